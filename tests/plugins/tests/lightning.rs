//! Lightning in a Bevy app: off by default, what it lights and shows, and that nothing of it stays.

use bevy::light::{DirectionalLight, GlobalAmbientLight, Skybox};
use bevy::prelude::*;
use image::RgbImage;
use rain_core::lightning::{Flash, FlashKind, for_each_flash};
use rain_plugins::prelude::*;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

const SIZE: [u32; 2] = [320, 180];
const SEED: u64 = 21;

fn settings() -> LightningSettings {
    LightningSettings {
        flashes_per_km2_min: 0.3,
        radius_m: 3000.0,
        ground_share: 0.6,
        ..LightningSettings::default()
    }
}

/// The first flash of a kind after some seconds with no other light near it in time.
fn lone(kind: FlashKind, wanted: impl Fn(&Flash) -> bool) -> Flash {
    let mut all = Vec::new();
    for_each_flash(&settings(), SEED, 0.0, 600.0, |flash| all.push(flash));
    let alone = |flash: &Flash| {
        let near = |other: &&Flash| (other.time_s - flash.time_s).abs() < 4.5;
        all.iter().filter(near).count() == 1
    };
    let found = all
        .iter()
        .find(|flash| flash.time_s > 5.0 && flash.kind == kind && alone(flash) && wanted(flash));
    *found.expect("one of many")
}

/// Ground and a block at night under a storm, looking towards `towards` on the horizon.
fn night(lightning: bool, towards: Vec3) -> TestApp {
    let mut test = TestApp::new(SIZE, true);
    test.world().insert_resource(RainSeed(SEED));
    world::ground(test.world());
    world::block(
        test.world(),
        "block",
        Vec3::new(-1.0, 0.0, -6.0),
        Vec3::new(1.0, 2.0, -5.0),
        world::STONE,
    );
    test.world().resource_mut::<GlobalAmbientLight>().brightness = 2.0;
    let mut suns = test.world().query::<&mut DirectionalLight>();
    for mut sun in suns.iter_mut(test.app.world_mut()) {
        sun.illuminance = 0.0;
    }
    let mut weather = test.world().spawn(Weather::default());
    if lightning {
        weather.insert(Lightning(settings()));
    }
    let camera = test.camera;
    test.world()
        .entity_mut(camera)
        .insert(bevy::camera::Exposure { ev100: 4.0 });
    let flat = Vec3::new(towards.x, 0.0, towards.z).normalize_or(Vec3::NEG_Z);
    test.look(
        Vec3::new(0.0, 1.7, 8.0),
        Vec3::new(0.0, 1.7, 8.0) + flat + 0.25 * Vec3::Y,
    );
    // The first update only starts the clock.
    test.frames(1, FRAME);
    test
}

/// Lets time run to `time_s` on the rain clock, the last tenth of a second in frames.
fn run_to(test: &mut TestApp, time_s: f64) {
    let now = |test: &TestApp| {
        let clock = test.app.world().resource::<RainClock>();
        clock.now_s() + f64::from(clock.interpolation()) * clock.tick_ns() as f64 * 1e-9
    };
    let far = time_s - 0.1 - now(test);
    if far > 0.0 {
        test.frames(1, std::time::Duration::from_secs_f64(far));
    }
    while now(test) + FRAME.as_secs_f64() < time_s {
        test.frames(1, FRAME);
    }
    let rest = time_s - now(test);
    test.frames(1, std::time::Duration::from_secs_f64(rest.max(0.0)));
}

fn mean(picture: &RgbImage) -> f64 {
    let sum: f64 = picture.pixels().flat_map(|p| p.0).map(f64::from).sum();
    sum / (3.0 * f64::from(SIZE[0] * SIZE[1]))
}

fn brightest(picture: &RgbImage) -> u8 {
    picture
        .pixels()
        .map(|p| p.0.into_iter().min().unwrap_or(0))
        .max()
        .unwrap_or(0)
}

fn lights(test: &mut TestApp) -> Vec<(f32, Visibility)> {
    let mut query = test
        .world()
        .query_filtered::<(&DirectionalLight, &Visibility), With<LightningLight>>();
    query
        .iter(test.app.world())
        .map(|(light, visible)| (light.illuminance, *visible))
        .collect()
}

