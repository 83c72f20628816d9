//! Shape of a falling drop: axis ratio, spheroid, and the outline of Beard & Chuang with its flat base.
//!
//! # Accuracy
//! Equilibrium shapes in still air. The spheroid misses the flat base: at most 5 % of the radius at 4 mm (rms 2.7 %).
//! Axis ratio and outline agree within 0.0035. Real drops oscillate about these shapes ([`super::Oscillation`]).

use core::f64::consts::PI;

use glam::{DVec2, Vec2};

use crate::constants::WATER_DENSITY;
use crate::error::{clamped_or, clamped_or_f32};
use crate::ops;

/// Largest diameter of the axis-ratio fit; larger drops count as this. Units: mm.
pub const MAX_AXIS_RATIO_DIAMETER_MM: f64 = 7.0;
/// Largest diameter of the outline's table; larger drops have its shape. Units: mm.
pub const MAX_OUTLINE_DIAMETER_MM: f64 = 6.0;
/// Cosine terms of the outline, the constant included.
pub const OUTLINE_TERMS: usize = 11;

/// Axis ratio height/width: min(1, 1.0048 + 5.7e-4 D − .02628 D² + .003682 D³ − 1.677e-4 D⁴). Units: none, in (0, 1].
///
/// `diameter_mm`: equivalent diameter, mm, clamped to [0, 7]; NaN counts as 0. Andsager, Beard & Laird 1999, fit to
/// Beard & Chuang 1987; the polynomial exceeds 1 below 0.453 mm.
///
/// Error: 1e-15; against the outline's own ratio at most 0.0035. Single drops scatter by a few per cent
/// (oscillation).
#[must_use]
pub fn axis_ratio(diameter_mm: f64) -> f64 {
    let d = if diameter_mm > 0.0 {
        diameter_mm.min(MAX_AXIS_RATIO_DIAMETER_MM)
    } else {
        0.0
    };
    (1.0048 + d * (5.7e-4 + d * (-0.026_28 + d * (0.003_682 - d * 1.677e-4)))).min(1.0)
}

/// [`axis_ratio`] in single precision.
///
/// Error: 3e-7 against the double form.
#[must_use]
#[inline]
pub fn axis_ratio_f32(diameter_mm: f32) -> f32 {
    let d = if diameter_mm > 0.0 { diameter_mm.min(7.0) } else { 0.0 };
    (1.0048 + d * (5.7e-4 + d * (-0.026_28 + d * (0.003_682 - d * 1.677e-4)))).min(1.0)
}

/// Volume π D³/6. Units: mm³. `diameter_mm`: mm, clamped to [0, 1e3]; NaN counts as 0.
///
/// Error: 2e-15 relative.
#[must_use]
pub fn drop_volume_mm3(diameter_mm: f64) -> f64 {
    let d = if diameter_mm > 0.0 { diameter_mm.min(1e3) } else { 0.0 };
    PI / 6.0 * d * d * d
}

/// Mass of a drop of water at 20 °C. Units: kg. `diameter_mm` as in [`drop_volume_mm3`].
///
/// Error: 2e-15 relative; 0.4 % between 0 and 30 °C.
#[must_use]
pub fn drop_mass_kg(diameter_mm: f64) -> f64 {
    WATER_DENSITY * 1e-9 * drop_volume_mm3(diameter_mm)
}

/// The spheroid of a drop's volume and axis ratio.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spheroid {
    /// Horizontal semi-axis, (D/2) α^(−1/3). Units: mm.
    pub horizontal_mm: f64,
    /// Vertical semi-axis, (D/2) α^(2/3). Units: mm.
    pub vertical_mm: f64,
}

impl Spheroid {
    /// Of a drop of this equivalent diameter, mm, clamped to [0, 1e3]; NaN counts as 0.
    ///
    /// Error: 2e-15 relative, of both axes and of the volume.
    #[must_use]
    pub fn of_drop(diameter_mm: f64) -> Self {
        let d = if diameter_mm > 0.0 { diameter_mm.min(1e3) } else { 0.0 };
        let root = ops::cbrt(axis_ratio(d));
        Self {
            horizontal_mm: 0.5 * d / root,
            vertical_mm: 0.5 * d * root * root,
        }
    }

    /// Distance of the surface from the centre at θ from the vertical. Units: mm.
    ///
    /// `cos_theta`: clamped to [−1, 1], NaN counts as 0.
    ///
    /// Error: 2e-15 relative; no flat base: at most 5 % of the radius at 4 mm.
    #[must_use]
    pub fn radius_mm(&self, cos_theta: f64) -> f64 {
        let x = cosine(cos_theta);
        let (a, b) = (self.horizontal_mm, self.vertical_mm);
        if b == 0.0 {
            return 0.0;
        }
        let ratio = a / b;
        a / ops::sqrt((1.0 - x) * (1.0 + x) + ratio * ratio * x * x)
    }
}

