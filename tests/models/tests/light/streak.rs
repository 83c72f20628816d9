//! Streaks of moving drops.

use core::f64::consts::{FRAC_PI_4, PI};

use glam::Vec3;
use proptest::prelude::*;
use rain_core::rainfall::{
    ScreenStreak, circle_of_confusion_px, clip_to_near, contrast_gain, lamp_falloff_per_m2, streak_length_m,
    streak_opacity, streak_opacity_f32, streak_path_m, streak_peak_opacity, terminal_velocity, visible_range_m,
};
use rain_reference::fall_speed::measured;
use rain_reference::light::streak as reference;

use super::{NOT_NUMBERS, config};
use crate::check::Worst;

#[test]
fn lengths_and_opacities_match_the_published_values() {
    let table = [
        (0.5, 3.433, 0.412, 0.01456),
        (1.0, 6.717, 0.806, 0.01489),
        (2.0, 10.817, 1.298, 0.01849),
        (3.0, 13.433, 1.612, 0.02233),
        (4.0, 14.717, 1.766, 0.02718),
    ];
    for (d, video, sport, opacity) in table {
        let v = measured(d);
        let path = streak_path_m(v, 1.0 / 60.0);
        assert!((path * 100.0 - video).abs() < 6e-4, "{d}: {path}");
        assert!((streak_path_m(v, 1.0 / 500.0) * 100.0 - sport).abs() < 6e-4, "{d}");
        assert!((streak_peak_opacity(d, path) - opacity).abs() < 6e-6, "{d}");
        assert!((streak_length_m(v, 1.0 / 60.0, d) - path - d * 1e-3).abs() < 1e-15);
        // The peak is the profile's.
        assert!((streak_opacity(0.0, 0.5 * path, d * 1e-3, path) - opacity).abs() < 6e-6);
    }
    // Yoshida, 1/30 s and the speeds of that source: digest B, 30 D/v.
    for (d, v, opacity) in [(1.0, 3.877, 0.00774), (1.4, 5.048, 0.00832), (2.0, 6.529, 0.00919)] {
        assert!(
            (streak_peak_opacity(d, streak_path_m(v, 1.0 / 30.0)) - opacity).abs() < 6e-6,
            "{d}"
        );
    }
}

#[test]
fn opacity_is_the_share_of_time_that_the_disc_covers() {
    let samples = 512;
    let mut worst = Worst::default();
    for path in [0.0, 0.3, 1.0, 2.5, 20.0] {
        for i in -12..=12 {
            for j in -8..=40 {
                let (x, y) = (f64::from(i) * 0.0471, -0.7 + (path + 1.4) * f64::from(j) / 32.0);
                let slow = reference::covered_share(x, y, 1.0, path, samples);
                worst.absolute(streak_opacity(x, y, 1.0, path), slow, || {
                    format!("path {path} at {x} {y}")
                });
            }
        }
    }
    // The samples' own resolution.
    worst.assert_below(1.0 / f64::from(samples), 6_000);
    let wrong = streak_opacity(0.0, 5.0, 1.05, 10.0);
    assert!((wrong - reference::covered_share(0.0, 5.0, 1.0, 10.0, samples)).abs() > 1.0 / f64::from(samples));
}

