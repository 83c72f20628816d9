//! What a field holds: energy, volume, slopes; and when it may sleep.

use super::border::Border;
use super::field::WaveField;
use super::stencil::Stencil;

/// Σ in double precision, in one order, with sums that run side by side.
pub(super) fn sum(values: &[f32]) -> f64 {
    let mut lanes = [0.0_f64; 8];
    let chunks = values.chunks_exact(8);
    let rest: f64 = chunks.remainder().iter().map(|value| f64::from(*value)).sum();
    for chunk in chunks {
        for (lane, value) in lanes.iter_mut().zip(chunk) {
            *lane += f64::from(*value);
        }
    }
    lanes.iter().sum::<f64>() + rest
}

impl WaveField {
    /// Water above the level. Units: m³. Changed by sources alone where the border lets nothing through; the rounding
    /// of single precision is taken out every 256 steps. With a fixed or an open border it is the sum over the field.
    ///
    /// Error: relative 1e-9 between walls and on a tile.
    #[must_use]
    pub fn volume_m3(&self) -> f64 {
        let total = if self.settings.border.keeps_volume() {
            self.sum_now
        } else {
            sum(&self.now)
        };
        total * self.cell_area_m2()
    }

    /// Takes the mean out of the field, for whoever keeps the level of the puddle, and returns it. Units: m³, signed.
    pub fn take_volume_m3(&mut self) -> f64 {
        let volume = self.volume_m3();
        if self.settings.border.keeps_volume() {
            (self.sum_now, self.sum_before) = (0.0, 0.0);
            self.remove_drift();
        } else {
            let means = [sum(&self.now), sum(&self.before)].map(|total| total / self.wet_cells().max(1) as f64);
            self.lower(means);
        }
        volume
    }

    /// Sets the means of both levels to what sources and damping make of them, unless water passes the border.
    pub(super) fn remove_drift(&mut self) {
        // A sponge damps the mean unevenly, but only open fields have one.
        if !self.settings.border.keeps_volume() || self.wet_cells() == 0 {
            return;
        }
        let wet = self.wet_cells() as f64;
        self.lower([
            (sum(&self.now) - self.sum_now) / wet,
            (sum(&self.before) - self.sum_before) / wet,
        ]);
    }

    /// Lowers the wet cells of `now` and `before`.
    fn lower(&mut self, [now, before]: [f64; 2]) {
        for (levels, drop) in [(&mut self.now, now as f32), (&mut self.before, before as f32)] {
            match &self.rules.bed {
                None => levels.iter_mut().for_each(|u| *u -= drop),
                Some(bed) => levels
                    .iter_mut()
                    .zip(&bed.depth)
                    .filter(|(_, depth)| **depth > 0.0)
                    .for_each(|(u, _)| *u -= drop),
            }
        }
    }

    /// E = ½Σ(u⁺−u)² − ½C²Σu⁺Lu of the last two levels. Units: m². Exactly conserved by the undamped scheme between
    /// walls, on a fixed border and on a tile; never grows with damping.
    ///
    /// Error: rounding of the stored heights, below 1e-5 of E after 20 000 steps.
    #[must_use]
    pub fn energy(&self) -> f64 {
        let rules = &self.rules;
        let (nx, nz) = (rules.nx, rules.nz);
        let wraps = rules.border == Border::Periodic;
        let after = |k: usize, n: usize| if k + 1 < n { Some(k + 1) } else { wraps.then_some(0) };
        // −Σu⁺Lu is a sum over pairs of neighbours: w (u⁺ₐ − u⁺ᵦ)(uₐ − uᵦ).
        let pair =
            |a: usize, b: usize| f64::from(self.now[a] - self.now[b]) * f64::from(self.before[a] - self.before[b]);
        let (mut motion, mut edges, mut corners) = (0.0, 0.0, 0.0);
        for j in 0..nz {
            for i in 0..nx {
                let here = j * nx + i;
                let change = f64::from(self.now[here] - self.before[here]);
                motion += change * change;
                let (east, south) = (after(i, nx), after(j, nz));
                if let Some(east) = east {
                    let face = rules.bed.as_ref().map_or(1.0, |bed| f64::from(bed.east[here]));
                    edges += face * pair(here, j * nx + east);
                }
                if let Some(south) = south {
                    let face = rules.bed.as_ref().map_or(1.0, |bed| f64::from(bed.south[here]));
                    edges += face * pair(here, south * nx + i);
                }
                if let (Some(east), Some(south)) = (east, south) {
                    corners += pair(here, south * nx + east) + pair(j * nx + east, south * nx + i);
                }
            }
        }
        let nine = rules.stencil == Stencil::NinePoint;
        // At walls the nine-point sum mirrors corners too: those pairs fall on edges along the wall.
        let potential = if nine {
            (4.0 * edges + corners + self.wall_corners()) / 6.0
        } else {
            edges
        };
        0.5 * motion + 0.5 * f64::from(rules.c2) * potential
    }

