//! The water in all basins and where all water went.

use serde::{Deserialize, Serialize};

use super::bake::Basins;
use crate::error::{ConfigError, in_range};
use crate::weather::store::Store;

/// The water in all basins, as plain data: save it, send it, restore it with [`super::BasinRun::restore`].
///
/// Every amount is a pair of doubles, so that small amounts are not lost in large ones.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BasinState {
    /// Water of each basin that is a pool of its own at present.
    pub(in crate::surface) volumes: Vec<Store>,
    /// Whether a basin's children are one pool (always, where there are none).
    pub(in crate::surface) united: Vec<bool>,
    /// Whether it stands at its spill level.
    pub(in crate::surface) full: Vec<bool>,
    pub(in crate::surface) totals: Totals,
}

/// All water that came and went.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::surface) struct Totals {
    pub(in crate::surface) rain: Store,
    pub(in crate::surface) added: Store,
    pub(in crate::surface) evaporated: Store,
    pub(in crate::surface) infiltrated: Store,
    pub(in crate::surface) drained: Store,
    pub(in crate::surface) left: Store,
    pub(in crate::surface) removed: Store,
}

/// All water since the start. Units: m³.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct BasinLedger {
    /// Rain on the pools and water from their catchments.
    pub rain_m3: f64,
    /// Added by [`super::BasinRun::add_water`].
    pub added_m3: f64,
    /// In the basins now.
    pub stored_m3: f64,
    /// Evaporated.
    pub evaporated_m3: f64,
    /// Seeped into the ground.
    pub infiltrated_m3: f64,
    /// Taken by inlets.
    pub drained_m3: f64,
    /// Overflowed off the map or into a hole.
    pub left_m3: f64,
    /// Taken by [`super::BasinRun::remove_water`].
    pub removed_m3: f64,
    /// |in − out − stored| / in, from the pairs of doubles (in: at least 1 mm³). Units: none.
    pub residual_relative: f64,
}

impl Totals {
    pub(in crate::surface) fn stores(&self) -> [Store; 7] {
        [
            self.rain,
            self.added,
            self.evaporated,
            self.infiltrated,
            self.drained,
            self.left,
            self.removed,
        ]
    }
}

impl BasinState {
    /// Dry basins.
    pub(in crate::surface) fn dry(basins: &Basins) -> Self {
        let count = basins.basins().len();
        Self {
            volumes: vec![Store::default(); count],
            united: basins.basins().iter().map(|basin| basin.children.is_none()).collect(),
            full: vec![false; count],
            totals: Totals::default(),
        }
    }

    /// Whether the basin is a pool of its own: its children are one, and it is not part of its parent.
    pub(in crate::surface) fn is_pool(&self, basins: &Basins, basin: u32) -> bool {
        let above = basins.basins()[basin as usize].parent;
        self.united[basin as usize] && above.is_none_or(|above| !self.united[above as usize])
    }

    /// The pool of which a leaf is part.
    pub(in crate::surface) fn pool_of(&self, basins: &Basins, leaf: u32) -> u32 {
        let mut at = leaf;
        loop {
            let basin = &basins.basins()[at as usize];
            match basin.parent {
                Some(parent) if self.united[parent as usize] => {
                    at = if self.united[basin.jump as usize] {
                        basin.jump
                    } else {
                        parent
                    };
                }
                _ => return at,
            }
        }
    }

    /// All amounts.
    pub(in crate::surface) fn ledger(&self, basins: &Basins) -> BasinLedger {
        let mut stored = Store::default();
        for basin in 0..self.volumes.len() as u32 {
            if self.is_pool(basins, basin) {
                stored.add_store(self.volumes[basin as usize]);
            }
        }
        let totals = &self.totals;
        let mut balance = totals.rain;
        balance.add_store(totals.added);
        let supplied = balance.total();
        for out in [
            stored,
            totals.evaporated,
            totals.infiltrated,
            totals.drained,
            totals.left,
            totals.removed,
        ] {
            balance.add_store(out.negated());
        }
        BasinLedger {
            rain_m3: totals.rain.total(),
            added_m3: totals.added.total(),
            stored_m3: stored.total(),
            evaporated_m3: totals.evaporated.total(),
            infiltrated_m3: totals.infiltrated.total(),
            drained_m3: totals.drained.total(),
            left_m3: totals.left.total(),
            removed_m3: totals.removed.total(),
            residual_relative: balance.total().abs() / supplied.max(1e-9),
        }
    }

    /// Whether this can be the state of these basins.
    pub(in crate::surface) fn validated(self, basins: &Basins) -> Result<Self, ConfigError> {
        let count = basins.basins().len();
        for (field, length) in [
            ("volumes.len()", self.volumes.len()),
            ("united.len()", self.united.len()),
            ("full.len()", self.full.len()),
        ] {
            if length != count {
                return Err(ConfigError::OutOfRange {
                    field,
                    value: length as f64,
                    allowed: "the number of basins",
                });
            }
        }
        for (index, basin) in basins.basins().iter().enumerate() {
            let united = self.united[index];
            let possible = match basin.children {
                None => united,
                Some(children) => !united || children.iter().all(|&child| self.united[child as usize]),
            };
            if !possible {
                return Err(ConfigError::OutOfRange {
                    field: "united",
                    value: index as f64,
                    allowed: "basins without children, and those whose children are united",
                });
            }
            if self.is_pool(basins, index as u32) {
                let curve = basins.curve(index as u32);
                let slack = 1e-9 * (1.0 + curve.base_volume);
                let brim = if curve.capacity.is_finite() {
                    curve.capacity
                } else {
                    1e18
                };
                // What is full stands at the brim; what cannot overflow is never full.
                let least = if self.full[index] {
                    curve.capacity
                } else {
                    curve.base_volume
                } - slack;
                let most = brim + slack;
                in_range(
                    "volume_m3",
                    self.volumes[index].total(),
                    least,
                    most,
                    "what the basin holds",
                )?;
            }
        }
        let ledger = self.ledger(basins);
        in_range(
            "residual_relative",
            ledger.residual_relative,
            0.0,
            1e-9,
            "a ledger that closes to 1e-9",
        )?;
        Ok(self)
    }
}
