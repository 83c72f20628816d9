//! Containers that follow, laws of detail, and the drops of areas.

use core::f64::consts::{FRAC_PI_2, PI};
use std::collections::BTreeSet;

use glam::{DVec2, DVec3, Vec3};
use rain_core::hash::unit_f32;
use rain_core::rainfall::areas::{AreaField, AreaRain, AreaShape};
use rain_core::rainfall::{
    Container, DetailLaw, Distribution, FieldMotion, Follow, FollowSettings, FollowShape, LocalRain, RANGE_CAP_M,
    RainViewVolume, RateLadder, SizeClass, Spectrum, Thinning, Threshold, cell_key, drop_marks, heading_margin_rad,
};

use super::{field, pair};
use crate::check::Worst;

const HALF_VIEW: f64 = 0.6;

fn semi_cylinder() -> FollowSettings {
    FollowSettings {
        shape: FollowShape::SemiCylinder {
            across_m: 20.0,
            ahead_m: 30.0,
            height_m: 16.0,
        },
        slack_m: 2.0,
        rim_m: 1.5,
    }
}

fn block() -> FollowSettings {
    FollowSettings {
        shape: FollowShape::REFERENCE_BLOCK,
        ..semi_cylinder()
    }
}

#[test]
fn a_container_follows_with_slack_in_place_and_heading() {
    let settings = semi_cylinder().validated().expect("valid");
    let margin = heading_margin_rad(HALF_VIEW);
    assert!((margin - (FRAC_PI_2 - HALF_VIEW)).abs() < 1e-15);
    let mut follow = Follow::new(DVec3::new(5.0, 1.7, 0.0), 0.3);
    let start = follow;
    follow.follow(&settings, DVec3::new(6.9, 1.7, 0.0), 0.3 + margin - 0.01, HALF_VIEW);
    assert_eq!(follow, start, "within both margins nothing happens");
    follow.follow(&settings, DVec3::new(10.0, 1.7, 0.0), 0.3 + margin + 0.5, HALF_VIEW);
    assert!(
        (follow.centre_m.x - 8.0).abs() < 1e-12 && (follow.heading_rad - 0.8).abs() < 1e-12,
        "{follow:?}"
    );
    // Any way of the eye, in any steps: it is never further than the slack, and turns stay within the margin.
    let mut heading = 0.0;
    for i in 0..2000 {
        let t = f64::from(i) * 0.1;
        let eye = DVec3::new(40.0 * t.sin(), 1.7, 3.0 * t);
        heading += 0.4 * (0.37 * t).sin();
        follow.follow(&settings, eye, heading, HALF_VIEW);
        assert!(follow.centre_m.distance(eye) <= 2.0 + 1e-12);
        let off = follow.heading_rad - heading;
        assert!((off - 2.0 * PI * (off / (2.0 * PI)).round()).abs() <= margin + 1e-12);
    }
    follow.follow(&settings, DVec3::NAN, f64::NAN, HALF_VIEW);
    assert!(follow.centre_m.is_finite() && follow.heading_rad.is_finite());
}

#[test]
fn what_a_view_sees_nearby_is_inside_its_container_wherever_it_looks() {
    for settings in [semi_cylinder(), block()] {
        let mut follow = Follow::new(DVec3::ZERO, 0.0);
        let mut seen = 0;
        for i in 0..600 {
            let t = f64::from(i);
            let eye = DVec3::new((0.3 * t).sin() * 9.0, 1.7, (0.2 * t).cos() * 9.0);
            let heading = 0.13 * t;
            follow.follow(&settings, eye, heading, HALF_VIEW);
            // Rays at the picture's sides and in its middle, as far as 7 m: nothing is missing there.
            for side in [-HALF_VIEW, 0.0, HALF_VIEW] {
                for range in [0.2, 3.0, 7.0] {
                    let turn = heading + side;
                    let p = eye + DVec3::new(turn.sin(), 0.1, -turn.cos()) * range;
                    let inside = matches!(settings.shape, FollowShape::SemiCylinder { .. });
                    // The block turns with its narrow side; its margin is that of its own faces.
                    if inside || follow.local_m(p).x.abs() < 18.0 {
                        assert!(follow.weight(&settings, p) > 0.99, "{settings:?} {i} {side} {range}");
                        seen += 1;
                    }
                }
            }
            // And what is far beyond is not there.
            assert_eq!(follow.weight(&settings, eye + DVec3::new(0.0, 0.0, 120.0)), 0.0);
        }
        assert!(seen > 5000, "{seen}");
    }
}

