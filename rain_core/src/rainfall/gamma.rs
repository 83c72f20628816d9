//! Normalised gamma distributions of drop sizes.
//!
//! # Accuracy
//! With three parameters single spectra are met within their sampling noise; with only a rain rate, N_w is that of a
//! climate and D_m follows, which leaves factors of 2 in D_m⁴ between showers.

use serde::{Deserialize, Serialize};

use super::drop_sizes::paneled;
use super::incomplete_gamma::shares;
use super::spectrum::{FLUX_FACTOR, MAX_INTENSITY_MM_H, MIN_SLOPE_INTENSITY_MM_H, diameters, power};
use crate::error::{ConfigError, in_range};
use crate::ops;
use crate::quadrature::GaussLegendre;

/// Normalised gamma spectrum, N(D) = N_w f(µ) (D/D_m)^µ e^(−(4+µ) D/D_m).
///
/// f(µ) = (6/256) (4+µ)^(4+µ)/Γ(4+µ), so that the liquid water is π·10⁻³ N_w (D_m/4)⁴ g/m³ for every µ, and µ = 0 is
/// the exponential of N₀ = N_w, Λ = 4/D_m. Source: Testud et al. 2001.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GammaSpectrum {
    nw_per_m3_mm: f64,
    mean_diameter_mm: f64,
    shape: f64,
    /// f(µ).
    factor: f64,
}

/// N_w by kind of rain: what a rain rate alone leaves open.
///
/// Bringi et al. 2003 found stratiform rain near log₁₀ N_w = 6.3 − 1.6 D_m and convective rain in two clusters. The
/// line cannot close the spectrum: along it no rain rate above about 10 mm/h exists, and where drops are larger than
/// 1.3 mm, D_m falls as the rate rises. Within one climate N_w is nearly constant, so each kind holds it: D_m then
/// grows as R^(1/4.67).
#[derive(Default, Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GammaClimate {
    /// N_w = 8000 m⁻³ mm⁻¹: Marshall & Palmer's, and the stratiform line at D_m = 1.5 mm.
    #[default]
    Stratiform,
    /// N_w = 10^4.25: middle of the maritime convective cluster (4 to 4.5).
    Maritime,
    /// N_w = 10^3.25: middle of the continental convective cluster (3 to 3.5).
    Continental,
}

impl GammaClimate {
    /// Every kind.
    pub const ALL: [Self; 3] = [Self::Stratiform, Self::Maritime, Self::Continental];

    /// N_w. Units: m⁻³ mm⁻¹.
    ///
    /// Error: 1e-9 relative; single showers scatter by factors.
    #[must_use]
    pub fn nw_per_m3_mm(self) -> f64 {
        match self {
            Self::Stratiform => 8000.0,
            Self::Maritime => 17_782.794_1,
            Self::Continental => 1_778.279_41,
        }
    }
}

/// Shape µ where none is given. Units: none. A choice: the usual one of satellite retrievals.
pub const DEFAULT_GAMMA_SHAPE: f64 = 3.0;

impl GammaSpectrum {
    /// The spectrum of three parameters: N_w in m⁻³ mm⁻¹, D_m (mass-weighted mean diameter, M₄/M₃) in mm, µ.
    ///
    /// # Errors
    /// When N_w is outside [0, 1e8], D_m outside [0.01, 10] mm or µ outside [0, 20], or one is not finite.
    pub fn new(nw_per_m3_mm: f64, mean_diameter_mm: f64, shape: f64) -> Result<Self, ConfigError> {
        Ok(Self::of(
            in_range("nw_per_m3_mm", nw_per_m3_mm, 0.0, 1e8, "0 to 1e8 per m³ and mm")?,
            in_range("mean_diameter_mm", mean_diameter_mm, 0.01, 10.0, "0.01 to 10 mm")?,
            in_range("shape", shape, 0.0, 20.0, "0 to 20")?,
        ))
    }

    /// The spectrum that carries `intensity_mm_h` with the fall law `speed_m_s` (mm in, m/s out): N_w of the climate,
    /// D_m by the rate, and N_w then scaled (by less than 1e-6) so that the rate is carried exactly.
    ///
    /// Below 1e-4 mm/h D_m is that at 1e-4 mm/h and N_w is thinned.
    ///
    /// Error: 2e-6 of the rain rate; single showers scatter by factors in N_w.
    ///
    /// # Errors
    /// When `intensity_mm_h` is outside [0, 500] or `shape` outside [0, 20], or one is not finite.
    pub fn carrying(
        climate: GammaClimate,
        shape: f64,
        intensity_mm_h: f64,
        speed_m_s: impl Fn(f64) -> f64,
    ) -> Result<Self, ConfigError> {
        let r = in_range(
            "intensity_mm_h",
            intensity_mm_h,
            0.0,
            MAX_INTENSITY_MM_H,
            "0 to 500 mm/h",
        )?;
        let shape = in_range("shape", shape, 0.0, 20.0, "0 to 20")?;
        let nw = climate.nw_per_m3_mm();
        let target = ops::ln(r.max(MIN_SLOPE_INTENSITY_MM_H));
        // ln R is nearly linear in ln D_m, with slope 4.67 for raindrops and 5 to 6 for mist: the secant converges
        // fast.
        let at = |x: f64| {
            let spectrum = Self::of(nw, ops::exp(x), shape);
            ops::ln(spectrum.rain_rate_mm_h(0.0, f64::INFINITY, &speed_m_s).max(1e-30)) - target
        };
        let mut x = ops::ln(1.5) + (target - ops::ln(9.2 * nw / 8000.0)) / 4.67;
        let mut error = at(x);
        let mut slope = 4.67;
        for _ in 0..20 {
            if error.abs() < 1e-9 {
                break;
            }
            let next = x - error / slope;
            let next_error = at(next);
            let found = (next_error - error) / (next - x);
            slope = if found > 1.0 { found.min(12.0) } else { 4.67 };
            (x, error) = (next, next_error);
        }
        let spectrum = Self::of(nw, ops::exp(x), shape);
        let carried = spectrum.rain_rate_mm_h(0.0, f64::INFINITY, &speed_m_s);
        Ok(Self {
            nw_per_m3_mm: if carried > 0.0 { nw * r / carried } else { 0.0 },
            ..spectrum
        })
    }

