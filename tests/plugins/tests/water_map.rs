//! The water map in the picture: a dry patch where something stood, a wheel's track, and when there is nothing to do.

use std::time::Duration;

use bevy::prelude::*;
use image::RgbImage;
use rain_plugins::prelude::*;
use rain_plugins::surface::GroundMap;
use test_support::app::{FRAME, TestApp, spawn_camera, target_image};
use test_support::{gpu, world};

/// Side of the picture, and its pixels per metre of ground. Units: px, px/m.
const SIZE: u32 = 128;
const PX_PER_M: f32 = 9.66;

/// Air that takes up no water.
fn humid(intensity_mm_h: f64) -> Weather {
    Weather {
        relative_humidity: 1.0,
        net_radiation_w_m2: 0.0,
        ..Weather::rain(intensity_mm_h)
    }
}

/// Level ground seen from straight above, its simulation built, under a dry sky, with a map of the default's size.
fn from_above() -> (TestApp, Entity) {
    with_map(GroundMapSettings::default())
}

/// A map of half the default's side, wide enough for the whole picture.
fn small_map() -> GroundMapSettings {
    let mut settings = GroundMapSettings::default();
    settings.map.texels = 256;
    settings
}

fn with_map(settings: GroundMapSettings) -> (TestApp, Entity) {
    let mut test = TestApp::new([SIZE, SIZE], true);
    test.world().insert_resource(settings);
    world::ground(test.world());
    let weather = test.world().spawn(humid(0.0)).id();
    let camera = test.camera;
    test.world().entity_mut(camera).insert(RainView {
        streak_budget: Some(0),
        ..default()
    });
    test.look(Vec3::new(0.0, 16.0, 0.0), Vec3::ZERO);
    test.frames(3, FRAME);
    test.leap(2);
    test.frames(3, FRAME);
    assert!(
        test.world().resource::<SurfaceGround>().ground().is_some(),
        "the ground is built"
    );
    (test, weather)
}

/// Mean brightness of the picture around the ground at (x, z), 0…255.
fn brightness(picture: &RgbImage, x: f32, z: f32) -> f64 {
    let [x, y] = [x, z].map(|at| (0.5 * SIZE as f32 + PX_PER_M * at) as u32);
    let pixels = (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| (x, y)));
    pixels
        .map(|(x, y)| picture.get_pixel(x, y).0.iter().map(|c| f64::from(*c)).sum::<f64>() / 3.0)
        .sum::<f64>()
        / 9.0
}

/// Rain for so many steps of five seconds.
fn rain(test: &mut TestApp, weather: Entity, intensity_mm_h: f64, steps: u32) {
    rain_in_steps_of(test, weather, intensity_mm_h, steps, 5);
}

fn rain_in_steps_of(test: &mut TestApp, weather: Entity, intensity_mm_h: f64, steps: u32, seconds: u64) {
    test.world().entity_mut(weather).insert(humid(intensity_mm_h));
    test.frames(steps, Duration::from_secs(seconds));
    test.frames(2, FRAME);
}

#[test]
fn a_truck_that_leaves_uncovers_a_dry_patch_that_stays_until_it_rains_on_it() {
    if !gpu::available() {
        return;
    }
    // The patch against the ground beside it: after the truck has left, a quarter of an hour later without rain, and
    // after more rain.
    let differences = |map: bool| {
        let (mut test, weather) = with_map(GroundMapSettings {
            enabled: map,
            ..small_map()
        });
        let truck = world::block(
            test.world(),
            "truck",
            Vec3::new(-1.5, 0.6, -1.5),
            Vec3::new(1.5, 2.6, 1.5),
            world::STONE,
        );
        test.world().entity_mut(truck).insert(MovesInRain);
        test.frames(4, FRAME);
        rain(&mut test, weather, 20.0, 60);
        test.world().despawn(truck);
        test.frames(4, FRAME);
        let mut seen = Vec::new();
        for (intensity_mm_h, steps, seconds) in [(0.0, 1, 5), (0.0, 30, 30), (40.0, 60, 5)] {
            rain_in_steps_of(&mut test, weather, intensity_mm_h, steps, seconds);
            let picture = test.picture();
            seen.push((brightness(&picture, 0.0, 0.0) - brightness(&picture, 4.0, 0.0)).abs());
        }
        seen
    };
    let (with, without) = (differences(true), differences(false));
    assert!(with[0] > 10.0, "a dry patch: {with:?}");
    assert!(with[1] > 0.9 * with[0], "nothing has rained on it: {with:?}");
    assert!(with[2] < 0.2 * with[0], "rain has: {with:?}");
    assert!(
        without.iter().all(|d| *d < 0.2 * with[0]),
        "without the map: {without:?}"
    );
}

