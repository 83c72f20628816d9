//! The pipeline, the bindings of a texture, the commands.

use crate::bindings::{compute_pipeline, storage_texture_entry, texture_entry};
use crate::compose;

/// Format of the mirrored view.
pub const REFLECTION_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Most views that are mirrored at once, each in its layer of the texture.
pub const MAX_MIRRORS: usize = 4;

/// Everything of the pass that lives as long as the device.
#[derive(Debug)]
pub struct ReflectionMipsGpu {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
}

/// The bindings of one layer of a texture.
#[derive(Debug)]
pub struct ReflectionMipsTarget {
    levels: Vec<(wgpu::BindGroup, [u32; 2])>,
}

impl ReflectionMipsGpu {
    /// Builds the pipeline.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("rain reflection mips"),
            entries: &[
                texture_entry(
                    0,
                    compute,
                    wgpu::TextureSampleType::Float { filterable: false },
                    wgpu::TextureViewDimension::D2,
                ),
                storage_texture_entry(1, compute, REFLECTION_FORMAT),
            ],
        });
        let module = compose::shader(device, "reflection_mips");
        let pipeline = compute_pipeline(device, "rain reflection mips", &module, "reduce", &[&layout]);
        Self { layout, pipeline }
    }

    /// Binds a layer of a texture of [`REFLECTION_FORMAT`] that may be bound as texture and as storage. Once for each
    /// texture, not for each frame.
    #[must_use]
    pub fn bind(&self, device: &wgpu::Device, texture: &wgpu::Texture, layer: u32) -> ReflectionMipsTarget {
        let view = |level| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_mip_level: level,
                mip_level_count: Some(1),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..Default::default()
            })
        };
        let level = |level: u32| {
            let (source, target) = (view(level - 1), view(level));
            let entry = |binding, view| wgpu::BindGroupEntry {
                binding,
                resource: wgpu::BindingResource::TextureView(view),
            };
            let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("rain reflection mips"),
                layout: &self.layout,
                entries: &[entry(0, &source), entry(1, &target)],
            });
            let size = [texture.width(), texture.height()].map(|side| (side >> level).max(1).div_ceil(8));
            (group, size)
        };
        ReflectionMipsTarget {
            levels: (1..texture.mip_level_count()).map(level).collect(),
        }
    }
}

/// Fills all levels below the finest.
pub fn encode_reflection_mips(pass: &mut wgpu::ComputePass, gpu: &ReflectionMipsGpu, target: &ReflectionMipsTarget) {
    pass.set_pipeline(&gpu.pipeline);
    for (group, [x, y]) in &target.levels {
        pass.set_bind_group(0, group, &[]);
        pass.dispatch_workgroups(*x, *y, 1);
    }
}
