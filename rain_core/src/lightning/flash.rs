//! Flashes as a pure function of seed and time, and the current of their strokes.

use core::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::draws::Draws;
use super::settings::LightningSettings;
use crate::error::clamped;
use crate::ops;

/// Most strokes of a flash.
pub const MAX_STROKES: usize = 15;
/// No flash lasts longer. Units: s.
pub const LONGEST_FLASH_S: f64 = 4.0;

/// Chance that a stroke is followed by another: 4 strokes on average (Thomson et al. 1984), each number less likely than
/// the one below by the same factor.
const ANOTHER: f64 = 0.75;
/// Median time between strokes, and its deviation. Units: s, decades. Source: Thomson et al. 1984.
const BETWEEN_STROKES: (f64, f64) = (0.069, 0.32);
/// Median peak current of first and of later strokes, and its deviation. Units: A, decades. Source: Berger et al. 1975.
const FIRST_A: (f64, f64) = (30e3, 0.26);
const LATER_A: (f64, f64) = (12e3, 0.26);
/// Share of strokes that a continuing current follows, and its median length and deviation: a third of the flashes has
/// one (Rakov & Uman 2003). Units: none, s, decades.
const CONTINUED: f64 = 0.12;
const CONTINUING_S: (f64, f64) = (0.1, 0.2);
/// Of flashes that stay in the cloud: mean further pulses, time between them and peaks. Units: none, (s, decades), (A,
/// decades). A choice: a third of a second of flicker, as much light as a flash to the ground.
const CLOUD_ANOTHER: f64 = 0.9;
const BETWEEN_PULSES: (f64, f64) = (0.025, 0.3);
const PULSE_A: (f64, f64) = (6e3, 0.3);

/// Decay of a stroke's current: its luminous pulse lasts 0.15 ms (Guo & Krider 1982). Units: s.
const FAST_S: f64 = 150e-6;
/// Current of the milliseconds after it, as a share of the peak, and its decay: 1 kA for some ms (Rakov & Uman 2003).
const SLOW_SHARE: f64 = 1.0 / 30.0;
const SLOW_S: f64 = 2e-3;
/// Continuing current. Units: A. Source: Rakov & Uman 2003.
const CONTINUING_A: f64 = 100.0;

/// Where a flash ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FlashKind {
    /// From the cloud to the ground, with a channel that is seen.
    ToGround,
    /// Within the cloud: only its glow is seen.
    InCloud,
}

/// A return stroke, or a pulse within the cloud.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stroke {
    /// After the flash's start. Units: s.
    pub after_s: f64,
    /// Peak current. Units: A.
    pub peak_a: f64,
    /// How long a current of 100 A goes on. Units: s.
    pub continuing_s: f64,
}

/// One flash of lightning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flash {
    /// Different for every flash of a seed.
    pub id: u64,
    /// Start of the first stroke on the rain clock. Units: s.
    pub time_s: f64,
    /// Where it ends.
    pub kind: FlashKind,
    /// The point struck, or the ground under its start within the cloud. World coordinates, m.
    pub place_m: DVec3,
    /// Height of the cloud's base over that ground. Units: m.
    pub cloud_base_m: f64,
    /// Its strokes, in order; those behind `stroke_count` are empty.
    strokes: [Stroke; MAX_STROKES],
    stroke_count: usize,
    seed: u64,
}

/// Visits the flashes that start in [from_s, to_s), in order of second and rank.
///
/// Flashes are a Poisson process in time, one hash a second, evenly over the disc of `settings` (validated). Times before
/// 0 have none; nor has an interval that is not finite or longer than 10⁷ s.
///
/// Error: exact, hashes; counts are Poisson's within five standard deviations.
pub fn for_each_flash(settings: &LightningSettings, seed: u64, from_s: f64, to_s: f64, mut visit: impl FnMut(Flash)) {
    let mean = settings.flashes_per_s();
    let from_s = clamped(from_s, 0.0, 1e12);
    if !(mean > 0.0 && to_s > from_s && to_s - from_s <= 1e7) {
        return;
    }
    let mut second = from_s as u64;
    while (second as f64) < to_s {
        let mut draws = Draws::new(seed, second, 0);
        let mut rank = draws.exponential();
        let mut index = 0;
        while rank < mean {
            let time_s = second as f64 + draws.unit();
            if (from_s..to_s).contains(&time_s) {
                visit(Flash::new(settings, seed, second * 64 + index, time_s));
            }
            rank += draws.exponential();
            // 47 are the mean of the wildest storm.
            index = (index + 1).min(63);
        }
        second += 1;
    }
}

