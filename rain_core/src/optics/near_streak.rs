//! What a near drop draws while it falls: its outline as it swings, and the picture in it swept along its streak.
//!
//! A streak whose drop is wider than a pixel or two is no even strip: each of its pixels sees a chord of the drop go by, with
//! all that the drop shows along this chord. What that is depends on the elevation of the line of sight, on where the light
//! comes from and on how the drop swings just then. Nothing is tabulated: rays are traced through [`DropBody`] for each
//! place, so every angle, size and phase has its own pattern.
//!
//! # Accuracy
//! That of [`DropBody`] with three rays, of a body whose halves are fitted to the outlines of Beard & Chuang and stretched
//! by the mode n = 2. The outline's area is that of the equivalent sphere's disc, which the optical depth of rain counts:
//! the outline of a 4 mm drop is 4 % wider than the drop. A swing at constant fall speed, about the vertical.

use core::f64::consts::TAU;

use glam::{Vec2, Vec3};

use super::drop_body::{DropBody, DropRay};
use crate::error::clamped_or_f32;
use crate::rainfall::{mode_frequency_hz, phase_turns, sustained_amplitude};

/// Refractive index of water that near drops have. Units: none.
pub const WATER_INDEX: f32 = 1.333;

/// Least fall speed that a swing is laid out by. Units: m/s.
const LEAST_FALL_M_S: f64 = 0.5;

/// The body of a drop deflected in its slowest mode.
///
/// `diameter_mm`: mm, clamped to [0, 6]; `deflection`: A₂ sin(2πφ) in radii, clamped to [−0.4, 0.4]; NaN counts as 0. At
/// rest a fit to Beard & Chuang 1987; both halves are stretched by (1 + δ)/(1 − δ/2), as mode 2 stretches a sphere.
///
/// Error: upper half 7e-4, lower half 4e-3 against [`DropBody::of_outline`] at rest; 0.05 at a deflection of 0.15.
#[must_use]
pub fn swinging_body(diameter_mm: f32, deflection: f32) -> DropBody {
    let d = clamped_or_f32(diameter_mm, 0.0, 6.0, 0.0);
    let delta = clamped_or_f32(deflection, -0.4, 0.4, 0.0);
    let stretch = (1.0 + delta) / (1.0 - 0.5 * delta);
    let upper = 1.0 + d * d * (-8.124_22e-3 + d * (6.076_22e-5 + d * 3.621_74e-5));
    let lower = 1.0 + d * d * (-2.969_648e-2 + d * (-2.215_78e-3 + d * (1.731_51e-3 - d * 1.522_1e-4)));
    DropBody::new(upper * stretch, lower * stretch)
}

/// Deflection in its slowest mode of a drop that falls evenly, by its height: the same at the same place whenever and from
/// wherever it is seen, and as much further in phase as it has fallen. Units: radii.
///
/// `diameter_mm` and amplitude as in [`sustained_amplitude`]; `start_turns`: the drop's own phase, turns; `height_m`: m;
/// `fall_m_s`: downward speed, m/s, at least 0.5, NaN counts as that. What else is not finite gives phase 0.
///
/// Error: 1e-11 radii after some thousands of turns, against phases kept by time.
#[must_use]
pub fn swing_at(diameter_mm: f64, start_turns: f64, height_m: f64, fall_m_s: f64) -> f64 {
    let fall = if fall_m_s > LEAST_FALL_M_S {
        fall_m_s
    } else {
        LEAST_FALL_M_S
    };
    let frequency = mode_frequency_hz(2, diameter_mm.max(0.05));
    let turns = phase_turns(frequency, -height_m / fall, start_turns);
    sustained_amplitude(diameter_mm) * crate::ops::sin(TAU * turns)
}

/// Heights of a body's outline over and under the middle of its widest circle, seen along a line that rises by the angle of
/// this sine. Units: radii of that circle.
///
/// `sine`: clamped to [−1, 1]; NaN counts as 0.
///
/// Error: 3e-7 against the ellipses of the halves; of a body whose halves differ exact when seen level.
#[must_use]
pub fn outline_heights(body: DropBody, sine: f32) -> [f32; 2] {
    let s = clamped_or_f32(sine, -1.0, 1.0, 0.0);
    [body.upper(), body.lower()].map(|h| (h * h * (1.0 - s) * (1.0 + s) + s * s).sqrt())
}

