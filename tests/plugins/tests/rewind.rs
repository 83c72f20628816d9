//! The picture after a jump back in time is the picture of then.

use bevy::prelude::*;
use rain_core::rainfall::DropChoice;
use rain_plugins::prelude::*;
use rain_plugins::rainfall::RainViewFrame;
use rain_plugins::surface::WaterLevels;
use rain_plugins::waves::PuddleWaves;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

use crate::scenes::{depth, difference, hollow_at, rain};

#[test]
fn a_restored_scene_looks_as_it_did_and_no_later_water_stays() {
    if !gpu::available() {
        return;
    }
    let (mut test, weather) = hollow_at(Vec3::ZERO);
    rain(&mut test, weather, 40.0, 200);
    let saved = RainSnapshot::save(test.world()).expect("can be written");
    let before = test.picture();
    let levels = test.world().resource::<WaterLevels>().levels_m().clone();
    let shallow = depth(&mut test, 0.0, 0.0);

    // Later: more water, a foot in it, another picture.
    rain(&mut test, weather, 150.0, 1200);
    let foot = test
        .world()
        .spawn((
            WaterDisturber {
                radius_m: 0.1,
                ..default()
            },
            Transform::from_xyz(0.0, 0.0, 0.0),
        ))
        .id();
    for step in 0..4_u8 {
        let at = Transform::from_xyz(0.05 * f32::from(step), 0.0, 0.0);
        test.world().entity_mut(foot).insert(at);
        test.frames(1, FRAME);
    }
    test.world().despawn(foot);
    assert!(
        !test.world().resource::<PuddleWaves>().tile().is_calm(),
        "the foot made waves"
    );
    let later = test.picture();
    let deep = depth(&mut test, 0.0, 0.0);
    assert!(shallow > 0.002 && deep > 1.3 * shallow, "{shallow}, {deep}");
    let changed = difference(&before, &later);
    assert!(changed.mean > 0.4 && changed.share > 0.02, "{changed:?}");

    saved.restore(test.world()).expect("fits");
    let after = test.picture();
    // What is shown lags behind what is simulated by less than 0.1 mm; restored, it does not.
    let restored = test.world().resource::<WaterLevels>().levels_m().clone();
    assert_eq!(restored.len(), levels.len());
    let off = levels
        .iter()
        .zip(restored.iter())
        .filter(|(then, now)| (*then - *now).abs() > 1e-4);
    assert_eq!(off.count(), 0, "the levels of then");
    assert!(
        test.world().resource::<PuddleWaves>().tile().is_calm(),
        "no waves of later"
    );
    let found = difference(&before, &after);
    assert!(found.mean < 0.02 && found.share == 0.0, "{found:?}, later {changed:?}");

    // It goes on from there as it did.
    test.frames(4, FRAME);
    assert!((depth(&mut test, 0.0, 0.0) - shallow).abs() < 0.002);
}

/// A foot that walks through the hollow's water, a frame for each step.
fn walk(test: &mut TestApp, foot: Entity, steps: std::ops::Range<u8>) {
    for step in steps {
        let at = Transform::from_xyz(0.03 * f32::from(step) - 0.2, 0.0, 0.05);
        test.world().entity_mut(foot).insert(at);
        test.frames(1, FRAME);
    }
}

fn foot(test: &mut TestApp) -> Entity {
    let foot = WaterDisturber {
        radius_m: 0.1,
        ..default()
    };
    test.world().spawn((foot, Transform::from_xyz(-0.2, 0.0, 0.05))).id()
}

