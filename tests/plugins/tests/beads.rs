//! Drops that stand on paint and glass.

use bevy::prelude::*;
use image::RgbImage;
use rain_plugins::prelude::*;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

const SIZE: [u32; 2] = [240, 160];

/// A wet block seen from 14 cm above, its roughness and what refines it.
fn top(roughness: f32, wetness: f64, wetting: SurfaceWetting, moved: Vec3) -> RgbImage {
    let mut test = TestApp::new(SIZE, true);
    world::without_ground(test.world());
    let material = test
        .world()
        .resource_mut::<Assets<StandardMaterial>>()
        .add(StandardMaterial {
            base_color: Color::linear_rgb(0.2, 0.02, 0.02),
            perceptual_roughness: roughness,
            ..default()
        });
    let (low, high) = (Vec3::new(-0.5, -0.5, -0.5) + moved, Vec3::new(0.5, 0.0, 0.5) + moved);
    let block = world::block_of(test.world(), "block", low, high, material);
    test.world().entity_mut(block).insert(wetting);
    let by_hand = WaterByHand {
        wetness: Some(wetness),
        ..default()
    };
    test.world().spawn((Weather::rain(0.0), by_hand));
    test.look(Vec3::new(0.0, 0.14, 0.0) + moved, moved);
    test.frames(8, FRAME);
    test.picture()
}

/// Mean square difference of neighbouring pixels' brightness.
fn unevenness(picture: &RgbImage) -> f64 {
    let bright = |x: u32, y: u32| picture.get_pixel(x, y).0.iter().map(|&c| f64::from(c)).sum::<f64>() / 3.0;
    let mut sum = 0.0;
    for y in 20..SIZE[1] - 20 {
        for x in 20..SIZE[0] - 20 {
            sum += (bright(x + 1, y) - bright(x, y)).powi(2);
        }
    }
    sum / f64::from((SIZE[0] - 40) * (SIZE[1] - 40))
}

fn apart(a: &RgbImage, b: &RgbImage) -> f64 {
    let sum: f64 = a.iter().zip(b.iter()).map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
    sum / a.len() as f64
}

#[test]
fn drops_stand_on_paint_and_not_on_stone_and_follow_what_moves() {
    if !gpu::available() {
        return;
    }
    let plain = SurfaceWetting::default();
    let paint = top(0.2, 1.0, plain, Vec3::ZERO);
    let [dry, stone] = [top(0.2, 0.0, plain, Vec3::ZERO), top(0.9, 1.0, plain, Vec3::ZERO)];
    // What a lamp's highlight and eight bits make of an even surface.
    let even = unevenness(&dry).max(0.1);
    assert!(unevenness(&stone) < 4.0 * even, "stone is even: {}", unevenness(&stone));
    assert!(
        unevenness(&paint) > 20.0 * even,
        "drops on paint show: {}",
        unevenness(&paint)
    );
    let beads = |share| SurfaceWetting {
        beads: Some(share),
        ..default()
    };
    let film = top(0.2, 1.0, beads(0.0), Vec3::ZERO);
    assert!(
        unevenness(&film) < 4.0 * even,
        "none are asked for: {}",
        unevenness(&film)
    );
    let asked = top(0.9, 1.0, beads(1.0), Vec3::ZERO);
    assert!(
        unevenness(&asked) > 20.0 * even,
        "drops on stone, asked for: {}",
        unevenness(&asked)
    );
    // The same drops on a block elsewhere.
    let far = top(0.2, 1.0, plain, Vec3::new(37.5, 2.0, -12.25));
    assert!(apart(&paint, &far) < 0.5, "{}", apart(&paint, &far));
    assert!(apart(&paint, &film) > 2.0, "{}", apart(&paint, &film));
}
