//! How to cut drop sizes into classes: why the drop field has twelve, with logarithmic edges.
//!
//! All drops of a class move at one speed, ∫Nv/∫N at one rain rate, so that changing rain moves no drop. What that
//! costs is the class error of this module; the study `size-classes` of the bench programme draws it for every scheme.
//!
//! # Accuracy
//! Quadratures within 1e-6; the errors that they measure are 1e-3 and more.

use super::drop_sizes::DropSizes;
use super::spectrum::power;
use crate::error::{ConfigError, in_range};
use crate::ops;

/// Where the borders of classes lie.
#[derive(Default, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ClassScheme {
    /// Equal ratios of diameters: the drop field's.
    #[default]
    Logarithmic,
    /// Equal steps of fall speed.
    EqualSpeed,
    /// Equal steps of diameter.
    EqualDiameter,
}

impl ClassScheme {
    /// Every scheme.
    pub const ALL: [Self; 3] = [Self::Logarithmic, Self::EqualSpeed, Self::EqualDiameter];

    /// Fills `edges` with the borders of `edges.len() − 1` classes from `min_mm` to `max_mm`. Units: mm.
    ///
    /// `speed_m_s`: a rising fall law (mm in, m/s out).
    ///
    /// Error: 2e-15 relative, of equal speeds 1e-13 m/s.
    ///
    /// # Errors
    /// When `min_mm` is outside [0.01, 10], `max_mm` outside (min, 20], or there are fewer than two edges.
    pub fn edges(
        self,
        min_mm: f64,
        max_mm: f64,
        speed_m_s: impl Fn(f64) -> f64,
        edges: &mut [f64],
    ) -> Result<(), ConfigError> {
        let a = in_range("min_mm", min_mm, 0.01, 10.0, "0.01 to 10 mm")?;
        let b = in_range("max_mm", max_mm, a * (1.0 + 1e-9), 20.0, "above min_mm, to 20 mm")?;
        if edges.len() < 2 {
            return Err(ConfigError::Empty { field: "edges" });
        }
        let last = (edges.len() - 1) as f64;
        for (i, edge) in edges.iter_mut().enumerate() {
            let s = i as f64 / last;
            *edge = match self {
                Self::Logarithmic => a * ops::pow(b / a, s),
                Self::EqualDiameter => a + s * (b - a),
                Self::EqualSpeed => {
                    let target = speed_m_s(a) + s * (speed_m_s(b) - speed_m_s(a));
                    let (mut low, mut high) = (a, b);
                    for _ in 0..60 {
                        let mid = 0.5 * (low + high);
                        if speed_m_s(mid) < target {
                            low = mid;
                        } else {
                            high = mid;
                        }
                    }
                    0.5 * (low + high)
                }
            };
        }
        edges[0] = a;
        edges[last as usize] = b;
        Ok(())
    }
}

/// What it costs to give every drop of a class one speed, and one size to stand for its extinction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClassErrors {
    /// Σ number · class speed over ∫ N v dD, less 1. Units: none.
    pub number_flux: f64,
    /// Σ water · class speed over ∫ N v D³ dD, less 1. Units: none.
    pub water_flux: f64,
    /// Σ number · square of the class's diameter over ∫ N D² dD, less 1, with the diameter of the held rate. 0 when
    /// every drop keeps its own. Units: none.
    pub extinction: f64,
    /// Root mean square of class speed over own speed, less 1, weighted by D² N. Units: none.
    pub speed_rms: f64,
    /// Largest deviation of class speed from own speed. Units: none.
    pub speed_max: f64,
}

impl ClassErrors {
    /// Errors of the classes between `edges` (mm, rising) for drops of `sizes`, with class speeds and diameters from
    /// `held` and the fall law `speed_m_s` (mm in, m/s out, above 0 from the first edge on).
    ///
    /// Error: 1e-6 against fine sums.
    ///
    /// # Errors
    /// When there are fewer than two edges, or they do not rise from above 0.
    pub fn of(
        edges: &[f64],
        sizes: &DropSizes,
        held: &DropSizes,
        speed_m_s: impl Fn(f64) -> f64,
    ) -> Result<Self, ConfigError> {
        if edges.len() < 2 {
            return Err(ConfigError::Empty { field: "edges" });
        }
        in_range("edges", edges[0], 1e-3, 20.0, "rising from 0.001 to 20 mm")?;
        for (index, pair) in edges.windows(2).enumerate() {
            if pair[1].is_nan() || pair[1] <= pair[0] {
                return Err(ConfigError::NotIncreasing {
                    field: "edges",
                    index: index + 1,
                    value: pair[1],
                    previous: pair[0],
                });
            }
        }
        let mut sums = [0.0; 7];
        let mut speed_max = 0.0_f64;
        for pair in edges.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let number = held.moment(0, a, b);
            let u = held.flux_moment(0, a, b, &speed_m_s) / number;
            let square = held.moment(2, a, b) / number;
            let off = |d: f64| u / speed_m_s(d) - 1.0;
            speed_max = speed_max.max(off(a).abs()).max(off(b).abs());
            for (sum, term) in sums.iter_mut().zip([
                u * sizes.moment(0, a, b),
                sizes.flux_moment(0, a, b, &speed_m_s),
                u * sizes.moment(3, a, b),
                sizes.flux_moment(3, a, b, &speed_m_s),
                square * sizes.moment(0, a, b),
                sizes.moment(2, a, b),
                sizes.integral(a, b, |d| d * d * power(off(d), 2)),
            ]) {
                *sum += term;
            }
        }
        Ok(Self {
            number_flux: sums[0] / sums[1] - 1.0,
            water_flux: sums[2] / sums[3] - 1.0,
            extinction: sums[4] / sums[5] - 1.0,
            speed_rms: ops::sqrt(sums[6] / sums[5]),
            speed_max,
        })
    }
}
