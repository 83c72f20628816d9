//! Near streaks have the pattern that their drops draw, where it is asked for.

use bevy::prelude::*;
use image::RgbImage;
use rain_plugins::prelude::*;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

const SIZE: [u32; 2] = [192, 128];

/// A view through a lens of this angle in a downpour over dark ground, in even light.
fn through_lens(fov: f32) -> TestApp {
    let mut test = TestApp::new(SIZE, true);
    world::without_ground(test.world());
    let camera = test.camera;
    let projection = Projection::Perspective(PerspectiveProjection { fov, ..default() });
    test.world().entity_mut(camera).insert(projection);
    test.world().spawn(Weather::rain(100.0));
    test.frames(3, FRAME);
    test.leap(2);
    test
}

/// The picture of this moment.
fn picture(test: &mut TestApp, near_patterns: bool, exposure_s: f32) -> RgbImage {
    let camera = test.camera;
    let view = RainView {
        near_patterns: Some(near_patterns),
        exposure_s,
        streak_budget: Some(8_000),
        contrast: 4.0,
        cards: Some(false),
        ..default()
    };
    test.world().entity_mut(camera).insert(view);
    test.frames(2, std::time::Duration::ZERO);
    test.picture()
}

fn changed(a: &RgbImage, b: &RgbImage) -> usize {
    let off = |(a, b): &(&image::Rgb<u8>, &image::Rgb<u8>)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 2);
    a.pixels().zip(b.pixels()).filter(off).count()
}

#[test]
fn near_streaks_have_patterns_where_they_are_asked_for() {
    if !gpu::available() {
        return;
    }
    // A short shutter: drops are opaque, and those of a long lens wide.
    let exposure_s = 1e-4;
    let mut long = through_lens(0.06);
    picture(&mut long, true, exposure_s);
    long.leap(1);
    let [on, off, again] = [true, false, true].map(|patterns| picture(&mut long, patterns, exposure_s));
    let (near, same) = (changed(&on, &off), changed(&on, &again));
    assert!(
        near > 100 && same == 0,
        "{near} pixels differ, {same} from frame to frame"
    );
    // Through a wide one hardly any drop is wider than a pixel and a half.
    let mut wide = through_lens(1.4);
    picture(&mut wide, true, exposure_s);
    wide.leap(1);
    let [on, off] = [true, false].map(|patterns| picture(&mut wide, patterns, exposure_s));
    let far = changed(&on, &off);
    assert!(
        far * 10 < near,
        "{far} pixels through a wide lens, {near} through a long one"
    );
}

#[test]
fn shutters_go_down_to_a_tenth_of_a_millisecond() {
    let with = |exposure_s: f32| RainView {
        exposure_s,
        ..default()
    };
    assert!(with(1e-4).validated().is_ok() && with(0.25).validated().is_ok());
    let error = with(5e-5).validated().expect_err("too short");
    assert!(error.to_string().contains("exposure_s"), "{error}");
}
