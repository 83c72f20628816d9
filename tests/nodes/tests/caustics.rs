//! Light that ruffled water throws, on the GPU against its twin.

use std::f64::consts::TAU;

use glam::Vec3;
use rain_core::waves::{CAUSTIC_TEXELS, CAUSTIC_WAYS_M, caustic_at, caustic_map, caustic_shift};
use rain_render::caustics::{CausticFrame, CausticsGpu, caustic_texture};
use rain_render::slope_mips::slope_texture;

use crate::device::{Device, device, kernel, library};
use crate::maps::{from_half, read_map, to_half, write_map};

/// Cells of the slope map: fewer than there are rays.
const CELLS: u32 = 128;

/// Slopes of two crossing waves that tile a square, as half floats hold them.
fn slopes() -> Vec<[f32; 4]> {
    (0..CELLS * CELLS)
        .map(|i| {
            let at = [i % CELLS, i / CELLS].map(|i| (f64::from(i) + 0.5) / f64::from(CELLS));
            let x = 0.05 * (TAU * (2.0 * at[0] + at[1])).cos();
            let z = 0.04 * (TAU * 3.0 * at[1]).sin();
            [x, z].map(|s| from_half(to_half(s as f32)))
        })
        .map(|[x, z]| [x, z, 0.0, 0.0])
        .collect()
}

/// The slopes between the cells' middles.
fn between(map: &[[f32; 4]], at: [f64; 2]) -> [f64; 2] {
    let place = at.map(|a| a * f64::from(CELLS) - 0.5);
    let (corner, part) = (place.map(f64::floor), place.map(|p| p - p.floor()));
    let cell = |dx: i64, dz: i64| {
        let wrap = |c: f64, d: i64| (c as i64 + d).rem_euclid(CELLS.into()) as usize;
        map[wrap(corner[1], dz) * CELLS as usize + wrap(corner[0], dx)]
    };
    [0, 1].map(|i| {
        let row = |dz| f64::from(cell(0, dz)[i]) * (1.0 - part[0]) + f64::from(cell(1, dz)[i]) * part[0];
        row(0) * (1.0 - part[1]) + row(1) * part[1]
    })
}

/// The map of a light.
fn thrown(gpu: &Device, map: &[[f32; 4]], towards: Vec3, strength: f32) -> Vec<[f32; 4]> {
    let mut descriptor = slope_texture("slopes", CELLS, CELLS);
    descriptor.usage |= wgpu::TextureUsages::COPY_DST;
    let slopes = gpu.device.create_texture(&descriptor);
    write_map(gpu, &slopes, map);
    let target = gpu.device.create_texture(&caustic_texture());
    let mut pass = CausticsGpu::new(&gpu.device);
    let frame = CausticFrame {
        towards,
        side_m: 1.0,
        strength,
    };
    // Twice: nothing of the first is left in the second.
    for _ in 0..2 {
        pass.prepare(&gpu.device, &gpu.queue, &slopes, &target, &frame);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        pass.clear(&mut encoder);
        pass.encode(&mut encoder.begin_compute_pass(&Default::default()));
        gpu.queue.submit([encoder.finish()]);
    }
    read_map(gpu, &target, 0)
}

#[test]
fn thrown_light_is_that_of_the_twin_and_none_is_lost() {
    let Some(gpu) = device() else { return };
    let map = slopes();
    for towards in [Vec3::Y, Vec3::new(0.5, 0.4, -0.6).normalize()] {
        let found = thrown(&gpu, &map, towards, 1.0);
        let twin = |towards: Vec3| caustic_map(towards.to_array().map(f64::from), 1.0, |at| between(&map, at));
        let off = |twin: &[[f64; 4]], layer: usize| {
            let sum: f64 = found
                .iter()
                .zip(twin)
                .map(|(found, twin)| (f64::from(found[layer]) - twin[layer]).abs())
                .sum();
            sum / twin.len() as f64
        };
        let expected = twin(towards);
        let elsewhere = twin(Vec3::new(-0.7, 0.5, 0.3).normalize());
        for layer in 0..CAUSTIC_WAYS_M.len() {
            let mean = found.iter().map(|v| f64::from(v[layer])).sum::<f64>() / found.len() as f64;
            assert!((mean - 1.0).abs() < 2e-3, "{mean}");
            let wrong = off(&expected, layer);
            assert!(wrong < 0.02, "{towards} at {} m: {wrong}", CAUSTIC_WAYS_M[layer]);
            assert!(
                off(&elsewhere, layer) > 5.0 * wrong,
                "another light is told apart: {} {wrong}",
                off(&elsewhere, layer)
            );
        }
        let brightest = found.iter().map(|v| v[1]).fold(0.0, f32::max);
        assert!(brightest > 1.5, "{brightest}");
    }
    // Still water.
    for value in thrown(&gpu, &map, Vec3::Y, 0.0) {
        assert!(value.iter().all(|v| (v - 1.0).abs() < 2e-3), "{value:?}");
    }
    assert_eq!(CAUSTIC_TEXELS % 8, 0);
}

#[test]
fn shift_and_blend_are_the_cpus() {
    let Some(gpu) = device() else { return };
    let input: Vec<[f32; 4]> = (0..400_u16)
        .map(|i| {
            let turn = f32::from(i) * 0.37;
            let up = 0.06 + 0.93 * f32::from(i % 37) / 37.0;
            [turn.cos(), up, 0.1 * (1.7 * turn).sin(), 14.0 * f32::from(i) / 400.0]
        })
        .collect();
    let body = "let v = input[i]; let out = sqrt(1.0 - v.y * v.y); \
        let towards = vec3<f32>(out * v.x, v.y, out * sqrt(max(1.0 - v.x * v.x, 0.0))); \
        let shift = rain_caustic_shift(towards, vec2<f32>(v.z, 0.06)); \
        output[i] = vec4<f32>(shift, rain_caustic_at(vec4<f32>(2.0, 0.5, 3.0, 1.4), v.w), 0.0);";
    let found: Vec<[f32; 4]> = gpu.compute(&kernel(&library(), "vec4<f32>", "vec4<f32>", body), &input, &[]);
    for ([cosine, up, slope, way], found) in input.into_iter().zip(found) {
        let (cosine, up) = (f64::from(cosine), f64::from(up));
        let out = (1.0 - up * up).sqrt();
        let towards = [out * cosine, up, out * (1.0 - cosine * cosine).max(0.0).sqrt()];
        let shift = caustic_shift(towards, [slope.into(), f64::from(0.06_f32)]);
        for i in 0..2 {
            assert!(
                (f64::from(found[i]) - shift[i]).abs() < 1e-6 / up,
                "{found:?} {shift:?}"
            );
        }
        let light = caustic_at([2.0, 0.5, 3.0, f64::from(1.4_f32)], way.into());
        assert!(
            (f64::from(found[2]) - light).abs() < 2e-5,
            "{way}: {} {light}",
            found[2]
        );
    }
}
