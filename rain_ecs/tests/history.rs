//! Samples of the past: when, what, how many.

use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy, Virtual};
use rain_core::weather::SurfaceClass;
use rain_ecs::prelude::*;

use crate::common::{SECOND, add_street, app, frame, run, weather};

fn recorded(interval_s: f64, capacity: usize) -> bevy_app::App {
    let mut app = app(RainClock::default());
    app.insert_resource(RainHistory::new(interval_s, capacity).expect("in its domain"))
        .add_plugins(RainHistoryPlugin);
    add_street(&mut app);
    app.world_mut().spawn(weather(&[
        [0.0, 0.0, 0.0, 0.0],
        [20.0, 80.0, 0.0, 0.0],
        [40.0, 0.0, 0.0, 300.0],
    ]));
    app
}

#[test]
fn samples_are_what_the_world_was_and_the_oldest_go_first() {
    let mut app = recorded(1.0, 8);
    run(&mut app, 25);
    let history = app.world().resource::<RainHistory>();
    assert_eq!(history.samples().len(), 8);
    let times: Vec<f64> = history.samples().map(|s| s.time_s).collect();
    assert!(times.windows(2).all(|w| w[1] - w[0] == 1.0), "{times:?}");
    let latest = history.latest().expect("a sample");
    assert!(latest.time_s > 23.9 && latest.time_s <= 25.0, "{latest:?}");
    // The rate falls from 80 at 20 s by 4 mm/h each second.
    for sample in history.samples() {
        let rate = if sample.time_s <= 20.0 {
            4.0 * sample.time_s
        } else {
            160.0 - 4.0 * sample.time_s
        };
        assert!((sample.rain_mm_h - rate).abs() < 0.1, "{sample:?}, {rate}");
        assert!(sample.visibility_m > 100.0 && sample.visibility_m < 1e4);
        let ledger = sample.ledger.expect("a ground");
        assert!(ledger.residual_relative < 1e-12);
        // Rain over the whole map (16 × 10 m) since the ground was built, less than since the start.
        let rain_mm = ledger.rain_m3 / sample.m3_per_mm;
        assert!(rain_mm > 0.0 && rain_mm <= 80.0 * 40.0 / 3600.0);
    }
    let wetness: Vec<f64> = history
        .samples()
        .map(|s| s.wetness[SurfaceClass::Asphalt.index()])
        .collect();
    assert!(
        wetness.windows(2).all(|w| w[1] >= w[0]) && wetness[7] > 0.0,
        "{wetness:?}"
    );
}

#[test]
fn every_tick_when_asked_and_nothing_from_a_future_that_was_undone() {
    let mut app = recorded(0.0, 1000);
    run(&mut app, 4);
    let saved = RainSnapshot::save(app.world()).expect("can be written");
    let ticks = app.world().resource::<RainClock>().ticks();
    assert_eq!(app.world().resource::<RainHistory>().samples().len() as u64, ticks);
    let latest = *app.world().resource::<RainHistory>().latest().expect("a sample");
    assert_eq!(latest.time_s, app.world().resource::<RainClock>().now_s());
    assert_eq!(latest.ledger, Some(app.world().resource::<SurfaceGround>().ledger()));
    let before: Vec<HistorySample> = app.world().resource::<RainHistory>().samples().copied().collect();
    run(&mut app, 3);
    saved.restore(app.world_mut()).expect("fits");
    frame(&mut app, SECOND / 32);
    let history = app.world().resource::<RainHistory>();
    assert_eq!(history.samples().len(), before.len() + 1);
    assert!(history.samples().zip(&before).all(|(a, b)| a == b));
    assert!(history.latest().expect("a sample").time_s > before[before.len() - 1].time_s);
}

#[test]
fn the_state_is_the_same_with_and_without_a_history() {
    let mut with = recorded(0.25, 4);
    let mut without = app(RainClock::default());
    add_street(&mut without);
    without.world_mut().spawn(weather(&[
        [0.0, 0.0, 0.0, 0.0],
        [20.0, 80.0, 0.0, 0.0],
        [40.0, 0.0, 0.0, 300.0],
    ]));
    for app in [&mut with, &mut without] {
        run(app, 10);
    }
    assert_eq!(state_hash(with.world()), state_hash(without.world()));
}

#[test]
fn without_weather_there_is_nothing_to_sample_and_bad_settings_are_refused() {
    let mut app = bevy_app::App::new();
    app.add_plugins((TimePlugin, RainEcsPlugin::default(), RainHistoryPlugin));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(std::time::Duration::ZERO));
    app.insert_resource(Time::<Fixed>::from_seconds(1e6));
    app.world_mut()
        .resource_mut::<Time<Virtual>>()
        .set_max_delta(std::time::Duration::MAX);
    app.update();
    frame(&mut app, 5 * SECOND);
    let history = app.world().resource::<RainHistory>();
    assert_eq!(history.samples().len(), 0);
    assert_eq!((history.interval_s(), history.capacity()), (1.0, 600));

    for (interval_s, capacity) in [(-1.0, 10), (f64::NAN, 10), (1e7, 10), (1.0, 1), (1.0, 2_000_000)] {
        assert!(
            RainHistory::new(interval_s, capacity).is_err(),
            "{interval_s} {capacity}"
        );
    }
    let mut history = RainHistory::new(1.0, 2).expect("in its domain");
    history.clear();
    assert!(history.latest().is_none());
}
