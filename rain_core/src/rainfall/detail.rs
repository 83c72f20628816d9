//! Laws by which fewer and larger drops stand for the field, and what each does to its coverage.
//!
//! With drops thinned to a share n(d) and scaled by s(d) in both dimensions, at the distance d relative to the container's
//! reach, the coverage of a stretch of ray is n·s² times that of the full field. [`DetailLaw::OpticalDepth`] keeps that at
//! 1; the published laws do not, and [`DetailLaw::opacity`] gives back what the sources leave out.

use crate::error::{ConfigError, clamped, in_range};
use crate::ops;
use crate::quadrature::GaussLegendre;

/// Most and least that opacity may make good. Units: none.
const GAIN: [f64; 2] = [0.25, 4.0];

/// How number and size change with distance.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum DetailLaw {
    /// The default: number falls, size grows as 1/√n, so that coverage stays: what is thinned to a share n is drawn
    /// 1/n as large in area.
    #[default]
    OpticalDepth,
    /// n = 1 − d, s = least + (most − least) d² (Puig-Centelles, Ripolles & Chover 2009, with a floor: their d² alone makes
    /// the nearest drops vanish).
    Quadratic {
        /// Size at the eye. Units: none. Domain: (0, 10].
        least: f64,
        /// Size at the reach. Units: none. Domain: [least, 100].
        most: f64,
    },
    /// n = e^(−9d²/2): positions along the view from a normal distribution about the eye, three standard deviations to the
    /// reach; s as for [`DetailLaw::Quadratic`].
    Gaussian {
        /// As above.
        least: f64,
        /// As above.
        most: f64,
    },
}

impl DetailLaw {
    /// The published pair with the sizes of 1 at the eye and 2 at the reach.
    pub const QUADRATIC: Self = Self::Quadratic { least: 1.0, most: 2.0 };
    /// The normal distribution with the same sizes.
    pub const GAUSSIAN: Self = Self::Gaussian { least: 1.0, most: 2.0 };

    /// This law, if its sizes lie in their domains.
    ///
    /// # Errors
    /// Names the first that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        if let Self::Quadratic { least, most } | Self::Gaussian { least, most } = self {
            in_range("least", least, 1e-3, 10.0, "0.001 to 10")?;
            in_range("most", most, least, 100.0, "least to 100")?;
        }
        Ok(self)
    }

    /// Share of the drops that is drawn at `d` (none, held in [0, 1]). Units: none. In [0, 1].
    ///
    /// Error: 1e-15.
    #[must_use]
    pub fn number(self, d: f64) -> f64 {
        let d = clamped(d, 0.0, 1.0);
        match self {
            // A quarter of the drops at the reach: twice as large.
            Self::OpticalDepth => 1.0 / ((1.0 + d) * (1.0 + d)),
            Self::Quadratic { .. } => 1.0 - d,
            Self::Gaussian { .. } => ops::exp(-4.5 * d * d),
        }
    }

    /// Factor on a drop's own size at `d` (none, held in [0, 1]). Units: none.
    ///
    /// Error: 1e-15 relative.
    #[must_use]
    pub fn size(self, d: f64) -> f64 {
        let d = clamped(d, 0.0, 1.0);
        match self {
            Self::OpticalDepth => 1.0 + d,
            Self::Quadratic { least, most } | Self::Gaussian { least, most } => least + (most - least) * d * d,
        }
    }

    /// [`DetailLaw::size`] as c₀ + c₁ d + c₂ d², for shaders.
    #[must_use]
    pub fn size_terms(self) -> [f32; 3] {
        match self {
            Self::OpticalDepth => [1.0, 1.0, 0.0],
            Self::Quadratic { least, most } | Self::Gaussian { least, most } => {
                [least as f32, 0.0, (most - least) as f32]
            }
        }
    }

    /// Coverage of the thinned and scaled field at `d` against the full one: n s². Units: none.
    ///
    /// Error: 1e-14 relative; of the default exactly 1 within that.
    #[must_use]
    pub fn coverage(self, d: f64) -> f64 {
        let size = self.size(d);
        self.number(d) * size * size
    }

    /// Factor on a drop's opacity that makes its law's coverage good, held in [0.25, 4]. Units: none.
    ///
    /// Error: 1e-14 relative.
    #[must_use]
    pub fn opacity(self, d: f64) -> f64 {
        clamped(1.0 / self.coverage(d).max(1e-9), GAIN[0], GAIN[1])
    }

    /// Error of the optical depth along a ray from the eye to `d` (none, held in [0.001, 1]) against the full field:
    /// ∫ n s² g dd / d − 1, with [`DetailLaw::opacity`] as g or without. Units: none.
    ///
    /// Error: 1e-9.
    #[must_use]
    pub fn depth_error(self, d: f64, made_good: bool) -> f64 {
        let d = clamped(d, 1e-3, 1.0);
        let of = |x: f64| self.coverage(x) * if made_good { self.opacity(x) } else { 1.0 };
        // The gain's two corners lie anywhere: many panels.
        GaussLegendre::<8>::RULE.integrate_panels(0.0, d, 256, of) / d - 1.0
    }

    /// The distance that a share of the drops lies within, for placing drops by the law: the inverse of ∫ n over [0, d]
    /// (per unit of distance) at `share` (none, held in [0, 1]). Units: none. In [0, 1].
    ///
    /// Error: 1e-12.
    #[must_use]
    pub fn place(self, share: f64) -> f64 {
        let share = clamped(share, 0.0, 1.0);
        match self {
            Self::OpticalDepth => share / (2.0 - share),
            Self::Quadratic { .. } => share / (1.0 + ops::sqrt(1.0 - share)),
            Self::Gaussian { .. } => {
                let root = 3.0 / core::f64::consts::SQRT_2;
                let whole = ops::erf(root);
                let (mut low, mut high) = (0.0, 1.0);
                for _ in 0..48 {
                    let middle = 0.5 * (low + high);
                    if ops::erf(root * middle) < share * whole {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                0.5 * (low + high)
            }
        }
    }
}
