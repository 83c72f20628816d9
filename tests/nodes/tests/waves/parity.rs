//! The GPU's water is the CPU's.

use rain_core::waves::{Push, SweptSource, WaveField};
use rain_render::waves::{Disturbance, WaveTileSettings};

use super::{Puddles, bare, farthest, largest, pond};
use crate::device::{Device, device};

/// Where the pond stands in the world: far from the origin, on whole cells.
const CORNER: [f64; 2] = [100_000.0, -2_000.0];

fn world(x: f64, z: f64) -> f32 {
    pond(x - CORNER[0], z - CORNER[1])
}

/// A tile over the pond.
fn over_pond(gpu: &Device, settings: &WaveTileSettings) -> Puddles {
    let mut puddles = Puddles::new(gpu, settings);
    let half = 0.5 * puddles.tile.side_m();
    assert!(puddles.tile.follow(CORNER.map(|at| at + half), world));
    let corner = puddles.tile.corner_m();
    assert!(corner.iter().zip(CORNER).all(|(found, at)| (found - at).abs() < 1e-9));
    puddles
}

/// The CPU's field over the same pond.
fn field(settings: &WaveTileSettings, depth: impl Fn(f64, f64) -> f32) -> WaveField {
    let mut field = WaveField::new(&settings.twin()).unwrap();
    let n = settings.cells;
    let centre = |k: u32| (f64::from(k) + 0.5) * settings.cell_m;
    let deepest = (settings.deepest_m) as f32;
    let depths: Vec<f32> = (0..n * n)
        .map(|index| depth(centre(index % n), centre(index / n)).min(deepest))
        .collect();
    field.set_depths(&depths).unwrap();
    field
}

/// What disturbs the pond in frame `index`: a wheel on its way through, a foot, a long and fast way over shore and
/// island, drops of stones, one outside.
fn disturbances(index: u32) -> Vec<Disturbance> {
    let at = |x: f64, z: f64| [CORNER[0] + x, CORNER[1] + z];
    let t = f64::from(index);
    let wheel = Disturbance {
        from_m: at(0.2 + 0.01 * t, 0.3 + 0.006 * t),
        to_m: at(0.21 + 0.01 * t, 0.306 + 0.006 * t),
        width_m: 0.06,
        push: Push::Impulse(0.4),
    };
    let mut all = vec![wheel];
    if index % 50 == 7 {
        all.push(Disturbance {
            from_m: at(0.4, 1.3),
            to_m: at(0.4, 1.3),
            width_m: 0.01,
            push: Push::Height(0.004),
        });
        all.push(Disturbance {
            from_m: at(-0.4, 0.2),
            to_m: at(1.5, 1.4),
            width_m: 0.08,
            push: Push::Impulse(-3.0),
        });
        all.push(Disturbance {
            from_m: at(-9.0, 2.0),
            to_m: at(-8.0, 2.0),
            width_m: 0.05,
            push: Push::Height(1.0),
        });
    }
    if index > 150 { all.split_off(1) } else { all }
}

/// The part of a disturbance as the CPU's field wants it.
fn part(disturbance: &Disturbance, index: u32, parts: u32) -> SweptSource {
    let share = 1.0 / f64::from(parts);
    let at = |t: f64| {
        [0, 1].map(|axis| {
            let (from, to) = (disturbance.from_m[axis], disturbance.to_m[axis]);
            (from + t * (to - from) - CORNER[axis]) as f32
        })
    };
    SweptSource {
        from_m: at(f64::from(index) * share),
        to_m: at(f64::from(index + 1) * share),
        width_m: disturbance.width_m as f32,
        push: match disturbance.push {
            Push::Height(height) => Push::Height(height * share as f32),
            Push::Impulse(impulse) => Push::Impulse(impulse * share as f32),
        },
    }
}

