//! Water on glass.

use core::f64::consts::PI;

use crate::fall_speed::fit;
use crate::numerics::simpson;

/// Speed into a glass averaged over gusts: a plain sum over a normal distribution.
pub fn mean_speed(mean: f64, gust: f64) -> f64 {
    if gust == 0.0 {
        return mean.max(0.0);
    }
    // Split where the drops just miss, so that the sum sees no corner.
    let start = (-mean / gust).clamp(-9.0, 9.0);
    simpson(start, 9.0, 400, |x| {
        (mean + gust * x).max(0.0) * (-x * x / 2.0).exp() / (2.0 * PI).sqrt()
    })
}

/// ∫ over diameters (mm) of N · speed · `weight`, N = n0 e^(−slope D).
pub fn impacts(
    n0: f64,
    slope: f64,
    upward: f64,
    into: f64,
    gust: f64,
    ends: [f64; 2],
    weight: impl Fn(f64) -> f64,
) -> f64 {
    simpson(ends[0], ends[1], 600, |d| {
        n0 * (-slope * d).exp() * mean_speed(fit(d) * upward + into, gust) * weight(d)
    })
}

/// A cap of a sphere with a contact angle of 45°, slice by slice.
pub fn cap_volume(radius: f64) -> f64 {
    let sphere = radius / (PI / 4.0).sin();
    let low = sphere * (PI / 4.0).cos();
    simpson(low, sphere, 400, |z| PI * (sphere * sphere - z * z))
}

/// Hu & Larson 2002 with Frössling's factor, in small steps of Heun.
pub fn drying(radius: f64, deficit: f64, speed: f64, time: f64) -> f64 {
    let rate = |r: f64| {
        let (diffusivity, viscosity) = (2.46e-5_f64, 1.5e-5_f64);
        let reynolds = 0.4 * speed * 2.0 * r / viscosity;
        let stream = 1.0 + 0.276 * reynolds.sqrt() * (viscosity / diffusivity).cbrt();
        let angle = PI / 4.0;
        let flux = PI * r * diffusivity * deficit * (0.27 * angle * angle + 1.3) * stream / 998.2;
        // dV = 3 c r² dr.
        -flux / (3.0 * cap_volume(1.0) * r * r)
    };
    let steps = 2000;
    let dt = time / f64::from(steps);
    let mut r = radius;
    for _ in 0..steps {
        let first = rate(r);
        let second = rate(r + dt * first);
        r += dt / 2.0 * (first + second);
    }
    r
}

/// How long ago an arm that swings as (1 − cos)/2 over `moving` seconds of each `period` passed `angle`, by walking back.
pub fn since(period: f64, moving: f64, rest: f64, far: f64, angle: f64, time: f64) -> Option<f64> {
    let at = |t: f64| {
        let t = t.rem_euclid(period);
        let swing = if t < moving {
            (1.0 - (2.0 * PI * t / moving).cos()) / 2.0
        } else {
            0.0
        };
        rest + (far - rest) * swing - angle
    };
    let step = 1e-3;
    let mut t = time;
    while t > 0.0 {
        let before = (t - step).max(0.0);
        if at(before) * at(t) <= 0.0 {
            let found = crate::numerics::bisect(before, t, at);
            return Some(time - found);
        }
        t = before;
    }
    None
}
