//! Wetness, water level and the simulation of water, set by hand while the app runs.

use bevy::prelude::*;
use rain_plugins::prelude::*;
use rain_plugins::surface::WaterLevels;
use test_support::app::FRAME;
use test_support::{gpu, world};

use crate::pond::{Pond, SIZE, difference, mean};

const EYE: Vec3 = Vec3::new(0.0, 2.0, 4.0);

fn brightness([r, g, b]: [f64; 3]) -> f64 {
    (r + g + b) / 3.0
}

#[test]
fn wetness_and_level_by_hand_show_without_rain_and_leave_no_trace() {
    if !gpu::available() {
        return;
    }
    let mut pond = Pond::new(EYE, Vec3::ZERO);
    let dry = pond.test.picture();
    // Dry ground all over the lower half.
    let ground = pond.pixels(|depth| depth == 0.0);
    let seen = [0.5, 1.0].map(|wetness| {
        pond.by_hand(Some(wetness), None);
        let picture = pond.test.picture();
        mean(&picture, &ground, brightness)
    });
    let before = mean(&dry, &ground, brightness);
    assert!(seen[0] < before - 4.0 && seen[1] < seen[0] - 4.0, "{before} {seen:?}");

    // Levels: the hollow floods from its bottom, and what it covers grows.
    let mut last = 0;
    for level in [0.3, 0.6, 1.0] {
        pond.by_hand(Some(0.0), Some(level));
        let deep = pond.pixels(|depth| depth > 0.0);
        assert!(deep.len() > last + 100, "{level}: {} pixels, {last} before", deep.len());
        last = deep.len();
    }
    let deep = pond.pixels(|depth| depth > 0.01);
    let full = pond.test.picture();
    assert!(
        difference(&dry, &full, &deep) > 8.0,
        "{}",
        difference(&dry, &full, &deep)
    );
    assert!(pond.test.recorded(PassName::Reflection) > 0);
    assert_eq!(pond.test.world().resource::<SurfaceGround>().ledger().basins_m3, 0.0);

    let weather = pond.weather;
    pond.test.world().entity_mut(weather).remove::<WaterByHand>();
    pond.test.frames(8, FRAME);
    assert!(!pond.test.world().resource::<WaterLevels>().any_water());
    assert!(pond.test.picture() == dry, "the dry picture is what it was");
}

#[test]
fn the_weather_goes_on_under_what_is_set_by_hand() {
    if !gpu::available() {
        return;
    }
    let mut pond = Pond::new(EYE, Vec3::ZERO);
    pond.weather(Weather::rain(60.0));
    pond.by_hand(Some(0.0), Some(0.0));
    pond.test.leap(1200);
    pond.test.frames(3, FRAME);
    let state = pond
        .test
        .world()
        .get::<WeatherState>(pond.weather)
        .expect("its state")
        .clone();
    assert_eq!(
        (
            state.wetness(SurfaceClass::Asphalt),
            state.water_level_mm(SurfaceClass::Asphalt)
        ),
        (0.0, 0.0)
    );
    assert!(
        !pond.test.world().resource::<WaterLevels>().any_water(),
        "held dry in a storm"
    );
    let basins = pond.test.world().resource::<SurfaceGround>().ledger().basins_m3;
    assert!(basins > 0.01, "{basins}");
    let weather = pond.weather;
    pond.test.world().entity_mut(weather).remove::<WaterByHand>();
    pond.test.frames(8, FRAME);
    assert!(pond.test.world().resource::<WaterLevels>().depth_at(0.0, 0.0) > 0.01);
}

