//! Share of the rain that reaches each cell of the ground.

use glam::DVec3;

use super::run::Ground;
use crate::cover::{ClassShare, CoverScene};
use crate::error::ConfigError;

impl Ground {
    /// Share of the rain that reaches the ground of each cell, in 255ths; the rest wets what stands over it. Row by
    /// row. Start: 255, 0 where something stands over the cell.
    #[must_use]
    pub fn exposure(&self) -> &[u8] {
        &self.exposure
    }

    /// Sets the exposure of some cells from `first` on, in 255ths. What comes after the last cell is ignored.
    pub fn set_exposure(&mut self, first: usize, exposure: &[u8]) {
        for (own, &new) in self.exposure.iter_mut().skip(first).zip(exposure) {
            *own = new;
        }
    }

    /// Asks a cover map for the exposure of `count` cells from `first` on: a call for every tick with a part of the
    /// cells spreads the work. Returns whether any changed. Where the map does not reach, the sky is open.
    ///
    /// Error: 1/510, by rounding to 255ths; the cover map's own is larger.
    ///
    /// # Errors
    /// When a class or all of them are outside their domain.
    pub fn refresh_exposure(
        &mut self,
        cover: &CoverScene,
        classes: &[ClassShare],
        first: usize,
        count: usize,
    ) -> Result<bool, ConfigError> {
        let [nx, _] = self.frame.cells();
        let open = cover.tiles().is_empty();
        let mut changed = false;
        for cell in first..first.saturating_add(count).min(self.heights.len()) {
            let y = self.heights[cell];
            if y.is_nan() {
                continue;
            }
            let [x, z] = self.frame.centre_m(cell % nx, cell / nx);
            let share = if open {
                1.0
            } else {
                cover.flux_exposure(DVec3::new(x, y, z), classes).unwrap_or(1.0)
            };
            let share = (share.clamp(0.0, 1.0) * 255.0).round() as u8;
            changed |= std::mem::replace(&mut self.exposure[cell], share) != share;
        }
        Ok(changed)
    }
}
