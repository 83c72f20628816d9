//! Fall of a drop from any speed to its terminal speed, in closed form.
//!
//! With u = v/v_t and τ = g t/v_t the drag law is du/dτ = (1 − u)(1 + c u). c = 1 is quadratic drag; c below 1 has a
//! Stokes part (small drops), c above 1 stiffens as the drop flattens (large drops).
//!
//! # Accuracy
//! One number c per diameter stands for a drag coefficient that changes with speed: at most 0.5 % of v_t against the
//! integration with Clift & Gauvin's drag between 0.5 and 5 mm. That integration itself guesses how a drop flattens
//! with speed: ± 2–3 % of v_t for drops of 4–5 mm after some metres. Still air, no added mass (ρ_a/ρ_w = 1e-3).

use super::terminal_velocity::terminal_velocity;
use crate::constants::GRAVITY;
use crate::error::{ConfigError, clamped, clamped_f32, in_range};
use crate::ops;

/// Longest time that is looked at; later ones count as this. Units: s.
pub const MAX_FALL_TIME_S: f64 = 1e6;
/// Highest fall that is looked at; higher ones count as this. Units: m.
pub const MAX_FALL_HEIGHT_M: f64 = 1e6;
/// Least and largest terminal speed. Units: m/s.
const SPEEDS_M_S: [f64; 2] = [1e-6, 1e3];
/// Highest initial speed, in terminal speeds; faster ones count as this. Units: none.
const MAX_INITIAL_RATIO: f64 = 1e6;

/// The c of the drag law for a drop: clamp(0.397 + 0.2141 D − 0.0125 D², 0.3, 1.25).
///
/// `diameter_mm`: mm, clamped to [0, 8.564], where the parabola has its top; NaN counts as 0. Units: none.
/// Fitted to the integration with the drag of Clift & Gauvin 1970 between 0.5 and 5 mm.
///
/// Error: 1e-15 relative; what it does to the speed is said at [`Fall`].
#[must_use]
pub fn drag_stiffness(diameter_mm: f64) -> f64 {
    let d = if diameter_mm > 0.0 { diameter_mm.min(8.564) } else { 0.0 };
    (0.397 + 0.2141 * d - 0.0125 * d * d).clamp(0.3, 1.25)
}

/// Speed and way of a drop at one moment of its fall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FallState {
    /// Downward. Units: m/s.
    pub speed_m_s: f64,
    /// Fallen since the start. Units: m.
    pub distance_m: f64,
}

/// How one drop falls: its terminal speed and the stiffness c of its drag.
///
/// All initial speeds are ≥ 0 and may exceed the terminal speed; NaN and negative ones count as 0. Times and heights:
/// NaN and negative ones count as 0, those beyond 1e6 (s, m) as 1e6.
///
/// Error: `speed_m_s`, `distance_m`, `speed_after_m_s`, `time_to_fall_s`, `distance_to_share_m` at most 1e-11 relative
/// against the integrated drag law. Against the integration with Clift & Gauvin's drag at most 0.5 % of v_t (c = 1: 4.4
/// %); see the module.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fall {
    terminal_m_s: f64,
    stiffness: f64,
}

impl Fall {
    /// A drop with this terminal speed (m/s, in [1e-6, 1000]) and stiffness c (none, in [0.01, 10]).
    ///
    /// # Errors
    /// When a value is not finite or outside its range.
    pub fn new(terminal_m_s: f64, stiffness: f64) -> Result<Self, ConfigError> {
        Ok(Self {
            terminal_m_s: in_range(
                "terminal_m_s",
                terminal_m_s,
                SPEEDS_M_S[0],
                SPEEDS_M_S[1],
                "1e-6 to 1000 m/s",
            )?,
            stiffness: in_range("stiffness", stiffness, 0.01, 10.0, "0.01 to 10")?,
        })
    }

    /// A raindrop of this diameter (mm, in [0.001, 10]) in still air at sea level: [`terminal_velocity`] and
    /// [`drag_stiffness`].
    ///
    /// # Errors
    /// When the diameter is not finite or outside its range.
    pub fn of_drop(diameter_mm: f64) -> Result<Self, ConfigError> {
        let d = in_range("diameter_mm", diameter_mm, 1e-3, 10.0, "0.001 to 10 mm")?;
        Self::new(terminal_velocity(d), drag_stiffness(d))
    }

