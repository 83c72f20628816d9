//! Light through a drop.

use glam::Vec3;
use proptest::prelude::*;
use rain_core::optics::{
    CHEAP_REFLECTED, CHEAP_REFRACTED, deviation_rad, deviation_sin_cos_f32, disc_share_within, drop_light,
    drop_rays_f32, energy_split, field_of_view_rad, impact_of_deviation, rainbow, retro_reflection, sphere_order_share,
};
use rain_reference::light::sphere as reference;

use super::{NOT_NUMBERS, config};
use crate::check::Worst;

const N: f64 = 1.333;

#[test]
fn deviations_match_the_published_values() {
    let table = [
        (0.1, 2.874),
        (0.3, 8.903),
        (0.5, 15.940),
        (0.7, 25.500),
        (0.8, 32.499),
        (0.9, 43.382),
        (0.95, 52.704),
        (0.99, 67.859),
        (1.0, 82.787),
    ];
    for (s, angle) in table {
        let ours = deviation_rad(s, N).to_degrees();
        assert!((ours - angle).abs() < 6e-4, "{s}: {ours}");
    }
    assert!((field_of_view_rad(N).to_degrees() - 165.57).abs() < 6e-3);
    for (n, view) in [(1.3314, 165.26), (1.3342, 165.81), (1.3377, 166.49)] {
        assert!(
            (field_of_view_rad(n).to_degrees() - view).abs() < 0.02,
            "{n}: {}",
            field_of_view_rad(n).to_degrees()
        );
    }
    for (angle, share) in [
        (10.0, 0.1115),
        (20.0, 0.3539),
        (30.0, 0.5900),
        (40.0, 0.7651),
        (50.0, 0.8799),
        (60.0, 0.9491),
    ] {
        let ours = disc_share_within(f64::to_radians(angle), N);
        assert!((ours - share).abs() < 6e-5, "{angle}: {ours}");
    }
}

#[test]
fn deviation_is_that_of_traced_rays() {
    let (mut double, mut single) = (Worst::default(), Worst::default());
    for n in [1.01, 1.2, N, 1.5, 2.0] {
        for i in 0..=1000 {
            let s = f64::from(i) * 1e-3;
            let ours = deviation_rad(s, n);
            double.absolute(ours, 2.0 * (s.asin() - (s / n).asin()), || format!("n {n} s {s}"));
            if i < 1000 {
                double.absolute(ours, reference::deviation(s, n), || format!("traced, n {n} s {s}"));
            }
            let rounded = (f64::from(s as f32), f64::from(n as f32));
            let exact = deviation_rad(rounded.0, rounded.1);
            let [sin, cos] = deviation_sin_cos_f32(s as f32, n as f32);
            single.absolute(f64::from(sin), exact.sin(), || format!("n {n} s {s}"));
            single.absolute(f64::from(cos), exact.cos(), || format!("n {n} s {s}"));
        }
    }
    double.assert_below(2e-14, 9_000);
    single.assert_below(5e-7, 9_000);
    assert!(
        (deviation_rad(0.7, N * 1.05) - reference::deviation(0.7, N)).abs() > 0.01,
        "5 % of the index goes unseen"
    );
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn impact_and_deviation_are_inverse(s in 0.0_f64..0.99, more in 1e-4_f64..0.01, n in 1.05_f64..3.0) {
        let angle = deviation_rad(s, n);
        prop_assert!((impact_of_deviation(angle, n) - s).abs() < 1e-13, "{}", impact_of_deviation(angle, n));
        prop_assert!(deviation_rad(s + more, n) > angle);
        prop_assert!((disc_share_within(angle, n) - s * s).abs() < 1e-13);
    }

    #[test]
    fn rays_of_a_drop_are_those_traced(
        x in -1.0_f32..1.0, y in -1.0_f32..1.0, z in -1.0_f32..1.0, azimuth in 0.0_f32..6.25, s in 0.001_f32..0.99
    ) {
        let view = Vec3::new(x, y, z);
        prop_assume!(view.length() > 0.1);
        let view = view.normalize();
        let side = view.any_orthonormal_vector();
        let across = side * azimuth.cos() + view.cross(side) * azimuth.sin();
        let normal = (across * s - view * (1.0 - s * s).sqrt()).normalize();
        let ours = drop_rays_f32(view, normal, 1.333).expect("unit vectors");
        let wide = |v: Vec3| v.to_array().map(f64::from);
        let rays = reference::trace(wide(view), wide(normal), f64::from(1.333_f32), 2);
        let off = |v: Vec3, d: [f64; 3]| (0..3).map(|i| (f64::from(v[i]) - d[i]).abs()).fold(0.0, f64::max);
        prop_assert!(off(ours.reflected, rays[0].direction) < 2e-6);
        prop_assert!(off(ours.refracted, rays[1].direction) < 1e-5, "{:?} {:?} s {s}", ours.refracted, rays[1].direction);
        let reflected = 0.5 * (rays[0].power[0] + rays[0].power[1]);
        prop_assert!((f64::from(ours.reflected_weight) - reflected).abs() < 5e-6);
        prop_assert!((ours.reflected_weight + ours.refracted_weight.sqrt() - 1.0).abs() < 1e-6);
    }
}