#[test]
fn a_mesh_is_wetted_by_hand_alone() {
    if !gpu::available() {
        return;
    }
    let mut pond = Pond::new(Vec3::new(0.0, 6.0, 5.0), Vec3::ZERO);
    let plates = [-1.5_f32, 1.5].map(|x| {
        let (low, high) = (Vec3::new(x - 1.0, 0.2, -1.0), Vec3::new(x + 1.0, 0.3, 1.0));
        world::block(pond.test.world(), "plate", low, high, world::STONE)
    });
    pond.test.frames(3, FRAME);
    let at = |x: f32| {
        let column = (0.5 * SIZE[0] as f32 + x * 14.0) as u32;
        (0..6)
            .flat_map(|dy| (0..6).map(move |dx| [column + dx - 3, 40 + dy]))
            .collect::<Vec<_>>()
    };
    let (left, right) = (at(-1.5), at(1.5));
    let dry = pond.test.picture();
    let set = |pond: &mut Pond, wetness: Option<f32>| {
        let wetting = SurfaceWetting { wetness, ..default() };
        pond.test.world().entity_mut(plates[0]).insert(wetting);
        pond.test.frames(4, FRAME);
        pond.test.picture()
    };
    let wet = set(&mut pond, Some(1.0));
    let [before, after] = [&dry, &wet].map(|p| mean(p, &left, brightness));
    assert!(after < before - 8.0, "{before} {after}");
    assert!(difference(&dry, &wet, &right) < 1.0, "its neighbour stays dry");
    // Set to 0 it stays as light as it was in soaked weather; the neighbour darkens.
    set(&mut pond, Some(0.0));
    pond.by_hand(Some(1.0), None);
    let soaked = pond.test.picture();
    assert!((mean(&soaked, &left, brightness) - before).abs() < 3.0);
    assert!(mean(&soaked, &right, brightness) < mean(&dry, &right, brightness) - 8.0);
    // What is no share counts as dry, and nothing by hand as the weather.
    set(&mut pond, Some(f32::NAN));
    let plain = set(&mut pond, None);
    assert!(mean(&plain, &left, brightness) < before - 8.0);
}

#[test]
fn the_simulation_of_water_is_switched_while_the_app_runs() {
    if !gpu::available() {
        return;
    }
    let mut pond = Pond::new(EYE, Vec3::ZERO);
    pond.weather(Weather::rain(30.0));
    pond.by_hand(Some(1.0), Some(1.0));
    let level = pond
        .test
        .world()
        .resource::<WaterLevels>()
        .surface_at(0.0, 0.0)
        .expect("a pond");
    let foot = pond
        .test
        .world()
        .spawn((
            WaterDisturber {
                radius_m: 0.05,
                ..default()
            },
            Transform::from_xyz(0.0, level, 0.0),
        ))
        .id();
    let walk = |pond: &mut Pond| {
        pond.test.reset();
        for step in 1..5_u8 {
            let at = Transform::from_xyz(0.1 * f32::from(step), level, 0.0);
            pond.test.world().entity_mut(foot).insert(at);
            pond.test.frames(1, FRAME);
        }
        let contact = *pond.test.world().get::<WaterContact>(foot).expect("its water");
        let recorded = [PassName::Waves, PassName::Ripples].map(|pass| pond.test.recorded(pass));
        (recorded, contact)
    };
    let switch = |pond: &mut Pond, no_waves: bool, no_rings: bool| {
        let mut settings = pond.test.world().resource_mut::<WaveWaterSettings>();
        (settings.no_waves, settings.no_rings) = (no_waves, no_rings);
        pond.test.frames(3, FRAME);
    };
    let on = |passes: u64| passes > 0;
    let (recorded, contact) = walk(&mut pond);
    assert!(recorded.map(on) == [true, true], "{recorded:?}");
    // The same look-up that makes the waves knows how deep the water is, as gameplay does.
    assert_eq!(contact.surface_m, Some(level));
    let place = bevy::math::DVec3::new(0.4, f64::from(level), 0.0);
    let asked = bevy::ecs::system::RunSystemOnce::run_system_once(pond.test.world(), move |q: RainQueries| {
        q.water_at(place).puddle_m
    })
    .expect("runs");
    // Between the cells' middles the ground is interpolated.
    assert!(
        (asked - f64::from(contact.depth_m)).abs() < 0.004 && contact.depth_m > 0.02,
        "{asked} {contact:?}"
    );

    switch(&mut pond, true, false);
    let (recorded, contact) = walk(&mut pond);
    assert!(recorded.map(on) == [false, true], "{recorded:?}");
    assert!(pond.test.skipped(PassName::Waves, SkipReason::Disabled) >= 4);
    assert_eq!(contact, WaterContact::default(), "nothing splashes either");
    switch(&mut pond, false, true);
    let (recorded, _) = walk(&mut pond);
    assert!(recorded.map(on) == [true, false], "{recorded:?}");
    assert!(pond.test.skipped(PassName::Ripples, SkipReason::Disabled) >= 4);
    switch(&mut pond, false, false);
    assert!(walk(&mut pond).0.map(on) == [true, true]);
}
