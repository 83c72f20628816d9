//! The weather in an app: same state at any frame rate, bad input, fast-forward, several weathers.

use std::time::Duration;

use bevy_app::{App, Update};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::TypeRegistry;
use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy, Virtual};
use rain_core::weather::{ColumnLedger, Keyframe, Transition};
use rain_ecs::prelude::*;

const SECOND: u64 = 1_000_000_000;

fn app(clock: RainClock) -> App {
    let mut app = App::new();
    app.add_plugins((TimePlugin, RainEcsPlugin { clock }));
    // The first update only starts Bevy's clock; frames below carry their whole length.
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    app.world_mut()
        .resource_mut::<Time<Virtual>>()
        .set_max_delta(Duration::MAX);
    // Bevy's own fixed loop has nothing to do here; a frame of two hours would run it half a million times.
    app.insert_resource(Time::<Fixed>::from_seconds(1e6));
    app.init_resource::<Collected>().add_systems(Update, collect);
    app.update();
    app
}

/// Every message so far; Bevy drops old ones.
#[derive(Resource, Default)]
struct Collected {
    errors: Vec<RainConfigError>,
    ignored: Vec<WeatherIgnored>,
}

fn collect(
    mut collected: ResMut<Collected>,
    mut errors: MessageReader<RainConfigError>,
    mut ignored: MessageReader<WeatherIgnored>,
) {
    collected.errors.extend(errors.read().cloned());
    collected.ignored.extend(ignored.read().copied());
}

fn frame(app: &mut App, ns: u64) {
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_nanos(ns)));
    app.update();
}

/// Frames of a steady rate: differences of rounded times, so that the last one ends exactly.
fn frames_at(hz: u64, seconds: u64) -> Vec<u64> {
    let time = |i: u64| (i * SECOND + hz / 2) / hz;
    (0..hz * seconds).map(|i| time(i + 1) - time(i)).collect()
}

/// Frames between 0 and 90 ms and a few hitches, exactly `seconds` long.
fn irregular_frames(seconds: u64) -> Vec<u64> {
    let (mut left, mut frames, mut i) = (seconds * SECOND, Vec::new(), 0);
    while left > 0 {
        let hash = u64::from(rain_core::hash::pcg(i));
        let length = match hash % 97 {
            0 => 0,
            1 => 2 * SECOND,
            _ => hash % 90_000_000,
        };
        frames.push(length.min(left));
        left -= length.min(left);
        i += 1;
    }
    frames
}

/// Rain comes, gusts, goes; then sun dries the ground.
fn storm() -> WeatherTimeline {
    let key = |time_s, intensity_mm_h, wind: f64, net_radiation_w_m2, transition| Keyframe {
        time_s,
        conditions: WeatherConditions {
            intensity_mm_h,
            wind_m_s: Vec3::new(1.0, 0.0, 0.5).as_dvec3() * wind,
            net_radiation_w_m2,
            ..WeatherConditions::default()
        },
        transition,
    };
    use Transition::{Hold, Linear};
    WeatherTimeline::new(
        Timeline::new(vec![
            key(0.3, 0.0, 1.0, 50.0, Linear),
            key(4.0, 400.0, 9.0, 0.0, Hold),
            key(14.0, 500.0, 6.0, 0.0, Linear),
            key(24.0, 3.0, 2.0, 100.0, Linear),
            key(26.0, 0.0, 2.0, 700.0, Hold),
        ])
        .expect("valid"),
    )
}

fn run(clock: RainClock, frames: &[u64]) -> (App, Entity) {
    let mut app = app(clock);
    let entity = app.world_mut().spawn(storm()).id();
    for &ns in frames {
        frame(&mut app, ns);
    }
    (app, entity)
}

fn state(app: &App, entity: Entity) -> &WeatherState {
    app.world().get::<WeatherState>(entity).expect("required by Weather")
}

fn ledgers(app: &App, entity: Entity) -> Vec<ColumnLedger> {
    SurfaceClass::ALL
        .map(|class| state(app, entity).column(class).ledger())
        .to_vec()
}

