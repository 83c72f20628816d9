//! What gameplay asks.

use bevy_app::App;
use bevy_ecs::message::Messages;
use bevy_ecs::system::RunSystemOnce;
use bevy_math::{DVec3, Vec3};
use rain_core::wheels::Tyre;
use rain_ecs::prelude::*;

use crate::common::{SECOND, add_street, app, frame, run, street_height};

/// Asks in a system.
fn ask<T: Send + Sync + 'static>(app: &mut App, question: impl Fn(&RainQueries) -> T + Send + Sync + 'static) -> T {
    app.world_mut()
        .run_system_once(move |queries: RainQueries| question(&queries))
        .expect("runs")
}

#[test]
fn answers_fit_the_street() {
    let mut app = app(RainClock::default());
    add_street(&mut app);
    let weather = app.world_mut().spawn(Weather::rain(100.0)).id();
    run(&mut app, 600);
    let on = |x: f64, z: f64| DVec3::new(x, street_height(x, z), z);
    let (bowl, slope, shelter, roof) = (on(8.1, 4.1), on(3.1, 4.1), on(14.1, 2.6), DVec3::new(14.1, 4.0, 2.6));
    let places = [bowl, slope, shelter, roof];
    let depths = ask(&mut app, move |q| places.map(|p| q.water_depth_at(p)));
    assert!(
        depths[0] > 0.03 && depths[1] > 0.8e-3 && depths[1] < 0.02 && depths[2] == 0.0 && depths[3] > 0.0,
        "{depths:?}"
    );
    let wetness = ask(&mut app, move |q| places.map(|p| q.wetness_at(p)));
    assert_eq!(wetness, [1.0, 1.0, 0.0, 1.0]);
    let exposed = ask(&mut app, move |q| places.map(|p| q.exposed_at(p)));
    assert_eq!(exposed, [1.0, 1.0, 0.0, 1.0]);
    let sounds = ask(&mut app, move |q| places.map(|p| q.surface_sound_at(p)));
    assert_eq!(
        sounds.map(|s| s.wetness),
        [
            SoundWetness::Puddle,
            SoundWetness::Wet,
            SoundWetness::Dry,
            SoundWetness::Wet
        ]
    );
    assert_eq!(
        (sounds[0].class, sounds[3].class),
        (SurfaceClass::Asphalt, SurfaceClass::Roof)
    );
    let grip = ask(&mut app, move |q| {
        [(shelter, 30.0), (slope, 30.0), (bowl, 5.0), (bowl, 30.0)].map(|(p, v)| q.friction_at(p, v))
    });
    assert!(
        grip[0] > grip[1] && grip[1] > grip[3] && grip[2] > 3.0 * grip[3],
        "{grip:?}"
    );
    let bald = Tyre {
        tread_mm: 1.0,
        ..Tyre::default()
    };
    assert!(ask(&mut app, move |q| q.friction_of(&bald, slope, 30.0)) < grip[1]);
    // Marshall–Palmer: 1.22/km at 25 mm/h, 6.6/km at 100 without the factor that follows from closing the flux.
    let visibility = ask(&mut app, |q| q.visibility_m());
    assert!((500.0..2000.0).contains(&visibility), "{visibility}");
    // Off the map and in the air: as open ground, where the rain reaches.
    let off = ask(&mut app, |q| {
        [
            q.wetness_at(Vec3::new(100.0, 0.0, 0.0)),
            q.wetness_at(DVec3::new(14.1, 2.0, 2.6)),
        ]
    });
    assert_eq!(off, [1.0, 0.0]);
    for bad in [DVec3::NAN, DVec3::INFINITY, DVec3::new(0.0, f64::NAN, 0.0)] {
        let (wet, depth, exposed, grip, sound) = ask(&mut app, move |q| {
            let friction = q.friction_at(bad, f64::NAN);
            (
                q.wetness_at(bad),
                q.water_depth_at(bad),
                q.exposed_at(bad),
                friction,
                q.surface_sound_at(bad),
            )
        });
        assert_eq!((wet, depth, exposed, grip), (0.0, 0.0, 0.0, 0.85));
        assert_eq!(sound, SurfaceSound::default());
    }
    // After the rain the pores of the slope are damp without a film.
    app.world_mut().entity_mut(weather).insert(Weather {
        net_radiation_w_m2: 800.0,
        ..Weather::rain(0.0)
    });
    frame(&mut app, 7200 * SECOND);
    let sound = ask(&mut app, move |q| q.surface_sound_at(slope));
    assert!(sound.wetness <= SoundWetness::Damp, "{sound:?}");
    assert_eq!(ask(&mut app, |q| q.visibility_m()), 1e9);
}

