//! How the rain beyond single drops is drawn.

use std::path::PathBuf;

use bevy::prelude::*;
use rain_core::error::ConfigError;
use rain_core::rainfall::{LatticePlan, LatticeSettings, StreakTextureSettings};

/// Cards of many drops each, in all views whose [`RainView::cards`](super::RainView::cards) is set. Contrast, shutter and
/// the distance at which single drops end are those of each view.
#[derive(Resource, Clone, Debug, PartialEq, Default)]
pub struct CardSettings {
    /// Sizes of cells, range, skips. A `max_cards` of 0 draws none.
    pub lattice: LatticeSettings,
    /// The pictures of streaks. Their distribution is that of the weather, whatever is set here. A shutter other than
    /// theirs stretches the pictures.
    pub textures: StreakTextureSettings,
    /// A folder that keeps the pictures as KTX2 (`rain bake streaks` fills one). What it lacks is made on the CPU and
    /// stored, within the frame. Default: none, they are made on the GPU when the first cards are drawn.
    pub cache: Option<PathBuf>,
}

impl CardSettings {
    /// These settings, if every field lies in its domain.
    ///
    /// # Errors
    /// As [`LatticePlan::new`].
    pub fn validated(self) -> Result<Self, ConfigError> {
        LatticePlan::new(self.lattice.clone(), &self.textures)?;
        Ok(self)
    }
}
