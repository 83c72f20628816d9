//! Distances, rates, bounds, gradients and integrals.

use core::f64::consts::PI;

use glam::{DVec2, DVec3};
use rain_core::haze::{EXTINCTION_EFFICIENCY, extinction_per_m};
use rain_core::rainfall::areas::{
    AreaError, AreaFade, AreaField, AreaFieldF32, AreaKey, AreaMotion, AreaRain, AreaSettings, AreaShape,
    border_weight, border_weight_f32, ellipse_distance, ellipse_distance_f32, ellipse_nearest, ellipse_ray,
    ellipse_tangents, polygon_distance, polygon_distance_f32,
};
use rain_core::rainfall::{Distribution, Spectrum};
use rain_reference::areas as slow;

use super::{ellipse, field, mixed, pair, places, star};
use crate::check::Worst;

const ELLIPSES: [[f64; 2]; 6] = [
    [100.0, 30.0],
    [30.0, 100.0],
    [50.0, 50.0],
    [400.0, 5.0],
    [0.1, 0.1],
    [180.0, 179.0],
];

#[test]
fn distances_from_an_ellipse_are_those_of_a_search() {
    let (mut worst, mut single) = (Worst::default(), Worst::default());
    for radii in ELLIPSES {
        let mut check = |p: DVec2| {
            let slow = slow::distance(&slow::Outline::Ellipse(radii), p.to_array());
            let scale = radii[0].max(radii[1]) + p.length();
            worst.relative(ellipse_distance(p, radii.into()) / scale, slow / scale, 1.0, || {
                format!("{radii:?} {p}")
            });
            let near = ellipse_distance_f32(p.as_vec2().to_array(), radii.map(|r| r as f32));
            single.relative(f64::from(near) / scale, slow / scale, 1.0, || format!("{radii:?} {p}"));
        };
        places(400).for_each(&mut check);
        for t in [0.0, 0.2, 0.999, 1.0, 1.001, 3.0] {
            check(DVec2::new(radii[0] * t, 0.0));
            check(DVec2::new(0.0, -radii[1] * t));
            check(DVec2::new(-radii[0] * t, 1e-9));
        }
    }
    // The search itself cannot tell a minimum closer than the root of a rounding; its value it can.
    worst.assert_below(1e-12, 2000);
    single.assert_below(2e-6, 2000);
}

#[test]
fn nearest_points_tangents_and_rays_meet_the_ellipse() {
    let mut worst = Worst::default();
    let mut rays = 0;
    for radii in ELLIPSES.map(DVec2::from) {
        let on = |p: DVec2| (p / radii).length();
        for p in places(300) {
            let q = ellipse_nearest(p, radii);
            worst.absolute(on(q), 1.0, || format!("{radii} {p}"));
            match ellipse_tangents(p, radii) {
                None => assert!(on(p) <= 1.0),
                Some(tangents) => {
                    for t in tangents {
                        worst.absolute(on(t), 1.0, || format!("tangent {radii} {p}"));
                        // The tangent at t: x t_x/a² + y t_y/b² = 1.
                        let value = (p * t / (radii * radii)).element_sum();
                        worst.relative(value, 1.0, on(p), || format!("tangent {radii} {p}"));
                    }
                }
            }
            let direction = -p + DVec2::new(0.3 * radii.x, 0.0);
            if let Some([near, far]) = ellipse_ray(p, direction, radii) {
                rays += 1;
                let e = direction.normalize();
                worst.relative(on(p + e * far), 1.0, on(p), || format!("exit {radii} {p}"));
                if near > 0.0 {
                    worst.relative(on(p + e * near), 1.0, on(p), || format!("entry {radii} {p}"));
                }
            }
            assert_eq!(
                ellipse_ray(p * 10.0 + p.normalize() * 500.0, p, radii),
                None,
                "away from {radii}"
            );
        }
    }
    assert!(rays > 1500, "{rays}");
    worst.assert_below(1e-11, 4000);
}

