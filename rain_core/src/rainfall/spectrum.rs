//! Drop-size distribution, renormalised to carry exactly the stated rain rate.

use serde::{Deserialize, Serialize};

use super::fit_flux::fit_flux;
use super::terminal_velocity::terminal_velocity;
use crate::error::{ConfigError, in_range};
use crate::ops;
use crate::quadrature::GaussLegendre;

/// Largest rain rate accepted anywhere. Units: mm/h.
pub const MAX_INTENSITY_MM_H: f64 = 500.0;

/// The family of exponential spectra N(D) = N₀ e^(−ΛD).
#[derive(Default, Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Distribution {
    /// Marshall & Palmer 1948: N₀ = 8000, Λ = 4.1 R^−0.21.
    #[default]
    MarshallPalmer,
    /// Joss, Thams & Waldvogel 1968, drizzle: N₀ = 30000, Λ = 5.7 R^−0.21.
    Drizzle,
    /// Joss, Thams & Waldvogel 1968, widespread rain: N₀ = 7000, Λ = 4.1 R^−0.21.
    Widespread,
    /// Joss, Thams & Waldvogel 1968, thunderstorm: N₀ = 1400, Λ = 3.0 R^−0.21.
    Thunderstorm,
}

impl Distribution {
    /// Every family.
    pub const ALL: [Self; 4] = [
        Self::MarshallPalmer,
        Self::Drizzle,
        Self::Widespread,
        Self::Thunderstorm,
    ];

    /// Λ at 1 mm/h. Units: mm⁻¹.
    fn slope_at_1_mm_h(self) -> f64 {
        match self {
            Self::MarshallPalmer | Self::Widespread => 4.1,
            Self::Drizzle => 5.7,
            Self::Thunderstorm => 3.0,
        }
    }

    /// Λ = Λ₁ R^−0.21. Units: mm⁻¹.
    ///
    /// `intensity_mm_h` in mm/h, held in [1e-4, 500]: below, the slope would grow without limit, and such rain is
    /// that at 1e-4 mm/h, thinned. NaN counts as 1e-4.
    ///
    /// Error: 1e-13 against the formula. Source: Marshall & Palmer 1948, Joss et al. 1968.
    #[must_use]
    pub fn slope_per_mm(self, intensity_mm_h: f64) -> f64 {
        let r = if intensity_mm_h > MIN_SLOPE_INTENSITY_MM_H {
            intensity_mm_h.min(MAX_INTENSITY_MM_H)
        } else {
            MIN_SLOPE_INTENSITY_MM_H
        };
        self.slope_at_1_mm_h() * ops::pow(r, -0.21)
    }

    /// N₀ as published. Units: m⁻³ mm⁻¹.
    ///
    /// Error: exact, the sources' numbers.
    #[must_use]
    pub fn published_n0_per_m3_mm(self) -> f64 {
        match self {
            Self::MarshallPalmer => 8000.0,
            Self::Drizzle => 30_000.0,
            Self::Widespread => 7000.0,
            Self::Thunderstorm => 1400.0,
        }
    }
}

/// Rain rate below which Λ stays as it is. Units: mm/h.
pub(super) const MIN_SLOPE_INTENSITY_MM_H: f64 = 1e-4;

/// One rain state's spectrum: number of drops per m³ of air and mm of diameter.
///
/// N₀ is set so that ∫ over all diameters carries `intensity_mm_h`; a diameter range only selects from it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spectrum {
    /// Rain rate. Units: mm/h. Domain: [0, 500].
    pub intensity_mm_h: f64,
    /// N₀ after renormalisation. Units: m⁻³ mm⁻¹. 0 when dry.
    pub n0_per_m3_mm: f64,
    /// Λ. Units: mm⁻¹.
    pub slope_per_mm: f64,
}

/// Rain rate from a spectrum: R = 6π·1e-4 ∫ N v D³ dD, D in mm, v in m/s, N in m⁻³ mm⁻¹, R in mm/h (exact).
pub(super) const FLUX_FACTOR: f64 = 6.0 * core::f64::consts::PI * 1e-4;

