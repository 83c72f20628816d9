//! Basins under rain: filled, spilled, merged and parted from event to event.

use std::sync::Arc;

use super::bake::Basins;
use super::events::Events;
use super::march::Stop;
use super::state::{BasinLedger, BasinState};
use crate::error::{ConfigError, in_range};
use crate::weather::store::Store;

/// Longest step. Units: s.
const MAX_STEP_S: f64 = 1e9;

/// What acts on all basins, constant over a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BasinForcing {
    /// Rain on open water. Units: m/s. Domain: [0, 1].
    pub rain_m_s: f64,
    /// What the catchment outside the water delivers, per area: rain less what film, pores and soil keep. Units: m/s.
    /// Domain: [0, 1].
    pub runoff_m_s: f64,
    /// Evaporation from open water. Units: m/s. Domain: [0, 1] (dew is rain: add it there).
    pub evaporation_m_s: f64,
    /// Seepage through the wet ground. Units: m/s. Domain: [0, 1].
    pub seepage_m_s: f64,
}

impl BasinForcing {
    /// Rain that all runs off at once, without losses. Units: m/s.
    #[must_use]
    pub fn rain(rain_m_s: f64) -> Self {
        Self {
            rain_m_s,
            runoff_m_s: rain_m_s,
            ..Self::default()
        }
    }

    fn validated(&self) -> Result<(), ConfigError> {
        for (field, value) in [
            ("rain_m_s", self.rain_m_s),
            ("runoff_m_s", self.runoff_m_s),
            ("evaporation_m_s", self.evaporation_m_s),
            ("seepage_m_s", self.seepage_m_s),
        ] {
            in_range(field, value, 0.0, 1.0, "0 to 1 m/s")?;
        }
        Ok(())
    }

    /// Whether anything but the inflow of a whole catchment counts.
    pub(super) fn needs_area(&self) -> bool {
        self.rain_m_s != self.runoff_m_s || self.evaporation_m_s != 0.0 || self.seepage_m_s != 0.0
    }
}

/// Basins with water in them.
///
/// Each pool's volume follows dV/dt = runoff · catchment + spill in + (rain − runoff − evaporation − seepage) · A(V) −
/// drains(level), solved in closed form between the bends of its curve; pools meet only when one is full, and these
/// moments are found exactly. So the state does not depend on how time is cut into steps. Where rain exceeds runoff and
/// losses together, a pool that wets more ground gains more: one that rested at a bend may then be balanced between
/// rising and sinking. It rises.
///
/// Error: see [`BasinRun::advance`].
///
/// A step costs a search in the curve of every pool, for each event up to a hundred such, and with losses, drains or
/// rain unlike the runoff two for each cell's height that a level passes. Steps and other changes allocate nothing
/// after construction. A step in which nothing changes any more costs nothing.
#[derive(Debug, Clone)]
pub struct BasinRun {
    pub(super) basins: Arc<Basins>,
    pub(in crate::surface) state: BasinState,
    pub(super) forcing: BasinForcing,
    /// Share of the rain that reaches each leaf; of a parent the mean over the part of its catchment that lies above
    /// its children's brim.
    pub(super) exposure: Vec<f64>,
    /// Catchments times exposure, and the children's areas times theirs. Units: m².
    pub(super) exposed: Vec<f64>,
    pub(super) exposed_base: Vec<f64>,
    pub(super) drain_starts: Vec<u32>,
    pub(super) drains_of: Vec<u32>,
    /// Of the step at hand, for each basin: what others spill into it (m³/s), how many do, what it spills, how far it
    /// has been followed (s), what its next event is.
    pub(super) received: Vec<f64>,
    pub(super) donors: Vec<u32>,
    pub(super) spill: Vec<f64>,
    pub(super) clock: Vec<f64>,
    pub(super) due: Vec<Stop>,
    /// Basins still to be looked at; has room for all.
    pub(super) open: Vec<u32>,
    pub(super) events: Events,
    /// End of the step; nothing is predicted before all inflows are known.
    pub(super) end: f64,
    pub(super) predicting: bool,
    /// Whether all pools stood still over the last step, and the rates at which water passed through.
    pub(super) still: bool,
    pub(super) rates: Rates,
}

/// Water that passes through pools that stand still. Units: m³/s.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Rates {
    pub(super) rain: f64,
    pub(super) evaporated: f64,
    pub(super) infiltrated: f64,
    pub(super) drained: f64,
    pub(super) left: f64,
}

impl BasinRun {
    /// Dry basins, all under open sky.
    #[must_use]
    pub fn new(basins: Arc<Basins>) -> Self {
        let state = BasinState::dry(&basins);
        Self::with_state(basins, state)
    }

