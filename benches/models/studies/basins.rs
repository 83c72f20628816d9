//! Work against precision: puddles baked and run.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::hint::black_box;
use std::sync::Arc;

use ndarray::Array2;
use rain_bench::study::{Study, Variant};
use rain_core::surface::basins::{BakeOptions, BasinForcing, BasinRun, Basins, Grid};
use rain_reference::basins::{Field, Tank, cascade, lossy_volume};

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![bake(), sizes(), cascades(), seepage()]
}

/// A number in [0, 1) from integers.
fn unit(x: usize, z: usize, seed: u64) -> f64 {
    let mut h = (x as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ (z as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F) ^ seed;
    for _ in 0..2 {
        h = (h ^ (h >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        h ^= h >> 32;
    }
    (h >> 11) as f64 / (1_u64 << 53) as f64
}

/// Fractal-like ground: octaves of value noise, each half as high as the one before.
fn ground(n: usize, seed: u64) -> Vec<f64> {
    let octave = |x: usize, z: usize, step: usize| {
        let (cx, cz) = (x / step, z / step);
        let smooth = |t: f64| t * t * (3.0 - 2.0 * t);
        let (u, v) = (
            smooth((x % step) as f64 / step as f64),
            smooth((z % step) as f64 / step as f64),
        );
        let at = |dx: usize, dz: usize| unit(cx + dx, cz + dz, seed + step as u64);
        (at(0, 0) * (1.0 - u) + at(1, 0) * u) * (1.0 - v) + (at(0, 1) * (1.0 - u) + at(1, 1) * u) * v
    };
    let cells = (0..n * n).map(|cell| {
        let (x, z) = (cell % n, cell / n);
        let mut height = 0.0;
        let mut step = 128;
        while step >= 2 {
            height += step as f64 * octave(x, z, step) / 64.0;
            step /= 2;
        }
        height
    });
    cells.collect()
}

/// Priority flood with a binary heap over all cells: only the filled surface.
fn heap_flood(n: usize, z: &[f64]) -> Vec<f64> {
    let mut filled = vec![f64::INFINITY; n * n];
    let mut heap = BinaryHeap::new();
    let key = |height: f64| (height + 0.0).to_bits();
    let border = (0..n).flat_map(|i| [i, (n - 1) * n + i, i * n, i * n + n - 1]);
    for cell in border {
        if filled[cell] == f64::INFINITY {
            filled[cell] = z[cell];
            heap.push(Reverse((key(z[cell]), cell)));
        }
    }
    while let Some(Reverse((_, cell))) = heap.pop() {
        let (x, row) = (cell % n, cell / n);
        for r in row.saturating_sub(1)..=(row + 1).min(n - 1) {
            for c in x.saturating_sub(1)..=(x + 1).min(n - 1) {
                let other = r * n + c;
                if filled[other] == f64::INFINITY {
                    filled[other] = z[other].max(filled[cell]);
                    heap.push(Reverse((key(filled[other]), other)));
                }
            }
        }
    }
    filled
}

fn crate_fill(n: usize, z: &[f64]) -> Vec<f64> {
    let mut dem = Array2::from_shape_vec((n, n), z.to_vec()).expect("n rows of n");
    hydro_analysis::fill_depressions(&mut dem, -1e30, 1.0, 1.0, false);
    dem.into_raw_vec_and_offset().0
}

fn baked(n: usize, z: &[f64], threshold_m: f64) -> Basins {
    let options = BakeOptions {
        threshold_m,
        ..BakeOptions::default()
    };
    Basins::bake(&Grid::new(n, n, 1.0, z), &options).expect("a valid grid")
}

fn own_fill(n: usize, z: &[f64]) -> Vec<f64> {
    baked(n, z, 0.0).filled(z).expect("the baked grid")
}

fn bake() -> Study {
    let small = ground(64, 7);
    let field = Field {
        nx: 64,
        nz: 64,
        cell: 1.0,
        z: small.clone(),
        closed: false,
    };
    let truth = field.filled();
    let error = |filled: Vec<f64>| {
        filled
            .iter()
            .zip(&truth)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max)
    };
    let errors = [
        error(own_fill(64, &small)),
        error(heap_flood(64, &small)),
        error(crate_fill(64, &small)),
    ];
    let mut variants = Vec::new();
    for n in [128, 256, 512, 1024] {
        let z = ground(n, 7);
        let cells = (n * n) as u64;
        let (a, b, c) = (z.clone(), z.clone(), z);
        let own = Variant::new(
            format!("hierarchy, curves, catchments, {n}²"),
            errors[0],
            cells,
            move || {
                let baked = baked(n, black_box(&a), 1e-4);
                baked.basins().iter().filter_map(|basin| basin.volume_m3).sum()
            },
        );
        variants.push(if n == 1024 { own.default() } else { own });
        variants.push(Variant::new(
            format!("binary heap, filled only, {n}²"),
            errors[1],
            cells,
            move || heap_flood(n, black_box(&b)).iter().sum(),
        ));
        variants.push(Variant::new(
            format!("hydro-analysis, filled only, {n}²"),
            errors[2],
            cells,
            move || crate_fill(n, black_box(&c)).iter().sum(),
        ));
    }
    Study {
        name: "puddle-bake",
        title: "Basins of fractal ground",
        norm: "max |filled − reference| at 64², m",
        unit: "cell",
        variants,
    }
}

/// |Σ volumes − Σ (filled − ground)| over the latter.
fn volume_error(n: usize, z: &[f64]) -> f64 {
    let baked = baked(n, z, 0.0);
    let filled = baked.filled(z).expect("the baked grid");
    let stood: f64 = filled.iter().zip(z).map(|(level, ground)| level - ground).sum();
    let tops = baked.basins().iter().filter(|basin| basin.parent.is_none());
    let volume: f64 = tops.filter_map(|basin| basin.volume_m3).sum();
    (volume / stood - 1.0).abs()
}

fn sizes() -> Study {
    let error = volume_error(256, &ground(256, 7));
    let variant = |n: usize| {
        // Made when it is run: the larger ones take seconds.
        let mut z = Vec::new();
        Variant::new(format!("{n}²"), error, (n * n) as u64, move || {
            if z.is_empty() {
                z = ground(n, 7);
            }
            baked(n, black_box(&z), 1e-4).off_map_m2()
        })
    };
    let sizes = [256, 512, 1024, 2048, 4096];
    let variants = sizes.map(|n| if n == 1024 { variant(n).default() } else { variant(n) });
    Study {
        name: "puddle-bake-size",
        title: "Basins of fractal ground, from 256² to 4096² cells",
        norm: "|ΣV / Σ(filled − ground) − 1| at 256²",
        unit: "cell",
        variants: variants.into(),
    }
}

/// A chain of one-cell basins down a slope, cell 1 m, and its tanks in the order of the slope.
fn chain(count: usize) -> (Arc<Basins>, Vec<Tank>, Vec<u32>) {
    let nx = 2 * count + 2;
    let mut z = vec![1e3; 3 * nx];
    let depth = |tank: usize| 0.01 + 0.03 * unit(tank, 1, 3);
    for tank in 0..count {
        let rim = 2.0 - 0.1 * tank as f64;
        z[nx + 1 + 2 * tank] = rim - depth(tank);
        z[nx + 2 + 2 * tank] = rim;
    }
    z[2 * nx - 1] = 0.0;
    let baked = Arc::new(baked_chain(nx, &z));
    let mut order = Vec::new();
    let mut tanks = Vec::new();
    for tank in 0..count {
        let leaf = baked.leaf_at(nx + 1 + 2 * tank).expect("a pit");
        let basin = &baked.basins()[leaf as usize];
        order.push(leaf);
        tanks.push(Tank {
            capacity: basin.volume_m3.expect("open"),
            catchment: basin.catchment_m2,
            next: (tank + 1 < count).then_some(tank + 1),
        });
    }
    (baked, tanks, order)
}

fn baked_chain(nx: usize, z: &[f64]) -> Basins {
    Basins::bake(&Grid::new(nx, 3, 1.0, z), &BakeOptions::default()).expect("a valid grid")
}

const RAIN: f64 = 2.0 / 3.6e6;
const HOUR: f64 = 3600.0;

fn run_for(mut run: BasinRun, forcing: &BasinForcing, steps: u32) -> BasinRun {
    for _ in 0..steps {
        run.advance(forcing, HOUR / f64::from(steps)).expect("a valid step");
    }
    run
}

/// All tanks at once, what is too much goes on in the next step.
fn tanks_by_steps(tanks: &[Tank], steps: u32) -> Vec<f64> {
    let dt = HOUR / f64::from(steps);
    let mut volumes = vec![0.0; tanks.len()];
    let mut spill = vec![0.0; tanks.len() + 1];
    for _ in 0..steps {
        let arriving = core::mem::replace(&mut spill, vec![0.0; tanks.len() + 1]);
        for (index, tank) in tanks.iter().enumerate() {
            volumes[index] += RAIN * tank.catchment * dt + arriving[index];
            let excess = f64::max(volumes[index] - tank.capacity, 0.0);
            volumes[index] -= excess;
            spill[tank.next.unwrap_or(tanks.len())] += excess;
        }
    }
    volumes
}

fn cascades() -> Study {
    let (baked, tanks, order) = chain(24);
    let (truth, _) = cascade(&tanks, RAIN, HOUR);
    let error = {
        let (truth, tanks) = (truth, tanks.clone());
        move |volumes: &[f64]| {
            let each = volumes.iter().zip(&truth).zip(&tanks);
            each.map(|((a, b), tank)| (a - b).abs() / tank.capacity)
                .fold(0.0, f64::max)
        }
    };
    let forcing = BasinForcing::rain(RAIN);
    let mut variants = Vec::new();
    for (name, steps) in [("1 h", 1), ("1 min", 60), ("1 s", 3600)] {
        let start = BasinRun::new(Arc::clone(&baked));
        let end = run_for(start.clone(), &forcing, steps);
        let volumes: Vec<f64> = order.iter().map(|&leaf| end.volume_m3(leaf)).collect();
        let variant = Variant::new(format!("events, step {name}"), error(&volumes), 1, move || {
            run_for(start.clone(), black_box(&forcing), steps).ledger().stored_m3
        });
        variants.push(if steps == 60 { variant.default() } else { variant });
    }
    for (name, steps) in [("1 min", 60), ("10 s", 360), ("1 s", 3600)] {
        let tanks = tanks.clone();
        variants.push(Variant::new(
            format!("all at once, step {name}"),
            error(&tanks_by_steps(&tanks, steps)),
            1,
            move || tanks_by_steps(black_box(&tanks), steps).iter().sum(),
        ));
    }
    Study {
        name: "puddle-cascade",
        title: "An hour of rain on 24 basins in a row",
        norm: "max |V − event list| / capacity",
        unit: "simulated hour",
        variants,
    }
}

/// One bowl with a rough bottom: 100 cells of 0.5 m.
fn bowl() -> (Arc<Basins>, Vec<f64>) {
    let n = 12;
    let inside = |cell: usize| (1..n - 1).contains(&(cell % n)) && (1..n - 1).contains(&(cell / n));
    let height = |cell: usize| {
        let (x, z) = ((cell % n) as f64 - 5.5, (cell / n) as f64 - 5.5);
        if inside(cell) {
            2e-4 * (x * x + z * z) + 1e-5 * unit(cell, 0, 5)
        } else {
            0.1
        }
    };
    let z: Vec<f64> = (0..n * n).map(height).collect();
    let baked = Basins::bake(&Grid::new(n, n, 0.5, &z), &BakeOptions::default()).expect("a valid grid");
    (
        Arc::new(baked),
        (0..n * n).filter(|&cell| inside(cell)).map(height).collect(),
    )
}

/// The wet area held over each step.
fn bowl_by_steps(baked: &Basins, inflow: f64, loss: f64, steps: u32) -> f64 {
    let curve = baked.curve(baked.basins().len() as u32 - 1);
    let dt = HOUR / f64::from(steps);
    let mut volume = 0.0;
    for _ in 0..steps {
        volume = f64::max(volume + dt * (inflow - loss * curve.area_m2(volume)), 0.0);
    }
    volume
}

fn seepage() -> Study {
    let (baked, cells) = bowl();
    let (inflow, loss) = (2e-5, 2e-6);
    let truth = lossy_volume(&cells, 0.5, inflow, loss, HOUR);
    let top = baked.basins().len() as u32 - 1;
    let forcing = BasinForcing {
        seepage_m_s: loss,
        ..BasinForcing::rain(inflow / baked.basins()[top as usize].catchment_m2)
    };
    let error = move |volume: f64| (volume / truth - 1.0).abs();
    let mut variants = Vec::new();
    for (name, steps) in [("1 h", 1), ("1 min", 60), ("1 s", 3600)] {
        let start = BasinRun::new(Arc::clone(&baked));
        let end = run_for(start.clone(), &forcing, steps).ledger().stored_m3;
        let variant = Variant::new(format!("closed form, step {name}"), error(end), 1, move || {
            run_for(start.clone(), black_box(&forcing), steps).ledger().stored_m3
        });
        variants.push(if steps == 60 { variant.default() } else { variant });
    }
    for (name, steps) in [("10 min", 6), ("1 min", 60), ("10 s", 360), ("1 s", 3600)] {
        let basins = Arc::clone(&baked);
        let end = bowl_by_steps(&basins, inflow, loss, steps);
        variants.push(Variant::new(
            format!("area held, step {name}"),
            error(end),
            1,
            move || bowl_by_steps(&basins, black_box(inflow), loss, steps),
        ));
    }
    Study {
        name: "puddle-seepage",
        title: "An hour of inflow and seepage in one bowl",
        norm: "|V / reference − 1|",
        unit: "simulated hour",
        variants,
    }
}
