//! Clouds of the rain in a Bevy app: what they take from the sun and the sky, and when.

use std::time::Duration;

use bevy::prelude::*;
use rain_core::optics::{
    CLOUD_ASYMMETRY, CLOUD_DROP_RADIUS_M, RAIN_COLUMN_M, cloud_optical_depth, cloud_transmittance, cloud_water_kg_m2,
};
use rain_plugins::prelude::*;
use test_support::app::TestApp;
use test_support::{gpu, world};

const LUX: f32 = 80_000.0;
const SECOND: Duration = Duration::from_secs(1);

fn scene(rate: f64, light: CloudLight) -> (TestApp, Entity) {
    let mut test = TestApp::new([16, 16], true);
    let world = test.world();
    let sun = world
        .query_filtered::<Entity, With<DirectionalLight>>()
        .single(world)
        .expect("one sun");
    world.entity_mut(sun).insert(light);
    world.get_mut::<DirectionalLight>(sun).expect("a sun").illuminance = LUX;
    world.spawn(Weather::rain(rate));
    (test, sun)
}

fn lux(test: &mut TestApp, sun: Entity) -> f32 {
    test.world().get::<DirectionalLight>(sun).expect("a sun").illuminance
}

fn depth(rate: f64) -> f64 {
    cloud_optical_depth(cloud_water_kg_m2(rate, RAIN_COLUMN_M), CLOUD_DROP_RADIUS_M)
}

#[test]
fn clouds_gather_with_the_rain_break_after_it_and_keep_what_the_app_sets() {
    if !gpu::available() {
        return;
    }
    let half = CloudLight {
        cover: 0.5,
        transition_s: 10.0,
        tint: LinearRgba::rgb(0.8, 0.9, 1.0),
        ..default()
    };
    let (mut test, sun) = scene(0.0, half);
    test.frames(3, SECOND);
    assert_eq!(lux(&mut test, sun), LUX, "no cloud without rain");
    let world = test.world();
    let weather = world
        .query_filtered::<Entity, With<Weather>>()
        .single(world)
        .expect("a weather");
    world.entity_mut(weather).insert(Weather::rain(10.0));
    test.frames(6, SECOND);
    let gathering = lux(&mut test, sun);
    assert!(gathering < 0.9 * LUX && gathering > 0.55 * LUX, "{gathering}");
    test.frames(20, SECOND);
    // A rain cloud lets nothing straight through: what is left is what it does not cover.
    let gathered = lux(&mut test, sun);
    assert!((gathered / LUX - 0.5).abs() < 1e-3, "{gathered}");
    let colour = test
        .world()
        .get::<DirectionalLight>(sun)
        .expect("a sun")
        .color
        .to_linear();
    assert!(
        (colour.red - 0.9).abs() < 0.01 && (colour.blue - 1.0).abs() < 0.01,
        "{colour:?}"
    );
    // The app's own evening goes on.
    test.world()
        .get_mut::<DirectionalLight>(sun)
        .expect("a sun")
        .illuminance = 20_000.0;
    test.frames(2, SECOND);
    assert!((lux(&mut test, sun) / 10_000.0 - 1.0).abs() < 1e-3);
    test.world().entity_mut(weather).insert(Weather::rain(0.0));
    test.frames(30, SECOND);
    assert!((lux(&mut test, sun) / 20_000.0 - 1.0).abs() < 1e-3);
    let colour = test
        .world()
        .get::<DirectionalLight>(sun)
        .expect("a sun")
        .color
        .to_linear();
    assert!((colour.red - 1.0).abs() < 1e-3, "{colour:?}");
}

#[test]
fn heavier_rain_has_a_darker_sky() {
    if !gpu::available() {
        return;
    }
    let mut before = 1.0;
    for rate in [1.0, 10.0, 50.0] {
        let (mut test, _) = scene(rate, CloudLight::default());
        let camera = test.camera;
        let map = world::cube_of(test.world(), [true; 3]);
        test.world().entity_mut(camera).insert((
            EnvironmentMapLight {
                diffuse_map: map.clone(),
                specular_map: map,
                intensity: 3000.0,
                ..default()
            },
            CloudLight::default(),
        ));
        test.frames(4, SECOND);
        let found = test
            .world()
            .get::<EnvironmentMapLight>(camera)
            .expect("a map")
            .intensity
            / 3000.0;
        let light = |rate| cloud_transmittance(depth(rate), CLOUD_ASYMMETRY);
        let expected = light(rate) / light(0.0);
        assert!((f64::from(found) - expected).abs() < 1e-3, "{rate}: {found} {expected}");
        assert!(found < before);
        before = found;
    }
    // Without the component nothing is touched.
    let (mut test, sun) = scene(50.0, CloudLight::default());
    test.frames(4, SECOND);
    assert!(lux(&mut test, sun) < 0.01 * LUX);
    test.world().entity_mut(sun).remove::<CloudLight>();
    test.frames(4, SECOND);
    assert_eq!(lux(&mut test, sun), LUX);
}
