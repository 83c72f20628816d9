//! The work of a frame on its way to the GPU.

use glam::DVec3;
use rain_core::rainfall::areas::AreaFieldF32;

use crate::gpu_types::{WaterMapParams, WaterStamp};

/// What the GPU has to do for the map. Made empty, filled by [`super::WaterMap::take`], read by
/// [`super::WaterMapGpu::prepare`]; its lists keep their capacity when it is used again.
#[derive(Debug, Clone, Default)]
pub struct WaterMapFrame {
    /// One for each level; without the map of what covers.
    pub(super) levels: Vec<WaterMapParams>,
    /// Time passes, or texels are new.
    pub(super) advances: bool,
    /// Water of the cells that new texels start from: pores mm, film mm, soil clock s, unused.
    pub(super) seeds: Vec<[f32; 4]>,
    /// Level and stamp, in order.
    pub(super) stamps: Vec<(u32, WaterStamp)>,
    /// The ground's cells, when they have changed.
    pub(super) ground: Vec<[u32; 2]>,
    /// A head, and the rain areas behind it.
    pub(super) areas: Vec<[f32; 4]>,
    /// World position that the cover map's positions have to be relative to. Units: m.
    pub(super) origin_m: DVec3,
}

impl WaterMapFrame {
    /// World position that [`super::WaterMapInput::cover`] has to be relative to. Units: m.
    #[must_use]
    pub fn origin_m(&self) -> DVec3 {
        self.origin_m
    }

    /// The rain of this frame is not the same everywhere: areas packed about [`WaterMapFrame::origin_m`], the weather's rate
    /// and the rate that the map's rain was given for (units: mm/h; above 0). To be called after
    /// [`super::WaterMap::take`], which forgets the areas before.
    pub fn set_areas(&mut self, areas: &AreaFieldF32, weather_mm_h: f64, reference_mm_h: f64) {
        self.areas.clear();
        self.areas.push([
            areas.areas as f32,
            areas.outside,
            weather_mm_h as f32,
            reference_mm_h.max(0.0) as f32,
        ]);
        self.areas.extend_from_slice(&areas.rows);
    }

    /// Whether time passes or texels are filled; else there are only presses.
    #[must_use]
    pub fn advances(&self) -> bool {
        self.advances
    }

    /// Number of presses, each level counted.
    #[must_use]
    pub fn stamps(&self) -> usize {
        self.stamps.len()
    }

    /// Number of ground cells whose water goes along.
    #[must_use]
    pub fn seeds(&self) -> usize {
        self.seeds.len()
    }

    pub(super) fn clear(&mut self) {
        self.levels.clear();
        self.advances = false;
        self.seeds.clear();
        self.stamps.clear();
        self.ground.clear();
        self.areas.clear();
        self.areas.push([0.0; 4]);
    }
}
