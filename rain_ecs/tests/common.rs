//! An app that runs in frames of given lengths, and a street.

use std::time::Duration;

use bevy_app::App;
use bevy_math::DVec3;
use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy, Virtual};
use bevy_transform::TransformPlugin;
use rain_core::weather::{Keyframe, Timeline, Transition};
use rain_ecs::prelude::*;

pub const SECOND: u64 = 1_000_000_000;

/// An app whose clock has started.
pub fn app(clock: RainClock) -> App {
    let mut app = App::new();
    app.add_plugins((TimePlugin, TransformPlugin, RainEcsPlugin { clock }));
    // The first update only starts Bevy's clock; frames below carry their whole length.
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    app.world_mut()
        .resource_mut::<Time<Virtual>>()
        .set_max_delta(Duration::MAX);
    // Bevy's own fixed loop has nothing to do here; a frame of two hours would run it half a million times.
    app.insert_resource(Time::<Fixed>::from_seconds(1e6));
    app.update();
    app
}

pub fn frame(app: &mut App, ns: u64) {
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_nanos(ns)));
    app.update();
}

/// Frames of a steady rate: differences of rounded times, so that the last one ends exactly.
pub fn frames_at(hz: u64, seconds: u64) -> Vec<u64> {
    let time = |i: u64| (i * SECOND + hz / 2) / hz;
    (0..hz * seconds).map(|i| time(i + 1) - time(i)).collect()
}

/// Frames of 30 Hz, or of 4 Hz over long times.
pub fn run(app: &mut App, seconds: u64) {
    for ns in frames_at(if seconds < 100 { 30 } else { 4 }, seconds) {
        frame(app, ns);
    }
}

/// Two triangles over a rectangle that face up, heights by a function of the corners.
pub fn quad(low: [f64; 2], high: [f64; 2], y: impl Fn(f64, f64) -> f64) -> Vec<[DVec3; 3]> {
    let p = |x: f64, z: f64| DVec3::new(x, y(x, z), z);
    let (a, b) = (p(low[0], low[1]), p(high[0], low[1]));
    let (c, d) = (p(high[0], high[1]), p(low[0], high[1]));
    vec![[a, d, c], [a, c, b]]
}

/// Height of the street below: falls by 2 % along x, a bowl of 0.15 m around (8, 4).
pub fn street_height(x: f64, z: f64) -> f64 {
    let r2 = ((x - 8.0) * (x - 8.0) + (z - 4.0) * (z - 4.0)) / 4.0;
    0.02 * (16.0 - x) - 0.15 * (1.0 - r2).max(0.0)
}

/// Puts in a street of 16 × 10 m: asphalt with a bowl, lawn along z > 8, a roof over x > 12, z < 5.
pub fn add_street(app: &mut App) {
    let mut road = Vec::new();
    for i in 0..32 {
        for j in 0..16 {
            let (x, z) = (f64::from(i) * 0.5, f64::from(j) * 0.5);
            road.extend(quad([x, z], [x + 0.5, z + 0.5], street_height));
        }
    }
    let lawn = quad([0.0, 8.0], [16.0, 10.0], |x, _| 0.02 * (16.0 - x) + 0.1);
    let roof = quad([12.0, 0.0], [15.5, 5.0], |_, _| 4.0);
    let mut scene = app.world_mut().resource_mut::<SurfaceScene>();
    scene.set(1, &road, SurfaceClass::Asphalt, true);
    scene.set(2, &lawn, SurfaceClass::Grass, true);
    scene.set(3, &roof, SurfaceClass::Roof, true);
    let mut cover = app.world_mut().resource_mut::<CoverField>();
    for (owner, triangles) in [(1, &road), (2, &lawn), (3, &roof)] {
        cover.set(owner, triangles, true).expect("fits");
    }
}

/// Weather that changes linearly through (time s, mm/h, wind m/s along x, W/m²).
pub fn weather(keys: &[[f64; 4]]) -> WeatherTimeline {
    let keyframe = |&[time_s, intensity_mm_h, wind, net_radiation_w_m2]: &[f64; 4]| Keyframe {
        time_s,
        conditions: WeatherConditions {
            intensity_mm_h,
            wind_m_s: DVec3::X * wind,
            net_radiation_w_m2,
            ..WeatherConditions::default()
        },
        transition: Transition::Linear,
    };
    WeatherTimeline::new(Timeline::new(keys.iter().map(keyframe).collect()).expect("valid"))
}
