//! The speed at which a tyre floats on standing water, and its grip below.

use super::tyre::Tyre;
use crate::error::clamped;
use crate::ops;

/// km/h per root of kPa. Source: 9 knots per root of psi, Horne & Dreher 1963 (6.348 from knots, 6.344 from mph).
const HORNE: f64 = 6.35;
/// Pressures that count. Units: kPa.
const PRESSURES_KPA: (f64, f64) = (10.0, 2000.0);
/// kPa in a psi, km/h in a mph, mm in an inch.
const KPA_PER_PSI: f64 = 6.894_757_293_168;
const KM_H_PER_MPH: f64 = 1.609_344;
const MM_PER_INCH: f64 = 25.4;
/// Share of the hydroplaning speed at which grip begins to fall, at which it is least, and what is then left of it.
const GRIP: (f64, f64, f64) = (0.6, 1.1, 0.1);

/// Speed at which a tyre of `pressure_kpa` floats on standing water, 6.35 √p. Units: km/h.
///
/// `pressure_kpa` held in [10, 2000] kPa, what is not a number counts as 10. Source: Horne & Dreher 1963.
///
/// Error: 1e-15 relative, 1e-3 from 9 knots per root of psi; tyres with a good tread float some 10 % later, worn ones
/// on smooth ground earlier.
#[must_use]
pub fn horne_speed_km_h(pressure_kpa: f64) -> f64 {
    HORNE * ops::sqrt(clamped(pressure_kpa, PRESSURES_KPA.0, PRESSURES_KPA.1))
}

/// What Gallaway's formula depends on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GallawayCase {
    /// Spin-down of the wheel: how much slower it turns than it rolls. Units: %. Domain: [0.1, 100]. Usual: 10.
    pub spin_down_percent: f64,
    /// Inflation pressure. Units: kPa. Domain: [10, 2000].
    pub pressure_kpa: f64,
    /// Tread depth. Units: mm. Domain: [0, 50].
    pub tread_mm: f64,
    /// Water above the texture. Units: mm. Domain: [0.1, 100].
    pub water_mm: f64,
    /// Mean texture depth of the pavement. Units: mm. Domain: [0, 10].
    pub texture_mm: f64,
}

/// Speed at which a tyre floats, v = SD^0.04 P^0.3 (TD + 1)^0.06 A (mph), P in psi, TD in 1/32 inch,
/// A = max(10.409 WD^(−0.06) + 3.507, (28.952 WD^(−0.06) − 7.817) MTD^0.14), WD and MTD in inches. Units: km/h.
///
/// Values outside their domains are held there, what is not a number counts as the lower end. Source: Gallaway et al.
/// 1979.
///
/// Error: 1e-15 relative; a fit for passenger tyres at 165 to 250 kPa on 0.5 to 10 mm of water.
#[must_use]
pub fn gallaway_speed_km_h(case: &GallawayCase) -> f64 {
    let spin = clamped(case.spin_down_percent, 0.1, 100.0);
    let psi = clamped(case.pressure_kpa, PRESSURES_KPA.0, PRESSURES_KPA.1) / KPA_PER_PSI;
    let tread = clamped(case.tread_mm, 0.0, 50.0) / MM_PER_INCH * 32.0;
    let water = ops::pow(clamped(case.water_mm, 0.1, 100.0) / MM_PER_INCH, -0.06);
    let texture = ops::pow(clamped(case.texture_mm, 0.0, 10.0) / MM_PER_INCH, 0.14);
    let a = (10.409 * water + 3.507).max((28.952 * water - 7.817) * texture);
    ops::pow(spin, 0.04) * ops::pow(psi, 0.3) * ops::pow(tread + 1.0, 0.06) * a * KM_H_PER_MPH
}

/// Share of the wet road's grip that is left at a share of the hydroplaning speed: 1 up to 0.6, smoothly down to 0.1 at
/// 1.1. Units: none.
///
/// `speed_ratio` = v/v_p; negative counts as its magnitude, what is not a number as 0. Source: choice.
///
/// Error: 1e-15; a choice, real grip depends on rubber and ground.
#[must_use]
pub fn grip_share(speed_ratio: f64) -> f64 {
    let (from, to, least) = GRIP;
    let t = clamped((clamped(speed_ratio.abs(), 0.0, 1e6) - from) / (to - from), 0.0, 1.0);
    1.0 - (1.0 - least) * t * t * (3.0 - 2.0 * t)
}

/// Whether a tyre floats: at or above [`horne_speed_km_h`] on water deeper than its grooves take in.
///
/// `speed_m_s` either way; what is not a number counts as 0. Source: Horne & Dreher 1963 for the speed, the depth a
/// choice ([`Tyre::groove_void_mm`]).
///
/// Error: exact, off the border; the speed itself is a fit ([`horne_speed_km_h`]).
#[must_use]
pub fn hydroplanes(tyre: &Tyre, speed_m_s: f64, film_mm: f64) -> bool {
    speed_m_s.abs() * 3.6 >= horne_speed_km_h(tyre.pressure_kpa) && film_mm > tyre.groove_void_mm()
}

/// Share of the wet road's grip that a tyre has at `speed_m_s` on a film of `film_mm`. Units: none, [0.1, 1].
///
/// [`grip_share`] where the film is deeper than the grooves take in, untouched below half of that depth, smooth
/// between. A film that is negative or not a number counts as 0, a speed as in [`grip_share`]. Source: choice.
///
/// Error: 2e-15; a choice, real grip depends on rubber and ground.
#[must_use]
pub fn wet_grip(tyre: &Tyre, speed_m_s: f64, film_mm: f64) -> f64 {
    let void = tyre.groove_void_mm().max(1e-3);
    let t = clamped(2.0 * clamped(film_mm, 0.0, 1e6) / void - 1.0, 0.0, 1.0);
    let deep = t * t * (3.0 - 2.0 * t);
    1.0 - deep * (1.0 - grip_share(speed_m_s * 3.6 / horne_speed_km_h(tyre.pressure_kpa)))
}
