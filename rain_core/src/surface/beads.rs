//! Drops that sit on smooth surfaces, paint and glass: where they sit, how they bend the surface, and those that trickle
//! down steep faces.
//!
//! A sessile drop smaller than the capillary length (2.7 mm) is a spherical cap that meets the surface at the contact angle.
//! Drops lie one to a cell of two square lattices, turned, each row shifted, jittered, of random size, small ones more often; they grow with the water on the surface and
//! shrink as it dries. On steep faces drops too heavy to stick run down columns and leave a thin trail behind in which no
//! others sit.
//!
//! # Accuracy
//! The caps' shape is exact below the capillary length, gravity flattens larger ones. How many there are, their sizes and
//! speeds are a look: beads of 0.5 to 4.8 mm that cover 36 % of a soaked surface, runs at 6 cm/s.

use core::f64::consts::TAU;

use crate::error::clamped;
use crate::hash::{pcg3d, unit_f32};
use crate::ops;

/// Contact angle of water on clean car paint. Units: rad (70°).
pub const BEAD_CONTACT_RAD: f64 = 70.0 * core::f64::consts::PI / 180.0;
/// Cells of the two lattices. Units: m.
pub const BEAD_CELLS_M: [f64; 2] = [0.005, 0.0025];
/// Least and greatest radius of their drops, as shares of a cell.
const RADII: [[f64; 2]; 2] = [[0.12, 0.48], [0.1, 0.46]];
/// Cosine and sine of the lattices' turns against the face's directions, so that no row shows.
const TURNS: [[f64; 2]; 2] = [[0.8, 0.6], [0.384_615_384_615_384_6, -0.923_076_923_076_923_1]];
/// Steepest slope that is shown: a cap's rim is drawn flatter than it is.
const STEEPEST: f64 = 1.6;
/// Width of a column that one drop at a time runs down. Units: m.
pub const TRICKLE_WIDTH_M: f64 = 0.02;
/// Way from one drop to the next in a column. Units: m.
const TRICKLE_LENGTH_M: f64 = 0.8;
/// Units: m/s. A whole number of lengths in the shaders' period of 4096 s.
const TRICKLE_SPEED_M_S: f64 = 0.0625;
const TRICKLES_PER_PERIOD: i64 = 320;
/// Share of the places in a column that hold a drop on a soaked face.
const TRICKLE_SHARE: f64 = 0.35;
/// Radius of a running drop, half width of its trail, length of the trail. Units: m.
const HEAD_M: f64 = 0.0022;
const TRAIL_M: f64 = 0.0009;
const TRAIL_LENGTH_M: f64 = 0.3;

/// What drops do to a surface at a point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Beads {
    /// Slope of the water's surface against the face's own, along the two directions of the face. Units: none.
    pub slope: [f64; 2],
    /// 1 where water sits, 0 where none does.
    pub cover: f64,
}

/// Slope of a cap at a share of its base's radius, down from the middle: x/√(1/sin²θ − x²), at most 1.6. Units: none.
/// The share is held in [0, 1].
/// Error: 1e-14.
#[must_use]
pub fn bead_slope(share: f64) -> f64 {
    let x = clamped(share, 0.0, 1.0);
    let sin = ops::sin(BEAD_CONTACT_RAD);
    (x / ops::sqrt(1.0 / (sin * sin) - x * x)).min(STEEPEST)
}

/// How far a drop has grown when a `wetness` in [0, 1] is on the surface; `chance` in [0, 1] is its own. Units: none.
/// Error: 1e-15; a look.
#[must_use]
pub fn bead_growth(wetness: f64, chance: f64) -> f64 {
    clamped(
        (clamped(wetness, 0.0, 1.0) - 0.7 * clamped(chance, 0.0, 1.0)) / 0.3,
        0.0,
        1.0,
    )
}

