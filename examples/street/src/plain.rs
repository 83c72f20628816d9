//! A country road over a plain, open to the horizon: fields, hedges, poles along the road, a barn, hills with woods.
//!
//! Made for weather that is seen from afar. The road runs along z through the origin; within 40 m of it nothing but
//! poles stands on its east side, and nothing at all ahead of an eye on it.

use crate::error::StreetError;
use crate::glb::{Attributes, Glb};
use crate::layout::TreeKind;
use crate::materials::{self, Mat, leaves, surface};
use crate::mesh::{BACK, FRONT, Frame, LEFT, Mesh, RIGHT, cos_sin};
use crate::noise::{Rng, fbm, lattice, smoothstep, value};
use crate::textures::fields::{self, FURROWS_M, MEADOW_M};
use crate::textures::foliage::{self, BARK_M};
use crate::textures::{encode, ground, walls};
use crate::trees;
use glam::{Vec2, Vec3, Vec4, vec2, vec3};
use serde_json::json;

/// Half the width of the plain, metres.
pub const HALF_M: f32 = 3200.0;
/// Half the width of the road, metres.
pub const ROAD_HALF_M: f32 = 2.7;
/// Where the barn's middle stands: x, z in metres.
pub const BARN: [f32; 2] = [46.0, 130.0];
/// Half length, half width, height of the eaves and of the ridge, metres.
const BARN_SIZE: [f32; 4] = [9.0, 5.5, 4.2, 8.0];

/// What a piece of ground is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Cover {
    Road,
    Meadow,
    Furrows,
}

/// Height of the ground at (x, z), metres.
#[must_use]
pub fn height(x: f32, z: f32) -> f32 {
    // Periods of twice the plain: it ends before the noise comes back.
    let (u, v) = (x / (4.0 * HALF_M) + 0.5, z / (4.0 * HALF_M) + 0.5);
    let far = vec2(x, z).length();
    let roll = 9.0 * (fbm(601, u, v, 24, 24, 3) - 0.5) * smoothstep(12.0, 220.0, x.abs());
    let hills = 150.0 * (fbm(602, u, v, 9, 9, 4) - 0.35).max(0.0) * smoothstep(900.0, 2900.0, far);
    let road = 5.0 * (value(603, 0.0, v, 1, 40) - 0.5) * smoothstep(80.0, 400.0, z.abs());
    road + roll + hills + bed(x, z)
}

/// Relief of the road and its verges over the ground, metres: camber, ruts, a ditch on both sides.
fn bed(x: f32, z: f32) -> f32 {
    let a = x.abs();
    let camber = 0.06 * (1.0 - smoothstep(0.0, ROAD_HALF_M, a));
    let rut = -0.016 * (1.0 - smoothstep(0.0, 0.4, (a - 1.1).abs())) * (0.4 + value(604, 0.0, z / 512.0, 1, 64));
    let ditch = -0.35 * smoothstep(ROAD_HALF_M + 0.4, 4.2, a) * (1.0 - smoothstep(4.6, 6.4, a));
    camber + rut + ditch
}

/// Which crop a field bears, and its tint: fields are about 170 by 240 m, their borders not straight.
fn cover(x: f32, z: f32, seed: u32) -> (Cover, f32) {
    if x.abs() < ROAD_HALF_M {
        return (Cover::Road, 1.0);
    }
    let (u, v) = (x / (4.0 * HALF_M) + 0.5, z / (4.0 * HALF_M) + 0.5);
    let bend = 60.0 * (fbm(seed ^ 610, u, v, 60, 60, 2) - 0.5);
    let cell = (
        ((x + 20.0 + bend) / 170.0).floor() as i32,
        ((z + bend) / 240.0).floor() as i32,
    );
    let tint = 0.75 + 0.5 * lattice(seed ^ 611, cell.0, cell.1);
    let verge = x.abs() < 9.0 || vec2(x - BARN[0], z - BARN[1]).length() < 24.0;
    let steep = vec2(x, z).length() > 2000.0;
    if !verge && !steep && lattice(seed ^ 612, cell.0, cell.1) < 0.36 {
        (Cover::Furrows, tint)
    } else {
        (Cover::Meadow, tint)
    }
}