/// Radius of the widest circle of an outline over that of the disc of the same area, √(2/(up + down)). Units: none.
///
/// `outline`: as [`outline_heights`] gives them; each clamped to [0.1, 10], NaN counts as 0.1.
///
/// Error: 3e-7 against the sum over chords.
#[must_use]
pub fn outline_radius(outline: [f32; 2]) -> f32 {
    let [up, down] = outline.map(|h| clamped_or_f32(h, 0.1, 10.0, 0.1));
    (2.0 / (up + down)).sqrt()
}

/// From when to when a point lies within an outline that moves: the outline's middle is at `time · path`. `None`: never.
///
/// All in radii of the widest circle, x level, y up; time in units of which `path` is one. `outline` as in
/// [`outline_radius`]. What is not finite, and a path shorter than 1e-6, gives `None`.
///
/// Error: 1e-5 of a crossing of the whole drop, against steps along the path.
#[must_use]
pub fn time_inside(point: Vec2, path: Vec2, outline: [f32; 2]) -> Option<[f32; 2]> {
    if !(point.is_finite() && path.is_finite() && path.length_squared() > 1e-12) {
        return None;
    }
    let mut found: Option<[f32; 2]> = None;
    for (half, height) in [(1.0, outline[0]), (-1.0, outline[1])] {
        let scale = Vec2::new(1.0, 1.0 / clamped_or_f32(height, 0.1, 10.0, 0.1));
        let (p, w) = (point * scale, path * scale);
        let middle = p.dot(w) / w.length_squared();
        let root = 1.0 - (p - middle * w).length_squared();
        if root <= 0.0 {
            continue;
        }
        let reach = (root / w.length_squared()).sqrt();
        let (mut from, mut to) = (middle - reach, middle + reach);
        // This half alone: (point.y − t path.y) half ≥ 0.
        let (level, sink) = (point.y * half, path.y * half);
        if sink.abs() < 1e-6 {
            if level < 0.0 {
                continue;
            }
        } else if sink > 0.0 {
            to = to.min(level / sink);
        } else {
            from = from.max(level / sink);
        }
        if from < to {
            found = Some(found.map_or([from, to], |[a, b]| [a.min(from), b.max(to)]));
        }
    }
    found
}

/// Share per steradian of light spread about a direction, k/(2π(1 − e^(−2k))) e^(k(c − 1)) (von Mises & Fisher). Units:
/// sr⁻¹.
///
/// `cosine`: of the angle off the direction, clamped to [−1, 1], NaN counts as −1; `sharpness`: k, one over the square of the
/// spread in radians, clamped to [0.01, 1e4], NaN counts as 0.01.
///
/// Error: 2e-5 relative, of its sum over all directions 1e-5.
#[must_use]
pub fn light_lobe(cosine: f32, sharpness: f32) -> f32 {
    let c = clamped_or_f32(cosine, -1.0, 1.0, -1.0);
    let k = clamped_or_f32(sharpness, 0.01, 1e4, 0.01);
    let whole = core::f32::consts::TAU * -crate::ops::exp_m1(f64::from(-2.0 * k)) as f32;
    k / whole * crate::ops::exp(f64::from(k * (c - 1.0))) as f32
}

/// Radiance that rays through a drop bring from a distant light of irradiance 1, spread by [`light_lobe`]: the reflected
/// and the inner one, which turn twice as fast from place to place, over twice the angle. Units: sr⁻¹.
///
/// `rays`: the first three of [`DropBody::rays`]; `light`: unit vector towards the light; `sharpness` of the straight ray.
///
/// Error: 2e-5 of the greatest lobe, that of [`light_lobe`].
#[must_use]
pub fn drop_glint(rays: &[DropRay; 3], light: Vec3, sharpness: f32) -> f32 {
    let [outside, straight, inner] = rays;
    let share = |ray: &DropRay, k: f32| ray.weight * light_lobe(ray.direction.dot(light), k);
    share(straight, sharpness) + share(outside, 0.25 * sharpness) + share(inner, 0.25 * sharpness)
}

