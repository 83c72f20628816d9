use std::f64::consts::TAU;

use proptest::prelude::*;
use rain_core::waves::{
    bottom_damping, bottom_damping_f32, bulk_damping, bulk_damping_f32, group_speed, group_speed_f32,
    minimum_phase_speed, phase_speed, phase_speed_f32, shallow_speed, shallow_speed_f32, wave_frequency,
    wave_frequency_f32,
};
use rain_reference::waves as truth;

use super::super::check::Worst;
use super::cases;

/// Wavelengths from 0.1 mm to 100 m on depths from 0.1 mm to 100 m.
fn grid() -> impl Iterator<Item = (f64, f64)> {
    (0..60).flat_map(|i| (0..40).map(move |j| (TAU / 1e-4 / 10_f64.powf(0.1 * f64::from(i)), 1e-4 * 1.42_f64.powi(j))))
}

#[test]
fn waves_run_at_the_published_speeds() {
    // λ in mm; phase and group speed on 5 mm, then on 10 mm.
    for (wavelength, at_5, at_10) in [
        (5.0, [0.31536, 0.44831], [0.31536, 0.44829]),
        (10.0, [0.24739, 0.31114], [0.24785, 0.30882]),
        (20.0, [0.22281, 0.23602], [0.23222, 0.21713]),
        (50.0, [0.22037, 0.21911], [0.27228, 0.22055]),
        (100.0, [0.22108, 0.22043], [0.29912, 0.27450]),
    ] {
        let k = TAU / (wavelength * 1e-3);
        for (depth, [phase, group]) in [(0.005, at_5), (0.010, at_10)] {
            assert!(
                (phase_speed(k, depth) - phase).abs() < 5.1e-6,
                "{wavelength} mm on {depth} m"
            );
            assert!(
                (group_speed(k, depth) - group).abs() < 5.1e-6,
                "{wavelength} mm on {depth} m"
            );
        }
    }
    for (depth, speed) in [(0.002, 0.14005), (0.005, 0.22143), (0.010, 0.31316)] {
        assert!((shallow_speed(depth) - speed).abs() < 5.1e-6);
    }
    // 24 % at 20 mm on 2 mm; 2 % from 17 mm on at 5 mm.
    assert!((phase_speed(TAU / 0.02, 0.002) / shallow_speed(0.002) - 1.24).abs() < 5e-3);
    for i in 0..100 {
        let k = TAU / (0.017 * 1.05_f64.powi(i));
        assert!((phase_speed(k, 0.005) / shallow_speed(0.005) - 1.0).abs() < 0.02);
    }
}

#[test]
fn the_slowest_wave_is_17_mm_long() {
    let (speed, length) = minimum_phase_speed();
    assert!((speed - 0.231_272).abs() < 5e-7 && (length - 0.017_135).abs() < 5e-7);
    assert!((speed / length - 13.497).abs() < 5e-4);
    for factor in [0.9, 0.99, 1.01, 1.1] {
        assert!(phase_speed(TAU / (length * factor), 100.0) > speed);
    }
    assert!((phase_speed(TAU / length, 100.0) / speed - 1.0).abs() < 1e-14);
}

#[test]
fn the_slowest_wave_is_where_gravity_and_tension_pull_alike() {
    let (speed, length) = minimum_phase_speed();
    let (mut worst, mut wrong) = (Worst::default(), Worst::default());
    let [exact_speed, exact_length] = truth::slowest_wave();
    worst.relative(speed, exact_speed, 0.0, || "speed".into());
    worst.relative(length, exact_length, 0.0, || "length".into());
    worst.assert_below(1e-14, 2);
    wrong.relative(1.05 * speed, exact_speed, 0.0, String::new);
    assert!(wrong.error > 0.04);
    // On deep water no wave of any length is slower; on water thinner than that length the longest are.
    for (k, _) in grid() {
        assert!(phase_speed(k, 100.0) >= speed * (1.0 - 1e-15), "{k}");
    }
    assert!(phase_speed(0.0, 0.004) < speed);
}

