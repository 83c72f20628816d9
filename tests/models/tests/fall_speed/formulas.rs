//! Air, its factors, and the sources' fits: formulas against their twins, distances as the documentation states them.

use rain_core::rainfall::density_factor;
use rain_core::rainfall::terminal_velocity::{
    BeardAir, FallLaw, SpeedTable, StandardAtmosphere, air_density_kg_m3, air_viscosity_pa_s, fits, gunn_kinzer,
    water_density_kg_m3, water_surface_tension_n_m,
};
use rain_reference::fall_speed as reference;

use super::{ODD, air, airs, diameters};
use crate::check::Worst;

#[test]
fn air_and_water_are_their_formulas_to_the_last_digits() {
    let (mut viscosity, mut tension, mut water, mut density, mut standard, mut bent) = (
        Worst::default(),
        Worst::default(),
        Worst::default(),
        Worst::default(),
        Worst::default(),
        Worst::default(),
    );
    for i in -120..=120 {
        let t = 0.5 * f64::from(i);
        let place = || format!("{t} °C");
        viscosity.relative(air_viscosity_pa_s(t), reference::air_viscosity(t), 1e-30, place);
        bent.relative(1.05 * air_viscosity_pa_s(t), reference::air_viscosity(t), 1e-30, place);
        tension.relative(water_surface_tension_n_m(t), 0.073 + 1.55e-4 * (20.0 - t), 1e-30, place);
        water.relative(water_density_kg_m3(t), reference::water_density(t), 1e-30, place);
        for p in [30e3, 70e3, 101_325.0, 110e3] {
            for humidity in [0.0, 0.5, 1.0] {
                let expected = reference::air_density(p, t, humidity);
                density.relative(air_density_kg_m3(p, t, humidity), expected, 1e-30, || {
                    format!("{p} Pa, {t} °C")
                });
            }
        }
    }
    for i in -5..=110 {
        let h = 100.0 * f64::from(i);
        let found = StandardAtmosphere::at(h);
        let kelvin = 288.15 - 0.0065 * h;
        let pressure = 101_325.0 * (5.255_88 * (kelvin / 288.15).ln()).exp();
        standard.relative(found.pressure_pa, pressure, 1e-30, || format!("{h} m"));
        standard.relative(found.temperature_c + 273.15, kelvin, 1e-30, || format!("{h} m"));
    }
    viscosity.assert_below(1e-15, 240);
    tension.assert_below(1e-15, 240);
    water.assert_below(1e-15, 240);
    density.assert_below(1e-15, 2800);
    standard.assert_below(2e-15, 230);
    assert!(bent.error > 0.04);
    for (bad, held) in [(f64::NAN, 20.0), (f64::NEG_INFINITY, -90.0), (f64::INFINITY, 60.0)] {
        assert_eq!(air_viscosity_pa_s(bad), air_viscosity_pa_s(held));
        assert_eq!(air_density_kg_m3(1e5, bad, 0.3), air_density_kg_m3(1e5, held, 0.3));
    }
    for (bad, held) in [(f64::NAN, 0.0), (-1e9, -500.0), (f64::INFINITY, 11_000.0)] {
        assert_eq!(StandardAtmosphere::at(bad), StandardAtmosphere::at(held));
    }
}

#[test]
fn factors_are_their_powers() {
    let (mut density, mut both) = (Worst::default(), Worst::default());
    for i in 0..=70 {
        let d = 0.1 * f64::from(i);
        for rho in [0.3, 0.7, 1.0065, 1.2041, 2.0] {
            let expected = ((0.375 + 0.025 * d) * (1.2041_f64 / rho).ln()).exp();
            density.relative(density_factor(d, rho), expected, 1e-30, || {
                format!("{d} mm, {rho} kg/m³")
            });
        }
        for air in airs() {
            let (p, t) = (air.pressure_pa(), air.temperature_c());
            let (rho, mu) = (reference::air_density(p, t, 0.0), reference::air_viscosity(t));
            let (thin, thick) = (1.2041 / rho, mu / reference::air_viscosity(20.0));
            let expected =
                thin.powf(0.2371 + 0.0231 * d + 0.085 * d.min(1.5)) / thick.powf(0.2211 + 0.3609 * (-d).exp());
            both.relative(air.velocity_factor(d), expected, 1e-30, || {
                format!("{d} mm, {p} Pa, {t} °C")
            });
            assert!((air.density_kg_m3() / rho - 1.0).abs() < 1e-15 && (air.viscosity_pa_s() / mu - 1.0).abs() < 1e-15);
        }
    }
    density.assert_below(1e-15, 350);
    both.assert_below(2e-15, 3900);
    for (bad, held) in [(f64::NAN, 0.0), (-1.0, 0.0), (f64::INFINITY, 7.0)] {
        assert_eq!(density_factor(bad, 0.9), density_factor(held, 0.9));
        assert_eq!(
            air(80e3, 5.0).velocity_factor(bad),
            air(80e3, 5.0).velocity_factor(held)
        );
    }
    for (bad, held) in [(f64::NAN, 1.2041), (0.0, 0.3), (f64::INFINITY, 2.0)] {
        assert_eq!(density_factor(2.0, bad), density_factor(2.0, held));
    }
}

