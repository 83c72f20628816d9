//! Pipelines that live with the device, buffers that live with a view.

use rain_core::rainfall::DropRecord;

use crate::bindings::{
    linear_sampler, one_texel, params_entry, params_entry_in, sampler_entry, storage_entry, texture_entry,
};
use crate::gpu_types::{RainfallView, Streak};
use crate::guard_band::GuardBand;
use crate::overlay::{Overlay, OverlayKey};
use crate::params_space::{PARAMS, ParamsSpace};
use crate::quad_indices::{DRAW_BYTES, QuadIndices, draw_words, quads_of_a_draw};
use crate::rainfall::choose::{Asked, ChoiceGpu, ChoiceTargets, Choose};
use crate::rainfall::near::near_reaches;
use crate::rainfall::project::{Project, ProjectKey};
use crate::rainfall::{Drops, RainfallInput};

/// Bytes of a drop's record and of its streak.
const RECORD_BYTES: u64 = size_of::<DropRecord>() as u64;
const STREAK_BYTES: u64 = size_of::<Streak>() as u64;

/// Format of the coverage mask: blendable everywhere.
pub const COVERAGE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;

/// Format of the depth the rain is tested against.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Stands in the list of near drops for one that is not drawn.
pub(crate) const NO_DROP: u32 = u32::MAX;

/// Words of the arguments before those of the draws: how many drops, how many that may have a pattern, how many there would
/// be without a limit, none; workgroups of the projection, none; those of looking through runs again, none.
pub(super) const HEAD_WORDS: u64 = 12;

/// Word at which the workgroups of the projection begin.
pub(super) const PROJECT_WORD: u64 = 4;

/// Word at which the workgroups of looking through runs again begin.
pub(super) const AGAIN_WORD: u64 = 8;

/// Everything of the pass that lives as long as the device.
#[derive(Debug)]
pub struct RainfallGpu {
    pub(super) choose: Choose,
    pub(super) project: Project,
    pub(super) draw: Overlay,
    pub(super) near: Overlay,
    pub(super) quads: QuadIndices,
    no_depth: wgpu::TextureView,
    no_environment: wgpu::TextureView,
    sampler: wgpu::Sampler,
}

/// How a view's streaks are drawn; by default their light alone, against a hard depth test.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub struct StreakDraws {
    /// Their coverage as well, into a [`COVERAGE_FORMAT`] target.
    pub coverage: bool,
    /// Those behind glass apart.
    pub behind: bool,
    /// They fade where they meet the scene, whose depth the view reads.
    pub soft: bool,
    /// Near ones have patterns.
    pub patterned: bool,
}

/// Textures of the host that a view reads. `None`: open sky, no soft fade, no environment.
#[derive(Debug, Default, Clone, Copy)]
pub struct RainfallTextures<'a> {
    /// Depth map along the rain.
    pub cover: Option<&'a wgpu::TextureView>,
    /// Single-sampled depth of the scene, for the soft fade.
    pub scene_depth: Option<&'a wgpu::TextureView>,
    /// Prefiltered cube map.
    pub environment: Option<&'a wgpu::TextureView>,
}

/// Buffers and bind groups of one view; grown, never shrunk.
#[derive(Debug)]
pub struct RainfallViewGpu {
    params: wgpu::Buffer,
    records: wgpu::Buffer,
    streaks: wgpu::Buffer,
    /// As many drops as the buffers hold.
    capacity: u32,
    /// Quads of one draw.
    of_a_draw: u32,
    pub(super) guard_band: Option<GuardBand>,
    pub(super) most: u32,
    pub(super) panes: u32,
    /// Streaks fade where they meet the scene.
    pub(super) soft: bool,
    /// Near streaks have patterns.
    pub(super) patterned: bool,
    /// What is dispatched and drawn: [`HEAD_WORDS`], then the draws of all drops, then those of near ones.
    pub(super) arguments: wgpu::Buffer,
    near_list: wgpu::Buffer,
    /// Where the GPU chooses.
    pub(super) choice: Option<ChoiceGpu>,
    pub(super) chooses: bool,
    pub(super) needs: ProjectKey,
    pub(super) project: Option<wgpu::BindGroup>,
    pub(super) draw: Option<wgpu::BindGroup>,
    pub(super) near: Option<wgpu::BindGroup>,
}

