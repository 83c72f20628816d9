//! Height fields for the tests.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rain_core::surface::basins::{BakeOptions, Basins, Grid};
use rain_reference::basins::Field;

/// Cases that are the same in every run.
pub fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(20_260_801),
        ..ProptestConfig::default()
    }
}

/// A number in [0, 1) from integers.
pub fn unit(x: u64, y: u64, seed: u64) -> f64 {
    let mut h = x.wrapping_mul(0x9E37_79B9_7F4A_7C15)
        ^ y.wrapping_mul(0xC2B2_AE3D_27D4_EB4F)
        ^ seed.wrapping_mul(0x1656_67B1_9E37_79F9);
    for _ in 0..2 {
        h = (h ^ (h >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        h ^= h >> 32;
    }
    (h >> 11) as f64 / (1_u64 << 53) as f64
}

/// Sizes, kinds and seeds of small fields.
pub fn small_fields() -> impl Strategy<Value = Field> {
    (1_usize..13, 1_usize..13, 0_u8..5, any::<u32>(), any::<bool>()).prop_map(|(nx, nz, kind, seed, closed)| Field {
        nx,
        nz,
        cell: 0.5,
        z: heights(nx, nz, kind, u64::from(seed)),
        closed,
    })
}

/// 0: few integers, 1: random, 2: random with holes, 3: flat with steps, 4: smooth.
pub fn heights(nx: usize, nz: usize, kind: u8, seed: u64) -> Vec<f64> {
    let at = |x: usize, z: usize, salt: u64| unit(x as u64, z as u64, seed.wrapping_add(salt << 40));
    let cells = (0..nz).flat_map(|z| (0..nx).map(move |x| (x, z)));
    cells
        .map(|(x, z)| match kind {
            0 => (at(x, z, 0) * 5.0).floor(),
            1 => 100.0 + at(x, z, 0),
            2 => {
                if at(x, z, 1) < 0.06 {
                    f64::NAN
                } else {
                    (at(x, z, 0) * 7.0).floor() * 0.125
                }
            }
            3 => (at(x / 4, z / 3, 0) * 3.0).floor() + if at(x, z, 1) < 0.1 { -1.0 } else { 0.0 },
            _ => {
                let (a, b) = (x as f64 * 0.9, z as f64 * 0.8);
                a.sin() + b.cos() + (0.7 * (a + b) + seed as f64).sin() + 0.2 * at(x, z, 0)
            }
        })
        .collect()
}

/// Everything that is a basin, however shallow.
pub fn bake(field: &Field) -> Basins {
    let grid = Grid::new(field.nx, field.nz, field.cell, &field.z);
    let options = BakeOptions {
        closed: field.closed,
        threshold_m: 0.0,
        ..BakeOptions::default()
    };
    Basins::bake(&grid, &options).expect("a valid field")
}

/// A field from a drawing: a digit is a height, a blank a hole.
pub fn drawn(rows: &[&str]) -> Field {
    let z = rows.iter().flat_map(|row| {
        row.chars()
            .map(|letter| letter.to_digit(36).map_or(f64::NAN, f64::from))
    });
    Field {
        nx: rows[0].len(),
        nz: rows.len(),
        cell: 1.0,
        z: z.collect(),
        closed: false,
    }
}

/// Fractal ground of n × n cells of 1 m: octaves of value noise, each half as high as the one before, quick to make.
pub fn fractal(n: usize, seed: u64) -> Vec<f64> {
    let mut heights = vec![0.0; n * n];
    let mut step = 256;
    while step >= 2 {
        let corner = |x: usize, z: usize| step as f64 / 64.0 * unit(x as u64, z as u64, seed + step as u64);
        let smooth: Vec<f64> = (0..step)
            .map(|i| i as f64 / step as f64)
            .map(|t| t * t * (3.0 - 2.0 * t))
            .collect();
        for (z, row) in heights.chunks_exact_mut(n).enumerate() {
            let v = smooth[z % step];
            let side = |x: usize| {
                let (near, far) = (corner(x, z / step), corner(x, z / step + 1));
                near + v * (far - near)
            };
            let mut left = side(0);
            for (x, cells) in row.chunks_mut(step).enumerate() {
                let right = side(x + 1);
                for (height, u) in cells.iter_mut().zip(&smooth) {
                    *height += left + u * (right - left);
                }
                left = right;
            }
        }
        step /= 2;
    }
    heights
}
