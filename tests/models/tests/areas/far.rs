//! Far rain: the container at the perimeter holds what a view has in sight, and no more.

use core::f64::consts::PI;

use glam::DVec2;
use rain_core::rainfall::areas::{FarView, Seen, ellipse_nearest, far_fit, near_share};

use super::places;

const ELLIPSES: [([f64; 2], f64); 4] = [
    ([60.0, 25.0], 0.4),
    ([20.0, 90.0], -1.0),
    ([40.0, 40.0], 0.0),
    ([150.0, 4.0], 2.5),
];

#[test]
fn the_far_container_holds_the_area_in_sight_and_touches_it() {
    let centre = DVec2::new(15.0, -30.0);
    let (mut wholes, mut parts, mut none) = (0, 0, 0);
    for (radii, heading) in ELLIPSES {
        let (radii, axis) = (DVec2::from(radii), DVec2::from_angle(heading));
        for (i, eye) in places(160).enumerate() {
            let view = FarView {
                eye_m: eye,
                ahead: DVec2::from_angle(0.1 * i as f64),
                half_view_rad: [0.9, 0.5, 0.1][i % 3],
            };
            let local = DVec2::new(axis.x, -axis.y).rotate(eye - centre);
            let outside = (local / radii).length() > 1.0;
            // Points of the area that are between the picture's sides, by a dense search.
            let mut sight = Vec::new();
            for ring in 0..40 {
                for step in 0..720 {
                    let r = 1.0 - (f64::from(ring) / 39.0).powi(2);
                    let p = centre + axis.rotate(DVec2::from_angle(f64::from(step) * PI / 360.0) * radii * r);
                    if view.ahead.angle_to(p - eye).abs() <= view.half_view_rad {
                        sight.push(p);
                    }
                }
            }
            let fit = far_fit(&view, centre, radii, heading);
            let Some(fit) = fit else {
                assert!(!outside || sight.is_empty(), "{eye} sees {} points", sight.len());
                none += 1;
                continue;
            };
            assert!(outside);
            match fit.seen {
                Seen::Whole => wholes += 1,
                Seen::Part => parts += 1,
            }
            let nearest = centre + axis.rotate(ellipse_nearest(local, radii));
            assert!(fit.anchor_m.distance(nearest) < 1e-9 && (fit.distance_m - eye.distance(nearest)).abs() < 1e-9);
            let (mut least, mut most, mut deep) = (0.0_f64, 0.0_f64, 0.0_f64);
            for p in sight {
                let from = p - fit.anchor_m;
                let (across, depth) = (fit.towards.perp().dot(from), fit.towards.dot(from));
                let bound = 1e-7 * (radii.max_element() + fit.distance_m);
                assert!(
                    across >= fit.across_m[0] - bound && across <= fit.across_m[1] + bound,
                    "{eye} {p}: {across} {fit:?}"
                );
                assert!(
                    depth >= -bound && depth <= fit.depth_m + bound,
                    "{eye} {p}: {depth} {fit:?}"
                );
                (least, most, deep) = (least.min(across), most.max(across), deep.max(depth));
            }
            // It is no wider than what it holds, but for the step of the search.
            let step = 0.03 * radii.max_element() + 0.02 * fit.distance_m.min(100.0);
            assert!(
                fit.across_m[0] >= least - step && fit.across_m[1] <= most + step,
                "{fit:?} {least} {most}"
            );
            assert!(fit.depth_m <= deep + 2.0 * step, "{fit:?} {deep}");
            assert!((fit.width_m() - (fit.across_m[1] - fit.across_m[0])).abs() < 1e-12);
        }
    }
    assert!(wholes > 30 && parts > 60 && none > 100, "{wholes} {parts} {none}");
}

#[test]
fn a_wide_area_is_in_view_although_its_nearest_point_is_not() {
    let radii = DVec2::new(500.0, 500.0);
    let view = |turn: f64| FarView {
        eye_m: DVec2::new(-520.0, 0.0),
        ahead: DVec2::from_angle(turn),
        half_view_rad: 0.4,
    };
    // The nearest point is straight ahead at +X; the view looks 60° past it, where the area still stands.
    let fit = far_fit(&view(1.05), DVec2::ZERO, radii, 0.0).expect("in view");
    assert!(fit.bearings_rad[1] < 0.35 && fit.seen == Seen::Part, "{fit:?}");
    assert_eq!(far_fit(&view(PI), DVec2::ZERO, radii, 0.0), None, "behind the eye");
    assert_eq!(
        far_fit(
            &FarView {
                eye_m: DVec2::ZERO,
                ..view(0.0)
            },
            DVec2::ZERO,
            radii,
            0.0
        ),
        None,
        "inside"
    );
}

#[test]
fn far_rain_reaches_the_cloud_or_the_top_of_the_picture() {
    let view = FarView {
        eye_m: DVec2::new(-1000.0, 0.0),
        ahead: DVec2::X,
        half_view_rad: 0.7,
    };
    let fit = far_fit(&view, DVec2::ZERO, DVec2::splat(200.0), 0.0).expect("in view");
    assert_eq!(fit.seen, Seen::Whole);
    assert!((fit.distance_m - 800.0).abs() < 1e-9 && (fit.depth_m - 400.0).abs() < 1e-9);
    assert!((fit.width_m() - 400.0).abs() < 1e-9, "{}", fit.width_m());
    assert_eq!(fit.height_m(300.0, 0.5), 300.0);
    assert!((fit.height_m(5000.0, 0.5) - 1200.0 * 0.5_f64.tan()).abs() < 1e-9);
    assert_eq!(fit.height_m(300.0, -0.2), 0.0, "looking down");
}

#[test]
fn near_and_far_change_places_smoothly_at_the_perimeter() {
    let radii = DVec2::new(80.0, 50.0);
    let mut before = near_share(DVec2::new(-120.0, 5.0), radii, 20.0);
    assert_eq!(before, 0.0);
    let mut steepest = 0.0_f64;
    for i in 1..=2400 {
        let p = DVec2::new(-120.0 + 0.1 * f64::from(i), 5.0);
        let now = near_share(p, radii, 20.0);
        steepest = steepest.max((now - before).abs());
        if (p / radii).length() < 0.6 {
            assert_eq!(now, 1.0);
        }
        before = now;
    }
    // 1.5 over the transition, at 0.1 m a step.
    assert!(steepest <= 0.1 * 1.5 / 20.0 + 1e-12 && steepest > 0.005, "{steepest}");
    let border = radii * DVec2::from_angle(1.0);
    assert!((near_share(border, radii, 20.0) - 0.5).abs() < 1e-12);
    // The anchor of far rain approaches the eye: at the crossing they are one.
    for away in [10.0, 1.0, 0.1, 1e-6] {
        let eye = border * (1.0 + away / border.length());
        let view = FarView {
            eye_m: eye,
            ahead: -border,
            half_view_rad: 0.6,
        };
        let fit = far_fit(&view, DVec2::ZERO, radii, 0.0).expect("outside");
        assert!(fit.distance_m <= away && fit.anchor_m.distance(border) < 2.0 * away);
    }
}
