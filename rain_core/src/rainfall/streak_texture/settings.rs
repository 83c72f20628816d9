//! What streak textures are made from, and the key that tells them apart.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

use crate::error::{ConfigError, in_range};
use crate::rainfall::{CLASS_EDGES_MM, Distribution, MAX_INTENSITY_MM_H, Spectrum};

use super::layer::StreakLayer;

/// Raised whenever the same settings give other pictures: files of older versions are made anew.
pub const STREAK_TEXTURE_VERSION: u32 = 1;

/// Layers that every graphics device takes in one array.
pub const MAX_STREAK_LAYERS: usize = 256;

/// Most bytes of all layers, half a gibibyte.
const MAX_BYTES: f64 = 536_870_912.0;

/// Most drops in one layer.
const MAX_DROPS: f64 = 1_048_576.0;

/// Everything that streak textures depend on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct StreakTextureSettings {
    /// Family of drop sizes. Default: Marshall–Palmer.
    pub distribution: Distribution,
    /// Rain rates, rising. Units: mm/h. Domain: each in [0.01, 500]. Default: 1, 5, 25, 100.
    pub intensities_mm_h: Vec<f64>,
    /// Borders of the size classes, rising. Units: mm. Domain: each in [0.1, 10]. Default: every second border of the
    /// drop field's, so that six classes hold what it draws.
    pub diameter_edges_mm: Vec<f64>,
    /// Texels along a side of the finest level: a power of two in [32, 2048]. Default: 512.
    pub texels: u32,
    /// Side of the cube. Units: m. Domain: [0.25, 4]. Default: 1.
    pub tile_m: f64,
    /// Shutter time. Units: s. Domain: [1e-4, 0.1]. Default: 1/60.
    pub exposure_s: f64,
    /// Seed of the drops' places.
    pub seed: u64,
}

impl Default for StreakTextureSettings {
    fn default() -> Self {
        Self {
            distribution: Distribution::MarshallPalmer,
            intensities_mm_h: vec![1.0, 5.0, 25.0, 100.0],
            diameter_edges_mm: CLASS_EDGES_MM.iter().copied().step_by(2).collect(),
            texels: 512,
            tile_m: 1.0,
            exposure_s: 1.0 / 60.0,
            seed: 1,
        }
    }
}

impl StreakTextureSettings {
    /// The source's set: 1, 5, 10 and 20 mm/h, diameters 1.0 to 2.0 mm in steps of 0.2, 512 texels to the metre, 1/30 s.
    ///
    /// It holds 49 to 63 % of the water and 2.5 to 13 % of the drops; who draws it leaves the rest to haze.
    #[must_use]
    pub fn yoshida() -> Self {
        Self {
            intensities_mm_h: vec![1.0, 5.0, 10.0, 20.0],
            diameter_edges_mm: vec![0.9, 1.1, 1.3, 1.5, 1.7, 1.9, 2.1],
            exposure_s: 1.0 / 30.0,
            ..Self::default()
        }
    }

    /// Number of size classes.
    #[must_use]
    pub fn class_count(&self) -> usize {
        self.diameter_edges_mm.len().saturating_sub(1)
    }

    /// Number of layers: rates times classes, rates outermost.
    #[must_use]
    pub fn layer_count(&self) -> usize {
        self.intensities_mm_h.len() * self.class_count()
    }

    /// Number of mip levels, down to one texel.
    #[must_use]
    pub fn level_count(&self) -> u32 {
        self.texels.max(1).ilog2() + 1
    }

