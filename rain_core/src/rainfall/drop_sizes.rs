//! Drop sizes of any kind of rain behind one type: exponentials, gamma distributions and blends of them.

use core::fmt;
use core::str::FromStr;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::gamma::{DEFAULT_GAMMA_SHAPE, GammaClimate, GammaSpectrum};
use super::renormalise::carrying;
use super::spectrum::{Distribution, Spectrum, diameters, power};
use super::terminal_velocity::{GUNN_KINZER, terminal_velocity};
use crate::error::{ConfigError, in_range};
use crate::quadrature::GaussLegendre;

/// Kind of rain by name.
#[derive(Default, Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RainKind {
    /// [`Distribution::MarshallPalmer`].
    #[default]
    MarshallPalmer,
    /// [`Distribution::Drizzle`].
    Drizzle,
    /// [`Distribution::Widespread`].
    Widespread,
    /// [`Distribution::Thunderstorm`].
    Thunderstorm,
    /// Normalised gamma distribution, µ = 3, N_w of stratiform rain: [`GammaClimate::Stratiform`].
    Gamma,
}

/// A name that no kind of rain has.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("no distribution is called `{name}`; there are marshall-palmer, drizzle, widespread, thunderstorm, gamma")]
pub struct UnknownRainKind {
    /// What was asked for.
    pub name: String,
}

impl RainKind {
    /// Every kind.
    pub const ALL: [Self; 5] = [
        Self::MarshallPalmer,
        Self::Drizzle,
        Self::Widespread,
        Self::Thunderstorm,
        Self::Gamma,
    ];

    /// The name in files and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::MarshallPalmer => "marshall-palmer",
            Self::Drizzle => "drizzle",
            Self::Widespread => "widespread",
            Self::Thunderstorm => "thunderstorm",
            Self::Gamma => "gamma",
        }
    }

    /// The exponential family, or none for the gamma distribution.
    #[must_use]
    pub fn exponential(self) -> Option<Distribution> {
        match self {
            Self::MarshallPalmer => Some(Distribution::MarshallPalmer),
            Self::Drizzle => Some(Distribution::Drizzle),
            Self::Widespread => Some(Distribution::Widespread),
            Self::Thunderstorm => Some(Distribution::Thunderstorm),
            Self::Gamma => None,
        }
    }
}

impl From<Distribution> for RainKind {
    fn from(distribution: Distribution) -> Self {
        match distribution {
            Distribution::MarshallPalmer => Self::MarshallPalmer,
            Distribution::Drizzle => Self::Drizzle,
            Distribution::Widespread => Self::Widespread,
            Distribution::Thunderstorm => Self::Thunderstorm,
        }
    }
}

impl fmt::Display for RainKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for RainKind {
    type Err = UnknownRainKind;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        Self::ALL
            .into_iter()
            .find(|kind| kind.name() == name)
            .ok_or_else(|| UnknownRainKind { name: name.to_owned() })
    }
}

/// One size law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SizeLaw {
    /// N₀ e^(−ΛD).
    Exponential(Spectrum),
    /// Normalised gamma.
    Gamma(GammaSpectrum),
}

impl SizeLaw {
    /// N(D). Units: m⁻³ mm⁻¹. As [`Spectrum::concentration`].
    ///
    /// Error: that of its law, the same bits.
    #[must_use]
    pub fn concentration(&self, diameter_mm: f64) -> f64 {
        match self {
            Self::Exponential(spectrum) => spectrum.concentration(diameter_mm),
            Self::Gamma(spectrum) => spectrum.concentration(diameter_mm),
        }
    }

    /// N₀, or N_w of a gamma distribution. Units: m⁻³ mm⁻¹.
    ///
    /// Error: that of its law, the same bits.
    #[must_use]
    pub fn n0_per_m3_mm(&self) -> f64 {
        match self {
            Self::Exponential(spectrum) => spectrum.n0_per_m3_mm,
            Self::Gamma(spectrum) => spectrum.nw_per_m3_mm(),
        }
    }

    /// Λ, (4 + µ)/D_m of a gamma distribution. Units: mm⁻¹.
    ///
    /// Error: that of its law, the same bits.
    #[must_use]
    pub fn slope_per_mm(&self) -> f64 {
        match self {
            Self::Exponential(spectrum) => spectrum.slope_per_mm,
            Self::Gamma(spectrum) => spectrum.slope_per_mm(),
        }
    }