fn assert_close(a: &[ColumnLedger], b: &[ColumnLedger]) {
    for (a, b) in a.iter().zip(b) {
        for (x, y) in [
            (a.pores_mm, b.pores_mm),
            (a.film_mm, b.film_mm),
            (a.rain_mm, b.rain_mm),
            (a.evaporated_mm, b.evaporated_mm),
            (a.infiltrated_mm, b.infiltrated_mm),
            (a.drained_mm, b.drained_mm),
        ] {
            // Relative to the amount, and to 10 µm where there is less.
            assert!((x - y).abs() <= 1e-6 * x.abs().max(1e-2), "{a:?}\n{b:?}");
        }
    }
}

fn errors(app: &App) -> Vec<RainConfigError> {
    app.world().resource::<Collected>().errors.clone()
}

#[test]
fn any_frame_rate_gives_the_same_bits() {
    let (reference, entity) = run(RainClock::default(), &frames_at(60, 30));
    let expected = state_hash(reference.world());
    assert!(state(&reference, entity).rain_mm() > 1.0, "the storm did rain");
    assert_eq!(reference.world().resource::<RainClock>().ticks(), 30 * 32);
    for frames in [frames_at(30, 30), frames_at(144, 30), irregular_frames(30)] {
        let (app, entity) = run(RainClock::default(), &frames);
        assert_eq!(state_hash(app.world()), expected);
        assert_eq!(ledgers(&app, entity).len(), SurfaceClass::COUNT);
        assert_eq!(app.world().resource::<RainClock>().runs(), 30 * 32);
    }
}

#[test]
fn the_hash_sees_seed_time_and_the_last_bit_of_the_weather() {
    let hash = |change: fn(&mut App, Entity)| {
        let mut app = app(RainClock::default());
        let entity = app.world_mut().spawn(Weather::preset(WeatherPreset::HeavyRain)).id();
        change(&mut app, entity);
        frame(&mut app, SECOND);
        state_hash(app.world())
    };
    let base = hash(|_, _| ());
    assert_eq!(base, hash(|_, _| ()));
    assert_ne!(base, hash(|app, _| app.world_mut().resource_mut::<RainSeed>().0 = 1));
    assert_ne!(base, hash(|app, _| frame(app, 31_250_000)));
    assert_ne!(
        base,
        hash(|app, entity| {
            let mut weather = app.world_mut().get_mut::<Weather>(entity).expect("spawned");
            weather.intensity_mm_h = weather.intensity_mm_h.next_up();
        })
    );
    assert_ne!(
        base,
        hash(|app, entity| {
            app.world_mut().entity_mut(entity).insert(WeatherMode::Artist);
        })
    );
}

#[test]
fn another_tick_length_gives_the_same_state() {
    let (reference, entity) = run(RainClock::default(), &frames_at(60, 32));
    for tick_ns in [10_000_000, 15_625_000, 125_000_000, 1_000_000_000] {
        let clock = RainClock::with_tick(Duration::from_nanos(tick_ns)).expect("in the domain");
        let (app, other) = run(clock, &frames_at(60, 32));
        assert_close(&ledgers(&reference, entity), &ledgers(&app, other));
    }
}

#[test]
fn fast_forward_takes_few_long_ticks_to_the_same_state() {
    let (reference, entity) = run(RainClock::default(), &frames_at(60, 32));
    let mut clock = RainClock::default();
    clock.set_max_ticks_per_frame(16).expect("positive");
    let (app, other) = run(clock, &[32 * SECOND]);
    let clock = app.world().resource::<RainClock>();
    assert_eq!((clock.ticks(), clock.runs()), (32 * 32, 16));
    assert_eq!(clock.current_tick_ns(), 2 * SECOND);
    assert_close(&ledgers(&reference, entity), &ledgers(&app, other));
    assert!(state(&app, other).rain_mm() > 1.0);
}