#[test]
fn distances_from_a_polygon_are_those_of_a_search() {
    let (mut worst, mut single) = (Worst::default(), Worst::default());
    for radius in [5.0, 80.0, 150.0] {
        let AreaShape::Polygon { corners_m } = star(radius) else {
            unreachable!()
        };
        let corners: Vec<[f64; 2]> = corners_m.iter().map(DVec2::to_array).collect();
        let corners_f32: Vec<[f32; 2]> = corners.iter().map(|c| c.map(|v| v as f32)).collect();
        for p in places(500) {
            let slow = slow::distance(&slow::Outline::Polygon(corners.clone()), p.to_array());
            let scale = radius + p.length();
            worst.absolute(polygon_distance(p, &corners_m) / scale, slow / scale, || {
                format!("{radius} {p}")
            });
            let near = polygon_distance_f32(p.as_vec2().to_array(), &corners_f32);
            // At the border of single precision a point may be on either side.
            let slow = if slow.abs() < 1e-5 * scale {
                slow.abs().copysign(f64::from(near))
            } else {
                slow
            };
            single.absolute(f64::from(near) / scale, slow / scale, || format!("{radius} {p}"));
        }
    }
    worst.assert_below(1e-13, 1500);
    single.assert_below(2e-6, 1500);
}

#[test]
fn rates_are_those_of_the_rule_in_both_precisions() {
    let (fast, areas) = mixed();
    let (mut worst, mut single) = (Worst::default(), Worst::default());
    let mut packed = AreaFieldF32::default();
    let origin = DVec2::new(12.5, -7.25);
    assert!(fast.pack(origin, 600.0, &mut packed));
    assert_eq!(packed.areas, 5);
    for weather in [0.0, 8.0, 60.0] {
        for p in places(800) {
            let slow = slow::rate(&areas, 0.5, weather, p.to_array());
            worst.relative(fast.rate_at(p, weather), slow, 40.0, || format!("{weather} {p}"));
            let near = packed.rate_at((p - origin).as_vec2().to_array(), weather as f32);
            single.relative(f64::from(near), slow, 180.0, || format!("{weather} {p}"));
        }
    }
    worst.assert_below(1e-12, 2400);
    // Of a rate, times 300 m over a transition of 10 m.
    single.assert_below(2e-6 * 30.0, 2400);
    // What is too far is left out, and nothing changes where it matters.
    assert!(fast.pack(DVec2::new(-150.0, -150.0), 5.0, &mut packed));
    assert_eq!(packed.areas, 1);
    assert_eq!(packed.rate_at([0.0, 0.0], 8.0), 4.0);
}

#[test]
fn weights_are_even_about_the_border() {
    let (mut worst, mut single) = (Worst::default(), Worst::default());
    for transition in [0.0, 0.5, 20.0, 1e5] {
        for i in -40..=40 {
            let distance = f64::from(i) * 0.02 * transition;
            let w = border_weight(distance, transition);
            if transition > 0.0 {
                worst.absolute(w + border_weight(-distance, transition), 1.0, || {
                    format!("{transition} {i}")
                });
            }
            let near = border_weight_f32(distance as f32, transition as f32);
            single.absolute(f64::from(near), w, || format!("{transition} {i}"));
        }
        assert_eq!(
            [border_weight(-1e6, transition), border_weight(1e6, transition)],
            [1.0, 0.0]
        );
    }
    worst.assert_below(1e-15, 200);
    single.assert_below(4e-7, 300);
    assert_eq!(border_weight(0.0, 0.0), 0.0, "a sharp outline is outside");
    assert_eq!(border_weight(f64::NAN, 1.0), 0.0);
}

#[test]
fn it_rains_inside_an_area_and_not_outside() {
    let (area, _) = pair([100.0, 50.0], ellipse(60.0, 20.0, 0.0), AreaRain::Rate(30.0), 0.0, 1.0);
    let dry_outside = field(&[&area], 0.0);
    for (place, rate) in [
        ([100.0, 50.0], 30.0),
        ([159.9, 50.0], 30.0),
        ([160.1, 50.0], 0.0),
        ([100.0, 69.9], 30.0),
        ([100.0, 70.1], 0.0),
        ([0.0, 0.0], 0.0),
    ] {
        assert_eq!(dry_outside.rate_at(place.into(), 12.0), rate, "{place:?}");
    }
    // The weather's rain in the area alone.
    let of_weather = AreaSettings {
        rain: AreaRain::OfWeather(1.0),
        ..area.clone()
    };
    let only = field(&[&of_weather], 0.0);
    assert_eq!(
        [only.rate_at(area.centre_m, 12.0), only.rate_at(DVec2::ZERO, 12.0)],
        [12.0, 0.0]
    );
    // None: the weather's everywhere.
    assert!(AreaField::default().is_uniform());
    assert_eq!(AreaField::default().rate_at(DVec2::ZERO, 12.0), 12.0);
    assert_eq!(dry_outside.rate_at(DVec2::NAN, 12.0), 0.0);
}

