//! What houses are made of: plaster, brick, cut stone, roof tiles, wood, zinc.

use super::{Picture, Texel, bake};
use crate::noise::{fbm, lattice, smoothstep, value};
use glam::vec3;

/// Size of the plaster tile, metres.
pub const PLASTER_M: f32 = 4.0;
/// Size of the brick tile, metres.
pub const BRICK_M: f32 = 1.8;
/// Size of the stone tile, metres.
pub const STONE_M: f32 = 2.0;
/// Size of the roof tile tile, metres.
pub const ROOF_M: f32 = 2.4;
/// Size of the wood tile, metres.
pub const WOOD_M: f32 = 1.2;

/// Lime plaster near white (tinted by the material), with dirt that water has drawn down.
#[must_use]
pub fn plaster(seed: u32) -> Vec<Picture> {
    bake("plaster", [512, 512], [PLASTER_M; 2], move |u, v| {
        let trowel = fbm(seed ^ 200, u, v, 12, 9, 5) - 0.5;
        let grain = fbm(seed ^ 201, u, v, 170, 170, 2) - 0.5;
        // Streaks: fine across, long down, and only here and there.
        let streak = smoothstep(0.45, 0.85, fbm(seed ^ 202, u, v, 28, 2, 4))
            * smoothstep(0.35, 0.8, fbm(seed ^ 203, u, v, 4, 3, 3));
        let cloud = fbm(seed ^ 204, u, v, 3, 3, 4) - 0.5;
        let a = 0.66 + 0.12 * cloud + 0.06 * trowel + 0.04 * grain - 0.17 * streak;
        let albedo = vec3(1.0, 0.985, 0.955) * a.clamp(0.2, 0.8);
        Texel::new(albedo, 0.007 * trowel + 0.002 * grain, 0.92 + 0.06 * cloud)
    })
}

/// Brick in stretcher bond: 8 bricks by 24 courses in a tile.
#[must_use]
pub fn brick(seed: u32) -> Vec<Picture> {
    bake("brick", [768, 768], [BRICK_M; 2], move |u, v| {
        let row = (v * 24.0).floor();
        let x = u * 8.0 + 0.5 * (row % 2.0);
        let col = (x.floor() as i32).rem_euclid(8);
        let (fx, fy) = ((x - x.floor()) * 0.225, (v * 24.0 - row) * 0.075);
        let edge = fx.min(0.225 - fx).min(fy.min(0.075 - fy));
        let rough = 0.004 * (fbm(seed ^ 210, u, v, 60, 60, 3) - 0.5);
        let brick = smoothstep(0.0045, 0.0085, edge + rough);
        let id = lattice(seed ^ 211, col, row as i32);
        let hue = lattice(seed ^ 212, col, row as i32);
        let grain = fbm(seed ^ 213, u, v, 120, 120, 3) - 0.5;
        let cloud = fbm(seed ^ 214, u, v, 3, 3, 3) - 0.5;
        let red = vec3(0.30, 0.125, 0.078).lerp(vec3(0.21, 0.088, 0.066), id);
        let red = red.lerp(vec3(0.33, 0.175, 0.1), smoothstep(0.75, 1.0, hue)) * (1.0 + 0.7 * grain + 0.45 * cloud);
        let burnt = if hue < 0.07 { 0.5 } else { 1.0 };
        let mortar = vec3(0.33, 0.31, 0.275) * (0.85 + 0.6 * cloud + 0.4 * grain);
        let face = 0.002 * (id - 0.5) + 0.0012 * grain;
        let mut t = Texel::new(
            mortar.lerp(red * burnt, brick),
            brick * 0.006 + face,
            0.9 + 0.06 * grain,
        );
        t.open = 0.7 + 0.3 * brick;
        t
    })
}

