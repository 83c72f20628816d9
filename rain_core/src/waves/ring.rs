//! Rings of drops without a grid: far from its drop a ring is a packet of fixed shape that spreads as r^(−½).
//!
//! A Gaussian bump on water with one wave speed, u₀ = e^(−r²/2s²), is u = s²∫e^(−k²s²/2) cos(ckt) J₀(kr) k dk. With
//! J₀(z) ≈ √(2/(πz)) [cos(z − π/4) + sin(z − π/4)/(8z)] and x = (r − ct)/s this is
//!
//! u = √(s/r) [F(x) + s/(8r) H(x)],  F(x) = (2π)^(−½) ∫₀^∞ √κ e^(−κ²/2) cos(κx − π/4) dκ,  H′ = F, H(∞) = 0.
//!
//! A pressure impulse Δu_t = A∇²e^(−r²/2s²) makes −A/(cs) times the same with F′ for F and F for H.
//!
//! # Accuracy
//! One wave speed and one damping. From r = 5 s on and within −3 s to 5 s of the front the error against the integral
//! is below 1 % of the crest, below 0.2 % from r = 10 s on for rings of drops; without the second term it is 1 % there.
//! Inside r = s the value at r = s is used. Surface tension, which makes short waves run ahead, is left out: 5 % of the
//! crest on 5 mm of water.

use super::impact::DropImpact;
use crate::constants::WATER_DENSITY;
use crate::error::{ConfigError, in_range};
use crate::ops;

/// Where the table starts and ends, and its points for each unit of x.
const FIRST: f32 = -16.0;
const LAST: f32 = 7.0;
const PER_UNIT: f32 = 16.0;

/// The ring of one drop, to be drawn by a [`RingTable`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ring {
    /// Height of the drop's own water, V/(2πs²). Units: m.
    pub bump_m: f32,
    /// Height that the impulse makes, h m v/(2πρ s³ c). Units: m.
    pub push_m: f32,
    /// Standard deviation s of the impact. Units: m.
    pub width_m: f32,
    /// Wave speed. Units: m/s.
    pub speed_m_s: f32,
    /// Decay rate of the amplitude, half of k_d. Units: 1/s.
    pub decay_per_s: f32,
}

