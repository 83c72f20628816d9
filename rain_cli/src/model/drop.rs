//! One drop: shape, fall from rest, streak.

use rain_core::rainfall::{
    Fall, MAX_FALL_HEIGHT_M, axis_ratio, drag_stiffness, drop_volume_mm3, gunn_kinzer, mode_frequency_hz,
    streak_path_m, streak_peak_opacity,
};

use super::key::{Key, returns};
use super::{Model, ModelError, Output, ReadFile, Values};

pub(super) const MODELS: &[&Model] = &[&DROP_SHAPE, &FALL, &STREAK];

/// Diameters of single drops. Units: mm.
const DIAMETERS_MM: [f64; 2] = [0.01, 10.0];

static DROP_SHAPE: Model = Model {
    name: "drop-shape",
    what: "flattening (Andsager, Beard & Laird 1999), volume and slowest oscillation (Rayleigh 1879) of a drop",
    keys: &[Key::number("diameter_mm", DIAMETERS_MM, "mm", "drop diameter")],
    returns: &[
        returns("axis_ratio", "", "height over width"),
        returns("volume_mm3", "mm³", "volume"),
        returns("oscillation_hz", "Hz", "frequency of the mode n = 2"),
    ],
    example: &["diameter_mm=3"],
    run: drop_shape,
};

fn drop_shape(values: &Values, _: ReadFile<'_>) -> Result<Output, ModelError> {
    let diameter = values.number("diameter_mm");
    Ok(Output::new([
        ("axis_ratio", axis_ratio(diameter)),
        ("volume_mm3", drop_volume_mm3(diameter)),
        ("oscillation_hz", mode_frequency_hz(2, diameter)),
    ]))
}

static FALL: Model = Model {
    name: "fall",
    what: "a drop let go at rest in still air, in closed form (terminal speed: the measured table)",
    keys: &[
        Key::number("diameter_mm", DIAMETERS_MM, "mm", "drop diameter"),
        Key::number("height_m", [0.0, MAX_FALL_HEIGHT_M], "m", "height of the fall"),
    ],
    returns: &[
        returns("speed_m_s", "m/s", "speed at the end of the fall"),
        returns("time_s", "s", "time that the fall takes"),
        returns(
            "distance_to_99_percent_m",
            "m",
            "fall after which it has 99 % of its terminal speed",
        ),
    ],
    example: &["diameter_mm=5", "height_m=2"],
    run: fall,
};

fn fall(values: &Values, _: ReadFile<'_>) -> Result<Output, ModelError> {
    let (diameter, height) = (values.number("diameter_mm"), values.number("height_m"));
    let fall = Fall::new(gunn_kinzer(diameter), drag_stiffness(diameter))?;
    Ok(Output::new([
        ("speed_m_s", fall.speed_after_m_s(height, 0.0)),
        ("time_s", fall.time_to_fall_s(height, 0.0)),
        ("distance_to_99_percent_m", fall.distance_to_99_percent_m()),
    ]))
}

static STREAK: Model = Model {
    name: "streak",
    what: "streak of a falling drop on a picture (speed: the measured table; Garg & Nayar 2007)",
    keys: &[
        Key::number("diameter_mm", DIAMETERS_MM, "mm", "drop diameter"),
        Key::number("exposure_s", [0.0, 3600.0], "s", "exposure time"),
    ],
    returns: &[
        returns(
            "length_m",
            "m",
            "way during the exposure, without the drop's own diameter",
        ),
        returns(
            "opacity",
            "",
            "share of the exposure that the drop covers a point on its axis, at most 1",
        ),
    ],
    example: &["diameter_mm=2", "exposure_s=0.016666666666666666"],
    run: streak,
};

fn streak(values: &Values, _: ReadFile<'_>) -> Result<Output, ModelError> {
    let diameter = values.number("diameter_mm");
    let length = streak_path_m(gunn_kinzer(diameter), values.number("exposure_s"));
    Ok(Output::new([
        ("length_m", length),
        ("opacity", streak_peak_opacity(diameter, length)),
    ]))
}