    fn of(nw_per_m3_mm: f64, mean_diameter_mm: f64, shape: f64) -> Self {
        let k = 4.0 + shape;
        Self {
            nw_per_m3_mm,
            mean_diameter_mm,
            shape,
            factor: 6.0 / 256.0 * ops::exp(k * ops::ln(k) - ops::ln_gamma(k)),
        }
    }

    /// N_w. Units: m⁻³ mm⁻¹.
    #[must_use]
    pub fn nw_per_m3_mm(&self) -> f64 {
        self.nw_per_m3_mm
    }

    /// D_m, the mass-weighted mean diameter. Units: mm.
    #[must_use]
    pub fn mean_diameter_mm(&self) -> f64 {
        self.mean_diameter_mm
    }

    /// µ. Units: none.
    #[must_use]
    pub fn shape(&self) -> f64 {
        self.shape
    }

    /// f(µ). Units: none.
    ///
    /// Error: 1e-12 relative.
    #[must_use]
    pub fn factor(&self) -> f64 {
        self.factor
    }

    /// (4 + µ)/D_m: what Λ is to an exponential. Units: mm⁻¹.
    ///
    /// Error: 1e-15 relative.
    #[must_use]
    pub fn slope_per_mm(&self) -> f64 {
        (4.0 + self.shape) / self.mean_diameter_mm
    }

    /// Whether N_w and D_m lie on the convective side of log₁₀ N_w = 6.3 − 1.6 D_m. Source: Bringi et al. 2003, 2009.
    ///
    /// Error: exact, more than 1e-12 of N_w from the line; the line parts observed clusters, not single showers.
    #[must_use]
    pub fn is_convective(&self) -> bool {
        // ln N_w > ln 10 (6.3 − 1.6 D_m); no drops are not convective.
        ops::ln(self.nw_per_m3_mm) > core::f64::consts::LN_10 * (6.3 - 1.6 * self.mean_diameter_mm)
    }

    /// N(D). Units: m⁻³ mm⁻¹.
    ///
    /// `diameter_mm` in mm, domain [0, ∞); there are no drops of a negative or NaN diameter: 0.
    ///
    /// Error: 1e-12 relative.
    #[must_use]
    pub fn concentration(&self, diameter_mm: f64) -> f64 {
        let x = diameter_mm / self.mean_diameter_mm;
        // Beyond, nothing is left of the exponential, and the power would overflow.
        if (0.0..1e3).contains(&x) {
            self.nw_per_m3_mm * self.factor * ops::pow(x, self.shape) * ops::exp(-(4.0 + self.shape) * x)
        } else {
            0.0
        }
    }

    /// ∫ N Dⁿ dD over [a, b] mm. Units: m⁻³ mmⁿ.
    ///
    /// By the incomplete gamma function, by quadrature where that would cancel. `n` up to 8; `b` may be infinite;
    /// negative limits count as 0, NaN or b ≤ a give 0.
    ///
    /// Error: 1e-9 relative.
    #[must_use]
    pub fn moment(&self, n: u32, a_mm: f64, b_mm: f64) -> f64 {
        let Some((a, b_mm)) = diameters(a_mm, b_mm) else {
            return 0.0;
        };
        let s = self.shape + f64::from(n) + 1.0;
        let slope = self.slope_per_mm();
        let (low, high) = (shares(s, slope * a), shares(s, slope * b_mm));
        // The difference of the smaller pair of shares loses least.
        let (share, from) = if low.0 < 0.5 {
            (high.0 - low.0, high.0)
        } else {
            (low.1 - high.1, low.1)
        };
        if share < 0.05 * from && b_mm.is_finite() && slope * (b_mm - a) < 4.0 {
            return GaussLegendre::<24>::RULE.integrate(a, b_mm, |d| self.concentration(d) * power(d, n));
        }
        // N_w f D_m^(n+1) Γ(s)/(4+µ)^s.
        let whole = ops::exp(ops::ln_gamma(s) - s * ops::ln(4.0 + self.shape));
        self.nw_per_m3_mm * self.factor * power(self.mean_diameter_mm, n + 1) * whole * share
    }

    /// Rain rate carried by diameters in [a, b] mm with a fall law. Units: mm/h. Domain and clamps as in
    /// [`GammaSpectrum::moment`].
    ///
    /// Error: 2e-6 relative.
    pub fn rain_rate_mm_h(&self, a_mm: f64, b_mm: f64, speed_m_s: impl Fn(f64) -> f64) -> f64 {
        let Some((a, b)) = diameters(a_mm, b_mm) else {
            return 0.0;
        };
        let water = |d: f64| self.concentration(d) * power(d, 3) * speed_m_s(d);
        FLUX_FACTOR * paneled(a, b.min(self.end_mm(a)), 3.0 / self.slope_per_mm(), water)
    }

    /// Diameter beyond which nothing counts, above a lower limit. Units: mm.
    pub(super) fn end_mm(&self, a_mm: f64) -> f64 {
        a_mm.max(0.0) + (45.0 + 3.0 * self.shape) / self.slope_per_mm()
    }
}
