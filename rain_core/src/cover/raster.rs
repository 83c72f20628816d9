//! Triangles in the projected plane, in fixed point: whether a cell centre is inside is decided exactly, and a scene
//! moved by whole cells gives the same bits wherever it stands.

use super::height_tiles::{TILE_CELLS, TileKey};
use glam::{DVec2, DVec3};

/// Fixed-point units per metre (2¹⁶: poses enter state rounded to the same step).
pub(crate) const UNITS_PER_M: f64 = 65_536.0;
/// Largest side of a triangle's rectangle in the projected plane. Units: fixed point (16384 m). Products of two such
/// lengths, summed twice, stay in 63 bits.
pub(crate) const MAX_SPAN: i64 = 1 << 30;

/// A triangle projected along the rain, counter-clockwise in (x, z).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FixedTriangle {
    x: [i64; 3],
    z: [i64; 3],
    /// Heights above the reference plane. Units: m.
    y: [f64; 3],
    /// Twice the area in the projected plane; above 0.
    area2: i64,
}

/// What became of a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Projected {
    Triangle(FixedTriangle),
    /// A coordinate is NaN or infinite.
    NonFinite,
    /// No area in space.
    Degenerate,
    /// Seen exactly along its plane: it hides nothing.
    EdgeOn,
    /// Wider than [`MAX_SPAN`]; its larger side in m.
    TooWide(f64),
}

/// A point in fixed-point units of the projected plane. Position and drift are rounded apart, so that a shift of the
/// world by whole units shifts the result by exactly as many.
pub(crate) fn fixed_point(p: DVec3, reference_height_m: f64, drift: DVec2) -> [i64; 2] {
    let fixed = |v: f64| (v * UNITS_PER_M).round() as i64;
    let y = p.y - reference_height_m;
    [fixed(p.x) + fixed(y * drift.x), fixed(p.z) + fixed(y * drift.y)]
}

/// Projects one triangle. Coordinates are taken to be within 1e7 m where finite.
pub(crate) fn project_triangle(corners: &[DVec3; 3], reference_height_m: f64, drift: DVec2) -> Projected {
    if !corners.iter().all(|c| c.is_finite()) {
        return Projected::NonFinite;
    }
    let [a, b, c] = *corners;
    // Needles of less than a square micrometre are rounding, not roofs.
    if (b - a).cross(c - a).length() < 1.0e-12 {
        return Projected::Degenerate;
    }
    let q = corners.map(|p| fixed_point(p, reference_height_m, drift));
    let (x, z) = (q.map(|q| q[0]), q.map(|q| q[1]));
    let span = [x, z].map(|[a, b, c]| a.max(b).max(c) - a.min(b).min(c));
    let span = span[0].max(span[1]);
    if span > MAX_SPAN {
        return Projected::TooWide(span as f64 / UNITS_PER_M);
    }
    match FixedTriangle::oriented(x, z, corners.map(|p| p.y - reference_height_m)) {
        Some((t, _)) => Projected::Triangle(t),
        None => Projected::EdgeOn,
    }
}

impl FixedTriangle {
    /// The triangle with its corners put counter-clockwise in (x, z), and whether they ran clockwise before; `None`
    /// without area. No side of its rectangle may be longer than [`MAX_SPAN`].
    pub(crate) fn oriented(x: [i64; 3], z: [i64; 3], y: [f64; 3]) -> Option<(Self, bool)> {
        let mut t = Self { x, z, y, area2: 0 };
        t.area2 = t.edge(0, 1, t.x[2], t.z[2]);
        let clockwise = t.area2 < 0;
        if clockwise {
            t.x.swap(1, 2);
            t.z.swap(1, 2);
            t.y.swap(1, 2);
            t.area2 = -t.area2;
        }
        (t.area2 > 0).then_some((t, clockwise))
    }

    /// Twice the signed area of (corner i, corner j, p): not negative where p lies left of the edge.
    fn edge(&self, i: usize, j: usize, px: i64, pz: i64) -> i64 {
        (self.x[j] - self.x[i]) * (pz - self.z[i]) - (self.z[j] - self.z[i]) * (px - self.x[i])
    }

