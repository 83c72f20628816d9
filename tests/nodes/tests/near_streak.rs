//! Pictures of near drops: what they show, and that a streak with a pattern hides and sends as much as one without.

use glam::{DVec3, Vec2, Vec3};
use rain_core::optics::{StreakAngles, streak_pattern, swinging_body};
use rain_core::rainfall::{Container, Distribution, Lamp, SizeClass, Spectrum};
use rain_render::rainfall::{
    DEPTH_FORMAT, Lighting, RainfallGpu, RainfallInput, RainfallTextures, RainfallViewGpu, StreakDraws, encode_draw,
    encode_project,
};

use crate::device::{Device, device};
use crate::field_parity::{FieldView, half_pair};

pub const SIDE: u32 = 512;
const SEED: u64 = 5;
pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// A long lens: a drop of 3 mm at 0.8 m is 19 px wide.
fn close() -> FieldView {
    FieldView {
        size: Vec2::splat(SIDE as f32),
        fov_y: 0.1,
        eye_m: DVec3::new(3.0, 1.7, -2.0),
        wind_m_s: DVec3::ZERO,
        ..FieldView::default()
    }
}

/// A moment with a drop of at least `least_mm` and `width_px` near the middle of the picture, and this drop alone.
fn one_drop(gpu: &Device, pipelines: &RainfallGpu, least_mm: f64, width_px: f32) -> (FieldView, Container) {
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 100.0).expect("a spectrum");
    for i in 0..400 {
        let view = FieldView {
            seconds: 100.0 + 0.7 * f64::from(i),
            exposure_s: 1.0 / 2000.0,
            ..close()
        };
        let mut container = view.container(SEED, &spectrum);
        let streaks = view.streaks(gpu, pipelines, SEED, &container);
        let middle = |s: &rain_render::gpu_types::Streak| {
            let off = Vec2::new(s.ends[0], s.ends[1]) - 0.5 * view.size;
            off.abs().max_element() < 0.2 * view.size.x
        };
        // Not in the fade before the eye.
        let found = container.records.iter().zip(&streaks).position(|(record, s)| {
            let width = 2.0 * s.shape[2];
            let large = SizeClass::new((record.drop & 15) as usize).min_mm >= least_mm;
            large && width > width_px && width < 3.0 * width_px && middle(s) && half_pair(s.shares)[1] > 0.999
        });
        if let Some(found) = found {
            container.records = vec![container.records[found]];
            return (view, container);
        }
    }
    panic!("no such drop in 400 moments");
}

/// What a drop is drawn in.
#[derive(Clone, Copy)]
struct Scene {
    patterned: bool,
    /// Bright above the horizon and dark below, else even light of 1.
    sky: bool,
    sun: Vec3,
    sun_direction: Vec3,
    background: f64,
}

const EVEN: Scene = Scene {
    patterned: true,
    sky: false,
    sun: Vec3::ZERO,
    sun_direction: Vec3::new(0.0, 0.196_116_14, -0.980_580_7),
    background: 0.0,
};

/// A cube of 1 above the horizon and 0.05 below.
fn sky(gpu: &Device) -> wgpu::TextureView {
    const FACE: u32 = 32;
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: FACE,
            height: FACE,
            depth_or_array_layers: 6,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let mut texels = Vec::new();
    for face in 0..6 {
        for row in 0..FACE {
            let above = match face {
                2 => true,
                3 => false,
                _ => row < FACE / 2,
            };
            for _ in 0..FACE {
                texels.extend([if above { 255 } else { 13_u8 }; 4]);
            }
        }
    }
    gpu.queue.write_texture(
        texture.as_image_copy(),
        &texels,
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(4 * FACE),
            rows_per_image: Some(FACE),
        },
        texture.size(),
    );
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::Cube),
        ..wgpu::TextureViewDescriptor::default()
    })
}