    /// Bytes of all layers and levels, two a texel.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let texels: usize = (0..self.level_count())
            .map(|level| ((self.texels >> level) as usize).pow(2))
            .sum();
        2 * texels * self.layer_count()
    }

    /// The layers, in the order of the array: all classes of the first rate, then those of the next.
    ///
    /// # Errors
    /// When a setting is outside its domain, a list does not rise, there are more than [`MAX_STREAK_LAYERS`] layers or
    /// half a gibibyte of texels, or a layer would hold more than a million drops.
    pub fn layers(&self) -> Result<Vec<StreakLayer>, ConfigError> {
        rising(
            "intensities_mm_h",
            &self.intensities_mm_h,
            1,
            0.01,
            MAX_INTENSITY_MM_H,
            "0.01 to 500 mm/h",
        )?;
        rising(
            "diameter_edges_mm",
            &self.diameter_edges_mm,
            2,
            0.1,
            10.0,
            "0.1 to 10 mm",
        )?;
        in_range(
            "layers (intensities_mm_h times classes)",
            self.layer_count() as f64,
            1.0,
            MAX_STREAK_LAYERS as f64,
            "1 to 256",
        )?;
        let texels = f64::from(self.texels);
        in_range(
            "texels",
            texels,
            // A number that is no power of two is below no limit that it meets.
            if self.texels.is_power_of_two() {
                32.0
            } else {
                f64::INFINITY
            },
            2048.0,
            "a power of two from 32 to 2048",
        )?;
        in_range(
            "texels (bytes of all layers)",
            self.bytes() as f64,
            0.0,
            MAX_BYTES,
            "at most 536870912, half a gibibyte",
        )?;
        in_range("tile_m", self.tile_m, 0.25, 4.0, "0.25 to 4 m")?;
        in_range("exposure_s", self.exposure_s, 1e-4, 0.1, "1e-4 to 0.1 s")?;
        // Classes keep their speed at every rate, so that a change of the rain moves no streak.
        let held = Spectrum::new(self.distribution, 25.0)?;
        let mut layers = Vec::with_capacity(self.layer_count());
        for &intensity in &self.intensities_mm_h {
            let spectrum = Spectrum::new(self.distribution, intensity)?;
            for edges in self.diameter_edges_mm.windows(2) {
                let layer = StreakLayer::new(&spectrum, &held, [edges[0], edges[1]], self);
                in_range(
                    "tile_m (drops in a layer)",
                    f64::from(layer.drops),
                    0.0,
                    MAX_DROPS,
                    "a cube with at most 1048576 drops of a class",
                )?;
                layers.push(layer);
            }
        }
        Ok(layers)
    }

    /// All settings and the version as one line of text: equal exactly when the pictures are.
    #[must_use]
    pub fn key_text(&self) -> String {
        let list = |values: &[f64]| {
            let words: Vec<String> = values.iter().map(f64::to_string).collect();
            words.join(",")
        };
        let distribution = match self.distribution {
            Distribution::MarshallPalmer => "marshall_palmer",
            Distribution::Drizzle => "drizzle",
            Distribution::Widespread => "widespread",
            Distribution::Thunderstorm => "thunderstorm",
        };
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = write!(
            text,
            "version={STREAK_TEXTURE_VERSION};distribution={distribution};intensities_mm_h={};diameter_edges_mm={};\
             texels={};tile_m={};exposure_s={};seed={}",
            list(&self.intensities_mm_h),
            list(&self.diameter_edges_mm),
            self.texels,
            self.tile_m,
            self.exposure_s,
            self.seed
        );
        text
    }

    /// Hash of [`StreakTextureSettings::key_text`]: names a file, and tells a host that nothing has changed.
    #[must_use]
    pub fn key(&self) -> u64 {
        fnv1a(self.key_text().as_bytes())
    }
}

/// FNV-1a on 64 bits. Source: Fowler, Noll & Vo 1991.
pub(super) fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// At least `least` finite values in a range, each above the one before it.
fn rising(
    field: &'static str,
    values: &[f64],
    least: usize,
    min: f64,
    max: f64,
    allowed: &'static str,
) -> Result<(), ConfigError> {
    if values.len() < least {
        return Err(ConfigError::Empty { field });
    }
    for (index, &value) in values.iter().enumerate() {
        in_range(field, value, min, max, allowed)?;
        if index > 0 && value <= values[index - 1] {
            return Err(ConfigError::NotIncreasing {
                field,
                index,
                value,
                previous: values[index - 1],
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_hashes() {
        // From the authors' test vectors.
        assert_eq!(fnv1a(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv1a(b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fnv1a(b"foobar"), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn the_default_set_has_four_rates_and_six_classes() {
        let settings = StreakTextureSettings::default();
        assert_eq!((settings.layer_count(), settings.class_count()), (24, 6));
        assert_eq!(settings.level_count(), 10);
        assert_eq!(settings.layers().expect("a set").len(), 24);
        assert_eq!(settings.diameter_edges_mm[0], 0.5);
        assert_eq!(settings.diameter_edges_mm[6], 6.0);
        // 24 · 512² · 4/3 texels of two bytes.
        assert_eq!(settings.bytes(), 24 * 2 * 349_525);
    }
}
