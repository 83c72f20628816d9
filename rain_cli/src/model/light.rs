//! Extinction and visibility.

use rain_core::rainfall::{Distribution, Spectrum};

use super::key::{Key, returns};
use super::rainfall::RAIN_MM_H;
use super::{Model, ModelError, Output, ReadFile, Values};

pub(super) const MODELS: &[&Model] = &[&VISIBILITY];

/// Extinction over geometric cross-section of drops far larger than the wavelength. Units: none.
pub(super) const EXTINCTION_EFFICIENCY: f64 = 2.0;

static VISIBILITY: Model = Model {
    name: "visibility",
    what: "extinction and visibility in rain (Marshall–Palmer, renormalised; Q = 2; Koschmieder 1924)",
    keys: &[
        Key::above("intensity_mm_h", RAIN_MM_H, "mm/h", "rain rate"),
        Key::number("distance_m", [0.0, 1e6], "m", "length of the line of sight"),
    ],
    returns: &[
        returns("extinction_per_km", "km⁻¹", "extinction coefficient"),
        returns("transmittance", "", "share of light that arrives"),
        returns("visibility_km", "km", "distance at which contrast falls to 2 %"),
    ],
    example: &["intensity_mm_h=25", "distance_m=100"],
    run: visibility,
};

fn visibility(values: &Values, _: ReadFile<'_>) -> Result<Output, ModelError> {
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, values.number("intensity_mm_h"))?;
    let extinction = EXTINCTION_EFFICIENCY * spectrum.extinction_per_m(0.0, f64::INFINITY);
    Ok(Output::new([
        ("extinction_per_km", extinction * 1e3),
        (
            "transmittance",
            rain_core::ops::exp(-extinction * values.number("distance_m")),
        ),
        ("visibility_km", 3.912 / extinction * 1e-3),
    ]))
}
