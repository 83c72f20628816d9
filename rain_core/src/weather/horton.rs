//! Infiltration into soil: Horton's capacity, advanced by what has infiltrated.

use serde::{Deserialize, Serialize};

use crate::error::{ConfigError, clamped, in_range};
use crate::ops;

/// Horton's infiltration capacity f = f_c + (f₀ − f_c) e^(−kτ), with a recovery in dry spells. Source: Horton 1940.
///
/// τ is not clock time: it is the time at which Horton's curve would have let in what has infiltrated, so a pause in
/// the rain does not use up the soil. While nothing infiltrates, the used share 1 − e^(−kτ) decays with
/// `recovery_per_s` (the regeneration curve of the SWMM manual, Rossman & Huber 2016).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Infiltration {
    /// Capacity of the dry soil f₀. Units: mm/h. Domain: [0, 10000], at least `final_mm_h`.
    pub initial_mm_h: f64,
    /// Capacity in the long run f_c. Units: mm/h. Domain: [0, 10000].
    pub final_mm_h: f64,
    /// Decay of the capacity k. Units: 1/h. Domain: (0, 1000].
    pub decay_per_h: f64,
    /// Decay of the used share in dry spells. Units: 1/s. Domain: [0, 1]. Default: 6.47e-6 (98 % in 7 days).
    pub recovery_per_s: f64,
}

impl Infiltration {
    /// A surface that lets nothing in.
    pub const NONE: Self = Self {
        initial_mm_h: 0.0,
        final_mm_h: 0.0,
        decay_per_h: 1.0,
        recovery_per_s: 0.0,
    };

    /// ln(50)/7 days: 98 % of the capacity is back after a week without rain (SWMM's usual drying time).
    pub const WEEK_RECOVERY_PER_S: f64 = 6.47e-6;

    /// These parameters, if they lie in their domains.
    ///
    /// # Errors
    /// Names the first field that does not.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range("final_mm_h", self.final_mm_h, 0.0, 1e4, "0 to 10000 mm/h")?;
        in_range(
            "initial_mm_h",
            self.initial_mm_h,
            self.final_mm_h,
            1e4,
            "final_mm_h to 10000 mm/h",
        )?;
        in_range("decay_per_h", self.decay_per_h, 1e-6, 1e3, "1e-6 to 1000 per hour")?;
        in_range("recovery_per_s", self.recovery_per_s, 0.0, 1.0, "0 to 1 per second")?;
        Ok(self)
    }

    /// Whether anything can infiltrate at all.
    #[must_use]
    pub fn is_permeable(&self) -> bool {
        self.initial_mm_h > 0.0
    }

    /// Capacity f of soil in which `time_s` of Horton's curve is used up. Units: mm/h, s.
    /// Times below 0 and NaN count as 0. Domain: valid parameters. Error: 1e-15 of f₀.
    #[must_use]
    pub fn capacity_mm_h(&self, time_s: f64) -> f64 {
        self.curve().capacity(time_s.max(0.0)) * 3600.0
    }

    /// What the dry soil takes in `time_s` under standing water, F. Units: mm, s. Times below 0 and NaN count as 0,
    /// those above 1e9 s as 1e9 s. Domain: valid parameters. Error: 1e-13 relative.
    #[must_use]
    pub fn flooded_mm(&self, time_s: f64) -> f64 {
        self.curve().depth(0.0, clamped(time_s, 0.0, 1e9))
    }

    /// How long the dry soil takes all of a constant rain: until its capacity, which falls with what infiltrates, is
    /// down to the rain. Units: s. `None` if R ≤ f_c: for ever (also without rain and for NaN).
    /// Domain: valid parameters. Error: 1e-11 relative for R at least 1e-6 of f₀ − f_c above f_c.
    #[must_use]
    pub fn ponding_time_s(&self, rain_mm_h: f64) -> Option<f64> {
        let (curve, rain) = (self.curve(), rain_mm_h.min(1e9) / 3600.0);
        if rain_mm_h.is_nan() || rain <= curve.floor {
            return None;
        }
        let tau = curve.tau_at(0.0, rain)?;
        Some(curve.depth(0.0, tau) / rain)
    }

    /// The curve in mm/s and s.
    pub(crate) fn curve(&self) -> HortonCurve {
        HortonCurve {
            floor: self.final_mm_h / 3600.0,
            extra: (self.initial_mm_h - self.final_mm_h) / 3600.0,
            decay: self.decay_per_h / 3600.0,
            recovery: self.recovery_per_s,
        }
    }
}

/// Beyond kτ = 30 the capacity is within 1e-13 of its final value; τ stops there, so that recovery can start from it.
const MAX_DECAYS: f64 = 30.0;

/// Horton's curve in mm and s; τ in s.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HortonCurve {
    /// f_c, mm/s.
    pub floor: f64,
    /// f₀ − f_c, mm/s.
    pub extra: f64,
    /// k, 1/s.
    pub decay: f64,
    /// Recovery, 1/s.
    pub recovery: f64,
}

