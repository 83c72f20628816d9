//! Pores and film of one surface under rain and evaporation, the physical way.
//!
//! Rain fills the pores first, then the film. Within the texture depth the film only stands (and soaks into soil);
//! above it, it also drains by Manning's law ([`SurfaceProperties::drain_coefficient`]). Evaporation takes the film
//! first, then the pores. Forcing is constant over an interval, and the interval is split at every event (pores full,
//! film at the texture's brim, soil slower than the rain, film gone, pores empty), so the end state does not depend on
//! how an interval is cut: each piece is a closed form, or `film_flow` with its proven bound.
//!
//! # Accuracy
//! Pores take water without delay and dry at the potential rate to the end (drying stage one); real materials slow
//! down in stage two. The film is one depth, that at the foot of the flow path. The texture holds its water back
//! entirely until it evaporates or soaks away.

use serde::{Deserialize, Serialize};

use super::film_flow::FilmFlow;
use super::horton::HortonCurve;
use super::store::Store;
use super::surface_class::SurfaceProperties;
use crate::error::{ConfigError, in_range};

/// Longest interval that [`SurfaceColumn::advance`] takes at once. Units: s.
pub const MAX_INTERVAL_S: f64 = 1e9;

/// Largest supply or loss of a surface (more than rain alone: gutters, crowns). Units: mm/h.
pub const MAX_SURFACE_RATE_MM_H: f64 = 1e4;

/// What acts on a surface, constant over an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColumnForcing {
    /// Water that arrives. Units: mm/h. Domain: [0, 10000].
    pub rain_mm_h: f64,
    /// Evaporation where there is water. Units: mm/h. Domain: [0, 10000] (dew does not wet: clamp it).
    pub evaporation_mm_h: f64,
}

/// All water of a column, as plain numbers: for reports and snapshots. Depths are per plan area.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ColumnLedger {
    /// Water in the pores. Units: mm.
    pub pores_mm: f64,
    /// Water on the surface, texture included. Units: mm.
    pub film_mm: f64,
    /// Water that arrived since the start. Units: mm.
    pub rain_mm: f64,
    /// Water that evaporated. Units: mm.
    pub evaporated_mm: f64,
    /// Water that went into the ground. Units: mm.
    pub infiltrated_mm: f64,
    /// Water that ran off. Units: mm.
    pub drained_mm: f64,
    /// Position on Horton's curve. Units: s.
    pub horton_time_s: f64,
}

impl ColumnLedger {
    /// rain − (pores + film + evaporated + infiltrated + drained), relative to the rain (or to 1 µm). Units: none.
    /// Error: the ledger closes to 1e-12.
    #[must_use]
    pub fn residual_relative(&self) -> f64 {
        let out = self.pores_mm + self.film_mm + self.evaporated_mm + self.infiltrated_mm + self.drained_mm;
        (self.rain_mm - out).abs() / self.rain_mm.max(1e-3)
    }
}

/// The water of one surface. Starts dry. What is read from outside is checked by [`super::WeatherSurfaces::validated`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SurfaceColumn {
    pub(crate) pores: Store,
    pub(crate) film: Store,
    pub(crate) rain: Store,
    pub(crate) evaporated: Store,
    pub(crate) infiltrated: Store,
    pub(crate) drained: Store,
    pub(crate) tau: f64,
}

/// One interval's constants, in mm and s.
struct Interval<'a> {
    properties: &'a SurfaceProperties,
    soil: Option<HortonCurve>,
    rain: f64,
    evaporation: f64,
}

impl SurfaceColumn {
    /// A column with this water on a surface with these properties, its ledger starting with it.
    ///
    /// # Errors
    /// When an amount is negative or not finite, or the pores hold more than their capacity, or the ledger is open by
    /// more than 1e-9 of the rain.
    pub fn restore(ledger: ColumnLedger, properties: &SurfaceProperties) -> Result<Self, ConfigError> {
        properties.validated()?;
        let l = ledger;
        in_range(
            "pores_mm",
            l.pores_mm,
            0.0,
            properties.pore_capacity_mm,
            "0 mm to the pore capacity",
        )?;
        for (field, value) in [
            ("film_mm", l.film_mm),
            ("rain_mm", l.rain_mm),
            ("evaporated_mm", l.evaporated_mm),
            ("infiltrated_mm", l.infiltrated_mm),
            ("drained_mm", l.drained_mm),
            ("horton_time_s", l.horton_time_s),
        ] {
            in_range(field, value, 0.0, 1e12, "0 to 1e12")?;
        }
        in_range(
            "residual_relative",
            l.residual_relative(),
            0.0,
            1e-9,
            "a ledger that closes to 1e-9",
        )?;
        Ok(Self {
            pores: Store::new(l.pores_mm),
            film: Store::new(l.film_mm),
            rain: Store::new(l.rain_mm),
            evaporated: Store::new(l.evaporated_mm),
            infiltrated: Store::new(l.infiltrated_mm),
            drained: Store::new(l.drained_mm),
            tau: l.horton_time_s,
        })
    }

