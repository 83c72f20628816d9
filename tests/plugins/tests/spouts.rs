//! Water that pours from an eave and a pipe: seen in the rain and after it, and free when there is none.

use bevy::prelude::*;
use image::RgbImage;
use rain_plugins::prelude::*;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

const SIZE: [u32; 2] = [240, 135];

/// Open ground, an eave of 2 m at a height of 3 m across the view and a pipe beside it; no streaks.
fn scene(spouts: bool) -> (TestApp, Entity) {
    let mut test = TestApp::new(SIZE, true);
    world::ground(test.world());
    let weather = test.world().spawn(Weather::rain(100.0)).id();
    if spouts {
        let eave = Transform::from_xyz(-0.6, 3.0, 8.0).looking_to(Vec3::Z, Vec3::Y);
        test.world().spawn((eave, Spout::eave(2.0, 6.0)));
        let pipe = Transform::from_xyz(1.4, 2.5, 7.6).looking_to(Vec3::Z, Vec3::Y);
        test.world().spawn((pipe, Spout::pipe(0.1, 60.0)));
    }
    let camera = test.camera;
    test.world().entity_mut(camera).insert(RainView {
        streak_budget: Some(1),
        contrast: 4.0,
        ..default()
    });
    test.look(Vec3::new(0.0, 1.5, 12.0), Vec3::new(0.0, 1.3, 8.0));
    test.frames(3, FRAME);
    (test, weather)
}

/// Pixels of a part of the picture in which two pictures differ.
fn different(a: &RgbImage, b: &RgbImage, columns: core::ops::Range<u32>, rows: core::ops::Range<u32>) -> usize {
    let mut count = 0;
    for y in rows {
        for x in columns.clone() {
            let (a, b) = (a.get_pixel(x, y).0, b.get_pixel(x, y).0);
            count += usize::from(a.iter().zip(b).any(|(a, b)| a.abs_diff(b) > 3));
        }
    }
    count
}

#[test]
fn an_eave_curtains_a_pipe_pours_and_both_drip_after_the_rain() {
    if !gpu::available() {
        return;
    }
    let [(mut with, weather), (mut without, _)] = [true, false].map(scene);
    for test in [&mut with, &mut without] {
        test.leap(240);
        test.frames(4, FRAME);
    }
    let pouring = with.picture();
    let drips = |test: &mut TestApp| test.world().resource::<RainReport>().snapshot().drips.back().copied();
    let falling = drips(&mut with);
    assert!(falling.is_some_and(|count| count > 500), "{falling:?}");
    assert_eq!(drips(&mut without), None);
    let plain = without.picture();
    // Above the horizon nothing but what pours differs: left the eave's curtain, right the pipe's stream.
    let horizon = 0..60;
    let curtain = different(&pouring, &plain, 40..120, horizon.clone());
    let stream = different(&pouring, &plain, 140..190, horizon.clone());
    let beside = different(&pouring, &plain, 0..30, horizon.clone());
    assert!(curtain > 150 && stream > 15, "{curtain} {stream}");
    assert_eq!(beside, 0, "nothing pours there");
    // The clock stands: so does the water.
    assert_eq!(different(&with.picture(), &pouring, 0..240, 0..135), 0);
    with.frames(1, FRAME);
    assert!(
        different(&with.picture(), &pouring, 40..120, horizon.clone()) > 40,
        "it falls"
    );

    // Two minutes after the rain it drips.
    with.world().entity_mut(weather).insert(Weather::rain(0.0));
    with.leap(120);
    with.reset();
    with.frames(4, FRAME);
    assert_eq!(with.recorded(PassName::Splash), 4);
    assert!(drips(&mut with) < falling.map(|count| count / 4));
    let mut moved = 0;
    let mut before = with.picture();
    for _ in 0..8 {
        with.frames(2, FRAME);
        let now = with.picture();
        moved += different(&now, &before, 40..190, horizon.clone());
        before = now;
    }
    assert!(moved > 8 && moved < 8 * curtain, "{moved} of {curtain}");
    // Off with the splashes.
    with.world().resource_mut::<SplashSettings>().enabled = false;
    with.frames(1, FRAME);
    with.reset();
    with.frames(3, FRAME);
    assert_eq!(with.recorded(PassName::Splash), 0);
    with.world().resource_mut::<SplashSettings>().enabled = true;
    // Far away it is not drawn, and there is nothing else to draw.
    with.look(Vec3::new(0.0, 1.5, 80.0), Vec3::new(0.0, 1.3, 90.0));
    with.frames(1, FRAME);
    with.reset();
    with.frames(3, FRAME);
    assert_eq!(with.skipped(PassName::Splash, SkipReason::NoRain), 3);
}
