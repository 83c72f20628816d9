//! A storm over a street: puddles where hollows are, dry ground under roofs, closed ledgers, the same at any rate.

use bevy_app::App;
use bevy_math::{DVec3, Vec3};
use bevy_transform::components::Transform;
use rain_core::surface::ground::{GroundLayer, WaterAt};
use rain_ecs::prelude::*;

use crate::common::{add_street, app, frame, frames_at, quad, run, street_height, weather};

fn water(app: &App, x: f64, y: f64, z: f64) -> WaterAt {
    let ground = app.world().resource::<SurfaceGround>().ground().expect("built");
    ground.water_at(DVec3::new(x, y, z))
}

fn ledger_closes(app: &App) {
    let ledger = app.world().resource::<SurfaceGround>().ledger();
    assert!(ledger.residual_relative < 1e-12, "{ledger:?}");
}

#[test]
fn an_hour_of_storm_fills_the_hollow_and_leaves_the_roofs_shadow_dry() {
    let mut app = app(RainClock::default());
    add_street(&mut app);
    app.world_mut().spawn(weather(&[
        [0.0, 0.0, 0.0, 0.0],
        [120.0, 30.0, 1.0, 0.0],
        [1200.0, 80.0, 2.0, 0.0],
        [2400.0, 60.0, 1.0, 0.0],
        [2700.0, 0.0, 0.0, 100.0],
        [3600.0, 0.0, 1.0, 400.0],
    ]));
    let middle = street_height(8.0, 4.0);
    // The start: wet asphalt, no puddle yet.
    run(&mut app, 60);
    let bowl = water(&app, 8.1, middle, 4.1);
    assert!(bowl.saturation > 0.1 && bowl.puddle_m == 0.0, "{bowl:?}");
    ledger_closes(&app);
    // The peak.
    run(&mut app, 1740);
    let bowl = water(&app, 8.1, middle, 4.1);
    assert!(bowl.puddle_m > 0.05 && bowl.layer == GroundLayer::Ground, "{bowl:?}");
    let slope = water(&app, 3.1, street_height(3.1, 4.1), 4.1);
    assert!(
        slope.puddle_m == 0.0 && slope.film_mm > 0.8 && slope.saturation == 1.0,
        "{slope:?}"
    );
    let lawn = water(&app, 3.1, 0.35, 9.1);
    assert!(
        lawn.class == SurfaceClass::Grass && lawn.puddle_m == 0.0 && lawn.saturation == 1.0,
        "{lawn:?}"
    );
    let under = water(&app, 14.6, street_height(14.6, 2.6), 2.6);
    assert_eq!((under.film_mm, under.saturation, under.puddle_m), (0.0, 0.0, 0.0));
    let roof = water(&app, 14.6, 4.0, 2.6);
    assert!(roof.layer == GroundLayer::Top && roof.film_mm > 0.05, "{roof:?}");
    ledger_closes(&app);
    let ledger = app.world().resource::<SurfaceGround>().ledger();
    assert!(
        ledger.gutters_m3 > 0.2 && ledger.off_map_m3 > 1.0 && ledger.infiltrated_m3 > 0.1,
        "{ledger:?}"
    );
    // A quarter of an hour after: the slope drains to its texture, the puddle stays, the pores are still full.
    run(&mut app, 1800);
    let bowl = water(&app, 8.1, middle, 4.1);
    assert!(bowl.puddle_m > 0.1, "{bowl:?}");
    let slope = water(&app, 3.1, street_height(3.1, 4.1), 4.1);
    assert!(
        slope.film_mm < 0.9 && slope.saturation > 0.5 && slope.puddle_m == 0.0,
        "{slope:?}"
    );
    ledger_closes(&app);
    let ledger = app.world().resource::<SurfaceGround>().ledger();
    assert!(ledger.basins_m3 > 0.3 && ledger.evaporated_m3 > 1e-3, "{ledger:?}");
}

