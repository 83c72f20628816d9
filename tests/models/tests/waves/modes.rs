//! The scheme against its exact solution.

use std::f64::consts::{FRAC_PI_4, PI};

use proptest::prelude::*;
use rain_core::error::ConfigError;
use rain_core::waves::{DoubleField, StandingWave, Stencil, WaveField, WaveSettings, sub_steps};
use rain_reference::waves as truth;

use super::super::check::Worst;
use super::{cases, peak, settings, standing, started};

/// Cells, mode, C, k_d dt, then the amplitude after 500 steps with five and with nine points.
const CHECKS: [(usize, [usize; 2], f64, f64, [f64; 2]); 4] = [
    (32, [2, 1], 0.5, 0.0, [-0.143_430_758_327, -0.178_205_191_239]),
    (32, [2, 1], 0.5, 0.01, [-0.020_021_604_598, -0.022_821_788_241]),
    (64, [5, 3], 0.7, 0.0, [0.923_685_186_284, 0.864_596_339_554]),
    (64, [5, 3], 0.7, 0.02, [0.005_694_125_806, 0.005_162_323_256]),
];

#[test]
fn modes_end_at_the_published_amplitudes() {
    for (cells, [m, n], courant, damping, ends) in CHECKS {
        for (stencil, end) in [Stencil::FivePoint, Stencil::NinePoint].into_iter().zip(ends) {
            let nine = stencil == Stencil::NinePoint;
            let lambda = truth::eigenvalue(cells, m, n, nine);
            let exact = truth::mode_amplitude(lambda, courant, 0.5 * damping, 500);
            assert!((exact - end).abs() < 5.1e-13, "{exact} is not {end}");
            let shape = |i: usize, j: usize| standing(cells, m, i) * standing(cells, n, j);
            let mut double = DoubleField::new(cells, stencil, courant, 0.5 * damping, shape).expect("within the bound");
            double.step(500);
            let mut single = started(
                &WaveSettings {
                    damping_per_s: damping / courant,
                    stencil,
                    ..settings(cells as u32, cells as u32, courant)
                },
                shape,
            );
            single.step(500);
            let [mut double_error, mut single_error] = [Worst::default(), Worst::default()];
            for index in 0..cells * cells {
                let exact = exact * shape(index % cells, index / cells);
                let place = || format!("{cells}, {m}, {n}, cell {index}");
                double_error.absolute(double.heights()[index], exact, place);
                single_error.absolute(f64::from(single.heights()[index]), exact, place);
            }
            double_error.assert_below(1e-11, 1000);
            single_error.assert_below(1e-5, 1000);
            assert!((double.amplitude(m, n) - exact).abs() < 1e-11);
            // Another speed is another wave.
            let wrong = truth::mode_amplitude(lambda, courant * 1.05, 0.5 * damping, 500);
            assert!((wrong - exact).abs() > 1e-4);
        }
    }
}

#[test]
fn the_calculator_gives_all_three_amplitudes() {
    let time = 500.0 * 0.5 / 32.0 / 0.2214;
    let wave = StandingWave {
        courant: 0.5,
        ..StandingWave::new(32, 2, 1, time)
    };
    let end = wave.run().expect("within its domain");
    assert_eq!(end.steps, 500);
    assert!((end.amplitude - -0.143_430_758_327).abs() < 1e-11);
    assert!((end.discrete_amplitude - -0.143_430_758_327).abs() < 1e-12);
    assert!((end.exact_amplitude - -0.096_357).abs() < 5.1e-7);
    assert!(end.energy_drift < 1e-12, "{}", end.energy_drift);
    let time = 500.0 * 0.7 / 64.0 / 0.2214;
    let end = StandingWave::new(64, 5, 3, time).run().expect("within its domain");
    assert!((end.amplitude - 0.923_685_186_284).abs() < 1e-11 && (end.exact_amplitude - 0.938_754).abs() < 5.1e-7);
    let flat = StandingWave::new(16, 0, 0, 10.0).run().expect("within its domain");
    assert!((flat.amplitude - 1.0).abs() < 1e-12 && flat.energy_drift == 0.0 && flat.exact_amplitude == 1.0);
    assert_eq!(StandingWave::new(16, 1, 0, 0.0).run().expect("no time").amplitude, 1.0);
}

