//! One layer: a class of drops at a rain rate, and the drops that its picture shows.

use core::f64::consts::FRAC_PI_4;

use super::settings::StreakTextureSettings;
use crate::hash::{pcg3d, unit_f32};
use crate::haze::obscured;
use crate::ops;
use crate::rainfall::{Spectrum, streak_path_m};

/// One size class at one rain rate.
///
/// Error: numbers, extinction and speed as those of [`Spectrum`], 1e-7 relative; what a layer's drops take out is its
/// extinction within 1e-12 relative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StreakLayer {
    /// Units: mm/h.
    pub intensity_mm_h: f64,
    /// Smallest diameter. Units: mm.
    pub min_mm: f64,
    /// Largest diameter. Units: mm.
    pub max_mm: f64,
    /// Drops in the air. Units: m⁻³.
    pub number_per_m3: f64,
    /// Geometric extinction σ of the class. Units: 1/m.
    pub extinction_per_m: f64,
    /// Speed of the class, the mean over cross-sections at 25 mm/h: the same at every rate. Units: m/s.
    pub speed_m_s: f64,
    /// Way of its drops while the shutter is open. Units: m.
    pub path_m: f64,
    /// Drops in the picture.
    pub drops: u32,
    /// Opacity over that of whole drops: real drops that one in the picture stands for. Units: none.
    pub share: f64,
    /// Opacity of a texel of value 1: the middle of the streak of a mean drop. Units: none, above 0.
    pub unit: f64,
    /// Seed, class by its smallest diameter, and side of the picture: what the drops are drawn from.
    source: Source,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Source {
    stream: [u32; 3],
    slope_per_mm: f64,
    texels_per_m: f64,
    texels: f64,
    tile_m: f64,
}

/// A drop in a layer's picture, in texels. The picture's y runs along the fall.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct TileDrop {
    /// Where the streak begins: the drop's centre when the shutter opens, in [0, texels)².
    pub x: f32,
    /// See `x`.
    pub y: f32,
    /// Diameter. Units: texels.
    pub diameter: f32,
    /// Opacity over that of a whole drop. Units: none.
    pub share: f32,
}

impl StreakLayer {
    pub(super) fn new(
        spectrum: &Spectrum,
        held: &Spectrum,
        [min_mm, max_mm]: [f64; 2],
        settings: &StreakTextureSettings,
    ) -> Self {
        let number_per_m3 = spectrum.moment(0, min_mm, max_mm);
        let extinction_per_m = spectrum.extinction_per_m(min_mm, max_mm);
        let speed_m_s = held.flux_moment(2, min_mm, max_mm) / held.moment(2, min_mm, max_mm);
        let path_m = streak_path_m(speed_m_s, settings.exposure_s);
        let expected = number_per_m3 * settings.tile_m * settings.tile_m * settings.tile_m;
        // More drops, each fainter, rather than fewer: a picture must not be brighter than rain.
        let drops = expected.ceil().clamp(1.0, 1e9) as u32;
        let stream = pcg3d([
            settings.seed as u32,
            (settings.seed >> 32) as u32,
            (min_mm * 1e6).round() as u32,
        ]);
        let texels = f64::from(settings.texels);
        let mut layer = Self {
            intensity_mm_h: spectrum.intensity_mm_h,
            min_mm,
            max_mm,
            number_per_m3,
            extinction_per_m,
            speed_m_s,
            path_m,
            drops,
            share: 1.0,
            unit: 1.0,
            source: Source {
                stream,
                slope_per_mm: spectrum.slope_per_mm,
                texels_per_m: texels / settings.tile_m,
                texels,
                tile_m: settings.tile_m,
            },
        };
        // A million diameters at most; the settings refuse more.
        let area_m2: f64 = (0..drops.min(1 << 20))
            .map(|index| {
                let d = layer.diameter_mm(index) * 1e-3;
                FRAC_PI_4 * d * d
            })
            .sum();
        let tile = settings.tile_m;
        layer.share = extinction_per_m * tile * tile * tile / area_m2;
        let mean_m = ops::sqrt(area_m2 / (FRAC_PI_4 * f64::from(drops)));
        layer.unit = layer.share * (mean_m / path_m).min(1.0);
        layer
    }

    /// Diameter of a drop in the picture: numbers that fill (0, 1) evenly for every count of drops, through the
    /// spectrum's inverse inside the class. Units: mm.
    fn diameter_mm(&self, index: u32) -> f64 {
        let turn = self.source.stream[2];
        let u = (f64::from(index.reverse_bits().wrapping_add(turn)) + 0.5) / 4_294_967_296.0;
        let slope = self.source.slope_per_mm;
        let span = -ops::exp_m1(-slope * (self.max_mm - self.min_mm));
        (self.min_mm - ops::ln_1p(-u * span) / slope).clamp(self.min_mm, self.max_mm)
    }

    /// The drops of the picture. Those of a lighter rain are the first of those of a heavier one, at the same places:
    /// blending two rates moves no streak.
    #[must_use]
    pub fn tile_drops(&self) -> Vec<TileDrop> {
        let [a, b, c] = self.source.stream;
        (0..self.drops)
            .map(|index| {
                let place = pcg3d([a ^ index, b.wrapping_add(index), c]);
                TileDrop {
                    x: unit_f32(place[0]) * self.source.texels as f32,
                    y: unit_f32(place[1]) * self.source.texels as f32,
                    diameter: (self.diameter_mm(index) * 1e-3 * self.source.texels_per_m) as f32,
                    share: self.share as f32,
                }
            })
            .collect()
    }

    /// Length of every streak without its ends. Units: texels.
    #[must_use]
    pub fn path_texels(&self) -> f64 {
        self.path_m * self.source.texels_per_m
    }

    /// Mean opacity that the picture must have, 1 − e^(−σ · tile). Units: none.
    #[must_use]
    pub fn mean_opacity(&self) -> f64 {
        obscured(self.extinction_per_m * self.source.tile_m)
    }
}