    fn bounds(&self) -> [[i64; 2]; 2] {
        [self.x, self.z].map(|[a, b, c]| [a.min(b).min(c), a.max(b).max(c)])
    }

    /// First and last tile along x and z whose rectangle meets this one's.
    pub(crate) fn tile_range(&self, tile_units: i64) -> [[i64; 2]; 2] {
        self.bounds().map(|side| side.map(|v| v.div_euclid(tile_units)))
    }

    /// Whether a tile and the triangle overlap: no edge has the whole tile on its outer side. (The rectangles are
    /// taken to meet.)
    pub(crate) fn touches(&self, tile: TileKey, tile_units: i64) -> bool {
        let (x0, z0) = (i64::from(tile.x) * tile_units, i64::from(tile.z) * tile_units);
        [(0, 1), (1, 2), (2, 0)].into_iter().all(|(i, j)| {
            // The tile's corner that lies deepest on the inner side.
            let px = if self.z[j] > self.z[i] { x0 } else { x0 + tile_units };
            let pz = if self.x[j] > self.x[i] { z0 + tile_units } else { z0 };
            self.edge(i, j, px, pz) >= 0
        })
    }

    /// Height where the signed areas towards the three edges are `w`, within those of the corners.
    pub(crate) fn height(&self, w: [i64; 3]) -> f64 {
        let [a, b, c] = self.y;
        let y = (w[0] as f64 * a + w[1] as f64 * b + w[2] as f64 * c) * (1.0 / self.area2 as f64);
        y.clamp(a.min(b).min(c), a.max(b).max(c))
    }

    /// Calls `visit(column, row, w)` for the cells of a grid whose centre lies inside or on an edge, row by row; `w`
    /// are twice the areas between the centre and the three edges. `first` is the centre of cell (0, 0).
    pub(crate) fn for_each_centre(
        &self,
        first: [i64; 2],
        cell_units: i64,
        cells: [usize; 2],
        mut visit: impl FnMut(usize, usize, [i64; 3]),
    ) {
        let [xs, zs] = self.bounds();
        // Cells whose centres lie between the bounds: the first by rounding up, the last by rounding down.
        let range = |[low, high]: [i64; 2], first: i64, cells: usize| {
            let from = -(first - low).div_euclid(cell_units);
            let to = (high - first).div_euclid(cell_units);
            (from.max(0), to.min(cells as i64 - 1))
        };
        let (i0, i1) = range(xs, first[0], cells[0]);
        let (j0, j1) = range(zs, first[1], cells[1]);
        if i0 > i1 || j0 > j1 {
            return;
        }
        let edges = [(1, 2), (2, 0), (0, 1)];
        let step_x = edges.map(|(i, j)| (self.z[i] - self.z[j]) * cell_units);
        for j in j0..=j1 {
            let (px, pz) = (first[0] + i0 * cell_units, first[1] + j * cell_units);
            let mut w = edges.map(|(a, b)| self.edge(a, b, px, pz));
            for i in i0..=i1 {
                if w[0] >= 0 && w[1] >= 0 && w[2] >= 0 {
                    visit(i as usize, j as usize, w);
                }
                for k in 0..3 {
                    w[k] += step_x[k];
                }
            }
        }
    }