#[test]
fn a_dry_patch_is_seen_by_a_second_view_that_is_near_the_first_and_not_by_one_far_from_it() {
    if !gpu::available() {
        return;
    }
    // The second view stays where it is, five metres from the patch, which lies 24 or 29 m from the first.
    let patch = |first: f32| {
        let (mut test, weather) = from_above();
        test.look(Vec3::new(first, 16.0, 0.0), Vec3::new(first, 0.0, 0.0));
        let target = target_image(&mut test.app, [SIZE, SIZE]);
        let second = spawn_camera(&mut test.app, &target, true);
        let view = RainView {
            streak_budget: Some(0),
            ..default()
        };
        let over = Transform::from_xyz(19.0, 16.0, 0.0).looking_to(Vec3::NEG_Y, Vec3::NEG_Z);
        test.world().entity_mut(second).insert((view, over));
        let truck = world::block(
            test.world(),
            "truck",
            Vec3::new(22.5, 0.6, -1.5),
            Vec3::new(25.5, 2.6, 1.5),
            world::STONE,
        );
        test.world().entity_mut(truck).insert(MovesInRain);
        test.frames(4, FRAME);
        rain(&mut test, weather, 20.0, 60);
        test.world().despawn(truck);
        test.frames(4, FRAME);
        rain(&mut test, weather, 0.0, 1);
        let place = test.world().resource::<GroundMap>().map().place();
        let picture = test.picture_of(&target);
        let dark = brightness(&picture, 5.0, 0.0) - brightness(&picture, 5.0, 4.0);
        (dark.abs(), place.seen_from([f64::from(first), 0.0]).middle_centre[0])
    };
    let (near, far) = (patch(0.0), patch(-5.0));
    assert_eq!((near.1, far.1), (9.5, 0.0), "amid both, then around the first");
    assert!(near.0 > 10.0 && far.0 < 0.2 * near.0, "{near:?}, then {far:?}");
}

#[test]
fn a_wheels_track_on_a_wet_road_is_seen_and_fills_again() {
    if !gpu::available() {
        return;
    }
    let (mut test, weather) = with_map(small_map());
    rain(&mut test, weather, 20.0, 180);
    rain(&mut test, weather, 0.0, 1);
    let mut press = FilmPress::wheel(0.3);
    (press.width_m, press.share) = (0.4, 0.8);
    let wheel = test.world().spawn((Transform::from_xyz(-5.0, 0.3, 0.0), press)).id();
    test.frames(3, FRAME);
    // The sun overhead glints on a film at the middle of the picture: the track there, and road far from it.
    let sun = Transform::default().looking_to(Vec3::NEG_Y, Vec3::X);
    let mut lights = test.world().query_filtered::<&mut Transform, With<DirectionalLight>>();
    lights.iter_mut(test.world()).for_each(|mut light| *light = sun);
    test.frames(2, FRAME);
    let look = |test: &mut TestApp| {
        let picture = test.picture();
        let at = |z: f32| {
            (-3..=3_i8)
                .map(|i| brightness(&picture, 0.1 * f32::from(i), z))
                .sum::<f64>()
                / 7.0
        };
        [at(0.0), at(4.0)]
    };
    let before = look(&mut test);
    test.reset();
    for step in 0..100_u8 {
        test.world()
            .entity_mut(wheel)
            .insert(Transform::from_xyz(0.1 * f32::from(step) - 5.0, 0.3, 0.0));
        test.frames(1, Duration::from_nanos(31_250_000));
    }
    test.frames(2, FRAME);
    assert!(test.recorded(PassName::WaterMap) > 50, "presses are drawn");
    let film = |test: &mut TestApp, z: f64| {
        let surface = test.world().resource::<SurfaceGround>();
        let ground = surface.ground().expect("a ground");
        ground.water_at(bevy::math::DVec3::new(0.1, 0.0, z)).film_mm
    };
    let (track, beside) = (film(&mut test, 0.1), film(&mut test, 2.1));
    assert!(
        track < 0.7 * beside,
        "on the simulation's ground {track} mm, beside {beside} mm"
    );
    let after = look(&mut test);
    let lost = before[0] - after[0];
    assert!(lost > 10.0, "the track glints less: {before:?}, then {after:?}");
    assert!(
        (before[1] - after[1]).abs() < 2.0,
        "the road beside does not: {before:?}, then {after:?}"
    );
    // The view looks away and comes back: the track is still there, fainter and as wide as the ground's cells.
    test.look(Vec3::new(0.0, 16.0, 36.0), Vec3::new(0.0, 0.0, 36.0));
    test.frames(3, FRAME);
    test.look(Vec3::new(0.0, 16.0, 0.0), Vec3::ZERO);
    test.frames(3, FRAME);
    let back = look(&mut test);
    let fainter = before[0] - back[0];
    assert!(fainter > 2.0, "{before:?}, {after:?}, then {back:?}");
    rain(&mut test, weather, 20.0, 60);
    rain(&mut test, weather, 0.0, 1);
    let filled = look(&mut test);
    assert!(
        before[0] - filled[0] < 0.2 * lost,
        "{before:?}, {after:?}, then {filled:?}"
    );
}