#[test]
fn speeds_are_those_of_the_dispersion_relation() {
    let [mut frequency, mut group, mut single, mut single_group] = [(); 4].map(|()| Worst::default());
    let [mut shallow, mut single_shallow] = [(); 2].map(|()| Worst::default());
    for (k, h) in grid() {
        let exact = truth::frequency(k, h);
        let place = || format!("k {k}, h {h}");
        frequency.relative(wave_frequency(k, h), exact, 0.0, place);
        frequency.relative(phase_speed(k, h), exact / k, 0.0, place);
        group.relative(group_speed(k, h), truth::group_speed(k, h), 0.0, place);
        let (k32, h32) = (k as f32, h as f32);
        single.relative(
            f64::from(wave_frequency_f32(k32, h32)),
            wave_frequency(k32.into(), h32.into()),
            0.0,
            place,
        );
        single.relative(
            f64::from(phase_speed_f32(k32, h32)),
            phase_speed(k32.into(), h32.into()),
            0.0,
            place,
        );
        single_group.relative(
            f64::from(group_speed_f32(k32, h32)),
            group_speed(k32.into(), h32.into()),
            0.0,
            place,
        );
        single_shallow.relative(f64::from(shallow_speed_f32(h32)), shallow_speed(h32.into()), 0.0, place);
        shallow.relative(shallow_speed(h), truth::shallow_speed(h), 0.0, place);
    }
    frequency.assert_below(1e-14, 4000);
    group.assert_below(1e-8, 2000);
    single.assert_below(1e-6, 4000);
    shallow.assert_below(3e-16, 2000);
    single_shallow.assert_below(3e-7, 2000);
    single_group.assert_below(2e-6, 2000);
    let mut wrong = Worst::default();
    wrong.relative(
        wave_frequency(100.0, 0.005 * 1.05),
        truth::frequency(100.0, 0.005),
        0.0,
        || "5 %".into(),
    );
    assert!(wrong.error > 0.02);
}

#[test]
fn waves_decay_at_the_published_rates() {
    for (wavelength, time) in [(0.005, 0.315), (0.010, 1.26), (0.020, 5.05)] {
        assert!((bulk_damping(TAU / wavelength) * time - 1.0).abs() < 2e-3);
    }
    for (wavelength, rate) in [(0.020, 0.161), (0.050, 0.290), (0.100, 0.247_46)] {
        assert!((bottom_damping(TAU / wavelength, 0.005) - rate).abs() < 5.1e-4);
    }
    let [mut double, mut single, mut in_bulk, mut single_in_bulk] = [(); 4].map(|()| Worst::default());
    for (k, h) in grid() {
        let (bulk, bottom) = truth::damping(k, h);
        let place = || format!("k {k}, h {h}");
        in_bulk.relative(bulk_damping(k), bulk, 0.0, place);
        double.relative(bottom_damping(k, h), bottom, 1e-250, place);
        let (k32, h32) = (k as f32, h as f32);
        single_in_bulk.relative(f64::from(bulk_damping_f32(k32)), bulk_damping(k32.into()), 0.0, place);
        single.relative(
            f64::from(bottom_damping_f32(k32, h32)),
            bottom_damping(k32.into(), h32.into()),
            1e-3,
            place,
        );
    }
    double.assert_below(1e-13, 2000);
    single.assert_below(2e-6, 2000);
    in_bulk.assert_below(1e-15, 2000);
    single_in_bulk.assert_below(4e-7, 2000);
    let mut wrong = Worst::default();
    wrong.relative(bulk_damping(105.0), truth::damping(100.0, 0.005).0, 0.0, String::new);
    assert!(wrong.error > 0.05, "a wave number 5 % off goes unseen");
}

#[test]
fn no_wave_number_or_depth_makes_nonsense() {
    let values = [
        0.0,
        -1.0,
        1e-300,
        1e-30,
        1.0,
        1e30,
        1e300,
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
    ];
    for k in values {
        for h in values {
            let all = [
                wave_frequency(k, h),
                phase_speed(k, h),
                group_speed(k, h),
                bulk_damping(k),
                bottom_damping(k, h),
                shallow_speed(h),
            ];
            assert!(all.iter().all(|x| x.is_finite() && *x >= 0.0), "k {k}, h {h}: {all:?}");
            let (k, h) = (k as f32, h as f32);
            let all = [
                wave_frequency_f32(k, h),
                phase_speed_f32(k, h),
                group_speed_f32(k, h),
                bulk_damping_f32(k),
                bottom_damping_f32(k, h),
                shallow_speed_f32(h),
            ];
            assert!(all.iter().all(|x| x.is_finite() && *x >= 0.0), "k {k}, h {h}: {all:?}");
        }
    }
    assert_eq!(phase_speed(0.0, 0.005), shallow_speed(0.005));
    assert_eq!(phase_speed(f64::NAN, 0.005), shallow_speed(0.005));
    assert_eq!(shallow_speed(f64::INFINITY), shallow_speed(1e4));
}

proptest! {
    #![proptest_config(cases(256))]
    #[test]
    fn frequency_rises_with_wave_number_and_depth(k in 1e-2_f64..1e5, h in 1e-4_f64..10.0, more in 1.001_f64..3.0) {
        prop_assert!(wave_frequency(k * more, h) > wave_frequency(k, h));
        prop_assert!(wave_frequency(k, h * more) >= wave_frequency(k, h) * (1.0 - 1e-15));
        prop_assert!(phase_speed(k, h) <= phase_speed(k, 1e4) * (1.0 + 1e-15));
        // Between gravity's half and capillarity's three halves.
        let ratio = group_speed(k, h) / phase_speed(k, h);
        prop_assert!((0.5..=2.0).contains(&ratio));
        prop_assert!(shallow_speed(h * more) > shallow_speed(h) && bulk_damping(k * more) > bulk_damping(k));
        prop_assert!(bottom_damping(k, h) >= bottom_damping(k, h * more));
    }
}
