//! Several cameras see the same rain.

use std::collections::BTreeSet;

use bevy::math::DVec3;
use bevy::prelude::*;
use rain_plugins::prelude::*;
use rain_plugins::rainfall::RainViewFrame;
use test_support::app::{FRAME, TestApp, spawn_camera, target_image};
use test_support::{gpu, world};

const SIZE: [u32; 2] = [96, 54];

/// World places of the drops that a camera drew in the last frame, in half millimetres.
fn drops(test: &mut TestApp, camera: Entity) -> BTreeSet<[i64; 3]> {
    let eye = test
        .world()
        .get::<GlobalTransform>(camera)
        .expect("a camera")
        .translation()
        .as_dvec3();
    let frame = test.world().get::<RainViewFrame>(camera).expect("a rain view");
    let place = |p: Vec3| (p.as_dvec3() + eye).to_array().map(|v| (v * 2000.0).round() as i64);
    let seed = frame.choice.as_ref().expect("rain").seed;
    let drops = frame.drops();
    drops
        .records
        .iter()
        .map(|r| place(r.position(seed, &drops.classes)))
        .collect()
}

/// How many of `a` are in `b`, within the rounding of single precision.
fn shared(a: &BTreeSet<[i64; 3]>, b: &BTreeSet<[i64; 3]>) -> usize {
    let near = |p: &[i64; 3]| {
        (-1..=1).any(|x| (-1..=1).any(|y| (-1..=1).any(|z| b.contains(&[p[0] + x, p[1] + y, p[2] + z]))))
    };
    a.iter().filter(|p| near(p)).count()
}

#[test]
fn two_cameras_both_draw_and_see_the_same_drops() {
    if !gpu::available() {
        return;
    }
    let mut test = TestApp::new(SIZE, true);
    world::ground(test.world());
    test.world().spawn(Weather::rain(25.0));
    let (same, aside) = (target_image(&mut test.app, SIZE), target_image(&mut test.app, SIZE));
    let second = spawn_camera(&mut test.app, &same, true);
    let third = spawn_camera(&mut test.app, &aside, true);
    let shift = DVec3::new(0.3, 0.1, -0.2);
    if let Some(mut place) = test.world().get_mut::<Transform>(third) {
        place.translation += shift.as_vec3();
    }
    test.frames(10, FRAME);
    test.reset();
    test.frames(2, FRAME);
    assert_eq!(test.recorded(PassName::Rainfall), 6, "three cameras, two frames");

    // Two cameras in one place show one picture.
    let first_target = test.target.clone();
    let (a, b, c) = (
        test.picture_of(&first_target),
        test.picture_of(&same),
        test.picture_of(&aside),
    );
    assert!(a == b, "two cameras in one place differ");
    assert!(a != c, "a camera elsewhere shows something else");

    // A camera a little aside sees the same drops, but for the rim of its view.
    let camera = test.camera;
    let (one, two, other) = (
        drops(&mut test, camera),
        drops(&mut test, second),
        drops(&mut test, third),
    );
    assert!(one.len() > 5_000, "{} drops", one.len());
    assert_eq!(one, two);
    let common = shared(&one, &other);
    assert!(
        common * 10 > one.len() * 7,
        "{common} of {} drops are common",
        one.len()
    );
    // Another instant has other drops: sharing is not automatic.
    test.frames(1, FRAME);
    let later = drops(&mut test, camera);
    assert!(
        shared(&one, &later) * 10 < one.len(),
        "{} of {}",
        shared(&one, &later),
        one.len()
    );
}
