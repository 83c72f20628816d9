//! Pipelines that live with the device, buffers that live with a view.

use rain_core::optics::RainbowPhase;
use rain_core::rainfall::areas::MAX_PACKED_ROWS;

use super::HazeInput;
use crate::bindings::{
    compute_pipeline, linear_sampler, one_texel, params_entry, sampler_entry, storage_entry, texture_entry,
};
use crate::compose::{self, HAZE_AZIMUTHS, HAZE_INTERVALS};
use crate::gpu_types::HazeView;
use crate::overlay::{Overlay, OverlayKey};
use crate::params_space::PARAMS;
use crate::rainfall::DEPTH_FORMAT;

/// Everything of the pass that lives as long as the device.
#[derive(Debug)]
pub struct HazeGpu {
    areas_layout: wgpu::BindGroupLayout,
    pub(super) spread: wgpu::ComputePipeline,
    pub(super) add: wgpu::ComputePipeline,
    /// For a scene's depth with one sample, and with more.
    single: Overlay,
    several: Option<Overlay>,
    no_environment: wgpu::TextureView,
    no_depth: wgpu::TextureView,
    no_bow: wgpu::Buffer,
    sampler: wgpu::Sampler,
}

/// Textures of the host that a view reads.
#[derive(Debug, Clone, Copy)]
pub struct HazeTextures<'a> {
    /// Depth of the scene, with as many samples as the target.
    pub scene_depth: &'a wgpu::TextureView,
    /// Prefiltered cube map; `None`: none.
    pub environment: Option<&'a wgpu::TextureView>,
    /// Depth map along the rain; `None`: none.
    pub cover: Option<&'a wgpu::TextureView>,
}

/// Buffers and bind groups of one view.
#[derive(Debug)]
pub struct HazeViewGpu {
    params: wgpu::Buffer,
    rows: wgpu::Buffer,
    grid: wgpu::Buffer,
    /// Made for the first rainbow, and what it holds.
    bow: Option<(wgpu::Buffer, RainbowPhase)>,
    pub(super) uneven: bool,
    /// There is mist of splashes.
    pub(super) mist: bool,
    pub(super) areas: Option<wgpu::BindGroup>,
    pub(super) draw: Option<wgpu::BindGroup>,
}

/// The whole rain, then the far rain.
const GRID_BYTES: usize = 2 * HAZE_AZIMUTHS as usize * (HAZE_INTERVALS as usize + 1) * 4;
const BOW_BYTES: usize = size_of::<RainbowPhase>();
const ROWS_BYTES: usize = (MAX_PACKED_ROWS + 1) * 16;

fn bow_buffer(device: &wgpu::Device) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("rain bow"),
        size: BOW_BYTES as u64,
        usage: PARAMS | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

fn overlay(device: &wgpu::Device, multisampled: bool) -> Overlay {
    let raster = wgpu::ShaderStages::VERTEX_FRAGMENT;
    let fragment = wgpu::ShaderStages::FRAGMENT;
    let mut depth = texture_entry(
        2,
        raster,
        wgpu::TextureSampleType::Depth,
        wgpu::TextureViewDimension::D2,
    );
    if let wgpu::BindingType::Texture {
        multisampled: several, ..
    } = &mut depth.ty
    {
        *several = multisampled;
    }
    let entries = [
        params_entry(device, 0, raster, size_of::<HazeView>()),
        storage_entry(1, fragment, true),
        depth,
        texture_entry(
            3,
            fragment,
            wgpu::TextureSampleType::Float { filterable: true },
            wgpu::TextureViewDimension::Cube,
        ),
        sampler_entry(4, fragment),
        params_entry(device, 5, fragment, BOW_BYTES),
        texture_entry(
            6,
            raster,
            wgpu::TextureSampleType::Depth,
            wgpu::TextureViewDimension::D2,
        ),
    ];
    let shader = if multisampled {
        compose::create(device, "haze", &compose::haze_of_samples())
    } else {
        compose::shader(device, "haze")
    };
    Overlay::untested(device, "rain haze", shader, &entries)
        .with_constants(|key| vec![("SPLASH_MIST", f64::from(key.mist))])
}