impl Spectrum {
    /// The spectrum of `distribution` at a rain rate: a power, an exponential and some sixty products.
    ///
    /// Error: 1e-12 of the rain rate.
    ///
    /// # Errors
    /// When `intensity_mm_h` is not finite or outside [0, 500].
    pub fn new(distribution: Distribution, intensity_mm_h: f64) -> Result<Self, ConfigError> {
        let r = in_range(
            "intensity_mm_h",
            intensity_mm_h,
            0.0,
            MAX_INTENSITY_MM_H,
            "0 to 500 mm/h",
        )?;
        let slope = distribution.slope_per_mm(r);
        let unit_flux = FLUX_FACTOR * fit_flux(slope);
        Ok(Self {
            intensity_mm_h: r,
            n0_per_m3_mm: r / unit_flux,
            slope_per_mm: slope,
        })
    }

    /// N(D) = N₀ e^(−ΛD). Units: m⁻³ mm⁻¹.
    ///
    /// `diameter_mm` in mm, domain [0, ∞); there are no drops of a negative or NaN diameter: 0.
    ///
    /// Error: 1e-13 against the formula; a mean spectrum, from which single showers differ by factors.
    #[must_use]
    pub fn concentration(&self, diameter_mm: f64) -> f64 {
        if diameter_mm >= 0.0 {
            self.n0_per_m3_mm * ops::exp(-self.slope_per_mm * diameter_mm)
        } else {
            0.0
        }
    }

    /// [`Spectrum::concentration`] in single precision.
    ///
    /// Error: 1e-5 relative for N > 1e-6 per m³ and mm.
    #[must_use]
    pub fn concentration_f32(&self, diameter_mm: f32) -> f32 {
        if diameter_mm >= 0.0 {
            self.n0_per_m3_mm as f32 * ops::expf(-self.slope_per_mm as f32 * diameter_mm)
        } else {
            0.0
        }
    }

    /// ∫ N Dⁿ dD over [a, b] mm. Units: m⁻³ mmⁿ.
    ///
    /// In closed form, by quadrature where that would cancel. `n` up to 8; `a_mm`, `b_mm` in mm, `b` may be infinite;
    /// negative limits count as 0, NaN or b ≤ a give 0.
    ///
    /// Error: 1e-10 relative.
    #[must_use]
    pub fn moment(&self, n: u32, a_mm: f64, b_mm: f64) -> f64 {
        self.n0_per_m3_mm * exponential_moment(self.slope_per_mm, n, a_mm, b_mm)
    }

    /// [`Spectrum::moment`] in single precision, with the same domain and clamps.
    ///
    /// Error: 1e-5 relative where the moment is above 1e-6 of the untruncated one.
    #[must_use]
    pub fn moment_f32(&self, n: u32, a_mm: f32, b_mm: f32) -> f32 {
        self.n0_per_m3_mm as f32 * exponential_moment_f32(self.slope_per_mm as f32, n, a_mm, b_mm)
    }

    /// ∫ N Dⁿ v dD over [a, b] mm with [`terminal_velocity`]. Units: m⁻² s⁻¹ mmⁿ. Domain and clamps as
    /// [`Spectrum::moment`].
    ///
    /// Error: 1e-7 relative.
    #[must_use]
    pub fn flux_moment(&self, n: u32, a_mm: f64, b_mm: f64) -> f64 {
        self.n0_per_m3_mm * flux_integral(self.slope_per_mm, n, a_mm, b_mm)
    }

    /// Rain rate carried by diameters in [a, b] mm. Units: mm/h. As [`Spectrum::flux_moment`].
    ///
    /// Error: 1e-7 relative.
    #[must_use]
    pub fn rain_rate_mm_h(&self, a_mm: f64, b_mm: f64) -> f64 {
        FLUX_FACTOR * self.flux_moment(3, a_mm, b_mm)
    }

    /// Geometric extinction σ_geo = (π/4) ∫ D² N dD over [a, b] mm. Units: m⁻¹. As [`Spectrum::moment`].
    ///
    /// Error: 1e-10 relative.
    #[must_use]
    pub fn extinction_per_m(&self, a_mm: f64, b_mm: f64) -> f64 {
        core::f64::consts::FRAC_PI_4 * 1e-6 * self.moment(2, a_mm, b_mm)
    }

