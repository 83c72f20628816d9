//! Trees: a trunk with branches of bark, and a crown of alpha-masked sprays of leaves on the surface of rounded lobes.

use crate::layout::TreeKind;
use crate::mesh::{Mesh, cos_sin};
use crate::noise::Rng;
use crate::textures::foliage::BARK_M;
use glam::{Vec3, vec2, vec3};

/// Half axes of the crown, height of its middle, sprays of leaves, their size, height of the first branches.
struct Habit {
    across: f32,
    up: f32,
    middle: f32,
    sprays: usize,
    size: f32,
    fork: f32,
    lobes: usize,
    trunk: f32,
}

fn habit(kind: TreeKind) -> Habit {
    match kind {
        TreeKind::Lime => Habit {
            across: 2.3,
            up: 2.3,
            middle: 4.55,
            sprays: 640,
            size: 0.74,
            fork: 2.35,
            lobes: 15,
            trunk: 0.16,
        },
        TreeKind::Ash => Habit {
            across: 2.1,
            up: 2.9,
            middle: 5.3,
            sprays: 600,
            size: 0.8,
            fork: 2.6,
            lobes: 16,
            trunk: 0.14,
        },
    }
}

/// A direction from two uniform numbers.
fn direction(rng: &mut Rng) -> Vec3 {
    let y = rng.range(-1.0, 1.0);
    let r = (1.0 - y * y).max(0.0).sqrt();
    let (c, s) = cos_sin(rng.range(0.0, std::f32::consts::TAU));
    vec3(r * c, y, r * s)
}

/// A bent branch from `a` to `b` with the radii at its ends.
fn branch(mesh: &mut Mesh, a: Vec3, b: Vec3, radii: [f32; 2], bow: Vec3, sides: usize) {
    let n = 4;
    let at = |k: usize| {
        let t = k as f32 / n as f32;
        a.lerp(b, t) + bow * (4.0 * t * (1.0 - t))
    };
    let axis = (b - a).normalize_or(Vec3::Y);
    let x = axis.any_orthonormal_vector();
    let z = x.cross(axis);
    let length = a.distance(b);
    let wraps = (std::f32::consts::TAU * radii[0] / BARK_M).max(0.25);
    mesh.surface(sides, n, true, |i, k| {
        let t = k as f32 / n as f32;
        let (c, s) = cos_sin(-(i as f32) / sides as f32 * std::f32::consts::TAU);
        let p = at(k) + (x * c + z * s) * (radii[0] + (radii[1] - radii[0]) * t);
        (p, vec2(i as f32 / sides as f32 * wraps, -t * length / BARK_M))
    });
}

/// Wood and crown of a tree whose foot is the origin.
#[must_use]
pub fn tree(kind: TreeKind, seed: u64) -> (Mesh, Mesh) {
    let h = habit(kind);
    let mut rng = Rng::new(seed, 700 + kind as u32);
    let centre = Vec3::Y * h.middle;
    let (mut wood, mut crown) = (Mesh::default(), Mesh::default());
    let lean = vec3(rng.range(-0.08, 0.08), 0.0, rng.range(-0.08, 0.08));
    // Root flare, trunk, and the leader into the crown.
    let r = h.trunk;
    branch(
        &mut wood,
        Vec3::Y * -0.12,
        Vec3::Y * 0.28,
        [r * 1.7, r * 1.08],
        Vec3::ZERO,
        10,
    );
    let fork = Vec3::Y * h.fork + lean;
    branch(&mut wood, Vec3::Y * 0.27, fork, [r * 1.08, r * 0.8], lean * 0.4, 10);
    let tip = centre + Vec3::Y * h.up * 0.55;
    branch(&mut wood, fork - Vec3::Y * 0.02, tip, [r * 0.8, 0.02], lean, 7);
    // Lobes: rounded masses of leaves, each at the end of a branch.
    let axes = vec3(h.across, h.up, h.across);
    let mut lobes: Vec<(Vec3, f32)> = Vec::new();
    for k in 0..h.lobes {
        // Evenly spread on a sphere (golden angle), then shaken.
        let y = 1.0 - 2.0 * (k as f32 + 0.5) / h.lobes as f32;
        let (c, s) = cos_sin(2.399_963 * k as f32);
        let q = (1.0 - y * y).sqrt();
        let dir = (vec3(q * c, y, q * s) + 0.35 * direction(&mut rng)).normalize();
        let radius = rng.range(0.28, 0.48);
        lobes.push((
            centre + dir * axes * ((1.0 - radius) * rng.range(0.86, 1.04)),
            radius * h.across,
        ));
        let from = fork.lerp(tip, rng.range(0.0, 0.55));
        let end = centre + dir * axes * (1.0 - radius * 0.8);
        let bow = vec3(dir.x, 0.0, dir.z) * 0.12 - Vec3::Y * 0.05;
        branch(&mut wood, from, end, [r * rng.range(0.3, 0.42), 0.012], bow, 5);
    }
    for k in 0..h.sprays {
        let (lobe, radius) = lobes[k % lobes.len()];
        let dir = (direction(&mut rng) + 0.7 * (lobe - centre).normalize_or(Vec3::Y)).normalize_or(Vec3::Y);
        let p = lobe + dir * radius * rng.range(0.55, 1.02) * vec3(1.0, h.up / h.across, 1.0);
        let outward = (p - centre).normalize_or(Vec3::Y);
        // A spray's twig points outward and, by its weight, somewhat down; its face is turned by chance.
        let grow = (outward + 0.55 * direction(&mut rng) - Vec3::Y * 0.25).normalize_or(Vec3::Y);
        let side = grow
            .cross(direction(&mut rng))
            .normalize_or(grow.any_orthonormal_vector());
        let size = h.size * rng.range(0.8, 1.2);
        let (low, high, half) = (p - grow * size * 0.45, p + grow * size * 0.55, side * size * 0.5);
        // Normals of the crown as a whole make it shade like a mass, not like confetti.
        let normal = (outward * 0.75 + dir * 0.45).normalize_or(Vec3::Y);
        let corners = [
            (low - half, 0.0, 1.0),
            (low + half, 1.0, 1.0),
            (high + half, 1.0, 0.0),
            (high - half, 0.0, 0.0),
        ];
        let i = corners.map(|(q, u, v)| crown.vertex(q, normal, vec2(u, v), side, 1.0));
        // The front is the side that faces away from the trunk.
        if side.cross(grow).dot(outward) >= 0.0 {
            crown.triangle(i[0], i[1], i[2]);
            crown.triangle(i[0], i[2], i[3]);
        } else {
            crown.triangle(i[0], i[2], i[1]);
            crown.triangle(i[0], i[3], i[2]);
        }
    }
    (wood, crown)
}