    /// Basins with the water of a saved state, all under open sky.
    ///
    /// # Errors
    /// When the state is not one of these basins: other counts, volumes a basin cannot hold, a ledger that is open.
    pub fn restore(basins: Arc<Basins>, state: BasinState) -> Result<Self, ConfigError> {
        let state = state.validated(&basins)?;
        Ok(Self::with_state(basins, state))
    }

    fn with_state(basins: Arc<Basins>, state: BasinState) -> Self {
        let count = basins.basins().len();
        let mut starts = vec![0_u32; count + 1];
        let way = |leaf: u32| core::iter::successors(Some(leaf), |&at| basins.basins()[at as usize].parent);
        for drain in basins.drains() {
            for basin in way(drain.leaf) {
                starts[basin as usize + 1] += 1;
            }
        }
        for index in 0..count {
            starts[index + 1] += starts[index];
        }
        let mut next = starts.clone();
        let mut drains_of = vec![0; starts[count] as usize];
        for (index, drain) in basins.drains().iter().enumerate() {
            for basin in way(drain.leaf) {
                drains_of[next[basin as usize] as usize] = index as u32;
                next[basin as usize] += 1;
            }
        }
        let mut run = Self {
            state,
            forcing: BasinForcing::default(),
            exposure: vec![1.0; count],
            exposed: vec![0.0; count],
            exposed_base: vec![0.0; count],
            drain_starts: starts,
            drains_of,
            received: vec![0.0; count],
            donors: vec![0; count],
            spill: vec![0.0; count],
            clock: vec![0.0; count],
            due: vec![Stop::Time; count],
            open: Vec::with_capacity(count),
            events: Events::new(count),
            end: 0.0,
            predicting: false,
            still: false,
            rates: Rates::default(),
            basins,
        };
        run.sum_exposure();
        run
    }

    /// The basins.
    #[must_use]
    pub fn basins(&self) -> &Arc<Basins> {
        &self.basins
    }

    /// The water, to be saved.
    #[must_use]
    pub fn state(&self) -> &BasinState {
        &self.state
    }

    /// Where all water came from and went to.
    #[must_use]
    pub fn ledger(&self) -> BasinLedger {
        self.state.ledger(&self.basins)
    }

    /// Whether the last step changed no volume: a further one under the same forcing costs nothing.
    #[must_use]
    pub fn is_settled(&self) -> bool {
        self.still
    }

    /// Forgets that nothing changed: the next step is worked out whatever came before, as after a restored state.
    pub(in crate::surface) fn rouse(&mut self) {
        self.still = false;
    }

    /// Share of rain and runoff that reaches the catchment of each basin without children (roofs, trees), by basin;
    /// what is given for others does not count. Units: none. Domain: [0, 10]. Default: 1.
    ///
    /// # Errors
    /// When the length is not the number of basins or a share is outside its domain; then nothing changes.
    pub fn set_exposure(&mut self, exposure: &[f64]) -> Result<(), ConfigError> {
        if exposure.len() != self.exposure.len() {
            return Err(ConfigError::OutOfRange {
                field: "exposure.len()",
                value: exposure.len() as f64,
                allowed: "the number of basins",
            });
        }
        for &share in exposure {
            in_range("exposure", share, 0.0, 10.0, "0 to 10")?;
        }
        self.exposure.copy_from_slice(exposure);
        self.sum_exposure();
        self.still = false;
        Ok(())
    }

    /// Children come before parents.
    fn sum_exposure(&mut self) {
        let basins = Arc::clone(&self.basins);
        let areas = |index: usize| basins.basins()[index].area_m2;
        for (index, basin) in basins.basins().iter().enumerate() {
            let Some(children) = basin.children else {
                self.exposed[index] = self.exposure[index] * basin.catchment_m2;
                continue;
            };
            let [a, b] = children.map(|child| child as usize);
            self.exposed[index] = self.exposed[a] + self.exposed[b];
            self.exposed_base[index] = self.exposed_water(a, areas(a)) + self.exposed_water(b, areas(b));
            let rest = basin.catchment_m2 - areas(a) - areas(b);
            let exposed_rest = (self.exposed[index] - self.exposed_base[index]).max(0.0);
            self.exposure[index] = if rest > 0.0 { exposed_rest / rest } else { 0.0 };
        }
    }

    /// Wet area times exposure: the children's own shares, then the mean of the rest. Units: m².
    pub(super) fn exposed_water(&self, basin: usize, area: f64) -> f64 {
        let base = self.basins.basins()[basin].children.map_or(0.0, |children| {
            children
                .iter()
                .map(|&child| self.basins.basins()[child as usize].area_m2)
                .sum()
        });
        self.exposed_base[basin] + self.exposure[basin] * (area - base)
    }

