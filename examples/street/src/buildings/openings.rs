//! What fills a hole in a wall: window, door, shop front; and awnings.

use super::{Dress, tile};
use crate::materials::{Mat, Parts};
use crate::mesh::{ALL, BACK, BOTTOM, FRONT, Frame, LEFT, RIGHT, TOP};
use crate::noise::Rng;
use crate::textures::windows::{SHOP_CELLS, WINDOW_CELLS};
use glam::vec2;

/// Depth of window recesses, metres.
const RECESS: f32 = 0.17;
/// Where awnings are fixed to the wall, metres above 0.
pub const AWNING_HIGH_Y: f32 = 2.95;
/// Lower edge of the awnings' valance.
pub const AWNING_LOW_Y: f32 = 2.28;
/// How far awnings stand out.
pub const AWNING_REACH: f32 = 1.25;

/// What a hole holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A window; lit or dark.
    Window {
        /// A lamp is on behind it.
        lit: bool,
    },
    /// A house door.
    Door,
    /// A shop's show window.
    Show,
    /// A shop's glazed door.
    ShopDoor,
}

/// A rectangular hole in a wall, in the wall's frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Opening {
    /// Left, right.
    pub s: [f32; 2],
    /// Lower, upper.
    pub y: [f32; 2],
    /// Filling.
    pub kind: Kind,
}

/// A pane that shows cell `cell` of an atlas.
fn pane(parts: &mut Parts, mat: Mat, f: &Frame, s: [f32; 2], y: [f32; 2], d: f32, cell: u32, cells: [u32; 2]) {
    let (cu, cv) = (1.0 / cells[0] as f32, 1.0 / cells[1] as f32);
    let inset = 0.012;
    let (u0, v0) = (
        (cell % cells[0]) as f32 * cu,
        ((cell / cells[0]) % cells[1]) as f32 * cv,
    );
    let (a, b) = (
        vec2(u0 + inset * cu, v0 + inset * cv),
        vec2(u0 + cu * (1.0 - inset), v0 + cv * (1.0 - inset)),
    );
    parts.get(mat).quad_uv(
        [
            f.at(s[0], y[0], d),
            f.at(s[1], y[0], d),
            f.at(s[1], y[1], d),
            f.at(s[0], y[1], d),
        ],
        [vec2(a.x, b.y), b, vec2(b.x, a.y), a],
    );
}

/// The inner sides of a hole of depth `depth`; `threshold`: the lower one too.
fn reveal(parts: &mut Parts, wall: Mat, f: &Frame, o: &Opening, depth: f32, threshold: bool) {
    let ([s0, s1], [y0, y1]) = (o.s, o.y);
    let m = parts.get(wall);
    let t = tile(wall);
    let r = -depth;
    m.quad(
        [f.at(s0, y0, 0.0), f.at(s0, y0, r), f.at(s0, y1, r), f.at(s0, y1, 0.0)],
        t,
    );
    m.quad(
        [f.at(s1, y0, r), f.at(s1, y0, 0.0), f.at(s1, y1, 0.0), f.at(s1, y1, r)],
        t,
    );
    m.quad(
        [f.at(s0, y1, r), f.at(s1, y1, r), f.at(s1, y1, 0.0), f.at(s0, y1, 0.0)],
        t,
    );
    if threshold {
        m.quad(
            [f.at(s0, y0, 0.0), f.at(s1, y0, 0.0), f.at(s1, y0, r), f.at(s0, y0, r)],
            t,
        );
    }
}

/// Bars of a frame from depth `d0` to `d1`: an outer one `b` wide, then uprights and crossbars at the given places.
fn bars(parts: &mut Parts, mat: Mat, f: &Frame, o: &Opening, d: [f32; 2], b: f32, upright: &[f32], cross: &[f32]) {
    let ([s0, s1], [y0, y1]) = (o.s, o.y);
    let m = parts.get(mat);
    let t = tile(mat);
    m.block(f, [s0, y0, d[0]], [s0 + b, y1, d[1]], t, FRONT | RIGHT);
    m.block(f, [s1 - b, y0, d[0]], [s1, y1, d[1]], t, FRONT | LEFT);
    m.block(f, [s0 + b, y1 - b, d[0]], [s1 - b, y1, d[1]], t, FRONT | BOTTOM);
    m.block(f, [s0 + b, y0, d[0]], [s1 - b, y0 + b, d[1]], t, FRONT | TOP);
    for &s in upright {
        m.block(
            f,
            [s - 0.4 * b, y0 + b, d[0]],
            [s + 0.4 * b, y1 - b, d[1] - 0.004],
            t,
            FRONT | LEFT | RIGHT,
        );
    }
    for &y in cross {
        m.block(
            f,
            [s0 + b, y - 0.3 * b, d[0]],
            [s1 - b, y + 0.3 * b, d[1] - 0.008],
            t,
            FRONT | TOP | BOTTOM,
        );
    }
}

