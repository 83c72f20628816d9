//! Whose rules wet surfaces look by: physics, or those of the artists' source systems.

use bevy::prelude::*;
use rain_core::surface::artist_look::ArtistRules;
use serde::{Deserialize, Serialize};

/// How wet surfaces look. As a resource: all of them; change it at any time. [`super::SurfaceWetting::look`] says it for
/// a mesh alone.
///
/// Only the look changes: where it is wet, how wet, and where water stands is the same.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[reflect(Resource, Default)]
pub enum WetLook {
    /// Darkened by total reflection inside the film (Lekner & Dorf 1988), smoothed by the film. The default.
    #[default]
    Physical,
    /// Diffuse down to 0.3, gloss up to 2.5 times, water flat with F₀ 0.02 (Lagarde 2013): darker and glossier.
    Lagarde,
    /// The same by porosity, guessed from roughness and metalness or given: smooth surfaces and metals stay as they are
    /// (Lagarde 2013, part 3b).
    LagardePorous,
    /// As [`WetLook::Lagarde`], but water darkens once more, to 0.8 (Nguyenova 2021).
    Nguyenova,
}

impl WetLook {
    /// The source's rules; none for physics.
    #[must_use]
    pub fn rules(self) -> Option<ArtistRules> {
        match self {
            Self::Physical => None,
            Self::Lagarde => Some(ArtistRules::Lagarde),
            Self::LagardePorous => Some(ArtistRules::LagardePorous),
            Self::Nguyenova => Some(ArtistRules::Nguyenova),
        }
    }

    /// The number of its rules in the shaders.
    pub(super) fn number(self) -> f32 {
        self.rules().map_or(0.0, |rules| match rules {
            ArtistRules::Lagarde => 1.0,
            ArtistRules::LagardePorous => 2.0,
            ArtistRules::Nguyenova => 3.0,
        })
    }
}
