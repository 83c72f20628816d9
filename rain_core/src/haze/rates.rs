//! Extinction by rain rate, as a table that a shader can read.

use super::extinction::extinction_per_m;
use crate::error::clamped;
use crate::ops;
use crate::rainfall::{Distribution, MAX_INTENSITY_MM_H, Spectrum};

/// Entries of a [`RateExtinction`].
pub const RATE_KNOTS: usize = 64;
/// Rate of the first entry; below it extinction goes with the rate. Units: mm/h.
pub const FIRST_RATE_MM_H: f64 = 0.01;

/// ln of the extinction (1/m) at rates from 0.01 to 500 mm/h, evenly in ln of the rate.
///
/// Error: 2e-3 relative from 0.01 to 500 mm/h.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RateExtinction {
    /// ln of 1/m.
    pub ln_per_m: [f32; RATE_KNOTS],
}

impl RateExtinction {
    /// Knots for each unit of ln of the rate.
    #[must_use]
    pub fn knots_per_ln() -> f64 {
        (RATE_KNOTS - 1) as f64 / ops::ln(MAX_INTENSITY_MM_H / FIRST_RATE_MM_H)
    }

    /// The table of a family of spectra under an efficiency Q ([`extinction_per_m`]).
    #[must_use]
    pub fn new(distribution: Distribution, efficiency: f64) -> Self {
        Self {
            ln_per_m: core::array::from_fn(|i| {
                let rate = FIRST_RATE_MM_H * ops::exp(i as f64 / Self::knots_per_ln());
                let spectrum = Spectrum::new(distribution, rate.min(MAX_INTENSITY_MM_H));
                spectrum.map_or(-80.0, |s| ops::ln(extinction_per_m(&s, efficiency))) as f32
            }),
        }
    }

    /// Extinction at a rate (mm/h, held in [0, 500], NaN counts as 0). Units: 1/m.
    #[must_use]
    pub fn per_m(&self, rate_mm_h: f64) -> f64 {
        let rate = clamped(rate_mm_h, 0.0, MAX_INTENSITY_MM_H);
        if rate <= 0.0 {
            return 0.0;
        }
        let line = ops::ln(rate / FIRST_RATE_MM_H) * Self::knots_per_ln();
        let place = line.max(0.0);
        let index = (place as usize).min(RATE_KNOTS - 2);
        let (a, b) = (f64::from(self.ln_per_m[index]), f64::from(self.ln_per_m[index + 1]));
        ops::exp(a + (b - a) * (place - index as f64)) * (rate / FIRST_RATE_MM_H).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_the_extinction_of_each_rate() {
        for distribution in [
            Distribution::MarshallPalmer,
            Distribution::Drizzle,
            Distribution::Thunderstorm,
        ] {
            let table = RateExtinction::new(distribution, 2.0);
            for i in 0..1000 {
                let rate = 0.01 * ops::exp(f64::from(i) / 999.0 * ops::ln(5e4));
                let exact = extinction_per_m(&Spectrum::new(distribution, rate.min(500.0)).unwrap(), 2.0);
                assert!(
                    (table.per_m(rate) / exact - 1.0).abs() < 2e-3,
                    "{rate}: {}",
                    table.per_m(rate) / exact
                );
            }
            assert_eq!(
                (table.per_m(0.0), table.per_m(-1.0), table.per_m(f64::NAN)),
                (0.0, 0.0, 0.0)
            );
        }
    }
}