/// Fills one opening.
pub fn fill(parts: &mut Parts, f: &Frame, o: &Opening, wall: Mat, dress: Dress, rng: &mut Rng) {
    match o.kind {
        Kind::Window { lit } => window(parts, f, o, wall, dress, lit, rng),
        Kind::Door => door(parts, f, o, wall, rng),
        Kind::Show => show(parts, f, o, rng),
        Kind::ShopDoor => shop_door(parts, f, o, rng),
    }
}

fn window(parts: &mut Parts, f: &Frame, o: &Opening, wall: Mat, dress: Dress, lit: bool, rng: &mut Rng) {
    let ([s0, s1], [y0, y1]) = (o.s, o.y);
    reveal(parts, wall, f, o, RECESS, true);
    let mat = if lit { Mat::PaneLit } else { Mat::Pane };
    let cell = rng.below((WINDOW_CELLS[0] * WINDOW_CELLS[1]) as usize) as u32;
    pane(parts, mat, f, o.s, o.y, -RECESS + 0.02, cell, WINDOW_CELLS);
    let transom = y0 + 0.68 * (y1 - y0);
    bars(
        parts,
        Mat::White,
        f,
        o,
        [-RECESS + 0.02, -RECESS + 0.075],
        0.065,
        &[0.5 * (s0 + s1)],
        &[transom],
    );
    let trim = if wall == Mat::Stone { Mat::White } else { Mat::Stone };
    let t = tile(trim);
    let sides = FRONT | LEFT | RIGHT | TOP | BOTTOM;
    parts
        .get(trim)
        .block(f, [s0 - 0.07, y0 - 0.07, 0.0], [s1 + 0.07, y0, 0.085], t, sides);
    match dress {
        Dress::Bare => {
            parts
                .get(trim)
                .block(f, [s0 - 0.12, y1, 0.0], [s1 + 0.12, y1 + 0.2, 0.02], t, sides);
        }
        Dress::Framed => {
            let m = parts.get(trim);
            m.block(f, [s0 - 0.13, y0, 0.0], [s0, y1, 0.03], t, FRONT | LEFT | RIGHT);
            m.block(f, [s1, y0, 0.0], [s1 + 0.13, y1, 0.03], t, FRONT | LEFT | RIGHT);
            m.block(f, [s0 - 0.13, y1, 0.0], [s1 + 0.13, y1 + 0.17, 0.03], t, sides);
            m.block(f, [s0 - 0.19, y1 + 0.17, 0.0], [s1 + 0.19, y1 + 0.23, 0.09], t, sides);
        }
        Dress::Shutters => {
            let w = 0.5 * (s1 - s0);
            let m = parts.get(Mat::Painted);
            let t = tile(Mat::Painted);
            for left in [s0 - w - 0.03, s1 + 0.03] {
                m.block(f, [left, y0 + 0.01, 0.012], [left + w, y1, 0.05], t, sides);
                for y in [y0 + 0.18, y0 + 0.55 * (y1 - y0), y1 - 0.22] {
                    m.block(f, [left + 0.03, y, 0.05], [left + w - 0.03, y + 0.07, 0.065], t, sides);
                }
            }
        }
    }
}

