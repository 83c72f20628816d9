//! What grows and is ploughed beside a country road: a meadow, a field of furrows.

use super::{Picture, Texel, bake};
use crate::noise::{cellular, fbm, smoothstep};
use glam::vec3;

/// Size of the meadow's tile, metres.
pub const MEADOW_M: f32 = 4.0;
/// Size of the furrows' tile, metres; furrows run along its v.
pub const FURROWS_M: f32 = 3.0;
/// Furrows in a tile.
const FURROWS: f32 = 8.0;

/// Grass of some 8 cm in tufts, with clover and dead blades.
#[must_use]
pub fn meadow(seed: u32) -> Vec<Picture> {
    bake("meadow", [512, 512], [MEADOW_M; 2], move |u, v| {
        let tuft = cellular(seed ^ 500, u, v, 42);
        let blade = fbm(seed ^ 501, u, v, 170, 90, 2) - 0.5;
        let patch = fbm(seed ^ 502, u, v, 3, 3, 4) - 0.5;
        let dead = smoothstep(0.58, 0.75, fbm(seed ^ 503, u, v, 24, 24, 3));
        let lush = vec3(0.075, 0.125, 0.04).lerp(vec3(0.115, 0.15, 0.055), tuft.id);
        let albedo = lush.lerp(vec3(0.19, 0.165, 0.085), 0.6 * dead) * (1.0 + 0.7 * patch + 0.9 * blade);
        let high = 0.05 * (1.0 - tuft.near).max(0.0) + 0.03 * blade;
        let mut t = Texel::new(albedo.clamp(vec3(0.01, 0.01, 0.01), vec3(0.3, 0.3, 0.3)), high, 0.92);
        t.open = 0.55 + 0.45 * (1.0 - tuft.near).clamp(0.0, 1.0);
        t
    })
}

/// Ploughed loam in furrows, clods and a few stalks.
#[must_use]
pub fn furrows(seed: u32) -> Vec<Picture> {
    bake("furrows", [512, 512], [FURROWS_M; 2], move |u, v| {
        let sway = 0.25 * (fbm(seed ^ 510, u, v, 4, 4, 3) - 0.5);
        let across = ((u * FURROWS + sway).rem_euclid(1.0) - 0.5).abs() * 2.0;
        let ridge = smoothstep(0.15, 0.9, across);
        let clod = cellular(seed ^ 511, u, v, 60);
        let lump = (1.0 - clod.near * 1.4).max(0.0) * (0.3 + 0.7 * clod.id);
        let grain = fbm(seed ^ 512, u, v, 128, 128, 3) - 0.5;
        let loam = vec3(0.15, 0.11, 0.075) * (0.75 + 0.4 * ridge + 0.35 * lump + 0.5 * grain);
        let mut t = Texel::new(loam, 0.09 * ridge + 0.03 * lump + 0.004 * grain, 0.95);
        t.open = 0.6 + 0.4 * ridge;
        t
    })
}
