//! The rain that is compared: a still view over flat country in steady rain, and as many of its drops as are asked for.

use glam::{DVec3, Mat4, Vec2, Vec3, Vec4};
use rain_core::rainfall::{
    Container, Distribution, DropChoice, FieldMotion, RainViewVolume, Spectrum, quality_for_budget,
};
use rain_render::cover::open_sky;
use rain_render::gpu_types::Streak;
use rain_render::rainfall::{Drops, Lighting, RainfallGpu, RainfallInput, RainfallTextures, RainfallViewGpu, Shutter};

/// The picture. Units: px.
pub const SIZE: [u32; 2] = [1280, 720];

/// Vertical field of view, Bevy's default. Units: rad.
pub const FOV_Y: f32 = std::f32::consts::FRAC_PI_4;

/// Near plane, Bevy's default. Units: m.
pub const NEAR_M: f32 = 0.1;

/// The eye looks along −Z from here: no drop that is drawn singly lies under the ground or behind anything.
pub const EYE_M: Vec3 = Vec3::new(0.0, 12.0, 20.0);

/// Rain rate. Units: mm/h.
pub const RATE_MM_H: f64 = 50.0;

/// Shutter time, the plugins' default. Units: s.
pub const EXPOSURE_S: f32 = 1.0 / 60.0;

/// Contrast, the plugins' default.
pub const CONTRAST: f32 = 4.0;

/// No more drops are looked for.
const MOST_DROPS: u32 = 1 << 19;

/// Seed of the drop field.
pub const SEED: u64 = 9;

/// Numbers of visible drops agree with what is asked for within this share.
pub const TOLERANCE: f64 = 0.02;

/// Focal length. Units: px.
#[must_use]
pub fn focal_px() -> f32 {
    0.5 * SIZE[1] as f32 / (0.5 * FOV_Y).tan()
}

/// Infinite reverse-Z, looking along −Z.
#[must_use]
pub fn clip_from_eye() -> Mat4 {
    let f = 1.0 / (0.5 * FOV_Y).tan();
    Mat4::from_cols(
        Vec4::new(f * SIZE[1] as f32 / SIZE[0] as f32, 0.0, 0.0, 0.0),
        Vec4::new(0.0, f, 0.0, 0.0),
        Vec4::new(0.0, 0.0, 0.0, -1.0),
        Vec4::new(0.0, 0.0, NEAR_M, 0.0),
    )
}

/// What is seen of projected streaks.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
pub struct Shown {
    /// Those with a part in the picture.
    pub visible: u32,
    /// Mean length of their quads in the picture. Units: px.
    pub length_px: f64,
    /// Area of their quads in the picture over its length. Units: px.
    pub width_px: f64,
    /// Area of their quads in the picture, overlaps counted as often as they are. Units: px.
    pub covered_px: f64,
}

/// Adds up quads given by the ends of their axes and their widths, px.
#[must_use]
pub fn shown(quads: impl Iterator<Item = (Vec2, Vec2, f32)>) -> Shown {
    let size = Vec2::new(SIZE[0] as f32, SIZE[1] as f32);
    let (mut visible, mut length, mut area) = (0_u32, 0.0, 0.0);
    for (head, tail, width) in quads {
        let Some(share) = share_inside(head, tail, size) else {
            continue;
        };
        let own = f64::from(share * (tail - head).length());
        visible += 1;
        length += own;
        area += own * f64::from(width);
    }
    Shown {
        visible,
        length_px: length / f64::from(visible.max(1)),
        width_px: area / f64::max(length, 1e-9),
        covered_px: area,
    }
}

/// Share of a segment that lies in the picture; `None`: nothing of it.
fn share_inside(a: Vec2, b: Vec2, size: Vec2) -> Option<f32> {
    let path = b - a;
    let (mut from, mut to) = (0.0_f32, 1.0_f32);
    for (p, d, end) in [(a.x, path.x, size.x), (a.y, path.y, size.y)] {
        if d.abs() < 1e-9 {
            if !(0.0..=end).contains(&p) {
                return None;
            }
            continue;
        }
        let (low, high) = ((0.0 - p) / d, (end - p) / d);
        from = from.max(low.min(high));
        to = to.min(low.max(high));
    }
    (from <= to).then_some(to - from)
}

