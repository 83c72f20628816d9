//! Hashes in place of random sequences.

use std::hint::black_box;

use rain_bench::study::{Study, Variant};
use rain_core::hash::{pcg, pcg3d, unit_f32};
use rain_reference::hash::{chi_squared_of_pairs, chi_squared_per_degree};

const KEYS: u32 = 1 << 20;
const CALLS: u32 = 1 << 14;

/// |χ²/dof − 1|, the larger of single values and of pairs of neighbours.
fn roughness(value: impl Fn(u32) -> f64) -> f64 {
    let singles = chi_squared_per_degree((0..KEYS).map(&value), 1024);
    let pairs = chi_squared_of_pairs((0..KEYS).map(|n| (value(n), value(n + 1))), 32);
    (singles - 1.0).abs().max((pairs - 1.0).abs())
}

fn variant(name: &str, value: impl Fn(u32) -> f32 + Copy + 'static) -> Variant {
    Variant::new(name, roughness(|n| f64::from(value(n))), CALLS.into(), move || {
        (0..black_box(CALLS)).map(value).sum::<f32>().into()
    })
}

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![Study {
        name: "hash",
        title: "Random value of an integer",
        norm: "|χ²/dof − 1| of values and pairs",
        unit: "value",
        variants: vec![
            variant("pcg3d of a cell, one word", |n| {
                unit_f32(pcg3d([n & 127, (n >> 7) & 127, n >> 14])[0])
            })
            .default(),
            variant("pcg", |n| unit_f32(pcg(n))),
            variant("fract(sin), f32", |n| {
                ((n as f32 * 12.9898).sin() * 43_758.547)
                    .rem_euclid(1.0)
                    .min(0.999_999_94)
            }),
        ],
    }]
}
