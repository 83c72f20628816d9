//! Terminal velocity: measurements, the sources' fits, Beard 1976.

use std::hint::black_box;

use rain_bench::study::{Study, Variant};
use rain_core::rainfall::terminal_velocity::{BeardAir, FallLaw, SpeedTable};
use rain_core::rainfall::{StandardAtmosphere, density_factor, gunn_kinzer, terminal_velocity, terminal_velocity_f32};
use rain_reference::fall_speed as reference;

/// Drops in one run: they fit into the first cache.
const DROPS: usize = 2048;

/// Diameters from 0.2 to 5.8 mm, evenly, in mixed order so that no branch can be guessed.
fn diameters() -> Vec<f64> {
    (0..DROPS)
        .map(|i| 0.2 + 5.6 * ((i * 1021 % DROPS) as f64 + 0.5) / DROPS as f64)
        .collect()
}

/// Root mean square of v − v_ref. Units: m/s.
fn rms(speed: impl Fn(f64) -> f64) -> f64 {
    let squares: f64 = diameters()
        .iter()
        .map(|d| (speed(*d) - reference::measured(*d)).powi(2))
        .sum();
    (squares / DROPS as f64).sqrt()
}

/// A law in double precision.
fn double(name: &str, speed: impl Fn(f64) -> f64 + Copy + 'static) -> Variant {
    let diameters = diameters();
    let mut speeds = vec![0.0; DROPS];
    Variant::new(name, rms(speed), DROPS as u64, move || {
        for (v, d) in speeds.iter_mut().zip(black_box(&diameters)) {
            *v = speed(*d);
        }
        black_box(&speeds)[DROPS / 2]
    })
}

/// A law in single precision.
fn single(name: &str, speed: impl Fn(f32) -> f32 + Clone + 'static) -> Variant {
    let diameters: Vec<f32> = diameters().iter().map(|d| *d as f32).collect();
    let mut speeds = vec![0.0_f32; DROPS];
    let error = rms(|d| f64::from(speed(d as f32)));
    Variant::new(name, error, DROPS as u64, move || {
        for (v, d) in speeds.iter_mut().zip(black_box(&diameters)) {
            *v = speed(*d);
        }
        f64::from(black_box(&speeds)[DROPS / 2])
    })
}

fn table<const N: usize>() -> Variant {
    let table = SpeedTable::<N>::new(gunn_kinzer);
    single(&format!("table {N}, f32"), move |d| table.speed_m_s(d))
}

/// Every law at sea level.
fn sea_level() -> Study {
    let beard = BeardAir::standard();
    let named = |law: FallLaw, name: &str| double(name, move |d| law.sea_level_speed_m_s(d));
    Study {
        name: "terminal-speed",
        title: "Terminal speed at sea level",
        norm: "rms of v against the monotone cubic through Gunn & Kinzer, 0.2-5.8 mm, m/s",
        unit: "drop",
        variants: vec![
            double("fit, f64", terminal_velocity).default(),
            single("fit, f32", terminal_velocity_f32),
            double("monotone cubic, f64", gunn_kinzer),
            double("Beard 1976, f64", move |d| beard.terminal_velocity(d)),
            single("Beard 1976, f32", move |d| beard.terminal_velocity_f32(d)),
            named(FallLaw::FooteDuToit, "Foote & du Toit 1969"),
            named(FallLaw::Brandes, "Brandes 2002"),
            named(FallLaw::Atlas, "Atlas 1973"),
            named(FallLaw::Best, "Best 1950"),
            named(FallLaw::Weber, "Weber 2016"),
            named(FallLaw::AtlasUlbrich, "Atlas & Ulbrich 1977"),
            double(
                "Yoshida's drag, closed form",
                rain_core::rainfall::terminal_velocity::fits::yoshida,
            ),
            table::<64>(),
            table::<128>(),
            table::<256>(),
        ],
    }
}

/// Airs from the sea to 4 km, 20 K around the standard atmosphere's temperature.
fn airs() -> Vec<BeardAir> {
    (0..=8)
        .flat_map(|i| [-10.0, 0.0, 10.0].map(|warmer| (500.0 * f64::from(i), warmer)))
        .map(|(height, warmer)| {
            let standard = StandardAtmosphere::at(height);
            BeardAir::new(standard.pressure_pa, standard.temperature_c + warmer).expect("inside the domain")
        })
        .collect()
}

/// Root mean square of (speed by `speed`)/(Beard in f64) − 1.
fn rms_ratio(speed: impl Fn(&BeardAir, f64) -> f64) -> f64 {
    let diameters: Vec<f64> = (0..59).map(|i| 0.2 + 0.1 * f64::from(i)).collect();
    let airs = airs();
    let squares: f64 = airs
        .iter()
        .flat_map(|air| diameters.iter().map(move |d| (air, *d)))
        .map(|(air, d)| {
            let truth = reference::beard(d * 1e-3, air.pressure_pa(), air.temperature_c());
            (speed(air, d) / truth - 1.0).powi(2)
        })
        .sum();
    (squares / (airs.len() * diameters.len()) as f64).sqrt()
}

/// A way from the speed at sea level to that in other air; its own work is timed, not that of the speed at sea level.
fn factor(name: &str, factor: impl Fn(&BeardAir, f64) -> f64 + Copy + 'static) -> Variant {
    let sea = BeardAir::standard();
    let error = rms_ratio(|air, d| factor(air, d) * sea.terminal_velocity(d));
    in_airs(name, error, factor)
}

fn in_airs(name: &str, error: f64, value: impl Fn(&BeardAir, f64) -> f64 + 'static) -> Variant {
    let (airs, diameters) = (airs(), diameters());
    let mut values = vec![0.0; DROPS];
    let mut turn = 0;
    Variant::new(name, error, DROPS as u64, move || {
        turn = (turn + 1) % airs.len();
        let air = &airs[turn];
        for (value_of, d) in values.iter_mut().zip(black_box(&diameters)) {
            *value_of = value(air, *d);
        }
        black_box(&values)[DROPS / 2]
    })
}

/// Speed in other air.
fn other_air() -> Study {
    let power =
        |exponent: f64| move |air: &BeardAir, _: f64| rain_core::ops::pow(1.2041 / air.density_kg_m3(), exponent);
    Study {
        name: "terminal-speed-air",
        title: "Terminal speed from 0 to 4 km, 10 K around the standard atmosphere",
        norm: "rms of v over that of Beard 1976 in f64, less 1, 0.2-6 mm",
        unit: "drop",
        variants: vec![
            factor("density and viscosity", |air, d| air.velocity_factor(d)).default(),
            factor("Beard 1985, density alone", |air, d| {
                density_factor(d, air.density_kg_m3())
            }),
            factor("density to the power 0.4", power(0.4)),
            factor("density to the power 0.5", power(0.5)),
            factor("none", |_, _| 1.0),
            in_airs(
                "Beard 1976, f64",
                rms_ratio(BeardAir::terminal_velocity),
                BeardAir::terminal_velocity,
            ),
            in_airs(
                "Beard 1976, f32",
                rms_ratio(|air, d| f64::from(air.terminal_velocity_f32(d as f32))),
                |air, d| f64::from(air.terminal_velocity_f32(d as f32)),
            ),
        ],
    }
}

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![sea_level(), other_air()]
}
