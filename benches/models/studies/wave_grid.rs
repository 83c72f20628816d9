//! Work against precision: the puddles' wave tile by cells in a wavelength, and at a shore.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::hint::black_box;

use rain_bench::study::{Study, Variant};
use rain_core::waves::{Border, Stencil, WaveField, WaveSettings};
use rain_reference::numerics::{bisect, simpson};
use rain_reference::waves::bessel_j0;
use rain_render::waves::WaveTileSettings;

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![dispersion(), shore()]
}

/// Steps of a field with `cell_m` cells, `courant` at most, so that `time_s` is a whole number of them.
fn settings(cells: u32, cell_m: f64, courant: f64, time_s: f64, stencil: Stencil) -> (WaveSettings, u32) {
    let tile = WaveTileSettings::default().twin();
    let steps = (tile.speed_m_s * time_s / (courant * cell_m)).ceil();
    let settings = WaveSettings {
        cells_x: cells,
        cells_z: cells,
        cell_m,
        damping_per_s: 0.0,
        stencil,
        step_ns: Some((time_s * 1e9 / steps) as u64),
        ..tile
    };
    (settings, steps as u32)
}

/// The Courant number of the tile as it comes.
fn tile_courant() -> f64 {
    let tile = WaveTileSettings::default().twin();
    tile.checked_step_ns().expect("valid") as f64 * 1e-9 * tile.speed_m_s / tile.cell_m
}

/// Length of the waves, and the side of a square that repeats. Units: m.
const WAVE_M: f64 = 0.3;
const SIDE_M: f64 = 2.4;
/// Periods after which a standing wave is looked at: it passes through 0, and its height is what it is early or late.
const PERIODS: f64 = 1.25;

/// Share by which a standing wave of `mode` waves along x and z swings too slowly.
fn slowness(field: &mut WaveField, steps: u32, mode: [u32; 2], time_s: f64) -> f64 {
    let n = field.settings().cells_x;
    let speed = field.settings().speed_m_s;
    let [a, b] = mode.map(|m| TAU * f64::from(m) / f64::from(n));
    let shape = |index: u32| (a * f64::from(index % n)).cos() * (b * f64::from(index / n)).cos();
    let start: Vec<f32> = (0..n * n).map(|index| shape(index) as f32).collect();
    field.set_state(&start, &[]).expect("finite");
    field.step(steps);
    let product = |index: u32| f64::from(field.heights()[index as usize]) * shape(index);
    let (found, norm): (f64, f64) = (0..n * n).fold((0.0, 0.0), |(found, norm), index| {
        (found + product(index), norm + shape(index) * shape(index))
    });
    // cos(φ + δ) at φ = 5π/2 up to the mode's own length.
    let [kx, kz] = mode.map(|m| TAU * f64::from(m) / SIDE_M);
    let phase = speed * kx.hypot(kz) * time_s;
    let turns = (phase / TAU).floor();
    let within = (found / norm).clamp(-1.0, 1.0).acos();
    (turns * TAU + within) / phase - 1.0
}

fn dispersion() -> Study {
    let tile = WaveTileSettings::default();
    let time_s = PERIODS * WAVE_M / tile.twin().speed_m_s;
    let mut variants = Vec::new();
    let own = tile_courant();
    for (cells_in_wave, courant, stencil) in [
        (4, 0.7, Stencil::FivePoint),
        (6, 0.7, Stencil::FivePoint),
        (8, 0.7, Stencil::FivePoint),
        (12, own, Stencil::FivePoint),
        (16, 0.7, Stencil::FivePoint),
        (24, 0.7, Stencil::FivePoint),
        (32, 0.7, Stencil::FivePoint),
        (12, 0.35, Stencil::FivePoint),
        (6, 0.86, Stencil::NinePoint),
        (8, 0.86, Stencil::NinePoint),
        (12, 0.86, Stencil::NinePoint),
        (24, 0.86, Stencil::NinePoint),
    ] {
        let cells = cells_in_wave * (SIDE_M / WAVE_M).round() as u32;
        let cell_m = SIDE_M / f64::from(cells);
        let (settings, steps) = settings(cells, cell_m, courant, time_s, stencil);
        let settings = WaveSettings {
            border: Border::Periodic,
            ..settings
        };
        let mut field = WaveField::new(&settings).expect("within the bound");
        // Along an axis, between, along the diagonal; all of about one length.
        let error = [[8, 0], [7, 4], [6, 6]]
            .map(|mode| slowness(&mut field, steps, mode, time_s).abs())
            .into_iter()
            .fold(0.0, f64::max);
        let points = if stencil == Stencil::FivePoint { 5 } else { 9 };
        let name = format!("{cells_in_wave} cells, {points}-point, C {:.2}", field.courant());
        let start = field.heights().to_vec();
        let variant = Variant::new(name, error, 1, move || {
            field.set_state(black_box(&start), &[]).expect("finite");
            field.step(steps);
            f64::from(field.heights()[0])
        });
        let default = (cell_m - tile.cell_m).abs() < 1e-12 && courant == own && points == 5;
        variants.push(if default { variant.default() } else { variant });
    }
    Study {
        name: "wave-dispersion",
        title: "Speed of waves of 0.3 m, by cells in a wavelength",
        norm: "largest |c/c_exact - 1| of three directions",
        unit: "0.38 s of a 2.4 m square",
        variants,
    }
}

