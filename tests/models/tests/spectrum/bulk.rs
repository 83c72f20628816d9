//! Bulk quantities and impacts.

use glam::DVec3;
use proptest::prelude::*;
use rain_core::rainfall::{
    Distribution, DropSizes, GammaSpectrum, RainKind, Spectrum, gunn_kinzer, measured_energy_j_m2_mm, terminal_velocity,
};
use rain_reference::fall_speed::measured;
use rain_reference::spectrum as reference;

use super::{ODD, config};
use crate::check::Worst;

const ALL: (f64, f64) = (0.0, f64::INFINITY);

fn rain(r: f64) -> DropSizes {
    DropSizes::carrying(RainKind::MarshallPalmer, r, gunn_kinzer).unwrap()
}

/// Off by so many halves of the last digit printed.
fn digits(worst: &mut Worst, found: f64, printed: f64, half_digit: f64, place: &str) {
    worst.absolute((found - printed) / half_digit, 0.0, || place.to_owned());
}

#[test]
fn bulk_check_values_with_the_measured_speeds() {
    let mut worst = Worst::default();
    for (r, [n0, slope, number, water, air, ground, extinction]) in [
        (1.0, [6755.6, 4.1000, 1647.7, 0.075106, 0.89562, 1.0957, 0.15397]),
        (5.0, [6776.5, 2.9242, 2317.4, 0.29117, 1.2558, 1.4977, 0.42572]),
        (10.0, [6865.8, 2.5280, 2715.9, 0.52809, 1.4525, 1.7144, 0.66752]),
        (25.0, [7068.0, 2.0855, 3389.1, 1.1738, 1.7607, 2.0483, 1.2240]),
        (50.0, [7294.1, 1.8030, 4045.5, 2.1683, 2.0366, 2.3388, 1.9547]),
        (100.0, [7593.8, 1.5588, 4871.7, 4.0409, 2.3557, 2.6649, 3.1494]),
    ] {
        let sizes = rain(r);
        let (a, b) = ALL;
        let law = sizes.parts()[0].1;
        for (name, found, printed, half) in [
            ("N0", law.n0_per_m3_mm(), n0, 5e-2),
            ("Λ", law.slope_per_mm(), slope, 5e-5),
            ("N_t", sizes.number_per_m3(a, b), number, 5e-2),
            (
                "W",
                sizes.liquid_water_g_m3(a, b),
                water,
                if r < 2.0 {
                    5e-7
                } else if r < 20.0 {
                    5e-6
                } else {
                    5e-5
                },
            ),
            (
                "D0 air",
                sizes.volume_median_air_mm(a, b),
                air,
                if r < 2.0 { 5e-6 } else { 5e-5 },
            ),
            (
                "D0 ground",
                sizes.volume_median_ground_mm(a, b, gunn_kinzer),
                ground,
                5e-5,
            ),
            (
                "σ",
                1e3 * sizes.extinction_per_m(a, b),
                extinction,
                if r < 20.0 { 5e-6 } else { 5e-5 },
            ),
        ] {
            digits(
                &mut worst,
                found,
                printed,
                half,
                &format!("{name} at {r} mm/h: {found}"),
            );
        }
    }
    worst.assert_below(1.02, 42);
}

