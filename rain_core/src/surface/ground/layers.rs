//! The two layers of every cell: the ground and what stands over it.

use glam::DVec3;

use super::error::GroundError;
use super::scene::{GroundScene, faces_up};
use crate::surface::height_field::{GridFrame, LeftOutTriangles, for_each_cell, usable};
use crate::weather::SurfaceClass;

/// Triangles that are no ground, and why.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct LeftOutGround {
    /// With a coordinate that is NaN, infinite or beyond ±1e7 m.
    pub not_finite: usize,
    /// Without area.
    pub degenerate: usize,
    /// Facing down or steeper than 78°: walls. Nothing is wrong with them.
    pub not_up: usize,
    /// Beside the domain.
    pub outside: usize,
}

/// Ground and top of every cell, row by row (row = z, column = x).
#[derive(Debug, Clone, PartialEq)]
pub struct GroundLayers {
    pub(super) frame: GridFrame,
    /// Units: m. NaN = hole.
    pub(super) ground: Vec<f64>,
    pub(super) class: Vec<u8>,
    /// What covers a cell; NaN under open sky. Units: m.
    pub(super) top: Vec<f64>,
    left_out: LeftOutGround,
}

impl GroundLayers {
    /// Ground: the highest surface at most `step_m` above the lowest. Top: the highest surface above that.
    pub(super) fn draw(scene: &GroundScene, frame: GridFrame, step_m: f64) -> Result<Self, GroundError> {
        let [nx, nz] = frame.cells();
        let mut layers = Self {
            frame,
            ground: vec![f64::NAN; nx * nz],
            class: vec![0; nx * nz],
            top: vec![f64::NAN; nx * nz],
            left_out: LeftOutGround::default(),
        };
        let mut lowest = vec![f64::INFINITY; nx * nz];
        layers.left_out = draw_all(scene, &frame, |cell, y, _| lowest[cell] = lowest[cell].min(y))?;
        let (ground, class, top) = (&mut layers.ground, &mut layers.class, &mut layers.top);
        draw_all(scene, &frame, |cell, y, index| {
            if y <= lowest[cell] + step_m {
                // Of two at one height the class that comes first counts: no order of owners matters.
                let old = ground[cell];
                if old.is_nan() || y > old || (y == old && index < class[cell]) {
                    (ground[cell], class[cell]) = (y, index);
                }
            } else if top[cell].is_nan() || y > top[cell] {
                top[cell] = y;
            }
        })?;
        if layers.ground.iter().all(|y| y.is_nan()) {
            return Err(GroundError::NoGround);
        }
        Ok(layers)
    }

    /// Where the cells lie.
    #[must_use]
    pub fn frame(&self) -> &GridFrame {
        &self.frame
    }

    /// Heights of the ground. Units: m. NaN = hole.
    #[must_use]
    pub fn ground(&self) -> &[f64] {
        &self.ground
    }

    /// Heights of what stands over the ground. Units: m. NaN = nothing.
    #[must_use]
    pub fn top(&self) -> &[f64] {
        &self.top
    }

    /// Class of each cell's ground, as [`SurfaceClass::index`]; 0 in holes.
    #[must_use]
    pub fn classes(&self) -> &[u8] {
        &self.class
    }

    /// What was not drawn.
    #[must_use]
    pub fn left_out(&self) -> LeftOutGround {
        self.left_out
    }
}

/// Calls `visit(cell, height, class)` for each cell centre under each static triangle that faces up.
fn draw_all(
    scene: &GroundScene,
    frame: &GridFrame,
    mut visit: impl FnMut(usize, f64, u8),
) -> Result<LeftOutGround, GroundError> {
    let mut left_out = LeftOutGround::default();
    let mut raster = LeftOutTriangles::default();
    for (corners, class) in scene.triangles() {
        if !usable(corners) {
            left_out.not_finite += 1;
            continue;
        }
        let [a, b, c] = *corners;
        // Needles of less than a square micrometre are rounding.
        if (b - a).cross(c - a).length() < 1e-12 {
            left_out.degenerate += 1;
            continue;
        }
        if !faces_up(corners) {
            left_out.not_up += 1;
            continue;
        }
        let index = class.index() as u8;
        let mut draw =
            |corners: &[DVec3; 3]| for_each_cell(frame, corners, &mut raster, |cell, y| visit(cell, y, index));
        if is_wide(frame, corners) {
            let clipped = clip(frame, corners);
            for i in 2..clipped.len() {
                draw(&[clipped[0], clipped[i - 1], clipped[i]])?;
            }
            left_out.outside += usize::from(clipped.is_empty());
        } else {
            let before = raster.outside;
            for_each_cell(frame, corners, &mut raster, |cell, y| visit(cell, y, index))?;
            left_out.outside += raster.outside - before;
        }
    }
    Ok(left_out)
}

/// Whether a triangle reaches far beyond the grid: it is cut before it is drawn, since exact arithmetic has bounds.
fn is_wide(frame: &GridFrame, corners: &[DVec3; 3]) -> bool {
    let [ox, oz] = frame.origin();
    let limit = 32_768.0 * frame.cell_m();
    corners
        .iter()
        .any(|c| (c.x - ox).abs() > limit || (c.z - oz).abs() > limit)
}

/// The part of a triangle within one cell around the grid, as a convex polygon (Sutherland & Hodgman 1974). A shared
/// edge is cut at the same points in both its triangles.
fn clip(frame: &GridFrame, corners: &[DVec3; 3]) -> Vec<DVec3> {
    let [ox, oz] = frame.origin();
    let [nx, nz] = frame.cells().map(|n| n as f64);
    let cell = frame.cell_m();
    let planes = [
        (0, 1.0, ox - cell),
        (0, -1.0, -(ox + (nx + 1.0) * cell)),
        (2, 1.0, oz - cell),
        (2, -1.0, -(oz + (nz + 1.0) * cell)),
    ];
    let mut polygon = corners.to_vec();
    for (axis, sign, bound) in planes {
        let inside = |p: DVec3| sign * p[axis] - bound;
        let mut cut = Vec::with_capacity(polygon.len() + 1);
        for (i, &p) in polygon.iter().enumerate() {
            let q = polygon[(i + 1) % polygon.len()];
            let (dp, dq) = (inside(p), inside(q));
            if dp >= 0.0 {
                cut.push(p);
            }
            if (dp >= 0.0) != (dq >= 0.0) {
                // From the same end whichever way round.
                let forward = p.to_array() < q.to_array();
                let (from, to, df, dt) = if forward { (p, q, dp, dq) } else { (q, p, dq, dp) };
                let mut at = from + (to - from) * (df / (df - dt));
                at[axis] = sign * bound;
                cut.push(at);
            }
        }
        polygon = cut;
    }
    polygon
}

/// The class of an index from [`GroundLayers::classes`].
pub(super) fn class_of(index: u8) -> SurfaceClass {
    SurfaceClass::ALL[usize::from(index).min(SurfaceClass::COUNT - 1)]
}
