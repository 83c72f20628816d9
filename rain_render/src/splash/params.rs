//! Plain inputs of the pass and how they become the uniform.

use glam::{Mat4, Vec2, Vec3, Vec4};
use rain_core::splash::{SPLASH_CELL_M, SPLASH_SLOTS, SplashAnchor, SplashField};

use crate::gpu_types::{CoverParams, LevelMapParams, SplashView};
use crate::rainfall::Lighting;

/// Furthest reach of splashes. Units: m.
pub(super) const LARGEST_REACH_M: f32 = 50.0;
/// Shortest shutter time. Units: s.
const LEAST_EXPOSURE_S: f32 = 1e-4;

/// One view of splashes.
#[derive(Debug, Clone, Copy)]
pub struct SplashInput<'a> {
    /// What falls on a cell in a slot.
    pub field: &'a SplashField,
    /// The eye and the moment on the grid.
    pub anchor: SplashAnchor,
    /// Clip from eye-relative world (rotation and projection, no translation) at the end of the exposure.
    pub clip_from_eye: Mat4,
    /// The same at the start of the exposure, from positions relative to the *present* eye.
    pub clip_from_eye_before: Mat4,
    /// Four side planes through the eye, unit normals inward; w: offset. Units: m.
    pub side_planes: [Vec4; 4],
    /// Where the air goes. Units: m/s.
    pub wind_m_s: Vec3,
    /// Size of the target. Units: px.
    pub viewport_px: Vec2,
    /// Focal length. Units: px.
    pub focal_px: f32,
    /// Near plane of the projection. Units: m.
    pub near_m: f32,
    /// Shutter time. Units: s. Domain: (0, 1].
    pub exposure_s: f32,
    /// Gain on contrast. Domain: [1, 32]; 1 = physical.
    pub contrast: f32,
    /// Fade against the scene over at most this distance, m; 0 = hard depth test.
    pub soft_m: f32,
    /// How far crowns are drawn. Units: m. Held in [0, 50].
    pub reach_m: f32,
    /// How far thrown drops are drawn. Units: m. Held in [0, reach].
    pub near_reach_m: f32,
    /// Film on what stands under no water. Units: mm.
    pub film_mm: f32,
    /// Crowns and drops for which there is room; more are left out, any of them.
    pub capacity: u32,
    /// Surroundings.
    pub lighting: Lighting,
    /// Cover map relative to the eye.
    pub cover: CoverParams,
    /// Standing water relative to the eye.
    pub levels: LevelMapParams,
}

impl SplashInput<'_> {
    fn reach_m(&self) -> f32 {
        // What is not a number reaches nowhere.
        held(self.reach_m, 0.0, LARGEST_REACH_M)
    }

    /// Cells on each side of the eye's.
    pub(super) fn span(&self) -> u32 {
        (self.reach_m() / SPLASH_CELL_M as f32).ceil() as u32 + 1
    }

    /// Cells and slots that are looked through.
    pub(super) fn invocations(&self) -> u32 {
        let side = 2 * self.span() + 1;
        side * side * SPLASH_SLOTS
    }

    /// The uniform of this view.
    #[must_use]
    pub fn uniform(&self) -> SplashView {
        let [a, b, c] = self.field.stream;
        let mut classes = [[0.0; 4]; rain_core::rainfall::CLASS_COUNT];
        for ((slot, [start, span, bend]), weight) in
            classes.iter_mut().zip(self.field.diameters).zip(self.field.weights)
        {
            *slot = [start, span, bend, weight];
        }
        SplashView {
            clip_from_eye: self.clip_from_eye.to_cols_array_2d(),
            clip_from_eye_before: self.clip_from_eye_before.to_cols_array_2d(),
            environment: Vec3::splat(self.lighting.environment_scale)
                .extend(self.lighting.environment_max_level)
                .to_array(),
            ambient: self.lighting.ambient.extend(0.0).to_array(),
            sun_direction: self.lighting.sun_direction.extend(0.0).to_array(),
            sun: self.lighting.sun.extend(0.0).to_array(),
            planes: self.side_planes.map(|plane| plane.to_array()),
            wind: self.wind_m_s.extend(0.0).to_array(),
            stream: [a, b, c, self.anchor.slot],
            viewport: self.viewport_px.to_array(),
            fraction: self.anchor.fraction.to_array(),
            cell: self.anchor.cell.to_array(),
            focal: self.focal_px,
            near: self.near_m,
            exposure: held(self.exposure_s, LEAST_EXPOSURE_S, 1.0),
            contrast: self.contrast,
            soft: self.soft_m,
            reach: self.reach_m(),
            near_reach: self.near_reach_m.max(0.0).min(self.reach_m()),
            film: held(self.film_mm, 0.0, 1e6),
            since: self.anchor.since_s,
            span: self.span(),
            capacity: self.capacity,
            pad_a: 0,
            pad_b: 0,
            pad_c: 0,
            cover: self.cover,
            levels: self.levels,
            counts: self.field.count_limits,
            limits: self.field.class_limits,
            classes,
        }
    }
}

/// Within bounds; NaN counts as the lower one.
fn held(x: f32, low: f32, high: f32) -> f32 {
    if x > low { x.min(high) } else { low }
}