#[test]
fn a_rim_fades_and_a_flat_face_ends() {
    let settings = semi_cylinder();
    let follow = Follow::new(DVec3::ZERO, 0.0);
    let at = |x: f64, z: f64| follow.weight(&settings, DVec3::new(x, 0.0, z));
    // Heading 0 looks along −Z: ahead is negative z.
    assert_eq!([at(0.0, 0.0), at(0.0, -28.0), at(0.0, -31.0)], [1.0, 1.0, 0.0]);
    assert!((at(0.0, -29.25) - 0.5).abs() < 1e-12, "half way through the rim");
    assert_eq!([at(0.0, 1.9), at(0.0, 2.1)], [1.0, 0.0], "the rear half is not there");
    assert_eq!([at(18.0, 0.0), at(20.1, 0.0)], [1.0, 0.0]);
    let box_at = |x: f64, z: f64| follow.weight(&block(), DVec3::new(x, 0.0, z));
    assert_eq!(
        [
            box_at(18.0, -70.0),
            box_at(20.1, -70.0),
            box_at(0.0, -78.1),
            box_at(0.0, 2.1)
        ],
        [1.0, 0.0, 0.0, 0.0]
    );
}

#[test]
fn a_container_is_fitted_by_speed_and_field_of_view() {
    for settings in [semi_cylinder(), block()] {
        let length = |speed: f64, view: f64| match settings.fitted(15.0, speed, view, 0.4).shape {
            FollowShape::SemiCylinder { ahead_m, across_m, .. } => [ahead_m, 2.0 * across_m],
            FollowShape::Block { depth_m, width_m, .. } => [depth_m - 2.0, width_m],
        };
        let [still, narrow] = length(0.0, 0.3);
        assert!((still - 18.5).abs() < 1e-12 && length(36.0, 0.3)[0] > still + 5.0);
        assert_eq!(
            length(200.0, 0.3)[0],
            still + 8.0,
            "no further than the default container reaches ahead"
        );
        assert!(length(0.0, 0.6)[1] > narrow + 5.0);
        assert!(length(f64::NAN, f64::NAN)[0].is_finite());
        assert!(settings.fitted(15.0, 20.0, 0.6, 0.4).validated().is_ok());
    }
    let bad = FollowSettings {
        slack_m: -1.0,
        ..block()
    };
    assert!(bad.validated().expect_err("bad").to_string().contains("slack_m is -1"));
}

#[test]
fn number_and_size_follow_the_published_laws() {
    let mut worst = Worst::default();
    for (d, number, size) in [
        (0.0, 1.0, 0.0),
        (0.25, 0.75, 0.0625),
        (0.5, 0.5, 0.25),
        (0.75, 0.25, 0.5625),
        (1.0, 0.0, 1.0),
    ] {
        let law = DetailLaw::QUADRATIC;
        worst.absolute(law.number(d), number, || format!("number {d}"));
        worst.absolute(law.size(d) - 1.0, size, || format!("size {d}"));
        worst.absolute(DetailLaw::GAUSSIAN.number(d), (-4.5 * d * d).exp(), || {
            format!("gaussian {d}")
        });
        worst.absolute(DetailLaw::OpticalDepth.coverage(d), 1.0, || format!("default {d}"));
    }
    worst.assert_below(1e-14, 20);
    // Places by the law: shares of the drops within them.
    let mut worst = Worst::default();
    for law in [DetailLaw::OpticalDepth, DetailLaw::QUADRATIC, DetailLaw::GAUSSIAN] {
        let sum = |to: f64| {
            (0..20_000)
                .map(|i| law.number((f64::from(i) + 0.5) / 2e4 * to))
                .sum::<f64>()
                * to
                / 2e4
        };
        for share in [0.0, 0.1, 0.5, 0.9, 1.0] {
            worst.absolute(sum(law.place(share)) / sum(1.0), share, || format!("{law:?} {share}"));
        }
    }
    worst.assert_below(1e-8, 15);
    assert!(DetailLaw::Quadratic { least: 0.0, most: 1.0 }.validated().is_err());
    assert!(DetailLaw::Gaussian { least: 1.0, most: 0.5 }.validated().is_err());
}

