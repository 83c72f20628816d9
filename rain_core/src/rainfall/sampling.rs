//! Random diameters: from the drops in the air, or from those that reach the ground.
//!
//! # Accuracy
//! [`AirSampler`] inverts its distribution exactly. [`DiameterTable`] interpolates the inverse of any distribution at
//! equal steps of s, with u = 1 − (1 − s)³: equal steps of u would make the mean D³ 36 % wrong with 128 entries, for
//! the tail's drops carry the water. With the warp it is 0.013 % (0.2–6 mm, 10 mm/h).

use super::drop_sizes::DropSizes;
use super::spectrum::Spectrum;
use crate::error::{ConfigError, in_range};
use crate::ops;
use crate::quadrature::GaussLegendre;

/// Diameters of an exponential spectrum's drops in the air, between two ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AirSampler {
    min_mm: f64,
    max_mm: f64,
    slope_per_mm: f64,
    /// e^(−Λ(b − a)), in [0, 1).
    rest: f64,
    /// The same less 1, without cancellation.
    span: f64,
}

impl AirSampler {
    /// Drops of `spectrum` between two diameters. `max_mm` may be infinite.
    ///
    /// # Errors
    /// When `min_mm` is outside [0, 20], or `max_mm` not above it.
    pub fn new(spectrum: &Spectrum, min_mm: f64, max_mm: f64) -> Result<Self, ConfigError> {
        let min_mm = in_range("min_mm", min_mm, 0.0, 20.0, "0 to 20 mm")?;
        if max_mm.is_nan() || max_mm <= min_mm {
            return Err(ConfigError::OutOfRange {
                field: "max_mm",
                value: max_mm,
                allowed: "above min_mm",
            });
        }
        let slope_per_mm = spectrum.slope_per_mm;
        // Beyond e^(−45) no double in [0, 1) reaches.
        let max_mm = max_mm.min(min_mm + 45.0 / slope_per_mm);
        Ok(Self {
            min_mm,
            max_mm,
            slope_per_mm,
            rest: ops::exp(-slope_per_mm * (max_mm - min_mm)),
            span: ops::exp_m1(-slope_per_mm * (max_mm - min_mm)),
        })
    }

    /// Diameter at the share `u` of the drops, D = a − ln(1 − u(1 − e^(−Λ(b − a))))/Λ. Units: mm.
    ///
    /// `u` in [0, 1], held there; NaN counts as 0.
    ///
    /// Error: 1e-13 relative.
    #[must_use]
    pub fn diameter_mm(&self, u: f64) -> f64 {
        let u = if u > 0.0 { u.min(1.0) } else { 0.0 };
        // The share of the larger drops, 1 − u(1 − e^(−Λ(b − a))): by its distance from 1 or from 0.
        let ln_share = if u * self.span > -0.5 {
            ops::ln_1p(u * self.span)
        } else {
            ops::ln((1.0 - u) + u * self.rest)
        };
        let d = self.min_mm - ln_share / self.slope_per_mm;
        d.clamp(self.min_mm, self.max_mm)
    }

    /// [`AirSampler::diameter_mm`] in single precision.
    ///
    /// Error: 1e-6 relative (or of 1e-3 mm).
    #[must_use]
    pub fn diameter_mm_f32(&self, u: f32) -> f32 {
        let u = if u > 0.0 { u.min(1.0) } else { 0.0 };
        let ln_share = if u * self.span as f32 > -0.5 {
            ops::ln_1pf(u * self.span as f32)
        } else {
            ops::lnf((1.0 - u) + u * self.rest as f32)
        };
        let d = self.min_mm as f32 - ln_share / self.slope_per_mm as f32;
        d.clamp(self.min_mm as f32, self.max_mm as f32)
    }
}

/// Steps of the integral that a table inverts.
const STEPS: usize = 256;

/// Inverse of a size distribution as a table of N + 1 diameters, for look-up in hot loops. Holds no pointer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiameterTable<const N: usize> {
    /// At s = i/N, i below N. Units: mm.
    diameters: [f32; N],
    /// At s = 1. Units: mm.
    max_mm: f32,
}

