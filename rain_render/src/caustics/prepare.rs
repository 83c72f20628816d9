//! The pipelines, the buffer that rays are thrown into, the bindings.

use rain_core::waves::CAUSTIC_TEXELS;

use super::params::{CAUSTIC_FORMAT, CausticFrame};
use crate::bindings::{compute_pipeline, params_entry, storage_entry, storage_texture_entry, texture_entry};
use crate::compose;
use crate::gpu_types::CausticParams;
use crate::params_space::PARAMS;

/// Bindings of one slope map and one map of its light.
#[derive(Debug)]
struct Bound {
    slopes: wgpu::Texture,
    map: wgpu::Texture,
    group: wgpu::BindGroup,
}

/// Everything of the pass. Made when light is first thrown: it holds 1 MiB.
#[derive(Debug)]
pub struct CausticsGpu {
    layout: wgpu::BindGroupLayout,
    pub(super) send: wgpu::ComputePipeline,
    pub(super) gather: wgpu::ComputePipeline,
    sampler: wgpu::Sampler,
    params: wgpu::Buffer,
    pub(super) thrown: wgpu::Buffer,
    bound: Option<Bound>,
}

impl CausticsGpu {
    /// Builds the pipelines.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("rain caustics"),
            entries: &[
                params_entry(device, 0, compute, size_of::<CausticParams>()),
                texture_entry(
                    1,
                    compute,
                    wgpu::TextureSampleType::Float { filterable: true },
                    wgpu::TextureViewDimension::D2,
                ),
                wgpu::BindGroupLayoutEntry {
                    binding: 2,
                    visibility: compute,
                    ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
                    count: None,
                },
                storage_entry(3, compute, false),
                storage_texture_entry(4, compute, CAUSTIC_FORMAT),
            ],
        });
        let module = compose::shader(device, "caustics");
        let [send, gather] =
            ["send", "gather"].map(|entry| compute_pipeline(device, "rain caustics", &module, entry, &[&layout]));
        Self {
            send,
            gather,
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("rain caustics"),
                address_mode_u: wgpu::AddressMode::Repeat,
                address_mode_v: wgpu::AddressMode::Repeat,
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
            params: device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("rain caustics"),
                size: size_of::<CausticParams>() as u64,
                usage: PARAMS | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
            thrown: device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("rain caustics thrown"),
                size: u64::from(CAUSTIC_TEXELS * CAUSTIC_TEXELS) * 16,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
            layout,
            bound: None,
        }
    }

    /// Uploads a frame whose rays leave `slopes` and are gathered in `map`, made from [`super::caustic_texture`].
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        slopes: &wgpu::Texture,
        map: &wgpu::Texture,
        frame: &CausticFrame,
    ) {
        queue.write_buffer(&self.params, 0, bytemuck::bytes_of(&frame.params()));
        let same = |bound: &Bound| bound.slopes == *slopes && bound.map == *map;
        if self.bound.as_ref().is_some_and(same) {
            return;
        }
        let views = [slopes, map].map(|texture| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                mip_level_count: Some(1),
                ..Default::default()
            })
        });
        let resources = [
            self.params.as_entire_binding(),
            wgpu::BindingResource::TextureView(&views[0]),
            wgpu::BindingResource::Sampler(&self.sampler),
            self.thrown.as_entire_binding(),
            wgpu::BindingResource::TextureView(&views[1]),
        ];
        let entries: Vec<wgpu::BindGroupEntry> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        self.bound = Some(Bound {
            slopes: slopes.clone(),
            map: map.clone(),
            group: device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("rain caustics"),
                layout: &self.layout,
                entries: &entries,
            }),
        });
    }

    pub(super) fn group(&self) -> Option<&wgpu::BindGroup> {
        self.bound.as_ref().map(|bound| &bound.group)
    }

    /// GPU memory without the map. Units: bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> u64 {
        self.params.size() + self.thrown.size()
    }
}
