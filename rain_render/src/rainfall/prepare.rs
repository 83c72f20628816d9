//! Pipelines that live with the device, buffers that live with a view.

use crate::bindings::{linear_sampler, one_texel, sampler_entry, storage_entry, texture_entry, uniform_entry};
use crate::gpu_types::{RainfallView, Streak};
use crate::overlay::{Overlay, OverlayKey};
use crate::quad_indices::QuadIndices;
use crate::rainfall::RainfallInput;
use crate::rainfall::near::near_drops;
use crate::rainfall::project::{Project, ProjectKey};

/// Format of the coverage mask: blendable everywhere.
pub const COVERAGE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;

/// Format of the depth the rain is tested against.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Everything of the pass that lives as long as the device.
#[derive(Debug)]
pub struct RainfallGpu {
    pub(super) project: Project,
    pub(super) draw: Overlay,
    pub(super) near: Overlay,
    pub(super) quads: QuadIndices,
    no_depth: wgpu::TextureView,
    no_environment: wgpu::TextureView,
    sampler: wgpu::Sampler,
}

/// How a view's streaks are drawn; by default their light alone, against a hard depth test.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub struct StreakDraws {
    /// Their coverage as well, into a [`COVERAGE_FORMAT`] target.
    pub coverage: bool,
    /// Those behind glass apart.
    pub behind: bool,
    /// They fade where they meet the scene, whose depth the view reads.
    pub soft: bool,
    /// Near ones have patterns.
    pub patterned: bool,
}

/// Textures of the host that a view reads. `None`: open sky, no soft fade, no environment.
#[derive(Debug, Default, Clone, Copy)]
pub struct RainfallTextures<'a> {
    /// Depth map along the rain.
    pub cover: Option<&'a wgpu::TextureView>,
    /// Single-sampled depth of the scene, for the soft fade.
    pub scene_depth: Option<&'a wgpu::TextureView>,
    /// Prefiltered cube map.
    pub environment: Option<&'a wgpu::TextureView>,
}

/// Buffers and bind groups of one view; grown, never shrunk.
#[derive(Debug)]
pub struct RainfallViewGpu {
    uniform: wgpu::Buffer,
    records: wgpu::Buffer,
    streaks: wgpu::Buffer,
    capacity: usize,
    pub(super) drops: u32,
    pub(super) panes: u32,
    /// Streaks fade where they meet the scene.
    pub(super) soft: bool,
    /// Which records may have a streak with a pattern, and as many words for them.
    pub(super) near_drops: Vec<u32>,
    near_list: wgpu::Buffer,
    pub(super) needs: ProjectKey,
    pub(super) project: Option<wgpu::BindGroup>,
    pub(super) draw: Option<wgpu::BindGroup>,
    pub(super) near: Option<wgpu::BindGroup>,
}

impl RainfallGpu {
    /// Builds the layouts.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let depth = wgpu::TextureSampleType::Depth;
        let raster = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let even = [
            uniform_entry(0, raster, size_of::<RainfallView>()),
            storage_entry(1, raster, true),
            texture_entry(2, raster, depth, wgpu::TextureViewDimension::D2),
        ];
        let draw = Overlay::new(device, "rain rainfall draw", "rainfall_draw", &even)
            .with_constants(|key| vec![("SOFT", f64::from(key.soft)), ("COVERAGE", f64::from(key.coverage))]);
        let [view, streaks, scene] = even;
        let near = Overlay::new(
            device,
            "rain rainfall near",
            "rainfall_near",
            &[
                view,
                streaks,
                scene,
                storage_entry(3, wgpu::ShaderStages::FRAGMENT, true),
                texture_entry(
                    4,
                    wgpu::ShaderStages::FRAGMENT,
                    wgpu::TextureSampleType::Float { filterable: true },
                    wgpu::TextureViewDimension::Cube,
                ),
                sampler_entry(5, wgpu::ShaderStages::FRAGMENT),
                storage_entry(6, wgpu::ShaderStages::VERTEX, true),
            ],
        );
        Self {
            project: Project::new(device),
            draw,
            near,
            quads: QuadIndices::new(device),
            no_depth: one_texel(device, "rain no depth", DEPTH_FORMAT, 1),
            no_environment: one_texel(device, "rain no environment", wgpu::TextureFormat::Rgba8Unorm, 6),
            sampler: linear_sampler(device, "rain environment", wgpu::AddressMode::ClampToEdge),
        }
    }

    /// Makes sure that the pipelines exist that draw so over a target of `format` with `samples` samples.
    pub fn prepare_pipelines(
        &mut self,
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        samples: u32,
        draws: StreakDraws,
    ) {
        let colour = OverlayKey::colour(format, samples);
        let mask = draws.coverage.then(|| OverlayKey::coverage(samples));
        for key in [Some(colour), mask].into_iter().flatten() {
            for key in [Some(key), draws.behind.then(|| key.behind())].into_iter().flatten() {
                self.draw.prepare(device, key.soft(draws.soft));
                if draws.patterned {
                    self.near.prepare(device, key);
                }
            }
        }
    }
}

