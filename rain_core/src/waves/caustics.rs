//! Light that a ruffled water surface throws onto walls and ceilings: caustics of mirrored rays.
//!
//! # Accuracy
//! Geometric optics of slopes small against 1, first order in them: rays of a parallel beam leave the level surface at
//! their own places and are turned by twice the slope. Heights of waves (millimetres) count as none; rays meet one
//! surface only. The sun's disc blurs evenly.

use crate::error::{clamped, clamped_or};
use crate::ops;

/// Ways along the mirrored ray for which a map is made. Units: m.
pub const CAUSTIC_WAYS_M: [f64; 4] = [0.25, 0.5, 1.0, 2.0];
/// Beyond this way the sun's disc has blurred everything: light is even. Units: m.
pub const CAUSTIC_END_M: f64 = 12.0;
/// Texels on a side of a map.
pub const CAUSTIC_TEXELS: u32 = 256;
/// Rays on a side of a map.
pub const CAUSTIC_RAYS: u32 = 512;
/// Half of the angle that the sun's disc has. Units: rad.
pub const SUN_RADIUS_RAD: f64 = 4.65e-3;
/// Lowest sine of a light's elevation that a map is made for: 3°. Lower light counts as that.
pub const LEAST_ELEVATION: f64 = 0.052;

/// How far a slope moves a mirrored ray, seen from where it would come from on level water: −2 (L_y η + L_h (L_h·η)/L_y) for
/// each metre of its way. Units: none (m/m), along x and z.
///
/// `towards`: unit vector towards the light (x, y up, z), y held in [0.052, 1]. `slope`: ∂η/∂x, ∂η/∂z of the surface, each
/// held in [−10, 10]; NaN counts as 0. From the law of reflection, linear in the slope.
///
/// Error: 1e-15 relative to the linear form; against exact reflection the square of the slope, over the elevation's sine.
#[must_use]
pub fn caustic_shift(towards: [f64; 3], slope: [f64; 2]) -> [f64; 2] {
    let up = clamped_or(towards[1], LEAST_ELEVATION, 1.0, 1.0);
    let [x, z] = slope.map(|s| clamped_or(s, -10.0, 10.0, 0.0));
    let along = [towards[0], towards[2]].map(|t| clamped_or(t, -1.0, 1.0, 0.0));
    let into = (along[0] * x + along[1] * z) / up;
    [-2.0 * (up * x + along[0] * into), -2.0 * (up * z + along[1] * into)]
}

/// Radius of the sun's disc in a map, at a way. Units: texels, ≥ 0.
///
/// `way_m`: m, held in [0, 100]. `side_m`: side of the map, m, held in [0.01, 100]. The long axis of a low sun's disc on the
/// level is left out: it would be longer by 1/sine of its elevation.
///
/// Error: 1e-15 relative.
#[must_use]
pub fn sun_blur_texels(way_m: f64, side_m: f64) -> f64 {
    SUN_RADIUS_RAD * clamped(way_m, 0.0, 100.0) * f64::from(CAUSTIC_TEXELS) / clamped(side_m, 0.01, 100.0)
}

/// Light at a way from the maps' values there: between neighbouring ways, linear from even light at the water, and even again at
/// [`CAUSTIC_END_M`]. Units: of the mean, 1.
///
/// `values`: those of the maps at [`CAUSTIC_WAYS_M`]. `way_m`: m, held in [0, 100]; NaN counts as 0.
///
/// Error: 1e-14; between two ways lines of one fade into those of the other.
#[must_use]
pub fn caustic_at(values: [f64; 4], way_m: f64) -> f64 {
    let way = clamped_or(way_m, 0.0, 100.0, 0.0);
    let [first, .., last] = CAUSTIC_WAYS_M;
    if way < first {
        return 1.0 + (values[0] - 1.0) * way / first;
    }
    if way >= last {
        let left = ((CAUSTIC_END_M - way) / (CAUSTIC_END_M - last)).max(0.0);
        return 1.0 + (values[3] - 1.0) * left * left;
    }
    let octaves = ops::ln(way / first) / core::f64::consts::LN_2;
    let below = (octaves as usize).min(2);
    let share = octaves - below as f64;
    values[below] + (values[below + 1] - values[below]) * share
}