#[test]
fn overlapping_areas_give_the_heaviest_and_their_order_does_not_count() {
    let circle = |x: f64, rain: AreaRain| pair([x, 0.0], AreaShape::Circle { radius_m: 50.0 }, rain, 10.0, 1.0).0;
    let (a, b) = (circle(-20.0, AreaRain::Rate(40.0)), circle(20.0, AreaRain::Rate(40.0)));
    let hole = circle(0.0, AreaRain::Scale(0.0));
    let double = circle(60.0, AreaRain::Scale(2.0));
    let both = field(&[&a, &b], 1.0);
    assert_eq!(
        both.rate_at(DVec2::ZERO, 5.0),
        40.0,
        "not 80: a region is built of several shapes"
    );
    assert_eq!(both.rate_at(DVec2::new(0.0, 200.0), 5.0), 5.0);
    let all = [&a, &b, &hole, &double];
    let one = field(&all, 1.0);
    let other = field(&[all[3], all[2], all[1], all[0]], 1.0);
    for p in places(500) {
        let (x, y) = (one.rate_at(p, 5.0), other.rate_at(p, 5.0));
        assert!((x - y).abs() <= 1e-13 * 80.0, "{p}: {x} {y}");
        assert!(x <= one.highest_mm_h(5.0));
    }
    assert_eq!(one.rate_at(DVec2::ZERO, 5.0), 0.0, "a hole is dry in any rain");
    assert_eq!(
        one.rate_at(DVec2::new(68.0, 0.0), 5.0),
        both.rate_at(DVec2::new(68.0, 0.0), 5.0) * 2.0
    );
    assert_eq!(
        field(
            &[&circle(0.0, AreaRain::Rate(400.0)), &circle(0.0, AreaRain::Scale(3.0))],
            1.0
        )
        .rate_at(DVec2::ZERO, 0.0),
        500.0
    );
}

#[test]
fn no_rate_is_beyond_the_bounds_around_it() {
    let (fast, _) = mixed();
    let (mut even, mut reached) = (0, 0);
    for (i, p) in places(300).enumerate() {
        let radius = [0.5, 5.0, 40.0][i % 3];
        let [low, high] = fast.rates_within(p, radius, 8.0);
        even += u32::from(low == high);
        let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
        for j in 0..200 {
            let turn = DVec2::from_angle(f64::from(j) * 2.399_963_229_728_653);
            let rate = fast.rate_at(p + turn * radius * (f64::from(j) / 199.0).sqrt(), 8.0);
            assert!(
                rate >= low - 1e-9 && rate <= high + 1e-9,
                "{p} {radius}: {rate} not in {low}..{high}"
            );
            (least, most) = (least.min(rate), most.max(rate));
        }
        reached += u32::from(most - least > 0.5 * (high - low));
    }
    assert!(even > 100 && reached > 60, "{even} {reached}");
}

#[test]
fn gradients_are_those_of_differences() {
    let (fast, _) = mixed();
    let (mut worst, mut steep) = (Worst::default(), 0);
    for p in places(2000) {
        let h = 1e-4;
        let along = |d: DVec2| (fast.rate_at(p + d * h, 8.0) - fast.rate_at(p - d * h, 8.0)) / (2.0 * h);
        let second =
            |d: DVec2| fast.rate_at(p + d * h, 8.0) - 2.0 * fast.rate_at(p, 8.0) + fast.rate_at(p - d * h, 8.0);
        // Where two rules meet there is a kink; it shows as a second difference.
        if second(DVec2::X).abs().max(second(DVec2::Y).abs()) > 1e-7 {
            continue;
        }
        let slope = fast.gradient_at(p, 8.0);
        steep += u32::from(slope.length() > 0.1);
        let difference = DVec2::new(along(DVec2::X), along(DVec2::Y));
        // In the steepest units: 60 mm/h over 10 m.
        worst.absolute(slope.distance(difference) / 6.0, 0.0, || {
            format!("{p} {slope} {difference}")
        });
    }
    assert!(steep > 150, "{steep}");
    worst.assert_below(1e-6, 1800);
}

