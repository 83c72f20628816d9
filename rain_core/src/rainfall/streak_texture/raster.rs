//! Drawing a layer: every streak with its footprint on texels, overlaps, mips.

use core::f64::consts::FRAC_PI_2;

use rayon::prelude::*;

use super::layer::{StreakLayer, TileDrop};
use super::settings::StreakTextureSettings;
use crate::error::ConfigError;
use crate::ops;

/// Steps of the overlap sum in one [`StreakLayer::unit`]: whole numbers, so that the order of streaks does not matter,
/// on the CPU or a GPU.
pub const OVERLAP_STEPS: f64 = 1_048_576.0;

/// Largest mean opacity of one streak over a texel.
const MAX_OPACITY: f64 = 0.999;

/// One layer's picture.
#[derive(Debug, Clone, PartialEq)]
pub struct StreakTexture {
    /// What it shows.
    pub layer: StreakLayer,
    /// Opacity over [`StreakLayer::unit`], row by row, the finest level first. Columns run across, rows along the fall.
    pub levels: Vec<Vec<f32>>,
}

impl StreakTexture {
    /// Draws a layer of `texels` a side.
    ///
    /// Streaks that cross an edge go on at the opposite one. A texel holds the mean opacity of each streak over its
    /// area, exact across (the disc's chord), ends ramping over a diameter along; streaks in one texel multiply their
    /// transmittances. Mips are means of opacity, so every level has the same mean.
    ///
    /// Error: mean opacity of a layer 2e-3 relative against 1 − e^(−σ · tile); that of a level 1e-6 against the finest;
    /// texels 0.03 of their sum against means over 24² points of the disc's way.
    #[must_use]
    pub fn draw(layer: &StreakLayer, texels: u32) -> Self {
        let side = texels.max(1) as usize;
        let mut overlap = vec![0_u32; side * side];
        let path = layer.path_texels();
        for drop in layer.tile_drops() {
            add_streak(&mut overlap, side, &drop, path, layer.unit);
        }
        let finest: Vec<f32> = overlap
            .iter()
            .map(|&steps| {
                let depth = f64::from(steps) / OVERLAP_STEPS * layer.unit;
                (-ops::exp_m1(-depth) / layer.unit) as f32
            })
            .collect();
        let mut levels = vec![finest];
        let mut side = side;
        while side > 1 {
            let above = &levels[levels.len() - 1];
            let half = side / 2;
            let next = (0..half * half)
                .map(|i| {
                    let at = 2 * (i / half) * side + 2 * (i % half);
                    0.25 * (above[at] + above[at + 1] + above[at + side] + above[at + side + 1])
                })
                .collect();
            levels.push(next);
            side = half;
        }
        Self { layer: *layer, levels }
    }

    /// Mean opacity of a level. Units: none.
    #[must_use]
    pub fn mean_opacity(&self, level: usize) -> f64 {
        let texels = &self.levels[level];
        let sum: f64 = texels.iter().map(|&t| f64::from(t)).sum();
        sum / texels.len() as f64 * self.layer.unit
    }
}

/// Area of a disc of diameter `d` to the left of a line `x` from its centre.
fn disc_left_of(x: f64, d: f64) -> f64 {
    let t = (2.0 * x / d).clamp(-1.0, 1.0);
    let root = ops::sqrt((1.0 - t) * (1.0 + t));
    0.25 * d * d * (t * root + ops::atan2(t, root) + FRAC_PI_2)
}

/// ∫ of a ramp from 0 to 1 over [−d/2, d/2].
fn ramp_up_to(y: f64, d: f64) -> f64 {
    if y <= -0.5 * d {
        0.0
    } else if y < 0.5 * d {
        (y + 0.5 * d) * (y + 0.5 * d) / (2.0 * d)
    } else {
        y
    }
}

/// Adds −ln(1 − ᾱ) of one streak to the texels that it touches.
fn add_streak(overlap: &mut [u32], side: usize, drop: &TileDrop, path: f64, unit: f64) {
    let (x, y) = (f64::from(drop.x), f64::from(drop.y));
    let (d, share) = (f64::from(drop.diameter), f64::from(drop.share));
    let radius = 0.5 * d;
    let columns = (x - radius).floor() as i64..=(x + radius).floor() as i64;
    let rows = (y - radius).floor() as i64..=(y + path + radius).floor() as i64;
    let size = side as i64;
    for column in columns {
        let left = column as f64 - x;
        let across = disc_left_of(left + 1.0, d) - disc_left_of(left, d);
        for row in rows.clone() {
            let top = row as f64 - y;
            let along = ramp_up_to(top + 1.0, d) - ramp_up_to(top, d) - ramp_up_to(top + 1.0 - path, d)
                + ramp_up_to(top - path, d);
            let opacity = (share * across * along / path).clamp(0.0, MAX_OPACITY);
            let steps = (-ops::ln_1p(-opacity) / unit * OVERLAP_STEPS + 0.5) as u32;
            let at = (row.rem_euclid(size) * size + column.rem_euclid(size)) as usize;
            overlap[at] = overlap[at].saturating_add(steps);
        }
    }
}

/// A whole set of streak textures.
#[derive(Debug, Clone, PartialEq)]
pub struct StreakTextures {
    /// What it was made from.
    pub settings: StreakTextureSettings,
    /// The layers in the array's order.
    pub textures: Vec<StreakTexture>,
}

impl StreakTextures {
    /// Draws every layer; layers in parallel, the same result on any number of threads.
    ///
    /// # Errors
    /// As [`StreakTextureSettings::layers`].
    pub fn bake(settings: &StreakTextureSettings) -> Result<Self, ConfigError> {
        let layers = settings.layers()?;
        Ok(Self {
            settings: settings.clone(),
            textures: layers
                .par_iter()
                .map(|layer| StreakTexture::draw(layer, settings.texels))
                .collect(),
        })
    }
}
