//! A height field from triangles: the highest that faces up over each cell centre.

use core::fmt;

use glam::DVec3;

use super::{GridFrame, HeightField, HeightFieldError, ImportLimits, MAX_COORDINATE_M};
use crate::cover::raster::{FixedTriangle, MAX_SPAN};

/// Fixed-point units to a cell: corners are rounded to so much of one before it is decided which centres lie inside.
const UNITS_PER_CELL: i64 = 1 << 14;

/// Triangles that are no ground, and why.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct LeftOutTriangles {
    /// With a coordinate that is NaN, infinite or beyond ±1e7 m.
    pub not_finite: usize,
    /// Facing down, or upright, or without area.
    pub not_up: usize,
    /// Beside the grid.
    pub outside: usize,
}

impl fmt::Display for LeftOutTriangles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} triangles face down, stand upright or have no area, {} are not finite, {} lie outside",
            self.not_up, self.not_finite, self.outside
        )
    }
}

/// Draws triangles into a grid, one after the other, in any order and with the same result.
///
/// A triangle faces up where its corners run counter-clockwise seen from above (+y); the others hide nothing. A cell
/// centre on a shared edge belongs to both triangles: a closed surface leaves no gap. Which centres lie inside is
/// decided in integers, with corners rounded to 2⁻¹⁴ of a cell; the height is that of the triangle's plane in double
/// precision, within the heights of its corners.
///
/// Error: ≤ 1e-9 m against the plane of the triangle over cell centres farther than 2⁻¹³ of a cell from its edges, for
/// coordinates up to 10 km and slopes up to 10; 1e-7 m at 2000 km.
#[derive(Debug, Clone)]
pub struct TriangleRaster {
    frame: GridFrame,
    heights: Vec<f64>,
    left_out: LeftOutTriangles,
}

/// Whether the corners may be used at all.
pub(in crate::surface) fn usable(corners: &[DVec3; 3]) -> bool {
    corners
        .iter()
        .all(|c| c.is_finite() && c.abs().max_element() <= MAX_COORDINATE_M)
}

/// y component of (b − a) × (c − a): above 0 where the triangle faces up.
pub(super) fn upward([a, b, c]: &[DVec3; 3]) -> f64 {
    let (ab, ac) = (*b - *a, *c - *a);
    ab.z * ac.x - ab.x * ac.z
}

impl TriangleRaster {
    /// An empty grid: every cell is a hole. Allocates the heights.
    #[must_use]
    pub fn new(frame: GridFrame) -> Self {
        let [nx, nz] = frame.cells();
        Self {
            frame,
            heights: vec![f64::NAN; nx * nz],
            left_out: LeftOutTriangles::default(),
        }
    }

    /// Draws one triangle: corners (x, y, z), y up. Units: m.
    ///
    /// # Errors
    /// When it lies over the grid and reaches more than 65536 cells from its corner.
    pub fn add(&mut self, corners: [DVec3; 3]) -> Result<(), HeightFieldError> {
        let heights = &mut self.heights;
        for_each_cell(&self.frame, &corners, &mut self.left_out, |cell, y| {
            let cell = &mut heights[cell];
            // A hole loses against anything.
            if cell.is_nan() || y > *cell {
                *cell = y;
            }
        })
    }

    /// What was not drawn so far.
    #[must_use]
    pub fn left_out(&self) -> LeftOutTriangles {
        self.left_out
    }

    /// The height field. Cells that nothing covers are holes.
    ///
    /// # Errors
    /// None that `add` has not excluded.
    pub fn finish(self) -> Result<HeightField, HeightFieldError> {
        HeightField::new(self.frame, self.heights)
    }
}