#[test]
fn water_of_an_area_is_that_of_counted_cells() {
    let mut worst = Worst::default();
    for (shape, transition) in [
        (AreaShape::Circle { radius_m: 50.0 }, 30.0),
        (ellipse(80.0, 50.0, 0.4), 30.0),
        (ellipse(80.0, 20.0, 1.0), 60.0),
        (star(60.0), 20.0),
    ] {
        let (area, slow) = pair([3.0, 7.0], shape, AreaRain::Rate(1.0), transition, 1.0);
        worst.relative(area.effective_area_m2(), slow::ground(&slow, 130.0, 200), 1.0, || {
            format!("{:?}", area.shape)
        });
    }
    worst.assert_below(1e-3, 4);
    // Steiner's formula in numbers: A + π T²/20.
    let (disc, _) = pair(
        [0.0; 2],
        AreaShape::Circle { radius_m: 50.0 },
        AreaRain::Rate(1.0),
        40.0,
        1.0,
    );
    assert!((disc.effective_area_m2() / (2500.0 * PI + 80.0 * PI) - 1.0).abs() < 1e-12);
    // The integral of many areas keeps its bound, and meets the closed form of one.
    let alone = field(&[&disc], 0.0).integral(DVec2::splat(-80.0), DVec2::splat(80.0), 0.0, 0.05);
    let off = (alone.value_mm_h_m2 - 2580.0 * PI).abs();
    assert!(
        off <= 1e-3 * 2580.0 * PI && off <= alone.bound_mm_h_m2,
        "{off} {alone:?}"
    );
    let (fast, areas) = mixed();
    let found = fast.integral(DVec2::splat(-200.0), DVec2::splat(200.0), 8.0, 0.05);
    let cells = 200;
    let mut counted = 0.0;
    for i in 0..cells {
        for j in 0..cells {
            let at = |i: i32| 2.0 * f64::from(i) + 1.0 - 200.0;
            counted += 4.0 * slow::rate(&areas, 0.5, 8.0, [at(i), at(j)]);
        }
    }
    assert!(
        (found.value_mm_h_m2 / counted - 1.0).abs() < 1e-3,
        "{found:?} {counted}"
    );
    assert!((found.value_mm_h_m2 - counted).abs() < found.bound_mm_h_m2 + 1e-4 * counted);
}

#[test]
fn an_area_moves_and_fades_in_closed_form() {
    let key = |time_s: f64, x: f64| AreaKey {
        time_s,
        moved_m: DVec2::new(x, 0.0),
    };
    let drift = AreaMotion::Drift {
        velocity_m_s: DVec2::new(5.0, -2.0),
        start_s: 10.0,
    };
    let path = AreaMotion::Path {
        keys: vec![key(0.0, 0.0), key(10.0, 100.0), key(30.0, 60.0)],
    };
    assert_eq!(drift.moved_m(30.0), DVec2::new(100.0, -40.0));
    assert_eq!(drift.velocity_m_s(3.0), DVec2::new(5.0, -2.0));
    for (time, x) in [
        (-5.0, 0.0),
        (0.0, 0.0),
        (4.0, 40.0),
        (10.0, 100.0),
        (20.0, 80.0),
        (30.0, 60.0),
        (99.0, 60.0),
    ] {
        assert!((path.moved_m(time).x - x).abs() < 1e-12, "{time}");
    }
    assert_eq!(
        [
            path.velocity_m_s(5.0).x,
            path.velocity_m_s(15.0).x,
            path.velocity_m_s(99.0).x
        ],
        [10.0, -2.0, 0.0]
    );
    let fade = AreaFade {
        start_s: Some(100.0),
        fade_in_s: 20.0,
        end_s: Some(300.0),
        fade_out_s: 60.0,
    };
    for (time, strength) in [
        (99.0, 0.0),
        (110.0, 0.5),
        (120.0, 1.0),
        (240.0, 1.0),
        (270.0, 0.5),
        (300.0, 0.0),
    ] {
        assert!((fade.strength(time) - strength).abs() < 1e-15, "{time}");
    }
    assert_eq!(AreaFade::default().strength(-1e9), 1.0);
    let area = AreaSettings {
        shape: AreaShape::Circle { radius_m: 30.0 },
        rain: AreaRain::Rate(20.0),
        motion: path,
        fade,
        ..AreaSettings::default()
    };
    let at = |time: f64| {
        let mut field = AreaField::new(0.0);
        field.push(&area, DVec2::new(0.0, 5.0), time);
        field
    };
    assert!(at(50.0).areas().is_empty(), "not yet there");
    assert_eq!(at(110.0).rate_at(DVec2::new(60.0, 5.0), 0.0), 10.0);
    assert_eq!(at(200.0).rate_at(DVec2::new(60.0, 5.0), 0.0), 20.0);
}

