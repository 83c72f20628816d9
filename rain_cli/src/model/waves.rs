//! A standing wave on a grid.

use rain_core::waves::StandingWave;

use super::key::{Key, returns};
use super::{Model, ModelError, Output, ReadFile, Values};

pub(super) const MODELS: &[&Model] = &[&WAVES];

static WAVES: Model = Model {
    name: "waves",
    what: "a standing wave in a square basin with walls, from rest with amplitude 1, undamped (f64, five points)",
    keys: &[
        Key::count("cells", [2, 4096], "cells along each side"),
        Key::count("mode_x", [0, 4095], "half waves along x, fewer than cells"),
        Key::count("mode_y", [0, 4095], "half waves along y, fewer than cells"),
        Key::number(
            "time_s",
            [0.0, 1e6],
            "s",
            "how long; round(time·speed/(courant·dx)) steps are done",
        ),
        Key::above(
            "courant",
            [0.0, 0.7],
            "",
            "C = speed·dt/dx; the scheme is stable below 1/√2",
        )
        .or("0.7"),
        Key::number("speed_m_s", [1e-6, 1e3], "m/s", "wave speed").or("0.2214"),
        Key::number("length_m", [1e-6, 1e6], "m", "side of the basin").or("1"),
    ],
    returns: &[
        returns("amplitude", "", "amplitude of the mode after the steps"),
        returns("discrete_amplitude", "", "what the scheme must give, in closed form"),
        returns(
            "exact_amplitude",
            "",
            "what the wave equation gives at the time of the last step",
        ),
        returns("energy_drift", "", "relative change of the scheme's energy"),
    ],
    example: &["cells=64", "mode_x=5", "mode_y=3", "time_s=2"],
    run: waves,
};

fn waves(values: &Values, _: ReadFile<'_>) -> Result<Output, ModelError> {
    let wave = StandingWave {
        cells: values.count("cells"),
        mode_x: values.count("mode_x"),
        mode_y: values.count("mode_y"),
        time_s: values.number("time_s"),
        courant: values.number("courant"),
        speed_m_s: values.number("speed_m_s"),
        length_m: values.number("length_m"),
    };
    let result = wave.run()?;
    Ok(Output::new([
        ("amplitude", result.amplitude),
        ("discrete_amplitude", result.discrete_amplitude),
        ("exact_amplitude", result.exact_amplitude),
        ("energy_drift", result.energy_drift),
    ]))
}
