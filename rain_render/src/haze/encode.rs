//! Commands of the pass.

use super::prepare::{HazeGpu, HazeViewGpu};
use crate::compose::{HAZE_AZIMUTHS, HAZE_INTERVALS};
use crate::overlay::OverlayKey;

/// Integrates the extinction of areas around the eye, if there are any.
pub fn encode_haze_areas(pass: &mut wgpu::ComputePass, gpu: &HazeGpu, view: &HazeViewGpu) {
    let Some(bind_group) = view.areas.as_ref().filter(|_| view.uneven) else {
        return;
    };
    pass.set_bind_group(0, bind_group, &[]);
    pass.set_pipeline(&gpu.spread);
    pass.dispatch_workgroups(HAZE_INTERVALS.div_ceil(64), HAZE_AZIMUTHS, 1);
    pass.set_pipeline(&gpu.add);
    pass.dispatch_workgroups(HAZE_AZIMUTHS.div_ceil(64), 1, 1);
}

/// Draws the haze over a target of `format` with `samples` samples, without a depth attachment.
pub fn encode_haze(
    pass: &mut wgpu::RenderPass,
    gpu: &HazeGpu,
    view: &HazeViewGpu,
    format: wgpu::TextureFormat,
    samples: u32,
) {
    encode(pass, gpu, view, OverlayKey::colour(format, samples), samples);
}

/// Draws what it obscures into a [`COVERAGE_FORMAT`](crate::rainfall::COVERAGE_FORMAT) target; the scene's depth must have one sample.
pub fn encode_haze_coverage(pass: &mut wgpu::RenderPass, gpu: &HazeGpu, view: &HazeViewGpu) {
    encode(pass, gpu, view, OverlayKey::coverage(1), 1);
}

fn encode(pass: &mut wgpu::RenderPass, gpu: &HazeGpu, view: &HazeViewGpu, key: OverlayKey, samples: u32) {
    let (Some(bind_group), Some(pipeline)) = (&view.draw, gpu.overlay(samples).get(key.mist(view.mist))) else {
        return;
    };
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, bind_group, &[]);
    pass.draw(0..3, 0..1);
}
