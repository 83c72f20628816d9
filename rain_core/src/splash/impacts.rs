//! Impacts per area: number, water, energy and pressure of rain on a surface.

use glam::DVec3;

use super::numbers::water_drop_kg;
use super::threshold::splash_threshold_diameter_mm;
use crate::rainfall::{MAX_FITTED_DIAMETER_MM, Spectrum, terminal_velocity};

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
        let from = crate::error::clamped(min_mm, 0.0, END_MM);
        let to = crate::error::clamped(max_mm, 0.0, END_MM).min(from + END_DECAYS / spectrum.slope_per_mm);
        // Where the approach changes sign, and where the fall speed's fit has its corner: the integrand is smooth between.
        let approach = |d: f64| terminal_velocity(d) * normal.y - wind.dot(normal);
        let mut borders = [from, to, to];
        borders[1] = MAX_FITTED_DIAMETER_MM.clamp(from, to.max(from));
        let mut flux = Self::default();
        for pair in borders.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            if b <= a {
                continue;
            }
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

    /// Adds what falls between two diameters by Simpson's rule.
    fn add_between(&mut self, spectrum: &Spectrum, a: f64, b: f64, wind: DVec3, approach: impl Fn(f64) -> f64) {
        if b <= a || approach(0.5 * (a + b)) <= 0.0 {
            return;
        }
        // Panels short against the decay length and against the bends of the fall speed's fit.
        let bend = if a < MAX_FITTED_DIAMETER_MM { 0.05 } else { 1.0 };
        let width = (0.1 / spectrum.slope_per_mm).min(bend);
        let panels = ((b - a) / width).ceil().clamp(2.0, 4000.0) as u32;
        let h = (b - a) / f64::from(2 * panels);
        for i in 0..=2 * panels {
            let weight = match i {
                0 => 1.0,
                i if i == 2 * panels => 1.0,
                i if i % 2 == 1 => 4.0,
                _ => 2.0,
            };
            let d = a + h * f64::from(i);
            let toward = approach(d).max(0.0);
            let number = weight * h / 3.0 * spectrum.concentration(d) * toward;
            let mass = number * water_drop_kg(d);
            let v = terminal_velocity(d);
            self.number_per_m2_s += number;
            self.water_mm_h += mass / crate::constants::WATER_DENSITY * 3.6e6;
            self.energy_w_m2 += 0.5 * mass * (wind.x * wind.x + (wind.y - v) * (wind.y - v) + wind.z * wind.z);
            self.pressure_pa += mass * toward;
        }
    }
}

/// Where a monotone function changes sign between `a` and `b`; `a` where it does not.
fn turning(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (a, b);
    if (f(a) > 0.0) == (f(b) > 0.0) {
        return a;
    }
    for _ in 0..60 {
        let mid = 0.5 * (low + high);
        if (f(mid) > 0.0) == (f(a) > 0.0) {
            low = mid;
        } else {
            high = mid;
        }
    }
    0.5 * (low + high)
}

/// Drops that splash on level ground in still air under a film of `film_mm`. Units: 1/(m² s).
///
/// `film_mm` as [`splash_threshold_diameter_mm`]. Error: that of the threshold and of [`ImpactFlux`].
#[must_use]
pub fn splashes_per_m2_s(spectrum: &Spectrum, film_mm: f64) -> f64 {
    ImpactFlux::level(spectrum, splash_threshold_diameter_mm(film_mm), END_MM).number_per_m2_s
}