#[test]
fn questions_need_nothing_but_a_world() {
    let mut app = App::new();
    let here = DVec3::new(1.0, 2.0, 3.0);
    let answers = ask(&mut app, move |q| {
        (
            q.wetness_at(here),
            q.water_depth_at(here),
            q.exposed_at(here),
            q.friction_at(here, 20.0),
            q.visibility_m(),
        )
    });
    assert_eq!(answers, (0.0, 0.0, 1.0, 0.85, 1e9));
}

#[test]
fn wetness_and_level_set_by_hand_are_answered_and_the_water_is_there_again_afterwards() {
    let mut app = app(RainClock::default());
    add_street(&mut app);
    let weather = app.world_mut().spawn(Weather::rain(0.0)).id();
    run(&mut app, 10);
    let on = |x: f64, z: f64| DVec3::new(x, street_height(x, z), z);
    let (bowl, slope, shelter) = (on(8.1, 4.1), on(3.1, 4.1), on(14.1, 2.6));
    let places = [bowl, slope, shelter];
    let answers = |app: &mut App| {
        (
            ask(app, move |q| places.map(|p| q.wetness_at(p))),
            ask(app, move |q| places.map(|p| q.water_depth_at(p))),
        )
    };
    let hash = |app: &App| state_hash(app.world());
    let dry = hash(&app);
    assert_eq!(answers(&mut app), ([0.0; 3], [0.0; 3]), "dry");
    let set = |app: &mut App, wetness: Option<f64>, water_level: Option<f64>| {
        app.world_mut().entity_mut(weather).insert(WaterByHand {
            wetness,
            water_level,
            hole_level: None,
        });
        frame(app, SECOND / 16);
    };
    set(&mut app, Some(0.6), None);
    assert_eq!(
        answers(&mut app),
        ([0.6, 0.6, 0.0], [0.0; 3]),
        "wet where rain would reach"
    );
    // Puddles rise with the level, the film with it; the hollow alone holds a puddle.
    let mut last = 0.0;
    for level in [0.25, 0.5, 1.0] {
        set(&mut app, Some(0.6), Some(level));
        let (wetness, depth) = answers(&mut app);
        assert_eq!(wetness, [1.0, 0.6, 0.0], "{level}");
        assert!(depth[0] > last + 0.01, "{level}: {depth:?}");
        assert!((depth[1] - level * 3e-3).abs() < 1e-12 && depth[2] == 0.0, "{depth:?}");
        last = depth[0];
    }
    let state = app.world().get::<WeatherState>(weather).expect("its state").clone();
    assert_eq!(state.shown_levels().puddles, 1.0);
    assert!(!state.is_dry_and_settled());
    assert_eq!(
        app.world().resource::<SurfaceGround>().ledger().basins_m3,
        0.0,
        "no water was made"
    );
    // A snapshot holds what is set; damaged values are refused.
    let saved = RainSnapshot::save(app.world()).expect("saved");
    set(&mut app, None, None);
    assert_eq!(answers(&mut app).1, [0.0; 3]);
    saved.restore(app.world_mut()).expect("restored");
    assert!(answers(&mut app).1[0] > 0.03);
    // What is outside its domain is named, and the last good values stay.
    for (wetness, level) in [
        (Some(1.1), None),
        (None, Some(-0.1)),
        (Some(f64::NAN), None),
        (None, Some(f64::INFINITY)),
    ] {
        set(&mut app, wetness, level);
        let mut errors = app.world_mut().resource_mut::<Messages<RainConfigError>>();
        let named: Vec<String> = errors.drain().map(|error| error.error.to_string()).collect();
        let field = if level.is_some() { "water_level" } else { "wetness" };
        assert!(named.len() == 1 && named[0].starts_with(field), "{named:?}");
        assert!(answers(&mut app).1[0] > 0.03, "{wetness:?} {level:?}");
    }
    app.world_mut().entity_mut(weather).remove::<WaterByHand>();
    frame(&mut app, SECOND / 16);
    assert_eq!(answers(&mut app), ([0.0; 3], [0.0; 3]), "the dry ground is back");
    assert!(hash(&app) != dry, "time has passed");
}