    fn moment(&self, n: u32, a_mm: f64, b_mm: f64) -> f64 {
        match self {
            Self::Exponential(spectrum) => spectrum.moment(n, a_mm, b_mm),
            Self::Gamma(spectrum) => spectrum.moment(n, a_mm, b_mm),
        }
    }

    /// Diameter beyond which nothing counts, above a lower limit. Units: mm.
    fn end_mm(&self, a_mm: f64) -> f64 {
        match self {
            // e^(−45) D⁶ is below 1e-13 of any integral here.
            Self::Exponential(spectrum) => a_mm.max(0.0) + 45.0 / spectrum.slope_per_mm,
            Self::Gamma(spectrum) => spectrum.end_mm(a_mm),
        }
    }
}

/// Most laws that one blend holds.
pub const MAX_BLEND: usize = 5;

/// Drop sizes of one rain state: one law, or several blended by N(D).
///
/// Each law carries the whole rain rate, and so does any blend whose shares add up to 1. Copies; allocates nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DropSizes {
    parts: [(f64, SizeLaw); MAX_BLEND],
    count: usize,
}

impl From<SizeLaw> for DropSizes {
    fn from(law: SizeLaw) -> Self {
        Self {
            parts: [(1.0, law); MAX_BLEND],
            count: 1,
        }
    }
}

impl From<Spectrum> for DropSizes {
    fn from(spectrum: Spectrum) -> Self {
        SizeLaw::Exponential(spectrum).into()
    }
}

impl From<GammaSpectrum> for DropSizes {
    fn from(spectrum: GammaSpectrum) -> Self {
        SizeLaw::Gamma(spectrum).into()
    }
}

impl DropSizes {
    /// Sizes of a kind of rain that carry exactly `intensity_mm_h` over all diameters with [`terminal_velocity`].
    ///
    /// Error: 2e-6 of the rain rate.
    ///
    /// # Errors
    /// When `intensity_mm_h` is outside [0, 500] or not finite.
    pub fn new(kind: RainKind, intensity_mm_h: f64) -> Result<Self, ConfigError> {
        Self::carrying(kind, intensity_mm_h, terminal_velocity)
    }

    /// As [`DropSizes::new`], with another fall law (mm in, m/s out).
    ///
    /// Error: 2e-6 of the rain rate.
    ///
    /// # Errors
    /// When `intensity_mm_h` is outside [0, 500] or not finite.
    pub fn carrying(kind: RainKind, intensity_mm_h: f64, speed_m_s: impl Fn(f64) -> f64) -> Result<Self, ConfigError> {
        Ok(match kind.exponential() {
            Some(distribution) => carrying(distribution, intensity_mm_h, speed_m_s)?.into(),
            None => {
                GammaSpectrum::carrying(GammaClimate::default(), DEFAULT_GAMMA_SHAPE, intensity_mm_h, speed_m_s)?.into()
            }
        })
    }

    /// Sizes with the published N₀, which carry up to 19 % more or 28 % less than `intensity_mm_h` from 1 to 100 mm/h,
    /// and less than half of it in the lightest drizzle. A gamma distribution has no published rate to miss and is that
    /// of [`DropSizes::new`].
    ///
    /// Error: that of [`Spectrum::published`], the same bits.
    ///
    /// # Errors
    /// When `intensity_mm_h` is outside [0, 500] or not finite.
    pub fn published(kind: RainKind, intensity_mm_h: f64) -> Result<Self, ConfigError> {
        match kind.exponential() {
            Some(distribution) => Ok(Spectrum::published(distribution, intensity_mm_h)?.into()),
            None => Self::new(kind, intensity_mm_h),
        }
    }

    /// A blend of kinds at one rain rate: N(D) = Σ share N_kind(D), shares scaled to add up to 1.
    ///
    /// Error: N(D) 1e-12 relative, the rain rate 2e-6.
    ///
    /// # Errors
    /// When `intensity_mm_h` is outside [0, 500], a share negative, or one not finite; when no share is above 0; when
    /// there are more than [`MAX_BLEND`].
    pub fn blend(shares: &[(RainKind, f64)], intensity_mm_h: f64) -> Result<Self, ConfigError> {
        in_range("blend", shares.len() as f64, 1.0, MAX_BLEND as f64, "1 to 5 kinds")?;
        let mut total = 0.0;
        for (_, share) in shares {
            total += in_range("share", *share, 0.0, 1e6, "0 to 1e6")?;
        }
        in_range("share", total, f64::MIN_POSITIVE, f64::MAX, "a sum above 0")?;
        let mut blend = Self::new(shares[0].0, intensity_mm_h)?;
        blend.count = shares.len();
        for (part, (kind, share)) in blend.parts.iter_mut().zip(shares) {
            *part = (share / total, Self::new(*kind, intensity_mm_h)?.parts[0].1);
        }
        Ok(blend)
    }

