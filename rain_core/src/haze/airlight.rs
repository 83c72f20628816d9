//! Glow of a lamp in rain: light that drops scatter once towards the eye (Sun, Ramamoorthi, Narasimhan & Nayar 2005, with
//! the phase function of drops).
//!
//! Along a line of sight the angle by which a drop turns the lamp's light, θ, grows evenly with the angle under which the
//! lamp sees the line: dt / r² = dθ / h. So ∫ p(θ) dt / r² = (1/h) ∫ p dθ, which is closed where p is.
//!
//! # Accuracy
//! Single scattering; nothing stands between lamp and drops. Half of what rain takes out is diffracted by less than 0.1° and
//! does not leave the lamp's own picture.

use glam::DVec3;

use crate::error::clamped;
use crate::ops;
use crate::optics::{CHEAP_REFLECTED, CHEAP_REFRACTED};

/// Largest share that leaves per steradian, about straight on.
const MAX_PHASE: f64 = 1.2;
/// ln of the share straight on without that bound, and how fast it falls. Units: none, 1/rad.
const PHASE_LINE: [f64; 2] = [0.745, 3.44];
/// Angle from which on the share falls. Units: rad.
const KNEE_RAD: f64 = 0.163_569_4;
/// Borders of the pieces of θ that have one loss each, as shares.
const LOSS_PIECES: [f64; 5] = [0.0, 0.15, 0.4, 0.7, 1.0];
/// A lamp is no smaller than this. Units: m.
pub const LEAST_LAMP_M: f64 = 0.05;

/// Share of the light on a drop's disc that leaves per steradian at `angle_rad` from straight on. Units: 1/sr.
///
/// `angle_rad`: θ, rad, clamped to [0, π], NaN counts as 0. Refraction within 60°, and outer reflection evenly into all
/// directions.
///
/// Error: exact to 1e-15 as a fit; 8 % of what a sphere sends to 10–60°.
#[must_use]
pub fn drop_phase_per_sr(angle_rad: f64) -> f64 {
    let theta = clamped(angle_rad, 0.0, core::f64::consts::PI);
    let refracted = ops::exp(PHASE_LINE[0] - PHASE_LINE[1] * theta).min(MAX_PHASE);
    f64::from(CHEAP_REFRACTED) * refracted + f64::from(CHEAP_REFLECTED) / (4.0 * core::f64::consts::PI)
}

/// ∫₀^θ of [`drop_phase_per_sr`]. Units: rad/sr. `angle_rad` as there.
///
/// Error: 1e-6 against the integral, the rounding of the knee's angle.
#[must_use]
pub fn drop_phase_integral(angle_rad: f64) -> f64 {
    let theta = clamped(angle_rad, 0.0, core::f64::consts::PI);
    let tail = (theta - KNEE_RAD).max(0.0);
    let refracted = MAX_PHASE * (theta.min(KNEE_RAD) - ops::exp_m1(-PHASE_LINE[1] * tail) / PHASE_LINE[1]);
    f64::from(CHEAP_REFRACTED) * refracted + f64::from(CHEAP_REFLECTED) / (4.0 * core::f64::consts::PI) * theta
}

/// Glow of a lamp of 1 cd along a line of sight through drops of 1/m geometric extinction: times σ_geo (1/m) and I (cd) it
/// is a luminance. Units: 1/m.
///
/// `lamp_m`: place from the eye, m, finite; `towards`: unit line of sight; the way from `from_m` to `to_m` (m, from 0 on)
/// counts; `radius_m`: the lamp's, the glow grows no more nearer than this (at least [`LEAST_LAMP_M`]);
/// `extinction_per_m`: what the light loses on its way to the drop and to the eye, 1/m ≥ 0.
///
/// In four pieces of θ, each with the loss on the way t + r by its middle.
///
/// Error: 0.02 of the glow where the lamp's distance times the extinction is at most 0.7, against the integral with the
/// loss inside; 1e-4 without loss.
#[must_use]
pub fn lamp_glow_per_m(
    lamp_m: DVec3,
    towards: DVec3,
    from_m: f64,
    to_m: f64,
    radius_m: f64,
    extinction_per_m: f64,
) -> f64 {
    let (from, to) = (clamped(from_m, 0.0, 1e9), clamped(to_m, 0.0, 1e9));
    let nearest = lamp_m.dot(towards);
    let beside = (lamp_m - nearest * towards).length();
    let h = beside.max(clamped(radius_m, LEAST_LAMP_M, 1e3));
    if to <= from || !nearest.is_finite() {
        return 0.0;
    }
    let [a, b] = [from, to].map(|t| ops::atan2(h, nearest - t));
    let mut light = 0.0;
    for piece in LOSS_PIECES.windows(2) {
        let [low, high] = [a + (b - a) * piece[0], a + (b - a) * piece[1]];
        // t + r = t₀ + h tan(θ/2).
        let way = nearest + h * ops::tan(0.25 * (low + high));
        let loss = ops::exp(-clamped(extinction_per_m * way, 0.0, 700.0));
        light += (drop_phase_integral(high) - drop_phase_integral(low)) * loss;
    }
    light / h
}