#[test]
fn impact_check_values_with_the_measured_speeds() {
    let mut worst = Worst::default();
    let rates = [1.0, 5.0, 10.0, 25.0, 50.0, 100.0];
    let large = [636.7, 1785.1, 2675.5, 4452.0, 6449.0, 9256.7];
    let all = [1518.8, 3039.0, 4110.8, 6149.7, 8366.1, 11416.0];
    let energy = [2.888, 21.885, 51.229, 154.17, 348.35, 774.51];
    let per_mm = [10.397, 15.757, 18.443, 22.200, 25.081, 27.882];
    let momentum = [0.001199, 0.0074685, 0.01624, 0.044839, 0.095786, 0.20293];
    for (i, r) in rates.into_iter().enumerate() {
        let sizes = rain(r);
        let (a, b) = ALL;
        for (name, found, printed, half) in [
            (
                "impacts ≥ 0.5 mm",
                sizes.impacts_per_m2_s(0.5, b, gunn_kinzer),
                large[i],
                5e-2,
            ),
            (
                "impacts",
                sizes.impacts_per_m2_s(a, b, gunn_kinzer),
                all[i],
                if r > 60.0 { 0.5 } else { 5e-2 },
            ),
            (
                "energy",
                1e3 * sizes.kinetic_energy_w_m2(a, b, gunn_kinzer),
                energy[i],
                if r > 20.0 { 5e-3 } else { 5e-4 },
            ),
            (
                "energy per mm",
                sizes.kinetic_energy_j_m2_mm(a, b, gunn_kinzer),
                per_mm[i],
                5e-4,
            ),
            (
                "momentum",
                sizes.momentum_flux_pa(a, b, gunn_kinzer),
                momentum[i],
                [5e-7, 5e-8, 5e-6, 5e-7, 5e-7, 5e-6][i],
            ),
        ] {
            digits(
                &mut worst,
                found,
                printed,
                half,
                &format!("{name} at {r} mm/h: {found}"),
            );
        }
    }
    worst.assert_below(1.02, 30);
}

#[test]
fn drift_shares_and_measured_energy_check_values() {
    let (a, b) = ALL;
    for (r, t) in [(1.0, 0.2704), (5.0, 0.2096), (25.0, 0.1690)] {
        let found = rain(r).mean_inverse_velocity_s_m(a, b, gunn_kinzer);
        assert!((found - t).abs() < 5.1e-5, "{r}: {found}");
    }
    for (r, share) in [(5.0, 0.9805), (25.0, 0.9919), (100.0, 0.9761)] {
        let found = rain(r).rain_rate_mm_h(0.5, 6.0, gunn_kinzer) / r;
        assert!((found - share).abs() < 5.1e-5, "{r}: {found}");
    }
    assert!((measured_energy_j_m2_mm(25.0) - 23.15).abs() < 5.1e-3);
    for x in ODD {
        assert!((13.0..28.4).contains(&measured_energy_j_m2_mm(x)), "{x}");
    }
    // Yoshida's classes reach from 0.9 to 2.1 mm.
    for (r, share) in [(1.0, 0.61), (5.0, 0.63), (10.0, 0.58), (20.0, 0.49)] {
        let found = rain(r).rain_rate_mm_h(0.9, 2.1, gunn_kinzer) / r;
        assert!((found - share).abs() < 6e-3, "{r}: {found}");
    }
}

