//! Volumes, modes, phases and points of a drop against their twins.

use proptest::prelude::*;
use rain_core::rainfall::{
    DropOutline, Oscillation, Spheroid, axis_ratio, drop_mass_kg, drop_volume_mm3, mode_decay_s, mode_frequency_hz,
    phase_turns, sustained_amplitude,
};
use rain_reference::{drop as reference, fall};

use super::{angles, config};
use crate::check::Worst;

/// 1 µm to 1 m.
fn diameters() -> impl Iterator<Item = f64> {
    (0..=120).map(|i| 1e-3 * 10_f64.powf(0.05 * f64::from(i)))
}

#[test]
fn volumes_and_masses_are_a_balls() {
    let (mut worst, mut bent) = (Worst::default(), Worst::default());
    for d in diameters() {
        let volume = reference::ball(d);
        worst.relative(drop_volume_mm3(d), volume, 1e-30, || format!("{d} mm"));
        worst.relative(drop_mass_kg(d), 998.2 * volume * 1e-9, 1e-60, || {
            format!("mass at {d} mm")
        });
        bent.relative(drop_volume_mm3(1.05 * d), volume, 1e-30, String::new);
        // A spheroid of the same volume and the given axis ratio: on its axes.
        let s = Spheroid::of_drop(d);
        let wide = (volume * 0.75 / (core::f64::consts::PI * axis_ratio(d))).cbrt();
        worst.relative(s.horizontal_mm, wide, 1e-30, || format!("width at {d} mm"));
        worst.relative(s.vertical_mm, axis_ratio(d) * wide, 1e-30, || {
            format!("height at {d} mm")
        });
        worst.relative(s.radius_mm(1.0), s.vertical_mm, 1e-30, || format!("top at {d} mm"));
        worst.relative(s.radius_mm(0.0), s.horizontal_mm, 1e-30, || format!("side at {d} mm"));
    }
    worst.assert_below(2e-15, 700);
    assert!(bent.error > 0.1);
    for (bad, held) in [
        (f64::NAN, 0.0),
        (f64::NEG_INFINITY, 0.0),
        (5e-324, 0.0),
        (1e300, 1e3),
        (f64::INFINITY, 1e3),
    ] {
        assert_eq!(
            (drop_volume_mm3(bad), drop_mass_kg(bad)),
            (drop_volume_mm3(held), drop_mass_kg(held))
        );
    }
}

#[test]
fn modes_are_rayleighs_and_lambs_over_the_whole_domain() {
    let (mut worst, mut amplitude) = (Worst::default(), Worst::default());
    for d in diameters() {
        for n in [2, 3, 7, 40, 100] {
            let place = || format!("mode {n}, {d} mm");
            let (order, metres) = (f64::from(n), 1e-3 * d);
            worst.relative(
                mode_frequency_hz(n, d),
                reference::mode_frequency(order, metres),
                1e-30,
                place,
            );
            worst.relative(mode_decay_s(n, d), reference::mode_decay(order, metres), 1e-30, place);
        }
        amplitude.absolute(sustained_amplitude(d), reference::amplitude(d), || format!("{d} mm"));
    }
    worst.assert_below(2e-15, 1200);
    amplitude.assert_below(1e-16, 121);
    assert_eq!(mode_frequency_hz(500, 2.0), mode_frequency_hz(100, 2.0));
    assert_eq!(
        (mode_decay_s(0, 2.0), mode_decay_s(u32::MAX, 2.0)),
        (mode_decay_s(2, 2.0), mode_decay_s(100, 2.0))
    );
    for (bad, held) in [
        (f64::NAN, 1e-3),
        (-1.0, 1e-3),
        (0.0, 1e-3),
        (1e300, 1e3),
        (f64::INFINITY, 1e3),
    ] {
        assert_eq!(mode_frequency_hz(2, bad), mode_frequency_hz(2, held));
        assert_eq!(mode_decay_s(2, bad), mode_decay_s(2, held));
    }
    assert_eq!(
        (sustained_amplitude(f64::NAN), sustained_amplitude(f64::INFINITY)),
        (0.0, 0.15)
    );
}

#[test]
fn phases_are_exact_fractions_of_the_turns_made() {
    let (mut worst, mut bent) = (Worst::default(), Worst::default());
    for frequency in [0.1, 30.75, 343.851_372_9, 972.55, 1883.3] {
        for time in [0.0, 1.0 / 60.0, 0.333_984_375, 3600.0, 86_400.007_812_5, -77.25] {
            // Few enough digits that the product of integers fits.
            let time = f64::from(time as f32);
            for start in [0.0, 1e-3, 0.25, 0.999_999, -0.3] {
                let start = f64::from(start as f32);
                let (share, whole) = fall::exact_turns(start, frequency, time);
                let off = |found: f64| {
                    let off = (found - share).abs();
                    off.min(1.0 - off) / (whole.unsigned_abs() as f64).max(1.0)
                };
                let place = || format!("{frequency} Hz, {time} s, from {start}");
                worst.absolute(off(phase_turns(frequency, time, start)), 0.0, place);
                bent.absolute(off(phase_turns(1.05 * frequency, time, start)), 0.0, String::new);
            }
        }
    }
    worst.assert_below(0.5_f64.powi(52), 120);
    assert!(bent.error > 0.01);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
        for other in [1.0, bad] {
            assert!((0.0..1.0).contains(&phase_turns(bad, other, 0.25)), "{bad}");
            assert!((0.0..1.0).contains(&phase_turns(1.0, other, bad)), "{bad}");
        }
    }
}

#[test]
fn points_and_deflections_are_those_of_the_slow_sum() {
    let (mut point, mut swing) = (Worst::default(), Worst::default());
    for d in [0.3, 1.0, 2.0, 3.3, 4.5, 6.0, 9.0] {
        let outline = DropOutline::new(d);
        let slow = reference::scaled_radius(d);
        for theta in angles(40) {
            let r = 0.5 * d * slow(theta);
            let found = outline.point_mm(theta.cos());
            let place = || format!("{d} mm at {theta}");
            point.absolute(found.x / d, r * theta.sin() / d, place);
            point.absolute(found.y / d, -r * theta.cos() / d, place);
        }
        for turns in [0.0, 0.1, 0.25, 0.6, 0.99] {
            let drop = Oscillation::released(d, turns, [0.3, 0.1]);
            for (found, amplitude) in drop.deflections().into_iter().zip([0.3, 0.1]) {
                swing.absolute(found, amplitude * (core::f64::consts::TAU * turns).sin(), || {
                    format!("{turns}")
                });
            }
        }
    }
    point.assert_below(1e-12, 500);
    swing.assert_below(1e-15, 70);
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn larger_drops_are_heavier_slower_and_flatter(d in 0.001_f64..900.0, more in 1.0_f64..1.1, n in 2_u32..100) {
        prop_assert!(drop_volume_mm3(d * more) >= drop_volume_mm3(d) && drop_mass_kg(d * more) >= drop_mass_kg(d));
        prop_assert!(mode_frequency_hz(n, d * more) <= mode_frequency_hz(n, d));
        prop_assert!(mode_decay_s(n, d * more) >= mode_decay_s(n, d));
        prop_assert!(sustained_amplitude(d * more) >= sustained_amplitude(d));
        let s = Spheroid::of_drop(d);
        prop_assert!(s.vertical_mm <= s.horizontal_mm * (1.0 + 1e-15));
        prop_assert!((drop_volume_mm3(2.0 * d.min(400.0)) / drop_volume_mm3(d.min(400.0)) - 8.0).abs() < 1e-14);
    }
}