/// Offsets from the middle: even steps near it, then growing with the distance up to the rim.
fn spread(near: &[f32], step: f32) -> Vec<f32> {
    let mut half = near.to_vec();
    let mut at = half[half.len() - 1];
    while at < HALF_M {
        at = (at + step.max(0.07 * at)).min(HALF_M);
        half.push(at);
    }
    let negative = half.iter().rev().filter(|x| **x > 0.0).map(|x| -x);
    negative.chain(half.iter().copied()).collect()
}

/// The ground, one mesh for each kind of cover.
fn ground(seed: u32) -> [Mesh; 3] {
    let xs = spread(
        &[
            0.0,
            0.4,
            0.75,
            1.1,
            1.45,
            1.8,
            2.3,
            ROAD_HALF_M,
            3.1,
            3.6,
            4.2,
            4.6,
            5.2,
            5.8,
            6.4,
            8.0,
        ],
        2.0,
    );
    let near: Vec<f32> = (0..=80).map(|k| 0.5 * k as f32).collect();
    let zs = spread(&near, 1.0);
    let covers = [Cover::Road, Cover::Meadow, Cover::Furrows];
    let mut meshes: [Mesh; 3] = std::array::from_fn(|_| Mesh::default());
    for (slot, mesh) in meshes.iter_mut().enumerate() {
        let mut made = vec![u32::MAX; xs.len() * zs.len()];
        let mut corner = |mesh: &mut Mesh, i: usize, j: usize| {
            let k = j * xs.len() + i;
            if made[k] == u32::MAX {
                let (x, z) = (xs[i], zs[j]);
                let e = 0.1;
                let slope = |ax: f32, az: f32| (height(x + ax, z + az) - height(x - ax, z - az)) / (2.0 * e);
                let n = vec3(-slope(e, 0.0), 1.0, -slope(0.0, e)).normalize();
                let uv = match covers[slot] {
                    Cover::Road => vec2(x + 3.5, z) / vec2(ground::ASPHALT_WIDTH_M, ground::ASPHALT_LENGTH_M),
                    Cover::Meadow => vec2(x, z) / MEADOW_M,
                    Cover::Furrows => vec2(x, z) / FURROWS_M,
                };
                made[k] = mesh.vertex(vec3(x, height(x, z), z), n, uv, Vec3::X, 1.0);
                let (u, v) = (x / 1024.0 + 0.5, z / 1024.0 + 0.5);
                let tint = match covers[slot] {
                    Cover::Road => 1.0,
                    _ => cover(x, z, seed).1 * (0.7 + 0.6 * fbm(seed ^ 613, u, v, 48, 48, 4)),
                };
                mesh.colors.push(Vec4::new(tint, tint, 0.9 * tint, 1.0));
            }
            made[k]
        };
        for j in 0..zs.len() - 1 {
            for i in 0..xs.len() - 1 {
                let middle = vec2(0.5 * (xs[i] + xs[i + 1]), 0.5 * (zs[j] + zs[j + 1]));
                if cover(middle.x, middle.y, seed).0 != covers[slot] {
                    continue;
                }
                let [a, b, c, d] = [(i, j + 1), (i + 1, j + 1), (i + 1, j), (i, j)].map(|(i, j)| corner(mesh, i, j));
                mesh.triangle(a, b, c);
                mesh.triangle(a, c, d);
            }
        }
    }
    meshes
}

