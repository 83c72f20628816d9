//! Mips of slope maps average slopes and keep their second moment.

use rain_core::hash::{pcg3d, unit_f32};
use rain_render::slope_mips::{SlopeMipsGpu, encode_slope_mips, slope_levels, slope_texture};

use crate::device::{Device, device};
use crate::maps::{from_half, read_map, to_half, write_map};

/// Slopes of waves and noise, a variance of its own and heights; as half floats hold them.
fn finest(width: u32, height: u32) -> Vec<[f32; 4]> {
    (0..width * height)
        .map(|i| {
            let [a, b, c] = pcg3d([i, 5, 9]).map(unit_f32);
            let wave = 0.3 * ((i % width) as f32 * 0.37).sin();
            [wave + 0.2 * (a - 0.5), 0.4 * (b - 0.5), 0.01 * c, wave * 3.0].map(|x| from_half(to_half(x)))
        })
        .collect()
}

fn run(gpu: &Device, width: u32, height: u32) -> Vec<Vec<[f32; 4]>> {
    let shape = slope_texture("map", width, height);
    let map = gpu.device.create_texture(&wgpu::TextureDescriptor {
        usage: shape.usage | wgpu::TextureUsages::COPY_DST,
        ..shape
    });
    write_map(gpu, &map, &finest(width, height));
    let mips = SlopeMipsGpu::new(&gpu.device);
    let target = mips.bind(&gpu.device, &map);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encode_slope_mips(&mut encoder.begin_compute_pass(&Default::default()), &mips, &target);
    gpu.queue.submit([encoder.finish()]);
    (0..shape.mip_level_count)
        .map(|level| read_map(gpu, &map, level))
        .collect()
}

/// Level `level` of the finest texels in double precision: means, and b plus the variance of the slopes in the block.
fn truth(finest: &[[f32; 4]], width: u32, height: u32, level: u32) -> Vec<[f64; 4]> {
    let side = 1 << level;
    let blocks = (0..height >> level).flat_map(|j| (0..width >> level).map(move |i| (i, j)));
    blocks
        .map(|(i, j)| {
            let texels = (0..side * side).map(|k| {
                let (x, z) = (i * side + k % side, j * side + k / side);
                finest[(z * width + x) as usize].map(f64::from)
            });
            let count = f64::from(side * side);
            let mut mean = [0.0; 4];
            let mut square = 0.0;
            for texel in texels {
                for (mean, value) in mean.iter_mut().zip(texel) {
                    *mean += value / count;
                }
                square += (texel[0] * texel[0] + texel[1] * texel[1]) / count;
            }
            mean[2] += square - mean[0] * mean[0] - mean[1] * mean[1];
            mean
        })
        .collect()
}

/// Largest error over a level, in thousandths of each channel's scale.
fn worst(found: &[[f32; 4]], expected: &[[f64; 4]]) -> f64 {
    let scale = [0.3, 0.2, 0.04, 0.9];
    let errors = found.iter().zip(expected).flat_map(|(found, expected)| {
        (0..4).map(move |c| ((f64::from(found[c]) - expected[c]) / scale[c]).abs() * 1e3)
    });
    errors.fold(0.0, f64::max)
}

#[test]
fn mips_are_means_and_keep_the_second_moment_of_slopes() {
    let Some(gpu) = device() else { return };
    for (width, height) in [(256, 256), (512, 64), (96, 160), (8, 8), (2, 2)] {
        let levels = run(&gpu, width, height);
        assert_eq!(levels[0], finest(width, height));
        for (level, found) in levels.iter().enumerate().skip(1) {
            let expected = truth(&levels[0], width, height, level as u32);
            assert_eq!(found.len(), expected.len());
            // One place of a half float is up to 1e-3, and a device may cut off; levels beyond the fourth go on from a
            // stored one.
            let error = worst(found, &expected);
            assert!(error < 3.0, "{width}×{height} level {level}: {error:.2} thousandths");
        }
    }
    // A map without the variance is told apart.
    let levels = run(&gpu, 64, 64);
    let without: Vec<[f32; 4]> = levels[2].iter().map(|t| [t[0], t[1], 0.0, t[3]]).collect();
    assert!(worst(&without, &truth(&levels[0], 64, 64, 2)) > 100.0);
}

#[test]
fn sides_are_halved_as_long_as_both_are_even() {
    for (width, height, levels) in [
        (256, 256, 9),
        (512, 256, 9),
        (96, 160, 6),
        (1, 1, 1),
        (7, 8, 1),
        (0, 4, 1),
        (0, 0, 1),
    ] {
        assert_eq!(slope_levels(width, height), levels, "{width}×{height}");
    }
}