    /// Quadratic drag, c = 1, the form of most particle systems: a terminal speed (m/s, in [1e-6, 1000]) is all it
    /// needs.
    ///
    /// # Errors
    /// When the speed is not finite or outside its range.
    pub fn quadratic(terminal_m_s: f64) -> Result<Self, ConfigError> {
        Self::new(terminal_m_s, 1.0)
    }

    /// [`Fall::quadratic`] for evaluators that must always answer: the speed is held in its range, NaN counts as its lower
    /// end.
    pub(crate) fn quadratic_held(terminal_m_s: f64) -> Self {
        Self {
            terminal_m_s: clamped(terminal_m_s, SPEEDS_M_S[0], SPEEDS_M_S[1]),
            stiffness: 1.0,
        }
    }

    /// Units: m/s.
    #[must_use]
    pub fn terminal_m_s(&self) -> f64 {
        self.terminal_m_s
    }

    /// c of the drag law. Units: none.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// Speed and way after `time_s`, from `initial_m_s`.
    #[must_use]
    pub fn at(&self, time_s: f64, initial_m_s: f64) -> FallState {
        let tau = clamped(time_s, 0.0, MAX_FALL_TIME_S) * GRAVITY / self.terminal_m_s;
        let u0 = self.ratio(initial_m_s);
        let [u, z] = motion(self.stiffness, tau, u0);
        FallState {
            speed_m_s: self.terminal_m_s * u,
            distance_m: self.length_m() * z,
        }
    }

    /// Speed after `time_s` from `initial_m_s`. Units: m/s.
    #[must_use]
    pub fn speed_m_s(&self, time_s: f64, initial_m_s: f64) -> f64 {
        self.at(time_s, initial_m_s).speed_m_s
    }

    /// Way fallen after `time_s` from `initial_m_s`. Units: m.
    #[must_use]
    pub fn distance_m(&self, time_s: f64, initial_m_s: f64) -> f64 {
        self.at(time_s, initial_m_s).distance_m
    }

    /// Time to fall `height_m` from `initial_m_s`: Halley's rule on the closed z(t), kept inside bounds. Units: s.
    ///
    /// For c = 1 from rest without iteration: t = (v_t/g) arcosh(e^(gz/v_t²)).
    #[must_use]
    pub fn time_to_fall_s(&self, height_m: f64, initial_m_s: f64) -> f64 {
        let z = clamped(height_m, 0.0, MAX_FALL_HEIGHT_M) / self.length_m();
        let u0 = self.ratio(initial_m_s);
        let tau = if self.stiffness == 1.0 && u0 == 0.0 {
            quadratic_time_from_rest(z)
        } else {
            arrival(self.stiffness, z, u0)[0]
        };
        tau * self.terminal_m_s / GRAVITY
    }

    /// Speed after a fall of `height_m` from `initial_m_s`. Units: m/s.
    ///
    /// For c = 1 without iteration: v² = v₀² e^(−2gz/v_t²) + v_t² (1 − e^(−2gz/v_t²)).
    #[must_use]
    pub fn speed_after_m_s(&self, height_m: f64, initial_m_s: f64) -> f64 {
        let z = clamped(height_m, 0.0, MAX_FALL_HEIGHT_M) / self.length_m();
        let u0 = self.ratio(initial_m_s);
        let u = if self.stiffness == 1.0 {
            quadratic_speed_ratio(z, u0)
        } else {
            arrival(self.stiffness, z, u0)[1]
        };
        self.terminal_m_s * u
    }