#[test]
fn laws_at_sea_level_are_the_functions_that_they_name() {
    let functions: [fn(f64) -> f64; 6] = [
        fits::foote_du_toit,
        fits::brandes,
        fits::atlas,
        fits::best,
        fits::weber,
        fits::atlas_ulbrich,
    ];
    let laws = [
        FallLaw::FooteDuToit,
        FallLaw::Brandes,
        FallLaw::Atlas,
        FallLaw::Best,
        FallLaw::Weber,
        FallLaw::AtlasUlbrich,
    ];
    for d in diameters().step_by(11).chain(ODD) {
        for (law, function) in laws.into_iter().zip(functions) {
            assert_eq!(law.sea_level_speed_m_s(d), function(d), "{law} at {d} mm");
        }
        assert_eq!(FallLaw::Reference.sea_level_speed_m_s(d), gunn_kinzer(d));
        assert_eq!(
            FallLaw::Beard.sea_level_speed_m_s(d),
            BeardAir::standard().terminal_velocity(d)
        );
    }
}

#[test]
fn fits_miss_the_measurements_by_no_more_than_they_say() {
    // rms and largest distance in m/s over the entries from 0.5 mm on.
    for (law, rms, largest) in [
        (FallLaw::Default, 0.014, 0.035),
        (FallLaw::Beard, 0.021, 0.043),
        (FallLaw::FooteDuToit, 0.015, 0.033),
        (FallLaw::Brandes, 0.033, 0.078),
        (FallLaw::Atlas, 0.082, 0.163),
        (FallLaw::Best, 0.187, 0.255),
        (FallLaw::Weber, 0.683, 1.600),
        (FallLaw::AtlasUlbrich, 1.212, 3.104),
    ] {
        let mut worst = Worst::default();
        let mut square = 0.0;
        for (d, v) in reference::DIAMETERS_MM
            .into_iter()
            .zip(reference::SPEEDS_M_S)
            .filter(|(d, _)| *d >= 0.5)
        {
            worst.absolute(law.sea_level_speed_m_s(d), v, || format!("{law} at {d} mm"));
            square += (law.sea_level_speed_m_s(d) - v).powi(2) / 30.0;
        }
        // Rounded to three digits.
        worst.assert_below(largest + 5e-4, 30);
        assert!(
            square.sqrt() < rms + 5e-4 && square.sqrt() > rms - 5e-4,
            "{law}: {}",
            square.sqrt()
        );
    }
    let off = |d: f64| fits::yoshida(d) / reference::measured(d) - 1.0;
    for i in 0..=100 {
        let d = 1.0 + 0.01 * f64::from(i);
        assert!((-0.04..0.011).contains(&off(d)), "{d} mm: {}", off(d));
    }
    assert!((off(5.0) - 0.29).abs() < 5e-3, "{}", off(5.0));
    let mut stokes = Worst::default();
    for i in 1..=700 {
        let r = 5e-6 * f64::from(i);
        let expected = 2.0 / 9.0 * r * r * (998.2 - 1.2041) * 9.80665 / reference::air_viscosity(20.0);
        stokes.relative(fits::stokes(2e3 * r), expected, 1e-30, || format!("{r} m"));
    }
    stokes.assert_below(1e-15, 700);
}

#[test]
fn tables_are_as_near_as_they_say() {
    fn worst<const N: usize>() -> Worst {
        let table = SpeedTable::<N>::new(gunn_kinzer);
        let mut worst = Worst::default();
        for d in diameters().filter(|d| *d <= 6.4) {
            worst.absolute(f64::from(table.speed_m_s(d as f32)), reference::measured(d), || {
                format!("{N}: {d} mm")
            });
        }
        worst
    }
    worst::<64>().assert_below(0.0205, 5000);
    worst::<128>().assert_below(0.0095, 5000);
    worst::<256>().assert_below(0.0035, 5000);
    assert_eq!(SpeedTable::<8>::new(gunn_kinzer).speed_m_s(99.0), 9.17);
    assert_eq!(SpeedTable::<8>::new(gunn_kinzer).speed_m_s(f32::NAN), 0.0);
}
