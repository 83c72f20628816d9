//! Lightning in an app: flashes when they are due, thunder when it arrives, whatever the frames and after a jump in time.

use bevy_app::{App, Update};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::components::Transform;
use rain_core::lightning::{Flash, FlashKind, for_each_flash, sound_speed_m_s};
use rain_ecs::prelude::*;

use crate::common::{SECOND, app, frame, frames_at};

/// Every message, with the tick's end after which it was read.
#[derive(Resource, Default)]
struct Collected {
    flashes: Vec<(f64, LightningFlash)>,
    thunders: Vec<(f64, ThunderHeard)>,
    errors: Vec<String>,
}

fn collect(
    clock: Res<RainClock>,
    mut collected: ResMut<Collected>,
    mut flashes: MessageReader<LightningFlash>,
    mut thunders: MessageReader<ThunderHeard>,
    mut errors: MessageReader<RainConfigError>,
) {
    let now = clock.now_s();
    collected.flashes.extend(flashes.read().map(|m| (now, *m)));
    collected.thunders.extend(thunders.read().map(|m| (now, *m)));
    collected.errors.extend(errors.read().map(|m| m.error.to_string()));
}

fn settings() -> LightningSettings {
    LightningSettings {
        flashes_per_km2_min: 0.06,
        ground_share: 0.5,
        radius_m: 8000.0,
        ..LightningSettings::default()
    }
}

/// A storm and ears at a place.
fn storm(place: Vec3) -> (App, Entity) {
    let mut app = app(RainClock::default());
    app.init_resource::<Collected>().add_systems(Update, collect);
    app.insert_resource(RainSeed(21));
    app.world_mut().spawn((Weather::rain(20.0), Lightning(settings())));
    let ears = app
        .world_mut()
        .spawn((RainListener, Transform::from_translation(place)))
        .id();
    (app, ears)
}

fn run_at(app: &mut App, hz: u64, seconds: u64) {
    for ns in frames_at(hz, seconds) {
        frame(app, ns);
    }
}

#[test]
fn flashes_are_told_in_their_tick_and_thunder_when_it_arrives() {
    let place = Vec3::new(300.0, 2.0, -200.0);
    let (mut app, ears) = storm(place);
    run_at(&mut app, 60, 120);
    let mut expected: Vec<Flash> = Vec::new();
    for_each_flash(&settings(), 21, 0.0, 119.9, |flash| expected.push(flash));
    let collected = app.world().resource::<Collected>();
    assert!(expected.len() > 12, "{}", expected.len());
    let told: Vec<Flash> = collected
        .flashes
        .iter()
        .map(|(_, m)| m.flash)
        .filter(|flash| flash.time_s < 119.9)
        .collect();
    // By second and rank, not by time.
    expected.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    let mut in_order = told;
    in_order.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    assert_eq!(in_order, expected);
    for (now, message) in &collected.flashes {
        // By the first frame after the tick that has it.
        let late = now - message.flash.time_s;
        assert!((0.0..0.05).contains(&late), "{late}");
    }
    assert!(collected.thunders.len() > 8);
    for (now, heard) in &collected.thunders {
        assert_eq!(heard.listener, ears);
        let late = now - heard.flash.time_s - heard.thunder.delay_s;
        assert!((0.0..0.05).contains(&late), "{late}");
        let straight = heard.thunder.from_m.distance(place.as_dvec3()) / sound_speed_m_s(15.0);
        assert!((heard.thunder.delay_s - straight).abs() < 1e-3);
        let flash = heard.flash.id;
        assert_eq!(
            collected
                .thunders
                .iter()
                .filter(|(_, other)| other.flash.id == flash)
                .count(),
            1
        );
    }
    // A flash to the ground at 3 km is heard after some 9 s.
    let struck = collected
        .thunders
        .iter()
        .filter(|(_, m)| m.flash.kind == FlashKind::ToGround);
    for (_, heard) in struck {
        let away = heard.flash.place_m.distance(place.as_dvec3());
        // A part in the cloud may be nearer, the low part of a far channel is not heard.
        let late = heard.thunder.delay_s - away / 340.0;
        assert!(late < 1.5 && (away > 4000.0 || late > -4.0), "{away} {heard:?}");
    }
}

