//! Plain inputs of the pass and how they become its parameters.

use glam::{Mat4, Vec3, Vec4};
use rain_core::hash::pcg3d;
use rain_core::rainfall::{
    CLASS_COUNT, ClassPlacement, Container, DetailLaw, DropChoice, LEAD_CAP_M, LEAD_TIME_S, Lamp, ParallelView,
    RANGE_CAP_M, SizeClass,
};

use crate::glass::{self, Pane};
use crate::gpu_types::{CoverParams, RainfallClass, RainfallView};
use crate::lamps;

/// The light that drops show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lighting {
    /// Scale from the environment map's texels to exposed radiance. 0 when there is no map.
    pub environment_scale: f32,
    /// Highest mip level of the environment map.
    pub environment_max_level: f32,
    /// Uniform surrounding radiance, exposed.
    pub ambient: Vec3,
    /// Direction towards the sun, unit.
    pub sun_direction: Vec3,
    /// Illuminance of the sun, exposed.
    pub sun: Vec3,
}

/// Light is seen from so far back where rays are parallel: their directions differ by less than a thousandth. Units: m.
pub(crate) const SEEN_FROM_M: f32 = 1e4;

/// The shutter and how streaks are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shutter {
    /// Shutter time. Units: s. Domain: (0, 1].
    pub exposure_s: f32,
    /// Gain on streak contrast. Domain: [1, 32]; 1 = physical.
    pub contrast: f32,
    /// Quality κ of the container.
    pub kappa: f32,
    /// Fade against the scene over this distance, m; 0 = hard depth test.
    pub soft_m: f32,
    /// Near streaks have the pattern that their drops draw, and frozen drops show their surroundings; otherwise all are
    /// even.
    pub patterned: bool,
    /// The law that the container was thinned by; its drops are drawn larger by it.
    pub detail: Option<DetailLaw>,
}

/// The drops of a view.
#[derive(Debug, Clone, Copy)]
pub enum Drops<'a> {
    /// The GPU chooses them.
    Chosen(&'a DropChoice),
    /// Those that somebody has listed, of the field with this seed. They are uploaded each frame.
    Listed(&'a Container, u64),
}

impl Drops<'_> {
    fn seed(&self) -> u64 {
        match self {
            Self::Chosen(choice) => choice.seed,
            Self::Listed(_, seed) => *seed,
        }
    }
}

/// One view of the rain.
#[derive(Debug, Clone, Copy)]
pub struct RainfallInput<'a> {
    /// The drops.
    pub drops: Drops<'a>,
    /// Clip from eye-relative world (rotation and projection, no translation) at the end of the exposure.
    pub clip_from_eye: Mat4,
    /// The same at the start of the exposure, from positions relative to the *present* eye.
    pub clip_from_eye_before: Mat4,
    /// Height of the eye, which drops' swings are in phase with. Units: m.
    pub eye_height_m: f32,
    /// Velocity of the eye. Units: m/s.
    pub eye_velocity_m_s: Vec3,
    /// Corner and size of the view in the target, within it. Units: px.
    pub viewport_px: Vec4,
    /// Focal length. Units: px.
    pub focal_px: f32,
    /// A view without perspective, as [`RainViewVolume`](rain_core::rainfall::RainViewVolume) has it: neither fade before the scene, nor panes, nor
    /// patterns, nor a law of detail.
    pub parallel: Option<ParallelView>,
    /// Near plane of the projection. Units: m.
    pub near_m: f32,
    /// Shutter and quality.
    pub shutter: Shutter,
    /// Surroundings.
    pub lighting: Lighting,
    /// Lamps near the view; the first [`rain_core::rainfall::MAX_LAMPS`] count.
    pub lamps: &'a [Lamp],
    /// What is transparent before the view; the first [`crate::glass::MAX_PANES`] count.
    pub panes: &'a [Pane],
    /// Cover map relative to the eye.
    pub cover: CoverParams,
}

impl RainfallInput<'_> {
    /// The parameters of this view; `placements` are those of its drops.
    #[must_use]
    pub(super) fn params(&self, placements: &[ClassPlacement]) -> RainfallView {
        let seed = self.drops.seed();
        let mut classes = [bytemuck::Zeroable::zeroed(); CLASS_COUNT];
        for (k, (slot, placement)) in classes.iter_mut().zip(placements).enumerate() {
            let class = SizeClass::new(k);
            let stream = pcg3d([seed as u32, (seed >> 32) as u32, k as u32]);
            let v = placement.velocity_m_s;
            *slot = RainfallClass {
                cell: placement.eye.cell.extend(0).to_array(),
                fraction: placement.eye.fraction.extend(class.cell_m as f32).to_array(),
                velocity: v.extend(1.0 / (-v.y).max(0.1)).to_array(),
                stream: [stream[0], stream[1], stream[2], 0],
                diameter: [class.exp_min as f32, class.exp_span as f32, 0.0, 0.0],
            };
        }
        let lead = match &self.parallel {
            Some(parallel) => parallel.across_m.as_vec3(),
            None => (self.eye_velocity_m_s * LEAD_TIME_S as f32).clamp_length_max(LEAD_CAP_M as f32),
        };
        let rays = self.parallel.map_or(Vec4::ZERO, |parallel| {
            (parallel.ahead.as_vec3() * SEEN_FROM_M).extend(1.0)
        });
        let (lamp, lamps) = lamps::slots(self.lamps);
        let (pane, panes) = glass::slots(self.panes);
        let size = self.shutter.detail.map(DetailLaw::size_terms);
        RainfallView {
            clip_from_eye: self.clip_from_eye.to_cols_array_2d(),
            clip_from_eye_before: self.clip_from_eye_before.to_cols_array_2d(),
            environment: Vec3::splat(self.lighting.environment_scale)
                .extend(self.lighting.environment_max_level)
                .to_array(),
            ambient: self.lighting.ambient.extend(0.0).to_array(),
            sun_direction: self.lighting.sun_direction.extend(0.0).to_array(),
            sun: self.lighting.sun.extend(0.0).to_array(),
            lead: lead.extend(self.eye_height_m).to_array(),
            rays: rays.to_array(),
            size: size.map_or([1.0, 0.0, 0.0, 0.0], |[even, linear, square]| {
                [even, linear, square, 1.0 / RANGE_CAP_M as f32]
            }),
            viewport: self.viewport_px.to_array(),
            focal: self.focal_px,
            near: self.near_m,
            exposure: self.shutter.exposure_s,
            contrast: self.shutter.contrast,
            kappa: self.shutter.kappa,
            soft: self.shutter.soft_m,
            lamps,
            panes,
            patterned: u32::from(self.shutter.patterned),
            guard_share: 1.0,
            pad_b: 0,
            pad_c: 0,
            cover: self.cover,
            classes,
            lamp,
            pane,
        }
    }
}
