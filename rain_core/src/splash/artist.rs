//! Splash rates the artists' way: the tables of the sources, as rates per second.

use crate::error::clamped;
use crate::weather::IntensityClass;

/// Relative intensities of light, moderate and heavy rain, and their splashes (Lagarde 2013, table T3).
const ROWS: [(f64, f64); 3] = [(0.33, 20.0), (0.66, 40.0), (1.0, 60.0)];

/// Splashes by relative intensity, linear through (0, 0), (0.33, 20), (0.66, 40), (1, 60). Units: 1/(m² s).
///
/// `relative_intensity` held in [0, 1], what is not a number counts as 0; see
/// [`relative_intensity`](crate::weather::relative_intensity). Source: Lagarde 2013, control panel; the source gives no
/// unit, a rate per area makes it independent of view and frame rate. A look: real rain of 10 mm/h makes 2700 impacts
/// of drops above 0.5 mm on a square metre and second.
///
/// Error: 4e-16 of the largest rate; a look, 1e-2 of the impacts of real rain and less.
#[must_use]
pub fn artist_splashes_per_m2_s(relative_intensity: f64) -> f64 {
    let x = clamped(relative_intensity, 0.0, 1.0);
    let (mut x0, mut v0) = (0.0, 0.0);
    for (x1, v1) in ROWS {
        if x <= x1 {
            return v0 + (v1 - v0) * (x - x0) / (x1 - x0);
        }
        (x0, v0) = (x1, v1);
    }
    v0
}

/// The traffic thesis' drops and splashes of an intensity class.
///
/// Its container of 40 × 15 × 80 m starts `count` drops `rate` times a second (the text and the table disagree; read as
/// drops per second) and shows a splash for a share of them. Source: Nguyenova 2021, table 4.4.
///
/// Error: exact, products of the table's numbers; a look.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TrafficSplashes {
    /// Drops that start in the container. Units: 1/s.
    pub drops_per_s: f64,
    /// Share of the drops that splash. Units: none.
    pub probability: f64,
}

impl TrafficSplashes {
    /// The container's ground, 40 × 80 m. Units: m².
    pub const AREA_M2: f64 = 3200.0;

    /// Of a class. No rain, no drops.
    #[must_use]
    pub fn of(class: IntensityClass) -> Self {
        let (count, rate, probability) = match class {
            IntensityClass::None => return Self::default(),
            IntensityClass::Light => (9.0, 50.0, 0.5),
            IntensityClass::Moderate => (43.0, 70.0, 0.33),
            IntensityClass::Heavy => (115.0, 90.0, 0.25),
        };
        Self {
            drops_per_s: count * rate,
            probability,
        }
    }

    /// Splashes in the container. Units: 1/s.
    #[must_use]
    pub fn splashes_per_s(&self) -> f64 {
        self.drops_per_s * self.probability
    }

    /// Splashes by area, for containers of any size. Units: 1/(m² s).
    #[must_use]
    pub fn splashes_per_m2_s(&self) -> f64 {
        self.splashes_per_s() / Self::AREA_M2
    }
}

/// How long a splash's image stays, 0.1 to 0.3 s, by a random number in [0, 1). Units: s.
///
/// `u` held in [0, 1], what is not a number counts as 0. Source: Nguyenova 2021. A look: crowns stand 10 to 20 ms, what
/// is seen longer are the drops that they throw.
///
/// Error: 1e-16 s; a look.
#[must_use]
pub fn splash_image_life_s(u: f64) -> f64 {
    0.1 + 0.2 * clamped(u, 0.0, 1.0)
}
