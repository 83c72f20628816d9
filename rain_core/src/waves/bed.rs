//! Depth that differs from cell to cell, with dry cells for shores and obstacles.

/// Depths and the faces between cells, relative to the depth of the field's fastest wave.
#[derive(Debug, Clone)]
pub(super) struct Bed {
    /// h/h_max of each cell; 0 is dry.
    pub depth: Vec<f32>,
    /// ½(h_i + h_east)/h_max, 0 where either is dry: c² of the face to the next cell in the row. The last one of a row
    /// is the face around the border when the field is periodic, else 0.
    pub east: Vec<f32>,
    /// The same towards the next row.
    pub south: Vec<f32>,
    /// Number of wet cells.
    pub wet: usize,
}

impl Bed {
    /// All cells dry.
    pub fn dry(cells: usize) -> Self {
        Self {
            depth: vec![0.0; cells],
            east: vec![0.0; cells],
            south: vec![0.0; cells],
            wet: 0,
        }
    }

    /// Sets relative depths in [0, 1] for rows of `nx` cells, and the faces from them.
    pub fn set(&mut self, nx: usize, wraps: bool, relative: impl Fn(usize) -> f32) {
        let cells = self.depth.len();
        for (index, depth) in self.depth.iter_mut().enumerate() {
            *depth = relative(index);
        }
        self.wet = self.depth.iter().filter(|depth| **depth > 0.0).count();
        let face = |a: f32, b: f32| if a > 0.0 && b > 0.0 { 0.5 * (a + b) } else { 0.0 };
        for index in 0..cells {
            let row = index - index % nx;
            let east = if index + 1 < row + nx { index + 1 } else { row };
            let south = if index + nx < cells { index + nx } else { index % nx };
            let here = self.depth[index];
            self.east[index] = if east > index || wraps {
                face(here, self.depth[east])
            } else {
                0.0
            };
            self.south[index] = if south > index || wraps {
                face(here, self.depth[south])
            } else {
                0.0
            };
        }
    }
}
