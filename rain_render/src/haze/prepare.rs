//! Pipelines that live with the device, buffers that live with a view.

use std::collections::HashMap;

use rain_core::rainfall::areas::MAX_PACKED_ROWS;

use super::HazeInput;
use crate::bindings::{
    compute_pipeline, linear_sampler, one_texel, sampler_entry, storage_entry, texture_entry, uniform_entry,
};
use crate::compose::{self, HAZE_AZIMUTHS, HAZE_INTERVALS};
use crate::gpu_types::HazeView;

/// What draw pipelines differ by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct HazeKey {
    format: wgpu::TextureFormat,
    samples: u32,
    /// What is obscured instead of colour.
    coverage: bool,
}

impl HazeKey {
    pub(super) fn colour(format: wgpu::TextureFormat, samples: u32) -> Self {
        Self {
            format,
            samples,
            coverage: false,
        }
    }

    pub(super) fn coverage(format: wgpu::TextureFormat) -> Self {
        Self {
            format,
            samples: 1,
            coverage: true,
        }
    }
}

/// Shader and layout for a scene's depth with one or with more samples.
#[derive(Debug)]
struct Sampled {
    layout: wgpu::BindGroupLayout,
    pipeline_layout: wgpu::PipelineLayout,
    shader: wgpu::ShaderModule,
}

/// Everything of the pass that lives as long as the device.
#[derive(Debug)]
pub struct HazeGpu {
    areas_layout: wgpu::BindGroupLayout,
    pub(super) spread: wgpu::ComputePipeline,
    pub(super) add: wgpu::ComputePipeline,
    single: Sampled,
    several: Option<Sampled>,
    pub(super) draw: HashMap<HazeKey, wgpu::RenderPipeline>,
    no_environment: wgpu::TextureView,
    sampler: wgpu::Sampler,
}

/// Textures of the host that a view reads.
#[derive(Debug, Clone, Copy)]
pub struct HazeTextures<'a> {
    /// Depth of the scene, with as many samples as the target.
    pub scene_depth: &'a wgpu::TextureView,
    /// Prefiltered cube map; `None`: none.
    pub environment: Option<&'a wgpu::TextureView>,
}

/// Buffers and bind groups of one view.
#[derive(Debug)]
pub struct HazeViewGpu {
    uniform: wgpu::Buffer,
    rows: wgpu::Buffer,
    grid: wgpu::Buffer,
    pub(super) uneven: bool,
    pub(super) areas: Option<wgpu::BindGroup>,
    pub(super) draw: Option<wgpu::BindGroup>,
}

const GRID_BYTES: usize = HAZE_AZIMUTHS as usize * (HAZE_INTERVALS as usize + 1) * 4;
const ROWS_BYTES: usize = (MAX_PACKED_ROWS + 1) * 16;

impl Sampled {
    fn new(device: &wgpu::Device, multisampled: bool) -> Self {
        let raster = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let mut depth = texture_entry(
            2,
            raster,
            wgpu::TextureSampleType::Depth,
            wgpu::TextureViewDimension::D2,
        );
        if let wgpu::BindingType::Texture {
            multisampled: several, ..
        } = &mut depth.ty
        {
            *several = multisampled;
        }
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("rain haze"),
            entries: &[
                uniform_entry(0, raster, size_of::<HazeView>()),
                storage_entry(1, fragment, true),
                depth,
                texture_entry(
                    3,
                    fragment,
                    wgpu::TextureSampleType::Float { filterable: true },
                    wgpu::TextureViewDimension::Cube,
                ),
                sampler_entry(4, fragment),
            ],
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("rain haze"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let source = if multisampled {
            compose::haze_of_samples()
        } else {
            compose::module("haze")
        };
        Self {
            layout,
            pipeline_layout,
            shader: device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("haze"),
                source: wgpu::ShaderSource::Wgsl(source.into()),
            }),
        }
    }
}

