//! The water on the ground under a course of rain.

use glam::DVec3;
use rain_core::error::shown;
use rain_core::weather::{
    Infiltration, MAX_INTERVAL_S, SurfaceClass, SurfaceProperties, WeatherConditions, WeatherSurfaces,
    penman_evaporation_mm_h, read_hyetograph,
};

use super::key::{Key, returns};
use super::{Model, ModelError, Output, ReadFile, Values};

pub(super) const MODELS: &[&Model] = &[&WEATHER];

/// Most rows of a series.
const MAX_ROWS: f64 = 1e5;

const SURFACES: &[&str] = &["asphalt", "concrete", "stone", "gravel", "soil", "grass", "roof"];

static WEATHER: Model = Model {
    name: "weather",
    what: "pores, film and budget of a surface under a hyetograph (closed form over each piece)",
    keys: &[
        Key::file(
            "timeline",
            "CSV table with time_s,intensity_mm_h; also wind, temperature and humidity",
        ),
        Key::number("duration_s", [0.0, 1e8], "s", "end of the series"),
        Key::above(
            "step_s",
            [0.0, 1e8],
            "s",
            "time between rows; the state does not depend on it",
        ),
        Key::choice("surface", SURFACES, "kind of ground"),
        Key::number("wind_m_s", [0.0, 80.0], "m/s", "wind where the table has none").or("0"),
        Key::number(
            "air_temperature_c",
            [-60.0, 60.0],
            "°C",
            "air temperature where the table has none",
        )
        .or("15"),
        Key::number(
            "relative_humidity",
            [0.0, 1.0],
            "",
            "relative humidity where the table has none",
        )
        .or("0.7"),
        Key::number("pressure_pa", [30_000.0, 110_000.0], "Pa", "air pressure").or("101325"),
        Key::number(
            "net_radiation_w_m2",
            [-300.0, 1400.0],
            "W/m²",
            "net radiation of the ground",
        )
        .or("150"),
        Key::number("pore_capacity_mm", [1e-6, 1e3], "mm", "water that the pores hold").or_words("the surface's"),
        Key::number("texture_depth_mm", [0.0, 1e3], "mm", "water that the texture holds").or_words("the surface's"),
        Key::number("manning_n", [1e-3, 10.0], "s/m^(1/3)", "Manning roughness").or_words("the surface's"),
        Key::number("slope", [0.0, 10.0], "", "fall per length").or_words("the surface's"),
        Key::number("flow_length_m", [0.01, 1e4], "m", "length of the way off").or_words("the surface's"),
        Key::number(
            "infiltration_initial_mm_h",
            [0.0, 1e4],
            "mm/h",
            "Horton's f₀, at least f_c",
        )
        .or_words("the surface's"),
        Key::number("infiltration_final_mm_h", [0.0, 1e4], "mm/h", "Horton's f_c").or_words("the surface's"),
        Key::number("infiltration_decay_per_h", [1e-6, 1e3], "1/h", "Horton's k").or_words("the surface's"),
    ],
    returns: &[
        returns(
            "series",
            "",
            "rows of time_s, intensity_mm_h, wetness, water_level_mm, pores_mm, drained_mm, infiltrated_mm, evaporated_mm, evaporation_mm_h",
        ),
        returns(
            "budget",
            "mm",
            "rain_mm = pores_mm + film_mm + evaporated_mm + infiltrated_mm + drained_mm, and residual_relative",
        ),
    ],
    example: &["timeline=storm.csv", "duration_s=3600", "step_s=600"],
    run: weather,
};