/// The quads that streaks are drawn as: half a pixel larger on each side than what is shown.
pub fn quads_of(streaks: &[Streak]) -> impl Iterator<Item = (Vec2, Vec2, f32)> + '_ {
    streaks.iter().filter(|s| s.shape[2] != 0.0).map(|s| {
        let (head, tail) = (Vec2::new(s.ends[0], s.ends[1]), Vec2::new(s.ends[2], s.ends[3]));
        let width = 2.0 * s.shape[2].abs();
        let path = tail - head;
        let travelled = path.length();
        let along = if travelled > 1e-4 { path / travelled } else { Vec2::Y };
        let span = f32::max(1.0, travelled + if width > 1.0 { width } else { 0.0 });
        let (middle, reach) = (0.5 * (head + tail), (0.5 * span + 0.5) * along);
        (middle - reach, middle + reach, width + 1.0)
    })
}

/// What the view's drops are chosen from at quality `kappa`.
///
/// # Errors
/// When there is no such rain.
pub fn choice(kappa: f64) -> Result<DropChoice, String> {
    let mut motion = FieldMotion::default();
    motion.set_velocity(DVec3::ZERO, 1.2041);
    motion.advance(1234.5);
    Ok(DropChoice {
        seed: SEED,
        spectrum: spectrum()?,
        motion,
        view: volume(),
        kappa,
        most_drops: MOST_DROPS,
        uneven: None,
        region: None,
        detail: None,
    })
}

fn spectrum() -> Result<Spectrum, String> {
    Spectrum::new(Distribution::default(), RATE_MM_H).map_err(|error| error.to_string())
}

fn volume() -> RainViewVolume {
    let ty = (0.5 * FOV_Y).tan();
    let tx = ty * SIZE[0] as f32 / SIZE[1] as f32;
    let plane = |n: Vec3| n.normalize().extend(0.0);
    let ratio = f64::from(tx * ty) / f64::from((1.0 + tx * tx) * (1.0 + ty * ty)).sqrt();
    RainViewVolume {
        eye_m: EYE_M.as_dvec3(),
        eye_velocity_m_s: DVec3::ZERO,
        side_planes: [
            plane(Vec3::new(1.0, 0.0, -tx)),
            plane(Vec3::new(-1.0, 0.0, -tx)),
            plane(Vec3::new(0.0, 1.0, -ty)),
            plane(Vec3::new(0.0, -1.0, -ty)),
        ],
        focal_px: f64::from(focal_px()),
        solid_angle_sr: 4.0 * ratio.asin(),
        exposure_s: f64::from(EXPOSURE_S),
        turn_rad: 0.0,
        parallel: None,
    }
}

/// Pipelines, buffers and drops of the view.
pub struct Field {
    /// The pass.
    pub gpu: RainfallGpu,
    /// The view's buffers.
    pub view: RainfallViewGpu,
    /// What its drops are chosen from.
    pub choice: DropChoice,
    /// How many of them there are.
    pub drops: u32,
    /// What is seen of them.
    pub shown: Shown,
}

