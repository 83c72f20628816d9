//! Passes that a scene does not need are not recorded; the partner case always is.

use bevy::prelude::*;
use rain_plugins::prelude::*;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

const SIZE: [u32; 2] = [96, 54];

const ALL: [PassName; 3] = [PassName::Cover, PassName::Rainfall, PassName::Masks];

/// Ground and roof, a camera that looks at both, and weather.
fn scene(rain: bool, intensity_mm_h: f64) -> TestApp {
    let mut test = TestApp::new(SIZE, rain);
    world::ground(test.world());
    world::roof(test.world());
    if rain {
        test.world().spawn(Weather::rain(intensity_mm_h));
    }
    test.look(Vec3::new(0.0, 1.7, 12.0), Vec3::new(0.0, 1.5, 0.0));
    test
}

#[test]
fn a_dry_scene_records_no_pass_in_30_frames_and_shows_what_it_shows_without_the_plugins() {
    if !gpu::available() {
        return;
    }
    let mut dry = scene(true, 0.0);
    dry.frames(5, FRAME);
    dry.reset();
    dry.frames(30, FRAME);
    for pass in ALL {
        assert_eq!(dry.recorded(pass), 0, "{pass:?}");
    }
    assert_eq!(dry.skipped(PassName::Cover, SkipReason::Dry), 30);
    assert_eq!(dry.skipped(PassName::Rainfall, SkipReason::NoRain), 30);
    let with_plugins = dry.picture();

    let mut without = scene(false, 0.0);
    without.frames(35, FRAME);
    assert!(
        without.picture() == with_plugins,
        "the dry picture differs from the one without the plugins"
    );

    let mut rainy = scene(true, 50.0);
    rainy.frames(35, FRAME);
    assert!(rainy.recorded(PassName::Rainfall) > 25 && rainy.recorded(PassName::Cover) > 0);
    assert!(rainy.picture() != with_plugins, "rain shows");
}

#[test]
fn an_eye_in_a_closed_room_records_no_rain_until_a_wall_opens() {
    if !gpu::available() {
        return;
    }
    let mut test = TestApp::new(SIZE, true);
    world::ground(test.world());
    let [wall, ..] = world::room(test.world());
    test.world().spawn(Weather::rain(50.0));
    let camera = test.camera;
    test.world().entity_mut(camera).insert(PlanarReflection::default());
    test.look(Vec3::new(0.0, 1.5, 1.5), Vec3::new(0.0, 1.5, -3.0));
    test.frames(10, FRAME);
    test.reset();
    test.frames(30, FRAME);
    assert_eq!(test.recorded(PassName::Rainfall), 0);
    assert_eq!(test.skipped(PassName::Rainfall, SkipReason::Indoors), 30);
    assert_eq!(test.recorded(PassName::Reflection), 0);
    assert_eq!(test.skipped(PassName::Reflection, SkipReason::Indoors), 30);

    test.world().despawn(wall);
    test.frames(5, FRAME);
    test.reset();
    test.frames(30, FRAME);
    assert_eq!(test.recorded(PassName::Rainfall), 30, "with a wall gone");
    assert!(
        test.recorded(PassName::Reflection) > 20,
        "the ground before the room mirrors"
    );
}

#[test]
fn cover_is_recorded_once_for_a_place_and_in_each_frame_in_which_something_moves() {
    if !gpu::available() {
        return;
    }
    let mut test = scene(true, 50.0);
    let slab = world::block(
        test.world(),
        "slab",
        Vec3::new(6.0, 2.0, 0.0),
        Vec3::new(8.0, 2.2, 2.0),
        world::STONE,
    );
    // The map is drawn until every mesh has the pipelines of its wet material; then it is kept.
    test.frames(30, FRAME);
    assert!(test.recorded(PassName::Cover) > 0);
    test.reset();
    test.frames(30, FRAME);
    assert_eq!(
        test.recorded(PassName::Cover),
        0,
        "static scene, static camera, steady rain"
    );
    assert_eq!(test.skipped(PassName::Cover, SkipReason::NothingMoved), 30);
    assert_eq!(test.recorded(PassName::Rainfall), 30);

    // A camera that has left the map's margin needs another map: one.
    test.reset();
    test.look(Vec3::new(0.0, 1.7, 24.0), Vec3::new(0.0, 1.5, 0.0));
    test.frames(30, FRAME);
    assert_eq!(test.recorded(PassName::Cover), 1, "the camera was moved once");

    test.reset();
    for _ in 0..7 {
        if let Some(mut place) = test.world().get_mut::<Transform>(slab) {
            place.translation.x += 0.1;
        }
        test.frames(1, FRAME);
    }
    assert_eq!(
        test.recorded(PassName::Cover),
        7,
        "one for each frame in which the slab moved"
    );
    test.reset();
    test.frames(10, FRAME);
    assert_eq!(test.recorded(PassName::Cover), 0, "it stands again");

    // Turning the wind by more than a degree draws it anew as well.
    let weather = test
        .world()
        .query_filtered::<Entity, With<Weather>>()
        .single(test.world())
        .expect("weather");
    test.world().entity_mut(weather).insert(Weather {
        wind_m_s: Vec3::new(5.0, 0.0, 0.0),
        ..Weather::rain(50.0)
    });
    test.frames(10, FRAME);
    assert_eq!(test.recorded(PassName::Cover), 1, "the wind turned once");
}

#[test]
fn an_inactive_camera_records_nothing_and_an_active_one_does() {
    if !gpu::available() {
        return;
    }
    let mut test = scene(true, 50.0);
    let camera = test.camera;
    let set = |test: &mut TestApp, active: bool| {
        if let Some(mut camera) = test.world().get_mut::<Camera>(camera) {
            camera.is_active = active;
        }
    };
    set(&mut test, false);
    test.frames(20, FRAME);
    for pass in ALL {
        assert_eq!(test.recorded(pass), 0, "{pass:?}");
    }
    assert!(test.skipped(PassName::Cover, SkipReason::NoView) > 0);
    assert!(test.skipped(PassName::Rainfall, SkipReason::NoView) > 0);
    set(&mut test, true);
    test.reset();
    test.frames(20, FRAME);
    assert_eq!(test.recorded(PassName::Rainfall), 20);
    assert!(test.recorded(PassName::Cover) >= 1);
}