    /// Water in a basin: all of it if it is a pool of its own or in several, what it holds when full if it is part of a
    /// larger pool. Units: m³.
    ///
    /// # Panics
    /// When there is no such basin.
    #[must_use]
    pub fn volume_m3(&self, basin: u32) -> f64 {
        let basins = self.basins.basins();
        let mut total = 0.0;
        let mut at = basin;
        loop {
            // Down to one body of water, by first children.
            while let (Some([first, _]), false) = (basins[at as usize].children, self.state.united[at as usize]) {
                at = first;
            }
            total += if self.state.is_pool(&self.basins, at) {
                self.state.volumes[at as usize].total().max(0.0)
            } else {
                basins[at as usize].volume_m3.unwrap_or(0.0)
            };
            // Up to where a second child is left.
            loop {
                let parent = basins[at as usize].parent.filter(|_| at != basin);
                let Some((parent, [first, second])) = parent.and_then(|p| Some((p, basins[p as usize].children?)))
                else {
                    return total;
                };
                if at == first {
                    at = second;
                    break;
                }
                at = parent;
            }
        }
    }

    /// Level of the water in a basin, its bottom when dry; none where it is several pools. Units: m.
    ///
    /// # Panics
    /// When there is no such basin.
    #[must_use]
    pub fn level_m(&self, basin: u32) -> Option<f64> {
        self.state.united[basin as usize].then(|| {
            let pool = self.state.pool_of(&self.basins, basin);
            let depth = self
                .basins
                .curve(pool)
                .depth_m(self.state.volumes[pool as usize].total());
            self.basins.basins()[pool as usize].bottom_m + depth
        })
    }

    /// Level of the pool that holds each basin, NaN where a basin is several pools; returns whether any holds water.
    /// Units: m. Fills as much of `out` as there are basins.
    pub fn levels_into(&self, out: &mut [f64]) -> bool {
        let mut any = false;
        // Parents have higher numbers than their children.
        for index in (0..self.basins.basins().len().min(out.len())).rev() {
            let basin = &self.basins.basins()[index];
            out[index] = if !self.state.united[index] {
                f64::NAN
            } else if let Some(parent) = basin.parent
                && self.state.united[parent as usize]
            {
                out[parent as usize]
            } else {
                let volume = self.state.volumes[index].total();
                any |= volume > 0.0;
                basin.bottom_m + self.basins.curve(index as u32).depth_m(volume)
            };
        }
        any
    }

    /// Level of the pool that would cover a cell; none where water runs off the map. Units: m.
    #[must_use]
    pub fn level_at(&self, cell: usize) -> Option<f64> {
        self.level_m(self.basins.wettable_leaf_at(cell)?)
    }

    /// Depth of water over a cell whose ground is at `ground_m`. Units: m. 0 where it is dry; NaN ground is a hole and
    /// dry. Error: 1e-9 m against flooding cell by cell.
    #[must_use]
    pub fn depth_at(&self, cell: usize, ground_m: f64) -> f64 {
        let depth = self.level_at(cell).map_or(0.0, |level| level - ground_m);
        if depth > 0.0 { depth } else { 0.0 }
    }

    /// Adds water at a cell at once; what is too much overflows, off the map too. Units: m³. Domain: [0, 1e12].
    ///
    /// Error: depths within 1e-9 m of flooding cell by cell.
    ///
    /// # Errors
    /// When the amount is outside its domain.
    pub fn add_water(&mut self, cell: usize, volume_m3: f64) -> Result<(), ConfigError> {
        in_range("volume_m3", volume_m3, 0.0, 1e12, "0 to 1e12 m³")?;
        self.still = false;
        self.state.totals.added.add(volume_m3);
        match self.basins.leaf_at(cell) {
            Some(leaf) => {
                let pool = self.state.pool_of(&self.basins, leaf);
                self.pour(pool, Store::new(volume_m3));
            }
            None => self.state.totals.left.add(volume_m3),
        }
        Ok(())
    }

