//! One puddle in a paraboloid z = r²/(2 R_c): volume, area and level, filling and drying in closed form.
//!
//! V = π R_c h², A = 2 π R_c h. Inflow Q and a loss e per area give dh/dt = Q/(2 π R_c h) − e, which settles at
//! h_e = Q/(2 π R_c e). With y = h/h_e and T = e t/h_e: −y − ln|1 − y| = const + T. Below h_e, y = 1 − e^(−s) turns
//! this into s − 1 + e^(−s) = const + T; above, y = 1 + e^(−s) into s − 1 − e^(−s) = const + T. Both have one root.
//!
//! # Accuracy
//! Real puddles are irregular; the closed form is what the basin solver is tested against.

use crate::error::{ConfigError, clamped, in_range};
use crate::ops;

const TWO_PI: f64 = core::f64::consts::TAU;

/// A round hollow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParaboloidPuddle {
    radius_m: f64,
}

impl ParaboloidPuddle {
    /// A hollow with this radius of curvature at its lowest point.
    ///
    /// # Errors
    /// When `curvature_radius_m` is not finite or outside [0.001, 1e9] m.
    pub fn new(curvature_radius_m: f64) -> Result<Self, ConfigError> {
        in_range("curvature_radius_m", curvature_radius_m, 1e-3, 1e9, "0.001 to 1e9 m")?;
        Ok(Self {
            radius_m: curvature_radius_m,
        })
    }

    /// π R_c h². Units: m³, level in m. Negative levels and NaN count as 0, those above 1e3 m as 1e3 m.
    /// Error: 1e-15 relative.
    #[must_use]
    pub fn volume_m3(&self, level_m: f64) -> f64 {
        let h = clamped(level_m, 0.0, 1e3);
        0.5 * TWO_PI * self.radius_m * h * h
    }

    /// 2 π R_c h. Units: m², level in m. Clamps as [`Self::volume_m3`]. Error: 1e-15 relative.
    #[must_use]
    pub fn area_m2(&self, level_m: f64) -> f64 {
        TWO_PI * self.radius_m * clamped(level_m, 0.0, 1e3)
    }

    /// Level of a volume, √(V/(π R_c)). Units: m, m³. Negative volumes and NaN count as 0, those above 1e15 m³ as
    /// 1e15 m³. Error: 1e-15 relative.
    #[must_use]
    pub fn level_m(&self, volume_m3: f64) -> f64 {
        ops::sqrt(clamped(volume_m3, 0.0, 1e15) / (0.5 * TWO_PI * self.radius_m))
    }

    /// The level at which inflow and loss balance, Q/(2 π R_c e). Units: m, m³/s, m/s.
    /// `None` without loss (and NaN): it rises for ever, or stays. Cut off at 1e9 m. Error: 1e-15 relative.
    #[must_use]
    pub fn balance_level_m(&self, inflow_m3_s: f64, loss_m_s: f64) -> Option<f64> {
        (loss_m_s > 0.0).then(|| (clamped(inflow_m3_s, 0.0, 1e6) / (TWO_PI * self.radius_m) / loss_m_s).min(1e9))
    }

    /// The level `time_s` later under a constant inflow and a constant loss per area of water. Units: m, m³/s, m/s, s.
    ///
    /// Negative values and NaN count as 0; levels are cut off at 1e3 m, inflows at 1e6 m³/s, losses at 1 m/s, times at
    /// 1e10 s. Without inflow the level falls by e t to 0; without loss √(h² + Q t/(π R_c)). Any cut of the time ends
    /// at the same level. Error: 1e-13 relative to the higher of both levels.
    #[must_use]
    pub fn level_after_m(&self, level_m: f64, inflow_m3_s: f64, loss_m_s: f64, time_s: f64) -> f64 {
        let (h, q) = (clamped(level_m, 0.0, 1e3), clamped(inflow_m3_s, 0.0, 1e6));
        let (loss, time) = (clamped(loss_m_s, 0.0, 1.0), clamped(time_s, 0.0, 1e10));
        if time == 0.0 {
            return h;
        }
        if q == 0.0 {
            return (h - loss * time).max(0.0);
        }
        let balance = q / (TWO_PI * self.radius_m * loss);
        if balance <= (1e-17 * h).max(1e-280) {
            return (h - loss * time).max(balance); // the inflow is too little to show before
        }
        let grown = ops::sqrt(h * h + q * time / (0.5 * TWO_PI * self.radius_m));
        if !balance.is_finite() || grown <= 1e-17 * balance {
            return grown; // without loss, or too soon for it to show
        }
        // e^(−1000) is 0: what lasts longer is at the balance.
        let y = h / balance;
        let t = (loss * time / balance).min(y + 1e3);
        if y < 1.0 {
            let root = filling_root(filling(-ops::ln_1p(-y)) + t);
            balance * -ops::exp_m1(-root)
        } else if y > 1.0 {
            let s = -ops::ln(y - 1.0);
            balance + balance * ops::exp(-drying_root(s - (y - 1.0) + t))
        } else {
            h
        }
    }

    /// How long until the puddle without inflow is dry, h/e. Units: s, m, m/s. `None` without loss, 0 when dry.
    /// Error: 1e-15 relative.
    #[must_use]
    pub fn drying_time_s(level_m: f64, loss_m_s: f64) -> Option<f64> {
        let h = clamped(level_m, 0.0, 1e3);
        if h == 0.0 {
            Some(0.0)
        } else {
            (loss_m_s > 0.0).then(|| h / loss_m_s.min(1.0))
        }
    }
}

/// s − 1 + e^(−s), without cancellation.
fn filling(s: f64) -> f64 {
    if s > 0.5 {
        return s + ops::exp_m1(-s);
    }
    // s²/2 − s³/6 + s⁴/24 − …
    let (mut term, mut sum, mut n) = (0.5 * s * s, 0.0, 3.0);
    while term.abs() > 1e-18 * s * s {
        sum += term;
        term *= -s / n;
        n += 1.0;
    }
    sum
}

/// The s ≥ 0 with s − 1 + e^(−s) = c: convex and rising, c + √(2c) lies above the root, Newton falls to it.
fn filling_root(c: f64) -> f64 {
    let mut s = c + ops::sqrt(2.0 * c);
    if s == 0.0 {
        return 0.0;
    }
    for _ in 0..32 {
        let step = (filling(s) - c) / -ops::exp_m1(-s);
        s -= step;
        if step.abs() <= 1e-16 * s {
            break;
        }
    }
    s
}

/// The s with s − e^(−s) = c: concave and rising; the start lies below the root, Newton rises to it.
fn drying_root(c: f64) -> f64 {
    let mut s = if c < -1.0 { -ops::ln(-c) } else { c };
    for _ in 0..64 {
        let e = ops::exp(-s);
        let step = (c - s + e) / (1.0 + e);
        s += step;
        if step.abs() <= 1e-16 * s.abs() {
            break;
        }
    }
    s
}
