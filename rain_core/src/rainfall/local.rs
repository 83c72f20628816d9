//! Which drops exist where the rain rate changes from place to place.
//!
//! A drop exists where the local rate reaches its own rank, so sets of drops are nested from thin to heavy rain and nothing
//! moves when an area does. Spectra are looked up by the rate in a ladder of knots: making one takes a microsecond.

use glam::DVec2;

use super::areas::AreaField;
use super::classes::{CLASS_COUNT, SizeClass};
use super::field::{Drop, Threshold};
use super::spectrum::{Distribution, MAX_INTENSITY_MM_H, Spectrum};
use crate::error::clamped;
use crate::ops;

/// Knots a factor of 10; enough for the bound below.
const KNOTS_PER_DECADE: f64 = 48.0;

/// Thresholds of every class over the rain rates of one family of spectra.
///
/// Error: thresholds 1e-3 of theirs (at least 1e-6) against those of the spectrum at the rate, from 1e-3 to 500 mm/h.
#[derive(Debug, Clone, PartialEq)]
pub struct RateLadder {
    distribution: Distribution,
    /// ln of the threshold's scale, and its slope, by class and knot.
    knots: [Vec<[f32; 2]>; CLASS_COUNT],
    /// No rank above this exists up to a knot's rate, by class and knot.
    limits: [Vec<f32>; CLASS_COUNT],
}

impl RateLadder {
    /// Rate of the first knot; below it a spectrum keeps its slope. Units: mm/h.
    pub const FIRST_MM_H: f64 = 1e-3;
    /// Knots a factor of e.
    pub const KNOTS_PER_E_FOLD: f64 = KNOTS_PER_DECADE / core::f64::consts::LN_10;

    /// The ladder of a family.
    #[must_use]
    pub fn new(distribution: Distribution) -> Self {
        let decades = ops::ln(MAX_INTENSITY_MM_H / Self::FIRST_MM_H) / core::f64::consts::LN_10;
        let count = (decades * KNOTS_PER_DECADE).ceil() as usize + 1;
        let mut knots: [Vec<[f32; 2]>; CLASS_COUNT] = Default::default();
        let mut limits: [Vec<f32>; CLASS_COUNT] = Default::default();
        for knot in 0..count {
            let rate = Self::FIRST_MM_H * ops::exp(knot as f64 * core::f64::consts::LN_10 / KNOTS_PER_DECADE);
            if let Ok(spectrum) = Spectrum::new(distribution, rate.min(MAX_INTENSITY_MM_H)) {
                for (k, class) in SizeClass::all().iter().enumerate() {
                    let threshold = Threshold::new(class, &spectrum);
                    knots[k].push(threshold.ln_line());
                    let before = limits[k].last().copied().unwrap_or(0.0);
                    limits[k].push(threshold.scan_limit().max(before));
                }
            }
        }
        Self {
            distribution,
            knots,
            limits,
        }
    }

    /// The family.
    #[must_use]
    pub fn distribution(&self) -> Distribution {
        self.distribution
    }

    /// Place of a rate among the knots.
    fn place(rate_mm_h: f64) -> f64 {
        ops::ln(rate_mm_h / Self::FIRST_MM_H) * Self::KNOTS_PER_E_FOLD
    }

    /// Threshold of a class (0…11, the last beyond) at a rate, none where it is dry. `rate_mm_h` in mm/h, held in [0, 500].
    #[must_use]
    pub fn threshold(&self, class: usize, rate_mm_h: f64) -> Option<Threshold> {
        let rate = clamped(rate_mm_h, 0.0, MAX_INTENSITY_MM_H);
        if rate <= 0.0 {
            return None;
        }
        let knots = &self.knots[class.min(CLASS_COUNT - 1)];
        let place = Self::place(rate);
        let index = (place.max(0.0) as usize).min(knots.len() - 2);
        let (a, b) = (knots[index], knots[index + 1]);
        // Below the first knot the number goes with the rate, the slope stays.
        let t = (place - index as f64).clamp(0.0, 1.0) as f32;
        let less = if place < 0.0 {
            ops::ln(rate / Self::FIRST_MM_H) as f32
        } else {
            0.0
        };
        Some(Threshold::of_ln_line(
            &SizeClass::new(class.min(CLASS_COUNT - 1)),
            [a[0] + (b[0] - a[0]) * t + less, a[1] + (b[1] - a[1]) * t],
        ))
    }

    /// How many knots each class has.
    #[must_use]
    pub fn knots_of_class(&self) -> usize {
        self.knots[0].len()
    }

    /// ln of the threshold at a diameter of 0 and its slope (mm⁻¹) at the knots, class after class: knot i is the rate
    /// [`RateLadder::FIRST_MM_H`] e^(i/[`RateLadder::KNOTS_PER_E_FOLD`]).
    pub fn ln_lines(&self) -> impl Iterator<Item = [f32; 2]> {
        self.knots.iter().flatten().copied()
    }

    /// No rank above this exists at any rate up to this one (mm/h).
    #[must_use]
    pub fn scan_limit(&self, class: usize, highest_mm_h: f64) -> f32 {
        let limits = &self.limits[class.min(CLASS_COUNT - 1)];
        let place = Self::place(highest_mm_h.max(Self::FIRST_MM_H)).max(0.0).ceil() as usize;
        // Between two knots a threshold is at most that of the greater, but for rounding.
        1.001 * limits[place.min(limits.len() - 1)]
    }
}

/// Rain whose rate changes from place to place.
#[derive(Debug, Clone, Copy)]
pub struct LocalRain<'a> {
    /// The areas at the time shown.
    pub areas: &'a AreaField,
    /// Spectra by rate.
    pub ladder: &'a RateLadder,
    /// The weather's rate. Units: mm/h. Domain: [0, 500].
    pub weather_mm_h: f64,
}

/// Which drops of a class exist in a cell of its lattice.
#[derive(Debug, Clone, Copy)]
pub(super) enum CellRain {
    /// None.
    Dry,
    /// The same everywhere in it.
    Even(Threshold),
    /// Each drop is asked; none of a higher rank exists.
    Uneven(f32),
}

impl LocalRain<'_> {
    /// The rain of a class within `radius_m` of a place (x, z).
    pub(super) fn within(&self, class: usize, place_m: DVec2, radius_m: f64) -> CellRain {
        let rates = self.areas.rates_within(place_m, radius_m, self.weather_mm_h);
        if rates[0] == rates[1] {
            self.ladder
                .threshold(class, rates[0])
                .map_or(CellRain::Dry, CellRain::Even)
        } else {
            CellRain::Uneven(self.ladder.scan_limit(class, rates[1]))
        }
    }

    /// Presence of a drop of a class at a place (x, z), 0…1: [`Threshold::presence`] at the local rate.
    ///
    /// Error: 3e-3 where the soft edge passes the drop's rank, else exact.
    #[must_use]
    pub fn presence(&self, class: usize, place_m: DVec2, drop: &Drop) -> f32 {
        self.ladder
            .threshold(class, self.areas.rate_at(place_m, self.weather_mm_h))
            .map_or(0.0, |threshold| threshold.presence(drop))
    }
}
