//! Pipelines that live with the device, buffers that live with a tile.

use std::ops::Range;

use super::frame::{MAX_STEPS, WaveFrame};
use crate::bindings::{compute_pipeline, params_entry, storage_entry, storage_texture_entry};
use crate::compose;
use crate::gpu_types::{WaveBin, WaveParams, WaveSource};
use crate::params_space::PARAMS;
use crate::slope_mips::{SLOPE_FORMAT, SlopeMipsGpu, SlopeMipsTarget};

/// Distance of the parameters of two steps: the largest alignment that a device may ask for.
pub(super) const STRIDE: usize = 256;

/// Everything of the pass that lives as long as the device.
#[derive(Debug)]
pub struct WavesGpu {
    layout: wgpu::BindGroupLayout,
    map_layout: wgpu::BindGroupLayout,
    pub(super) settle: wgpu::ComputePipeline,
    pub(super) gather: wgpu::ComputePipeline,
    pub(super) add: wgpu::ComputePipeline,
    pub(super) step: wgpu::ComputePipeline,
    pub(super) slopes: wgpu::ComputePipeline,
}

impl WavesGpu {
    /// Builds the pipelines.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let mut params = params_entry(device, 0, compute, size_of::<WaveParams>());
        if let wgpu::BindingType::Buffer { has_dynamic_offset, .. } = &mut params.ty {
            *has_dynamic_offset = true;
        }
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("rain waves"),
            entries: &[
                params,
                storage_entry(1, compute, false),
                storage_entry(2, compute, false),
                storage_entry(3, compute, true),
                storage_entry(4, compute, true),
                storage_entry(5, compute, true),
                storage_entry(6, compute, true),
                storage_entry(7, compute, false),
            ],
        });
        let map_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("rain waves map"),
            entries: &[storage_texture_entry(0, compute, SLOPE_FORMAT)],
        });
        let module = compose::shader(device, "waves");
        let pipeline = |entry: &str, groups: &[&wgpu::BindGroupLayout]| {
            compute_pipeline(device, "rain waves", &module, entry, groups)
        };
        Self {
            settle: pipeline("settle", &[&layout]),
            gather: pipeline("gather", &[&layout]),
            add: pipeline("add", &[&layout]),
            step: pipeline("step_levels", &[&layout]),
            slopes: pipeline("slopes", &[&layout, &map_layout]),
            layout,
            map_layout,
        }
    }
}

/// A step as it is recorded.
#[derive(Debug)]
pub(super) struct Recorded {
    pub sources: u32,
    pub bins: u32,
    pub steps: bool,
}

/// The heights of one tile and what a frame brings to them.
#[derive(Debug)]
pub struct WaveTileGpu {
    pub(super) cells: u32,
    params: wgpu::Buffer,
    levels: [wgpu::Buffer; 2],
    depths: wgpu::Buffer,
    sources: wgpu::Buffer,
    bins: wgpu::Buffer,
    entries: wgpu::Buffer,
    sums: wgpu::Buffer,
    /// With either level as the one that is shown.
    pub(super) groups: [wgpu::BindGroup; 2],
    /// Which level is shown after all that was prepared, and before the last frame.
    now: usize,
    pub(super) first: usize,
    pub(super) map: wgpu::BindGroup,
    pub(super) mips: SlopeMipsTarget,
    pub(super) frame: Vec<Recorded>,
    pub(super) settle: bool,
    pub(super) balance: bool,
    staging: Vec<u8>,
}

impl WaveTileGpu {
    /// Calm water for a tile, and its map: a texture from [`super::WaveTileSettings::map_texture`] or
    /// [`super::RippleSettings::map_texture`], whose width is that of the tile.
    #[must_use]
    pub fn new(device: &wgpu::Device, gpu: &WavesGpu, mips: &SlopeMipsGpu, map: &wgpu::Texture) -> Self {
        let cells = map.width();
        let bytes = u64::from(cells * cells) * 4;
        let [sources, bins, entries] = [64, 256, 1024];
        let buffers = Lists {
            sources: list(device, "rain wave sources", sources * size_of::<WaveSource>()),
            bins: list(device, "rain wave bins", bins * size_of::<WaveBin>()),
            entries: list(device, "rain wave entries", entries * 4),
            sums: list(device, "rain wave sums", sources * 16),
        };
        let params = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("rain wave steps"),
            size: (STRIDE * (MAX_STEPS + 1)) as u64,
            usage: PARAMS | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let field = |label| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let levels = [field("rain wave level"), field("rain wave level")];
        let depths = field("rain wave depths");
        let groups = groups(device, gpu, &params, &levels, &depths, &buffers);
        let Lists {
            sources,
            bins,
            entries,
            sums,
        } = buffers;
        Self {
            cells,
            params,
            levels,
            depths,
            sources,
            bins,
            entries,
            sums,
            groups,
            now: 0,
            first: 0,
            map: map_group(device, gpu, map),
            mips: mips.bind(device, map),
            frame: Vec::new(),
            settle: false,
            balance: false,
            staging: Vec::new(),
        }
    }

