//! What a view that moves holds more, against steps along many directions.

use glam::{DVec3, Vec4};
use rain_core::rainfall::{
    Container, DrawRange, FADE_END, FieldMotion, ParallelView, RANGE_CAP_M, RainViewVolume, expected_drops,
    quality_for_budget,
};

use crate::check::Worst;
use crate::drop_field::{spectrum, view};

/// Volume in a view of these tangents, within `reach` of the segment from the eye to `lead`, over that within reach of the eye.
/// By steps along many directions; the view looks along −Z.
fn lead_growth_by_steps([tx, ty]: [f64; 2], lead: DVec3, reach: f64) -> f64 {
    let (mut moving, mut still) = (0.0, 0.0);
    let side = 60;
    for i in 0..side * side {
        let at = |i: i32| 2.0 * (f64::from(i) + 0.5) / f64::from(side) - 1.0;
        let ray = DVec3::new(tx * at(i % side), ty * at(i / side), -1.0);
        let share = ray.length().powi(-3);
        let ray = ray.normalize();
        let step = (reach + lead.length()) / 600.0;
        for k in 0..600 {
            let t = step * (f64::from(k) + 0.5);
            let p = ray * t;
            let on = lead * (p.dot(lead) / lead.length_squared()).clamp(0.0, 1.0);
            let volume = share * t * t;
            moving += if p.distance(on) <= reach { volume } else { 0.0 };
            still += if t <= reach { volume } else { 0.0 };
        }
    }
    moving / still
}

#[test]
fn a_view_that_moves_holds_the_volume_along_its_lead() {
    let (mut near, mut far, mut bent) = (Worst::default(), Worst::default(), Worst::default());
    let tangents = [0.8, 0.4];
    for velocity in [
        DVec3::new(0.0, 0.0, -5.0),
        DVec3::new(0.0, 0.0, -36.0),
        DVec3::new(4.0, -1.0, -20.0),
        DVec3::new(0.0, 0.0, 20.0),
        DVec3::new(14.0, 0.0, 0.0),
        DVec3::new(-20.0, 3.0, -9.0),
        DVec3::new(0.0, -9.0, 1.0),
    ] {
        let view = RainViewVolume {
            eye_velocity_m_s: velocity,
            ..view(623.5, 1.0 / 60.0)
        };
        let lead = (velocity * 0.15).clamp_length_max(8.0);
        for reach in [0.4, 1.0, 3.0, 8.0, 18.0] {
            let slow = lead_growth_by_steps(tangents, lead, reach);
            let found = view.lead_growth(reach);
            let place = || format!("{velocity} m/s, {reach} m: {found}, {slow}");
            if lead.length() <= 6.0 * reach {
                near.relative(found, slow, 1e-30, place);
                bent.relative(1.1 * found, slow, 1e-30, String::new);
            } else {
                far.absolute(found.ln(), slow.ln(), place);
            }
        }
    }
    near.assert_below(6e-2, 30);
    far.assert_below(3.0_f64.ln(), 3);
    assert!(bent.error > 0.08);
    // What stands still, or has no planes or no velocity, holds what it holds.
    for odd in [
        view(623.5, 1.0 / 60.0),
        RainViewVolume {
            eye_velocity_m_s: DVec3::new(0.0, f64::NAN, 1.0),
            ..view(623.5, 1.0 / 60.0)
        },
        RainViewVolume {
            eye_velocity_m_s: DVec3::X,
            side_planes: [Vec4::ZERO; 4],
            ..view(623.5, 1.0 / 60.0)
        },
    ] {
        assert_eq!(odd.lead_growth(3.0), 1.0);
    }
    let fast = RainViewVolume {
        eye_velocity_m_s: DVec3::new(0.0, 0.0, -9.0),
        ..view(623.5, 1.0 / 60.0)
    };
    for bad in [f64::NAN, f64::NEG_INFINITY, -1.0, 0.0, 5e-324, 1e300, f64::INFINITY] {
        assert!(fast.lead_growth(bad).is_finite(), "{bad}");
    }
}