    /// Raises the heights of the tile's cells whose centre lies inside or on an edge.
    pub(crate) fn draw(&self, tile: TileKey, cell_units: i64, heights: &mut [f32]) {
        let first = [tile.x, tile.z].map(|k| i64::from(k) * TILE_CELLS as i64 * cell_units + cell_units / 2);
        self.for_each_centre(first, cell_units, [TILE_CELLS; 2], |column, row, w| {
            // Adding zero makes −0 into 0: the maximum must not depend on the order of triangles.
            let y = (self.height(w) + 0.0) as f32;
            let cell = &mut heights[row * TILE_CELLS + column];
            if y > *cell {
                *cell = y;
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cover::lookup::OPEN_SKY;
    use crate::hash::{pcg3d, unit_f32};

    const CELL: i64 = 16_384;

    fn fixed(corners: [[f64; 3]; 3], drift: DVec2) -> FixedTriangle {
        match project_triangle(&corners.map(DVec3::from), 0.0, drift) {
            Projected::Triangle(t) => t,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn heights_lie_on_the_plane_at_the_cell_centre() {
        let drift = DVec2::new(0.7, -0.3);
        let plane = |x: f64, z: f64| 2.0 + 0.1 * x - 0.2 * z;
        let xz = [[1.0, 1.0], [12.5, 3.0], [5.0, 14.25]];
        let t = fixed(xz.map(|[x, z]| [x, plane(x, z), z]), drift);
        let mut heights = vec![OPEN_SKY; TILE_CELLS * TILE_CELLS];
        t.draw(TileKey { x: 0, z: 0 }, CELL, &mut heights);
        let mut inside = 0;
        for (i, &h) in heights.iter().enumerate().filter(|(_, h)| **h > OPEN_SKY) {
            let q = DVec2::new((i % TILE_CELLS) as f64 + 0.5, (i / TILE_CELLS) as f64 + 0.5) * 0.25;
            // The point of the plane that projects to q: q = xz + y·drift with y linear in xz.
            let (a, b) = (0.1, -0.2);
            let y = (2.0 + a * q.x + b * q.y) / (1.0 + a * drift.x + b * drift.y);
            assert!((f64::from(h) - y).abs() < 2.0e-5, "{h} {y}");
            inside += 1;
        }
        // Projected area over the cell's.
        let expected = t.area2 as f64 / 2.0 / (CELL * CELL) as f64;
        assert!(
            (f64::from(inside) - expected).abs() < 0.02 * expected,
            "{inside} {expected}"
        );
    }

    #[test]
    fn a_fan_covers_every_cell_once_or_more() {
        // Shared edges through cell centres leave no gap.
        let centre = [8.125, 3.0, 8.125];
        let ring = [[0.0, 3.0, 0.0], [16.0, 3.0, 0.0], [16.0, 3.0, 16.0], [0.0, 3.0, 16.0]];
        let mut heights = vec![OPEN_SKY; TILE_CELLS * TILE_CELLS];
        for i in 0..4 {
            let t = fixed([centre, ring[i], ring[(i + 1) % 4]], DVec2::ZERO);
            t.draw(TileKey { x: 0, z: 0 }, CELL, &mut heights);
        }
        assert!(heights.iter().all(|h| *h == 3.0));
    }

    #[test]
    fn touched_tiles_are_those_drawn_to() {
        let tile_units = CELL * TILE_CELLS as i64;
        let (mut drawn, mut refused) = (0, 0);
        for n in 0..300 {
            let r = |k: u32, scale: f64| pcg3d([n, k, 5]).map(|v| (f64::from(unit_f32(v)) - 0.5) * scale);
            let t = match project_triangle(&[0, 1, 2].map(|k| DVec3::from(r(k, 80.0))), 0.0, DVec2::ZERO) {
                Projected::Triangle(t) => t,
                other => panic!("{other:?}"),
            };
            let [xs, zs] = t.tile_range(tile_units);
            for x in -4..4_i32 {
                for z in -4..4_i32 {
                    let tile = TileKey { x, z };
                    let in_range = (xs[0]..=xs[1]).contains(&i64::from(x)) && (zs[0]..=zs[1]).contains(&i64::from(z));
                    let mut heights = vec![OPEN_SKY; TILE_CELLS * TILE_CELLS];
                    t.draw(tile, CELL, &mut heights);
                    let any = heights.iter().any(|h| *h > OPEN_SKY);
                    let touched = in_range && t.touches(tile, tile_units);
                    assert!(touched || !any, "{n} {tile:?}");
                    drawn += u32::from(any);
                    refused += u32::from(in_range && !touched);
                }
            }
        }
        assert!(drawn > 1000 && refused > 300, "{drawn} {refused}");
    }

    #[test]
    fn winding_does_not_matter() {
        let a = fixed([[0.0, 1.0, 0.0], [5.0, 2.0, 0.0], [0.0, 3.0, 5.0]], DVec2::ZERO);
        let b = fixed([[0.0, 1.0, 0.0], [0.0, 3.0, 5.0], [5.0, 2.0, 0.0]], DVec2::ZERO);
        assert_eq!(a, b);
    }
}