fn short_storm(hz: u64) -> App {
    let mut app = app(RainClock::default());
    add_street(&mut app);
    app.world_mut().spawn(weather(&[
        [0.0, 200.0, 0.0, 0.0],
        [20.0, 300.0, 6.0, 0.0],
        [40.0, 0.0, 2.0, 300.0],
        [60.0, 0.0, 2.0, 300.0],
    ]));
    let objects = [
        (Vec3::new(3.0, 0.5, 3.0), SurfaceClass::Stone),
        (Vec3::new(14.0, 0.1, 2.5), SurfaceClass::Roof),
    ];
    for (at, class) in objects {
        let place = Transform::from_translation(at);
        app.world_mut()
            .spawn((place, DynamicWetness::default(), SurfaceMaterial(class)));
    }
    for ns in frames_at(hz, 60) {
        frame(&mut app, ns);
    }
    app
}

#[test]
fn any_frame_rate_ends_in_the_same_ground() {
    let apps = [30, 60, 144].map(short_storm);
    let hashes = apps.each_ref().map(|app| state_hash(app.world()));
    assert_eq!(hashes[0], hashes[1]);
    assert_eq!(hashes[0], hashes[2]);
    let bowl = water(&apps[0], 8.1, street_height(8.0, 4.0), 4.1);
    assert!(bowl.puddle_m > 1e-3, "or nothing was compared: {bowl:?}");
    apps.iter().for_each(ledger_closes);
}

#[test]
fn fast_forward_ends_in_nearly_the_same_ground() {
    let keys = [[0.0, 40.0, 0.0, 0.0], [1e4, 40.0, 0.0, 0.0]];
    let ground = |frames: &[u64]| {
        let mut app = app(RainClock::default());
        add_street(&mut app);
        app.world_mut().resource_mut::<SurfaceSettings>().settle_ticks = 0;
        app.world_mut().spawn(weather(&keys));
        run(&mut app, 1);
        frames.iter().for_each(|&ns| frame(&mut app, ns));
        ledger_closes(&app);
        app.world().resource::<SurfaceGround>().ledger()
    };
    let short = ground(&frames_at(30, 1200));
    let long = ground(&[1_200_000_000_000]);
    assert!((short.rain_m3 - long.rain_m3).abs() < 1e-9 * short.rain_m3);
    assert!(
        (short.basins_m3 - long.basins_m3).abs() < 0.02 * short.basins_m3,
        "{short:?} {long:?}"
    );
    assert!(
        (short.film_m3 - long.film_m3).abs() < 0.02 * short.film_m3,
        "{short:?} {long:?}"
    );
}

#[test]
fn the_ground_is_built_when_the_scene_has_settled_and_keeps_its_water() {
    let mut app = app(RainClock::default());
    app.world_mut().spawn(Weather::rain(60.0));
    let built = |app: &App| app.world().resource::<SurfaceGround>().rebuilds();
    run(&mut app, 2);
    assert_eq!(built(&app), 0, "nothing to build from");
    add_street(&mut app);
    frame(&mut app, 15 * 31_250_000);
    assert_eq!(built(&app), 0, "not yet");
    frame(&mut app, 2 * 31_250_000);
    assert_eq!(built(&app), 1);
    run(&mut app, 30);
    assert_eq!(built(&app), 1, "and once only");
    let before = app.world().resource::<SurfaceGround>().ledger();
    // A van that drives is no ground; a kiosk that is set up is.
    let van = quad([2.0, 2.0], [4.0, 4.0], |_, _| 2.0);
    let mut scene = app.world_mut().resource_mut::<SurfaceScene>();
    scene.set(9, &van, SurfaceClass::Roof, false);
    run(&mut app, 2);
    assert_eq!(built(&app), 1);
    let mut scene = app.world_mut().resource_mut::<SurfaceScene>();
    scene.set(10, &van, SurfaceClass::Roof, true);
    scene.request_rebuild();
    frame(&mut app, 31_250_000);
    assert_eq!(built(&app), 2, "at once, since it was asked for");
    let after = app.world().resource::<SurfaceGround>().ledger();
    assert!(
        after.rain_m3 >= before.rain_m3 && after.film_m3 > 0.9 * before.film_m3,
        "{before:?} {after:?}"
    );
    ledger_closes(&app);
    // Settings that cannot be: reported, the old ground goes on.
    app.world_mut().resource_mut::<SurfaceSettings>().cell_m = f64::NAN;
    run(&mut app, 2);
    let surface = app.world().resource::<SurfaceGround>();
    let message = surface.error().expect("refused").to_string();
    assert!(
        message.starts_with("cell_m is NaN") && surface.ground().is_some(),
        "{message}"
    );
    ledger_closes(&app);
    app.world_mut().resource_mut::<SurfaceSettings>().enabled = false;
    run(&mut app, 1);
    assert!(app.world().resource::<SurfaceGround>().ground().is_none());
}

