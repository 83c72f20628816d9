//! Gusts in an app: drops sway with them, without jumps, the same at any frame rate; nothing without them.

use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_math::{DVec3, Vec3};
use rain_core::rainfall::CLASS_COUNT;
use rain_core::weather::GustModel;
use rain_ecs::prelude::*;

use crate::common::{SECOND, app, frame, frames_at};

fn blowing(gusts: Option<GustSettings>) -> (App, Entity) {
    let mut app = app(RainClock::default());
    app.insert_resource(RainSeed(5));
    let weather = Weather {
        wind_m_s: Vec3::new(6.0, 0.0, 2.0),
        ..Weather::rain(20.0)
    };
    let mut entity = app.world_mut().spawn(weather);
    if let Some(gusts) = gusts {
        entity.insert(Gusts(gusts));
    }
    let entity = entity.id();
    (app, entity)
}

fn field(app: &App) -> &RainfallField {
    app.world().resource::<RainfallField>()
}

#[test]
fn drops_sway_with_the_gusts_and_large_ones_less() {
    let settings = GustSettings::default();
    let (mut app, _) = blowing(Some(settings));
    let model = GustModel::new(&settings, 5).expect("in its domain");
    let wind = DVec3::new(6.0, 0.0, 2.0);
    let mut spread = [0.0; 2];
    for _ in 0..32 * 60 {
        let before = *field(&app).motion();
        frame(&mut app, SECOND / 32);
        let now = app.world().resource::<RainClock>().now_s();
        let after = *field(&app).motion();
        // The air is the model's.
        let air = GustModel::gusty(wind, model.mean(now - 1.0 / 32.0, now, 0.0));
        assert!((field(&app).wind_m_s() - air).length() < 1e-12);
        assert_eq!(field(&app).mean_wind_m_s(), wind);
        for class in 0..CLASS_COUNT {
            // What frames showed at the end of the last tick's interval is where the drops are.
            let shown = before.offset_m[class] + before.velocity_m_s[class] / 32.0;
            assert!(
                now < 0.1 || (after.offset_m[class] - shown).length() < 1e-9,
                "{class} at {now}"
            );
        }
        for (sum, class) in spread.iter_mut().zip([0, CLASS_COUNT - 1]) {
            let off = after.velocity_m_s[class] - wind;
            *sum += off.with_y(0.0).length_squared();
        }
    }
    // 20 % of 6.3 m/s, less what lags.
    let [small, large] = spread.map(|sum: f64| (sum / (32.0 * 60.0)).sqrt());
    assert!((0.8..2.0).contains(&small) && large < 0.97 * small, "{small} {large}");
    // Over a long time they go with the mean wind.
    let way = field(&app).motion().offset_m[0].with_y(0.0) / 60.0;
    assert!((way - wind).length() < 1.5, "{way}");
}

#[test]
fn any_frame_rate_and_a_restored_snapshot_sway_alike() {
    let hash = |rate: u64| {
        let (mut app, _) = blowing(Some(GustSettings::default()));
        for ns in frames_at(rate, 20) {
            frame(&mut app, ns);
        }
        (state_hash(app.world()), *field(&app).motion())
    };
    assert_eq!(hash(30), hash(144));
    let (mut app, _) = blowing(Some(GustSettings::default()));
    for ns in frames_at(30, 10) {
        frame(&mut app, ns);
    }
    let saved = RainSnapshot::save(app.world()).expect("can be written");
    let (mut other, _) = blowing(None);
    saved.restore(other.world_mut()).expect("fits");
    for app in [&mut app, &mut other] {
        for ns in frames_at(30, 10) {
            frame(app, ns);
        }
    }
    assert_eq!(state_hash(app.world()), state_hash(other.world()));
    assert_eq!(field(&app).motion(), field(&other).motion());
    assert_eq!(hash(30).1.offset_m, field(&app).motion().offset_m);
}

#[test]
fn without_gusts_nothing_runs_and_a_bad_setting_is_named() {
    let (mut app, entity) = blowing(None);
    for ns in frames_at(30, 5) {
        frame(&mut app, ns);
    }
    let changed = app.world().resource_ref::<GustState>().last_changed();
    for ns in frames_at(30, 5) {
        frame(&mut app, ns);
    }
    assert_eq!(app.world().resource_ref::<GustState>().last_changed(), changed);
    assert_eq!(field(&app).wind_m_s(), DVec3::new(6.0, 0.0, 2.0));
    assert_eq!(
        field(&app).motion().velocity_m_s[3].with_y(0.0),
        DVec3::new(6.0, 0.0, 2.0)
    );

    let bad = Gusts(GustSettings {
        intensity: 2.0,
        ..GustSettings::default()
    });
    let errors = |app: &mut App| {
        let mut messages = app.world_mut().resource_mut::<Messages<RainConfigError>>();
        messages.drain().map(|m| m.error.to_string()).collect::<Vec<_>>()
    };
    app.world_mut().entity_mut(entity).insert(bad);
    frame(&mut app, SECOND / 8);
    let named = errors(&mut app);
    assert!(named.len() == 1 && named[0].starts_with("intensity is 2"), "{named:?}");
    assert!(app.world().resource::<GustState>().model().is_none());
    app.world_mut().entity_mut(entity).insert(Gusts::default());
    frame(&mut app, SECOND / 8);
    let good = app.world().resource::<GustState>().model().cloned();
    assert!(good.is_some());
    app.world_mut().entity_mut(entity).insert(bad);
    frame(&mut app, SECOND / 8);
    assert_eq!(errors(&mut app).len(), 1);
    assert_eq!(app.world().resource::<GustState>().model().cloned(), good);
    app.world_mut().entity_mut(entity).remove::<Gusts>();
    frame(&mut app, SECOND / 8);
    assert!(app.world().resource::<GustState>().model().is_none());
    assert_eq!(field(&app).wind_m_s(), DVec3::new(6.0, 0.0, 2.0));
}
