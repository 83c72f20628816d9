//! The drop field by its definition: a Poisson process marked and thinned, in double precision.

use crate::fall_speed::fit;
use crate::hash::pcg3d;
use crate::numerics::simpson;
use crate::spectrum::sum;

/// Modulo 2³².
fn word(value: i128) -> u32 {
    value.rem_euclid(1 << 32) as u32
}

/// Key of a cell.
pub fn cell_key(seed: u64, class: u32, cell: [i64; 3]) -> [u32; 3] {
    let stream = pcg3d([word(i128::from(seed)), word(i128::from(seed) / (1 << 32)), class]);
    pcg3d([0, 1, 2].map(|i| stream[i] ^ word(i128::from(cell[i]))))
}

/// Words of a drop: rank and diameter, then x, y, z.
pub fn words(key: [u32; 3], index: u32) -> ([u32; 3], [u32; 3]) {
    let spread = |factor: i128| word(i128::from(index) * factor);
    let shifted = |k: u32| word(i128::from(k) + i128::from(index));
    (
        pcg3d([key[0] ^ spread(2_654_435_769), shifted(key[1]), key[2]]),
        pcg3d([key[1] ^ spread(2_246_822_507), shifted(key[2]), key[0]]),
    )
}

/// Uniform in [0, 1) from 24 bits.
fn unit(bits: u32) -> f64 {
    f64::from(bits / 256) / 16_777_216.0
}

/// A drop of a cell.
#[derive(Debug, Clone, Copy)]
pub struct FieldDrop {
    /// In cells.
    pub place: [f64; 3],
    /// mm.
    pub diameter: f64,
    /// Sum of exponential steps.
    pub rank: f64,
}

/// Share of the drops of n_ref ∝ e^(−2D) between `a` and `d` of those between `a` and `b`.
pub fn share_below(a: f64, b: f64, d: f64) -> f64 {
    (-2.0 * (d - a)).exp_m1() / (-2.0 * (b - a)).exp_m1()
}

/// The drops of a cell of the class between `a` and `b` mm with ranks below `max_rank`.
pub fn drops(key: [u32; 3], a: f64, b: f64, max_rank: f64) -> Vec<FieldDrop> {
    let mut drops = Vec::new();
    let mut rank = 0.0;
    loop {
        let index = drops.len() as u32;
        let (marks, place) = words(key, index);
        // Odd halves of 2⁻²⁴.
        rank += -(f64::from(2 * (marks[0] / 512) + 1) / 16_777_216.0).ln();
        if rank >= max_rank {
            return drops;
        }
        drops.push(FieldDrop {
            place: place.map(unit),
            diameter: a - 0.5 * (unit(marks[1]) * (-2.0 * (b - a)).exp_m1()).ln_1p(),
            rank,
        });
    }
}

/// Drops of n_ref = 8000 e^(−2D) in a cell of edge `cell` m between `a` and `b` mm.
pub fn reference_count(cell: f64, a: f64, b: f64) -> f64 {
    cell.powi(3) * simpson(a, b, 400, |d| 8000.0 * (-2.0 * d).exp())
}

/// Rank below which a drop of diameter `d` exists: the cell's drops at the density `n`, had all of them this size.
pub fn threshold(cell: f64, a: f64, b: f64, d: f64, n: f64) -> f64 {
    reference_count(cell, a, b) * n / (8000.0 * (-2.0 * d).exp())
}

/// 1 inside, 0 outside, linear within a twentieth of the threshold on either side.
pub fn presence(rank: f64, threshold: f64) -> f64 {
    let (full, none) = (0.95 * threshold, 1.05 * threshold);
    ((none - rank) / (none - full)).clamp(0.0, 1.0)
}

/// Range at which a streak's contrast is one step of 255, m; `d` in mm.
pub fn contrast_range(d: f64, focal: f64, exposure: f64) -> f64 {
    let disc = core::f64::consts::PI * (d / 2000.0).powi(2);
    disc * focal * 255.0 / (fit(d) * exposure)
}

/// Drops in a view: ∫ N Ω r³/3 dD from 0.5 to 6 mm, drawn up to r = 1.2 min(κ z₁, 15 m).
pub fn drawn(n: impl Fn(f64) -> f64, solid_angle: f64, focal: f64, exposure: f64, kappa: f64) -> f64 {
    sum(0.5, 6.0, |d| {
        let reach = 1.2 * (kappa * contrast_range(d, focal, exposure)).min(15.0);
        n(d) * solid_angle * reach.powi(3) / 3.0
    })
}
