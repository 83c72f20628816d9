//! The ground under rain: cells in turns, basins between.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::cells::{Columns, Interval, Memo};
use super::error::GroundError;
use super::inflow::Inflow;
use super::layers::{GroundLayers, class_of};
use super::ledger::Totals;
use super::scene::{GroundScene, GroundSettings};
use crate::error::{ConfigError, in_range};
use crate::surface::basins::{BakeOptions, BasinForcing, BasinRun, Basins, Grid};
use crate::surface::height_field::GridFrame;
use crate::weather::store::Store;
use crate::weather::{ColumnForcing, MAX_INTERVAL_S, MAX_SURFACE_RATE_MM_H, SurfaceClass, SurfaceProperties};

/// A level moves the version when it has moved by this much. Units: m.
const SEEN_M: f64 = 1e-4;
/// m/s in a mm/h.
const M_S_PER_MM_H: f64 = 1.0 / 3.6e6;

/// What has acted on a slice of cells since it was last advanced.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Pending {
    /// Units: mm.
    pub(super) rain: Store,
    /// Units: mm.
    pub(super) evaporation: f64,
    pub(super) time_s: f64,
    /// Dry time without rain before that: only the soil recovers. Units: s.
    pub(super) idle_s: f64,
    /// Whether any of its cells may hold water.
    pub(super) wet: bool,
    /// Mean share of `rain` on its ground cells, as it was when they were last advanced; more than the full rain is not.
    #[serde(default = "all", skip_serializing_if = "is_all")]
    pub(super) share: Share,
}

/// A share that is 1 until areas of rain say otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub(super) struct Share(pub(super) f64);

impl Default for Share {
    fn default() -> Self {
        Self(1.0)
    }
}

fn all() -> Share {
    Share::default()
}

fn is_all(share: &Share) -> bool {
    share.0 == 1.0
}

/// Rain that is not the same everywhere: shares of the rate that [`Ground::advance_under`] is given.
pub trait UnevenRain {
    /// The next questions are about so long before the end of the step. Units: s.
    fn look_back(&mut self, ago_s: f64);

    /// Share of the rain at a place (x, z). Units: none; held in [0, 1] and rounded to 1/65535.
    fn share_at(&self, place_m: [f64; 2]) -> f64;
}

/// Steps of a local share.
pub(super) const FULL: u16 = u16::MAX;

/// What stands over the ground: the covered cells in rising order.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cover {
    pub(super) cell: Vec<u32>,
    pub(super) top: Vec<f64>,
    /// Place of the first covered cell of each row, and the end.
    pub(super) row: Vec<u32>,
    pub(super) columns: Columns,
}

impl Cover {
    fn new(layers: &GroundLayers) -> Self {
        let [nx, nz] = layers.frame.cells();
        let mut cover = Self {
            cell: Vec::new(),
            top: Vec::new(),
            row: Vec::with_capacity(nz + 1),
            columns: Columns::default(),
        };
        for row in 0..nz {
            cover.row.push(cover.cell.len() as u32);
            for cell in row * nx..(row + 1) * nx {
                if !layers.top[cell].is_nan() {
                    cover.cell.push(cell as u32);
                    cover.top.push(layers.top[cell]);
                }
            }
        }
        cover.row.push(cover.cell.len() as u32);
        cover.columns = Columns::dry(cover.cell.len());
        cover
    }

    /// Place of a cell among the covered ones.
    pub(super) fn find(&self, cell: usize) -> Option<usize> {
        self.cell.binary_search(&(cell as u32)).ok()
    }
}

