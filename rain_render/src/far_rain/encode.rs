//! Commands of the pass.

use super::prepare::{FarRainGpu, FarRainViewGpu};
use crate::overlay::OverlayKey;

/// Draws the particles over a target of `format` with `samples` samples.
pub fn encode_far_rain(
    pass: &mut wgpu::RenderPass,
    gpu: &FarRainGpu,
    view: &FarRainViewGpu,
    format: wgpu::TextureFormat,
    samples: u32,
) {
    encode(pass, gpu, view, OverlayKey::colour(format, samples));
}

/// Draws what they obscure over a [`crate::rainfall::COVERAGE_FORMAT`] target.
pub fn encode_far_rain_coverage(pass: &mut wgpu::RenderPass, gpu: &FarRainGpu, view: &FarRainViewGpu, samples: u32) {
    encode(pass, gpu, view, OverlayKey::coverage(samples));
}

fn encode(pass: &mut wgpu::RenderPass, gpu: &FarRainGpu, view: &FarRainViewGpu, key: OverlayKey) {
    let (Some(group), Some(pipeline)) = (&view.group, gpu.draw.get(key)) else {
        return;
    };
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group, &[]);
    pass.draw(0..6 * view.count, 0..1);
}