#[test]
fn a_drop_darkens_by_its_disc_whatever_the_exposure() {
    for (diameter, path) in [(1.0, 0.0), (1.0, 0.2), (1.0, 1.0), (1.0, 7.3), (0.4, 30.0)] {
        let sum = reference::total(|x, y| streak_opacity(x, y, diameter, path), diameter, path, 0.1, 6);
        let disc = FRAC_PI_4 * diameter * diameter;
        assert!((sum / disc - 1.0).abs() < 4e-3, "path {path}: {sum} {disc}");
    }
    // Exactly: ∫ of the chord over the width, the ends shifted into the middle.
    let disc = rain_reference::numerics::simpson(0.0, PI, 200, |t: f64| {
        // x = cos t/2 and mid-streak opacity × path.
        streak_opacity(0.5 * t.cos(), 5.0, 1.0, 10.0) * 10.0 * 0.5 * t.sin()
    });
    assert!((disc - FRAC_PI_4).abs() < 1e-10, "{disc}");
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn opacity_is_bounded_symmetric_and_ends_with_the_disc(
        x in -1.0_f64..1.0, y in -2.0_f64..12.0, d in 0.01_f64..2.0, path in 0.0_f64..10.0
    ) {
        let alpha = streak_opacity(x, y, d, path);
        prop_assert!((0.0..=1.0).contains(&alpha));
        prop_assert_eq!(alpha, streak_opacity(-x, y, d, path));
        prop_assert!((alpha - streak_opacity(x, path - y, d, path)).abs() < 1e-12 || path == 0.0);
        if x.abs() > 0.5 * d || y < -0.5 * d || y > path + 0.5 * d {
            prop_assert_eq!(alpha, 0.0);
        }
        prop_assert!(path <= d || alpha <= d / path + 1e-14);
        let single = f64::from(streak_opacity_f32(x as f32, y as f32, d as f32, path as f32));
        let rounded = streak_opacity(f64::from(x as f32), f64::from(y as f32), f64::from(d as f32), f64::from(path as f32));
        let scale = if path > d { d / path } else { 1.0 };
        // The root at the rim turns a rounded difference into its square root.
        let rim = (1.0 - (2.0 * x / d).abs()).abs();
        if rim > 1e-4 && path > 1e-3 {
            prop_assert!((single - rounded).abs() < 1e-5 * scale + 5e-7 * y.abs().max(d) / path, "{single} {rounded}");
        }
    }

    #[test]
    fn a_projected_streak_keeps_the_sum_of_its_disc(
        x in -3.0_f32..3.0, y in -3.0_f32..3.0, start in 0.3_f32..20.0, end in 0.3_f32..20.0, d in 1e-4_f32..6e-3,
        focal in 100.0_f32..3000.0, blur in 0.0_f32..30.0
    ) {
        let (tail, head) = (Vec3::new(x, y + 0.1, -start), Vec3::new(x, y, -end));
        let streak = ScreenStreak::project(head, tail, d, focal, 0.1).expect("in view");
        let exact = FRAC_PI_4 * f64::from(d * focal).powi(2) / (f64::from(start) * f64::from(end));
        prop_assert!((f64::from(streak.sum_px2()) / exact - 1.0).abs() < 2e-6);
        prop_assert!((f64::from(streak.blurred(blur).sum_px2()) / exact - 1.0).abs() < 3e-6);
        prop_assert!(streak.width_px >= 1.0 && streak.length_px >= streak.width_px && f64::from(streak.opacity) <= FRAC_PI_4 + 1e-6);
        // Seen from the other end of time it is the same streak.
        let back = ScreenStreak::project(tail, head, d, focal, 0.1).expect("in view");
        prop_assert!(back.head_px == streak.tail_px && back.opacity == streak.opacity);
    }

    #[test]
    fn a_streak_through_the_near_plane_loses_what_lies_before_it(
        start in -5.0_f32..20.0, end in -5.0_f32..20.0, near in 0.05_f32..0.5
    ) {
        let (tail, head) = (Vec3::new(0.3, 0.2, -start), Vec3::new(-0.1, 0.4, -end));
        match clip_to_near(head, tail, near) {
            None => prop_assert!(start < near && end < near),
            Some((a, b, share)) => {
                prop_assert!(-a.z >= near * 0.999_999 && -b.z >= near * 0.999_999 && (0.0..=1.0).contains(&share));
                let kept = (b - a).length() / (tail - head).length();
                prop_assert!((kept - share).abs() < 1e-4 || (tail - head).length() < 0.5, "{kept} {share}");
            }
        }
    }
}

#[test]
fn the_sum_of_a_clipped_streak_is_the_integral_behind_the_near_plane() {
    let mut worst = Worst::default();
    for (start, end) in [(5.0, 2.0), (2.0, -1.0), (-3.0, 0.9), (0.6, 0.15)] {
        let near = 0.1;
        let (tail, head) = (Vec3::new(0.1, 0.0, -start as f32), Vec3::new(0.1, 0.2, -end as f32));
        let streak = ScreenStreak::project(head, tail, 2e-3, 600.0, near as f32).expect("in view");
        let exact = reference::disc_sum_px2(2e-3, 600.0, start, end, near);
        worst.relative(f64::from(streak.sum_px2()), exact, 1e-30, || {
            format!("{start} to {end}")
        });
    }
    // The sum over 200 000 moments cuts the near plane within one of them.
    worst.assert_below(2e-4, 4);
}

