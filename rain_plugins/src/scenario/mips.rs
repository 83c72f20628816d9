//! Mip chains for the textures of loaded scenes: glTF files carry none, and without them far surfaces shimmer.

use std::collections::HashMap;

use bevy::image::Image;
use bevy::prelude::*;
use bevy::render::render_resource::{TextureDimension, TextureFormat};

/// Gives every plain 8-bit colour texture a full mip chain and a sampler that uses it.
pub(super) fn add_mips(app: &mut App) {
    let materials = app.world().resource::<Assets<StandardMaterial>>();
    let cut_off: HashMap<_, _> = materials
        .iter()
        .filter_map(|(_, m)| match (m.alpha_mode, &m.base_color_texture) {
            (AlphaMode::Mask(cut_off), Some(texture)) => Some((texture.id(), cut_off)),
            _ => None,
        })
        .collect();
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
        let levels = chain(data, size.width, size.height, srgb, cut_off.get(&id).copied());
        image.texture_descriptor.mip_level_count = levels;
    }
    // Materials bound the textures as they were loaded; visited, they count as changed and bind the new ones.
    let _ = app
        .world_mut()
        .resource_mut::<Assets<StandardMaterial>>()
        .iter_mut()
        .count();
}

/// Scales the alpha of `level` until as large a `share` of it passes the cut-off as of the full picture, or crowns thin
/// out with distance (Castaño 2010).
fn keep_coverage(level: &mut [u8], cut_off: f32, share: f32) {
    let (mut low, mut high) = (0.0, 8.0);
    for _ in 0..12 {
        let middle = 0.5 * (low + high);
        if passing(level, cut_off / middle) < share {
            low = middle;
        } else {
            high = middle;
        }
    }
    for texel in level.chunks_exact_mut(4) {
        texel[3] = (f32::from(texel[3]) * high + 0.5).min(255.0) as u8;
    }
}

/// Share of texels whose alpha is at least `cut_off`, [0, 1].
fn passing(texels: &[u8], cut_off: f32) -> f32 {
    let solid = texels.chunks_exact(4).filter(|t| f32::from(t[3]) >= 255.0 * cut_off);
    solid.count() as f32 / (texels.len() / 4) as f32
}

/// Appends all smaller levels to `data` and returns the number of levels. Colours are averaged in linear light; with a
/// `cut_off`, as many texels of each level pass it.
fn chain(data: &mut Vec<u8>, width: u32, height: u32, srgb: bool, cut_off: Option<f32>) -> u32 {
    let to_linear: Vec<f32> = (0..256)
        .map(|v| {
            let v = v as f32 / 255.0;
            if srgb { v.powf(2.2) } else { v }
        })
        .collect();
    let (mut w, mut h) = (width as usize, height as usize);
    let mut start = 0;
    let mut levels = 1;
    let mask = cut_off.map(|cut_off| (cut_off, passing(data, cut_off)));
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
        if let Some((cut_off, share)) = mask {
            keep_coverage(&mut level, cut_off, share);
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
        assert_eq!(chain(&mut data, 4, 3, true, None), 3);
        assert_eq!(data.len(), 4 * (12 + 2 + 1));
        for texel in data.chunks(4) {
            for (a, b) in texel.iter().zip([10_u8, 200, 90, 128]) {
                assert!(a.abs_diff(b) <= 1, "{texel:?}");
            }
        }
    }

    #[test]
    fn a_masked_chain_keeps_its_coverage_and_a_plain_one_loses_it() {
        // Leaves: single opaque texels, one in eight, on nothing.
        let solid = |i: u32| {
            i.wrapping_mul(2_654_435_761)
                .rotate_left(15)
                .wrapping_mul(2_246_822_519)
                >> 29
                == 0
        };
        let leaves: Vec<u8> = (0..64 * 64)
            .flat_map(|i| [30, 90, 20, if solid(i) { 255 } else { 0 }])
            .collect();
        let full = passing(&leaves, 0.4);
        assert!((full - 0.125).abs() < 0.02, "{full}");
        let after = |cut_off: Option<f32>| {
            let mut data = leaves.clone();
            chain(&mut data, 64, 64, true, cut_off);
            // The level of 16 x 16 texels.
            passing(&data[4 * (64 * 64 + 32 * 32)..][..4 * 16 * 16], 0.4)
        };
        // Means of 16 texels have few values: coverage comes in steps.
        let (kept, lost) = (after(Some(0.4)), after(None));
        assert!(kept > 0.5 * full && kept < 2.5 * full, "{kept} of {full}");
        assert!(lost < 0.25 * full, "{lost} of {full}");
    }

    #[test]
    fn black_and_white_average_in_linear_light() {
        let mut data = Vec::new();
        for v in [0, 255, 255, 0] {
            data.extend([v, v, v, 255]);
        }
        chain(&mut data, 2, 2, true, None);
        assert!(data[16].abs_diff(186) <= 2, "{}", data[16]);
    }
}
