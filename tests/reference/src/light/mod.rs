//! Fresnel reflection, refraction in a drop, streaks, extinction.

pub mod cloud;
pub mod drop;
pub mod haze;
pub mod rainbow;
pub mod sphere;
pub mod streak;

use crate::numerics::simpson;

/// Reflectance (s, p) by Snell's law and Fresnel's equations with angles; 1 beyond the critical angle.
pub fn fresnel(incidence: f64, before: f64, beyond: f64) -> [f64; 2] {
    let sine = before * incidence.sin() / beyond;
    if sine >= 1.0 {
        return [1.0, 1.0];
    }
    let (ci, ct) = (incidence.cos(), sine.asin().cos());
    let s = (before * ci - beyond * ct) / (before * ci + beyond * ct);
    let p = (beyond * ci - before * ct) / (beyond * ci + before * ct);
    [s * s, p * p]
}

/// Mean reflectance for diffuse light from outside: 2∫F sin θ cos θ dθ, with θ = π/2 − x² near grazing.
pub fn diffuse_mean(index: f64) -> f64 {
    // Towards grazing F rises within an angle of √(n² − 1): x^4 puts enough points there.
    let end = core::f64::consts::FRAC_PI_2.powf(0.25);
    2.0 * simpson(0.0, end, 4000, |x| {
        let theta = core::f64::consts::FRAC_PI_2 - x.powi(4);
        let [s, p] = fresnel(theta.min(core::f64::consts::FRAC_PI_2), 1.0, index);
        0.5 * (s + p) * theta.sin() * theta.cos().max(0.0) * 4.0 * x.powi(3)
    })
}

/// Schlick's formula by angle.
pub fn schlick(incidence: f64, index: f64) -> f64 {
    let f0 = ((index - 1.0) / (index + 1.0)).powi(2);
    f0 + (1.0 - f0) * (1.0 - incidence.cos()).powi(5)
}
