//! Work against precision: the wave step by grid, stencil and precision, its share of the memory's bandwidth, moving
//! sources, rings.

use std::hint::black_box;
use std::time::Instant;

use rain_bench::study::{Study, Variant};
use rain_core::waves::{
    DoubleField, DropImpact, Ring, RingTable, Stencil, WaveField, WaveSettings, swept_weight, swept_weight_f32,
};
use rain_reference::waves as truth;

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![accuracy(), bandwidth(), sweep(), ring()]
}

/// Wave speed of 5 mm of water, m/s.
const SPEED: f64 = 0.221_431_3;
/// Width of the test's Gaussian, m, and the time at which it is looked at, s.
const WIDTH: f64 = 0.01;
const TIME_NS: u64 = 500_000_000;

/// An undamped square of `cells`² cells of `cell_m`, stepped so that `TIME_NS` is a whole number of steps.
fn square(cells: usize, cell_m: f64, courant: f64, stencil: Stencil) -> (WaveSettings, u32) {
    let steps = (SPEED * 0.5 / (courant * cell_m)).ceil() as u32;
    let settings = WaveSettings {
        cells_x: cells as u32,
        cells_z: cells as u32,
        cell_m,
        speed_m_s: SPEED,
        damping_per_s: 0.0,
        stencil,
        step_ns: Some(TIME_NS / u64::from(steps)),
        ..WaveSettings::default()
    };
    (settings, steps)
}

/// Relative L2 error on the axis and the diagonal, up to 0.16 m, against the Hankel integral on a finer set of radii.
fn gaussian_error(cells: usize, cell_m: f64, height: impl Fn(usize, usize) -> f64, exact: &dyn Fn(f64) -> f64) -> f64 {
    let middle = cells / 2;
    let (mut error, mut norm) = (0.0, 0.0);
    for (dx, dz) in [(1, 0), (1, 1)] {
        let step = cell_m * f64::from(dx * dx + dz * dz).sqrt();
        for k in 0..=(0.16 / step) as usize {
            let value = exact(k as f64 * step);
            error += (height(middle + k * dx as usize, middle + k * dz as usize) - value).powi(2) * step;
            norm += value * value * step;
        }
    }
    (error / norm).sqrt()
}

/// The exact answer at `TIME_NS`, tabulated every half millimetre.
fn exact() -> impl Fn(f64) -> f64 {
    let step = 5e-4;
    let table: Vec<f64> = (0..330)
        .map(|i| truth::hankel(f64::from(i) * step, WIDTH, 300, |k| (SPEED * k * 0.5).cos()))
        .collect();
    move |r| {
        let place = r / step;
        let i = (place as usize).clamp(1, table.len() - 3);
        let t = place - i as f64;
        // Cubic through four points.
        let [a, b, c, d] = [table[i - 1], table[i], table[i + 1], table[i + 2]];
        b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)))
    }
}