/// A round pond with an upright shore: radius, width of the hump in its middle, side of the square around it. Units: m.
const POND_M: f64 = 1.0;
const HUMP_M: f64 = 0.1;
const SQUARE_M: f64 = 2.4;
/// When it is looked at: the ring has come back half of the way from the shore.
const POND_S: f64 = 1.5;

/// J₁ as the mean of sin t sin(x sin t) over a quarter turn.
fn bessel_j1(x: f64) -> f64 {
    let points = (0.5 * x.abs()) as usize + 24;
    let step = FRAC_PI_2 / points as f64;
    let sum: f64 = (0..points)
        .map(|i| {
            let sine = ((i as f64 + 0.5) * step).sin();
            sine * (x * sine).sin()
        })
        .sum();
    sum / points as f64
}

/// The hump after a time: modes J₀(k r) without slope at the shore, each swinging with its own frequency. A table by
/// 1 mm.
fn pond(speed_m_s: f64, time_s: f64) -> Vec<f64> {
    let hump = |r: f64| (-0.5 * (r / HUMP_M).powi(2)).exp();
    let mean = 2.0 / (POND_M * POND_M) * simpson(0.0, POND_M, 400, |r| hump(r) * r);
    let modes: Vec<(f64, f64)> = (1..=30)
        .map(|mode| {
            // Zero number n of J₁ lies near (n + ¼)π.
            let near = (f64::from(mode) + 0.25) * PI;
            let k = bisect(near - 0.5, near + 0.5, bessel_j1) / POND_M;
            let over = simpson(0.0, POND_M, 400, |r| hump(r) * bessel_j0(k * r) * r);
            (k, over / (0.5 * POND_M * POND_M * bessel_j0(k * POND_M).powi(2)))
        })
        .collect();
    let height = |r: f64| {
        let sum: f64 = modes
            .iter()
            .map(|(k, share)| share * bessel_j0(k * r) * (k * speed_m_s * time_s).cos())
            .sum();
        mean + sum
    };
    (0..=1000).map(|i| height(f64::from(i) * 1e-3)).collect()
}

fn shore() -> Study {
    let tile = WaveTileSettings::default();
    let exact = pond(tile.twin().speed_m_s, POND_S);
    let mut variants = Vec::new();
    for (cell_m, mean_depth) in [
        (0.1, false),
        (0.05, false),
        (0.025, false),
        (0.0125, false),
        (0.00625, false),
        (0.05, true),
        (0.025, true),
        (0.0125, true),
    ] {
        let cells = (SQUARE_M / cell_m).round() as u32;
        let courant = if cell_m == tile.cell_m { tile_courant() } else { 0.7 };
        let (settings, steps) = settings(cells, cell_m, courant, POND_S, Stencil::FivePoint);
        let mut field = WaveField::new(&settings).expect("within the bound");
        // From the pond's middle, which lies anywhere in its cell.
        let middle = 0.5 * SQUARE_M + 0.003;
        let place = |index: u32, part: f64| (f64::from(index) + part) * cell_m - middle;
        let is_pond = |x: f64, z: f64| x.hypot(z) < POND_M;
        let wet_share = |i: u32, j: u32| {
            if !mean_depth {
                return f64::from(u8::from(is_pond(place(i, 0.5), place(j, 0.5))));
            }
            let parts = (0..64).map(|part: u32| [part % 8, part / 8].map(|p| (f64::from(p) + 0.5) / 8.0));
            parts.filter(|[a, b]| is_pond(place(i, *a), place(j, *b))).count() as f64 / 64.0
        };
        let index = || (0..cells).flat_map(|j| (0..cells).map(move |i| (i, j)));
        let depths: Vec<f32> = index()
            .map(|(i, j)| (tile.deepest_m * wet_share(i, j)) as f32)
            .collect();
        field.set_depths(&depths).expect("up to the deepest");
        let radius = |i: u32, j: u32| place(i, 0.5).hypot(place(j, 0.5));
        let start: Vec<f32> = index()
            .map(|(i, j)| (-0.5 * (radius(i, j) / HUMP_M).powi(2)).exp() as f32)
            .collect();
        let mut run = move || {
            field.set_state(black_box(&start), &[]).expect("finite");
            field.step(steps);
            field.clone()
        };
        let end = run();
        let (mut error, mut norm) = (0.0, 0.0);
        for (cell, (i, j)) in index().enumerate() {
            let at = radius(i, j) * 1e3;
            if at < 950.0 {
                let low = at as usize;
                let truth = exact[low] + (at - low as f64) * (exact[low + 1] - exact[low]);
                error += (f64::from(end.heights()[cell]) - truth).powi(2);
                norm += truth * truth;
            }
        }
        let how = if mean_depth {
            "cells as deep as they are wet"
        } else {
            "cells wet or dry"
        };
        let variant = Variant::new(
            format!("{} mm, {how}", 1e3 * cell_m),
            (error / norm).sqrt(),
            1,
            move || f64::from(run().heights()[(cells * cells / 2) as usize]),
        );
        let default = cell_m == tile.cell_m && !mean_depth;
        variants.push(if default { variant.default() } else { variant });
    }
    Study {
        name: "wave-shore",
        title: "A ring come back from the shore of a round pond",
        norm: "relative L2 error of the heights within 0.95 m",
        unit: "1.5 s of a 2.4 m square",
        variants,
    }
}
