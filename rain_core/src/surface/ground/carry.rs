//! Water taken over from the ground of a scene before it changed.

use super::run::Ground;
use crate::error::ConfigError;
use crate::weather::store::Store;

impl Ground {
    /// Takes over the water and the ledger of the ground that this one replaces, by position. This one must be as it
    /// was built. What has no place any more runs off the map. The ledger stays closed.
    ///
    /// Each cell's water goes in equal parts to the cells whose centre lies in it, or else to the cell that holds its
    /// centre; what pores cannot hold becomes film. Each pool's water is poured in at its lowest place.
    ///
    /// Error: the balance closes to 1e-12 of the water supplied.
    ///
    /// # Errors
    /// None for a ground that came about by the methods here.
    pub fn take_over(&mut self, old: &Self) -> Result<(), ConfigError> {
        let accounts = old.accounts();
        let totals = &mut self.totals;
        totals.rain = accounts.rain;
        totals.added = accounts.added;
        totals.airborne = accounts.airborne;
        totals.evaporated = accounts.evaporated;
        totals.infiltrated = accounts.infiltrated;
        totals.off_map = accounts.off_map;
        totals.inlets = accounts.inlets;
        totals.gutters = accounts.gutters;
        self.turn = old.turn;
        (self.film_version, self.level_version) = (old.film_version + 1, old.level_version + 1);
        // What cells have not seen or basins have not got runs off now.
        let k = old.m3_per_mm();
        let [nx, nz] = old.frame.cells();
        for row in 0..nz {
            let pending = &old.pending[row % old.interval_steps as usize];
            let unseen = pending.rain.scaled(pending.share.0);
            for cell in row * nx..(row + 1) * nx {
                if !old.heights[cell].is_nan() {
                    self.take_cell(old, cell, unseen.scaled(k));
                }
            }
        }
        let state = old.basins.state();
        for (basin, at) in old.basins().basins().iter().enumerate() {
            let mut water = old.inflow.gathered[basin];
            water.add_store(old.inflow.due[basin]);
            let mut water = water.scaled(k);
            if state.is_pool(old.basins(), basin as u32) {
                water.add_store(state.volumes[basin]);
            }
            if water.total() <= 0.0 {
                self.totals.off_map.add_store(water);
                continue;
            }
            let pit = at.pit_cell as usize;
            let [x, z] = old.frame.centre_m(pit % nx, pit / nx);
            match self.cell_at(x, z) {
                Some(cell) if !self.heights[cell].is_nan() => {
                    self.basins.add_water(cell, water.total())?;
                    self.totals.off_map.add(water.parts()[1]);
                }
                _ => self.totals.off_map.add_store(water),
            }
        }
        self.see_levels();
        Ok(())
    }

    /// One old cell's film, pores and unseen rain (m³).
    fn take_cell(&mut self, old: &Self, cell: usize, unseen: Store) {
        let [nx, _] = old.frame.cells();
        let k = old.m3_per_mm();
        let [x, z] = old.frame.centre_m(cell % nx, cell / nx);
        let half = 0.5 * old.frame.cell_m();
        let above = old.cover.find(cell);
        let new_k = self.m3_per_mm();
        let places = self.cells_within([x - half, z - half], [x + half, z + half], [x, z]);
        let (columns, rows, count) = places;
        let mut rest = unseen;
        rest.add_store(Store::new(old.cells.film[cell]).scaled(k));
        rest.add_store(Store::new(old.cells.pores[cell]).scaled(k));
        if let Some(at) = above {
            rest.add_store(Store::new(old.cover.columns.film[at]).scaled(k));
            rest.add_store(Store::new(old.cover.columns.pores[at]).scaled(k));
        }
        let [nx, _] = self.frame.cells();
        let slices = self.interval_steps as usize;
        for row in rows {
            for column in columns.clone() {
                let to = row * nx + column;
                if self.heights[to].is_nan() {
                    continue;
                }
                let scale = k / new_k / count as f64;
                let capacity = self.properties[usize::from(self.class[to])].pore_capacity_mm;
                // Several old cells may end in one: its pores take what they can.
                let pores = (self.cells.pores[to] + old.cells.pores[cell] * scale).min(capacity);
                let film_in = unseen.total() / new_k / count as f64
                    + old.cells.film[cell] * scale
                    + (self.cells.pores[to] + old.cells.pores[cell] * scale - pores);
                rest.add_store(self.cells.set(to, pores, self.cells.film[to] + film_in).scaled(-new_k));
                self.cells.tau[to] = self.cells.tau[to].max(old.cells.tau[cell]);
                let wet = &mut self.pending[row % slices].wet;
                *wet |= self.cells.is_wet(to);
                if let (Some(from), Some(at)) = (above, self.cover.find(to)) {
                    let capacity = self.properties[crate::weather::SurfaceClass::Roof.index()].pore_capacity_mm;
                    let (old, new) = (&old.cover.columns, &mut self.cover.columns);
                    let pores = (new.pores[at] + old.pores[from] * scale).min(capacity);
                    let film =
                        new.film[at] + old.film[from] * scale + (new.pores[at] + old.pores[from] * scale - pores);
                    rest.add_store(new.set(at, pores, film).scaled(-new_k));
                    *wet |= new.is_wet(at);
                }
            }
        }
        self.totals.off_map.add_store(rest);
    }

    /// Columns and rows of the cells whose centre lies in a rectangle, or of the one that holds `centre`; and how many
    /// have a ground (at least 1).
    fn cells_within(
        &self,
        low: [f64; 2],
        high: [f64; 2],
        centre: [f64; 2],
    ) -> (core::ops::Range<usize>, core::ops::Range<usize>, usize) {
        let [nx, nz] = self.frame.cells();
        let origin = self.frame.origin();
        let cell_m = self.frame.cell_m();
        let range = |axis: usize, count: usize| {
            let from = ((low[axis] - origin[axis]) / cell_m - 0.5).ceil().max(0.0) as usize;
            let to = ((high[axis] - origin[axis]) / cell_m - 0.5).ceil().max(0.0) as usize;
            if from < to {
                return from..to.min(count).max(from);
            }
            let at = ((centre[axis] - origin[axis]) / cell_m).floor();
            if at >= 0.0 && at < count as f64 {
                at as usize..at as usize + 1
            } else {
                0..0
            }
        };
        let (columns, rows) = (range(0, nx), range(1, nz));
        let grounded = rows
            .clone()
            .flat_map(|row| columns.clone().map(move |column| row * nx + column))
            .filter(|&cell| !self.heights[cell].is_nan())
            .count();
        (columns, rows, grounded.max(1))
    }
}
