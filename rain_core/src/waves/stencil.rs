//! The sum over neighbours that stands for ∇², and how long a step it allows.

use crate::error::{ConfigError, in_range};

/// How the Laplacian is formed.
#[derive(Default, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Stencil {
    /// Four neighbours less four times the cell: cheapest, and closest to the true speed near its bound.
    #[default]
    FivePoint,
    /// (4·edges + corners − 20·cell)/6: the same speed in every direction, so rings stay round.
    NinePoint,
}

impl Stencil {
    /// Largest Courant number C = c dt/dx that is accepted. Units: none.
    ///
    /// A step is stable for every damping iff C² λ_max < 4; λ_max = 8 and 16/3. At equality the checkerboard grows
    /// linearly, so the bound stays a per cent below 1/√2 and √¾.
    #[must_use]
    pub fn max_courant(self) -> f64 {
        match self {
            Self::FivePoint => 0.70,
            Self::NinePoint => 0.86,
        }
    }

    /// `courant` if it is in (0, [`Stencil::max_courant`]].
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] that names the bound.
    pub fn check_courant(self, courant: f64) -> Result<f64, ConfigError> {
        let allowed = match self {
            Self::FivePoint => "above 0, at most 0.70 (five-point stencil: unstable from 1/sqrt(2) on)",
            Self::NinePoint => "above 0, at most 0.86 (nine-point stencil: unstable from sqrt(3)/2 on)",
        };
        // A bound met within rounding is met.
        in_range(
            "courant",
            courant,
            f64::MIN_POSITIVE,
            self.max_courant() * (1.0 + 1e-12),
            allowed,
        )
    }
}

/// Number of equal steps into which an interval must be cut: ⌈c Δt/(C_max dx)⌉, at least 1.
///
/// `speed_m_s` in m/s, `interval_s` in s, `cell_m` in m. Inputs that are not positive and finite, and cuts into more
/// than 2³² steps, give the nearest end of [1, u32::MAX].
///
/// Error: none: the fewest steps within the bound, which counts as met within rounding.
#[must_use]
pub fn sub_steps(stencil: Stencil, speed_m_s: f64, interval_s: f64, cell_m: f64) -> u32 {
    let steps = (speed_m_s * interval_s / (stencil.max_courant() * cell_m) * (1.0 - 1e-12)).ceil();
    // A cast saturates, and makes 0 of NaN.
    (steps as u32).max(1)
}
