//! Impacts per area: number, water, energy and pressure of rain on a surface.

use glam::DVec3;

use super::numbers::water_drop_kg;
use super::threshold::splash_threshold_diameter_mm;
use crate::constants::{M_S_PER_MM_H, WATER_DENSITY};
use crate::error::clamped;
use crate::quadrature::GaussLegendre;
use crate::rainfall::{MAX_FITTED_DIAMETER_MM, Spectrum, terminal_velocity, turning};

/// Largest diameter that counts. Units: mm.
const END_MM: f64 = 100.0;
/// Sums end this many decay lengths up: e^(−45) D³ is below 1e-15 of any of them.
const END_DECAYS: f64 = 45.0;
/// Fastest wind that counts. Units: m/s.
const FASTEST_WIND_M_S: f64 = 100.0;

/// What rain does to a surface, per area and time.
///
/// With a drop's velocity w = wind − v ŷ and the surface's unit normal n: number ∫ N max(0, −w·n) dD, and the same
/// weighted with mass, with m |w|²/2 and with m |w·n|. On level ground wind changes only the energy.
///
/// Error: 1e-6 relative against fine sums; the fall speed's fit 1 % of number, 2 % of energy. Below 0.5 mm exponential
/// spectra count too many drops by a factor.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ImpactFlux {
    /// Impacts. Units: 1/(m² s).
    pub number_per_m2_s: f64,
    /// Water caught. Units: mm/h.
    pub water_mm_h: f64,
    /// Kinetic energy. Units: W/m².
    pub energy_w_m2: f64,
    /// Momentum along the normal. Units: Pa.
    pub pressure_pa: f64,
}

impl ImpactFlux {
    /// Of the drops of `spectrum` between `min_mm` and `max_mm` (held in [0, 100] mm) on a surface with `normal`, in
    /// `wind_m_s` (held at 100 m/s). A vector that is not finite counts as still air or as level ground, a diameter
    /// that is not a number as 0.
    #[must_use]
    pub fn new(spectrum: &Spectrum, min_mm: f64, max_mm: f64, normal: DVec3, wind_m_s: DVec3) -> Self {
        let wind = if wind_m_s.is_finite() {
            wind_m_s.clamp_length_max(FASTEST_WIND_M_S)
        } else {
            DVec3::ZERO
        };
        let normal = normal.try_normalize().unwrap_or(DVec3::Y);
        let from = clamped(min_mm, 0.0, END_MM);
        let to = clamped(max_mm, 0.0, END_MM).min(from + END_DECAYS / spectrum.slope_per_mm);
        // Where the approach changes sign, and where the fall speed's fit has its corner: the integrand is smooth
        // between.
        let approach = |d: f64| terminal_velocity(d) * normal.y - wind.dot(normal);
        let corner = MAX_FITTED_DIAMETER_MM.clamp(from, to.max(from));
        let mut flux = Self::default();
        for [a, b] in [[from, corner], [corner, to]] {
            let turn = turning(a, b, approach);
            for [a, b] in [[a, turn], [turn, b]] {
                flux.add_between(spectrum, a, b, wind, approach);
            }
        }
        flux
    }

    /// On level ground in still air.
    #[must_use]
    pub fn level(spectrum: &Spectrum, min_mm: f64, max_mm: f64) -> Self {
        Self::new(spectrum, min_mm, max_mm, DVec3::Y, DVec3::ZERO)
    }

    /// Adds what falls between two diameters, by panels short against the decay length and the bends of the fall
    /// speed's fit.
    fn add_between(&mut self, spectrum: &Spectrum, a: f64, b: f64, wind: DVec3, approach: impl Fn(f64) -> f64) {
        if b <= a || approach(0.5 * (a + b)) <= 0.0 {
            return;
        }
        let rule = GaussLegendre::<8>::RULE;
        let width = (2.0 / spectrum.slope_per_mm).min(1.0);
        let panels = ((b - a) / width).ceil().clamp(1.0, 100.0);
        let half = 0.5 * (b - a) / panels;
        for panel in 0..panels as u32 {
            let mid = a + half * f64::from(2 * panel + 1);
            for (node, weight) in rule.nodes.iter().zip(rule.weights) {
                let d = mid + half * node;
                let toward = approach(d).max(0.0);
                let number = half * weight * spectrum.concentration(d) * toward;
                let mass = number * water_drop_kg(d);
                let v = terminal_velocity(d);
                self.number_per_m2_s += number;
                self.water_mm_h += mass / WATER_DENSITY / M_S_PER_MM_H;
                self.energy_w_m2 += 0.5 * mass * (wind - v * DVec3::Y).length_squared();
                self.pressure_pa += mass * toward;
            }
        }
    }
}

/// Drops that splash on level ground in still air under a film of `film_mm`. Units: 1/(m² s).
///
/// `film_mm` as [`splash_threshold_diameter_mm`].
///
/// Error: 1e-6 relative against a fine sum above the threshold; real spectra and rough ground differ by factors.
#[must_use]
pub fn splashes_per_m2_s(spectrum: &Spectrum, film_mm: f64) -> f64 {
    ImpactFlux::level(spectrum, splash_threshold_diameter_mm(film_mm), END_MM).number_per_m2_s
}
