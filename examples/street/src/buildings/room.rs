//! A closed room in one of the houses: four walls, floor, ceiling, door and curtains shut.

use super::tile;
use crate::layout::{ROOM_MAX, ROOM_MIN};
use crate::materials::{Mat, Parts};
use crate::mesh::{ALL, BACK, BOTTOM, FRONT, Frame, LEFT, RIGHT, TOP};
use glam::{Vec3, vec3};

/// Where the room's lamp hangs.
#[must_use]
pub fn lamp() -> Vec3 {
    vec3(
        0.5 * (ROOM_MIN[0] + ROOM_MAX[0]),
        ROOM_MAX[1] - 0.55,
        0.5 * (ROOM_MIN[2] + ROOM_MAX[2]),
    )
}

/// Builds the room.
pub fn build(parts: &mut Parts) {
    let ([x0, y0, z0], [x1, y1, z1]) = (ROOM_MIN, ROOM_MAX);
    let (wide, long) = (x1 - x0, z1 - z0);
    let walls = [
        (Frame::facing(vec3(x0, 0.0, z0), Vec3::Z), wide),
        (Frame::facing(vec3(x1, 0.0, z1), Vec3::NEG_Z), wide),
        (Frame::facing(vec3(x0, 0.0, z1), Vec3::X), long),
        (Frame::facing(vec3(x1, 0.0, z0), Vec3::NEG_X), long),
    ];
    for (f, w) in &walls {
        parts
            .get(Mat::Sage)
            .block(f, [0.0, y0, 0.0], [*w, y1, 0.0], tile(Mat::Sage), FRONT);
        let white = parts.get(Mat::White);
        white.block(f, [0.0, y0, 0.0], [*w, y0 + 0.12, 0.015], 4.0, FRONT | TOP);
    }
    let f = Frame::world(Vec3::ZERO);
    parts
        .get(Mat::Wood)
        .block(&f, [x0, y0, z0], [x1, y0, z1], tile(Mat::Wood), TOP);
    parts.get(Mat::White).block(&f, [x0, y1, z0], [x1, y1, z1], 4.0, BOTTOM);
    // The door, shut, in the wall at the high end of z.
    let (door, s) = (&walls[1].0, 3.2);
    let open = ALL & !BACK;
    parts
        .get(Mat::White)
        .block(door, [s - 0.1, y0, 0.0], [s + 1.0, y0 + 2.15, 0.04], 4.0, open);
    parts.get(Mat::Wood).block(
        door,
        [s, y0 + 0.01, 0.0],
        [s + 0.9, y0 + 2.05, 0.055],
        tile(Mat::Wood),
        open,
    );
    parts
        .get(Mat::Iron)
        .block(door, [s + 0.08, y0 + 1.0, 0.055], [s + 0.2, y0 + 1.03, 0.1], 1.0, open);
    // Drawn curtains where the windows to the street are.
    let street = &walls[3].0;
    for s in [0.8, 3.2] {
        parts
            .get(Mat::Rose)
            .block(street, [s, y0 + 0.75, 0.02], [s + 1.5, y0 + 2.4, 0.06], 1.0, open);
        parts
            .get(Mat::Wood)
            .block(street, [s - 0.1, y0 + 2.4, 0.0], [s + 1.6, y0 + 2.46, 0.1], 1.2, open);
    }
    // A table with a bench, shelves, a picture.
    let table = Frame::world(vec3(-9.4, y0, 14.4));
    let wood = parts.get(Mat::Wood);
    wood.block(&table, [-0.7, 0.7, -0.4], [0.7, 0.75, 0.4], 1.2, ALL);
    for (x, z) in [(-0.62, -0.32), (0.56, -0.32), (-0.62, 0.26), (0.56, 0.26)] {
        wood.block(
            &table,
            [x, 0.0, z],
            [x + 0.06, 0.7, z + 0.06],
            1.2,
            FRONT | BACK | LEFT | RIGHT,
        );
    }
    wood.block(&table, [-0.6, 0.42, -0.95], [0.6, 0.46, -0.6], 1.2, ALL);
    for x in [-0.55, 0.5] {
        wood.block(
            &table,
            [x, 0.0, -0.92],
            [x + 0.05, 0.42, -0.63],
            1.2,
            FRONT | BACK | LEFT | RIGHT,
        );
    }
    let shelf = &walls[2].0;
    for k in 0..4 {
        let y = y0 + 0.4 + 0.45 * k as f32;
        parts
            .get(Mat::Wood)
            .block(shelf, [1.2, y, 0.0], [3.4, y + 0.03, 0.26], 1.2, open);
        for b in 0..22 {
            let s = 1.3 + 0.09 * b as f32;
            let high = 0.2 + 0.03 * ((b * 7 + k * 5) % 4) as f32;
            let mat = [Mat::Painted, Mat::Rose, Mat::Ochre, Mat::Wood][(b + k) % 4];
            parts.get(mat).block(
                shelf,
                [s, y + 0.03, 0.02],
                [s + 0.065, y + 0.03 + high, 0.2],
                1.2,
                open & !BOTTOM,
            );
        }
    }
    crate::street_lamps::lantern(parts, lamp(), y1);
}