impl Field {
    /// The view with `count` visible drops.
    ///
    /// # Errors
    /// When there are not so many to be seen at [`RATE_MM_H`], or the device fails.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, count: u32) -> Result<Self, String> {
        let gpu = RainfallGpu::new(device);
        let mut view = RainfallViewGpu::new(device);
        let spectrum = spectrum()?;
        let mut budget = f64::from(count);
        for _ in 0..8 {
            let choice = choice(quality_for_budget(&spectrum, &volume(), budget))?;
            let streaks = project(device, queue, &gpu, &mut view, &input(&choice, 0.0))?;
            let shown = shown(quads_of(&streaks));
            let ratio = f64::from(count) / f64::from(shown.visible.max(1));
            if (ratio - 1.0).abs() <= 0.5 * TOLERANCE {
                let drops = streaks.len() as u32;
                // Memory and draws as for a budget of so many.
                let choice = DropChoice {
                    most_drops: 2 * drops + 1024,
                    ..choice
                };
                project(device, queue, &gpu, &mut view, &input(&choice, 0.0))?;
                return Ok(Self {
                    gpu,
                    view,
                    choice,
                    drops,
                    shown,
                });
            }
            budget *= ratio;
        }
        Err(format!(
            "{count} drops are not to be had: 100 to 250000 are at {RATE_MM_H} mm/h"
        ))
    }

    /// Uploads the view again, with a soft fade over `soft_m` against `depth`.
    pub fn soften(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        soft_m: f32,
        depth: Option<&wgpu::TextureView>,
    ) {
        let textures = RainfallTextures {
            scene_depth: depth,
            ..RainfallTextures::default()
        };
        self.view
            .prepare(device, queue, &self.gpu, &input(&self.choice, soft_m), textures);
    }

    /// Uploads the drops as a list.
    pub fn listed(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, container: &Container) {
        let input = RainfallInput {
            drops: Drops::Listed(container, SEED),
            ..input(&self.choice, 0.0)
        };
        self.view
            .prepare(device, queue, &self.gpu, &input, RainfallTextures::default());
    }
}

/// The view's inputs.
#[must_use]
pub fn input(choice: &DropChoice, soft_m: f32) -> RainfallInput<'_> {
    RainfallInput {
        drops: Drops::Chosen(choice),
        clip_from_eye: clip_from_eye(),
        clip_from_eye_before: clip_from_eye(),
        eye_height_m: 1.7,
        eye_velocity_m_s: Vec3::ZERO,
        viewport_px: Vec4::new(0.0, 0.0, SIZE[0] as f32, SIZE[1] as f32),
        focal_px: focal_px(),
        parallel: None,
        near_m: NEAR_M,
        shutter: Shutter {
            exposure_s: EXPOSURE_S,
            contrast: CONTRAST,
            kappa: choice.kappa as f32,
            soft_m,
            patterned: false,
            detail: None,
        },
        lighting: Lighting {
            environment_scale: 0.0,
            environment_max_level: 0.0,
            ambient: Vec3::ONE,
            sun_direction: Vec3::Y,
            sun: Vec3::ZERO,
        },
        lamps: &[],
        panes: &[],
        cover: open_sky(),
    }
}

/// The first words of a buffer.
fn read<T: bytemuck::Pod>(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    buffer: &wgpu::Buffer,
    count: u32,
) -> Result<Vec<T>, String> {
    let bytes = u64::from(count) * size_of::<T>() as u64;
    if bytes == 0 {
        return Ok(Vec::new());
    }
    let copy = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size: bytes,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, bytes);
    queue.submit([encoder.finish()]);
    copy.slice(..).map_async(wgpu::MapMode::Read, |_| {});
    device
        .poll(wgpu::PollType::wait_indefinitely())
        .map_err(|error| error.to_string())?;
    Ok(bytemuck::pod_collect_to_vec(&copy.slice(..).get_mapped_range()))
}

/// The streaks that the pass makes of `input`'s drops.
///
/// # Errors
/// When the device fails.
pub fn project(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    gpu: &RainfallGpu,
    view: &mut RainfallViewGpu,
    input: &RainfallInput,
) -> Result<Vec<Streak>, String> {
    view.prepare(device, queue, gpu, input, RainfallTextures::default());
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        rain_render::rainfall::encode_project(&mut pass, gpu, view);
    }
    queue.submit([encoder.finish()]);
    let drops: Vec<u32> = read(device, queue, view.arguments(), 1)?;
    read(device, queue, view.streaks(), drops[0])
}
