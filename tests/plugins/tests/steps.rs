//! Steps in puddles: what they throw is seen, for half a second, also after the rain.

use bevy::prelude::*;
use image::RgbImage;
use rain_plugins::prelude::*;
use test_support::app::{FRAME, TestApp};
use test_support::gpu;

use crate::puddles::hollow;

/// Pixels in which two pictures differ.
fn different(a: &RgbImage, b: &RgbImage) -> usize {
    let off = |(a, b): &(&image::Rgb<u8>, &image::Rgb<u8>)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 3);
    a.pixels().zip(b.pixels()).filter(off).count()
}

/// A puddle after the rain, seen from near; no streaks, no rings.
fn after_rain() -> TestApp {
    let (mut test, weather) = hollow();
    let camera = test.camera;
    test.world()
        .entity_mut(camera)
        .remove::<PlanarReflection>()
        .insert(RainView {
            streak_budget: Some(1),
            ..default()
        });
    // Waves move the picture as well.
    test.world().insert_resource(WaveWaterSettings {
        no_waves: true,
        no_rings: true,
        ..default()
    });
    test.frames(3, FRAME);
    test.leap(2);
    test.world().entity_mut(weather).insert(Weather::rain(240.0));
    test.leap(300);
    test.world().entity_mut(weather).insert(Weather::rain(0.0));
    test.look(Vec3::new(0.0, 0.5, 1.4), Vec3::new(0.0, 0.05, 0.0));
    test.frames(10, FRAME);
    test
}

fn step(test: &mut TestApp, speed_m_s: f32) {
    test.world().write_message(FootStep {
        speed_m_s,
        ..FootStep::at(Vec3::new(0.0, -0.06, 0.0))
    });
}

#[test]
fn a_step_in_a_puddle_is_seen_to_splash_and_is_over_in_half_a_second() {
    if !gpu::available() {
        return;
    }
    let mut test = after_rain();
    // What changes by itself in that time: water dries.
    let before = test.picture();
    test.frames(38, FRAME);
    let still = test.picture();
    let drift = different(&still, &before);
    test.reset();
    test.frames(2, FRAME);
    assert_eq!(test.recorded(PassName::Splash), 0, "nobody steps");
    assert_eq!(test.skipped(PassName::Splash, SkipReason::NoRain), 2);
    test.reset();
    step(&mut test, 1.8);
    test.frames(5, FRAME);
    assert_eq!(test.recorded(PassName::Splash), 5);
    let thrown = test.picture();
    let strong = different(&thrown, &still);
    // The clock stands: so do the drops.
    assert_eq!(different(&test.picture(), &thrown), 0);
    let drawn = test.world().resource::<RainReport>().snapshot().splashes;
    assert!(
        drawn.iter().any(|count| *count > 30) && drawn.iter().all(|count| *count <= 64),
        "{drawn:?}"
    );
    test.frames(30, FRAME);
    test.reset();
    test.frames(3, FRAME);
    assert_eq!(test.recorded(PassName::Splash), 0, "all has landed");
    let over = test.picture();
    assert!(
        different(&over, &still) * 20 < strong + 40 * drift && drift * 4 < strong,
        "{} of {strong} stay, {drift} change by themselves",
        different(&over, &still)
    );
    // A gentler step throws less, and none is drawn where splashes are off.
    step(&mut test, 0.4);
    test.frames(5, FRAME);
    let gentle = different(&test.picture(), &over);
    assert!(
        strong > 60 && gentle * 3 < strong * 2 && gentle > 5,
        "{strong} strong, {gentle} gentle"
    );
    test.frames(40, FRAME);
    test.world().resource_mut::<SplashSettings>().enabled = false;
    test.reset();
    step(&mut test, 1.8);
    test.frames(5, FRAME);
    assert_eq!(test.recorded(PassName::Splash), 0);
    assert_eq!(test.skipped(PassName::Splash, SkipReason::Disabled), 5);
}