fn accuracy() -> Study {
    let exact = exact();
    let gauss = |cells: usize, cell_m: f64, i: usize, j: usize| {
        let [x, z] = [i, j].map(|k| (k as f64 - (cells / 2) as f64) * cell_m);
        (-0.5 * (x * x + z * z) / (WIDTH * WIDTH)).exp()
    };
    let mut variants = Vec::new();
    for (cell_mm, courant, stencil, points) in [
        (8.0, 0.7, Stencil::FivePoint, 5),
        (4.0, 0.7, Stencil::FivePoint, 5),
        (2.0, 0.7, Stencil::FivePoint, 5),
        (1.0, 0.7, Stencil::FivePoint, 5),
        (2.0, 0.5, Stencil::FivePoint, 5),
        (4.0, 0.86, Stencil::NinePoint, 9),
        (2.0, 0.86, Stencil::NinePoint, 9),
        (1.0, 0.86, Stencil::NinePoint, 9),
    ] {
        let cell_m = cell_mm * 1e-3;
        let cells = (0.4 / cell_m) as usize | 1;
        let (settings, steps) = square(cells, cell_m, courant, stencil);
        let start: Vec<f32> = (0..cells * cells)
            .map(|index| gauss(cells, cell_m, index % cells, index / cells) as f32)
            .collect();
        let mut field = WaveField::new(&settings).expect("within the bound");
        let mut run = move || {
            field.set_state(black_box(&start), &[]).expect("finite");
            field.step(steps);
            field.clone()
        };
        let end = run();
        let error = gaussian_error(cells, cell_m, |i, j| f64::from(end.heights()[j * cells + i]), &exact);
        let variant = Variant::new(
            format!("f32, {points}-point, {cell_mm} mm, C {courant}"),
            error,
            1,
            move || f64::from(run().heights()[cells]),
        );
        let default = cell_mm == 2.0 && points == 5 && courant == 0.7;
        variants.push(if default { variant.default() } else { variant });
    }
    for cell_mm in [4.0, 2.0] {
        let cell_m = cell_mm * 1e-3;
        let cells = (0.4 / cell_m) as usize | 1;
        let steps = (SPEED * 0.5 / (0.7 * cell_m)).ceil();
        let courant = SPEED * 0.5 / (steps * cell_m);
        let run = move || {
            let start = |i: usize, j: usize| gauss(cells, cell_m, i, j);
            let mut field = DoubleField::new(cells, Stencil::FivePoint, black_box(courant), 0.0, start).expect("bound");
            field.step(steps as u64);
            field
        };
        let end = run();
        let error = gaussian_error(cells, cell_m, |i, j| end.heights()[j * cells + i], &exact);
        variants.push(Variant::new(
            format!("f64, 5-point, {cell_mm} mm, C 0.7"),
            error,
            1,
            move || run().heights()[cells],
        ));
    }
    Study {
        name: "wave-accuracy",
        title: "Waves of a Gaussian after half a second",
        norm: "relative L2 error on r < 0.16 m",
        unit: "0.5 s of a 0.4 m square",
        variants,
    }
}

/// Bytes that a step must move for each cell: two levels read, one written.
const BYTES: f64 = 12.0;

/// Bandwidth of a[i] = b[i] + q·c[i] over arrays far larger than the caches, by all threads or one. Units: B/ns.
fn triad(all: bool) -> f64 {
    let n = 12 << 20;
    let (b, c) = (vec![1.0_f32; n], vec![2.0_f32; n]);
    let mut a = vec![0.0_f32; n];
    let threads = if all { threads() } else { 1 };
    let chunk = n.div_ceil(threads);
    let mut best = f64::INFINITY;
    for _ in 0..20 {
        let start = Instant::now();
        std::thread::scope(|scope| {
            for ((a, b), c) in a.chunks_mut(chunk).zip(b.chunks(chunk)).zip(c.chunks(chunk)) {
                scope.spawn(move || {
                    for ((a, b), c) in a.iter_mut().zip(b).zip(c) {
                        *a = b + 0.5 * c;
                    }
                });
            }
        });
        best = best.min(start.elapsed().as_nanos() as f64);
        black_box(&a);
    }
    BYTES * n as f64 / best
}

fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}

/// A pool in which a field uses one core only.
fn one_thread() -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .expect("one thread")
}

/// The plain loop over the textbook form, one step at a time, with three buffers.
fn plain_step(n: usize, c2: f32, g: f32, before: &[f32], now: &[f32], next: &mut [f32]) {
    for j in 0..n {
        for i in 0..n {
            let at = |i: usize, j: usize| now[j * n + i];
            let u = at(i, j);
            let sum = (at(i.saturating_sub(1), j) + at((i + 1).min(n - 1), j))
                + (at(i, j.saturating_sub(1)) + at(i, (j + 1).min(n - 1)))
                - 4.0 * u;
            next[j * n + i] = u + (g * (u - before[j * n + i]) + (0.5 + 0.5 * g) * c2 * sum);
        }
    }
}