#[test]
fn only_the_default_law_keeps_the_optical_depth_and_the_others_err_by_the_stated_shares() {
    // (law, error at the reach as the source has it, with opacity made good)
    for (law, bare, good) in [
        (DetailLaw::OpticalDepth, 0.0, 0.0),
        (DetailLaw::QUADRATIC, -0.3, -0.0343),
        (DetailLaw::GAUSSIAN, -0.4795, -0.1502),
    ] {
        let found = [law.depth_error(1.0, false), law.depth_error(1.0, true)];
        // By counting.
        let count = |made_good: bool| {
            let mut sum = 0.0;
            for i in 0..100_000 {
                let d = (f64::from(i) + 0.5) / 1e5;
                let c = law.number(d) * law.size(d).powi(2);
                sum += c * if made_good { (1.0 / c).clamp(0.25, 4.0) } else { 1.0 };
            }
            sum / 1e5 - 1.0
        };
        assert!(
            (found[0] - count(false)).abs() < 1e-6 && (found[1] - count(true)).abs() < 1e-5,
            "{law:?} {found:?}"
        );
        assert!(
            (found[0] - bare).abs() < 5e-4 && (found[1] - good).abs() < 5e-4,
            "{law:?} {found:?}"
        );
        assert!(
            law.depth_error(0.3, true).abs() < 1e-9,
            "near the eye opacity makes all good: {law:?}"
        );
    }
}

/// 60° high, 16:9, along −Z.
fn view(eye_m: DVec3) -> RainViewVolume {
    let (ty, tx) = (30.0_f32.to_radians().tan(), 16.0 / 9.0 * 30.0_f32.to_radians().tan());
    let plane = |n: Vec3| n.normalize().extend(0.0);
    let ratio = f64::from(tx * ty) / (f64::from(1.0 + tx * tx) * f64::from(1.0 + ty * ty)).sqrt();
    RainViewVolume {
        eye_m,
        eye_velocity_m_s: DVec3::ZERO,
        side_planes: [
            plane(Vec3::new(1.0, 0.0, -tx)),
            plane(Vec3::new(-1.0, 0.0, -tx)),
            plane(Vec3::new(0.0, 1.0, -ty)),
            plane(Vec3::new(0.0, -1.0, -ty)),
        ],
        focal_px: 623.5,
        solid_angle_sr: 4.0 * ratio.asin(),
        exposure_s: 1.0 / 60.0,
        turn_rad: 0.0,
        parallel: None,
    }
}

fn spectrum(rate: f64) -> Spectrum {
    Spectrum::new(Distribution::MarshallPalmer, rate).expect("inside the domain")
}

fn filled(areas: &AreaField, ladder: &RateLadder, weather_mm_h: f64, eye: DVec3) -> (Container, Vec<DVec3>) {
    let mut container = Container::default();
    let local = LocalRain {
        areas,
        ladder,
        weather_mm_h,
    };
    let complete = container.fill_local(
        5,
        &spectrum(25.0),
        &FieldMotion::default(),
        &view(eye),
        1.1,
        1 << 20,
        &Thinning {
            local: Some(&local),
            ..Thinning::default()
        },
    );
    assert!(complete);
    let places = container
        .records
        .iter()
        .map(|r| eye + r.position(5, &container.classes).as_dvec3())
        .collect();
    (container, places)
}

#[test]
fn ladders_give_the_thresholds_of_the_spectra() {
    let mut worst = Worst::default();
    for distribution in [
        Distribution::MarshallPalmer,
        Distribution::Drizzle,
        Distribution::Thunderstorm,
    ] {
        let ladder = RateLadder::new(distribution);
        assert_eq!(ladder.distribution(), distribution);
        for i in 0..400 {
            let rate = 1.1e-3 * 1.03_f64.powi(i);
            let spectrum = Spectrum::new(distribution, rate.min(500.0)).expect("inside the domain");
            for (k, class) in SizeClass::all().iter().enumerate() {
                let exact = Threshold::new(class, &spectrum);
                let found = ladder.threshold(k, rate).expect("rain");
                for d in [class.min_mm, class.max_mm] {
                    let exact = f64::from(exact.at(d as f32));
                    worst.relative(f64::from(found.at(d as f32)), exact, 1e-6, || format!("{rate} {k} {d}"));
                }
            }
        }
        assert!(ladder.threshold(3, 0.0).is_none() && ladder.threshold(3, f64::NAN).is_none());
    }
    worst.assert_below(1e-3, 28_000);
}

