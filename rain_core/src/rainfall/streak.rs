//! Streaks: what a drop leaves in a picture while the shutter is open.
//!
//! Opacity is a time: the share of the exposure in which the drop covers a point. Whatever the exposure, the speed, the
//! motion of the camera or the size of a pixel, a drop's opacity summed over the picture is that of its disc,
//! (π/4)(D f/z)². Source: Garg & Nayar 2007.
//!
//! # Accuracy
//! The drop is a disc of its equivalent diameter: real ones are up to 15 % wider and 30 % lower. [`streak_opacity`] is
//! exact for that disc; [`ScreenStreak`] spreads its sum evenly over a rectangle, ends included.

use core::f32::consts::FRAC_PI_4;

use glam::{Vec2, Vec3};

use crate::error::clamped;
use crate::ops;

/// Way of a drop during the exposure relative to the camera, w T. Units: m.
///
/// `relative_m_s`: |w − w_camera|, m/s; `exposure_s`: s; each clamped to [0, 1e6], NaN counts as 0.
///
/// Error: exact, one product.
#[must_use]
pub fn streak_path_m(relative_m_s: f64, exposure_s: f64) -> f64 {
    clamped(relative_m_s, 0.0, 1e6) * clamped(exposure_s, 0.0, 1e6)
}

/// Length of a streak with both ends, w T + D. Units: m. `diameter_mm`: mm, clamped to [0, 1e6]; others as in
/// [`streak_path_m`].
///
/// Error: 1e-15 relative.
#[must_use]
pub fn streak_length_m(relative_m_s: f64, exposure_s: f64, diameter_mm: f64) -> f64 {
    streak_path_m(relative_m_s, exposure_s) + 1e-3 * clamped(diameter_mm, 0.0, 1e6)
}

/// Opacity on the axis in the middle of a streak, min(1, D/(w T)). Units: none.
///
/// `diameter_mm`: mm, `path_m`: [`streak_path_m`], m; clamped to [0, 1e6], NaN counts as 0. No drop: 0; no way: 1.
///
/// Error: 1e-15 relative.
#[must_use]
pub fn streak_peak_opacity(diameter_mm: f64, path_m: f64) -> f64 {
    let (d, path) = (1e-3 * clamped(diameter_mm, 0.0, 1e6), clamped(path_m, 0.0, 1e6));
    if d <= 0.0 {
        0.0
    } else if d >= path {
        1.0
    } else {
        d / path
    }
}

/// Opacity at a point beside a streak: share of the exposure in which the disc covers it. Units: none, in [0, 1].
///
/// `across_m`: distance from the axis; `along_m`: from the disc's centre at the start of the exposure, positive along
/// the motion; `diameter_m` ≥ 0; `path_m` ≥ 0, 0 = a drop at rest. NaN anywhere, or no diameter: 0.
/// α = |[y − h, y + h] ∩ [0, wT]|/(w T) with half a chord h = √(D² − 4x²)/2: mid-streak √(D² − 4x²)/(w T), ends taper
/// over D. ∫α dA = π D²/4 exactly.
///
/// Error: 1e-15 · (1 + D/path) against the overlap of the two intervals, off the rim; against 512 samples of the disc's
/// way 1/512, which is theirs.
#[must_use]
#[inline]
pub fn streak_opacity(across_m: f64, along_m: f64, diameter_m: f64, path_m: f64) -> f64 {
    let half = 0.5 * diameter_m;
    let square = (half - across_m) * (half + across_m);
    // Also where something is not a number, or no drop.
    if !(half > 0.0 && square >= 0.0) {
        return 0.0;
    }
    let chord = ops::sqrt(square);
    let (from, to) = (along_m - chord, along_m + chord);
    // `min` and `max` would hide it.
    if from.is_nan() || path_m.is_nan() {
        return 0.0;
    }
    if path_m <= 0.0 {
        return if from <= 0.0 && to >= 0.0 { 1.0 } else { 0.0 };
    }
    let share = (to.min(path_m) - from.max(0.0)) / path_m;
    if share > 0.0 { share.min(1.0) } else { 0.0 }
}

