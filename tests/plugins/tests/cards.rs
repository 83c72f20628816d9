//! Cards of rain beyond the single drops: when they are drawn, and how much they take out of the light.

use bevy::camera::Hdr;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::prelude::*;
use rain_core::rainfall::{Distribution, DrawRange, LatticePlan, LatticeSharing, StreakTextureSettings};
use rain_plugins::prelude::*;
use rain_plugins::rainfall::{CardViewFrame, RainViewFrame};
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

const SIZE: u32 = 160;

/// A view from a height over nothing: rain alone, lit evenly with `radiance` (exposed), nothing behind it.
fn aloft(intensity_mm_h: f64, radiance: f32) -> TestApp {
    let mut test = TestApp::new([SIZE, SIZE], true);
    let suns: Vec<Entity> = test
        .world()
        .query_filtered::<Entity, With<DirectionalLight>>()
        .iter(test.world())
        .collect();
    for sun in suns {
        test.world().despawn(sun);
    }
    let exposure = bevy::camera::Exposure::default().exposure();
    test.world().insert_resource(GlobalAmbientLight {
        brightness: radiance / exposure,
        ..default()
    });
    test.world().insert_resource(ClearColor(Color::BLACK));
    test.world().spawn(Weather::rain(intensity_mm_h));
    let camera = test.camera;
    test.world().entity_mut(camera).insert((
        Hdr,
        Tonemapping::None,
        RainView {
            streak_budget: Some(20_000),
            contrast: 1.0,
            cards: Some(true),
            ..default()
        },
    ));
    test.look(Vec3::new(0.0, 80.0, 0.0), Vec3::new(0.0, 80.0, -10.0));
    test
}

fn set(test: &mut TestApp, change: impl FnOnce(&mut RainView)) {
    let camera = test.camera;
    if let Some(mut view) = test.world().get_mut::<RainView>(camera) {
        change(&mut view);
    }
}

fn cards(test: &mut TestApp) -> usize {
    let camera = test.camera;
    test.world()
        .get::<CardViewFrame>(camera)
        .map_or(0, CardViewFrame::cards)
}

/// Mean linear light of a picture.
fn light(test: &mut TestApp) -> f64 {
    let picture = test.picture();
    let sum: f64 = picture
        .pixels()
        .map(|pixel| f64::from(Srgba::gamma_function(f32::from(pixel[1]) / 255.0)))
        .sum();
    sum / f64::from(SIZE * SIZE)
}

