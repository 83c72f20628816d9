//! Extinction of rain from its drops, and what it does to light.
//!
//! # Accuracy
//! Drops much larger than the wavelength take out twice their cross-section, half of it by diffraction into less than
//! 0.1°, which a camera cannot tell from the direct beam: what a picture loses lies between Q = 1 and 2. Measured
//! visibility in rain also contains mist.

use crate::error::{clamped, clamped_f32, clamped_or};
use crate::ops;
use crate::rainfall::Spectrum;

/// Extinction over cross-section of large drops, Q. Units: none. A choice between 1 and 2 for pictures; 2 is the
/// beam's.
pub const EXTINCTION_EFFICIENCY: f64 = 2.0;

/// Longest optical depth that is looked at: e^(−700) is the smallest ordinary double.
const MAX_DEPTH: f64 = 700.0;

/// Extinction coefficient of rain σ = Q σ_geo, all diameters. Units: 1/m.
///
/// `efficiency`: Q, clamped to [0, 4], NaN counts as [`EXTINCTION_EFFICIENCY`]. Uses the spectrum's own N₀, so drops
/// and fog share one. Marshall–Palmer with N₀ = 8000: 0.36466 R^0.63 per km.
///
/// Error: 1e-10 relative against the sum over diameters.
#[must_use]
pub fn extinction_per_m(spectrum: &Spectrum, efficiency: f64) -> f64 {
    let q = clamped_or(efficiency, 0.0, 4.0, EXTINCTION_EFFICIENCY);
    q * spectrum.extinction_per_m(0.0, f64::INFINITY)
}

/// Light that gets through an optical depth, e^(−τ). Units: none.
///
/// `depth`: τ, clamped to [0, 700]; NaN counts as 0.
///
/// Error: 1e-15 relative.
#[must_use]
pub fn transmittance(depth: f64) -> f64 {
    ops::exp(-clamped(depth, 0.0, MAX_DEPTH))
}

/// Light that does not get through, 1 − e^(−τ), exact for small τ. `depth` as in [`transmittance`]. Units: none.
///
/// Error: 1e-15 relative, also for tiny τ.
#[must_use]
pub fn obscured(depth: f64) -> f64 {
    -ops::exp_m1(-clamped(depth, 0.0, MAX_DEPTH))
}

/// [`transmittance`] in single precision, `depth` clamped to [0, 80].
///
/// Error: 2e-7 relative.
#[must_use]
#[inline]
pub fn transmittance_f32(depth: f32) -> f32 {
    ops::expf(-clamped_f32(depth, 0.0, 80.0))
}

/// [`obscured`] in single precision, `depth` clamped to [0, 80].
///
/// Error: 2e-7 relative, also for tiny τ.
#[must_use]
#[inline]
pub fn obscured_f32(depth: f32) -> f32 {
    -ops::exp_m1f(-clamped_f32(depth, 0.0, 80.0))
}

/// Radiance behind an optical depth of haze: L e^(−τ) + L_fog (1 − e^(−τ)), each colour. Units: those of the radiances.
///
/// `depth` as in [`transmittance`]; radiances any finite numbers ≥ 0 (others go through as they are).
///
/// Error: 1e-15 of the larger radiance; single scattering of a uniform light.
#[must_use]
pub fn inscattered(radiance: [f64; 3], fog_radiance: [f64; 3], depth: f64) -> [f64; 3] {
    let lost = obscured(depth);
    core::array::from_fn(|i| radiance[i] * (1.0 - lost) + fog_radiance[i] * lost)
}

/// [`inscattered`] in single precision, for one colour.
///
/// Error: 3e-7 of the larger radiance.
#[must_use]
#[inline]
pub fn inscattered_f32(radiance: f32, fog_radiance: f32, depth: f32) -> f32 {
    let lost = obscured_f32(depth);
    radiance * (1.0 - lost) + fog_radiance * lost
}
