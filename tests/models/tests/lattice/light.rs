//! Lamps on cards: inverse squares, cones, and cards that no light reaches.

use glam::{DVec3, Vec3};
use rain_core::rainfall::{DrawRange, Lamp, LatticeSettings, LatticeSharing, MAX_LAMPS, lamp_falloff_per_m2};

use super::{Case, EXPOSURE_S, centre, frustum, spectrum};

fn luminance(colour: Vec3) -> f32 {
    colour.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

#[test]
fn light_falls_with_the_square_of_the_distance_and_stays_finite() {
    let lamp = |at: Vec3| Lamp::point(at, Vec3::splat(50.0), 0.1);
    let drop = Vec3::new(0.0, 0.0, -10.0);
    // Lamps to the side, so that the angle at the drop stays a right angle.
    let at = |d: f32| lamp(drop + Vec3::X * d).radiance(drop).x;
    for (near, far) in [(1.0_f32, 2.0_f32), (2.0, 6.0), (5.0, 20.0)] {
        let ratio = f64::from(at(near) / at(far));
        let expected = lamp_falloff_per_m2(near.into(), 0.1) / lamp_falloff_per_m2(far.into(), 0.1);
        assert!((ratio / expected - 1.0).abs() < 1e-4, "{ratio} {expected}");
        assert!((ratio / f64::from(far / near).powi(2) - 1.0).abs() < 0.011);
    }
    let inside = lamp(drop).radiance(drop);
    assert!(inside.is_finite() && inside.x > at(1.0));
    // Behind the drop, as seen by the eye, it shines brightest: the drop refracts it on.
    let behind = lamp(drop * 1.5).radiance(drop).x;
    let before = lamp(drop * 0.5).radiance(drop).x;
    assert!(behind > 20.0 * before && before > 0.0, "{behind} {before}");
}

#[test]
fn a_spot_lights_its_cone_alone() {
    let lamp = Lamp {
        position_m: Vec3::new(1.0, 0.0, 0.0),
        intensity: Vec3::splat(1000.0),
        direction: Vec3::NEG_Z,
        cos_inner: 0.95,
        cos_outer: 0.9,
        radius_m: 0.05,
        range_m: f32::INFINITY,
    };
    let at = |x: f32| lamp.radiance(Vec3::new(x, 0.0, -10.0)).x;
    assert!(at(1.0) > 0.0 && at(3.5) > 0.0);
    // Between the angles (18.2° and 25.8°) it fades, beyond nothing is lit.
    assert!(at(1.0 + 10.0 * 0.41) > 0.0 && at(1.0 + 10.0 * 0.49) == 0.0);
    assert_eq!(lamp.radiance(Vec3::new(1.0, 0.0, 5.0)), Vec3::ZERO);
}

#[test]
fn a_lamp_ends_at_its_range_and_its_bound_holds_everywhere() {
    let drop = Vec3::new(0.0, 0.0, -10.0);
    let at = |d: f32, range_m: f32| {
        let lamp = Lamp {
            range_m,
            ..Lamp::point(drop + Vec3::X * d, Vec3::splat(50.0), 0.1)
        };
        lamp.radiance(drop).x
    };
    let share = |d: f32| at(d, 20.0) / at(d, f32::INFINITY);
    // (1 − (d/r)⁴)² at half and at nine tenths of the range.
    for (d, expected) in [(10.0_f32, 0.937_5_f32), (18.0, 0.343_9)] {
        assert!((share(d) - expected * expected).abs() < 1e-4, "{d}: {}", share(d));
    }
    assert_eq!(at(20.0, 20.0), 0.0);
    let lamp = Lamp {
        direction: Vec3::NEG_Z,
        cos_inner: 0.95,
        cos_outer: 0.8,
        range_m: 15.0,
        ..Lamp::point(Vec3::new(0.5, -0.5, -2.0), Vec3::new(300.0, 200.0, 100.0), 0.1)
    };
    let mut dark = 0;
    for i in 0..4000 {
        let at = |k: u32, by: f32| by * (rain_core::hash::unit_f32(rain_core::hash::pcg3d([i, k, 5])[0]) - 0.5);
        let middle = Vec3::new(at(0, 30.0), at(1, 10.0), at(2, 50.0));
        let place = middle + Vec3::new(at(3, 1.0), at(4, 1.0), at(5, 1.0));
        let bound = lamp.bound(middle, 0.9);
        assert!(luminance(lamp.radiance(place)) <= bound * 1.000_1, "{place}");
        dark += u32::from(bound == 0.0);
    }
    assert!((1000..4000).contains(&dark), "{dark}");
}

fn night() -> Case {
    Case {
        lattice: LatticeSettings {
            min_light: 1e-4,
            ..LatticeSettings::default()
        },
        volume: frustum(DVec3::new(0.0, 1.5, 0.0), Vec3::NEG_Z, 0.6),
        ambient: Vec3::ZERO,
        lamps: vec![Lamp::point(
            Vec3::new(2.0, 3.0, -14.0),
            Vec3::new(30.0, 20.0, 10.0),
            0.1,
        )],
        ..Case::default()
    }
}

#[test]
fn cards_that_no_light_reaches_are_left_out_and_none_that_shows() {
    let case = night();
    let plan = case.plan();
    let (lit, counts) = case.cards_with(&plan, None);
    let mut free = case.clone();
    free.lattice.min_light = 0.0;
    let all = free.cards();
    assert!(counts.unlit > 100 && !lit.is_empty(), "{counts:?}");
    assert_eq!(lit.len() + counts.unlit as usize, all.len());
    // A card that is missing has no place where a streak would show.
    let mut bright = 0;
    for card in &all {
        let unit = plan.layers()[card.layers[1] as usize].unit as f32;
        let middle = centre(card);
        let brightest = (0..125)
            .map(|i| {
                let at = |k: i32| (k as f32 / 2.0 - 1.0) * card.centre[3];
                middle + Vec3::new(at(i % 5), at(i / 5 % 5), at(i / 25))
            })
            .map(|place| luminance(case.lamps[0].radiance(place)))
            .fold(0.0, f32::max);
        let shows = brightest * (card.facing[2] * unit).min(1.0) >= 1e-4;
        let kept = lit
            .iter()
            .any(|other| other.centre == card.centre && other.layers == card.layers);
        assert!(kept || !shows, "{middle}");
        bright += usize::from(shows);
    }
    assert!(bright > 10 && bright <= lit.len(), "{bright} of {}", lit.len());
    // Without a lamp nothing is drawn.
    let dark = Case { lamps: vec![], ..case };
    assert!(dark.cards_with(&plan, None).0.is_empty());
}

#[test]
fn a_spot_leaves_out_what_its_cone_does_not_meet() {
    let mut case = night();
    let spot = |direction: Vec3| Lamp {
        position_m: Vec3::new(0.5, -0.8, -1.0),
        intensity: Vec3::splat(3000.0),
        direction,
        cos_inner: 0.98,
        cos_outer: 0.93,
        radius_m: 0.1,
        range_m: f32::INFINITY,
    };
    let mut count = |direction: Vec3| {
        case.lamps = vec![spot(direction)];
        case.cards().len()
    };
    let (ahead, behind) = (count(Vec3::NEG_Z), count(Vec3::Z));
    assert!(ahead > 100 && behind * 10 < ahead, "{ahead} {behind}");
    // More lamps than are looked at: the first count.
    let many = Case {
        lamps: [vec![spot(Vec3::Z); MAX_LAMPS], vec![spot(Vec3::NEG_Z)]].concat(),
        ..night()
    };
    assert!(many.cards().len() * 10 < ahead);
}

#[test]
fn haze_before_a_card_dims_it_by_the_account() {
    let case = Case {
        intensity: 100.0,
        ..Case::default()
    };
    let plan = case.plan();
    let range = DrawRange {
        kappa: case.kappa,
        focal_px: case.volume.focal_px,
        exposure_s: EXPOSURE_S,
    };
    let account = LatticeSharing::new(&plan, &spectrum(100.0), &range, 2.0).expect("an account");
    let (clear, hazy) = (case.cards_with(&plan, None).0, case.cards_with(&plan, Some(&account)).0);
    assert_eq!(clear.len(), hazy.len());
    assert!(clear.iter().all(|card| card.place[3] == 1.0));
    for card in &hazy {
        let distance = f64::from(centre(card).length());
        let level = f64::from(card.centre[0].hypot(card.centre[2])) / distance;
        let expected = account.fog_transmittance(distance, level) as f32;
        assert!((card.place[3] - expected).abs() < 1e-5);
    }
    let (far, near) = (hazy[0].place[3], hazy[hazy.len() - 1].place[3]);
    assert!(far < 0.97 && near > 0.985 && far < near, "{far} {near}");
}
