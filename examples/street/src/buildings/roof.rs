//! Pitched roofs with tiles, eaves, gutters and pipes, chimneys, dormers.

use super::{House, tile};
use crate::layout::EAVES_OVERHANG;
use crate::materials::{Mat, Parts};
use crate::mesh::{ALL, BACK, BOTTOM, FRONT, Frame, LEFT, RIGHT, TOP, cos_sin};
use crate::noise::Rng;
use glam::vec2;

/// Rise over run of the roofs.
pub const PITCH: f32 = 0.86;
/// Thickness of the roofs at their lower edge, metres.
pub const THICKNESS: f32 = 0.14;
/// Radius of the gutters, metres.
const GUTTER_R: f32 = 0.07;
/// How far a roof stands over its gables, metres.
const VERGE: f32 = 0.05;

/// Height of the tiles' plane at distance `d` out of the façade (negative: over the house), street side.
#[must_use]
pub fn top(h: &House, d: f32) -> f32 {
    h.wall_top() + 0.2 - PITCH * d
}

/// Builds the roof and what stands on it.
pub fn build(h: &House, parts: &mut Parts, rng: &mut Rng) {
    let front = h.frame();
    let back = Frame::facing(front.at(h.width, 0.0, -h.depth), -front.out);
    for f in [&front, &back] {
        slope(h, parts, f);
        gutter(h, parts, f);
    }
    let ridge_y = top(h, -0.5 * h.depth);
    let ridge = parts.get(h.roof);
    let (a, b) = (
        front.at(-VERGE, ridge_y - 0.03, -0.5 * h.depth),
        front.at(h.width + VERGE, ridge_y - 0.03, -0.5 * h.depth),
    );
    ridge.tube(a, b, [0.1, 0.1], 8, tile(h.roof), true);
    pipe(h, parts, &front);
    let n = 1 + rng.below(2);
    for k in 0..n {
        let s = if k == 0 {
            rng.range(1.1, 1.8)
        } else {
            h.width - rng.range(1.1, 1.8)
        };
        chimney(parts, &front, s, ridge_y, -0.5 * h.depth + rng.range(-0.4, 0.4), rng);
    }
    for k in 0..h.dormers {
        let s = h.width * (k as f32 + 0.5) / h.dormers as f32;
        dormer(h, parts, &front, s, rng);
    }
}

fn slope(h: &House, parts: &mut Parts, f: &Frame) {
    let (s0, s1) = (-VERGE, h.width + VERGE);
    let (e, ridge) = (EAVES_OVERHANG, -0.5 * h.depth);
    let (ye, yr) = (top(h, e), top(h, ridge));
    let t = tile(h.roof);
    let length = (e - ridge) * (1.0 + PITCH * PITCH).sqrt();
    let m = parts.get(h.roof);
    // The courses start whole at the eaves; v falls up the roof.
    let uv = [
        vec2(s0 / t, 0.0),
        vec2(s1 / t, 0.0),
        vec2(s1 / t, -length / t),
        vec2(s0 / t, -length / t),
    ];
    m.quad_uv(
        [
            f.at(s0, ye, e),
            f.at(s1, ye, e),
            f.at(s1, yr, ridge),
            f.at(s0, yr, ridge),
        ],
        uv,
    );
    let m = parts.get(Mat::White);
    // Fascia, soffit, barge boards.
    m.quad(
        [
            f.at(s0, ye - THICKNESS, e),
            f.at(s1, ye - THICKNESS, e),
            f.at(s1, ye, e),
            f.at(s0, ye, e),
        ],
        4.0,
    );
    let y = ye - THICKNESS;
    m.quad(
        [f.at(s0, y, 0.0), f.at(s1, y, 0.0), f.at(s1, y, e), f.at(s0, y, e)],
        4.0,
    );
    for (s, flip) in [(s0, false), (s1, true)] {
        let q = [
            f.at(s, yr - THICKNESS, ridge),
            f.at(s, y, e),
            f.at(s, ye, e),
            f.at(s, yr, ridge),
        ];
        m.quad(if flip { [q[1], q[0], q[3], q[2]] } else { q }, 4.0);
        // The underside of the verge, from the boards back to the gable.
        let inner = if flip { h.width } else { 0.0 };
        let r = [
            f.at(s, yr - THICKNESS, ridge),
            f.at(inner, yr - THICKNESS, ridge),
            f.at(inner, y, e),
            f.at(s, y, e),
        ];
        m.quad(if flip { [r[1], r[0], r[3], r[2]] } else { r }, 4.0);
    }
}

