//! Commands of the pass.

use super::prepare::{HEAD_WORDS, PROJECT_WORD, RainfallGpu, RainfallViewGpu};
use crate::overlay::OverlayKey;
use crate::quad_indices::DRAW_BYTES;

/// Chooses this frame's drops, unless they are listed; places, covers and projects them.
pub fn encode_project(pass: &mut wgpu::ComputePass, gpu: &RainfallGpu, view: &RainfallViewGpu) {
    let (Some(bind_group), Some(pipeline)) = (&view.project, gpu.project.get(view.needs)) else {
        return;
    };
    if view.most == 0 {
        return;
    }
    if let Some(choice) = view.choice.as_ref().filter(|_| view.chooses) {
        choice.encode(pass, &gpu.choose, &view.arguments);
    }
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, bind_group, &[]);
    pass.dispatch_workgroups_indirect(&view.arguments, 4 * PROJECT_WORD);
}

/// Draws the projected streaks over a target of `format` with `samples` samples, but those behind glass.
///
/// The pass's viewport is the view's ([`RainfallInput::viewport_px`](super::RainfallInput)), which lies in the target; on a
/// software device it is the scissor rectangle afterwards too.
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
    if let Some(band) = &view.guard_band {
        band.open(pass);
    }
    encode_quads(pass, gpu, view, key);
    if let Some(band) = &view.guard_band {
        band.close(pass);
    }
}

fn encode_quads(pass: &mut wgpu::RenderPass, gpu: &RainfallGpu, view: &RainfallViewGpu, key: OverlayKey) {
    let (all, draws) = (4 * HEAD_WORDS, view.draws());
    if let (Some(bind_group), Some(pipeline)) = (&view.draw, gpu.draw.get(key.soft(view.soft))) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, bind_group, &[]);
        // Big vertex-pulling draws: tiny instances waste most of a SIMD batch.
        gpu.quads.draw(pass, &view.arguments, all, draws);
    }
    if !view.patterned {
        return;
    }
    // Streaks with a pattern, by a pipeline of their own: its fragments would slow all others down.
    if let (Some(bind_group), Some(pipeline)) = (&view.near, gpu.near.get(key)) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, bind_group, &[]);
        gpu.quads
            .draw(pass, &view.arguments, all + DRAW_BYTES * u64::from(draws), draws);
    }
}