/// The wet ground of a scene.
///
/// Each cell is advanced once in [`GroundSettings::interval_steps`] steps, with the mean conditions of that time; rows
/// take turns by the number of the step, so the state depends on the steps alone. Steps allocate nothing. A step of a
/// dry ground without rain touches nothing but counters.
///
/// Memory: 45 bytes a cell, 36 more where something covers it, and the basins.
#[derive(Debug, Clone)]
pub struct Ground {
    pub(super) frame: GridFrame,
    pub(super) heights: Vec<f64>,
    pub(super) heights_f32: Vec<f32>,
    pub(super) base_m: f64,
    pub(super) class: Vec<u8>,
    pub(super) properties: [SurfaceProperties; SurfaceClass::COUNT],
    pub(super) interval_steps: u32,
    pub(super) basin_steps: u32,
    pub(super) ground_cells: usize,
    pub(super) cells: Columns,
    pub(super) cover: Cover,
    pub(super) exposure: Vec<u8>,
    pub(super) basins: BasinRun,
    pub(super) inflow: Inflow,
    /// Level of the pool that holds each basin. Units: m.
    pub(super) levels: Vec<f64>,
    pub(super) pending: Vec<Pending>,
    /// Ground cells of each slice.
    pub(super) slice_cells: Vec<u32>,
    /// Of the basins since they were last advanced. Units: s, mm.
    pub(super) basin_time_s: f64,
    pub(super) basin_evaporation: f64,
    pub(super) basins_hold: bool,
    pub(super) turn: u64,
    pub(super) totals: Totals,
    memo: Memo,
    /// Shares of a row under rain that is not the same everywhere.
    local: Vec<u16>,
    /// Cells that some level may cover.
    pub(super) wettable: Vec<u32>,
    marks: Vec<f64>,
    pub(super) film_version: u64,
    pub(super) level_version: u64,
}

impl Ground {
    /// A dry ground. Where something covers a cell no rain reaches it until its exposure is set.
    ///
    /// # Errors
    /// When a setting is outside its domain, the grid would be too large or nothing faces up inside the domain.
    pub fn build(scene: &GroundScene, settings: &GroundSettings) -> Result<Self, GroundError> {
        Self::new(scene.layers(settings)?, settings)
    }

    /// A dry ground of these layers.
    ///
    /// # Errors
    /// When a setting is outside its domain.
    pub fn new(layers: GroundLayers, settings: &GroundSettings) -> Result<Self, GroundError> {
        settings.validated()?;
        let frame = *layers.frame();
        let [nx, nz] = frame.cells();
        let grid = Grid {
            nx,
            nz,
            cell_m: frame.cell_m(),
            origin_m: frame.origin(),
            heights: &layers.ground,
        };
        let options = BakeOptions {
            closed: false,
            threshold_m: settings.puddle_threshold_m,
            drains: settings.drains.clone(),
        };
        let baked = Arc::new(Basins::bake(&grid, &options)?);
        let filled = baked.filled(&layers.ground)?;
        let wettable = (0..nx * nz)
            .filter(|&i| filled[i] > layers.ground[i])
            .map(|i| i as u32)
            .collect();
        let lowest = layers.ground.iter().copied().fold(f64::INFINITY, f64::min);
        let base_m = lowest.floor();
        let slices = settings.interval_steps as usize;
        let mut slice_cells = vec![0; slices];
        for (cell, height) in layers.ground.iter().enumerate() {
            slice_cells[cell / nx % slices] += u32::from(!height.is_nan());
        }
        let count = baked.basins().len();
        let basins = BasinRun::new(baked);
        let mut levels = vec![0.0; count];
        basins.levels_into(&mut levels);
        Ok(Self {
            frame,
            heights_f32: layers.ground.iter().map(|y| (y - base_m) as f32).collect(),
            base_m,
            properties: settings.properties,
            interval_steps: settings.interval_steps,
            basin_steps: settings.basin_steps,
            ground_cells: slice_cells.iter().map(|&n| n as usize).sum(),
            cells: Columns::dry(nx * nz),
            cover: Cover::new(&layers),
            exposure: layers
                .top
                .iter()
                .map(|top| if top.is_nan() { 255 } else { 0 })
                .collect(),
            inflow: Inflow::none(count),
            marks: levels.clone(),
            levels,
            basins,
            pending: vec![Pending::default(); slices],
            slice_cells,
            basin_time_s: 0.0,
            basin_evaporation: 0.0,
            basins_hold: false,
            turn: 0,
            totals: Totals::default(),
            memo: Memo::new(),
            local: Vec::new(),
            wettable,
            film_version: 0,
            level_version: 0,
            heights: layers.ground,
            class: layers.class,
        })
    }

