//! Reading and writing maps of half floats.

use crate::device::Device;

/// A half float as f32.
pub fn from_half(h: u16) -> f32 {
    let sign = if h & 0x8000 == 0 { 1.0 } else { -1.0 };
    let (exponent, mantissa) = (i32::from(h >> 10 & 31), f32::from(h & 1023));
    let scale = |e: i32| (e as f32).exp2();
    match exponent {
        0 => sign * mantissa * scale(-24),
        31 if mantissa == 0.0 => sign * f32::INFINITY,
        31 => f32::NAN,
        e => sign * (1024.0 + mantissa) * scale(e - 25),
    }
}

/// An f32 as half float, cut off; tiny values are 0.
pub fn to_half(x: f32) -> u16 {
    let bits = x.to_bits();
    let sign = (bits >> 16 & 0x8000) as u16;
    let exponent = (bits >> 23 & 255) as i32 - 112;
    if exponent <= 0 {
        return sign;
    }
    sign | (exponent.min(30) as u16) << 10 | (bits >> 13 & 1023) as u16
}

/// A level of a map of half floats, row by row; channels that it has not are 0.
pub fn read_map(gpu: &Device, map: &wgpu::Texture, level: u32) -> Vec<[f32; 4]> {
    let (width, height) = (map.width() >> level, map.height() >> level);
    let texel_bytes = map.format().block_copy_size(None).expect("a colour");
    let row = (width * texel_bytes).next_multiple_of(256);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row * height),
        usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        wgpu::TexelCopyTextureInfo {
            texture: map,
            mip_level: level,
            origin: wgpu::Origin3d::ZERO,
            aspect: wgpu::TextureAspect::All,
        },
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(row),
                rows_per_image: None,
            },
        },
        wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
    );
    gpu.queue.submit([encoder.finish()]);
    let bytes = gpu.read(&buffer, u64::from(row * height));
    bytes
        .chunks_exact(row as usize)
        .flat_map(|row| row[..(width * texel_bytes) as usize].chunks_exact(texel_bytes as usize))
        .map(|texel| {
            let half = |c: usize| {
                texel
                    .get(2 * c..2 * c + 2)
                    .map_or(0, |two| u16::from_le_bytes([two[0], two[1]]))
            };
            std::array::from_fn(|c| from_half(half(c)))
        })
        .collect()
}

/// Fills the finest level of a four-channel map of half floats, which needs the usage COPY_DST.
pub fn write_map(gpu: &Device, map: &wgpu::Texture, texels: &[[f32; 4]]) {
    let halves: Vec<[u16; 4]> = texels.iter().map(|texel| texel.map(to_half)).collect();
    gpu.queue.write_texture(
        map.as_image_copy(),
        bytemuck::cast_slice(&halves),
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(map.width() * 8),
            rows_per_image: None,
        },
        map.size(),
    );
}
