//! What stops rain, against every drop's way cast through every triangle.

mod air;
mod lookup;
mod map;
mod shares;

use glam::{DVec2, DVec3};
use rain_core::cover::{CoverScene, CoverSettings, FallSlope, OccluderId};
use rain_core::hash::{pcg3d, unit_f32};
use rain_reference::cover::{Triangle, block};

/// Flux mean of 1/u at 25 mm/h. Units: s/m.
const MEAN: f64 = 0.169;

/// Three random numbers in [0, 1).
fn random(a: u32, b: u32, c: u32) -> [f64; 3] {
    pcg3d([a, b, c]).map(|h| f64::from(unit_f32(h)))
}

fn slope(wind: [f64; 2]) -> FallSlope {
    FallSlope::new(DVec2::from(wind), MEAN).expect("inside the domain")
}

/// A map of these triangles.
fn scene(triangles: &[Triangle], cell_m: f64, wind: [f64; 2]) -> CoverScene {
    let settings = CoverSettings {
        cell_m,
        ..Default::default()
    };
    let mut scene = CoverScene::new(settings, slope(wind)).expect("valid");
    let triangles: Vec<_> = triangles.iter().map(|t| t.map(DVec3::from)).collect();
    scene.add(OccluderId(1), &triangles).expect("small");
    scene.update();
    scene
}

/// Triangles of 2 to 14 m in any position, at 1 to 9 m above the ground.
fn shards(seed: u32, count: u32) -> Vec<Triangle> {
    (0..count)
        .map(|i| {
            let [x, y, z] = random(seed, i, 0);
            let middle = [50.0 * x - 25.0, 2.0 + 6.0 * y, 50.0 * z - 25.0];
            [1, 2, 3].map(|k| {
                let [a, b, c] = random(seed, i, k);
                let off = [7.0 * (a - 0.5), 2.0 * (b - 0.5), 7.0 * (c - 0.5)];
                [0, 1, 2].map(|axis| middle[axis] + off[axis])
            })
        })
        .collect()
}
