//! One area as it is authored.

use core::f64::consts::PI;

use glam::DVec2;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::density::DensityMap;
use super::field::AreaField;
use super::motion::{AreaFade, AreaMotion};
use super::shape::{AreaShape, MAX_CORNERS};
use crate::error::{ConfigError, in_range};
use crate::rainfall::spectrum::MAX_INTENSITY_MM_H;

/// Most areas that count at once.
pub const MAX_AREAS: usize = 256;
/// Widest transition. Units: m.
pub const MAX_TRANSITION_M: f64 = 1e5;
/// Largest factor on a rate.
const MAX_FACTOR: f64 = 100.0;

/// Why an area is refused.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum AreaError {
    /// A number outside its domain.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// Too few or too many corners.
    #[error("corners_m: {count} corners, allowed: 3 to {MAX_CORNERS}")]
    Corners {
        /// How many.
        count: usize,
    },
    /// Two edges cross, touch or fold; or an edge has no length (both numbers are then the same).
    #[error("corners_m: the edges from corners {} and {} cross, touch or have no length", edges[0], edges[1])]
    Crossing {
        /// Numbers of the corners that the edges start from.
        edges: [usize; 2],
    },
    /// The polygon encloses less than 0.01 m².
    #[error("corners_m: the polygon encloses less than 0.01 m²")]
    NoArea,
}

/// What an area does to the rain.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum AreaRain {
    /// A shower: it rains at this rate, whatever the weather does. Units: mm/h. Domain: [0, 500].
    Rate(f64),
    /// A shower whose rate is this multiple of the weather's. Units: none. Domain: [0, 100].
    OfWeather(f64),
    /// A factor on all rain in the area, of showers too: 0 is a dry hole. Units: none. Domain: [0, 100].
    Scale(f64),
}

impl Default for AreaRain {
    fn default() -> Self {
        Self::OfWeather(1.0)
    }
}

/// A rain area.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AreaSettings {
    /// Centre on the ground (x, z). Units: m. Domain: each within ±1e7. Default: the origin.
    pub centre_m: DVec2,
    /// Outline about it. Default: the whole plane.
    pub shape: AreaShape,
    /// What it does to the rain. Default: the weather's rain.
    pub rain: AreaRain,
    /// Width of the soft edge, half of it on each side of the outline. Units: m. Domain: [0, 1e5]. Default: 20; 0 is a
    /// sharp edge. Showers in nature have 200 to 2000.
    pub transition_m: f64,
    /// How much of its rain falls where, painted: shares that multiply its weight and go along with its centre. Default: all of
    /// it everywhere.
    pub density: Option<DensityMap>,
    /// How it moves. Default: it stays.
    pub motion: AreaMotion,
    /// When it is there. Default: always.
    pub fade: AreaFade,
}

impl Default for AreaSettings {
    fn default() -> Self {
        Self {
            centre_m: DVec2::ZERO,
            shape: AreaShape::default(),
            rain: AreaRain::default(),
            transition_m: 20.0,
            density: None,
            motion: AreaMotion::default(),
            fade: AreaFade::default(),
        }
    }
}

impl AreaSettings {
    /// # Errors
    /// Names the first value that is outside its domain, or what is wrong with the shape.
    pub fn check(&self) -> Result<(), AreaError> {
        for at in self.centre_m.to_array() {
            in_range("centre_m", at, -1e7, 1e7, "-1e7 to 1e7 m")?;
        }
        self.shape.check()?;
        match self.rain {
            AreaRain::Rate(rate) => in_range("rate", rate, 0.0, MAX_INTENSITY_MM_H, "0 to 500 mm/h")?,
            AreaRain::OfWeather(factor) => in_range("of_weather", factor, 0.0, MAX_FACTOR, "0 to 100")?,
            AreaRain::Scale(factor) => in_range("scale", factor, 0.0, MAX_FACTOR, "0 to 100")?,
        };
        in_range("transition_m", self.transition_m, 0.0, MAX_TRANSITION_M, "0 to 1e5 m")?;
        self.motion.check()?;
        self.fade.check()
    }

    /// Where its centre is at `time_s` (units: s, on the rain clock). Units: m.
    #[must_use]
    pub fn centre_at(&self, time_s: f64) -> DVec2 {
        self.centre_m + self.motion.moved_m(time_s)
    }

    /// Ground on which the same rain would fall without a soft edge: ∫ w dA at full strength. Units: m². Infinite where
    /// it is unbounded.
    ///
    /// A + π T²/20 (Steiner's formula for the outlines parallel to a convex one, averaged over the edge) where half the
    /// transition is at most the smallest radius of curvature b²/a; else by quadrature.
    ///
    /// Error: 1e-12 relative in closed form; by quadrature 1e-3 relative.
    #[must_use]
    pub fn effective_area_m2(&self) -> f64 {
        let half = 0.5 * self.transition_m;
        if matches!(self.shape, AreaShape::Unbounded) {
            return f64::INFINITY;
        }
        let closed = self.density.is_none()
            && match &self.shape {
                AreaShape::Unbounded => false,
                AreaShape::Circle { radius_m } => half <= *radius_m,
                AreaShape::Ellipse { radii_m, .. } => {
                    let (a, b) = (radii_m.max_element(), radii_m.min_element());
                    half * a <= b * b
                }
                AreaShape::Polygon { .. } => half == 0.0,
            };
        if closed {
            return self.shape.area_m2() + PI * self.transition_m * self.transition_m / 20.0;
        }
        let alone = Self {
            centre_m: DVec2::ZERO,
            rain: AreaRain::Rate(1.0),
            motion: AreaMotion::Still,
            fade: AreaFade::default(),
            ..self.clone()
        };
        let mut field = AreaField::new(0.0);
        field.push(&alone, DVec2::ZERO, 0.0);
        let reach = self.shape.reach_m() + half;
        field.integral(-reach, reach, 0.0, 0.05).value_mm_h_m2
    }
}
