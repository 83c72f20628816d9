//! Haze that grows into mist and fog as the air gets humid: water on the particles that float in it.
//!
//! # Accuracy
//! One kind of particle, in balance with the air, large enough that its curvature does not count. Drops of fog that
//! have begun to grow by themselves (humidity above 1) are the clamp's end. Measured growth scatters by a factor of two.

use crate::error::{clamped, clamped_or};
use crate::ops;

/// Extinction of dry particles of clean country air: a visibility of 39 km. Units: 1/m.
pub const DRY_EXTINCTION_PER_M: f64 = 1e-4;
/// Hygroscopicity κ of mixed continental particles (Petters & Kreidenweis 2007). Units: none.
pub const HYGROSCOPICITY: f64 = 0.3;
/// Humidity that more counts as: dense fog. Units: none.
pub const MAX_MIST_HUMIDITY: f64 = 0.9999;

/// Extinction of particles that have taken up water: that of the dry ones times (1 + κ h/(1 − h))^(2/3), the growth of their
/// cross-section. Units: 1/m.
///
/// `relative_humidity`: h, clamped to [0, 0.9999], NaN counts as 0; `dry_per_m`: 1/m, clamped to [0, 1]; `hygroscopicity`:
/// κ, clamped to [0, 2], NaN counts as 0.3. Petters & Kreidenweis 2007, eq. 6 without curvature.
///
/// Error: 1e-14 relative to the formula.
#[must_use]
pub fn mist_extinction_per_m(relative_humidity: f64, dry_per_m: f64, hygroscopicity: f64) -> f64 {
    let h = clamped(relative_humidity, 0.0, MAX_MIST_HUMIDITY);
    let kappa = clamped_or(hygroscopicity, 0.0, 2.0, HYGROSCOPICITY);
    let root = ops::cbrt(1.0 + kappa * h / (1.0 - h));
    clamped(dry_per_m, 0.0, 1.0) * root * root
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::haze::{KOSCHMIEDER_CONTRAST, visibility_m};

    #[test]
    fn haze_grows_into_mist_and_fog_without_a_step() {
        let seen = |h: f64| {
            let extinction = mist_extinction_per_m(h, DRY_EXTINCTION_PER_M, HYGROSCOPICITY);
            visibility_m(extinction, KOSCHMIEDER_CONTRAST)
        };
        // Dry air, haze, mist (below 5 km), fog (below 1 km).
        assert!((seen(0.0) - 39_120.0).abs() < 10.0);
        assert!(seen(0.8) > 20_000.0 && seen(0.95) > 5_000.0);
        assert!(seen(0.99) < 5_000.0 && seen(0.99) > 1_000.0, "{}", seen(0.99));
        assert!(
            seen(0.999) < 1_000.0 && seen(1.0) > 150.0,
            "{} {}",
            seen(0.999),
            seen(1.0)
        );
        let mut before = seen(0.0);
        for i in 1..=4000 {
            // Even in the logarithm of what is left to saturation.
            let h = 1.0 - ops::exp(-f64::from(i) * 2.3e-3);
            let now = seen(h);
            assert!(now < before && now > 0.99 * before, "{h}: {now} after {before}");
            before = now;
        }
    }

    #[test]
    fn growth_is_that_of_the_cross_section() {
        for (h, kappa) in [(0.5, 0.3), (0.9, 0.6), (0.99, 1.2)] {
            let volume: f64 = 1.0 + kappa * h / (1.0 - h);
            let expected = 2e-4 * ops::pow(volume, 2.0 / 3.0);
            let found = mist_extinction_per_m(h, 2e-4, kappa);
            assert!((found / expected - 1.0).abs() < 1e-14, "{found} {expected}");
        }
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(mist_extinction_per_m(bad, 1e-4, 0.3).is_finite());
            assert!(mist_extinction_per_m(0.9, bad, 0.3).is_finite());
            assert!(mist_extinction_per_m(0.9, 1e-4, bad).is_finite());
        }
    }
}