#[test]
fn an_invalid_value_keeps_the_last_good_one_and_is_reported_once() {
    let mut app = app(RainClock::default());
    let entity = app.world_mut().spawn(Weather::rain(10.0)).id();
    frame(&mut app, SECOND);
    app.world_mut()
        .get_mut::<Weather>(entity)
        .expect("spawned")
        .intensity_mm_h = f64::NAN;
    for _ in 0..10 {
        frame(&mut app, SECOND / 10);
    }
    let found = errors(&app);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].entity, entity);
    assert_eq!(
        found[0].error.to_string(),
        "intensity_mm_h is NaN, allowed: 0 to 500 mm/h"
    );
    assert_eq!(state(&app, entity).conditions().intensity_mm_h, 10.0);
    assert!(
        (state(&app, entity).rain_mm() - 2.0 * 10.0 / 3600.0).abs() < 1e-12,
        "it went on raining"
    );

    // A second bad edit is a second report; a good one takes effect.
    app.world_mut().get_mut::<Weather>(entity).expect("spawned").wind_m_s = Vec3::splat(60.0);
    frame(&mut app, SECOND);
    assert_eq!(errors(&app).len(), 2);
    *app.world_mut().get_mut::<Weather>(entity).expect("spawned") = Weather::rain(20.0);
    frame(&mut app, SECOND);
    assert_eq!(
        (errors(&app).len(), state(&app, entity).conditions().intensity_mm_h),
        (2, 20.0)
    );
}

#[test]
fn weather_spawned_invalid_is_dry_and_reported() {
    let mut app = app(RainClock::default());
    let entity = app.world_mut().spawn(Weather::rain(-1.0)).id();
    frame(&mut app, SECOND);
    assert_eq!(errors(&app).len(), 1);
    assert!(state(&app, entity).is_dry_and_settled());
}

#[test]
fn a_timeline_with_a_bad_start_falls_back_to_the_last_good_weather() {
    let mut app = app(RainClock::default());
    let entity = app.world_mut().spawn((Weather::rain(7.0), storm())).id();
    frame(&mut app, SECOND);
    let before = state(&app, entity).conditions().intensity_mm_h;
    app.world_mut()
        .get_mut::<WeatherTimeline>(entity)
        .expect("spawned")
        .start_s = f64::NAN;
    for _ in 0..5 {
        frame(&mut app, SECOND);
    }
    assert_eq!(errors(&app).len(), 1);
    let weather = app.world().get::<Weather>(entity).expect("spawned").intensity_mm_h;
    assert_eq!(state(&app, entity).conditions().intensity_mm_h, weather);
    assert!(weather > before, "the last good weather is that of the last tick's end");
    // Repaired: the timeline drives again, shifted.
    app.world_mut()
        .get_mut::<WeatherTimeline>(entity)
        .expect("spawned")
        .start_s = -2.0;
    frame(&mut app, SECOND);
    assert_eq!(state(&app, entity).conditions().intensity_mm_h, 400.0);
    assert_eq!(errors(&app).len(), 1);
}

#[test]
fn the_timeline_leaves_its_value_in_the_weather() {
    let (app, entity) = run(RainClock::default(), &frames_at(60, 12));
    let weather = app.world().get::<Weather>(entity).expect("required");
    assert_eq!(
        (weather.intensity_mm_h, weather.wind_m_s),
        (400.0, Vec3::new(9.0, 0.0, 4.5))
    );
    let mean = storm().timeline.mean_intensity_mm_h(0.0, 12.0).expect("valid");
    assert!((state(&app, entity).rain_mm() - mean * 12.0 / 3600.0).abs() < 1e-12);
}

#[test]
fn pausing_stops_the_rain_and_nothing_is_made_up_for() {
    for rain_alone in [false, true] {
        let mut app = app(RainClock::default());
        let entity = app.world_mut().spawn(Weather::rain(36.0)).id();
        let pause = |app: &mut App, paused: bool| {
            if rain_alone {
                app.world_mut().resource_mut::<RainClock>().paused = paused;
            } else if paused {
                app.world_mut().resource_mut::<Time<Virtual>>().pause();
            } else {
                app.world_mut().resource_mut::<Time<Virtual>>().unpause();
            }
        };
        frame(&mut app, SECOND);
        pause(&mut app, true);
        frame(&mut app, 5 * SECOND);
        assert!((state(&app, entity).rain_mm() - 0.01).abs() < 1e-15);
        pause(&mut app, false);
        frame(&mut app, SECOND);
        assert!((state(&app, entity).rain_mm() - 0.02).abs() < 1e-15);
    }
}