/// Rounded heads of a wood's trees on the hills, all in one mesh.
fn woods(seed: u64) -> Mesh {
    let mut rng = Rng::new(seed, 720);
    let mut mesh = Mesh::default();
    for _ in 0..46 {
        let (c, s) = cos_sin(rng.range(0.0, std::f32::consts::TAU));
        let far = rng.range(700.0, 2900.0);
        let (middle, across) = (vec2(far * s, far * c), rng.range(40.0, 150.0));
        for _ in 0..(across * 0.5) as usize {
            let (c, s) = cos_sin(rng.range(0.0, std::f32::consts::TAU));
            let at = middle + vec2(c, 0.5 * s) * across * rng.unit().sqrt();
            if at.x.abs() < 30.0 || at.x.abs().max(at.y.abs()) > HALF_M - 20.0 {
                continue;
            }
            let (r, up) = (rng.range(3.5, 6.5), rng.range(4.0, 8.0));
            let foot = vec3(at.x, height(at.x, at.y) + 0.6 * up, at.y);
            let lumps = rng.below(1 << 20) as u32;
            mesh.surface(7, 4, true, |i, j| {
                let (c, s) = cos_sin(-(i as f32) / 7.0 * std::f32::consts::TAU);
                let (q, y) = cos_sin((j as f32 / 4.0 - 0.5) * std::f32::consts::PI);
                let lump = 0.8 + 0.4 * lattice(lumps, (i % 7) as i32, j as i32);
                let p = vec3(q * c * r, y * up, q * s * r) * lump;
                (foot + p, vec2(i as f32, -(j as f32)))
            });
        }
    }
    mesh
}

/// Poles with a cross-arm along the east side of the road.
fn poles() -> Mesh {
    let mut mesh = Mesh::default();
    for k in 0..26 {
        let (x, z) = (7.5, -50.0 + 45.0 * k as f32);
        let y = height(x, z);
        let lean = 0.12 * (lattice(73, k, 0) - 0.5);
        let top = vec3(x + lean, y + 7.6, z);
        mesh.tube(vec3(x, y - 0.3, z), top, [0.13, 0.09], 8, BARK_M, true);
        let arm = top - Vec3::Y * 0.5;
        mesh.tube(
            arm - Vec3::X * 0.9,
            arm + Vec3::X * 0.9,
            [0.055, 0.055],
            5,
            BARK_M,
            true,
        );
    }
    mesh
}

/// Walls and roof of the barn.
fn barn() -> (Mesh, Mesh) {
    let [along, across, eaves, ridge] = BARN_SIZE;
    let f = Frame::world(vec3(BARN[0], height(BARN[0], BARN[1]) - 0.4, BARN[1]));
    let (mut planks, mut tiles) = (Mesh::default(), Mesh::default());
    let (low, high) = ([-across, 0.0, -along], [across, eaves, along]);
    planks.block(&f, low, high, 1.5, FRONT | BACK | LEFT | RIGHT);
    let (out, lip) = (0.5, 0.35);
    for side in [-1.0_f32, 1.0] {
        // Gable ends look along z; the two roof planes along x.
        let end = along * side;
        let corner = |s: f32, y: f32| f.at(s * side, y, end);
        planks.tri([corner(-across, eaves), corner(across, eaves), corner(0.0, ridge)], 1.5);
        let slope = (ridge - eaves) / across;
        let (x, y) = ((across + out) * side, eaves - out * slope);
        let (z0, z1) = ((along + lip) * side, -(along + lip) * side);
        let plane = [
            f.at(x, y, z0),
            f.at(x, y, z1),
            f.at(0.0, ridge, z1),
            f.at(0.0, ridge, z0),
        ];
        tiles.quad(plane, 1.5);
        tiles.quad([plane[3], plane[2], plane[1], plane[0]], 1.5);
    }
    (planks, tiles)
}

/// Feet of the hedges' trees: (x, z), height factor.
fn hedges(seed: u64) -> Vec<(Vec2, f32)> {
    let mut rng = Rng::new(seed, 721);
    let mut feet = Vec::new();
    let mut line = |from: Vec2, to: Vec2, gap: f32| {
        let n = (from.distance(to) / gap) as usize;
        for k in 0..n {
            let at = from.lerp(to, (k as f32 + rng.range(0.1, 0.9)) / n as f32);
            let shaken = at + vec2(rng.range(-1.5, 1.5), rng.range(-1.5, 1.5));
            feet.push((shaken, rng.range(0.45, 1.15)));
        }
    };
    line(vec2(-64.0, 30.0), vec2(-70.0, 430.0), 11.0);
    line(vec2(-400.0, 240.0), vec2(-12.0, 236.0), 10.0);
    line(vec2(14.0, 300.0), vec2(420.0, 330.0), 10.0);
    line(vec2(95.0, -60.0), vec2(98.0, 300.0), 12.0);
    line(vec2(-300.0, 480.0), vec2(330.0, 500.0), 12.0);
    feet.retain(|(at, _)| at.x.abs() > 9.0);
    feet
}