/// Worst error over 600 steps, over the largest amplitude; `frames` steps at a time.
fn worst(gpu: &Device, settings: &WaveTileSettings, twin: &mut WaveField, each: u32) -> f64 {
    let mut puddles = over_pond(gpu, settings);
    let step_ns = puddles.tile.step_ns();
    let (mut error, mut amplitude) = (0.0_f64, 0.0_f64);
    for index in 0..600 / each {
        let all = disturbances(index * each);
        puddles.frame(gpu, u64::from(each) * step_ns, &all);
        for step in 0..each {
            for disturbance in &all {
                twin.add_swept(&part(disturbance, step, each)).unwrap();
            }
            twin.step(1);
        }
        amplitude = amplitude.max(largest(twin.heights()));
        if index % (60 / each) == 0 || index == 600 / each - 1 {
            let [now, _] = puddles.heights(gpu);
            error = error.max(farthest(&now, twin.heights()));
        }
    }
    assert!(amplitude > 1e-3, "{amplitude}");
    error / amplitude
}

#[test]
fn water_with_shores_depths_and_sources_equals_the_field_for_600_steps() {
    let Some(gpu) = device() else { return };
    let settings = bare();
    let error = worst(&gpu, &settings, &mut field(&settings, pond), 1);
    eprintln!("step by step: {error:.2e} of the amplitude");
    assert!(error < 1e-5, "{error:.2e}");
    // A per cent of depth is told apart.
    let mut other = field(&settings, |x, z| 0.99 * pond(x, z));
    assert!(worst(&gpu, &settings, &mut other, 1) > 1e-3);
}

#[test]
fn long_frames_split_ways_among_their_steps() {
    let Some(gpu) = device() else { return };
    let settings = bare();
    let error = worst(&gpu, &settings, &mut field(&settings, pond), 4);
    eprintln!("four steps at a time: {error:.2e} of the amplitude");
    assert!(error < 1e-5, "{error:.2e}");
}

#[test]
fn decay_shrinks_the_fields_water_alike() {
    let Some(gpu) = device() else { return };
    let settings = WaveTileSettings {
        decay_per_s: 0.5,
        ..bare()
    };
    let mut puddles = over_pond(&gpu, &settings);
    let mut twin = field(&settings, pond);
    let push = disturbances(7);
    let step_ns = puddles.tile.step_ns();
    puddles.frame(&gpu, step_ns, &push);
    push.iter().for_each(|d| twin.add_swept(&part(d, 0, 1)).unwrap());
    twin.step(1);
    for _ in 0..299 {
        puddles.frame(&gpu, step_ns, &[]);
    }
    twin.step(299);
    let keep = (-0.5 * 300.0 * step_ns as f64 * 1e-9).exp() as f32;
    let expected: Vec<f32> = twin.heights().iter().map(|u| keep * u).collect();
    let [now, _] = puddles.heights(&gpu);
    let error = farthest(&now, &expected) / largest(&expected);
    assert!(error < 3e-5, "{error:.2e}");
    assert!(farthest(&now, twin.heights()) / largest(&expected) > 1.0);
}

#[test]
fn frames_of_any_length_end_in_the_same_water() {
    let Some(gpu) = device() else { return };
    let settings = bare();
    let run = |parts: &[u64]| {
        let mut puddles = over_pond(&gpu, &settings);
        let step_ns = puddles.tile.step_ns();
        puddles.frame(&gpu, step_ns, &disturbances(7));
        for part in parts.iter().cycle().take(40 * parts.len()) {
            puddles.frame(&gpu, step_ns * part / 12, &[]);
        }
        puddles.heights(&gpu)
    };
    // Each of them 24 twelfths of a step 40 times.
    let even = run(&[12, 12]);
    assert!(largest(&even[0]) > 1e-4);
    for parts in [&[24][..], &[5, 5, 5, 5, 4], &[1, 23]] {
        // Rounding of the twelfths may leave the last step undone: its level is then the one before.
        let found = run(parts);
        assert!(found == even || found[0] == even[1], "{parts:?}");
    }
}