/// [`streak_opacity`] in single precision; lengths in any common unit (pixels, say).
///
/// Error: 1e-5 of the peak opacity plus 5e-7 · max(|along|, D)/path against the double form, more than 1e-4 of the
/// radius inside the rim (a root rises vertically there).
#[must_use]
#[inline]
pub fn streak_opacity_f32(across: f32, along: f32, diameter: f32, path: f32) -> f32 {
    let half = 0.5 * diameter;
    let square = (half - across) * (half + across);
    if !(half > 0.0 && square >= 0.0) {
        return 0.0;
    }
    let chord = square.sqrt();
    let (from, to) = (along - chord, along + chord);
    // `min` and `max` would hide it.
    if from.is_nan() || path.is_nan() {
        return 0.0;
    }
    if path <= 0.0 {
        return if from <= 0.0 && to >= 0.0 { 1.0 } else { 0.0 };
    }
    // Mid-streak the two ends do not matter: their difference would cost digits.
    let covered = if from >= 0.0 && to <= path {
        2.0 * chord
    } else {
        to.min(path) - from.max(0.0)
    };
    let share = covered / path;
    if share > 0.0 { share.min(1.0) } else { 0.0 }
}

/// A streak as a rectangle of even opacity, at least one pixel wide and long.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScreenStreak {
    /// Where the drop is at the end of the exposure, from the picture's middle, x right, y up. Units: px.
    pub head_px: Vec2,
    /// Where it was at the start.
    pub tail_px: Vec2,
    /// Way between them plus the drop's own size, at least 1. Units: px.
    pub length_px: f32,
    /// The drop's own size, at least 1. Units: px.
    pub width_px: f32,
    /// Mean opacity over length × width. Units: none, in [0, π/4].
    pub opacity: f32,
}

impl ScreenStreak {
    /// A drop that goes from `tail_m` to `head_m` (camera space, looking along −z; m) during the exposure.
    ///
    /// `diameter_m` ≥ 0; `focal_px`: focal length in pixels, > 0; `near_m`: near plane, > 0. What lies before the near
    /// plane is cut off before the division by depth, and its share of the exposure with it. The drop's size is that at
    /// the geometric mean of both depths, which makes the sum exact: the mean of 1/z² over the way is 1/(z₁ z₂).
    /// `None` when all of it is before the near plane or a value, of the result too, is out of range or not finite.
    ///
    /// Error: opacity × length × width is (π/4)(D f)²/(z₁ z₂) × share of the exposure within 3e-6 of the exact
    /// integral.
    #[must_use]
    pub fn project(head_m: Vec3, tail_m: Vec3, diameter_m: f32, focal_px: f32, near_m: f32) -> Option<Self> {
        let valid = head_m.is_finite() && tail_m.is_finite() && diameter_m.is_finite() && focal_px.is_finite();
        if !(valid && diameter_m >= 0.0 && focal_px > 0.0 && near_m > 0.0) {
            return None;
        }
        let (head, tail, share) = clip_to_near(head_m, tail_m, near_m)?;
        let (head_depth, tail_depth) = (-head.z, -tail.z);
        let head_px = head.truncate() * (focal_px / head_depth);
        let tail_px = tail.truncate() * (focal_px / tail_depth);
        // Two roots: the product of two large depths may overflow.
        let size = diameter_m * focal_px / (head_depth.sqrt() * tail_depth.sqrt());
        let length_px = (head_px.distance(tail_px) + size).max(1.0);
        let width_px = size.max(1.0);
        // Also where an end lies beyond all numbers.
        if !length_px.is_finite() {
            return None;
        }
        Some(Self {
            head_px,
            tail_px,
            length_px,
            width_px,
            opacity: FRAC_PI_4 * (size / width_px) * (size / length_px) * share,
        })
    }

    /// Opacity summed over pixels: kept by [`ScreenStreak::blurred`]. Units: px².
    ///
    /// Error: 3e-6 of the exact integral.
    #[must_use]
    pub fn sum_px2(&self) -> f32 {
        self.opacity * self.width_px * self.length_px
    }