/// Light that mirrored rays throw, by cells of a level map, at each of [`CAUSTIC_WAYS_M`]: the reference of the GPU's pass.
/// Units: of the mean, which is 1.
///
/// `slope`: the surface's at a place in sides of the tile, each in [0, 1); the tile repeats. `towards` as in
/// [`caustic_shift`]; `side_m`: side of the tile, m, held in [0.01, 100].
/// Rows of [`CAUSTIC_TEXELS`] values, x along a row.
///
/// Error: rays are [`CAUSTIC_RAYS`]² points; the mean is 1 to 1e-12.
#[must_use]
pub fn caustic_map(towards: [f64; 3], side_m: f64, slope: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<[f64; 4]> {
    let side_m = clamped(side_m, 0.01, 100.0);
    let texels = CAUSTIC_TEXELS as usize;
    let ray = f64::from(CAUSTIC_TEXELS * CAUSTIC_TEXELS) / f64::from(CAUSTIC_RAYS * CAUSTIC_RAYS);
    let mut thrown = vec![[0.0; 4]; texels * texels];
    for row in 0..CAUSTIC_RAYS {
        for column in 0..CAUSTIC_RAYS {
            let at = [column, row].map(|i| (f64::from(i) + 0.5) / f64::from(CAUSTIC_RAYS));
            let shift = caustic_shift(towards, slope(at));
            for (layer, way) in CAUSTIC_WAYS_M.into_iter().enumerate() {
                let place = [0, 1].map(|i| (at[i] + shift[i] * way / side_m) * f64::from(CAUSTIC_TEXELS) - 0.5);
                let (corner, part) = (place.map(f64::floor), place.map(|p| p - p.floor()));
                for (dx, dz) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    let weight = [dx, dz].into_iter().zip(part);
                    let weight: f64 = weight.map(|(d, part)| if d == 1 { part } else { 1.0 - part }).product();
                    let wrapped = |corner: f64, d: i64| (corner as i64 + d).rem_euclid(texels as i64) as usize;
                    thrown[wrapped(corner[1], dz) * texels + wrapped(corner[0], dx)][layer] += ray * weight;
                }
            }
        }
    }
    blurred(&thrown, side_m)
}

