//! Mip chains for the textures of loaded scenes: glTF files carry none, and without them far surfaces shimmer.

use bevy::image::Image;
use bevy::prelude::*;
use bevy::render::render_resource::{TextureDimension, TextureFormat};

/// Gives every plain 8-bit colour texture a full mip chain and a sampler that uses it.
pub(super) fn add_mips(app: &mut App) {
    let mut images = app.world_mut().resource_mut::<Assets<Image>>();
    let wanted: Vec<_> = images
        .iter()
        .filter(|(_, image)| {
            let d = &image.texture_descriptor;
            d.mip_level_count == 1
                && d.dimension == TextureDimension::D2
                && d.size.depth_or_array_layers == 1
                && d.size.width.min(d.size.height) > 1
                && matches!(d.format, TextureFormat::Rgba8UnormSrgb | TextureFormat::Rgba8Unorm)
                && image
                    .data
                    .as_ref()
                    .is_some_and(|data| data.len() == (d.size.width * d.size.height * 4) as usize)
        })
        .map(|(id, _)| id)
        .collect();
    for id in wanted {
        let Some(mut image) = images.get_mut(id) else { continue };
        let size = image.texture_descriptor.size;
        let srgb = image.texture_descriptor.format == TextureFormat::Rgba8UnormSrgb;
        let Some(data) = image.data.as_mut() else { continue };
        let levels = chain(data, size.width, size.height, srgb);
        image.texture_descriptor.mip_level_count = levels;
    }
}

/// Appends all smaller levels to `data` and returns the number of levels. Colours are averaged in linear light.
fn chain(data: &mut Vec<u8>, width: u32, height: u32, srgb: bool) -> u32 {
    let to_linear: Vec<f32> = (0..256)
        .map(|v| {
            let v = v as f32 / 255.0;
            if srgb { v.powf(2.2) } else { v }
        })
        .collect();
    let (mut w, mut h) = (width as usize, height as usize);
    let mut start = 0;
    let mut levels = 1;
    while w > 1 || h > 1 {
        let (nw, nh) = ((w / 2).max(1), (h / 2).max(1));
        let mut level = Vec::with_capacity(nw * nh * 4);
        for y in 0..nh {
            for x in 0..nw {
                let texel = |dx: usize, dy: usize| {
                    let (sx, sy) = ((2 * x + dx).min(w - 1), (2 * y + dy).min(h - 1));
                    start + (sy * w + sx) * 4
                };
                let corners = [texel(0, 0), texel(1, 0), texel(0, 1), texel(1, 1)];
                for c in 0..4 {
                    let mean = corners
                        .iter()
                        .map(|i| {
                            if c < 3 {
                                to_linear[data[i + c] as usize]
                            } else {
                                f32::from(data[i + c]) / 255.0
                            }
                        })
                        .sum::<f32>()
                        * 0.25;
                    let value = if srgb && c < 3 { mean.powf(1.0 / 2.2) } else { mean };
                    level.push((value * 255.0 + 0.5) as u8);
                }
            }
        }
        start += w * h * 4;
        data.extend_from_slice(&level);
        (w, h) = (nw, nh);
        levels += 1;
    }
    levels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chain_goes_down_to_one_texel_and_keeps_a_plain_colour() {
        let mut data = [10, 200, 90, 128].repeat(12);
        assert_eq!(chain(&mut data, 4, 3, true), 3);
        assert_eq!(data.len(), 4 * (12 + 2 + 1));
        for texel in data.chunks(4) {
            for (a, b) in texel.iter().zip([10_u8, 200, 90, 128]) {
                assert!(a.abs_diff(b) <= 1, "{texel:?}");
            }
        }
    }

    #[test]
    fn black_and_white_average_in_linear_light() {
        let mut data = Vec::new();
        for v in [0, 255, 255, 0] {
            data.extend([v, v, v, 255]);
        }
        chain(&mut data, 2, 2, true);
        assert!(data[16].abs_diff(186) <= 2, "{}", data[16]);
    }
}