/// A view without perspective, so wide and high in metres, looking down a slope.
fn parallel([width, height]: [f64; 2]) -> RainViewVolume {
    let ahead = DVec3::new(0.3, -0.7, -0.6).normalize();
    let right = ahead.cross(DVec3::Y).normalize();
    let up = right.cross(ahead);
    RainViewVolume {
        side_planes: [
            right.as_vec3().extend(0.0),
            (-right).as_vec3().extend(width as f32),
            up.as_vec3().extend(0.5 * height as f32),
            (-up).as_vec3().extend(0.5 * height as f32),
        ],
        focal_px: 720.0 / height * RANGE_CAP_M,
        parallel: Some(ParallelView {
            across_m: right * width,
            height_m: height,
            ahead,
        }),
        ..view(600.0, 1.0 / 60.0)
    }
}

#[test]
fn without_perspective_large_drops_are_drawn_evenly_and_small_ones_not_at_all() {
    let (rain, mut container) = (spectrum(25.0), Container::default());
    for size in [[8.0, 4.5], [20.0, 11.25], [36.0, 20.0]] {
        let shown = parallel(size);
        let kappa = quality_for_budget(&rain, &shown, 20_000.0);
        let expected = expected_drops(&rain, &shown, kappa);
        assert!((expected / 20_000.0 - 1.0).abs() < 1e-6, "{expected}");
        assert!(container.fill(3, &rain, &FieldMotion::default(), &shown, kappa, 1 << 20));
        let drawn = container.records.len() as f64;
        // Streaks from above reach in, and a class is counted as two.
        assert!((drawn / expected - 1.0).abs() < 0.25, "{size:?}: {drawn} of {expected}");
        // As many in each ninth of the picture, but for those above it whose streaks reach in.
        let (mut ninths, mut furthest) = ([[0_u32; 3]; 3], 0.0_f64);
        let ParallelView { across_m, ahead, .. } = shown.parallel.expect("it has no perspective");
        let right = across_m.normalize();
        let up = right.cross(ahead);
        for record in &container.records {
            let p = record.position(3, &container.classes).as_dvec3();
            let (x, y) = (p.dot(right) / size[0], p.dot(up) / size[1] + 0.5);
            furthest = furthest.max((p - right * p.dot(right)).length());
            if (0.0..1.0).contains(&x) && (0.0..1.0).contains(&y) {
                ninths[(3.0 * y) as usize][(3.0 * x) as usize] += 1;
            }
        }
        assert!(furthest < FADE_END * RANGE_CAP_M + 0.01, "{furthest} m");
        // A disc has less depth above and below its middle.
        let depth = |y: f64| (1.0 - (y * size[1] / (FADE_END * RANGE_CAP_M)).powi(2)).sqrt();
        let ratio = depth(1.0 / 3.0) / depth(0.0);
        for (row, of) in ninths.iter().zip([ratio, 1.0, ratio]) {
            for count in row {
                let even = of * f64::from(ninths[1].iter().sum::<u32>()) / 3.0;
                let off = f64::from(*count) / even - 1.0;
                assert!(off.abs() < 0.12, "{size:?}: {ninths:?}");
            }
        }
    }
    // A view with perspective whose picture is as large at 15 m draws the same diameters so far.
    let (shown, flat) = (parallel([20.0, 11.25]), view(720.0 / 11.25 * RANGE_CAP_M, 1.0 / 60.0));
    for kappa in [0.2, 0.5, 1.0] {
        for d in [0.6, 1.0, 1.5, 2.0, 3.0, 5.0] {
            let drawn = shown.drawn_m(kappa, d);
            let seen = DrawRange::of(&flat, kappa).at(d);
            assert!(
                drawn == 0.0 || seen > 0.9 * RANGE_CAP_M,
                "{d} mm at {kappa}: {drawn}, {seen}"
            );
            assert!(
                drawn == RANGE_CAP_M || seen < RANGE_CAP_M,
                "{d} mm at {kappa}: {drawn}, {seen}"
            );
        }
    }
    // What is no view holds nothing.
    for bad in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        let odd = RainViewVolume {
            parallel: Some(ParallelView {
                across_m: DVec3::X * bad,
                height_m: bad,
                ahead: DVec3::NEG_Z,
            }),
            ..parallel([20.0, 11.25])
        };
        let drops = expected_drops(&rain, &odd, 1.0);
        assert!(drops.is_finite() && drops >= 0.0, "{bad}: {drops}");
        let _complete = container.fill(3, &rain, &FieldMotion::default(), &odd, 0.3, 1 << 16);
    }
}
