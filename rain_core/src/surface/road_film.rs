//! Water above the texture of a road, by the regressions of Gallaway's rain rigs.
//!
//! # Accuracy
//! Fits to pavements of 0.4 to 2 mm texture, slopes of 0.5 to 8 %, up to about 15 m and 50 mm/h. The two fits differ
//! by 8 to 40 % on ordinary roads: that is the error of either. Ruts, wind and kerbs are left out.

use crate::error::{ConfigError, in_range};
use crate::ops;

/// Which regression.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum RoadFilmFit {
    /// Gallaway, Rose & Schiller 1971: 0.0148676 T^0.11 L^0.43 I^0.59 S^(−0.42) − T (often printed with 0.01485).
    Gallaway1971,
    /// Gallaway et al. 1979: 0.0190 T^0.125 L^0.519 I^0.562 S^(−0.364) − T.
    #[default]
    Gallaway1979,
}

impl RoadFilmFit {
    /// Factor and exponents of texture depth (mm), length (m), rain rate (mm/h) and slope.
    fn coefficients(self) -> [f64; 5] {
        match self {
            Self::Gallaway1971 => [0.014_867_6, 0.11, 0.43, 0.59, -0.42],
            Self::Gallaway1979 => [0.019_0, 0.125, 0.519, 0.562, -0.364],
        }
    }
}

/// A road as the regressions see it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoadSurface {
    /// Mean texture depth (sand patch). Units: mm. Domain: [0.01, 10].
    pub texture_depth_mm: f64,
    /// Length of the flow path. Units: m. Domain: [0.1, 1000].
    pub length_m: f64,
    /// Fall along it. Units: none (m/m). Domain: [1e-4, 1].
    pub slope: f64,
}

impl RoadSurface {
    /// This road, if every value lies in its domain.
    ///
    /// # Errors
    /// Names the first value that does not.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range("texture_depth_mm", self.texture_depth_mm, 0.01, 10.0, "0.01 to 10 mm")?;
        in_range("length_m", self.length_m, 0.1, 1e3, "0.1 to 1000 m")?;
        in_range("slope", self.slope, 1e-4, 1.0, "1e-4 to 1")?;
        Ok(self)
    }

    /// Water above the texture. Units: mm. **Negative: the water stands inside the texture**, that far below its
    /// tops; −T without rain.
    ///
    /// Error: 5e-15 of the depth plus the texture; model error 8–40 % (difference of the two fits).
    ///
    /// # Errors
    /// When a value of the road or the rain (domain: [0, 500] mm/h) is outside its domain.
    pub fn film_mm(&self, fit: RoadFilmFit, intensity_mm_h: f64) -> Result<f64, ConfigError> {
        self.validated()?;
        in_range("intensity_mm_h", intensity_mm_h, 0.0, 500.0, "0 to 500 mm/h")?;
        let [_, _, _, rate, _] = fit.coefficients();
        Ok(self.at_unit_rate(fit) * ops::pow(intensity_mm_h, rate) - self.texture_depth_mm)
    }

    /// The rain rate at which the water just covers the texture ([`Self::film_mm`] = 0). Units: mm/h. It may lie
    /// above what falls anywhere. Error: 1e-13 relative.
    ///
    /// # Errors
    /// When a value of the road is outside its domain.
    pub fn covering_intensity_mm_h(&self, fit: RoadFilmFit) -> Result<f64, ConfigError> {
        self.validated()?;
        let [_, _, _, rate, _] = fit.coefficients();
        Ok(ops::pow(self.texture_depth_mm / self.at_unit_rate(fit), 1.0 / rate))
    }

    /// Water with that in the texture at 1 mm/h, mm.
    fn at_unit_rate(&self, fit: RoadFilmFit) -> f64 {
        let [factor, texture, length, _, slope] = fit.coefficients();
        factor
            * ops::exp(
                texture * ops::ln(self.texture_depth_mm)
                    + length * ops::ln(self.length_m)
                    + slope * ops::ln(self.slope),
            )
    }
}
