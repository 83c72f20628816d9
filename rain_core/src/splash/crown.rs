//! The crown that a splash throws up, and the crater that a drop leaves in deep water.

use super::numbers::{FASTEST_M_S, LARGEST_MM, impact_energy_j};
use super::threshold::splash_excess;
use crate::constants::{GRAVITY, WATER_DENSITY, WATER_SURFACE_TENSION};
use crate::error::{clamped, clamped_f32};
use crate::ops;

/// Thinnest and thickest film, in diameters, that the crown's law is used for.
const FILM_SHARES: (f64, f64) = (0.02, 2.0);
/// Largest radius of a crown, in drop diameters: the law of √t has no end of its own.
const LARGEST_CROWN: f64 = 4.0;
/// Shortest and longest life of a crown. Units: s.
const LIVES_S: (f64, f64) = (0.010, 0.020);
/// Height of a crown in diameters per root of the excess over the threshold, and its largest.
const HEIGHTS: (f64, f64) = (0.6, 2.5);

/// Radius of the crown `time_s` after the impact, D (2/(3δ))^¼ √(v t/D), δ = film over diameter. Units: m.
///
/// `diameter_mm` held in [0, 100] mm, `speed_m_s` in [0, 1000], δ in [0.02, 2] (the source's is a thin-film law; dry
/// ground counts as 0.02), `time_s` in [0, 1e6]; what is not a number counts as 0. At most 4 diameters, a choice.
/// Source: Yarin & Weiss 1995.
///
/// Error: 1e-15 relative; measured crowns scatter by 10 to 20 %.
#[must_use]
pub fn crown_radius_m(diameter_mm: f64, speed_m_s: f64, film_mm: f64, time_s: f64) -> f64 {
    let d = clamped(diameter_mm, 0.0, LARGEST_MM) * 1e-3;
    let delta = film_share(d * 1e3, film_mm);
    let way = clamped(speed_m_s, 0.0, FASTEST_M_S) * clamped(time_s, 0.0, 1e6);
    // D √(v t/D) is √(D v t), also without a drop.
    let radius = ops::sqrt(ops::sqrt(2.0 / (3.0 * delta))) * ops::sqrt(d * way);
    radius.min(LARGEST_CROWN * d)
}

/// [`crown_radius_m`] in single precision.
///
/// Error: 4e-7 relative.
#[must_use]
pub fn crown_radius_m_f32(diameter_mm: f32, speed_m_s: f32, film_mm: f32, time_s: f32) -> f32 {
    let d = clamped_f32(diameter_mm, 0.0, LARGEST_MM as f32) * 1e-3;
    let film = clamped_f32(film_mm, 0.0, 1e6) * 1e-3;
    let delta = clamped_f32(film / d.max(1e-12), FILM_SHARES.0 as f32, FILM_SHARES.1 as f32);
    let way = clamped_f32(speed_m_s, 0.0, FASTEST_M_S as f32) * clamped_f32(time_s, 0.0, 1e6);
    ((2.0 / (3.0 * delta)).sqrt().sqrt() * (d * way).sqrt()).min(LARGEST_CROWN as f32 * d)
}

/// How long a crown stands, √(ρ D³/σ) held in [10, 20] ms. Units: s.
///
/// `diameter_mm` held in [0, 100], what is not a number counts as 0. Source: the capillary time of a drop; a choice.
///
/// Error: 1e-15 relative; a choice.
#[must_use]
pub fn crown_life_s(diameter_mm: f64) -> f64 {
    let d = clamped(diameter_mm, 0.0, LARGEST_MM) * 1e-3;
    ops::sqrt(WATER_DENSITY * d * d * d / WATER_SURFACE_TENSION).clamp(LIVES_S.0, LIVES_S.1)
}

/// How much of a crown is left: 1 in the first half of its life, then smoothly to 0. Units: none, [0, 1].
///
/// `time_s` in s; before the impact and for what is not a number 0. Source: choice.
///
/// Error: 2e-15; a look.
#[must_use]
pub fn crown_opacity(diameter_mm: f64, time_s: f64) -> f64 {
    if time_s.is_nan() || time_s < 0.0 {
        return 0.0;
    }
    let t = (2.0 * time_s / crown_life_s(diameter_mm) - 1.0).clamp(0.0, 1.0);
    1.0 - t * t * (3.0 - 2.0 * t)
}

/// How long a crown has been seen during the exposure that ends `age_s` after the impact: ∫ [`crown_opacity`] dt. Units: s.
///
/// `diameter_mm` as [`crown_life_s`], `age_s` and `exposure_s` in s, held in [0, 1e6]; before the impact 0. Exposures add
/// up: two halves see what a whole one does. Source: closed form of the fading.
///
/// Error: 1e-16 s and 2e-15 of the life; a look.
#[must_use]
pub fn crown_seen_s(diameter_mm: f64, age_s: f64, exposure_s: f64) -> f64 {
    let half = 0.5 * crown_life_s(diameter_mm);
    let seen_since_impact = |time_s: f64| {
        let time = clamped(time_s, 0.0, 1e6);
        let fading = (time / half - 1.0).clamp(0.0, 1.0);
        time.min(half) + half * fading * (1.0 - fading * fading * (1.0 - 0.5 * fading))
    };
    seen_since_impact(age_s) - seen_since_impact(age_s - clamped(exposure_s, 0.0, 1e6))
}

/// Height of the crown's rim `time_s` after the impact: a parabola over its life. Units: m.
///
/// Its peak is D · min(2.5, 0.6 √(excess − 1)), excess as [`splash_excess`]; 0 below the threshold and outside its
/// life. Arguments as [`crown_radius_m`]. Source: choice: 1 mm drops 0.6 mm, 4 mm drops 9 mm on dry ground.
///
/// Error: 5e-15 of the diameter, up to 5e-8 just above the threshold, where the height rises as a root; a choice.
#[must_use]
pub fn crown_height_m(diameter_mm: f64, speed_m_s: f64, film_mm: f64, time_s: f64) -> f64 {
    let d = clamped(diameter_mm, 0.0, LARGEST_MM) * 1e-3;
    let excess = (splash_excess(diameter_mm, speed_m_s, film_mm) - 1.0).max(0.0);
    let peak = d * (HEIGHTS.0 * ops::sqrt(excess)).min(HEIGHTS.1);
    let t = clamped(time_s, 0.0, 1e6) / crown_life_s(diameter_mm);
    peak * (4.0 * t * (1.0 - t)).max(0.0)
}

/// Radius of the crater in deep water, (4 E_k/(π ρ g))^¼, with the share `energy_share` of the drop's energy in it.
/// Units: m.
///
/// `diameter_mm` and `speed_m_s` as [`crown_radius_m`], `energy_share` held in [0, 1] (1: all of it; Engel 1966 and
/// Pumphrey & Elmore 1990 find less). Source: Engel 1966.
///
/// Error: 1e-15 relative; 1e-6 against the work of digging it.
#[must_use]
pub fn crater_radius_m(diameter_mm: f64, speed_m_s: f64, energy_share: f64) -> f64 {
    let energy = impact_energy_j(diameter_mm, speed_m_s) * clamped(energy_share, 0.0, 1.0);
    ops::sqrt(ops::sqrt(
        4.0 * energy / (core::f64::consts::PI * WATER_DENSITY * GRAVITY),
    ))
}

/// Film over diameter within the law's range.
fn film_share(diameter_mm: f64, film_mm: f64) -> f64 {
    clamped(
        clamped(film_mm, 0.0, 1e6) / diameter_mm.max(1e-9),
        FILM_SHARES.0,
        FILM_SHARES.1,
    )
}