#[test]
fn waves_are_saved_with_their_foot_and_go_on_bit_for_bit() {
    if !gpu::available() {
        return;
    }
    let (mut test, weather) = hollow_at(Vec3::ZERO);
    rain(&mut test, weather, 40.0, 200);
    rain(&mut test, weather, 0.0, 2);
    let walker = foot(&mut test);
    walk(&mut test, walker, 0..8);
    let saved = RainSnapshot::save(test.world()).expect("can be written");
    assert!(saved.parts().any(|part| part == "seen_waves"));
    assert!(saved.size_bytes() < 400_000, "{} bytes", saved.size_bytes());
    walk(&mut test, walker, 8..16);
    let end = RainSnapshot::save(test.world()).expect("can be written");
    assert!(
        !test.world().resource::<PuddleWaves>().tile().is_calm(),
        "it makes waves"
    );
    let picture = test.picture();

    // In the same world, and in one that has just begun.
    let (mut fresh, _) = hollow_at(Vec3::ZERO);
    let stranger = foot(&mut fresh);
    fresh.frames(3, FRAME);
    for (test, foot) in [(&mut test, walker), (&mut fresh, stranger)] {
        saved.restore(test.world()).expect("fits");
        walk(test, foot, 8..16);
        let again = RainSnapshot::save(test.world()).expect("can be written");
        assert_eq!(again.size_bytes(), end.size_bytes());
        assert!(again == end, "the waves went on otherwise");
        let found = difference(&picture, &test.picture());
        assert!(found.mean < 0.02 && found.share == 0.0, "{found:?}");
    }

    // Where nobody makes waves the rest fits all the same.
    fresh.world().remove_resource::<PuddleWaves>();
    saved.restore(fresh.world()).expect("waves are only seen");

    // Damaged heights are refused, and nothing changes.
    let before = RainSnapshot::save(test.world()).expect("can be written");
    for (from, to) in [("now_ns", "now"), ("depths:\"", "depths:\"!")] {
        let damaged = saved.with_part("seen_waves", |text| text.replacen(from, to, 1));
        let error = damaged.restore(test.world()).expect_err("damaged");
        assert!(error.to_string().contains("seen_waves"), "{error}");
        assert!(RainSnapshot::save(test.world()).expect("can be written") == before);
    }
    // A tile of another size is of no use here; the rest fits.
    let other = saved.with_part("seen_waves", |text| text.replacen("cells:256", "cells:128", 1));
    other.restore(test.world()).expect("waves are only seen");
    assert!(
        test.world().resource::<PuddleWaves>().tile().is_calm(),
        "the water is still"
    );
}

/// Rain over level ground in gusts of wind.
fn gusty() -> TestApp {
    let mut test = TestApp::new([96, 54], true);
    world::ground(test.world());
    test.world().spawn((
        Weather {
            wind_m_s: Vec3::new(4.0, 0.0, 1.0),
            ..Weather::rain(40.0)
        },
        Gusts::default(),
    ));
    test.frames(3, FRAME);
    test.leap(2);
    test
}

/// What the view's drops are chosen from: where each class stands, how it moves, which are drawn.
fn choice(test: &mut TestApp) -> DropChoice {
    let camera = test.camera;
    let frame = test.world().get::<RainViewFrame>(camera).expect("a rain view");
    frame.choice.clone().expect("it rains")
}

#[test]
fn rain_runs_backwards_frame_by_frame_as_it_came() {
    if !gpu::available() {
        return;
    }
    let mut test = gusty();
    let mut frames = Vec::new();
    for _ in 0..10 {
        test.frames(1, FRAME);
        let saved = RainSnapshot::save(test.world()).expect("can be written");
        frames.push((saved, choice(&mut test), test.picture()));
    }
    let moved = difference(&frames[0].2, &frames[9].2);
    assert!(moved.share > 0.02 && frames[0].1 != frames[9].1, "it rains: {moved:?}");
    for (saved, then, picture) in frames.iter().rev() {
        saved.restore(test.world()).expect("fits");
        test.frames(1, std::time::Duration::ZERO);
        assert!(choice(&mut test) == *then, "other drops than then");
        let found = difference(picture, &test.picture());
        assert!(found.share == 0.0, "{found:?}");
    }
    // And forwards again from there.
    for (_, then, _) in &frames[1..] {
        test.frames(1, FRAME);
        assert!(choice(&mut test) == *then, "other drops than then");
    }
}

#[test]
fn in_slow_motion_every_fourth_frame_is_one_of_the_usual_ones() {
    if !gpu::available() {
        return;
    }
    // A quarter of it is a whole number of nanoseconds.
    let frame = std::time::Duration::from_millis(16);
    let [usual, slow] = [1_u8, 4].map(|slower| {
        let mut test = gusty();
        test.world()
            .resource_mut::<Time<Virtual>>()
            .set_relative_speed(1.0 / f32::from(slower));
        let mut choices = Vec::new();
        for _ in 0..6 * slower {
            test.frames(1, frame);
            choices.push(choice(&mut test));
        }
        choices
    });
    for (step, usual) in usual.iter().enumerate() {
        assert!(slow[4 * step + 3] == *usual, "frame {step}");
    }
    // In between it goes on by a quarter of the way each time.
    let height = |choice: &DropChoice| choice.motion.offset_m[8].y;
    let ways: Vec<f64> = slow.windows(2).map(|w| height(&w[1]) - height(&w[0])).collect();
    let usual_way = height(&usual[1]) - height(&usual[0]);
    assert!(usual_way < -0.05, "{usual_way}");
    for way in ways {
        assert!(
            (way / (0.25 * usual_way) - 1.0).abs() < 0.02,
            "{way} m of {usual_way} m"
        );
    }
}
