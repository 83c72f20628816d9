//! Pipelines that live with the device, buffers that live with a view.

use crate::bindings::{
    compute_pipeline, linear_sampler, one_texel, params_entry, sampler_entry, storage_entry, texture_entry,
};
use crate::compose;
use crate::gpu_types::{SplashDraw, SplashFind, SplashPart, SplashView, SpoutMouth};
use crate::overlay::Overlay;
use crate::params_space::PARAMS;
use crate::rainfall::DEPTH_FORMAT;

use super::params::MAX_MOUTHS;
use super::{SplashInput, SpoutStream};

/// Everything of the pass that lives as long as the device.
#[derive(Debug)]
pub struct SplashGpu {
    make_layout: wgpu::BindGroupLayout,
    pub(super) find: wgpu::ComputePipeline,
    pub(super) add: wgpu::ComputePipeline,
    pub(super) sort: wgpu::ComputePipeline,
    pub(super) draw: Overlay,
    no_depth: wgpu::TextureView,
    no_environment: wgpu::TextureView,
    no_levels: wgpu::TextureView,
    sampler: wgpu::Sampler,
}

/// Textures of the host that a view reads. `None`: no ground (and so no splash), no soft fade, no environment, no
/// standing water.
#[derive(Debug, Default, Clone, Copy)]
pub struct SplashTextures<'a> {
    /// Depth map along the rain.
    pub cover: Option<&'a wgpu::TextureView>,
    /// Single-sampled depth of the scene, for the soft fade.
    pub scene_depth: Option<&'a wgpu::TextureView>,
    /// Prefiltered cube map.
    pub environment: Option<&'a wgpu::TextureView>,
    /// Levels of standing water.
    pub levels: Option<&'a wgpu::TextureView>,
}

/// Buffers and bind groups of one view; grown, never shrunk.
#[derive(Debug)]
pub struct SplashViewGpu {
    params: wgpu::Buffer,
    places: wgpu::Buffer,
    finds: wgpu::Buffer,
    parts: wgpu::Buffer,
    mouths: wgpu::Buffer,
    pub(super) arguments: wgpu::Buffer,
    cells: u32,
    capacity: u32,
    pub(super) invocations: u32,
    pub(super) room: u32,
    pub(super) panes: u32,
    pub(super) make: Option<wgpu::BindGroup>,
    pub(super) draw: Option<wgpu::BindGroup>,
}

