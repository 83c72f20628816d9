//! Water underway from the cells to the basins.
//!
//! What the cells of an interval give is handed to the basins in equal parts over the next one, so that levels move
//! smoothly although cells are advanced in turns.

use serde::{Deserialize, Serialize};

use crate::error::ConfigError;
use crate::surface::basins::BasinRun;
use crate::weather::store::Store;

/// Less than this waits for more: what rounding leaves. Units: mm times cells.
const LEAST: f64 = 1e-9;

/// Water for the basins without children, by basin. Units: mm times cells.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Inflow {
    /// Of this interval.
    pub(super) gathered: Vec<Store>,
    /// Of the last one, less what was handed over.
    pub(super) due: Vec<Store>,
    /// Parts in which `due` will be handed over.
    pub(super) parts: u32,
    /// What the soil under pools will take. Units: m³.
    pub(super) demand: Vec<f64>,
}

impl Inflow {
    pub(super) fn none(basins: usize) -> Self {
        Self {
            gathered: vec![Store::default(); basins],
            due: vec![Store::default(); basins],
            parts: 0,
            demand: vec![0.0; basins],
        }
    }

    /// Whether nothing that counts is underway.
    pub(super) fn is_empty(&self) -> bool {
        let none = |stores: &[Store]| stores.iter().all(|s| s.total() <= LEAST);
        none(&self.gathered) && none(&self.due)
    }

    /// An interval ends: what it gave is due in so many parts.
    pub(super) fn gather(&mut self, parts: u32) {
        for (due, gathered) in self.due.iter_mut().zip(&mut self.gathered) {
            due.add_store(std::mem::take(gathered));
        }
        self.parts = parts;
    }

    /// Hands one part over; a cell and a millimetre are `m3_per_mm`.
    pub(super) fn release(&mut self, basins: &mut BasinRun, m3_per_mm: f64) -> Result<bool, ConfigError> {
        if self.parts == 0 {
            return Ok(false);
        }
        let mut any = false;
        for basin in 0..self.due.len() {
            let due = &mut self.due[basin];
            if due.total() <= LEAST {
                continue;
            }
            let part = due.total() / f64::from(self.parts);
            let pit = basins.basins().basins()[basin].pit_cell as usize;
            basins.add_water(pit, part * m3_per_mm)?;
            due.add(-part);
            any = true;
        }
        self.parts -= 1;
        Ok(any)
    }

    /// Lets the soil under pools take its water; returns what it got. Units: m³.
    pub(super) fn soak(&mut self, basins: &mut BasinRun) -> Result<f64, ConfigError> {
        let mut taken = 0.0;
        for basin in 0..self.demand.len() {
            let demand = std::mem::take(&mut self.demand[basin]);
            if demand > 0.0 {
                let pit = basins.basins().basins()[basin].pit_cell as usize;
                taken += basins.remove_water(pit, demand)?;
            }
        }
        Ok(taken)
    }

    /// Everything underway. Units: mm times cells.
    pub(super) fn total(&self) -> Store {
        let mut sum = Store::default();
        for store in self.gathered.iter().chain(&self.due) {
            sum.add_store(*store);
        }
        sum
    }

    pub(super) fn for_each_bits(&self, put: &mut impl FnMut(u64)) {
        for store in self.gathered.iter().chain(&self.due) {
            store.parts().iter().for_each(|v| put(v.to_bits()));
        }
        self.demand.iter().for_each(|v| put(v.to_bits()));
        put(u64::from(self.parts));
    }
}