#[test]
fn the_two_rays_at_an_impact_are_those_traced() {
    let mut worst = Worst::default();
    for i in 1..100 {
        let s = f64::from(i) * 0.01;
        let light = drop_light(s, N);
        let rays = reference::at_impact(s, N, 2);
        let turn = |d: [f64; 3]| d[0].hypot(d[1]).atan2(-d[2]);
        worst.absolute(light.refracted_rad, turn(rays[1].direction), || {
            format!("refracted {s}")
        });
        worst.absolute(light.reflected_rad, turn(rays[0].direction), || {
            format!("reflected {s}")
        });
        worst.absolute(light.reflected, 0.5 * (rays[0].power[0] + rays[0].power[1]), || {
            format!("F {s}")
        });
        // The refracted ray goes towards the axis and through it, the reflected one away.
        assert!(rays[1].direction[0] < 0.0 && rays[0].direction[0] > 0.0);
        assert!((light.refracted - (1.0 - light.reflected).powi(2)).abs() < 1e-15);
    }
    worst.assert_below(1e-14, 290);
}

#[test]
fn energy_goes_where_it_is_published_to_go() {
    let split = energy_split(N);
    assert!((split.reflected - 0.06641).abs() < 6e-6, "{split:?}");
    assert!((split.through - 0.8837).abs() < 6e-5, "{split:?}");
    assert!(
        (split.inner[0] - 0.04060).abs() < 6e-6 && (split.inner[1] - 0.00612).abs() < 6e-6,
        "{split:?}"
    );
    let sum = split.reflected + split.through + split.inner.iter().sum::<f64>() + split.rest;
    assert!((sum - 1.0).abs() < 1e-15);
    // Averaging F before squaring, as a cheap model would.
    let unpolarised = rain_reference::numerics::simpson(0.0, 1.0, 2000, |s: f64| 2.0 * s * drop_light(s, N).refracted);
    assert!((unpolarised - 0.8814).abs() < 6e-5, "{unpolarised}");
    assert!((f64::from(CHEAP_REFRACTED) - split.through).abs() < 5e-4);
    assert!((f64::from(CHEAP_REFLECTED) - split.reflected).abs() < 5e-4);
}

#[test]
fn energy_of_every_order_is_that_of_the_traced_disc() {
    let mut worst = Worst::default();
    for n in [1.05, 1.2, N, 1.5, 2.0] {
        let traced = reference::energy(n, 6);
        for (order, share) in traced.iter().enumerate() {
            worst.absolute(sphere_order_share(order as u32, n), *share, || {
                format!("n {n} order {order}")
            });
        }
        let sum: f64 = (0..60).map(|order| sphere_order_share(order, n)).sum();
        assert!((sum - 1.0).abs() < 1e-3 && sum <= 1.0 + 1e-7, "n {n}: {sum}");
    }
    worst.assert_below(2e-8, 30);
    assert!(
        (sphere_order_share(2, N * 1.05) - reference::energy(N, 3)[2]).abs() > 1e-3,
        "5 % of the index goes unseen"
    );
}

