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
        // A little less than it can, for rounding.
        let larger = LARGER.min(0.99 * most);
        let sized = view.is_finite() && view.cmpge(Vec4::new(0.0, 0.0, 1.0, 1.0)).all();
        (software && sized && larger > 1.0).then(|| Self {
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
        let [x, y, width, height] = self.viewport();
        pass.set_viewport(x, y, width, height, 0.0, 1.0);
        let [x, y, width, height] = self.scissor();
        pass.set_scissor_rect(x, y, width, height);
    }

    fn viewport(&self) -> [f32; 4] {
        let [x, y, width, height] = self.view.to_array();
        let (wide, high) = (width / self.share, height / self.share);
        [x - 0.5 * (wide - width), y - 0.5 * (high - height), wide, high]
    }

    /// All pixels that the view touches.
    fn scissor(&self) -> [u32; 4] {
        let [x, y, width, height] = self.view.to_array();
        let (left, top) = (x as u32, y as u32);
        [
            left,
            top,
            (x + width).ceil() as u32 - left,
            (y + height).ceil() as u32 - top,
        ]
    }

    /// Sets the viewport to the view again.
    pub fn close(&self, pass: &mut wgpu::RenderPass) {
        let [x, y, width, height] = self.view.to_array();
        pass.set_viewport(x, y, width, height, 0.0, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_larger_viewport_is_about_the_views_middle() {
        let band = GuardBand {
            view: Vec4::new(100.0, 50.0, 640.0, 360.0),
            share: 1.0 / 3.0,
        };
        let [x, y, width, height] = band.viewport();
        assert!((x + 540.0).abs() < 1e-3 && (y + 310.0).abs() < 1e-3, "{x}, {y}");
        assert!((width - 1920.0).abs() < 1e-3 && (height - 1080.0).abs() < 1e-3);
        assert_eq!(band.scissor(), [100, 50, 640, 360]);
        let between = GuardBand {
            view: Vec4::new(0.5, 0.0, 10.25, 10.0),
            share: 0.5,
        };
        assert_eq!(between.scissor(), [0, 0, 11, 10]);
    }
}
