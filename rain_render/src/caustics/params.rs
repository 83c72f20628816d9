//! What a frame brings, and the texture of the map.

use glam::Vec3;
use rain_core::waves::{CAUSTIC_TEXELS, sun_blur_texels};

use crate::gpu_types::CausticParams;

/// Format of the map: light over its mean at four ways from the water.
pub const CAUSTIC_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// What the host makes for the map. It is sampled with repeat.
#[must_use]
pub fn caustic_texture() -> wgpu::TextureDescriptor<'static> {
    wgpu::TextureDescriptor {
        label: Some("rain caustics"),
        size: wgpu::Extent3d {
            width: CAUSTIC_TEXELS,
            height: CAUSTIC_TEXELS,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: CAUSTIC_FORMAT,
        usage: wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::STORAGE_BINDING
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    }
}

/// The light of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CausticFrame {
    /// Unit vector towards the light, above the horizon.
    pub towards: Vec3,
    /// Side of the slope map. Units: m.
    pub side_m: f64,
    /// Multiple of its slopes. Units: none.
    pub strength: f32,
}

impl CausticFrame {
    pub(super) fn params(&self) -> CausticParams {
        CausticParams {
            towards: self.towards.extend(0.0).to_array(),
            per_side: (1.0 / self.side_m) as f32,
            strength: self.strength,
            blur: sun_blur_texels(1.0, self.side_m) as f32,
            pad_a: 0.0,
        }
    }
}