    /// Fall height from rest at which the drop has `share` of its terminal speed. Units: m.
    ///
    /// `share`: clamped to [0, 1 − 1e-12], NaN counts as 0. Exact: z = −[ln(1−u) + ln(1+cu)/c]/(1+c) · v_t²/g.
    #[must_use]
    pub fn distance_to_share_m(&self, share: f64) -> f64 {
        let u = clamped(share, 0.0, 1.0 - 1e-12);
        let c = self.stiffness;
        // −ln(1−u) − ln(1+cu)/c cancels to (1+c) u²/2 for small u.
        let z = if u * c.max(1.0) < 1e-3 {
            let (c2, u2) = (c * c, u * u);
            u2 / 2.0
                + (1.0 - c) * u2 * u / 3.0
                + (1.0 - c + c2) * u2 * u2 / 4.0
                + (1.0 - c + c2 - c2 * c) * u2 * u2 * u / 5.0
        } else {
            (-ops::ln_1p(-u) - ops::ln_1p(c * u) / c) / (1.0 + c)
        };
        z * self.length_m()
    }

    /// Fall height from rest to 99 % of the terminal speed. Units: m.
    #[must_use]
    pub fn distance_to_99_percent_m(&self) -> f64 {
        self.distance_to_share_m(0.99)
    }

    /// v_t²/g. Units: m.
    fn length_m(&self) -> f64 {
        self.terminal_m_s * self.terminal_m_s / GRAVITY
    }

    fn ratio(&self, initial_m_s: f64) -> f64 {
        clamped(initial_m_s / self.terminal_m_s, 0.0, MAX_INITIAL_RATIO)
    }
}

/// u and z at τ from u₀. Only decaying exponentials and sums of positive terms: nothing overflows or cancels.
fn motion(c: f64, tau: f64, u0: f64) -> [f64; 2] {
    let b = 1.0 + c;
    let passed = -ops::exp_m1(-b * tau);
    let start = b * (1.0 - passed);
    // u = (1 − κE)/(1 + cκE) with κ = (1 − u₀)/(1 + c u₀), both multiplied by 1 + c u₀.
    let gain = passed * (1.0 + c * u0);
    let u = (gain + start * u0) / (gain + start);
    let z = if tau * b < 1.0 {
        // e^(cz) − 1 as a sum in which the leading terms of both exponentials have been taken out.
        let (own, stokes) = (second_remainder(c * tau), second_remainder(-tau));
        let sum = c * tau * (u0 + tau * (c * (1.0 + c * u0) * own + (1.0 - u0) * stokes) / b);
        ops::ln_1p(sum) / c
    } else {
        tau + ops::ln_1p(c * (u0 - 1.0) * passed / b) / c
    };
    [u, z]
}

/// τ at z from rest for c = 1, arcosh(eᶻ) = z + ln(1 + √(1 − e^(−2z))): nothing overflows or cancels.
fn quadratic_time_from_rest(z: f64) -> f64 {
    z + ops::ln_1p(ops::sqrt(-ops::exp_m1(-2.0 * z)))
}

/// u at z for c = 1, without time.
fn quadratic_speed_ratio(z: f64, u0: f64) -> f64 {
    let passed = -ops::exp_m1(-2.0 * z);
    ops::sqrt(u0 * u0 * (1.0 - passed) + passed)
}

/// (eˣ − 1 − x)/x² for |x| ≤ 1.
fn second_remainder(x: f64) -> f64 {
    // Taylor: the last factor is 1/20 of 1/19!, below 1e-18.
    (3..=19).rev().fold(1.0, |sum, k| 1.0 + x / f64::from(k) * sum) / 2.0
}

/// τ with z(τ) = z, and u there.
fn arrival(c: f64, z: f64, u0: f64) -> [f64; 2] {
    if z <= 0.0 {
        return [0.0, u0];
    }
    // u lies between u₀ and 1: so does z/τ.
    let latest = z + ops::ln_1p(c) / c;
    let (mut low, mut high) = (z / u0.max(1.0), if u0 >= 1.0 { z } else { latest.min(z / u0) });
    let mut tau = (2.0 * z / (u0 + quadratic_speed_ratio(z, u0))).clamp(low, high);
    // Halley's rule, whose second derivative is the drag law itself; the bounds guard its first steps.
    for _ in 0..60 {
        let [u, way] = motion(c, tau, u0);
        let excess = way - z;
        if excess > 0.0 {
            high = tau;
        } else {
            low = tau;
        }
        let bend = (1.0 - u) * (1.0 + c * u);
        let next = (tau - 2.0 * excess * u / (2.0 * u * u - excess * bend)).clamp(low, high);
        // The rule cubes its error: another step would change nothing.
        if (next - tau).abs() <= 1e-5 * tau {
            return [next, motion(c, next, u0)[0]];
        }
        tau = next;
    }
    [tau, motion(c, tau, u0)[0]]
}

