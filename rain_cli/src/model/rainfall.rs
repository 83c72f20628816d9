//! Fall speed and drop-size distribution.

use rain_core::haze::EXTINCTION_EFFICIENCY;
use rain_core::rainfall::{BeardAir, DropSizes, FallLaw, MAX_INTENSITY_MM_H, RainKind, gunn_kinzer};

use super::key::{Key, returns};
use super::{Model, ModelError, Output, ReadFile, Values};

pub(super) const MODELS: &[&Model] = &[&TERMINAL_SPEED, &RAINFALL];

/// Rain rates at which it rains: without rain there are no medians and no visibility. Units: mm/h.
pub(super) const RAIN_MM_H: [f64; 2] = [1e-6, MAX_INTENSITY_MM_H];

static TERMINAL_SPEED: Model = Model {
    name: "terminal-speed",
    what: "speed of a drop that has fallen far in still air",
    keys: &[
        Key::number("diameter_mm", [0.0, 10.0], "mm", "drop diameter"),
        Key::number("pressure_pa", [30_000.0, 110_000.0], "Pa", "air pressure").or("101325"),
        Key::number("temperature_c", [-60.0, 60.0], "°C", "air temperature").or("20"),
        Key::choice(
            "fit",
            &[
                "default",
                "reference",
                "gunn-kinzer",
                "beard",
                "foote-du-toit",
                "brandes",
                "atlas",
                "best",
                "weber",
                "atlas-ulbrich",
            ],
            "the law; reference is the measured table, and Beard 1976 in other air than at 20 °C and 101325 Pa",
        ),
    ],
    returns: &[returns("speed_m_s", "m/s", "terminal speed")],
    example: &["diameter_mm=2", "fit=beard", "pressure_pa=90000", "temperature_c=12"],
    run: terminal_speed,
};

fn terminal_speed(values: &Values, _: ReadFile<'_>) -> Result<Output, ModelError> {
    let air = BeardAir::new(values.number("pressure_pa"), values.number("temperature_c"))?;
    let law = values.parsed::<FallLaw>("fit")?;
    Ok(Output::new([(
        "speed_m_s",
        law.speed_m_s(values.number("diameter_mm"), &air),
    )]))
}

static RAINFALL: Model = Model {
    name: "rainfall",
    what: "drop sizes of a rain rate and what follows from them (fall speeds: the measured table)",
    keys: &[
        Key::number("intensity_mm_h", RAIN_MM_H, "mm/h", "rain rate"),
        Key::choice(
            "distribution",
            &["marshall-palmer", "drizzle", "widespread", "thunderstorm", "gamma"],
            "family of drop sizes",
        ),
        Key::flag(
            "renormalise",
            true,
            "whether N₀ is set so that all diameters carry the rain rate",
        ),
        Key::number(
            "min_diameter_mm",
            [0.0, 6.0],
            "mm",
            "smallest drop counted; it selects and does not renormalise",
        )
        .or("0"),
    ],
    returns: &[
        returns("n0_per_m3_mm", "m⁻³ mm⁻¹", "N₀ (gamma: N_w)"),
        returns("lambda_per_mm", "mm⁻¹", "Λ (gamma: (4 + µ)/D_m)"),
        returns("flux_mm_h", "mm/h", "rain rate that the drops counted carry"),
        returns("number_per_m3", "m⁻³", "drops in the air"),
        returns("impacts_per_m2_s", "m⁻² s⁻¹", "drops that reach the ground"),
        returns(
            "median_volume_diameter_air_mm",
            "mm",
            "half of the water in the air is in larger drops",
        ),
        returns(
            "median_volume_diameter_ground_mm",
            "mm",
            "half of the rain falls in larger drops",
        ),
        returns("extinction_per_km", "km⁻¹", "extinction coefficient, Q = 2"),
    ],
    example: &["intensity_mm_h=25", "distribution=thunderstorm"],
    run: rainfall,
};

/// Drop sizes that carry their rain rate with measured speeds.
pub(super) fn carrying(kind: RainKind, intensity_mm_h: f64) -> Result<DropSizes, ModelError> {
    Ok(DropSizes::carrying(kind, intensity_mm_h, gunn_kinzer)?)
}

fn rainfall(values: &Values, _: ReadFile<'_>) -> Result<Output, ModelError> {
    let kind = values.parsed::<RainKind>("distribution")?;
    let intensity = values.number("intensity_mm_h");
    let sizes = if values.flag("renormalise") {
        carrying(kind, intensity)?
    } else {
        DropSizes::published(kind, intensity)?
    };
    let (from, to) = (values.number("min_diameter_mm"), f64::INFINITY);
    let (n0, lambda) = sizes
        .parts()
        .first()
        .map_or((0.0, 0.0), |(_, law)| (law.n0_per_m3_mm(), law.slope_per_mm()));
    Ok(Output::new([
        ("n0_per_m3_mm", n0),
        ("lambda_per_mm", lambda),
        ("flux_mm_h", sizes.rain_rate_mm_h(from, to, gunn_kinzer)),
        ("number_per_m3", sizes.number_per_m3(from, to)),
        ("impacts_per_m2_s", sizes.impacts_per_m2_s(from, to, gunn_kinzer)),
        ("median_volume_diameter_air_mm", sizes.volume_median_air_mm(from, to)),
        (
            "median_volume_diameter_ground_mm",
            sizes.volume_median_ground_mm(from, to, gunn_kinzer),
        ),
        (
            "extinction_per_km",
            EXTINCTION_EFFICIENCY * sizes.extinction_per_m(from, to) * 1e3,
        ),
    ]))
}