    /// Flux-weighted mean of 1/v over the drops of 0.2 to 6 mm: how far wind carries rain sideways per metre of fall
    /// and m/s of wind. Units: s/m. Also where it is dry.
    ///
    /// Error: 1e-7 relative.
    #[must_use]
    pub fn mean_inverse_velocity(&self) -> f64 {
        let (a, b) = (0.2, 6.0);
        exponential_moment(self.slope_per_mm, 3, a, b) / flux_integral(self.slope_per_mm, 3, a, b)
    }
}

/// A range of diameters with the part below 0 cut off; none when it is empty or an end is NaN, which `max` would hide.
pub(super) fn diameters(a: f64, b: f64) -> Option<(f64, f64)> {
    let held = a.max(0.0);
    (!a.is_nan() && b > held && held < f64::INFINITY).then_some((held, b))
}

/// ∫ₐᵇ e^(−ΛD) Dⁿ dD from the finite sum of the incomplete gamma function.
pub(super) fn exponential_moment(slope: f64, n: u32, a: f64, b: f64) -> f64 {
    let Some((a, b)) = diameters(a, b) else { return 0.0 };
    // Q(x) = e^(−x) Σ xʲ/j!, j = 0..n, is the upper share beyond x = ΛD.
    let upper = |d: f64| {
        let x = slope * d;
        // Nothing is left of e^(−x); far beyond, the sum overflows.
        if x > 1e3 {
            return 0.0;
        }
        let mut term = 1.0;
        let mut sum = 1.0;
        for j in 1..=n {
            term *= x / f64::from(j);
            sum += term;
        }
        ops::exp(-x) * sum
    };
    let (from, to) = (upper(a), upper(b));
    // More than a digit lost: the interval is short against 1/Λ, or holds small drops only, and is smooth.
    if from - to < 0.05 * from && b.is_finite() {
        return GaussLegendre::<16>::RULE.integrate(a, b, |d| ops::exp(-slope * d) * power(d, n));
    }
    let factorial: f64 = (1..=n).map(f64::from).product();
    factorial / (0..=n).map(|_| slope).product::<f64>() * (from - to)
}

/// [`exponential_moment`] in single precision.
fn exponential_moment_f32(slope: f32, n: u32, a: f32, b: f32) -> f32 {
    if a.is_nan() || b.is_nan() || b <= a.max(0.0) {
        return 0.0;
    }
    let a = a.max(0.0);
    let upper = |d: f32| {
        let x = slope * d;
        // e^(−88) is the smallest normal number; the sum would overflow long after.
        if x > 88.0 {
            return 0.0;
        }
        let mut term = 1.0;
        let mut sum = 1.0;
        for j in 1..=n {
            term *= x / j as f32;
            sum += term;
        }
        ops::expf(-x) * sum
    };
    let (from, to) = (upper(a), upper(b));
    if from - to < 0.3 * from && b.is_finite() {
        return GaussLegendre::<12>::RULE
            .integrate_f32(a, b, |d| ops::expf(-slope * d) * (0..n).map(|_| d).product::<f32>());
    }
    // n!/Λ^(n+1) factor by factor, so that neither overflows.
    (from - to) * (1..=n).map(|j| j as f32 / slope).product::<f32>() / slope
}

/// dⁿ.
pub(super) fn power(d: f64, n: u32) -> f64 {
    (0..n).map(|_| d).product()
}