/// Each map blurred by the sun's disc.
fn blurred(thrown: &[[f64; 4]], side_m: f64) -> Vec<[f64; 4]> {
    let texels = CAUSTIC_TEXELS as i64;
    let mut out = vec![[0.0; 4]; thrown.len()];
    for (layer, way) in CAUSTIC_WAYS_M.into_iter().enumerate() {
        let radius = sun_blur_texels(way, side_m);
        let reach = (radius + 0.5).min(8.0) as i64;
        let mut disc = Vec::new();
        for dz in -reach..=reach {
            for dx in -reach..=reach {
                let weight = (radius + 0.5 - ops::sqrt((dx * dx + dz * dz) as f64)).clamp(0.0, 1.0);
                disc.push((dx, dz, weight));
            }
        }
        let whole: f64 = disc.iter().map(|(.., weight)| weight).sum();
        for row in 0..texels {
            for column in 0..texels {
                let sum: f64 = disc
                    .iter()
                    .map(|&(dx, dz, weight)| {
                        let (x, z) = ((column + dx).rem_euclid(texels), (row + dz).rem_euclid(texels));
                        weight * thrown[(z * texels + x) as usize][layer]
                    })
                    .sum();
                out[(row * texels + column) as usize][layer] = sum / whole;
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use core::f64::consts::TAU;

    use super::*;

    fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
        a.into_iter().zip(b).map(|(a, b)| a * b).sum()
    }

    /// Where an exactly mirrored ray of the origin meets the height of a wall's point `way` up the unturned ray, minus where
    /// the unturned ray does, seen back along the unturned ray on the level.
    fn exact(towards: [f64; 3], slope: [f64; 2], way: f64) -> [f64; 2] {
        let length = (1.0 + slope[0] * slope[0] + slope[1] * slope[1]).sqrt();
        let normal = [-slope[0] / length, 1.0 / length, -slope[1] / length];
        let into = towards.map(|t| -t);
        let twice = 2.0 * dot(into, normal);
        let out = [0, 1, 2].map(|i| into[i] - twice * normal[i]);
        let height = way * towards[1];
        let there = [0, 2].map(|i| out[i] * height / out[1]);
        [0, 1].map(|i| there[i] + towards[2 * i] * way)
    }

    #[test]
    fn a_slope_turns_a_mirrored_ray_by_the_law_of_reflection() {
        let high = [0.0, 1.0, 0.0];
        assert_eq!(caustic_shift(high, [0.1, 0.0]), [-0.2, 0.0]);
        for elevation in [0.3_f64, 0.8, 1.3] {
            for azimuth in [0.0_f64, 1.0, 4.0] {
                let (out, up) = (elevation.cos(), elevation.sin());
                let towards = [out * azimuth.cos(), up, out * azimuth.sin()];
                for slope in [[1e-4, 0.0], [0.0, -1e-4], [7e-5, 5e-5]] {
                    let found = caustic_shift(towards, slope).map(|s| 2.0 * s);
                    let truth = exact(towards, slope, 2.0);
                    for i in 0..2 {
                        assert!((found[i] - truth[i]).abs() < 1e-6, "{found:?} {truth:?}");
                    }
                }
            }
        }
        assert!(
            caustic_shift([f64::NAN; 3], [f64::INFINITY, f64::NAN])
                .iter()
                .all(|s| s.is_finite())
        );
    }

    #[test]
    fn still_water_throws_even_light_and_none_is_lost() {
        let towards = [0.6, 0.8, 0.0];
        for value in caustic_map(towards, 1.0, |_| [0.0; 2]) {
            assert!(value.iter().all(|v| (v - 1.0).abs() < 1e-12), "{value:?}");
        }
        let waves = |at: [f64; 2]| [0.02 * (TAU * 8.0 * at[0]).cos(), 0.015 * (TAU * 11.0 * at[1]).sin()];
        let map = caustic_map(towards, 1.0, waves);
        for layer in 0..4 {
            let mean = map.iter().map(|v| v[layer]).sum::<f64>() / map.len() as f64;
            assert!((mean - 1.0).abs() < 1e-12, "{mean}");
        }
    }

    #[test]
    fn a_trough_focuses_at_half_its_radius_of_curvature() {
        // Slope a sin(kx) has the curvature ak in the middle of its trough: light from above meets at 1/(2ak).
        let k = TAU * 2.0;
        let focus = 1.0;
        let steep = 0.5 / (focus * k);
        let map = caustic_map([0.0, 1.0, 0.0], 1.0, |at| [steep * ops::sin(k * at[0]), 0.0]);
        let row = |layer: usize, column: usize| map[column][layer];
        let texels = CAUSTIC_TEXELS as usize;
        let brightest = |layer| (0..texels).map(|c| row(layer, c)).fold(0.0, f64::max);
        // Before the focus a mirror of half its length brightens by 1/(1 − way/focus).
        assert!((row(0, 0) / (1.0 / 0.75) - 1.0).abs() < 0.02, "{}", row(0, 0));
        assert!((row(1, 0) / 2.0 - 1.0).abs() < 0.03, "{}", row(1, 0));
        // Crests, half a wave on, spread it.
        assert!(
            (row(1, texels / 4) / (1.0 / 1.5) - 1.0).abs() < 0.03,
            "{}",
            row(1, texels / 4)
        );
        // At the focus the sun's disc is what limits it; beyond, light parts again.
        assert!(row(2, 0) > 4.0 && brightest(2) < 40.0, "{}", row(2, 0));
        assert!(row(3, 0) < 0.6 * row(2, 0), "{} {}", row(3, 0), row(2, 0));
    }

    #[test]
    fn light_goes_from_way_to_way_without_a_step_and_ends_even() {
        let values = [2.0, 0.5, 3.0, 1.4];
        assert_eq!(caustic_at(values, 0.0), 1.0);
        assert_eq!(caustic_at(values, f64::NAN), 1.0);
        for (way, value) in CAUSTIC_WAYS_M.into_iter().zip(values) {
            for near in [way * (1.0 - 1e-9), way, way * (1.0 + 1e-9)] {
                assert!((caustic_at(values, near) - value).abs() < 1e-7, "{way}");
            }
        }
        assert_eq!(caustic_at(values, CAUSTIC_END_M), 1.0);
        assert_eq!(caustic_at(values, 1e9), 1.0);
        assert!((sun_blur_texels(2.0, 1.0) - 2.3808).abs() < 1e-9);
    }
}
