//! Choosing the drops of a view on the GPU: nothing that grows with their number goes up or comes back.
//!
//! Runs of neighbouring cells that reach into the view are noted, their drops counted and staged, counts summed up, and drops
//! listed in the order of their cells, so that the list is the same each time. A run with more drops than its part of the stage
//! holds is looked through again.
//! A software device runs masked-off code too: there uneven rain and what thins it are in the pipelines of views that have
//! them only. A GPU has one set, so that the first shower makes no frame wait.

use std::sync::OnceLock;

use glam::{Vec3, Vec4};
use rain_core::rainfall::areas::{AreaFieldF32, MAX_PACKED_ROWS};
use rain_core::rainfall::{
    CLASS_COUNT, DetailLaw, DropChoice, Follow, FollowSettings, FollowShape, RateLadder, SizeClass, Threshold,
    UnevenRain, ViewCells,
};

use crate::bindings::{compute_pipeline_with, params_entry_in, storage_entry};
use crate::compose;
use crate::gpu_types::{ChoiceClass, RainfallChoice, RainfallView};
use crate::params_space::{BySpace, PARAMS, ParamsSpace};
use crate::quad_indices::quads_of_a_draw;
use crate::rainfall::prepare::AGAIN_WORD;

/// Invocations of a workgroup, as the shader has it.
const WORKGROUP: u32 = 64;

/// Runs of a group, as the shader has it.
const GROUP: u32 = 16;

/// Workgroups are dispatched in rows of this many, as the shader has it.
const ROW: u32 = 32_768;

/// What the choices of views differ by.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
struct ChoiceKey {
    uneven: bool,
    thinned: bool,
    patterned: bool,
}

impl ChoiceKey {
    const EVERYTHING: Self = Self {
        uneven: true,
        thinned: true,
        patterned: true,
    };

    fn index(self) -> usize {
        usize::from(self.uneven) + 2 * usize::from(self.thinned) + 4 * usize::from(self.patterned)
    }
}

#[derive(Debug)]
struct Pipelines {
    begin: wgpu::ComputePipeline,
    note: wgpu::ComputePipeline,
    count: wgpu::ComputePipeline,
    sum: wgpu::ComputePipeline,
    scan: wgpu::ComputePipeline,
    list: wgpu::ComputePipeline,
    list_again: wgpu::ComputePipeline,
}

/// Bindings of what notes and sums up; of what counts and lists: these are dispatched by what the others write.
const SUMMING: [(u32, bool); 4] = [(2, false), (3, false), (4, false), (10, false)];
const FINDING: [(u32, bool); 8] = [
    (2, false),
    (3, false),
    (5, false),
    (6, false),
    (7, true),
    (8, true),
    (9, false),
    (11, true),
];

/// The module and its layouts, with parameters in one space.
#[derive(Debug)]
struct Passes {
    summing: wgpu::BindGroupLayout,
    finding: wgpu::BindGroupLayout,
    module: wgpu::ShaderModule,
}

impl Passes {
    fn new(device: &wgpu::Device, space: ParamsSpace) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let layout = |buffers: &[(u32, bool)]| {
            let mut entries = vec![
                params_entry_in(space, 0, compute, size_of::<RainfallView>()),
                params_entry_in(space, 1, compute, size_of::<RainfallChoice>()),
            ];
            entries.extend(
                buffers
                    .iter()
                    .map(|(binding, read_only)| storage_entry(*binding, compute, *read_only)),
            );
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some("rain rainfall choose"),
                entries: &entries,
            })
        };
        Self {
            summing: layout(&SUMMING),
            finding: layout(&FINDING),
            module: compose::shader_in(space, device, "rainfall_choose"),
        }
    }
}

/// The layouts and the pipelines.
#[derive(Debug)]
pub(super) struct Choose {
    passes: BySpace<Passes>,
    /// Views have pipelines of their own.
    apart: bool,
    pipelines: [OnceLock<Pipelines>; 8],
}