#[test]
fn the_first_weather_counts_and_others_are_reported_once() {
    let mut app = app(RainClock::default());
    let first = app.world_mut().spawn(Weather::rain(10.0)).id();
    let second = app.world_mut().spawn(Weather::rain(20.0)).id();
    for _ in 0..5 {
        frame(&mut app, SECOND);
    }
    let reports = |app: &App| app.world().resource::<Collected>().ignored.clone();
    assert_eq!(app.world().resource::<ActiveWeather>().entity(), Some(first));
    assert_eq!(
        reports(&app),
        [WeatherIgnored {
            entity: second,
            active: first
        }]
    );
    assert_eq!(state(&app, second).rain_mm(), 0.0);
    app.world_mut().despawn(first);
    frame(&mut app, SECOND);
    assert_eq!(app.world().resource::<ActiveWeather>().entity(), Some(second));
    assert_eq!(state(&app, second).conditions().intensity_mm_h, 20.0);
    assert_eq!(reports(&app).len(), 1);
}

#[test]
fn both_modes_run_and_the_chosen_one_answers() {
    let mut app = app(RainClock::default());
    let entity = app.world_mut().spawn(Weather::rain(10.0)).id();
    frame(&mut app, 2 * SECOND);
    let asphalt = SurfaceClass::Asphalt;
    let physical = state(&app, entity).wetness(asphalt);
    assert!(
        physical > 0.0 && physical < 0.02,
        "2 s of 10 mm/h hardly wet a road: {physical}"
    );
    app.world_mut().entity_mut(entity).insert(WeatherMode::Artist);
    frame(&mut app, SECOND / 32);
    assert_eq!(
        state(&app, entity).wetness(asphalt),
        1.0,
        "the artists' way takes one second"
    );
    assert_eq!(state(&app, entity).water_level_mm(asphalt), 3.0);

    // Settings apply, and a bad one leaves them as they were.
    let half = ArtistSettings {
        full_level_mm: 8.0,
        ..ArtistSettings::default()
    };
    app.world_mut().entity_mut(entity).insert(ArtistControls(half));
    frame(&mut app, SECOND);
    assert_eq!(state(&app, entity).water_level_mm(asphalt), 8.0);
    let bad = ArtistSettings {
        drying_delay_s: f64::NAN,
        ..half
    };
    app.world_mut().entity_mut(entity).insert(ArtistControls(bad));
    frame(&mut app, SECOND);
    assert_eq!(errors(&app).len(), 1);
    assert_eq!(state(&app, entity).water_level_mm(asphalt), 8.0);
    app.world_mut().entity_mut(entity).remove::<ArtistControls>();
    frame(&mut app, SECOND);
    assert_eq!(state(&app, entity).water_level_mm(asphalt), 3.0);

    // Dry and settled, by mode.
    app.world_mut().entity_mut(entity).insert(Weather {
        net_radiation_w_m2: 500.0,
        ..Weather::rain(0.0)
    });
    frame(&mut app, 25 * SECOND);
    assert!(state(&app, entity).is_dry_and_settled());
    assert!(state(&app, entity).column(asphalt).water_level_mm() >= 0.0);
    app.world_mut().entity_mut(entity).insert(WeatherMode::Physical);
    frame(&mut app, 7200 * SECOND);
    assert!(state(&app, entity).is_dry_and_settled());
}

#[test]
fn frames_interpolate_between_the_last_two_ticks() {
    let mut app = app(RainClock::default());
    let entity = app.world_mut().spawn(Weather::rain(100.0)).id();
    frame(&mut app, SECOND);
    let at_tick = state(&app, entity).wetness(SurfaceClass::Asphalt);
    frame(&mut app, 31_250_000 + 15_625_000);
    let clock = app.world().resource::<RainClock>();
    assert_eq!(clock.interpolation(), 0.5);
    let now = state(&app, entity).wetness(SurfaceClass::Asphalt);
    let shown = state(&app, entity).wetness_at(SurfaceClass::Asphalt, clock.interpolation());
    assert!(now > at_tick && (shown - 0.5 * (now + at_tick)).abs() < 1e-15);
}

#[test]
fn sets_of_a_tick_run_in_the_documented_order() {
    #[derive(Resource, Default)]
    struct Seen(Vec<usize>);
    let mut app = app(RainClock::default());
    app.init_resource::<Seen>();
    // Added backwards, so that only the sets can bring them into order.
    for (index, set) in RainSystems::ORDER.into_iter().enumerate().rev() {
        app.add_systems(RainTick, (move |mut seen: ResMut<Seen>| seen.0.push(index)).in_set(set));
    }
    frame(&mut app, 2 * 31_250_000);
    let expected: Vec<usize> = (0..RainSystems::ORDER.len())
        .chain(0..RainSystems::ORDER.len())
        .collect();
    assert_eq!(app.world().resource::<Seen>().0, expected);
}

