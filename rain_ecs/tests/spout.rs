//! Water of roofs: late, long, all of it, and where it lands.

use bevy_app::App;
use bevy_ecs::message::Messages;
use bevy_ecs::prelude::Entity;
use bevy_math::{DVec3, Vec3};
use bevy_transform::components::Transform;
use rain_ecs::prelude::*;

use crate::common::{add_street, app, frame, frames_at, run, street_height, weather};

/// A street under ten minutes of heavy rain that stops, with an eave of 4 m along z at x = 4 and a pipe at x = 10 that
/// looks along +x.
fn street() -> (App, Entity, Entity) {
    let mut app = app(RainClock::default());
    add_street(&mut app);
    let rain = [[0.0, 0.0, 0.0, 0.0], [1.0, 60.0, 0.0, 0.0], [600.0, 60.0, 0.0, 0.0]];
    app.world_mut().spawn(weather(&[
        rain[0],
        rain[1],
        rain[2],
        [601.0, 0.0, 0.0, 0.0],
        [1e5, 0.0, 0.0, 0.0],
    ]));
    let turned = |x: f32, z: f32| Transform::from_xyz(x, 3.0, z).looking_to(Vec3::X, Vec3::Y);
    let eave = app.world_mut().spawn((turned(4.125, 4.0), Spout::eave(4.0, 5.0))).id();
    let pipe = app.world_mut().spawn((turned(9.0, 2.0), Spout::pipe(0.1, 60.0))).id();
    (app, eave, pipe)
}

fn water(app: &App, spout: Entity) -> SpoutWater {
    app.world().get::<SpoutWater>(spout).expect("a spout").clone()
}

fn film(app: &App, x: f64, z: f64) -> f64 {
    let ground = app.world().resource::<SurfaceGround>().ground().expect("a ground");
    ground.water_at(DVec3::new(x, street_height(x, z), z)).film_mm
}

#[test]
fn a_roof_pours_later_than_the_rain_and_goes_on_after_it_and_loses_nothing() {
    let (mut app, eave, pipe) = street();
    // Pores of 0.1 mm and 0.05 mm of texture take the first nine seconds of 60 mm/h.
    run(&mut app, 8);
    assert_eq!(water(&app, eave).poured_m3(), 0.0);
    assert!(water(&app, eave).outflow().is_none());
    run(&mut app, 4);
    let early = water(&app, eave).flow_m3_s();
    let dripping = water(&app, eave).outflow().expect("pours");
    assert!(early > 0.0 && !dripping.jets());
    run(&mut app, 558);
    assert!(water(&app, eave).flow_m3_s() > 5.0 * early);
    // The steady flow is the rain on the roof: 20 m² at 60 mm/h are a third of a litre a second.
    let steady = water(&app, eave).flow_m3_s();
    assert!((steady / (20.0 * 60e-3 / 3600.0) - 1.0).abs() < 0.02, "{steady:e}");
    let pouring = water(&app, eave).outflow().expect("pours");
    assert!(pouring.flow_m3_s > dripping.flow_m3_s && pouring.jets());
    let jet = water(&app, pipe).outflow().expect("pours");
    assert!((jet.flow_m3_s / 1e-3 - 1.0).abs() < 0.02 && jet.jets() && jet.speed_m_s > 0.4);
    // The rain has been over for a minute, and it still drips.
    run(&mut app, 90);
    let late = water(&app, eave);
    assert!(
        late.flow_m3_s() > 0.0 && late.flow_m3_s() < 0.2 * steady,
        "{:e}",
        late.flow_m3_s()
    );
    assert!(late.outflow().is_some_and(|outflow| !outflow.jets()));
    let account = late.column().ledger();
    assert!(account.residual_relative() < 1e-12, "{account:?}");
    let rain = account.rain_mm * 1e-3 * 20.0;
    let kept = late.poured_m3() + late.stored_m3() + account.evaporated_mm * 1e-3 * 20.0;
    assert!((kept / rain - 1.0).abs() < 1e-9 && rain > 0.19, "{kept} {rain}");
    // The ground has got it.
    let poured = late.poured_m3() + water(&app, pipe).poured_m3();
    let ledger = app.world().resource::<SurfaceGround>().ledger();
    assert!(
        (ledger.added_m3 / poured - 1.0).abs() < 1e-6,
        "{} {poured}",
        ledger.added_m3
    );
    assert!(ledger.residual_relative < 1e-12, "{ledger:?}");
}

#[test]
fn the_ground_is_wetter_under_the_eave_and_where_the_pipe_throws() {
    let (mut app, _, pipe) = street();
    run(&mut app, 590);
    let (under, beside) = (film(&app, 4.125, 4.125), film(&app, 2.125, 4.125));
    assert!(under > 1.3 * beside, "{under} {beside}");
    assert!(film(&app, 4.125, 7.0) < 1.1 * beside, "not beyond the eave's end");
    // Three metres down at critical speed: half a metre ahead of the mouth and more.
    let speed = water(&app, pipe).outflow().expect("pours").speed_m_s;
    let ahead = 9.0 + speed * (2.0 * (3.0 - street_height(9.5, 2.0)) / 9.80665_f64).sqrt();
    assert!(ahead > 9.3, "{ahead}");
    let (hit, mouth) = (film(&app, ahead, 2.0), film(&app, 8.6, 2.0));
    assert!(hit > 2.0 * mouth, "{hit} {mouth}");
}