fn gutter(h: &House, parts: &mut Parts, f: &Frame) {
    let y = top(h, EAVES_OVERHANG) - 0.05;
    let d = EAVES_OVERHANG + GUTTER_R + 0.005;
    // Seen from below, the half pipe runs from its outer lip under to the inner one.
    parts.get(Mat::Zinc).surface(1, 6, false, |i, j| {
        let (c, s) = cos_sin(std::f32::consts::PI * (j as f32 / 6.0));
        let along = if i == 0 { 0.02 } else { h.width - 0.02 };
        (
            f.at(along, y - GUTTER_R * s, d - GUTTER_R * c),
            vec2(along, j as f32 * 0.04),
        )
    });
    for s in [0.02, h.width - 0.02] {
        let n = 6;
        for j in 0..n {
            let p = |j: usize| {
                let (c, si) = cos_sin(std::f32::consts::PI * (j as f32 / n as f32));
                f.at(s, y - GUTTER_R * si, d - GUTTER_R * c)
            };
            parts.get(Mat::Zinc).tri([f.at(s, y, d), p(j), p(j + 1)], 1.0);
        }
    }
}

fn pipe(h: &House, parts: &mut Parts, f: &Frame) {
    let y = top(h, EAVES_OVERHANG) - 0.05 - GUTTER_R;
    let s = 0.16;
    let bottom = if h.ground == super::Ground::Arcade {
        h.ground_m + 0.05
    } else {
        0.12
    };
    let m = parts.get(Mat::Zinc);
    let wall = 0.11;
    m.tube(
        f.at(s, y - 0.5, wall),
        f.at(s, y + 0.01, EAVES_OVERHANG + GUTTER_R),
        [0.04, 0.04],
        8,
        1.0,
        false,
    );
    m.tube(
        f.at(s, bottom, wall),
        f.at(s, y - 0.48, wall),
        [0.04, 0.04],
        8,
        1.0,
        false,
    );
    let mut at = bottom + 1.2;
    while at < y - 0.8 {
        m.block(
            f,
            [s - 0.05, at, 0.0],
            [s + 0.05, at + 0.04, wall + 0.05],
            1.0,
            ALL & !BACK,
        );
        at += 1.9;
    }
}

fn chimney(parts: &mut Parts, f: &Frame, s: f32, ridge_y: f32, d: f32, rng: &mut Rng) {
    let (w, e) = (rng.range(0.45, 0.75), 0.3);
    let high = ridge_y + rng.range(0.8, 1.3);
    let sides = FRONT | BACK | LEFT | RIGHT;
    parts.get(Mat::Brick).block(
        f,
        [s - w, ridge_y - 1.2, d - e],
        [s + w, high, d + e],
        tile(Mat::Brick),
        sides,
    );
    parts.get(Mat::Stone).block(
        f,
        [s - w - 0.06, high, d - e - 0.06],
        [s + w + 0.06, high + 0.12, d + e + 0.06],
        tile(Mat::Stone),
        ALL,
    );
    let pots = 1 + rng.below(3);
    for k in 0..pots {
        let at = s + (k as f32 + 0.5 - 0.5 * pots as f32) * 0.36;
        let profile = [(0.13, 0.0), (0.1, 0.34), (0.125, 0.42), (0.08, 0.42), (0.0, 0.3)];
        parts
            .get(Mat::Roof)
            .lathe(f.at(at, high + 0.12, d), &profile, 8, tile(Mat::Roof));
    }
}

fn dormer(h: &House, parts: &mut Parts, f: &Frame, s: f32, rng: &mut Rng) {
    use super::openings::{Kind, Opening, fill};
    let d = -0.55;
    let base = top(h, d);
    let (w, height) = (0.68, 1.35);
    let inner = d - height / PITCH;
    let face = Frame::facing(f.at(s - w, base - 0.05, d), f.out);
    let hole = Opening {
        s: [0.17, 2.0 * w - 0.17],
        y: [0.18, height - 0.12],
        kind: Kind::Window { lit: rng.unit() < 0.5 },
    };
    super::facade::wall(parts, &face, 2.0 * w, [-0.1, height], Mat::Zinc, &[hole]);
    fill(parts, &face, &hole, Mat::Zinc, super::Dress::Bare, rng);
    let y = base - 0.05;
    let m = parts.get(Mat::Zinc);
    m.block(
        f,
        [s - w, y - 0.3, inner - 0.2],
        [s + w, y + height, d],
        1.0,
        LEFT | RIGHT,
    );
    // A nearly flat lid that runs into the tiles.
    m.block(
        f,
        [s - w - 0.12, y + height, inner - 0.3],
        [s + w + 0.12, y + height + 0.09, d + 0.16],
        1.0,
        FRONT | LEFT | RIGHT | TOP | BOTTOM,
    );
}
