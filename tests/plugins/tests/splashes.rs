//! Splashes in a Bevy app: where they show, when they are skipped, and what they leave alone.

use bevy::prelude::*;
use image::RgbImage;
use rain_plugins::prelude::*;
use rain_plugins::surface::WaterLevels;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

use crate::puddles::hollow;

const SIZE: [u32; 2] = [160, 90];

/// Ground and roof in a rain; nearly no streaks, so that what differs is splashes.
fn scene(intensity_mm_h: f64, splashes: bool) -> TestApp {
    let mut test = TestApp::new(SIZE, true);
    world::ground(test.world());
    world::roof(test.world());
    test.world().spawn(Weather::rain(intensity_mm_h));
    let camera = test.camera;
    test.world().entity_mut(camera).insert(RainView {
        streak_budget: Some(1),
        contrast: 8.0,
        ..default()
    });
    test.world().resource_mut::<SplashSettings>().enabled = splashes;
    test
}

/// Pixels in which two pictures differ.
fn different(a: &RgbImage, b: &RgbImage) -> usize {
    let off = |(a, b): &(&image::Rgb<u8>, &image::Rgb<u8>)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 2);
    a.pixels().zip(b.pixels()).filter(off).count()
}

/// Pixels that splashes change in three moments of a view.
fn shown(intensity_mm_h: f64, eye: Vec3, target: Vec3) -> usize {
    let [mut with, mut without] = [true, false].map(|splashes| scene(intensity_mm_h, splashes));
    let mut sum = 0;
    for test in [&mut with, &mut without] {
        test.look(eye, target);
        test.frames(12, FRAME);
    }
    for _ in 0..3 {
        sum += different(&with.picture(), &without.picture());
        with.frames(7, FRAME);
        without.frames(7, FRAME);
    }
    sum
}

#[test]
fn splashes_show_on_open_ground_and_on_roofs_and_not_under_them() {
    if !gpu::available() {
        return;
    }
    let open = shown(50.0, Vec3::new(0.0, 0.6, 12.0), Vec3::new(0.0, 0.0, 10.5));
    assert!(open > 100, "{open} on open ground");
    let roof = shown(50.0, Vec3::new(0.0, 5.0, 1.5), Vec3::new(0.0, 4.1, 0.0));
    assert!(roof > 100, "{roof} on the roof");
    let under = shown(50.0, Vec3::new(0.0, 0.6, 1.5), Vec3::new(0.0, 0.0, 1.2));
    assert_eq!(under, 0, "under the roof");
    let drizzle = shown(0.5, Vec3::new(0.0, 0.6, 12.0), Vec3::new(0.0, 0.0, 10.5));
    assert!(10 * drizzle < open, "{drizzle} in drizzle, {open} in a downpour");
}

#[test]
fn splashes_are_skipped_with_a_reason_and_recorded_otherwise() {
    if !gpu::available() {
        return;
    }
    let eye = (Vec3::new(0.0, 1.0, 12.0), Vec3::new(0.0, 0.0, 8.0));
    let mut test = scene(50.0, true);
    test.look(eye.0, eye.1);
    test.frames(20, FRAME);
    test.reset();
    test.frames(10, FRAME);
    assert_eq!(test.recorded(PassName::Splash), 10);
    let memory = test.app.world().resource::<RainReport>().snapshot().gpu_memory_bytes;

    let settings = |test: &mut TestApp, edit: &dyn Fn(&mut SplashSettings)| {
        edit(&mut test.world().resource_mut::<SplashSettings>());
        test.frames(2, FRAME);
        test.reset();
        test.frames(5, FRAME);
    };
    settings(&mut test, &|s| s.budget = Some(0));
    assert_eq!(test.skipped(PassName::Splash, SkipReason::Disabled), 5, "no budget");
    settings(&mut test, &|s| s.budget = None);
    assert_eq!(test.recorded(PassName::Splash), 5);
    // A bad value leaves the last good ones in force.
    settings(&mut test, &|s| s.distance_m = f32::NAN);
    assert_eq!(test.recorded(PassName::Splash), 5);
    settings(&mut test, &|s| {
        *s = SplashSettings {
            enabled: false,
            ..default()
        }
    });
    assert_eq!(test.skipped(PassName::Splash, SkipReason::Disabled), 5, "off");
    assert!(memory > 1_000_000 && memory < 64 << 20, "{memory}");

    let mut dry = scene(0.0, true);
    dry.frames(10, FRAME);
    assert_eq!(
        (
            dry.recorded(PassName::Splash),
            dry.skipped(PassName::Splash, SkipReason::NoRain)
        ),
        (0, 10)
    );

    let mut empty = TestApp::new(SIZE, true);
    empty.world().spawn(Weather::rain(50.0));
    let camera = empty.camera;
    empty.world().entity_mut(camera).remove::<RainView>();
    empty.frames(4, FRAME);
    assert_eq!(empty.skipped(PassName::Splash, SkipReason::NoView), 4);
}

#[test]
fn an_eye_in_a_closed_room_records_no_splash() {
    if !gpu::available() {
        return;
    }
    let mut test = TestApp::new(SIZE, true);
    world::ground(test.world());
    world::room(test.world());
    test.world().spawn(Weather::rain(50.0));
    test.look(Vec3::new(0.0, 1.5, 1.5), Vec3::new(0.0, 1.5, -3.0));
    test.frames(10, FRAME);
    test.reset();
    test.frames(10, FRAME);
    assert_eq!(test.recorded(PassName::Splash), 0);
    assert_eq!(test.skipped(PassName::Splash, SkipReason::Indoors), 10);
}

