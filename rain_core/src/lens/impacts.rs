//! What hits a glass, by diameter.

use core::f64::consts::PI;

use glam::DVec3;

use super::sessile::cap_radius_m;
use crate::error::clamped;
use crate::ops;
use crate::quadrature::GaussLegendre;
use crate::rainfall::{Spectrum, terminal_velocity};

/// Smallest drop that counts: below it exponential spectra count too many, and what arrives is a mist. Units: mm.
pub const LEAST_DROP_MM: f64 = 0.5;
/// Largest drop that counts. Units: mm.
const LARGEST_DROP_MM: f64 = 6.0;
/// Steps of the table of diameters.
const STEPS: usize = 44;
/// Fastest air that counts. Units: m/s.
const FASTEST_M_S: f64 = 100.0;

/// Mean of max(0, X) of a normal X. Its two tails agree: f(m) − f(−m) = m.
fn mean_positive(mean: f64, spread: f64) -> f64 {
    if spread <= 0.0 {
        return mean.max(0.0);
    }
    let x = mean / spread;
    let density = ops::exp(-0.5 * x * x) / ops::sqrt(2.0 * PI);
    // Far down the tail the sum cancels; there is nothing.
    (spread * (density + 0.5 * x * (1.0 + ops::erf(x / core::f64::consts::SQRT_2)))).max(0.0)
}

/// Drops that hit a glass, per area and time, from 0.5 to 6 mm.
///
/// A drop moves with the air and falls: w = u − v ŷ against the glass, u the air's velocity relative to it. Its speed
/// into the glass, −w·n, scatters with the gusts' deviation g as a normal variable X, so that even upright glass in calm
/// rain catches some: number ∫ N(D) E[max(0, X)] dD, E[max(0, X)] = g φ(m/g) + m Φ(m/g).
///
/// Error: number 2e-4, water 2e-4 relative against a fine sum over diameters and gusts; the drops' own answer to
/// gusts (large ones follow less) is left out.
#[derive(Debug, Clone, PartialEq)]
pub struct GlassImpacts {
    /// Impacts. Units: 1/(m² s).
    pub number_per_m2_s: f64,
    /// Water. Units: m/s.
    pub water_m_s: f64,
    /// Share of the impacts below each step of diameter.
    below: [f64; STEPS + 1],
}

impl Default for GlassImpacts {
    fn default() -> Self {
        Self {
            number_per_m2_s: 0.0,
            water_m_s: 0.0,
            below: [0.0; STEPS + 1],
        }
    }
}

/// Where a step begins: they widen with the square, as most impacts are small.
fn diameter_mm(step: f64) -> f64 {
    let share = step / STEPS as f64;
    LEAST_DROP_MM + (LARGEST_DROP_MM - LEAST_DROP_MM) * share * share
}

impl GlassImpacts {
    /// On a glass with unit normal `normal` in `air_m_s`, the air's velocity relative to it (held at 100 m/s), with
    /// gusts of the deviation `gust_m_s` (m/s, held in [0, 20]). A vector that is not finite counts as still air or as a
    /// glass that looks up.
    #[must_use]
    pub fn new(spectrum: &Spectrum, normal: DVec3, air_m_s: DVec3, gust_m_s: f64) -> Self {
        let normal = normal.try_normalize().unwrap_or(DVec3::Y);
        let air = if air_m_s.is_finite() {
            air_m_s.clamp_length_max(FASTEST_M_S)
        } else {
            DVec3::ZERO
        };
        let gust = clamped(gust_m_s, 0.0, 20.0);
        let mut found = Self::default();
        let rule = GaussLegendre::<8>::RULE;
        for step in 0..STEPS {
            let (a, b) = (diameter_mm(step as f64), diameter_mm(step as f64 + 1.0));
            let speed = |d: f64| mean_positive(terminal_velocity(d) * normal.y - air.dot(normal), gust);
            let number = rule.integrate(a, b, |d| spectrum.concentration(d) * speed(d));
            let water = rule.integrate(a, b, |d| spectrum.concentration(d) * speed(d) * d * d * d);
            found.number_per_m2_s += number;
            found.water_m_s += water * PI / 6.0 * 1e-9;
            found.below[step + 1] = found.number_per_m2_s;
        }
        if found.number_per_m2_s > 0.0 {
            for below in &mut found.below {
                *below /= found.number_per_m2_s;
            }
        }
        found
    }

    /// The diameter below which a share of the impacts lies. Units: mm.
    ///
    /// `share`: none, held in [0, 1].
    ///
    /// Error: 5e-3 of the share. A step of width h is filled evenly where the density falls as e^(−κD): off by κh/8 of
    /// what lies in it, at most 0.1 of all and κh 0.4.
    #[must_use]
    pub fn diameter_at(&self, share: f64) -> f64 {
        let share = clamped(share, 0.0, 1.0);
        let step = self.step_of(share);
        let (a, b) = (self.below[step], self.below[step + 1]);
        let (a_mm, b_mm) = (diameter_mm(step as f64), diameter_mm(step as f64 + 1.0));
        let within = if b > a { (share - a) / (b - a) } else { 0.0 };
        a_mm + within.clamp(0.0, 1.0) * (b_mm - a_mm)
    }

    fn step_of(&self, share: f64) -> usize {
        let above = self.below[1..].iter().take_while(|below| **below <= share);
        above.count().min(STEPS - 1)
    }

    /// How much of the glass the smallest impacts, this share of all, cover in a second. Units: 1/s.
    ///
    /// `share`: none, held in [0, 1].
    ///
    /// Error: 2e-2 relative against a fine sum.
    #[must_use]
    pub fn covered_below_per_s(&self, share: f64) -> f64 {
        let share = clamped(share, 0.0, 1.0);
        let covered = |step: usize| {
            let part = self.below[step + 1].min(share) - self.below[step].min(share);
            let d = diameter_mm(step as f64 + 0.5) * 1e-3;
            let r = cap_radius_m(PI / 6.0 * d * d * d);
            part * PI * r * r
        };
        self.number_per_m2_s * (0..STEPS).map(covered).sum::<f64>()
    }
}
