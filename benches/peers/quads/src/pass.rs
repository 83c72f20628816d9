//! Our pass and the bare one, timed in turn.

use rain_core::rainfall::Container;
use rain_render::rainfall::{DEPTH_FORMAT, StreakDraws, encode_draw, encode_project};

use crate::clock::{Moment, Passed, Summary};
use crate::field::{Field, SIZE, Shown};

/// Bevy's main texture without HDR.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// Distance over which streaks fade, the plugins' default. Units: m.
const SOFT_M: f32 = 0.15;

/// Times of the passes, less an empty pass over the same targets.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct PassTimes {
    /// The streaks, with a hard depth test.
    pub draw: Summary,
    /// The streaks, faded where they meet the scene.
    pub soft: Summary,
    /// The bare quads.
    pub bare: Summary,
    /// The compute pass before: drops are chosen and projected.
    pub project: Summary,
    /// The same where they are listed already.
    pub listed: Summary,
    /// Listing them on the CPU.
    pub list: Summary,
    /// The empty pass.
    pub empty: Summary,
    /// What was drawn.
    pub shown: Shown,
    /// Drops that are drawn, seen or not.
    pub drops: u32,
}

struct Targets {
    colour: wgpu::TextureView,
    depth: wgpu::TextureView,
    /// Another of the same kind: what is attached cannot be read.
    scene: wgpu::TextureView,
}

fn texture(device: &wgpu::Device, format: wgpu::TextureFormat) -> wgpu::TextureView {
    let made = device.create_texture(&wgpu::TextureDescriptor {
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
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    made.create_view(&wgpu::TextureViewDescriptor::default())
}

/// A pass over the targets; `clear` for the first time, else over what is there, as over a scene.
fn begin<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    colour: &wgpu::TextureView,
    depth: &wgpu::TextureView,
    clear: bool,
) -> wgpu::RenderPass<'e> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: None,
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: colour,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: if clear {
                    wgpu::LoadOp::Clear(wgpu::Color::BLACK)
                } else {
                    wgpu::LoadOp::Load
                },
                store: wgpu::StoreOp::Store,
            },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(wgpu::Operations {
                load: if clear {
                    wgpu::LoadOp::Clear(0.0)
                } else {
                    wgpu::LoadOp::Load
                },
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}

fn bare_pipeline(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("bare quads"),
        source: wgpu::ShaderSource::Wgsl(include_str!("bare.wgsl").into()),
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("bare quads"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(false),
            depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("colour"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: FORMAT,
                blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Times `pairs` rounds of the empty pass, the bare quads, our pass hard and soft, and the projection, in turn, at
/// `count` visible drops.
///
/// # Errors
/// Without an adapter, when it fails, or when there are not so many drops to be seen.
pub fn times(count: u32, pairs: usize) -> Result<PassTimes, String> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))
        .map_err(|error| format!("no graphics adapter: {error}"))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))
        .map_err(|error| error.to_string())?;
    let targets = Targets {
        colour: texture(&device, FORMAT),
        depth: texture(&device, DEPTH_FORMAT),
        scene: texture(&device, DEPTH_FORMAT),
    };
    let mut hard = Field::new(&device, &queue, count)?;
    hard.gpu.prepare_pipelines(&device, FORMAT, 1, StreakDraws::default());
    let mut soft = Field::new(&device, &queue, count)?;
    let softly = StreakDraws {
        soft: true,
        ..StreakDraws::default()
    };
    soft.gpu.prepare_pipelines(&device, FORMAT, 1, softly);
    soft.soften(&device, &queue, SOFT_M, Some(&targets.scene));
    let bare = bare_pipeline(&device);
    let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &bare.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: hard.view.streaks().as_entire_binding(),
        }],
    });
    let drops = hard.drops;
    let mut listed = Field::new(&device, &queue, count)?;
    let mut container = Container::default();
    if !listed.choice.fill(&mut container) {
        return Err("there are more drops than before".into());
    }
    listed.listed(&device, &queue, &container);
    let timed = |record: &dyn Fn(&mut wgpu::CommandEncoder)| -> Result<Passed, String> {
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        record(&mut encoder);
        let commands = encoder.finish();
        let from = Moment::now();
        queue.submit([commands]);
        device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|error| error.to_string())?;
        Ok(from.passed())
    };
    let draw = |encoder: &mut wgpu::CommandEncoder, field: &Field| {
        let mut pass = begin(encoder, &targets.colour, &targets.depth, false);
        encode_draw(&mut pass, &field.gpu, &field.view, FORMAT, 1);
    };
    let project = |encoder: &mut wgpu::CommandEncoder, field: &Field| {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        encode_project(&mut pass, &field.gpu, &field.view);
    };
    // Something far away everywhere, so that every pixel is tested and drawn.
    timed(&|encoder| drop(begin(encoder, &targets.colour, &targets.depth, true)))?;
    timed(&|encoder| drop(begin(encoder, &targets.colour, &targets.scene, true)))?;
    timed(&|encoder| project(encoder, &soft))?;
    let mut all = [const { Vec::new() }; 7];
    // The first rounds compile shaders and touch memory.
    for round in 0..pairs + 2 {
        let times = [
            timed(&|encoder| drop(begin(encoder, &targets.colour, &targets.depth, false)))?,
            timed(&|encoder| {
                let mut pass = begin(encoder, &targets.colour, &targets.depth, false);
                pass.set_pipeline(&bare);
                pass.set_bind_group(0, &bind_group, &[]);
                pass.draw(0..6 * drops, 0..1);
            })?,
            timed(&|encoder| draw(encoder, &hard))?,
            timed(&|encoder| draw(encoder, &soft))?,
            timed(&|encoder| project(encoder, &hard))?,
            timed(&|encoder| project(encoder, &listed))?,
            {
                let from = Moment::now();
                let whole = listed.choice.fill(&mut container);
                std::hint::black_box(whole);
                from.passed()
            },
        ];
        if round >= 2 {
            for (list, time) in all.iter_mut().zip(times) {
                list.push(time);
            }
        }
    }
    let [empty, bare, draw, soft, project, listed, list] = all.map(|list| Summary::of(&list));
    Ok(PassTimes {
        draw: draw.over(empty),
        soft: soft.over(empty),
        bare: bare.over(empty),
        project,
        listed,
        list,
        empty,
        shown: hard.shown,
        drops,
    })
}