#[test]
fn cards_are_drawn_while_it_rains_and_their_pictures_are_made_once() {
    if !gpu::available() {
        return;
    }
    let mut test = TestApp::new([96, 54], true);
    set(&mut test, |view| view.cards = Some(true));
    world::ground(test.world());
    world::roof(test.world());
    let weather = test.world().spawn(Weather::rain(0.0)).id();
    test.look(Vec3::new(0.0, 1.7, 12.0), Vec3::new(0.0, 1.5, 0.0));
    test.frames(5, FRAME);
    assert_eq!(
        test.recorded(PassName::Lattice) + test.recorded(PassName::StreakTextures),
        0
    );
    assert_eq!(test.skipped(PassName::Lattice, SkipReason::NoRain), 5);
    let memory = |test: &mut TestApp| test.world().resource::<RainReport>().snapshot().gpu_memory_bytes;
    let before = memory(&mut test);

    test.world().entity_mut(weather).insert(Weather::rain(30.0));
    test.frames(5, FRAME);
    test.reset();
    test.frames(20, FRAME);
    assert_eq!(test.recorded(PassName::Lattice), 20);
    assert_eq!(test.recorded(PassName::StreakTextures), 0, "made before, and not again");
    assert!(cards(&mut test) > 200);
    let report = test.world().resource::<RainReport>().snapshot();
    assert_eq!(report.cards.len(), 20);
    let textures = StreakTextureSettings::default().bytes();
    let more = memory(&mut test) - before;
    // Beside the pictures: cards, and room for twice as many single drops as there are in the mean, 56 bytes each.
    assert!((textures..textures + 5_000_000).contains(&more), "{more}");

    // Another family of spectra has other pictures.
    test.world().entity_mut(weather).insert(Weather {
        distribution: Distribution::Thunderstorm,
        ..Weather::rain(30.0)
    });
    test.frames(3, FRAME);
    assert_eq!(test.recorded(PassName::StreakTextures), 1);

    set(&mut test, |view| view.cards = Some(false));
    test.reset();
    test.frames(4, FRAME);
    assert_eq!(test.recorded(PassName::Lattice), 0);
    assert_eq!(test.skipped(PassName::Lattice, SkipReason::Disabled), 4);
    assert_eq!(test.recorded(PassName::Rainfall), 4);
    set(&mut test, |view| view.cards = Some(true));

    // Settings that no lattice can be made of draw none.
    let good = CardSettings::default();
    let mut bad = good.clone();
    bad.textures.texels = 100;
    assert!(bad.clone().validated().is_err() && good.clone().validated().is_ok());
    test.world().insert_resource(bad);
    test.reset();
    test.frames(3, FRAME);
    assert_eq!(test.skipped(PassName::Lattice, SkipReason::Disabled), 3);
    test.world().insert_resource(good);
    test.frames(2, FRAME);
    assert_eq!(test.recorded(PassName::Lattice), 2);

    test.world().entity_mut(weather).insert(Weather::rain(0.0));
    test.frames(2, FRAME);
    test.reset();
    test.frames(5, FRAME);
    assert_eq!(test.recorded(PassName::Lattice), 0);
    assert_eq!(test.skipped(PassName::Lattice, SkipReason::NoRain), 5);
}

#[test]
fn pictures_come_from_a_folder_without_a_pass() {
    if !gpu::available() {
        return;
    }
    let folder = std::env::temp_dir().join(format!("rain-cards-{}", std::process::id()));
    let settings = CardSettings {
        textures: StreakTextureSettings {
            texels: 64,
            ..StreakTextureSettings::default()
        },
        cache: Some(folder.clone()),
        ..CardSettings::default()
    };
    for _ in 0..2 {
        let mut test = aloft(50.0, 4.0);
        test.world().insert_resource(settings.clone());
        test.frames(6, FRAME);
        assert!(test.recorded(PassName::Lattice) >= 3);
        assert_eq!(test.recorded(PassName::StreakTextures), 0);
        let files = std::fs::read_dir(&folder).expect("the folder").count();
        assert_eq!(files, 1, "stored once, then read");
        set(&mut test, |view| view.cards = Some(true));
        let with = light(&mut test);
        set(&mut test, |view| view.cards = Some(false));
        assert!(with > light(&mut test), "they show");
    }
    std::fs::remove_dir_all(&folder).expect("the folder goes");
}

