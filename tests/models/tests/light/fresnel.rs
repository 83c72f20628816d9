//! Reflection at a water surface.

use proptest::prelude::*;
use rain_core::optics::{
    brewster_rad, critical_angle_rad, fresnel, fresnel_f32, fresnel_from_inside, fresnel_polarised, hemispherical_mean,
    hemispherical_mean_inside, normal_reflectance, schlick, schlick_f32,
};
use rain_reference::light as reference;

use super::{NOT_NUMBERS, config};
use crate::check::Worst;

const N: f64 = 1.333;

#[test]
fn reflectances_match_the_published_values() {
    let table = [
        (0.0, 0.020373, 0.020373),
        (30.0, 0.021436, 0.020415),
        (45.0, 0.027898, 0.022485),
        (60.0, 0.059691, 0.050987),
        (70.0, 0.133475, 0.141189),
        (75.0, 0.212378, 0.239493),
        (80.0, 0.347917, 0.397846),
        (85.0, 0.583523, 0.641305),
        (88.0, 0.804043, 0.840580),
    ];
    for (angle, exact, cheap) in table {
        let c = f64::to_radians(angle).cos();
        assert!((fresnel(c, N) - exact).abs() < 6e-7, "{angle}: {}", fresnel(c, N));
        assert!((schlick(c, N) - cheap).abs() < 6e-7, "{angle}: {}", schlick(c, N));
    }
    assert!((brewster_rad(N).to_degrees() - 53.123).abs() < 6e-4);
    assert!((critical_angle_rad(N).to_degrees() - 48.607).abs() < 6e-4);
    // Schlick's worst angle and error.
    let (mut worst, mut at) = (0.0, 0.0);
    for i in 0..=9000 {
        let angle = f64::from(i) * 0.01;
        let off = schlick(angle.to_radians().cos(), N) - fresnel(angle.to_radians().cos(), N);
        if off > worst {
            (worst, at) = (off, angle);
        }
    }
    assert!(
        (worst - 0.0592).abs() < 6e-5 && (at - 83.8).abs() < 0.06,
        "{worst} at {at}"
    );
    let cheap_mean = 2.0 * rain_reference::numerics::simpson(0.0, 1.0, 2000, |c| schlick(c, N) * c);
    assert!((cheap_mean - 0.06702).abs() < 6e-6, "{cheap_mean}");
    assert!(
        (hemispherical_mean(N) - 0.0664058).abs() < 6e-8,
        "{}",
        hemispherical_mean(N)
    );
    assert!((1.0 - hemispherical_mean(N) - 0.9336).abs() < 6e-5);
    assert!((hemispherical_mean_inside(N) - 0.474591).abs() < 6e-7);
}

#[test]
fn reflectance_is_fresnels_by_angles() {
    let (mut from_outside, mut from_inside, mut cheap) = (Worst::default(), Worst::default(), Worst::default());
    for n in [1.0001, 1.01, 1.2, N, 1.55, 2.4, 9.9] {
        for i in 0..=900 {
            let theta = f64::from(i) * 0.1_f64.to_radians();
            let [s, p] = reference::fresnel(theta, 1.0, n);
            let ours = fresnel_polarised(theta.cos(), n);
            let place = || format!("n {n} at {} deg", theta.to_degrees());
            from_outside.absolute(ours.s, s, place);
            from_outside.absolute(ours.p, p, place);
            from_outside.absolute(fresnel(theta.cos(), n), 0.5 * (s + p), place);
            cheap.absolute(schlick(theta.cos(), n), reference::schlick(theta, n), place);
            // At the critical angle F rises vertically: the angle itself is not sharp enough.
            if (theta - (1.0 / n).asin()).abs() > 1e-3 {
                let [s, p] = reference::fresnel(theta, n, 1.0);
                from_inside.absolute(fresnel_from_inside(theta.cos(), n), 0.5 * (s + p), place);
            }
        }
    }
    from_outside.assert_below(1e-12, 18_000);
    from_inside.assert_below(1e-12, 6_000);
    cheap.assert_below(1e-15, 6_000);

    let [s, p] = reference::fresnel(1.0, 1.0, N);
    assert!(
        (fresnel(1.0_f64.cos(), N * 1.05) - 0.5 * (s + p)).abs() > 1e-3,
        "5 % of the index goes unseen"
    );
}