#[test]
fn an_edit_in_update_takes_effect_in_the_next_frames_ticks() {
    let mut app = app(RainClock::default());
    let entity = app.world_mut().spawn(Weather::default()).id();
    app.add_systems(Update, |mut weathers: Query<&mut Weather>| {
        for mut weather in &mut weathers {
            weather.intensity_mm_h += 1.0;
        }
    });
    for _ in 0..3 {
        frame(&mut app, SECOND);
    }
    assert!(
        (state(&app, entity).rain_mm() - 3.0 / 3600.0).abs() < 1e-15,
        "0, 1 and 2 mm/h for a second each"
    );
}

#[test]
fn components_are_registered_for_reflection() {
    let app = app(RainClock::default());
    let registry = app.world().resource::<bevy_ecs::prelude::AppTypeRegistry>().read();
    let registry: &TypeRegistry = &registry;
    for name in [
        "Weather",
        "WeatherTimeline",
        "WeatherMode",
        "ArtistControls",
        "WeatherState",
        "RainClock",
        "RainSeed",
    ] {
        assert!(registry.get_with_short_type_path(name).is_some(), "{name}");
    }
}

#[test]
fn without_a_time_plugin_nothing_happens() {
    let mut app = App::new();
    app.add_plugins(RainEcsPlugin::default());
    let entity = app.world_mut().spawn(Weather::rain(10.0)).id();
    app.update();
    assert_eq!(
        (
            state(&app, entity).rain_mm(),
            app.world().resource::<RainClock>().ticks()
        ),
        (0.0, 0)
    );
}

#[test]
fn a_table_of_rain_types_sets_the_speeds_and_a_blend_passes_through_its_rows() {
    let mut app = app(RainClock::default());
    let mut table = RainTypes::default();
    table
        .put(RainType {
            name: "cloudburst".into(),
            intensity_mm_h: 50.0,
            wetness_rise_per_s: 4.0,
            holes_rise_per_s: 0.25,
            puddles_rise_per_s: 0.125,
            splashes_per_m2_s: 100.0,
            fog_amount: 1.0,
        })
        .expect("valid");
    let entity = app
        .world_mut()
        .spawn((Weather::rain(50.0), WeatherMode::Artist, RainTypeTable(table.clone())))
        .id();
    for _ in 0..4 {
        frame(&mut app, SECOND / 2);
    }
    let levels = *app.world().get::<WeatherState>(entity).expect("state").artist();
    assert_eq!(levels.wetness, 1.0);
    assert!(
        (levels.holes - 0.5).abs() < 1e-9 && (levels.puddles - 0.25).abs() < 1e-9,
        "{levels:?}"
    );

    // From light to heavy over eight seconds: the speeds rise without a step, those of the row between on the way.
    let [light, heavy] = [2.0, 10.0].map(Weather::rain);
    let way = WeatherTimeline::blend(&light, &heavy, 2.0, 8.0).expect("valid");
    app.world_mut().entity_mut(entity).insert(way);
    let mut speeds = Vec::new();
    for _ in 0..340 {
        frame(&mut app, SECOND / 32);
        let controls = app.world().get::<ArtistControls>(entity).expect("written by the table");
        speeds.push(controls.0.puddles.rise_per_s[1]);
    }
    let speeds = &speeds[2..];
    assert!(speeds[0] < 0.12 && (speeds[337] - 0.7).abs() < 1e-9, "{speeds:?}");
    assert!(
        speeds.windows(2).all(|w| w[1] >= w[0] && w[1] - w[0] < 0.02),
        "{speeds:?}"
    );
    assert!(speeds.iter().any(|s| (s - 0.3).abs() < 0.01), "through moderate rain");
    for (start, over) in [(0.0, 0.0), (0.0, -1.0), (0.0, f64::NAN)] {
        assert!(WeatherTimeline::blend(&light, &heavy, start, over).is_err());
    }
    let bad = Weather::rain(f64::NAN);
    assert!(WeatherTimeline::blend(&light, &bad, 0.0, 1.0).is_err());
}
