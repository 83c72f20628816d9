//! Commands of the pass.

use super::prepare::{SplashGpu, SplashViewGpu};
use crate::overlay::OverlayKey;

/// Makes this frame's crowns and thrown drops.
pub fn encode_splash_make(pass: &mut wgpu::ComputePass, gpu: &SplashGpu, view: &SplashViewGpu) {
    let Some(bind_group) = &view.make else { return };
    pass.set_bind_group(0, bind_group, &[]);
    pass.set_pipeline(&gpu.find);
    pass.dispatch_workgroups(view.invocations.div_ceil(64), 1, 1);
    pass.set_pipeline(&gpu.add);
    pass.dispatch_workgroups(1, 1, 1);
    pass.set_pipeline(&gpu.sort);
    pass.dispatch_workgroups(view.room.div_ceil(64), 1, 1);
}

/// Draws them over a target of `format` with `samples` samples, but those behind glass.
pub fn encode_splash_draw(
    pass: &mut wgpu::RenderPass,
    gpu: &SplashGpu,
    view: &SplashViewGpu,
    format: wgpu::TextureFormat,
    samples: u32,
) {
    encode(pass, gpu, view, OverlayKey::colour(format, samples));
}

/// Draws those behind glass, where there is any: before what is transparent is drawn.
pub fn encode_splash_behind(
    pass: &mut wgpu::RenderPass,
    gpu: &SplashGpu,
    view: &SplashViewGpu,
    format: wgpu::TextureFormat,
    samples: u32,
) {
    if view.panes > 0 {
        encode(pass, gpu, view, OverlayKey::colour(format, samples).behind());
    }
}

/// Draws the coverage of all into a [`crate::rainfall::COVERAGE_FORMAT`] target.
pub fn encode_splash_coverage(pass: &mut wgpu::RenderPass, gpu: &SplashGpu, view: &SplashViewGpu, samples: u32) {
    let key = OverlayKey::coverage(samples);
    if view.panes > 0 {
        encode(pass, gpu, view, key.behind());
    }
    encode(pass, gpu, view, key);
}

fn encode(pass: &mut wgpu::RenderPass, gpu: &SplashGpu, view: &SplashViewGpu, key: OverlayKey) {
    let (Some(bind_group), Some(pipeline)) = (&view.draw, gpu.draw.get(key)) else {
        return;
    };
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, bind_group, &[]);
    pass.draw_indirect(&view.arguments, 0);
}
