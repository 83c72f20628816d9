//! Random numbers of a flash: the n-th is a hash of the flash's key and n.

use core::f64::consts::TAU;

use crate::hash::pcg3d;
use crate::ops;

/// Keeps lightning apart from the drops of the same seed.
const SALT: u32 = 0x4C49_4748;

/// A row of random numbers.
pub(super) struct Draws {
    key: [u32; 3],
    next: u32,
}

impl Draws {
    /// Of a whole number, such as a second or a flash, under a seed.
    pub(super) fn new(seed: u64, number: u64, part: u32) -> Self {
        let a = pcg3d([seed as u32 ^ SALT, (seed >> 32) as u32, part]);
        let key = pcg3d([a[0] ^ number as u32, a[1] ^ (number >> 32) as u32, a[2]]);
        Self { key, next: 0 }
    }

    /// Uniform in (0, 1).
    pub(super) fn unit(&mut self) -> f64 {
        let [a, b, c] = self.key;
        let hash = pcg3d([a ^ self.next.wrapping_mul(0x9E37_79B9), b.wrapping_add(self.next), c]);
        self.next += 1;
        (f64::from(hash[0]) + 0.5) / 4_294_967_296.0
    }

    /// Uniform in (from, to).
    pub(super) fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.unit()
    }

    /// Two independent numbers of mean 0 and deviation 1 (Box & Muller 1958).
    pub(super) fn normals(&mut self) -> [f64; 2] {
        let radius = ops::sqrt(-2.0 * ops::ln(self.unit()));
        let angle = TAU * self.unit();
        [radius * ops::cos(angle), radius * ops::sin(angle)]
    }

    /// Lognormal, by its median and its deviation in decades.
    pub(super) fn lognormal(&mut self, median: f64, decades: f64) -> f64 {
        median * ops::pow(10.0, decades * self.normals()[0])
    }

    /// Exponential with mean 1.
    pub(super) fn exponential(&mut self) -> f64 {
        -ops::ln(self.unit())
    }
}
