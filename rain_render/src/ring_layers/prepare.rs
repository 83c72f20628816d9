//! The pipeline, and the circle texture and bindings of one map.

use std::sync::Arc;

use rain_core::waves::CircleMap;

use super::params::RingLayerFrame;
use crate::bindings::{compute_pipeline, params_entry, storage_entry, storage_texture_entry};
use crate::compose;
use crate::gpu_types::RingLayerParams;
use crate::params_space::PARAMS;
use crate::slope_mips::{SLOPE_FORMAT, SlopeMipsGpu, SlopeMipsTarget};

/// Everything of the pass that lives as long as the device.
#[derive(Debug)]
pub struct RingLayersGpu {
    layout: wgpu::BindGroupLayout,
    pub(super) pipeline: wgpu::ComputePipeline,
}

impl RingLayersGpu {
    /// Builds the pipeline.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("rain ring layers"),
            entries: &[
                params_entry(device, 0, compute, size_of::<RingLayerParams>()),
                storage_entry(1, compute, true),
                storage_texture_entry(2, compute, SLOPE_FORMAT),
            ],
        });
        let module = compose::shader(device, "ring_layers");
        let pipeline = compute_pipeline(device, "rain ring layers", &module, "compose", &[&layout]);
        Self { layout, pipeline }
    }
}

/// The circles of a frame on the GPU, bound to its map.
#[derive(Debug)]
struct Bound {
    circles: Arc<CircleMap>,
    buffer: wgpu::Buffer,
    map: wgpu::Texture,
    group: wgpu::BindGroup,
    mips: SlopeMipsTarget,
}

/// The circle texture, and what a frame brings.
#[derive(Debug)]
pub struct RingLayerGpu {
    params: wgpu::Buffer,
    bound: Option<Bound>,
    pub(super) groups: u32,
}

impl RingLayerGpu {
    /// Nothing yet.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        Self {
            params: device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("rain ring layers"),
                size: size_of::<RingLayerParams>() as u64,
                usage: PARAMS | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
            bound: None,
            groups: 0,
        }
    }

    /// Uploads a frame that is to be drawn into `map`, a square texture from [`crate::slope_mips::slope_texture`]; the
    /// circles only when they, or the map, are others than before. A frame for another size than the map's draws the
    /// part that fits.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        gpu: &RingLayersGpu,
        mips: &SlopeMipsGpu,
        map: &wgpu::Texture,
        frame: &RingLayerFrame,
    ) {
        let same = |bound: &Bound| Arc::ptr_eq(&bound.circles, &frame.circles) && bound.map == *map;
        if !self.bound.as_ref().is_some_and(same) {
            self.bind(device, queue, gpu, mips, map, frame);
        }
        queue.write_buffer(&self.params, 0, bytemuck::bytes_of(&frame.params));
        self.groups = frame.params.cells.div_ceil(8);
    }

    fn bind(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        gpu: &RingLayersGpu,
        mips: &SlopeMipsGpu,
        map: &wgpu::Texture,
        frame: &RingLayerFrame,
    ) {
        let texels: &[u8] = bytemuck::cast_slice(frame.circles.texels());
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("rain ring circles"),
            size: texels.len() as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        queue.write_buffer(&buffer, 0, texels);
        let finest = map.create_view(&wgpu::TextureViewDescriptor {
            mip_level_count: Some(1),
            ..Default::default()
        });
        let resources = [
            self.params.as_entire_binding(),
            buffer.as_entire_binding(),
            wgpu::BindingResource::TextureView(&finest),
        ];
        let entries: Vec<wgpu::BindGroupEntry> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("rain ring layers"),
            layout: &gpu.layout,
            entries: &entries,
        });
        self.bound = Some(Bound {
            circles: frame.circles.clone(),
            buffer,
            map: map.clone(),
            group,
            mips: mips.bind(device, map),
        });
    }

    /// The bindings of the frame that was prepared.
    pub(super) fn bound(&self) -> Option<(&wgpu::BindGroup, &SlopeMipsTarget)> {
        self.bound.as_ref().map(|bound| (&bound.group, &bound.mips))
    }

    /// GPU memory without the map. Units: bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> u64 {
        self.params.size() + self.bound.as_ref().map_or(0, |bound| bound.buffer.size())
    }
}
