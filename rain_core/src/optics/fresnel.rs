//! Fresnel reflection at a smooth water surface.
//!
//! # Accuracy
//! Smooth, loss-free, non-magnetic media of real index: exact. Water's index varies by 0.5 % over the visible; F₀ by 2
//! %.

use crate::error::{clamped_or, clamped_or_f32};
use crate::ops;
use crate::quadrature::GaussLegendre;

/// Smallest and largest relative index that is looked at; others count as these. Units: none.
const INDEX_RANGE: [f64; 2] = [0.1, 10.0];

/// Reflectance of the two linear polarisations. Units: none, in [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Polarised {
    /// Electric field across the plane of incidence.
    pub s: f64,
    /// Electric field in the plane of incidence.
    pub p: f64,
}

impl Polarised {
    /// Of unpolarised light.
    ///
    /// Error: exact, the mean of both.
    #[must_use]
    pub fn mean(self) -> f64 {
        0.5 * (self.s + self.p)
    }
}

/// Reflectance for unpolarised light: ½((γ−c)/(γ+c))² (1 + ((c(γ+c)−1)/(c(γ−c)+1))²), γ = √(n² − 1 + c²).
///
/// `cos_incidence`: c, clamped to [0, 1], NaN counts as 1; `relative_index`: n beyond the surface over n before it
/// (water from air 1.333, air from water 1/1.333), clamped to [0.1, 10], NaN counts as 1. Where n² − 1 + c² < 0: 1,
/// total reflection. Units: none, in [0, 1].
///
/// Error: 1e-12 against Snell's law and Fresnel's equations by angles.
#[must_use]
#[inline]
pub fn fresnel(cos_incidence: f64, relative_index: f64) -> f64 {
    fresnel_polarised(cos_incidence, relative_index).mean()
}

/// Both polarisations; arguments as in [`fresnel`].
///
/// Error: 1e-12 as there.
#[must_use]
#[inline]
pub fn fresnel_polarised(cos_incidence: f64, relative_index: f64) -> Polarised {
    let c = cosine(cos_incidence);
    let n = index(relative_index);
    if n == 1.0 {
        return Polarised { s: 0.0, p: 0.0 };
    }
    let square = (n - 1.0) * (n + 1.0) + c * c;
    if square <= 0.0 {
        return Polarised { s: 1.0, p: 1.0 };
    }
    let gamma = ops::sqrt(square);
    let across = (gamma - c) / (gamma + c);
    let ratio = (c * (gamma + c) - 1.0) / (c * (gamma - c) + 1.0);
    let s = across * across;
    Polarised {
        s,
        p: s * ratio * ratio,
    }
}

/// [`fresnel`] from inside a medium of index n > 1 into air: total reflection beyond the critical angle.
///
/// `index`: of the medium, clamped to [1, 10]; NaN counts as 1.
///
/// Error: 1e-12 as [`fresnel`], more than 0.001 rad from the critical angle.
#[must_use]
pub fn fresnel_from_inside(cos_incidence: f64, index: f64) -> f64 {
    fresnel(cos_incidence, 1.0 / self::index(index).max(1.0))
}

/// [`fresnel`] in single precision, robust from c = 0 (F = 1) to 1, total reflection included.
///
/// Error: 5e-7 against the double form for n in [1.1, 2]; for n in [0.5, 0.75] 1e-5 where |n² − 1 + c²| > 2e-5, up to
/// 0.003 nearer to the critical angle, where F rises vertically.
#[must_use]
#[inline]
pub fn fresnel_f32(cos_incidence: f32, relative_index: f32) -> f32 {
    let [s, p] = fresnel_polarised_f32(cos_incidence, relative_index);
    0.5 * (s + p)
}

/// (s, p) of [`fresnel_f32`].
#[inline]
pub(super) fn fresnel_polarised_f32(cos_incidence: f32, relative_index: f32) -> [f32; 2] {
    let c = clamped_or_f32(cos_incidence, 0.0, 1.0, 1.0);
    let n = clamped_or_f32(relative_index, 0.1, 10.0, 1.0);
    if n == 1.0 {
        return [0.0; 2];
    }
    let square = (n - 1.0) * (n + 1.0) + c * c;
    if square <= 0.0 {
        return [1.0; 2];
    }
    let gamma = square.sqrt();
    let across = (gamma - c) / (gamma + c);
    let ratio = (c * (gamma + c) - 1.0) / (c * (gamma - c) + 1.0);
    let s = across * across;
    [s, s * ratio * ratio]
}

/// Reflectance at normal incidence, ((n − 1)/(n + 1))². `relative_index` as in [`fresnel`]. Units: none.
///
/// Error: 4e-16.
#[must_use]
pub fn normal_reflectance(relative_index: f64) -> f64 {
    let n = index(relative_index);
    let r = (n - 1.0) / (n + 1.0);
    r * r
}

