//! Wheels leave tracks that are state: they fill again, and a snapshot knows them.

use bevy_app::App;
use bevy_ecs::prelude::Entity;
use bevy_math::{DVec3, Vec3};
use bevy_transform::components::Transform;
use rain_ecs::prelude::*;

use crate::common::{add_street, app, frame, run, street_height, weather};

/// A wheel on the wet street under steady rain.
fn wet_street() -> (App, Entity) {
    let mut app = app(RainClock::default());
    add_street(&mut app);
    app.world_mut()
        .spawn(weather(&[[0.0, 20.0, 0.0, 0.0], [1e5, 20.0, 0.0, 0.0]]));
    let wheel = app.world_mut().spawn((at(2.0), FilmPress::wheel(0.3))).id();
    run(&mut app, 900);
    (app, wheel)
}

/// Across the middle of a row of cells. Units: m.
const Z: f64 = 2.125;

/// The wheel on the ground at x.
fn at(x: f64) -> Transform {
    Transform::from_translation(Vec3::new(x as f32, street_height(x, Z) as f32 + 0.3, Z as f32))
}

/// Rolls the wheel from 2 m to 6 m, a tick for each frame.
fn roll(app: &mut App, wheel: Entity) {
    for step in 1..=64 {
        *app.world_mut().get_mut::<Transform>(wheel).expect("a wheel") = at(2.0 + f64::from(step) / 16.0);
        frame(app, 31_250_000);
    }
}

/// Films on the track and beside it. Units: mm.
fn films(app: &App) -> [f64; 2] {
    let ground = app.world().resource::<SurfaceGround>().ground().expect("a ground");
    [Z, Z - 1.0].map(|z| ground.water_at(DVec3::new(4.1, street_height(4.1, z), z)).film_mm)
}

#[test]
fn a_wheel_leaves_a_track_that_fills_again_and_no_water_is_lost() {
    let (mut app, wheel) = wet_street();
    let [track, beside] = films(&app);
    assert!(
        (track - beside).abs() < 1e-3 * beside && beside > 0.8,
        "{track} {beside}"
    );
    roll(&mut app, wheel);
    let [track, beside] = films(&app);
    assert!(track < 0.6 * beside, "{track} {beside}");
    assert!(app.world().resource::<FilmPresses>().len() > 30, "the picture is told");
    let ledger = app.world().resource::<SurfaceGround>().ledger();
    assert!(
        ledger.residual_relative < 1e-12 && ledger.airborne_m3 == 0.0,
        "{ledger:?}"
    );
    run(&mut app, 900);
    let [track, beside] = films(&app);
    assert!((track - beside).abs() < 0.02 * beside, "{track} {beside}");
}

#[test]
fn a_wheel_that_stands_flies_or_leaps_leaves_none() {
    let (mut app, wheel) = wet_street();
    for place in [
        at(2.0),
        at(2.02),
        // In the air.
        Transform::from_xyz(3.0, 2.0, 2.0),
        Transform::from_xyz(4.0, 2.0, 2.0),
        // Farther than any wheel rolls between two ticks.
        at(14.0),
        Transform::from_xyz(f32::NAN, 0.3, 2.0),
        at(4.0),
    ] {
        *app.world_mut().get_mut::<Transform>(wheel).expect("a wheel") = place;
        frame(&mut app, 31_250_000);
    }
    assert!(app.world().resource::<FilmPresses>().is_empty());
    let [track, beside] = films(&app);
    assert!((track - beside).abs() < 1e-3 * beside, "{track} {beside}");
}

#[test]
fn a_snapshot_in_the_middle_of_a_track_goes_on_bit_for_bit() {
    let (mut first, wheel) = wet_street();
    let half = |app: &mut App, wheel: Entity, from: u32| {
        for step in from..from + 24 {
            // Steps that are shorter than a press: what has gathered is state.
            *app.world_mut().get_mut::<Transform>(wheel).expect("a wheel") = at(2.0 + 0.02 * f64::from(step));
            frame(app, 31_250_000);
        }
    };
    half(&mut first, wheel, 1);
    let saved = RainSnapshot::save(first.world()).expect("can be written");
    assert!(saved.parts().any(|part| part == "film_press"));
    let (mut other, other_wheel) = wet_street();
    assert_ne!(state_hash(other.world()), state_hash(first.world()));
    saved.restore(other.world_mut()).expect("fits");
    for (app, wheel) in [(&mut first, wheel), (&mut other, other_wheel)] {
        half(app, wheel, 25);
    }
    assert_eq!(state_hash(other.world()), state_hash(first.world()));
    other.world_mut().despawn(other_wheel);
    let refused = saved.restore(other.world_mut()).expect_err("a wheel is missing");
    assert!(refused.to_string().contains("film_press"), "{refused}");
}

#[test]
fn bad_settings_are_refused_by_name() {
    type Set = fn(&mut FilmPress, f32);
    let fields: [(&str, Set, [f32; 2]); 3] = [
        ("width_m", |p, v| p.width_m = v, [0.0, 11.0]),
        ("radius_m", |p, v| p.radius_m = v, [-1.0, 200.0]),
        ("share", |p, v| p.share = v, [-0.1, 1.1]),
    ];
    assert!(FilmPress::default().validated().is_ok());
    for (name, set, bad) in fields {
        for bad in bad.into_iter().chain([f32::NAN, f32::INFINITY]) {
            let mut press = FilmPress::default();
            set(&mut press, bad);
            let message = press.validated().expect_err("refused").to_string();
            assert!(message.starts_with(name), "{message}");
        }
    }
}