impl RainfallViewGpu {
    /// Buffers for a view, empty.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let (records, streaks) = Self::buffers(device, 1024);
        let near_list = Self::list(device, 64);
        Self {
            uniform: device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("rain rainfall view"),
                size: size_of::<RainfallView>() as u64,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
            records,
            streaks,
            capacity: 1024,
            drops: 0,
            panes: 0,
            soft: false,
            near_drops: Vec::new(),
            near_list,
            needs: ProjectKey::default(),
            project: None,
            draw: None,
            near: None,
        }
    }

    fn list(device: &wgpu::Device, words: usize) -> wgpu::Buffer {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("rain near drops"),
            size: 4 * words as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    }

    fn buffers(device: &wgpu::Device, capacity: usize) -> (wgpu::Buffer, wgpu::Buffer) {
        let buffer = |label, bytes: usize, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes as u64,
                usage: wgpu::BufferUsages::STORAGE | usage,
                mapped_at_creation: false,
            })
        };
        (
            buffer("rain drop records", capacity * 8, wgpu::BufferUsages::COPY_DST),
            buffer(
                "rain streaks",
                capacity * size_of::<Streak>(),
                wgpu::BufferUsages::COPY_SRC,
            ),
        )
    }

    /// Uploads a view's inputs and binds its textures. Call once a frame, before encoding.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        gpu: &RainfallGpu,
        input: &RainfallInput,
        textures: RainfallTextures,
    ) {
        let records = &input.container.records;
        self.drops = records.len() as u32;
        let uniform = input.uniform();
        self.panes = uniform.panes;
        self.soft = uniform.soft > 0.0;
        self.needs = ProjectKey::of(input, &uniform);
        gpu.project.prepare(device, self.needs);
        near_drops(input, &mut self.near_drops);
        if records.len() > self.capacity {
            self.capacity = records.len().next_power_of_two();
            (self.records, self.streaks) = Self::buffers(device, self.capacity);
        }
        queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
        if 4 * self.near_drops.len() as u64 > self.near_list.size() {
            self.near_list = Self::list(device, self.near_drops.len().next_power_of_two());
        }
        if !self.near_drops.is_empty() {
            queue.write_buffer(&self.near_list, 0, bytemuck::cast_slice(&self.near_drops));
        }
        if !records.is_empty() {
            queue.write_buffer(&self.records, 0, bytemuck::cast_slice(records));
        }
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let view =
            |texture: Option<&wgpu::TextureView>, fallback: &wgpu::TextureView| texture.unwrap_or(fallback).clone();
        let cover = view(textures.cover, &gpu.no_depth);
        let scene = view(textures.scene_depth, &gpu.no_depth);
        let environment = view(textures.environment, &gpu.no_environment);
        self.project = Some(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("rain rainfall project"),
            layout: &gpu.project.layout,
            entries: &[
                entry(0, self.uniform.as_entire_binding()),
                entry(1, self.records.as_entire_binding()),
                entry(2, self.streaks.as_entire_binding()),
                entry(3, wgpu::BindingResource::TextureView(&cover)),
                entry(4, wgpu::BindingResource::TextureView(&environment)),
                entry(5, wgpu::BindingResource::Sampler(&gpu.sampler)),
            ],
        }));
        let even = [
            entry(0, self.uniform.as_entire_binding()),
            entry(1, self.streaks.as_entire_binding()),
            entry(2, wgpu::BindingResource::TextureView(&scene)),
        ];
        self.draw = Some(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("rain rainfall draw"),
            layout: &gpu.draw.layout,
            entries: &even,
        }));
        let [uniform, streaks, depth] = even;
        self.near = Some(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("rain rainfall near"),
            layout: &gpu.near.layout,
            entries: &[
                uniform,
                streaks,
                depth,
                entry(3, self.records.as_entire_binding()),
                entry(4, wgpu::BindingResource::TextureView(&environment)),
                entry(5, wgpu::BindingResource::Sampler(&gpu.sampler)),
                entry(6, self.near_list.as_entire_binding()),
            ],
        }));
    }

    /// Number of drops uploaded for this frame.
    #[must_use]
    pub fn drops(&self) -> u32 {
        self.drops
    }

    /// How much that is transparent this frame tells apart.
    #[must_use]
    pub fn panes(&self) -> u32 {
        self.panes
    }

    /// GPU memory of this view. Units: bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        size_of::<RainfallView>() + self.capacity * (8 + size_of::<Streak>()) + self.near_list.size() as usize
    }

    /// The projected streaks, for reading back.
    #[must_use]
    pub fn streaks(&self) -> &wgpu::Buffer {
        &self.streaks
    }
}
