//! [`SurfaceColumn`](super::SurfaceColumn) in single precision, for grids: pores, film and soil clock, no ledger.
//!
//! The same balance and the same order of events, in plain arithmetic that has a twin in WGSL
//! (`rain_render/shaders/lib/water_column.wgsl`). Pores and a film within the texture are straight lines between events.
//! A film above the texture, dw/dt = supply − κ w^(5/3), goes in steps of the classical Runge–Kutta method (Kutta 1901)
//! over at most 0.4 decay times, while drain rules in steps of its closed form (see [`crate::surface::drained_film_f32`]),
//! and near its equilibrium as the exponential of the linear equation, whatever the time. Soil takes its mean capacity of
//! pieces in which it falls by at most 3 %.
//!
//! # Accuracy
//! Single precision adds the roundings of many short steps: each loses up to 3e-8 of what is there. Advance when a
//! visible amount has gathered (some µm), not every frame.

use super::surface_class::SurfaceProperties;
use crate::error::clamped_f32;
use crate::ops;

/// Pieces of an interval at most; the last one takes what is left.
const PIECES: u32 = 64;
/// Steps of a film in a piece at most.
const FILM_STEPS: u32 = 64;
/// Decay times in a step of Runge and Kutta.
const DECAYS: f32 = 0.4;
/// Relative distance from equilibrium below which the linear equation is taken.
const NEAR: f32 = 0.01;
/// Drain over supply from which on the drain's closed form is taken.
const DRAIN_RULES: f32 = 1000.0;
/// Part by which the soil's capacity may fall in a piece.
const SOIL_PART: f32 = 0.03;
/// kτ at which the soil's clock stops.
const MAX_DECAYS: f32 = 30.0;

/// What a surface does with water, in mm and s.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ColumnRules {
    /// What the pores hold. Units: mm.
    pub capacity_mm: f32,
    /// What the texture holds. Units: mm.
    pub texture_mm: f32,
    /// κ of the drain. Units: mm^(−2/3)/s.
    pub drain: f32,
    /// Infiltration in the long run. Units: mm/s.
    pub soil_mm_s: f32,
    /// What dry soil takes beyond that; 0 with `soil_mm_s` = 0: nothing infiltrates. Units: mm/s.
    pub dry_soil_mm_s: f32,
    /// Decay of the capacity. Units: 1/s.
    pub soil_decay_per_s: f32,
    /// Recovery in dry spells. Units: 1/s.
    pub recovery_per_s: f32,
}

impl From<&SurfaceProperties> for ColumnRules {
    fn from(properties: &SurfaceProperties) -> Self {
        let soil = properties.infiltration.curve();
        Self {
            capacity_mm: properties.pore_capacity_mm as f32,
            texture_mm: properties.texture_depth_mm as f32,
            drain: properties.drain_coefficient() as f32,
            soil_mm_s: soil.floor as f32,
            dry_soil_mm_s: soil.extra as f32,
            soil_decay_per_s: soil.decay as f32,
            recovery_per_s: soil.recovery as f32,
        }
    }
}

impl ColumnRules {
    fn is_permeable(&self) -> bool {
        self.soil_mm_s + self.dry_soil_mm_s > 0.0
    }

    /// Infiltration capacity at τ. Units: mm/s.
    fn capacity(&self, tau: f32) -> f32 {
        self.soil_mm_s + self.dry_soil_mm_s * ops::expf(-self.soil_decay_per_s * tau)
    }

    /// What infiltrates at capacity from τ to τ + t. Units: mm.
    fn depth(&self, tau: f32, t: f32) -> f32 {
        let extra = self.dry_soil_mm_s * ops::expf(-self.soil_decay_per_s * tau);
        t * (self.soil_mm_s + extra * mean_decay(self.soil_decay_per_s * t))
    }

    fn clock_after(&self, tau: f32, t: f32) -> f32 {
        (tau + t).min(MAX_DECAYS / self.soil_decay_per_s)
    }

    /// The τ at which the capacity has fallen to `supply`, and when that is if the soil takes all until then.
    fn ponds(&self, tau: f32, supply: f32) -> (f32, f32) {
        if supply <= self.soil_mm_s {
            return (tau, f32::INFINITY);
        }
        let at = -ops::lnf((supply - self.soil_mm_s) / self.dry_soil_mm_s) / self.soil_decay_per_s;
        let at = self.clock_after(at.max(tau), 0.0);
        (at, self.depth(tau, at - tau) / supply)
    }

