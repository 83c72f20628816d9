//! The pipeline, and the bindings of one map.

use super::params::SLOPE_FORMAT;
use crate::bindings::{compute_pipeline, storage_texture_entry, texture_entry};
use crate::compose;

/// Levels that one dispatch makes: as many as storage textures may be bound.
const LEVELS: u32 = 4;

/// Texels of the source for each workgroup along an axis.
const GROUP_TEXELS: u32 = 16;

/// Everything of the pass that lives as long as the device.
#[derive(Debug)]
pub struct SlopeMipsGpu {
    layout: wgpu::BindGroupLayout,
    pub(super) pipeline: wgpu::ComputePipeline,
    /// Takes what a dispatch makes beyond the last level.
    unused: wgpu::Texture,
}

/// One dispatch: its bindings and the number of its workgroups.
#[derive(Debug)]
pub(super) struct Dispatch {
    pub group: wgpu::BindGroup,
    pub size: [u32; 2],
}

/// The bindings of one slope map.
#[derive(Debug)]
pub struct SlopeMipsTarget {
    pub(super) dispatches: Vec<Dispatch>,
}

impl SlopeMipsGpu {
    /// Builds the pipeline.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let source = texture_entry(
            0,
            compute,
            wgpu::TextureSampleType::Float { filterable: false },
            wgpu::TextureViewDimension::D2,
        );
        let level = |binding| storage_texture_entry(binding, compute, SLOPE_FORMAT);
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("rain slope mips"),
            entries: &[source, level(1), level(2), level(3), level(4)],
        });
        let module = compose::shader(device, "slope_mips");
        let pipeline = compute_pipeline(device, "rain slope mips", &module, "reduce", &[&layout]);
        let side = 1 << (LEVELS - 1);
        let unused = device.create_texture(&wgpu::TextureDescriptor {
            usage: wgpu::TextureUsages::STORAGE_BINDING,
            ..super::slope_texture("rain slope mips unused", side, side)
        });
        Self {
            layout,
            pipeline,
            unused,
        }
    }

    /// Binds a map made from [`super::slope_texture`]. Once for each texture, not for each frame.
    #[must_use]
    pub fn bind(&self, device: &wgpu::Device, map: &wgpu::Texture) -> SlopeMipsTarget {
        let last = map.mip_level_count() - 1;
        let view = |texture: &wgpu::Texture, level| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                base_mip_level: level,
                mip_level_count: Some(1),
                ..Default::default()
            })
        };
        let dispatch = |index: u32| {
            let from = index * LEVELS;
            let views: Vec<wgpu::TextureView> = (0..=LEVELS)
                .map(|k| {
                    if from + k <= last {
                        view(map, from + k)
                    } else {
                        view(&self.unused, k - 1)
                    }
                })
                .collect();
            let entries: Vec<wgpu::BindGroupEntry> = (0..)
                .zip(&views)
                .map(|(binding, view)| wgpu::BindGroupEntry {
                    binding,
                    resource: wgpu::BindingResource::TextureView(view),
                })
                .collect();
            Dispatch {
                group: device.create_bind_group(&wgpu::BindGroupDescriptor {
                    label: Some("rain slope mips"),
                    layout: &self.layout,
                    entries: &entries,
                }),
                size: [map.width(), map.height()].map(|side| (side >> from).div_ceil(GROUP_TEXELS)),
            }
        };
        SlopeMipsTarget {
            dispatches: (0..last.div_ceil(LEVELS)).map(dispatch).collect(),
        }
    }
}