#[test]
fn splashes_leave_the_water_of_a_puddle_still() {
    if !gpu::available() {
        return;
    }
    let (mut test, weather) = hollow();
    let camera = test.camera;
    test.world().entity_mut(camera).insert(RainView::default());
    // The ground is built from the mesh before it rains.
    test.frames(3, FRAME);
    test.leap(2);
    test.world().entity_mut(weather).insert(Weather::rain(60.0));
    test.leap(1200);
    test.frames(30, FRAME);
    let level = test.world().resource::<WaterLevels>().surface_at(0.0, 0.0);
    let level = level.expect("a puddle in the hollow");
    test.reset();
    test.frames(30, FRAME);
    assert_eq!(test.recorded(PassName::Splash), 30);
    assert_eq!(test.recorded(PassName::Waves), 0);
    assert_eq!(test.skipped(PassName::Waves, SkipReason::Calm), 30);
    // What does disturb it is seen.
    let foot = WaterDisturber {
        radius_m: 0.05,
        ..default()
    };
    let foot = test.world().spawn((foot, Transform::from_xyz(0.0, level, 0.0))).id();
    test.frames(3, FRAME);
    for step in 1..4_u8 {
        let at = Transform::from_xyz(0.1 * f32::from(step), level, 0.0);
        test.world().entity_mut(foot).insert(at);
        test.frames(1, FRAME);
    }
    assert!(test.recorded(PassName::Waves) > 0);
}

/// Linear light that splashes add to a picture, from the sum over pixels that they brighten.
fn added(with: &RgbImage, without: &RgbImage) -> f64 {
    let linear = |v: u8| f64::from(Srgba::gamma_function(f32::from(v) / 255.0));
    let more = |(a, b): (&image::Rgb<u8>, &image::Rgb<u8>)| (linear(a.0[1]) - linear(b.0[1])).max(0.0);
    with.pixels().zip(without.pixels()).map(more).sum()
}

#[test]
fn at_night_splashes_show_under_a_street_lamp_and_hardly_away_from_it() {
    if !gpu::available() {
        return;
    }
    // The lamp is low, before the eye, and lights no ground: what is seen of it is on splashes.
    let light = |lumens: f32, x: f32| -> [f64; 2] {
        let mut pictures = Vec::new();
        let mut moments = [0.0, 0.0];
        for splashes in [true, false] {
            let mut test = scene(50.0, splashes);
            test.world().insert_resource(GlobalAmbientLight {
                brightness: 0.0,
                ..default()
            });
            let suns: Vec<Entity> = test
                .world()
                .query_filtered::<Entity, With<DirectionalLight>>()
                .iter(test.world())
                .collect();
            for sun in suns {
                test.world().despawn(sun);
            }
            test.world().insert_resource(ClearColor(Color::BLACK));
            test.world().spawn((
                PointLight {
                    intensity: lumens,
                    range: 8.0,
                    ..default()
                },
                Transform::from_xyz(0.0, 1.5, 8.0),
            ));
            test.look(Vec3::new(x, 0.6, 12.0), Vec3::new(x, 0.0, 10.0));
            test.frames(12, FRAME);
            let first = test.picture();
            test.frames(7, FRAME);
            pictures.push([first, test.picture()]);
        }
        for (i, moment) in moments.iter_mut().enumerate() {
            *moment = added(&pictures[0][i], &pictures[1][i]);
        }
        moments
    };
    let sum = |moments: [f64; 2]| moments[0] + moments[1];
    let (under, away) = (sum(light(4e5, 0.0)), sum(light(4e5, 14.0)));
    let dark = sum(light(0.0, 0.0));
    assert!(
        under > 1.0 && away < 0.02 * under,
        "{under} under the lamp, {away} away from it"
    );
    assert!(dark < 0.02 * under, "{dark} with the lamp off");
}

#[test]
fn the_report_counts_what_the_gpu_drew() {
    if !gpu::available() {
        return;
    }
    let counts = |intensity_mm_h: f64| {
        let mut test = scene(intensity_mm_h, true);
        test.world().resource_mut::<SplashSettings>().budget = Some(2_000);
        test.look(Vec3::new(0.0, 1.0, 12.0), Vec3::new(0.0, 0.0, 20.0));
        test.frames(12, FRAME);
        test.reset();
        test.frames(20, FRAME);
        let report = test.world().resource::<RainReport>().snapshot();
        report.splashes.into_iter().collect::<Vec<u32>>()
    };
    let heavy = counts(50.0);
    // A frame's count may come with the next.
    assert!((19..=21).contains(&heavy.len()), "{heavy:?}");
    assert!(
        heavy.iter().all(|count| (200..=2 * 2_000 + 1024).contains(count)),
        "{heavy:?}"
    );
    let drizzle = counts(1.0);
    let sum = |counts: &[u32]| counts.iter().sum::<u32>();
    assert!(sum(&drizzle) > 0 && 3 * sum(&drizzle) < sum(&heavy), "{drizzle:?}");
    assert!(counts(0.0).is_empty());
}
