//! What is drawn over a finished scene: the pipelines of streaks, cards, splashes and haze for every kind of target.

use std::collections::HashMap;

use crate::compose;
use crate::params_space::ParamsSpace;
use crate::rainfall::{COVERAGE_FORMAT, DEPTH_FORMAT};

/// What pipelines differ by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct OverlayKey {
    format: wgpu::TextureFormat,
    samples: u32,
    /// Coverage instead of colour.
    pub coverage: bool,
    /// What lies behind glass instead of what does not.
    behind: bool,
    /// Fades where it meets the scene; for shaders with a constant for it.
    pub soft: bool,
    /// Mist of splashes is in it; likewise.
    pub mist: bool,
}

impl OverlayKey {
    /// Colour over a target.
    pub fn colour(format: wgpu::TextureFormat, samples: u32) -> Self {
        Self {
            format,
            samples,
            coverage: false,
            behind: false,
            soft: false,
            mist: false,
        }
    }

    /// Coverage into a [`COVERAGE_FORMAT`] target.
    pub fn coverage(samples: u32) -> Self {
        Self {
            format: COVERAGE_FORMAT,
            samples,
            coverage: true,
            behind: false,
            soft: false,
            mist: false,
        }
    }

    /// The same for what lies behind glass.
    pub fn behind(self) -> Self {
        Self { behind: true, ..self }
    }

    /// The same, fading where it meets the scene.
    pub fn soft(self, soft: bool) -> Self {
        Self { soft, ..self }
    }

    /// The same with mist of splashes.
    pub fn mist(self, mist: bool) -> Self {
        Self { mist, ..self }
    }
}

/// Pipelines of one shader with the entry points `vertex`, `colour` and `coverage`, and `vertex_behind` where it tells what
/// lies behind glass, made when they are asked for.
#[derive(Debug)]
pub(crate) struct Overlay {
    label: &'static str,
    pub layout: wgpu::BindGroupLayout,
    pipeline_layout: wgpu::PipelineLayout,
    shader: wgpu::ShaderModule,
    /// Tested against the scene's depth, which is attached.
    tested: bool,
    /// What the shader's pipeline constants are.
    constants: fn(OverlayKey) -> Vec<(&'static str, f64)>,
    made: HashMap<OverlayKey, wgpu::RenderPipeline>,
}

impl Overlay {
    /// Of the pass `pass`, with these bindings, tested against the scene's depth.
    pub fn new(device: &wgpu::Device, label: &'static str, pass: &str, entries: &[wgpu::BindGroupLayoutEntry]) -> Self {
        Self::of(device, label, compose::shader(device, pass), entries, true)
    }

    /// The same with parameters in uniform buffers on every device: for shaders with no branch that tests them alone.
    pub fn uniform(
        device: &wgpu::Device,
        label: &'static str,
        pass: &str,
        entries: &[wgpu::BindGroupLayoutEntry],
    ) -> Self {
        let shader = compose::shader_in(ParamsSpace::Uniform, device, pass);
        Self::of(device, label, shader, entries, true)
    }

    /// The same for a shader with pipeline constants.
    pub fn with_constants(self, constants: fn(OverlayKey) -> Vec<(&'static str, f64)>) -> Self {
        Self { constants, ..self }
    }

    /// Of a shader that reads the scene's depth itself, if at all; without a depth attachment.
    pub fn untested(
        device: &wgpu::Device,
        label: &'static str,
        shader: wgpu::ShaderModule,
        entries: &[wgpu::BindGroupLayoutEntry],
    ) -> Self {
        Self::of(device, label, shader, entries, false)
    }

    fn of(
        device: &wgpu::Device,
        label: &'static str,
        shader: wgpu::ShaderModule,
        entries: &[wgpu::BindGroupLayoutEntry],
        tested: bool,
    ) -> Self {
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(label),
            entries,
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(label),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        Self {
            label,
            layout,
            pipeline_layout,
            shader,
            tested,
            constants: |_| Vec::new(),
            made: HashMap::new(),
        }
    }

    /// Makes sure that the pipelines for a target exist; `coverage` asks for the mask's as well, `behind` for those of what
    /// lies behind glass.
    pub fn prepare_all(
        &mut self,
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        samples: u32,
        coverage: bool,
        behind: bool,
    ) {
        let colour = OverlayKey::colour(format, samples);
        let mask = coverage.then(|| OverlayKey::coverage(samples));
        for key in [Some(colour), mask].into_iter().flatten() {
            self.prepare(device, key);
            if behind {
                self.prepare(device, key.behind());
            }
        }
    }

    /// Makes sure that a pipeline exists.
    pub fn prepare(&mut self, device: &wgpu::Device, key: OverlayKey) {
        if !self.made.contains_key(&key) {
            let pipeline = self.pipeline(device, key);
            self.made.insert(key, pipeline);
        }
    }

    pub fn get(&self, key: OverlayKey) -> Option<&wgpu::RenderPipeline> {
        self.made.get(&key)
    }

    fn pipeline(&self, device: &wgpu::Device, key: OverlayKey) -> wgpu::RenderPipeline {
        let add = |src_factor, dst_factor| wgpu::BlendComponent {
            src_factor,
            dst_factor,
            operation: wgpu::BlendOperation::Add,
        };
        let constants = (self.constants)(key);
        let options = || wgpu::PipelineCompilationOptions {
            constants: &constants,
            ..Default::default()
        };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.label),
            layout: Some(&self.pipeline_layout),
            vertex: wgpu::VertexState {
                module: &self.shader,
                entry_point: Some(if key.behind { "vertex_behind" } else { "vertex" }),
                compilation_options: options(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: self.tested.then(|| wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(false),
                depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState {
                count: key.samples,
                ..Default::default()
            },
            fragment: Some(wgpu::FragmentState {
                module: &self.shader,
                entry_point: Some(if key.coverage { "coverage" } else { "colour" }),
                compilation_options: options(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: key.format,
                    blend: Some(wgpu::BlendState {
                        color: add(wgpu::BlendFactor::One, wgpu::BlendFactor::OneMinusSrcAlpha),
                        // The target's own alpha stays what the scene made it.
                        alpha: add(wgpu::BlendFactor::Zero, wgpu::BlendFactor::One),
                    }),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
