//! Other ways to solve the storage equation, kept for comparison. The default is exact:
//! [`CanopyStore`](super::CanopyStore).

use super::store::LEAST_RAIN_MM_H;
use crate::error::clamped;
use crate::ops;

/// Largest exponent whose exponential is used as it is.
const MAX_EXPONENT: f64 = 700.0;

/// Stored depth after `dt_s` by first-order splitting: the exact step without evaporation, then C ← max(0, C − E dt).
///
/// `capacity_mm` S > 0 and `stored_mm` C in [0, S] in mm, `rain_mm_h` (intercepted) and `evaporation_mm_h` in mm/h.
/// Bad numbers count as 0. Units: mm.
///
/// Error: 3.1e-3 S at dt = 0.05 t_sat, 1.1e-3 at 0.02, 2.6e-4 at 0.005 (R = 10, S = 0.6, E = 0.5): first order, its
/// budget closes; the step itself 1e-15 S.
#[must_use]
pub fn stored_by_splitting(capacity_mm: f64, stored_mm: f64, rain_mm_h: f64, evaporation_mm_h: f64, dt_s: f64) -> f64 {
    let Some(case) = Case::new(capacity_mm, stored_mm, rain_mm_h, evaporation_mm_h, dt_s) else {
        return 0.0;
    };
    let root = ops::sqrt(1.0 - case.stored / case.capacity);
    let left = (root - case.rain * case.dt / (2.0 * case.capacity)).max(0.0);
    let filled = case.capacity * (1.0 - left) * (1.0 + left);
    (filled - case.evaporation * case.dt).clamp(0.0, case.capacity)
}

/// Stored depth after `dt_s` by Lambert's W: y = y_e (1 + W₀(x₀ e^(x₀ − R t/(2 S y_e)))), x₀ = y₀/y_e − 1.
///
/// Arguments, units and clamps as [`stored_by_splitting`]. Above exponents of 700 it uses W₀(e^z) ≈ the root of
/// w + ln w = z; rain below 1e-9 mm/h counts as none. Source: physics of [`CanopyStore`](super::CanopyStore) in closed
/// form.
/// Error: 1e-13 S up to E = 5 R; beyond, 1 + W₀ cancels and the error grows as (E/R)² to 2e-5 S at E = 2e5 R, from
/// where splitting is nearer and is used. The change over a short step is a difference of two such values, and times
/// cannot be asked for.
#[must_use]
pub fn stored_by_lambert_w(capacity_mm: f64, stored_mm: f64, rain_mm_h: f64, evaporation_mm_h: f64, dt_s: f64) -> f64 {
    let Some(case) = Case::new(capacity_mm, stored_mm, rain_mm_h, evaporation_mm_h, dt_s) else {
        return 0.0;
    };
    if case.rain * 3600.0 < LEAST_RAIN_MM_H {
        return case.stored * ops::exp(-case.evaporation * case.dt / case.capacity);
    }
    if case.evaporation <= 1e-12 * case.rain || case.evaporation >= 2e5 * case.rain {
        return stored_by_splitting(capacity_mm, stored_mm, rain_mm_h, evaporation_mm_h, dt_s);
    }
    let equilibrium = case.evaporation / case.rain;
    let start = ops::sqrt(1.0 - case.stored / case.capacity);
    let x0 = start / equilibrium - 1.0;
    let exponent = x0 - case.rain * case.dt / (2.0 * case.capacity * equilibrium);
    let w = if exponent < MAX_EXPONENT {
        lambert_w0(x0 * ops::exp(exponent))
    } else {
        omega(exponent + ops::ln(x0))
    };
    let y = (equilibrium * (1.0 + w)).clamp(0.0, 1.0);
    case.capacity * (1.0 - y) * (1.0 + y)
}

/// Principal branch of Lambert's W: the w ≥ −1 with w e^w = x.
///
/// `x` in [−1/e, ∞); below, and what is not a number, counts as −1/e. Infinity returns W₀(f64::MAX). Units: none.
/// Error: |w e^w − x| ≤ 4e-13 max(|x|, 0.4). Source: Halley's iteration.
#[must_use]
pub fn lambert_w0(x: f64) -> f64 {
    let branch = -1.0 / core::f64::consts::E;
    if x.is_nan() || x <= branch {
        return -1.0;
    }
    let x = x.min(f64::MAX);
    let mut w = if x < -0.2 {
        let p = ops::sqrt((2.0 * (core::f64::consts::E * x + 1.0)).max(0.0));
        -1.0 + p * (1.0 - p * (1.0 / 3.0 - p * (11.0 / 72.0)))
    } else if x < 3.0 {
        let l = ops::ln_1p(x);
        l * (1.0 - ops::ln_1p(l) / (2.0 + l))
    } else {
        let l = ops::ln(x);
        return omega(l);
    };
    for _ in 0..20 {
        let e = ops::exp(w);
        let f = w * e - x;
        let slope = e * (w + 1.0);
        let step = f / (slope - (w + 2.0) * f / (2.0 * (w + 1.0)));
        if !step.is_finite() || step.abs() <= 1e-16 * w.abs() {
            break;
        }
        w -= step;
    }
    w
}

/// The w > 0 with w + ln w = z, for z ≥ 1: W₀(e^z) without the exponential.
fn omega(z: f64) -> f64 {
    let mut w = if z > 1.5 { z - ops::ln(z) } else { z };
    for _ in 0..20 {
        // Newton in w of the convex w + ln w − z, scaled so that it stays positive.
        let step = (z - w - ops::ln(w)) * w / (1.0 + w);
        w = (w + step).max(0.1 * w);
        if step.abs() <= 2e-16 * w {
            break;
        }
    }
    w
}

/// Arguments in mm and mm/s, held in their domains.
struct Case {
    capacity: f64,
    stored: f64,
    rain: f64,
    evaporation: f64,
    dt: f64,
}

impl Case {
    /// None without capacity.
    fn new(capacity: f64, stored: f64, rain: f64, evaporation: f64, dt: f64) -> Option<Self> {
        let rate = |value: f64| clamped(value, 0.0, 1e4) / 3600.0;
        (capacity.is_finite() && capacity > 0.0).then(|| Self {
            capacity,
            stored: clamped(stored, 0.0, capacity),
            rain: rate(rain),
            evaporation: rate(evaporation),
            dt: clamped(dt, 0.0, 1e9),
        })
    }
}