#[test]
fn drops_exist_where_the_local_rate_reaches_their_rank() {
    let ladder = RateLadder::new(Distribution::MarshallPalmer);
    let eye = DVec3::new(1000.0, 1.7, -500.0);
    // The whole plane at 25 mm/h is the weather's 25 mm/h.
    let (even, _) = filled(&AreaField::new(1.0), &ladder, 25.0, eye);
    let mut plain = Container::default();
    assert!(plain.fill(5, &spectrum(25.0), &FieldMotion::default(), &view(eye), 1.1, 1 << 20));
    // Which drop, without its presence, which the ladder gives to 1e-2.
    let names = |container: &Container| -> BTreeSet<(u32, u32)> {
        container.records.iter().map(|r| (r.cell, r.drop & 0xFFFF)).collect()
    };
    let (ours, theirs) = (names(&even), names(&plain));
    let same = ours.intersection(&theirs).count();
    assert!(
        same > 10_000 && same + 20 > ours.len().max(theirs.len()),
        "{same} of {} and {}",
        ours.len(),
        theirs.len()
    );
    // Half of the view is dry: no drop there, and on the other side the same drops.
    let half_plane = AreaShape::Polygon {
        corners_m: [[0.0, -900.0], [900.0, -900.0], [900.0, 900.0], [0.0, 900.0]]
            .map(DVec2::from)
            .to_vec(),
    };
    let (area, _) = pair([1000.0, -500.0], half_plane, AreaRain::Rate(25.0), 0.0, 1.0);
    let sharp = field(&[&area], 0.0);
    let (half, places) = filled(&sharp, &ladder, 0.0, eye);
    assert!(places.iter().all(|p| p.x >= 1000.0), "a drop outside");
    let (_, all) = filled(&AreaField::new(1.0), &ladder, 25.0, eye);
    let right = all.iter().filter(|p| p.x >= 1000.0).count();
    assert_eq!(half.records.len(), right, "the same drops inside");
    // Over a soft edge the numbers follow the local spectrum, and sets are nested from thin to heavy rain.
    let soft = field(
        &[&rain_core::rainfall::areas::AreaSettings {
            transition_m: 16.0,
            ..area
        }],
        0.0,
    );
    let (thin, places) = filled(&soft, &ladder, 0.0, eye);
    // Each drop of the even rain stays with the chance that its size has at the rate of its place.
    let (even, all) = filled(&AreaField::new(1.0), &ladder, 25.0, eye);
    let expected: f64 = even
        .records
        .iter()
        .zip(&all)
        .map(|(record, p)| {
            let k = (record.drop & 15) as usize;
            let cell = [0, 10, 20].map(|bit| (record.cell >> bit & 1023) as i32 - 512);
            let key = cell_key(5, k as u32, even.classes[k].eye.cell.wrapping_add(cell.into()));
            let diameter = SizeClass::new(k).diameter_mm(unit_f32(drop_marks(key, record.drop >> 4 & 0xFFF)[1]));
            let rate = soft.rate_at(DVec2::new(p.x, p.z), 0.0);
            let of = |rate: f64| spectrum(rate).concentration(f64::from(diameter));
            of(rate) / of(25.0)
        })
        .sum();
    let found = thin.records.len() as f64;
    assert!((found / expected - 1.0).abs() < 0.05, "{found} {expected}");
    assert!(places.iter().any(|p| p.x < 998.0) && places.iter().all(|p| p.x > 1000.0 - 8.0));
    // Another view sees the same drops, but for those at the borders of what each sees, half a metre apart.
    let (_, other) = filled(&soft, &ladder, 0.0, eye + DVec3::new(0.4, 0.0, -0.3));
    let shared = other
        .iter()
        .filter(|p| places.iter().any(|q| q.distance(**p) < 1e-3))
        .count();
    assert!(shared as f64 > 0.75 * other.len() as f64, "{shared} of {}", other.len());
}

