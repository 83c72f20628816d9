//! Infiltration by a wetting front: Green & Ampt 1911.
//!
//! Under standing water F − M ln(1 + F/M) = K t and f = K (1 + M/F), with M = ψ Δθ: suction of the front times the
//! pore space it fills. Rain slower than f goes in whole, until f has fallen to it (ponding). The state is what has
//! infiltrated, so a pause uses nothing up and any cut of an interval ends the same.
//!
//! # Accuracy
//! A sharp front in a uniform, deep soil; no redistribution in dry spells (use [`crate::weather::Infiltration`] where
//! recovery matters). K and ψ of a texture class scatter by a factor of ten between samples.

use crate::error::{ConfigError, clamped, in_range};
use crate::ops;

/// Texture classes with the mean parameters of Rawls et al. 1983.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SoilTexture {
    /// K 117.8 mm/h, ψ 49.5 mm.
    Sand,
    /// K 10.9 mm/h, ψ 110.1 mm.
    SandyLoam,
    /// K 3.4 mm/h, ψ 88.9 mm.
    Loam,
    /// K 6.5 mm/h, ψ 166.8 mm.
    SiltLoam,
    /// K 1.0 mm/h, ψ 208.8 mm.
    ClayLoam,
    /// K 0.3 mm/h, ψ 316.3 mm.
    Clay,
}

impl SoilTexture {
    /// All classes, from coarse to fine.
    pub const ALL: [Self; 6] = [
        Self::Sand,
        Self::SandyLoam,
        Self::Loam,
        Self::SiltLoam,
        Self::ClayLoam,
        Self::Clay,
    ];

    /// The soil with `moisture_deficit` (pore space not filled, domain [0, 0.6]; 0.3 is a dry loam).
    ///
    /// # Errors
    /// When the deficit is outside its domain.
    pub fn soil(self, moisture_deficit: f64) -> Result<GreenAmpt, ConfigError> {
        let (conductivity_mm_h, suction_mm) = match self {
            Self::Sand => (117.8, 49.5),
            Self::SandyLoam => (10.9, 110.1),
            Self::Loam => (3.4, 88.9),
            Self::SiltLoam => (6.5, 166.8),
            Self::ClayLoam => (1.0, 208.8),
            Self::Clay => (0.3, 316.3),
        };
        GreenAmpt {
            conductivity_mm_h,
            suction_mm,
            moisture_deficit,
        }
        .validated()
    }
}

/// A soil with a sharp wetting front.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GreenAmpt {
    /// Conductivity behind the front K. Units: mm/h. Domain: [1e-6, 10000].
    pub conductivity_mm_h: f64,
    /// Suction at the front ψ. Units: mm. Domain: [0, 10000].
    pub suction_mm: f64,
    /// Pore space that the front fills Δθ. Units: none. Domain: [0, 0.6]. 0: wet soil, F = K t.
    pub moisture_deficit: f64,
}