impl Ring {
    /// The ring of an impact on water of a depth, with the width of [`DropImpact::width_m`].
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`]: a field of `impact` outside its domain, `depth_m` not in [1e-4, 100] m,
    /// `damping_per_s` (k_d) not in [0, 1e4] 1/s.
    pub fn new(impact: &DropImpact, depth_m: f64, damping_per_s: f64) -> Result<Self, ConfigError> {
        impact.check()?;
        in_range("depth_m", depth_m, 1e-4, 100.0, "1e-4 to 100 m")?;
        in_range("damping_per_s", damping_per_s, 0.0, 1e4, "0 to 1e4 1/s")?;
        let speed = super::shallow_speed(depth_m);
        // No narrower than a micrometre: a drop of no size makes no ring, but must not divide by 0.
        let s = impact.width_m(5e-7, depth_m);
        let around = core::f64::consts::TAU * s * s;
        let push = depth_m * impact.momentum() / (WATER_DENSITY * around * s * speed);
        Ok(Self {
            bump_m: (impact.volume_m3() / around) as f32,
            push_m: push as f32,
            width_m: s as f32,
            speed_m_s: speed as f32,
            decay_per_s: (0.5 * damping_per_s) as f32,
        })
    }
}

/// H, F, F′, F″ and F‴ at equal steps of x. Allocates 7.4 kB once; look-ups are cubic.
#[derive(Debug, Clone)]
pub struct RingTable {
    rows: Vec<[f32; 5]>,
    /// Largest |F′| and |F″|.
    steepest: [f32; 2],
}

impl Default for RingTable {
    fn default() -> Self {
        Self::new()
    }
}

impl RingTable {
    /// Works the integrals out: about 5 ms.
    #[must_use]
    pub fn new() -> Self {
        let count = ((LAST - FIRST) * PER_UNIT) as usize + 1;
        // κ = q² takes the root away; the integrand is then even and smooth, so equal steps converge fast.
        const NODES: usize = 256;
        let h = 3.0 / NODES as f64;
        let weights: Vec<(f64, f64)> = (0..NODES)
            .map(|i| {
                let q = h * (i as f64 + 0.5);
                let kappa = q * q;
                let weight = 2.0 * h * ops::exp(-0.5 * kappa * kappa) / ops::sqrt(core::f64::consts::TAU);
                (kappa, weight)
            })
            .collect();
        let rows: Vec<[f32; 5]> = (0..count)
            .map(|index| {
                let x = f64::from(FIRST) + index as f64 / f64::from(PER_UNIT);
                let mut row = [0.0_f64; 5];
                for (kappa, weight) in &weights {
                    let phase = kappa * x - core::f64::consts::FRAC_PI_4;
                    let (sine, cosine) = (ops::sin(phase) * weight, ops::cos(phase) * weight);
                    row[0] += sine;
                    row[1] += kappa * cosine;
                    row[2] -= kappa * kappa * sine;
                    row[3] -= kappa * kappa * kappa * cosine;
                    row[4] += kappa * kappa * kappa * kappa * sine;
                }
                row.map(|value| value as f32)
            })
            .collect();
        let largest = |column: usize| rows.iter().fold(0.0_f32, |max, row| max.max(row[column].abs()));
        let steepest = [largest(2), largest(3)];
        Self { rows, steepest }
    }

    /// H, F, F′ and F″ at x = (r − ct)/s; 0 ahead of x = 7, two terms of the asymptotic series behind x = −16. NaN
    /// gives 0.
    ///
    /// Error: absolute 3e-6 against the integrals, where F reaches 0.49.
    #[must_use]
    pub fn packet(&self, x: f32) -> [f32; 4] {
        if x.is_nan() || x >= LAST {
            return [0.0; 4];
        }
        if x < FIRST {
            // −(2π)^(−½) Σ Γ(q) y^(−q)/(2ⁿ n!), q = 2n + 3/2 and one more for each derivative.
            let i = -1.0 / x;
            let (root, i2) = (i.sqrt(), i * i);
            let [h, f, f1, f2] = [
                1.772_453_9 + 0.664_670_2 * i2,
                0.886_226_9 + 1.661_675_4 * i2,
                1.329_340_4 + 5.815_864 * i2,
                3.323_351 + 26.171_39 * i2,
            ];
            let scale = -0.398_942_3 * root;
            return [scale * h, scale * i * f, scale * i2 * f1, scale * i2 * i * f2];
        }
        let place = (x - FIRST) * PER_UNIT;
        let index = (place as usize).min(self.rows.len() - 2);
        let t = place - index as f32;
        let (low, high) = (&self.rows[index], &self.rows[index + 1]);
        let step = 1.0 / PER_UNIT;
        // Cubic Hermite: each column's derivative is the next column.
        let (t2, u) = (t * t, 1.0 - t);
        let u2 = u * u;
        core::array::from_fn(|c| {
            let ends = (1.0 + 2.0 * t) * u2 * low[c] + (1.0 + 2.0 * u) * t2 * high[c];
            ends + step * (t * u2 * low[c + 1] - u * t2 * high[c + 1])
        })
    }

    /// Height of a ring and its slope ∂u/∂r at the distance `r_m` from the impact `age_s` after it. Units: m, none.
    ///
    /// Both are clamped to no less than s (distance) and 0 (age); NaN and infinite inputs give 0.
    ///
    /// Error: of the crest 2e-3 (slope: 1e-3 of crest/s) from r = 10 s on for rings of drops, 1e-2 (7e-3) from 5 s on
    /// for any; nearer see the module.
    #[must_use]
    pub fn height_and_slope(&self, ring: &Ring, r_m: f32, age_s: f32) -> (f32, f32) {
        if !(r_m.is_finite() && age_s.is_finite()) {
            return (0.0, 0.0);
        }
        let s = ring.width_m;
        let (r, age) = (r_m.max(s), age_s.max(0.0));
        let [h, f, f1, f2] = self.packet((r - ring.speed_m_s * age) / s);
        let near = 0.125 * s / r;
        let (bump, push) = (ring.bump_m, ring.push_m);
        let shape = bump * (f + near * h) - push * (f1 + near * f);
        let along = bump * (f1 + near * f) - push * (f2 + near * f1);
        let spread = shape * 0.5 + (bump * h - push * f) * near;
        let amplitude = (s / r).sqrt() * ops::expf(-ring.decay_per_s * age);
        (amplitude * shape, amplitude * (along / s - spread / r))
    }

    /// Age beyond which no part of a ring is steeper than `slope`. Units: s, within [0, 1e3]; a slope that is not
    /// positive gives 1e3.
    ///
    /// Error: 2e-3 of the age against the same law with the steepest slopes of the integrals.
    #[must_use]
    pub fn lifetime_s(&self, ring: &Ring, slope: f32) -> f32 {
        let [f1, f2] = self.steepest;
        let start = (ring.bump_m * f1 + ring.push_m.abs() * f2) / ring.width_m;
        let steepness = |age: f32| {
            let r = (ring.speed_m_s * age).max(ring.width_m);
            start * (ring.width_m / r).sqrt() * ops::expf(-ring.decay_per_s * age)
        };
        // Falls with age: halve the interval.
        let (mut low, mut high) = (0.0_f32, 1e3_f32);
        if slope.is_nan() || slope <= 0.0 {
            return high;
        }
        if steepness(low) <= slope {
            return low;
        }
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if steepness(middle) > slope {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }
}
