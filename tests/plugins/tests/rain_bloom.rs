//! Bloom that grows with the rain in a Bevy app.

use std::time::Duration;

use bevy::post_process::bloom::{Bloom, BloomCompositeMode};
use bevy::prelude::*;
use rain_core::haze::{bloom_in_rain, extinction_per_m};
use rain_core::rainfall::{Distribution, Spectrum};
use rain_plugins::prelude::*;
use test_support::app::TestApp;
use test_support::gpu;

const SECOND: Duration = Duration::from_secs(1);

fn bloom(test: &mut TestApp) -> [f32; 2] {
    let camera = test.camera;
    let bloom = test.world().get::<Bloom>(camera).expect("a bloom");
    [bloom.intensity, bloom.low_frequency_boost]
}

fn set(test: &mut TestApp, rate: f64) {
    let world = test.world();
    let weather = world
        .query_filtered::<Entity, With<Weather>>()
        .single(world)
        .expect("a weather");
    world.entity_mut(weather).insert(Weather::rain(rate));
}

#[test]
fn bloom_widens_with_the_rain_and_the_apps_own_comes_back() {
    if !gpu::available() {
        return;
    }
    let mut test = TestApp::new([16, 16], true);
    let camera = test.camera;
    let settings = RainBloom {
        way_m: 200.0,
        ..default()
    };
    test.world().entity_mut(camera).insert((Bloom::NATURAL, settings));
    test.world().spawn(Weather::rain(0.0));
    test.frames(3, SECOND);
    assert_eq!(bloom(&mut test), [0.15, 0.7], "nothing without rain");

    set(&mut test, 25.0);
    test.frames(3, SECOND);
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 25.0).expect("inside the domain");
    let depth = 200.0 * extinction_per_m(&spectrum, 1.0);
    let expected = bloom_in_rain(f64::from(0.15_f32), f64::from(0.7_f32), depth);
    for (found, expected) in bloom(&mut test).into_iter().zip(expected) {
        assert!((f64::from(found) - expected).abs() < 1e-4, "{found} {expected}");
    }
    assert!(bloom(&mut test)[0] > 0.25, "{:?}", bloom(&mut test));

    // The app's own change amid the rain counts as the bloom without it.
    test.world().get_mut::<Bloom>(camera).expect("a bloom").intensity = 0.3;
    test.frames(2, SECOND);
    let [found, _] = bloom(&mut test);
    assert!((f64::from(found) - bloom_in_rain(f64::from(0.3_f32), 0.7, depth)[0]).abs() < 1e-4);

    // Adding blooms may exceed the picture.
    let own = Bloom {
        intensity: 1.5,
        composite_mode: BloomCompositeMode::Additive,
        ..Bloom::OLD_SCHOOL
    };
    test.world().entity_mut(camera).insert(own);
    test.frames(2, SECOND);
    let [found, _] = bloom(&mut test);
    assert!(
        (f64::from(found) - 1.5 - (1.0 - (-depth).exp())).abs() < 1e-4,
        "{found}"
    );

    // A bad setting is named and the last good one stays.
    let before = bloom(&mut test);
    test.world().entity_mut(camera).insert(RainBloom {
        way_m: f32::NAN,
        ..default()
    });
    test.frames(1, SECOND);
    let errors = test.app.world().resource::<Messages<RainConfigError>>();
    let named = errors
        .iter_current_update_messages()
        .any(|e| e.error.to_string().contains("way_m"));
    assert!(named);
    assert_eq!(bloom(&mut test), before);

    test.world().entity_mut(camera).remove::<RainBloom>();
    test.frames(2, SECOND);
    assert_eq!(bloom(&mut test), [1.5, 0.7]);
}
