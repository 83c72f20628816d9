//! Saved, sent, restored: the same state, bit for bit; damaged input changes nothing.

use bevy_app::App;
use bevy_math::Vec3;
use bevy_transform::components::Transform;
use rain_ecs::prelude::*;

use crate::common::{add_street, app, frame, run, weather};

/// A street in the middle of a storm with a car.
fn stormy(seconds: u64) -> App {
    let mut app = app(RainClock::default());
    add_street(&mut app);
    app.insert_resource(RainSeed(7));
    app.world_mut().spawn(weather(&[
        [0.0, 200.0, 0.0, 0.0],
        [20.0, 300.0, 6.0, 0.0],
        [40.0, 0.0, 2.0, 300.0],
    ]));
    let place = Transform::from_translation(Vec3::new(3.0, 0.5, 3.0));
    app.world_mut().spawn((place, DynamicWetness::default()));
    run(&mut app, seconds);
    // Not on a tick.
    frame(&mut app, 17_123_457);
    app
}

fn save(app: &App) -> RainSnapshot {
    RainSnapshot::save(app.world()).expect("can be written")
}

#[test]
fn a_restored_world_goes_on_bit_for_bit() {
    let mut first = stormy(17);
    let saved = save(&first);
    assert_eq!(
        saved.parts().collect::<Vec<_>>(),
        [
            "clock",
            "cover",
            "dynamic_wetness",
            "rain_areas",
            "rainfall",
            "seed",
            "surface",
            "weather"
        ]
    );
    // Through text, into a world that has run otherwise, and into one that has not begun.
    let text = ron::to_string(&saved).expect("text");
    let sent: RainSnapshot = ron::from_str(&text).expect("text of a snapshot");
    assert_eq!(sent, saved);
    let mut other = stormy(31);
    let mut fresh = app(RainClock::default());
    add_street(&mut fresh);
    fresh.world_mut().spawn(Weather::default());
    let place = Transform::from_translation(Vec3::new(3.0, 0.5, 3.0));
    fresh.world_mut().spawn((place, DynamicWetness::default()));
    for world in [other.world_mut(), fresh.world_mut()] {
        assert_ne!(state_hash(world), state_hash(first.world()));
        sent.restore(world).expect("fits");
        assert_eq!(state_hash(world), state_hash(first.world()));
    }
    for seconds in [1, 10, 30] {
        for app in [&mut first, &mut other, &mut fresh] {
            run(app, seconds);
        }
        assert_eq!(
            state_hash(first.world()),
            state_hash(other.world()),
            "after {seconds} s more"
        );
        assert_eq!(
            state_hash(first.world()),
            state_hash(fresh.world()),
            "after {seconds} s more"
        );
    }
    assert_eq!(save(&first).parts().count(), 8);
    let ledger = fresh.world().resource::<SurfaceGround>().ledger();
    assert!(ledger.residual_relative < 1e-12 && ledger.rain_m3 > 0.1);
}

#[test]
fn damaged_snapshots_are_refused_and_change_nothing() {
    let mut app = stormy(17);
    let text = ron::to_string(&save(&app)).expect("text");
    let before = state_hash(app.world());
    let mut refused = |text: &str, expected: &str| {
        let message = match ron::from_str::<RainSnapshot>(text) {
            Ok(snapshot) => snapshot.restore(app.world_mut()).expect_err("refused").to_string(),
            Err(error) => error.to_string(),
        };
        assert!(message.contains(expected), "{message}, not {expected}");
        assert_eq!(state_hash(app.world()), before);
    };
    refused(&text.replacen("version:1", "version:2", 1), "version 2");
    refused(&text[..text.len() / 2], "");
    let digit = text.rfind("turn:").expect("the ground's turns") + 5;
    let mut flipped = text.clone();
    flipped.replace_range(digit..=digit, "9");
    refused(&flipped, "checksum");
    run(&mut app, 1);
}

#[test]
fn snapshots_of_other_worlds_are_refused() {
    let saved = save(&stormy(17));
    let refused = |app: &mut App, expected: &str| {
        let before = state_hash(app.world());
        let message = saved.restore(app.world_mut()).expect_err("refused").to_string();
        assert!(message.contains(expected), "{message}");
        assert_eq!(state_hash(app.world()), before);
    };
    let mut elsewhere = stormy(1);
    elsewhere.world_mut().resource_mut::<SurfaceScene>().remove(2);
    refused(
        &mut elsewhere,
        "'surface' is refused: the snapshot is of another ground",
    );
    let mut empty = app(RainClock::default());
    refused(
        &mut empty,
        "'dynamic_wetness' is refused: it has 1 objects, this world 0",
    );
    let mut bare = App::new();
    refused(&mut bare, "is its plugin missing?");
    // A part less than the world has.
    let mut full = stormy(1);
    let smaller = RainSnapshot::save(bare.world()).expect("nothing to write");
    let message = smaller.restore(full.world_mut()).expect_err("refused").to_string();
    assert!(message.contains("no part 'clock'"), "{message}");
}

