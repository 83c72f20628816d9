//! Height fields: from triangles, images, tables and glTF files.
//!
//! | file | concept |
//! |---|---|
//! | `mod.rs` | [`GridFrame`], [`HeightField`], what is refused |
//! | `csv.rs` | from a table of heights |
//! | `png.rs` | from a grey image (feature `import`) |
//! | `triangles.rs` | from triangles: the highest that faces up |
//! | `gltf.rs` | from a glTF or GLB file (feature `import`) |
//! | `accessor.rs` | numbers out of a glTF file's buffers |
//!
//! Axes are the world's: x along a row, z from row to row, heights along y. A cell's height is the ground's at its
//! centre; NaN marks a hole, into which water drains.
//!
//! # Accuracy
//! Between cell centres nothing is known: a wall thinner than a cell may be missed, and so may the gap between two
//! kerbs. Overhangs hide what is under them.

#[cfg(feature = "import")]
mod accessor;
mod csv;
#[cfg(feature = "import")]
mod gltf;
#[cfg(feature = "import")]
mod png;
mod triangles;

use thiserror::Error;

use crate::error::{ConfigError, in_range, shown};

pub use csv::CsvProblem;
#[cfg(feature = "import")]
pub use gltf::{GltfImport, GltfProblem};
#[cfg(feature = "import")]
pub use png::PngProblem;
pub use triangles::{LeftOutTriangles, TriangleRaster};
pub(super) use triangles::{for_each_cell, usable};

/// Most cells along one side.
pub const MAX_SIDE_CELLS: usize = 1 << 16;
/// Largest height above or below zero, and largest coordinate of a corner. Units: m.
pub const MAX_COORDINATE_M: f64 = 1e7;

/// How much an import may take. Larger input is refused, with the limit in the message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ImportLimits {
    /// Cells of the height field; each takes 8 bytes. Default: 2²⁶ (8192²).
    pub cells: usize,
    /// Triangles, and a third of the vertices, that are drawn, counted anew each time a mesh stands somewhere.
    /// Default: 2²⁶.
    pub triangles: usize,
    /// Bytes of the file, and of each buffer beside it. Default: 2³⁰.
    pub bytes: usize,
}

impl Default for ImportLimits {
    fn default() -> Self {
        Self {
            cells: 1 << 26,
            triangles: 1 << 26,
            bytes: 1 << 30,
        }
    }
}

/// Why a height field could not be made.
#[derive(Debug, Error)]
pub enum HeightFieldError {
    /// A number outside its domain, or not finite.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// A side with no cells.
    #[error("the height field is {0} × {1} cells, allowed: at least 1 × 1")]
    NoCells(usize, usize),
    /// More cells than allowed: take larger cells, or a part of the scene.
    #[error("the height field would be {nx} × {nz} cells, allowed: {allowed} cells, at most 65536 along a side")]
    TooManyCells {
        /// Cells along x.
        nx: u64,
        /// Cells along z.
        nz: u64,
        /// The limit.
        allowed: usize,
    },
    /// A list of heights that does not fill the grid.
    #[error("{found} heights for a grid of {expected} cells")]
    HeightCount {
        /// Heights given.
        found: usize,
        /// Cells of the grid.
        expected: usize,
    },
    /// A height that is infinite or beyond ±[`MAX_COORDINATE_M`].
    #[error(
        "the height in column {column}, row {row} is {} m, allowed: -1e7 to 1e7 m, or NaN for a hole",
        shown(*.value)
    )]
    Height {
        /// Column, from 0.
        column: usize,
        /// Row, from 0.
        row: usize,
        /// The height.
        value: f64,
    },
    /// A file or buffer larger than allowed.
    #[error("{bytes} bytes, allowed: {allowed}")]
    TooManyBytes {
        /// Its size.
        bytes: u64,
        /// The limit.
        allowed: usize,
    },
    /// More triangles or vertices than allowed.
    #[error("more than {allowed} triangles, or three times as many vertices")]
    TooManyTriangles {
        /// The limit.
        allowed: usize,
    },
    /// One triangle spans more cells than exact arithmetic allows.
    #[error("a triangle reaches {cells:.0} cells from the grid's corner, allowed: 65536")]
    TooWide {
        /// Its farthest coordinate. Units: cells.
        cells: f64,
    },
    /// Nothing faces up.
    #[error("no triangle faces up: {0}")]
    NothingFacesUp(LeftOutTriangles),
    /// A table of heights is wrong somewhere.
    #[error("line {line}, column {column}: {problem}")]
    Csv {
        /// Line in the file, the first is 1.
        line: u64,
        /// Column of the table (not the character), the first is 1.
        column: usize,
        /// What is wrong there.
        problem: CsvProblem,
    },
    /// An image is no height field.
    #[cfg(feature = "import")]
    #[error(transparent)]
    Png(#[from] PngProblem),
    /// A glTF file is broken, or needs what is not supported.
    #[cfg(feature = "import")]
    #[error(transparent)]
    Gltf(#[from] GltfProblem),
}

/// Refuses a file or buffer larger than `limits` allow.
#[cfg(feature = "import")]
fn check_bytes(bytes: u64, limits: &ImportLimits) -> Result<(), HeightFieldError> {
    if bytes > limits.bytes as u64 {
        return Err(HeightFieldError::TooManyBytes {
            bytes,
            allowed: limits.bytes,
        });
    }
    Ok(())
}

/// Where the cells of a grid lie in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridFrame {
    cells: [usize; 2],
    cell_m: f64,
    origin: [f64; 2],
}

