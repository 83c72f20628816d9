//! Extinction as a sum over drops, and ways marched step by step.

use crate::numerics::simpson;

/// ∫ D²N dD · π/4 in 1/m for N = n0 e^(−slope D), n0 in m⁻³ mm⁻¹, slope in 1/mm, over [a, b] mm.
pub fn geometric_extinction(n0: f64, slope: f64, a: f64, b: f64) -> f64 {
    simpson(a, b, 4000, |d| {
        core::f64::consts::FRAC_PI_4 * d * d * 1e-6 * n0 * (-slope * d).exp()
    })
}

/// t²(3 − 2t) between a and b.
pub fn smooth(x: f64, a: f64, b: f64) -> f64 {
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Weight of single drops at r for range z (drop-field rule).
pub fn near_weight(r: f64, z: f64) -> f64 {
    smooth(r, 0.1, 0.2) - smooth(r, 0.8 * z, 1.2 * z)
}

/// Weight of cards at r for range z.
pub fn mid_weight(r: f64, z: f64) -> f64 {
    let b = (0.8 * z).max(3.2);
    smooth(r, b, 1.5 * b) - smooth(r, 24.0, 36.0)
}

/// ∫ of a weight along a way, in steps that end at every corner in `corners`.
pub fn along(way: f64, corners: &[f64], weight: impl Fn(f64) -> f64) -> f64 {
    let mut ends: Vec<f64> = corners.iter().copied().filter(|c| *c > 0.0 && *c < way).collect();
    ends.push(way);
    ends.sort_by(f64::total_cmp);
    let mut from = 0.0;
    let mut sum = 0.0;
    for end in ends {
        sum += simpson(from, end, 20, &weight);
        from = end;
    }
    sum
}

/// Transmittance by a march of `steps` equal steps with the extinction at each middle.
pub fn marched(way: f64, steps: u32, extinction: impl Fn(f64) -> f64) -> f64 {
    let h = way / f64::from(steps);
    (0..steps)
        .map(|i| 1.0 - (extinction((f64::from(i) + 0.5) * h) * h).min(1.0))
        .product()
}

/// Optical depth of haze σ₀ up to y₀, σ₀ e^(−(y−y₀)/H) above, along a straight way.
pub fn profile_depth(base: f64, base_height: f64, scale: f64, from: f64, to: f64, way: f64) -> f64 {
    let density = |t: f64| {
        let y = from + (to - from) * t;
        base * (-((y - base_height) / scale).max(0.0)).exp()
    };
    let corner = (base_height - from) / (to - from);
    if corner > 0.0 && corner < 1.0 {
        way * (simpson(0.0, corner, 2000, density) + simpson(corner, 1.0, 2000, density))
    } else {
        way * simpson(0.0, 1.0, 2000, density)
    }
}

/// 1 − e^(−τ) by the hyperbolic tangent.
pub fn lost(depth: f64) -> f64 {
    let t = (0.5 * depth).tanh();
    2.0 * t / (1.0 + t)
}

/// ∫₀¹ e^(−xs) ds, in pieces short against the decay.
pub fn mean_decay(x: f64) -> f64 {
    let pieces = 1 + x.min(60.0) as usize;
    let end = (60.0 / x).min(1.0);
    (0..pieces)
        .map(|i| {
            simpson(
                end * i as f64 / pieces as f64,
                end * (i + 1) as f64 / pieces as f64,
                600,
                |s| (-x * s).exp(),
            )
        })
        .sum()
}

/// Fog amount by relative intensity: what the slope of each piece adds up to.
pub fn table_fog(x: f64) -> f64 {
    let part = |from: f64, to: f64| x.clamp(from, to) - from;
    0.15 / 0.33 * part(0.0, 0.33) + 0.25 / 0.33 * part(0.33, 0.66) + 0.6 / 0.34 * part(0.66, 1.0)
}

/// Mean weight of the middle tier over a card of depth `a` about `r`.
pub fn card(r: f64, a: f64, z: f64) -> f64 {
    let b = (0.8 * z).clamp(3.2, 24.0);
    let weight = |s: f64| smooth(s, b, 1.5 * b) - smooth(s, 24.0, 36.0);
    let corners = [b, 1.5 * b, 24.0, 36.0];
    let until = |s: f64| if s > 0.0 { along(s, &corners, weight) } else { 0.0 };
    (until(r + 0.5 * a) - until(r - 0.5 * a)) / a
}