#[test]
fn a_thin_streak_is_one_pixel_wide_and_as_much_fainter() {
    // 1 mm at 10 m with 623.5 px: 0.0624 px wide.
    let project = |d: f32, z: f32| {
        ScreenStreak::project(Vec3::new(0.0, 0.0, -z), Vec3::new(0.0, 0.067, -z), d, 623.5, 0.1).expect("in view")
    };
    let thin = project(1e-3, 10.0);
    assert_eq!(thin.width_px, 1.0);
    assert!(
        (thin.length_px - (4.17745 + 0.06235)).abs() < 1e-4,
        "{}",
        thin.length_px
    );
    // Peak contrast of the rule c = (π/4)(D/(vT))(D f/z), for streaks long against the drop.
    assert!((thin.opacity / (core::f32::consts::FRAC_PI_4 * (1e-3 / 0.067) * 0.062_35) - 1.0).abs() < 0.02);
    // A camera that falls with the drop sees a disc, not a line.
    let dot = ScreenStreak::project(-Vec3::Z, -Vec3::Z, 4e-3, 623.5, 0.1).expect("in view");
    assert!((dot.opacity - core::f32::consts::FRAC_PI_4).abs() < 1e-6 && dot.length_px == dot.width_px);
}

#[test]
fn streaks_answer_every_number() {
    let p = Vec3::new(0.0, 0.0, -1.0);
    for bad in NOT_NUMBERS {
        let single = bad as f32;
        for alpha in [
            streak_opacity(bad, 0.5, 1.0, 1.0),
            streak_opacity(0.0, bad, 1.0, 1.0),
            streak_opacity(0.0, 0.5, bad, 1.0),
            streak_opacity(0.0, 0.5, 1.0, bad),
            streak_peak_opacity(bad, bad),
            streak_peak_opacity(1.0, bad),
            f64::from(streak_opacity_f32(single, single, single, single)),
            f64::from(streak_opacity_f32(0.0, 0.5, 1.0, single)),
            contrast_gain(bad, bad),
            contrast_gain(0.5, bad),
        ] {
            assert!((0.0..=1.0).contains(&alpha), "{bad}: {alpha}");
        }
        if bad.is_nan() {
            for [across, along, diameter, path] in [
                [bad, 0.5, 1.0, 5.0],
                [0.0, bad, 1.0, 5.0],
                [0.0, 0.5, bad, 5.0],
                [0.0, 0.0, 1.0, bad],
            ] {
                assert_eq!(streak_opacity(across, along, diameter, path), 0.0);
                let [across, along, diameter, path] = [across, along, diameter, path].map(|x| x as f32);
                assert_eq!(streak_opacity_f32(across, along, diameter, path), 0.0);
            }
        }
        assert!(streak_path_m(bad, bad).is_finite() && streak_length_m(bad, bad, bad).is_finite());
        assert!(
            circle_of_confusion_px(bad, 1.0, 1.0, 2.0).is_finite() && circle_of_confusion_px(1.0, 1.0, bad, bad) >= 0.0
        );
        assert!(lamp_falloff_per_m2(bad, bad).is_finite() && lamp_falloff_per_m2(bad, bad) > 0.0);
        assert!(ScreenStreak::project(p, p, single, 600.0, 0.1).is_none());
        assert!(ScreenStreak::project(Vec3::splat(single), p, 1e-3, 600.0, 0.1).is_none_or(|s| s.opacity.is_finite()));
        assert!(ScreenStreak::project(p, p, 1e-3, single, 0.1).is_none());
        assert!(clip_to_near(p, p, single).is_none());
        let sharp = ScreenStreak::project(p, p, 1e-3, 600.0, 0.1).expect("in view");
        assert!(sharp.blurred(single).opacity.is_finite());
    }
    // Ends and sizes beyond all numbers.
    let far = Vec3::new(1e30, 0.0, -1.0);
    assert_eq!(ScreenStreak::project(far, p, 1e-3, 1e20, 0.1), None);
    assert_eq!(ScreenStreak::project(p, p, 1e20, 1e20, 0.1), None);
    assert_eq!(streak_peak_opacity(2.0, 0.0), 1.0);
    assert_eq!(streak_peak_opacity(0.0, 0.0), 0.0);
}

