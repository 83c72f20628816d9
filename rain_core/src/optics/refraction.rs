//! Refraction through a sphere: what a drop shows of its surroundings, and where rainbows stand.
//!
//! # Accuracy
//! Geometric optics of a sphere: right for drops above 0.1 mm (the wavelength is 0.5 µm) as far as they are round. A 4
//! mm drop is 20 % flatter: its view is wider across than up.

use core::f64::consts::{PI, TAU};

use crate::error::clamped;
use crate::ops;

/// Impact parameter in [0, 1]; NaN counts as 0.
fn impact(s: f64) -> f64 {
    clamped(s, 0.0, 1.0)
}

/// Index in [1, 10]; NaN counts as 1.
pub(super) fn index(n: f64) -> f64 {
    if n > 1.0 { n.min(10.0) } else { 1.0 }
}

/// sin(δ/2) of a ray's deviation, s(√(n² − s²) − √(1 − s²))/n, without any difference that cancels.
fn half_sine(s: f64, n: f64) -> f64 {
    if n == 1.0 {
        return 0.0;
    }
    // The difference of two roots is that of their squares, n² − 1, over their sum.
    let sum = ops::sqrt((n - s) * (n + s)) + ops::sqrt((1.0 - s) * (1.0 + s));
    s * (n - 1.0) * (n + 1.0) / (n * sum)
}

/// Deviation of a ray that goes straight through a sphere, δ = 2(asin s − asin(s/n)). Units: rad.
///
/// `impact`: s, distance from the axis in radii, clamped to [0, 1], NaN counts as 0; `index`: n, clamped to [1, 10],
/// NaN counts as 1. The image is inverted: the ray turns towards the axis.
///
/// Error: 2e-14 rad against the two arcs and against traced rays.
#[must_use]
pub fn deviation_rad(impact: f64, index: f64) -> f64 {
    let (s, n) = (self::impact(impact), self::index(index));
    2.0 * ops::asin(half_sine(s, n).clamp(0.0, 1.0))
}

/// (sin δ, cos δ) of [`deviation_rad`] in single precision, without any arc.
///
/// Error: 5e-7 against the double form.
#[must_use]
#[inline]
pub fn deviation_sin_cos_f32(impact: f32, index: f32) -> [f32; 2] {
    let s = if impact > 0.0 { impact.min(1.0) } else { 0.0 };
    let n = if index > 1.0 { index.min(10.0) } else { 1.0 };
    let q = s / n;
    let (inside, outside) = (((1.0 - q) * (1.0 + q)).sqrt(), ((1.0 - s) * (1.0 + s)).sqrt());
    let half_sine = s * (inside - outside / n);
    let half_cosine = outside * inside + s * q;
    [2.0 * half_sine * half_cosine, 1.0 - 2.0 * half_sine * half_sine]
}

/// Widest angle seen through a sphere, 2 δ(1) = 4 acos(1/n). Units: rad.
///
/// `index` as in [`deviation_rad`].
///
/// Error: 6e-15 rad.
#[must_use]
pub fn field_of_view_rad(index: f64) -> f64 {
    2.0 * deviation_rad(1.0, index)
}

/// The impact parameter whose ray is deviated by δ: s = n sin h/√((n − 1)² + 4n sin²(h/2)), h = δ/2. Units: none, in
/// [0, 1].
///
/// `deviation_rad`: clamped to [0, δ(1)], NaN counts as 0; `index` as in [`deviation_rad`]. For n = 1 nothing is
/// deviated: 0.
///
/// Error: round trip 1e-13 below s = 0.99; δ turns vertical at the rim, where s is sharper than δ.
#[must_use]
pub fn impact_of_deviation(deviation_rad: f64, index: f64) -> f64 {
    let n = self::index(index);
    if deviation_rad.is_nan() || deviation_rad <= 0.0 || n == 1.0 {
        return 0.0;
    }
    let half = 0.5 * deviation_rad;
    if half >= ops::acos(1.0 / n) {
        return 1.0;
    }
    let quarter = ops::sin(0.5 * half);
    let chord = (n - 1.0) * (n - 1.0) + 4.0 * n * quarter * quarter;
    (n * ops::sin(half) / ops::sqrt(chord)).min(1.0)
}

/// Share of a drop's disc whose straight refracted ray leaves within `angle_rad` of forward, s(δ)². Units: none.
///
/// Arguments as in [`impact_of_deviation`]; n = 1 gives 1.
///
/// Error: 1e-13, below s = 0.99.
#[must_use]
pub fn disc_share_within(angle_rad: f64, index: f64) -> f64 {
    if self::index(index) == 1.0 {
        return 1.0;
    }
    let s = impact_of_deviation(angle_rad, index);
    s * s
}

/// A rainbow: the ray that many neighbours join.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bow {
    /// Impact parameter s. Units: none.
    pub impact: f64,
    /// Angle from the point opposite the sun. Units: rad, in [0, π].
    pub angle_rad: f64,
}

/// The rainbow of rays with `reflections` ≥ 1 inner reflections (1: primary, 2: secondary): the stationary deviation,
/// at cos²i = (n² − 1)/(k(k + 2)). `None` where there is none (k = 0, or n ≥ k + 1).
///
/// `index` as in [`deviation_rad`]; `reflections` above 100 count as 100.
///
/// Error: 1e-9 rad against a search for the stationary ray; Airy's theory moves bows of drops below 0.5 mm inward by up
/// to a degree.
#[must_use]
pub fn rainbow(reflections: u32, index: f64) -> Option<Bow> {
    let n = self::index(index);
    let k = f64::from(reflections.min(100));
    let cosine2 = (n - 1.0) * (n + 1.0) / (k * (k + 2.0));
    // Also k = 0, where the quotient is infinite or not a number.
    if cosine2.is_nan() || cosine2 >= 1.0 {
        return None;
    }
    let impact = ops::sqrt(1.0 - cosine2);
    let (i, r) = (ops::acos(ops::sqrt(cosine2)), ops::asin((impact / n).min(1.0)));
    let deviation = 2.0 * (i - r) + k * (PI - 2.0 * r);
    // Angle from straight back, folded into [0, π].
    let back = deviation - PI;
    let turned = back - TAU * (back / TAU).round();
    Some(Bow {
        impact,
        angle_rad: turned.abs(),
    })
}
