//! What stands on the pavements: the bus shelter, benches, bins, bollards, planters, a bus stop sign.

use crate::ground::ground_height;
use crate::layout::{FACADE_X, SHELTER_X, SHELTER_Y, SHELTER_Z};
use crate::materials::{Mat, Parts};
use crate::mesh::{ALL, BACK, FRONT, Frame, LEFT, RIGHT};
use glam::{Vec3, vec3};

/// The shelter: four posts, a roof that is closed above and below, a back and one side of glass, a bench.
fn shelter(parts: &mut Parts) {
    let [x0, x1] = SHELTER_X;
    let [z0, z1] = SHELTER_Z;
    let f = Frame::world(Vec3::ZERO);
    let floor = ground_height(x0, z0) - 0.05;
    let iron = parts.get(Mat::Iron);
    iron.block(&f, [x0, SHELTER_Y, z0], [x1, SHELTER_Y + 0.1, z1], 1.0, ALL);
    iron.block(
        &f,
        [x0 - 0.03, SHELTER_Y + 0.02, z0 - 0.03],
        [x1 + 0.03, SHELTER_Y + 0.14, z0 + 0.03],
        1.0,
        ALL,
    );
    iron.block(
        &f,
        [x0 - 0.03, SHELTER_Y + 0.02, z1 - 0.03],
        [x1 + 0.03, SHELTER_Y + 0.14, z1 + 0.03],
        1.0,
        ALL,
    );
    let round = FRONT | BACK | LEFT | RIGHT;
    let back = x0 + 0.12;
    for z in [z0 + 0.15, 0.5 * (z0 + z1) - 0.03, z1 - 0.21] {
        iron.block(&f, [back, floor, z], [back + 0.06, SHELTER_Y, z + 0.06], 1.0, round);
    }
    for z in [z0 + 0.15, z1 - 0.21] {
        iron.block(&f, [x1 - 0.3, floor, z], [x1 - 0.24, SHELTER_Y, z + 0.06], 1.0, round);
        iron.block(&f, [back + 0.06, 0.5, z + 0.02], [x1 - 0.3, 0.54, z + 0.05], 1.0, ALL);
    }
    for y in [0.32, 1.3, 2.3] {
        iron.block(
            &f,
            [back + 0.02, y, z0 + 0.21],
            [back + 0.05, y + 0.04, z1 - 0.21],
            1.0,
            ALL,
        );
    }
    let glass = parts.get(Mat::Glass);
    glass.block(
        &f,
        [back + 0.033, 0.36, z0 + 0.21],
        [back + 0.033, 2.3, z1 - 0.21],
        1.0,
        RIGHT,
    );
    glass.block(
        &f,
        [back + 0.08, 0.56, z0 + 0.18],
        [x1 - 0.32, 2.3, z0 + 0.18],
        1.0,
        FRONT,
    );
    let wood = parts.get(Mat::Wood);
    for k in 0..4 {
        let x = back + 0.14 + 0.1 * k as f32;
        wood.block(&f, [x, 0.53, z0 + 0.5], [x + 0.08, 0.57, z1 - 0.5], 1.2, ALL);
    }
    let iron = parts.get(Mat::Iron);
    for z in [z0 + 0.7, z1 - 0.76] {
        iron.block(&f, [back + 0.14, floor, z], [back + 0.52, 0.53, z + 0.06], 1.0, round);
    }
    // A strip light under the roof, and the timetable in its frame.
    parts.get(Mat::Glow).block(
        &f,
        [-5.3, SHELTER_Y - 0.03, z0 + 0.6],
        [-5.22, SHELTER_Y - 0.001, z1 - 0.6],
        1.0,
        ALL,
    );
    let iron = parts.get(Mat::Iron);
    iron.block(
        &f,
        [back + 0.05, 1.1, z1 - 0.95],
        [back + 0.08, 1.8, z1 - 0.4],
        1.0,
        ALL,
    );
    parts.get(Mat::White).block(
        &f,
        [back + 0.08, 1.15, z1 - 0.9],
        [back + 0.085, 1.75, z1 - 0.45],
        1.0,
        RIGHT,
    );
}

fn bench(parts: &mut Parts, p: [f32; 2], out: Vec3) {
    let f = Frame::facing(vec3(p[0], ground_height(p[0], p[1]), p[1]), out);
    let wood = parts.get(Mat::Wood);
    for k in 0..4 {
        let d = 0.04 + 0.11 * k as f32;
        wood.block(&f, [-0.85, 0.43, d], [0.85, 0.46, d + 0.09], 1.2, ALL);
    }
    for k in 0..3 {
        let y = 0.56 + 0.12 * k as f32;
        wood.block(&f, [-0.85, y, -0.06], [0.85, y + 0.1, -0.03], 1.2, ALL);
    }
    let iron = parts.get(Mat::Iron);
    for s in [-0.7, 0.65] {
        iron.block(&f, [s, -0.05, 0.38], [s + 0.05, 0.43, 0.44], 1.0, ALL);
        iron.block(&f, [s, -0.05, -0.06], [s + 0.05, 0.92, -0.01], 1.0, ALL);
        iron.block(&f, [s, 0.39, -0.01], [s + 0.05, 0.43, 0.44], 1.0, ALL);
        iron.block(&f, [s, 0.62, -0.01], [s + 0.05, 0.65, 0.4], 1.0, ALL);
    }
}