#[test]
fn the_visible_range_answers_every_number() {
    // 1 mm, 623.5 px, 1/60 s: 255 (π/4) D² f/(v T).
    let exact = 255.0 * FRAC_PI_4 * 1e-6 * 623.5 * 60.0 / terminal_velocity(1.0);
    assert!((visible_range_m(1.0, 623.5, 1.0 / 60.0) / exact - 1.0).abs() < 1e-14);
    for bad in NOT_NUMBERS.into_iter().chain([0.0, 5e-324, 1e300]) {
        for range in [
            visible_range_m(bad, 623.5, 0.01),
            visible_range_m(2.0, bad, 0.01),
            visible_range_m(2.0, 623.5, bad),
            visible_range_m(bad, bad, bad),
        ] {
            assert!((0.0..=1e9).contains(&range), "{bad}: {range}");
        }
    }
    assert_eq!(visible_range_m(0.0, 623.5, 0.01), 0.0);
    assert_eq!(visible_range_m(2.0, 623.5, 0.0), 1e9);
}

#[test]
fn gains_lenses_and_lamps() {
    assert!((contrast_gain(0.3, 1.0) - 0.3).abs() < 1e-16);
    assert!((contrast_gain(0.1, 2.0) - 0.19).abs() < 1e-15);
    assert!((contrast_gain(1e-12, 6.0) / 6e-12 - 1.0).abs() < 1e-11);
    assert_eq!(contrast_gain(1.0, 6.0), 1.0);
    assert!(contrast_gain(0.02, 6.0) > contrast_gain(0.02, 5.0) && contrast_gain(0.9, 32.0) <= 1.0);
    // 5 mm opening, 1000 px, focus at 4 m: at 2 m 1.25 px, at infinity 1.25 px.
    assert!((circle_of_confusion_px(5e-3, 1000.0, 2.0, 4.0) - 1.25).abs() < 1e-12);
    assert!((circle_of_confusion_px(5e-3, 1000.0, 1e12, 4.0) - 1.25).abs() < 1e-9);
    assert_eq!(circle_of_confusion_px(5e-3, 1000.0, 4.0, 4.0), 0.0);
    assert!((lamp_falloff_per_m2(10.0, 0.1) - 1.0 / 100.01).abs() < 1e-15);
    assert!((lamp_falloff_per_m2(20.0, 0.1) / lamp_falloff_per_m2(10.0, 0.1) - 0.25).abs() < 1e-4);
    assert!((lamp_falloff_per_m2(0.0, 0.1) - 100.0).abs() < 1e-9);
}

#[test]
fn paths_peaks_lenses_and_lamps_are_their_formulas() {
    let (mut length, mut peak, mut blur, mut lamp, mut near) = (
        Worst::default(),
        Worst::default(),
        Worst::default(),
        Worst::default(),
        Worst::default(),
    );
    for i in -40..=40 {
        let x = 10_f64.powf(0.1 * f64::from(i));
        for y in [1e-4, 0.013, 1.0, 77.0] {
            let place = || format!("{x} {y}");
            assert_eq!(streak_path_m(x, y), x * y);
            length.relative(streak_length_m(x, y, 3.0), x * y + 0.003, 1e-30, place);
            peak.relative(streak_peak_opacity(x, y), f64::min(x / (1000.0 * y), 1.0), 1e-30, place);
            let expected = 5e-3 * 900.0 * (y - x).abs() / (x * y);
            let larger = 4.5 / f64::min(x, y);
            if expected < 1e6 {
                blur.absolute(
                    circle_of_confusion_px(5e-3, 900.0, x, y) / larger,
                    expected / larger,
                    place,
                );
            }
            if y >= 1e-3 {
                lamp.relative(lamp_falloff_per_m2(x, y), x.hypot(y).powi(-2), 1e-30, place);
            }
            if x > 10.0 * f64::max(y, 1e-3) {
                // A sphere that shines evenly acts as a point.
                near.relative(lamp_falloff_per_m2(x, f64::max(y, 1e-3)), x.powi(-2), 1e-30, place);
            }
        }
    }
    length.assert_below(1e-15, 300);
    peak.assert_below(1e-15, 300);
    blur.assert_below(1e-15, 300);
    lamp.assert_below(1e-15, 200);
    near.assert_below(0.01, 50);
    assert_eq!(circle_of_confusion_px(1.0, 1e6, 1e-9, 1.0), 1e6);
}

