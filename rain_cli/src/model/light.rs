//! Reflection, extinction and visibility.

use rain_core::haze::{EXTINCTION_EFFICIENCY, transmittance};
use rain_core::ops;
use rain_core::optics::{fresnel as from_outside, fresnel_from_inside};
use rain_core::rainfall::RainKind;

use super::key::{Key, returns};
use super::rainfall::{RAIN_MM_H, carrying};
use super::{Model, ModelError, Output, ReadFile, Values};

pub(super) const MODELS: &[&Model] = &[&FRESNEL, &VISIBILITY];

static FRESNEL: Model = Model {
    name: "fresnel",
    what: "share of unpolarised light that a smooth surface reflects",
    keys: &[
        Key::number("angle_deg", [0.0, 90.0], "°", "angle of incidence"),
        Key::number(
            "ior",
            [0.2, 5.0],
            "",
            "refractive index behind the surface over that before it; below 1: from inside",
        )
        .or("1.333"),
    ],
    returns: &[returns("reflectance", "", "reflected share")],
    example: &["angle_deg=60"],
    run: fresnel,
};

fn fresnel(values: &Values, _: ReadFile<'_>) -> Result<Output, ModelError> {
    let cos = ops::cos(values.number("angle_deg").to_radians());
    let ior = values.number("ior");
    let reflectance = if ior < 1.0 {
        fresnel_from_inside(cos, 1.0 / ior)
    } else {
        from_outside(cos, ior)
    };
    Ok(Output::new([("reflectance", reflectance)]))
}

static VISIBILITY: Model = Model {
    name: "visibility",
    what: "extinction and visibility in rain (Marshall–Palmer, renormalised; Q = 2; Koschmieder 1924)",
    keys: &[
        Key::number("intensity_mm_h", RAIN_MM_H, "mm/h", "rain rate"),
        Key::number("distance_m", [0.0, 1e6], "m", "length of the line of sight"),
    ],
    returns: &[
        returns("extinction_per_km", "km⁻¹", "extinction coefficient σ"),
        returns("transmittance", "", "share of light that arrives"),
        returns("visibility_km", "km", "3.912/σ: contrast falls to 2 %"),
    ],
    example: &["intensity_mm_h=25", "distance_m=100"],
    run: visibility,
};

fn visibility(values: &Values, _: ReadFile<'_>) -> Result<Output, ModelError> {
    let sizes = carrying(RainKind::MarshallPalmer, values.number("intensity_mm_h"))?;
    let extinction = EXTINCTION_EFFICIENCY * sizes.extinction_per_m(0.0, f64::INFINITY);
    Ok(Output::new([
        ("extinction_per_km", extinction * 1e3),
        ("transmittance", transmittance(extinction * values.number("distance_m"))),
        ("visibility_km", 3.912 / (extinction * 1e3)),
    ]))
}
