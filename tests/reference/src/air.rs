//! Closed-in air, the slow way: cells against clipped triangles, and a flood without any index.

use std::collections::BTreeSet;

use crate::cover::Triangle;

/// Whether a triangle has a point in the cube with its lowest corner at `low`: what is left of it after clipping at the
/// six sides (Sutherland & Hodgman 1974).
pub fn touches(triangle: &Triangle, low: [f64; 3], edge: f64) -> bool {
    let mut left: Vec<[f64; 3]> = triangle.to_vec();
    for (axis, low) in low.into_iter().enumerate() {
        for (side, at) in [(1.0, low), (-1.0, low + edge)] {
            let inside = |p: &[f64; 3]| side * (p[axis] - at);
            let mut kept = Vec::new();
            for (i, p) in left.iter().enumerate() {
                let before = &left[(i + left.len() - 1) % left.len()];
                let (a, b) = (inside(before), inside(p));
                if (a < 0.0) != (b < 0.0) {
                    let share = a / (a - b);
                    kept.push([0, 1, 2].map(|k| before[k] + share * (p[k] - before[k])));
                }
                if b >= 0.0 {
                    kept.push(*p);
                }
            }
            left = kept;
        }
    }
    !left.is_empty()
}

/// The cells of edge `edge` in reach of `eye` through faces of free cells, at most `cells` away from the eye's; `None`
/// where rain reaches one of them or none is free. A cell is free where no triangle touches it, grown by `grow` of its
/// edge on all sides.
pub fn flood(
    triangles: &[Triangle],
    eye: [f64; 3],
    edge: f64,
    cells: i64,
    grow: f64,
    mut reached: impl FnMut([f64; 3]) -> bool,
) -> Option<BTreeSet<[i64; 3]>> {
    const SIDES: [[i64; 3]; 6] = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
    let free = |cell: [i64; 3]| {
        let low = cell.map(|c| (c as f64 - grow) * edge);
        !triangles
            .iter()
            .any(|triangle| touches(triangle, low, (1.0 + 2.0 * grow) * edge))
    };
    let beside = |cell: [i64; 3], side: [i64; 3]| [0, 1, 2].map(|i| cell[i] + side[i]);
    let start = eye.map(|x| (x / edge).floor() as i64);
    let mut open: Vec<[i64; 3]> = if free(start) {
        vec![start]
    } else {
        SIDES
            .iter()
            .map(|side| beside(start, *side))
            .filter(|cell| free(*cell))
            .collect()
    };
    if open.is_empty() {
        return None;
    }
    let mut found: BTreeSet<[i64; 3]> = open.iter().copied().collect();
    while let Some(cell) = open.pop() {
        if reached(cell.map(|c| (c as f64 + 0.5) * edge)) {
            return None;
        }
        for side in SIDES {
            let next = beside(cell, side);
            let away: i64 = (0..3).map(|i| (next[i] - start[i]).pow(2)).sum();
            if away <= cells * cells && !found.contains(&next) && free(next) {
                found.insert(next);
                open.push(next);
            }
        }
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slanted_triangles_touch_the_cubes_that_they_cut() {
        let corner = [[0.9, 0.0, 0.0], [0.0, 0.9, 0.0], [0.0, 0.0, 0.9]];
        assert!(touches(&corner, [0.0; 3], 1.0));
        assert!(touches(&corner, [0.0; 3], 0.31), "its middle is at 0.3");
        assert!(!touches(&corner, [0.0; 3], 0.29));
        assert!(!touches(&corner, [0.5; 3], 1.0));
        // Larger than the cube, no corner in it.
        let large = [[-9.0, 0.5, -9.0], [9.0, 0.5, -9.0], [0.0, 0.5, 19.0]];
        assert!(touches(&large, [0.0; 3], 1.0) && !touches(&large, [0.0, 0.6, 0.0], 1.0));
    }

    #[test]
    fn air_in_a_box_is_closed_in() {
        let side = |p: [[f64; 3]; 4]| [[p[0], p[1], p[2]], [p[0], p[2], p[3]]];
        let mut walls = Vec::new();
        for axis in 0..3 {
            for at in [0.5, 3.5] {
                walls.extend(side([[0.5, 0.5], [3.5, 0.5], [3.5, 3.5], [0.5, 3.5]].map(|[a, b]| {
                    let mut p = [at; 3];
                    p[(axis + 1) % 3] = a;
                    p[(axis + 2) % 3] = b;
                    p
                })));
            }
        }
        let found = flood(&walls, [2.0; 3], 1.0, 9, 0.0, |_| false).expect("closed");
        assert_eq!(found.len(), 8, "cells 1 and 2 along each axis");
        assert!(flood(&walls[2..], [2.0; 3], 1.0, 9, 0.0, |p| p[0] < 0.0).is_none());
        assert!(
            flood(&walls, [0.5; 3], 1.0, 9, 0.0, |p| p[0] < 0.0).is_none(),
            "an eye in a wall"
        );
    }
}