#[test]
fn the_calculator_refuses_what_it_cannot_do() {
    let good = StandingWave::new(32, 2, 1, 1.0);
    for (field, wave) in [
        ("cells", StandingWave { cells: 1, ..good }),
        ("mode_x", StandingWave { mode_x: 32, ..good }),
        ("mode_y", StandingWave { mode_y: 32, ..good }),
        ("time_s", StandingWave { time_s: -1.0, ..good }),
        (
            "time_s",
            StandingWave {
                time_s: f64::NAN,
                ..good
            },
        ),
        (
            "time_s",
            StandingWave {
                time_s: 1e6,
                cells: 4096,
                ..good
            },
        ),
        ("courant", StandingWave { courant: 0.71, ..good }),
        ("courant", StandingWave { courant: 0.0, ..good }),
        (
            "courant",
            StandingWave {
                courant: f64::NAN,
                ..good
            },
        ),
        ("speed_m_s", StandingWave { speed_m_s: 0.0, ..good }),
        (
            "length_m",
            StandingWave {
                length_m: f64::INFINITY,
                ..good
            },
        ),
    ] {
        match wave.run() {
            Err(ConfigError::OutOfRange { field: named, .. }) => assert_eq!(named, field),
            other => panic!("{field}: {other:?}"),
        }
    }
}

#[test]
fn waves_run_too_slowly_by_the_published_ratios() {
    // Cells a wave, C, points; ratio along the axis and the diagonal.
    for (cells, courant, nine, ratios) in [
        (8.0, 0.5, false, [0.98054, 0.99349]),
        (8.0, 0.5, true, [0.98054, 0.98081]),
        (16.0, 0.5, false, [0.99517, 0.99839]),
        (32.0, 0.5, false, [0.99879, 0.99960]),
        (8.0, 0.7, false, [0.98654, 0.99973]),
        (16.0, 0.7, false, [0.99670, 0.99994]),
    ] {
        for (angle, ratio) in [0.0, FRAC_PI_4].into_iter().zip(ratios) {
            let value = truth::speed_ratio(cells, angle, courant, nine);
            assert!((value - ratio).abs() < 5.1e-6, "{cells}, {courant}, {nine}: {value}");
        }
    }
    // A field's wave of 8 cells along a row: 200 steps at 0.7 turn it by 2π·200·0.7/8 times the ratio.
    let mut field = started(&settings(32, 8, 0.7), |i, _| standing(32, 8, i));
    field.step(200);
    let amplitude = f64::from(field.heights()[0]) / standing(32, 8, 0);
    let turned = 2.0 * PI * 200.0 * 0.7 / 8.0 * 0.986_54;
    assert!((amplitude - turned.cos()).abs() < 2e-3, "{amplitude}");
}

#[test]
fn steps_above_the_bound_are_refused_by_name() {
    for (stencil, good, bad, words) in [
        (Stencil::FivePoint, 0.70, 0.705, "at most 0.70"),
        (Stencil::NinePoint, 0.86, 0.865, "at most 0.86"),
    ] {
        let with = |courant: f64| WaveSettings {
            stencil,
            ..settings(16, 16, courant)
        };
        let mut field = WaveField::new(&with(good)).expect("at the bound");
        let error = WaveField::new(&with(bad)).expect_err("above the bound").to_string();
        assert!(error.starts_with("courant is 0.") && error.contains(words), "{error}");
        assert!(field.set_step_ns((bad * 1e9) as u64).is_err());
        assert!(field.set_step_ns((0.5 * good * 1e9) as u64).is_ok());
        for bad in [bad, 0.0, -0.1, f64::NAN, f64::INFINITY] {
            assert!(DoubleField::new(16, stencil, bad, 0.0, |_, _| 0.0).is_err());
        }
    }
    assert!(DoubleField::new(1, Stencil::FivePoint, 0.5, 0.0, |_, _| 0.0).is_err());
    assert!(DoubleField::new(16, Stencil::FivePoint, 0.5, f64::NAN, |_, _| 0.0).is_err());
}

