//! Pipelines that live with the device, buffers that live with a view.

use rain_core::rainfall::FarParticle;

use super::params::FarRainInput;
use crate::bindings::{linear_sampler, one_texel, params_entry, sampler_entry, storage_entry, texture_entry};
use crate::gpu_types::FarRainParams;
use crate::overlay::{Overlay, OverlayKey};
use crate::params_space::PARAMS;

/// Everything of the pass that lives as long as the device.
#[derive(Debug)]
pub struct FarRainGpu {
    pub(super) draw: Overlay,
    no_environment: wgpu::TextureView,
    sampler: wgpu::Sampler,
}

impl FarRainGpu {
    /// Builds the layout.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let vertex = wgpu::ShaderStages::VERTEX;
        let draw = Overlay::new(
            device,
            "far rain",
            "far_rain",
            &[
                params_entry(device, 0, both, size_of::<FarRainParams>()),
                storage_entry(1, vertex, true),
                texture_entry(
                    2,
                    vertex,
                    wgpu::TextureSampleType::Float { filterable: true },
                    wgpu::TextureViewDimension::Cube,
                ),
                sampler_entry(3, vertex),
            ],
        );
        Self {
            draw,
            no_environment: one_texel(device, "rain no environment", wgpu::TextureFormat::Rgba8Unorm, 6),
            sampler: linear_sampler(device, "rain environment", wgpu::AddressMode::ClampToEdge),
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
        self.draw.prepare(device, OverlayKey::colour(format, samples));
        if coverage {
            self.draw.prepare(device, OverlayKey::coverage(samples));
        }
    }
}

/// Buffers and bindings of one view; grown, never shrunk.
#[derive(Debug)]
pub struct FarRainViewGpu {
    params: wgpu::Buffer,
    particles: wgpu::Buffer,
    capacity: usize,
    pub(super) count: u32,
    pub(super) group: Option<wgpu::BindGroup>,
}

fn particle_buffer(device: &wgpu::Device, capacity: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("far rain particles"),
        size: (capacity * size_of::<FarParticle>()) as u64,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

impl FarRainViewGpu {
    /// Buffers for a view, empty.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        const CAPACITY: usize = 4096;
        Self {
            params: device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("far rain view"),
                size: size_of::<FarRainParams>() as u64,
                usage: PARAMS | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
            particles: particle_buffer(device, CAPACITY),
            capacity: CAPACITY,
            count: 0,
            group: None,
        }
    }

    /// Uploads a view's particles and binds its environment (a prefiltered cube map, if there is one). Call once a frame,
    /// before encoding.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        gpu: &FarRainGpu,
        input: &FarRainInput,
        environment: Option<&wgpu::TextureView>,
    ) {
        self.count = input.particles.len() as u32;
        if input.particles.len() > self.capacity {
            self.capacity = input.particles.len().next_power_of_two();
            self.particles = particle_buffer(device, self.capacity);
        }
        queue.write_buffer(&self.params, 0, bytemuck::bytes_of(&input.params()));
        queue.write_buffer(&self.particles, 0, bytemuck::cast_slice(input.particles));
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        self.group = Some(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("far rain"),
            layout: &gpu.draw.layout,
            entries: &[
                entry(0, self.params.as_entire_binding()),
                entry(1, self.particles.as_entire_binding()),
                entry(
                    2,
                    wgpu::BindingResource::TextureView(environment.unwrap_or(&gpu.no_environment)),
                ),
                entry(3, wgpu::BindingResource::Sampler(&gpu.sampler)),
            ],
        }));
    }

    /// Number of particles uploaded for this frame.
    #[must_use]
    pub fn particles(&self) -> u32 {
        self.count
    }

    /// GPU memory of this view. Units: bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        size_of::<FarRainParams>() + self.capacity * size_of::<FarParticle>()
    }
}
