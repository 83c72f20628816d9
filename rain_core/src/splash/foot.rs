//! Splashes of feet (Lagarde 2013: E47, E48).

use glam::Vec3;

use super::secondary::SecondaryDrop;
use crate::error::{clamped, clamped_f32};
use crate::hash::{pcg, pcg3d, unit_f32};
use crate::ops;

/// Speed of a foot whose splash is as strong as any. Units: m/s.
const FULL_SPEED_M_S: f64 = 2.0;
/// Depth of water whose splash is as strong as any. Units: m.
const FULL_DEPTH_M: f64 = 0.01;

/// How strong a foot splashes that comes down at `speed_m_s` into water `depth_m` deep: (v/2 m/s) · (d/10 mm), each at
/// most 1. Units: none. In [0, 1].
///
/// For the loudness of a sound and the size of an effect. Negative numbers and what is not a number count as 0.
/// Error: 3e-16; a look, chosen: a walker's heel strikes at some 1 m/s, a runner's at 2.
#[must_use]
pub fn foot_splash_strength(speed_m_s: f64, depth_m: f64) -> f64 {
    clamped(speed_m_s / FULL_SPEED_M_S, 0.0, 1.0) * clamped(depth_m / FULL_DEPTH_M, 0.0, 1.0)
}

/// Most drops that a step throws. Units: none.
pub const FOOT_DROPS: u32 = 63;
/// What a step throws is drawn for this long; by then it has landed. Units: s.
pub const FOOT_SPLASH_S: f32 = 0.5;

/// Fewest drops that a step throws.
const FEWEST: f32 = 8.0;
/// Half the width of a sole: where drops and sheet start. Units: m.
const SOLE_M: f32 = 0.05;
/// Smallest and largest drop. Units: mm.
const SIZES_MM: (f32, f32) = (1.5, 6.5);
/// Slowest and fastest drop of the strongest step. Units: m/s.
const SPEEDS_M_S: (f32, f32) = (0.8, 2.5);
/// Flattest and steepest, from level. Units: rad.
const ANGLES: (f32, f32) = (
    25.0 * core::f32::consts::PI / 180.0,
    65.0 * core::f32::consts::PI / 180.0,
);
/// How long the sheet stands that a sole presses out. Units: s.
const SHEET_S: f32 = 0.12;
/// How far the strongest step's sheet spreads, and how high it rises. Units: m.
const SHEET_M: (f32, f32) = (0.15, 0.04);
/// Opacity of that sheet, seen square on.
const SHEET_OPACITY: f32 = 0.25;

/// How many drops a step of `strength` ([`foot_splash_strength`]) throws: 8 to 63, none without strength. Units: none.
///
/// `strength` held in [0, 1], what is not a number counts as 0. Source: a look, chosen.
///
/// Error: exact, the whole part of 8 + 55 strength in single precision; a look.
#[must_use]
pub fn foot_drop_count(strength: f32) -> u32 {
    let strength = clamped_f32(strength, 0.0, 1.0);
    if strength > 0.0 {
        (FEWEST + (FOOT_DROPS as f32 - FEWEST) * strength) as u32
    } else {
        0
    }
}

/// Drop `index` (below [`foot_drop_count`]) of a step, and where it leaves the water, from the step's place. Units: m.
///
/// 1.5 to 6.5 mm, most of them small; 0.8 to 2.5 m/s times the root of the strength, 25° to 65° from level, one in each
/// sector around the sole. `key` tells one step from the other: the same key, the same drops. `strength` as
/// [`foot_drop_count`]. Source: a look, chosen within what films of steps show.
///
/// Error: diameter 2e-7 relative, velocity and place 1e-6 against the same words in double precision.
#[must_use]
pub fn foot_drop(strength: f32, key: [u32; 3], index: u32) -> (SecondaryDrop, Vec3) {
    let count = foot_drop_count(strength).max(1);
    let [a, b, c] = pcg3d([key[0] ^ pcg(index), key[1], key[2].wrapping_add(index)]);
    let u = unit_f32(a);
    let root = clamped_f32(strength, 0.0, 1.0).sqrt();
    let speed = root * (SPEEDS_M_S.0 + (SPEEDS_M_S.1 - SPEEDS_M_S.0) * unit_f32(b));
    let angle = f64::from(ANGLES.0 + (ANGLES.1 - ANGLES.0) * unit_f32(c));
    let sector = f64::from(index) + f64::from(unit_f32(b.rotate_left(13)));
    let around = core::f64::consts::TAU * (sector / f64::from(count));
    let outward = Vec3::new(ops::cos(around) as f32, 0.0, ops::sin(around) as f32);
    let drop = SecondaryDrop {
        diameter_mm: SIZES_MM.0 + (SIZES_MM.1 - SIZES_MM.0) * u * u,
        velocity_m_s: speed * (outward * ops::cos(angle) as f32 + Vec3::Y * ops::sin(angle) as f32),
    };
    (drop, SOLE_M * outward)
}

/// The sheet of water that a sole presses out, `age_s` after the step: radius and height, m, and opacity; zeros before the
/// step, after 0.12 s and without strength.
///
/// Radius 0.05 m and up to 0.15 m more, evenly in time; height a parabola up to 0.04 m; both with the root of the strength.
/// Opacity 0.25, falling to 0 over the second half. `strength` as [`foot_drop_count`]. Source: a look, chosen.
///
/// Error: 1e-6 relative against double precision; a look.
#[must_use]
pub fn foot_sheet(strength: f32, age_s: f32) -> [f32; 3] {
    let strength = clamped_f32(strength, 0.0, 1.0);
    let t = age_s / SHEET_S;
    if !(0.0..1.0).contains(&t) || strength <= 0.0 {
        return [0.0; 3];
    }
    let root = strength.sqrt();
    [
        SOLE_M + SHEET_M.0 * root * t,
        SHEET_M.1 * root * 4.0 * t * (1.0 - t),
        SHEET_OPACITY * (2.0 - 2.0 * t).min(1.0),
    ]
}
