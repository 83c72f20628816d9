//! Commands of the pass.

use super::prepare::{RainfallGpu, RainfallViewGpu};
use crate::overlay::OverlayKey;

/// Places, covers and projects this frame's drops.
pub fn encode_project(pass: &mut wgpu::ComputePass, gpu: &RainfallGpu, view: &RainfallViewGpu) {
    let (Some(bind_group), Some(pipeline)) = (&view.project, gpu.project.get(view.needs)) else {
        return;
    };
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, bind_group, &[]);
    pass.dispatch_workgroups(view.drops.div_ceil(64), 1, 1);
}

/// Draws the projected streaks over a target of `format` with `samples` samples, but those behind glass.
pub fn encode_draw(
    pass: &mut wgpu::RenderPass,
    gpu: &RainfallGpu,
    view: &RainfallViewGpu,
    format: wgpu::TextureFormat,
    samples: u32,
) {
    encode(pass, gpu, view, OverlayKey::colour(format, samples));
}

/// Draws the streaks behind glass, where there is any: before what is transparent is drawn.
pub fn encode_behind(
    pass: &mut wgpu::RenderPass,
    gpu: &RainfallGpu,
    view: &RainfallViewGpu,
    format: wgpu::TextureFormat,
    samples: u32,
) {
    if view.panes > 0 {
        encode(pass, gpu, view, OverlayKey::colour(format, samples).behind());
    }
}

/// Draws the coverage of all streaks into a [`super::COVERAGE_FORMAT`] target.
pub fn encode_coverage(pass: &mut wgpu::RenderPass, gpu: &RainfallGpu, view: &RainfallViewGpu, samples: u32) {
    let key = OverlayKey::coverage(samples);
    if view.panes > 0 {
        encode(pass, gpu, view, key.behind());
    }
    encode(pass, gpu, view, key);
}

fn encode(pass: &mut wgpu::RenderPass, gpu: &RainfallGpu, view: &RainfallViewGpu, key: OverlayKey) {
    if let (Some(bind_group), Some(pipeline)) = (&view.draw, gpu.draw.get(key.soft(view.soft))) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, bind_group, &[]);
        // Big vertex-pulling draws: tiny instances waste most of a SIMD batch.
        gpu.quads.draw(pass, view.drops);
    }
    if view.near_drops.is_empty() {
        return;
    }
    // Streaks with a pattern, by a pipeline of their own: its fragments would slow all others down.
    if let (Some(bind_group), Some(pipeline)) = (&view.near, gpu.near.get(key)) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, bind_group, &[]);
        gpu.quads.draw(pass, view.near_drops.len() as u32);
    }
}
