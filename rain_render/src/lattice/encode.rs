//! Commands of the pass.

use super::prepare::{DrawKey, LatticeGpu, LatticeViewGpu};
use crate::rainfall::COVERAGE_FORMAT;

/// Draws the cards over a target of `format` with `samples` samples.
pub fn encode_lattice(
    pass: &mut wgpu::RenderPass,
    gpu: &LatticeGpu,
    view: &LatticeViewGpu,
    format: wgpu::TextureFormat,
    samples: u32,
) {
    encode(pass, gpu, view, (format, samples, false, view.soft));
}

/// Draws the share of pixels that streaks cover into a [`COVERAGE_FORMAT`] target.
pub fn encode_lattice_coverage(pass: &mut wgpu::RenderPass, gpu: &LatticeGpu, view: &LatticeViewGpu, samples: u32) {
    encode(pass, gpu, view, (COVERAGE_FORMAT, samples, true, view.soft));
}

fn encode(pass: &mut wgpu::RenderPass, gpu: &LatticeGpu, view: &LatticeViewGpu, key: DrawKey) {
    let (Some(group), Some(pipeline)) = (&view.group, gpu.pipelines.get(&key)) else {
        return;
    };
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group, &[]);
    pass.draw(0..6 * view.count, 0..1);
}
