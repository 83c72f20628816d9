//! From mass per second to particles, within a budget and without losing water.

use crate::error::clamped;

/// Mass that each particle must stand for so that no more than `budget` are alive at once. Units: kg.
///
/// `flow_kg_s` in kg/s, held in [0, 1e6]; `life_s` in s, held in [0, 1e4]; `budget` in particles, at least 1;
/// `least_kg`: mass below which a particle is not split further, held in [1e-12, 1e3] (one drop, for instance). What is
/// not a number counts as the lower end.
///
/// Error: 1e-15 relative.
#[must_use]
pub fn spray_parcel_kg(flow_kg_s: f64, life_s: f64, budget: u32, least_kg: f64) -> f64 {
    let alive = clamped(flow_kg_s, 0.0, 1e6) * clamped(life_s, 0.0, 1e4);
    (alive / f64::from(budget.max(1))).max(clamped(least_kg, 1e-12, 1e3))
}

/// Turns a flow into whole parcels; what is not yet a parcel waits.
///
/// Everything that came in = parcels · their mass + pending, at any step.
///
/// Error: 1e-12 of the mass.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SprayEmitter {
    pending_kg: f64,
}

impl SprayEmitter {
    /// Adds `flow_kg_s` over `dt_s` and returns how many parcels of `parcel_kg` leave.
    ///
    /// Flow held in [0, 1e6] kg/s, time in [0, 1e9] s; what is not a number counts as 0, a parcel that is not above 0
    /// lets nothing leave. At most 2³² − 1 parcels leave at once, the rest waits.
    pub fn advance(&mut self, flow_kg_s: f64, dt_s: f64, parcel_kg: f64) -> u32 {
        self.pending_kg += clamped(flow_kg_s, 0.0, 1e6) * clamped(dt_s, 0.0, 1e9);
        if !(parcel_kg > 0.0 && parcel_kg.is_finite()) {
            return 0;
        }
        let count = (self.pending_kg / parcel_kg).floor().min(f64::from(u32::MAX));
        self.pending_kg = (self.pending_kg - count * parcel_kg).max(0.0);
        count as u32
    }

    /// Mass that waits. Units: kg.
    #[must_use]
    pub fn pending_kg(&self) -> f64 {
        self.pending_kg
    }

    /// Takes what waits, for the film or another wheel. Units: kg.
    pub fn take(&mut self) -> f64 {
        core::mem::take(&mut self.pending_kg)
    }
}