    /// Water of a cell and a millimetre. Units: m³.
    pub(super) fn m3_per_mm(&self) -> f64 {
        self.frame.cell_m() * self.frame.cell_m() * 1e-3
    }

    /// Rain that slices have not seen. Units: mm times cells.
    pub(super) fn pending_rain(&self) -> Store {
        let mut sum = Store::default();
        for (pending, &cells) in self.pending.iter().zip(&self.slice_cells) {
            sum.add_store(pending.rain.scaled(f64::from(cells) * pending.share.0));
        }
        sum
    }

    /// Whether no water is anywhere: a step without rain touches nothing.
    #[must_use]
    pub fn is_dry(&self) -> bool {
        !self.basins_hold && self.pending.iter().all(|p| !p.wet && p.rain.total() == 0.0) && self.inflow.is_empty()
    }

    /// Advances by `dt_s` (units: s; domain: [0, 1e9]) under constant conditions: one call for each tick, with `steps`
    /// normal ticks in it (above 1 in fast-forward; 0 counts as 1). From `interval_steps` on every cell is advanced.
    ///
    /// Error: within 2e-3 of what films held up to 1 s before and basins up to 3 s before; at rest 3e-3 against cells
    /// advanced every tick, 1e-6 against turns of one tick.
    ///
    /// # Errors
    /// When a rate or the time is outside its domain; then nothing changes.
    pub fn advance(&mut self, forcing: &ColumnForcing, dt_s: f64, steps: u32) -> Result<(), ConfigError> {
        self.advance_under(forcing, dt_s, steps, None)
    }

    /// [`Ground::advance`] under rain that is not the same everywhere: `uneven` gives each cell its share of the forcing's
    /// rain, in the middle of the interval that it is advanced by. None: the same everywhere, bit for bit.
    ///
    /// Until a cell is advanced the ledger has its unseen rain by the share of its row's turn before; the balance closes
    /// all the same.
    ///
    /// Error: as [`Ground::advance`]; shares 1/131070.
    ///
    /// # Errors
    /// When a rate or the time is outside its domain; then nothing changes.
    pub fn advance_under(
        &mut self,
        forcing: &ColumnForcing,
        dt_s: f64,
        steps: u32,
        mut uneven: Option<&mut dyn UnevenRain>,
    ) -> Result<(), ConfigError> {
        const RATES: &str = "0 to 10000 mm/h";
        in_range("rain_mm_h", forcing.rain_mm_h, 0.0, MAX_SURFACE_RATE_MM_H, RATES)?;
        let evaporation = forcing.evaporation_mm_h;
        in_range("evaporation_mm_h", evaporation, 0.0, MAX_SURFACE_RATE_MM_H, RATES)?;
        in_range("dt_s", dt_s, 0.0, MAX_INTERVAL_S, "0 to 1e9 s")?;
        if dt_s == 0.0 {
            return Ok(());
        }
        let steps = u64::from(steps.max(1));
        let (before, n, k) = (self.turn, u64::from(self.interval_steps), u64::from(self.basin_steps));
        self.turn += steps;
        if forcing.rain_mm_h == 0.0 && self.is_dry() {
            for pending in &mut self.pending {
                pending.idle_s += std::mem::take(&mut pending.time_s) + dt_s;
                pending.evaporation = 0.0;
            }
            (self.basin_time_s, self.basin_evaporation) = (0.0, 0.0);
            return Ok(());
        }
        let (rain_mm, evaporation_mm) = (forcing.rain_mm_h * dt_s / 3600.0, evaporation * dt_s / 3600.0);
        for pending in &mut self.pending {
            pending.rain.add(rain_mm);
            pending.evaporation += evaporation_mm;
            pending.time_s += dt_s;
        }
        self.basin_time_s += dt_s;
        self.basin_evaporation += evaporation_mm;
        for step in 0..steps.min(n) {
            self.advance_slice(((before + step) % n) as usize, uneven.as_deref_mut())?;
        }
        if steps >= n {
            self.inflow.gather(self.basin_steps);
            let (time, evaporated) = (self.basin_time_s, self.basin_evaporation);
            for _ in 0..k {
                (self.basin_time_s, self.basin_evaporation) = (time / k as f64, evaporated / k as f64);
                self.advance_basins(1)?;
            }
            return Ok(());
        }
        let place = |turn: u64| turn * k / n;
        let parts = place(self.turn) - place(before);
        if parts > 0 {
            self.advance_basins(parts)?;
        }
        if self.turn / n > before / n {
            self.inflow.gather(self.basin_steps);
        }
        Ok(())
    }