    /// Takes water from the pool at a cell, at most what is connected to it there; returns what it took. Units: m³.
    /// Domain: [0, 1e12].
    ///
    /// # Errors
    /// When the amount is outside its domain.
    pub fn remove_water(&mut self, cell: usize, volume_m3: f64) -> Result<f64, ConfigError> {
        in_range("volume_m3", volume_m3, 0.0, 1e12, "0 to 1e12 m³")?;
        let Some(leaf) = self.basins.wettable_leaf_at(cell).filter(|_| volume_m3 > 0.0) else {
            return Ok(0.0);
        };
        self.still = false;
        let basins = Arc::clone(&self.basins);
        let mut taken = Store::default();
        loop {
            let pool = self.state.pool_of(&basins, leaf);
            let wanted = volume_m3 - taken.total();
            let held = self.state.volumes[pool as usize].total() - basins.curve(pool).base_volume;
            let part = if held < wanted { held.max(0.0) } else { wanted };
            self.state.volumes[pool as usize].add(-part);
            self.state.full[pool as usize] &= part == 0.0;
            taken.add(part);
            if part == wanted || pool == leaf {
                break;
            }
            self.part(pool);
        }
        self.state.totals.removed.add(taken.total());
        Ok(taken.total())
    }

    /// Lets time pass. Units: s. Domain: [0, 1e9]; 0 does nothing.
    ///
    /// Error: volumes within 1e-9 (or of 1 m³) for steps of any length, within 1e-11 of an event list, within 1e-10 of
    /// small steps over a rough bottom; inlets as [`super::Inlet::flow_m3_s`]; the ledger closes to 1e-12 of the water that
    /// came.
    ///
    /// # Errors
    /// When the time or a rate is outside its domain; then nothing changes.
    pub fn advance(&mut self, forcing: &BasinForcing, time_s: f64) -> Result<(), ConfigError> {
        in_range("time_s", time_s, 0.0, MAX_STEP_S, "0 to 1e9 s")?;
        forcing.validated()?;
        if time_s == 0.0 {
            return Ok(());
        }
        if self.still && *forcing == self.forcing {
            self.pass(time_s);
            return Ok(());
        }
        self.forcing = *forcing;
        self.begin(time_s);
        // Each pool fills, and each pair meets or parts, a few times in a step; far more would be a fault of rounding.
        let mut budget = 64 + 32 * self.clock.len();
        let mut events = 0;
        while let Some((now, pool)) = self.events.next() {
            self.events.set(pool, f64::INFINITY);
            self.follow(pool, now);
            if self.due[pool as usize] == Stop::Time {
                self.predict(pool, now);
                continue;
            }
            if budget == 0 {
                debug_assert!(false, "events without end");
                break;
            }
            budget -= 1;
            events += 1;
            if self.due[pool as usize] == Stop::Split {
                let children = self.part(pool);
                self.share_received(pool, children);
                for child in children {
                    self.clock[child as usize] = now;
                }
                for child in children {
                    self.balance(child, now);
                }
            } else {
                self.state.full[pool as usize] = true;
                self.balance(pool, now);
            }
        }
        self.finish(events == 0);
        Ok(())
    }

    pub(super) fn unite(&mut self, pool: u32, sibling: u32, parent: u32) {
        let mut volume = self.state.volumes[pool as usize];
        volume.add_store(self.state.volumes[sibling as usize]);
        self.state.volumes[parent as usize] = volume;
        self.state.united[parent as usize] = true;
        self.state.full[parent as usize] = false;
    }

    /// Makes a pool that has fallen to its sill two full ones.
    pub(super) fn part(&mut self, pool: u32) -> [u32; 2] {
        let children = self.basins.basins()[pool as usize].children.unwrap_or([pool; 2]);
        self.state.united[pool as usize] = false;
        self.state.full[pool as usize] = false;
        let mut rest = self.state.volumes[pool as usize];
        let first = self.basins.basins()[children[0] as usize].volume_m3.unwrap_or(0.0);
        rest.add(-first);
        self.state.volumes[children[0] as usize] = Store::new(first);
        self.state.volumes[children[1] as usize] = rest;
        for child in children {
            self.state.full[child as usize] = true;
        }
        children
    }

    /// Puts water into a pool at once.
    fn pour(&mut self, pool: u32, amount: Store) {
        let basins = Arc::clone(&self.basins);
        let (mut pool, mut amount) = (pool, amount);
        loop {
            let at = pool as usize;
            self.state.volumes[at].add_store(amount);
            let capacity = basins.basins()[at].volume_m3.unwrap_or(f64::INFINITY);
            if self.state.volumes[at].total() < capacity {
                return;
            }
            amount = self.state.volumes[at].cut_to(capacity);
            self.state.full[at] = true;
            if amount.total() <= 0.0 {
                self.state.volumes[at].add_store(amount);
                return;
            }
            if let Some((sibling, parent)) = self.full_sibling(pool) {
                self.unite(pool, sibling, parent);
                pool = parent;
            } else if let Some(leaf) = basins.basins()[at].overflows_to {
                pool = self.state.pool_of(&basins, leaf);
            } else {
                self.state.totals.left.add_store(amount);
                return;
            }
        }
    }
}
