//! A wheel: tyre, rim, five spokes; its axle is the x axis through the origin.

use super::{CarMat, CarParts, TYRE_WIDTH, WHEEL_RADIUS};
use crate::mesh::cos_sin;
use glam::{Vec3, vec2, vec3};

const SIDES: usize = 28;

/// A body of revolution about the x axis; `profile` is (x, radius), and `side` −1 mirrors it in x.
fn revolve(parts: &mut CarParts, mat: CarMat, side: f32, profile: &[(f32, f32)]) {
    let list: Vec<(f32, f32)> = if side > 0.0 {
        profile.to_vec()
    } else {
        profile.iter().rev().map(|&(x, r)| (-x, r)).collect()
    };
    parts.get(mat).surface(SIDES, list.len() - 1, true, |i, j| {
        let (c, s) = cos_sin(-(i as f32) / SIDES as f32 * std::f32::consts::TAU);
        let (x, r) = list[j];
        (
            vec3(x, r * s, r * c),
            vec2(i as f32 / SIDES as f32 * 4.0, -(j as f32) * 0.1),
        )
    });
}

/// Builds a wheel whose outer face looks along +x (`side` 1) or −x (`side` −1).
pub fn build(parts: &mut CarParts, side: f32) {
    let (h, r) = (0.5 * TYRE_WIDTH, WHEEL_RADIUS);
    let tyre = [
        (-h + 0.01, 0.2),
        (-h - 0.004, 0.235),
        (-h, 0.272),
        (-h + 0.012, r - 0.012),
        (-h + 0.03, r - 0.001),
        (0.0, r),
        (h - 0.03, r - 0.001),
        (h - 0.012, r - 0.012),
        (h, 0.272),
        (h + 0.004, 0.235),
        (h - 0.01, 0.2),
    ];
    revolve(parts, CarMat::Rubber, side, &tyre);
    // The rim's lip and well, a dark brake behind the spokes, a closed back.
    revolve(
        parts,
        CarMat::Alloy,
        side,
        &[(h - 0.006, 0.208), (h - 0.004, 0.198), (h - 0.02, 0.186), (0.01, 0.178)],
    );
    revolve(parts, CarMat::Plastic, side, &[(0.012, 0.18), (0.012, 0.06)]);
    revolve(parts, CarMat::Plastic, side, &[(0.012, 0.06), (0.012, 0.0)]);
    revolve(parts, CarMat::Plastic, side, &[(-h + 0.02, 0.0), (-h + 0.012, 0.202)]);
    revolve(
        parts,
        CarMat::Alloy,
        side,
        &[(0.02, 0.062), (h - 0.03, 0.05), (h - 0.022, 0.03), (h - 0.02, 0.0)],
    );
    for k in 0..5 {
        let (c, s) = cos_sin(std::f32::consts::TAU * (k as f32 / 5.0));
        let (radial, across) = (vec3(0.0, c, s), vec3(0.0, -s, c));
        let front = |r: f32, w: f32, x: f32| radial * r + across * w + Vec3::X * (x * side);
        let (x0, x1, xb) = (h - 0.032, h - 0.026, 0.014);
        let (inner, outer) = (0.035, 0.19);
        let (wi, wo) = (0.026, 0.034);
        let m = parts.get(CarMat::Alloy);
        let mut face = |q: [Vec3; 4]| m.quad(if side > 0.0 { q } else { [q[3], q[2], q[1], q[0]] }, 1.0);
        face([
            front(inner, -wi, x0),
            front(outer, -wo, x1),
            front(outer, wo, x1),
            front(inner, wi, x0),
        ]);
        face([
            front(inner, wi, x0),
            front(outer, wo, x1),
            front(outer, wo, xb),
            front(inner, wi, xb),
        ]);
        face([
            front(inner, -wi, xb),
            front(outer, -wo, xb),
            front(outer, -wo, x1),
            front(inner, -wi, x0),
        ]);
    }
}