#[test]
fn frames_and_jumps_in_time_change_no_flash_and_no_thunder() {
    let place = Vec3::new(0.0, 2.0, 0.0);
    let ids = |app: &App| {
        let collected = app.world().resource::<Collected>();
        let flashes: Vec<u64> = collected.flashes.iter().map(|(_, m)| m.flash.id).collect();
        let thunders: Vec<(u64, f64)> = collected
            .thunders
            .iter()
            .map(|(_, m)| (m.flash.id, m.thunder.delay_s))
            .collect();
        (flashes, thunders)
    };
    let (mut fast, _) = storm(place);
    run_at(&mut fast, 144, 60);
    let (mut slow, _) = storm(place);
    run_at(&mut slow, 5, 60);
    assert_eq!(ids(&fast), ids(&slow));
    assert_eq!(state_hash(fast.world()), state_hash(slow.world()));

    // Back to half a minute: what was on its way arrives again, and nothing that had arrived.
    let (mut again, _) = storm(place);
    run_at(&mut again, 30, 30);
    let before = ids(&again);
    let saved = RainSnapshot::save(again.world()).expect("can be written");
    run_at(&mut again, 30, 25);
    *again.world_mut().resource_mut::<Collected>() = Collected::default();
    saved.restore(again.world_mut()).expect("fits");
    run_at(&mut again, 30, 30);
    let (flashes, thunders) = ids(&again);
    let (all_flashes, all_thunders) = ids(&fast);
    assert_eq!([before.0, flashes].concat(), all_flashes);
    assert_eq!([before.1, thunders].concat(), all_thunders);
    // Into a world that knows of no lightning.
    let mut other = app(RainClock::default());
    other.init_resource::<Collected>().add_systems(Update, collect);
    other
        .world_mut()
        .spawn((RainListener, Transform::from_translation(place)));
    saved.restore(other.world_mut()).expect("fits");
    run_at(&mut other, 30, 30);
    assert_eq!(ids(&other), ids(&again));
}

#[test]
fn without_lightning_nothing_runs_and_a_bad_setting_is_named() {
    let mut calm = app(RainClock::default());
    calm.init_resource::<Collected>().add_systems(Update, collect);
    let weather = calm.world_mut().spawn(Weather::rain(20.0)).id();
    calm.world_mut().spawn((RainListener, Transform::default()));
    run_at(&mut calm, 10, 20);
    assert!(calm.world().resource::<ActiveLightning>().flashes().is_empty());
    // Untouched since it was made: the system has not run.
    let ticks = calm.world().resource_ref::<ActiveLightning>().last_changed();
    run_at(&mut calm, 10, 5);
    assert_eq!(calm.world().resource_ref::<ActiveLightning>().last_changed(), ticks);

    calm.world_mut()
        .entity_mut(weather)
        .insert(Lightning(LightningSettings {
            flashes_per_km2_min: f64::NAN,
            ..settings()
        }));
    run_at(&mut calm, 10, 20);
    let collected = calm.world().resource::<Collected>();
    assert_eq!(collected.errors.len(), 1);
    assert!(
        collected.errors[0].starts_with("flashes_per_km2_min"),
        "{:?}",
        collected.errors
    );
    assert!(collected.flashes.is_empty());
    // Good ones, bad ones: the good ones stay.
    calm.world_mut().entity_mut(weather).insert(Lightning(settings()));
    run_at(&mut calm, 10, 60);
    let flashes = calm.world().resource::<Collected>().flashes.len();
    assert!(flashes > 4, "{flashes}");
    calm.world_mut()
        .entity_mut(weather)
        .insert(Lightning(LightningSettings {
            radius_m: 1.0,
            ..settings()
        }));
    run_at(&mut calm, 10, 60);
    assert!(calm.world().resource::<Collected>().flashes.len() > flashes + 4);
    // Taken away, it is over.
    calm.world_mut().entity_mut(weather).remove::<Lightning>();
    run_at(&mut calm, 10, 1);
    let flashes = calm.world().resource::<Collected>().flashes.len();
    run_at(&mut calm, 10, 60);
    assert_eq!(calm.world().resource::<Collected>().flashes.len(), flashes);
    assert!(calm.world().resource::<ActiveLightning>().flashes().is_empty());
}

#[test]
fn who_comes_nearer_hears_it_sooner_and_a_leap_tells_the_last_flashes() {
    let (mut app, ears) = storm(Vec3::new(0.0, 2.0, 6000.0));
    run_at(&mut app, 20, 10);
    // 60 m/s towards the middle.
    for step in 0..1600_u16 {
        let z = 6000.0 - 3.0 * f32::from(step);
        app.world_mut()
            .entity_mut(ears)
            .insert(Transform::from_xyz(0.0, 2.0, z));
        frame(&mut app, SECOND / 20);
    }
    for (now, heard) in &app.world().resource::<Collected>().thunders {
        let late = now - heard.flash.time_s - heard.thunder.delay_s;
        // On the way the place changes by 2 m a tick.
        assert!((-0.02..0.12).contains(&late), "{late}");
    }
    let before = app.world().resource::<Collected>().flashes.len();
    frame(&mut app, 100_000 * SECOND);
    let collected = app.world().resource::<Collected>();
    let told = &collected.flashes[before..];
    // 256 ticks of 390 s: ten seconds of each.
    assert!(told.len() > 100 && told.len() < 1000, "{}", told.len());
    assert!(told[0].1.flash.place_m.is_finite());
}