impl GridFrame {
    /// A grid of `[nx, nz]` cells of `cell_m` (units: m, domain: [1e-4, 1e4]) with the first cell's corner at `origin`
    /// (x, z; units: m, domain: ±1e7).
    ///
    /// # Errors
    /// When a number lies outside its domain, a side has no cells, or the grid more than `limits` allow.
    pub fn new(
        cells: [usize; 2],
        cell_m: f64,
        origin: [f64; 2],
        limits: &ImportLimits,
    ) -> Result<Self, HeightFieldError> {
        in_range("cell_m", cell_m, 1e-4, 1e4, "0.0001 to 10000 m")?;
        for value in origin {
            in_range("origin", value, -MAX_COORDINATE_M, MAX_COORDINATE_M, "-1e7 to 1e7 m")?;
        }
        let [nx, nz] = cells;
        if nx == 0 || nz == 0 {
            return Err(HeightFieldError::NoCells(nx, nz));
        }
        if nx > MAX_SIDE_CELLS || nz > MAX_SIDE_CELLS || nx * nz > limits.cells {
            return Err(HeightFieldError::TooManyCells {
                nx: nx as u64,
                nz: nz as u64,
                allowed: limits.cells,
            });
        }
        Ok(Self { cells, cell_m, origin })
    }

    /// The smallest grid from the corner `low` that covers everything up to `high` (x, z; units: m): as many cells as
    /// the extent needs, where a thousandth of a cell more needs none.
    ///
    /// # Errors
    /// As [`GridFrame::new`], and when `high` is not finite.
    pub fn around(low: [f64; 2], high: [f64; 2], cell_m: f64, limits: &ImportLimits) -> Result<Self, HeightFieldError> {
        in_range("cell_m", cell_m, 1e-4, 1e4, "0.0001 to 10000 m")?;
        for value in low.into_iter().chain(high) {
            in_range("bounds", value, -MAX_COORDINATE_M, MAX_COORDINATE_M, "-1e7 to 1e7 m")?;
        }
        // Below 2e11 by the domains.
        let cells = [0, 1].map(|i| (((high[i] - low[i]) / cell_m - 1e-3).ceil().max(1.0)) as usize);
        if cells.iter().any(|n| *n > MAX_SIDE_CELLS) {
            return Err(HeightFieldError::TooManyCells {
                nx: cells[0] as u64,
                nz: cells[1] as u64,
                allowed: limits.cells,
            });
        }
        Self::new(cells, cell_m, low, limits)
    }

    /// Cells along x and z.
    #[must_use]
    pub fn cells(&self) -> [usize; 2] {
        self.cells
    }

    /// Side of a cell. Units: m.
    #[must_use]
    pub fn cell_m(&self) -> f64 {
        self.cell_m
    }

    /// The first cell's corner (x, z). Units: m.
    #[must_use]
    pub fn origin(&self) -> [f64; 2] {
        self.origin
    }

    /// Centre (x, z) of a cell. Units: m.
    #[must_use]
    pub fn centre_m(&self, column: usize, row: usize) -> [f64; 2] {
        [
            self.origin[0] + (column as f64 + 0.5) * self.cell_m,
            self.origin[1] + (row as f64 + 0.5) * self.cell_m,
        ]
    }
}

/// Ground heights at the cell centres of a grid, row by row; NaN = hole.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightField {
    frame: GridFrame,
    heights: Vec<f64>,
}

impl HeightField {
    /// Heights (units: m; domain: ±1e7 or NaN for a hole) in the cells of `frame`: row = z, column = x.
    ///
    /// # Errors
    /// When there are more or fewer heights than cells, or one is infinite or too large.
    pub fn new(frame: GridFrame, heights: Vec<f64>) -> Result<Self, HeightFieldError> {
        let [nx, nz] = frame.cells;
        if heights.len() != nx * nz {
            return Err(HeightFieldError::HeightCount {
                found: heights.len(),
                expected: nx * nz,
            });
        }
        if let Some(i) = heights.iter().position(|h| h.abs() > MAX_COORDINATE_M) {
            return Err(HeightFieldError::Height {
                column: i % nx,
                row: i / nx,
                value: heights[i],
            });
        }
        Ok(Self { frame, heights })
    }

    /// Where the cells lie.
    #[must_use]
    pub fn frame(&self) -> &GridFrame {
        &self.frame
    }

    /// Cells along x and z.
    #[must_use]
    pub fn cells(&self) -> [usize; 2] {
        self.frame.cells
    }

    /// Side of a cell. Units: m.
    #[must_use]
    pub fn cell_m(&self) -> f64 {
        self.frame.cell_m
    }

    /// All heights, row by row (row = z, column = x). Units: m. NaN = hole.
    #[must_use]
    pub fn heights(&self) -> &[f64] {
        &self.heights
    }

    /// The height of a cell, `None` outside the grid; NaN = hole. Units: m.
    #[must_use]
    pub fn height(&self, column: usize, row: usize) -> Option<f64> {
        let [nx, _] = self.frame.cells;
        if column >= nx {
            return None;
        }
        self.heights.get(row.checked_mul(nx)?.checked_add(column)?).copied()
    }

    /// How many cells are holes.
    #[must_use]
    pub fn holes(&self) -> usize {
        self.heights.iter().filter(|h| h.is_nan()).count()
    }
}
