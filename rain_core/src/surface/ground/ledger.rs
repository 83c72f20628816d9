//! Where all water came from and went to.

use serde::{Deserialize, Serialize};

use super::run::Ground;
use crate::weather::store::Store;

/// All water of a ground since its start. Units: m³.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct GroundLedger {
    /// Rain on the cells that have a ground, ∫ R A dt, what stands over them included.
    pub rain_m3: f64,
    /// Added by [`Ground::add_water`].
    pub added_m3: f64,
    /// In films, of the ground and of what stands over it.
    pub film_m3: f64,
    /// In pores, of the ground and of what stands over it.
    pub pores_m3: f64,
    /// In basins.
    pub basins_m3: f64,
    /// On its way: rain of the interval that its cells have not seen, runoff that its basin has not got.
    pub underway_m3: f64,
    /// Thrown up and not landed.
    pub airborne_m3: f64,
    /// Evaporated.
    pub evaporated_m3: f64,
    /// Gone into the soil.
    pub infiltrated_m3: f64,
    /// Run off the map or into a hole.
    pub off_map_m3: f64,
    /// Taken by inlets.
    pub inlets_m3: f64,
    /// Run off what stands over the ground.
    pub gutters_m3: f64,
    /// |in − out − stored| / in (in: at least 1 cm³), from sums that lose nothing to rounding. Units: none.
    pub residual_relative: f64,
}

impl GroundLedger {
    /// All water that came, rain and added. Units: m³.
    #[must_use]
    pub fn supplied_m3(&self) -> f64 {
        self.rain_m3 + self.added_m3
    }

    /// All water that ran off: the map, inlets, gutters. Units: m³.
    #[must_use]
    pub fn drained_m3(&self) -> f64 {
        self.off_map_m3 + self.inlets_m3 + self.gutters_m3
    }

    /// All water that is still there. Units: m³.
    #[must_use]
    pub fn stored_m3(&self) -> f64 {
        self.film_m3 + self.pores_m3 + self.basins_m3 + self.underway_m3 + self.airborne_m3
    }
}

/// Sums since the start. In mm times cells: what the cells of this grid did. In m³: everything else, and what cells and
/// basins did before the last change of the scene.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Totals {
    pub(super) cells_rain: Store,
    pub(super) cells_evaporated: Store,
    pub(super) cells_infiltrated: Store,
    pub(super) cells_off_map: Store,
    pub(super) cells_gutters: Store,
    pub(super) rain: Store,
    pub(super) added: Store,
    pub(super) airborne: Store,
    pub(super) evaporated: Store,
    pub(super) infiltrated: Store,
    pub(super) off_map: Store,
    pub(super) inlets: Store,
    pub(super) gutters: Store,
}

impl Totals {
    pub(super) fn stores(&self) -> [Store; 13] {
        [
            self.cells_rain,
            self.cells_evaporated,
            self.cells_infiltrated,
            self.cells_off_map,
            self.cells_gutters,
            self.rain,
            self.added,
            self.airborne,
            self.evaporated,
            self.infiltrated,
            self.off_map,
            self.inlets,
            self.gutters,
        ]
    }
}

/// The ledger as pairs of doubles. Units: m³.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Accounts {
    pub(super) rain: Store,
    pub(super) added: Store,
    pub(super) film: Store,
    pub(super) pores: Store,
    pub(super) basins: Store,
    pub(super) underway: Store,
    pub(super) airborne: Store,
    pub(super) evaporated: Store,
    pub(super) infiltrated: Store,
    pub(super) off_map: Store,
    pub(super) inlets: Store,
    pub(super) gutters: Store,
}

impl Ground {
    pub(super) fn accounts(&self) -> Accounts {
        let k = self.m3_per_mm();
        let sum = |a: Store, b: Store| {
            let mut sum = a;
            sum.add_store(b);
            sum
        };
        let t = &self.totals;
        let pending = self.pending_rain();
        let [ground_pores, ground_film] = self.cells.total();
        let [cover_pores, cover_film] = self.cover.columns.total();
        let basins = self.basins.state();
        let water = &basins.totals;
        let mut stored = Store::default();
        for basin in 0..basins.volumes.len() as u32 {
            if basins.is_pool(self.basins.basins(), basin) {
                stored.add_store(basins.volumes[basin as usize]);
            }
        }
        Accounts {
            rain: sum(t.rain, sum(t.cells_rain, pending).scaled(k)),
            added: t.added,
            film: sum(ground_film, cover_film).scaled(k),
            pores: sum(ground_pores, cover_pores).scaled(k),
            basins: stored,
            underway: sum(self.inflow.total(), pending).scaled(k),
            airborne: t.airborne,
            evaporated: sum(sum(t.evaporated, t.cells_evaporated.scaled(k)), water.evaporated),
            infiltrated: sum(sum(t.infiltrated, t.cells_infiltrated.scaled(k)), water.infiltrated),
            off_map: sum(sum(t.off_map, t.cells_off_map.scaled(k)), water.left),
            inlets: sum(t.inlets, water.drained),
            gutters: sum(t.gutters, t.cells_gutters.scaled(k)),
        }
    }

    /// Where all water came from and went to. Sums over all cells: for reports, not for every tick.
    ///
    /// Error: closes to 1e-12 of the water supplied at any moment.
    #[must_use]
    pub fn ledger(&self) -> GroundLedger {
        let a = self.accounts();
        let mut balance = a.rain;
        balance.add_store(a.added);
        let supplied = balance.total();
        for out in [
            a.film,
            a.pores,
            a.basins,
            a.underway,
            a.airborne,
            a.evaporated,
            a.infiltrated,
            a.off_map,
            a.inlets,
            a.gutters,
        ] {
            balance.add_store(out.negated());
        }
        GroundLedger {
            rain_m3: a.rain.total(),
            added_m3: a.added.total(),
            film_m3: a.film.total(),
            pores_m3: a.pores.total(),
            basins_m3: a.basins.total(),
            underway_m3: a.underway.total(),
            airborne_m3: a.airborne.total(),
            evaporated_m3: a.evaporated.total(),
            infiltrated_m3: a.infiltrated.total(),
            off_map_m3: a.off_map.total(),
            inlets_m3: a.inlets.total(),
            gutters_m3: a.gutters.total(),
            residual_relative: balance.total().abs() / supplied.max(1e-6),
        }
    }
}
