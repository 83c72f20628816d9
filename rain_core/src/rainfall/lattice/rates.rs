//! Rain whose rate changes from place to place, as cards take it: cell by cell.

use glam::DVec2;

use super::plan::LatticePlan;
use crate::ops;
use crate::rainfall::Spectrum;
use crate::rainfall::areas::AreaField;

/// Knots a factor of 2 in rate.
const KNOTS_PER_OCTAVE: f64 = 2.0;
/// Octaves below the heaviest rate; still lighter rain shows no card.
const OCTAVES: usize = 16;

/// Where it rains how much.
#[derive(Debug, Clone, Copy)]
pub struct LatticeRates<'a> {
    /// The areas at the time shown.
    pub areas: &'a AreaField,
    /// The weather's rate. Units: mm/h. Domain: [0, 500].
    pub weather_mm_h: f64,
}

/// Extinction of each class of textures by the rain rate, in steps of half an octave below the heaviest.
pub(super) struct ClassLadder {
    heaviest_mm_h: f64,
    /// ln of the extinction (1/m) by class and knot, from the heaviest down.
    knots: Vec<Vec<f64>>,
}

impl ClassLadder {
    pub fn new(plan: &LatticePlan, heaviest_mm_h: f64) -> Self {
        let count = OCTAVES * KNOTS_PER_OCTAVE as usize + 1;
        let spectra: Vec<Option<Spectrum>> = (0..count)
            .map(|knot| {
                let rate = heaviest_mm_h * ops::exp(-(knot as f64) * core::f64::consts::LN_2 / KNOTS_PER_OCTAVE);
                Spectrum::new(plan.textures().distribution, rate).ok()
            })
            .collect();
        let knots = plan
            .textures()
            .diameter_edges_mm
            .windows(2)
            .map(|edges| {
                let of = |spectrum: &Option<Spectrum>| {
                    let sigma = spectrum
                        .as_ref()
                        .map_or(0.0, |s| s.extinction_per_m(edges[0], edges[1]));
                    ops::ln(sigma.max(1e-300))
                };
                spectra.iter().map(of).collect()
            })
            .collect();
        Self { heaviest_mm_h, knots }
    }

    /// Extinction of a class at a rate (mm/h) over that at the heaviest. Units: none.
    ///
    /// Error: 0.02 relative above 0.1 mm/h; what is lighter than the heaviest by 2¹⁶ is none.
    pub fn share(&self, class: usize, rate_mm_h: f64) -> f64 {
        if rate_mm_h >= self.heaviest_mm_h {
            return 1.0;
        }
        let knots = &self.knots[class];
        let place = -ops::ln(rate_mm_h / self.heaviest_mm_h) / core::f64::consts::LN_2 * KNOTS_PER_OCTAVE;
        // Also where the rate is 0 or not a number.
        if !(place >= 0.0 && place < (knots.len() - 1) as f64) {
            return 0.0;
        }
        let index = place as usize;
        let (a, b) = (knots[index], knots[index + 1]);
        ops::exp(a + (b - a) * (place - index as f64) - knots[0])
    }
}

impl LatticeRates<'_> {
    /// Rate at a place (x, z). Units: mm/h.
    pub(super) fn at(&self, place_m: DVec2) -> f64 {
        self.areas.rate_at(place_m, self.weather_mm_h)
    }
}