impl RainfallGpu {
    /// Builds the layouts.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let depth = wgpu::TextureSampleType::Depth;
        let raster = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let streaks = storage_entry(1, raster, true);
        let even = [
            params_entry_in(ParamsSpace::Uniform, 0, raster, size_of::<RainfallView>()),
            streaks,
        ];
        let draw = Overlay::uniform(device, "rain rainfall draw", "rainfall_draw", &even)
            .with_constants(|key| vec![("SOFT", f64::from(key.soft)), ("COVERAGE", f64::from(key.coverage))]);
        let view = params_entry(device, 0, raster, size_of::<RainfallView>());
        let near = Overlay::new(
            device,
            "rain rainfall near",
            "rainfall_near",
            &[
                view,
                streaks,
                texture_entry(2, wgpu::ShaderStages::FRAGMENT, depth, wgpu::TextureViewDimension::D2),
                storage_entry(3, wgpu::ShaderStages::FRAGMENT, true),
                texture_entry(
                    4,
                    wgpu::ShaderStages::FRAGMENT,
                    wgpu::TextureSampleType::Float { filterable: true },
                    wgpu::TextureViewDimension::Cube,
                ),
                sampler_entry(5, wgpu::ShaderStages::FRAGMENT),
                storage_entry(6, wgpu::ShaderStages::VERTEX, true),
            ],
        );
        Self {
            choose: Choose::new(device),
            project: Project::new(device),
            draw,
            near,
            quads: QuadIndices::new(device),
            no_depth: one_texel(device, "rain no depth", DEPTH_FORMAT, 1),
            no_environment: one_texel(device, "rain no environment", wgpu::TextureFormat::Rgba8Unorm, 6),
            sampler: linear_sampler(device, "rain environment", wgpu::AddressMode::ClampToEdge),
        }
    }

    /// Makes sure that the pipelines exist that draw so over a target of `format` with `samples` samples.
    pub fn prepare_pipelines(
        &mut self,
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        samples: u32,
        draws: StreakDraws,
    ) {
        let colour = OverlayKey::colour(format, samples);
        let mask = draws.coverage.then(|| OverlayKey::coverage(samples));
        for key in [Some(colour), mask].into_iter().flatten() {
            for key in [Some(key), draws.behind.then(|| key.behind())].into_iter().flatten() {
                self.draw.prepare(device, key.soft(draws.soft));
                if draws.patterned {
                    self.near.prepare(device, key);
                }
            }
        }
    }
}

fn buffer(device: &wgpu::Device, label: &str, bytes: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC | usage,
        mapped_at_creation: false,
    })
}

