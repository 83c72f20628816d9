//! Streak textures as they are uploaded and stored: half floats, level by level.

use super::half::{from_half, to_half};
use super::raster::StreakTextures;
use super::settings::StreakTextureSettings;
use crate::error::ConfigError;

/// All layers of all levels as half floats.
#[derive(Debug, Clone, PartialEq)]
pub struct PackedStreaks {
    settings: StreakTextureSettings,
    /// The finest level first; in each, layer by layer, row by row.
    levels: Vec<Vec<u16>>,
}

impl PackedStreaks {
    /// Texels that something else has made: `levels` from the finest on, each layer by layer, row by row, as half
    /// floats of opacity over the layer's unit. `None` when their number is not that of the settings, or one is negative
    /// or not finite.
    #[must_use]
    pub fn new(settings: &StreakTextureSettings, levels: Vec<Vec<u16>>) -> Option<Self> {
        let fits = levels.len() == settings.level_count() as usize
            && levels.iter().enumerate().all(|(level, texels)| {
                let side = (settings.texels >> level) as usize;
                // From 0x7C00 on: infinite, not a number, or negative.
                texels.len() == side * side * settings.layer_count() && texels.iter().all(|&t| t < 0x7C00)
            });
        fits.then(|| Self {
            settings: settings.clone(),
            levels,
        })
    }

    /// Draws every layer on the CPU.
    ///
    /// # Errors
    /// As [`StreakTextureSettings::layers`].
    pub fn bake(settings: &StreakTextureSettings) -> Result<Self, ConfigError> {
        StreakTextures::bake(settings).map(|set| Self::from(&set))
    }

    /// What they were made from.
    #[must_use]
    pub fn settings(&self) -> &StreakTextureSettings {
        &self.settings
    }

    /// Half floats, the finest level first; in each, layer by layer, row by row.
    #[must_use]
    pub fn levels(&self) -> &[Vec<u16>] {
        &self.levels
    }

    /// Opacity over unit of the texels of one layer and level.
    pub fn texels(&self, layer: usize, level: usize) -> impl Iterator<Item = f32> + '_ {
        let side = (self.settings.texels >> level) as usize;
        let count = side * side;
        self.levels[level][layer * count..(layer + 1) * count]
            .iter()
            .map(|&half| from_half(half))
    }
}

impl From<&StreakTextures> for PackedStreaks {
    fn from(set: &StreakTextures) -> Self {
        let levels = (0..set.settings.level_count() as usize)
            .map(|level| {
                set.textures
                    .iter()
                    .flat_map(|texture| texture.levels[level].iter().map(|&t| to_half(t)))
                    .collect()
            })
            .collect();
        Self {
            settings: set.settings.clone(),
            levels,
        }
    }
}
