//! The drops under one drip place in closed form: no drop is stored.
//!
//! A drop of terminal speed v starts at rest and falls against quadratic drag ([`Fall::quadratic`]): after t it has
//! fallen (v²/g) ln cosh(g t/v), and d below the leaf it has been falling for t(d) = (v/g) arcosh(e^(g d/v²)).

use crate::ops;
use crate::rainfall::{Fall, fall_f32, quadratic_fall_time_f32};

/// Shortest period that is looked at: a jet, no drops, and numbers of drops in the air stay finite. Units: s.
const SHORTEST_PERIOD_S: f64 = 1e-6;

/// Time to fall `distance_m` from rest, t(d) = (v/g) arcosh(e^(g d/v²)): [`Fall::quadratic`]'s. Units: s.
///
/// `distance_m` in m, held in [0, 1e6]; `terminal_m_s` in m/s, held in [1e-6, 1e3]; what is not a number counts as the
/// lower end. Source: Weber et al. 2016, eqs. 7 and 19, with any terminal speed.
///
/// Error: 1e-15 relative; quadratic drag is up to 4 % of the terminal speed off for 1 mm drops, 1.6 % for 5 mm.
#[must_use]
pub fn drip_fall_time_s(distance_m: f64, terminal_m_s: f64) -> f64 {
    Fall::quadratic_held(terminal_m_s).time_to_fall_s(distance_m, 0.0)
}

/// Distance fallen after `time_s` from rest, (v²/g) ln cosh(g t/v): [`Fall::quadratic`]'s. Units: m.
///
/// Domains as [`drip_fall_time_s`], `time_s` in s, held in [0, 1e6]. Source: Weber et al. 2016, eq. 18.
///
/// Error: 1e-15 relative, 1e-10 against the integrated fall; back from [`drip_fall_time_s`] 1e-13.
#[must_use]
pub fn drip_distance_m(time_s: f64, terminal_m_s: f64) -> f64 {
    Fall::quadratic_held(terminal_m_s).distance_m(time_s, 0.0)
}

/// [`drip_fall_time_s`] in single precision.
///
/// Error: 4e-7 relative.
#[must_use]
pub fn drip_fall_time_s_f32(distance_m: f32, terminal_m_s: f32) -> f32 {
    quadratic_fall_time_f32(terminal_m_s, distance_m)
}

/// [`drip_distance_m`] in single precision: [`fall_f32`]'s.
///
/// Error: 2e-6 relative.
#[must_use]
pub fn drip_distance_m_f32(time_s: f32, terminal_m_s: f32) -> f32 {
    fall_f32(terminal_m_s, 1.0, time_s, 0.0)[1]
}

/// The source's distribution function with its sign corrected: cos(2π (N − t(d)/T)), whose crests are the drops.
///
/// `released` N = drops let go so far, whole and fraction (only the fraction matters); `period_s` T in s. Units: none,
/// [−1, 1]. Without a period, or with numbers that are not finite, −1: no drop anywhere.
/// Source: Weber et al. 2016, eqs. 6 and 25.
///
/// Error: 1e-7 at 10 000 drops.
#[must_use]
pub fn drip_crest(distance_m: f64, period_s: f64, released: f64, terminal_m_s: f64) -> f64 {
    let periods = drip_fall_time_s(distance_m, terminal_m_s) / period_s;
    let turns = released - periods;
    if period_s > 0.0 && turns.is_finite() {
        ops::cos(core::f64::consts::TAU * (turns - turns.floor()))
    } else {
        -1.0
    }
}

/// A drop in the air under a drip place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drip {
    /// Which one: 0 is the newest.
    pub index: u64,
    /// Time since it let go. Units: s.
    pub age_s: f64,
    /// How far it has fallen. Units: m.
    pub distance_m: f64,
}

/// The drop that is nearest, in time, to the point `distance_m` below the leaf.
///
/// `phase`: fraction of the next drop that has gathered, [0, 1); `period_s`: seconds between drops, shorter ones count
/// as 1e-6; `terminal_m_s` as [`drip_fall_time_s`]. None without a finite period above 0 or with a phase that is not
/// finite. Whether the drop is still in the air is for the caller to tell from `distance_m` and the place's height.
/// Source: Weber et al. 2016, eqs. 8 and 9, with time put in (as printed the drop stands still).
/// Error: index exact, age 1e-15 and distance 2e-15 relative against a search among the drops; model as
/// [`drip_fall_time_s`].
#[must_use]
pub fn nearest_drip(distance_m: f64, period_s: f64, phase: f64, terminal_m_s: f64) -> Option<Drip> {
    if !(period_s > 0.0 && period_s.is_finite() && phase.is_finite()) {
        return None;
    }
    let period_s = period_s.max(SHORTEST_PERIOD_S);
    let phase = phase - phase.floor();
    let index = (drip_fall_time_s(distance_m, terminal_m_s) / period_s - phase + 0.5)
        .floor()
        .max(0.0);
    let age_s = (index + phase) * period_s;
    Some(Drip {
        index: index as u64,
        age_s,
        distance_m: drip_distance_m(age_s, terminal_m_s),
    })
}

/// [`Drip`] in single precision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DripF32 {
    /// Which one: 0 is the newest.
    pub index: u32,
    /// Time since it let go. Units: s.
    pub age_s: f32,
    /// How far it has fallen. Units: m.
    pub distance_m: f32,
}

/// [`nearest_drip`] in single precision.
///
/// Error: 2e-5 m down to 12 m below the leaf, where both choose the same drop (all but one in 240).
#[must_use]
pub fn nearest_drip_f32(distance_m: f32, period_s: f32, phase: f32, terminal_m_s: f32) -> Option<DripF32> {
    if !(period_s > 0.0 && period_s.is_finite() && phase.is_finite()) {
        return None;
    }
    let period_s = period_s.max(SHORTEST_PERIOD_S as f32);
    let phase = phase - phase.floor();
    let index = (drip_fall_time_s_f32(distance_m, terminal_m_s) / period_s - phase + 0.5)
        .floor()
        .max(0.0);
    let age_s = (index + phase) * period_s;
    Some(DripF32 {
        index: index as u32,
        age_s,
        distance_m: drip_distance_m_f32(age_s, terminal_m_s),
    })
}