/// The drop of a lattice (0 coarse, 1 fine) at a place on the face. Units: m. A place that is not finite has none.
/// Error: 1e-6 of a cell against the shader, whose places are in single precision.
#[must_use]
pub fn bead_at(place_m: [f64; 2], lattice: usize, seed: u32, wetness: f64) -> Beads {
    let (Some(&cell_m), Some(&[least, most])) = (BEAD_CELLS_M.get(lattice), RADII.get(lattice)) else {
        return Beads::default();
    };
    let [cos, sin] = TURNS[lattice];
    let turned = [
        (cos * place_m[0] - sin * place_m[1]) / cell_m,
        (sin * place_m[0] + cos * place_m[1]) / cell_m,
    ];
    if !(turned.iter().all(|x| x.is_finite() && x.abs() < 1e9)) {
        return Beads::default();
    }
    let row = turned[1].floor();
    let shift = f64::from(unit_f32(pcg3d([row as i32 as u32, seed, 0x0072_6F77])[0]));
    let cells = [turned[0] + shift, turned[1]];
    let id = cells.map(f64::floor);
    let hash = pcg3d([id[0] as i32 as u32, id[1] as i32 as u32, seed]);
    let [a, b, c] = hash.map(|h| f64::from(unit_f32(h)));
    // The low bits of the hashes are as good as the high ones.
    let chance = f64::from(unit_f32(hash[0] << 20 | hash[1] & 0xF_FFFF));
    let radius = (least + (most - least) * c * c) * bead_growth(wetness, chance);
    if radius <= 0.0 {
        return Beads::default();
    }
    let middle = [a, b].map(|jitter| radius + (1.0 - 2.0 * radius) * jitter);
    let off = [cells[0] - id[0] - middle[0], cells[1] - id[1] - middle[1]];
    let distance = ops::sqrt(off[0] * off[0] + off[1] * off[1]);
    if distance >= radius {
        return Beads::default();
    }
    let steep = bead_slope(distance / radius) / distance.max(1e-9);
    Beads {
        slope: [
            -(cos * off[0] + sin * off[1]) * steep,
            -(cos * off[1] - sin * off[0]) * steep,
        ],
        cover: 1.0,
    }
}