fn bin(parts: &mut Parts, x: f32, z: f32) {
    let p = vec3(x, ground_height(x, z), z);
    let shell = [
        (0.0, -0.04),
        (0.2, -0.04),
        (0.2, 0.04),
        (0.235, 0.06),
        (0.26, 0.8),
        (0.27, 0.82),
        (0.27, 0.86),
        (0.22, 0.86),
        (0.2, 0.7),
        (0.0, 0.7),
    ];
    parts.get(Mat::Iron).lathe(p, &shell, 14, 1.0);
    parts
        .get(Mat::Zinc)
        .lathe(p, &[(0.262, 0.6), (0.266, 0.62), (0.268, 0.66), (0.265, 0.68)], 14, 1.0);
}

fn bollard(parts: &mut Parts, x: f32, z: f32) {
    let p = vec3(x, ground_height(x, z), z);
    let body = [
        (0.09, -0.05),
        (0.09, 0.08),
        (0.06, 0.13),
        (0.05, 0.75),
        (0.07, 0.78),
        (0.07, 0.83),
        (0.045, 0.86),
        (0.055, 0.92),
        (0.0, 0.96),
    ];
    parts.get(Mat::Iron).lathe(p, &body, 10, 1.0);
}

fn planter(parts: &mut Parts, x: f32, z: f32) {
    let f = Frame::world(vec3(x, ground_height(x, z), z));
    parts.get(Mat::Stone).block(
        &f,
        [-0.3, -0.05, -0.55],
        [0.3, 0.42, 0.55],
        2.0,
        FRONT | BACK | LEFT | RIGHT,
    );
    parts
        .get(Mat::Stone)
        .block(&f, [-0.34, 0.42, -0.59], [0.34, 0.48, 0.59], 2.0, ALL);
    // Evergreen tufts: crossed cards of leaves.
    let leaves = parts.get(Mat::LeavesSlender);
    for k in 0..7 {
        let at = f.at(0.04 * ((k * 5 % 3) as f32 - 1.0), 0.45, -0.45 + 0.15 * k as f32);
        for turn in 0..3 {
            let (c, s) = crate::mesh::cos_sin(1.05 * turn as f32 + k as f32);
            let (a, up) = (vec3(c, 0.0, s) * 0.24, vec3(0.06 * s, 0.5, 0.06 * c));
            let uv = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]].map(|[u, v]| glam::vec2(u, v));
            leaves.quad_uv([at - a, at + a, at + a + up, at - a + up], uv);
        }
    }
}

fn stop_sign(parts: &mut Parts, x: f32, z: f32) {
    let p = vec3(x, ground_height(x, z), z);
    let iron = parts.get(Mat::Iron);
    iron.tube(p - Vec3::Y * 0.05, p + Vec3::Y * 2.75, [0.035, 0.035], 8, 1.0, true);
    let f = Frame::world(p);
    parts
        .get(Mat::White)
        .block(&f, [-0.02, 2.3, -0.03], [0.02, 2.72, 0.42], 4.0, ALL);
    parts
        .get(Mat::Painted)
        .block(&f, [-0.024, 2.36, 0.06], [0.024, 2.5, 0.36], 1.2, LEFT | RIGHT);
    parts
        .get(Mat::White)
        .block(&f, [-0.015, 1.2, 0.03], [0.015, 1.75, 0.35], 4.0, ALL);
}

/// Builds all of it.
pub fn build(parts: &mut Parts) {
    shelter(parts);
    bench(parts, [FACADE_X - 0.45, -20.5], Vec3::NEG_X);
    bench(parts, [11.8, 14.6], vec3(-1.0, 0.0, 0.0));
    bench(parts, [10.2, 20.6], Vec3::NEG_Z);
    for (x, z) in [(-4.15, -12.6), (4.2, 1.2), (11.9, 16.3), (4.15, -20.0), (-4.15, 22.6)] {
        bin(parts, x, z);
    }
    for z in [12.4, 13.9, 15.4, 16.9, 18.4, 19.9, 21.4] {
        bollard(parts, 6.2, z);
    }
    for z in [-31.0, -26.0, 23.2, 27.8] {
        bollard(parts, 3.95, z);
        bollard(parts, -3.95, z);
    }
    for (x, z) in [(-6.0, -1.0), (-6.0, 8.6), (5.95, -25.0), (6.0, -9.0)] {
        planter(parts, x, z);
    }
    stop_sign(parts, -3.95, -7.2);
}