#[test]
fn a_view_draws_the_drops_of_the_field_that_are_in_its_container() {
    let eye = DVec3::new(30.0, 1.7, 12.0);
    let fill = |region: Option<(&Follow, &FollowSettings)>| {
        let mut container = Container::default();
        assert!(container.fill_local(
            5,
            &spectrum(25.0),
            &FieldMotion::default(),
            &view(eye),
            1.1,
            1 << 20,
            &Thinning {
                region,
                ..Thinning::default()
            },
        ));
        container
    };
    let all = fill(None);
    for narrow in [
        FollowShape::SemiCylinder {
            across_m: 3.0,
            ahead_m: 5.0,
            height_m: 4.0,
        },
        FollowShape::Block {
            width_m: 4.0,
            height_m: 3.0,
            depth_m: 6.0,
        },
    ] {
        let settings = FollowSettings {
            shape: narrow,
            slack_m: 0.5,
            rim_m: 0.5,
        };
        let mut follow = Follow::new(eye + DVec3::new(0.2, 0.0, 0.0), 0.2);
        follow.follow(&settings, eye, 0.0, HALF_VIEW);
        let part = fill(Some((&follow, &settings)));
        let places: Vec<DVec3> = part
            .records
            .iter()
            .map(|r| eye + r.position(5, &part.classes).as_dvec3())
            .collect();
        assert!(places.iter().all(|p| follow.weight(&settings, *p) > 0.0));
        // All that are well inside, and no others: the field does not know of containers.
        let inside = |p: &DVec3| follow.weight(&settings, *p) == 1.0;
        let whole = all.records.iter().map(|r| eye + r.position(5, &all.classes).as_dvec3());
        assert_eq!(
            whole.filter(inside).count(),
            places.iter().filter(|p| inside(p)).count()
        );
        assert!(
            part.records.len() > 500 && part.records.len() < all.records.len() / 2,
            "{}",
            part.records.len()
        );
    }
    let wide = FollowSettings {
        shape: FollowShape::Block {
            width_m: 200.0,
            height_m: 200.0,
            depth_m: 200.0,
        },
        slack_m: 100.0,
        rim_m: 0.0,
    };
    assert_eq!(fill(Some((&Follow::new(eye, 0.0), &wide))).records, all.records);
}

#[test]
fn a_law_of_detail_leaves_out_its_share_of_drops_at_every_distance() {
    let eye = DVec3::new(30.0, 1.7, 12.0);
    let fill = |detail: Option<DetailLaw>| {
        let mut container = Container::default();
        assert!(container.fill_local(
            5,
            &spectrum(100.0),
            &FieldMotion::default(),
            &view(eye),
            3.0,
            1 << 22,
            &Thinning {
                detail,
                ..Thinning::default()
            },
        ));
        container
    };
    // Presence of drops by distance, in five shells up to the reach.
    let shells = |container: &Container| {
        let mut sums = [0.0_f64; 5];
        for record in &container.records {
            let d = f64::from(record.position(5, &container.classes).length()) / RANGE_CAP_M;
            if let Some(sum) = sums.get_mut((5.0 * d) as usize) {
                *sum += f64::from(record.drop >> 16) / 65_535.0;
            }
        }
        sums
    };
    let all = fill(None);
    let whole = shells(&all);
    for law in [DetailLaw::OpticalDepth, DetailLaw::QUADRATIC, DetailLaw::GAUSSIAN] {
        let thinned = fill(Some(law));
        // No drop but those of the field.
        let known: BTreeSet<(u32, u32)> = all.records.iter().map(|r| (r.cell, r.drop & 0xFFFF)).collect();
        assert!(
            thinned
                .records
                .iter()
                .all(|r| known.contains(&(r.cell, r.drop & 0xFFFF)))
        );
        for (shell, (kept, of)) in shells(&thinned).into_iter().zip(whole).enumerate() {
            // Drops of a shell lie as d² along the view.
            let (from, to) = (0.2 * shell as f64, 0.2 * (shell + 1) as f64);
            let (mut share, mut weight) = (0.0, 0.0);
            for i in 0..64 {
                let d = from + (to - from) * (f64::from(i) + 0.5) / 64.0;
                share += law.number(d) * d * d;
                weight += d * d;
            }
            let expected = of * share / weight;
            // Four standard deviations of the number kept, 1.25 % at the eye, and 5 % for ranges that end in the shell.
            let noise = 4.0 * expected.sqrt() + 0.0125 * of + 0.05 * expected;
            assert!(of > 100.0, "{of}");
            assert!(
                (kept - expected).abs() < noise,
                "{law:?}, shell {shell}: {kept}, expected {expected}"
            );
        }
    }
}