#[test]
fn streaks_and_cards_take_out_the_light_that_the_account_gives_them() {
    if !gpu::available() {
        return;
    }
    // Radiances that bring the picture into the range of 8 bits.
    for (intensity, radiance) in [(5.0, 20.0), (25.0, 6.0), (100.0, 3.0)] {
        let mut test = aloft(intensity, radiance);
        test.frames(4, FRAME);
        // The quality settles as the budget says.
        test.leap(3);
        let camera = test.camera;
        let (mut both, mut near) = (0.0, 0.0);
        let mut kappa = 0.0;
        const SHOTS: u32 = 12;
        for shot in 0..SHOTS {
            // Another part of the field each time, and another direction.
            let angle = shot as f32 * core::f32::consts::TAU / SHOTS as f32;
            let eye = Vec3::new(90.0 * shot as f32, 80.0, 0.0);
            test.look(eye, eye + Vec3::new(10.0 * angle.sin(), 1.0, -10.0 * angle.cos()));
            set(&mut test, |view| view.cards = Some(true));
            test.frames(2, FRAME);
            both += light(&mut test) / f64::from(SHOTS);
            set(&mut test, |view| view.cards = Some(false));
            near += light(&mut test) / f64::from(SHOTS);
            kappa += test
                .world()
                .get::<RainViewFrame>(camera)
                .and_then(|frame| frame.shutter)
                .map_or(0.0, |shutter| f64::from(shutter.kappa))
                / f64::from(SHOTS);
        }
        let focal_px = test
            .world()
            .get::<RainViewFrame>(camera)
            .map_or(0.0, RainViewFrame::focal_px);
        let range = DrawRange {
            kappa,
            focal_px,
            exposure_s: 1.0 / 60.0,
        };
        let plan =
            LatticePlan::new(CardSettings::default().lattice, &StreakTextureSettings::default()).expect("a plan");
        let field = test.world().resource::<RainfallField>();
        let account = LatticeSharing::new(&plan, field.spectrum(), &range, 1.0).expect("an account");
        // Mean over the picture's lines of sight.
        let half = (core::f64::consts::FRAC_PI_8).tan();
        let (mut own, mut whole) = (0.0, 0.0);
        for row in 0..32 {
            for column in 0..32 {
                let at = |i: i32| half * (2.0 * (f64::from(i) + 0.5) / 32.0 - 1.0);
                let sight = bevy::math::DVec3::new(at(column), at(row) + 0.1, -1.0).normalize();
                let level = (1.0 - sight.y * sight.y).sqrt();
                let (single, carded) = (account.near_depth(100.0), account.card_depth(100.0, level));
                own += (1.0 - (-single).exp()) / 1024.0;
                whole += (1.0 - (-single - carded).exp()) / 1024.0;
            }
        }
        // Drops show 0.95 of an even light.
        let scale = f64::from(radiance) * 0.95;
        let (both, near) = (both / scale, near / scale);
        assert!(whole > 1.3 * own, "{intensity} mm/h: cards matter, {own} of {whole}");
        assert!(
            (near / own - 1.0).abs() < 0.05 && (both / whole - 1.0).abs() < 0.05,
            "{intensity} mm/h: streaks {near}, the account {own}; with cards {both}, the account {whole}"
        );
    }
}

#[test]
fn a_headlight_lights_the_rain_in_its_cone() {
    if !gpu::available() {
        return;
    }
    let mut test = aloft(50.0, 0.0);
    set(&mut test, |view| view.contrast = 8.0);
    test.frames(4, FRAME);
    assert_eq!(light(&mut test), 0.0, "no light, nothing to see");
    // Beside the eye, shining past it to the right.
    let lamp = test
        .world()
        .spawn((
            SpotLight {
                intensity: 4e7,
                range: 200.0,
                outer_angle: 0.2,
                inner_angle: 0.15,
                ..default()
            },
            Transform::from_xyz(0.6, 79.5, 0.5).looking_to(Vec3::new(0.35, 0.0, -1.0), Vec3::Y),
        ))
        .id();
    let halves = |test: &mut TestApp| {
        test.frames(2, FRAME);
        let picture = test.picture();
        let sum = |right: bool| -> f64 {
            picture
                .enumerate_pixels()
                .filter(|(x, _, _)| (*x >= SIZE / 2) == right)
                .map(|(_, _, pixel)| f64::from(Srgba::gamma_function(f32::from(pixel[1]) / 255.0)))
                .sum::<f64>()
                / f64::from(SIZE * SIZE / 2)
        };
        [sum(false), sum(true)]
    };
    let [left, right] = halves(&mut test);
    assert!(right > 0.002 && right > 20.0 * left, "{left} {right}");
    // Cards too, beyond the single drops.
    set(&mut test, |view| view.cards = Some(false));
    let [_, near] = halves(&mut test);
    assert!(near > 0.0 && near < 0.98 * right, "{near} of {right}");
    set(&mut test, |view| view.cards = Some(true));
    // Turned off it is dark again.
    test.world().entity_mut(lamp).insert(Visibility::Hidden);
    test.frames(2, FRAME);
    assert_eq!(light(&mut test), 0.0);
}