#[test]
fn at_equality_the_checkerboard_grows_and_above_it_explodes() {
    // u⁺ = (2 − 8C²)u − u⁻ of the checkerboard, λ = 8: why the bound is below 1/√2.
    let run = |courant: f64, second: f64, steps: u32| {
        let (mut before, mut now) = (1e-6, second);
        for _ in 1..steps {
            (before, now) = (now, (2.0 - 8.0 * courant * courant) * now - before);
        }
        now.abs()
    };
    assert!((run(0.5_f64.sqrt(), -1e-6 + 1e-8, 1000) / 9.0e-6 - 1.0).abs() < 1e-3);
    assert!(run(0.708, -1e-6, 900) / 1e-6 > 1e8);
    assert!(run(0.70, -1e-6, 1_000_000) / 1e-6 < 8.0);
}

#[test]
fn sub_steps_are_as_few_as_the_bound_allows() {
    assert_eq!(sub_steps(Stencil::FivePoint, 0.35, 1.0, 0.5), 1);
    assert_eq!(sub_steps(Stencil::FivePoint, 0.3501, 1.0, 0.5), 2);
    assert_eq!(sub_steps(Stencil::NinePoint, 0.43, 1.0, 0.5), 1);
    assert_eq!(sub_steps(Stencil::FivePoint, f64::NAN, 1.0, 0.5), 1);
    assert_eq!(sub_steps(Stencil::FivePoint, 1e300, 1e300, 0.5), u32::MAX);
    assert_eq!(sub_steps(Stencil::FivePoint, -1.0, 1.0, 0.5), 1);
    let field = WaveField::new(&WaveSettings::default()).expect("defaults");
    assert!(field.courant() <= 0.7 && field.courant() > 0.2);
    // Counted up one by one: the same number, everywhere.
    let mut counted = 0;
    for stencil in [Stencil::FivePoint, Stencil::NinePoint] {
        for i in 0..40 {
            for j in 0..40 {
                let (speed, cell) = (1e-3 * 1.3_f64.powi(i), 1e-4 * 1.3_f64.powi(j));
                if speed / 60.0 < 3e3 * cell {
                    let exact = truth::fewest_steps(stencil.max_courant(), speed, 1.0 / 60.0, cell);
                    assert_eq!(sub_steps(stencil, speed, 1.0 / 60.0, cell), exact, "{speed} {cell}");
                    let wrong = truth::fewest_steps(0.95 * stencil.max_courant(), speed, 1.0 / 60.0, cell);
                    counted += u32::from(wrong != exact);
                }
            }
        }
    }
    assert!(counted > 300, "a bound 5 % off goes unseen: {counted}");
    for odd in [f64::NEG_INFINITY, -1.0, 0.0, 5e-324] {
        assert_eq!(sub_steps(Stencil::FivePoint, 0.2, odd, 0.5), 1, "{odd}");
    }
    for (speed, interval, cell, steps) in [
        (f64::INFINITY, 1.0, 1.0, u32::MAX),
        (1.0, f64::INFINITY, 1.0, u32::MAX),
        (1.0, 1.0, f64::INFINITY, 1),
        (1.0, 1.0, 0.0, u32::MAX),
        (1.0, 1.0, 5e-324, u32::MAX),
        (1.0, f64::NAN, 1.0, 1),
        (1.0, 1.0, f64::NAN, 1),
        (0.0, f64::INFINITY, 1.0, 1),
    ] {
        assert_eq!(
            sub_steps(Stencil::NinePoint, speed, interval, cell),
            steps,
            "{speed} {interval} {cell}"
        );
    }
}

