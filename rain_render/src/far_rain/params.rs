//! Plain inputs of the pass and how they become its parameters.

use glam::{Mat4, Vec3};
use rain_core::rainfall::FarParticle;

use crate::gpu_types::FarRainParams;
use crate::rainfall::Lighting;

/// One view of far rain.
#[derive(Debug, Clone, Copy)]
pub struct FarRainInput<'a> {
    /// The particles.
    pub particles: &'a [FarParticle],
    /// Unit direction that they are drawn out along, downwards.
    pub axis: Vec3,
    /// Clip from eye-relative world (rotation and projection, no translation).
    pub clip_from_eye: Mat4,
    /// Surroundings.
    pub lighting: Lighting,
    /// Base of the cloud over the eye's height. Units: m.
    pub cloud_m: f32,
    /// How far below it rain thins out. Units: m.
    pub thin_m: f32,
}

impl FarRainInput<'_> {
    /// The parameters of this view.
    pub(super) fn params(&self) -> FarRainParams {
        FarRainParams {
            clip_from_eye: self.clip_from_eye.to_cols_array_2d(),
            environment: Vec3::splat(self.lighting.environment_scale)
                .extend(self.lighting.environment_max_level)
                .to_array(),
            ambient: self.lighting.ambient.extend(0.0).to_array(),
            sun_direction: self.lighting.sun_direction.extend(0.0).to_array(),
            sun: self.lighting.sun.extend(0.0).to_array(),
            axis: self.axis.extend(0.0).to_array(),
            cloud: self.cloud_m,
            thin: self.thin_m,
            pad_b: 0.0,
            pad_c: 0.0,
        }
    }
}