fn door(parts: &mut Parts, f: &Frame, o: &Opening, wall: Mat, rng: &mut Rng) {
    let ([s0, s1], [y0, y1]) = (o.s, o.y);
    let depth = 0.24;
    reveal(parts, wall, f, o, depth, false);
    let d = -depth + 0.03;
    let light = y1 - 0.42;
    // The leaf with raised panels, and a lit pane above it.
    let m = parts.get(Mat::Wood);
    let t = tile(Mat::Wood);
    m.block(f, [s0 + 0.07, y0, -depth], [s1 - 0.07, light - 0.06, d], t, FRONT);
    let mid = 0.5 * (s0 + s1);
    let sides = FRONT | LEFT | RIGHT | TOP | BOTTOM;
    for [a, b] in [[s0 + 0.16, mid - 0.05], [mid + 0.05, s1 - 0.16]] {
        for [low, high] in [[0.14, 0.42], [0.5, 0.9]] {
            let h = light - 0.06 - y0;
            m.block(f, [a, y0 + low * h, d], [b, y0 + high * h, d + 0.025], t, sides);
        }
    }
    let mut upper = *o;
    upper.y = [light, y1];
    let lit = rng.unit() < 0.5;
    pane(
        parts,
        if lit { Mat::PaneLit } else { Mat::Pane },
        f,
        o.s,
        upper.y,
        d - 0.005,
        rng.below(8) as u32,
        WINDOW_CELLS,
    );
    bars(
        parts,
        Mat::White,
        f,
        o,
        [d - 0.005, d + 0.05],
        0.07,
        &[],
        &[light - 0.03],
    );
    let m = parts.get(Mat::Iron);
    m.block(
        f,
        [s1 - 0.19, y0 + 0.98, d],
        [s1 - 0.15, y0 + 1.1, d + 0.06],
        1.0,
        sides,
    );
    let m = parts.get(Mat::Stone);
    let t = tile(Mat::Stone);
    m.block(f, [s0 - 0.12, -0.1, -depth], [s1 + 0.12, y0, 0.3], t, sides);
    m.block(f, [s0 - 0.17, y0, 0.0], [s0, y1, 0.05], t, FRONT | LEFT | RIGHT);
    m.block(f, [s1, y0, 0.0], [s1 + 0.17, y1, 0.05], t, FRONT | LEFT | RIGHT);
    m.block(f, [s0 - 0.17, y1, 0.0], [s1 + 0.17, y1 + 0.22, 0.05], t, sides);
    m.block(f, [s0 - 0.25, y1 + 0.22, 0.0], [s1 + 0.25, y1 + 0.3, 0.16], t, sides);
}

fn show(parts: &mut Parts, f: &Frame, o: &Opening, rng: &mut Rng) {
    let ([s0, s1], [y0, y1]) = (o.s, o.y);
    reveal(parts, Mat::Painted, f, o, RECESS, true);
    let n = ((s1 - s0) / 1.7).round().max(1.0) as usize;
    let at = |k: usize| s0 + (s1 - s0) * (k as f32 / n as f32);
    let first = rng.below(4);
    for k in 0..n {
        let cell = ((first + k) % 4) as u32;
        pane(
            parts,
            Mat::Shop,
            f,
            [at(k), at(k + 1)],
            o.y,
            -RECESS + 0.02,
            cell,
            SHOP_CELLS,
        );
    }
    let uprights: Vec<f32> = (1..n).map(at).collect();
    bars(
        parts,
        Mat::Painted,
        f,
        o,
        [-RECESS + 0.02, -RECESS + 0.09],
        0.07,
        &uprights,
        &[y1 - 0.45],
    );
    let sides = FRONT | LEFT | RIGHT | TOP | BOTTOM;
    let t = tile(Mat::Painted);
    let m = parts.get(Mat::Painted);
    // Stall riser with panels, sill.
    m.block(f, [s0, 0.0, -0.02], [s1, y0 - 0.06, 0.03], t, FRONT | LEFT | RIGHT);
    for k in 0..n {
        m.block(
            f,
            [at(k) + 0.12, 0.2, 0.03],
            [at(k + 1) - 0.12, y0 - 0.14, 0.045],
            t,
            sides,
        );
    }
    m.block(f, [s0 - 0.05, y0 - 0.06, 0.0], [s1 + 0.05, y0, 0.1], t, sides);
}

fn shop_door(parts: &mut Parts, f: &Frame, o: &Opening, rng: &mut Rng) {
    let ([s0, s1], [y0, y1]) = (o.s, o.y);
    let depth = 0.4;
    reveal(parts, Mat::Painted, f, o, depth, false);
    let mut glass = *o;
    glass.y[0] = y0 + 0.75;
    let d = -depth + 0.02;
    pane(
        parts,
        Mat::Shop,
        f,
        [s0, s1],
        glass.y,
        d,
        rng.below(4) as u32,
        SHOP_CELLS,
    );
    bars(parts, Mat::Painted, f, &glass, [d, d + 0.06], 0.12, &[], &[y1 - 0.5]);
    let m = parts.get(Mat::Painted);
    m.block(
        f,
        [s0, y0, -depth],
        [s1, y0 + 0.75, d + 0.06],
        tile(Mat::Painted),
        FRONT | TOP,
    );
    m.block(
        f,
        [s0 + 0.2, y0 + 0.15, d + 0.06],
        [s1 - 0.2, y0 + 0.6, d + 0.075],
        tile(Mat::Painted),
        ALL & !BACK,
    );
    parts.get(Mat::Stone).block(
        f,
        [s0 - 0.05, -0.1, -depth],
        [s1 + 0.05, y0, 0.12],
        tile(Mat::Stone),
        ALL & !BACK,
    );
}

