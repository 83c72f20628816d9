//! The colours of rainbows by angle, for any mixture of drop sizes.

use core::f64::consts::PI;

use rayon::prelude::*;

use super::airy::{AiryBand, BAND};
use super::colour::wavelengths;
use super::rays::{BowRays, light_of};
use crate::error::{clamped, clamped_or};
use crate::ops;
use crate::quadrature::GaussLegendre;
use crate::rainfall::Spectrum;

/// Entries of a [`RainbowPhase`].
pub const BOW_KNOTS: usize = 376;
/// Angles between which the entries stand close together. Units: degrees.
pub const BOW_SPAN_DEG: [f64; 2] = [30.0, 66.0];
/// Step of the entries below, within and above [`BOW_SPAN_DEG`]. Units: degrees.
pub const BOW_STEP_DEG: [f64; 3] = [1.0, 0.125, 2.0];
/// Half of the sun's width. Units: rad.
const SUN_RAD: f64 = 0.2666 * PI / 180.0;
/// Points across the sun's disc.
const DISC: usize = 7;
/// Sizes of drops.
const SIZES: usize = 27;
/// Radius of the smallest. Units: µm.
const FIRST_UM: f64 = 2.0;

/// Place of an angle from the point opposite the sun among the entries, in [0, 375].
///
/// `angle_rad`: clamped to [0, π], NaN counts as 0.
///
/// Error: 1e-12 at both ends and at 30°.
#[must_use]
pub fn bow_place(angle_rad: f64) -> f64 {
    let degrees = clamped(angle_rad, 0.0, PI) * (180.0 / PI);
    let [low, high] = BOW_SPAN_DEG;
    let [below, within, above] = BOW_STEP_DEG;
    let at = |degrees: f64| degrees.min(low) / below + (degrees.clamp(low, high) - low) / within;
    (at(degrees) + (degrees - high).max(0.0) / above).min((BOW_KNOTS - 1) as f64)
}

/// Angle of an entry. Units: rad.
fn knot_rad(knot: usize) -> f64 {
    let [low, high] = BOW_SPAN_DEG;
    let [below, within, above] = BOW_STEP_DEG;
    let first = low / below;
    let second = first + (high - low) / within;
    let knot = knot as f64;
    let degrees = if knot < first {
        knot * below
    } else if knot < second {
        low + (knot - first) * within
    } else {
        high + (knot - second) * above
    };
    degrees * (PI / 180.0)
}

/// Light that drops send after one and two inner reflections, by the angle from the point opposite the sun, in linear
/// Rec. 709 under white sunlight. Of the light on the drops' discs, per steradian; the sun's disc is in it.
///
/// Colours that no screen shows are drawn to grey of their own luminance until no part is negative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RainbowPhase {
    /// Red, green, blue and nothing. Units: 1/sr.
    pub rgb_per_sr: [[f32; 4]; BOW_KNOTS],
}

impl RainbowPhase {
    /// At an angle (rad) as in [`bow_place`], straight between entries. Units: 1/sr.
    ///
    /// Error: 1e-6 of the table's greatest, its single precision.
    #[must_use]
    pub fn per_sr(&self, angle_rad: f64) -> [f64; 3] {
        let place = bow_place(angle_rad);
        let index = (place as usize).min(BOW_KNOTS - 2);
        let t = place - index as f64;
        let [a, b] = [self.rgb_per_sr[index], self.rgb_per_sr[index + 1]];
        core::array::from_fn(|i| {
            let (a, b) = (f64::from(a[i]), f64::from(b[i]));
            a + (b - a) * t
        })
    }
}

/// The bows of drops of 27 sizes, from which those of every mixture are summed up.
#[derive(Debug, Clone, PartialEq)]
pub struct RainbowTables {
    sizes: Vec<[[f32; 3]; BOW_KNOTS]>,
}

impl Default for RainbowTables {
    fn default() -> Self {
        Self::new()
    }
}

