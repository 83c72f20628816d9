//! The blurred levels of the mirrored view.

use rain_render::reflection::{REFLECTION_FORMAT, ReflectionMipsGpu, encode_reflection_mips};

use crate::device::device;
use crate::maps::{read_map, write_map};

fn levels(size: [u32; 2], count: u32, texel: impl Fn(u32, u32) -> [f32; 4]) -> Option<Vec<Vec<[f32; 4]>>> {
    let gpu = device()?;
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: size[0],
            height: size[1],
            depth_or_array_layers: 1,
        },
        mip_level_count: count,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: REFLECTION_FORMAT,
        usage: wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::STORAGE_BINDING
            | wgpu::TextureUsages::COPY_DST
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let texels: Vec<[f32; 4]> = (0..size[1])
        .flat_map(|y| (0..size[0]).map(move |x| (x, y)))
        .map(|(x, y)| texel(x, y))
        .collect();
    write_map(&gpu, &texture, &texels);
    let mips = ReflectionMipsGpu::new(&gpu.device);
    let target = mips.bind(&gpu.device, &texture, 0);
    let mut encoder = gpu
        .device
        .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        encode_reflection_mips(&mut pass, &mips, &target);
    }
    gpu.queue.submit([encoder.finish()]);
    Some((0..count).map(|level| read_map(&gpu, &texture, level)).collect())
}

#[test]
fn an_even_view_stays_even_in_every_level() {
    let Some(levels) = levels([96, 40], 5, |_, _| [0.25, 1.5, 7.0, 1.0]) else {
        return;
    };
    for level in levels {
        assert!(!level.is_empty());
        for texel in level {
            assert_eq!(texel, [0.25, 1.5, 7.0, 1.0]);
        }
    }
}

#[test]
fn a_lamp_is_spread_and_none_of_its_light_is_lost() {
    let Some(levels) = levels([64, 64], 4, |x, y| {
        if (x, y) == (32, 31) {
            [1024.0, 0.0, 0.0, 1.0]
        } else {
            [0.0, 0.0, 0.0, 1.0]
        }
    }) else {
        return;
    };
    for (i, level) in levels.iter().enumerate() {
        let texels = 4_f32.powi(i as i32);
        let sum: f32 = level.iter().map(|t| t[0]).sum();
        assert!((sum * texels / 1024.0 - 1.0).abs() < 2e-3, "level {i}: {sum}");
        let lit = level.iter().filter(|t| t[0] > 0.0).count();
        assert!(i == 0 || lit >= 4, "level {i}: {lit} texels");
    }
}
