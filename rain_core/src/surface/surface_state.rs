//! The four states of a wet surface: dry, wet, drenched, puddle (Nakamae et al. 1990), as continuous weights.
//!
//! Two numbers say how wet a point is: the pore saturation w in [0, 1] and the film h on it. Water fills the pores
//! first, then the film ([`crate::weather::SurfaceColumn`]). A film below the texture depth covers part of the texture
//! (drenched); at the texture depth and above it is level water (puddle).
//!
//! # Accuracy
//! The ramps (cover over [0, T], puddle over [0.8 T, 1.2 T]) are choices, made so that no weight jumps.

use crate::error::{ConfigError, clamped, in_range};

/// Texture depths below this count as this: a weight over a ramp of no width would jump. Units: mm.
const MIN_TEXTURE_MM: f64 = 0.01;

/// 0 below `from`, 1 above `to`, 3t² − 2t³ between. NaN gives 0. For `to` ≤ `from` a step at `from`.
pub(super) fn smoothstep(from: f64, to: f64, x: f64) -> f64 {
    if x.is_nan() || x <= from {
        return 0.0;
    }
    if x >= to || to <= from {
        return 1.0;
    }
    let t = (x - from) / (to - from);
    t * t * (3.0 - 2.0 * t)
}

/// [`smoothstep`] in single precision.
pub(super) fn smoothstep_f32(from: f32, to: f32, x: f32) -> f32 {
    if x.is_nan() || x <= from {
        return 0.0;
    }
    if x >= to || to <= from {
        return 1.0;
    }
    let t = (x - from) / (to - from);
    t * t * (3.0 - 2.0 * t)
}

/// The state that a point is in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SurfaceState {
    /// No water at all.
    Dry,
    /// Water in the pores, none on top.
    Wet,
    /// A film that leaves the tops of the texture bare.
    Drenched,
    /// Level water over the texture.
    Puddle,
}

impl SurfaceState {
    /// The state of a point: puddle for h ≥ T, drenched for 0 < h < T, else wet for w > 0, else dry.
    /// NaN counts as no water.
    #[must_use]
    pub fn of(saturation: f64, film_mm: f64, texture_depth_mm: f64) -> Self {
        if film_mm > 0.0 {
            if film_mm >= texture_depth_mm {
                Self::Puddle
            } else {
                Self::Drenched
            }
        } else if saturation > 0.0 {
            Self::Wet
        } else {
            Self::Dry
        }
    }
}

/// How much of each state a point shows. The weights are in [0, 1] and add up to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceWeights {
    /// Share that is dry.
    pub dry: f64,
    /// Share that is wet without a film.
    pub wet: f64,
    /// Share under a film within the texture.
    pub drenched: f64,
    /// Share under level water.
    pub puddle: f64,
}

impl SurfaceWeights {
    /// The weights of a pore saturation w and a film h (mm) over a texture of depth T (mm):
    /// puddle = smoothstep(0.8 T, 1.2 T, h), drenched = smoothstep(0, T, h) − puddle, and the rest wet by w.
    ///
    /// w is clamped to [0, 1]; NaN counts as 0. Continuous in w and h, also for T = 0 (T is at least 0.01 mm here).
    /// Error: 3e-16.
    ///
    /// # Errors
    /// When the texture depth is not finite or outside [0, 1000] mm.
    pub fn new(saturation: f64, film_mm: f64, texture_depth_mm: f64) -> Result<Self, ConfigError> {
        in_range("texture_depth_mm", texture_depth_mm, 0.0, 1e3, "0 to 1000 mm")?;
        let t = texture_depth_mm.max(MIN_TEXTURE_MM);
        let w = clamped(saturation, 0.0, 1.0);
        let covered = smoothstep(0.0, t, film_mm);
        // Up to here the first ramp is above the second one; rounding must not make the difference negative.
        let puddle = smoothstep(0.8 * t, 1.2 * t, film_mm).min(covered);
        Ok(Self {
            dry: (1.0 - w) * (1.0 - covered),
            wet: w * (1.0 - covered),
            drenched: covered - puddle,
            puddle,
        })
    }

    /// Share of the surface under water, drenched + puddle: what mirrors. [0, 1]. Error: 3e-16.
    #[must_use]
    pub fn covered(&self) -> f64 {
        self.drenched + self.puddle
    }
}