/// Calls `visit(cell, height)` for each cell whose centre the triangle covers, or counts why there is none.
///
/// # Errors
/// When it lies over the grid and reaches more than 65536 cells from its corner.
pub(in crate::surface) fn for_each_cell(
    frame: &GridFrame,
    corners: &[DVec3; 3],
    left_out: &mut LeftOutTriangles,
    mut visit: impl FnMut(usize, f64),
) -> Result<(), HeightFieldError> {
    if !usable(corners) {
        left_out.not_finite += 1;
        return Ok(());
    }
    let [ox, oz] = frame.origin();
    let (cell, [nx, nz]) = (frame.cell_m(), frame.cells());
    let x = corners.map(|c| (c.x - ox) / cell);
    let z = corners.map(|c| (c.z - oz) / cell);
    let beside = |v: [f64; 3], n: usize| v.iter().all(|v| *v < 0.0) || v.iter().all(|v| *v > n as f64);
    if beside(x, nx) || beside(z, nz) {
        left_out.outside += 1;
        return Ok(());
    }
    let widest = (MAX_SPAN / UNITS_PER_CELL) as f64;
    let reach = x.iter().chain(&z).fold(0.0, |far: f64, v| far.max(v.abs()));
    let spans = [x, z].map(|v| v[0].max(v[1]).max(v[2]) - v[0].min(v[1]).min(v[2]));
    if reach > 2.0 * widest || spans[0] > widest || spans[1] > widest {
        return Err(HeightFieldError::TooWide { cells: reach });
    }
    let fixed = |v: [f64; 3]| v.map(|v| (v * UNITS_PER_CELL as f64).round() as i64);
    let Some((triangle, clockwise)) = FixedTriangle::oriented(fixed(x), fixed(z), corners.map(|c| c.y)) else {
        left_out.not_up += 1;
        return Ok(());
    };
    // From above, x to the right and z down the page: what is clockwise in (x, z) faces up.
    if !clockwise {
        left_out.not_up += 1;
        return Ok(());
    }
    let [a, b, c] = *corners;
    let (low, high) = (a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
    let normal = (b - a).cross(c - a);
    let (slope_x, slope_z) = (-normal.x / normal.y, -normal.z / normal.y);
    let centre = UNITS_PER_CELL / 2;
    triangle.for_each_centre([centre, centre], UNITS_PER_CELL, [nx, nz], |column, row, w| {
        let [px, pz] = frame.centre_m(column, row);
        let mut y = a.y + slope_x * (px - a.x) + slope_z * (pz - a.z);
        if !y.is_finite() {
            // Rounded to facing up from standing upright: the plane has no height here.
            y = triangle.height(w);
        }
        visit(row * nx + column, y.clamp(low, high) + 0.0);
    });
    Ok(())
}

/// Bounds in (x, z) of the triangles that face up.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    low: [f64; 2],
    high: [f64; 2],
    left_out: LeftOutTriangles,
}

impl Bounds {
    pub(super) fn none() -> Self {
        Self {
            low: [f64::INFINITY; 2],
            high: [f64::NEG_INFINITY; 2],
            left_out: LeftOutTriangles::default(),
        }
    }

    pub(super) fn add(&mut self, corners: &[DVec3; 3]) {
        if !usable(corners) {
            self.left_out.not_finite += 1;
        } else if upward(corners) <= 0.0 {
            self.left_out.not_up += 1;
        } else {
            for c in corners {
                self.low = [self.low[0].min(c.x), self.low[1].min(c.z)];
                self.high = [self.high[0].max(c.x), self.high[1].max(c.z)];
            }
        }
    }

    pub(super) fn frame(&self, cell_m: f64, limits: &ImportLimits) -> Result<GridFrame, HeightFieldError> {
        if self.low[0] > self.high[0] {
            return Err(HeightFieldError::NothingFacesUp(self.left_out));
        }
        GridFrame::around(self.low, self.high, cell_m, limits)
    }
}

impl HeightField {
    /// Draws triangles (corners x, y, z with y up; units: m) into the smallest grid around those that face up; the
    /// first cell's corner is their lowest x and z. Says which were left out.
    ///
    /// Allocates the heights. See [`TriangleRaster`] for the rules.
    ///
    /// # Errors
    /// When none faces up, or more than `limits` allow.
    pub fn from_triangles(
        triangles: &[[DVec3; 3]],
        cell_m: f64,
        limits: &ImportLimits,
    ) -> Result<(Self, LeftOutTriangles), HeightFieldError> {
        if triangles.len() > limits.triangles {
            return Err(HeightFieldError::TooManyTriangles {
                allowed: limits.triangles,
            });
        }
        let mut bounds = Bounds::none();
        triangles.iter().for_each(|t| bounds.add(t));
        let mut raster = TriangleRaster::new(bounds.frame(cell_m, limits)?);
        for t in triangles {
            raster.add(*t)?;
        }
        let left_out = raster.left_out();
        Ok((raster.finish()?, left_out))
    }
}