/// Ashlar of pale sandstone: blocks of 50 by 25 cm with fine joints.
#[must_use]
pub fn stone(seed: u32) -> Vec<Picture> {
    bake("stone", [512, 512], [STONE_M; 2], move |u, v| {
        let row = (v * 8.0).floor();
        let x = u * 4.0 + 0.5 * (row % 2.0);
        let col = (x.floor() as i32).rem_euclid(4);
        let (fx, fy) = ((x - x.floor()) * 0.5, (v * 8.0 - row) * 0.25);
        let edge = fx.min(0.5 - fx).min(fy.min(0.25 - fy));
        let block = smoothstep(0.002, 0.008, edge);
        let id = lattice(seed ^ 220, col, row as i32);
        let grain = fbm(seed ^ 221, u, v, 90, 140, 3) - 0.5;
        let layer = value(seed ^ 222, u, v, 3, 80) - 0.5;
        let stain = fbm(seed ^ 223, u, v, 3, 3, 4) - 0.5;
        let a = 0.42 + 0.07 * (id - 0.5) + 0.09 * grain + 0.03 * layer + 0.2 * stain;
        let albedo = (vec3(1.08, 0.97, 0.79) * a).lerp(vec3(0.24, 0.22, 0.18), 1.0 - block);
        Texel::new(albedo, 0.004 * block + 0.0018 * grain, 0.9)
    })
}

/// Interlocking clay tiles: 12 columns by 8 courses in a tile.
#[must_use]
pub fn roof(seed: u32) -> Vec<Picture> {
    bake("roof", [512, 512], [ROOF_M; 2], move |u, v| {
        let row = (v * 8.0).floor() as i32;
        let fy = v * 8.0 - row as f32;
        let x = u * 12.0;
        let col = (x.floor() as i32).rem_euclid(12);
        let fx = x - x.floor();
        let id = lattice(seed ^ 230, col, row);
        // A pan and a roll; the lower end of a tile stands proud of the next course.
        let pan = (fx - 0.36) / 0.36;
        let roll = (fx - 0.86) / 0.14;
        let wave = if fx < 0.72 {
            0.012 * pan * pan
        } else {
            0.012 + 0.014 * (1.0 - roll * roll)
        };
        let height = wave + 0.016 * fy + 0.003 * (id - 0.5);
        let grain = fbm(seed ^ 231, u, v, 100, 100, 2) - 0.5;
        let moss = smoothstep(0.5, 0.72, fbm(seed ^ 232, u, v, 6, 6, 4)) * (1.0 - smoothstep(0.0, 0.5, fy) * 0.6);
        let clay = vec3(0.27, 0.112, 0.064).lerp(vec3(0.17, 0.08, 0.056), id) * (1.0 + 0.7 * grain);
        let gap = 1.0 - smoothstep(0.0, 0.07, fy);
        let groove = 1.0 - smoothstep(0.0, 0.05, (fx - 0.71).abs());
        let shade = 1.0 - 0.6 * gap.max(0.7 * groove);
        let mut t = Texel::new(
            clay.lerp(vec3(0.085, 0.09, 0.045), 0.6 * moss) * shade,
            height,
            0.85 + 0.1 * moss,
        );
        t.open = 0.5 + 0.5 * shade;
        t
    })
}

/// Planks of 15 cm running up the image, near white (tinted by the material).
#[must_use]
pub fn wood(seed: u32) -> Vec<Picture> {
    bake("wood", [256, 256], [WOOD_M; 2], move |u, v| {
        let plank = (u * 8.0).floor();
        let fx = (u * 8.0 - plank) * 0.15;
        let joint = 1.0 - smoothstep(0.003, 0.007, fx.min(0.15 - fx));
        let id = lattice(seed ^ 240, plank as i32, 0);
        let grain = fbm(seed ^ 241, u, v, 80, 4, 3) - 0.5;
        let fleck = fbm(seed ^ 242, u, v, 64, 16, 2) - 0.5;
        let a = (0.62 + 0.18 * (id - 0.5) + 0.3 * grain + 0.1 * fleck) * (1.0 - 0.7 * joint);
        Texel::new(
            vec3(1.0, 0.96, 0.9) * a.clamp(0.05, 0.9),
            0.0012 * grain - 0.005 * joint,
            0.75 + 0.2 * grain,
        )
    })
}