    /// Hands due water over and lets the basins' time pass.
    fn advance_basins(&mut self, parts: u64) -> Result<(), ConfigError> {
        let k = self.m3_per_mm();
        let mut any = self.basins_hold;
        for _ in 0..parts {
            any |= self.inflow.release(&mut self.basins, k)?;
        }
        let time = std::mem::take(&mut self.basin_time_s);
        let evaporation = std::mem::take(&mut self.basin_evaporation);
        if !any || time == 0.0 {
            return Ok(());
        }
        let forcing = BasinForcing {
            evaporation_m_s: evaporation / time * 3600.0 * M_S_PER_MM_H,
            ..BasinForcing::default()
        };
        self.basins.rouse();
        self.basins.advance(&forcing, time)?;
        self.totals.infiltrated.add(self.inflow.soak(&mut self.basins)?);
        self.see_levels();
        Ok(())
    }

    /// Reads the levels after the basins have changed.
    pub(super) fn see_levels(&mut self) {
        self.basins_hold = self.basins.levels_into(&mut self.levels);
        let moved = |(level, mark): (&f64, &f64)| (level - mark).abs() > SEEN_M || level.is_nan() != mark.is_nan();
        if self.levels.iter().zip(&self.marks).any(moved) {
            self.marks.copy_from_slice(&self.levels);
            self.level_version += 1;
        }
    }

    /// The pool over a cell, if it stands over its ground.
    pub(super) fn pool_over(&self, cell: usize) -> Option<u32> {
        let leaf = self.basins.basins().wettable_leaf_at(cell)?;
        (self.levels[leaf as usize] > self.heights[cell]).then_some(leaf)
    }

    /// Sends water (mm) from a cell to its basin or off the map.
    pub(super) fn run_off(&mut self, cell: usize, water: Store) {
        match self.basins.basins().leaf_at(cell) {
            Some(leaf) => self.inflow.gathered[leaf as usize].add_store(water),
            None => self.totals.cells_off_map.add_store(water),
        }
    }

