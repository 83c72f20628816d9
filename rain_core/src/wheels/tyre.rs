//! A tyre, as far as water goes.

use serde::{Deserialize, Serialize};

use crate::error::{ConfigError, in_range};

/// A tyre's parameters.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Tyre {
    /// Width of the contact b. Units: m. Domain: (0.001, 3]. Default: 0.2.
    pub width_m: f64,
    /// Radius of the wheel. Units: m. Domain: [0.01, 3]. Default: 0.31.
    pub radius_m: f64,
    /// Depth of the tread. Units: mm. Domain: [0, 50]. Default: 8 (new).
    pub tread_mm: f64,
    /// Share of the width that is grooves, K_t. Units: none. Domain: [0, 1]. Default: 0.25.
    pub groove_share: f64,
    /// Share of the tread's depth that water fills as the wheel carries it up. Units: none. Domain: [0, 1].
    /// Default: 0.1: h_tp = 0.8 mm of a new tread. A choice: more, and the spray behind grows at the cost of bow and
    /// side.
    pub carried_share: f64,
    /// Thickest film that clings to the rubber, h_ca. Units: mm. Domain: [0, 5]. Default: 0.1.
    pub adhesion_mm: f64,
    /// Share of the remaining water that goes into the bow wave, the rest into the side waves. Units: none.
    /// Domain: [0, 1]. Default: 0.4, a choice.
    pub bow_share: f64,
    /// Inflation pressure. Units: kPa. Domain: [10, 2000]. Default: 220.
    pub pressure_kpa: f64,
}

impl Default for Tyre {
    fn default() -> Self {
        Self {
            width_m: 0.2,
            radius_m: 0.31,
            tread_mm: 8.0,
            groove_share: 0.25,
            carried_share: 0.1,
            adhesion_mm: 0.1,
            bow_share: 0.4,
            pressure_kpa: 220.0,
        }
    }
}

impl Tyre {
    /// These parameters, if they lie in their domains.
    ///
    /// # Errors
    /// Names the first field that does not.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range("width_m", self.width_m, 0.001, 3.0, "0.001 to 3 m")?;
        in_range("radius_m", self.radius_m, 0.01, 3.0, "0.01 to 3 m")?;
        in_range("tread_mm", self.tread_mm, 0.0, 50.0, "0 to 50 mm")?;
        in_range("groove_share", self.groove_share, 0.0, 1.0, "0 to 1")?;
        in_range("carried_share", self.carried_share, 0.0, 1.0, "0 to 1")?;
        in_range("adhesion_mm", self.adhesion_mm, 0.0, 5.0, "0 to 5 mm")?;
        in_range("bow_share", self.bow_share, 0.0, 1.0, "0 to 1")?;
        in_range("pressure_kpa", self.pressure_kpa, 10.0, 2000.0, "10 to 2000 kPa")?;
        Ok(self)
    }

    /// Depth of film that the grooves carry, h_tp. Units: mm.
    ///
    /// Error: exact, one product; [`Self::carried_share`] is a choice.
    #[must_use]
    pub fn carried_mm(&self) -> f64 {
        self.carried_share * self.tread_mm
    }

    /// Film that the grooves can take in under the tyre, K_t times the tread's depth. Units: mm. A choice: deeper water
    /// cannot leave through them.
    ///
    /// Error: exact, one product.
    #[must_use]
    pub fn groove_void_mm(&self) -> f64 {
        self.groove_share * self.tread_mm
    }
}