#[test]
fn exposure_follows_a_cover_that_appears() {
    let mut app = app(RainClock::default());
    add_street(&mut app);
    app.world_mut().spawn(Weather::rain(60.0));
    run(&mut app, 20);
    let wet = water(&app, 3.1, street_height(3.1, 3.1), 3.1);
    assert!(wet.saturation > 0.5);
    let exposure = |app: &App| {
        let surface = app.world().resource::<SurfaceGround>();
        let ground = surface.ground().expect("built");
        assert!(surface.is_exposure_known());
        ground.exposure()[ground.cell_at(3.1, 3.1).expect("inside")]
    };
    assert_eq!(exposure(&app), 255);
    // The dry patch under the truck.
    let truck = quad([1.5, 1.5], [4.5, 4.5], |_, _| 3.0);
    app.world_mut()
        .resource_mut::<CoverField>()
        .set(9, &truck, true)
        .expect("fits");
    run(&mut app, 2);
    assert_eq!(exposure(&app), 0);
    app.world_mut().resource_mut::<CoverField>().remove(9);
    run(&mut app, 2);
    assert_eq!(exposure(&app), 255);
}

#[test]
fn objects_get_wet_in_the_rain_and_dry_under_cover() {
    for mode in [WeatherMode::Physical, WeatherMode::Artist] {
        let mut app = app(RainClock::default());
        add_street(&mut app);
        let sun = Weather {
            net_radiation_w_m2: 700.0,
            ..Weather::rain(20.0)
        };
        app.world_mut().spawn((sun, mode));
        let outside = Transform::from_xyz(3.0, 0.3, 3.0);
        let shelter = Transform::from_xyz(13.7, 0.1, 2.5);
        let [a, b] = [outside, shelter].map(|at| app.world_mut().spawn((at, DynamicWetness::default())).id());
        run(&mut app, 60);
        let wet = |app: &App, entity| app.world().get::<DynamicWetness>(entity).expect("there").clone();
        assert!(
            wet(&app, a).wetness() == 1.0 && wet(&app, a).exposure() == 1.0,
            "{mode:?} {:?}",
            wet(&app, a)
        );
        assert!(
            wet(&app, b).wetness() == 0.0 && wet(&app, b).exposure() == 0.0,
            "{mode:?} {:?}",
            wet(&app, b)
        );
        // They change places.
        app.world_mut().entity_mut(a).insert(shelter);
        app.world_mut().entity_mut(b).insert(outside);
        run(&mut app, 30);
        assert!(
            wet(&app, b).wetness() == 1.0 && wet(&app, a).exposure() == 0.0,
            "{mode:?}"
        );
        run(&mut app, 1800);
        assert_eq!(wet(&app, a).wetness(), 0.0, "{mode:?}: dried by the air under cover");
        assert_eq!(wet(&app, b).wetness(), 1.0);
    }
}
