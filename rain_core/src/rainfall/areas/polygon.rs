//! Simple polygons: no edge meets another but at their common corner.

use glam::DVec2;

/// Twice the signed area: positive where the corners run from x to y. Units: m².
pub(super) fn double_area(corners: &[DVec2]) -> f64 {
    let last = corners.last().copied().unwrap_or_default();
    let first = corners.first().copied().unwrap_or_default();
    let mut before = last - first;
    let mut sum = 0.0;
    for &corner in corners {
        let corner = corner - first;
        sum += before.perp_dot(corner);
        before = corner;
    }
    sum
}

/// Side of `c` seen along a → b: 1, −1, or 0 on the line.
fn side(a: DVec2, b: DVec2, c: DVec2) -> i32 {
    let area = (b - a).perp_dot(c - a);
    i32::from(area > 0.0) - i32::from(area < 0.0)
}

fn on_segment(a: DVec2, b: DVec2, p: DVec2) -> bool {
    side(a, b, p) == 0 && p.cmpge(a.min(b)).all() && p.cmple(a.max(b)).all()
}

fn meet(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    let sides = [side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b)];
    (sides[0] * sides[1] < 0 && sides[2] * sides[3] < 0)
        || on_segment(a, b, c)
        || on_segment(a, b, d)
        || on_segment(c, d, a)
        || on_segment(c, d, b)
}

/// The first two edges that cross or touch, by the numbers of the corners that they start from; also an edge without
/// length, with itself, and one that runs back on the one before it.
pub(super) fn crossing(corners: &[DVec2]) -> Option<[usize; 2]> {
    let n = corners.len();
    let at = |i: usize| corners[i % n];
    if let Some(i) = (0..n).find(|&i| at(i) == at(i + 1)) {
        return Some([i, i]);
    }
    for i in 0..n {
        // Neighbours share a corner: only a fold is wrong.
        let (back, ahead) = (at(i) - at(i + 1), at(i + 2) - at(i + 1));
        if side(at(i), at(i + 1), at(i + 2)) == 0 && back.dot(ahead) > 0.0 {
            return Some([i, (i + 1) % n]);
        }
        for j in i + 2..n {
            if (j + 1) % n != i && meet(at(i), at(i + 1), at(j), at(j + 1)) {
                return Some([i, j]);
            }
        }
    }
    None
}

/// The nearest point of the border, and whether `p` is inside (even–odd rule).
pub(super) fn nearest(corners: &[DVec2], p: DVec2) -> (DVec2, bool) {
    let mut before = corners.last().copied().unwrap_or_default();
    let (mut best, mut point, mut inside) = (f64::INFINITY, before, false);
    for &corner in corners {
        let edge = corner - before;
        let t = ((p - before).dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
        let q = before + t * edge;
        let square = p.distance_squared(q);
        if square < best {
            (best, point) = (square, q);
        }
        if (before.y > p.y) != (corner.y > p.y) {
            // The edge as it rises, so that both its ends agree.
            let left = edge.perp_dot(p - before);
            if (left > 0.0) == (corner.y > before.y) {
                inside = !inside;
            }
        }
        before = corner;
    }
    (point, inside)
}

/// Signed distance from the border of a simple polygon of at least three corners (m): negative inside. Units: m. A point
/// that is not finite counts as the origin.
///
/// Error: 1e-13 of the distances to the corners, against a search along the border.
#[must_use]
pub fn polygon_distance(p: DVec2, corners_m: &[DVec2]) -> f64 {
    let p = if p.is_finite() { p } else { DVec2::ZERO };
    let (q, inside) = nearest(corners_m, p);
    let distance = p.distance(q);
    if inside { -distance } else { distance }
}

/// [`polygon_distance`] in single precision, as the shader has it.
///
/// Error: 2e-6 of the distances to the corners.
#[must_use]
pub fn polygon_distance_f32(p: [f32; 2], corners_m: &[[f32; 2]]) -> f32 {
    let [px, py] = p.map(|v| if v.is_finite() { v } else { 0.0 });
    let [mut bx, mut by] = corners_m.last().copied().unwrap_or_default();
    let (mut best, mut inside) = (f32::MAX, false);
    for &[cx, cy] in corners_m {
        let (ex, ey) = (cx - bx, cy - by);
        let (rx, ry) = (px - bx, py - by);
        let t = ((rx * ex + ry * ey) / (ex * ex + ey * ey)).clamp(0.0, 1.0);
        let (dx, dy) = (rx - t * ex, ry - t * ey);
        best = best.min(dx * dx + dy * dy);
        if (by > py) != (cy > py) && ((ex * ry - ey * rx > 0.0) == (cy > by)) {
            inside = !inside;
        }
        (bx, by) = (cx, cy);
    }
    let distance = best.sqrt();
    if inside { -distance } else { distance }
}