/// The board with the shop's name, without the name.
pub fn sign(parts: &mut Parts, f: &Frame, s: [f32; 2], y: [f32; 2]) {
    let t = tile(Mat::Painted);
    let m = parts.get(Mat::Painted);
    m.block(f, [s[0], y[0], 0.0], [s[1], y[1], 0.07], t, ALL & !BACK);
    m.block(
        f,
        [s[0] - 0.06, y[1], 0.0],
        [s[1] + 0.06, y[1] + 0.08, 0.16],
        t,
        ALL & !BACK,
    );
    let m = parts.get(Mat::Cream);
    m.block(
        f,
        [s[0] + 0.12, y[0] + 0.1, 0.07],
        [s[1] - 0.12, y[0] + 0.13, 0.078],
        4.0,
        ALL & !BACK,
    );
    m.block(
        f,
        [s[0] + 0.12, y[1] - 0.13, 0.07],
        [s[1] - 0.12, y[1] - 0.1, 0.078],
        4.0,
        ALL & !BACK,
    );
}

/// An awning of cloth over `s`: a slope, a valance and triangular cheeks, seen from both sides.
pub fn awning(parts: &mut Parts, f: &Frame, s: [f32; 2]) {
    let [s0, s1] = [s[0] - 0.15, s[1] + 0.15];
    let (top, low, reach) = (AWNING_HIGH_Y, AWNING_LOW_Y + 0.24, AWNING_REACH);
    let thick = 0.012;
    let m = parts.get(Mat::Cloth);
    let slope = (reach * reach + (top - low) * (top - low)).sqrt();
    let p = |s: f32, y: f32, d: f32| f.at(s, y, d);
    let mut both = |c: [[f32; 3]; 4], uv: [[f32; 2]; 4], off: [f32; 2]| {
        let front = c.map(|[s, y, d]| p(s, y, d));
        m.quad_uv(front, uv.map(|[u, v]| vec2(u, v)));
        let back = [3, 2, 1, 0].map(|k: usize| p(c[k][0], c[k][1] - off[0], c[k][2] - off[1]));
        m.quad_uv(back, [3, 2, 1, 0].map(|k: usize| vec2(uv[k][0], uv[k][1])));
    };
    let (u0, u1) = (0.0, (s1 - s0).round());
    let slope_face = [[s0, low, reach], [s1, low, reach], [s1, top, 0.0], [s0, top, 0.0]];
    both(
        slope_face,
        [[u0, slope], [u1, slope], [u1, 0.0], [u0, 0.0]],
        [thick, 0.0],
    );
    let v = slope + 0.24;
    let valance = [
        [s0, AWNING_LOW_Y, reach],
        [s1, AWNING_LOW_Y, reach],
        [s1, low, reach],
        [s0, low, reach],
    ];
    both(valance, [[u0, v], [u1, v], [u1, slope], [u0, slope]], [0.0, thick]);
    for (s, flip) in [(s0, false), (s1, true)] {
        let [a, b, c] = [p(s, top, 0.0), p(s, low, 0.0), p(s, low, reach)];
        m.tri(if flip { [a, c, b] } else { [a, b, c] }, 1.0);
        let inward = f.right * if flip { -thick } else { thick };
        m.tri(
            if flip {
                [a + inward, b + inward, c + inward]
            } else {
                [a + inward, c + inward, b + inward]
            },
            1.0,
        );
    }
    let iron = parts.get(Mat::Iron);
    for s in [s0 + 0.06, s1 - 0.06] {
        iron.tube(
            p(s, low - 0.35, 0.0),
            p(s, low - 0.02, reach - 0.03),
            [0.014, 0.014],
            6,
            1.0,
            false,
        );
    }
}
