//! The depth map along the rain, as the host hands it over.

use glam::{DVec2, DVec3, Vec2};

use crate::gpu_types::CoverParams;

/// Where a depth map lies and what it was drawn along.
///
/// The map holds the top of everything that covers, seen along the mean fall: texel (u, v) is the ray that meets the
/// reference plane at `centre + (uv − ½)·extent`; depth is reverse-Z and linear in height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoverPlacement {
    /// Centre of the map on the reference plane, world (x, z). Units: m.
    pub centre_m: DVec2,
    /// Height of the reference plane. Units: m.
    pub plane_m: f64,
    /// Side of the map. Units: m.
    pub extent_m: f64,
    /// Height of depth 1. Units: m.
    pub top_m: f64,
    /// Height between depth 0 and depth 1. Units: m.
    pub range_m: f64,
    /// Height of the highest occluder. Units: m.
    pub highest_m: f64,
    /// Horizontal wind (x, z). Units: m/s.
    pub wind_m_s: DVec2,
    /// Flux mean of 1/v. Units: s/m.
    pub inverse_speed_s_m: f64,
    /// Texels per side.
    pub texels: u32,
}

impl CoverPlacement {
    /// The placement relative to an eye, so that single precision suffices anywhere.
    #[must_use]
    pub fn params(&self, eye_m: DVec3) -> CoverParams {
        let centre: Vec2 = (self.centre_m - DVec2::new(eye_m.x, eye_m.z)).as_vec2();
        CoverParams {
            centre: centre.to_array(),
            wind: self.wind_m_s.as_vec2().to_array(),
            inverse_extent: (1.0 / self.extent_m) as f32,
            top: (self.top_m - eye_m.y) as f32,
            range: self.range_m as f32,
            highest: (self.highest_m - eye_m.y) as f32,
            plane: (self.plane_m - eye_m.y) as f32,
            inverse_speed: self.inverse_speed_s_m as f32,
            texels: self.texels as f32,
            present: 1.0,
        }
    }
}

/// Open sky: no map, everything is reached.
#[must_use]
pub fn open_sky() -> CoverParams {
    CoverParams {
        centre: [0.0; 2],
        wind: [0.0; 2],
        inverse_extent: 1.0,
        top: 0.0,
        range: 1.0,
        highest: 0.0,
        plane: 0.0,
        inverse_speed: 0.17,
        texels: 1.0,
        present: 0.0,
    }
}
