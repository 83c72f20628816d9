//! Pipelines that live with the device, buffers that live with a map.

use super::frame::WaterMapFrame;
use super::params::{MAX_LEVELS, WATER_MAP_FORMAT, WaterMapSettings};
use super::press::MAX_PRESSES;
use crate::bindings::{compute_pipeline, one_texel, params_entry, storage_entry, texture_entry};
use crate::compose;
use crate::gpu_types::{CoverParams, WaterMapParams, WaterStamp};
use crate::params_space::PARAMS;

/// Distance of two levels' parameters, and of two stamps'.
pub(super) const LEVEL_STRIDE: usize = 512;
pub(super) const STAMP_STRIDE: usize = 256;
/// Most stamps in a frame: each press on each level.
const MOST_STAMPS: usize = MAX_PRESSES * MAX_LEVELS;

/// Everything of the pass that lives as long as the device.
#[derive(Debug)]
pub struct WaterMapPasses {
    layout: wgpu::BindGroupLayout,
    stamp_layout: wgpu::BindGroupLayout,
    pub(super) advance: wgpu::ComputePipeline,
    pub(super) press: wgpu::ComputePipeline,
    pub(super) lay: wgpu::ComputePipeline,
    no_cover: wgpu::TextureView,
    no_levels: wgpu::TextureView,
}

/// What the host hands over with a frame.
#[derive(Debug, Clone, Copy)]
pub struct WaterMapInput<'a> {
    /// The map of what covers, relative to [`WaterMapFrame::origin_m`].
    pub cover: CoverParams,
    /// Its depth texture.
    pub cover_map: Option<&'a wgpu::TextureView>,
    /// Levels of standing water over the base in the ground's cells (R32Float). Units: m.
    pub levels: Option<&'a wgpu::TextureView>,
}

fn dynamic(mut entry: wgpu::BindGroupLayoutEntry) -> wgpu::BindGroupLayoutEntry {
    if let wgpu::BindingType::Buffer { has_dynamic_offset, .. } = &mut entry.ty {
        *has_dynamic_offset = true;
    }
    entry
}

impl WaterMapPasses {
    /// Builds the pipelines.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let plane = wgpu::TextureViewDimension::D2;
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("rain water map"),
            entries: &[
                dynamic(params_entry(device, 0, compute, size_of::<WaterMapParams>())),
                storage_entry(1, compute, false),
                storage_entry(2, compute, true),
                storage_entry(3, compute, true),
                storage_entry(4, compute, false),
                texture_entry(5, compute, wgpu::TextureSampleType::Depth, plane),
                texture_entry(6, compute, wgpu::TextureSampleType::Float { filterable: false }, plane),
                wgpu::BindGroupLayoutEntry {
                    binding: 7,
                    visibility: compute,
                    ty: wgpu::BindingType::StorageTexture {
                        access: wgpu::StorageTextureAccess::WriteOnly,
                        format: WATER_MAP_FORMAT,
                        view_dimension: wgpu::TextureViewDimension::D2Array,
                    },
                    count: None,
                },
                storage_entry(8, compute, true),
            ],
        });
        let stamp_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("rain water stamps"),
            entries: &[dynamic(params_entry(device, 0, compute, size_of::<WaterStamp>()))],
        });
        let module = compose::shader(device, "water_map");
        let pipeline = |entry: &str, groups: &[&wgpu::BindGroupLayout]| {
            compute_pipeline(device, "rain water map", &module, entry, groups)
        };
        Self {
            advance: pipeline("advance", &[&layout]),
            press: pipeline("press", &[&layout, &stamp_layout]),
            lay: pipeline("lay", &[&layout, &stamp_layout]),
            layout,
            stamp_layout,
            no_cover: one_texel(device, "rain no cover", wgpu::TextureFormat::Depth32Float, 1),
            no_levels: one_texel(device, "rain no levels", wgpu::TextureFormat::R32Float, 1),
        }
    }
}

/// The texels of one map and what a frame brings to them.
#[derive(Debug)]
pub struct WaterMapGpu {
    pub(super) texels: u32,
    params: wgpu::Buffer,
    stamps: wgpu::Buffer,
    water: wgpu::Buffer,
    ground: wgpu::Buffer,
    seeds: wgpu::Buffer,
    sums: wgpu::Buffer,
    areas: wgpu::Buffer,
    drawn: wgpu::TextureView,
    pub(super) stamp_group: wgpu::BindGroup,
    pub(super) group: Option<wgpu::BindGroup>,
    pub(super) advances: bool,
    pub(super) levels: u32,
    /// Level and number of texels of each stamp.
    pub(super) boxes: Vec<(u32, [u32; 2])>,
    staging: Vec<u8>,
}

