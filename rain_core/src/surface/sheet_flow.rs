//! Kinematic sheet flow on a plane under rain that starts, lasts and stops: every depth in closed form.
//!
//! ∂h/∂t + ∂q/∂x = i with q = α hᵐ. Along a characteristic dx/dt = m α h^(m−1) the depth grows with i t, so under
//! constant rain h = min(i t, h_s(x)), h_s = (i x/α)^(1/m). After the rain h is constant along characteristics, which
//! gives x = α hᵐ/i + m α h^(m−1) t. With y = h/h_s and τ = i t/h_s this is yᵐ + m τ y^(m−1) = 1: one polynomial
//! for every plane, of degree 5 in y^(1/3) (Manning) or 3 in y (laminar).
//!
//! # Accuracy
//! No pressure and no inertia: the depth's own slope must be small against the bed's. On the planes of the check
//! table the steady depth of the full (local inertial) equations differs by less than 1 %. On a plane askew to its
//! edges (5 % fall, 4 m) rise and steady depth along the fall line are within 2.2 % (L1) of the two-dimensional
//! equations on 80² cells, which is that grid's own error. Rain splash, rills and
//! the change from laminar to turbulent flow on one plane are left out.

use crate::constants::{GRAVITY, M_S_PER_MM_H, WATER_KINEMATIC_VISCOSITY};
use crate::error::{ConfigError, clamped, in_range};
use crate::ops;

/// Resistance of the bed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FlowLaw {
    /// q = √S/n · h^(5/3), turbulent. Source: Manning; n of surfaces: Engman 1986, Brown et al. 2009.
    Manning {
        /// Roughness n. Units: s/m^(1/3). Domain: [0.001, 10]. Smooth asphalt 0.011–0.015, short grass 0.15.
        manning_n: f64,
    },
    /// q = 8 g S h³/(K ν), laminar with the Darcy–Weisbach factor f = K/Re; for Re = q/ν below about 500.
    /// Source: Woolhiser & Liggett 1967.
    Laminar {
        /// K. Units: none. Domain: [24, 10000]. 24 is a smooth bed (then q = g S h³/(3ν)), rough ones reach 500.
        friction: f64,
    },
}

/// A plane under rain. Units: SI, the rain rate in mm/h.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SheetFlow {
    manning: bool,
    coefficient: f64,
    length_m: f64,
    rain_m_s: f64,
}

/// Newton steps of [`recession_share`]. From its starting value five reach the last bit (four: 6e-10).
const NEWTON_STEPS: usize = 5;

impl SheetFlow {
    /// A plane of `length_m` with the fall `slope` under `intensity_mm_h`.
    ///
    /// # Errors
    /// Names the first value outside its domain: manning_n [0.001, 10], friction [24, 10000], slope [1e-6, 10],
    /// length_m [0.01, 10000], intensity_mm_h [0, 10000].
    pub fn new(law: FlowLaw, slope: f64, length_m: f64, intensity_mm_h: f64) -> Result<Self, ConfigError> {
        in_range("slope", slope, 1e-6, 10.0, "1e-6 to 10")?;
        in_range("length_m", length_m, 0.01, 1e4, "0.01 to 10000 m")?;
        in_range("intensity_mm_h", intensity_mm_h, 0.0, 1e4, "0 to 10000 mm/h")?;
        let (manning, coefficient) = match law {
            FlowLaw::Manning { manning_n } => {
                in_range("manning_n", manning_n, 1e-3, 10.0, "0.001 to 10 s/m^(1/3)")?;
                (true, ops::sqrt(slope) / manning_n)
            }
            FlowLaw::Laminar { friction } => {
                in_range("friction", friction, 24.0, 1e4, "24 to 10000")?;
                (false, 8.0 * GRAVITY * slope / (friction * WATER_KINEMATIC_VISCOSITY))
            }
        };
        Ok(Self {
            manning,
            coefficient,
            length_m,
            rain_m_s: intensity_mm_h * M_S_PER_MM_H,
        })
    }

    /// The exponent m: 5/3 or 3.
    #[must_use]
    pub fn exponent(&self) -> f64 {
        if self.manning { 5.0 / 3.0 } else { 3.0 }
    }

