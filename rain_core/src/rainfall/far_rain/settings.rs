//! What users set.

use crate::error::{ConfigError, in_range};

/// Largest accepted number of far particles in a view.
pub const MAX_FAR_PARTICLES: u32 = 100_000;

/// How far rain is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FarRainSettings {
    /// Particles in a view, about; twice as many is the hard bound, 0 draws none. Where more would be wanted, they carry
    /// less of the rain and the haze carries more. Domain: [0, 100 000]. Default: 6000.
    pub budget: u32,
    /// Largest share of the visible rain that particles carry; the rest is even haze. Units: none. Domain: [0, 0.95].
    /// Default: 0.6, by eye: with more the curtain falls apart into stripes, with less it stands still.
    pub share: f64,
}

impl Default for FarRainSettings {
    fn default() -> Self {
        Self {
            budget: 6000,
            share: 0.6,
        }
    }
}

impl FarRainSettings {
    /// These settings, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not.
    pub fn validated(self) -> Result<Self, ConfigError> {
        let most = f64::from(MAX_FAR_PARTICLES);
        in_range("budget", f64::from(self.budget), 0.0, most, "0 to 100000")?;
        in_range("share", self.share, 0.0, 0.95, "0 to 0.95")?;
        Ok(self)
    }
}
