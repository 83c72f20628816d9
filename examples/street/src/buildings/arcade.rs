//! The arcade: a covered walkway under two houses, behind four arches.

use super::facade::wall;
use super::openings::{Kind, Opening, fill, sign};
use super::{Dress, tile};
use crate::layout::{ARCADE_CEILING_Y, ARCADE_COLUMN, ARCADE_DEPTH, ARCADE_FLOOR_Y, ARCADE_Z, FACADE_X};
use crate::materials::{Mat, Parts};
use crate::mesh::{ALL, BACK, BOTTOM, FRONT, Frame, LEFT, RIGHT, TOP, cos_sin};
use crate::noise::Rng;
use glam::{Vec3, vec3};

/// Number of arches.
const BAYS: usize = 4;
/// Half the width of a column, metres.
const HALF_COLUMN: f32 = 0.3;
/// Where arches spring from, metres.
const SPRING_Y: f32 = 2.45;
/// Rise of the arches, metres.
const RISE: f32 = 0.8;
/// Straight pieces of an arch.
const PIECES: usize = 14;
/// Where the houses' own façades begin.
const HEAD_Y: f32 = 3.7;

/// Length of the arcade, metres.
fn length() -> f32 {
    ARCADE_Z[1] - ARCADE_Z[0]
}

/// The arcade's frame: s along the street, d out of the façade.
fn frame() -> Frame {
    Frame::facing(vec3(FACADE_X, 0.0, ARCADE_Z[0]), Vec3::NEG_X)
}

/// Where its lanterns hang.
#[must_use]
pub fn lanterns() -> Vec<Vec3> {
    let bay = length() / BAYS as f32;
    [0, 1, 2, 3]
        .map(|k| frame().at((k as f32 + 0.5) * bay, 2.95, -0.55 * ARCADE_DEPTH))
        .to_vec()
}

fn arches(parts: &mut Parts, f: &Frame) {
    let bay = length() / BAYS as f32;
    let t = tile(Mat::Stone);
    let m = parts.get(Mat::Stone);
    let back = -ARCADE_COLUMN;
    for k in 0..=BAYS {
        let s = k as f32 * bay;
        let (a, b) = ((s - HALF_COLUMN).max(0.0), (s + HALF_COLUMN).min(length()));
        let round = FRONT | BACK | LEFT | RIGHT;
        m.block(f, [a, -0.25, back], [b, SPRING_Y, 0.0], t, round);
        m.block(f, [a, SPRING_Y, back], [b, HEAD_Y, 0.0], t, FRONT | BACK);
        let (a, b) = ((a - 0.06).max(0.0), (b + 0.06).min(length()));
        m.block(f, [a, -0.25, back - 0.06], [b, 0.55, 0.06], t, ALL & !BOTTOM);
        m.block(f, [a, SPRING_Y - 0.16, back - 0.06], [b, SPRING_Y, 0.06], t, ALL);
    }
    for k in 0..BAYS {
        let (a, b) = (k as f32 * bay + HALF_COLUMN, (k + 1) as f32 * bay - HALF_COLUMN);
        let point = |i: usize| {
            let (c, s) = cos_sin(std::f32::consts::PI * (1.0 - i as f32 / PIECES as f32));
            (0.5 * (a + b) + 0.5 * (b - a) * c, SPRING_Y + RISE * s)
        };
        for i in 0..PIECES {
            let ((s0, y0), (s1, y1)) = (point(i), point(i + 1));
            let top = HEAD_Y;
            m.quad(
                [
                    f.at(s0, y0, 0.0),
                    f.at(s1, y1, 0.0),
                    f.at(s1, top, 0.0),
                    f.at(s0, top, 0.0),
                ],
                t,
            );
            m.quad(
                [
                    f.at(s1, y1, back),
                    f.at(s0, y0, back),
                    f.at(s0, top, back),
                    f.at(s1, top, back),
                ],
                t,
            );
            m.quad(
                [
                    f.at(s0, y0, back),
                    f.at(s1, y1, back),
                    f.at(s1, y1, 0.0),
                    f.at(s0, y0, 0.0),
                ],
                t,
            );
            // The arch's ring of stones stands a little proud.
            let out = |s: f32, y: f32| {
                let d = vec3(s - 0.5 * (a + b), y - SPRING_Y + 0.35, 0.0).normalize() * 0.24;
                (s + d.x, y + d.y)
            };
            let ((o0, q0), (o1, q1)) = (out(s0, y0), out(s1, y1));
            m.quad(
                [
                    f.at(s0, y0, 0.03),
                    f.at(s1, y1, 0.03),
                    f.at(o1, q1, 0.03),
                    f.at(o0, q0, 0.03),
                ],
                t,
            );
            m.quad(
                [
                    f.at(o0, q0, 0.03),
                    f.at(o1, q1, 0.03),
                    f.at(o1, q1, 0.0),
                    f.at(o0, q0, 0.0),
                ],
                t,
            );
            m.quad(
                [
                    f.at(s0, y0, 0.0),
                    f.at(s1, y1, 0.0),
                    f.at(s1, y1, 0.03),
                    f.at(s0, y0, 0.03),
                ],
                t,
            );
        }
        let mid = 0.5 * (a + b);
        let crown = SPRING_Y + RISE;
        m.block(
            f,
            [mid - 0.13, crown - 0.03, 0.0],
            [mid + 0.13, crown + 0.34, 0.07],
            t,
            ALL & !BACK,
        );
    }
}