    /// The laws with their shares.
    #[must_use]
    pub fn parts(&self) -> &[(f64, SizeLaw)] {
        &self.parts[..self.count]
    }

    /// N(D). Units: m⁻³ mm⁻¹. `diameter_mm` in mm, domain [0, ∞); a negative or NaN diameter gives 0.
    ///
    /// Error: 1e-12 relative.
    #[must_use]
    pub fn concentration(&self, diameter_mm: f64) -> f64 {
        self.parts()
            .iter()
            .map(|(share, law)| share * law.concentration(diameter_mm))
            .sum()
    }

    /// ∫ N Dⁿ dD over [a, b] mm, in closed form. Units: m⁻³ mmⁿ. As [`Spectrum::moment`].
    ///
    /// Error: 1e-9 relative.
    #[must_use]
    pub fn moment(&self, n: u32, a_mm: f64, b_mm: f64) -> f64 {
        self.parts()
            .iter()
            .map(|(share, law)| share * law.moment(n, a_mm, b_mm))
            .sum()
    }

    /// ∫ N(D) w(D) dD over [a, b] mm by Gauss–Legendre panels, for any smooth weight.
    ///
    /// Panels end where fall laws have corners or knots (0.1 to 1 mm every 0.1, to 5.8 mm every 0.2; 1.07, 7 mm). `b`
    /// may be infinite; negative limits count as 0, NaN or b ≤ a give 0.
    ///
    /// Error: 2e-6 relative for weights made of powers and fall laws.
    pub fn integral(&self, a_mm: f64, b_mm: f64, weight: impl Fn(f64) -> f64) -> f64 {
        let Some((a, b)) = diameters(a_mm, b_mm) else {
            return 0.0;
        };
        self.parts()
            .iter()
            .map(|(share, law)| {
                let integrand = |d: f64| law.concentration(d) * weight(d);
                share * paneled(a, b.min(law.end_mm(a)), 3.0 / law.slope_per_mm(), integrand)
            })
            .sum()
    }

    /// ∫ N Dⁿ v dD over [a, b] mm with a fall law (mm in, m/s out). Units: m⁻² s⁻¹ mmⁿ. As [`DropSizes::integral`].
    ///
    /// Error: 2e-6 relative.
    pub fn flux_moment(&self, n: u32, a_mm: f64, b_mm: f64, speed_m_s: impl Fn(f64) -> f64) -> f64 {
        self.integral(a_mm, b_mm, |d| power(d, n) * speed_m_s(d))
    }

    /// Diameter beyond which nothing counts. Units: mm.
    #[must_use]
    pub fn end_mm(&self) -> f64 {
        self.parts().iter().map(|(_, law)| law.end_mm(0.0)).fold(0.0, f64::max)
    }
}

/// Where fall laws have knots and corners. Units: mm.
const BORDERS: [f64; 36] = borders();

const fn borders() -> [f64; 36] {
    let mut borders = [7.0; 36];
    let mut i = 0;
    while i < 10 {
        borders[i] = GUNN_KINZER[i + 1].0;
        i += 1;
    }
    borders[10] = 1.07;
    while i < 34 {
        borders[i + 1] = GUNN_KINZER[i + 1].0;
        i += 1;
    }
    borders
}

/// ∫ₐᵇ f dD by six-point panels of at most `scale` mm that end at the knots of fall laws. `a` from 0 on.
pub(super) fn paneled(a: f64, b: f64, scale: f64, f: impl Fn(f64) -> f64) -> f64 {
    let rule = GaussLegendre::<6>::RULE;
    let mut sum = 0.0;
    let mut from = a;
    for border in BORDERS.into_iter().chain([b]) {
        let to = border.min(b);
        if to > from {
            // At most 64 panels: what is that much longer than the scale has decayed long before its end.
            let panels = ((to - from) / scale).ceil().min(64.0) as u32;
            sum += rule.integrate_panels(from, to, panels, &f);
            from = to;
        }
    }
    sum
}
