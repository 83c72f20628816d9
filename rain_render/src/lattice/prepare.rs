//! Pipelines that live with the device, buffers that live with a view.

use rain_core::rainfall::Card;

use super::params::LatticeInput;
use crate::bindings::{linear_sampler, one_texel, params_entry, sampler_entry, storage_entry, texture_entry};
use crate::gpu_types::LatticeParams;
use crate::overlay::Overlay;
use crate::params_space::PARAMS;
use crate::rainfall::{DEPTH_FORMAT, RainfallTextures};
use crate::streak_textures::StreakArray;

/// Everything of the pass that lives as long as the device.
#[derive(Debug)]
pub struct LatticeGpu {
    pub(super) draw: Overlay,
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
        let draw = Overlay::new(
            device,
            "rain lattice",
            "lattice_draw",
            &[
                params_entry(device, 0, both, size_of::<LatticeParams>()),
                storage_entry(1, both, true),
                storage_entry(2, fragment, true),
                texture_entry(3, fragment, colour, wgpu::TextureViewDimension::D2Array),
                sampler_entry(4, fragment),
                texture_entry(5, fragment, depth, wgpu::TextureViewDimension::D2),
                texture_entry(6, fragment, depth, wgpu::TextureViewDimension::D2),
                texture_entry(7, vertex, colour, wgpu::TextureViewDimension::Cube),
                sampler_entry(8, vertex),
            ],
        );
        Self {
            draw,
            no_depth: one_texel(device, "rain no depth", DEPTH_FORMAT, 1),
            no_environment: one_texel(device, "rain no environment", wgpu::TextureFormat::Rgba8Unorm, 6),
            streak_sampler: linear_sampler(device, "rain streak textures", wgpu::AddressMode::Repeat),
            environment_sampler: linear_sampler(device, "rain environment", wgpu::AddressMode::ClampToEdge),
        }
    }

    /// Makes sure that the draw pipelines for a target exist; `coverage` asks for the mask's as well, `behind` for those of
    /// what lies behind glass.
    pub fn prepare_pipelines(
        &mut self,
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        samples: u32,
        coverage: bool,
        behind: bool,
    ) {
        self.draw.prepare_all(device, format, samples, coverage, behind);
    }
}

/// Buffers and bindings of one view; grown, never shrunk.
#[derive(Debug)]
pub struct LatticeViewGpu {
    params: wgpu::Buffer,
    cards: wgpu::Buffer,
    units: wgpu::Buffer,
    /// Textures whose units are uploaded.
    units_of: Option<u64>,
    capacity: usize,
    pub(super) count: u32,
    pub(super) panes: u32,
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
            params: buffer("rain lattice view", size_of::<LatticeParams>(), PARAMS),
            cards: buffer("rain cards", CAPACITY * size_of::<Card>(), wgpu::BufferUsages::STORAGE),
            units: buffer(
                "rain streak texture units",
                4 * rain_core::rainfall::MAX_STREAK_LAYERS,
                wgpu::BufferUsages::STORAGE,
            ),
            units_of: None,
            capacity: CAPACITY,
            count: 0,
            panes: 0,
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
        if input.cards.len() > self.capacity {
            self.capacity = input.cards.len().next_power_of_two();
            self.cards = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("rain cards"),
                size: (self.capacity * size_of::<Card>()) as u64,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
        }
        let params = input.params(textures.scene_depth.is_some());
        self.panes = params.panes;
        queue.write_buffer(&self.params, 0, bytemuck::bytes_of(&params));
        if !input.cards.is_empty() {
            queue.write_buffer(&self.cards, 0, bytemuck::cast_slice(input.cards));
        }
        if self.units_of != Some(streaks.key()) {
            let units: Vec<f32> = streaks.layers().iter().map(|layer| layer.unit as f32).collect();
            queue.write_buffer(&self.units, 0, bytemuck::cast_slice(&units));
            self.units_of = Some(streaks.key());
        }
        let resources = [
            self.params.as_entire_binding(),
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
            layout: &gpu.draw.layout,
            entries: &entries,
        }));
    }

    /// Number of cards uploaded for this frame.
    #[must_use]
    pub fn cards(&self) -> u32 {
        self.count
    }

    /// How much that is transparent this frame tells apart.
    #[must_use]
    pub fn panes(&self) -> u32 {
        self.panes
    }

    /// GPU memory of this view. Units: bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        size_of::<LatticeParams>() + self.units.size() as usize + self.capacity * size_of::<Card>()
    }
}
