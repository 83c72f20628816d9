//! Wheels in water.

use rain_core::wheels::{Tyre, hydroplaning_speed_km_h, wheel_on_film};

use super::key::{Key, returns};
use super::{Model, ModelError, Output, ReadFile, Values};

pub(super) const MODELS: &[&Model] = &[&HYDROPLANING, &WHEEL];

static HYDROPLANING: Model = Model {
    name: "hydroplaning",
    what: "speed at which a tyre floats on deep water (Horne & Dreher 1963)",
    keys: &[Key::number("pressure_kpa", [10.0, 2000.0], "kPa", "tyre pressure")],
    returns: &[returns("speed_km_h", "km/h", "speed")],
    example: &["pressure_kpa=220"],
    run: hydroplaning,
};

fn hydroplaning(values: &Values, _: ReadFile<'_>) -> Result<Output, ModelError> {
    let speed = hydroplaning_speed_km_h(values.number("pressure_kpa"))?;
    Ok(Output::new([("speed_km_h", speed)]))
}

static WHEEL: Model = Model {
    name: "wheel",
    what: "water that a wheel meets and where it goes (Weir, Strange & Heffley 1978; Flintsch et al. 2014)",
    keys: &[
        Key::number("speed_km_h", [0.0, 720.0], "km/h", "speed"),
        Key::number("width_mm", [1.0, 3000.0], "mm", "width of the contact"),
        Key::number("film_mm", [0.0, 1000.0], "mm", "water on the road"),
        Key::number("tread_mm", [0.0, 50.0], "mm", "depth of the tread").or("8"),
        Key::number("pressure_kpa", [10.0, 2000.0], "kPa", "tyre pressure").or("220"),
    ],
    returns: &[
        returns("intercepted_kg_s", "kg/s", "water met"),
        returns("adhesion_kg_s", "kg/s", "clings to the rubber"),
        returns("tread_kg_s", "kg/s", "carried in the grooves"),
        returns("bow_kg_s", "kg/s", "pushed ahead"),
        returns("side_kg_s", "kg/s", "pushed to both sides"),
        returns("hydroplaning", "", "whether the tyre floats"),
    ],
    example: &["speed_km_h=90", "width_mm=200", "film_mm=0.5"],
    run: wheel,
};

fn wheel(values: &Values, _: ReadFile<'_>) -> Result<Output, ModelError> {
    let tyre = Tyre {
        width_m: values.number("width_mm") * 1e-3,
        tread_mm: values.number("tread_mm"),
        pressure_kpa: values.number("pressure_kpa"),
        ..Tyre::default()
    };
    let report = wheel_on_film(tyre, values.number("speed_km_h"), values.number("film_mm"))?;
    let water = report.water;
    let output = Output::new([
        ("intercepted_kg_s", water.intercepted_kg_s),
        ("adhesion_kg_s", water.adhesion_kg_s),
        ("tread_kg_s", water.tread_kg_s),
        ("bow_kg_s", water.bow_kg_s),
        ("side_kg_s", water.side_kg_s),
    ]);
    Ok(output.flag("hydroplaning", report.hydroplaning))
}