/// Rows of Beard & Chuang 1987: D in mm, c₀…c₁₀ × 10⁴.
const TABLE: [(f64, [f64; OUTLINE_TERMS]); 9] = [
    (
        2.0,
        [-131.0, -120.0, -376.0, -96.0, -4.0, 15.0, 5.0, 0.0, -2.0, 0.0, 1.0],
    ),
    (
        2.5,
        [-201.0, -172.0, -567.0, -137.0, 3.0, 29.0, 8.0, -2.0, -4.0, 0.0, 1.0],
    ),
    (
        3.0,
        [-282.0, -230.0, -779.0, -175.0, 21.0, 46.0, 11.0, -6.0, -7.0, 0.0, 3.0],
    ),
    (
        3.5,
        [-369.0, -285.0, -998.0, -207.0, 48.0, 68.0, 13.0, -13.0, -10.0, 0.0, 5.0],
    ),
    (
        4.0,
        [
            -458.0, -335.0, -1211.0, -227.0, 83.0, 89.0, 12.0, -21.0, -13.0, 1.0, 8.0,
        ],
    ),
    (
        4.5,
        [
            -549.0, -377.0, -1421.0, -240.0, 126.0, 110.0, 9.0, -31.0, -16.0, 4.0, 11.0,
        ],
    ),
    (
        5.0,
        [
            -644.0, -416.0, -1629.0, -246.0, 176.0, 131.0, 2.0, -44.0, -18.0, 9.0, 14.0,
        ],
    ),
    (
        5.5,
        [
            -742.0, -454.0, -1837.0, -244.0, 234.0, 150.0, -7.0, -58.0, -19.0, 15.0, 19.0,
        ],
    ),
    (
        6.0,
        [
            -840.0, -480.0, -2034.0, -237.0, 297.0, 166.0, -21.0, -72.0, -19.0, 24.0, 23.0,
        ],
    ),
];

/// The outline r(θ) = (D/2) Σ aₙ cos nθ of a drop, θ from the **downward** vertical (the base is flat).
///
/// Beard & Chuang 1987, cₙ linear in D between the rows of their table, growing as D² below 2 mm, held above 6 mm;
/// then scaled so that the volume is exactly π D³/6. 200 bytes; nothing is allocated.
///
/// Error: radius and points 1e-12 of D/2 in double, 6e-7 in single precision; volume 1e-11 against sums over 800
/// angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DropOutline {
    diameter_mm: f64,
    coefficients: [f64; OUTLINE_TERMS],
    coefficients_f32: [f32; OUTLINE_TERMS],
}

impl DropOutline {
    /// Of a drop of this equivalent diameter, mm, clamped to [0, 1e3]; NaN counts as 0.
    #[must_use]
    pub fn new(diameter_mm: f64) -> Self {
        let d = if diameter_mm > 0.0 { diameter_mm.min(1e3) } else { 0.0 };
        let mut coefficients = shape_coefficients(d.min(MAX_OUTLINE_DIAMETER_MM));
        coefficients[0] += 1.0;
        Self::scaled(d, coefficients)
    }

    /// With `coefficients` scaled to the volume of a sphere.
    fn scaled(diameter_mm: f64, coefficients: [f64; OUTLINE_TERMS]) -> Self {
        let scale = 1.0 / ops::cbrt(volume_ratio(&coefficients));
        let coefficients = coefficients.map(|a| a * scale);
        Self {
            diameter_mm,
            coefficients,
            coefficients_f32: coefficients.map(|a| a as f32),
        }
    }

    /// This outline with Legendre modes Aₙ Pₙ(cos θ), n = 2, 3, added, scaled to the same volume.
    ///
    /// `amplitudes`: A₂, A₃ in radii, each clamped to [−0.4, 0.4]; NaN counts as 0.
    #[must_use]
    pub fn deformed(&self, amplitudes: [f64; 2]) -> Self {
        let [second, third] = amplitudes.map(|a| clamped_or(a, -0.4, 0.4, 0.0));
        let mut coefficients = self.coefficients;
        // P₂ = (1 + 3 cos 2θ)/4, P₃ = (3 cos θ + 5 cos 3θ)/8.
        coefficients[0] += 0.25 * second;
        coefficients[2] += 0.75 * second;
        coefficients[1] += 0.375 * third;
        coefficients[3] += 0.625 * third;
        Self::scaled(self.diameter_mm, coefficients)
    }

    /// Equivalent diameter. Units: mm.
    #[must_use]
    pub fn diameter_mm(&self) -> f64 {
        self.diameter_mm
    }

    /// The aₙ after scaling. Units: none.
    #[must_use]
    pub fn coefficients(&self) -> &[f64; OUTLINE_TERMS] {
        &self.coefficients
    }

    /// r/(D/2) at θ from the downward vertical, by the recurrence of cos nθ: no trigonometry. Units: none.
    ///
    /// `cos_theta`: clamped to [−1, 1], NaN counts as 0.
    #[must_use]
    pub fn radius(&self, cos_theta: f64) -> f64 {
        let x = cosine(cos_theta);
        let (mut before, mut now) = (1.0, x);
        let mut sum = self.coefficients[0] + self.coefficients[1] * x;
        for a in &self.coefficients[2..] {
            (before, now) = (now, 2.0 * x * now - before);
            sum += a * now;
        }
        sum
    }

