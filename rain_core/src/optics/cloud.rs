//! Light through the clouds that rain falls from.
//!
//! # Accuracy
//! Level closed cloud of drops that absorb nothing: true to 1 % of visible light (water takes 3e-6 of red light at each
//! drop), so such clouds are grey; colours come from what lights them. The water over rain scatters by a factor of two about
//! its mean.

use crate::error::{clamped, clamped_or};
use crate::ops;
use crate::rainfall::MAX_INTENSITY_MM_H;

/// Mean cosine of the angle that a cloud's drops turn light by. Units: none.
pub const CLOUD_ASYMMETRY: f64 = 0.85;
/// Effective radius of a rain cloud's drops. Units: m.
pub const CLOUD_DROP_RADIUS_M: f64 = 12e-6;
/// Depth of the rain column in mid latitudes. Units: m.
pub const RAIN_COLUMN_M: f64 = 3000.0;

/// Water in the cloud over rain, 0.18 (1 + √(H R)), H in km, R in mm/h. Units: kg/m².
///
/// `rate_mm_h`: clamped to [0, 500]; `column_m`: H, m, clamped to [0, 2e4]; NaN counts as 0. Wentz & Spencer 1998.
///
/// Error: 1e-15 relative to the formula; a factor of two from cloud to cloud.
#[must_use]
pub fn cloud_water_kg_m2(rate_mm_h: f64, column_m: f64) -> f64 {
    let rate = clamped(rate_mm_h, 0.0, MAX_INTENSITY_MM_H);
    0.18 * (1.0 + ops::sqrt(clamped(column_m, 0.0, 2e4) * 1e-3 * rate))
}

/// Optical depth of a cloud, 3 W/(2 ρ r). Units: none.
///
/// `water_kg_m2`: W, kg/m², clamped to [0, 100]; `radius_m`: effective radius r, m, clamped to [1e-6, 1e-4], NaN counts as
/// 1.2e-5. Stephens 1978.
///
/// Error: 1e-15 relative to the formula.
#[must_use]
pub fn cloud_optical_depth(water_kg_m2: f64, radius_m: f64) -> f64 {
    let radius = clamped_or(radius_m, 1e-6, 1e-4, CLOUD_DROP_RADIUS_M);
    1.5 * clamped(water_kg_m2, 0.0, 100.0) / (1000.0 * radius)
}

/// Share of diffuse light that a cloud lets through over dark ground, 1/(1 + (√3/2)(1 − g) τ). Units: none.
///
/// `depth`: τ, clamped to [0, 1e5], NaN counts as 0; `asymmetry`: g, clamped to [−1, 1], NaN counts as 0.85. Coakley &
/// Chýlek 1975, two streams.
///
/// Error: 1e-15 relative to the formula, 0.03 of the light that falls on the cloud against a Monte Carlo of its drops.
#[must_use]
pub fn cloud_transmittance(depth: f64, asymmetry: f64) -> f64 {
    let g = clamped_or(asymmetry, -1.0, 1.0, CLOUD_ASYMMETRY);
    1.0 / (1.0 + 0.5 * ops::sqrt(3.0) * (1.0 - g) * clamped(depth, 0.0, 1e5))
}
