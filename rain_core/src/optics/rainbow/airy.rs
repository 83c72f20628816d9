//! Airy's function near a caustic, averaged over a band of drop sizes.

use core::f64::consts::{FRAC_PI_4, PI};
use std::sync::OnceLock;

use crate::ops;

/// Ai and Ai′ at z; beyond 6 both are counted as 0 (they are below 3e-5).
///
/// Error: 1e-5, where series and asymptote meet.
fn airy(z: f64) -> [f64; 2] {
    if z > 6.0 {
        return [0.0; 2];
    }
    if z < -6.0 {
        return airy_far(-z);
    }
    // Ai(0) and −Ai′(0).
    const AT_ZERO: [f64; 2] = [0.355_028_053_887_817_2, 0.258_819_403_792_806_8];
    let cube = z * z * z;
    let (mut even, mut odd) = (1.0, z);
    let (mut even_slope, mut odd_slope) = (0.5 * z * z, 1.0);
    let [mut a, mut b] = [even, odd];
    let [mut c, mut d] = [even_slope, odd_slope];
    for k in 0..60_u32 {
        let k = 3.0 * f64::from(k);
        even *= cube / ((k + 2.0) * (k + 3.0));
        odd *= cube / ((k + 3.0) * (k + 4.0));
        even_slope *= cube / ((k + 3.0) * (k + 5.0));
        odd_slope *= cube / ((k + 1.0) * (k + 3.0));
        a += even;
        b += odd;
        c += even_slope;
        d += odd_slope;
    }
    [AT_ZERO[0] * a - AT_ZERO[1] * b, AT_ZERO[0] * c - AT_ZERO[1] * d]
}

/// Ai and Ai′ at −z, z large (Abramowitz & Stegun 1964, 10.4.60 and 10.4.62).
fn airy_far(z: f64) -> [f64; 2] {
    let xi = 2.0 / 3.0 * z * ops::sqrt(z);
    let by = 1.0 / xi;
    let c = [1.0, 5.0 / 72.0, 385.0 / 10_368.0, 85_085.0 / 2_239_488.0];
    let d = [c[0], -7.0 / 5.0 * c[1], -13.0 / 11.0 * c[2], -19.0 / 17.0 * c[3]];
    let pair = |k: [f64; 4]| [k[0] - k[2] * by * by, by * (k[1] - k[3] * by * by)];
    let (sin, cos) = (ops::sin(xi + FRAC_PI_4), ops::cos(xi + FRAC_PI_4));
    let fourth = ops::sqrt(ops::sqrt(z));
    let [even, odd] = pair(c);
    let [even_slope, odd_slope] = pair(d);
    let scale = 1.0 / ops::sqrt(PI);
    [
        scale / fourth * (sin * even - cos * odd),
        -scale * fourth * (cos * even_slope + sin * odd_slope),
    ]
}

/// ln of the ratio of neighbouring drop sizes. Units: none.
pub(super) const BAND: f64 = 0.3;
const LOW: f64 = -6.0;
const STEP: f64 = 0.05;
const ENTRIES: usize = 601;
/// Points across a band.
const POINTS: u32 = 128;

/// Means of r^(1/3) Ai²(−ζ r^(2/3)) and r^(−1/3) Ai′²(−ζ r^(2/3)) over sizes r about 1, with weights that fall straight to 0
/// at e^(±[`BAND`]).
pub(super) struct AiryBand {
    means: Vec<[f64; 2]>,
}

impl AiryBand {
    /// The table, made once.
    pub(super) fn get() -> &'static Self {
        static TABLE: OnceLock<AiryBand> = OnceLock::new();
        TABLE.get_or_init(|| Self {
            means: (0..ENTRIES).map(|i| mean(LOW + STEP * i as f64)).collect(),
        })
    }

    /// Both means at ζ (positive where light falls): 0 far on the dark side, 1/(2π√ζ) and √ζ/(2π) far on the lit one.
    #[inline]
    pub(super) fn at(&self, zeta: f64) -> [f64; 2] {
        let place = (zeta - LOW) / STEP;
        if place < 0.0 {
            return [0.0; 2];
        }
        let index = place as usize;
        if index + 1 >= ENTRIES {
            let root = ops::sqrt(zeta);
            return [0.5 / (PI * root), 0.5 * root / PI];
        }
        let t = place - index as f64;
        let [a, b] = [self.means[index], self.means[index + 1]];
        [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t]
    }
}

fn mean(zeta: f64) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for i in 0..POINTS {
        let t = (f64::from(i) + 0.5) / f64::from(POINTS) * 2.0 - 1.0;
        let weight = 2.0 / f64::from(POINTS) * (1.0 - t.abs());
        let root = ops::exp(t * BAND / 3.0);
        let [value, slope] = airy(-zeta * root * root);
        sums[0] += weight * root * value * value;
        sums[1] += weight / root * slope * slope;
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn airys_function_has_its_published_values() {
        // Abramowitz & Stegun 1964, table 10.11.
        for (z, value, slope) in [
            (0.0, 0.355_028_05, -0.258_819_40),
            (1.0, 0.135_292_42, -0.159_147_44),
            (-1.0, 0.535_560_88, -0.010_160_57),
            (-2.0, 0.227_407_43, 0.618_259_02),
            (-5.0, 0.350_761_01, 0.327_192_82),
            (-10.0, 0.040_241_23, 0.996_265_04),
        ] {
            let found = airy(z);
            assert!(
                (found[0] - value).abs() < 1e-5 && (found[1] - slope).abs() < 1e-5,
                "{z}: {found:?}"
            );
        }
        let [near, far] = [airy(-6.0), airy_far(6.0)];
        assert!(
            (near[0] - far[0]).abs() < 1e-5 && (near[1] - far[1]).abs() < 1e-5,
            "{near:?} {far:?}"
        );
    }

    #[test]
    fn a_band_of_sizes_has_no_fringes_far_from_the_caustic() {
        let band = AiryBand::get();
        for zeta in [20.0_f64, 23.9, 24.1, 60.0] {
            let [value, slope] = band.at(zeta);
            assert!((value * 2.0 * PI * zeta.sqrt() - 1.0).abs() < 0.01, "{zeta}: {value}");
            assert!((slope * 2.0 * PI / zeta.sqrt() - 1.0).abs() < 0.01, "{zeta}: {slope}");
        }
        assert_eq!(band.at(-7.0), [0.0; 2]);
    }
}