#[test]
fn a_flash_lights_the_scene_shows_its_channel_and_leaves_nothing() {
    if !gpu::available() {
        return;
    }
    let flash = lone(FlashKind::ToGround, |flash| {
        (600.0..2500.0).contains(&flash.place_m.length()) && flash.strokes()[0].peak_a > 20e3
    });
    let towards = flash.place_m.as_vec3();
    let mut test = night(true, towards);
    run_to(&mut test, flash.time_s - 0.03);
    assert!(lights(&mut test).is_empty());
    let before = test.picture();
    let ambient = test.world().resource::<GlobalAmbientLight>().brightness;
    assert_eq!(ambient, 2.0);
    run_to(&mut test, flash.time_s + 0.008);
    let lit = lights(&mut test);
    assert!(
        lit.len() == 1 && lit[0].0 > 5.0 && lit[0].1 == Visibility::Visible,
        "{lit:?}"
    );
    assert!(test.world().resource::<GlobalAmbientLight>().brightness > 2.2);
    // The material's pipeline may still be compiled; no time passes meanwhile.
    let mut during = test.picture();
    for _ in 0..20 {
        if brightest(&during) > 240 {
            break;
        }
        test.frames(1, std::time::Duration::ZERO);
        during = test.picture();
    }
    assert!(
        mean(&during) > mean(&before) + 5.0,
        "{} {}",
        mean(&during),
        mean(&before)
    );
    assert!(
        brightest(&before) < 200 && brightest(&during) > 240,
        "{}",
        brightest(&during)
    );
    // Gone with the flash, and the scene is as it was.
    run_to(&mut test, flash.time_s + flash.duration_s() + 0.3);
    test.frames(2, FRAME);
    assert!(
        lights(&mut test)
            .iter()
            .all(|(_, visible)| *visible == Visibility::Hidden)
    );
    assert_eq!(test.world().resource::<GlobalAmbientLight>().brightness, 2.0);
    assert_eq!(test.picture(), before);
}

#[test]
fn without_lightning_or_with_its_look_off_nothing_is_spawned() {
    if !gpu::available() {
        return;
    }
    let flash = lone(FlashKind::ToGround, |flash| flash.place_m.length() < 2500.0);
    let mut without = night(false, flash.place_m.as_vec3());
    let mut off = night(true, flash.place_m.as_vec3());
    off.world().insert_resource(LightningLook {
        enabled: false,
        ..default()
    });
    for test in [&mut without, &mut off] {
        run_to(test, flash.time_s + 0.01);
        assert!(lights(test).is_empty());
        let mut named = test.world().query::<&Name>();
        assert!(named.iter(test.app.world()).all(|name| !name.starts_with("lightning")));
        assert_eq!(test.world().resource::<GlobalAmbientLight>().brightness, 2.0);
    }
    assert!(without.app.world().resource::<ActiveLightning>().flashes().is_empty());
    assert!(!off.app.world().resource::<ActiveLightning>().flashes().is_empty());
    assert_eq!(without.picture(), off.picture());
    // A gain that is not in its domain leaves the last good look in force.
    off.world().insert_resource(LightningLook {
        gain: f32::NAN,
        ..default()
    });
    let later = lone(FlashKind::InCloud, |other| other.time_s > flash.time_s + 5.0);
    run_to(&mut off, later.time_s + 0.01);
    assert!(lights(&mut off).is_empty());
}

#[test]
fn a_flash_in_the_cloud_lights_from_above_without_a_channel() {
    if !gpu::available() {
        return;
    }
    let flash = lone(FlashKind::InCloud, |flash| flash.place_m.length() < 2500.0);
    let mut test = night(true, Vec3::NEG_Z);
    run_to(&mut test, flash.time_s - 0.03);
    let before = test.picture();
    run_to(&mut test, flash.time_s + 0.01);
    assert!(test.world().resource::<GlobalAmbientLight>().brightness > 2.2);
    assert!(
        lights(&mut test)
            .iter()
            .all(|(_, visible)| *visible == Visibility::Hidden)
    );
    let during = test.picture();
    assert!(
        mean(&during) > mean(&before) + 1.0,
        "{} {}",
        mean(&during),
        mean(&before)
    );
}

#[test]
fn clouds_that_dim_the_sky_and_a_flash_that_lights_it_leave_it_as_it_was() {
    if !gpu::available() {
        return;
    }
    let flash = lone(FlashKind::ToGround, |flash| flash.strokes()[0].peak_a > 20e3);
    let mut test = night(true, flash.place_m.as_vec3());
    let image = world::cube_of(test.world(), [true; 3]);
    let camera = test.camera;
    let clouds = CloudLight {
        transition_s: 0.0,
        ..default()
    };
    test.world().entity_mut(camera).insert((
        Skybox {
            image: Some(image),
            brightness: 8.0,
            ..default()
        },
        clouds,
    ));
    let mut weather = test.world().query::<&mut Weather>();
    for mut weather in weather.iter_mut(test.app.world_mut()) {
        weather.intensity_mm_h = 10.0;
    }
    let sky = |test: &TestApp| test.app.world().get::<Skybox>(camera).expect("a sky").brightness;
    run_to(&mut test, flash.time_s - 0.5);
    let before = sky(&test);
    assert!(before < 0.5 * 8.0, "dimmed: {before}");
    run_to(&mut test, flash.time_s + 0.005);
    assert!(sky(&test) > 1.5 * before, "lit: {} of {before}", sky(&test));
    run_to(&mut test, flash.time_s + 4.0);
    assert!((sky(&test) / before - 1.0).abs() < 1e-3, "{} of {before}", sky(&test));
    test.world().entity_mut(camera).remove::<CloudLight>();
    test.frames(2, FRAME);
    assert!((sky(&test) - 8.0).abs() < 1e-3, "the app's own: {}", sky(&test));
}