fn properties(values: &Values, class: SurfaceClass) -> SurfaceProperties {
    let known = class.properties();
    let given = |name: &str, known: f64| values.optional(name).unwrap_or(known);
    SurfaceProperties {
        pore_capacity_mm: given("pore_capacity_mm", known.pore_capacity_mm),
        texture_depth_mm: given("texture_depth_mm", known.texture_depth_mm),
        manning_n: given("manning_n", known.manning_n),
        slope: given("slope", known.slope),
        flow_length_m: given("flow_length_m", known.flow_length_m),
        infiltration: Infiltration {
            initial_mm_h: given("infiltration_initial_mm_h", known.infiltration.initial_mm_h),
            final_mm_h: given("infiltration_final_mm_h", known.infiltration.final_mm_h),
            decay_per_h: given("infiltration_decay_per_h", known.infiltration.decay_per_h),
            ..known.infiltration
        },
    }
}

fn weather(values: &Values, read_file: ReadFile<'_>) -> Result<Output, ModelError> {
    let base = WeatherConditions {
        wind_m_s: DVec3::new(values.number("wind_m_s"), 0.0, 0.0),
        air_temperature_c: values.number("air_temperature_c"),
        relative_humidity: values.number("relative_humidity"),
        pressure_pa: values.number("pressure_pa"),
        net_radiation_w_m2: values.number("net_radiation_w_m2"),
        ..WeatherConditions::default()
    };
    let (duration, step) = (values.number("duration_s"), values.number("step_s"));
    let steps = (duration / step - 1e-9).ceil().max(0.0);
    if steps > MAX_ROWS || duration > MAX_INTERVAL_S {
        return Err(ModelError::TooMuch {
            what: "duration_s/step_s",
            value: shown(steps),
            allowed: format!("up to {MAX_ROWS}"),
        });
    }
    let class = SurfaceClass::ALL[SURFACES.iter().position(|s| *s == values.word("surface")).unwrap_or(0)];
    let mut ground = WeatherSurfaces::default();
    let properties = properties(values, class);
    let Infiltration {
        initial_mm_h,
        final_mm_h,
        ..
    } = properties.infiltration;
    if initial_mm_h < final_mm_h {
        return Err(ModelError::Value {
            key: "infiltration_initial_mm_h",
            value: shown(initial_mm_h),
            allowed: format!("infiltration_final_mm_h, here {}, to 10000 mm/h", shown(final_mm_h)),
        });
    }
    ground.set_properties(class, properties)?;

    let path = values.file("timeline");
    let wrong = |problem: String| ModelError::File {
        path: path.display().to_string(),
        problem,
    };
    let table = read_file(path).map_err(|error| wrong(error.to_string()))?;
    let timeline = read_hyetograph(table.as_slice(), &base).map_err(|error| wrong(error.to_string()))?;

    let mut rows = Vec::new();
    let (mut now, mut count) = (0.0, 0.0);
    loop {
        let ledger = ground.column(class).ledger();
        let conditions = timeline.at(now)?;
        rows.push(Output::new([
            ("time_s", now),
            ("intensity_mm_h", conditions.intensity_mm_h),
            ("wetness", ground.wetness(class)),
            ("water_level_mm", ground.water_level_mm(class)),
            ("pores_mm", ledger.pores_mm),
            ("drained_mm", ledger.drained_mm),
            ("infiltrated_mm", ledger.infiltrated_mm),
            ("evaporated_mm", ledger.evaporated_mm),
            ("evaporation_mm_h", penman_evaporation_mm_h(&conditions)),
        ]));
        if count >= steps {
            break;
        }
        count += 1.0;
        let next = (count * step).min(duration);
        ground.advance_along(&timeline, now, next)?;
        now = next;
    }
    let ledger = ground.column(class).ledger();
    let budget = Output::new([
        ("rain_mm", ledger.rain_mm),
        ("pores_mm", ledger.pores_mm),
        ("film_mm", ledger.film_mm),
        ("evaporated_mm", ledger.evaporated_mm),
        ("infiltrated_mm", ledger.infiltrated_mm),
        ("drained_mm", ledger.drained_mm),
        ("residual_relative", ledger.residual_relative()),
    ]);
    Ok(Output::default().rows("series", rows).object("budget", budget))
}
