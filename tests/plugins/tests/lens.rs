//! Glass in the rain in a Bevy app: off by default, what it shows, when it is skipped.

use bevy::prelude::*;
use image::RgbImage;
use rain_plugins::prelude::*;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

const SIZE: [u32; 2] = [320, 180];

/// A roof over ground in a rain, with a wind against the camera (m/s), and no streaks or splashes.
fn scene(intensity_mm_h: f64, wind: f32, glass: Option<LensDrops>) -> TestApp {
    let mut test = TestApp::new(SIZE, true);
    world::ground(test.world());
    world::roof(test.world());
    test.world().spawn(Weather {
        wind_m_s: Vec3::new(0.0, 0.0, wind),
        ..Weather::rain(intensity_mm_h)
    });
    let camera = test.camera;
    test.world().entity_mut(camera).insert(RainView {
        streak_budget: Some(0),
        ..default()
    });
    if let Some(glass) = glass {
        test.world().entity_mut(camera).insert(glass);
    }
    test.look(Vec3::new(0.0, 1.0, 12.0), Vec3::new(0.0, 1.5, 0.0));
    test
}

/// Share of the pixels in which two pictures differ.
fn different(a: &RgbImage, b: &RgbImage) -> f64 {
    let off = |(a, b): &(&image::Rgb<u8>, &image::Rgb<u8>)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 2);
    a.pixels().zip(b.pixels()).filter(off).count() as f64 / f64::from(SIZE[0] * SIZE[1])
}

fn glass(test: &TestApp) -> &LensGlass {
    test.app.world().get::<LensGlass>(test.camera).expect("a glass")
}

#[test]
fn rain_on_a_lens_shows_and_without_the_component_nothing_is_recorded() {
    if !gpu::available() {
        return;
    }
    let [mut without, mut with, mut off] = [
        None,
        Some(LensDrops::default()),
        Some(LensDrops {
            enabled: false,
            ..default()
        }),
    ]
    .map(|glass| scene(50.0, 6.0, glass));
    for test in [&mut without, &mut with, &mut off] {
        test.frames(4, FRAME);
        test.leap(4);
    }
    let plain = without.picture();
    assert_eq!((without.recorded(PassName::Lens), off.recorded(PassName::Lens)), (0, 0));
    assert!(off.skipped(PassName::Lens, SkipReason::Disabled) > 4 && glass(&off).glass().is_dry());
    assert_eq!(plain, off.picture(), "what is off changes nothing");
    assert!(with.recorded(PassName::Lens) > 0);
    let drops = glass(&with).glass().drops();
    assert!(drops.len() > 10, "{}", drops.len());
    // What drops and their soft rims cover, as shares of a lens of 1:0.6.
    let changed = different(&plain, &with.picture());
    assert!(changed > 0.02, "{changed}");
    let memory = with.app.world().resource::<RainReport>().snapshot().gpu_memory_bytes;
    assert!(memory < 64 << 20, "{memory}");
}

#[test]
fn a_lens_stays_dry_without_rain_and_under_a_roof() {
    if !gpu::available() {
        return;
    }
    let mut dry = scene(0.0, 6.0, Some(LensDrops::default()));
    dry.frames(2, FRAME);
    dry.leap(4);
    assert_eq!(dry.recorded(PassName::Lens), 0);
    assert!(dry.skipped(PassName::Lens, SkipReason::NoRain) >= 6);

    let mut roofed = scene(100.0, 0.0, Some(LensDrops::default()));
    roofed.look(Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 1.0, -3.0));
    roofed.frames(2, FRAME);
    roofed.leap(4);
    assert_eq!(roofed.recorded(PassName::Lens), 0);
    assert!(roofed.skipped(PassName::Lens, SkipReason::Dry) > 0);
    // Out in the open it is wetted, and stays wet when it comes back.
    roofed.look(Vec3::new(0.0, 1.0, 12.0), Vec3::new(0.0, 1.0, 0.0));
    roofed.frames(2, FRAME);
    roofed.leap(4);
    let arrived = glass(&roofed).glass().ledger().arrived_m3;
    assert!(roofed.recorded(PassName::Lens) > 0 && arrived > 0.0);
    roofed.look(Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 1.0, -3.0));
    roofed.frames(2, FRAME);
    roofed.leap(4);
    let frames = roofed.recorded(PassName::Lens);
    let before = glass(&roofed).glass().ledger().arrived_m3;
    roofed.leap(4);
    assert_eq!(glass(&roofed).glass().ledger().arrived_m3, before);
    assert!(roofed.recorded(PassName::Lens) > frames, "old drops are shown");

    let mut room = TestApp::new(SIZE, true);
    world::ground(room.world());
    world::room(room.world());
    room.world().spawn(Weather::rain(50.0));
    let camera = room.camera;
    room.world().entity_mut(camera).insert(LensDrops {
        exposure: Some(1.0),
        ..default()
    });
    room.look(Vec3::new(0.0, 1.5, 1.5), Vec3::new(0.0, 1.5, -3.0));
    room.frames(6, FRAME);
    room.reset();
    room.frames(6, FRAME);
    assert_eq!(room.recorded(PassName::Lens), 0);
    assert_eq!(room.skipped(PassName::Lens, SkipReason::Indoors), 6);
}

#[test]
fn wipers_clear_a_windscreen_and_a_bad_setting_is_named() {
    if !gpu::available() {
        return;
    }
    let moving = LensDrops {
        velocity_m_s: Some(Vec3::new(0.0, 0.0, -10.0)),
        ..LensDrops::windscreen()
    };
    let mut test = scene(20.0, 6.0, Some(moving));
    let camera = test.camera;
    test.frames(2, FRAME);
    test.leap(6);
    let before = glass(&test).glass().drops().len();
    let wet = test.picture();
    let wipers = WindscreenWipers {
        mode: WiperMode::Fast,
        ..default()
    };
    test.world().entity_mut(camera).insert(wipers);
    test.frames(120, FRAME);
    let after = glass(&test).glass();
    let wiped = after.ledger().wiped_m3;
    assert!(
        before > 300 && after.drops().len() < before,
        "{before}, then {}",
        after.drops().len()
    );
    assert!(wiped > 0.0 && different(&wet, &test.picture()) > 0.05);
    // Off again, they end their swing first.
    test.world().entity_mut(camera).insert(WindscreenWipers::default());
    test.frames(70, FRAME);
    assert!(glass(&test).glass().wipers.rests());
    test.world().entity_mut(camera).insert(LensDrops {
        distance_m: f32::NAN,
        ..default()
    });
    test.frames(1, FRAME);
    let errors = test.app.world().resource::<Messages<RainConfigError>>();
    let named = errors
        .iter_current_update_messages()
        .any(|e| e.error.to_string().contains("distance_m"));
    assert!(named);
    // The last good ones stay in force: drops lie where a lens at its default distance has no glass.
    test.reset();
    test.frames(30, FRAME);
    assert_eq!(test.recorded(PassName::Lens), 30);
    let outside = glass(&test)
        .glass()
        .drops()
        .iter()
        .filter(|drop| drop.place_m[0].abs() > 0.1);
    assert!(outside.count() > 50);
}