fn attachment(gpu: &Device, format: wgpu::TextureFormat) -> wgpu::Texture {
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
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// A half float that is neither infinite nor NaN.
fn half(bits: u16) -> f32 {
    let (exponent, fraction) = (i32::from(bits >> 10 & 31), f32::from(bits & 1023) / 1024.0);
    let size = if exponent == 0 {
        fraction * 2.0_f32.powi(-14)
    } else {
        (1.0 + fraction) * 2.0_f32.powi(exponent - 15)
    };
    if bits >> 15 == 0 { size } else { -size }
}

/// The red of a picture, row after row.
fn draw(gpu: &Device, pipelines: &mut RainfallGpu, view: &FieldView, container: &Container, scene: Scene) -> Vec<f32> {
    let draws = StreakDraws {
        patterned: scene.patterned,
        soft: view.input(SEED, container).shutter.soft_m > 0.0,
        ..StreakDraws::default()
    };
    pipelines.prepare_pipelines(&gpu.device, FORMAT, 1, draws);
    let (target, depth) = (attachment(gpu, FORMAT), attachment(gpu, DEPTH_FORMAT));
    let sky = sky(gpu);
    let mut input = view.input(SEED, container);
    input.shutter.patterned = scene.patterned;
    input.lighting = Lighting {
        environment_scale: f32::from(u8::from(scene.sky)),
        ambient: if scene.sky || scene.sun != Vec3::ZERO {
            Vec3::ZERO
        } else {
            Vec3::ONE
        },
        sun_direction: scene.sun_direction,
        sun: scene.sun,
        ..input.lighting
    };
    if scene.background > 0.0 {
        input.lighting.ambient = Vec3::ZERO;
    }
    let textures = RainfallTextures {
        environment: Some(&sky),
        ..RainfallTextures::default()
    };
    let mut buffers = RainfallViewGpu::new(&gpu.device);
    buffers.prepare(&gpu.device, &gpu.queue, pipelines, &input, textures);
    let mut encoder = gpu
        .device
        .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        encode_project(&mut pass, pipelines, &buffers);
    }
    let plain = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: None,
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &plain(&target),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color {
                        r: scene.background,
                        g: scene.background,
                        b: scene.background,
                        a: 1.0,
                    }),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &plain(&depth),
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        encode_draw(&mut pass, pipelines, &buffers, FORMAT, 1);
    }
    red_of(gpu, encoder, &target)
}

/// The red of an [`attachment`] with the streaks of a view over black, row after row; `scene`: the depth that is there.
pub fn red_of_streaks(
    gpu: &Device,
    pipelines: &RainfallGpu,
    input: &RainfallInput,
    textures: RainfallTextures,
    scene: &wgpu::TextureView,
) -> Vec<f32> {
    let target = attachment(gpu, FORMAT);
    let mut buffers = RainfallViewGpu::new(&gpu.device);
    buffers.prepare(&gpu.device, &gpu.queue, pipelines, input, textures);
    let mut encoder = gpu
        .device
        .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encode_project(
        &mut encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default()),
        pipelines,
        &buffers,
    );
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: None,
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &target.create_view(&wgpu::TextureViewDescriptor::default()),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: scene,
                depth_ops: None,
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        let [x, y, width, height] = input.viewport_px.to_array();
        pass.set_viewport(x, y, width, height, 0.0, 1.0);
        encode_draw(&mut pass, pipelines, &buffers, FORMAT, 1);
    }
    red_of(gpu, encoder, &target)
}

/// The red of an [`attachment`] of [`FORMAT`] after what an encoder holds, row after row.
fn red_of(gpu: &Device, mut encoder: wgpu::CommandEncoder, target: &wgpu::Texture) -> Vec<f32> {
    let copy = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(SIDE * SIDE * 8),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    encoder.copy_texture_to_buffer(
        target.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &copy,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(SIDE * 8),
                rows_per_image: None,
            },
        },
        target.size(),
    );
    gpu.queue.submit([encoder.finish()]);
    let bytes = gpu.read(&copy, u64::from(SIDE * SIDE * 8));
    bytes
        .chunks_exact(8)
        .map(|texel| half(u16::from_le_bytes([texel[0], texel[1]])))
        .collect()
}

/// How much of a background is hidden, row after row.
fn opacity(gpu: &Device, pipelines: &mut RainfallGpu, view: &FieldView, drop: &Container, patterned: bool) -> Vec<f32> {
    let scene = Scene {
        patterned,
        background: 1.0,
        ..EVEN
    };
    let mut picture = draw(gpu, pipelines, view, drop, scene);
    for value in &mut picture {
        *value = 1.0 - *value;
    }
    picture
}

fn total(picture: &[f32]) -> f64 {
    picture.iter().map(|v| f64::from(*v)).sum()
}

/// Means of `values` weighted with `weight` over the rows above and below the middle of what is drawn.
fn halves(values: &[f32], weight: &[f32]) -> [f64; 2] {
    let rows = |of: &[f32]| -> Vec<f64> { of.chunks(SIDE as usize).map(total).collect() };
    let (light, area) = (rows(values), rows(weight));
    let moment: f64 = (0_u16..).zip(&area).map(|(y, a)| f64::from(y) * a).sum();
    let middle = moment / area.iter().sum::<f64>();
    let mean = |above: bool| {
        let picked = |of: &[f64]| -> f64 {
            (0_u16..)
                .zip(of)
                .filter(|(y, _)| (f64::from(*y) < middle) == above)
                .map(|(_, v)| v)
                .sum()
        };
        picked(&light) / picked(&area)
    };
    [mean(true), mean(false)]
}

