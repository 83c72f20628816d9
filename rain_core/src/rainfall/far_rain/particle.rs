//! One particle of far rain, and what it obscures.

use glam::Vec3;

use super::account::{cloud_share, far_pitch_weight};
use crate::error::{clamped, clamped_f32};
use crate::ops;

/// Height of a particle over its width. Units: none.
pub const FAR_HEIGHT: f64 = 14.0;

/// Opacity in the middle of a particle without stripes. Its mean over the particle is a quarter. Chosen: less needs more
/// particles for the same rain, more shows each by itself. Units: none.
pub const FAR_OPACITY: f64 = 0.2;

/// How much brighter or darker than the curtain a particle is, at most; as many are the one as the other, so the curtain's
/// light is kept. Chosen by eye: shafts shade each other, and a curtain that one cannot see through would be a flat wall. Units:
/// none.
pub const FAR_SHADE: f64 = 0.2;

/// Widest soft threshold in ranks at which particles come and go; at low densities it is as wide as the density. Units: none.
const SOFT: f64 = 0.25;

/// A particle of far rain: 32 bytes, as the shader reads it.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct FarParticle {
    /// Middle, relative to the eye. Units: m.
    pub centre: [f32; 3],
    /// Opacity over that of a whole particle: how much of it is there. Units: none. In [0, 1].
    pub presence: f32,
    /// Half its width; its height is [`FAR_HEIGHT`] times that. Units: m.
    pub half_width: f32,
    /// Where its stripes lie. Units: turns. In [0, 1).
    pub phase: f32,
    /// Its rank: it is there where the density reaches it. Units: none. In [0, 1).
    pub rank: f32,
    /// Level of its lattice, a whole number.
    pub level: f32,
}

/// How much of a particle of this rank is there at a density t (particles to a place, in [0, 1]; others are held): 1 well
/// above it, 0 well below it. The mean over ranks is t. Units: none.
///
/// Error: 1e-14; the mean over ranks 1e-12.
#[must_use]
pub fn far_presence(density: f64, rank: f64) -> f64 {
    let t = clamped(density, 0.0, 1.0);
    if t <= 0.0 {
        return 0.0;
    }
    // The threshold whose soft edge of width s, cut off at rank 1, has the mean t.
    let soft = t.min(SOFT);
    let reach = if t > 1.0 - 0.5 * soft {
        1.0 + soft - ops::sqrt(2.0 * soft * (1.0 - t))
    } else {
        t + 0.5 * soft
    };
    clamped((reach - rank) / soft, 0.0, 1.0)
}

/// Opacity of a particle at (across, along), each −1 to 1 from side to side, over that in the middle: soft sides and ends,
/// and three stripes. The mean over the particle and all phases is a quarter. Units: none. In [0, 2).
///
/// Error: 2e-6, its twin in WGSL 1e-4.
#[must_use]
pub fn far_profile(across: f32, along: f32, phase: f32) -> f32 {
    const TURN: f32 = core::f32::consts::TAU;
    if !(across.abs() < 1.0 && along.abs() < 1.0) {
        return 0.0;
    }
    let soft = |x: f32| 0.5 + 0.5 * cosf(0.5 * TURN * x);
    let stripes = 1.0 + 0.6 * cosf(TURN * (1.5 * across + phase)) + 0.35 * cosf(TURN * (3.7 * across - 3.0 * phase));
    soft(across) * soft(along) * stripes
}

fn cosf(x: f32) -> f32 {
    ops::cos(f64::from(x)) as f32
}

impl FarParticle {
    /// Its light over that of the curtain. Units: none. In [1 − [`FAR_SHADE`], 1 + [`FAR_SHADE`]]; 1 on average.
    ///
    /// Error: 1e-5, as the shader.
    #[must_use]
    pub fn shade(&self) -> f32 {
        let turned = 7.0 * self.phase;
        1.0 + FAR_SHADE as f32 * (2.0 * (turned - turned.floor()) - 1.0)
    }

    /// Opacity where a unit line of sight passes it, less than 1; `axis` is the unit direction it is drawn out along, `cloud` the
    /// cloud's base over the eye and how far below it the rain thins out (m). Over the sine between sight and axis: a line that runs along the rain is in it for longer.
    /// Units: none.
    ///
    /// Error: 1e-5; the shader's 1e-3.
    #[must_use]
    pub fn opacity(&self, towards: Vec3, axis: Vec3, cloud: [f32; 2]) -> f32 {
        let centre = Vec3::from(self.centre);
        let Some((right, normal)) = far_facing(centre, axis) else {
            return 0.0;
        };
        let head_on = towards.dot(normal);
        if head_on <= 1e-4 {
            return 0.0;
        }
        let way = centre.dot(normal) / head_on;
        let point = towards * way;
        let under = cloud_share(point.y.into(), cloud[0].into(), cloud[1].into()) as f32;
        let off = point - centre;
        let across = off.dot(right) / self.half_width;
        let along = off.dot(axis) / (self.half_width * FAR_HEIGHT as f32);
        let sine = towards.cross(axis).length().max(0.3);
        let weight = far_pitch_weight(f64::from(towards.y)) as f32 * under;
        let shown = FAR_OPACITY as f32 * self.presence * weight / sine * far_profile(across, along, self.phase);
        clamped_f32(shown, 0.0, 0.99)
    }
}

/// Across and normal of a particle that faces the eye about its axis; none where the eye looks along it.
fn far_facing(centre: Vec3, axis: Vec3) -> Option<(Vec3, Vec3)> {
    let right = centre.cross(axis).try_normalize()?;
    // Away from the eye.
    Some((right, axis.cross(right)))
}
