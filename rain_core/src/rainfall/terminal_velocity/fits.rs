//! The sources' terminal-speed fits for sea level, kept for comparison. D in mm, v in m/s.
//!
//! Every one returns 0 for a negative or NaN diameter, never falls below 0, and holds its diameter at the end of the
//! range that its authors fitted, or at 7 mm where they gave none: no larger drop survives.
//!
//! # Accuracy
//! Each function's `Error:` gives its rms and largest distance from Gunn & Kinzer's 30 entries with D ≥ 0.5 mm.

use super::MAX_FITTED_DIAMETER_MM;
use super::air::air_viscosity_pa_s;
use crate::constants::{AIR_DENSITY, GRAVITY, WATER_DENSITY};
use crate::error::clamped;
use crate::ops;

/// Largest drop that the laws without an upper end of their own accept. Units: mm.
const LARGEST_MM: f64 = 7.0;

/// Foote & du Toit 1969: powers of D from 0 to 9.
const FOOTE_DU_TOIT: [f64; 10] = [
    -8.573_154_0e-2,
    3.326_586_2,
    4.384_357_8,
    -6.881_341_4,
    4.757_020_5,
    -1.904_660_1,
    4.633_997_8e-1,
    -6.760_789_8e-2,
    5.445_548_0e-3,
    -1.863_108_7e-4,
];

/// Foote & du Toit 1969, polynomial of degree 9. Units: m/s.
///
/// `diameter_mm` in mm, held at 5.8: above 6 mm the polynomial falls without end (−95 at 8 mm). Below 0.024 mm it is
/// negative and 0 is returned.
///
/// Error: 1e-11 m/s against the printed formula; rms 0.015, at most 0.033 m/s.
#[must_use]
pub fn foote_du_toit(diameter_mm: f64) -> f64 {
    let d = clamped(diameter_mm, 0.0, MAX_FITTED_DIAMETER_MM);
    FOOTE_DU_TOIT.iter().rev().fold(0.0, |sum, c| sum * d + c).max(0.0)
}

/// Brandes et al. 2002, −0.1021 + 4.932 D − 0.9551 D² + 0.07934 D³ − 0.002362 D⁴. Units: m/s.
///
/// `diameter_mm` in mm, held at 6; below 0.021 mm the polynomial is negative and 0 is returned.
///
/// Error: 1e-11 m/s against the printed formula; rms 0.033, at most 0.078 m/s.
#[must_use]
pub fn brandes(diameter_mm: f64) -> f64 {
    let d = clamped(diameter_mm, 0.0, 6.0);
    (-0.1021 + d * (4.932 + d * (-0.9551 + d * (0.079_34 - d * 0.002_362)))).max(0.0)
}

/// Atlas, Srivastava & Sekhon 1973, 9.65 − 10.3 e^(−0.6 D). Units: m/s.
///
/// `diameter_mm` in mm, held at 7; below 0.1087 mm the formula is negative and 0 is returned.
///
/// Error: 1e-11 m/s against the printed formula; rms 0.082, at most 0.163 m/s.
#[must_use]
pub fn atlas(diameter_mm: f64) -> f64 {
    let d = clamped(diameter_mm, 0.0, LARGEST_MM);
    (9.65 - 10.3 * ops::exp(-0.6 * d)).max(0.0)
}

/// Best 1950, 9.32 (1 − e^(−(D/1.77)^1.147)). Units: m/s.
///
/// `diameter_mm` in mm, held at 7.
///
/// Error: 1e-11 m/s against the printed formula; rms 0.187, at most 0.255 m/s.
#[must_use]
pub fn best(diameter_mm: f64) -> f64 {
    let d = clamped(diameter_mm, 0.0, LARGEST_MM);
    -9.32 * ops::exp_m1(-ops::pow(d / 1.77, 1.147))
}

/// Weber et al. 2016, 200 √r with the radius r = D/2 in m. Units: m/s.
///
/// `diameter_mm` in mm, held at 7.
///
/// Error: 1e-11 m/s against the printed formula; rms 0.683, at most 1.600 m/s: it misses by 16 % (rms) and is kept to
/// show by how much.
#[must_use]
pub fn weber(diameter_mm: f64) -> f64 {
    let d = clamped(diameter_mm, 0.0, LARGEST_MM);
    200.0 * ops::sqrt(d / 2000.0)
}

/// Atlas & Ulbrich 1977, 3.78 D^0.67. Units: m/s.
///
/// `diameter_mm` in mm, held at 7. For algebra with power laws.
///
/// Error: 1e-11 m/s against the printed formula; rms 1.212, at most 3.104 m/s.
#[must_use]
pub fn atlas_ulbrich(diameter_mm: f64) -> f64 {
    let d = clamped(diameter_mm, 0.0, LARGEST_MM);
    3.78 * ops::pow(d, 0.67)
}

/// Yoshida's drag law, C_D = 24/Re up to Re = 1 and (0.55 + 4.8/√Re)² above, solved in closed form. Units: m/s.
///
/// v = ((−B + √(B² + 2.2 K))/1.1)² with K = √(4 g D Δρ/(3 ρ)), B = 4.8 √(µ/(ρ D)). `diameter_mm` in mm, held at 7.
/// The source iterates; the fixed point is the same. Where both branches hold (Re near 1) the slower is taken.
///
/// Error: 1e-9 relative against the source's iteration; −4 to +1 % of the measurements from 1 to 2 mm, +29 % at 5 mm:
/// drops flatten, its spheres do not.
#[must_use]
pub fn yoshida(diameter_mm: f64) -> f64 {
    let d = clamped(diameter_mm, 0.0, LARGEST_MM) * 1e-3;
    if d <= 0.0 {
        return 0.0;
    }
    let excess = WATER_DENSITY - AIR_DENSITY;
    let viscosity = air_viscosity_pa_s(20.0);
    let creeping = GRAVITY * d * d * excess / (18.0 * viscosity);
    if creeping * d * AIR_DENSITY <= viscosity {
        return creeping;
    }
    let k = ops::sqrt(4.0 * GRAVITY * d * excess / (3.0 * AIR_DENSITY));
    let b = 4.8 * ops::sqrt(viscosity / (AIR_DENSITY * d));
    // (−B + √(B² + 2.2 K))/1.1 without the cancellation of large B.
    let root = 2.0 * k / (b + ops::sqrt(b * b + 2.2 * k));
    root * root
}

/// Stokes' law as Nguyenova 2021 (eq. 3.3) prints it for rain, (2/9) r² Δρ g/µ. Units: m/s.
///
/// `diameter_mm` in mm, held at 7.
///
/// Error: 1e-15 relative against the printed formula; right only below about 0.08 mm: 30 m/s at 1 mm, where drops fall
/// at 4.03 m/s.
#[must_use]
pub fn stokes(diameter_mm: f64) -> f64 {
    let d = clamped(diameter_mm, 0.0, LARGEST_MM) * 1e-3;
    GRAVITY * d * d * (WATER_DENSITY - AIR_DENSITY) / (18.0 * air_viscosity_pa_s(20.0))
}