    /// A column with this water and an empty ledger.
    pub(crate) fn holding(pores_mm: f64, film_mm: f64, horton_time_s: f64) -> Self {
        Self {
            pores: Store::new(pores_mm),
            film: Store::new(film_mm),
            tau: horton_time_s,
            ..Self::default()
        }
    }

    /// Water in the pores. Units: mm. Domain: [0, pore capacity].
    #[must_use]
    pub fn pores_mm(&self) -> f64 {
        self.pores.total()
    }

    /// Mean film on the surface outside basins, with what the texture holds. Units: mm. Domain: ≥ 0.
    #[must_use]
    pub fn water_level_mm(&self) -> f64 {
        self.film.total()
    }

    /// Film above the texture: what flows, and what a tyre meets. Units: mm. Domain: ≥ 0.
    #[must_use]
    pub fn film_above_texture_mm(&self, properties: &SurfaceProperties) -> f64 {
        (self.film.total() - properties.texture_depth_mm).max(0.0)
    }

    /// Pore water / pore capacity. Units: none. Domain: [0, 1].
    #[must_use]
    pub fn wetness(&self, properties: &SurfaceProperties) -> f64 {
        (self.pores.total() / properties.pore_capacity_mm).clamp(0.0, 1.0)
    }

    /// Whether no water is left.
    #[must_use]
    pub fn is_dry(&self) -> bool {
        self.pores.total() <= 0.0 && self.film.total() <= 0.0
    }

    /// All amounts.
    #[must_use]
    pub fn ledger(&self) -> ColumnLedger {
        ColumnLedger {
            pores_mm: self.pores.total(),
            film_mm: self.film.total(),
            rain_mm: self.rain.total(),
            evaporated_mm: self.evaporated.total(),
            infiltrated_mm: self.infiltrated.total(),
            drained_mm: self.drained.total(),
            horton_time_s: self.tau,
        }
    }

    /// Every bit of the state in a fixed order, for hashes.
    #[must_use]
    pub fn state_bits(&self) -> [u64; 13] {
        let mut bits = [0; 13];
        let stores = [
            self.pores,
            self.film,
            self.rain,
            self.evaporated,
            self.infiltrated,
            self.drained,
        ];
        for (i, store) in stores.into_iter().enumerate() {
            let [high, low] = store.parts();
            (bits[2 * i], bits[2 * i + 1]) = (high.to_bits(), low.to_bits());
        }
        bits[12] = self.tau.to_bits();
        bits
    }

    /// Advances by `dt_s` under constant forcing. `dt_s` = 0 changes nothing.
    ///
    /// Error: any cut of an interval, from 1 ms to 1 h a step, ends within 1e-10 of each amount (or of 1e-2 mm); within
    /// 1e-6 of the reference in small steps, which is as far as those reach.
    ///
    /// # Errors
    /// When a rate or the time is not finite or outside its domain (time: [0, 1e9] s), or the properties are invalid.
    /// Then the column is as before.
    pub fn advance(
        &mut self,
        properties: &SurfaceProperties,
        forcing: ColumnForcing,
        dt_s: f64,
    ) -> Result<(), ConfigError> {
        const RATES: &str = "0 to 10000 mm/h";
        properties.validated()?;
        in_range("rain_mm_h", forcing.rain_mm_h, 0.0, MAX_SURFACE_RATE_MM_H, RATES)?;
        in_range(
            "evaporation_mm_h",
            forcing.evaporation_mm_h,
            0.0,
            MAX_SURFACE_RATE_MM_H,
            RATES,
        )?;
        in_range("dt_s", dt_s, 0.0, MAX_INTERVAL_S, "0 to 1e9 s")?;
        if dt_s == 0.0 || (forcing.rain_mm_h == 0.0 && self.is_dry() && self.tau == 0.0) {
            return Ok(());
        }
        let interval = Interval {
            properties,
            soil: properties
                .infiltration
                .is_permeable()
                .then(|| properties.infiltration.curve()),
            rain: forcing.rain_mm_h / 3600.0,
            evaporation: forcing.evaporation_mm_h / 3600.0,
        };
        self.fill_pores_from_film(properties.pore_capacity_mm);
        let mut left = dt_s;
        // Set once the soil cannot take the rain: it stays so under constant rain, rounding must not undo it.
        let mut ponding = false;
        // With constant forcing there are at most six events; the bound only ends a loop that rounding might cause.
        for _ in 0..32 {
            if left <= 0.0 {
                return Ok(());
            }
            left -= self.next_event(&interval, left, &mut ponding);
        }
        debug_assert!(left <= 1e-9 * dt_s, "{left} s of {dt_s} s not advanced: {self:?}");
        Ok(())
    }