    /// q = α hᵐ. Units: m²/s; depth in m. Negative depths and NaN count as 0, those above 1000 m as 1000 m.
    /// Error: 1e-14 relative.
    #[must_use]
    pub fn discharge_m2_s(&self, depth_m: f64) -> f64 {
        let h = clamped(depth_m, 0.0, 1e3);
        if self.manning {
            let c = ops::cbrt(h);
            self.coefficient * h * c * c
        } else {
            self.coefficient * h * h * h
        }
    }

    /// Steady depth at x from the top, (i x/α)^(1/m). Units: m. x is clamped to the plane, NaN counts as 0.
    /// Error: 2e-15 relative; within 1 % of the local inertial equations on the check planes, and 2.2 % (L1) on a plane
    /// askew to a grid, which is that grid's.
    #[must_use]
    pub fn steady_depth_m(&self, x_m: f64) -> f64 {
        let ratio = self.rain_m_s * self.on_plane(x_m) / self.coefficient;
        if self.manning {
            ops::pow(ratio, 0.6)
        } else {
            ops::cbrt(ratio)
        }
    }

    /// Time to equilibrium of the foot, h(L)/i. Units: s. 0 without rain (it is dry at once).
    /// Error: 2e-15 relative.
    #[must_use]
    pub fn equilibrium_time_s(&self) -> f64 {
        if self.rain_m_s > 0.0 {
            self.steady_depth_m(self.length_m) / self.rain_m_s
        } else {
            0.0
        }
    }

    /// Depth at x, `time_s` after the rain began on a dry plane: i t until it meets the steady profile. Units: m.
    /// Times below 0 and NaN count as 0. Error: 1e-14 relative.
    #[must_use]
    pub fn rising_depth_m(&self, x_m: f64, time_s: f64) -> f64 {
        self.steady_depth_m(x_m).min(self.rain_m_s * time_s.max(0.0))
    }

    /// Depth at x, `time_s` after rain that had made the plane steady stopped. Units: m.
    /// Times below 0 and NaN count as 0. Error: 1e-14 relative.
    #[must_use]
    pub fn recession_depth_m(&self, x_m: f64, time_s: f64) -> f64 {
        let steady = self.steady_depth_m(x_m);
        if steady == 0.0 {
            return 0.0;
        }
        let scaled = self.exponent() * (self.rain_m_s * time_s.max(0.0) / steady);
        let share = if self.manning {
            let root = recession_share(5, scaled, NEWTON_STEPS);
            root * root * root
        } else {
            recession_share(3, scaled, NEWTON_STEPS)
        };
        steady * share
    }

    /// Depth at x, `time_s` after the beginning of rain that lasts `duration_s`, whether or not it makes the plane
    /// steady. Units: m.
    ///
    /// After short rain the depth i·duration moves down the plane unchanged until the recession from the steady part
    /// above overtakes it, so it is the smaller of the two. Error: 1e-14 relative to that; 1e-5 against characteristics
    /// followed in steps, which is as far as those reach.
    #[must_use]
    pub fn depth_m(&self, x_m: f64, time_s: f64, duration_s: f64) -> f64 {
        let duration = duration_s.max(0.0);
        let rising = self.rising_depth_m(x_m, time_s.min(duration));
        if time_s > duration {
            rising.min(self.recession_depth_m(x_m, time_s - duration))
        } else {
            rising
        }
    }

    fn on_plane(&self, x_m: f64) -> f64 {
        clamped(x_m, 0.0, self.length_m)
    }
}

/// The root u in [0, 1] of uᵖ + c u² = 1 for p = 3 or 5 and c ≥ 0, by `steps` of Newton's rule.
///
/// The left side is convex and rises, and min(1, 1/√c) lies above the root, so the steps fall towards it and never
/// pass it. NaN and negative c count as 0, infinite c gives 0. Error: after 5 steps 1e-15 relative.
#[must_use]
pub fn recession_share(power: u8, c: f64, steps: usize) -> f64 {
    let c = c.max(0.0);
    let mut u = if c > 1.0 { 1.0 / ops::sqrt(c) } else { 1.0 };
    if u == 0.0 {
        return 0.0;
    }
    for _ in 0..steps {
        let cubed = u * u * u;
        let (value, slope) = if power == 3 {
            (cubed, 3.0 * u * u)
        } else {
            (cubed * u * u, 5.0 * cubed * u)
        };
        u -= (value + c * u * u - 1.0) / (slope + 2.0 * c * u);
    }
    u
}