/// The part of a line of sight from the eye that a cone lights: from and to, m, empty (to ≤ from) where it misses.
///
/// `apex_m`: from the eye, m; `axis`: unit direction of the cone; `cosine`: of its half angle, clamped to [0.01, 1];
/// `towards`: unit line of sight.
///
/// Error: 1e-9 of the apex's distance.
#[must_use]
pub fn cone_span_m(apex_m: DVec3, axis: DVec3, cosine: f64, towards: DVec3) -> [f64; 2] {
    let c = clamped(cosine, 0.01, 1.0);
    let along = axis.dot(towards);
    let start = -axis.dot(apex_m);
    let (a, b, k) = (
        along * along - c * c,
        along * start + c * c * apex_m.dot(towards),
        start * start - c * c * apex_m.length_squared(),
    );
    let square = b * b - a * k;
    if square <= 0.0 || a == 0.0 {
        return [0.0; 2];
    }
    let root = ops::sqrt(square);
    let (first, second) = ((-b - root) / a, (-b + root) / a);
    let (low, high) = (first.min(second), first.max(second));
    let [from, to] = if a < 0.0 {
        // Both on one of the two nappes.
        if start + along * 0.5 * (low + high) > 0.0 {
            [low, high]
        } else {
            [0.0; 2]
        }
    } else if along > 0.0 {
        [high, f64::INFINITY]
    } else {
        [f64::NEG_INFINITY, low]
    };
    [from.max(0.0), to.min(1e9)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ p(θ) e^(−σ(t + r)) / r² dt by 200 000 midpoints.
    fn by_sum(lamp: DVec3, towards: DVec3, to: f64, extinction: f64) -> f64 {
        let n = 200_000;
        let dt = to / f64::from(n);
        (0..n)
            .map(|i| {
                let t = (f64::from(i) + 0.5) * dt;
                let from_lamp = towards * t - lamp;
                let r = from_lamp.length();
                let theta = ops::acos((from_lamp / r).dot(-towards).clamp(-1.0, 1.0));
                drop_phase_per_sr(theta) * ops::exp(-extinction * (t + r)) / (r * r) * dt
            })
            .sum()
    }

    #[test]
    fn the_integral_of_the_phase_is_that_of_its_sum() {
        let mut sum = 0.0;
        let n = 100_000;
        for i in 0..n {
            let theta = (f64::from(i) + 0.5) * core::f64::consts::PI / f64::from(n);
            sum += drop_phase_per_sr(theta) * core::f64::consts::PI / f64::from(n);
            let at = (f64::from(i) + 1.0) * core::f64::consts::PI / f64::from(n);
            assert!((drop_phase_integral(at) - sum).abs() < 1e-6, "{at}: {sum}");
        }
    }

    #[test]
    fn glow_of_a_lamp_is_its_integral() {
        let mut worst: f64 = 0.0;
        for distance in [3.0, 20.0, 100.0] {
            for degrees in [0.5_f64, 3.0, 15.0, 50.0, 90.0, 150.0] {
                for to in [0.4 * distance, 0.95 * distance, 4.0 * distance] {
                    let lamp = DVec3::new(0.0, 0.0, -distance);
                    let g = degrees.to_radians();
                    let towards = DVec3::new(ops::sin(g), 0.0, -ops::cos(g));
                    // Beside the lamp's own size.
                    if distance * ops::sin(g) < LEAST_LAMP_M && degrees < 90.0 {
                        continue;
                    }
                    let found = lamp_glow_per_m(lamp, towards, 0.0, to, 0.0, 0.0);
                    let expected = by_sum(lamp, towards, to, 0.0);
                    assert!(
                        (found / expected - 1.0).abs() < 1e-4,
                        "{distance} m {degrees}° {to} m: {found} {expected}"
                    );
                    let extinction = 0.7 / distance;
                    let found = lamp_glow_per_m(lamp, towards, 0.0, to, 0.0, extinction);
                    let expected = by_sum(lamp, towards, to, extinction);
                    worst = worst.max((found / expected - 1.0).abs());
                }
            }
        }
        assert!(worst < 0.02, "{worst}");
    }

    #[test]
    fn a_cone_lights_the_part_of_a_line_within_it() {
        let mut hits = 0;
        for i in 0..4000_u32 {
            let h = |k: u32| f64::from((i * 7919 + k * 104_729) % 1999) / 1999.0 * 2.0 - 1.0;
            let apex = DVec3::new(h(1), h(2), h(3)) * 20.0;
            let axis = DVec3::new(h(4), h(5), h(6)).normalize_or(DVec3::Y);
            let towards = DVec3::new(h(7), h(8), h(9)).normalize_or(DVec3::X);
            let cosine = 0.5 + 0.49 * h(10);
            let [from, to] = cone_span_m(apex, axis, cosine, towards);
            for step in 0..60_u32 {
                let t = f64::from(step) * 0.9 + 0.013;
                let p = towards * t - apex;
                let inside = p.dot(axis) - cosine * p.length();
                if inside.abs() > 1e-6 {
                    assert_eq!(t > from && t < to, inside > 0.0, "{i} at {t}: {from} to {to}");
                    hits += u32::from(inside > 0.0);
                }
            }
        }
        assert!(hits > 1000, "{hits}");
    }
}
