//! Where the light that hits a drop goes.
//!
//! # Accuracy
//! Geometric optics of a loss-free sphere, both polarisations tracked. Water absorbs less than 1e-3 over a drop's
//! diameter in the visible. Flattened drops share out differently by some per cent of each order.

use super::fresnel::{fresnel_polarised, normal_reflectance};
use super::refraction::index;
use crate::quadrature::GaussLegendre;

/// Shares of the light that hits a sphere, over its whole disc, unpolarised. Units: none; they add up to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergySplit {
    /// Reflected outside.
    pub reflected: f64,
    /// Straight through.
    pub through: f64,
    /// Out after one, two, three inner reflections.
    pub inner: [f64; 3],
    /// All later orders.
    pub rest: f64,
}

/// The split for a sphere of `index` n (clamped to [1, 10], NaN counts as 1). About 20 µs: make it once.
///
/// Error: 2e-8 against 4000 traced rings, which is their own resolution; the rest 1e-6.
#[must_use]
pub fn energy_split(index: f64) -> EnergySplit {
    let [reflected, through, one, two, three] = [0, 1, 2, 3, 4].map(|order| sphere_order_share(order, index));
    EnergySplit {
        reflected,
        through,
        inner: [one, two, three],
        rest: (1.0 - reflected - through - one - two - three).max(0.0),
    }
}

/// Share of one order: 0 reflected outside (F), 1 straight through ((1−F)²), p: p − 1 inner reflections
/// ((1−F)² F^(p−1)), the mean over the disc of each polarisation. Units: none.
///
/// `order` above 100 counts as 100; `index` as in [`energy_split`].
///
/// Error: 2e-8 as there.
#[must_use]
pub fn sphere_order_share(order: u32, index: f64) -> f64 {
    let n = self::index(index);
    let of = |f: f64| match order.min(100) {
        0 => f,
        order => (1.0 - f) * (1.0 - f) * (1..order).map(|_| f).product::<f64>(),
    };
    // Over the disc 2s ds = 2c dc, c the cosine of incidence; c = x² takes out the steep rise of F at the rim.
    let integrand = |x: f64| {
        let f = fresnel_polarised(x * x, n);
        4.0 * x * x * x * 0.5 * (of(f.s) + of(f.p))
    };
    GaussLegendre::<16>::RULE.integrate_panels(0.0, 1.0, 4, integrand)
}

/// Light sent straight back per solid angle, over the square of the radius: F₀/4 + (1 − F₀)² F₀/(4/n − 2)².
///
/// Units: 1/sr (times a² in m² gives m²/sr). `index`: n, clamped to [1, 1.9] (at 2 the back surface is in focus), NaN
/// counts as 1.
///
/// Error: 5e-15 relative, 1e-6 against traced rays near the axis; ± 30 % for real drops (oblate ones seen from the side
/// send more back).
#[must_use]
pub fn retro_reflection(index: f64) -> f64 {
    let n = self::index(index).min(1.9);
    let f0 = normal_reflectance(n);
    let focus = 4.0 / n - 2.0;
    f0 / 4.0 + (1.0 - f0) * (1.0 - f0) * f0 / (focus * focus)
}