/// ½Σ(u−u⁻)² + ½C² Σ over faces, of both levels.
fn energy(
    settings: &WaveTileSettings,
    courant: f64,
    [now, before]: &[Vec<f32>; 2],
    depth: impl Fn(f64, f64) -> f32,
) -> f64 {
    let n = settings.cells as usize;
    let centre = |k: usize| (k as f64 + 0.5) * settings.cell_m;
    let relative = |i: usize, j: usize| (f64::from(depth(centre(i), centre(j))) / settings.deepest_m).min(1.0);
    let u = |level: &[f32], i: usize, j: usize| f64::from(level[j * n + i]);
    let mut sum = 0.0;
    for j in 0..n {
        for i in 0..n {
            let change = u(now, i, j) - u(before, i, j);
            sum += 0.5 * change * change;
            for (k, l) in [(i + 1, j), (i, j + 1)] {
                if k < n && l < n && relative(i, j) > 0.0 && relative(k, l) > 0.0 {
                    let face = 0.5 * (relative(i, j) + relative(k, l));
                    let pair = (u(now, i, j) - u(now, k, l)) * (u(before, i, j) - u(before, k, l));
                    sum += 0.5 * courant * courant * face * pair;
                }
            }
        }
    }
    sum
}

/// The CPU's own test takes a million steps (`nothing_grows_in_a_million_steps_at_the_bound` in the models
/// tests); the argument is the same here: the scheme is that of the field, and C stays at 0.7 or below.
#[test]
fn energy_stays_for_20000_undisturbed_steps_at_the_bound() {
    let Some(gpu) = device() else { return };
    // A tick of the longest step: C = 0.70.
    let mut settings = WaveTileSettings {
        damping_per_s: 0.0,
        ..bare()
    };
    let speed = settings.twin().speed_m_s;
    settings.tick_ns = (0.7 * settings.cell_m / speed * 1e9) as u64;
    let mut puddles = over_pond(&gpu, &settings);
    let step_ns = puddles.tile.step_ns();
    let courant = speed * step_ns as f64 * 1e-9 / settings.cell_m;
    assert!(courant > 0.699 && courant <= 0.7, "{courant}");
    puddles.frame(&gpu, step_ns, &disturbances(7));
    let start = energy(&settings, courant, &puddles.heights(&gpu), pond);
    let highest = largest(&puddles.heights(&gpu)[0]);
    for _ in 0..10 {
        for _ in 0..63 {
            puddles.frame(&gpu, 32 * step_ns, &[]);
        }
        let heights = puddles.heights(&gpu);
        let drift = energy(&settings, courant, &heights, pond) / start - 1.0;
        assert!(drift.abs() < 2e-5, "{drift:.1e}");
        assert!(largest(&heights[0]) < 2.0 * highest);
    }
    // A lost step would show: the levels of different times are no state of this energy.
    let [now, before] = puddles.heights(&gpu);
    let wrong = energy(
        &settings,
        courant,
        &[before, now.iter().map(|u| 1.01 * u).collect()],
        pond,
    );
    assert!((wrong / start - 1.0).abs() > 1e-3);
}

#[test]
fn shores_send_waves_back_and_keep_the_water() {
    let Some(gpu) = device() else { return };
    let settings = WaveTileSettings {
        damping_per_s: 0.0,
        ..bare()
    };
    let mut puddles = over_pond(&gpu, &settings);
    let hump = Disturbance {
        from_m: [CORNER[0] + 0.8, CORNER[1] + 1.3],
        to_m: [CORNER[0] + 0.8, CORNER[1] + 1.3],
        width_m: 0.06,
        push: Push::Height(0.003),
    };
    let step_ns = puddles.tile.step_ns();
    puddles.frame(&gpu, 0, &[hump]);
    let [start, _] = puddles.heights(&gpu);
    let volume = |level: &[f32]| level.iter().map(|u| f64::from(*u)).sum::<f64>();
    for _ in 0..500 {
        puddles.frame(&gpu, step_ns, &[]);
    }
    let [now, _] = puddles.heights(&gpu);
    let change = volume(&now) / volume(&start) - 1.0;
    assert!(change.abs() < 1e-4, "{change:.1e}");
    // Nothing stands on dry cells, everything else has been reached.
    let n = settings.cells as usize;
    for (index, u) in now.iter().enumerate() {
        let at = |k: usize| (k as f64 + 0.5) * settings.cell_m;
        let wet = pond(at(index % n), at(index / n)) > 0.0;
        assert_eq!(*u != 0.0, wet, "cell {index}");
    }
}
