//! Drops on glass in the shader are the CPU's.

use glam::{UVec2, UVec4, Vec2};
use rain_core::lens::{WiperArm, WiperMode, Wipers, cap_view};
use rain_render::gpu_types::LensDrop;
use rain_render::lens::{LensGpu, LensInput, LensViewGpu, encode_lens};

use crate::device::{device, kernel, library};

#[test]
fn what_a_drop_on_glass_shows_is_the_cpus() {
    let Some(gpu) = device() else { return };
    let input: Vec<[f32; 4]> = (0..=200_u16).map(|i| [f32::from(i) / 200.0, 0.0, 0.0, 0.0]).collect();
    let body = "output[i] = vec4<f32>(rain_cap_view(input[i].x), 0.0, 0.0);";
    let found: Vec<[f32; 4]> = gpu.compute(&kernel(&library(), "vec4<f32>", "vec4<f32>", body), &input, &[]);
    let off = |factor: f64| {
        let each = input.iter().zip(&found).map(|(v, f)| {
            let known = cap_view(factor * f64::from(v[0]));
            let turn = (f64::from(f[0]) - known.deviation_rad.tan()).abs();
            turn.max((f64::from(f[1]) - known.transmission).abs())
        });
        each.fold(0.0, f64::max)
    };
    // Differences of products of numbers below 1, in single precision, steepest at the rim.
    assert!(off(1.0) < 4e-6, "{}", off(1.0));
    assert!(off(0.95) > 1e-2, "another slope is found");
}

#[test]
fn wipers_pass_in_the_shader_when_they_pass_on_the_cpu() {
    let Some(gpu) = device() else { return };
    let arm = WiperArm {
        pivot_m: [0.1, -0.4],
        blade_m: [0.1, 0.6],
        turn_rad: [3.0, 0.6],
    };
    for (mode, time_s) in [
        (WiperMode::Slow, 0.5),
        (WiperMode::Fast, 17.3),
        (WiperMode::Interval, 8.2),
    ] {
        let wipers = Wipers {
            arms: [Some(arm), None],
            mode,
            time_s,
        };
        let [period, moving] = mode.cycle_s().expect("a cycle");
        let places: Vec<[f32; 4]> = (0..4096_u32)
            .map(|i| [0.02 * (i % 64) as f32 - 0.6, 0.02 * (i / 64) as f32 - 0.6, 0.0, 0.0])
            .collect();
        let body = format!(
            "output[i] = vec4<f32>(rain_wiped_since(vec4<f32>(0.1, -0.4, 0.1, 0.6), vec2<f32>(3.0, 0.6), \
             vec4<f32>({period:?}, {moving:?}, {:?}, {time_s:?}), input[i].xy));",
            time_s % period
        );
        let found: Vec<[f32; 4]> = gpu.compute(&kernel(&library(), "vec4<f32>", "vec4<f32>", &body), &places, &[]);
        let (mut passed, mut apart) = (0, 0);
        for (place, found) in places.iter().zip(found) {
            let known = wipers.since_s([f64::from(place[0]), f64::from(place[1])]);
            match (known, found[0] >= 0.0) {
                // The arc cosine is steep at the ends of the swing: 1e-6 there is 1e-3 of the cycle.
                (Some(known), true) if (known - f64::from(found[0])).abs() < 2e-3 * period => passed += 1,
                (None, false) => {}
                _ => apart += 1,
            }
        }
        // On the rim of the arc, or at the very place of the blade, the two may fall to either side.
        assert!(passed > 200 && apart <= 4, "{mode:?}: {passed} passed, {apart} apart");
    }
}

const SIZE: [u32; 2] = [256, 144];

