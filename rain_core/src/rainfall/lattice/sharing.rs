//! The account of single drops, cards and haze.

use super::card::pitch_weight;
use super::plan::{LatticePlan, Slice};
use crate::error::{ConfigError, in_range};
use crate::haze::{near_depth_m, ramp_integral_m, transmittance};
use crate::rainfall::{DrawRange, Spectrum};

/// What single drops and cards take out of the light in one rain and view, and what is left to haze.
///
/// Error: single drops, cards and haze together are Q σ_geo s within 1e-12 relative, for every way and direction.
#[derive(Debug, Clone, PartialEq)]
pub struct LatticeSharing {
    slices: Vec<(Slice, [f64; 2])>,
    end_m: [f64; 2],
    total_per_m: f64,
}

impl LatticeSharing {
    /// The account of `plan` in a rain. `range`: how far single drops are drawn; `efficiency`: Q, in [1, 4].
    ///
    /// # Errors
    /// When Q is not finite or outside [1, 4].
    pub fn new(
        plan: &LatticePlan,
        spectrum: &Spectrum,
        range: &DrawRange,
        efficiency: f64,
    ) -> Result<Self, ConfigError> {
        let q = in_range("efficiency", efficiency, 1.0, 4.0, "1 to 4")?;
        Ok(Self {
            slices: plan
                .slices(spectrum, range)
                .into_iter()
                .map(|slice| (slice, plan.settings().ramp_m(0, slice.range_m)))
                .collect(),
            end_m: plan.settings().end_ramp_m(),
            total_per_m: q * spectrum.extinction_per_m(0.0, f64::INFINITY),
        })
    }

    /// Optical depth of the single drops on a way (m, clamped to [0, 1e9], NaN counts as 0). Units: none.
    #[must_use]
    pub fn near_depth(&self, way_m: f64) -> f64 {
        self.slices
            .iter()
            .map(|(slice, _)| slice.extinction_per_m * near_depth_m(way_m, slice.range_m))
            .sum()
    }

    /// Optical depth of the cards on a way in a direction. Units: none.
    ///
    /// `cos_pitch`: length of the direction's horizontal part, none; below cos 60° there are no cards.
    #[must_use]
    pub fn card_depth(&self, way_m: f64, cos_pitch: f64) -> f64 {
        let [end_from, end_to] = self.end_m;
        let end = ramp_integral_m(way_m, end_from, end_to);
        let metres: f64 = self
            .slices
            .iter()
            .filter(|(slice, _)| slice.class.is_some())
            .map(|(slice, [from, to])| slice.extinction_per_m * (ramp_integral_m(way_m, *from, *to) - end))
            .sum();
        metres * pitch_weight(cos_pitch)
    }

    /// Optical depth of the whole rain. Units: none.
    #[must_use]
    pub fn total_depth(&self, way_m: f64) -> f64 {
        if way_m > 0.0 {
            self.total_per_m * way_m.min(1e9)
        } else {
            0.0
        }
    }

    /// Optical depth left to haze. Units: none, never negative.
    #[must_use]
    pub fn fog_depth(&self, way_m: f64, cos_pitch: f64) -> f64 {
        (self.total_depth(way_m) - self.near_depth(way_m) - self.card_depth(way_m, cos_pitch)).max(0.0)
    }

    /// Share of the light from behind that haze lets through: by this rain dims what lies beyond. Units: none.
    #[must_use]
    pub fn fog_transmittance(&self, way_m: f64, cos_pitch: f64) -> f64 {
        transmittance(self.fog_depth(way_m, cos_pitch))
    }
}