    /// τ after `t` without infiltration.
    fn recovered(&self, tau: f32, t: f32) -> f32 {
        if tau <= 0.0 || self.recovery_per_s <= 0.0 {
            return tau;
        }
        let (k, x) = (self.soil_decay_per_s, self.recovery_per_s * t);
        // Share of the capacity that is back.
        let back = x * mean_decay(x);
        let dry = ops::expf(-k * tau);
        if k * tau < 0.5 && x < 0.01 {
            // The logarithm of nearly 1 would cancel.
            let grown = tau * (1.0 + 0.5 * k * tau * (1.0 + k * tau / 3.0 * (1.0 + 0.25 * k * tau)));
            return (tau - back * grown).max(0.0);
        }
        (-ops::lnf(dry + (1.0 - dry) * back) / k).max(0.0)
    }
}

/// (1 − e^(−x))/x for x ≥ 0.
fn mean_decay(x: f32) -> f32 {
    if x < 0.1 {
        return 1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0)));
    }
    (1.0 - ops::expf(-x)) / x
}

/// w^(2/3) for w ≥ 0.
fn cbrt_square(w: f32) -> f32 {
    let c = ops::cbrtf(w);
    c * c
}

/// Water of a texel.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ColumnF32 {
    /// Water in the pores. Units: mm.
    pub pores_mm: f32,
    /// Water on the surface, texture included. Units: mm.
    pub film_mm: f32,
    /// Place on Horton's curve, τ. Units: s.
    pub soil_s: f32,
}

impl ColumnF32 {
    /// The column after `dt_s` (units: s) under constant rain and evaporation (units: mm/h). What is outside its domain
    /// is moved there: rates to [0, 10000] mm/h, times to [0, 1e9] s, water to [0, 1e6] mm; NaN counts as 0.
    ///
    /// Error: against the column in double precision, relative to what is there (or to 0.1 mm): 1e-3 in an interval of up
    /// to a minute, 3e-3 in one of up to an hour, of τ (or of 10 s) 1e-2; over a day of changing weather in steps of 0.25
    /// to 10 s 1e-3.
    #[must_use]
    pub fn advanced(self, rules: &ColumnRules, rain_mm_h: f32, evaporation_mm_h: f32, dt_s: f32) -> Self {
        let rain = clamped_f32(rain_mm_h, 0.0, 1e4) / 3600.0;
        let supply = rain - clamped_f32(evaporation_mm_h, 0.0, 1e4) / 3600.0;
        let mut left = clamped_f32(dt_s, 0.0, 1e9);
        let mut pores = clamped_f32(self.pores_mm, 0.0, 1e6);
        let mut film = clamped_f32(self.film_mm, 0.0, 1e6);
        let mut tau = clamped_f32(self.soil_s, 0.0, 1e9);
        let (capacity, brim) = (rules.capacity_mm, rules.texture_mm);
        let soil = rules.is_permeable();
        // Once the soil cannot take the rain it stays so: rounding must not undo it.
        let mut ponding = false;
        // Water on top of thirsty pores goes into them at once.
        film += (pores - capacity).max(0.0);
        pores = pores.min(capacity);
        let thirst = film.min(capacity - pores);
        pores = if thirst < film { capacity } else { pores + thirst };
        film -= thirst;
        for piece in 0..PIECES {
            if left <= 0.0 {
                break;
            }
            if film <= 0.0 && (pores < capacity || supply <= 0.0) {
                let mut used = left;
                if supply > 0.0 {
                    let to_full = (capacity - pores) / supply;
                    used = to_full.min(left);
                    pores = if to_full <= left {
                        capacity
                    } else {
                        pores + supply * used
                    };
                } else {
                    pores = (pores + supply * used).max(0.0);
                }
                if soil {
                    tau = rules.recovered(tau, used);
                }
                left -= used;
                continue;
            }
            let mut h = left;
            let mut soaked = 0.0;
            if soil {
                h = left.min((SOIL_PART / rules.soil_decay_per_s).max(left / (PIECES - piece) as f32));
                let most = rules.capacity(tau);
                if film <= 0.0 && !ponding && most > supply {
                    // The soil takes all, until its capacity has fallen to the supply.
                    let (ponds, time) = rules.ponds(tau, supply);
                    if time <= h {
                        (tau, ponding) = (ponds, true);
                        left -= time;
                    } else {
                        let mut t = supply * h / most;
                        t += (supply * h - rules.depth(tau, t)) / rules.capacity(tau + t);
                        tau = rules.clock_after(tau, t);
                        left -= h;
                    }
                    continue;
                }
                soaked = rules.depth(tau, h) / h;
            }
            let net = supply - soaked;
            let mut used = h;
            if film > brim || (film == brim && net >= 0.0) {
                let (time, over) = flow(film - brim, net, rules.drain, h);
                (used, film) = (time, brim + over);
            } else if net > 0.0 {
                let mut to_brim = (brim - film) / net;
                if soil && to_brim < h {
                    to_brim += (brim - film - supply * to_brim + rules.depth(tau, to_brim)) / net;
                }
                used = to_brim.min(h);
                film = if to_brim <= h { brim } else { film + net * used };
            } else if net < 0.0 {
                let mut to_empty = film / -net;
                if soil && to_empty < h {
                    to_empty -= (film + supply * to_empty - rules.depth(tau, to_empty)) / net;
                }
                used = to_empty.min(h);
                film = if to_empty <= h { 0.0 } else { film + net * used };
            }
            if soil {
                tau = rules.clock_after(tau, used);
            }
            left -= used;
        }
        Self {
            pores_mm: pores,
            film_mm: film,
            soil_s: tau,
        }
    }
}