#[test]
fn a_frozen_drop_shows_its_surroundings_upside_down_on_its_own_outline() {
    let Some(gpu) = device() else { return };
    let mut pipelines = RainfallGpu::new(&gpu.device);
    let (view, drop) = one_drop(&gpu, &pipelines, 0.0, 14.0);
    let frozen = FieldView {
        exposure_s: 1e-5,
        ..view
    };
    let streak = frozen.streaks(&gpu, &pipelines, SEED, &drop)[0];
    let width = f64::from(2.0 * streak.shape[2]);
    let hidden = opacity(&gpu, &mut pipelines, &frozen, &drop, true);
    let disc = core::f64::consts::FRAC_PI_4 * width * width;
    assert!(
        (total(&hidden) / disc - 1.0).abs() < 0.02,
        "{} of {disc}",
        total(&hidden)
    );
    // A rounded outline: wider than high where the drop is flat, and clear of the corners of its box.
    let solid = hidden.iter().filter(|v| **v > 0.95).count() as f64;
    assert!(solid > 0.7 * disc, "{solid} of {disc}");
    let under_sky = |patterned: bool, pipelines: &mut RainfallGpu| {
        let scene = Scene {
            patterned,
            sky: true,
            ..EVEN
        };
        draw(&gpu, pipelines, &frozen, &drop, scene)
    };
    let shown = under_sky(true, &mut pipelines);
    let [above, below] = halves(&shown, &hidden);
    assert!(above < 0.3 * below && below > 0.7, "above {above}, below {below}");
    let even = under_sky(false, &mut pipelines);
    let strip = opacity(&gpu, &mut pipelines, &frozen, &drop, false);
    let [above, below] = halves(&even, &strip);
    assert!(
        (above / below - 1.0).abs() < 0.02,
        "an even strip shows none: {above} {below}"
    );
    // Half of what it shows is sky, and 5 % of all is lost.
    let mean = total(&shown) / total(&hidden);
    assert!((mean / (0.95 * 0.525) - 1.0).abs() < 0.06, "{mean}");
}

#[test]
fn a_near_streak_hides_and_sends_as_much_as_an_even_one_with_a_pattern() {
    let Some(gpu) = device() else { return };
    let mut pipelines = RainfallGpu::new(&gpu.device);
    let (moment, drop) = one_drop(&gpu, &pipelines, 0.0, 12.0);
    for exposure_s in [1.0 / 2000.0, 1.0 / 800.0] {
        let view = FieldView {
            exposure_s,
            seconds: moment.seconds,
            ..close()
        };
        let [even, drawn] = [false, true].map(|patterned| opacity(&gpu, &mut pipelines, &view, &drop, patterned));
        let kept = total(&drawn) / total(&even) - 1.0;
        assert!(kept.abs() < 0.03, "{exposure_s}: {kept}");
        let [even, drawn] = [false, true].map(|patterned| {
            let scene = Scene { patterned, ..EVEN };
            draw(&gpu, &mut pipelines, &view, &drop, scene)
        });
        let kept = total(&drawn) / total(&even) - 1.0;
        assert!(kept.abs() < 0.03, "{exposure_s}: {kept}");
        let [even, drawn] = [false, true].map(|patterned| {
            let scene = Scene {
                patterned,
                sun: Vec3::ONE,
                ..EVEN
            };
            draw(&gpu, &mut pipelines, &view, &drop, scene)
        });
        let kept = total(&drawn) / total(&even) - 1.0;
        assert!(kept.abs() < 0.2, "{exposure_s}: {kept}");
        // The sun stands above: its glint lies in one part of the streak.
        let peak = |picture: &[f32]| f64::from(picture.iter().copied().fold(0.0, f32::max));
        let contrast = (peak(&drawn) / total(&drawn)) / (peak(&even) / total(&even));
        assert!(contrast > 1.5, "{contrast}");
    }
}

#[test]
fn far_streaks_do_not_change_by_a_bit_and_near_ones_do() {
    let Some(gpu) = device() else { return };
    let mut pipelines = RainfallGpu::new(&gpu.device);
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 25.0).expect("a spectrum");
    let view = FieldView {
        fov_y: 0.3,
        lamps: vec![Lamp::point(Vec3::new(0.3, 0.4, -4.0), Vec3::splat(20.0), 0.1)],
        ..close()
    };
    let all = view.container(SEED, &spectrum);
    let streaks = view.streaks(&gpu, &pipelines, SEED, &all);
    let mut pictures = |near: bool| {
        let mut some = all.clone();
        some.records = all
            .records
            .iter()
            .zip(&streaks)
            .filter(|(_, s)| (2.0 * s.shape[2] > 1.5) == near)
            .map(|(record, _)| *record)
            .collect();
        assert!(some.records.len() > 20, "{}", some.records.len());
        [false, true].map(|patterned| {
            let scene = Scene {
                patterned,
                sky: true,
                ..EVEN
            };
            draw(&gpu, &mut pipelines, &view, &some, scene)
        })
    };
    let [off, on] = pictures(false);
    assert!(total(&off) > 10.0 && off == on, "far streaks changed");
    let [off, on] = pictures(true);
    let differ = off.iter().zip(&on).filter(|(a, b)| (**a - **b).abs() > 1e-3).count();
    assert!(differ > 500, "{differ}");
}

