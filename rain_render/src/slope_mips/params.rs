//! The texture of a slope map.

/// Format of slope maps.
pub const SLOPE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Number of levels: both sides are halved as long as both are even, so that every texel has just four below it. Sizes
/// in texels; 1 for a side of 0.
#[must_use]
pub fn slope_levels(width: u32, height: u32) -> u32 {
    if width == 0 || height == 0 {
        return 1;
    }
    1 + width.trailing_zeros().min(height.trailing_zeros())
}

/// What the host makes for a slope map of this size, in texels. Powers of two have mips down to one texel.
#[must_use]
pub fn slope_texture(label: &'static str, width: u32, height: u32) -> wgpu::TextureDescriptor<'static> {
    wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: slope_levels(width, height),
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: SLOPE_FORMAT,
        usage: wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::STORAGE_BINDING
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    }
}