#[test]
fn optical_depth_along_a_ray_does_not_jump_at_the_border() {
    let (area, _) = pair([0.0; 2], ellipse(200.0, 90.0, 0.3), AreaRain::Rate(50.0), 30.0, 1.0);
    let rain = field(&[&area], 0.0);
    let extinction = |rate: f64| {
        let spectrum = Spectrum::new(Distribution::MarshallPalmer, rate).expect("inside the domain");
        extinction_per_m(&spectrum, EXTINCTION_EFFICIENCY)
    };
    let ahead = DVec3::new(0.9, 0.1, 0.3).normalize();
    let start = DVec3::new(-150.0, 1.7, -20.0) - 200.0 * ahead;
    let depth = |way: f64| {
        let eye = start + way * ahead;
        rain.along(eye, eye + 900.0 * ahead, 0.0, extinction)
    };
    // The eye walks in, through and out; depth may not change by more than what stands in a step of 0.5 m.
    let (mut before, mut steepest, mut inside) = (depth(0.0), 0.0_f64, 0.0_f64);
    for i in 1..=1400 {
        let now = depth(0.5 * f64::from(i));
        steepest = steepest.max((now - before).abs());
        inside = inside.max(now);
        before = now;
    }
    let whole = extinction(50.0);
    assert!(inside > 200.0 * whole, "{inside}");
    assert!(
        steepest < 0.5 * whole * 1.005 && steepest > 0.4 * whole,
        "{steepest} in half a metre of {whole} per m"
    );
    assert!(before < 1e-12, "out again: {before}");
    // Against many small steps.
    let (eye, mut sum) = (DVec3::new(-150.0, 1.7, -20.0), 0.0);
    for i in 0..60_000 {
        let p = eye + ahead * ((f64::from(i) + 0.5) * 0.01);
        sum += 0.01 * extinction(rain.rate_at(DVec2::new(p.x, p.z), 0.0));
    }
    let found = rain.along(eye, eye + 600.0 * ahead, 0.0, extinction);
    assert!((found / sum - 1.0).abs() < 1e-6, "{found} {sum}");
}