fn end_walls(parts: &mut Parts, f: &Frame) {
    // Two centimetres before the neighbour's gable, which stands in the same plane as the arcade's end.
    let shut = Frame::facing(f.at(0.02, 0.0, 0.0), f.right);
    wall(parts, &shut, ARCADE_DEPTH, [-0.25, ARCADE_CEILING_Y], Mat::Cream, &[]);
    // The far end opens to the square through a wall 40 cm thick.
    let thick = 0.4;
    let hole = [0.62, 2.95];
    let outer = Frame::facing(f.at(length(), 0.0, 0.0), f.right);
    let inner = Frame::facing(f.at(length() - thick, 0.0, -ARCADE_DEPTH), -f.right);
    let open = |s: [f32; 2]| Opening {
        s,
        y: [-0.25, 2.8],
        kind: Kind::Door,
    };
    let mirrored = [ARCADE_DEPTH - hole[1], ARCADE_DEPTH - hole[0]];
    wall(
        parts,
        &outer,
        ARCADE_DEPTH,
        [-0.25, ARCADE_CEILING_Y],
        Mat::Stone,
        &[open(hole)],
    );
    wall(
        parts,
        &inner,
        ARCADE_DEPTH,
        [-0.25, ARCADE_CEILING_Y],
        Mat::Cream,
        &[open(mirrored)],
    );
    let m = parts.get(Mat::Stone);
    let t = tile(Mat::Stone);
    let g = &outer;
    m.quad(
        [
            g.at(hole[0], -0.25, 0.0),
            g.at(hole[0], -0.25, -thick),
            g.at(hole[0], 2.8, -thick),
            g.at(hole[0], 2.8, 0.0),
        ],
        t,
    );
    m.quad(
        [
            g.at(hole[1], -0.25, -thick),
            g.at(hole[1], -0.25, 0.0),
            g.at(hole[1], 2.8, 0.0),
            g.at(hole[1], 2.8, -thick),
        ],
        t,
    );
    m.quad(
        [
            g.at(hole[0], 2.8, -thick),
            g.at(hole[1], 2.8, -thick),
            g.at(hole[1], 2.8, 0.0),
            g.at(hole[0], 2.8, 0.0),
        ],
        t,
    );
    m.block(
        g,
        [hole[0], -0.25, -0.01],
        [hole[1], ARCADE_FLOOR_Y, 0.25],
        t,
        FRONT | TOP | LEFT | RIGHT,
    );
}

/// Builds the walkway.
pub fn build(parts: &mut Parts, rng: &mut Rng) {
    let f = frame();
    let len = length();
    arches(parts, &f);
    end_walls(parts, &f);
    let slabs = parts.get(Mat::Slabs);
    slabs.block(
        &f,
        [0.0, ARCADE_FLOOR_Y, -ARCADE_DEPTH],
        [len, ARCADE_FLOOR_Y, -ARCADE_COLUMN],
        2.0,
        TOP,
    );
    let stone = parts.get(Mat::Stone);
    let t = tile(Mat::Stone);
    stone.block(
        &f,
        [0.0, -0.25, -ARCADE_COLUMN],
        [len, ARCADE_FLOOR_Y, 0.09],
        t,
        TOP | FRONT | RIGHT,
    );
    let white = parts.get(Mat::White);
    white.block(
        &f,
        [0.0, ARCADE_CEILING_Y, -ARCADE_DEPTH],
        [len, ARCADE_CEILING_Y, -ARCADE_COLUMN],
        4.0,
        BOTTOM,
    );
    let bay = len / BAYS as f32;
    for k in 1..BAYS {
        let s = k as f32 * bay;
        let low = ARCADE_CEILING_Y - 0.3;
        white.block(
            &f,
            [s - 0.2, low, -ARCADE_DEPTH],
            [s + 0.2, ARCADE_CEILING_Y, -ARCADE_COLUMN],
            4.0,
            LEFT | RIGHT | BOTTOM,
        );
    }
    let rear = Frame::facing(f.at(0.0, 0.0, -ARCADE_DEPTH), f.out);
    let hole = |a: f32, b: f32, low: f32, high: f32, kind| Opening {
        s: [a, b],
        y: [low, high],
        kind,
    };
    let door = ARCADE_FLOOR_Y + 0.03;
    let holes = [
        hole(0.7, 3.7, 0.75, 2.72, Kind::Show),
        hole(4.0, 5.05, door, 2.72, Kind::ShopDoor),
        hole(6.4, 7.6, door, 2.6, Kind::Door),
        hole(8.7, 12.0, 0.75, 2.72, Kind::Show),
        hole(12.3, 13.35, door, 2.72, Kind::ShopDoor),
    ];
    wall(parts, &rear, len, [-0.1, ARCADE_CEILING_Y], Mat::Cream, &holes);
    for o in &holes {
        fill(parts, &rear, o, Mat::Cream, Dress::Bare, rng);
    }
    sign(parts, &rear, [0.5, 5.25], [2.84, 3.2]);
    sign(parts, &rear, [8.5, 13.5], [2.84, 3.2]);
    for p in lanterns() {
        crate::street_lamps::lantern(parts, p, ARCADE_CEILING_Y);
    }
}
