//! Measurement masks of a view: wetness, distance and standing water of every pixel, from the scene's depth, and from
//! what wet materials wrote of their pixels where a view of masks was drawn.
//!
//! Output: three R32Float targets. Only recorded when somebody asked for a mask.

use glam::{Mat4, Vec4};

use crate::bindings::{sampler_entry, texture_entry};
use crate::compose;
use crate::gpu_types::{MaskView, SurfaceParams};
use crate::params_space::{PARAMS, ParamsSpace};

/// Format of the wet, distance and water masks.
pub const MASK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;

/// Format of the texture that keeps what wet materials know of a view's pixels.
pub const KNOWN_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// A texture of [`KNOWN_FORMAT`], to be copied to. Units: px.
#[must_use]
pub fn known_texture(device: &wgpu::Device, size_px: [u32; 2]) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("rain masks: known"),
        size: wgpu::Extent3d {
            width: size_px[0].max(1),
            height: size_px[1].max(1),
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: KNOWN_FORMAT,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// Pipeline of the mask pass.
#[derive(Debug)]
pub struct MaskGpu {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
    sampler: wgpu::Sampler,
    /// Stands for a ground that is not there.
    nothing: wgpu::TextureView,
    no_map: wgpu::TextureView,
}

/// What the mask pass reads of the ground; without one, the weather and the cover alone tell what is wet.
#[derive(Debug, Clone, Copy)]
pub struct GroundMaps<'a> {
    /// Films and pores (Rgba16Float), see `rain_remembered`.
    pub films: &'a wgpu::TextureView,
    /// Levels of standing water (R32Float), see `rain_standing_water`.
    pub levels: &'a wgpu::TextureView,
    /// The water map, all levels; it counts where `SurfaceParams::map` says that it holds.
    pub map: &'a wgpu::TextureView,
}

/// Targets of the mask pass.
#[derive(Debug, Clone, Copy)]
pub struct MaskTargets<'a> {
    /// Pore saturation, 0…1.
    pub wet: &'a wgpu::TextureView,
    /// Distance from the eye. Units: m.
    pub depth: &'a wgpu::TextureView,
    /// Depth of standing water. Units: m.
    pub water: &'a wgpu::TextureView,
}

/// A texel for a texture that is bound and never counts.
fn empty(device: &wgpu::Device) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("rain masks: no ground"),
        size: wgpu::Extent3d::default(),
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba16Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

impl MaskGpu {
    /// Builds the pipeline.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let depth = |binding| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Depth,
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            },
            count: None,
        };
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let colour = |binding, filterable, dimension| {
            texture_entry(
                binding,
                fragment,
                wgpu::TextureSampleType::Float { filterable },
                dimension,
            )
        };
        let plane = wgpu::TextureViewDimension::D2;
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("rain masks"),
            entries: &[
                wgpu::BindGroupLayoutEntry {
                    binding: 0,
                    visibility: wgpu::ShaderStages::FRAGMENT,
                    ty: wgpu::BindingType::Buffer {
                        ty: ParamsSpace::of(device).binding(),
                        has_dynamic_offset: false,
                        min_binding_size: wgpu::BufferSize::new(size_of::<MaskView>() as u64),
                    },
                    count: None,
                },
                depth(1),
                depth(2),
                colour(3, true, plane),
                sampler_entry(4, wgpu::ShaderStages::FRAGMENT),
                colour(5, false, plane),
                colour(6, true, wgpu::TextureViewDimension::D2Array),
                colour(7, false, plane),
            ],
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("rain masks"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let module = compose::shader(device, "mask");
        let target = Some(wgpu::ColorTargetState {
            format: MASK_FORMAT,
            blend: None,
            write_mask: wgpu::ColorWrites::ALL,
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("rain masks"),
            layout: Some(&pipeline_layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[target.clone(), target.clone(), target],
            }),
            multiview_mask: None,
            cache: None,
        });
        Self {
            layout,
            pipeline,
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("rain masks"),
                address_mode_u: wgpu::AddressMode::Repeat,
                address_mode_v: wgpu::AddressMode::Repeat,
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
            nothing: empty(device).create_view(&wgpu::TextureViewDescriptor::default()),
            no_map: empty(device).create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2Array),
                ..Default::default()
            }),
        }
    }

    /// Uploads a view and binds its depth, the cover map and the ground's maps.
    ///
    /// `eye_from_clip`: clip to eye-relative world; `near_m`: near plane, m; `viewport_px`: corner and
    /// size of the view in its target; `known`: what wet
    /// materials know of the same pixels ([`KNOWN_FORMAT`], `rain_mask_texel`).
    #[must_use]
    pub fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        eye_from_clip: Mat4,
        near_m: f32,
        viewport_px: Vec4,
        surface: SurfaceParams,
        scene_depth: &wgpu::TextureView,
        cover: &wgpu::TextureView,
        ground: Option<GroundMaps<'_>>,
        known: Option<&wgpu::TextureView>,
    ) -> wgpu::BindGroup {
        let view = MaskView {
            eye_from_clip: eye_from_clip.to_cols_array_2d(),
            screen: [
                near_m,
                viewport_px.z,
                viewport_px.w,
                f32::from(u8::from(known.is_some())),
            ],
            corner: [viewport_px.x, viewport_px.y, 0.0, 0.0],
            surface,
        };
        // Each view has its own.
        let params = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("rain masks"),
            size: size_of::<MaskView>() as u64,
            usage: PARAMS | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        queue.write_buffer(&params, 0, bytemuck::bytes_of(&view));
        let maps = ground.unwrap_or(GroundMaps {
            films: &self.nothing,
            levels: &self.nothing,
            map: &self.no_map,
        });
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("rain masks"),
            layout: &self.layout,
            entries: &[
                entry(0, params.as_entire_binding()),
                entry(1, wgpu::BindingResource::TextureView(scene_depth)),
                entry(2, wgpu::BindingResource::TextureView(cover)),
                entry(3, wgpu::BindingResource::TextureView(maps.films)),
                entry(4, wgpu::BindingResource::Sampler(&self.sampler)),
                entry(5, wgpu::BindingResource::TextureView(maps.levels)),
                entry(6, wgpu::BindingResource::TextureView(maps.map)),
                entry(7, wgpu::BindingResource::TextureView(known.unwrap_or(&self.nothing))),
            ],
        })
    }

    /// Records the pass into its targets.
    pub fn encode(&self, encoder: &mut wgpu::CommandEncoder, bind_group: &wgpu::BindGroup, targets: MaskTargets<'_>) {
        let attachment = |view| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("rain masks"),
            color_attachments: &[
                attachment(targets.wet),
                attachment(targets.depth),
                attachment(targets.water),
            ],
            depth_stencil_attachment: None,
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, bind_group, &[]);
        pass.draw(0..3, 0..1);
    }
}
