//! What the host says about the scene.

use bevy_ecs::prelude::*;
use bevy_math::DVec3;
use rain_core::surface::basins::Drain;
use rain_core::surface::ground::{GroundDomain, GroundScene, GroundSettings};
use rain_core::weather::SurfaceClass;

/// The scene's triangles by owner, each owner of one surface class. The ground is built from the static ones once they
/// have settled ([`SurfaceSettings::settle_ticks`]).
#[derive(Resource, Debug, Clone, Default)]
pub struct SurfaceScene {
    scene: GroundScene,
    pub(super) requested: bool,
}

impl SurfaceScene {
    /// Puts in or replaces an owner's triangles (world coordinates, m; counter-clockwise seen from above where they face
    /// up). What moves is no ground. The same again changes nothing.
    pub fn set(&mut self, owner: u64, triangles: &[[DVec3; 3]], class: SurfaceClass, is_static: bool) {
        self.scene.set(owner, triangles, class, is_static);
    }

    /// Takes an owner out.
    pub fn remove(&mut self, owner: u64) {
        self.scene.remove(owner);
    }

    /// Has the ground built anew by the next tick.
    pub fn request_rebuild(&mut self) {
        self.requested = true;
    }

    /// The triangles.
    #[must_use]
    pub fn scene(&self) -> &GroundScene {
        &self.scene
    }
}

/// How the ground is made and kept. A change has it built anew.
#[derive(Resource, Debug, Clone, PartialEq)]
pub struct SurfaceSettings {
    /// Whether there is a ground at all. Default: true.
    pub enabled: bool,
    /// Where. Default: the bounds of the static triangles that face up.
    pub domain: Option<GroundDomain>,
    /// Side of a cell; doubled until there are at most `max_cells`. Units: m. Domain: [0.01, 100]. Default: 0.25.
    pub cell_m: f64,
    /// Most cells. Domain: [1, 2²⁴]. Default: 2²⁰.
    pub max_cells: usize,
    /// How far above the lowest surface the ground may still be: kerbs, slabs. Units: m. Domain: [0, 10]. Default: 0.3.
    pub step_m: f64,
    /// How often each cell is advanced. Units: s. Domain: [one tick, 60]. Default: 1.
    pub interval_s: f64,
    /// Cells whose exposure is asked for in a tick after what covers has changed. Domain: ≥ 1. Default: 1024, 0.4 ms.
    pub exposure_cells_per_tick: usize,
    /// Ticks for which nothing static may have changed before the ground is built. Default: 16, half a second.
    pub settle_ticks: u32,
    /// Inlets.
    pub drains: Vec<Drain>,
}

impl Default for SurfaceSettings {
    fn default() -> Self {
        let ground = GroundSettings::default();
        Self {
            enabled: true,
            domain: ground.domain,
            cell_m: ground.cell_m,
            max_cells: ground.max_cells,
            step_m: ground.step_m,
            interval_s: 1.0,
            exposure_cells_per_tick: 1024,
            settle_ticks: 16,
            drains: Vec::new(),
        }
    }
}

impl SurfaceSettings {
    /// The core's settings for ticks of this length.
    pub(super) fn ground(&self, tick_s: f64) -> GroundSettings {
        // What is too short becomes one tick; what is too long or not a number (0 steps) is refused by the core.
        let steps = (self.interval_s / tick_s).round().clamp(1.0, 1e9) as u32;
        GroundSettings {
            domain: self.domain,
            cell_m: self.cell_m,
            max_cells: self.max_cells,
            step_m: self.step_m,
            interval_steps: steps,
            basin_steps: steps.min(8),
            drains: self.drains.clone(),
            ..GroundSettings::default()
        }
    }
}
