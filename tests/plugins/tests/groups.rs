//! Plugins alone, left out of the group, and without a renderer.

use std::time::Duration;

use bevy::prelude::*;
use bevy::time::TimeUpdateStrategy;
use rain_plugins::prelude::*;
use rain_plugins::scenario::headless;
use test_support::app::{FRAME, spawn_camera, target_image};
use test_support::{gpu, world};

use crate::puddles::hollow_ground;

const SIZE: [u32; 2] = [96, 54];

#[test]
fn a_server_without_a_renderer_simulates_the_weather() {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, RainPlugins));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(FRAME));
    app.world_mut().spawn(Weather::rain(25.0));
    for _ in 0..120 {
        app.update();
    }
    assert_eq!(
        *app.world().resource::<RainRenderStatus>(),
        RainRenderStatus::NoRenderer
    );
    assert!(app.world().resource::<RainfallField>().is_raining());
    let fallen = app
        .world_mut()
        .query::<&WeatherState>()
        .single(app.world())
        .expect("one weather")
        .rain_mm();
    // Two seconds, up to a tick, of 25 mm/h.
    assert!((fallen - 25.0 / 1800.0).abs() < 25.0 / 3600.0 / 16.0, "{fallen} mm");
}

/// Rain passes recorded in three frames of an app with these plugins, and cover passes.
fn recorded(plugins: impl FnOnce(&mut App)) -> (u64, u64) {
    let mut app = App::new();
    app.add_plugins(headless::plugins());
    plugins(&mut app);
    headless::finish(&mut app);
    let target = target_image(&mut app, SIZE);
    spawn_camera(&mut app, &target, true);
    world::ground(app.world_mut());
    app.world_mut().spawn(Weather::rain(25.0));
    for _ in 0..12 {
        headless::step(&mut app, FRAME).expect("the renderer goes on");
    }
    let report = app.world().resource::<RainReport>();
    (
        report.recorded_frames(PassName::Rainfall),
        report.recorded_frames(PassName::Cover),
    )
}

#[test]
fn it_rains_without_wet_surfaces_and_without_cover() {
    if !gpu::available() {
        return;
    }
    let (rain, cover) = recorded(|app: &mut App| {
        app.add_plugins(RainPlugins.build().disable::<WetSurfacePlugin>());
    });
    assert!(
        rain > 5 && cover > 0,
        "without wet surfaces: {rain} rain, {cover} cover"
    );
    let (rain, cover) = recorded(|app: &mut App| {
        app.add_plugins(RainPlugins.build().disable::<CoverPlugin>());
    });
    assert!(rain > 5 && cover == 0, "without cover: {rain} rain, {cover} cover");
    let (rain, cover) = recorded(|app: &mut App| {
        app.add_plugins(RainPlugins.build().disable::<RainfallPlugin>());
    });
    assert!(rain == 0 && cover > 0, "without near rain: {rain} rain, {cover} cover");
}

#[test]
fn core_effects_are_on_whenever_it_rains() {
    if !gpu::available() {
        return;
    }
    // Passes recorded and meshes that got wet, with nothing but the plugins, a camera and this weather.
    let seen = |weather: Weather| {
        let mut app = App::new();
        app.add_plugins((headless::plugins(), RainPlugins));
        headless::finish(&mut app);
        let target = target_image(&mut app, SIZE);
        spawn_camera(&mut app, &target, true);
        // Ground with a hollow: rings need water to be on.
        let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(hollow_ground());
        let mut materials = app.world_mut().resource_mut::<Assets<StandardMaterial>>();
        let material = materials.add(StandardMaterial::default());
        app.world_mut().spawn((Mesh3d(mesh), MeshMaterial3d(material)));
        app.world_mut().spawn(weather);
        let mut go = |frames: u32, each: Duration| {
            for _ in 0..frames {
                headless::step(&mut app, each).expect("the renderer goes on");
            }
        };
        go(3, FRAME);
        go(1, Duration::from_secs(2));
        go(3, FRAME);
        go(1, Duration::from_secs(1200));
        go(8, FRAME);
        let mut wet = app.world_mut().query::<&rain_plugins::surface::DryMaterial>();
        let wet = wet.iter(app.world()).count() as u64;
        let report = app.world().resource::<RainReport>();
        let passes = [PassName::Cover, PassName::Rainfall, PassName::Ripples];
        (passes.map(|pass| report.recorded_frames(pass)), wet)
    };
    let (passes, wet) = seen(Weather::rain(60.0));
    assert!(
        passes.iter().all(|frames| *frames > 0) && wet == 1,
        "cover, drops, ripples {passes:?}; {wet} wet meshes"
    );
    assert_eq!(seen(Weather::rain(0.0)), ([0; 3], 0), "none while it is dry");
}