fn storage(device: &wgpu::Device, label: &str, bytes: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes.max(16) as u64,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

fn params(device: &wgpu::Device, label: &str, bytes: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes as u64,
        usage: PARAMS | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// Writes a list into a buffer, which grows when it has to.
fn write<T: bytemuck::Pod>(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    buffer: &mut wgpu::Buffer,
    label: &str,
    list: &[T],
) {
    let bytes = bytemuck::cast_slice(list);
    if bytes.is_empty() {
        return;
    }
    if buffer.size() < bytes.len() as u64 {
        *buffer = storage(device, label, bytes.len().next_power_of_two());
    }
    queue.write_buffer(buffer, 0, bytes);
}

impl WaterMapGpu {
    /// An empty map, shown in a texture from [`WaterMapSettings::map_texture`].
    #[must_use]
    pub fn new(
        device: &wgpu::Device,
        passes: &WaterMapPasses,
        settings: &WaterMapSettings,
        map: &wgpu::Texture,
    ) -> Self {
        let texels = map.width();
        let count = texels as usize * texels as usize * map.depth_or_array_layers() as usize;
        let stamps = params(device, "rain water stamps", STAMP_STRIDE * MOST_STAMPS);
        let stamp_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("rain water stamps"),
            layout: &passes.stamp_layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                    buffer: &stamps,
                    offset: 0,
                    size: wgpu::BufferSize::new(size_of::<WaterStamp>() as u64),
                }),
            }],
        });
        Self {
            texels,
            params: params(device, "rain water map", LEVEL_STRIDE * MAX_LEVELS),
            stamps,
            water: storage(device, "rain water map", count * 12),
            ground: storage(device, "rain water map ground", 0),
            seeds: storage(device, "rain water map seeds", 0),
            sums: storage(device, "rain water stamp sums", MOST_STAMPS * 8),
            areas: storage(device, "rain water map areas", 0),
            drawn: map.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2Array),
                ..Default::default()
            }),
            stamp_group,
            group: None,
            advances: false,
            levels: settings.levels,
            boxes: Vec::new(),
            staging: Vec::new(),
        }
    }

    /// Pores mm, film mm and soil clock s of each texel, level after level, row after row.
    #[must_use]
    pub fn water(&self) -> &wgpu::Buffer {
        &self.water
    }

    /// GPU memory of the buffers. Units: bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> u64 {
        [
            &self.params,
            &self.stamps,
            &self.water,
            &self.ground,
            &self.seeds,
            &self.sums,
            &self.areas,
        ]
        .iter()
        .map(|buffer| buffer.size())
        .sum()
    }

    /// Uploads a frame. Each call must be followed by [`WaterMapGpu::encode`].
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        passes: &WaterMapPasses,
        frame: &WaterMapFrame,
        input: &WaterMapInput<'_>,
    ) {
        self.advances = frame.advances;
        self.levels = frame.levels.len() as u32;
        self.boxes.clear();
        write(device, queue, &mut self.ground, "rain water map ground", &frame.ground);
        write(device, queue, &mut self.seeds, "rain water map seeds", &frame.seeds);
        write(device, queue, &mut self.areas, "rain water map areas", &frame.areas);
        self.staging.clear();
        for level in &frame.levels {
            let mut params = *level;
            params.cover = input.cover;
            if input.cover_map.is_none() {
                params.cover.present = 0.0;
            }
            if input.levels.is_none() {
                params.pools = 0.0;
            }
            self.staging.extend_from_slice(bytemuck::bytes_of(&params));
            self.staging
                .resize(self.staging.len().next_multiple_of(LEVEL_STRIDE), 0);
        }
        if !self.staging.is_empty() {
            queue.write_buffer(&self.params, 0, &self.staging);
        }
        self.staging.clear();
        for (level, stamp) in frame.stamps.iter().take(MOST_STAMPS) {
            self.boxes.push((*level, stamp.count.map(|n| n.max(0) as u32)));
            self.staging.extend_from_slice(bytemuck::bytes_of(stamp));
            self.staging
                .resize(self.staging.len().next_multiple_of(STAMP_STRIDE), 0);
        }
        if !self.boxes.is_empty() {
            queue.write_buffer(&self.stamps, 0, &self.staging);
            self.staging.clear();
            self.staging.resize(self.boxes.len() * 8, 0);
            queue.write_buffer(&self.sums, 0, &self.staging);
        }
        let texture = |view| wgpu::BindingResource::TextureView(view);
        let params = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: &self.params,
            offset: 0,
            size: wgpu::BufferSize::new(size_of::<WaterMapParams>() as u64),
        });
        let resources = [
            params,
            self.water.as_entire_binding(),
            self.ground.as_entire_binding(),
            self.seeds.as_entire_binding(),
            self.sums.as_entire_binding(),
            texture(input.cover_map.unwrap_or(&passes.no_cover)),
            texture(input.levels.unwrap_or(&passes.no_levels)),
            texture(&self.drawn),
            self.areas.as_entire_binding(),
        ];
        let entries: Vec<wgpu::BindGroupEntry> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        self.group = Some(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("rain water map"),
            layout: &passes.layout,
            entries: &entries,
        }));
    }
}
