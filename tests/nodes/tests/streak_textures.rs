//! Streak textures of the GPU are those of the CPU.

use rain_core::rainfall::{
    Distribution, PackedStreaks, StreakLayer, StreakTexture, StreakTextureSettings, StreakTextures,
};
use rain_render::streak_textures::{StreakArray, StreakTextureGpu, encode_streak_textures};

use crate::device::{Device, device};

/// What a device's textures hold, after drawing them where that is still to be done.
pub fn read_back(gpu: &Device, pipelines: &StreakTextureGpu, array: &mut StreakArray) -> PackedStreaks {
    let bytes = array.copy_bytes();
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: bytes,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encode_streak_textures(&mut encoder, pipelines, array);
    array.encode_copy(&mut encoder, &buffer);
    gpu.queue.submit([encoder.finish()]);
    array.unpack(&gpu.read(&buffer, bytes)).expect("textures")
}

fn sets() -> [StreakTextureSettings; 4] {
    let base = StreakTextureSettings::default();
    [
        StreakTextureSettings {
            texels: 256,
            ..base.clone()
        },
        StreakTextureSettings {
            texels: 512,
            intensities_mm_h: vec![20.0],
            ..StreakTextureSettings::yoshida()
        },
        // Streaks longer than the cube, thick ones, and nearly empty layers.
        StreakTextureSettings {
            distribution: Distribution::Drizzle,
            intensities_mm_h: vec![0.1, 300.0],
            texels: 64,
            tile_m: 0.25,
            exposure_s: 0.1,
            ..base.clone()
        },
        // Drops wider than their way.
        StreakTextureSettings {
            distribution: Distribution::Thunderstorm,
            intensities_mm_h: vec![100.0],
            diameter_edges_mm: vec![0.3, 6.0],
            texels: 512,
            tile_m: 0.25,
            exposure_s: 1e-4,
            seed: 5,
        },
    ]
}

/// Σ |a − b| over Σ b.
fn difference(a: impl Iterator<Item = f32>, b: &[f32]) -> f64 {
    let (mut off, mut sum) = (0.0, 0.0);
    let mut count = 0;
    for (a, &b) in a.zip(b) {
        off += f64::from((a - b).abs());
        sum += f64::from(b);
        count += 1;
    }
    assert_eq!(count, b.len());
    assert!(sum > 0.0);
    off / sum
}

#[test]
fn textures_of_the_gpu_are_those_of_the_cpu() {
    let Some(gpu) = device() else { return };
    let pipelines = StreakTextureGpu::new(&gpu.device);
    for settings in sets() {
        let truth = StreakTextures::bake(&settings).expect("a set");
        let mut array = StreakArray::new(&gpu.device, &gpu.queue, &pipelines, &settings).expect("a set");
        let found = read_back(&gpu, &pipelines, &mut array);
        for (index, texture) in truth.textures.iter().enumerate() {
            for (level, texels) in texture.levels.iter().enumerate() {
                let place = format!("layer {index}, level {level} of {}", settings.key_text());
                // Half floats have 2⁻¹¹.
                let error = difference(found.texels(index, level), texels);
                assert!(error < 1e-3, "{place}: {error}");
                let (mean, expected) = (
                    found.texels(index, level).map(f64::from).sum::<f64>() / texels.len() as f64,
                    texture.mean_opacity(level) / texture.layer.unit,
                );
                assert!((mean / expected - 1.0).abs() < 1e-3, "{place}: {mean}, {expected}");
            }
        }
        // A layer whose streaks are a twentieth longer is told apart.
        let longer = StreakTextureSettings {
            exposure_s: settings.exposure_s * 1.05,
            ..settings.clone()
        };
        if let Ok(layers) = longer.layers() {
            let other = StreakTexture::draw(&layers[0], settings.texels);
            assert!(difference(found.texels(0, 0), &other.levels[0]) > 0.01);
        }
    }
}

#[test]
fn every_level_of_the_gpus_textures_has_the_mean_opacity_of_its_class() {
    let Some(gpu) = device() else { return };
    let pipelines = StreakTextureGpu::new(&gpu.device);
    let settings = StreakTextureSettings::default();
    let mut array = StreakArray::new(&gpu.device, &gpu.queue, &pipelines, &settings).expect("a set");
    let found = read_back(&gpu, &pipelines, &mut array);
    let layers: Vec<StreakLayer> = array.layers().to_vec();
    for (index, layer) in layers.iter().enumerate() {
        for level in 0..settings.level_count() as usize {
            let count = f64::from((settings.texels >> level).pow(2));
            let mean = found.texels(index, level).map(f64::from).sum::<f64>() / count * layer.unit;
            let expected = layer.mean_opacity();
            assert!(
                (mean / expected - 1.0).abs() < 2e-3,
                "{index} {level}: {mean} {expected}"
            );
        }
    }
    assert_eq!(array.memory_bytes(), settings.bytes());
}

#[test]
fn textures_are_drawn_once_and_anew_when_a_setting_changes() {
    let Some(gpu) = device() else { return };
    let pipelines = StreakTextureGpu::new(&gpu.device);
    let settings = StreakTextureSettings {
        texels: 64,
        ..StreakTextureSettings::default()
    };
    let mut array = StreakArray::new(&gpu.device, &gpu.queue, &pipelines, &settings).expect("a set");
    let encode = |array: &mut StreakArray| {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let recorded = encode_streak_textures(&mut encoder, &pipelines, array);
        gpu.queue.submit([encoder.finish()]);
        recorded
    };
    assert!(array.wants_pass() && encode(&mut array));
    assert!(!array.wants_pass() && !encode(&mut array));
    let key = array.key();
    array
        .prepare(&gpu.device, &gpu.queue, &pipelines, &settings)
        .expect("the same");
    assert!(!array.wants_pass() && !encode(&mut array));
    let other = StreakTextureSettings {
        seed: 2,
        ..settings.clone()
    };
    array
        .prepare(&gpu.device, &gpu.queue, &pipelines, &other)
        .expect("another seed");
    assert!(array.key() != key && array.wants_pass() && encode(&mut array));
    // Settings that nothing can be made from leave what is there.
    let bad = StreakTextureSettings {
        texels: 65,
        ..settings.clone()
    };
    assert!(array.prepare(&gpu.device, &gpu.queue, &pipelines, &bad).is_err());
    assert_eq!(array.settings(), &other);
    assert!(!array.wants_pass());
}

#[test]
fn textures_from_a_file_are_uploaded_without_a_pass() {
    let Some(gpu) = device() else { return };
    let pipelines = StreakTextureGpu::new(&gpu.device);
    let settings = StreakTextureSettings {
        texels: 64,
        ..StreakTextureSettings::default()
    };
    let made = PackedStreaks::bake(&settings).expect("a set");
    let stored = PackedStreaks::from_ktx2(&made.to_ktx2(), &settings).expect("a file");
    let mut array = StreakArray::upload(&gpu.device, &gpu.queue, &stored).expect("a set");
    assert!(!array.wants_pass());
    assert_eq!(array.key(), settings.key());
    assert_eq!(read_back(&gpu, &pipelines, &mut array), made);
}