/// The plain as the bytes of a `.glb` file.
///
/// # Errors
/// [`StreetError::Encode`] or [`StreetError::Document`] when a part cannot be encoded.
pub fn glb(seed: u64) -> Result<Vec<u8>, StreetError> {
    let s = seed as u32 ^ (seed >> 32) as u32;
    let mut glb = Glb::default();
    let mut asphalt = vec![ground::asphalt_colour(s)];
    asphalt.extend(ground::asphalt_relief(s));
    let sets = [
        encode(&asphalt)?,
        encode(&fields::meadow(s))?,
        encode(&fields::furrows(s))?,
        encode(&foliage::bark(s))?,
        encode(&walls::wood(s))?,
        encode(&walls::roof(s))?,
        encode(&[foliage::spray(seed, foliage::Leaf::Broad)])?,
    ];
    let [asphalt, meadow, furrows, bark, wood, roof, spray] = sets.map(|e| e.install(&mut glb));
    let white = [1.0; 3];
    let asphalt = glb.add_material(materials::asphalt(asphalt));
    let meadow = glb.add_material(surface("grass", white, meadow));
    let furrows = glb.add_material(surface("soil", white, furrows));
    let bark = glb.add_material(surface("bark", white, bark));
    let planks = glb.add_material(surface("wood", [0.32, 0.2, 0.13], wood));
    let tiles = glb.add_material(surface("roof-tiles", white, roof));
    let spray = glb.add_material(leaves("leaves-broad", spray.base));
    let canopy = glb.add_material(json!({
        "name": "leaves-far",
        "pbrMetallicRoughness": {
            "baseColorFactor": [0.022, 0.038, 0.014, 1.0], "roughnessFactor": 0.95, "metallicFactor": 0.0,
        },
    }));
    let tangents = Attributes {
        tangents: true,
        detail_m: None,
    };
    let plain = Attributes {
        tangents: false,
        detail_m: None,
    };

    let [road, fields, ploughed] = ground(s);
    let (walls, cladding) = barn();
    for (name, mesh, material, attributes) in [
        ("road", &road, asphalt, Mat::Asphalt.attributes()),
        ("meadow", &fields, meadow, tangents),
        ("furrows", &ploughed, furrows, tangents),
        ("poles", &poles(), planks, tangents),
        ("barn-walls", &walls, planks, tangents),
        ("barn-roof", &cladding, tiles, tangents),
        ("woods", &woods(seed), canopy, plain),
    ] {
        let mesh = glb.add_mesh(name, &[(mesh, material, attributes)]);
        glb.add_root(json!({ "name": name, "mesh": mesh }));
    }
    let (trunk, crown) = trees::tree(TreeKind::Lime, seed);
    let tree = glb.add_mesh(
        "hedge-tree",
        &[
            (&trunk, bark, Mat::Bark.attributes()),
            (&crown, spray, Mat::LeavesBroad.attributes()),
        ],
    );
    for (k, (at, tall)) in hedges(seed).into_iter().enumerate() {
        let (c, s) = cos_sin(1.7 * k as f32);
        glb.add_root(json!({
            "name": format!("hedge-tree-{k}"), "mesh": tree,
            "translation": [at.x, height(at.x, at.y) - 0.9 * tall, at.y], "rotation": [0.0, s, 0.0, c],
            "scale": [1.25 * tall, tall, 1.25 * tall],
        }));
    }
    glb.finish("plain", json!({ "seed": seed }))
}
