//! Pipelines that live with the device, buffers that live with a view.

use std::collections::HashMap;

use rain_core::rainfall::Card;

use super::params::LatticeInput;
use crate::bindings::{one_texel, storage_entry, texture_entry, uniform_entry};
use crate::compose;
use crate::gpu_types::LatticeParams;
use crate::rainfall::{COVERAGE_FORMAT, DEPTH_FORMAT, RainfallTextures};
use crate::streak_textures::StreakArray;

/// What pipelines differ by: target, samples, coverage instead of colour, the scene's depth read instead of tested.
pub(super) type DrawKey = (wgpu::TextureFormat, u32, bool, bool);

/// Everything of the pass that lives as long as the device.
#[derive(Debug)]
pub struct LatticeGpu {
    layout: wgpu::BindGroupLayout,
    pipeline_layout: wgpu::PipelineLayout,
    shader: wgpu::ShaderModule,
    pub(super) pipelines: HashMap<DrawKey, wgpu::RenderPipeline>,
    no_depth: wgpu::TextureView,
    no_environment: wgpu::TextureView,
    streak_sampler: wgpu::Sampler,
    environment_sampler: wgpu::Sampler,
}

impl LatticeGpu {
    /// Builds the layout.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let (vertex, fragment) = (wgpu::ShaderStages::VERTEX, wgpu::ShaderStages::FRAGMENT);
        let depth = wgpu::TextureSampleType::Depth;
        let colour = wgpu::TextureSampleType::Float { filterable: true };
        let sampler_entry = |binding, visibility| wgpu::BindGroupLayoutEntry {
            binding,
            visibility,
            ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
            count: None,
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("rain lattice"),
            entries: &[
                uniform_entry(0, both, size_of::<LatticeParams>()),
                storage_entry(1, both, true),
                storage_entry(2, fragment, true),
                texture_entry(3, fragment, colour, wgpu::TextureViewDimension::D2Array),
                sampler_entry(4, fragment),
                texture_entry(5, fragment, depth, wgpu::TextureViewDimension::D2),
                texture_entry(6, fragment, depth, wgpu::TextureViewDimension::D2),
                texture_entry(7, vertex, colour, wgpu::TextureViewDimension::Cube),
                sampler_entry(8, vertex),
            ],
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("rain lattice"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let sampler = |label, address| {
            device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some(label),
                address_mode_u: address,
                address_mode_v: address,
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                mipmap_filter: wgpu::MipmapFilterMode::Linear,
                ..Default::default()
            })
        };
        Self {
            layout,
            pipeline_layout,
            shader: compose::shader(device, "lattice_draw"),
            pipelines: HashMap::new(),
            no_depth: one_texel(device, "rain no depth", DEPTH_FORMAT, 1),
            no_environment: one_texel(device, "rain no environment", wgpu::TextureFormat::Rgba8Unorm, 6),
            streak_sampler: sampler("rain streak textures", wgpu::AddressMode::Repeat),
            environment_sampler: sampler("rain environment", wgpu::AddressMode::ClampToEdge),
        }
    }

    /// Makes sure that the pipelines for a target exist; `coverage` asks for the mask's as well.
    pub fn prepare_pipelines(
        &mut self,
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        samples: u32,
        coverage: bool,
    ) {
        for soft in [false, true] {
            let mut keys = vec![(format, samples, false, soft)];
            if coverage {
                keys.push((COVERAGE_FORMAT, samples, true, soft));
            }
            for key in keys {
                if !self.pipelines.contains_key(&key) {
                    let pipeline = self.pipeline(device, key);
                    self.pipelines.insert(key, pipeline);
                }
            }
        }
    }

    fn pipeline(&self, device: &wgpu::Device, (format, samples, coverage, soft): DrawKey) -> wgpu::RenderPipeline {
        let over = |src_factor, dst_factor| wgpu::BlendComponent {
            src_factor,
            dst_factor,
            operation: wgpu::BlendOperation::Add,
        };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("rain lattice"),
            layout: Some(&self.pipeline_layout),
            vertex: wgpu::VertexState {
                module: &self.shader,
                entry_point: Some("vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(false),
                // Half of a cell may lie before a wall that its middle is behind.
                depth_compare: Some(if soft {
                    wgpu::CompareFunction::Always
                } else {
                    wgpu::CompareFunction::GreaterEqual
                }),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState {
                count: samples,
                ..Default::default()
            },
            fragment: Some(wgpu::FragmentState {
                module: &self.shader,
                entry_point: Some(if coverage { "coverage" } else { "colour" }),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format,
                    blend: Some(wgpu::BlendState {
                        color: over(wgpu::BlendFactor::One, wgpu::BlendFactor::OneMinusSrcAlpha),
                        // The target's own alpha stays what the scene made it.
                        alpha: over(wgpu::BlendFactor::Zero, wgpu::BlendFactor::One),
                    }),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// Buffers and bindings of one view; grown, never shrunk.
#[derive(Debug)]
pub struct LatticeViewGpu {
    uniform: wgpu::Buffer,
    cards: wgpu::Buffer,
    units: wgpu::Buffer,
    /// Textures whose units are uploaded.
    units_of: Option<u64>,
    capacity: usize,
    pub(super) count: u32,
    pub(super) soft: bool,
    pub(super) group: Option<wgpu::BindGroup>,
}

impl LatticeViewGpu {
    /// Buffers for a view, empty.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        const CAPACITY: usize = 1024;
        let buffer = |label, bytes: usize, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes as u64,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        Self {
            uniform: buffer(
                "rain lattice view",
                size_of::<LatticeParams>(),
                wgpu::BufferUsages::UNIFORM,
            ),
            cards: buffer("rain cards", CAPACITY * size_of::<Card>(), wgpu::BufferUsages::STORAGE),
            units: buffer(
                "rain streak texture units",
                4 * rain_core::rainfall::MAX_STREAK_LAYERS,
                wgpu::BufferUsages::STORAGE,
            ),
            units_of: None,
            capacity: CAPACITY,
            count: 0,
            soft: false,
            group: None,
        }
    }

    /// Uploads a view's cards and binds its textures. Call once a frame, before encoding. Cards are of `textures`.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        gpu: &LatticeGpu,
        input: &LatticeInput,
        streaks: &StreakArray,
        textures: RainfallTextures,
    ) {
        self.count = input.cards.len() as u32;
        self.soft = textures.scene_depth.is_some();
        if input.cards.len() > self.capacity {
            self.capacity = input.cards.len().next_power_of_two();
            self.cards = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("rain cards"),
                size: (self.capacity * size_of::<Card>()) as u64,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
        }
        queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&input.uniform(self.soft)));
        if !input.cards.is_empty() {
            queue.write_buffer(&self.cards, 0, bytemuck::cast_slice(input.cards));
        }
        if self.units_of != Some(streaks.key()) {
            let units: Vec<f32> = streaks.layers().iter().map(|layer| layer.unit as f32).collect();
            queue.write_buffer(&self.units, 0, bytemuck::cast_slice(&units));
            self.units_of = Some(streaks.key());
        }
        let resources = [
            self.uniform.as_entire_binding(),
            self.cards.as_entire_binding(),
            self.units.as_entire_binding(),
            wgpu::BindingResource::TextureView(streaks.view()),
            wgpu::BindingResource::Sampler(&gpu.streak_sampler),
            wgpu::BindingResource::TextureView(textures.scene_depth.unwrap_or(&gpu.no_depth)),
            wgpu::BindingResource::TextureView(textures.cover.unwrap_or(&gpu.no_depth)),
            wgpu::BindingResource::TextureView(textures.environment.unwrap_or(&gpu.no_environment)),
            wgpu::BindingResource::Sampler(&gpu.environment_sampler),
        ];
        let entries: Vec<wgpu::BindGroupEntry> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        self.group = Some(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("rain lattice"),
            layout: &gpu.layout,
            entries: &entries,
        }));
    }

    /// Number of cards uploaded for this frame.
    #[must_use]
    pub fn cards(&self) -> u32 {
        self.count
    }

    /// GPU memory of this view. Units: bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        size_of::<LatticeParams>() + self.units.size() as usize + self.capacity * size_of::<Card>()
    }
}