/// Film `w` above the texture under a constant net supply for `left`: time used (less if it runs out) and film then.
fn flow(w: f32, net: f32, drain: f32, left: f32) -> (f32, f32) {
    if drain <= 0.0 {
        let end = w + net * left;
        return if end < 0.0 { (w / -net, 0.0) } else { (left, end) };
    }
    let (mut w, mut t) = (w, 0.0);
    let balance = if net > 0.0 {
        let c = ops::expf(0.2 * ops::lnf(net / drain));
        c * c * c
    } else {
        0.0
    };
    for step in 0..FILM_STEPS {
        let rest = left - t;
        if rest <= 0.0 {
            break;
        }
        let root = cbrt_square(w);
        let out = drain * w * root;
        if out > DRAIN_RULES * net.abs() || step == FILM_STEPS - 1 {
            // To a half: (2^(2/3) − 1)·3/2 drain times.
            let h = if step == FILM_STEPS - 1 {
                rest
            } else {
                rest.min(0.88 / (drain * root))
            };
            let half = (w + 0.5 * net * h).max(0.0);
            let x = 1.0 + 2.0 / 3.0 * drain * h * cbrt_square(half);
            w = (half / (x * x.sqrt()) + 0.5 * net * h).max(0.0);
            t += h;
            continue;
        }
        if net > 0.0 && (w - balance).abs() <= NEAR * balance {
            w = balance + (w - balance) * ops::expf(-5.0 / 3.0 * net / balance * rest);
            return (left, w);
        }
        if net < 0.0 && out <= -net {
            // Time to empty, ∫dx/(−net + κ x^(5/3)), by Gauss and Legendre's three points.
            let slowness = |share: f32| {
                let x = share * w;
                1.0 / (drain * x * cbrt_square(x) - net)
            };
            let ends = slowness(0.112_701_67) + slowness(0.887_298_35);
            let gone = w / 18.0 * (5.0 * ends + 8.0 * slowness(0.5));
            if gone <= rest {
                return (t + gone, 0.0);
            }
        }
        let most = w.max(balance.min(w + net.max(0.0) * rest));
        let h = rest.min(DECAYS / (5.0 / 3.0 * drain * cbrt_square(most)).max(1e-12));
        let rate = |w: f32| {
            let w = w.max(0.0);
            net - drain * w * cbrt_square(w)
        };
        let first = rate(w);
        let second = rate(w + 0.5 * h * first);
        let third = rate(w + 0.5 * h * second);
        let last = rate(w + h * third);
        w = (w + h / 6.0 * (first + 2.0 * second + 2.0 * third + last)).max(0.0);
        t += h;
    }
    (left, w)
}

#[cfg(test)]
#[path = "column_f32_tests.rs"]
mod tests;