/// Speed (m/s) and way (m) after `time_s` in single precision, for a drop with terminal speed `terminal_m_s` (m/s, at
/// least 1e-6) and stiffness `stiffness` (none, in [0.01, 10]) that starts at `initial_m_s`.
///
/// Times in [0, 1e6] s, initial speeds up to 1000 v_t; clamps as at [`Fall`]; parameters outside their range, or NaN,
/// count as the nearest bound.
///
/// Error: 2e-6 relative, of the speed and of the way, against [`Fall::at`].
#[must_use]
#[inline]
pub fn fall_f32(terminal_m_s: f32, stiffness: f32, time_s: f32, initial_m_s: f32) -> [f32; 2] {
    let v = clamped_f32(terminal_m_s, 1e-6, 1e3);
    let c = clamped_f32(stiffness, 0.01, 10.0);
    let tau = clamped_f32(time_s, 0.0, 1e6) * GRAVITY as f32 / v;
    let u0 = clamped_f32(initial_m_s / v, 0.0, 1e3);
    let b = 1.0 + c;
    let passed = -ops::exp_m1f(-b * tau);
    let start = b * (1.0 - passed);
    let speed = (passed * (1.0 + c * u0) + start * u0) / (passed * (1.0 + c * u0) + start);
    let way = if tau * b < 1.0 {
        let remainder = |x: f32| (3..=10_u8).rev().fold(1.0, |sum, k| 1.0 + x / f32::from(k) * sum) * 0.5;
        let sum =
            c * tau * u0 + c * tau * tau * (c * (1.0 + c * u0) * remainder(c * tau) + (1.0 - u0) * remainder(-tau)) / b;
        ops::ln_1pf(sum) / c
    } else {
        tau + ops::ln_1pf(c * (u0 - 1.0) * passed / b) / c
    };
    [v * speed, v * v / GRAVITY as f32 * way]
}

/// Time of a fall from rest under quadratic drag in single precision, t = (v_t/g) arcosh(e^(gz/v_t²)). Units: s.
///
/// `terminal_m_s`: m/s, in [1e-6, 1000]; `height_m`: m, in [0, 1e6]; beyond or NaN: the nearest bound.
///
/// Error: 4e-7 relative against [`Fall::time_to_fall_s`] with c = 1, over [0, 1e4] m.
#[must_use]
#[inline]
pub fn quadratic_fall_time_f32(terminal_m_s: f32, height_m: f32) -> f32 {
    let v = clamped_f32(terminal_m_s, 1e-6, 1e3);
    let g = GRAVITY as f32;
    let z = g * clamped_f32(height_m, 0.0, 1e6) / (v * v);
    let tau = if z < 0.05 {
        // √(2z)(1 + z/6 + z²/120): 1 − e^(−2z) would cancel.
        (2.0 * z).sqrt() * (1.0 + z * (1.0 / 6.0 + z * (1.0 / 120.0)))
    } else {
        z + ops::lnf(1.0 + (1.0 - ops::expf(-2.0 * z)).sqrt())
    };
    v / g * tau
}

/// Speed after a fall from rest under quadratic drag in single precision, v = v_t √(1 − e^(−2gz/v_t²)). Units: m/s.
///
/// `terminal_m_s`: m/s, in [1e-6, 1000]; `height_m`: m, in [0, 1e6]; beyond or NaN: the nearest bound.
///
/// Error: 5e-7 relative against [`Fall::speed_after_m_s`] with c = 1.
#[must_use]
#[inline]
pub fn quadratic_speed_after_f32(terminal_m_s: f32, height_m: f32) -> f32 {
    let v = clamped_f32(terminal_m_s, 1e-6, 1e3);
    v * (-ops::exp_m1f(-2.0 * GRAVITY as f32 * clamped_f32(height_m, 0.0, 1e6) / (v * v))).sqrt()
}