#[test]
fn a_spout_that_feeds_no_ground_and_one_without_rain_leave_it_alone() {
    let (mut app, eave, pipe) = street();
    for spout in [eave, pipe] {
        app.world_mut().get_mut::<Spout>(spout).expect("a spout").feeds_ground = false;
    }
    run(&mut app, 120);
    assert!(water(&app, eave).poured_m3() > 0.0);
    assert_eq!(app.world().resource::<SurfaceGround>().ledger().added_m3, 0.0);
    // An area with no rain over the eave.
    let (mut dry, eave, _) = street();
    dry.world_mut().spawn(RainArea(AreaSettings {
        rain: AreaRain::Scale(0.0),
        ..AreaSettings::default()
    }));
    run(&mut dry, 120);
    assert_eq!(water(&dry, eave).poured_m3(), 0.0);
}

#[test]
fn frames_of_any_length_and_a_snapshot_end_alike() {
    let end = |hz: u64| {
        let (mut app, ..) = street();
        frames_at(hz, 60).into_iter().for_each(|ns| frame(&mut app, ns));
        state_hash(app.world())
    };
    assert_eq!(end(30), end(7));
    let (mut first, eave, _) = street();
    run(&mut first, 40);
    let saved = RainSnapshot::save(first.world()).expect("can be written");
    assert!(saved.parts().any(|part| part == "spouts"));
    let (mut other, other_eave, _) = street();
    saved.restore(other.world_mut()).expect("fits");
    for app in [&mut first, &mut other] {
        run(app, 30);
    }
    assert_eq!(state_hash(other.world()), state_hash(first.world()));
    assert_eq!(water(&other, other_eave), water(&first, eave));
    let broken = saved.with_part("spouts", |text| text.replacen("pores", "poros", 1));
    assert!(broken.restore(other.world_mut()).is_err());
    other.world_mut().despawn(other_eave);
    let refused = saved.restore(other.world_mut()).expect_err("a spout is missing");
    assert!(refused.to_string().contains("spouts"), "{refused}");
}

#[test]
fn bad_spouts_are_named_and_the_last_good_one_goes_on() {
    type Set = fn(&mut Spout, f32);
    let fields: [(&str, Set, [f32; 2]); 5] = [
        (
            "length_m",
            |s, v| s.form = SpoutForm::Eave { length_m: v },
            [0.0, 2000.0],
        ),
        (
            "diameter_m",
            |s, v| s.form = SpoutForm::Pipe { diameter_m: v },
            [0.0, 3.0],
        ),
        ("catchment_m2", |s, v| s.catchment_m2 = v, [-1.0, 2e6]),
        ("slope", |s, v| s.slope = v, [0.0, 11.0]),
        ("flow_length_m", |s, v| s.flow_length_m = v, [0.0, 2000.0]),
    ];
    assert!(Spout::default().validated().is_ok() && Spout::pipe(0.1, 20.0).validated().is_ok());
    let (mut app, eave, pipe) = street();
    app.world_mut().get_mut::<Spout>(pipe).expect("a spout").feeds_ground = false;
    run(&mut app, 60);
    for (name, set, bad) in fields {
        for bad in bad.into_iter().chain([f32::NAN, f32::INFINITY]) {
            let mut spout = Spout::eave(4.0, 5.0);
            set(&mut spout, bad);
            let message = spout.validated().expect_err("refused").to_string();
            assert!(message.starts_with(name), "{message}");
            *app.world_mut().get_mut::<Spout>(eave).expect("a spout") = spout;
            frame(&mut app, 40_000_000);
            let mut errors = app.world_mut().resource_mut::<Messages<RainConfigError>>();
            let told: Vec<_> = errors.drain().collect();
            assert!(
                told.len() == 1 && told[0].entity == eave && told[0].error.to_string().starts_with(name),
                "{told:?}"
            );
        }
    }
    assert_eq!(water(&app, eave).spout(), Some(&Spout::eave(4.0, 5.0)));
    // A scale of 0 has no direction: the water comes down all the same.
    let added = |app: &App| app.world().resource::<SurfaceGround>().ledger().added_m3;
    app.world_mut().get_mut::<Transform>(eave).expect("a spout").scale = Vec3::ZERO;
    let (had, earlier) = (added(&app), water(&app, eave).poured_m3());
    run(&mut app, 5);
    let poured = water(&app, eave).poured_m3() - earlier;
    assert!(
        poured > 0.0 && (added(&app) - had - poured).abs() < 1e-9 * poured,
        "{poured}"
    );
    // A place that is no number pours nothing and breaks nothing.
    let before = water(&app, eave).poured_m3();
    app.world_mut()
        .get_mut::<Transform>(eave)
        .expect("a spout")
        .translation
        .x = f32::NAN;
    run(&mut app, 5);
    assert_eq!(water(&app, eave).poured_m3(), before);
}