impl Choose {
    pub fn new(device: &wgpu::Device) -> Self {
        let choose = Self {
            passes: BySpace::new(device),
            apart: device.adapter_info().device_type == wgpu::DeviceType::Cpu,
            pipelines: Default::default(),
        };
        if !choose.apart {
            choose.prepare(device, ChoiceKey::EVERYTHING);
        }
        choose
    }

    fn serving(&self, key: ChoiceKey) -> ChoiceKey {
        if self.apart { key } else { ChoiceKey::EVERYTHING }
    }

    /// What the pipelines of a view are made of, and their space: only what leaves drops out has branches that test
    /// parameters alone.
    fn passes(&self, device: &wgpu::Device, key: ChoiceKey) -> (&Passes, ParamsSpace) {
        let space = self.passes.space(self.serving(key).thinned);
        (self.passes.get(space, |space| Passes::new(device, space)), space)
    }

    fn prepare(&self, device: &wgpu::Device, key: ChoiceKey) {
        let key = self.serving(key);
        if let Some(slot) = self.pipelines.get(key.index()) {
            slot.get_or_init(|| {
                let (passes, _) = self.passes(device, key);
                let constants = [
                    ("UNEVEN", f64::from(key.uneven)),
                    ("THINNED", f64::from(key.thinned)),
                    ("PATTERNED", f64::from(key.patterned)),
                    ("QUADS_OF_A_DRAW", f64::from(quads_of_a_draw(device))),
                ];
                let pipeline = |entry: &str, layout: &wgpu::BindGroupLayout| {
                    compute_pipeline_with(
                        device,
                        "rain rainfall choose",
                        &passes.module,
                        entry,
                        &[layout],
                        &constants,
                    )
                };
                Pipelines {
                    begin: pipeline("begin", &passes.summing),
                    note: pipeline("note", &passes.summing),
                    count: pipeline("count", &passes.finding),
                    sum: pipeline("sum", &passes.summing),
                    scan: pipeline("scan", &passes.summing),
                    list: pipeline("list", &passes.finding),
                    list_again: pipeline("list_again", &passes.finding),
                }
            });
        }
    }
}

/// Buffers of a view that chooses; grown, never shrunk.
#[derive(Debug)]
pub(super) struct ChoiceGpu {
    params: wgpu::Buffer,
    counts: wgpu::Buffer,
    sums: wgpu::Buffer,
    noted: wgpu::Buffer,
    areas: wgpu::Buffer,
    ladder: wgpu::Buffer,
    /// What the ladder's buffer holds.
    ladder_of: Option<std::sync::Arc<RateLadder>>,
    packed: AreaFieldF32,
    key: ChoiceKey,
    rows: u32,
    groups: u32,
    bind_groups: Option<BindGroups>,
}

#[derive(Debug)]
struct BindGroups {
    summing: wgpu::BindGroup,
    finding: wgpu::BindGroup,
    of: [wgpu::Buffer; 12],
    space: ParamsSpace,
}

fn storage(device: &wgpu::Device, label: &str, bytes: u64) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes.max(16),
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// Words before the list of noted runs: how many there are, and the workgroups for them.
const NOTED: u64 = 4;

/// Room for a list of `runs` runs.
fn noted(device: &wgpu::Device, runs: u32) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("rain runs of cells in view"),
        size: 4 * (NOTED + u64::from(runs)),
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT,
        mapped_at_creation: false,
    })
}

/// Makes a buffer larger that is too small.
fn grow(device: &wgpu::Device, buffer: &mut wgpu::Buffer, label: &str, bytes: u64) {
    if buffer.size() < bytes {
        // A quarter more, so that a view that opens slowly does not ask for another in each frame.
        *buffer = storage(device, label, (bytes + bytes / 4).next_multiple_of(256));
    }
}

/// What is chosen from, and by what.
pub(super) struct Asked<'a> {
    pub choice: &'a DropChoice,
    /// Its cells.
    pub cells: &'a ViewCells,
    /// No more drops are listed.
    pub most: u32,
    /// Draws that they are divided into.
    pub draws: u32,
    /// As [`super::near::near_reaches`] has them.
    pub near_reaches: [f32; CLASS_COUNT],
}

