//! A time for each frame is held by drawing less rain.

use std::time::Duration;

use bevy::prelude::*;
use bevy::render::diagnostic::RenderDiagnosticsPlugin;
use rain_plugins::prelude::*;
use rain_plugins::rainfall::RainViewFrame;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

fn storm(add: impl FnOnce(&mut App)) -> TestApp {
    let mut test = TestApp::with([96, 54], true, add);
    world::without_ground(test.world());
    test.world().spawn(Weather::rain(50.0));
    test.frames(3, FRAME);
    test.leap(2);
    test
}

fn share(test: &mut TestApp) -> f64 {
    test.world().resource::<RainShare>().share()
}

/// Drops that the view draws singly.
fn drops(test: &mut TestApp) -> f64 {
    let camera = test.camera;
    let frame = test.world().get::<RainViewFrame>(camera).expect("a rain view");
    frame.drops().records.len() as f64
}

/// Frames whose times follow from the share, as on a machine whose frames take `base_ms` and at most `rain_ms` more.
fn play(test: &mut TestApp, frames: u32, base_ms: f64, rain_ms: f64) -> Vec<f64> {
    let mut shares = Vec::new();
    for _ in 0..frames {
        let took_ms = base_ms + rain_ms * share(test);
        test.frames(1, Duration::from_secs_f64(took_ms / 1e3));
        shares.push(share(test));
    }
    shares
}

#[test]
fn a_frame_budget_is_held_by_fewer_drops_and_a_passing_load_leaves_no_trace() {
    if !gpu::available() {
        return;
    }
    let mut test = storm(|_| {});
    play(&mut test, 30, 50.0, 100.0);
    let (all, full) = (drops(&mut test), share(&mut test));
    assert!(full == 1.0 && all > 5_000.0, "{full}, {all} drops without a budget");

    test.world().insert_resource(RainFrameBudget::of_frame(100.0));
    let shares = play(&mut test, 250, 50.0, 100.0);
    let settled = shares[249];
    assert!(shares[200..].iter().all(|share| *share == settled), "{shares:?}");
    let took_ms = 50.0 + 100.0 * settled;
    assert!((90.0..=100.0).contains(&took_ms), "{took_ms} ms");
    let fewer = drops(&mut test) / all;
    assert!(
        (fewer / settled - 1.0).abs() < 0.1,
        "{fewer} of the drops, share {settled}"
    );

    // A load of its own, then none.
    let loaded = play(&mut test, 200, 85.0, 100.0);
    assert!(85.0 + 100.0 * loaded[199] <= 100.0, "{loaded:?}");
    let after = play(&mut test, 400, 20.0, 60.0);
    assert_eq!(after[399], 1.0, "{after:?}");
    let again = drops(&mut test) / all;
    assert!((again - 1.0).abs() < 0.05, "{again} of the drops again");

    // Without a budget all is drawn, however long frames take.
    test.world().insert_resource(RainFrameBudget::default());
    let free = play(&mut test, 40, 300.0, 100.0);
    assert!(free.iter().all(|share| *share == 1.0), "{free:?}");
}

#[test]
fn the_time_of_rain_passes_is_what_the_gpu_says() {
    if !gpu::available() {
        return;
    }
    let mut test = storm(|app| {
        app.add_plugins(RenderDiagnosticsPlugin);
    });
    // No pass of 20 000 streaks takes as little, none as long.
    test.world().insert_resource(RainFrameBudget {
        least: 0.5,
        ..RainFrameBudget::of_rain_passes(0.1)
    });
    let mut frames = 0;
    while share(&mut test) > 0.5 && frames < 2_000 {
        test.frames(20, FRAME);
        frames += 20;
    }
    assert_eq!(share(&mut test), 0.5, "after {frames} frames");
    let took = test.world().resource::<RainShare>().median_ms();
    assert!(took.is_some_and(|ms| ms > 0.1), "{took:?}");
    test.world().insert_resource(RainFrameBudget::of_rain_passes(10_000.0));
    while share(&mut test) < 1.0 && frames < 6_000 {
        test.frames(20, FRAME);
        frames += 20;
    }
    assert_eq!(share(&mut test), 1.0, "after {frames} frames");
}

#[test]
fn without_times_of_passes_nothing_changes() {
    if !gpu::available() {
        return;
    }
    let mut test = storm(|_| {});
    test.world().insert_resource(RainFrameBudget::of_rain_passes(0.1));
    test.frames(90, FRAME);
    assert_eq!(share(&mut test), 1.0);
    assert_eq!(test.world().resource::<RainShare>().median_ms(), None);
}