/// Values of a picture in one row.
fn row(picture: &[f32], y: u32) -> &[f32] {
    &picture[(y * SIDE) as usize..((y + 1) * SIDE) as usize]
}

#[test]
fn a_glint_stands_where_the_pattern_has_it() {
    let Some(gpu) = device() else { return };
    let mut pipelines = RainfallGpu::new(&gpu.device);
    let (moment, drop) = one_drop(&gpu, &pipelines, 0.0, 16.0);
    let view = FieldView {
        exposure_s: 1.0 / 400.0,
        seconds: moment.seconds,
        ..close()
    };
    let streak = view.streaks(&gpu, &pipelines, SEED, &drop)[0];
    let class = SizeClass::new((drop.records[0].drop & 15) as usize);
    let body = swinging_body((0.5 * (class.min_mm + class.max_mm)) as f32, 0.0);
    let angles = StreakAngles {
        view_elevation_rad: 0.0,
        light_elevation_rad: 0.15,
        light_azimuth_rad: 0.5,
    };
    let scene = Scene {
        sun: Vec3::ONE,
        sun_direction: angles.directions()[1],
        ..EVEN
    };
    let light = draw(&gpu, &mut pipelines, &view, &drop, scene);
    let hidden = draw(&gpu, &mut pipelines, &view, &drop, EVEN);
    let middle = 0.5 * (streak.ends[0] + streak.ends[2]);
    let y = (0.5 * (streak.ends[1] + streak.ends[3])).clamp(0.0, SIDE as f32 - 1.0) as u32;
    // Means of a few rows, which swing by less than the drop does; even light is 95 % of what is hidden.
    let column =
        |picture: &[f32], x: u32| -> f64 { (y - 4..=y + 4).map(|y| f64::from(row(picture, y)[x as usize])).sum() };
    let radius = f64::from(streak.shape[2]);
    let compare = |mirror: f64| {
        let (mut off, mut sum, mut compared) = (0.0, 0.0, 0);
        for x in 0..SIDE {
            let across = (f64::from(x) + 0.5 - f64::from(middle)) / radius;
            if across.abs() < 0.8 {
                let found = column(&light, x) / (column(&hidden, x) / 0.95);
                let known = f64::from(streak_pattern(body, &angles, (mirror * across) as f32, 0.15));
                off += (found - known).abs();
                sum += known;
                compared += 1;
            }
        }
        assert!(compared > 10, "{compared}");
        off / sum
    };
    let (right, wrong) = (compare(1.0), compare(-1.0));
    // The drop of the picture swings, and is up to a fifth of a class larger or smaller.
    assert!(right < 0.3 && wrong > 0.7, "{right}, its mirror picture {wrong}");
}

#[test]
fn a_near_streak_swings_along_its_way() {
    let Some(gpu) = device() else { return };
    let mut pipelines = RainfallGpu::new(&gpu.device);
    let (moment, drop) = one_drop(&gpu, &pipelines, 2.9, 12.0);
    let view = FieldView {
        exposure_s: 1.0 / 80.0,
        seconds: moment.seconds,
        ..close()
    };
    let streak = view.streaks(&gpu, &pipelines, SEED, &drop)[0];
    let [low, high] = [streak.ends[1].min(streak.ends[3]), streak.ends[1].max(streak.ends[3])];
    let mut spread = |patterned: bool| {
        let picture = draw(&gpu, &mut pipelines, &view, &drop, Scene { patterned, ..EVEN });
        let first = (low.max(0.0) + 30.0) as u32;
        let last = (high.min(SIDE as f32) - 30.0) as u32;
        let widths: Vec<f64> = (first..last)
            .map(|y| {
                let values = row(&picture, y);
                let moment = |power: i32| -> f64 {
                    (0_u16..)
                        .zip(values)
                        .map(|(x, v)| f64::from(*v) * (f64::from(x) - f64::from(streak.ends[0])).powi(power))
                        .sum()
                };
                let (area, mean) = (moment(0), moment(1) / moment(0));
                (moment(2) / area - mean * mean).sqrt()
            })
            .collect();
        assert!(widths.len() > 100, "{}", widths.len());
        let (least, most) = widths
            .iter()
            .fold((f64::MAX, 0.0_f64), |(a, b), w| (a.min(*w), b.max(*w)));
        most / least
    };
    let (drawn, even) = (spread(true), spread(false));
    assert!(drawn > 1.05 && even < 1.02, "{drawn}, without a pattern {even}");
}
