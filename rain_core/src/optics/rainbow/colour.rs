//! Colours of light in a drop: water's refractive index and what an eye makes of a spectrum.

use crate::error::clamped_or;
use crate::ops;

/// That of air, which water's is measured against. Units: none.
const AIR: f64 = 1.000_273;

/// Refractive index of water at 20 °C against air. Units: none.
///
/// `wavelength_um`: in air, µm, clamped to [0.2, 1.1], NaN counts as 0.5893. Source: Daimon & Masumura 2007, four terms of
/// Sellmeier.
///
/// Error: 3e-5 from 0.4 to 0.66 µm against published values; from 0 to 30 °C it falls by 1.7e-3.
#[must_use]
pub fn water_index(wavelength_um: f64) -> f64 {
    const TERMS: [[f64; 2]; 4] = [
        [5.684_027_565e-1, 5.101_829_712e-3],
        [1.726_177_391e-1, 1.821_153_936e-2],
        [2.086_189_578e-2, 2.620_722_293e-2],
        [1.130_748_688e-1, 1.069_792_721e1],
    ];
    let square = clamped_or(wavelength_um, 0.2, 1.1, 0.5893);
    let square = square * square;
    let sum: f64 = TERMS.iter().map(|[a, b]| a * square / (square - b)).sum();
    ops::sqrt(1.0 + sum) / AIR
}

/// Colour of light of one wavelength in linear Rec. 709, not normalised. Wyman, Sloan & Shirley 2013.
fn rec709(wavelength_nm: f64) -> [f64; 3] {
    let lobe = |scale: f64, middle: f64, below: f64, above: f64| {
        let t = (wavelength_nm - middle) / if wavelength_nm < middle { below } else { above };
        scale * ops::exp(-0.5 * t * t)
    };
    let x = lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7) + lobe(-0.065, 501.1, 20.4, 26.2);
    let y = lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1);
    let z = lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8);
    [
        3.2406 * x - 1.5372 * y - 0.4986 * z,
        -0.9689 * x + 1.8758 * y + 0.0415 * z,
        0.0557 * x - 0.2040 * y + 1.0570 * z,
    ]
}

/// Wavelengths that a colour is summed up from.
pub(super) const WAVELENGTHS: usize = 32;

/// Wavelengths (µm), and the weight of each in red, green and blue: what is the same at all wavelengths is (1, 1, 1).
pub(super) fn wavelengths() -> [(f64, [f64; 3]); WAVELENGTHS] {
    let mut table: [(f64, [f64; 3]); WAVELENGTHS] = core::array::from_fn(|i| {
        let nm = 395.0 + 10.0 * i as f64;
        (nm * 1e-3, rec709(nm))
    });
    for channel in 0..3 {
        let sum: f64 = table.iter().map(|(_, colour)| colour[channel]).sum();
        for (_, colour) in &mut table {
            colour[channel] /= sum;
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn water_bends_blue_light_more_than_red() {
        // International Critical Tables 1930, at 20 °C: lines h, F, D, C.
        for (um, index) in [
            (0.4047, 1.34274),
            (0.4861, 1.33712),
            (0.5893, 1.33299),
            (0.6563, 1.33115),
        ] {
            let found = water_index(um);
            assert!((found - index).abs() < 3e-5, "{um}: {found}");
        }
        assert_eq!(water_index(f64::NAN), water_index(0.5893));
    }

    #[test]
    fn even_light_is_white_and_each_end_of_the_spectrum_has_its_colour() {
        let table = wavelengths();
        for channel in 0..3 {
            let sum: f64 = table.iter().map(|(_, colour)| colour[channel]).sum();
            assert!((sum - 1.0).abs() < 1e-12);
        }
        let near = |um: f64| {
            let distance = |w: f64| (w - um).abs();
            table
                .iter()
                .min_by(|a, b| distance(a.0).total_cmp(&distance(b.0)))
                .map_or([0.0; 3], |(_, colour)| *colour)
        };
        let [red, green, blue] = [near(0.63), near(0.53), near(0.45)];
        assert!(red[0] > red[1].max(red[2]), "{red:?}");
        assert!(green[1] > green[0].max(green[2]), "{green:?}");
        assert!(blue[2] > blue[0].max(blue[1]), "{blue:?}");
    }
}