#[test]
fn opacity_is_an_overlap_of_two_intervals() {
    let (mut worst, mut bent) = (Worst::default(), Worst::default());
    for path in [1e-3, 0.3, 1.0, 2.5, 20.0, 1e4] {
        for i in -44..=44 {
            // Beside the axis by the angle at the disc's middle, off the rim.
            let angle = f64::from(i) * 0.035;
            let (across, chord) = (0.5 * angle.sin(), 0.5 * angle.cos());
            for j in -4..=44 {
                let along = path * f64::from(j) / 40.0;
                let expected = reference::overlap(along, chord, path);
                let place = || format!("path {path} at {across} {along}");
                // The two ends are as far from each other as the path, or the disc, is long.
                let scale = 1.0 + 1.0 / path;
                worst.absolute(
                    streak_opacity(across, along, 1.0, path) / scale,
                    expected / scale,
                    place,
                );
                bent.absolute(
                    streak_opacity(across, along, 1.05, path) / scale,
                    expected / scale,
                    place,
                );
            }
        }
    }
    worst.assert_below(1e-15, 25_000);
    assert!(bent.error > 0.01);
}

#[test]
fn gains_are_layers_over_layers() {
    let (mut worst, mut bent) = (Worst::default(), Worst::default());
    for i in -160..=0 {
        let alpha = 10_f64.powf(0.1 * f64::from(i)).min(1.0 - 1e-9);
        for halves in [0, 1, 2, 3, 4, 12, 63, 64] {
            let expected = reference::layered(alpha, halves);
            let found = contrast_gain(alpha, 0.5 * f64::from(halves));
            worst.relative(found, expected, 1e-300, || format!("{alpha}, {halves} halves"));
            bent.relative(
                contrast_gain(1.05 * alpha, 0.5 * f64::from(halves)),
                expected,
                1e-300,
                String::new,
            );
        }
    }
    worst.assert_below(2e-15, 1200);
    assert!(bent.error > 0.04);
}

#[test]
fn streaks_are_cut_where_their_way_meets_the_near_plane() {
    let (mut sum, mut cut, mut blurred, mut bent) =
        (Worst::default(), Worst::default(), Worst::default(), Worst::default());
    for (start, end) in [
        (5.0, 2.0),
        (2.0, -1.0),
        (-3.0, 0.9),
        (0.6, 0.15),
        (0.05, 30.0),
        (20.0, 0.11),
        (1.0, 0.0999),
    ] {
        for near in [0.1_f32, 0.05] {
            let (tail, head) = (Vec3::new(0.1, 0.3, -start as f32), Vec3::new(-0.4, 0.2, -end as f32));
            let place = || format!("{start} to {end} m, near plane at {near} m");
            let streak = ScreenStreak::project(head, tail, 2e-3, 600.0, near).expect("in view");
            let exact = reference::disc_integral_px2(
                f64::from(2e-3_f32),
                600.0,
                -f64::from(tail.z),
                -f64::from(head.z),
                f64::from(near),
            );
            sum.relative(f64::from(streak.sum_px2()), exact, 1e-30, place);
            blurred.relative(f64::from(streak.blurred(7.0).sum_px2()), exact, 1e-30, place);
            bent.relative(f64::from(streak.sum_px2()), 1.05 * exact, 1e-30, place);
            // The same cut in double precision.
            let (h, t) = (head.as_dvec3(), tail.as_dvec3());
            let way = h - t;
            let at = |share: f64| t + way * share;
            let border = (t.z + f64::from(near)) / (t.z - h.z);
            let (from, to) = (
                if -t.z >= f64::from(near) { 0.0 } else { border },
                if -h.z >= f64::from(near) { 1.0 } else { border },
            );
            let (a, b, share) = clip_to_near(head, tail, near).expect("in view");
            cut.absolute((a.as_dvec3() - at(to)).length() / way.length(), 0.0, place);
            cut.absolute((b.as_dvec3() - at(from)).length() / way.length(), 0.0, place);
            cut.absolute(f64::from(share), to - from, place);
        }
    }
    sum.assert_below(3e-6, 14);
    blurred.assert_below(3e-6, 14);
    cut.assert_below(2e-7, 40);
    assert!(bent.error > 0.04);
}
