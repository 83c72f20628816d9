//! Rain areas: where it rains, for everybody who asks; closed ledgers; nothing without an area.

use bevy_app::App;
use bevy_ecs::message::Messages;
use bevy_ecs::system::RunSystemOnce;
use bevy_math::{DVec2, DVec3, Vec3};
use bevy_time::TimePlugin;
use bevy_transform::TransformPlugin;
use bevy_transform::components::Transform;
use rain_core::surface::ground::WaterAt;
use rain_ecs::prelude::*;

use crate::common::{SECOND, add_street, app, frame, frames_at, run, street_height};

fn disc(x: f64, z: f64, radius_m: f64, rain: AreaRain) -> AreaSettings {
    AreaSettings {
        centre_m: DVec2::new(x, z),
        shape: AreaShape::Circle { radius_m },
        rain,
        transition_m: 0.0,
        ..AreaSettings::default()
    }
}

fn water(app: &App, x: f64, z: f64) -> WaterAt {
    let ground = app.world().resource::<SurfaceGround>().ground().expect("built");
    ground.water_at(DVec3::new(x, street_height(x, z), z))
}

fn asked<T: Send + Sync + 'static>(app: &mut App, f: impl Fn(&RainQueries) -> T + Send + Sync + 'static) -> T {
    app.world_mut()
        .run_system_once(move |queries: RainQueries| f(&queries))
        .expect("runs")
}

/// A street whose ground is built, under this weather.
fn street(rain_mm_h: f64) -> App {
    let mut app = app(RainClock::default());
    add_street(&mut app);
    app.world_mut().resource_mut::<SurfaceSettings>().settle_ticks = 0;
    app.world_mut().spawn(Weather {
        net_radiation_w_m2: 0.0,
        ..Weather::rain(rain_mm_h)
    });
    app
}

#[test]
fn without_an_area_the_state_is_that_of_a_world_without_the_plugin() {
    let with = {
        let mut app = street(30.0);
        run(&mut app, 20);
        app
    };
    let mut without = App::new();
    without.add_plugins((
        TimePlugin,
        TransformPlugin,
        RainClockPlugin::default(),
        WeatherPlugin,
        RainfallFieldPlugin,
        CoverFieldPlugin,
        SurfaceGroundPlugin,
        SpoutPlugin,
        FootSplashPlugin,
    ));
    without.insert_resource(bevy_time::TimeUpdateStrategy::ManualDuration(std::time::Duration::ZERO));
    without
        .world_mut()
        .resource_mut::<bevy_time::Time<bevy_time::Virtual>>()
        .set_max_delta(std::time::Duration::MAX);
    without.insert_resource(bevy_time::Time::<bevy_time::Fixed>::from_seconds(1e6));
    without.update();
    add_street(&mut without);
    without.world_mut().resource_mut::<SurfaceSettings>().settle_ticks = 0;
    without.world_mut().spawn(Weather {
        net_radiation_w_m2: 0.0,
        ..Weather::rain(30.0)
    });
    run(&mut without, 20);
    assert_eq!(state_hash(with.world()), state_hash(without.world()));
    assert!(water(&with, 3.1, 4.1).saturation > 0.0, "or nothing was compared");
    // With one it differs.
    let mut other = street(30.0);
    other
        .world_mut()
        .spawn(RainArea(disc(3.0, 3.0, 2.0, AreaRain::Rate(60.0))));
    run(&mut other, 20);
    assert_ne!(state_hash(with.world()), state_hash(other.world()));
}

