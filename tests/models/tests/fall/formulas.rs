//! Columns, slants and stiffness against their twins, columns in exact integers.

use proptest::prelude::*;
use rain_core::rainfall::{Fall, column_drop, drag_stiffness, fract, gust_gain, response_time_s, slant_rad};
use rain_reference::fall as reference;

use crate::check::Worst;

#[test]
fn columns_are_exact_fractions() {
    let (mut height, mut fraction, mut bent) = (Worst::default(), Worst::default(), Worst::default());
    // φ in 2⁻²⁰, v and t in 2⁻¹⁰, H in 2⁻⁸: x = φ + v t/H is a fraction of integers.
    for phase in [0_i32, 1, 262_144, -77_777, 1_048_575] {
        for speed in [102_i32, 4127, 9216, 10_240] {
            for time in [0_i32, 17, 1_048_576, 88_473_600, 88_473_601, -5_000_000] {
                for h in [128_i32, 1024, 1111, 12_800] {
                    let numerator = i128::from(phase) * i128::from(h) + 256 * i128::from(speed) * i128::from(time);
                    let (share, cycle) = reference::parts(numerator, i128::from(h) << 20);
                    let [p, v, t, h] = [(phase, 20), (speed, 10), (time, 10), (h, 8)]
                        .map(|(n, bits)| f64::from(n) / f64::from(1 << bits));
                    let drop = column_drop(p, v, t, h);
                    let place = || format!("φ {p}, {v} m/s, {t} s, {h} m");
                    // At the border of two falls rounding may choose the other one.
                    let near = share.min(1.0 - share) < 1e-9;
                    if !near {
                        assert_eq!(i128::from(drop.cycle), cycle.rem_euclid(1 << 32), "{}", place());
                        height.absolute(drop.height_m / h, 1.0 - share, place);
                        bent.absolute(column_drop(p, 1.05 * v, t, h).height_m / h, 1.0 - share, place);
                        fraction.absolute(f64::from(drop.fraction), share, place);
                    }
                }
            }
        }
    }
    height.assert_below(4e-9, 300);
    fraction.assert_below(6.4e-8, 300);
    assert!(bent.error > 0.4);
}

#[test]
fn fractions_are_those_of_integers() {
    let mut worst = Worst::default();
    for bits in [1_u32, 20, 40, 52, 62] {
        for n in [
            0_i64,
            1,
            3,
            -1,
            -2,
            4_503_599_627_370_495,
            -4_503_599_627_370_495,
            123_456_789_012,
            -7_654_321,
        ] {
            let (share, _) = reference::parts(i128::from(n), 1 << bits);
            let x = n as f64 / (1_u64 << bits) as f64;
            worst.absolute(fract(x), share, || format!("{n} of 2^{bits}"));
            assert!((0.0..1.0).contains(&fract(x)));
        }
    }
    worst.assert_below(1.2e-16, 45);
    for (x, part) in [(0.0, 0.0), (-0.0, 0.0), (1e300, 0.0), (5e-324, 5e-324), (0.25, 0.25)] {
        assert_eq!(fract(x), part);
    }
    assert!(fract(-5e-324) < 1.0 && fract(f64::NAN) == 0.0 && fract(f64::INFINITY) == 0.0);
}

#[test]
fn slants_gains_and_stiffness_are_their_formulas() {
    let (mut slant, mut gain, mut stiff, mut bent) =
        (Worst::default(), Worst::default(), Worst::default(), Worst::default());
    for i in -60..=60 {
        let u = 10_f64.powf(0.1 * f64::from(i));
        for v in [1e-6, 0.3, 4.03, 9.17, 1e3] {
            let place = || format!("{u} and {v} m/s");
            slant.relative(slant_rad(u, v), reference::slant(u, v), 1e-30, place);
            bent.relative(slant_rad(1.05 * u, v), reference::slant(u, v), 1e-30, place);
            assert_eq!(slant_rad(-u, v), slant_rad(u, -v));
            let x = core::f64::consts::TAU * u * (v / 9.80665);
            gain.relative(gust_gain(u, v), 1.0 / x.hypot(1.0), 1e-30, || {
                format!("{u} Hz, {v} m/s")
            });
            assert_eq!(response_time_s(v), v / 9.80665);
        }
    }
    for i in 0..=1000 {
        let d = 0.01 * f64::from(i);
        stiff.relative(drag_stiffness(d), reference::stiffness(d), 1e-30, || format!("{d} mm"));
    }
    slant.assert_below(1e-15, 600);
    gain.assert_below(1e-15, 600);
    stiff.assert_below(1e-15, 1000);
    assert!(bent.error > 0.04);
    assert_eq!((response_time_s(f64::NAN), response_time_s(-1.0)), (0.0, 0.0));
    assert_eq!(response_time_s(f64::INFINITY), response_time_s(1e3));
    assert_eq!((slant_rad(f64::NAN, 1.0), slant_rad(1.0, f64::NAN)), (0.0, 0.0));
    let of = Fall::of_drop(3.0).expect("valid");
    assert_eq!(of.terminal_m_s(), rain_core::rainfall::terminal_velocity(3.0));
}

proptest! {
    #![proptest_config(super::config())]

    #[test]
    fn slants_are_angles_that_grow_with_the_wind(u in 0.0_f64..60.0, more in 0.0_f64..5.0, v in 0.01_f64..10.0, f in 0.0_f64..20.0) {
        let angle = slant_rad(u, v);
        prop_assert!((0.0..=core::f64::consts::FRAC_PI_2).contains(&angle) && slant_rad(u + more, v) >= angle);
        prop_assert!(slant_rad(u, v + more) <= angle);
        prop_assert!((slant_rad(v, u) + angle - core::f64::consts::FRAC_PI_2).abs() < 1e-15 || u == 0.0);
        prop_assert!(gust_gain(f + more, v) <= gust_gain(f, v) && gust_gain(f, v + more) <= gust_gain(f, v));
        prop_assert!((0.3..=1.25).contains(&drag_stiffness(u)) && drag_stiffness(u + more) >= drag_stiffness(u));
        let x = u - 30.0;
        prop_assert!((0.0..1.0).contains(&fract(x)) && (fract(x + 3.0) - fract(x)).abs() < 1e-14);
    }
}
