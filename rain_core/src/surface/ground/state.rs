//! Snapshots of the ground's water.

use serde::{Deserialize, Serialize};

use super::cells::Columns;
use super::error::GroundError;
use super::inflow::Inflow;
use super::ledger::Totals;
use super::run::{Ground, Pending};
use crate::surface::basins::{BasinRun, BasinState};
use crate::weather::store::Store;

/// Version of [`GroundState`] that this library writes and reads.
pub const GROUND_STATE_VERSION: u32 = 1;

/// All water of a ground as plain data: save it, send it, restore it with [`Ground::restore`].
///
/// Restored bit for bit from any format that keeps the bits of an f64 (RON does; JSON through serde_json does with its
/// feature `float_roundtrip`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GroundState {
    pub(super) version: u32,
    /// Of heights, classes and cover.
    pub(super) scene: u64,
    pub(super) interval_steps: u32,
    pub(super) basin_steps: u32,
    pub(super) cells: Columns,
    pub(super) cover: Columns,
    pub(super) exposure: Vec<u8>,
    pub(super) basins: BasinState,
    pub(super) inflow: Inflow,
    pub(super) pending: Vec<Pending>,
    pub(super) basin_time_s: f64,
    pub(super) basin_evaporation_mm: f64,
    pub(super) turn: u64,
    pub(super) totals: Totals,
}

impl GroundState {
    /// The version it was written with.
    #[must_use]
    pub fn version(&self) -> u32 {
        self.version
    }
}

fn finite(values: &[f64], most: f64) -> bool {
    values.iter().all(|v| v.is_finite() && *v >= 0.0 && *v <= most)
}

fn sound(stores: &[Store]) -> bool {
    stores
        .iter()
        .all(|s| s.parts().iter().all(|v| v.is_finite() && v.abs() < 1e18))
}

impl Ground {
    /// A number that tells grids, heights, classes and covers apart.
    #[must_use]
    pub fn scene_fingerprint(&self) -> u64 {
        let mut hash = 0_u64;
        let mut put = |word: u64| hash = (hash.rotate_left(23) ^ word).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let [nx, nz] = self.frame.cells();
        let [ox, oz] = self.frame.origin();
        put(nx as u64);
        put(nz as u64);
        for value in [self.frame.cell_m(), ox, oz] {
            put(value.to_bits());
        }
        for (height, &class) in self.heights.iter().zip(&self.class) {
            put(if height.is_nan() { 1 } else { height.to_bits() });
            put(u64::from(class));
        }
        for (&cell, top) in self.cover.cell.iter().zip(&self.cover.top) {
            put(u64::from(cell));
            put(top.to_bits());
        }
        hash
    }

    /// The water, to be saved. Allocates a copy.
    #[must_use]
    pub fn state(&self) -> GroundState {
        GroundState {
            version: GROUND_STATE_VERSION,
            scene: self.scene_fingerprint(),
            interval_steps: self.interval_steps,
            basin_steps: self.basin_steps,
            cells: self.cells.clone(),
            cover: self.cover.columns.clone(),
            exposure: self.exposure.clone(),
            basins: self.basins.state().clone(),
            inflow: self.inflow.clone(),
            pending: self.pending.clone(),
            basin_time_s: self.basin_time_s,
            basin_evaporation_mm: self.basin_evaporation,
            turn: self.turn,
            totals: self.totals,
        }
    }

    /// Whether a state could be restored.
    ///
    /// # Errors
    /// As [`Ground::restore`].
    pub fn check(&self, state: &GroundState) -> Result<(), GroundError> {
        self.restored(state).map(|_| ())
    }

    /// Takes over a saved state of the same ground: what follows is bit for bit what would have followed there.
    ///
    /// # Errors
    /// When it is of another version, another scene, grid or interval, damaged, or its ledger is open by more than 1e-9.
    /// Then nothing changes.
    pub fn restore(&mut self, state: &GroundState) -> Result<(), GroundError> {
        *self = self.restored(state)?;
        Ok(())
    }

    fn restored(&self, state: &GroundState) -> Result<Self, GroundError> {
        let other = |what| GroundError::OtherGround { what };
        let damaged = |what| GroundError::Damaged { what };
        let must = |holds: bool, error: GroundError| if holds { Ok(()) } else { Err(error) };
        if state.version != GROUND_STATE_VERSION {
            return Err(GroundError::Version {
                found: state.version,
                supported: GROUND_STATE_VERSION,
            });
        }
        let of = |columns: &Columns, count: usize| {
            [&columns.pores, &columns.film, &columns.tau]
                .iter()
                .all(|v| v.len() == count)
        };
        let slices = self.interval_steps as usize;
        must(
            of(&state.cells, self.heights.len()) && state.exposure.len() == self.heights.len(),
            other("number of cells"),
        )?;
        must(
            of(&state.cover, self.cover.cell.len()),
            other("number of covered cells"),
        )?;
        must(state.scene == self.scene_fingerprint(), other("scene"))?;
        must(
            state.interval_steps == self.interval_steps && state.basin_steps == self.basin_steps,
            other("interval"),
        )?;
        must(state.pending.len() == slices, damaged("the turns of the rows"))?;
        for columns in [&state.cells, &state.cover] {
            let sound = finite(&columns.pores, 1e3) && finite(&columns.film, 1e15) && finite(&columns.tau, 1e12);
            must(sound, damaged("the water of a cell"))?;
        }
        let fits = |pores: f64, class: u8| pores <= self.properties[usize::from(class)].pore_capacity_mm;
        must(
            state
                .cells
                .pores
                .iter()
                .zip(&self.class)
                .all(|(&p, &class)| fits(p, class)),
            damaged("more water than pores hold"),
        )?;
        for pending in &state.pending {
            let times = [pending.evaporation, pending.time_s, pending.idle_s];
            must(
                finite(&times, 1e15)
                    && finite(&[pending.share.0], 1.0)
                    && sound(&[pending.rain])
                    && pending.rain.total() >= 0.0,
                damaged("the weather that rows have not seen"),
            )?;
        }
        let count = self.levels.len();
        let inflow = &state.inflow;
        must(
            [inflow.gathered.len(), inflow.due.len(), inflow.demand.len()] == [count; 3]
                && sound(&inflow.gathered)
                && sound(&inflow.due)
                && finite(&inflow.demand, 1e15)
                && inflow.parts <= self.basin_steps,
            damaged("the water underway to basins"),
        )?;
        must(
            finite(&[state.basin_time_s, state.basin_evaporation_mm], 1e15),
            damaged("the time of the basins"),
        )?;
        must(sound(&state.totals.stores()), damaged("the ledger's sums"))?;
        let basins = BasinRun::restore(self.basins.basins().clone(), state.basins.clone())?;
        let mut restored = self.clone();
        restored.cells.clone_from(&state.cells);
        restored.cover.columns.clone_from(&state.cover);
        restored.exposure.clone_from(&state.exposure);
        restored.basins = basins;
        restored.inflow.clone_from(&state.inflow);
        restored.pending.clone_from(&state.pending);
        restored.basin_time_s = state.basin_time_s;
        restored.basin_evaporation = state.basin_evaporation_mm;
        restored.turn = state.turn;
        restored.totals = state.totals;
        restored.film_version += 1;
        restored.level_version += 1;
        restored.see_levels();
        must(
            restored.ledger().residual_relative <= 1e-9,
            damaged("its ledger is open"),
        )?;
        Ok(restored)
    }
}