impl RainbowTables {
    /// Sums over wavelengths, the sun's disc and both bows: 0.15 s over the threads of rayon's pool. Make it once.
    #[must_use]
    pub fn new() -> Self {
        // Chebyshev's second rule: a disc across a line.
        let disc: [[f64; 2]; DISC] = core::array::from_fn(|j| {
            let turn = (j + 1) as f64 / (DISC + 1) as f64 * PI;
            let sin = ops::sin(turn);
            [SUN_RAD * ops::cos(turn), 2.0 * sin * sin / (DISC + 1) as f64]
        });
        let wavelengths = wavelengths();
        let spectra: Vec<_> = wavelengths
            .par_iter()
            .map(|(um, _)| of_wavelength(*um, &disc))
            .collect();
        let mut sizes = vec![[[0.0; 3]; BOW_KNOTS]; SIZES];
        for (size, bow) in sizes.iter_mut().enumerate() {
            for (knot, entry) in bow.iter_mut().enumerate() {
                *entry = core::array::from_fn(|channel| {
                    let lit = wavelengths.iter().zip(&spectra);
                    lit.map(|((_, colour), light)| colour[channel] * light[knot][size])
                        .sum::<f64>() as f32
                });
            }
        }
        Self { sizes }
    }

    /// The bow of rain, each drop by its cross-section. Without drops: nothing.
    ///
    /// Error: 2 % of its greatest against a sum over 300 sizes of drops, each wavelength by itself.
    #[must_use]
    pub fn of_rain(&self, spectrum: &Spectrum) -> RainbowPhase {
        // ∫ N D² dD = ∫ N D³ d(ln D), in hats about each size.
        let share = |size: usize| {
            let middle = ops::ln(2e-3 * radius_um(size));
            GaussLegendre::<16>::RULE.integrate_panels(-BAND, BAND, 2, |off| {
                let d = ops::exp(middle + off);
                spectrum.concentration(d) * d * d * d * (1.0 - off.abs() / BAND)
            })
        };
        self.mixed(core::array::from_fn(share))
    }

    /// The bow of drops of about one radius (standard deviation 12 %): 5 to 15 µm is fog, 50 to 250 µm drizzle.
    ///
    /// `radius_m`: m, clamped to [2e-6, 4.8e-3], NaN counts as 5e-4.
    ///
    /// Error: 10 % of the luminance of its brightest half degree against rays of each wavelength, for the largest drops;
    /// Airy's theory fails below 10 µm.
    #[must_use]
    pub fn of_radius(&self, radius_m: f64) -> RainbowPhase {
        let last = FIRST_UM * ops::exp(BAND * (SIZES - 1) as f64);
        let radius = clamped_or(radius_m * 1e6, FIRST_UM, last, 500.0);
        let place = ops::ln(radius / FIRST_UM) / BAND;
        self.mixed(core::array::from_fn(|size| {
            (1.0 - (place - size as f64).abs()).max(0.0)
        }))
    }

    fn mixed(&self, shares: [f64; SIZES]) -> RainbowPhase {
        let total: f64 = shares.iter().sum();
        let by = if total > 0.0 { 1.0 / total } else { 0.0 };
        let rgb_per_sr = core::array::from_fn(|knot| {
            let mut sum = [0.0; 3];
            for (size, share) in self.sizes.iter().zip(shares) {
                for (sum, value) in sum.iter_mut().zip(size[knot]) {
                    *sum += share * by * f64::from(value);
                }
            }
            let [r, g, b] = shown(sum).map(|v| v as f32);
            [r, g, b, 0.0]
        });
        RainbowPhase { rgb_per_sr }
    }
}

/// Light of every size at every entry, at one wavelength.
fn of_wavelength(wavelength_um: f64, disc: &[[f64; 2]]) -> Vec<[f64; SIZES]> {
    let band = AiryBand::get();
    let rays = BowRays::new(super::water_index(wavelength_um));
    let roots: [f64; SIZES] = core::array::from_fn(|size| ops::cbrt(2.0 * PI * radius_um(size) / wavelength_um));
    (0..BOW_KNOTS)
        .map(|knot| {
            let mut sums = [0.0; SIZES];
            for [off, weight] in disc {
                for light in rays.light(knot_rad(knot) + off) {
                    for (sum, root) in sums.iter_mut().zip(roots) {
                        *sum += weight * light_of(band, light, root);
                    }
                }
            }
            sums
        })
        .collect()
}

/// Radius of a size. Units: µm.
fn radius_um(size: usize) -> f64 {
    FIRST_UM * ops::exp(BAND * size as f64)
}

/// Drawn to grey until nothing is negative.
fn shown(colour: [f64; 3]) -> [f64; 3] {
    let luminance: f64 = colour.iter().zip(crate::haze::LUMA_LINEAR).map(|(c, l)| c * l).sum();
    let least = colour.iter().fold(0.0_f64, |a, b| a.min(*b));
    if least >= 0.0 {
        return colour;
    }
    if luminance <= 0.0 {
        return [0.0; 3];
    }
    let keep = luminance / (luminance - least);
    colour.map(|c| (luminance + (c - luminance) * keep).max(0.0))
}
