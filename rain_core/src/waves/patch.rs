//! The cells that a source reaches.

use super::border::Border;
use super::field::WaveField;

/// How far a Gaussian source reaches, in standard deviations: e^(−12.5) = 4e-6 of its peak is left out.
pub(super) const REACH: f64 = 5.0;

/// A run of cells along one axis; starts below 0 and ends beyond the field only where the field goes around.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Span {
    pub start: i64,
    pub len: usize,
}

impl Span {
    /// The cells of `cells` whose centres lie within `[low, high]`, both in cells from the field's edge.
    pub fn new(low: f64, high: f64, cells: usize, wraps: bool) -> Self {
        // Casts saturate.
        let mut start = (low - 0.5).ceil() as i64;
        let mut end = ((high - 0.5).floor() as i64).saturating_add(1);
        if wraps {
            let excess = (end - start - cells as i64).max(0);
            start += excess / 2;
            end -= excess - excess / 2;
        } else {
            start = start.max(0);
            end = end.min(cells as i64);
        }
        Self {
            start,
            len: usize::try_from(end - start).unwrap_or(0),
        }
    }
}

impl WaveField {
    /// The cells around the box from `low` to `high` (m) that a source of this width reaches.
    pub(super) fn reach(&self, low: [f64; 2], high: [f64; 2], width_m: f64) -> [Span; 2] {
        let per_cell = 1.0 / self.settings.cell_m;
        let wraps = self.settings.border == Border::Periodic;
        let span = |axis: usize, cells: usize| {
            Span::new(
                (low[axis] - REACH * width_m) * per_cell,
                (high[axis] + REACH * width_m) * per_cell,
                cells,
                wraps,
            )
        };
        [span(0, self.rules.nx), span(1, self.rules.nz)]
    }

    /// Cell `k`, `l` of two spans: its index, if a source may change it.
    pub(super) fn reached(&self, [along, across]: [Span; 2], k: usize, l: usize) -> Option<usize> {
        let i = (along.start + k as i64).rem_euclid(self.rules.nx as i64) as usize;
        let j = (across.start + l as i64).rem_euclid(self.rules.nz as i64) as usize;
        self.accepts(i, j).then_some(j * self.rules.nx + i)
    }

    /// The index of the cell that holds a point in m, around the border of a tile; `None` outside, on dry cells and on
    /// a fixed border.
    pub(super) fn cell_of(&self, x_m: f64, z_m: f64) -> Option<usize> {
        let wraps = self.settings.border == Border::Periodic;
        let cell = |at: f64, cells: usize| {
            let index = (at / self.settings.cell_m).floor() as i64;
            let index = if wraps { index.rem_euclid(cells as i64) } else { index };
            usize::try_from(index).ok().filter(|index| *index < cells)
        };
        let (i, j) = (cell(x_m, self.rules.nx)?, cell(z_m, self.rules.nz)?);
        self.accepts(i, j).then_some(j * self.rules.nx + i)
    }
}
