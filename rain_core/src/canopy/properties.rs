//! What a crown does with rain: how much it holds, how much falls through its gaps.

use serde::{Deserialize, Serialize};

use crate::error::{ConfigError, clamped, in_range};
use crate::ops;

/// Largest leaf area index accepted. Units: m² of leaves per m² of ground.
pub(super) const MAX_LEAF_AREA_INDEX: f64 = 20.0;

/// Leaves, as far as storage goes.
#[derive(Default, Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CanopyKind {
    /// Broad leaves: 0.15 mm per unit of leaf area index.
    #[default]
    Broadleaf,
    /// Needles: 0.20 mm per unit of leaf area index.
    Needle,
}

impl CanopyKind {
    /// Storage per unit of leaf area index. Units: mm. Source: Watanabe & Mizutani 1996, in Weber et al. 2016, eq. 1.
    ///
    /// Error: exact, the source's numbers; real crowns differ by a factor of two.
    #[must_use]
    pub fn storage_mm_per_leaf_area(self) -> f64 {
        match self {
            Self::Broadleaf => 0.15,
            Self::Needle => 0.20,
        }
    }
}

/// A crown's parameters. All depths are over the crown's projection on the ground.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CanopyProperties {
    /// Broad leaves or needles. Default: broad leaves.
    pub kind: CanopyKind,
    /// Leaf area index. Units: m²/m². Domain: [0, 20]. Default: 4.
    pub leaf_area_index: f64,
    /// Extinction κ of gaps with leaf area: e^(−κ LAI) of the rain meets no leaf. Units: none. Domain: [0, 5].
    /// Default: 0.5, leaves turned all ways; a choice.
    pub gap_extinction: f64,
    /// Largest share of the intercepted rain that drips, the rest runs down the trunk. Units: none. Domain: [0, 1].
    /// Default: 0.8; the source gives 0.7 to 0.9.
    pub max_drip_fraction: f64,
}

impl Default for CanopyProperties {
    fn default() -> Self {
        Self {
            kind: CanopyKind::Broadleaf,
            leaf_area_index: 4.0,
            gap_extinction: 0.5,
            max_drip_fraction: 0.8,
        }
    }
}

impl CanopyProperties {
    /// These parameters, if they lie in their domains.
    ///
    /// # Errors
    /// Names the first field that does not.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range("lai", self.leaf_area_index, 0.0, MAX_LEAF_AREA_INDEX, "0 to 20")?;
        in_range("gap_extinction", self.gap_extinction, 0.0, 5.0, "0 to 5")?;
        in_range("max_drip_fraction", self.max_drip_fraction, 0.0, 1.0, "0 to 1")?;
        Ok(self)
    }

    /// Storage capacity S = 0.15 LAI (broad leaves) or 0.20 LAI (needles). Units: mm.
    ///
    /// Source: Watanabe & Mizutani 1996, in Weber et al. 2016, eq. 1.
    ///
    /// Error: 5e-16 relative; real crowns differ by a factor of two.
    #[must_use]
    pub fn capacity_mm(&self) -> f64 {
        self.kind.storage_mm_per_leaf_area() * self.leaf_area_index
    }

    /// Share of the rain that meets no leaf, p = e^(−κ LAI). Units: none, (0, 1].
    ///
    /// Source: Beer's law for gaps.
    ///
    /// Error: 1e-15 relative; clumped leaves let more through.
    #[must_use]
    pub fn free_share(&self) -> f64 {
        ops::exp(-self.gap_extinction * self.leaf_area_index)
    }

    /// Share of the rain that leaves catch, 1 − p without cancellation in thin crowns. Units: none, [0, 1).
    ///
    /// Error: 1e-15 relative; clumped leaves let more through.
    #[must_use]
    pub fn intercepted_share(&self) -> f64 {
        -ops::exp_m1(-self.gap_extinction * self.leaf_area_index)
    }
}

/// Time until the crown holds all it can under constant rain without evaporation, t_sat = 7200 S/R.
///
/// `capacity_mm` in mm, `rain_mm_h` in mm/h. Units: s. `None` where the rain is not above 0 or either is not finite;
/// a negative capacity counts as 0. Source: Weber et al. 2016, eq. 2.
///
/// Error: 5e-16 relative.
#[must_use]
pub fn saturation_time_s(capacity_mm: f64, rain_mm_h: f64) -> Option<f64> {
    let time = 7200.0 * capacity_mm.max(0.0) / rain_mm_h;
    (rain_mm_h > 0.0 && capacity_mm.is_finite() && time.is_finite() && rain_mm_h.is_finite()).then_some(time)
}

/// Drip fraction under constant rain from a dry start, q = min(t/t_sat, q_max): the source's form, for comparison with
/// the state form of [`CanopyStore`](super::CanopyStore).
///
/// `elapsed_s` since the rain began and `saturation_time_s` in s; `max_drip_fraction` in [0, 1]. What is not a number
/// counts as 0; with a saturation time of 0 the fraction is `max_drip_fraction` at once.
/// Source: Weber et al. 2016, eq. 3 (its condition corrected: the plateau starts at q_max t_sat).
/// Error: 2e-16; equal to the state form to 1e-14 while rain is constant and nothing evaporates.
#[must_use]
pub fn constant_rain_drip_fraction(elapsed_s: f64, saturation_time_s: f64, max_drip_fraction: f64) -> f64 {
    let cap = clamped(max_drip_fraction, 0.0, 1.0);
    let elapsed = clamped(elapsed_s, 0.0, f64::MAX);
    let time = clamped(saturation_time_s, 0.0, f64::MAX);
    if elapsed >= cap * time { cap } else { elapsed / time }
}