/// The angles that a streak's pattern of a distant light depends on, beside the drop; it falls along −y (Garg & Nayar 2006).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StreakAngles {
    /// By how much the line of sight from the eye to the drop rises. Units: rad. Domain: [−π/2, π/2].
    pub view_elevation_rad: f32,
    /// Elevation of the light. Units: rad. Domain: [−π/2, π/2].
    pub light_elevation_rad: f32,
    /// Azimuth of the light off the line of sight, positive to the right; 0: behind the drop. Units: rad.
    pub light_azimuth_rad: f32,
}

impl StreakAngles {
    /// Unit vectors from the eye to the drop, along −z seen from above, and to the light.
    ///
    /// Error: 3e-7.
    #[must_use]
    pub fn directions(&self) -> [Vec3; 2] {
        let of = |elevation: f32, azimuth: f32| {
            let (e, a) = (f64::from(elevation), f64::from(azimuth));
            let level = crate::ops::cos(e);
            Vec3::new(
                (level * crate::ops::sin(a)) as f32,
                crate::ops::sin(e) as f32,
                (-level * crate::ops::cos(a)) as f32,
            )
        };
        [
            of(self.view_elevation_rad, 0.0),
            of(self.light_elevation_rad, self.light_azimuth_rad),
        ]
    }
}

/// Mean radiance along the chord of a falling drop at `across`, from a distant light of irradiance 1: what a long streak
/// shows there while the drop is in this shape. Units: sr⁻¹.
///
/// `across`: in radii of the widest circle, positive to the right, clamped to [−0.999, 0.999], NaN counts as 0; `spread_rad`:
/// angle that the light is spread over, clamped to [0.05, 2], NaN counts as 2. Angles that are not finite count as 0.
///
/// Error: 2e-3 of the greatest of its streak, against four times the 48 places along the chord, from a spread of 0.1 on.
#[must_use]
pub fn streak_pattern(body: DropBody, angles: &StreakAngles, across: f32, spread_rad: f32) -> f32 {
    pattern_of(body, angles, across, spread_rad, 48)
}

/// [`streak_pattern`] from `places` points of the chord.
fn pattern_of(body: DropBody, angles: &StreakAngles, across: f32, spread_rad: f32, places: u16) -> f32 {
    let finite = |x: f32| if x.is_finite() { x } else { 0.0 };
    let [view, light] = StreakAngles {
        view_elevation_rad: finite(angles.view_elevation_rad),
        light_elevation_rad: finite(angles.light_elevation_rad),
        light_azimuth_rad: finite(angles.light_azimuth_rad),
    }
    .directions();
    let [view, light] = [view, light].map(Vec3::normalize);
    let x = clamped_or_f32(across, -0.999, 0.999, 0.0);
    let spread = clamped_or_f32(spread_rad, 0.05, 2.0, 2.0);
    let [up, down] = outline_heights(body, view.y);
    let chord = (1.0 - x * x).sqrt();
    let upward = Vec3::X.cross(view);
    let mut sum = 0.0;
    for i in 0..places {
        let share = (f32::from(i) + 0.5) / f32::from(places);
        let y = chord * (share * (up + down) - down);
        let rays = body
            .enter(Vec3::X * x + upward * y, view)
            .and_then(|normal| body.rays::<3>(view, normal, WATER_INDEX));
        sum += rays.map_or(0.0, |rays| drop_glint(&rays, light, 1.0 / (spread * spread)));
    }
    sum / f32::from(places)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forty_eight_places_make_a_chord() {
        let angles = StreakAngles {
            view_elevation_rad: 0.2,
            light_elevation_rad: 0.5,
            light_azimuth_rad: 0.4,
        };
        let body = swinging_body(4.0, 0.1);
        let off = |places: u16| {
            let (mut worst, mut greatest) = (0.0_f32, 0.0_f32);
            for i in -18..=18_i8 {
                let x = 0.05 * f32::from(i);
                let fine = pattern_of(body, &angles, x, 0.1, 192);
                greatest = greatest.max(fine);
                worst = worst.max((pattern_of(body, &angles, x, 0.1, places) - fine).abs());
            }
            worst / greatest
        };
        assert!(off(48) < 2e-3, "{}", off(48));
        assert!(off(4) > 2e-2, "{}", off(4));
    }
}
