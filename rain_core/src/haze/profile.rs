//! Haze that thins out with height.
//!
//! # Accuracy
//! An exponential profile over level ground, uniform along it. Nothing is marched: the optical depth of any straight
//! way is a closed form.

use crate::error::{ConfigError, clamped, clamped_or, in_range};
use crate::ops;

/// Longest way that is looked at; longer ones count as this. Units: m.
const MAX_WAY_M: f64 = 1e9;

/// Mean of e^(−t) over t in [0, x], (1 − e^(−x))/x, through exp_m1: nothing cancels, 1 at 0. Units: none.
///
/// `x`: clamped to [0, ∞), NaN counts as 0.
///
/// Error: 6e-15 relative.
#[must_use]
#[inline]
pub fn mean_decay(x: f64) -> f64 {
    if x > 0.0 { -ops::exp_m1(-x) / x } else { 1.0 }
}

/// [`mean_decay`] in single precision.
///
/// Error: 3e-7 relative.
#[must_use]
#[inline]
pub fn mean_decay_f32(x: f32) -> f32 {
    if x > 0.0 { -ops::exp_m1f(-x) / x } else { 1.0 }
}

/// Haze of extinction σ₀ up to a base height, above it σ₀ e^(−(y − y₀)/H).
///
/// Error: extinction 1e-15 relative; optical depth 2e-10 relative against the integral along the way, which is the
/// integral's own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightHaze {
    base_per_m: f64,
    base_height_m: f64,
    scale_height_m: f64,
}

impl HeightHaze {
    /// `base_per_m`: σ₀, 1/m, in [0, 100]; `base_height_m`: y₀, m, in ± 1e6; `scale_height_m`: H, m, in [1e-3, 1e9]
    /// (1e9: practically homogeneous).
    ///
    /// # Errors
    /// When a value is not finite or outside its range.
    pub fn new(base_per_m: f64, base_height_m: f64, scale_height_m: f64) -> Result<Self, ConfigError> {
        Ok(Self {
            base_per_m: in_range("base_per_m", base_per_m, 0.0, 100.0, "0 to 100 per m")?,
            base_height_m: in_range("base_height_m", base_height_m, -1e6, 1e6, "-1e6 to 1e6 m")?,
            scale_height_m: in_range("scale_height_m", scale_height_m, 1e-3, 1e9, "1e-3 to 1e9 m")?,
        })
    }

    /// Extinction at a height (m; NaN counts as the base). Units: 1/m.
    #[must_use]
    pub fn extinction_per_m(&self, height_m: f64) -> f64 {
        let above = ((height_m - self.base_height_m) / self.scale_height_m).max(0.0);
        self.base_per_m * ops::exp(-above)
    }

    /// Optical depth of a straight way of `way_m` (m, clamped to [0, 1e9], NaN counts as 0) from height `from_m` to
    /// `to_m` (m, clamped to ± 1e9, NaN counts as the base). Units: none.
    ///
    /// The part above the base: extinction at its lower end × length × (1 − e^(−x))/x with x = |Δy|/H, the same seen
    /// from both ends; the part below: σ₀ × length.
    #[must_use]
    pub fn depth(&self, from_m: f64, to_m: f64, way_m: f64) -> f64 {
        let way = clamped(way_m, 0.0, MAX_WAY_M);
        let above = |y: f64| clamped_or(y, -MAX_WAY_M, MAX_WAY_M, self.base_height_m) - self.base_height_m;
        let (a, b) = (above(from_m), above(to_m));
        let (low, high) = (a.min(b), a.max(b));
        if high <= 0.0 {
            return self.base_per_m * way;
        }
        let below_share = if low < 0.0 { -low / (high - low) } else { 0.0 };
        let start = low.max(0.0) / self.scale_height_m;
        let x = (high - low.max(0.0)) / self.scale_height_m;
        self.base_per_m * way * (below_share + (1.0 - below_share) * ops::exp(-start) * mean_decay(x))
    }
}