#[test]
fn it_rains_in_the_area_for_everybody_who_asks() {
    let mut app = street(0.0);
    app.world_mut()
        .spawn(RainArea(disc(4.0, 4.0, 3.0, AreaRain::Rate(60.0))));
    let object = |app: &mut App, x: f32| {
        let place = Transform::from_xyz(x, 0.5, 4.0);
        app.world_mut().spawn((place, DynamicWetness::default())).id()
    };
    let (inside, outside) = (object(&mut app, 4.0), object(&mut app, 10.0));
    run(&mut app, 120);
    let (in_it, beside) = (Vec3::new(4.0, 1.0, 4.0), Vec3::new(10.0, 1.0, 4.0));
    assert_eq!(
        asked(&mut app, move |q| [q.rain_at(in_it), q.rain_at(beside)]),
        [60.0, 0.0]
    );
    assert_eq!(asked(&mut app, |q| q.rain_at(Vec3::NAN)), 0.0);
    let [near, far, all] = asked(&mut app, move |q| {
        [q.visibility_at(in_it), q.visibility_at(beside), q.visibility_m()]
    });
    assert!(near < 2000.0 && far == 1e9 && all == 1e9, "{near} {far} {all}");
    // Across the area some light is lost, beside it none; twice as far through it is squared.
    let through =
        |x0: f32, x1: f32, z: f32| move |q: &RainQueries| q.seen_through(Vec3::new(x0, 1.0, z), Vec3::new(x1, 1.0, z));
    let across = asked(&mut app, through(-5.0, 15.0, 4.0));
    assert!(across < 1.0 && across > 0.95, "{across}");
    assert_eq!(asked(&mut app, through(-5.0, 15.0, 9.0)), 1.0);
    let half = asked(&mut app, through(-5.0, 4.0, 4.0));
    assert!((half * half / across - 1.0).abs() < 1e-5, "{half} {across}");
    // The ground, the objects.
    assert!(water(&app, 4.1, 4.1).film_mm > 0.1 && water(&app, 10.1, 4.1).saturation == 0.0);
    let wetness = |entity| app.world().get::<DynamicWetness>(entity).expect("there").wetness();
    assert!(
        wetness(inside) > 0.5 && wetness(outside) == 0.0,
        "{} {}",
        wetness(inside),
        wetness(outside)
    );
    assert!(app.world().resource::<RainfallField>().is_raining());
    let ledger = app.world().resource::<SurfaceGround>().ledger();
    let expected = 60e-3 / 3600.0 * 120.0 * std::f64::consts::PI * 9.0;
    assert!(
        ledger.residual_relative < 1e-12 && (ledger.rain_m3 / expected - 1.0).abs() < 0.03,
        "{ledger:?} {expected}"
    );
}

#[test]
fn the_weathers_rain_stays_outside_and_holes_are_dry() {
    let mut app = street(20.0);
    app.world_mut()
        .spawn(RainArea(disc(4.0, 4.0, 2.0, AreaRain::Scale(0.0))));
    run(&mut app, 60);
    let of = |app: &mut App, x: f32| asked(app, move |q| q.rain_at(Vec3::new(x, 0.0, 4.0)));
    assert_eq!([of(&mut app, 4.0), of(&mut app, 8.0)], [0.0, 20.0]);
    assert!(water(&app, 4.1, 4.1).saturation == 0.0 && water(&app, 9.1, 4.1).saturation > 0.0);
    // Rain in areas alone.
    app.insert_resource(RainOutside(0.0));
    app.world_mut()
        .spawn(RainArea(disc(8.0, 4.0, 1.0, AreaRain::OfWeather(2.0))));
    run(&mut app, 1);
    assert_eq!(
        [of(&mut app, 4.0), of(&mut app, 8.0), of(&mut app, 12.0)],
        [0.0, 40.0, 0.0]
    );
}