    /// Water on top of thirsty pores (after a change of material) goes into them at once.
    fn fill_pores_from_film(&mut self, capacity: f64) {
        if self.pores.total() > capacity {
            let excess = self.pores.cut_to(capacity);
            self.film.add_store(excess);
        }
        if self.film.total() > 0.0 && self.pores.total() < capacity {
            let film = std::mem::take(&mut self.film);
            self.pores.add_store(film);
            if self.pores.total() > capacity {
                self.film = self.pores.cut_to(capacity);
            }
        }
    }

    /// Goes to the next event or to the end; returns the time used.
    fn next_event(&mut self, i: &Interval<'_>, left: f64, ponding: &mut bool) -> f64 {
        let supply = i.rain - i.evaporation;
        let full = self.pores.total() >= i.properties.pore_capacity_mm;
        if self.film.total() > 0.0 {
            return self.film_event(i, left, *ponding);
        }
        if !full || supply <= 0.0 {
            return self.pores_event(i, left);
        }
        match i.soil {
            Some(curve) if !*ponding && curve.capacity(self.tau) > supply => self.soak_event(i, curve, left, ponding),
            _ => self.film_event(i, left, true),
        }
    }

    /// No film: the pores fill or dry.
    fn pores_event(&mut self, i: &Interval<'_>, left: f64) -> f64 {
        let capacity = i.properties.pore_capacity_mm;
        let supply = i.rain - i.evaporation;
        let used;
        if supply > 0.0 {
            let to_full = (capacity - self.pores.total()) / supply;
            used = to_full.min(left);
            self.receive_into_pores(i, used);
            if to_full <= left {
                self.settle_pores(capacity);
            }
        } else if supply < 0.0 && self.pores.total() > 0.0 {
            let to_empty = self.pores.total() / -supply;
            used = to_empty.min(left);
            self.receive_into_pores(i, used);
            if to_empty <= left {
                // What rounding leaves has evaporated, too.
                let rest = self.pores.cut_to(0.0);
                self.evaporated.add_store(rest);
            }
        } else {
            // Dry under rain that evaporates at once, or rain and evaporation in balance.
            used = left;
            let amount = i.rain * used;
            self.rain.add(amount);
            self.evaporated.add(amount);
        }
        if let Some(curve) = i.soil {
            self.tau = curve.recovered(self.tau, used);
        }
        used
    }

    fn receive_into_pores(&mut self, i: &Interval<'_>, time: f64) {
        let (rain, evaporated) = (i.rain * time, i.evaporation * time);
        self.rain.add(rain);
        self.pores.add(rain);
        self.pores.add(-evaporated);
        self.evaporated.add(evaporated);
        // The last bit may fall outside.
        let inside = self.pores.total().clamp(0.0, i.properties.pore_capacity_mm);
        if self.pores.total() != inside {
            self.settle_pores(inside);
        }
    }

    /// Puts the pores exactly at `level`; the rounding difference is booked as rain that did or did not fall.
    fn settle_pores(&mut self, level: f64) {
        let excess = self.pores.cut_to(level);
        self.rain.add_store(excess.negated());
    }

    fn settle_film(&mut self, level: f64) {
        let excess = self.film.cut_to(level);
        self.rain.add_store(excess.negated());
    }

    /// No film, full pores: the soil takes all until its capacity has fallen to the supply.
    fn soak_event(&mut self, i: &Interval<'_>, curve: HortonCurve, left: f64, ponding: &mut bool) -> f64 {
        let supply = i.rain - i.evaporation;
        let ponds = curve
            .tau_at(self.tau, supply)
            .map(|tau| (tau, curve.depth(self.tau, tau - self.tau) / supply));
        let used = match ponds {
            Some((tau, time)) if time <= left => {
                self.tau = tau;
                *ponding = true;
                time
            }
            _ => {
                let advance = curve.time_for(self.tau, supply * left);
                self.tau = curve.advanced(self.tau, advance);
                left
            }
        };
        let (rain, evaporated) = (i.rain * used, i.evaporation * used);
        let mut soaked = Store::new(rain);
        soaked.add(-evaporated);
        self.rain.add(rain);
        self.evaporated.add(evaporated);
        self.infiltrated.add_store(soaked);
        used
    }

