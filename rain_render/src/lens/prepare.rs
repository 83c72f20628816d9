//! Pipelines that live with the device, buffers that live with a view.

use std::collections::HashMap;

use rain_core::lens::MAX_GLASS_DROPS;

use super::params::LensInput;
use crate::bindings::{params_entry, storage_entry, texture_entry};
use crate::compose;
use crate::gpu_types::{LensDrop, LensView};
use crate::params_space::PARAMS;

/// Format of the shrunk copy.
const SMALL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Film and drops for a format of targets.
#[derive(Debug)]
pub(super) struct Pipelines {
    pub film: wgpu::RenderPipeline,
    pub drops: wgpu::RenderPipeline,
}

/// Everything of the pass that lives as long as the device.
#[derive(Debug)]
pub struct LensGpu {
    shader: wgpu::ShaderModule,
    pub(super) shrink_layout: wgpu::BindGroupLayout,
    pub(super) layout: wgpu::BindGroupLayout,
    pub(super) shrink: wgpu::RenderPipeline,
    pub(super) made: HashMap<wgpu::TextureFormat, Pipelines>,
    pub(super) sampler: wgpu::Sampler,
}

fn pipeline(
    device: &wgpu::Device,
    shader: &wgpu::ShaderModule,
    layout: &wgpu::BindGroupLayout,
    [vertex, fragment]: [&str; 2],
    format: wgpu::TextureFormat,
    blend: Option<wgpu::BlendState>,
) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("rain lens"),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("rain lens"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: shader,
            entry_point: Some(vertex),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: shader,
            entry_point: Some(fragment),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format,
                blend,
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

impl LensGpu {
    /// Builds what all targets share.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let filtered = wgpu::TextureSampleType::Float { filterable: true };
        let sampler_entry = wgpu::BindGroupLayoutEntry {
            binding: 4,
            visibility: fragment,
            ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
            count: None,
        };
        let scene = texture_entry(2, fragment, filtered, wgpu::TextureViewDimension::D2);
        let params = params_entry(device, 0, both, size_of::<LensView>());
        let shrink_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("rain lens shrink"),
            entries: &[params, scene, sampler_entry],
        });
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("rain lens"),
            entries: &[
                params,
                storage_entry(1, both, true),
                scene,
                texture_entry(3, fragment, filtered, wgpu::TextureViewDimension::D2),
                sampler_entry,
            ],
        });
        let shader = compose::shader(device, "lens");
        let entries = ["cover_all", "shrink"];
        let shrink = pipeline(device, &shader, &shrink_layout, entries, SMALL_FORMAT, None);
        Self {
            shader,
            shrink_layout,
            layout,
            shrink,
            made: HashMap::new(),
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("rain lens"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
        }
    }

    /// Makes sure that pipelines for targets of `format` exist.
    pub fn prepare_pipelines(&mut self, device: &wgpu::Device, format: wgpu::TextureFormat) {
        if self.made.contains_key(&format) {
            return;
        }
        let add = |src_factor, dst_factor| wgpu::BlendComponent {
            src_factor,
            dst_factor,
            operation: wgpu::BlendOperation::Add,
        };
        let over = wgpu::BlendState {
            color: add(wgpu::BlendFactor::One, wgpu::BlendFactor::OneMinusSrcAlpha),
            // The target's own alpha stays what the scene made it.
            alpha: add(wgpu::BlendFactor::Zero, wgpu::BlendFactor::One),
        };
        let make = |entries, blend| pipeline(device, &self.shader, &self.layout, entries, format, blend);
        let made = Pipelines {
            film: make(["cover_all", "film"], None),
            drops: make(["drop_vertex", "drop_colour"], Some(over)),
        };
        self.made.insert(format, made);
    }
}

/// What a view owns.
#[derive(Debug)]
pub struct LensViewGpu {
    pub(super) params: wgpu::Buffer,
    pub(super) drops: wgpu::Buffer,
    pub(super) small: wgpu::Texture,
    pub(super) count: u32,
    pub(super) viewport: [f32; 4],
}

impl LensViewGpu {
    /// A view without drops.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let buffer = |label, bytes: usize, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes as u64,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        Self {
            params: buffer("rain lens view", size_of::<LensView>(), PARAMS),
            drops: buffer(
                "rain lens drops",
                MAX_GLASS_DROPS * size_of::<LensDrop>(),
                wgpu::BufferUsages::STORAGE,
            ),
            small: small(device, [1, 1]),
            count: 0,
            viewport: [0.0; 4],
        }
    }

    /// Uploads this frame's glass; drops beyond [`MAX_GLASS_DROPS`] are left out.
    pub fn prepare(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, input: &LensInput) {
        let view = input.view();
        let drops = &input.drops[..input.drops.len().min(MAX_GLASS_DROPS)];
        queue.write_buffer(&self.params, 0, bytemuck::bytes_of(&view));
        queue.write_buffer(&self.drops, 0, bytemuck::cast_slice(drops));
        self.count = drops.len() as u32;
        self.viewport = view.viewport;
        let size = [input.viewport_px.z, input.viewport_px.w].map(|side| side.div_ceil(8).max(1));
        if size != [self.small.width(), self.small.height()] {
            self.small = small(device, size);
        }
    }

    /// GPU memory of this view. Units: bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        let texels = self.small.width() as usize * self.small.height() as usize;
        size_of::<LensView>() + MAX_GLASS_DROPS * size_of::<LensDrop>() + 8 * texels
    }
}

fn small(device: &wgpu::Device, [width, height]: [u32; 2]) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("rain lens small"),
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: SMALL_FORMAT,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    })
}