#[test]
fn numbers_that_no_state_has_are_refused() {
    // Parts are checked beyond the checksum, which a sender can compute as well.
    let mut app = stormy(17);
    let saved = save(&app);
    for (part, from, to, expected) in [
        (
            "weather",
            "relative_humidity:0.7",
            "relative_humidity:7.0",
            "relative_humidity is 7",
        ),
        (
            "weather",
            "relative_humidity:0.7",
            "relative_humidity:NaN",
            "relative_humidity is NaN",
        ),
        ("rainfall", "slope_per_mm:", "slope_per_mm:-", "rainfall"),
        ("clock", "tick:31250000", "tick:31250001", "clock"),
        ("cover", "wind_m_s:(", "wind_m_s:(9e9,", "cover"),
        ("surface", "version:1", "version:8", "version 8"),
        ("surface", "exposure:[255,", "exposure:[", "another ground"),
        ("dynamic_wetness", "wetness:", "wetness:-", "dynamic_wetness"),
    ] {
        let forged = saved.with_part(part, |text| {
            assert!(
                text.contains(from),
                "{part}: {from} in {}",
                &text[..text.len().min(600)]
            );
            text.replacen(from, to, 1)
        });
        let before = state_hash(app.world());
        let message = forged.restore(app.world_mut()).expect_err("refused").to_string();
        assert!(message.contains(expected), "{message}, not {expected}");
        assert_eq!(state_hash(app.world()), before);
    }
}

/// Something that is seen only.
#[derive(bevy_ecs::prelude::Resource, serde::Serialize, serde::Deserialize, Clone, Copy, PartialEq, Debug)]
struct Foam(u32);

impl rain_ecs::snapshot::SnapshotPart for Foam {
    fn save(world: &bevy_ecs::prelude::World) -> Option<Self> {
        world.get_resource().copied()
    }

    fn prepare(self, _: &bevy_ecs::prelude::World) -> Result<rain_ecs::snapshot::Apply, SnapshotError> {
        Ok(Box::new(move |world| world.insert_resource(self)))
    }

    fn absent(world: &mut bevy_ecs::prelude::World) {
        world.insert_resource(Self(0));
    }
}

#[test]
fn what_is_seen_only_travels_between_worlds_that_see_and_those_that_do_not() {
    let seeing = || {
        let mut app = stormy(2);
        app.snapshot_part::<Foam>("seen_foam").insert_resource(Foam(7));
        app
    };
    let (mut client, mut server) = (seeing(), stormy(5));
    let (rich, plain) = (save(&client), save(&server));
    assert!(rich.parts().any(|part| part == "seen_foam"));
    rich.restore(server.world_mut()).expect("the server does not look");
    assert_eq!(state_hash(server.world()), state_hash(client.world()));
    plain.restore(client.world_mut()).expect("nothing is seen yet");
    assert_eq!(client.world().resource::<Foam>(), &Foam(0));
    rich.restore(client.world_mut()).expect("fits");
    assert_eq!(client.world().resource::<Foam>(), &Foam(7));
    // What is simulated may not be missing.
    client.snapshot_part::<Foam>("foam");
    let error = rich.restore(client.world_mut()).expect_err("no such part");
    assert!(matches!(error, SnapshotError::MissingPart { part: "foam" }), "{error}");
    let strange = save(&client).restore(server.world_mut()).expect_err("unknown part");
    assert!(matches!(strange, SnapshotError::UnknownPart { .. }), "{strange}");
}

#[test]
fn levels_play_back_restore_and_stay_when_switched_off() {
    let levels = |share: f64| WaterByHand {
        wetness: Some(share),
        water_level: Some(0.5 * share),
        hole_level: Some(0.25 * share),
    };
    let key = |time_s, share| LevelKey {
        time_s,
        levels: levels(share),
    };
    let curve = LevelCurve::new(vec![key(0.0, 0.0), key(8.0, 1.0), key(16.0, 0.0)], Some(16.0)).expect("valid");
    let mut first = app(RainClock::default());
    let entity = first
        .world_mut()
        .spawn((Weather::default(), LevelTimeline::new(curve)))
        .id();
    let shown = |app: &mut App| {
        let world = app.world_mut();
        let state = world.query::<&WeatherState>().single(world).expect("one");
        let levels = state.shown_levels();
        (levels.wetness, levels.puddles, levels.holes)
    };
    run(&mut first, 4);
    assert_eq!(shown(&mut first), (0.5, 0.25, 0.125), "half way up");
    run(&mut first, 8);
    assert_eq!(shown(&mut first), (0.5, 0.25, 0.125), "half way down");
    let mut second = app(RainClock::default());
    second.world_mut().spawn(Weather::default());
    save(&first).restore(second.world_mut()).expect("it fits");
    for app in [&mut first, &mut second] {
        run(app, 6);
        assert_eq!(shown(app), (0.25, 0.125, 0.0625), "started over");
    }
    assert_eq!(state_hash(first.world()), state_hash(second.world()));

    let mut timeline = first.world_mut().get_mut::<LevelTimeline>(entity).expect("it plays");
    timeline.playing = false;
    run(&mut first, 4);
    assert_eq!(shown(&mut first), (0.25, 0.125, 0.0625), "switched off, levels stay");
    first.world_mut().entity_mut(entity).insert(levels(1.0));
    run(&mut first, 1);
    assert_eq!(shown(&mut first), (1.0, 0.5, 0.25), "set by hand");
    first
        .world_mut()
        .entity_mut(entity)
        .remove::<(LevelTimeline, WaterByHand)>();
    run(&mut first, 1);
    assert_eq!(shown(&mut first), (0.0, 0.0, 0.0), "given back to dry weather");
}
