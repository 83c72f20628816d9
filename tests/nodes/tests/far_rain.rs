//! Particles of far rain on a GPU against their opacities on the CPU.

use glam::{DVec3, Mat4, Vec3, Vec4};
use rain_core::rainfall::{FAR_HEIGHT, FarParticle, far_pitch_weight, far_profile};
use rain_render::far_rain::{FarRainGpu, FarRainInput, FarRainViewGpu, encode_far_rain, encode_far_rain_coverage};
use rain_render::rainfall::{COVERAGE_FORMAT, DEPTH_FORMAT, Lighting};

use crate::device::{Device, device, kernel, library};
use crate::maps::read_map;

const SIDE: u32 = 96;
const NEAR_M: f32 = 0.1;
/// Tangent of half the view's angle.
const HALF: f32 = 0.6;
const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
const CLOUD_M: f32 = 60.0;
const THIN_M: f32 = 25.0;
/// What a drop shows in surroundings of radiance 1 goes on whole.
const AMBIENT: f32 = 0.5;

/// Some dozens of particles, 60 to 260 m away.
fn particles() -> Vec<FarParticle> {
    let unit = |i: u32, k: u32| ((i * 7919 + k * 104_729 + 31) % 1999) as f32 / 1999.0;
    (0..60)
        .map(|i| {
            let way = 60.0 + 200.0 * unit(i, 1);
            FarParticle {
                centre: [
                    (2.0 * unit(i, 2) - 1.0) * 0.5 * way,
                    0.7 * way * unit(i, 3) - 0.1 * way,
                    -way,
                ],
                presence: 0.2 + 0.8 * unit(i, 4),
                half_width: way * (0.01 + 0.02 * unit(i, 5)),
                phase: unit(i, 6),
                rank: unit(i, 7),
                level: 0.0,
            }
        })
        .collect()
}

fn draw(gpu: &Device, particles: &[FarParticle], axis: Vec3, wall_m: Option<f32>, coverage: bool) -> Vec<[f32; 4]> {
    let f = 1.0 / HALF;
    let clip_from_eye = Mat4::from_cols(
        Vec4::new(f, 0.0, 0.0, 0.0),
        Vec4::new(0.0, f, 0.0, 0.0),
        Vec4::new(0.0, 0.0, 0.0, -1.0),
        Vec4::new(0.0, 0.0, NEAR_M, 0.0),
    );
    let texture = |format, more| {
        gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d {
                width: SIDE,
                height: SIDE,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | more,
            view_formats: &[],
        })
    };
    let mut far = FarRainGpu::new(&gpu.device);
    far.prepare_pipelines(&gpu.device, COLOUR, 1, coverage);
    let mut view = FarRainViewGpu::new(&gpu.device);
    let input = FarRainInput {
        particles,
        axis,
        clip_from_eye,
        lighting: Lighting {
            environment_scale: 0.0,
            environment_max_level: 0.0,
            ambient: Vec3::splat(AMBIENT),
            sun_direction: Vec3::Y,
            sun: Vec3::ZERO,
        },
        cloud_m: CLOUD_M,
        thin_m: THIN_M,
    };
    view.prepare(&gpu.device, &gpu.queue, &far, &input, None);
    assert_eq!(view.particles() as usize, particles.len());
    assert!(view.memory_bytes() >= 4096 * 32);
    let format = if coverage { COVERAGE_FORMAT } else { COLOUR };
    let reading = wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::TEXTURE_BINDING;
    let target = texture(format, reading);
    let target_view = target.create_view(&Default::default());
    let depth = texture(DEPTH_FORMAT, wgpu::TextureUsages::TEXTURE_BINDING).create_view(&Default::default());
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &target_view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                store: wgpu::StoreOp::Store,
            },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &depth,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(wall_m.map_or(0.0, |wall| NEAR_M / wall)),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    if coverage {
        encode_far_rain_coverage(&mut pass, &far, &view, 1);
    } else {
        encode_far_rain(&mut pass, &far, &view, COLOUR, 1);
    }
    drop(pass);
    gpu.queue.submit([encoder.finish()]);
    read_map(gpu, &target, 0)
}

#[test]
fn far_particles_obscure_what_the_cpu_says() {
    let Some(gpu) = device() else { return };
    let particles = particles();
    for axis in [Vec3::NEG_Y, Vec3::new(0.5, -1.0, 0.2).normalize()] {
        for wall in [None, Some(140.0)] {
            let [colour, coverage] = [false, true].map(|coverage| draw(&gpu, &particles, axis, wall, coverage));
            let mut shown = 0;
            for (i, texel) in (0_u32..).zip(&colour) {
                let ndc = |i: u32| f64::from(2 * i + 1) / f64::from(SIDE) - 1.0;
                let at = DVec3::new(ndc(i % SIDE) * f64::from(HALF), -ndc(i / SIDE) * f64::from(HALF), -1.0);
                let towards = at.normalize().as_vec3();
                let (mut expected, mut through) = (0.0, 1.0);
                for p in &particles {
                    // Where the sight meets the particle's plane.
                    let centre = Vec3::from(p.centre);
                    let normal = axis.cross(centre.cross(axis)).normalize();
                    let ahead = -towards.z * centre.dot(normal) / towards.dot(normal);
                    if wall.is_none_or(|wall| ahead < wall) {
                        let opacity = p.opacity(towards, axis, [CLOUD_M, THIN_M]);
                        expected += (AMBIENT * p.shade() - expected) * opacity;
                        through *= 1.0 - opacity;
                    }
                }
                // Soft sides: little depends on where rounding ends a particle. Halves are blended once for each.
                let obscured = 1.0 - through;
                assert!(
                    (texel[0] - expected).abs() < 4e-3 && (coverage[i as usize][0] - obscured).abs() < 4e-3,
                    "{axis} {wall:?} {towards}: {} {expected}",
                    texel[0]
                );
                shown += usize::from(obscured > 0.05);
            }
            assert!(shown > 500, "{shown}");
        }
    }
}

#[test]
fn profiles_and_weights_of_far_rain_are_the_cpus() {
    let Some(gpu) = device() else { return };
    let rows: Vec<[f32; 4]> = (0..4000)
        .map(|i: i32| {
            let unit = |k: i32| ((i * 7919 + k * 104_729) % 1999) as f32 / 999.5 - 1.0;
            [unit(1), unit(2), 0.5 + 0.5 * unit(3), unit(4)]
        })
        .collect();
    let body = "let v = input[i];
        output[i] = vec4<f32>(rain_far_profile(v.xy, v.z), rain_far_pitch_weight(v.w), rain_far_begin(v.w * 200.0), RAIN_FAR_HEIGHT);";
    let found: Vec<[f32; 4]> = gpu.compute(&kernel(&library(), "vec4<f32>", "vec4<f32>", body), &rows, &[]);
    for (v, found) in rows.iter().zip(found) {
        let profile = far_profile(v[0], v[1], v[2]);
        assert!((found[0] - profile).abs() < 1e-4, "{v:?}: {} {profile}", found[0]);
        let weight = far_pitch_weight(v[3].into()) as f32;
        assert!((found[1] - weight).abs() < 1e-5, "{v:?}: {} {weight}", found[1]);
        let begin = rain_core::rainfall::far_begin(f64::from(v[3] * 200.0)) as f32;
        assert!((found[2] - begin).abs() < 1e-5, "{v:?}: {} {begin}", found[2]);
        assert_eq!(found[3], FAR_HEIGHT as f32);
    }
}
