//! Pipelines of the projection. A software device runs masked-off code too: there each has only what its view needs. On a
//! GPU one serves all, made at the start, so that the first lamp or gust makes no frame wait.

use std::sync::OnceLock;

use crate::bindings::{compute_pipeline_with, params_entry_in, sampler_entry, storage_entry, texture_entry};
use crate::compose;
use crate::gpu_types::RainfallView;
use crate::params_space::{BySpace, ParamsSpace};

/// How drops are tested against the cover map: `COVER` of `shaders/passes/rainfall_project.wgsl`.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
enum CoverTest {
    /// There is no map.
    #[default]
    Open,
    /// Everything falls straight down: one look-up tells.
    Straight,
    /// Rain is driven by wind.
    Driven,
}

/// What the projections of views differ by.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub(super) struct ProjectKey {
    cover: CoverTest,
    environment: bool,
    lamps: bool,
    panes: bool,
    soft: bool,
}

impl ProjectKey {
    const EVERYTHING: Self = Self {
        cover: CoverTest::Driven,
        environment: true,
        lamps: true,
        panes: true,
        soft: true,
    };

    /// What a view needs.
    pub fn of(view: &RainfallView) -> Self {
        let straight = view.cover.wind == [0.0; 2]
            && view
                .classes
                .iter()
                .all(|class| class.velocity[0] == 0.0 && class.velocity[2] == 0.0);
        Self {
            cover: match (view.cover.present < 0.5, straight) {
                (true, _) => CoverTest::Open,
                (false, true) => CoverTest::Straight,
                (false, false) => CoverTest::Driven,
            },
            environment: view.environment[..3] != [0.0; 3],
            lamps: view.lamps > 0,
            panes: view.panes > 0,
            soft: view.soft > 0.0,
        }
    }

    fn index(self) -> usize {
        let flags = [self.environment, self.lamps, self.panes, self.soft];
        flags
            .into_iter()
            .fold(self.cover as usize, |index, flag| 2 * index + usize::from(flag))
    }
}

/// The module and its layout, with parameters in one space.
#[derive(Debug)]
struct Pass {
    layout: wgpu::BindGroupLayout,
    module: wgpu::ShaderModule,
}

/// The projection's layouts and its pipelines.
#[derive(Debug)]
pub(super) struct Project {
    passes: BySpace<Pass>,
    /// Views have pipelines of their own.
    apart: bool,
    pipelines: [OnceLock<wgpu::ComputePipeline>; 48],
}

impl Pass {
    fn new(device: &wgpu::Device, space: ParamsSpace) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("rain rainfall project"),
            entries: &[
                params_entry_in(space, 0, compute, size_of::<RainfallView>()),
                storage_entry(1, compute, true),
                storage_entry(2, compute, false),
                texture_entry(
                    3,
                    compute,
                    wgpu::TextureSampleType::Depth,
                    wgpu::TextureViewDimension::D2,
                ),
                texture_entry(
                    4,
                    compute,
                    wgpu::TextureSampleType::Float { filterable: true },
                    wgpu::TextureViewDimension::Cube,
                ),
                sampler_entry(5, compute),
                storage_entry(6, compute, true),
                texture_entry(
                    7,
                    compute,
                    wgpu::TextureSampleType::Depth,
                    wgpu::TextureViewDimension::D2,
                ),
            ],
        });
        Self {
            layout,
            module: compose::shader_in(space, device, "rainfall_project"),
        }
    }
}

impl Project {
    pub fn new(device: &wgpu::Device) -> Self {
        let project = Self {
            passes: BySpace::new(device),
            apart: device.adapter_info().device_type == wgpu::DeviceType::Cpu,
            pipelines: [const { OnceLock::new() }; 48],
        };
        if !project.apart {
            project.prepare(device, ProjectKey::EVERYTHING);
        }
        project
    }

    /// What serves a view that needs this.
    fn serving(&self, key: ProjectKey) -> ProjectKey {
        if self.apart { key } else { ProjectKey::EVERYTHING }
    }

    /// What the pipeline of a view is made of: lamps and panes are loops that test parameters alone.
    fn pass(&self, device: &wgpu::Device, key: ProjectKey) -> &Pass {
        let key = self.serving(key);
        let space = self.passes.space(key.lamps || key.panes);
        self.passes.get(space, |space| Pass::new(device, space))
    }

    /// The layout of what a view binds.
    pub fn layout(&self, device: &wgpu::Device, key: ProjectKey) -> &wgpu::BindGroupLayout {
        &self.pass(device, key).layout
    }

    /// Makes sure that the pipeline exists.
    pub fn prepare(&self, device: &wgpu::Device, key: ProjectKey) {
        let key = self.serving(key);
        if let Some(slot) = self.pipelines.get(key.index()) {
            slot.get_or_init(|| {
                let pass = self.pass(device, key);
                compute_pipeline_with(
                    device,
                    "rain rainfall project",
                    &pass.module,
                    "project",
                    &[&pass.layout],
                    &[
                        ("COVER", key.cover as u32 as f64),
                        ("ENVIRONMENT", f64::from(key.environment)),
                        ("LAMPS", f64::from(key.lamps)),
                        ("PANES", f64::from(key.panes)),
                        ("SOFT", f64::from(key.soft)),
                    ],
                )
            });
        }
    }

    pub fn get(&self, key: ProjectKey) -> Option<&wgpu::ComputePipeline> {
        self.pipelines.get(self.serving(key).index())?.get()
    }
}
