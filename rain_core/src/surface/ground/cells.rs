//! Pores and film of the cells over one interval.
//!
//! Most cells of a class have had the same weather and hold the same water to the last bit: what one such cell does is
//! computed once ([`Memo`]).

use serde::{Deserialize, Serialize};

use super::run::FULL;
use crate::weather::store::Store;
use crate::weather::{ColumnForcing, SurfaceClass, SurfaceColumn, SurfaceProperties};

/// Remembered results; a power of two.
const MEMO_ENTRIES: usize = 512;

/// Water of many columns, and the soil's place on Horton's curve. Units: mm, s.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Columns {
    pub(super) pores: Vec<f64>,
    pub(super) film: Vec<f64>,
    pub(super) tau: Vec<f64>,
}

impl Columns {
    pub(super) fn dry(count: usize) -> Self {
        Self {
            pores: vec![0.0; count],
            film: vec![0.0; count],
            tau: vec![0.0; count],
        }
    }

    pub(super) fn is_wet(&self, at: usize) -> bool {
        self.pores[at] > 0.0 || self.film[at] > 0.0
    }

    /// All pore water and all film. Units: mm times cells.
    pub(super) fn total(&self) -> [Store; 2] {
        [&self.pores, &self.film].map(|values| {
            let mut sum = Store::default();
            values.iter().for_each(|&v| sum.add(v));
            sum
        })
    }

    pub(super) fn for_each_bits(&self, put: &mut impl FnMut(u64)) {
        for values in [&self.pores, &self.film, &self.tau] {
            values.iter().for_each(|v| put(v.to_bits()));
        }
    }

    /// Sets the water of a cell; returns what is there now more than before, exactly. Units: mm.
    pub(super) fn set(&mut self, at: usize, pores: f64, film: f64) -> Store {
        let mut more = Store::new(pores);
        more.add(-self.pores[at]);
        more.add(film);
        more.add(-self.film[at]);
        (self.pores[at], self.film[at]) = (pores, film);
        more
    }

    /// Writes a column back; what its last bits do not hold is returned, so that nothing is lost. Units: mm.
    pub(super) fn put(&mut self, at: usize, column: &SurfaceColumn) -> f64 {
        self.pores[at] = column.pores.total();
        self.film[at] = column.film.total();
        self.tau[at] = column.tau;
        column.pores.parts()[1] + column.film.parts()[1]
    }
}

/// What acts over an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Interval {
    /// Over open ground.
    pub(super) rain_mm_h: f64,
    pub(super) evaporation_mm_h: f64,
    pub(super) time_s: f64,
}

impl Interval {
    /// Over open ground where `local`/65535 of the rain falls. The full rain is that itself.
    pub(super) fn local_mm_h(&self, local: u16) -> f64 {
        if local == FULL {
            self.rain_mm_h
        } else {
            self.rain_mm_h * (f64::from(local) / f64::from(FULL))
        }
    }
}

/// What a result depends on, beside the interval: pores, film, τ, class and shares.
type Key = [u64; 4];

/// Results of columns under one interval.
#[derive(Debug, Clone)]
pub(super) struct Memo {
    keys: Vec<Key>,
    results: Vec<SurfaceColumn>,
    used: Vec<u32>,
    round: u32,
}

impl Memo {
    pub(super) fn new() -> Self {
        Self {
            keys: vec![[0; 4]; MEMO_ENTRIES],
            results: vec![SurfaceColumn::default(); MEMO_ENTRIES],
            used: vec![0; MEMO_ENTRIES],
            round: 0,
        }
    }

    /// Forgets all: another interval begins.
    pub(super) fn begin(&mut self) {
        self.round = self.round.wrapping_add(1);
        if self.round == 0 {
            self.used.fill(0);
            self.round = 1;
        }
    }

    /// The column after the interval, under `share`/255 of the rain that falls there, which is `local`/65535 of the
    /// interval's; its ledger is that of the interval.
    pub(super) fn advanced(
        &mut self,
        properties: &[SurfaceProperties; SurfaceClass::COUNT],
        class: u8,
        (share, local): (u8, u16),
        [pores, film, tau]: [f64; 3],
        interval: &Interval,
    ) -> &SurfaceColumn {
        let key = [
            pores.to_bits(),
            film.to_bits(),
            tau.to_bits(),
            u64::from(FULL - local) << 16 | u64::from(class) << 8 | u64::from(share),
        ];
        let mut hash = 0_u64;
        for word in key {
            hash = (hash.rotate_left(23) ^ word).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        }
        let slot = (hash >> 32) as usize & (MEMO_ENTRIES - 1);
        if self.used[slot] != self.round || self.keys[slot] != key {
            let mut column = SurfaceColumn::holding(pores, film, tau);
            let forcing = ColumnForcing {
                rain_mm_h: interval.local_mm_h(local) * (f64::from(share) / 255.0),
                evaporation_mm_h: interval.evaporation_mm_h,
            };
            let properties = &properties[usize::from(class).min(SurfaceClass::COUNT - 1)];
            let done = column.advance(properties, forcing, interval.time_s);
            debug_assert!(done.is_ok(), "{done:?}");
            self.keys[slot] = key;
            self.results[slot] = column;
            self.used[slot] = self.round;
        }
        &self.results[slot]
    }
}
