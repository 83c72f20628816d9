//! Visibility: how far something dark can be told from the horizon.
//!
//! # Accuracy
//! Koschmieder's law for a black object against the horizon in uniform haze. Observed visibility in rain scatters by a
//! factor of two (mist, wind, lighting).

use super::extinction::transmittance;
use crate::error::clamped_or;
use crate::ops;

/// Contrast threshold of Koschmieder 1924: −ln 0.02 = 3.912. Units: none.
pub const KOSCHMIEDER_CONTRAST: f64 = 0.02;
/// Contrast threshold of the meteorological optical range: −ln 0.05 = 2.996. Units: none.
pub const METEOROLOGICAL_CONTRAST: f64 = 0.05;
/// Visibility of clear air and the upper clamp. Units: m.
pub const MAX_VISIBILITY_M: f64 = 1e9;

/// Distance at which contrast has fallen to a threshold, −ln(threshold)/σ. Units: m, in [0, 1e9].
///
/// `extinction_per_m`: σ, 1/m; negative, 0 or NaN: 1e9. `threshold`: contrast, clamped to [1e-6, 1]; NaN counts as
/// 0.02.
///
/// Error: 1e-15 relative; observers differ by a factor of two.
#[must_use]
pub fn visibility_m(extinction_per_m: f64, threshold: f64) -> f64 {
    let distance = depth_of(threshold) / extinction_per_m;
    if extinction_per_m > 0.0 && distance < MAX_VISIBILITY_M {
        distance
    } else {
        MAX_VISIBILITY_M
    }
}

/// The inverse: extinction at which `visibility_m` (m, clamped to [1e-3, 1e9], NaN counts as 1e9) is seen. Units: 1/m.
///
/// `threshold` as in [`visibility_m`].
///
/// Error: 1e-15 relative.
#[must_use]
pub fn extinction_for_visibility_per_m(visibility_m: f64, threshold: f64) -> f64 {
    let v = clamped_or(visibility_m, 1e-3, MAX_VISIBILITY_M, MAX_VISIBILITY_M);
    depth_of(threshold) / v
}

/// Share of contrast left at a distance, e^(−σs). Units: none.
///
/// `extinction_per_m`: 1/m, `distance_m`: m; negative or NaN products count as 0.
///
/// Error: 1e-15 relative.
#[must_use]
pub fn contrast_at(extinction_per_m: f64, distance_m: f64) -> f64 {
    transmittance(extinction_per_m * distance_m)
}

fn depth_of(threshold: f64) -> f64 {
    -ops::ln(clamped_or(threshold, 1e-6, 1.0, KOSCHMIEDER_CONTRAST))
}