#[test]
fn bad_areas_are_refused_by_name() {
    let polygon = |corners: &[[f64; 2]]| AreaShape::Polygon {
        corners_m: corners.iter().copied().map(DVec2::from).collect(),
    };
    let of = |shape: AreaShape| {
        AreaSettings {
            shape,
            ..AreaSettings::default()
        }
        .check()
    };
    for (shape, message) in [
        (AreaShape::Circle { radius_m: 0.0 }, "radius_m is 0"),
        (AreaShape::Circle { radius_m: f64::NAN }, "radius_m is NaN"),
        (ellipse(10.0, -1.0, 0.0), "radii_m is -1"),
        (ellipse(10.0, 5.0, f64::INFINITY), "heading_rad is inf"),
        (polygon(&[[0.0, 0.0], [1.0, 0.0]]), "2 corners"),
        (polygon(&[[0.0, 0.0], [f64::NAN, 0.0], [1.0, 1.0]]), "corners_m is NaN"),
        // A bow tie, a touch, a doubled corner, a spike, a line.
        (
            polygon(&[[0.0, 0.0], [4.0, 4.0], [4.0, 0.0], [0.0, 4.0]]),
            "from corners 0 and 2",
        ),
        (
            polygon(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 0.0]]),
            "from corners 0 and",
        ),
        (
            polygon(&[[0.0, 0.0], [4.0, 0.0], [4.0, 0.0], [0.0, 4.0]]),
            "from corners 1 and 1",
        ),
        (
            polygon(&[[0.0, 0.0], [8.0, 0.0], [4.0, 0.0], [0.0, 4.0]]),
            "from corners 0 and 1",
        ),
        (polygon(&[[0.0, 0.0], [4.0, 0.0], [2.0, 0.0]]), "from corners"),
        (polygon(&[[0.0, 0.0], [0.05, 0.0], [0.05, 0.05]]), "less than 0.01 m²"),
    ] {
        let error = of(shape.clone()).expect_err("bad").to_string();
        assert!(error.contains(message), "{shape:?}: {error}");
    }
    assert_eq!(of(star(20.0)), Ok(()));
    let refused = |area: AreaSettings| area.check().expect_err("bad").to_string();
    let area = AreaSettings::default;
    assert!(
        refused(AreaSettings {
            transition_m: -1.0,
            ..area()
        })
        .contains("transition_m is -1")
    );
    assert!(
        refused(AreaSettings {
            rain: AreaRain::Rate(501.0),
            ..area()
        })
        .contains("rate is 501")
    );
    assert!(
        refused(AreaSettings {
            rain: AreaRain::Scale(f64::NAN),
            ..area()
        })
        .contains("scale is NaN")
    );
    assert!(
        refused(AreaSettings {
            centre_m: DVec2::INFINITY,
            ..area()
        })
        .contains("centre_m is inf")
    );
    let path = |times: &[f64]| AreaMotion::Path {
        keys: times
            .iter()
            .map(|&time_s| AreaKey {
                time_s,
                ..AreaKey::default()
            })
            .collect(),
    };
    assert!(
        refused(AreaSettings {
            motion: path(&[]),
            ..area()
        })
        .contains("keys is empty")
    );
    assert!(
        refused(AreaSettings {
            motion: path(&[1.0, 1.0]),
            ..area()
        })
        .contains("entry 1")
    );
    let late = AreaFade {
        fade_out_s: -1.0,
        ..AreaFade::default()
    };
    assert!(matches!(
        AreaSettings { fade: late, ..area() }.check(),
        Err(AreaError::Config(_))
    ));
}

#[test]
fn a_map_shows_rates_and_outlines() {
    let (fast, _) = mixed();
    let map = fast
        .map(DVec2::new(-100.0, -50.0), DVec2::new(100.0, 50.0), [40, 10], 8.0)
        .expect("valid");
    assert_eq!((map.cells, map.rates_mm_h.len()), ([40, 10], 400));
    for (i, rate) in map.rates_mm_h.iter().enumerate() {
        let at = DVec2::new(-97.5 + 5.0 * (i % 40) as f64, -45.0 + 10.0 * (i / 40) as f64);
        assert!((f64::from(*rate) - fast.rate_at(at, 8.0)).abs() < 1e-4, "{at}");
    }
    for area in fast.areas() {
        let line = area.outline_m(64);
        assert!(
            line.iter().all(|p| area.distance_m(*p).abs() < 1e-9 * 120.0),
            "{area:?}"
        );
        assert!(line.is_empty() == (area.distance_m(DVec2::ZERO) == f64::NEG_INFINITY));
    }
    let refused = |high: DVec2, cells| fast.map(DVec2::ZERO, high, cells, 8.0).is_err();
    assert!(refused(DVec2::new(1.0, 0.0), [4, 4]) && refused(DVec2::NAN, [4, 4]));
    assert!(refused(DVec2::ONE, [0, 4]) && refused(DVec2::ONE, [1 << 12, 1 << 12]));
}
