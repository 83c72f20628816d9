//! Sunlight that a pond throws onto the wall behind it.

use bevy::prelude::*;
use image::RgbImage;
use rain_plugins::prelude::*;
use test_support::app::FRAME;
use test_support::{gpu, world};

use crate::pond::{At, Pond, SIZE};

/// Height of the sun: light from over the pond's middle reaches the wall some 1.1 m up.
const ELEVATION_DEG: f32 = 20.0;

/// The pond before a grey wall that the sun shines on from behind the eye.
fn scene() -> (Pond, Entity) {
    let mut pond = Pond::new(Vec3::new(0.0, 1.3, 3.5), Vec3::new(0.0, 1.1, -3.0));
    let world = pond.test.world();
    let wall = world::block(
        world,
        "wall",
        Vec3::new(-6.0, -0.5, -3.4),
        Vec3::new(6.0, 3.0, -3.0),
        [0.12; 3],
    );
    world.entity_mut(wall).insert(MovesInRain);
    let sun = world
        .query_filtered::<Entity, With<DirectionalLight>>()
        .single(world)
        .expect("one sun");
    let (sine, cosine) = ELEVATION_DEG.to_radians().sin_cos();
    world
        .entity_mut(sun)
        .insert(Transform::default().looking_to(-Vec3::new(0.0, sine, cosine), Vec3::Y));
    pond.weather(Weather::rain(60.0));
    pond.test.leap(1200);
    pond.test.frames(3, FRAME);
    (pond, sun)
}

/// Brightness that `b` has over `a` in pixels of the wall, x in shares of the picture's width.
fn gain(a: &RgbImage, b: &RgbImage, x: [f64; 2]) -> Vec<f64> {
    let columns = |share: f64| (share * f64::from(SIZE[0])) as u32;
    // Rows that show the wall from 0.8 to 1.5 m.
    let pixels = (columns(x[0])..columns(x[1])).flat_map(|x| (36..52).map(move |y| [x, y]));
    let green = |picture: &RgbImage, [x, y]: At| f64::from(picture.get_pixel(x, y).0[1]);
    pixels.map(|at| green(b, at) - green(a, at)).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn a_pond_in_the_sun_throws_light_onto_a_wall_broken_up_by_the_rain() {
    if !gpu::available() {
        return;
    }
    let (mut pond, sun) = scene();
    assert_eq!(pond.test.recorded(PassName::Caustics), 0, "off by default");
    assert!(pond.test.skipped(PassName::Caustics, SkipReason::Disabled) > 0);
    // Switched on over still water: its light is worked out once.
    pond.weather(Weather::rain(0.0));
    pond.test.leap(60);
    let dark = pond.test.picture();
    pond.appearance(|look| look.caustics = 1.0);
    pond.test.frames(3, FRAME);
    let lit = pond.test.picture();
    let before = mean(&gain(&dark, &lit, [0.4, 0.6]));
    let beside = mean(&gain(&dark, &lit, [0.0, 0.1]));
    assert!(before > 2.0, "{before}");
    assert!(beside.abs() < 0.3, "no water before this part: {beside}");
    pond.test.reset();
    pond.test.frames(5, FRAME);
    assert_eq!(pond.test.recorded(PassName::Caustics), 0);
    assert!(pond.test.skipped(PassName::Caustics, SkipReason::Settled) >= 5);

    // From nearby rings are seen: they part and gather the light.
    pond.look(Vec3::new(0.0, 1.1, -2.0), Vec3::new(0.0, 1.1, -3.0));
    pond.appearance(|look| look.caustics = 0.0);
    let dark = pond.test.picture();
    pond.appearance(|look| look.caustics = 4.0);
    let still = pond.test.picture();
    pond.weather(Weather::rain(60.0));
    pond.test.leap(2);
    assert!(pond.test.recorded(PassName::Caustics) > 0);
    let rainy = pond.test.picture();
    let [broken, even] = [&rainy, &still].map(|picture| gain(&dark, picture, [0.3, 0.7]));
    assert!(
        mean(&even) > 5.0 && mean(&broken) > 5.0,
        "{} {}",
        mean(&even),
        mean(&broken)
    );
    let [broken, even] = [broken, even].map(|gains| {
        let about = mean(&gains);
        (mean(&gains.iter().map(|g| (g - about).powi(2)).collect::<Vec<_>>())).sqrt()
    });
    assert!(broken > 1.0 && broken > 2.0 * even, "{broken} {even}");

    // No sun, no light.
    pond.appearance(|look| look.caustics = 1.0);
    pond.test.world().entity_mut(sun).insert(Visibility::Hidden);
    pond.test.frames(2, FRAME);
    pond.test.reset();
    pond.test.frames(3, FRAME);
    assert!(pond.test.skipped(PassName::Caustics, SkipReason::NoSun) >= 3);
}