/// What the bind group of a choice takes from its view.
pub(super) struct ChoiceTargets<'a> {
    pub view: &'a wgpu::Buffer,
    pub arguments: &'a wgpu::Buffer,
    pub records: &'a wgpu::Buffer,
    pub near: &'a wgpu::Buffer,
    /// Streaks are made after the choice: until then drops are staged there.
    pub stage: &'a wgpu::Buffer,
}

impl ChoiceGpu {
    pub fn new(device: &wgpu::Device) -> Self {
        Self {
            params: device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("rain drop choice"),
                size: size_of::<RainfallChoice>() as u64,
                usage: PARAMS | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
            counts: storage(device, "rain drop counts", 4096),
            sums: storage(device, "rain drop sums", 512),
            noted: noted(device, 1024),
            areas: storage(device, "rain areas of drops", 16),
            ladder: storage(device, "rain ladder of rates", 16),
            ladder_of: None,
            packed: AreaFieldF32::default(),
            key: ChoiceKey::default(),
            rows: 0,
            groups: 0,
            bind_groups: None,
        }
    }

    /// Uploads what is chosen from. `false`: there are more areas than fit, and the last are left out.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        choose: &Choose,
        asked: &Asked,
        targets: &ChoiceTargets,
    ) -> bool {
        let choice = asked.choice;
        self.key = ChoiceKey {
            uneven: choice.uneven.is_some(),
            thinned: choice.region.is_some() || choice.detail.is_some(),
            patterned: asked.near_reaches.iter().any(|reach| *reach > 0.0),
        };
        choose.prepare(device, self.key);
        let stage = u32::try_from(targets.stage.size() / 4).unwrap_or(u32::MAX);
        let params = params(asked, stage);
        (self.rows, self.groups) = (params.rows, params.groups);
        queue.write_buffer(&self.params, 0, bytemuck::bytes_of(&params));
        grow(device, &mut self.counts, "rain drop counts", 4 * u64::from(params.runs));
        grow(device, &mut self.sums, "rain drop sums", 8 * u64::from(params.groups));
        if self.noted.size() < 4 * (NOTED + u64::from(params.runs)) {
            self.noted = noted(device, params.runs + params.runs / 4);
        }
        let mut whole = true;
        if let Some(rain) = &choice.uneven {
            whole = self.prepare_uneven(device, queue, choice, rain);
        }
        self.bind(device, choose, targets);
        whole
    }

    /// Binds what it reads and writes, unless that is bound already.
    fn bind(&mut self, device: &wgpu::Device, choose: &Choose, targets: &ChoiceTargets) {
        // By binding.
        let buffers = [
            targets.view,
            &self.params,
            &self.counts,
            &self.sums,
            targets.arguments,
            targets.records,
            targets.near,
            &self.areas,
            &self.ladder,
            targets.stage,
            &self.noted,
            &self.noted,
        ]
        .map(Clone::clone);
        let (passes, space) = choose.passes(device, self.key);
        let bound = |groups: &BindGroups| groups.of == buffers && groups.space == space;
        if self.bind_groups.as_ref().is_some_and(bound) {
            return;
        }
        let group = |layout, bindings: &[(u32, bool)]| {
            let bindings = [0, 1].into_iter().chain(bindings.iter().map(|(binding, _)| *binding));
            let entries: Vec<_> = bindings
                .map(|binding| wgpu::BindGroupEntry {
                    binding,
                    resource: buffers[binding as usize].as_entire_binding(),
                })
                .collect();
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("rain rainfall choose"),
                layout,
                entries: &entries,
            })
        };
        self.bind_groups = Some(BindGroups {
            summing: group(&passes.summing, &SUMMING),
            finding: group(&passes.finding, &FINDING),
            of: buffers,
            space,
        });
    }

    fn prepare_uneven(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        choice: &DropChoice,
        rain: &UnevenRain,
    ) -> bool {
        let eye = eye_of(choice);
        let reach = choice.reach_m();
        let whole = rain.areas.pack(glam::DVec2::new(eye.x, eye.z), reach, &mut self.packed);
        grow(
            device,
            &mut self.areas,
            "rain areas of drops",
            16 * (MAX_PACKED_ROWS as u64 + 1),
        );
        let head = [[
            self.packed.areas as f32,
            self.packed.outside,
            rain.weather_mm_h as f32,
            0.0,
        ]];
        queue.write_buffer(&self.areas, 0, bytemuck::cast_slice(&head));
        queue.write_buffer(&self.areas, 16, bytemuck::cast_slice(&self.packed.rows));
        let known = self.ladder_of.as_ref();
        if known.is_none_or(|known| !std::sync::Arc::ptr_eq(known, &rain.ladder)) {
            let lines: Vec<[f32; 2]> = rain.ladder.ln_lines().collect();
            grow(device, &mut self.ladder, "rain ladder of rates", 8 * lines.len() as u64);
            queue.write_buffer(&self.ladder, 0, bytemuck::cast_slice(&lines));
            self.ladder_of = Some(rain.ladder.clone());
        }
        whole
    }

    /// Chooses. `arguments`: those that it was prepared with.
    pub fn encode(&self, pass: &mut wgpu::ComputePass, choose: &Choose, arguments: &wgpu::Buffer) {
        let slot = choose.pipelines.get(choose.serving(self.key).index());
        let (Some(pipelines), Some(groups)) = (slot.and_then(OnceLock::get), &self.bind_groups) else {
            return;
        };
        let dispatch = |pass: &mut wgpu::ComputePass, pipeline, group, invocations: u32| {
            let groups = invocations.div_ceil(WORKGROUP);
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, group, &[]);
            pass.dispatch_workgroups(groups.min(ROW), groups.div_ceil(ROW), 1);
        };
        let indirect = |pass: &mut wgpu::ComputePass, pipeline, buffer, word: u64| {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &groups.finding, &[]);
            pass.dispatch_workgroups_indirect(buffer, 4 * word);
        };
        dispatch(pass, &pipelines.begin, &groups.summing, 1);
        dispatch(pass, &pipelines.note, &groups.summing, self.rows);
        indirect(pass, &pipelines.count, &self.noted, 1);
        dispatch(pass, &pipelines.sum, &groups.summing, self.groups);
        dispatch(pass, &pipelines.scan, &groups.summing, 1);
        indirect(pass, &pipelines.list, &self.noted, 1);
        indirect(pass, &pipelines.list_again, arguments, AGAIN_WORD);
    }

    /// GPU memory. Units: bytes.
    pub fn memory_bytes(&self) -> u64 {
        let buffers = [
            &self.params,
            &self.counts,
            &self.sums,
            &self.noted,
            &self.areas,
            &self.ladder,
        ];
        buffers.into_iter().map(wgpu::Buffer::size).sum()
    }
}

