//! Fall speed and drop-size distribution.

use rain_core::rainfall::{MAX_INTENSITY_MM_H, terminal_velocity};

use super::key::{Key, returns};
use super::{Model, ModelError, Output, ReadFile, Values};

pub(super) const MODELS: &[&Model] = &[&TERMINAL_SPEED];

/// Rain rates with rain in them. Units: mm/h.
pub(super) const RAIN_MM_H: [f64; 2] = [0.0, MAX_INTENSITY_MM_H];

static TERMINAL_SPEED: Model = Model {
    name: "terminal-speed",
    what: "speed of a drop that falls for long in still air",
    keys: &[
        Key::number("diameter_mm", [0.0, 10.0], "mm", "drop diameter"),
        Key::number("pressure_pa", [30_000.0, 110_000.0], "Pa", "air pressure").or("101325"),
        Key::number("temperature_c", [-60.0, 60.0], "°C", "air temperature").or("20"),
        Key::choice("fit", &["default"], "which law"),
    ],
    returns: &[returns("speed_m_s", "m/s", "terminal speed")],
    example: &["diameter_mm=2"],
    run: terminal_speed,
};

fn terminal_speed(values: &Values, _: ReadFile<'_>) -> Result<Output, ModelError> {
    Ok(Output::new([(
        "speed_m_s",
        terminal_velocity(values.number("diameter_mm")),
    )]))
}
