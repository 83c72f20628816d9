//! How smooth a film makes a surface. Roughness α is that of GGX (the square of the perceptual one).
//!
//! # Accuracy
//! How high stones stand about their mean is a choice: half as far as the texture is deep, either way. Waves enter by their slope variance alone, which
//! is exact for Gaussian slopes of a Beckmann surface and good for GGX while α stays below about 0.5.

use super::surface_state::{smoothstep, smoothstep_f32};
use crate::constants::WATER_IOR;
use crate::error::{clamped, clamped_f32};
use crate::ops;

/// F₀ of water in air, ((n − 1)/(n + 1))². Units: none.
pub const WATER_F0: f64 = (WATER_IOR - 1.0) * (WATER_IOR - 1.0) / ((WATER_IOR + 1.0) * (WATER_IOR + 1.0));

/// Share of a textured surface under a closed film: smoothstep(T/2, 3T/2, h). Depths in mm, at least 0; NaN counts as
/// no film. Over a texture of no depth any film is closed.
///
/// Rain that has stopped leaves the texture full, h = T: its water stands level with the tops of the stones on average,
/// and about half of them break through. What mirrors as one surface is a film that runs above them. Error: 3e-16.
#[must_use]
pub fn closed_film_share(film_mm: f64, texture_depth_mm: f64) -> f64 {
    let t = texture_depth_mm.max(0.0);
    smoothstep(0.5 * t, 1.5 * t, film_mm)
}

/// [`closed_film_share`] in single precision. Error: 5e-7.
#[must_use]
pub fn closed_film_share_f32(film_mm: f32, texture_depth_mm: f32) -> f32 {
    let t = texture_depth_mm.max(0.0);
    smoothstep_f32(0.5 * t, 1.5 * t, film_mm)
}

/// Roughness under a film of `film_mm` in a texture of `texture_depth_mm`, s the [`closed_film_share`]:
/// 1/α² = (1 − s)/α_dry² + s/α_water². Depths in mm; roughnesses are clamped to [0, 1], NaN counts as 0 (roughness) or
/// no film. α_water of calm water is 0.02 to 0.05, of a film that follows a road's stones about 0.05.
///
/// The normals of what is bare and of what is flooded are two distributions side by side; α is that of one GGX lobe as
/// high as both together, so that lamps keep their glint where only part of the ground mirrors. Error: 5e-16.
#[must_use]
pub fn film_roughness(dry: f64, water: f64, film_mm: f64, texture_depth_mm: f64) -> f64 {
    one_lobe(dry, water, closed_film_share(film_mm, texture_depth_mm))
}

/// Roughness of one lobe as high as those of two parts of a surface, `share` of which has `water`.
pub(super) fn one_lobe(dry: f64, water: f64, share: f64) -> f64 {
    let (dry, water, s) = (clamped(dry, 0.0, 1.0), clamped(water, 0.0, 1.0), share);
    if s <= 0.0 {
        return dry;
    }
    if s >= 1.0 {
        return water;
    }
    // Over both squares, so that a mirror divides nothing by 0.
    let below = ops::sqrt((1.0 - s) * water * water + s * dry * dry);
    if below > 0.0 { dry * water / below } else { 0.0 }
}

/// [`film_roughness`] in single precision. Error: 5e-7.
#[must_use]
pub fn film_roughness_f32(dry: f32, water: f32, film_mm: f32, texture_depth_mm: f32) -> f32 {
    let (dry, water) = (clamped_f32(dry, 0.0, 1.0), clamped_f32(water, 0.0, 1.0));
    let s = closed_film_share_f32(film_mm, texture_depth_mm);
    if s <= 0.0 {
        return dry;
    }
    if s >= 1.0 {
        return water;
    }
    let below = ((1.0 - s) * water * water + s * dry * dry).sqrt();
    if below > 0.0 { dry * water / below } else { 0.0 }
}

/// Roughness of water whose waves have this mean square slope ⟨s²⟩ (along one axis) beyond what is drawn as normals:
/// √(α² + 2⟨s²⟩), at most 1. Inputs are clamped to [0, 1] and [0, ∞), NaN counts as 0. Error: 3e-16.
#[must_use]
pub fn widened_roughness(roughness: f64, slope_variance: f64) -> f64 {
    let a = clamped(roughness, 0.0, 1.0);
    ops::sqrt(a * a + 2.0 * slope_variance.max(0.0)).min(1.0)
}