#[test]
fn rainbows_stand_where_they_stand() {
    for (order, angle, impact) in [(1, 42.078, 0.8608), (2, 50.891, 0.9502)] {
        let bow = rainbow(order, N).expect("water has it");
        assert!(
            (bow.angle_rad.to_degrees() - angle).abs() < 6e-4,
            "{order}: {}",
            bow.angle_rad.to_degrees()
        );
        assert!((bow.impact - impact).abs() < 6e-5, "{order}: {}", bow.impact);
        let (slow, at) = reference::bow(order as usize, N);
        assert!(
            (bow.angle_rad - slow).abs() < 1e-9 && (bow.impact - at).abs() < 1e-4,
            "{order}: {slow} {at}"
        );
    }
    // Red outside the primary, inside the secondary.
    let angle = |order, n| rainbow(order, n).expect("has it").angle_rad;
    assert!(angle(1, 1.3314) > angle(1, 1.3377) && angle(2, 1.3314) < angle(2, 1.3377));
    assert!(rainbow(0, N).is_none() && rainbow(1, 2.1).is_none() && rainbow(2, 2.1).is_some());
    for bad in NOT_NUMBERS {
        assert!(rainbow(1, bad).is_none_or(|bow| bow.angle_rad.is_finite()));
        assert!(rainbow(u32::MAX, bad).is_none_or(|bow| bow.angle_rad.is_finite()));
    }
}

#[test]
fn retro_reflection_is_the_published_one() {
    assert!(
        (retro_reflection(N) - 0.0246155).abs() < 6e-8,
        "{}",
        retro_reflection(N)
    );
    assert!((4.0 / N - 2.0 - 1.00075).abs() < 6e-6);
    // From traced rays near the axis: light in a ring of impact parameters over the solid angle it leaves into.
    let (s, ds) = (1e-3, 1e-5);
    let turned = |s: f64, order: usize| {
        let d = reference::at_impact(s, N, order + 1)[order].direction;
        d[0].hypot(d[1]).atan2(d[2])
    };
    let of = |order: usize| {
        let power = reference::at_impact(s, N, order + 1)[order].power;
        let angle = turned(s, order);
        let per_impact = (turned(s + ds, order) - turned(s - ds, order)) / (2.0 * ds);
        0.5 * (power[0] + power[1]) * s / (angle.sin() * per_impact.abs())
    };
    assert!(
        (of(0) + of(2) - retro_reflection(N)).abs() < 1e-6,
        "{} {}",
        of(0),
        of(2)
    );
    for bad in NOT_NUMBERS {
        assert!(retro_reflection(bad).is_finite());
    }
    assert!(retro_reflection(2.0).is_finite());
}

#[test]
fn drops_answer_every_number() {
    for bad in NOT_NUMBERS {
        for (s, n) in [(bad, N), (0.5, bad), (bad, bad)] {
            assert!(deviation_rad(s, n).is_finite() && impact_of_deviation(s, n).is_finite());
            assert!(deviation_sin_cos_f32(s as f32, n as f32).iter().all(|v| v.is_finite()));
            assert!((0.0..=1.0).contains(&disc_share_within(s, n)));
            let light = drop_light(s, n);
            assert!(light.refracted.is_finite() && light.refracted_rad.is_finite() && light.reflected_rad.is_finite());
        }
        assert!(field_of_view_rad(bad).is_finite());
        let split = energy_split(bad);
        assert!(split.reflected.is_finite() && split.rest.is_finite());
        assert!(drop_rays_f32(Vec3::splat(bad as f32), Vec3::Y, 1.3).is_none());
        assert!(
            drop_rays_f32(Vec3::Y, -Vec3::Y, bad as f32)
                .expect("unit")
                .refracted
                .is_finite()
        );
    }
    assert!(drop_rays_f32(Vec3::Y, Vec3::ZERO, 1.3).is_none());
    // Head on, and a normal that looks away.
    let through = drop_rays_f32(Vec3::Y, -Vec3::Y, 1.333).expect("unit");
    assert!(through.refracted == Vec3::Y && through.reflected == -Vec3::Y);
    assert_eq!(
        drop_rays_f32(Vec3::Y, Vec3::Y, 1.333).expect("unit").reflected_weight,
        1.0
    );
    assert!((energy_split(1.0).through - 1.0).abs() < 1e-15);
    assert_eq!(impact_of_deviation(1.0, 1.0), 0.0);
}
