//! Streak textures: what they show, and the files they are kept in.

mod file;
mod picture;

use rain_core::rainfall::{Distribution, StreakTextureSettings};

/// A small set: quick to make, with every kind of layer.
fn small() -> StreakTextureSettings {
    StreakTextureSettings {
        intensities_mm_h: vec![2.0, 20.0],
        diameter_edges_mm: vec![0.5, 1.0, 2.0, 4.0],
        texels: 64,
        seed: 7,
        ..StreakTextureSettings::default()
    }
}

/// Sets that differ in everything: families, rates, classes, resolutions, cubes, shutters.
fn varied() -> Vec<StreakTextureSettings> {
    let base = StreakTextureSettings::default();
    vec![
        base.clone(),
        StreakTextureSettings::yoshida(),
        StreakTextureSettings {
            texels: 64,
            ..base.clone()
        },
        StreakTextureSettings {
            texels: 1024,
            intensities_mm_h: vec![10.0],
            seed: 99,
            ..base.clone()
        },
        StreakTextureSettings {
            distribution: Distribution::Thunderstorm,
            exposure_s: 1.0 / 500.0,
            tile_m: 2.0,
            texels: 256,
            ..base.clone()
        },
        StreakTextureSettings {
            distribution: Distribution::Drizzle,
            exposure_s: 0.1,
            tile_m: 0.5,
            texels: 128,
            intensities_mm_h: vec![0.1, 500.0],
            ..base
        },
    ]
}