impl HazeGpu {
    /// Builds the layouts and the pipelines of the areas' grid.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let areas_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("rain haze areas"),
            entries: &[
                params_entry(device, 0, compute, size_of::<HazeView>()),
                storage_entry(1, compute, true),
                storage_entry(2, compute, false),
            ],
        });
        let module = compose::shader(device, "haze_areas");
        let pipeline = |entry: &str| compute_pipeline(device, "rain haze areas", &module, entry, &[&areas_layout]);
        let (spread, add) = (pipeline("spread"), pipeline("add"));
        Self {
            areas_layout,
            spread,
            add,
            single: overlay(device, false),
            several: None,
            no_bow: bow_buffer(device),
            no_environment: one_texel(device, "rain no environment", wgpu::TextureFormat::Rgba8Unorm, 6),
            no_depth: one_texel(device, "rain no depth", DEPTH_FORMAT, 1),
            sampler: linear_sampler(device, "rain environment", wgpu::AddressMode::ClampToEdge),
        }
    }

    /// Makes sure that the pipeline for a target exists; `coverage` asks for the mask's as well, `splash` for those with mist of
    /// splashes.
    pub fn prepare_pipelines(
        &mut self,
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        samples: u32,
        coverage: bool,
        splash: bool,
    ) {
        let overlay = if samples > 1 {
            self.several.get_or_insert_with(|| overlay(device, true))
        } else {
            &mut self.single
        };
        let mask = (coverage && samples == 1).then(|| OverlayKey::coverage(samples));
        for key in [Some(OverlayKey::colour(format, samples)), mask].into_iter().flatten() {
            overlay.prepare(device, key);
            if splash {
                overlay.prepare(device, key.mist(true));
            }
        }
    }

    pub(super) fn overlay(&self, samples: u32) -> &Overlay {
        self.several.as_ref().filter(|_| samples > 1).unwrap_or(&self.single)
    }
}

impl HazeViewGpu {
    /// Buffers for a view, empty.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let buffer = |label: &str, bytes: usize, usage: wgpu::BufferUsages| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes as u64,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        Self {
            params: buffer("rain haze view", size_of::<HazeView>(), PARAMS),
            rows: buffer("rain haze areas", ROWS_BYTES, wgpu::BufferUsages::STORAGE),
            grid: buffer(
                "rain haze grid",
                GRID_BYTES,
                wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            ),
            bow: None,
            uneven: false,
            mist: false,
            areas: None,
            draw: None,
        }
    }

    /// Uploads a view's inputs and binds its textures. Call once a frame, before encoding; `samples` is that of the depth.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        gpu: &HazeGpu,
        input: &HazeInput,
        textures: HazeTextures,
        samples: u32,
    ) {
        let params = input.params();
        queue.write_buffer(&self.params, 0, bytemuck::bytes_of(&params));
        self.mist = params.splash[0] + params.splash[2] > 0.0;
        self.uneven = input.areas.is_some();
        if let Some(areas) = &input.areas {
            let head = [[areas.packed.areas as f32, areas.packed.outside, areas.weather_mm_h, 0.0]];
            queue.write_buffer(&self.rows, 0, bytemuck::cast_slice(&head));
            queue.write_buffer(&self.rows, 16, bytemuck::cast_slice(&areas.packed.rows));
        }
        if let Some(bow) = &input.bow
            && self.bow.as_ref().is_none_or(|(_, known)| known != bow.phase)
        {
            let (buffer, known) = self.bow.get_or_insert_with(|| (bow_buffer(device), *bow.phase));
            *known = *bow.phase;
            queue.write_buffer(buffer, 0, bytemuck::cast_slice(&known.rgb_per_sr));
        }
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        if self.areas.is_none() {
            self.areas = Some(device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("rain haze areas"),
                layout: &gpu.areas_layout,
                entries: &[
                    entry(0, self.params.as_entire_binding()),
                    entry(1, self.rows.as_entire_binding()),
                    entry(2, self.grid.as_entire_binding()),
                ],
            }));
        }
        let environment = textures.environment.unwrap_or(&gpu.no_environment);
        self.draw = Some(
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("rain haze"),
                layout: &gpu.overlay(samples).layout,
                entries: &[
                    entry(0, self.params.as_entire_binding()),
                    entry(1, self.grid.as_entire_binding()),
                    entry(2, wgpu::BindingResource::TextureView(textures.scene_depth)),
                    entry(3, wgpu::BindingResource::TextureView(environment)),
                    entry(4, wgpu::BindingResource::Sampler(&gpu.sampler)),
                    entry(
                        5,
                        self.bow
                            .as_ref()
                            .map_or(&gpu.no_bow, |(buffer, _)| buffer)
                            .as_entire_binding(),
                    ),
                    entry(
                        6,
                        wgpu::BindingResource::TextureView(textures.cover.unwrap_or(&gpu.no_depth)),
                    ),
                ],
            }),
        );
    }

    /// Whether areas divide the rain of this view.
    #[must_use]
    pub fn uneven(&self) -> bool {
        self.uneven
    }

    /// GPU memory of this view. Units: bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        let bow = self.bow.as_ref().map_or(0, |_| BOW_BYTES);
        size_of::<HazeView>() + ROWS_BYTES + GRID_BYTES + bow
    }
}
