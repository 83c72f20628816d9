//! The height field as the baker reads it.

use crate::error::{ConfigError, in_range};

/// Largest height in either direction. Units: m.
const MAX_HEIGHT_M: f64 = 1e7;

/// One over the distance to a diagonal neighbour, in cells.
pub(super) const DIAGONAL: f64 = core::f64::consts::FRAC_1_SQRT_2;

/// A height field: heights at cell centres, row after row.
#[derive(Debug, Clone, Copy)]
pub struct Grid<'a> {
    /// Cells along x. Domain: ≥ 1.
    pub nx: usize,
    /// Cells along z (rows). Domain: ≥ 1.
    pub nz: usize,
    /// Edge of a cell. Units: m. Domain: (0, 1e6].
    pub cell_m: f64,
    /// x and z of the first cell's corner. Units: m.
    pub origin_m: [f64; 2],
    /// Heights, cell (x, z) at `z * nx + x`. NaN is a hole, which drains. Units: m. Domain: [-1e7, 1e7] or NaN.
    pub heights: &'a [f64],
}

impl<'a> Grid<'a> {
    /// A field whose first cell's corner is at (0, 0).
    #[must_use]
    pub fn new(nx: usize, nz: usize, cell_m: f64, heights: &'a [f64]) -> Self {
        Self {
            nx,
            nz,
            cell_m,
            origin_m: [0.0; 2],
            heights,
        }
    }

    /// Checks all fields; `Ok(true)` when there are holes.
    pub(super) fn validated(&self) -> Result<bool, ConfigError> {
        in_range("cell_m", self.cell_m, 1e-6, 1e6, "1e-6 to 1e6 m")?;
        for origin in self.origin_m {
            in_range("origin_m", origin, -1e9, 1e9, "-1e9 to 1e9 m")?;
        }
        if self.nx == 0 || self.nz == 0 {
            return Err(ConfigError::Empty { field: "heights" });
        }
        let cells = self.nx.checked_mul(self.nz).filter(|&cells| cells < (1 << 31) - 2);
        if cells.is_none() {
            return Err(ConfigError::OutOfRange {
                field: "nx * nz",
                value: self.nx as f64 * self.nz as f64,
                allowed: "at most 2147483645 cells",
            });
        }
        if cells != Some(self.heights.len()) {
            return Err(ConfigError::OutOfRange {
                field: "heights.len()",
                value: self.heights.len() as f64,
                allowed: "nx * nz",
            });
        }
        let mut holes = false;
        for &height in self.heights {
            if height.is_nan() {
                holes = true;
            } else {
                in_range(
                    "heights",
                    height,
                    -MAX_HEIGHT_M,
                    MAX_HEIGHT_M,
                    "-1e7 to 1e7 m, or NaN for a hole",
                )?;
            }
        }
        Ok(holes)
    }

    /// Calls `visit` with every neighbour (of eight) of the cell, in rising order of index.
    pub(super) fn neighbours(&self, cell: usize, mut visit: impl FnMut(usize)) {
        let (x, z) = (cell % self.nx, cell / self.nx);
        for row in z.saturating_sub(1)..=(z + 1).min(self.nz - 1) {
            for column in x.saturating_sub(1)..=(x + 1).min(self.nx - 1) {
                let other = row * self.nx + column;
                if other != cell {
                    visit(other);
                }
            }
        }
    }

    /// x and z of a cell's centre. Units: m.
    pub(super) fn centre(&self, cell: usize) -> [f64; 2] {
        let half = |index: usize| (index as f64 + 0.5) * self.cell_m;
        [
            self.origin_m[0] + half(cell % self.nx),
            self.origin_m[1] + half(cell / self.nx),
        ]
    }

    /// The cell that holds a position. Units: m.
    pub(super) fn cell_at(&self, x_m: f64, z_m: f64) -> Option<usize> {
        let place = |position: f64, origin: f64, count: usize| {
            let index = ((position - origin) / self.cell_m).floor();
            (index >= 0.0 && index < count as f64).then_some(index as usize)
        };
        Some(place(z_m, self.origin_m[1], self.nz)? * self.nx + place(x_m, self.origin_m[0], self.nx)?)
    }
}