impl HazeGpu {
    /// Builds the layouts and the pipelines of the areas' grid.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let areas_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("rain haze areas"),
            entries: &[
                uniform_entry(0, compute, size_of::<HazeView>()),
                storage_entry(1, compute, true),
                storage_entry(2, compute, false),
            ],
        });
        let module = compose::shader(device, "haze_areas");
        let pipeline = |entry: &str| compute_pipeline(device, "rain haze areas", &module, entry, &[&areas_layout]);
        let (spread, add) = (pipeline("spread"), pipeline("add"));
        Self {
            areas_layout,
            spread,
            add,
            single: Sampled::new(device, false),
            several: None,
            draw: HashMap::new(),
            no_environment: one_texel(device, "rain no environment", wgpu::TextureFormat::Rgba8Unorm, 6),
            sampler: linear_sampler(device, "rain environment", wgpu::AddressMode::ClampToEdge),
        }
    }

    /// Makes sure that the pipeline for a target exists; `coverage` asks for the mask's as well.
    pub fn prepare_pipelines(
        &mut self,
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        samples: u32,
        coverage: bool,
    ) {
        if samples > 1 && self.several.is_none() {
            self.several = Some(Sampled::new(device, true));
        }
        let mut keys = vec![HazeKey::colour(format, samples)];
        if coverage && samples == 1 {
            keys.push(HazeKey::coverage(crate::rainfall::COVERAGE_FORMAT));
        }
        for key in keys {
            if !self.draw.contains_key(&key) {
                let pipeline = pipeline(device, self.sampled(key.samples), key);
                self.draw.insert(key, pipeline);
            }
        }
    }

    fn sampled(&self, samples: u32) -> &Sampled {
        self.several.as_ref().filter(|_| samples > 1).unwrap_or(&self.single)
    }
}

fn pipeline(device: &wgpu::Device, sampled: &Sampled, key: HazeKey) -> wgpu::RenderPipeline {
    let add = |src_factor, dst_factor| wgpu::BlendComponent {
        src_factor,
        dst_factor,
        operation: wgpu::BlendOperation::Add,
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("rain haze"),
        layout: Some(&sampled.pipeline_layout),
        vertex: wgpu::VertexState {
            module: &sampled.shader,
            entry_point: Some("vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState {
            count: key.samples,
            ..Default::default()
        },
        fragment: Some(wgpu::FragmentState {
            module: &sampled.shader,
            entry_point: Some(if key.coverage { "coverage" } else { "colour" }),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: key.format,
                blend: Some(wgpu::BlendState {
                    color: add(wgpu::BlendFactor::One, wgpu::BlendFactor::OneMinusSrcAlpha),
                    // The target's own alpha stays what the scene made it.
                    alpha: add(wgpu::BlendFactor::Zero, wgpu::BlendFactor::One),
                }),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

impl HazeViewGpu {
    /// Buffers for a view, empty.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let buffer = |label: &str, bytes: usize, usage: wgpu::BufferUsages| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes as u64,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        Self {
            uniform: buffer("rain haze view", size_of::<HazeView>(), wgpu::BufferUsages::UNIFORM),
            rows: buffer("rain haze areas", ROWS_BYTES, wgpu::BufferUsages::STORAGE),
            grid: buffer(
                "rain haze grid",
                GRID_BYTES,
                wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            ),
            uneven: false,
            areas: None,
            draw: None,
        }
    }

    /// Uploads a view's inputs and binds its textures. Call once a frame, before encoding; `samples` is that of the depth.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        gpu: &HazeGpu,
        input: &HazeInput,
        textures: HazeTextures,
        samples: u32,
    ) {
        queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&input.uniform()));
        self.uneven = input.areas.is_some();
        if let Some(areas) = &input.areas {
            let head = [[areas.packed.areas as f32, areas.packed.outside, areas.weather_mm_h, 0.0]];
            queue.write_buffer(&self.rows, 0, bytemuck::cast_slice(&head));
            queue.write_buffer(&self.rows, 16, bytemuck::cast_slice(&areas.packed.rows));
        }
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        if self.areas.is_none() {
            self.areas = Some(device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("rain haze areas"),
                layout: &gpu.areas_layout,
                entries: &[
                    entry(0, self.uniform.as_entire_binding()),
                    entry(1, self.rows.as_entire_binding()),
                    entry(2, self.grid.as_entire_binding()),
                ],
            }));
        }
        let environment = textures.environment.unwrap_or(&gpu.no_environment);
        self.draw = Some(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("rain haze"),
            layout: &gpu.sampled(samples).layout,
            entries: &[
                entry(0, self.uniform.as_entire_binding()),
                entry(1, self.grid.as_entire_binding()),
                entry(2, wgpu::BindingResource::TextureView(textures.scene_depth)),
                entry(3, wgpu::BindingResource::TextureView(environment)),
                entry(4, wgpu::BindingResource::Sampler(&gpu.sampler)),
            ],
        }));
    }

    /// Whether areas divide the rain of this view.
    #[must_use]
    pub fn uneven(&self) -> bool {
        self.uneven
    }

    /// GPU memory of this view. Units: bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        size_of::<HazeView>() + ROWS_BYTES + GRID_BYTES
    }
}