impl Flash {
    fn new(settings: &LightningSettings, seed: u64, id: u64, time_s: f64) -> Self {
        let mut draws = Draws::new(seed, id, 1);
        let kind = if draws.unit() < settings.ground_share {
            FlashKind::ToGround
        } else {
            FlashKind::InCloud
        };
        let nearest = match kind {
            FlashKind::ToGround => {
                let share = settings.nearest_m / settings.radius_m;
                share * share
            }
            FlashKind::InCloud => 0.0,
        };
        let radius = settings.radius_m * ops::sqrt(draws.between(nearest, 1.0));
        let angle = TAU * draws.unit();
        let at = settings.centre_at(time_s) + radius * DVec2::new(ops::cos(angle), ops::sin(angle));
        let mut flash = Self {
            id,
            time_s,
            kind,
            place_m: DVec3::new(at.x, settings.ground_m, at.y),
            cloud_base_m: settings.cloud_base_m,
            strokes: [Stroke::default(); MAX_STROKES],
            stroke_count: 0,
            seed,
        };
        flash.draw_strokes(&mut draws);
        flash
    }

    fn draw_strokes(&mut self, draws: &mut Draws) {
        let (another, between, first, later) = match self.kind {
            FlashKind::ToGround => (ANOTHER, BETWEEN_STROKES, FIRST_A, LATER_A),
            FlashKind::InCloud => (CLOUD_ANOTHER, BETWEEN_PULSES, PULSE_A, PULSE_A),
        };
        let mut after_s = 0.0;
        loop {
            let (median, decades) = if self.stroke_count == 0 { first } else { later };
            let peak_a = draws.lognormal(median, decades).min(300e3);
            let gap_s = draws.lognormal(between.0, between.1).clamp(0.002, 1.0);
            let continuing_s = match self.kind {
                FlashKind::ToGround if draws.unit() < CONTINUED => {
                    draws.lognormal(CONTINUING_S.0, CONTINUING_S.1).min(0.5)
                }
                FlashKind::ToGround => 0.0,
                // A leader creeps on between the pulses.
                FlashKind::InCloud => gap_s,
            };
            self.strokes[self.stroke_count] = Stroke {
                after_s,
                peak_a,
                continuing_s,
            };
            self.stroke_count += 1;
            // The next stroke ends a continuing current.
            after_s += gap_s.max(continuing_s);
            let over = after_s + 0.5 > LONGEST_FLASH_S;
            if self.stroke_count == MAX_STROKES || over || draws.unit() >= another {
                return;
            }
        }
    }

    /// Its strokes, or the pulses within the cloud, in order; never empty.
    #[must_use]
    pub fn strokes(&self) -> &[Stroke] {
        &self.strokes[..self.stroke_count]
    }

    /// Seed of its path.
    pub(super) fn draws(&self) -> Draws {
        Draws::new(self.seed, self.id, 2)
    }

    /// When its light has gone, after its start; at most [`LONGEST_FLASH_S`]. Units: s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        let last = self.strokes()[self.stroke_count - 1];
        last.after_s + last.continuing_s.max(10.0 * SLOW_S)
    }

    /// Mean currents over an interval of the rain clock (s): of the whole channel, and of the first stroke alone, which
    /// is the one that branches share. Units: A. 0 for an interval of no length.
    ///
    /// Each stroke decays as e^(−t/0.15 ms) with a tail of a thirtieth of it, e^(−t/2 ms), and a continuing current of
    /// 100 A if it has one. Error: 1e-8 of the peak against fine sums.
    #[must_use]
    pub fn mean_current_a(&self, from_s: f64, to_s: f64) -> [f64; 2] {
        let length = to_s - from_s;
        if !(length > 0.0 && length.is_finite()) {
            return [0.0; 2];
        }
        let mut all = 0.0;
        let mut first = 0.0;
        for (index, stroke) in self.strokes().iter().enumerate() {
            let start = self.time_s + stroke.after_s;
            let (a, b) = ((from_s - start).max(0.0), (to_s - start).max(0.0));
            let decay = |time: f64| time * (ops::exp(-a / time) - ops::exp(-b / time));
            let charge = stroke.peak_a * (decay(FAST_S) + SLOW_SHARE * decay(SLOW_S));
            let on = b.min(stroke.continuing_s) - a.min(stroke.continuing_s);
            all += charge + CONTINUING_A * on;
            if index == 0 {
                first = charge;
            }
        }
        [all / length, first / length]
    }
}