    /// The same streak out of focus: wider and longer by the circle of confusion, fainter by as much.
    ///
    /// `blur_px`: diameter of the circle, px; clamped to [0, 1e4], NaN counts as 0.
    ///
    /// Error: the sum is kept to 3e-6 of the exact integral; the profile is a box where a disc's convolution is round.
    #[must_use]
    pub fn blurred(self, blur_px: f32) -> Self {
        let blur = if blur_px > 0.0 { blur_px.min(1e4) } else { 0.0 };
        let (length_px, width_px) = (self.length_px + blur, self.width_px + blur);
        Self {
            length_px,
            width_px,
            opacity: self.opacity * (self.length_px / length_px) * (self.width_px / width_px),
            ..self
        }
    }
}

/// The part of the way from `tail` to `head` (camera space, looking along −z) behind the near plane, and its share of
/// the exposure. `None` when nothing is left or `near_m` is not positive.
///
/// Error: 2e-7 of the segment against the double form.
#[must_use]
pub fn clip_to_near(head: Vec3, tail: Vec3, near_m: f32) -> Option<(Vec3, Vec3, f32)> {
    let (head_in, tail_in) = (-head.z >= near_m, -tail.z >= near_m);
    if near_m.is_nan() || near_m <= 0.0 {
        return None;
    }
    if head_in && tail_in {
        return Some((head, tail, 1.0));
    }
    if !head_in && !tail_in {
        return None;
    }
    let (inside, outside) = if head_in { (head, tail) } else { (tail, head) };
    let share = ((-inside.z - near_m) / (outside.z - inside.z)).clamp(0.0, 1.0);
    let mut cut = inside + (outside - inside) * share;
    cut.z = -near_m;
    Some(if head_in {
        (inside, cut, share)
    } else {
        (cut, inside, share)
    })
}

/// Diameter of the circle of confusion of a thin lens, A f |1/z − 1/z_f|. Units: px.
///
/// `aperture_m`: diameter of the opening, m ≥ 0; `focal_px`: px ≥ 0; `depth_m`, `focus_m`: m > 0. Out of range or NaN:
/// 0. At most 1e6.
///
/// Error: 1e-15 relative to the larger of the two terms.
#[must_use]
pub fn circle_of_confusion_px(aperture_m: f64, focal_px: f64, depth_m: f64, focus_m: f64) -> f64 {
    if !(aperture_m >= 0.0 && focal_px >= 0.0 && depth_m > 0.0 && focus_m > 0.0) {
        return 0.0;
    }
    let blur = aperture_m * focal_px * (1.0 / depth_m - 1.0 / focus_m).abs();
    if blur < 1e6 { blur } else { 1e6 }
}

/// Opacity under a contrast gain, 1 − (1 − α)^g; 1 is physical. Units: none.
///
/// `opacity`: clamped to [0, 1]; `gain`: to [0, 32]; NaN counts as 0.
///
/// Error: 2e-15 relative, also for tiny α.
#[must_use]
pub fn contrast_gain(opacity: f64, gain: f64) -> f64 {
    let (alpha, gain) = (clamped(opacity, 0.0, 1.0), clamped(gain, 0.0, 32.0));
    if alpha >= 1.0 {
        return if gain > 0.0 { 1.0 } else { 0.0 };
    }
    -ops::exp_m1(gain * ops::ln_1p(-alpha))
}

/// Light of a small lamp at a distance, 1/(d² + r²), with the lamp's own radius so that it stays finite. Units: 1/m².
///
/// `distance_m`: m, clamped to [0, 1e9]; `lamp_radius_m`: m, clamped to [1e-3, 1e3]; NaN counts as the lower bound.
/// Yoshida (digest B34) without the pole at d = 0.
///
/// Error: 1e-15 relative; against a sphere of that radius less than 1 % beyond 10 r.
#[must_use]
pub fn lamp_falloff_per_m2(distance_m: f64, lamp_radius_m: f64) -> f64 {
    let d = if distance_m > 0.0 { distance_m.min(1e9) } else { 0.0 };
    let r = if lamp_radius_m > 1e-3 {
        lamp_radius_m.min(1e3)
    } else {
        1e-3
    };
    1.0 / (d * d + r * r)
}
