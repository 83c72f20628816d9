//! Feet in water.

use bevy_app::App;
use bevy_ecs::message::Messages;
use bevy_ecs::prelude::*;
use bevy_math::{DVec3, Vec3};
use bevy_transform::components::Transform;
use rain_ecs::prelude::*;

use crate::common::{SECOND, add_street, app, frame, quad, run, street_height};

fn on(x: f64, z: f64) -> Vec3 {
    DVec3::new(x, street_height(x, z), z).as_vec3()
}

/// Steps on these places, and what splashed.
fn steps(app: &mut App, places: &[Vec3]) -> Vec<FootSplash> {
    for &place in places {
        app.world_mut().write_message(FootStep::at(place));
    }
    frame(app, SECOND / 32);
    app.world_mut().resource_mut::<Messages<FootSplash>>().drain().collect()
}

#[test]
fn feet_splash_in_enough_water_under_the_open_sky() {
    let mut app = app(RainClock::default());
    add_street(&mut app);
    app.world_mut().spawn(Weather::rain(100.0));
    let (bowl, slope, shelter) = (on(8.1, 4.1), on(3.1, 4.1), on(14.1, 2.6));
    run(&mut app, 10);
    assert!(
        steps(&mut app, &[bowl, slope, shelter]).is_empty(),
        "a film is not enough"
    );
    run(&mut app, 600);
    let splashes = steps(&mut app, &[bowl, slope, shelter]);
    assert_eq!(splashes.len(), 1, "{splashes:?}");
    let splash = splashes[0];
    assert_eq!((splash.place, splash.foot), (bowl, None));
    assert!(splash.depth_m > 0.03 && splash.strength == 0.5, "{splash:?}");
    assert_eq!(splash.sound.wetness, SoundWetness::Puddle);
    assert_eq!(splash.sound.class, SurfaceClass::Asphalt);

    // A roof comes over the puddle: the water stays, but nothing splashes under cover.
    let roof = quad([5.0, 1.0], [11.0, 7.0], |_, _| 5.0);
    app.world_mut()
        .resource_mut::<CoverField>()
        .set(9, &roof, true)
        .expect("fits");
    run(&mut app, 4);
    assert!(steps(&mut app, &[bowl]).is_empty());
    app.world_mut().resource_mut::<CoverField>().remove(9);
    run(&mut app, 4);
    assert_eq!(steps(&mut app, &[bowl]).len(), 1);

    // Bad steps splash nowhere.
    let bad = [Vec3::NAN, Vec3::INFINITY].map(FootStep::at);
    let still = FootStep {
        speed_m_s: f32::NAN,
        ..FootStep::at(bowl)
    };
    for step in bad.into_iter().chain([still]) {
        app.world_mut().write_message(step);
    }
    assert!(steps(&mut app, &[]).is_empty());
    app.world_mut().resource_mut::<FootSplashSettings>().least_depth_m = f32::NAN;
    assert!(steps(&mut app, &[bowl]).is_empty());
}

#[test]
fn a_foot_that_walks_splashes_where_it_steps() {
    let mut app = app(RainClock::default());
    add_street(&mut app);
    app.world_mut().spawn(Weather::rain(100.0));
    run(&mut app, 600);
    let foot = app.world_mut().spawn(Foot::with_origin_above(0.1)).id();
    let mut walk = |from: Vec3| {
        let mut found = Vec::new();
        // Down within three frames at 2 m/s, then it stands.
        for height in [0.3_f32, 0.2, 0.1, 0.0, 0.0, 0.0] {
            let place = from + (0.1 + height) * Vec3::Y;
            app.world_mut()
                .entity_mut(foot)
                .insert(Transform::from_translation(place));
            frame(&mut app, SECOND / 20);
            found.extend(app.world_mut().resource_mut::<Messages<FootSplash>>().drain());
        }
        found
    };
    let splashes = walk(on(8.1, 4.1));
    assert_eq!(splashes.len(), 1, "{splashes:?}");
    assert!((splashes[0].strength - 1.0).abs() < 0.01 && splashes[0].foot == Some(foot));
    assert!(walk(on(3.1, 4.1)).is_empty(), "on the slope");
}

#[test]
fn painted_puddles_splash_when_the_weather_has_flooded_them() {
    let mut app = app(RainClock::default());
    app.world_mut().spawn((Weather::rain(20.0), WeatherMode::Artist));
    let step = |depth: f32| FootStep {
        painted: Some(PaintedStep {
            depth,
            ..PaintedStep::default()
        }),
        ..FootStep::at(Vec3::new(3.0, 0.0, 3.0))
    };
    let ask = |app: &mut App| {
        for depth in [0.0, 1.0] {
            app.world_mut().write_message(step(depth));
        }
        frame(app, SECOND / 32);
        let mut splashes = app.world_mut().resource_mut::<Messages<FootSplash>>();
        splashes.drain().map(|s| s.depth_m).collect::<Vec<_>>()
    };
    // White is as open ground: the level's own film.
    app.world_mut().resource_mut::<FootSplashSettings>().least_depth_m = 0.004;
    assert!(ask(&mut app).is_empty(), "nothing has gathered yet");
    run(&mut app, 10);
    assert_eq!(ask(&mut app), [0.01]);
    // A level set by hand is what the picture shows and what feet step into.
    let weather = app
        .world_mut()
        .query_filtered::<Entity, With<Weather>>()
        .single(app.world())
        .expect("one");
    let by_hand = |water_level| WaterByHand {
        wetness: None,
        water_level,
        hole_level: None,
    };
    app.world_mut().entity_mut(weather).insert(by_hand(Some(0.0)));
    run(&mut app, 1);
    assert!(ask(&mut app).is_empty(), "dry by hand");
    app.world_mut().entity_mut(weather).insert(by_hand(Some(1.0)));
    run(&mut app, 1);
    assert_eq!(ask(&mut app), [0.01]);
}
