//! What a gully takes, and how fast it empties a pond. Source: Brown et al. 2009 (HEC-22).
//!
//! Shallow water falls over the grate's edge like over a weir, Q = 1.66 P d^1.5; deep water is throttled by its
//! openings, Q = 0.67 A √(2 g d). The smaller counts.
//!
//! # Accuracy
//! In sag, unclogged; a clogging allowance belongs in P and A (half of each is usual). Between the two laws the real
//! curve is smooth and lower by up to about 10 %.

use serde::{Deserialize, Serialize};

use crate::constants::GRAVITY;
use crate::error::{ConfigError, clamped, in_range};
use crate::ops;

/// Weir coefficient. Units: m^0.5/s.
const WEIR: f64 = 1.66;
/// Orifice coefficient. Units: none.
const ORIFICE: f64 = 0.67;
/// Depths beyond this count as this. Units: m.
const MAX_DEPTH_M: f64 = 100.0;

/// A grate in the ground.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grate {
    /// Length of the edge that water falls over P. Units: m. Domain: [0, 1000]. 0: shut.
    pub perimeter_m: f64,
    /// Clear opening A. Units: m². Domain: [0, 1000]. 0: shut.
    pub area_m2: f64,
}

impl Grate {
    /// This grate, if its sizes lie in their domains.
    ///
    /// # Errors
    /// Names the first that does not.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range("perimeter_m", self.perimeter_m, 0.0, 1e3, "0 to 1000 m")?;
        in_range("area_m2", self.area_m2, 0.0, 1e3, "0 to 1000 m²")?;
        Ok(self)
    }

    /// Flow over the edge. Units: m³/s, depth in m. Negative depths and NaN count as 0, those above 100 m as 100 m.
    /// Error: 1e-15 relative.
    #[must_use]
    pub fn weir_m3_s(&self, depth_m: f64) -> f64 {
        let d = clamped(depth_m, 0.0, MAX_DEPTH_M);
        WEIR * self.perimeter_m * d * ops::sqrt(d)
    }

    /// Flow through the openings. Units: m³/s, depth in m. Clamps as [`Self::weir_m3_s`]. Error: 1e-15 relative.
    #[must_use]
    pub fn orifice_m3_s(&self, depth_m: f64) -> f64 {
        let d = clamped(depth_m, 0.0, MAX_DEPTH_M);
        ORIFICE * self.area_m2 * ops::sqrt(2.0 * GRAVITY * d)
    }

    /// What the inlet takes: the smaller of the two. Units: m³/s, depth in m.
    /// Error: 1e-15 relative; model error see the module.
    #[must_use]
    pub fn capacity_m3_s(&self, depth_m: f64) -> f64 {
        self.weir_m3_s(depth_m).min(self.orifice_m3_s(depth_m))
    }

    /// The depth at which both laws agree. Units: m. Infinite for a shut edge. Error: 1e-15 relative.
    #[must_use]
    pub fn transition_depth_m(&self) -> f64 {
        if self.perimeter_m == 0.0 {
            return f64::INFINITY;
        }
        ORIFICE * self.area_m2 * ops::sqrt(2.0 * GRAVITY) / (WEIR * self.perimeter_m)
    }

    /// Depth over the inlet after it has drained a pond of constant `pond_area_m2` for `time_s`, exactly:
    /// √d falls linearly under the orifice law, 1/√d rises linearly under the weir law. Units: m, m², s.
    ///
    /// Negative depths and times and NaN count as 0, depths above 100 m as 100 m, times above 1e9 s as 1e9 s; a pond of
    /// area 0 or NaN is empty at once. Error: 3e-8 relative against 20 000 Runge–Kutta steps across the kink.
    #[must_use]
    pub fn drained_depth_m(&self, depth_m: f64, pond_area_m2: f64, time_s: f64) -> f64 {
        let mut root = ops::sqrt(clamped(depth_m, 0.0, MAX_DEPTH_M));
        let mut left = clamped(time_s, 0.0, 1e9);
        if left == 0.0 || root == 0.0 || self.perimeter_m == 0.0 || self.area_m2 == 0.0 {
            return root * root;
        }
        if pond_area_m2.is_nan() || pond_area_m2 <= 0.0 {
            return 0.0;
        }
        let turn = ops::sqrt(self.transition_depth_m());
        if root > turn {
            let fall = 0.5 * ORIFICE * self.area_m2 * ops::sqrt(2.0 * GRAVITY) / pond_area_m2;
            let to_turn = (root - turn) / fall;
            if to_turn >= left {
                root -= fall * left;
                return root * root;
            }
            left -= to_turn;
            root = turn;
        }
        root /= 1.0 + root * 0.5 * WEIR * self.perimeter_m / pond_area_m2 * left;
        root * root
    }
}