fn bandwidth() -> Study {
    let (one, all) = (triad(false), triad(true));
    let mut variants = Vec::new();
    for n in [128_usize, 512, 1024, 2048, 4096] {
        let settings = WaveSettings {
            cells_x: n as u32,
            cells_z: n as u32,
            ..WaveSettings::default()
        };
        let mut field = WaveField::new(&settings).expect("within the bound");
        let start: Vec<f32> = (0..n * n)
            .map(|index| ((index % n) as f32 * 0.37).sin() * ((index / n) as f32 * 0.21).cos())
            .collect();
        field.set_state(&start, &[]).expect("finite");
        // Deviation from the plain loop after some steps.
        let mut other = field.clone();
        let steps = 8;
        let (c, a) = (field.courant(), 0.5 * settings.damping_per_s * field.step_s());
        let (c2, g) = ((c * c) as f32, ((1.0 - a) / (1.0 + a)) as f32);
        let (mut now, mut next) = (start.clone(), vec![0.0; n * n]);
        // u⁻ = u + ½C²Lu is half a step over a copy.
        let mut before = start;
        plain_step(n, c2, 0.0, &now, &now, &mut before);
        for _ in 0..steps {
            plain_step(n, c2, g, &before, &now, &mut next);
            std::mem::swap(&mut before, &mut now);
            std::mem::swap(&mut now, &mut next);
        }
        other.step(steps);
        let error = other
            .heights()
            .iter()
            .zip(&now)
            .fold(0.0_f64, |max, (a, b)| max.max(f64::from((a - b).abs())));
        if n == 1024 {
            variants.push(Variant::new("plain loop, one thread, 1024²", 0.0, (n * n) as u64, {
                let (mut before, mut now, mut next) = (before, now, next);
                move || {
                    plain_step(n, c2, g, &before, &now, &mut next);
                    std::mem::swap(&mut before, &mut now);
                    std::mem::swap(&mut now, &mut next);
                    f64::from(now[n])
                }
            }));
        }
        let parallel = n >= 512;
        let mut best = f64::INFINITY;
        // Many short runs: the fastest is one that nothing else on the machine cut into.
        for _ in 0..(32_usize << 20).div_ceil(n * n).clamp(10, 200) {
            let clock = Instant::now();
            other.step(8);
            best = best.min(clock.elapsed().as_nanos() as f64 / 8.0);
        }
        let share = BYTES * (n * n) as f64 / best / if parallel { all } else { one };
        let threads = if parallel { threads() } else { 1 };
        let name = format!(
            "{n}², threads {threads}: {:.0} % of the triad's bandwidth",
            100.0 * share
        );
        let variant = Variant::new(name, error, 8 * (n * n) as u64, move || {
            field.step(8);
            f64::from(field.heights()[n])
        });
        variants.push(if n == 512 { variant.default() } else { variant });
        if n == 1024 {
            let pool = one_thread();
            let mut alone = other;
            let mut best = f64::INFINITY;
            for _ in 0..40 {
                let clock = Instant::now();
                pool.install(|| alone.step(8));
                best = best.min(clock.elapsed().as_nanos() as f64 / 8.0);
            }
            let share = 100.0 * BYTES * (n * n) as f64 / best / one;
            let name = format!("{n}², threads 1: {share:.0} % of the triad's bandwidth");
            variants.push(Variant::new(name, error, 8 * (n * n) as u64, move || {
                pool.install(|| alone.step(8));
                f64::from(alone.heights()[n])
            }));
        }
    }
    Study {
        name: "wave-bandwidth",
        title: "A wave step by size of the field",
        norm: "largest deviation from the plain loop, of heights of 1",
        unit: "cell step",
        variants,
    }
}