#[test]
fn a_bad_area_is_reported_once_and_the_last_good_one_stays() {
    let mut app = street(0.0);
    let refused = |app: &mut App| {
        app.world_mut()
            .resource_mut::<Messages<RainAreaRefused>>()
            .drain()
            .count()
    };
    let area = app
        .world_mut()
        .spawn(RainArea(disc(4.0, 4.0, 2.0, AreaRain::Rate(10.0))))
        .id();
    let bad = app
        .world_mut()
        .spawn(RainArea(disc(4.0, 4.0, 0.0, AreaRain::Rate(90.0))))
        .id();
    let at = |app: &mut App| asked(app, |q| q.rain_at(Vec3::new(4.0, 0.0, 4.0)));
    frame(&mut app, SECOND / 4);
    assert_eq!((refused(&mut app), at(&mut app)), (1, 10.0));
    app.world_mut().get_mut::<RainArea>(area).expect("there").0.transition_m = f64::NAN;
    frame(&mut app, SECOND / 4);
    assert_eq!((refused(&mut app), at(&mut app)), (1, 10.0));
    frame(&mut app, SECOND / 4);
    assert_eq!((refused(&mut app), at(&mut app)), (0, 10.0), "once a change");
    app.world_mut().get_mut::<RainArea>(bad).expect("there").0 = disc(4.0, 4.0, 1.0, AreaRain::Rate(90.0));
    frame(&mut app, SECOND / 4);
    assert_eq!((refused(&mut app), at(&mut app)), (0, 90.0));
    app.world_mut().despawn(bad);
    app.world_mut().despawn(area);
    frame(&mut app, SECOND / 4);
    assert_eq!(at(&mut app), 0.0);
    assert!(app.world().resource::<RainAreas>().is_uniform());
}

/// A shower that drifts over the street and ends, and a weather of its own.
fn shower(hz: u64, seconds: u64) -> App {
    let mut app = street(6.0);
    let settings = AreaSettings {
        transition_m: 4.0,
        motion: AreaMotion::Drift {
            velocity_m_s: DVec2::new(0.8, 0.1),
            start_s: 0.0,
        },
        fade: AreaFade {
            start_s: Some(2.0),
            fade_in_s: 5.0,
            ..AreaFade::default()
        },
        ..disc(-4.0, 4.0, 5.0, AreaRain::Rate(200.0))
    };
    app.world_mut().spawn(RainArea(settings));
    app.world_mut()
        .spawn((Transform::from_xyz(6.0, 0.5, 4.0), DynamicWetness::default()));
    for ns in frames_at(hz, seconds) {
        frame(&mut app, ns);
    }
    app
}

#[test]
fn a_shower_crosses_the_street_the_same_at_any_frame_rate_and_after_a_restore() {
    let apps = [30, 60, 144].map(|hz| shower(hz, 20));
    let hashes = apps.each_ref().map(|app| state_hash(app.world()));
    assert_eq!(hashes[0], hashes[1]);
    assert_eq!(hashes[0], hashes[2]);
    for app in &apps {
        let ledger = app.world().resource::<SurfaceGround>().ledger();
        assert!(ledger.residual_relative < 1e-12 && ledger.rain_m3 > 0.03, "{ledger:?}");
    }
    let [mut first, ..] = apps;
    // Into a world that has run otherwise, with an area too many, and into one that has none.
    let saved = RainSnapshot::save(first.world()).expect("can be written");
    let mut other = shower(30, 11);
    other
        .world_mut()
        .spawn(RainArea(disc(1.0, 1.0, 5.0, AreaRain::Scale(0.5))));
    run(&mut other, 1);
    let mut fresh = street(0.0);
    fresh
        .world_mut()
        .spawn((Transform::from_xyz(6.0, 0.5, 4.0), DynamicWetness::default()));
    for app in [&mut other, &mut fresh] {
        saved.restore(app.world_mut()).expect("fits");
        assert_eq!(state_hash(app.world()), state_hash(first.world()));
        assert_eq!(app.world().resource::<RainAreas>().areas().len(), 1);
    }
    for app in [&mut first, &mut other, &mut fresh] {
        run(app, 10);
    }
    assert_eq!(state_hash(first.world()), state_hash(other.world()));
    assert_eq!(state_hash(first.world()), state_hash(fresh.world()));
    // What cannot be is refused.
    let broken = saved.with_part("rain_areas", |text| text.replace("radius_m:5.0", "radius_m:-5.0"));
    let error = broken.restore(first.world_mut()).expect_err("refused").to_string();
    assert!(error.contains("radius_m is -5"), "{error}");
}
