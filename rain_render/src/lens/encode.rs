//! Commands of the pass.

use super::prepare::{LensGpu, LensViewGpu};

/// Draws `scene` through the glass into `target`, another texture of the same size and of `format`.
pub fn encode_lens(
    device: &wgpu::Device,
    encoder: &mut wgpu::CommandEncoder,
    gpu: &LensGpu,
    view: &LensViewGpu,
    scene: &wgpu::TextureView,
    target: &wgpu::TextureView,
    format: wgpu::TextureFormat,
) {
    let Some(pipelines) = gpu.made.get(&format) else { return };
    let small = view.small.create_view(&wgpu::TextureViewDescriptor::default());
    let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
    let params = || entry(0, view.params.as_entire_binding());
    let picture = || entry(2, wgpu::BindingResource::TextureView(scene));
    let sampler = || entry(4, wgpu::BindingResource::Sampler(&gpu.sampler));
    let shrink = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("rain lens shrink"),
        layout: &gpu.shrink_layout,
        entries: &[params(), picture(), sampler()],
    });
    let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("rain lens"),
        layout: &gpu.layout,
        entries: &[
            params(),
            entry(1, view.drops.as_entire_binding()),
            picture(),
            entry(3, wgpu::BindingResource::TextureView(&small)),
            sampler(),
        ],
    });
    let mut pass = begin(encoder, "rain_lens_shrink", &small);
    pass.set_pipeline(&gpu.shrink);
    pass.set_bind_group(0, &shrink, &[]);
    pass.draw(0..3, 0..1);
    drop(pass);

    let mut pass = begin(encoder, "rain_lens", target);
    pass.set_pipeline(&pipelines.film);
    pass.set_bind_group(0, &bind_group, &[]);
    pass.draw(0..3, 0..1);
    if view.count > 0 {
        let [x, y, width, height] = view.viewport;
        pass.set_viewport(x, y, width, height, 0.0, 1.0);
        pass.set_pipeline(&pipelines.drops);
        pass.draw(0..6, 0..view.count);
    }
}

/// A pass that overwrites all of `target`.
fn begin<'a>(encoder: &'a mut wgpu::CommandEncoder, label: &str, target: &wgpu::TextureView) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                store: wgpu::StoreOp::Store,
            },
        })],
        depth_stencil_attachment: None,
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}