    /// [`DropOutline::radius`] in single precision.
    #[must_use]
    #[inline]
    pub fn radius_f32(&self, cos_theta: f32) -> f32 {
        let x = clamped_or_f32(cos_theta, -1.0, 1.0, 0.0);
        let (mut before, mut now) = (1.0, x);
        let mut sum = self.coefficients_f32[0] + self.coefficients_f32[1] * x;
        for a in &self.coefficients_f32[2..] {
            (before, now) = (now, 2.0 * x * now - before);
            sum += a * now;
        }
        sum
    }

    /// Point of the outline: x away from the axis (≥ 0), y up, from the origin of the series. Units: mm.
    #[must_use]
    pub fn point_mm(&self, cos_theta: f64) -> DVec2 {
        let x = cosine(cos_theta);
        let r = 0.5 * self.diameter_mm * self.radius(x);
        DVec2::new(r * ops::sqrt((1.0 - x) * (1.0 + x)), -r * x)
    }

    /// Outward unit normal of the outline, from the derivative of the series: x away from the axis, y up.
    ///
    /// `cos_theta` as in [`DropOutline::radius`].
    ///
    /// Error: 1e-10 against differences of the slow sum's points, which is theirs.
    #[must_use]
    pub fn normal(&self, cos_theta: f64) -> DVec2 {
        let x = cosine(cos_theta);
        let sine = ops::sqrt((1.0 - x) * (1.0 + x));
        // dr/dθ = −sin θ Σ n aₙ Uₙ₋₁(cos θ).
        let (mut t0, mut t1) = (1.0, x);
        let (mut u0, mut u1) = (0.0, 1.0);
        let mut r = self.coefficients[0] + self.coefficients[1] * x;
        let mut slope = self.coefficients[1];
        for (n, a) in self.coefficients.iter().enumerate().skip(2) {
            (t0, t1) = (t1, 2.0 * x * t1 - t0);
            (u0, u1) = (u1, 2.0 * x * u1 - u0);
            r += a * t1;
            slope += n as f64 * a * u1;
        }
        slope *= -sine;
        DVec2::new(r * sine - slope * x, -r * x - slope * sine).normalize()
    }

    /// [`DropOutline::normal`] in single precision.
    ///
    /// Error: 1e-6 against the double form.
    #[must_use]
    #[inline]
    pub fn normal_f32(&self, cos_theta: f32) -> Vec2 {
        let x = clamped_or_f32(cos_theta, -1.0, 1.0, 0.0);
        let sine = ((1.0 - x) * (1.0 + x)).sqrt();
        let (mut t0, mut t1) = (1.0, x);
        let (mut u0, mut u1) = (0.0, 1.0);
        let mut r = self.coefficients_f32[0] + self.coefficients_f32[1] * x;
        let mut slope = self.coefficients_f32[1];
        for (n, a) in self.coefficients_f32.iter().enumerate().skip(2) {
            (t0, t1) = (t1, 2.0 * x * t1 - t0);
            (u0, u1) = (u1, 2.0 * x * u1 - u0);
            r += a * t1;
            slope += n as f32 * a * u1;
        }
        slope *= -sine;
        Vec2::new(r * sine - slope * x, -r * x - slope * sine).normalize()
    }
}

fn cosine(x: f64) -> f64 {
    clamped_or(x, -1.0, 1.0, 0.0)
}

/// cₙ for D in [0, 6] mm.
fn shape_coefficients(d: f64) -> [f64; OUTLINE_TERMS] {
    let (first, row) = TABLE[0];
    if d <= first {
        let share = d / first * (d / first) * 1e-4;
        return row.map(|c| c * share);
    }
    // Rows are 0.5 mm apart.
    let position = (d - first) / 0.5;
    let below = (position as usize).min(TABLE.len() - 2);
    let t = position - below as f64;
    core::array::from_fn(|n| (TABLE[below].1[n] + t * (TABLE[below + 1].1[n] - TABLE[below].1[n])) * 1e-4)
}

/// Volume of r = Σ aₙ cos nθ over that of the unit sphere, ½∫r³ sin θ dθ, exact: r³ is again such a sum, and
/// ½∫cos nθ sin θ dθ = 1/(1 − n²) for even n, 0 for odd n.
fn volume_ratio(a: &[f64; OUTLINE_TERMS]) -> f64 {
    let mut square = [0.0; 2 * OUTLINE_TERMS - 1];
    for (i, p) in a.iter().enumerate() {
        for (j, q) in a.iter().enumerate() {
            square[i + j] += 0.5 * p * q;
            square[i.abs_diff(j)] += 0.5 * p * q;
        }
    }
    let mean = |n: usize| {
        if n.is_multiple_of(2) {
            1.0 / (1.0 - (n * n) as f64)
        } else {
            0.0
        }
    };
    let mut volume = 0.0;
    for (i, p) in square.iter().enumerate() {
        for (j, q) in a.iter().enumerate() {
            volume += 0.5 * p * q * (mean(i + j) + mean(i.abs_diff(j)));
        }
    }
    volume
}
