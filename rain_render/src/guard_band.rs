//! Room around a view for what reaches over its border.
//!
//! Devices clip triangles at the viewport's border only where they must: GPUs have a band around it that they rasterise without.
//! A software device has none, and sends all triangles of a draw one by one through its clipping as soon as one of them
//! crosses the border. There the viewport is made larger and the scissor rectangle holds what the viewport did.

use glam::Vec4;

/// The larger viewport is this many times as wide and high, where the device has as many pixels.
const LARGER: f32 = 3.0;

/// A band around a view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct GuardBand {
    /// Corner and size of the view in the target, px.
    view: Vec4,
    /// The view's share of the larger viewport, each way.
    share: f32,
}

impl GuardBand {
    /// That of a view with this corner and size in px; `None` where the device has its own, or the view no size.
    pub fn new(device: &wgpu::Device, view: Vec4) -> Option<Self> {
        let software = device.adapter_info().device_type == wgpu::DeviceType::Cpu;
        let most = device.limits().max_texture_dimension_2d as f32 / view.z.max(view.w);
        let larger = LARGER.min(most);
        (software && view.is_finite() && view.cmpge(Vec4::ZERO).all() && larger > 1.0).then(|| Self {
            view,
            share: 1.0 / larger,
        })
    }

    /// What places in the view's clip space are multiplied with.
    pub fn share(&self) -> f32 {
        self.share
    }

    /// Sets the larger viewport, and the view as the scissor rectangle: it must lie in the target.
    pub fn open(&self, pass: &mut wgpu::RenderPass) {
        let [x, y, width, height] = self.view.to_array();
        let (wide, high) = (width / self.share, height / self.share);
        pass.set_viewport(
            x - 0.5 * (wide - width),
            y - 0.5 * (high - height),
            wide,
            high,
            0.0,
            1.0,
        );
        let end = (self.view.truncate().truncate() + glam::Vec2::new(width, height))
            .ceil()
            .as_uvec2();
        let corner = glam::Vec2::new(x, y).as_uvec2();
        pass.set_scissor_rect(corner.x, corner.y, end.x - corner.x, end.y - corner.y);
    }

    /// Sets the viewport to the view again.
    pub fn close(&self, pass: &mut wgpu::RenderPass) {
        let [x, y, width, height] = self.view.to_array();
        pass.set_viewport(x, y, width, height, 0.0, 1.0);
    }
}