    fn advance_slice(&mut self, slice: usize, uneven: Option<&mut (dyn UnevenRain + '_)>) -> Result<(), ConfigError> {
        let [nx, nz] = self.frame.cells();
        let rows = (slice..nz).step_by(self.interval_steps as usize);
        let pending = &mut self.pending[slice];
        if pending.rain.total() == 0.0 && !pending.wet {
            pending.idle_s += std::mem::take(&mut pending.time_s);
            pending.evaporation = 0.0;
            return Ok(());
        }
        let idle_s = std::mem::take(&mut pending.idle_s);
        if idle_s > 0.0 {
            for row in rows.clone() {
                self.recover(row * nx..(row + 1) * nx, idle_s);
            }
        }
        let Pending {
            rain,
            evaporation,
            time_s,
            share,
            ..
        } = std::mem::take(&mut self.pending[slice]);
        let interval = Interval {
            rain_mm_h: (rain.total() / time_s * 3600.0).min(MAX_SURFACE_RATE_MM_H),
            evaporation_mm_h: (evaporation / time_s * 3600.0).min(MAX_SURFACE_RATE_MM_H),
            time_s,
        };
        self.memo.begin();
        let mut wet = false;
        let uneven = uneven.filter(|_| interval.rain_mm_h > 0.0).map(|uneven| {
            uneven.look_back(0.5 * time_s);
            &*uneven
        });
        let mut local = std::mem::take(&mut self.local);
        let mut shares = 0;
        for row in rows {
            let local = match uneven {
                Some(uneven) => {
                    shares += self.read_shares(row, uneven, &mut local);
                    Some(local.as_slice())
                }
                None => None,
            };
            wet |= self.advance_row(row * nx..(row + 1) * nx, &interval, local)?;
            wet |= self.advance_cover(row, &interval, local);
        }
        self.local = local;
        self.pending[slice].wet = wet;
        self.pending[slice].share = match uneven {
            Some(_) => Share(shares as f64 / (f64::from(FULL) * f64::from(self.slice_cells[slice].max(1)))),
            // Without rain nothing was asked.
            None if interval.rain_mm_h > 0.0 => Share::default(),
            None => share,
        };
        self.film_version += 1;
        Ok(())
    }

    /// The shares of a row's cells; returns their sum over the cells that have a ground.
    fn read_shares(&self, row: usize, uneven: &dyn UnevenRain, into: &mut Vec<u16>) -> u64 {
        let [nx, _] = self.frame.cells();
        into.clear();
        let mut sum = 0;
        for column in 0..nx {
            let share = if self.heights[row * nx + column].is_nan() {
                0
            } else {
                let share = uneven.share_at(self.frame.centre_m(column, row));
                // What is not a number becomes 0.
                (share.clamp(0.0, 1.0) * f64::from(FULL) + 0.5) as u16
            };
            sum += u64::from(share);
            into.push(share);
        }
        sum
    }

    /// Lets dry soil recover.
    fn recover(&mut self, cells: core::ops::Range<usize>, time_s: f64) {
        for cell in cells {
            if self.cells.tau[cell] > 0.0 {
                let soil = self.properties[class_of(self.class[cell]).index()].infiltration.curve();
                self.cells.tau[cell] = soil.recovered(self.cells.tau[cell], time_s);
            }
        }
    }

    fn advance_row(
        &mut self,
        cells: core::ops::Range<usize>,
        interval: &Interval,
        local: Option<&[u16]>,
    ) -> Result<bool, ConfigError> {
        let mut wet = false;
        let first = cells.start;
        for cell in cells {
            if self.heights[cell].is_nan() {
                continue;
            }
            let share = self.exposure[cell];
            let local = local.map_or(FULL, |local| local[cell - first]);
            if let Some(leaf) = self.pool_over(cell) {
                self.pass_to_pool(cell, leaf, interval, local)?;
                wet = true;
                continue;
            }
            let state = [self.cells.pores[cell], self.cells.film[cell], self.cells.tau[cell]];
            if state == [0.0; 3] && (share == 0 || local == 0 || interval.rain_mm_h == 0.0) {
                continue;
            }
            let after = self
                .memo
                .advanced(&self.properties, self.class[cell], (share, local), state, interval);
            let rounding = self.cells.put(cell, after);
            let totals = &mut self.totals;
            totals.cells_rain.add_store(after.rain);
            totals.cells_evaporated.add_store(after.evaporated);
            if rounding != 0.0 {
                totals.cells_evaporated.add(rounding);
            }
            if after.infiltrated.total() != 0.0 {
                totals.cells_infiltrated.add_store(after.infiltrated);
            }
            let drained = after.drained;
            if drained.total() != 0.0 {
                self.run_off(cell, drained);
            }
            wet |= self.cells.is_wet(cell);
        }
        Ok(wet)
    }

    /// A cell under a pool: film and rain join it, the pores are full, the soil takes its share from it.
    fn pass_to_pool(&mut self, cell: usize, leaf: u32, interval: &Interval, local: u16) -> Result<(), ConfigError> {
        let properties = &self.properties[class_of(self.class[cell]).index()];
        let (capacity, infiltration) = (properties.pore_capacity_mm, properties.infiltration);
        let k = self.m3_per_mm();
        let share = f64::from(self.exposure[cell]) / 255.0;
        let rain = interval.local_mm_h(local) * share * interval.time_s / 3600.0;
        let mut water = Store::new(self.cells.pores[cell]);
        water.add(self.cells.film[cell]);
        water.add(rain);
        self.totals.cells_rain.add(rain);
        self.cells.film[cell] = 0.0;
        let missing = capacity - water.total();
        if missing > 0.0 {
            water.add(self.basins.remove_water(cell, missing * k)? / k);
        }
        if water.total() >= capacity {
            let rest = water.cut_to(capacity);
            self.inflow.gathered[leaf as usize].add_store(rest);
        } else {
            self.totals.cells_evaporated.add(water.parts()[1]);
        }
        self.cells.pores[cell] = water.total();
        if infiltration.is_permeable() {
            let soil = infiltration.curve();
            let tau = self.cells.tau[cell];
            self.inflow.demand[leaf as usize] += soil.depth(tau, interval.time_s) * k;
            self.cells.tau[cell] = soil.advanced(tau, interval.time_s);
        }
        Ok(())
    }

    /// What stands over a row's cells, and the rain that the slant keeps off cells with nothing over them.
    fn advance_cover(&mut self, row: usize, interval: &Interval, local: Option<&[u16]>) -> bool {
        let [nx, _] = self.frame.cells();
        let local_at = |cell: usize| local.map_or(FULL, |local| local[cell - row * nx]);
        let mut wet = false;
        let places = self.cover.row[row] as usize..self.cover.row[row + 1] as usize;
        for place in places.clone() {
            let cell = self.cover.cell[place] as usize;
            let (share, local) = (255 - self.exposure[cell], local_at(cell));
            let columns = &mut self.cover.columns;
            let state = [columns.pores[place], columns.film[place], 0.0];
            if state == [0.0; 3] && (share == 0 || local == 0 || interval.rain_mm_h == 0.0) {
                continue;
            }
            let class = SurfaceClass::Roof.index() as u8;
            let after = self
                .memo
                .advanced(&self.properties, class, (share, local), state, interval);
            let rounding = columns.put(place, after);
            let totals = &mut self.totals;
            totals.cells_rain.add_store(after.rain);
            totals.cells_evaporated.add_store(after.evaporated);
            totals.cells_evaporated.add(rounding);
            totals.cells_infiltrated.add_store(after.infiltrated);
            totals.cells_gutters.add_store(after.drained);
            wet |= columns.is_wet(place);
        }
        if interval.rain_mm_h > 0.0 {
            let mut next = places.start;
            for cell in row * nx..(row + 1) * nx {
                if self.cover.cell.get(next) == Some(&(cell as u32)) {
                    next += 1;
                } else if self.exposure[cell] < 255 && !self.heights[cell].is_nan() {
                    let share = f64::from(255 - self.exposure[cell]) / 255.0;
                    let rain = interval.local_mm_h(local_at(cell)) * share * interval.time_s / 3600.0;
                    self.totals.cells_rain.add(rain);
                    self.totals.cells_gutters.add(rain);
                }
            }
        }
        wet
    }

    /// Every bit of the state in a fixed order, for hashes.
    pub fn for_each_state_bits(&self, mut put: impl FnMut(u64)) {
        self.cells.for_each_bits(&mut put);
        self.cover.columns.for_each_bits(&mut put);
        self.exposure.chunks(8).for_each(|chunk| {
            put(chunk.iter().fold(0, |word, &e| word << 8 | u64::from(e)));
        });
        self.inflow.for_each_bits(&mut put);
        for pending in &self.pending {
            for value in [
                pending.rain.parts()[0],
                pending.rain.parts()[1],
                pending.evaporation,
                pending.time_s,
                pending.idle_s,
            ] {
                put(value.to_bits());
            }
            put(u64::from(pending.wet));
            if pending.share != Share::default() {
                put(pending.share.0.to_bits());
            }
        }
        for value in [self.basin_time_s, self.basin_evaporation] {
            put(value.to_bits());
        }
        put(self.turn);
        for store in self.totals.stores() {
            store.parts().iter().for_each(|v| put(v.to_bits()));
        }
        let basins = self.basins.state();
        for (index, volume) in basins.volumes.iter().enumerate() {
            volume.parts().iter().for_each(|v| put(v.to_bits()));
            put(u64::from(basins.united[index]) << 1 | u64::from(basins.full[index]));
        }
        for store in basins.totals.stores() {
            store.parts().iter().for_each(|v| put(v.to_bits()));
        }
    }
}