/// Drops that run down a steep face: `place_m` is (across, down), units: m; `time_s` counts from 0 to 4096 and starts over.
/// Its cover is also 1 − share of other drops that are left, in a trail. Error: 1e-5 against the shader; a look.
#[must_use]
pub fn trickle_at(place_m: [f64; 2], time_s: f64, seed: u32, wetness: f64) -> Beads {
    let column = (place_m[0] / TRICKLE_WIDTH_M).floor();
    if !(column.abs() < 1e9 && place_m[1].abs() < 1e6 && time_s.is_finite()) {
        return Beads::default();
    }
    let own = pcg3d([column as i32 as u32, seed, 0x7472_6963]);
    let phase = f64::from(unit_f32(own[0]));
    let along = (place_m[1] - time_s * TRICKLE_SPEED_M_S) / TRICKLE_LENGTH_M - phase;
    let number = along.floor();
    let hash = pcg3d([
        column as i32 as u32,
        (number as i64).rem_euclid(TRICKLES_PER_PERIOD) as u32,
        seed,
    ]);
    let [a, b, c] = hash.map(|h| f64::from(unit_f32(h)));
    let growth = bead_growth(wetness, a / TRICKLE_SHARE);
    if a >= TRICKLE_SHARE || growth <= 0.0 {
        return Beads::default();
    }
    // From the head upwards, m.
    let behind = (0.9 - (along - number)) * TRICKLE_LENGTH_M;
    let bend = 0.12 * ops::sin(TAU * (place_m[1] / 0.13 + c));
    let aside = place_m[0] - (column + 0.35 + 0.3 * b + bend) * TRICKLE_WIDTH_M;
    let head = HEAD_M * growth;
    let distance = ops::sqrt(aside * aside + behind * behind);
    if distance < head {
        let steep = bead_slope(distance / head) / distance.max(1e-9);
        return Beads {
            // Behind grows upwards, the second direction points down.
            slope: [-aside * steep, behind * steep],
            cover: 1.0,
        };
    }
    let left = clamped(1.0 - behind / (TRAIL_LENGTH_M * growth), 0.0, 1.0);
    let width = TRAIL_M * ops::sqrt(left);
    if behind <= 0.0 || left <= 0.0 {
        return Beads::default();
    }
    let swept = if aside.abs() < HEAD_M { left } else { 0.0 };
    if aside.abs() >= width {
        return Beads {
            slope: [0.0; 2],
            cover: swept,
        };
    }
    let steep = 0.5 * bead_slope(aside.abs() / width) / aside.abs().max(1e-9);
    Beads {
        slope: [-aside * steep, 0.0],
        cover: 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cap_is_flat_in_the_middle_and_rises_towards_its_contact_angle() {
        assert_eq!(bead_slope(0.0), 0.0);
        // tan of the angle whose sine is x sin θ.
        for x in [0.1, 0.4, 0.7] {
            let angle = ops::asin(x * ops::sin(BEAD_CONTACT_RAD));
            assert!((bead_slope(x) - ops::tan(angle)).abs() < 1e-14, "{x}");
        }
        assert_eq!((bead_slope(1.0), bead_slope(f64::NAN)), (STEEPEST, 0.0));
    }

    fn covered(lattice: usize, wetness: f64) -> f64 {
        let mut hits = 0.0;
        let n = 400;
        for i in 0..n * n {
            let place = [i % n, i / n].map(|k| (f64::from(k) + 0.5) * 0.0005 - 0.1);
            hits += bead_at(place, lattice, 9, wetness).cover;
        }
        hits / f64::from(n * n)
    }

    #[test]
    fn drops_cover_more_of_a_wetter_surface_and_all_of_them_go() {
        for lattice in [0, 1] {
            let cover = [0.0, 0.2, 0.4, 0.7, 1.0].map(|wetness| covered(lattice, wetness));
            assert_eq!(cover[0], 0.0);
            assert!(cover.windows(2).all(|w| w[1] > w[0] + 0.001), "{cover:?}");
            // π times the mean square of low + (high − low) c², in cells.
            let [low, high] = RADII[lattice];
            let span = high - low;
            let expected = core::f64::consts::PI * (low * low + 2.0 * low * span / 3.0 + span * span / 5.0);
            assert!((cover[4] / expected - 1.0).abs() < 0.05, "{} of {expected}", cover[4]);
        }
    }

    #[test]
    fn slopes_point_down_from_the_middle_of_drops() {
        // Water's surface is the integral of its slopes: along a line through drops it ends where it began.
        let step = 1e-5;
        let mut height = 0.0;
        let mut highest: f64 = 0.0;
        for i in 0..200_000 {
            let x = f64::from(i) * step;
            height += bead_at([x, 0.0123], 0, 3, 1.0).slope[0] * step;
            highest = highest.max(height);
        }
        assert!(highest > 3e-4 && highest < 3e-3, "drops stand {highest} m high");
        assert!(height.abs() < 0.02 * highest * 400.0, "they end {height} m up");
    }

    #[test]
    fn trickles_run_down_leave_trails_and_start_over_without_a_jump() {
        let found = |time: f64, down: f64| {
            let row = |k: i32| [f64::from(k) * 2e-4, down];
            (0..20_000)
                .filter(|&k| trickle_at(row(k), time, 5, 1.0).cover >= 1.0)
                .count()
        };
        // 200 columns, 0.35 of their places taken, a trail over 3/8 of the way, 1.2 mm wide on average: some 150 points.
        let seen = found(10.0, 0.3);
        assert!((75..300).contains(&seen), "{seen}");
        // What is at a place now is a speed's way further down a second later, but for the column's bends.
        let under_water = |column: i32, down: f64, time: f64| {
            let x = f64::from(column) * TRICKLE_WIDTH_M;
            (0..40).any(|k| trickle_at([x + f64::from(k) * 5e-4, down], time, 5, 1.0).cover >= 1.0)
        };
        let (mut wet, mut missing) = (0, 0);
        for column in 0..100 {
            for down in (0..80).map(|k| f64::from(k) * 0.01) {
                if under_water(column, down, 20.0) {
                    wet += 1;
                    missing += usize::from(!under_water(column, down + TRICKLE_SPEED_M_S, 21.0));
                }
            }
        }
        // Where the trail is thinner than the step of the search it may slip through.
        assert!(wet > 500 && missing * 50 < wet, "{missing} of {wet} did not run down");
        for k in 0..2000 {
            let place = [f64::from(k) * 3.1e-4, 0.2];
            assert_eq!(trickle_at(place, 0.0, 5, 1.0), trickle_at(place, 4096.0, 5, 1.0));
        }
        assert_eq!(trickle_at([0.1, f64::NAN], 0.0, 5, 1.0), Beads::default());
        assert_eq!(bead_at([f64::INFINITY, 0.0], 0, 5, 1.0), Beads::default());
    }
}
