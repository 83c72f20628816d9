//! A paved court of flat ground with two puddles in its vertex colours, walls on three sides and a lamp: what puddles placed by an
//! artist are shown on.
//!
//! Vertex colours, linear: red 1 (ripples may be), green the depth at which ground floods (0 in the middle of a puddle,
//! 1 where none is), blue 1 (it gets wet), alpha as green, for puddles that do not change.

use crate::error::StreetError;
use crate::glb::Glb;
use crate::materials::{Mat, Parts, iron, lamp_glass, surface};
use crate::mesh::{BACK, FRONT, Frame, LEFT, Mesh, RIGHT, TOP};
use crate::noise::{fbm, smoothstep};
use crate::textures::ground::{SETTS_TILE_M, setts, setts_depth};
use crate::textures::{encode, walls};
use crate::{LAMP_CD, WARM, layout, light_node, street_lamps};
use glam::{Vec2, Vec3, Vec4, vec2, vec3};
use serde_json::json;

/// Half the width of the court, metres.
pub const HALF_M: f32 = 6.0;
/// Where the puddles lie: middle (x, z) and radii along x and z, metres.
pub const PUDDLES: [[f32; 4]; 2] = [[-0.9, 1.3, 3.0, 1.7], [2.4, -1.8, 2.2, 1.5]];
/// Quads along each side of the ground: vertices every 0.1 m.
const QUADS: usize = 120;
const WALL_Z: f32 = -5.0;
const WALL_M: f32 = 3.2;
const LAMP: Vec3 = vec3(-3.4, 0.0, -4.2);

/// Depth in [0, 1] at which the ground floods: 0 in the middle of a puddle, 1 outside; its rim is uneven.
#[must_use]
pub fn flood_depth(x: f32, z: f32, seed: u32) -> f32 {
    let (u, v) = (x / (2.0 * HALF_M) + 0.5, z / (2.0 * HALF_M) + 0.5);
    let uneven = 0.5 * (fbm(seed, u, v, 10, 10, 3) - 0.5);
    let nearest = PUDDLES
        .iter()
        .map(|[px, pz, rx, rz]| vec2((x - px) / rx, (z - pz) / rz).length())
        .fold(f32::MAX, f32::min);
    smoothstep(0.15, 1.0, nearest + uneven)
}

/// The court as the bytes of a `.glb` file.
///
/// # Errors
/// [`StreetError::Encode`] or [`StreetError::Document`] when a part cannot be encoded.
pub fn glb(seed: u64) -> Result<Vec<u8>, StreetError> {
    let s = seed as u32 ^ (seed >> 32) as u32;
    let mut glb = Glb::default();
    let paving = encode(&setts(s))?.install(&mut glb);
    let bricks = encode(&walls::brick(s))?.install(&mut glb);
    let white = [1.0; 3];
    let paving = glb.add_material(surface("setts", white, paving));
    let bricks = glb.add_material(surface("brick", white, bricks));
    let iron = glb.add_material(iron());
    let glow = glb.add_material(lamp_glass());

    let mesh = glb.add_mesh("ground", &[(&ground(s), paving, Mat::Setts.attributes())]);
    glb.add_root(json!({ "name": "ground", "mesh": mesh }));
    let mut wall = Mesh::default();
    let back = Frame::world(Vec3::ZERO);
    for (low, high) in [
        ([-HALF_M, WALL_Z - 0.3], [HALF_M, WALL_Z]),
        ([-HALF_M - 0.3, WALL_Z - 0.3], [-HALF_M, HALF_M]),
        ([HALF_M, WALL_Z - 0.3], [HALF_M + 0.3, HALF_M]),
    ] {
        let (low, high) = ([low[0], -0.05, low[1]], [high[0], WALL_M, high[1]]);
        wall.block(&back, low, high, 1.0, FRONT | BACK | LEFT | RIGHT | TOP);
    }
    let mesh = glb.add_mesh("wall", &[(&wall, bricks, Mat::Brick.attributes())]);
    glb.add_root(json!({ "name": "wall", "mesh": mesh }));

    let mut parts = Parts::default();
    street_lamps::post(&mut parts);
    let list: Vec<_> = parts
        .used()
        .map(|(mat, mesh)| (mesh, if mat == Mat::Glow { glow } else { iron }, mat.attributes()))
        .collect();
    let mesh = glb.add_mesh("lamp", &list);
    let light = glb.add_light(json!({
        "name": "lamp", "type": "point", "color": WARM, "intensity": 0.5 * LAMP_CD, "range": 28.0,
    }));
    let at = vec3(layout::LAMP_ARM, layout::LAMP_LIGHT_Y - 0.2, 0.0);
    let child = light_node(&mut glb, "lamp-light", light, at);
    glb.add_root(json!({ "name": "lamp", "mesh": mesh, "translation": LAMP.to_array(), "children": [child] }));
    glb.finish("court", json!({ "seed": seed }))
}

/// The PNG of the paving's depth, over the same texture coordinates: 0 the highest stone, 1 the lowest joint.
///
/// # Errors
/// [`StreetError::Encode`] when the codec refuses.
pub fn depth_png(seed: u64) -> Result<Vec<u8>, StreetError> {
    setts_depth(seed as u32 ^ (seed >> 32) as u32).png()
}

fn ground(seed: u32) -> Mesh {
    let mut mesh = Mesh::default();
    let at = |i: usize, j: usize| {
        let along = |k: usize| (2.0 * k as f32 / QUADS as f32 - 1.0) * HALF_M;
        vec3(along(i), 0.0, -along(j))
    };
    mesh.surface(QUADS, QUADS, false, |i, j| {
        let p = at(i, j);
        (p, Vec2::new(p.x, p.z) / SETTS_TILE_M)
    });
    mesh.colors = mesh
        .positions
        .iter()
        .map(|p| {
            let depth = flood_depth(p.x, p.z, seed);
            Vec4::new(1.0, depth, 1.0, depth)
        })
        .collect();
    mesh
}