impl HortonCurve {
    /// Capacity at τ, mm/s.
    pub(crate) fn capacity(&self, tau: f64) -> f64 {
        if self.extra == 0.0 {
            self.floor
        } else {
            self.floor + self.extra * ops::exp(-self.decay * tau)
        }
    }

    /// What infiltrates at capacity from τ to τ + t, mm.
    pub(crate) fn depth(&self, tau: f64, t: f64) -> f64 {
        let mut depth = self.floor * t;
        if self.extra != 0.0 {
            depth += self.extra * ops::exp(-self.decay * tau) * -ops::exp_m1(-self.decay * t) / self.decay;
        }
        depth
    }

    /// The τ ≥ `tau` at which the capacity has fallen to `rate`, if it ever does.
    pub(crate) fn tau_at(&self, tau: f64, rate: f64) -> Option<f64> {
        if rate >= self.capacity(tau) {
            return Some(tau);
        }
        if rate <= self.floor || self.extra == 0.0 {
            return None;
        }
        Some((-ops::ln((rate - self.floor) / self.extra) / self.decay).max(tau))
    }

    /// The time t with depth(τ, t) = `depth`, for a depth > 0 that is reached at capacity > 0.
    ///
    /// The depth is concave in t, so Newton from below rises to the root without passing it.
    pub(crate) fn time_for(&self, tau: f64, depth: f64) -> f64 {
        let mut t = depth / self.capacity(tau);
        for _ in 0..64 {
            let step = (depth - self.depth(tau, t)) / self.capacity(tau + t);
            t += step;
            if step <= 1e-16 * t {
                break;
            }
        }
        t
    }

    /// τ after `t` more, kept where the curve still has digits.
    pub(crate) fn advanced(&self, tau: f64, t: f64) -> f64 {
        (tau + t).min(MAX_DECAYS / self.decay)
    }

    /// τ after `t` without infiltration.
    pub(crate) fn recovered(&self, tau: f64, t: f64) -> f64 {
        if tau == 0.0 || self.recovery == 0.0 {
            return tau;
        }
        let used = -ops::exp_m1(-self.decay * tau) * ops::exp(-self.recovery * t);
        -ops::ln_1p(-used) / self.decay
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOAM: Infiltration = Infiltration {
        initial_mm_h: 76.0,
        final_mm_h: 13.0,
        decay_per_h: 4.14,
        recovery_per_s: 1e-5,
    };

    #[test]
    fn check_values() {
        let c = LOAM.curve();
        for (hours, rate, depth) in [(0.25, 35.37926, 13.06177), (1.0, 14.00314, 27.97509)] {
            let t = hours * 3600.0;
            assert!((c.capacity(t) * 3600.0 - rate).abs() < 5e-6);
            assert!((c.depth(0.0, t) - depth).abs() < 5e-6);
        }
    }

    #[test]
    fn inverses_round_trip() {
        let c = LOAM.curve();
        for tau in [0.0, 100.0, 2000.0] {
            for t in [1e-3, 1.0, 500.0, 9000.0] {
                let back = c.time_for(tau, c.depth(tau, t));
                assert!((back - t).abs() < 1e-9 * t, "{tau} {t} {back}");
            }
            let rate = c.capacity(tau + 321.0);
            assert!((c.tau_at(tau, rate).expect("reached") - tau - 321.0).abs() < 1e-6);
        }
        assert_eq!(c.tau_at(0.0, 12.9 / 3600.0), None, "never falls below f_c");
        assert_eq!(c.tau_at(50.0, 1.0), Some(50.0), "already below");
    }

    #[test]
    fn recovery_composes_and_ends_at_the_dry_soil() {
        let c = LOAM.curve();
        let tau = c.advanced(0.0, 1e9);
        assert!(tau.is_finite());
        let once = c.recovered(tau, 3000.0);
        let twice = c.recovered(c.recovered(tau, 1000.0), 2000.0);
        assert!(once < tau && (once - twice).abs() < 1e-6 * once, "{once} {twice}");
        assert!(c.recovered(tau, 1e8) < 1e-9);
    }

    #[test]
    fn bad_parameters_are_refused() {
        let name = |i: Infiltration| i.validated().expect_err("invalid").to_string();
        assert!(
            name(Infiltration {
                final_mm_h: -1.0,
                ..LOAM
            })
            .starts_with("final_mm_h is -1")
        );
        assert!(
            name(Infiltration {
                initial_mm_h: 10.0,
                ..LOAM
            })
            .starts_with("initial_mm_h is 10")
        );
        assert!(
            name(Infiltration {
                decay_per_h: 0.0,
                ..LOAM
            })
            .starts_with("decay_per_h is 0")
        );
        assert!(
            name(Infiltration {
                recovery_per_s: f64::NAN,
                ..LOAM
            })
            .starts_with("recovery_per_s is NaN")
        );
        assert!(LOAM.validated().is_ok() && Infiltration::NONE.validated().is_ok());
    }
}