/// A scene that is bright above its middle and dark below, seen through `drops`, `mist` and `wipers`: rows of red, 0 to 1.
fn seen(gpu: &crate::device::Device, drops: &[LensDrop], mist: f32, wipers: &Wipers) -> Vec<f32> {
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let [scene, target] = [
        wgpu::TextureUsages::TEXTURE_BINDING,
        wgpu::TextureUsages::RENDER_ATTACHMENT,
    ]
    .map(|usage| {
        gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d {
                width: SIZE[0],
                height: SIZE[1],
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: usage | wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        })
    });
    let texels: Vec<[u8; 4]> = (0..SIZE[0] * SIZE[1])
        .map(|i| if i / SIZE[0] < SIZE[1] / 2 { [204; 4] } else { [51; 4] })
        .collect();
    let rows = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(4 * SIZE[0]),
        rows_per_image: None,
    };
    gpu.queue
        .write_texture(scene.as_image_copy(), bytemuck::cast_slice(&texels), rows, scene.size());
    let mut lens = LensGpu::new(&gpu.device);
    lens.prepare_pipelines(&gpu.device, format);
    let mut view = LensViewGpu::new(&gpu.device);
    view.prepare(
        &gpu.device,
        &gpu.queue,
        &LensInput {
            drops,
            wipers,
            viewport_px: UVec4::new(0, 0, SIZE[0], SIZE[1]),
            target_px: UVec2::from(SIZE),
            half_tan: Vec2::new(0.8, 0.45),
            distance_m: 0.1,
            aperture_m: 0.0,
            mist,
            mist_per_s: 0.0,
        },
    );
    let mut encoder = gpu
        .device
        .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let views = [&scene, &target].map(|t| t.create_view(&wgpu::TextureViewDescriptor::default()));
    encode_lens(&gpu.device, &mut encoder, &lens, &view, &views[0], &views[1], format);
    let bytes = u64::from(4 * SIZE[0] * SIZE[1]);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: bytes,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let copy = wgpu::TexelCopyBufferInfo {
        buffer: &buffer,
        layout: rows,
    };
    encoder.copy_texture_to_buffer(target.as_image_copy(), copy, target.size());
    gpu.queue.submit([encoder.finish()]);
    let found = gpu.read(&buffer, bytes);
    found.chunks_exact(4).map(|texel| f32::from(texel[0]) / 255.0).collect()
}

#[test]
fn a_drop_turns_the_scene_over_and_clear_glass_changes_nothing() {
    let Some(gpu) = device() else { return };
    let at = |picture: &[f32], x: u32, y: u32| picture[(y * SIZE[0] + x) as usize];
    let off = Wipers::default();
    let clear = seen(&gpu, &[], 0.0, &off);
    for y in 0..SIZE[1] {
        assert!((0..SIZE[0]).all(|x| at(&clear, x, y) == if y < 72 { 0.8 } else { 0.2 }));
    }
    // In the middle, 16 mm of 160 mm: a radius of 25.6 pixels.
    let drop = LensDrop {
        place: [0.0, 0.0],
        along: [1.0, 0.0],
        radius: 0.016,
        stretch: 1.0,
        key: 5,
        pad_a: 0,
    };
    let picture = seen(&gpu, &[drop], 0.0, &off);
    // Above its middle it shows what is below.
    assert!(at(&picture, 128, 60) < 0.3 && at(&picture, 128, 84) > 0.6);
    let rim = at(&picture, 128, 72 + 22);
    assert!(rim < at(&picture, 128, 84) + 1e-3, "the rim is no brighter: {rim}");
    // Beside it nothing changes.
    assert!(at(&picture, 60, 60) == 0.8 && at(&picture, 200, 100) == 0.2);
    // Mist blurs the edge of the scene and nothing far from it; where a blade passed just now it is gone.
    let misty = seen(&gpu, &[], 1.0, &off);
    assert!((0.25..0.75).contains(&at(&misty, 128, 72)) && (at(&misty, 128, 10) - 0.8).abs() < 0.01);
    let arm = WiperArm {
        pivot_m: [0.0, -0.05],
        blade_m: [0.01, 0.2],
        turn_rad: [0.1, 3.0],
    };
    let wiped = Wipers {
        arms: [Some(arm), None],
        mode: WiperMode::Slow,
        time_s: 1.2,
    };
    let wiped = seen(&gpu, &[], 1.0, &wiped);
    assert!((at(&wiped, 128, 71) - 0.8).abs() < 0.01 && (at(&wiped, 128, 73) - 0.2).abs() < 0.01);
    // The blade itself is dark: at rest along the lower edge.
    let resting = Wipers {
        arms: [Some(arm), None],
        ..off
    };
    let resting = seen(&gpu, &[], 0.0, &resting);
    assert!(at(&resting, 180, 72 + 64) < 0.05, "{}", at(&resting, 180, 136));
}