    /// Full pores and a film, or one about to form (`rising`).
    fn film_event(&mut self, i: &Interval<'_>, left: f64, rising: bool) -> f64 {
        let brim = i.properties.texture_depth_mm;
        let film = self.film.total();
        let slope = i.rain - i.evaporation - i.soil.map_or(0.0, |curve| curve.capacity(self.tau));
        if film > brim || (film == brim && slope >= 0.0) {
            return self.flow_event(i, left, brim);
        }
        self.texture_event(i, left, brim, rising)
    }

    /// Film within the texture: rises or falls without drain.
    fn texture_event(&mut self, i: &Interval<'_>, left: f64, brim: f64, rising: bool) -> f64 {
        let film = self.film.total();
        let supply = i.rain - i.evaporation;
        let level = |t: f64| film + supply * t - i.soil.map_or(0.0, |curve| curve.depth(self.tau, t));
        let slope = |t: f64| supply - i.soil.map_or(0.0, |curve| curve.capacity(self.tau + t));

        // The level is convex: it falls until the soil's capacity is down to the supply, then rises.
        let falls = slope(0.0) < 0.0 && !(rising && film == 0.0);
        let turn = match i.soil {
            _ if !falls => 0.0,
            Some(curve) => curve
                .tau_at(self.tau, supply)
                .map_or(f64::INFINITY, |tau| tau - self.tau),
            None => f64::INFINITY,
        };
        let low = turn.min(left);
        if falls && level(low) <= 0.0 {
            // Newton from the left stays left of the root of a falling convex function.
            let time = newton(0.0, low, |t| level(t) / slope(t));
            self.receive_into_film(i, time);
            let rest = self.film.cut_to(0.0);
            if i.soil.is_some() && rest.total() > 0.0 {
                self.infiltrated.add_store(rest);
            } else {
                self.rain.add_store(rest.negated());
            }
            return time;
        }
        if turn < left && level(left) >= brim {
            // Newton from the right stays right of the root of a rising convex function.
            let time = newton(left, low, |t| (level(t) - brim) / slope(t));
            self.receive_into_film(i, time);
            self.settle_film(brim);
            return time;
        }
        self.receive_into_film(i, left);
        if self.film.total() < 0.0 {
            self.settle_film(0.0);
        }
        left
    }

    fn receive_into_film(&mut self, i: &Interval<'_>, time: f64) {
        let (rain, evaporated) = (i.rain * time, i.evaporation * time);
        self.rain.add(rain);
        self.film.add(rain);
        self.film.add(-evaporated);
        self.evaporated.add(evaporated);
        if let Some(curve) = i.soil {
            let soaked = curve.depth(self.tau, time);
            self.film.add(-soaked);
            self.infiltrated.add(soaked);
            self.tau = curve.advanced(self.tau, time);
        }
    }

    /// Film above the texture: drains.
    fn flow_event(&mut self, i: &Interval<'_>, left: f64, brim: f64) -> f64 {
        let flow = FilmFlow {
            supply: i.rain - i.evaporation,
            drain: i.properties.drain_coefficient(),
            soil: i.soil.map(|curve| (curve, self.tau)),
        };
        let end = flow.run(self.film.total() - brim, left);
        self.receive_into_film(i, end.time);
        let drained = self.film.cut_to(brim + end.film);
        // Without drain the difference is rounding, of either sign.
        if drained.total() >= 0.0 {
            self.drained.add_store(drained);
        } else {
            self.rain.add_store(drained.negated());
        }
        end.time
    }
}

/// Newton from `start` with `ratio` = f/f′, kept between `start` and `end` (the far limit of the root).
fn newton(start: f64, end: f64, ratio: impl Fn(f64) -> f64) -> f64 {
    let (low, high) = if start < end { (start, end) } else { (end, start) };
    let mut t = start;
    for _ in 0..64 {
        let next = (t - ratio(t)).clamp(low, high);
        let done = (next - t).abs() <= 1e-16 * high;
        t = next;
        if done {
            break;
        }
    }
    t
}

#[cfg(test)]
#[path = "column_tests.rs"]
#[allow(
    clippy::disallowed_methods,
    reason = "an independent check uses std, not the maths under test"
)]
mod tests;