fn eye_of(choice: &DropChoice) -> glam::DVec3 {
    if choice.view.eye_m.is_finite() {
        choice.view.eye_m
    } else {
        glam::DVec3::ZERO
    }
}

/// Half its width, half its height, how far ahead, and what it is.
fn region_terms(settings: &FollowSettings) -> [f32; 4] {
    match settings.shape {
        FollowShape::SemiCylinder {
            across_m,
            ahead_m,
            height_m,
        } => [across_m, 0.5 * height_m, ahead_m, 1.0],
        FollowShape::Block {
            width_m,
            height_m,
            depth_m,
        } => [0.5 * width_m, 0.5 * height_m, depth_m, 2.0],
    }
    .map(|v| v as f32)
}

/// Drops that a run has at least, if it may have as many cells. Units: none.
const DROPS_OF_RUN: f32 = 4.0;

/// Most cells of a run: four bits name one.
const MOST_CELLS: u32 = 16;

/// How many of `side` cells of a row are looked through together where no rank is above `limit`: so many that there are some drops
/// in them, for most cells of thin rain have none.
fn cells_of_run(limit: f32, side: u32) -> u32 {
    let cells = (DROPS_OF_RUN / limit.max(0.01)).ceil() as u32;
    cells.clamp(1, MOST_CELLS).min(side.max(1))
}