impl GreenAmpt {
    /// These parameters, if they lie in their domains.
    ///
    /// # Errors
    /// Names the first that does not.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range(
            "conductivity_mm_h",
            self.conductivity_mm_h,
            1e-6,
            1e4,
            "1e-6 to 10000 mm/h",
        )?;
        in_range("suction_mm", self.suction_mm, 0.0, 1e4, "0 to 10000 mm")?;
        in_range("moisture_deficit", self.moisture_deficit, 0.0, 0.6, "0 to 0.6")?;
        Ok(self)
    }

    /// M = ψ Δθ. Units: mm. Error: one rounding.
    #[must_use]
    pub fn front_mm(&self) -> f64 {
        self.suction_mm * self.moisture_deficit
    }

    /// What the soil could take at most after `infiltrated_mm`, K (1 + M/F). Units: mm/h.
    /// NaN and amounts below 1e-9 mm count as 1e-9 mm: f is infinite at F = 0. Error: 1e-15 relative.
    #[must_use]
    pub fn capacity_mm_h(&self, infiltrated_mm: f64) -> f64 {
        self.conductivity_mm_h * (1.0 + self.front_mm() / clamped(infiltrated_mm, 1e-9, 1e12))
    }

    /// What has infiltrated `time_h` after the dry soil was flooded. Units: mm, hours.
    /// Times below 0 and NaN count as 0, those above 1e9 h as 1e9 h. Error: 1e-12 relative in its own equation, 1e-8
    /// against its integral summed, which is as far as the sum reaches.
    #[must_use]
    pub fn flooded_mm(&self, time_h: f64) -> f64 {
        self.flooded_from_mm(0.0, time_h)
    }

    /// What has infiltrated after `time_h` more under standing water, from the state `infiltrated_mm`. Units: mm,
    /// hours. Whoever has less water than this standing limits it. Negative values and NaN count as 0, states above
    /// 1e12 mm as that, times above 1e9 h as 1e9 h. Error: 1e-12 relative.
    #[must_use]
    pub fn flooded_from_mm(&self, infiltrated_mm: f64, time_h: f64) -> f64 {
        let infiltrated_mm = clamped(infiltrated_mm, 0.0, 1e12);
        let gravity = self.conductivity_mm_h * clamped(time_h, 0.0, 1e9);
        let m = self.front_mm();
        if m <= 1e-9 * gravity || m <= 1e-15 * infiltrated_mm || gravity == 0.0 {
            // The front's part, M ln(1 + F/M), is that of F without it to the last digits (or there is no time).
            let growth = gravity / (m + infiltrated_mm);
            let part = if growth.is_finite() {
                m * ops::ln_1p(growth)
            } else {
                0.0
            };
            return infiltrated_mm + gravity + part;
        }
        m * front_root(front(infiltrated_mm / m) + gravity / m)
    }

    /// When constant rain on the dry soil begins to stand, K M/(R (R − K)). Units: hours; infinite rain or NaN: 0.
    /// `None` if R ≤ K: the soil takes it for ever. Error: 1e-15 relative.
    #[must_use]
    pub fn ponding_time_h(&self, rain_mm_h: f64) -> Option<f64> {
        if rain_mm_h <= self.conductivity_mm_h {
            return None;
        }
        let r = if rain_mm_h.is_finite() { rain_mm_h } else { f64::MAX };
        Some(self.conductivity_mm_h * self.front_mm() / r / (r - self.conductivity_mm_h))
    }

    /// The state (water infiltrated so far, mm) after `time_h` of constant rain without standing water at the start.
    ///
    /// All of the rain goes in while it is below the capacity; then the soil takes what it can, as if flooded, also
    /// when rain that fell earlier in the call stands. Units: mm, mm/h, hours. Negative values and NaN count as 0,
    /// rain above 1e6 mm/h as 1e6, times above 1e9 h as 1e9. Never more than state + rain·time. Error: 1e-12 relative.
    #[must_use]
    pub fn infiltrated_mm(&self, state_mm: f64, rain_mm_h: f64, time_h: f64) -> f64 {
        let state = clamped(state_mm, 0.0, 1e12);
        let rain = clamped(rain_mm_h, 0.0, 1e6);
        let time = clamped(time_h, 0.0, 1e9);
        let all = state + rain * time;
        let k = self.conductivity_mm_h;
        if rain <= k {
            return all;
        }
        let ponds_at = k * self.front_mm() / (rain - k);
        if all <= ponds_at {
            return all;
        }
        let dry_time = ((ponds_at - state) / rain).max(0.0);
        self.flooded_from_mm(state.max(ponds_at), time - dry_time).min(all)
    }
}

/// x − ln(1 + x) for x ≥ 0, without cancellation.
fn front(x: f64) -> f64 {
    if x > 0.5 {
        return x - ops::ln_1p(x);
    }
    // ln(1 + x) = 2 (s + s³/3 + s⁵/5 + …), s = x/(2 + x), and x − 2 s = x s.
    let s = x / (2.0 + x);
    let square = s * s;
    let mut term = s * square;
    let mut sum = 0.0;
    let mut n = 3.0;
    while term > 1e-18 * x * s {
        sum += term / n;
        term *= square;
        n += 2.0;
    }
    x * s - 2.0 * sum
}

/// The x ≥ 0 with x − ln(1 + x) = t, t ≥ 0.
///
/// The left side is convex, and t + √(2t) lies above the root: Newton falls towards it. Source of the start:
/// docs/physics.md.
fn front_root(t: f64) -> f64 {
    let mut x = t + ops::sqrt(2.0 * t);
    if x == 0.0 {
        return 0.0;
    }
    for _ in 0..16 {
        let step = (front(x) - t) * (1.0 + x) / x;
        x -= step;
        if step.abs() <= 1e-16 * x {
            break;
        }
    }
    x
}
