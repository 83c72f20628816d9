//! What listeners hear of the rain.

use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_transform::components::Transform;
use rain_core::weather::SurfaceClass;
use rain_ecs::prelude::*;

use crate::common::{add_street, app, run, street_height};

/// Ears at a height over the street.
fn listener(app: &mut App, x: f64, z: f64) -> Entity {
    let y = street_height(x, z) + 1.7;
    app.world_mut()
        .spawn((RainSound::default(), Transform::from_xyz(x as f32, y as f32, z as f32)))
        .id()
}

fn heard(app: &App, entity: Entity) -> RainSound {
    *app.world().get::<RainSound>(entity).expect("it listens")
}

#[test]
fn rain_is_heard_where_it_lands_by_what_it_lands_on() {
    let mut app = app(RainClock::default());
    add_street(&mut app);
    let weather = app.world_mut().spawn(Weather::rain(25.0)).id();
    let (open, lawn, roofed) = (
        listener(&mut app, 4.0, 2.0),
        listener(&mut app, 4.0, 9.0),
        listener(&mut app, 13.7, 2.5),
    );
    run(&mut app, 8);
    let sounds = [open, lawn, roofed].map(|entity| heard(&app, entity));
    let [street, grass, under] = sounds;
    // Heavy rain in a street: 55 to 60 dB (ISO 10140 has 65 to 70 right under a sheet roof).
    assert!((50.0..60.0).contains(&street.rain_db), "{street:?}");
    assert!(street.on(SurfaceClass::Asphalt) > street.on(SurfaceClass::Grass));
    assert!(grass.on(SurfaceClass::Grass) > street.on(SurfaceClass::Grass) + 3.0);
    assert!(street.exposure == 1.0 && street.shelter_db == 0.0 && street.rain_mm_h == 25.0);
    assert!(under.exposure < 0.05 && under.shelter_db > 55.0, "{under:?}");
    // A roof keeps the nearest drops off: the ground is quieter.
    assert!(under.on(SurfaceClass::Asphalt) < street.on(SurfaceClass::Asphalt) - 1.0);
    // Ten times the rain: some 12 dB more; none: silence.
    app.world_mut().entity_mut(weather).insert(Weather::rain(2.5));
    run(&mut app, 2);
    let light = heard(&app, open).rain_db;
    assert!((10.0..14.0).contains(&(street.rain_db - light)), "{light}");
    app.world_mut().entity_mut(weather).insert(Weather::rain(0.0));
    run(&mut app, 2);
    let silent = heard(&app, open);
    assert_eq!((silent.rain_db, silent.ground_db), (0.0, [0.0; SurfaceClass::COUNT]));
}

#[test]
fn thunder_is_as_loud_as_it_arrives() {
    let mut app = app(RainClock::default());
    app.insert_resource(RainSeed(21));
    let settings = LightningSettings {
        flashes_per_km2_min: 0.04,
        radius_m: 4000.0,
        ..LightningSettings::default()
    };
    app.world_mut().spawn((Weather::rain(0.0), Lightning(settings)));
    let ears = app
        .world_mut()
        .spawn((RainSound::default(), Transform::from_xyz(0.0, 2.0, 0.0)))
        .id();
    let (mut loudest, mut silent) = (0.0_f32, 0);
    for _ in 0..240 {
        run(&mut app, 1);
        let level = heard(&app, ears).thunder_db;
        loudest = loudest.max(level);
        silent += u32::from(level == 0.0);
    }
    assert!((70.0..130.0).contains(&loudest) && silent > 5, "{loudest} {silent}");
    assert_eq!(heard(&app, ears).rain_db, 0.0);
}

#[test]
fn without_listeners_nothing_is_computed_and_the_state_is_the_same_with_them() {
    let mut with = app(RainClock::default());
    let mut without = app(RainClock::default());
    for app in [&mut with, &mut without] {
        add_street(app);
        app.world_mut().spawn(Weather::rain(25.0));
    }
    listener(&mut with, 4.0, 2.0);
    for app in [&mut with, &mut without] {
        run(app, 5);
    }
    assert_eq!(state_hash(with.world()), state_hash(without.world()));
}
