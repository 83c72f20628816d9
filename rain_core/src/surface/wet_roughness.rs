//! How smooth a film makes a surface. Roughness α is that of GGX (the square of the perceptual one).
//!
//! # Accuracy
//! The ramp from the texture's roughness to the water's is a choice. Waves enter by their slope variance alone, which
//! is exact for Gaussian slopes of a Beckmann surface and good for GGX while α stays below about 0.5.

use super::surface_state::{smoothstep, smoothstep_f32};
use crate::constants::WATER_IOR;
use crate::error::{clamped, clamped_f32};
use crate::ops;

/// F₀ of water in air, ((n − 1)/(n + 1))². Units: none.
pub const WATER_F0: f64 = (WATER_IOR - 1.0) * (WATER_IOR - 1.0) / ((WATER_IOR + 1.0) * (WATER_IOR + 1.0));

/// Roughness under a film of `film_mm` in a texture of `texture_depth_mm`: from α_dry to α_water along
/// smoothstep(0, T, h). Depths in mm; roughnesses are clamped to [0, 1], NaN counts as 0 (roughness) or no film.
/// α_water of calm water is 0.02 to 0.05. Error: 3e-16.
#[must_use]
pub fn film_roughness(dry: f64, water: f64, film_mm: f64, texture_depth_mm: f64) -> f64 {
    let (dry, water) = (clamped(dry, 0.0, 1.0), clamped(water, 0.0, 1.0));
    let covered = smoothstep(0.0, texture_depth_mm.max(0.0), film_mm);
    dry * (1.0 - covered) + water * covered
}

/// [`film_roughness`] in single precision. Error: 2e-7.
#[must_use]
pub fn film_roughness_f32(dry: f32, water: f32, film_mm: f32, texture_depth_mm: f32) -> f32 {
    let (dry, water) = (clamped_f32(dry, 0.0, 1.0), clamped_f32(water, 0.0, 1.0));
    let covered = smoothstep_f32(0.0, texture_depth_mm.max(0.0), film_mm);
    dry * (1.0 - covered) + water * covered
}

/// Roughness of water whose waves have this mean square slope ⟨s²⟩ (along one axis) beyond what is drawn as normals:
/// √(α² + 2⟨s²⟩), at most 1. Inputs are clamped to [0, 1] and [0, ∞), NaN counts as 0. Error: 3e-16.
#[must_use]
pub fn widened_roughness(roughness: f64, slope_variance: f64) -> f64 {
    let a = clamped(roughness, 0.0, 1.0);
    ops::sqrt(a * a + 2.0 * slope_variance.max(0.0)).min(1.0)
}