    /// Corner terms of the nine-point sum whose far cell is the mirror image behind a wall: pairs along the border,
    /// each once from either end.
    fn wall_corners(&self) -> f64 {
        if self.rules.border == Border::Periodic {
            return 0.0;
        }
        let (nx, nz) = (self.rules.nx, self.rules.nz);
        let pair =
            |a: usize, b: usize| f64::from(self.now[a] - self.now[b]) * f64::from(self.before[a] - self.before[b]);
        let mut total = 0.0;
        for edge in [0, (nz - 1) * nx] {
            for i in 1..nx {
                total += pair(edge + i - 1, edge + i);
            }
        }
        for edge in [0, nx - 1] {
            for j in 1..nz {
                total += pair(edge + (j - 1) * nx, edge + j * nx);
            }
        }
        total
    }

    /// Whether no height and no change within a step, as a height, exceeds `height_m`. Units: m. Looks no further than
    /// the first cell that does; NaN is never calm.
    #[must_use]
    pub fn is_calm(&self, height_m: f32) -> bool {
        // Over a step the change of a wave of height h is at most 2h.
        self.still
            || self
                .now
                .iter()
                .zip(&self.before)
                .all(|(now, before)| now.abs() <= height_m && (now - before).abs() <= 2.0 * height_m)
    }

    /// Stills a calm field (see [`WaveField::is_calm`]): steps then cost nothing until the next source. Returns whether
    /// it is still, with the water in m³ that has to go to the level.
    pub fn settle(&mut self, height_m: f32) -> Option<f64> {
        if !self.is_calm(height_m) {
            return None;
        }
        let volume = if self.still { 0.0 } else { self.volume_m3() };
        self.now.fill(0.0);
        self.before.fill(0.0);
        (self.sum_now, self.sum_before) = (0.0, 0.0);
        self.still = true;
        Some(volume)
    }

    /// Whether all heights are exactly 0.
    #[must_use]
    pub fn is_still(&self) -> bool {
        self.still
    }

    /// Writes (∂u/∂x, ∂u/∂z) of every cell, by central differences; one-sided at borders and shores. Units: none.
    ///
    /// The normal is (−∂u/∂x, 1, −∂u/∂z), normalised. Error: 0.1 of the slope of waves of 8 cells, second order in the cell;
    /// none on a plane.
    ///
    /// # Panics
    /// When `out` has not one entry for each cell.
    pub fn write_slopes(&self, out: &mut [[f32; 2]]) {
        let rules = &self.rules;
        let (nx, nz) = (rules.nx, rules.nz);
        assert_eq!(out.len(), nx * nz, "one slope for each cell");
        let wraps = rules.border == Border::Periodic;
        let per_cell = (1.0 / self.settings.cell_m) as f32;
        // The neighbour, or the cell itself where there is none.
        let next = |k: usize, n: usize| {
            if k + 1 < n {
                k + 1
            } else if wraps {
                0
            } else {
                k
            }
        };
        let last = |k: usize, n: usize| {
            if k > 0 {
                k - 1
            } else if wraps {
                n - 1
            } else {
                k
            }
        };
        for j in 0..nz {
            for i in 0..nx {
                let here = j * nx + i;
                let wet = |index: usize| if self.relative_depth(index) > 0.0 { index } else { here };
                let difference = |low: usize, high: usize| {
                    let (low, high) = (wet(low), wet(high));
                    let spans = (low != here) as u8 + (high != here) as u8;
                    (self.now[high] - self.now[low]) * per_cell / f32::from(spans.max(1))
                };
                out[here] = [
                    difference(j * nx + last(i, nx), j * nx + next(i, nx)),
                    difference(last(j, nz) * nx + i, next(j, nz) * nx + i),
                ];
            }
        }
    }
}
