//! Spray slowed by the air, with quadratic drag in closed form.

use crate::constants::GRAVITY;
use crate::error::clamped;
use crate::ops;
use crate::rainfall::terminal_velocity;

/// Smallest drop that counts: below, the fall speed's fit and quadratic drag both fail. Units: mm.
const SMALLEST_MM: f64 = 0.05;
/// Largest drop that counts. Units: mm.
const LARGEST_MM: f64 = 100.0;

/// v_t²/g: the way over which a fast drop loses 63 % of its speed through the air. Units: m.
fn stopping_way(diameter_mm: f64) -> f64 {
    let v = terminal_velocity(clamped(diameter_mm, SMALLEST_MM, LARGEST_MM));
    v * v / GRAVITY
}

/// Time in which a drop of spray takes up the air's motion: v_t/g up to its terminal speed, v_t²/(g u) above. Units: s.
///
/// `diameter_mm` held in [0.05, 100] mm; `relative_speed_m_s` u through the air, m/s, either sign; what is not a number
/// counts as the lower end. Source: quadratic drag that balances gravity at v_t.
///
/// Error: 3e-15 relative; drops below 0.5 mm feel Stokes' drag too and stop up to a third sooner.
#[must_use]
pub fn spray_relaxation_s(diameter_mm: f64, relative_speed_m_s: f64) -> f64 {
    let v = terminal_velocity(clamped(diameter_mm, SMALLEST_MM, LARGEST_MM));
    v / GRAVITY * (v / clamped(relative_speed_m_s.abs(), v, 1e4))
}

/// Speed through the air after `time_s`, u₀/(1 + g u₀ t/v_t²). Units: m/s.
///
/// `start_m_s` u₀ held in [0, 1e4] m/s, `time_s` in [0, 1e9] s; what is not a number counts as 0. Gravity left out: add
/// the fall. Source: du/dt = −g u²/v_t².
///
/// Error: 3e-15 relative against the law's solution, 1e-13 against its integration.
#[must_use]
pub fn spray_relative_speed_m_s(diameter_mm: f64, start_m_s: f64, time_s: f64) -> f64 {
    let start = clamped(start_m_s, 0.0, 1e4);
    start / (1.0 + start * clamped(time_s, 0.0, 1e9) / stopping_way(diameter_mm))
}

/// Way through the air in `time_s`, (v_t²/g) ln(1 + g u₀ t/v_t²). Units: m.
///
/// Arguments and source as [`spray_relative_speed_m_s`].
///
/// Error: 3e-15 relative against the law's solution, 1e-13 against its integration.
#[must_use]
pub fn spray_reach_m(diameter_mm: f64, start_m_s: f64, time_s: f64) -> f64 {
    let way = stopping_way(diameter_mm);
    way * ops::ln_1p(clamped(start_m_s, 0.0, 1e4) * clamped(time_s, 0.0, 1e9) / way)
}
