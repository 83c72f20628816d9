//! The drops that a view holds against a search through every cell around the eye.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use rain_core::rainfall::{
    CLASS_COUNT, Container, Distribution, DrawRange, FieldMotion, RainViewVolume, SizeClass, Spectrum,
};
use rain_reference::container as reference;

use crate::check::Worst;

/// Room at a border for single precision. Units: m.
const BORDER_M: f64 = 1e-4;

fn spectrum(rain: f64) -> Spectrum {
    Spectrum::new(Distribution::MarshallPalmer, rain).expect("inside the domain")
}

/// A view from `eye` along `ahead`, 16:9, 60° high.
fn view(eye: DVec3, velocity: DVec3, ahead: DVec3) -> RainViewVolume {
    let ahead = ahead.normalize();
    let right = ahead.cross(DVec3::Y).normalize();
    let up = right.cross(ahead);
    let (ty, tx) = (30.0_f64.to_radians().tan(), 16.0 / 9.0 * 30.0_f64.to_radians().tan());
    let plane = |normal: DVec3| normal.normalize().as_vec3().extend(0.0);
    let ratio = tx * ty / ((1.0 + tx * tx) * (1.0 + ty * ty)).sqrt();
    RainViewVolume {
        eye_m: eye,
        eye_velocity_m_s: velocity,
        side_planes: [
            plane(right + tx * ahead),
            plane(-right + tx * ahead),
            plane(up + ty * ahead),
            plane(-up + ty * ahead),
        ],
        focal_px: 623.5,
        solid_angle_sr: 4.0 * ratio.asin(),
        exposure_s: 1.0 / 60.0,
        turn_rad: 0.0,
        parallel: None,
    }
}

/// What a container and the search disagree about.
#[derive(Debug, Default)]
struct Comparison {
    /// Drops well inside that are missing, and drawn ones that are none or well outside.
    missed: usize,
    strange: usize,
    same: usize,
    place: Worst,
    presence: Worst,
}

/// Compares what `container` holds for `shown` with the search for a view `bent` by the caller.
fn compare(
    container: &Container,
    seed: u64,
    rain: &Spectrum,
    motion: &FieldMotion,
    shown: &RainViewVolume,
    quality: f64,
    bend: impl Fn(&mut reference::View),
) -> Comparison {
    let mut slow = reference::View {
        eye: shown.eye_m.to_array(),
        velocity: shown.eye_velocity_m_s.to_array(),
        sides: shown.side_planes.map(|plane| plane.as_dvec4().to_array()),
        focal: shown.focal_px,
        exposure: shown.exposure_s,
        turn: shown.turn_rad,
        quality,
    };
    bend(&mut slow);
    let mut found = Comparison::default();
    for (k, class) in SizeClass::all().iter().enumerate() {
        let of_class = reference::Class {
            number: k as u32,
            diameters: [class.min_mm, class.max_mm],
            cell: class.cell_m,
            velocity: motion.velocity_m_s[k].to_array(),
            offset: motion.offset_m[k].to_array(),
        };
        let mut drawn: BTreeMap<(u32, u32), _> = container
            .records
            .iter()
            .filter(|record| record.drop & 15 == k as u32)
            .map(|record| ((record.cell, record.drop >> 4 & 0xFFF), record))
            .collect();
        for drop in reference::seen(seed, &of_class, &slow, |d| rain.concentration(d)) {
            let [x, y, z] = drop.cell.map(|c| (c + 512) as u32);
            let Some(record) = drawn.remove(&(x | y << 10 | z << 20, drop.index)) else {
                found.missed += usize::from(drop.inside > BORDER_M && drop.presence > BORDER_M);
                continue;
            };
            found.strange += usize::from(drop.inside < -BORDER_M);
            found.same += 1;
            let at = record.position(seed, &container.classes).as_dvec3();
            let off = (at - DVec3::from(drop.place)).length();
            found.place.absolute(off, 0.0, || format!("class {k}, {at}"));
            let there = f64::from(record.drop >> 16) / 65_535.0;
            found
                .presence
                .absolute(there, drop.presence, || format!("class {k}, {at}"));
        }
        found.strange += drawn.len();
    }
    found
}

