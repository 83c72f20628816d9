//! Water on slopes and roads, and how dark it makes them.

use rain_core::surface::{FlowLaw, RoadFilmFit, RoadSurface, SheetFlow, wet_albedo as wet};

use super::key::{Key, returns};
use super::rainfall::RAIN_MM_H;
use super::{Model, ModelError, Output, ReadFile, Values};

pub(super) const MODELS: &[&Model] = &[&SHEET_FLOW, &ROAD_FILM, &WET_ALBEDO];

static SHEET_FLOW: Model = Model {
    name: "sheet-flow",
    what: "steady depth at the foot of a plane under constant rain (kinematic, Manning)",
    keys: &[
        Key::number("manning_n", [1e-3, 10.0], "s/m^(1/3)", "Manning roughness"),
        Key::number("slope", [1e-6, 10.0], "", "fall per length"),
        Key::number("length_m", [0.01, 1e4], "m", "length of the plane"),
        Key::number("intensity_mm_h", RAIN_MM_H, "mm/h", "rain that runs off"),
    ],
    returns: &[
        returns("depth_mm", "mm", "steady depth at the foot"),
        returns("equilibrium_time_s", "s", "time until it is steady"),
    ],
    example: &["manning_n=0.015", "slope=0.02", "length_m=5", "intensity_mm_h=50"],
    run: sheet_flow,
};

fn sheet_flow(values: &Values, _: ReadFile<'_>) -> Result<Output, ModelError> {
    let length = values.number("length_m");
    let flow = SheetFlow::new(
        FlowLaw::Manning {
            manning_n: values.number("manning_n"),
        },
        values.number("slope"),
        length,
        values.number("intensity_mm_h"),
    )?;
    Ok(Output::new([
        ("depth_mm", flow.steady_depth_m(length) * 1e3),
        ("equilibrium_time_s", flow.equilibrium_time_s()),
    ]))
}

static ROAD_FILM: Model = Model {
    name: "road-film",
    what: "water above the texture of a road (Gallaway et al. 1971, 1979); negative: inside the texture",
    keys: &[
        Key::number("texture_depth_mm", [0.01, 10.0], "mm", "mean texture depth"),
        Key::number("length_m", [0.1, 1e3], "m", "length of the flow path"),
        Key::number("intensity_mm_h", [0.0, 500.0], "mm/h", "rain rate"),
        Key::number("slope", [1e-4, 1.0], "", "fall per length"),
        Key::choice("fit", &["gallaway71", "gallaway79"], "which regression"),
    ],
    returns: &[returns("depth_mm", "mm", "water above the texture")],
    example: &["texture_depth_mm=0.5", "length_m=5", "intensity_mm_h=50", "slope=0.02"],
    run: road_film,
};

fn road_film(values: &Values, _: ReadFile<'_>) -> Result<Output, ModelError> {
    let road = RoadSurface {
        texture_depth_mm: values.number("texture_depth_mm"),
        length_m: values.number("length_m"),
        slope: values.number("slope"),
    };
    let fit = match values.word("fit") {
        "gallaway79" => RoadFilmFit::Gallaway1979,
        _ => RoadFilmFit::Gallaway1971,
    };
    Ok(Output::new([(
        "depth_mm",
        road.film_mm(fit, values.number("intensity_mm_h"))?,
    )]))
}

static WET_ALBEDO: Model = Model {
    name: "wet-albedo",
    what: "how dark a wet diffuse surface is (Lekner & Dorf 1988)",
    keys: &[Key::number("albedo", [0.0, 1.0], "", "albedo when dry")],
    returns: &[
        returns("wet_albedo", "", "albedo when wet"),
        returns("ratio", "", "wet over dry; its limit where dry is 0"),
    ],
    example: &["albedo=0.2"],
    run: wet_albedo,
};

fn wet_albedo(values: &Values, _: ReadFile<'_>) -> Result<Output, ModelError> {
    let dry = values.number("albedo");
    // The ratio is smooth at 0; so close to it, its limit is the value.
    let some = dry.max(1e-9);
    Ok(Output::new([("wet_albedo", wet(dry)), ("ratio", wet(some) / some)]))
}