impl RainfallViewGpu {
    /// Buffers for a view, empty.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let storage = wgpu::BufferUsages::STORAGE;
        Self {
            params: buffer(device, "rain rainfall view", size_of::<RainfallView>() as u64, PARAMS),
            records: buffer(device, "rain drop records", RECORD_BYTES, storage),
            streaks: buffer(device, "rain streaks", STREAK_BYTES, storage),
            near_list: buffer(device, "rain near drops", 4, storage),
            arguments: buffer(device, "rain drop draws", 4 * HEAD_WORDS, storage),
            capacity: 0,
            of_a_draw: quads_of_a_draw(device),
            guard_band: None,
            most: 0,
            panes: 0,
            soft: false,
            patterned: false,
            choice: None,
            chooses: false,
            needs: ProjectKey::default(),
            project: None,
            draw: None,
            near: None,
        }
    }

    /// Room for `most` drops.
    fn grow(&mut self, device: &wgpu::Device, most: u32, holds: u32) {
        let storage = wgpu::BufferUsages::STORAGE;
        if most > self.capacity {
            // A quarter more, so that setting rain does not ask for other buffers in each frame.
            self.capacity = (most + most / 4).next_multiple_of(1024).min(holds);
            let capacity = u64::from(self.capacity);
            self.records = buffer(device, "rain drop records", RECORD_BYTES * capacity, storage);
            self.streaks = buffer(device, "rain streaks", STREAK_BYTES * capacity, storage);
            self.arguments = buffer(
                device,
                "rain drop draws",
                4 * HEAD_WORDS + 2 * DRAW_BYTES * u64::from(self.capacity.div_ceil(self.of_a_draw)),
                storage | wgpu::BufferUsages::INDIRECT,
            );
        }
        if self.patterned && self.near_list.size() < 4 * u64::from(most) {
            self.near_list = buffer(device, "rain near drops", 4 * u64::from(self.capacity), storage);
        }
    }

    /// Draws that the drops are divided into.
    pub(super) fn draws(&self) -> u32 {
        self.most.div_ceil(self.of_a_draw)
    }

    /// Uploads a list of drops. Any of them may be near.
    fn list(&mut self, queue: &wgpu::Queue, records: &[DropRecord]) {
        let drops = self.most;
        let near = if self.patterned { drops } else { 0 };
        let mut words = vec![drops, near, drops, 0, drops.div_ceil(64), 1, 1, 0, 0, 1, 1, 0];
        let draws = |quads| draw_words(quads, self.draws(), self.of_a_draw);
        words.extend(draws(drops).chain(draws(near)));
        queue.write_buffer(&self.arguments, 0, bytemuck::cast_slice(&words));
        if !records.is_empty() {
            queue.write_buffer(&self.records, 0, bytemuck::cast_slice(records));
        }
        if near > 0 {
            let all: Vec<u32> = (0..near).collect();
            queue.write_buffer(&self.near_list, 0, bytemuck::cast_slice(&all));
        }
    }

    /// Uploads a view's inputs and binds its textures. Call once a frame, before encoding.
    ///
    /// `false`: more rain areas are about the view than fit; the last are left out.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        gpu: &RainfallGpu,
        input: &RainfallInput,
        textures: RainfallTextures,
    ) -> bool {
        let mut whole = true;
        match input.drops {
            Drops::Listed(container, _) => {
                self.chooses = false;
                let params = input.params(&container.classes);
                self.upload(device, queue, gpu, params, container.records.len() as u32);
                self.list(queue, &container.records[..self.most as usize]);
            }
            Drops::Chosen(choice) => {
                self.chooses = true;
                let cells = choice.cells();
                let placements = cells.placements();
                self.upload(device, queue, gpu, input.params(&placements), choice.most_drops);
                let targets = ChoiceTargets {
                    view: &self.params,
                    arguments: &self.arguments,
                    records: &self.records,
                    near: &self.near_list,
                    stage: &self.streaks,
                };
                let asked = Asked {
                    choice,
                    cells: &cells,
                    most: self.most,
                    draws: self.draws(),
                    near_reaches: near_reaches(input, &placements),
                };
                let chooser = self.choice.get_or_insert_with(|| ChoiceGpu::new(device));
                whole = chooser.prepare(device, queue, &gpu.choose, &asked, &targets);
            }
        }
        self.bind(device, gpu, textures);
        whole
    }

    /// Uploads what is the same for drops of any origin, with room for `wanted` of them.
    fn upload(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        gpu: &RainfallGpu,
        mut params: RainfallView,
        wanted: u32,
    ) {
        self.guard_band = GuardBand::new(device, params.viewport.into());
        params.guard_share = self.guard_band.map_or(1.0, |band| band.share());
        let holds = device.limits().max_storage_buffer_binding_size / STREAK_BYTES;
        let holds = u32::try_from(holds).unwrap_or(u32::MAX);
        self.most = wanted.min(holds);
        self.panes = params.panes;
        self.soft = params.soft > 0.0;
        self.patterned = params.patterned > 0;
        self.needs = ProjectKey::of(&params);
        gpu.project.prepare(device, self.needs);
        self.grow(device, self.most, holds);
        queue.write_buffer(&self.params, 0, bytemuck::bytes_of(&params));
    }

    fn bind(&mut self, device: &wgpu::Device, gpu: &RainfallGpu, textures: RainfallTextures) {
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let view =
            |texture: Option<&wgpu::TextureView>, fallback: &wgpu::TextureView| texture.unwrap_or(fallback).clone();
        let cover = view(textures.cover, &gpu.no_depth);
        let scene = view(textures.scene_depth, &gpu.no_depth);
        let environment = view(textures.environment, &gpu.no_environment);
        self.project = Some(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("rain rainfall project"),
            layout: gpu.project.layout(device, self.needs),
            entries: &[
                entry(0, self.params.as_entire_binding()),
                entry(1, self.records.as_entire_binding()),
                entry(2, self.streaks.as_entire_binding()),
                entry(3, wgpu::BindingResource::TextureView(&cover)),
                entry(4, wgpu::BindingResource::TextureView(&environment)),
                entry(5, wgpu::BindingResource::Sampler(&gpu.sampler)),
                entry(6, self.arguments.as_entire_binding()),
                entry(7, wgpu::BindingResource::TextureView(&scene)),
            ],
        }));
        let even = [
            entry(0, self.params.as_entire_binding()),
            entry(1, self.streaks.as_entire_binding()),
        ];
        self.draw = Some(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("rain rainfall draw"),
            layout: &gpu.draw.layout,
            entries: &even,
        }));
        let [params, streaks] = even;
        self.near = self.patterned.then(|| {
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("rain rainfall near"),
                layout: &gpu.near.layout,
                entries: &[
                    params,
                    streaks,
                    entry(2, wgpu::BindingResource::TextureView(&scene)),
                    entry(3, self.records.as_entire_binding()),
                    entry(4, wgpu::BindingResource::TextureView(&environment)),
                    entry(5, wgpu::BindingResource::Sampler(&gpu.sampler)),
                    entry(6, self.near_list.as_entire_binding()),
                ],
            })
        });
    }

    /// No more drops than this are drawn in this frame: as many as there are where they are listed, unless the device's buffers
    /// hold fewer.
    #[must_use]
    pub fn most_drops(&self) -> u32 {
        self.most
    }

    /// What is dispatched and drawn, for reading back. The first three words: how many drops are drawn, how many of them may
    /// have a pattern, how many there would be without a limit.
    #[must_use]
    pub fn arguments(&self) -> &wgpu::Buffer {
        &self.arguments
    }

    /// The drops that are drawn, for reading back: [`DropRecord`]s.
    #[must_use]
    pub fn records(&self) -> &wgpu::Buffer {
        &self.records
    }

    /// Which of them may have a pattern, for reading back.
    #[must_use]
    pub fn near_drops(&self) -> &wgpu::Buffer {
        &self.near_list
    }

    /// How much that is transparent this frame tells apart.
    #[must_use]
    pub fn panes(&self) -> u32 {
        self.panes
    }

    /// GPU memory of this view. Units: bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        let own = [
            &self.params,
            &self.records,
            &self.streaks,
            &self.near_list,
            &self.arguments,
        ];
        let own: u64 = own.into_iter().map(wgpu::Buffer::size).sum();
        (own + self.choice.as_ref().map_or(0, ChoiceGpu::memory_bytes)) as usize
    }

    /// The projected streaks, for reading back.
    #[must_use]
    pub fn streaks(&self) -> &wgpu::Buffer {
        &self.streaks
    }
}
