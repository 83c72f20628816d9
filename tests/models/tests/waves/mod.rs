//! Water waves: dispersion, discrete modes, open-water integrals, borders, sources, rings.

mod borders;
mod dispersion;
mod field;
mod impact;
mod modes;
mod open_water;
mod ring_layers;
mod rings;
mod sources;

use proptest::test_runner::{Config, RngSeed};
use rain_core::waves::{WaveField, WaveSettings};

/// The same cases every time.
fn cases(count: u32) -> Config {
    Config {
        cases: count,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(15),
        ..Config::default()
    }
}

/// An undamped field of `nx` by `nz` cells of 1 m with a speed of 1 m/s and the Courant number `courant`.
fn settings(nx: u32, nz: u32, courant: f64) -> WaveSettings {
    WaveSettings {
        cells_x: nx,
        cells_z: nz,
        cell_m: 1.0,
        speed_m_s: 1.0,
        damping_per_s: 0.0,
        step_ns: Some((courant * 1e9).round() as u64),
        ..WaveSettings::default()
    }
}

/// A field with those settings and heights, at rest.
fn started(settings: &WaveSettings, height: impl Fn(usize, usize) -> f64) -> WaveField {
    let mut field = WaveField::new(settings).expect("settings within their domains");
    let nx = settings.cells_x as usize;
    let heights: Vec<f32> = (0..nx * settings.cells_z as usize)
        .map(|index| height(index % nx, index / nx) as f32)
        .collect();
    field.set_state(&heights, &[]).expect("finite heights");
    field
}

/// cos(mπ(i+½)/N).
fn standing(cells: usize, mode: usize, i: usize) -> f64 {
    (std::f64::consts::PI * mode as f64 * (i as f64 + 0.5) / cells as f64).cos()
}

/// Largest |height|.
fn peak(field: &WaveField) -> f64 {
    field.heights().iter().fold(0.0, |max, u| max.max(f64::from(u.abs())))
}

/// Σ of the heights.
fn total(field: &WaveField) -> f64 {
    field.heights().iter().map(|u| f64::from(*u)).sum()
}
