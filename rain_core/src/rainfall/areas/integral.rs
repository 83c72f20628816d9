//! Water on a rectangle and rain along a ray, with bounds.

use glam::{DVec2, DVec3, Vec3Swizzles};

use super::field::AreaField;
use crate::quadrature::GaussLegendre;

/// Deepest halving of a rectangle or a ray.
const DEPTH: u32 = 12;
/// Most pieces of a rectangle.
const PIECES: usize = 500_000;

/// Rain on a rectangle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GroundIntegral {
    /// ∫ R dA. Units: mm/h·m², which is litres an hour.
    pub value_mm_h_m2: f64,
    /// No further from the truth than this. Units: mm/h·m².
    pub bound_mm_h_m2: f64,
}

impl AreaField {
    /// Rain on the rectangle from `low_m` to `high_m` (x, z), both finite.
    ///
    /// Quarters are taken until the least and the greatest rate of a piece differ by less than `tolerance` (none, held in
    /// [1e-6, 1]) of the heaviest rain, 12 halvings and half a million pieces at most: a tolerance of 0.05 takes some ten
    /// thousand pieces for an edge of 20 m. Pieces under an edge are integrated by 4 × 4 points.
    ///
    /// Error: never beyond its bound, which the pieces' least and greatest rates give; 1e-3 of what falls with a tolerance of
    /// 0.05.
    #[must_use]
    pub fn integral(&self, low_m: DVec2, high_m: DVec2, weather_mm_h: f64, tolerance: f64) -> GroundIntegral {
        let mut sum = GroundIntegral::default();
        if !(low_m.is_finite() && high_m.is_finite()) {
            return sum;
        }
        let allowed = crate::error::clamped(tolerance, 1e-6, 1.0) * self.highest_mm_h(weather_mm_h);
        let mut open = vec![(0.5 * (low_m + high_m), 0.5 * (high_m - low_m).max(DVec2::ZERO), 0)];
        let mut pieces = 0;
        while let Some((centre, half, depth)) = open.pop() {
            let [least, most] = self.rates_within(centre, half.length(), weather_mm_h);
            let area = 4.0 * half.x * half.y;
            pieces += 1;
            if least == most {
                sum.value_mm_h_m2 += area * least;
            } else if most - least <= allowed || depth >= DEPTH || pieces >= PIECES {
                let rule = GaussLegendre::<4>::RULE;
                let mut mean = 0.0;
                for (x, wx) in rule.nodes.iter().zip(&rule.weights) {
                    for (z, wz) in rule.nodes.iter().zip(&rule.weights) {
                        mean += 0.25 * wx * wz * self.rate_at(centre + half * DVec2::new(*x, *z), weather_mm_h);
                    }
                }
                sum.value_mm_h_m2 += area * mean;
                sum.bound_mm_h_m2 += area * (most - mean).max(mean - least);
            } else {
                let quarter = 0.5 * half;
                for sign in [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]] {
                    open.push((centre + quarter * DVec2::from_array(sign), quarter, depth + 1));
                }
            }
        }
        sum
    }

    /// ∫ g(R) ds along the line from `from_m` to `to_m` (world, both finite, else 0): with the extinction of a rate as g
    /// (units: 1/m; 0 at 0) it is the optical depth of the rain between two points.
    ///
    /// Pieces with one rate are exact; those under an edge are halved to a 64th of the line or an 8th of the transition
    /// and integrated by 8 points.
    ///
    /// Error: 1e-6 relative where edges are soft; a sharp edge is placed to 1/4096 of the line.
    pub fn along(&self, from_m: DVec3, to_m: DVec3, weather_mm_h: f64, mut g: impl FnMut(f64) -> f64) -> f64 {
        if !(from_m.is_finite() && to_m.is_finite()) {
            return 0.0;
        }
        let length = from_m.distance(to_m);
        let place = |t: f64| (from_m + (to_m - from_m) * t).xz();
        let flat = place(0.0).distance(place(1.0));
        let soft = self
            .areas()
            .iter()
            .map(|area| area.transition_m)
            .fold(f64::INFINITY, f64::min);
        let short = (0.125 * soft).min(flat / 64.0);
        let mut open = vec![(0.5, 0.5, 0)];
        let mut sum = 0.0;
        while let Some((middle, half, depth)) = open.pop() {
            let [least, most] = self.rates_within(place(middle), half * flat, weather_mm_h);
            if least == most {
                sum += 2.0 * half * g(least);
            } else if 2.0 * half * flat <= short || depth >= DEPTH {
                let rule = GaussLegendre::<8>::RULE;
                sum += rule.integrate(
                    middle - half,
                    middle + half,
                    |t| g(self.rate_at(place(t), weather_mm_h)),
                );
            } else {
                open.push((middle - 0.5 * half, 0.5 * half, depth + 1));
                open.push((middle + 0.5 * half, 0.5 * half, depth + 1));
            }
        }
        sum * length
    }
}