/// Schlick's approximation from outside, F₀ + (1 − F₀)(1 − c)⁵. Schlick 1994. Arguments as in [`fresnel`], n ≥ 1.
///
/// Error: 1e-15 against the formula by angles; against [`fresnel`] at n = 1.333 at most 0.0593, at 83.8°.
#[must_use]
#[inline]
pub fn schlick(cos_incidence: f64, relative_index: f64) -> f64 {
    let f0 = normal_reflectance(relative_index);
    let x = 1.0 - cosine(cos_incidence);
    let x2 = x * x;
    f0 + (1.0 - f0) * x2 * x2 * x
}

/// [`schlick`] in single precision, from F₀ (clamped to [0, 1], NaN counts as 0).
///
/// Error: 3e-7 against the double form.
#[must_use]
#[inline]
pub fn schlick_f32(cos_incidence: f32, normal_reflectance: f32) -> f32 {
    let c = clamped_or_f32(cos_incidence, 0.0, 1.0, 1.0);
    let f0 = if normal_reflectance > 0.0 {
        normal_reflectance.min(1.0)
    } else {
        0.0
    };
    let x = 1.0 - c;
    let x2 = x * x;
    f0 + (1.0 - f0) * x2 * x2 * x
}

/// Angle of incidence at which no light polarised in the plane of incidence is reflected, atan n. Units: rad.
///
/// `relative_index` as in [`fresnel`].
///
/// Error: 6e-15 rad.
#[must_use]
pub fn brewster_rad(relative_index: f64) -> f64 {
    ops::atan2(index(relative_index), 1.0)
}

/// Angle of incidence from inside beyond which all light is reflected, asin(1/n). Units: rad; π/2 for n = 1.
///
/// `index`: of the medium, clamped to [1, 10], NaN counts as 1.
///
/// Error: 6e-15 rad.
#[must_use]
pub fn critical_angle_rad(index: f64) -> f64 {
    let n = self::index(index).max(1.0);
    // The arc sine of 1/n, where its tangent is sharper: near n = 1 the arc is steep.
    ops::atan2(1.0, ops::sqrt((n - 1.0) * (n + 1.0)))
}

/// Mean reflectance for diffuse light from outside, 2∫F c dc. Duntley 1942. Units: none.
///
/// `index`: n, clamped to [1, 10], NaN counts as 1. The closed form cancels near n = 1: below 1.02 an integral in which
/// F is smooth, c = √(n²−1) sinh t, is summed instead (about 2 µs).
///
/// Error: 1e-13 absolute and 1e-11 relative against 2∫F c dc.
#[must_use]
pub fn hemispherical_mean(index: f64) -> f64 {
    let n = self::index(index).max(1.0);
    if n == 1.0 {
        return 0.0;
    }
    if n < 1.02 {
        return mean_near_one(n);
    }
    let n2 = n * n;
    let n3 = n2 * n;
    let n4 = n2 * n2;
    let (minus, plus) = ((n - 1.0) * (n + 1.0), n2 + 1.0);
    // n⁴ − 1 without its own cancellation.
    let fourth = minus * plus;
    0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0))
        + n2 * minus * minus / (plus * plus * plus) * ops::ln((n - 1.0) / (n + 1.0))
        - 2.0 * n3 * (n2 + 2.0 * n - 1.0) / (plus * fourth)
        + 8.0 * n4 * (n4 + 1.0) / (plus * fourth * fourth) * ops::ln_1p(n - 1.0)
}

/// Mean reflectance for diffuse light from inside, 1 − (1 − R̄)/n²: total reflection included. Units: none.
///
/// `index` as in [`hemispherical_mean`].
///
/// Error: 1e-13 against 2∫F c dc from inside.
#[must_use]
pub fn hemispherical_mean_inside(index: f64) -> f64 {
    let n = self::index(index).max(1.0);
    1.0 - (1.0 - hemispherical_mean(n)) / (n * n)
}

/// 2∫F c dc with c = g sinh t, g = √(n² − 1): (γ − c)/(γ + c) = e^(−2t), so the integrand decays smoothly.
fn mean_near_one(n: f64) -> f64 {
    let g2 = (n - 1.0) * (n + 1.0);
    let g = ops::sqrt(g2);
    // asinh(1/g); beyond t = 12 nothing is left of e^(−2t).
    let end = ops::ln((1.0 + ops::sqrt(1.0 + g2)) / g).min(12.0);
    GaussLegendre::<16>::RULE.integrate_panels(0.0, end, 4, |t| {
        let (up, down) = (ops::exp(t), ops::exp(-t));
        let (c, gamma) = (0.5 * g * (up - down), 0.5 * g * (up + down));
        let s = down * down * down * down;
        let ratio = (c * (gamma + c) - 1.0) / (c * (gamma - c) + 1.0);
        s * (1.0 + ratio * ratio) * c * gamma
    })
}

fn cosine(c: f64) -> f64 {
    clamped_or(c, 0.0, 1.0, 1.0)
}

/// The index inside its range.
fn index(n: f64) -> f64 {
    clamped_or(n, INDEX_RANGE[0], INDEX_RANGE[1], 1.0)
}
