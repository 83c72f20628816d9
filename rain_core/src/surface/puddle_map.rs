//! The map that places puddles at random (Nguyenova 2021): noise over the ground. It repeats after 4096 sizes.
//!
//! # Accuracy
//! A look: the source gives no formula for its Perlin noise. Value noise of three octaves is taken, spread so that all of
//! 0 to 1 is used.

use crate::hash::{pcg3d, unit_f32};

/// Ratios and offsets of the octaves' lattices.
const OCTAVES: [(f64, f64, f64); 3] = [(1.0, 0.0, 1.0), (2.0, 7.31, 0.5), (4.0, -3.77, 0.25)];
/// The sum is spread from here to here.
const SPREAD: [f64; 2] = [0.25, 0.75];
/// Farther from the origin lattice cells have no number of their own.
const FARTHEST: f64 = 1e9;

/// The lattice repeats after so many points: a power of two, so that places far from the origin have exact ones.
const PERIOD: i64 = 4096;

/// Value noise over the lattice of whole numbers, smooth to the second derivative.
fn value_noise(x: f64, z: f64, seed: u32) -> f64 {
    let corner = |x: f64, z: f64| {
        let cell = [x, z].map(|at| (at as i64).rem_euclid(PERIOD) as u32);
        f64::from(unit_f32(pcg3d([cell[0], cell[1], seed])[0]))
    };
    let (x0, z0) = (x.floor(), z.floor());
    let fade = |f: f64| f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let (tx, tz) = (fade(x - x0), fade(z - z0));
    let mix = |a: f64, b: f64, t: f64| a + t * (b - a);
    let near = mix(corner(x0, z0), corner(x0 + 1.0, z0), tx);
    let far = mix(corner(x0, z0 + 1.0), corner(x0 + 1.0, z0 + 1.0), tx);
    mix(near, far, tz)
}

/// The puddle map at a place given in sizes of the largest puddles: 0 floods first, 1 never. Of the seed the lower 24 bits
/// count. Places beyond ±1e9 sizes, and what is not a number, are 1: no puddle.
/// Error: 1e-12; a look.
#[must_use]
pub fn puddle_map(x: f64, z: f64, seed: u32) -> f64 {
    // NaN fails both.
    if !(x.abs() <= FARTHEST / 8.0 && z.abs() <= FARTHEST / 8.0) {
        return 1.0;
    }
    let (mut sum, mut weights, mut octave) = (0.0, 0.0, seed & 0xff_ffff);
    for (ratio, offset, weight) in OCTAVES {
        sum += weight * value_noise(ratio * x + offset, ratio * z + offset, octave);
        weights += weight;
        octave = octave.wrapping_add(1);
    }
    let [low, high] = SPREAD;
    let t = ((sum / weights - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