impl<const N: usize> DiameterTable<N> {
    /// Of the drops in the air, ∝ N.
    ///
    /// # Errors
    /// As [`DiameterTable::on_ground`].
    pub fn in_air(sizes: &DropSizes, min_mm: f64, max_mm: f64) -> Result<Self, ConfigError> {
        Self::new(sizes, min_mm, max_mm, |_| 1.0)
    }

    /// Of the drops that reach the ground, ∝ v N with a fall law (mm in, m/s out).
    ///
    /// Allocates nothing; takes tens of microseconds, once for each rain state. N at least 1.
    ///
    /// # Errors
    /// When `min_mm` is outside [0, 20], `max_mm` not above it, or no drop lies between them.
    pub fn on_ground(
        sizes: &DropSizes,
        min_mm: f64,
        max_mm: f64,
        speed_m_s: impl Fn(f64) -> f64,
    ) -> Result<Self, ConfigError> {
        Self::new(sizes, min_mm, max_mm, speed_m_s)
    }

    fn new(sizes: &DropSizes, min_mm: f64, max_mm: f64, weight: impl Fn(f64) -> f64) -> Result<Self, ConfigError> {
        let min_mm = in_range("min_mm", min_mm, 0.0, 20.0, "0 to 20 mm")?;
        let refused = |field, value, allowed| Err(ConfigError::OutOfRange { field, value, allowed });
        if max_mm.is_nan() || max_mm <= min_mm {
            return refused("max_mm", max_mm, "above min_mm");
        }
        let max_mm = max_mm.min(sizes.end_mm().max(min_mm + 0.1));
        let density = |d: f64| sizes.concentration(d) * weight(d);
        let rule = GaussLegendre::<3>::RULE;
        // Steps that grow with the diameter: most drops are small, most water is not.
        let border = |i: usize| {
            let x = i as f64 / STEPS as f64;
            min_mm + (max_mm - min_mm) * x * x * (0.25 + 0.75 * x)
        };
        // Shares beyond each border, summed from the large end, where they are small.
        let mut beyond = [0.0; STEPS + 1];
        for i in (0..STEPS).rev() {
            beyond[i] = beyond[i + 1] + rule.integrate(border(i), border(i + 1), density);
        }
        if beyond[0].is_nan() || beyond[0] <= 0.0 {
            return refused("max_mm", max_mm, "a range that holds drops");
        }
        let mut step = 0;
        let mut at = |i: usize| {
            let rest = 1.0 - i as f64 / N as f64;
            let target = rest * rest * rest * beyond[0];
            while step + 1 < STEPS && beyond[step + 1] > target {
                step += 1;
            }
            let (low, high) = (border(step), border(step + 1));
            let share = beyond[step] - beyond[step + 1];
            let part = if share > 0.0 {
                (beyond[step] - target) / share
            } else {
                0.0
            };
            let mut d = low + (high - low) * part.clamp(0.0, 1.0);
            // Newton's method on the step's own integral.
            for _ in 0..3 {
                let excess = beyond[step + 1] + rule.integrate(d, high, density) - target;
                let slope = density(d);
                if slope > 0.0 {
                    d = (d + excess / slope).clamp(low, high);
                }
            }
            d as f32
        };
        Ok(Self {
            diameters: core::array::from_fn(&mut at),
            max_mm: max_mm as f32,
        })
    }

    /// Diameter at the share `u` of the drops. Units: mm.
    ///
    /// `u` in [0, 1], held there; NaN counts as 0. A cube root and one linear interpolation.
    ///
    /// Error: at 10 mm/h, 0.2 to 6 mm, with 64, 128, 256 entries mean D³ 0.051 %, 0.013 %, 0.0033 %; D of all drops but
    /// one in 100 000 within 0.038, 0.010, 0.004 mm, of the rest within 0.145, 0.04, 0.017 mm.
    #[must_use]
    pub fn diameter_mm(&self, u: f32) -> f32 {
        let u = if u > 0.0 { u.min(1.0) } else { 0.0 };
        // s = 1 − ∛(1 − u).
        let place = (1.0 - ops::cbrtf(1.0 - u)) * N as f32;
        let i = (place as usize).min(N - 1);
        let (from, to) = (
            self.diameters[i],
            self.diameters.get(i + 1).copied().unwrap_or(self.max_mm),
        );
        from + (place - i as f32) * (to - from)
    }
}
