//! How a falling drop follows the wind.
//!
//! Near its terminal speed a drop's velocity relative to the air relaxes with the time constant v_t/g, so
//! du/dt = (g/v_t)(U − u). For a wind that is constant or linear in time both u and its path are closed forms.
//!
//! # Accuracy
//! The drag is linearised about the terminal speed: exact for winds that differ little from the drop's own velocity. A
//! horizontal difference as large as v_t pulls 1.4 times as hard (quadratic drag), so such drops follow faster; up- and
//! downdraughts act 1 + c times faster ([`super::Fall`]). Uniform wind in space.

use glam::DVec3;

use crate::constants::GRAVITY;
use crate::ops;

/// Angle of a drop's path from the vertical in a steady wind, atan(U/v_t). Units: rad, in [0, π/2].
///
/// `wind_m_s`: horizontal speed of the air, m/s ≥ 0; `terminal_m_s`: m/s ≥ 0. The sign of both is ignored; 0 where both
/// are 0 or one is NaN.
///
/// Error: 1e-15 relative.
#[must_use]
pub fn slant_rad(wind_m_s: f64, terminal_m_s: f64) -> f64 {
    let angle = ops::atan2(wind_m_s.abs(), terminal_m_s.abs());
    if angle.is_nan() { 0.0 } else { angle }
}

/// Time constant of a drop's answer to the wind, v_t/g. Units: s.
///
/// `terminal_m_s`: m/s, in [0, 1000]; clamped, NaN counts as 0.
///
/// Error: exact, one division; the law is linear, see the module.
#[must_use]
pub fn response_time_s(terminal_m_s: f64) -> f64 {
    positive(terminal_m_s).min(1e3) / GRAVITY
}

/// Amplitude of a drop's horizontal speed over that of a wind that swings at `frequency_hz`: 1/√(1 + (2πf v_t/g)²).
///
/// `frequency_hz`: Hz ≥ 0; `terminal_m_s` as in [`response_time_s`]; NaN counts as 0. Units: none, in (0, 1].
///
/// Error: 1e-15 relative, 1e-6 against integration.
#[must_use]
pub fn gust_gain(frequency_hz: f64, terminal_m_s: f64) -> f64 {
    let x = core::f64::consts::TAU * positive(frequency_hz).min(1e9) * response_time_s(terminal_m_s);
    1.0 / ops::sqrt(1.0 + x * x)
}

fn positive(x: f64) -> f64 {
    if x > 0.0 { x } else { 0.0 }
}

/// A drop's (or a whole size class's) velocity and path in the wind, without its fall.
///
/// Error: 1e-13 of the largest speed (velocity) and of speed × time (path) against the integrated law; cutting an
/// interval changes nothing beyond that.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WindResponse {
    /// Of the drop, from the wind alone. Units: m/s.
    pub velocity_m_s: DVec3,
    /// ∫ velocity dt. Units: m.
    pub path_m: DVec3,
}

impl WindResponse {
    /// A drop that already moves with the wind.
    #[must_use]
    pub fn following(wind_m_s: DVec3) -> Self {
        Self {
            velocity_m_s: wind_m_s,
            path_m: DVec3::ZERO,
        }
    }

    /// Advances by `dt_s` in a wind that goes linearly from `start_m_s` to `end_m_s`.
    ///
    /// `terminal_m_s`: of the drop, m/s ≥ 0; 0 follows at once. A `dt_s` that is not positive and finite changes
    /// nothing, nor do winds that are not finite. Allocates nothing.
    pub fn advance(&mut self, terminal_m_s: f64, start_m_s: DVec3, end_m_s: DVec3, dt_s: f64) {
        if !(dt_s > 0.0 && dt_s.is_finite() && start_m_s.is_finite() && end_m_s.is_finite()) {
            return;
        }
        let weights = Weights::of(dt_s, response_time_s(terminal_m_s));
        let (own, change) = (self.velocity_m_s, end_m_s - start_m_s);
        self.velocity_m_s = own * weights.keep + start_m_s * (1.0 - weights.keep) + change * (1.0 - weights.mean);
        self.path_m += (own * weights.mean + start_m_s * (1.0 - weights.mean) + change * weights.lagged_half) * dt_s;
    }

    /// Advances by `dt_s` in a constant wind.
    pub fn advance_constant(&mut self, terminal_m_s: f64, wind_m_s: DVec3, dt_s: f64) {
        self.advance(terminal_m_s, wind_m_s, wind_m_s, dt_s);
    }
}

/// Shares of the old velocity and of the wind, with x = dt/time constant.
struct Weights {
    /// e^(−x).
    keep: f64,
    /// (1 − e^(−x))/x: mean of `keep` over the step.
    mean: f64,
    /// ½ − (1 − mean)/x: mean over the step of the answer to a wind that grows from 0 to 1.
    lagged_half: f64,
}

impl Weights {
    fn of(dt: f64, time_constant: f64) -> Self {
        let x = dt / time_constant;
        if x.is_infinite() {
            return Self {
                keep: 0.0,
                mean: 0.0,
                lagged_half: 0.5,
            };
        }
        let lost = -ops::exp_m1(-x);
        let mean = if x > 0.0 { lost / x } else { 1.0 };
        let lagged_half = if x < 0.05 {
            // x/6 − x²/24 + x³/120 − …: the closed form cancels.
            x * (1.0 / 6.0
                - x * (1.0 / 24.0 - x * (1.0 / 120.0 - x * (1.0 / 720.0 - x * (1.0 / 5040.0 - x / 40320.0)))))
        } else {
            0.5 - (1.0 - mean) / x
        };
        Self {
            keep: 1.0 - lost,
            mean,
            lagged_half,
        }
    }
}

/// One component of a drop's velocity after `dt_s` in a constant wind, exact, in single precision:
/// u + (U − u)(1 − e^(−dt/T)). Units: m/s.
///
/// `response_time_s`: T = v_t/g, s; 0 or less follows at once. `dt_s`: s; not positive or NaN changes nothing.
///
/// Error: 3e-7 of the larger speed against the double form.
#[must_use]
#[inline]
pub fn relax_f32(velocity_m_s: f32, wind_m_s: f32, response_time_s: f32, dt_s: f32) -> f32 {
    if dt_s.is_nan() || dt_s <= 0.0 {
        return velocity_m_s;
    }
    if response_time_s.is_nan() || response_time_s <= 0.0 {
        return wind_m_s;
    }
    velocity_m_s + (wind_m_s - velocity_m_s) * -ops::exp_m1f(-dt_s / response_time_s)
}
