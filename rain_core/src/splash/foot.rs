//! Splashes of feet (Lagarde 2013: E47, E48).

use crate::error::clamped;

/// Speed of a foot whose splash is as strong as any. Units: m/s.
const FULL_SPEED_M_S: f64 = 2.0;
/// Depth of water whose splash is as strong as any. Units: m.
const FULL_DEPTH_M: f64 = 0.01;

/// How strong a foot splashes that comes down at `speed_m_s` into water `depth_m` deep: (v/2 m/s) · (d/10 mm), each at
/// most 1. Units: none. In [0, 1].
///
/// For the loudness of a sound and the size of an effect. Negative numbers and what is not a number count as 0.
/// Error: 3e-16; a look, chosen: a walker's heel strikes at some 1 m/s, a runner's at 2.
#[must_use]
pub fn foot_splash_strength(speed_m_s: f64, depth_m: f64) -> f64 {
    clamped(speed_m_s / FULL_SPEED_M_S, 0.0, 1.0) * clamped(depth_m / FULL_DEPTH_M, 0.0, 1.0)
}
