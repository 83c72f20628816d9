//! The work of a frame on its way to the GPU.

use glam::DVec3;

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
    /// World position that the cover map's positions have to be relative to. Units: m.
    pub(super) origin_m: DVec3,
}

impl WaterMapFrame {
    /// World position that [`super::WaterMapInput::cover`] has to be relative to. Units: m.
    #[must_use]
    pub fn origin_m(&self) -> DVec3 {
        self.origin_m
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
    }
}
