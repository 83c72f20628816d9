//! Plain inputs of the pass and how they become its parameters.

use glam::{Mat4, Vec3};
use rain_core::rainfall::{Card, Lamp};

use crate::glass::{self, Pane};
use crate::gpu_types::{CoverParams, LatticeParams};
use crate::lamps;
use crate::rainfall::Lighting;

/// One view of the lattice.
#[derive(Debug, Clone, Copy)]
pub struct LatticeInput<'a> {
    /// The cards, from far to near.
    pub cards: &'a [Card],
    /// Clip from eye-relative world (rotation and projection, no translation); infinite reverse-Z.
    pub clip_from_eye: Mat4,
    /// Near plane of the projection. Units: m.
    pub near_m: f32,
    /// Gain on streak contrast. Domain: [1, 32]; 1 = physical.
    pub contrast: f32,
    /// Surroundings.
    pub lighting: Lighting,
    /// Radiance of the haze before a card, exposed.
    pub fog: Vec3,
    /// Lamps near the view; the first [`rain_core::rainfall::MAX_LAMPS`] count.
    pub lamps: &'a [Lamp],
    /// What is transparent before the view; the first [`crate::glass::MAX_PANES`] count.
    pub panes: &'a [Pane],
    /// Cover map relative to the eye.
    pub cover: CoverParams,
}

impl LatticeInput<'_> {
    /// The parameters of this view; `soft`: whether the scene's depth is there.
    pub(super) fn params(&self, soft: bool) -> LatticeParams {
        let (lamp, lamps) = lamps::slots(self.lamps);
        let (pane, panes) = glass::slots(self.panes);
        LatticeParams {
            clip_from_eye: self.clip_from_eye.to_cols_array_2d(),
            environment: Vec3::splat(self.lighting.environment_scale)
                .extend(self.lighting.environment_max_level)
                .to_array(),
            ambient: self.lighting.ambient.extend(0.0).to_array(),
            sun_direction: self.lighting.sun_direction.extend(0.0).to_array(),
            sun: self.lighting.sun.extend(0.0).to_array(),
            fog: self.fog.extend(0.0).to_array(),
            near: self.near_m,
            contrast: self.contrast,
            soft: f32::from(u8::from(soft)),
            cards: self.cards.len() as u32,
            lamps,
            panes,
            pad_b: 0,
            pad_c: 0,
            cover: self.cover,
            lamp,
            pane,
        }
    }
}