impl SplashGpu {
    /// Builds the layouts and the pipelines that make splashes.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let depth = wgpu::TextureSampleType::Depth;
        let make_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("rain splash make"),
            entries: &[
                params_entry(device, 0, compute, size_of::<SplashView>()),
                storage_entry(1, compute, false),
                storage_entry(2, compute, false),
                storage_entry(3, compute, false),
                texture_entry(4, compute, depth, wgpu::TextureViewDimension::D2),
                texture_entry(
                    5,
                    compute,
                    wgpu::TextureSampleType::Float { filterable: true },
                    wgpu::TextureViewDimension::Cube,
                ),
                sampler_entry(6, compute),
                texture_entry(
                    7,
                    compute,
                    wgpu::TextureSampleType::Float { filterable: false },
                    wgpu::TextureViewDimension::D2,
                ),
                storage_entry(8, compute, false),
                storage_entry(9, compute, true),
            ],
        });
        let module = compose::shader(device, "splash_make");
        let pipeline = |entry: &str| compute_pipeline(device, "rain splash make", &module, entry, &[&make_layout]);
        let (find, add, sort) = (pipeline("find"), pipeline("add"), pipeline("sort"));
        let raster = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let draw = Overlay::new(
            device,
            "rain splash draw",
            "splash_draw",
            &[
                params_entry(device, 0, raster, size_of::<SplashView>()),
                storage_entry(1, wgpu::ShaderStages::VERTEX, true),
                texture_entry(2, wgpu::ShaderStages::FRAGMENT, depth, wgpu::TextureViewDimension::D2),
            ],
        );
        Self {
            make_layout,
            find,
            add,
            sort,
            draw,
            no_depth: one_texel(device, "rain no depth", DEPTH_FORMAT, 1),
            no_environment: one_texel(device, "rain no environment", wgpu::TextureFormat::Rgba8Unorm, 6),
            no_levels: one_texel(device, "rain no levels", wgpu::TextureFormat::R32Float, 1),
            sampler: linear_sampler(device, "rain environment", wgpu::AddressMode::ClampToEdge),
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

impl SplashViewGpu {
    /// Buffers for a view, empty.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let storage = wgpu::BufferUsages::STORAGE;
        Self {
            params: buffer(
                device,
                "rain splash view",
                size_of::<SplashView>(),
                PARAMS | wgpu::BufferUsages::COPY_DST,
            ),
            places: buffer(device, "rain splash places", 4, storage),
            finds: buffer(device, "rain splash finds", size_of::<SplashFind>(), storage),
            parts: buffer(device, "rain splash parts", size_of::<SplashPart>(), storage),
            arguments: buffer(
                device,
                "rain splash draw",
                size_of::<SplashDraw>(),
                storage | wgpu::BufferUsages::INDIRECT | wgpu::BufferUsages::COPY_SRC,
            ),
            mouths: buffer(
                device,
                "rain spout mouths",
                size_of::<SpoutMouth>(),
                storage | wgpu::BufferUsages::COPY_DST,
            ),
            cells: 1,
            capacity: 1,
            invocations: 0,
            room: 0,
            panes: 0,
            make: None,
            draw: None,
        }
    }

    /// Uploads a view's inputs and binds its textures. Call once a frame, before encoding.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        gpu: &SplashGpu,
        input: &SplashInput,
        textures: SplashTextures,
    ) {
        let storage = wgpu::BufferUsages::STORAGE;
        (self.invocations, self.room) = (input.invocations(), input.capacity);
        if self.invocations > self.cells {
            self.cells = self.invocations;
            self.places = buffer(device, "rain splash places", self.cells as usize * 4, storage);
        }
        if input.capacity > self.capacity {
            self.capacity = input.capacity;
            self.finds = buffer(
                device,
                "rain splash finds",
                self.capacity as usize * size_of::<SplashFind>(),
                storage,
            );
            self.parts = buffer(
                device,
                "rain splash parts",
                self.capacity as usize * size_of::<SplashPart>(),
                storage | wgpu::BufferUsages::COPY_SRC,
            );
        }
        let records: Vec<SpoutMouth> = input.mouths.iter().take(MAX_MOUTHS).map(SpoutStream::record).collect();
        let bytes: &[u8] = bytemuck::cast_slice(&records);
        if bytes.len() as u64 > self.mouths.size() {
            self.mouths = buffer(
                device,
                "rain spout mouths",
                bytes.len().next_power_of_two(),
                storage | wgpu::BufferUsages::COPY_DST,
            );
        }
        if !bytes.is_empty() {
            queue.write_buffer(&self.mouths, 0, bytes);
        }
        let params = input.params();
        self.panes = params.panes;
        queue.write_buffer(&self.params, 0, bytemuck::bytes_of(&params));
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let view =
            |texture: Option<&wgpu::TextureView>, fallback: &wgpu::TextureView| texture.unwrap_or(fallback).clone();
        let cover = view(textures.cover, &gpu.no_depth);
        let scene = view(textures.scene_depth, &gpu.no_depth);
        let environment = view(textures.environment, &gpu.no_environment);
        let levels = view(textures.levels, &gpu.no_levels);
        self.make = Some(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("rain splash make"),
            layout: &gpu.make_layout,
            entries: &[
                entry(0, self.params.as_entire_binding()),
                entry(1, self.places.as_entire_binding()),
                entry(2, self.parts.as_entire_binding()),
                entry(3, self.arguments.as_entire_binding()),
                entry(4, wgpu::BindingResource::TextureView(&cover)),
                entry(5, wgpu::BindingResource::TextureView(&environment)),
                entry(6, wgpu::BindingResource::Sampler(&gpu.sampler)),
                entry(7, wgpu::BindingResource::TextureView(&levels)),
                entry(8, self.finds.as_entire_binding()),
                entry(9, self.mouths.as_entire_binding()),
            ],
        }));
        self.draw = Some(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("rain splash draw"),
            layout: &gpu.draw.layout,
            entries: &[
                entry(0, self.params.as_entire_binding()),
                entry(1, self.parts.as_entire_binding()),
                entry(2, wgpu::BindingResource::TextureView(&scene)),
            ],
        }));
    }

    /// How much that is transparent this frame tells apart.
    #[must_use]
    pub fn panes(&self) -> u32 {
        self.panes
    }

    /// GPU memory of this view. Units: bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        size_of::<SplashView>()
            + size_of::<SplashDraw>()
            + self.mouths.size() as usize
            + self.cells as usize * 4
            + self.capacity as usize * (size_of::<SplashFind>() + size_of::<SplashPart>())
    }

    /// The crowns and drops that were made, for reading back.
    #[must_use]
    pub fn parts(&self) -> &wgpu::Buffer {
        &self.parts
    }

    /// The draw's arguments and how many parts there were ([`SplashDraw`]), for reading back.
    #[must_use]
    pub fn arguments(&self) -> &wgpu::Buffer {
        &self.arguments
    }
}

fn buffer(device: &wgpu::Device, label: &str, bytes: usize, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes as u64,
        usage,
        mapped_at_creation: false,
    })
}