/// ∫ₐᵇ e^(−ΛD) Dⁿ v dD by Gauss–Legendre panels of at most six decay lengths, short against the fit's
/// wiggles.
fn flux_integral(slope: f64, n: u32, a: f64, b: f64) -> f64 {
    const PANELS: u32 = 8;
    let Some((a, b)) = diameters(a, b) else { return 0.0 };
    // e^(−45) D³ is below 1e-15 of the integral.
    let end = b.min(a + 45.0 / slope);
    // The fit has a corner where it is clamped: a panel border there keeps the rule's order.
    let corner = super::terminal_velocity::MAX_FITTED_DIAMETER_MM;
    let rule = GaussLegendre::<8>::RULE;
    let integrand = |d: f64| ops::exp(-slope * d) * power(d, n) * terminal_velocity(d);
    [(a, end.min(corner)), (a.max(corner), end)]
        .into_iter()
        .filter(|(from, to)| to > from)
        .map(|(from, to)| rule.integrate_panels(from, to, PANELS, integrand))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn marshall_palmer(r: f64) -> Spectrum {
        Spectrum::new(Distribution::MarshallPalmer, r).unwrap()
    }

    /// Close to `expected` within `relative`.
    #[track_caller]
    fn close(value: f64, expected: f64, relative: f64) {
        assert!((value / expected - 1.0).abs() < relative, "{value} is not {expected}");
    }

    #[test]
    fn spectrum_carries_its_own_rain_rate() {
        for distribution in [
            Distribution::MarshallPalmer,
            Distribution::Drizzle,
            Distribution::Widespread,
            Distribution::Thunderstorm,
        ] {
            for r in [1e-3, 0.1, 1.0, 5.0, 25.0, 100.0, 500.0] {
                let s = Spectrum::new(distribution, r).unwrap();
                // An independent sum: 200,000 midpoints to 40 mm.
                let h = 2e-4;
                let sum: f64 = (0..200_000)
                    .map(|i| (f64::from(i) + 0.5) * h)
                    .map(|d| s.concentration(d) * terminal_velocity(d) * d * d * d * h)
                    .sum();
                close(6.0 * core::f64::consts::PI * 1e-4 * sum, r, 1e-6);
            }
        }
    }

    #[test]
    fn bulk_check_values() {
        // R, N0, Λ, N_t, σ_geo per km. The check's speeds are the measured table, ours its fit: 3e-3.
        for (r, n0, slope, number, extinction) in [
            (1.0, 6755.6, 4.1, 1647.7, 0.15397),
            (5.0, 6776.5, 2.9242, 2317.4, 0.42572),
            (25.0, 7068.0, 2.0855, 3389.1, 1.2240),
            (100.0, 7593.8, 1.5588, 4871.7, 3.1494),
        ] {
            let s = marshall_palmer(r);
            close(s.n0_per_m3_mm, n0, 4e-3);
            close(s.slope_per_mm, slope, 2e-5);
            close(s.moment(0, 0.0, f64::INFINITY), number, 4e-3);
            close(s.extinction_per_m(0.0, f64::INFINITY) * 1e3, extinction, 4e-3);
        }
    }

    #[test]
    fn truncated_moments_match_the_closed_values() {
        let s = Spectrum {
            intensity_mm_h: 25.0,
            n0_per_m3_mm: 8000.0,
            slope_per_mm: 4.1 * ops::pow(25.0, -0.21),
        };
        close(s.moment(0, 0.5, 6.0), 1352.078, 1e-6);
        close(s.moment(2, 0.5, 6.0), 1607.481, 1e-6);
        close(s.moment(3, 0.5, 6.0), 2478.298, 1e-6);
        close(s.moment(0, 0.0, f64::INFINITY), 3835.955, 1e-6);
    }

    #[test]
    fn sideways_drift_matches_the_published_values() {
        for (r, t) in [(1.0, 0.268), (5.0, 0.209), (25.0, 0.169), (100.0, 0.146)] {
            close(marshall_palmer(r).mean_inverse_velocity(), t, 0.01);
        }
    }

    #[test]
    fn dry_is_empty_and_bad_rates_are_refused() {
        let dry = marshall_palmer(0.0);
        assert_eq!(dry.n0_per_m3_mm, 0.0);
        assert_eq!(dry.concentration(1.0), 0.0);
        for bad in [-1.0, f64::NAN, f64::INFINITY, 500.1] {
            let error = Spectrum::new(Distribution::MarshallPalmer, bad).unwrap_err();
            assert!(error.to_string().starts_with("intensity_mm_h is "), "{error}");
        }
    }

    #[test]
    fn concentration_rises_with_rain_at_every_size() {
        let rates = [0.05, 0.5, 1.0, 5.0, 25.0, 100.0, 500.0];
        for pair in rates.windows(2) {
            for d in [0.2, 0.5, 1.0, 2.0, 4.0, 6.0] {
                assert!(marshall_palmer(pair[1]).concentration(d) > marshall_palmer(pair[0]).concentration(d));
            }
        }
    }
}
