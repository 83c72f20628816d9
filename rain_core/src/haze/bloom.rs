//! Glow of bright lights in rain as a wider bloom of the whole picture.
//!
//! # Accuracy
//! A look: one way through the rain stands for that of every pixel, and scattered light is spread as widely as the bloom can.

use crate::error::clamped_or;
use crate::ops;

/// A bloom's share of scattered light and how much of that goes far, in a rain that scatters more of it.
///
/// `scatter`: share of a pixel's light that the bloom spreads; `wide`: share of it that goes on to the widest blur; `depth`:
/// optical depth of the way through the rain. A ray passes lens and rain unscattered with (1 − scatter) e^(−depth); of what is
/// scattered the rain's part goes to the widest blur. `scatter` and `wide` are held in [0, 1], `depth` in [0, 100]; NaN
/// counts as 0. Units: none. Digest E79 (Lagarde 2013): a larger blur in rain.
///
/// Error: 1e-15.
#[must_use]
pub fn bloom_in_rain(scatter: f64, wide: f64, depth: f64) -> [f64; 2] {
    let [scatter, wide] = [scatter, wide].map(|share| clamped_or(share, 0.0, 1.0, 0.0));
    let by_rain = -ops::exp_m1(-clamped_or(depth, 0.0, 100.0, 0.0));
    let both = scatter + (1.0 - scatter) * by_rain;
    if both <= 0.0 {
        return [0.0, wide];
    }
    let share = (1.0 - scatter) * by_rain / both;
    [both, wide + (1.0 - wide) * share]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rain_adds_wide_scattering_and_no_rain_none() {
        assert_eq!(bloom_in_rain(0.15, 0.7, 0.0), [0.15, 0.7]);
        assert_eq!(bloom_in_rain(0.0, 0.3, f64::NAN), [0.0, 0.3]);
        // Half of the light scattered: of 0.575 in all, 0.425 by the rain.
        let [scatter, wide] = bloom_in_rain(0.15, 0.7, std::f64::consts::LN_2);
        assert!((scatter - 0.575).abs() < 1e-15);
        assert!((wide - (0.7 * 0.15 + 0.425) / 0.575).abs() < 1e-15);
        // What lens and rain let through multiplies.
        let mut before = 0.0;
        for depth in [0.01, 0.1, 1.0, 10.0, 1e9] {
            let [scatter, wide] = bloom_in_rain(0.2, 0.5, depth);
            assert!((1.0 - scatter - 0.8 * (-f64::min(depth, 100.0)).exp()).abs() < 1e-15);
            assert!(scatter > before && (0.5..=1.0).contains(&wide));
            before = scatter;
        }
        // No lens: all that is scattered goes far.
        assert_eq!(bloom_in_rain(0.0, 0.3, 0.5)[1], 1.0);
    }
}