#[test]
fn a_view_holds_what_a_search_through_all_cells_finds() {
    let (seed, still) = (0xFACE_0FF5_EED5, DVec3::ZERO);
    let far = DVec3::new(2.0_f64.powi(29) - 1.3, 1.7, -1.5 * 2.0_f64.powi(30) + 0.4);
    let mut container = Container::default();
    let (mut place, mut presence, mut all) = (Worst::default(), Worst::default(), 0);
    for (name, eye, velocity, ahead, wind, rain, quality, turn) in [
        (
            "still",
            DVec3::new(12.3, 1.7, -4.5),
            still,
            DVec3::NEG_Z,
            still,
            25.0,
            0.4,
            0.0,
        ),
        (
            "upwards",
            DVec3::ZERO,
            still,
            DVec3::new(0.3, 1.0, 0.1),
            still,
            5.0,
            0.6,
            0.0,
        ),
        (
            "walking in wind",
            DVec3::new(-300.0, 50.0, 9.9),
            DVec3::new(1.2, 0.0, 0.9),
            DVec3::X,
            DVec3::new(7.0, 0.0, -3.0),
            25.0,
            0.4,
            0.0,
        ),
        (
            "driving",
            DVec3::new(5.0, 1.2, 0.0),
            DVec3::new(0.0, 0.0, -36.0),
            DVec3::NEG_Z,
            DVec3::new(2.0, 0.0, 0.0),
            25.0,
            0.3,
            0.0,
        ),
        (
            "flying backwards, lead at its bound",
            DVec3::new(5.0, 900.0, 0.0),
            DVec3::new(-90.0, 30.0, 0.0),
            DVec3::X,
            still,
            50.0,
            0.2,
            0.0,
        ),
        (
            "drizzle",
            DVec3::new(0.1, 1.7, 0.2),
            still,
            DVec3::Z,
            still,
            0.1,
            2.0,
            0.0,
        ),
        (
            "turning",
            DVec3::new(0.1, 1.7, 0.2),
            still,
            DVec3::Z,
            still,
            25.0,
            0.4,
            0.06,
        ),
        (
            "turning too fast",
            DVec3::new(0.1, 1.7, 0.2),
            still,
            DVec3::X,
            still,
            25.0,
            0.4,
            3.0,
        ),
        (
            "cells wrapped in 32 bits",
            far,
            still,
            DVec3::Z,
            DVec3::new(3.0, 0.0, 3.0),
            25.0,
            0.4,
            0.0,
        ),
    ] {
        let rain = spectrum(rain);
        let mut motion = FieldMotion::default();
        motion.set_velocity(wind, 1.2);
        motion.advance(4321.9);
        let mut shown = view(eye, velocity, ahead);
        shown.turn_rad = turn;
        assert!(container.fill(seed, &rain, &motion, &shown, quality, 1 << 20));
        let found = compare(&container, seed, &rain, &motion, &shown, quality, |_| {});
        assert!(
            found.missed == 0 && found.strange == 0 && found.same > 50,
            "{name}: {found:?}"
        );
        all += found.same;
        // In halves of a billion metres even double precision has steps of 6e-8 m.
        place.absolute(found.place.error, 0.0, || format!("{name}: {}", found.place.place));
        presence.absolute(found.presence.error, 0.0, || {
            format!("{name}: {}", found.presence.place)
        });
        // Searches for other views are told apart.
        let quality_bent = compare(&container, seed, &rain, &motion, &shown, quality, |v| v.quality *= 1.05);
        assert!(quality_bent.missed > 0, "{name}: a view that reaches 5 % further");
        let turned = compare(&container, seed, &rain, &motion, &shown, quality, |v| {
            v.sides.swap(0, 2)
        });
        let mirrored = compare(&container, seed, &rain, &motion, &shown, quality, |v| {
            v.sides = v.sides.map(|[x, y, z, w]| [-x, -y, -z, w]);
        });
        assert!(turned.missed == 0 && turned.strange == 0, "{name}: the order of sides");
        assert!(mirrored.strange > 20, "{name}: a view behind the eye");
        if velocity != DVec3::ZERO {
            let still = compare(&container, seed, &rain, &motion, &shown, quality, |v| {
                v.velocity = [0.0; 3]
            });
            // (One that flies backwards leads out of the picture: it differs by its streaks.)
            assert!(still.strange + still.missed > 0, "{name}: a view that stands still");
        }
        if turn > 0.0 {
            let fixed = compare(&container, seed, &rain, &motion, &shown, quality, |v| v.turn = 0.0);
            assert!(fixed.strange > 0, "{name}: a view that does not turn");
        }
        let next = compare(&container, seed + 1, &rain, &motion, &shown, quality, |_| {});
        assert!(next.missed > 20 && next.strange > 20, "{name}: another seed");
    }
    assert!(all > 3000, "{all}");
    place.assert_below(1e-5, 9);
    presence.assert_below(1e-4, 9);
}

#[test]
fn the_field_repeats_after_its_last_cell() {
    // All cells repeat after 2³² of the largest, 2 m.
    let period = 2.0_f64.powi(33);
    let (rain, motion) = (spectrum(25.0), FieldMotion::default());
    let records = |eye: DVec3| {
        let mut container = Container::default();
        assert!(container.fill(9, &rain, &motion, &view(eye, DVec3::ZERO, DVec3::NEG_Z), 0.5, 1 << 20));
        container.records
    };
    let eye = DVec3::new(0.25, 1.5, -7.75);
    let here = records(eye);
    assert!(here.len() > 500);
    for axis in DVec3::AXES {
        assert_eq!(here, records(eye + period * axis));
        assert_eq!(here, records(eye - period * axis));
        assert_ne!(here, records(eye + 0.5 * period * axis));
    }
}

