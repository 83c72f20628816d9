//! Small pictures without relief: awning cloth, zinc.

use super::{Picture, srgb};
use crate::noise::{fbm, smoothstep};
use glam::vec3;

/// Striped awning cloth, a tile of 1 m: two stripes each of red and cream.
#[must_use]
pub fn awning(seed: u32) -> Picture {
    Picture::new("awning-color", 256, 256, 3, move |px, py| {
        let (u, v) = ((px as f32 + 0.5) / 256.0, (py as f32 + 0.5) / 256.0);
        let s = ((u * 2.0).fract() - 0.5).abs();
        let cream = smoothstep(0.245, 0.255, s);
        let weave = 0.9 + 0.2 * fbm(seed ^ 300, u, v, 64, 64, 1);
        let dirt = 0.75 + 0.4 * fbm(seed ^ 301, u, v, 3, 3, 4);
        let c = vec3(0.26, 0.03, 0.028).lerp(vec3(0.52, 0.47, 0.36), cream) * (weave * dirt);
        [srgb(c.x), srgb(c.y), srgb(c.z), 255]
    })
}

/// Weathered zinc: base colour, then occlusion-roughness-metalness; a tile of 1 m.
#[must_use]
pub fn zinc(seed: u32) -> Vec<Picture> {
    let at = |k: u32| (k as f32 + 0.5) / 128.0;
    let cloud = move |x: u32, y: u32| fbm(seed ^ 310, at(x), at(y), 5, 3, 4);
    vec![
        Picture::new("zinc-color", 128, 128, 3, move |x, y| {
            let a = 0.16 + 0.2 * cloud(x, y);
            [srgb(a * 0.97), srgb(a), srgb(a * 1.03), 255]
        }),
        Picture::new("zinc-orm", 128, 128, 3, move |x, y| {
            let rough = 0.4 + 0.35 * cloud(x, y);
            [255, ((rough * 32.0) as u8) * 8, 200, 255]
        }),
    ]
}
