//! Where the tile stands in the world.

use super::params::Rules;

/// Beyond this from the origin a place counts as none. Units: m.
const FARTHEST_M: f64 = 1e9;

/// Corner of a tile that moves in steps of whole cells. Cell w of the world is stored at w mod N, so nothing is copied
/// when the tile moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// World cell of the tile's cell (0, 0), once known.
    pub corner: Option<[i64; 2]>,
    snap: i64,
}

impl Place {
    pub fn new(snap_cells: u32) -> Self {
        Self {
            corner: None,
            snap: i64::from(snap_cells),
        }
    }

    /// Where the corner should be for the centre of the view to be in the middle; the old one as long as the view is
    /// within three quarters of a step of its middle. `None`: no move.
    pub fn wanted(&self, rules: &Rules, view_m: [f64; 2]) -> Option<[i64; 2]> {
        if !view_m.iter().all(|at| at.abs() <= FARTHEST_M) {
            return None;
        }
        let half = i64::from(rules.cells / 2);
        let snap = self.snap as f64;
        let cell = view_m.map(|at| at / rules.cell_m);
        let new = cell.map(|at| (at / snap).round() as i64 * self.snap - half);
        match self.corner {
            Some(old) => {
                let far = (0..2).any(|axis| (cell[axis] - (old[axis] + half) as f64).abs() > 0.75 * snap);
                (far && new != old).then_some(new)
            }
            None => Some(new),
        }
    }

    /// Where cell (0, 0) is stored.
    pub fn offset(&self, cells: u32) -> [u32; 2] {
        let corner = self.corner.unwrap_or_default();
        corner.map(|w| w.rem_euclid(i64::from(cells)) as u32)
    }
}