#[test]
fn views_of_nonsense_hold_nothing_or_what_is_said() {
    let (rain, motion) = (spectrum(25.0), FieldMotion::default());
    let fill = |rain: &Spectrum, shown: &RainViewVolume, quality: f64| {
        let mut container = Container::default();
        assert!(container.fill(9, rain, &motion, shown, quality, 1 << 20));
        container.records
    };
    let good = view(DVec3::new(1.0, 2.0, 3.0), DVec3::ZERO, DVec3::NEG_Z);
    let whole = fill(&rain, &good, 0.4);
    assert!(whole.len() > 100);
    for quality in [f64::NAN, f64::NEG_INFINITY, -1.0, 0.0] {
        assert!(fill(&rain, &good, quality).is_empty(), "{quality}");
    }
    assert!(fill(&spectrum(0.0), &good, 0.4).is_empty());
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        // An eye that is nowhere stands at the origin of every class; one that moves nowhere stands still.
        let nowhere = fill(&rain, &view(DVec3::new(0.0, bad, 0.0), DVec3::ZERO, DVec3::NEG_Z), 0.4);
        assert_eq!(
            nowhere,
            fill(&rain, &view(DVec3::ZERO, DVec3::ZERO, DVec3::NEG_Z), 0.4),
            "{bad}"
        );
        let moving = RainViewVolume {
            eye_velocity_m_s: DVec3::new(bad, 0.0, 0.0),
            ..good
        };
        assert_eq!(fill(&rain, &moving, 0.4), whole, "{bad}");
    }
    for (bad, held) in [(f64::NAN, 0.0), (-1.0, 0.0), (f64::INFINITY, 0.1)] {
        let [bad, held] = [bad, held].map(|turn_rad| RainViewVolume { turn_rad, ..good });
        assert_eq!(fill(&rain, &bad, 0.4), fill(&rain, &held, 0.4));
    }
    for (focal_px, exposure_s) in [(f64::NAN, 0.01), (-1.0, 0.01), (0.0, 0.01), (600.0, f64::NAN)] {
        let odd = RainViewVolume {
            focal_px,
            exposure_s,
            ..good
        };
        assert!(fill(&rain, &odd, 0.4).is_empty(), "{focal_px} px, {exposure_s} s");
    }
    let sides = RainViewVolume {
        side_planes: [Vec3::NAN.extend(0.0); 4],
        ..good
    };
    assert!(fill(&rain, &sides, 0.4).is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 64,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(23),
        ..ProptestConfig::default()
    })]

    #[test]
    fn any_view_holds_drops_within_its_reach(
        seed in any::<u64>(),
        eye in prop::array::uniform3(-1e6_f64..1e6),
        velocity in prop::array::uniform3(-60.0_f64..60.0),
        ahead in prop::array::uniform3(-1.0_f64..1.0),
        wind in prop::array::uniform3(-20.0_f64..20.0),
        rain in 0.1_f64..80.0,
        quality in 0.05_f64..0.5,
    ) {
        prop_assume!(DVec3::from(ahead).cross(DVec3::Y).length() > 0.1);
        let (rain, mut motion) = (spectrum(rain), FieldMotion::default());
        motion.set_velocity(DVec3::from(wind), 1.2);
        motion.advance(777.7);
        let shown = view(DVec3::from(eye), DVec3::from(velocity), DVec3::from(ahead));
        let (mut container, mut better) = (Container::default(), Container::default());
        prop_assert!(container.fill(seed, &rain, &motion, &shown, quality, 1 << 20));
        prop_assert!(better.fill(seed, &rain, &motion, &shown, 1.3 * quality, 1 << 20));
        let range = DrawRange { kappa: quality, focal_px: shown.focal_px, exposure_s: shown.exposure_s };
        let lead = reference::lead(velocity);
        for record in &container.records {
            let class = SizeClass::new((record.drop & 15) as usize);
            let p = record.position(seed, &container.classes).as_dvec3();
            prop_assert!(reference::from_way(p.to_array(), lead) <= 1.2 * range.at(class.max_mm) + BORDER_M);
        }
        // No drop twice, and more quality only adds.
        let names = |c: &Container| c.records.iter().map(|r| (r.cell, r.drop)).collect::<std::collections::BTreeSet<_>>();
        prop_assert_eq!(names(&container).len(), container.records.len());
        prop_assert!(names(&container).is_subset(&names(&better)));
        prop_assert_eq!(container.classes.len(), CLASS_COUNT);
    }
}