#[test]
fn bulk_quantities_equal_brute_force() {
    let mut worst = Worst::default();
    let mut medians = Worst::default();
    for kind in [RainKind::Drizzle, RainKind::Thunderstorm, RainKind::Gamma] {
        for r in [0.2, 20.0, 200.0] {
            let sizes = DropSizes::new(kind, r).unwrap();
            for (a, b) in [(0.0, sizes.end_mm().min(40.0)), (0.5, 6.0)] {
                let n = |d: f64| sizes.concentration(d);
                let place = |name: &str| format!("{name}, {kind}, {r} mm/h, from {a}");
                let mass = |d: f64| core::f64::consts::PI / 6.0 * 998.2 * (d * 1e-3).powi(3);
                for (name, found, slow) in [
                    (
                        "rate",
                        sizes.rain_rate_mm_h(a, b, gunn_kinzer),
                        reference::rain_rate(a, b, n, measured),
                    ),
                    (
                        "impacts",
                        sizes.impacts_per_m2_s(a, b, gunn_kinzer),
                        reference::sum(a, b, |d| n(d) * measured(d)),
                    ),
                    (
                        "energy",
                        sizes.kinetic_energy_w_m2(a, b, gunn_kinzer),
                        reference::sum(a, b, |d| 0.5 * mass(d) * n(d) * measured(d).powi(3)),
                    ),
                    (
                        "momentum",
                        sizes.momentum_flux_pa(a, b, gunn_kinzer),
                        reference::sum(a, b, |d| mass(d) * n(d) * measured(d).powi(2)),
                    ),
                    (
                        "water",
                        sizes.liquid_water_g_m3(a, b),
                        reference::sum(a, b, |d| core::f64::consts::PI / 6.0 * 1e-3 * d.powi(3) * n(d)),
                    ),
                    (
                        "extinction",
                        sizes.extinction_per_m(a, b),
                        reference::sum(a, b, |d| core::f64::consts::FRAC_PI_4 * (d * 1e-3).powi(2) * n(d)),
                    ),
                ] {
                    worst.relative(found, slow, 1e-300, || place(name));
                }
                medians.absolute(
                    sizes.volume_median_air_mm(a, b),
                    reference::median(a, b, |d| n(d) * d.powi(3)),
                    || place("D0 air"),
                );
                medians.absolute(
                    sizes.volume_median_ground_mm(a, b, gunn_kinzer),
                    reference::median(a, b, |d| n(d) * d.powi(3) * measured(d)),
                    || place("D0 ground"),
                );
            }
        }
    }
    worst.assert_below(2e-6, 100);
    medians.assert_below(3e-6, 30);
}

#[test]
fn an_air_median_is_not_a_ground_median_and_five_percent_are_found() {
    let sizes = rain(10.0);
    let (a, b) = ALL;
    let (air, ground) = (
        sizes.volume_median_air_mm(a, b),
        sizes.volume_median_ground_mm(a, b, gunn_kinzer),
    );
    assert!(ground > 1.15 * air);
    let mut worst = Worst::default();
    worst.relative(1.05 * ground, 1.7144, 1e-9, || "ground".into());
    assert!(std::panic::catch_unwind(|| worst.assert_below(1e-3, 1)).is_err());
}

#[test]
fn walls_catch_what_wind_drives_against_them() {
    let sizes = rain(10.0);
    let (a, b) = ALL;
    let wind = DVec3::new(6.0, 0.0, 2.0);
    let flat = |normal| sizes.rain_on_surface_mm_h(normal, wind, a, b, gunn_kinzer);
    // A horizontal plane gets the rain rate whatever the wind.
    assert!((flat(DVec3::Y) / 10.0 - 1.0).abs() < 1e-6);
    let impacts = sizes.impacts_on_surface_per_m2_s(DVec3::Y, wind, a, b, gunn_kinzer);
    assert!((impacts / 4110.8 - 1.0).abs() < 2e-5, "{impacts}");
    // A wall that faces the wind gets R·U·t; its other side nothing.
    let t = sizes.mean_inverse_velocity_s_m(a, b, gunn_kinzer);
    assert!((flat(DVec3::NEG_X) / (10.0 * 6.0 * t) - 1.0).abs() < 1e-6);
    assert_eq!(flat(DVec3::X), 0.0);
    assert_eq!(flat(DVec3::NEG_Y), 0.0);
    // A roof leaning away from the wind is missed by slow drops only.
    let lee = DVec3::new(0.8, 0.6, 0.0);
    let slow = reference::rain_rate(
        a,
        30.0,
        |d| sizes.concentration(d),
        |d| (0.6 * measured(d) - 0.8 * 6.0).max(0.0),
    );
    assert!(
        slow > 0.01 && (flat(lee) / slow - 1.0).abs() < 1e-4,
        "{} {slow}",
        flat(lee)
    );
    for bad in [DVec3::NAN, DVec3::INFINITY] {
        assert_eq!(sizes.rain_on_surface_mm_h(bad, wind, a, b, gunn_kinzer), 0.0);
        assert_eq!(sizes.rain_on_surface_mm_h(DVec3::Y, bad, a, b, gunn_kinzer), 0.0);
    }
}

