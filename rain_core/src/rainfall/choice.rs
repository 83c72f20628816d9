//! What the drops of one view are chosen from: handed to the GPU, which chooses them, or to [`Container`] on the CPU.

use std::sync::Arc;

use super::areas::AreaField;
use super::container::{Container, FADE_END, LEAD_CAP_M, RANGE_CAP_M, RainViewVolume, Thinning};
use super::detail::DetailLaw;
use super::field::FieldMotion;
use super::follow::{Follow, FollowSettings};
use super::local::{LocalRain, RateLadder};
use super::spectrum::Spectrum;
use super::view_cells::ViewCells;

/// [`LocalRain`] that holds what it is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct UnevenRain {
    /// The areas at the time shown.
    pub areas: AreaField,
    /// Spectra by rate.
    pub ladder: Arc<RateLadder>,
    /// The weather's rate. Units: mm/h. Domain: [0, 500].
    pub weather_mm_h: f64,
}

impl UnevenRain {
    /// The rain from place to place.
    #[must_use]
    pub fn local(&self) -> LocalRain<'_> {
        LocalRain {
            areas: &self.areas,
            ladder: &self.ladder,
            weather_mm_h: self.weather_mm_h,
        }
    }
}

/// Everything that tells which drops a view draws singly.
#[derive(Debug, Clone, PartialEq)]
pub struct DropChoice {
    /// Seed of the drop field.
    pub seed: u64,
    /// The rain, or the heaviest where it is uneven.
    pub spectrum: Spectrum,
    /// Where each class's frame stands.
    pub motion: FieldMotion,
    /// The view.
    pub view: RainViewVolume,
    /// Quality κ. Units: none.
    pub kappa: f64,
    /// No more drops than this are drawn.
    pub most_drops: u32,
    /// The rain from place to place. `None`: everywhere that of the spectrum.
    pub uneven: Option<Arc<UnevenRain>>,
    /// As [`Thinning::region`].
    pub region: Option<(Follow, FollowSettings)>,
    /// As [`Thinning::detail`].
    pub detail: Option<DetailLaw>,
}

impl DropChoice {
    /// No drop is drawn from further away. Units: m.
    #[must_use]
    pub fn reach_m(&self) -> f64 {
        FADE_END * RANGE_CAP_M + LEAD_CAP_M
    }

    /// The cells that may hold such drops.
    #[must_use]
    pub fn cells(&self) -> ViewCells {
        ViewCells::new(
            &self.spectrum,
            &self.motion,
            &self.view,
            self.kappa,
            self.uneven.is_some(),
        )
    }

    /// Chooses on the CPU; `false`: there are more than [`DropChoice::most_drops`].
    ///
    /// Error: as [`Container::fill_local`].
    #[must_use = "false says that drops were left out"]
    pub fn fill(&self, container: &mut Container) -> bool {
        let local = self.uneven.as_deref().map(UnevenRain::local);
        container.fill_local(
            self.seed,
            &self.spectrum,
            &self.motion,
            &self.view,
            self.kappa,
            self.most_drops as usize,
            &Thinning {
                local: local.as_ref(),
                region: self.region.as_ref().map(|(follow, settings)| (follow, settings)),
                detail: self.detail,
            },
        )
    }
}
