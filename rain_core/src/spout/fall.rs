//! The way of water that has left a mouth.

use glam::{DVec3, Vec3};

use crate::constants::GRAVITY;
use crate::error::{clamped, clamped_f32};
use crate::ops;
use crate::rainfall::{Fall, terminal_velocity};

/// Air does not slow a thick jet: its terminal speed. Units: m/s.
const JET_TERMINAL_M_S: f64 = 100.0;
/// Longest way down. Units: m.
const DEEPEST_M: f64 = 1000.0;
/// Fastest start. Units: m/s.
const FASTEST_M_S: f64 = 100.0;

/// What has left a mouth and falls: downwards [`Fall::quadratic`] from the speed at which it left, sideways
/// x = w t + (v − w) τ (1 − e^(−t/τ)), τ = v_t/g, in a wind w.
///
/// # Accuracy
/// Sideways drag is linear and does not know how fast the drop falls: at first it is too strong, near the terminal speed
/// right. The wind is that of the open air, no house shelters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpoutFall {
    velocity_m_s: DVec3,
    wind_m_s: DVec3,
    fall: Fall,
}

impl SpoutFall {
    /// Of drops of `drop_mm` (mm, held in [0.1, 10]), or of a jet that air does not slow (None), which left with a velocity
    /// (m/s, held to 100; upward counts as level, what is not finite as at rest) into a level wind (m/s, as well).
    #[must_use]
    pub fn new(velocity_m_s: DVec3, drop_mm: Option<f64>, wind_m_s: DVec3) -> Self {
        let held = |v: DVec3| {
            if v.is_finite() {
                v.clamp_length_max(FASTEST_M_S)
            } else {
                DVec3::ZERO
            }
        };
        let v = held(velocity_m_s);
        let terminal = drop_mm.map_or(JET_TERMINAL_M_S, |d| terminal_velocity(clamped(d, 0.1, 10.0)));
        Self {
            velocity_m_s: v.with_y(v.y.min(0.0)),
            wind_m_s: held(wind_m_s).with_y(0.0),
            fall: Fall::quadratic_held(terminal),
        }
    }

    /// At which it left. Units: m/s.
    #[must_use]
    pub fn velocity_m_s(&self) -> DVec3 {
        self.velocity_m_s
    }

    /// Units: m/s.
    #[must_use]
    pub fn terminal_m_s(&self) -> f64 {
        self.fall.terminal_m_s()
    }

    /// Where it is `age_s` after it left (held in [0, 1e3] s), from the mouth. Units: m.
    ///
    /// Error: 1e-7 m in a second, against small steps.
    #[must_use]
    pub fn place_m(&self, age_s: f64) -> DVec3 {
        let age = clamped(age_s, 0.0, 1e3);
        let time = self.fall.terminal_m_s() / GRAVITY;
        let level = -time * ops::exp_m1(-age / time);
        let down = self.fall.distance_m(age, -self.velocity_m_s.y);
        let sideways = self.wind_m_s * age + (self.velocity_m_s - self.wind_m_s) * level;
        sideways.with_y(-down)
    }

    /// When it has fallen `height_m` (held in [0, 1000] m). Units: s.
    ///
    /// Error: 1e-7 s, back from the way.
    #[must_use]
    pub fn time_to_fall_s(&self, height_m: f64) -> f64 {
        self.fall
            .time_to_fall_s(clamped(height_m, 0.0, DEEPEST_M), -self.velocity_m_s.y)
    }
}

/// [`SpoutFall::place_m`] in single precision: y = −(v_t²/g) ln(cosh τ + u₀ sinh τ), τ = g t/v_t, u₀ = v₀/v_t.
///
/// `velocity_m_s`: m/s, level or downward; `wind_m_s`: m/s, level; `terminal_m_s` held in [0.1, 1000] m/s, `age_s` in
/// [0, 10] s.
///
/// Error: 2e-5 m in a second.
#[must_use]
pub fn spout_fall_f32(velocity_m_s: Vec3, terminal_m_s: f32, wind_m_s: Vec3, age_s: f32) -> Vec3 {
    let terminal = clamped_f32(terminal_m_s, 0.1, 1e3);
    let age = clamped_f32(age_s, 0.0, 10.0);
    let time = terminal / GRAVITY as f32;
    let tau = age / time;
    let start = (-velocity_m_s.y / terminal).max(0.0);
    let level = -time * ops::exp_m1f(-tau);
    let down = tau + ops::ln_1pf(0.5 * (1.0 - start) * ops::exp_m1f(-2.0 * tau));
    let sideways = wind_m_s * age + (velocity_m_s - wind_m_s) * level;
    sideways.with_y(-terminal * time * down)
}
