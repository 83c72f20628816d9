//! The cabin: windscreen, side windows, hatch and roof on one lofted shell.

use super::{CarMat, CarParts, shell};
use glam::{Vec2, Vec3, vec2, vec3};

/// Heights of the rows, and how far each has come from the base outline to the roof's outline.
const ROWS: [(f32, f32); 9] = [
    (0.79, 0.0),
    (0.895, 0.17),
    (0.93, 0.22),
    (1.05, 0.42),
    (1.17, 0.61),
    (1.29, 0.79),
    (1.335, 0.86),
    (1.385, 0.945),
    (1.415, 1.03),
];
/// Rows of the roof from its edge to the middle plane, as shares.
const ROOF: [f32; 5] = [0.18, 0.4, 0.62, 0.84, 1.0];

/// Half sizes and middle (z) of the outline where the cabin meets the body.
const BASE: (Vec2, f32) = (vec2(0.825, 1.49), -0.4);
/// Half sizes and middle (z) of the roof's outline.
const TOP: (Vec2, f32) = (vec2(0.6, 0.8), -0.55);

fn point(base: Vec2, top: Vec2, j: usize) -> Vec3 {
    let place = |t: f32| {
        // The glass bulges a little between body and roof.
        let bulge = 0.035 * 4.0 * t * (1.0 - t).max(0.0);
        let p = base.lerp(top, t);
        let from = vec2(p.x, p.y - BASE.1);
        let out = from.normalize_or(Vec2::Y) * bulge;
        p + out
    };
    if j < ROWS.len() {
        let p = place(ROWS[j].1);
        return vec3(p.x, ROWS[j].0, p.y);
    }
    let (y, t) = ROWS[ROWS.len() - 1];
    let p = place(t);
    let s = ROOF[j - ROWS.len()];
    let share = (p.y - TOP.1) / TOP.0.y;
    let along = 1.0 - (share * share).min(1.0);
    vec3(
        p.x * (1.0 - s),
        y + (0.012 + 0.033 * along) * (1.0 - (1.0 - s) * (1.0 - s)),
        p.y,
    )
}

/// Builds the cabin.
pub fn build(parts: &mut CarParts) {
    let side = [
        0.85, 0.74, 0.62, 0.5, 0.36, 0.2, 0.04, -0.03, -0.12, -0.3, -0.5, -0.64, -0.74, -0.84,
    ];
    let of = |(half, middle): (Vec2, f32), shares: &[f32]| -> Vec<Vec2> {
        let z: Vec<f32> = shares.iter().map(|s| s * half.y).collect();
        shell::outline(half, 6, &z)
            .into_iter()
            .map(|p| vec2(p.x, p.y + middle))
            .collect()
    };
    let (base, top) = (of(BASE, &side), of(TOP, &side));
    let ends = 11;
    let last = base.len() - 1;
    let choose = |k: usize, j: usize| {
        let glass_rows = (2..6).contains(&j);
        // Pillars: at the corners, and one between the doors.
        let first = k.min(last - 1 - k);
        let pillar = (7..ends).contains(&first) || k == ends + 6 || k + 1 == last - ends || k == ends + 12;
        let screen = first < 7 && (1..7).contains(&j);
        Some(if (glass_rows && !pillar) || screen {
            CarMat::Glass
        } else {
            CarMat::Paint
        })
    };
    shell::add(
        parts,
        base.len(),
        ROWS.len() + ROOF.len(),
        |k, j| point(base[k], top[k], j),
        choose,
    );
    // Wipers and the aerial.
    let black = parts.get(CarMat::Plastic);
    for x in [0.05, -0.5] {
        black.tube(
            vec3(x, 0.885, 1.09),
            vec3(x + 0.42, 0.905, 1.02),
            [0.008, 0.006],
            5,
            1.0,
            true,
        );
    }
    black.tube(
        vec3(0.0, 1.45, -1.3),
        vec3(0.0, 1.62, -1.5),
        [0.006, 0.003],
        5,
        1.0,
        true,
    );
}