    /// Uploads a frame. Each call must be followed by [`WaveTileGpu::encode`].
    pub fn prepare(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, gpu: &WavesGpu, frame: &WaveFrame) {
        let Some(params) = frame.params else { return };
        let plan = &frame.plan;
        self.grow(device, gpu, frame);
        if !frame.depths.is_empty() {
            queue.write_buffer(&self.depths, 0, bytemuck::cast_slice(&frame.depths));
        }
        for (level, heights) in self.levels().into_iter().zip(frame.heights.iter().flatten()) {
            queue.write_buffer(level, 0, bytemuck::cast_slice(heights));
        }
        for (buffer, bytes) in [
            (&self.sources, bytemuck::cast_slice::<_, u8>(&plan.sources)),
            (&self.bins, bytemuck::cast_slice(&plan.bins)),
            (&self.entries, bytemuck::cast_slice(&plan.entries)),
        ] {
            if !bytes.is_empty() {
                queue.write_buffer(buffer, 0, bytes);
            }
        }
        self.staging.clear();
        self.frame.clear();
        let length = |range: &Range<u32>| range.end - range.start;
        // The last parameters are that of the map.
        for index in 0..=plan.steps.len() {
            let mut params = params;
            if let Some(step) = plan.steps.get(index) {
                (params.first_source, params.first_bin) = (step.sources.start, step.bins.start);
                self.frame.push(Recorded {
                    sources: length(&step.sources),
                    bins: length(&step.bins),
                    steps: step.steps,
                });
            }
            self.staging.extend_from_slice(bytemuck::bytes_of(&params));
            self.staging.resize((index + 1) * STRIDE, 0);
        }
        queue.write_buffer(&self.params, 0, &self.staging);
        self.settle = frame.settle;
        self.balance = frame.balance;
        self.first = self.now;
        self.now = (self.now + frame.steps()) % 2;
    }

    /// Makes the lists long enough.
    fn grow(&mut self, device: &wgpu::Device, gpu: &WavesGpu, frame: &WaveFrame) {
        let plan = &frame.plan;
        let mut grown = false;
        let mut fit = |buffer: &mut wgpu::Buffer, label, bytes: usize| {
            if buffer.size() < bytes as u64 {
                *buffer = list(device, label, bytes.next_power_of_two());
                grown = true;
            }
        };
        let sources = plan.sources.len();
        fit(
            &mut self.sources,
            "rain wave sources",
            sources * size_of::<WaveSource>(),
        );
        fit(&mut self.bins, "rain wave bins", plan.bins.len() * size_of::<WaveBin>());
        fit(&mut self.entries, "rain wave entries", plan.entries.len() * 4);
        fit(&mut self.sums, "rain wave sums", sources * 16);
        if grown {
            let lists = Lists {
                sources: self.sources.clone(),
                bins: self.bins.clone(),
                entries: self.entries.clone(),
                sums: self.sums.clone(),
            };
            self.groups = groups(device, gpu, &self.params, &self.levels, &self.depths, &lists);
        }
    }

    /// Draws into another map of the same size from now on.
    pub fn set_map(&mut self, device: &wgpu::Device, gpu: &WavesGpu, mips: &SlopeMipsGpu, map: &wgpu::Texture) {
        self.map = map_group(device, gpu, map);
        self.mips = mips.bind(device, map);
    }

    /// The heights that are shown and those of the step before, as they are stored ([`super::WaveTile::stored`]), for
    /// saving, restoring and reading back. Units: m.
    #[must_use]
    pub fn levels(&self) -> [&wgpu::Buffer; 2] {
        [&self.levels[self.now], &self.levels[1 - self.now]]
    }

    /// GPU memory without the map. Units: bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> u64 {
        let lists = [&self.params, &self.sources, &self.bins, &self.entries, &self.sums];
        3 * self.depths.size() + lists.iter().map(|list| list.size()).sum::<u64>()
    }
}

/// Buffers that grow.
struct Lists {
    sources: wgpu::Buffer,
    bins: wgpu::Buffer,
    entries: wgpu::Buffer,
    sums: wgpu::Buffer,
}

fn list(device: &wgpu::Device, label: &str, bytes: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes as u64,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

fn map_group(device: &wgpu::Device, gpu: &WavesGpu, map: &wgpu::Texture) -> wgpu::BindGroup {
    let finest = map.create_view(&wgpu::TextureViewDescriptor {
        mip_level_count: Some(1),
        ..Default::default()
    });
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("rain waves map"),
        layout: &gpu.map_layout,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::TextureView(&finest),
        }],
    })
}

fn groups(
    device: &wgpu::Device,
    gpu: &WavesGpu,
    params: &wgpu::Buffer,
    levels: &[wgpu::Buffer; 2],
    depths: &wgpu::Buffer,
    lists: &Lists,
) -> [wgpu::BindGroup; 2] {
    let params = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
        buffer: params,
        offset: 0,
        size: wgpu::BufferSize::new(size_of::<WaveParams>() as u64),
    });
    [0, 1].map(|now: usize| {
        let resources = [
            params.clone(),
            levels[now].as_entire_binding(),
            levels[1 - now].as_entire_binding(),
            depths.as_entire_binding(),
            lists.sources.as_entire_binding(),
            lists.bins.as_entire_binding(),
            lists.entries.as_entire_binding(),
            lists.sums.as_entire_binding(),
        ];
        let entries: Vec<wgpu::BindGroupEntry> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("rain waves"),
            layout: &gpu.layout,
            entries: &entries,
        })
    })
}