fn sweep() -> Study {
    let width = 0.06;
    let cell = 0.02;
    let points: Vec<[f64; 2]> = (0..40 * 30)
        .map(|index| [f64::from(index % 40 - 12) * cell, f64::from(index / 40 - 15) * cell])
        .collect();
    // One frame of a car at 50 km/h.
    let (from, to) = ([0.0, 0.0], [0.22, 0.06]);
    let exact: Vec<f64> = points
        .iter()
        .map(|p| truth::swept_weight(*p, from, to, width))
        .collect();
    let worst = |weight: &dyn Fn([f64; 2]) -> f64| {
        points
            .iter()
            .zip(&exact)
            .fold(0.0_f64, |max, (point, exact)| max.max((weight(*point) - exact).abs()))
    };
    let beads = move |count: u32| {
        move |p: [f64; 2]| {
            let sum: f64 = (0..count)
                .map(|k| {
                    let t = (f64::from(k) + 0.5) / f64::from(count);
                    let r2: f64 = (0..2).map(|a| (p[a] - from[a] - t * (to[a] - from[a])).powi(2)).sum();
                    (-0.5 * r2 / (width * width)).exp()
                })
                .sum();
            sum / f64::from(count)
        }
    };
    let single = move |p: [f64; 2]| {
        let [p, from, to] = [p, from, to].map(|point| point.map(|x| x as f32));
        f64::from(swept_weight_f32(p, from, to, width as f32))
    };
    let double = move |p: [f64; 2]| swept_weight(p, from, to, width);
    let mut variants = Vec::new();
    let mut add = |name: String, weight: Box<dyn Fn([f64; 2]) -> f64>, default: bool| {
        let (error, count, points) = (worst(&weight), points.len() as u64, points.clone());
        let run = move || points.iter().map(|point| weight(black_box(*point))).sum();
        let variant = Variant::new(name, error, count, run);
        variants.push(if default { variant.default() } else { variant });
    };
    add("swept Gaussian, f32".into(), Box::new(single), true);
    add("swept Gaussian, f64".into(), Box::new(double), false);
    for count in [1, 2, 4, 8, 16] {
        let plural = if count == 1 { "" } else { "s" };
        add(
            format!("{count} point{plural} a frame, f64"),
            Box::new(beads(count)),
            false,
        );
    }
    Study {
        name: "wave-sweep",
        title: "A wheel at 50 km/h, one frame",
        norm: "largest error of the weight",
        unit: "cell",
        variants,
    }
}

fn ring() -> Study {
    let ring = Ring::new(
        &DropImpact {
            x_m: 0.0,
            z_m: 0.0,
            diameter_mm: 2.0,
            speed_m_s: 6.5,
        },
        0.005,
        0.0,
    )
    .expect("in its domain");
    let (s, c) = (f64::from(ring.width_m), f64::from(ring.speed_m_s));
    let age = 10.0 * s / c;
    let radii: Vec<f64> = (0..64).map(|i| s * (5.0 + 0.15 * f64::from(i))).collect();
    let (bump, push) = (f64::from(ring.bump_m), f64::from(ring.push_m));
    let integral = move |r: f64, panels: usize| {
        truth::hankel(r, s, panels, |k| {
            bump * (c * k * age).cos() - push * s * k * (c * k * age).sin()
        })
    };
    let exact: Vec<f64> = radii.iter().map(|r| integral(*r, 800)).collect();
    let crest = exact.iter().fold(0.0_f64, |max, u| max.max(u.abs()));
    let worst = |height: &dyn Fn(f64) -> f64| {
        radii
            .iter()
            .zip(&exact)
            .fold(0.0_f64, |max, (r, exact)| max.max((height(*r) - exact).abs()))
            / crest
    };
    let table = RingTable::new();
    let leading = table.clone();
    let two_terms = move |r: f64| f64::from(table.height_and_slope(&ring, r as f32, age as f32).0);
    let one_term = move |r: f64| {
        let [_, f, f1, _] = leading.packet(((r - c * age) / s) as f32);
        (s / r).sqrt() * (bump * f64::from(f) - push * f64::from(f1))
    };
    let mut variants = Vec::new();
    let mut add = |name: &str, height: Box<dyn Fn(f64) -> f64>, default: bool| {
        let (error, count, radii) = (worst(&height), radii.len() as u64, radii.clone());
        let run = move || radii.iter().map(|r| height(black_box(*r))).sum();
        let variant = Variant::new(name, error, count, run);
        variants.push(if default { variant.default() } else { variant });
    };
    add("packet table, two terms, f32", Box::new(two_terms), true);
    add("packet table, leading term, f32", Box::new(one_term), false);
    for (panels, name) in [
        (20, "Hankel integral, 41 nodes, f64"),
        (60, "Hankel integral, 121 nodes, f64"),
    ] {
        add(name, Box::new(move |r| integral(r, panels)), false);
    }
    Study {
        name: "wave-ring",
        title: "Ring of a 2 mm drop",
        norm: "largest error over the crest",
        unit: "height",
        variants,
    }
}