#[test]
fn energy_is_conserved_without_damping() {
    for stencil in [Stencil::FivePoint, Stencil::NinePoint] {
        let bump = |i: usize, j: usize| (-((i as f64 - 20.0).powi(2) + (j as f64 - 37.0).powi(2)) / 18.0).exp();
        let mut field = started(
            &WaveSettings {
                stencil,
                ..settings(64, 64, 0.7)
            },
            bump,
        );
        let (start, volume) = (field.energy(), super::total(&field));
        field.step(20_000);
        let drift = (field.energy() / start - 1.0).abs();
        assert!(drift < 1e-5, "{stencil:?}: {drift:e}");
        let moved = (super::total(&field) - volume).abs();
        assert!(moved < 1e-2, "{stencil:?}: the mean drifts by {moved}");
    }
    let mut double = DoubleField::new(64, Stencil::FivePoint, 0.7, 0.0, |i, j| {
        (-((i as f64 - 20.0).powi(2) + (j as f64 - 37.0).powi(2)) / 18.0).exp()
    })
    .expect("within the bound");
    let start = double.energy();
    double.step(20_000);
    assert!((double.energy() / start - 1.0).abs() < 1e-13);
}

#[test]
fn nothing_grows_in_a_million_steps_at_the_bound() {
    // Noise has every mode in it, the checkerboard too.
    let noise =
        |i: usize, j: usize| f64::from(rain_core::hash::unit_f32(rain_core::hash::pcg((j * 16 + i) as u32))) - 0.5;
    let mut field = started(&settings(16, 16, 0.70), noise);
    let energy = field.energy();
    let before = peak(&field);
    field.step(1_000_000);
    assert!(
        (field.energy() / energy - 1.0).abs() < 1e-2,
        "{}",
        field.energy() / energy
    );
    assert!(peak(&field) < 4.0 * before, "{}", peak(&field));
}

proptest! {
    #![proptest_config(cases(256))]
    #[test]
    fn sub_steps_hold_the_bound_and_are_fewest(
        speed in 1e-3_f64..100.0, interval in 1e-6_f64..1.0, cell in 1e-4_f64..100.0, more in 1.0_f64..3.0, nine: bool,
    ) {
        let stencil = if nine { Stencil::NinePoint } else { Stencil::FivePoint };
        let n = sub_steps(stencil, speed, interval, cell);
        let courant = |n: u32| speed * interval / f64::from(n) / cell;
        prop_assert!(courant(n) <= stencil.max_courant() * (1.0 + 2e-12));
        prop_assert!(n == 1 || courant(n - 1) > stencil.max_courant());
        prop_assert!(sub_steps(stencil, more * speed, interval, cell) >= n);
        prop_assert!(sub_steps(stencil, speed, interval, more * cell) <= n);
    }
}

proptest! {
    #![proptest_config(cases(64))]
    #[test]
    fn every_mode_follows_its_closed_form(
        cells in 4_usize..40, m in 0_usize..40, n in 0_usize..40, courant in 0.05_f64..0.7, damping in 0.0_f64..0.05,
        nine: bool,
    ) {
        let (m, n) = (m % cells, n % cells);
        let stencil = if nine { Stencil::NinePoint } else { Stencil::FivePoint };
        let lambda = truth::eigenvalue(cells, m, n, nine);
        prop_assume!(lambda * courant * courant > 0.02);
        let exact = truth::mode_amplitude(lambda, courant, damping, 100);
        let shape = |i: usize, j: usize| standing(cells, m, i) * standing(cells, n, j);
        let mut field = DoubleField::new(cells, stencil, courant, damping, shape).expect("within the bound");
        field.step(100);
        prop_assert!((field.amplitude(m, n) - exact).abs() < 1e-11);
    }
}