#[test]
fn single_precision_reflectance_is_the_double_one() {
    let (mut outside, mut inside, mut cheap) = (Worst::default(), Worst::default(), Worst::default());
    for n in [1.1_f32, 1.333, 1.5, 2.0, 1.0 / 1.333, 0.5] {
        for i in 0..=20_000_u16 {
            let c = f32::from(i) / 20_000.0;
            let square = f64::from(n) * f64::from(n) - 1.0 + f64::from(c) * f64::from(c);
            let worst = if n > 1.0 { &mut outside } else { &mut inside };
            if square.abs() > 2e-5 || n > 1.0 {
                worst.absolute(
                    f64::from(fresnel_f32(c, n)),
                    fresnel(f64::from(c), f64::from(n)),
                    || format!("{n} {c}"),
                );
            }
            let f0 = normal_reflectance(f64::from(n));
            cheap.absolute(
                f64::from(schlick_f32(c, f0 as f32)),
                schlick(f64::from(c), f64::from(n)),
                || format!("{n} {c}"),
            );
        }
    }
    outside.assert_below(5e-7, 80_000);
    inside.assert_below(1e-5, 30_000);
    cheap.assert_below(3e-7, 100_000);
    assert_eq!(fresnel_f32(0.0, 1.333), 1.0);
    assert_eq!(fresnel_f32(0.1, 1.0 / 1.333), 1.0);
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn reflectance_is_a_share_and_the_same_from_both_sides(c in 0.0_f64..1.0, n in 1.001_f64..9.0) {
        let outside = fresnel_polarised(c, n);
        prop_assert!((0.0..=1.0).contains(&outside.s) && (0.0..=1.0).contains(&outside.p) && outside.s >= outside.p - 1e-15);
        // Snell: sin r = sin i/n.
        let inner = (1.0 - (1.0 - c * c) / (n * n)).sqrt();
        let inside = fresnel_polarised(inner, 1.0 / n);
        prop_assert!((outside.s - inside.s).abs() < 1e-11 && (outside.p - inside.p).abs() < 1e-11);
        prop_assert!(fresnel(c * 0.9, n) >= fresnel(c, n) - 0.3 && fresnel(0.0, n) == 1.0);
        // Cross-polarised light grows monotonically towards grazing.
        prop_assert!(fresnel_polarised(c * 0.9, n).s >= outside.s);
    }

    #[test]
    fn the_diffuse_mean_grows_with_the_index(n in 1.0_f64..9.0, more in 0.001_f64..0.5) {
        let (a, b) = (hemispherical_mean(n), hemispherical_mean(n + more));
        prop_assert!(a >= 0.0 && b > a && b < 1.0, "{a} {b}");
        prop_assert!(hemispherical_mean_inside(n) >= a);
    }
}

#[test]
fn the_diffuse_mean_is_the_integral_also_near_one() {
    let (mut absolute, mut relative) = (Worst::default(), Worst::default());
    for excess in [1e-6, 1e-4, 1e-3, 0.01, 0.0199, 0.0201, 0.05, 0.2, 0.333, 0.55, 1.0, 3.0] {
        let n = 1.0 + excess;
        let mean = reference::diffuse_mean(n);
        absolute.absolute(hemispherical_mean(n), mean, || format!("{n}"));
        relative.relative(hemispherical_mean(n), mean, 1e-30, || format!("{n}"));
    }
    absolute.assert_below(1e-13, 12);
    relative.assert_below(1e-11, 12);
    assert_eq!(hemispherical_mean(1.0), 0.0);
    // Both forms meet.
    assert!((hemispherical_mean(1.02 - 1e-9) - hemispherical_mean(1.02 + 1e-9)).abs() < 1e-9);
}

#[test]
fn brewsters_and_the_critical_angle_are_where_they_belong() {
    for n in [1.1, N, 2.0] {
        assert!(fresnel_polarised(brewster_rad(n).cos(), n).p < 1e-28);
        let critical = critical_angle_rad(n);
        assert_eq!(fresnel_from_inside((critical + 1e-6).cos(), n), 1.0);
        assert!(fresnel_from_inside((critical - 1e-6).cos(), n) < 1.0);
    }
    assert_eq!(critical_angle_rad(1.0), core::f64::consts::FRAC_PI_2);
}

#[test]
fn reflection_answers_every_number() {
    for bad in NOT_NUMBERS {
        for other in [0.5, bad] {
            for value in [
                fresnel(bad, other),
                fresnel(other, bad),
                fresnel_from_inside(bad, other),
                schlick(other, bad),
            ] {
                assert!((0.0..=1.0).contains(&value), "{bad} {other}: {value}");
            }
            assert!((0.0..=1.0).contains(&fresnel_f32(bad as f32, other as f32)));
            assert!((0.0..=1.0).contains(&fresnel_f32(other as f32, bad as f32)));
            assert!((0.0..=1.0).contains(&schlick_f32(bad as f32, bad as f32)));
        }
        assert!(
            (0.0..=1.0).contains(&hemispherical_mean(bad)) && (0.0..=1.0).contains(&hemispherical_mean_inside(bad))
        );
        assert!(brewster_rad(bad).is_finite() && critical_angle_rad(bad).is_finite());
        assert!(normal_reflectance(bad).is_finite());
    }
    assert_eq!(fresnel(0.0, 1.0), 0.0);
    assert!((fresnel(f64::NAN, N) - normal_reflectance(N)).abs() < 1e-16);
}