/// How many drops of each of `runs` runs are staged that have `limit` candidates in the mean: their number is Poisson's, and one in
/// a hundred thousand that has more is looked through again. None where there is no room for as many on what is `left` of the
/// stage: then all runs are looked through again.
fn room(limit: f32, runs: u32, left: u32) -> u32 {
    let room = (limit + 4.5 * limit.max(0.0).sqrt()).ceil() as u32 + 3;
    if u64::from(runs) * u64::from(room) <= u64::from(left) {
        room
    } else {
        0
    }
}

/// The parameters of a stage of so many drops.
fn params(asked: &Asked, stage: u32) -> RainfallChoice {
    let Asked {
        choice,
        cells,
        most,
        draws,
        near_reaches,
    } = *asked;
    let mut out = RainfallChoice {
        planes: choice.view.side_planes.map(|plane| Vec4::to_array(&plane)),
        most,
        draws,
        detail: match choice.detail {
            None => 0,
            Some(DetailLaw::OpticalDepth) => 1,
            Some(DetailLaw::Quadratic { .. }) => 2,
            Some(DetailLaw::Gaussian { .. }) => 3,
        },
        kappa: choice.kappa as f32,
        focal: choice.view.focal_px as f32,
        exposure: choice.view.exposure_s as f32,
        parallel: u32::from(choice.view.parallel.is_some()),
        ..RainfallChoice::default()
    };
    if let Some((follow, settings)) = &choice.region {
        let Follow { centre_m, heading_rad } = *follow;
        let place: Vec3 = (centre_m - eye_of(choice)).as_vec3();
        out.region = region_terms(settings);
        out.region_place = place.extend(settings.slack_m as f32).to_array();
        let (sin, cos) = heading_rad.sin_cos();
        out.region_turn = [sin as f32, cos as f32, settings.rim_m as f32, 0.0];
    }
    let highest = choice.uneven.as_ref().map(|rain| {
        out.ladder = [
            RateLadder::FIRST_MM_H.ln() as f32,
            RateLadder::KNOTS_PER_E_FOLD as f32,
            rain.ladder.knots_of_class() as f32,
            0.0,
        ];
        let eye = eye_of(choice);
        let place = glam::DVec2::new(eye.x, eye.z);
        let rates = rain.areas.rates_within(place, choice.reach_m(), rain.weather_mm_h);
        (&rain.ladder, rates[1])
    });
    let mut staged = 0_u32;
    for (k, (slot, of)) in out.classes.iter_mut().zip(&cells.classes).enumerate() {
        let threshold = Threshold::new(&SizeClass::new(k), &choice.spectrum);
        let [scale, slope] = threshold.terms();
        let ranks = match &highest {
            None => [threshold.scan_limit(), threshold.whole_limit(), scale, slope],
            Some((ladder, rate)) if *rate > 0.0 => [ladder.scan_limit(k, *rate), -1.0, 0.0, 0.0],
            Some(_) => [0.0, -1.0, 0.0, 0.0],
        };
        let together = cells_of_run(ranks[0], of.side.x);
        let rows = of.side.y * of.side.z;
        let runs = of.side.x.div_ceil(together) * rows;
        let room = room(ranks[0] * together as f32, runs, stage - staged);
        *slot = ChoiceClass {
            low: of.low.extend(out.rows as i32).to_array(),
            side: of.side.extend(together).to_array(),
            runs: [out.runs, runs, room, staged],
            ranks,
            reach: [of.reach_m, of.least_reach_m, near_reaches[k], 0.0],
            out: of.sides.map(|plane| plane.w),
        };
        out.rows += rows;
        out.runs += runs;
        staged += runs * room;
    }
    out.groups = out.runs.div_ceil(GROUP);
    let lead = cells.lead_m;
    if lead != Vec3::ZERO {
        out.lead = lead.extend(0.0).to_array();
        out.along = (lead / lead.length_squared()).extend(1.0).to_array();
    }
    out
}
