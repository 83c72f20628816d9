//! Commands of the pass.

use super::prepare::{LatticeGpu, LatticeViewGpu};
use crate::overlay::OverlayKey;

/// Draws the cards over a target of `format` with `samples` samples, but those behind glass.
pub fn encode_lattice(
    pass: &mut wgpu::RenderPass,
    gpu: &LatticeGpu,
    view: &LatticeViewGpu,
    format: wgpu::TextureFormat,
    samples: u32,
) {
    encode(pass, gpu, view, OverlayKey::colour(format, samples));
}

/// Draws the cards behind glass, where there is any: before what is transparent is drawn.
pub fn encode_lattice_behind(
    pass: &mut wgpu::RenderPass,
    gpu: &LatticeGpu,
    view: &LatticeViewGpu,
    format: wgpu::TextureFormat,
    samples: u32,
) {
    if view.panes > 0 {
        encode(pass, gpu, view, OverlayKey::colour(format, samples).behind());
    }
}

/// Draws the share of pixels that streaks cover into a [`crate::rainfall::COVERAGE_FORMAT`] target.
pub fn encode_lattice_coverage(pass: &mut wgpu::RenderPass, gpu: &LatticeGpu, view: &LatticeViewGpu, samples: u32) {
    let key = OverlayKey::coverage(samples);
    if view.panes > 0 {
        encode(pass, gpu, view, key.behind());
    }
    encode(pass, gpu, view, key);
}

fn encode(pass: &mut wgpu::RenderPass, gpu: &LatticeGpu, view: &LatticeViewGpu, key: OverlayKey) {
    let (Some(group), Some(pipeline)) = (&view.group, gpu.draw.get(key)) else {
        return;
    };
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group, &[]);
    pass.draw(0..6 * view.count, 0..1);
}