#[test]
fn a_huge_end_is_no_end() {
    let gamma = GammaSpectrum::new(8000.0, 1.5, 3.0).unwrap();
    let exponential = Spectrum::new(Distribution::MarshallPalmer, 10.0).unwrap();
    for end in [1e3, 1e60, 1e150, f64::MAX] {
        for n in 0..=8 {
            let sizes = DropSizes::from(exponential);
            let whole = sizes.moment(n, 0.5, f64::INFINITY);
            assert!(
                (sizes.moment(n, 0.5, end) / whole - 1.0).abs() < 1e-12,
                "M{n} to {end:e}"
            );
            let whole = gamma.moment(n, 0.5, f64::INFINITY);
            assert!(
                (gamma.moment(n, 0.5, end) / whole - 1.0).abs() < 1e-12,
                "M{n} to {end:e}"
            );
            assert_eq!(sizes.moment(n, end, f64::INFINITY), 0.0);
        }
        assert_eq!(gamma.concentration(end * 10.0), 0.0);
        assert_eq!(exponential.concentration(end), 0.0);
    }
}

#[test]
fn dry_and_odd_ranges_give_nothing() {
    let dry = rain(0.0);
    let wet = rain(10.0);
    for x in ODD {
        for (sizes, a, b) in [
            (&dry, 0.0, x),
            (&dry, x, 6.0),
            (&wet, x, f64::NAN),
            (&wet, f64::NAN, x),
            (&wet, x, x),
        ] {
            for value in [
                sizes.number_per_m3(a, b),
                sizes.volume_median_air_mm(a, b),
                sizes.volume_median_ground_mm(a, b, gunn_kinzer),
                sizes.mean_inverse_velocity_s_m(a, b, gunn_kinzer),
                sizes.kinetic_energy_j_m2_mm(a, b, gunn_kinzer),
                sizes.momentum_flux_pa(a, b, gunn_kinzer),
            ] {
                assert_eq!(value, 0.0, "[{a}, {b}]");
            }
        }
        for value in [
            wet.volume_median_air_mm(x, 1e3),
            wet.volume_median_ground_mm(x, 6.0, gunn_kinzer),
            wet.volume_median_ground_mm(0.5, x, gunn_kinzer),
            wet.kinetic_energy_j_m2_mm(x, 6.0, gunn_kinzer),
            wet.mean_inverse_velocity_s_m(0.0, x, gunn_kinzer),
        ] {
            assert!(value.is_finite() && value >= 0.0, "{x}: {value}");
        }
    }
}

#[test]
fn medians_lie_inside_and_grow_with_the_rain() {
    proptest!(config(), |(r in 0.05..300.0_f64, more in 1.05..1.5_f64, a in 0.0..1.0_f64, span in 0.5..8.0_f64)| {
        for kind in RainKind::ALL {
            let sizes = DropSizes::new(kind, r).unwrap();
            let heavier = DropSizes::new(kind, r * more).unwrap();
            let b = a + span;
            let air = sizes.volume_median_air_mm(a, b);
            let ground = sizes.volume_median_ground_mm(a, b, terminal_velocity);
            prop_assert!(a < air && air < ground && ground < b, "{} {} {} {} {}", kind, a, air, ground, b);
            let median = sizes.volume_median_air_mm(0.0, f64::INFINITY);
            prop_assert!(heavier.volume_median_air_mm(0.0, f64::INFINITY) > median);
            let faster = sizes.mean_inverse_velocity_s_m(0.0, f64::INFINITY, terminal_velocity);
            prop_assert!(heavier.mean_inverse_velocity_s_m(0.0, f64::INFINITY, terminal_velocity) < faster);
            // Half of the water is on either side.
            let share = sizes.moment(3, a, air) / sizes.moment(3, a, b);
            prop_assert!((share - 0.5).abs() < 1e-9, "{} {}", kind, share);
        }
    });
}
