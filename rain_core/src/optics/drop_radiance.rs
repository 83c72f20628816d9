//! What a drop shows: its surroundings, refracted and reflected.
//!
//! L = (1 − F)² L_env(refracted) + F L_env(reflected). A drop is not a tinted transparent streak.
//!
//! # Accuracy
//! A sphere with two rays: 4.7 % of the light comes by inner reflections and is left out. The cheap tier replaces both
//! directions by one blurred look-up each, the mean of the surroundings within 40° of straight on and that of all.
//! [`crate::optics`] compares all tiers with traced drops.

use glam::Vec3;

use super::fresnel::fresnel;
use super::refraction::deviation_rad;
use crate::ops;

/// Share of a drop's light that comes straight through: weight of one look-up blurred over ± 40° around the inverted
/// view. Units: none. Rounded from the energy split at n = 1.333, 0.8837.
pub const CHEAP_REFRACTED: f32 = 0.884;
/// Share reflected outside: weight of one look-up blurred over the reflections. Units: none. Rounded from 0.0664.
pub const CHEAP_REFLECTED: f32 = 0.066;

/// Weights and angles of the two rays at one point of a round drop's disc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DropLight {
    /// (1 − F)². Units: none.
    pub refracted: f64,
    /// Angle by which the refracted ray is turned from straight on, towards the axis. Units: rad.
    pub refracted_rad: f64,
    /// F. Units: none.
    pub reflected: f64,
    /// Angle by which the reflected ray is turned from straight on, away from the axis, π − 2i. Units: rad.
    pub reflected_rad: f64,
}

/// The two rays at `impact` s (radii from the axis, clamped to [0, 1], NaN counts as 0) for `index` n (clamped to
/// [1, 10], NaN counts as 1).
///
/// Error: 1e-14 against rays traced through a sphere. For falling drops see [`crate::optics`].
#[must_use]
pub fn drop_light(impact: f64, index: f64) -> DropLight {
    let s = if impact > 0.0 { impact.min(1.0) } else { 0.0 };
    let n = super::refraction::index(index);
    let f = fresnel(ops::sqrt((1.0 - s) * (1.0 + s)), n);
    DropLight {
        refracted: (1.0 - f) * (1.0 - f),
        refracted_rad: deviation_rad(s, n),
        reflected: f,
        reflected_rad: core::f64::consts::PI - 2.0 * ops::asin(s),
    }
}

/// Directions and weights of the two rays for one pixel of a drop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DropRays {
    /// Where the refracted ray comes from, unit vector from the drop outward.
    pub refracted: Vec3,
    /// (1 − F)². Units: none.
    pub refracted_weight: f32,
    /// Where the reflected ray comes from, unit vector from the drop outward.
    pub reflected: Vec3,
    /// F. Units: none.
    pub reflected_weight: f32,
}

/// The two rays where a line of sight meets a drop, in single precision.
///
/// `view`: unit vector from the eye to the point; `normal`: outward unit normal there (a sphere's, or that of
/// [`crate::rainfall::DropOutline`]); the refracted ray leaves as from the sphere with this normal, which is poor above
/// 2 mm: [`super::DropBody::rays`] takes the true far side. A normal turned away
/// from the eye counts as one across the view. `index` as in [`drop_light`]. Vectors must be unit and finite; else
/// `None`.
///
/// Error: directions 1e-5 and weights 5e-6 against traced rays through a sphere, up to 0.99 of the radius. For falling
/// drops see [`crate::optics`].
#[must_use]
pub fn drop_rays_f32(view: Vec3, normal: Vec3, index: f32) -> Option<DropRays> {
    if !(view.is_normalized() && normal.is_normalized()) {
        return None;
    }
    let cosine = (-view.dot(normal)).clamp(0.0, 1.0);
    // The part of the normal across the view; its length is the impact parameter.
    let across = normal - view * view.dot(normal);
    let s = across.length().min(1.0);
    let n = if index > 1.0 { index.min(10.0) } else { 1.0 };
    let [sin, cos] = super::refraction::deviation_sin_cos_f32(s, n);
    let towards_axis = if s > 0.0 { across / -s } else { Vec3::ZERO };
    let f = super::fresnel::fresnel_f32(cosine, n);
    Some(DropRays {
        refracted: (view * cos + towards_axis * sin).normalize(),
        refracted_weight: (1.0 - f) * (1.0 - f),
        reflected: (view + 2.0 * cosine * normal).normalize(),
        reflected_weight: f,
    })
}