#[test]
fn the_map_is_recorded_when_something_changes_and_says_why_not_otherwise() {
    if !gpu::available() {
        return;
    }
    let (mut test, weather) = from_above();
    test.reset();
    test.frames(20, FRAME);
    assert_eq!(test.recorded(PassName::WaterMap), 0, "dry");
    assert_eq!(test.skipped(PassName::WaterMap, SkipReason::Dry), 20);
    // At 10 mm/h the pores gain 1/500 of what they hold in 0.36 s: a few steps in a second of 60 frames.
    test.world().entity_mut(weather).insert(humid(10.0));
    test.frames(60, FRAME);
    let steps = test.recorded(PassName::WaterMap);
    assert!((2..8).contains(&steps), "{steps} steps");
    rain(&mut test, weather, 10.0, 30);
    assert!(test.world().resource::<GroundMap>().map().is_shown());
    let memory = test.world().resource::<RainReport>().snapshot().gpu_memory_bytes;
    assert!(memory > 2 * 512 * 512 * 20, "{memory} bytes");
    // Wet, no rain, nothing evaporates.
    rain(&mut test, weather, 0.0, 1);
    test.reset();
    test.frames(30, FRAME);
    assert_eq!(test.recorded(PassName::WaterMap), 0, "settled");
    assert_eq!(test.skipped(PassName::WaterMap, SkipReason::Settled), 30);
    // The view moves: new ground is filled in once.
    test.look(Vec3::new(5.0, 16.0, 0.0), Vec3::new(5.0, 0.0, 0.0));
    test.frames(10, FRAME);
    assert_eq!(test.recorded(PassName::WaterMap), 1, "moved");
    // Unseen.
    let camera = test.camera;
    test.world().get_mut::<Camera>(camera).expect("a camera").is_active = false;
    test.reset();
    test.frames(10, FRAME);
    assert_eq!(test.skipped(PassName::WaterMap, SkipReason::NoView), 10);
    // In the artists' way the levels are theirs.
    test.world().get_mut::<Camera>(camera).expect("a camera").is_active = true;
    test.world().entity_mut(weather).insert(WeatherMode::Artist);
    test.frames(2, FRAME);
    test.reset();
    test.frames(10, FRAME);
    assert_eq!(test.skipped(PassName::WaterMap, SkipReason::Disabled), 10);
    // What is set by hand is not the ground's either: the map forgets, and starts anew from the ground afterwards.
    test.world().entity_mut(weather).insert(WeatherMode::Physical);
    test.frames(4, FRAME);
    assert!(test.world().resource::<GroundMap>().map().is_shown());
    let by_hand = WaterByHand {
        wetness: None,
        water_level: Some(1.0),
        ..WaterByHand::default()
    };
    test.world().entity_mut(weather).insert(by_hand);
    test.frames(2, FRAME);
    test.reset();
    test.frames(10, FRAME);
    assert_eq!(test.skipped(PassName::WaterMap, SkipReason::Disabled), 10);
    assert!(!test.world().resource::<GroundMap>().map().is_shown());
    test.world().entity_mut(weather).remove::<WaterByHand>();
    test.frames(4, FRAME);
    assert!(test.world().resource::<GroundMap>().map().is_shown());
}

/// Whether the finest level holds a place.
fn finest(test: &TestApp, x: f64) -> bool {
    test.app
        .world()
        .resource::<GroundMap>()
        .map()
        .texel_at(0, [x, 0.0])
        .is_some()
}

#[test]
fn the_map_lies_around_the_leading_view_of_those_far_apart() {
    if !gpu::available() {
        return;
    }
    let (mut test, weather) = from_above();
    rain(&mut test, weather, 20.0, 60);
    assert!(finest(&test, 12.0) && !finest(&test, 24.0));
    // A second view too far away for one map: it is the leading view's, whichever was made first.
    let target = target_image(&mut test.app, [SIZE, SIZE]);
    let second = spawn_camera(&mut test.app, &target, true);
    let above = Transform::from_xyz(40.0, 16.0, 0.0).looking_at(Vec3::X * 40.0, Vec3::NEG_Z);
    test.world().entity_mut(second).insert(above);
    test.frames(3, FRAME);
    assert!(finest(&test, 1.0) && !finest(&test, 39.0));
    test.world().get_mut::<Camera>(second).expect("a camera").order = -1;
    test.frames(3, FRAME);
    assert!(!finest(&test, 1.0) && finest(&test, 39.0));
}
