//! The street's own textures: a formula per surface gives colour, height and roughness; the maps follow from them.

pub mod fields;
pub mod foliage;
pub mod ground;
pub mod paint;
pub mod walls;
pub mod windows;

use crate::error::StreetError;
use crate::glb::Glb;
use glam::{Vec3, vec3};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use rain_core::ops;
use std::sync::OnceLock;

/// What a surface is at one texel.
#[derive(Debug, Clone, Copy)]
pub struct Texel {
    /// Reflectance of the dry surface, linear RGB, 0 to 1.
    pub albedo: Vec3,
    /// Height above the surface's mean plane, metres.
    pub height: f32,
    /// Perceptual roughness, 0 to 1.
    pub rough: f32,
    /// Metalness, 0 or 1.
    pub metal: f32,
    /// Ambient occlusion, 0 (closed) to 1 (open).
    pub open: f32,
}

impl Texel {
    /// A rough, open, non-metal texel.
    #[must_use]
    pub fn new(albedo: Vec3, height: f32, rough: f32) -> Self {
        Self {
            albedo,
            height,
            rough,
            metal: 0.0,
            open: 1.0,
        }
    }
}

/// An 8-bit image.
#[derive(Debug, Clone)]
pub struct Picture {
    /// Name in the glTF.
    pub name: String,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// 3 (RGB) or 4 (RGBA) bytes a pixel.
    pub channels: u8,
    /// Rows from the top.
    pub bytes: Vec<u8>,
}

impl Picture {
    /// An image from a function of the pixel, giving RGBA of which the first `channels` are kept.
    #[must_use]
    pub fn new(name: &str, width: u32, height: u32, channels: u8, f: impl Fn(u32, u32) -> [u8; 4]) -> Self {
        let mut bytes = Vec::with_capacity((width * height) as usize * usize::from(channels));
        for y in 0..height {
            for x in 0..width {
                bytes.extend_from_slice(&f(x, y)[..usize::from(channels)]);
            }
        }
        Self {
            name: name.to_owned(),
            width,
            height,
            channels,
            bytes,
        }
    }

    /// Encodes as PNG.
    ///
    /// # Errors
    /// [`StreetError::Encode`] when the codec refuses.
    pub fn png(&self) -> Result<Vec<u8>, StreetError> {
        let mut out = Vec::new();
        let kind = if self.channels == 4 {
            ExtendedColorType::Rgba8
        } else {
            ExtendedColorType::Rgb8
        };
        PngEncoder::new_with_quality(&mut out, CompressionType::Default, FilterType::Adaptive)
            .write_image(&self.bytes, self.width, self.height, kind)
            .map_err(|source| StreetError::Encode {
                name: self.name.clone(),
                source,
            })?;
        Ok(out)
    }
}

/// The PNG files of one surface.
#[derive(Debug, Clone)]
pub struct Encoded {
    /// Name and PNG bytes of each map.
    pub maps: Vec<(String, Vec<u8>)>,
}

/// Texture indices of one surface in a glTF.
#[derive(Debug, Clone, Copy, Default)]
pub struct MapIds {
    /// Base colour, or the first picture of a surface without maps.
    pub base: usize,
    /// Tangent-space normal, or the second picture.
    pub normal: usize,
    /// Occlusion, roughness, metalness.
    pub orm: usize,
}

impl Encoded {
    /// Adds the maps to a document.
    pub fn install(&self, glb: &mut Glb) -> MapIds {
        let ids: Vec<usize> = self.maps.iter().map(|(name, png)| glb.add_texture(name, png)).collect();
        let get = |k: usize| ids.get(k).copied().unwrap_or_default();
        MapIds {
            base: get(0),
            normal: get(1),
            orm: get(2),
        }
    }
}

/// Encodes pictures.
///
/// # Errors
/// [`StreetError::Encode`] when the codec refuses.
pub fn encode(pictures: &[Picture]) -> Result<Encoded, StreetError> {
    let maps = pictures
        .iter()
        .map(|p| Ok((p.name.clone(), p.png()?)))
        .collect::<Result<_, StreetError>>()?;
    Ok(Encoded { maps })
}

/// Base colour, normal and occlusion-roughness-metalness maps of a surface `metres` wide and high; `f` takes (u, v) in [0, 1).
/// Roughness is stored at half the resolution.
#[must_use]
pub fn bake(name: &str, size: [u32; 2], metres: [f32; 2], f: impl Fn(f32, f32) -> Texel) -> Vec<Picture> {
    let [w, h] = size;
    let at = |x: u32, y: u32| f((x as f32 + 0.5) / w as f32, (y as f32 + 0.5) / h as f32);
    let texels: Vec<Texel> = (0..w * h).map(|k| at(k % w, k / w)).collect();
    let get = |x: u32, y: u32| &texels[((y % h) * w + x % w) as usize];
    let base = Picture::new(&format!("{name}-color"), w, h, 3, |x, y| {
        let c = get(x, y).albedo;
        [srgb(c.x), srgb(c.y), srgb(c.z), 255]
    });
    let scale = [0.5 * w as f32 / metres[0], 0.5 * h as f32 / metres[1]];
    let normal = Picture::new(&format!("{name}-normal"), w, h, 3, |x, y| {
        let dx = (get(x + 1, y).height - get(x + w - 1, y).height) * scale[0];
        let dy = (get(x, y + 1).height - get(x, y + h - 1).height) * scale[1];
        // The image's v grows down, the bitangent points up: the sign of y turns twice.
        let n = vec3(-dx, dy, 1.0).normalize();
        let byte = |c: f32| coarse(c * 127.5 + 127.5);
        [byte(n.x), byte(n.y), byte(n.z).max(128), 255]
    });
    let orm = Picture::new(&format!("{name}-orm"), w / 2, h / 2, 3, |x, y| {
        let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| get(2 * x + i, 2 * y + j));
        let mean = |g: fn(&Texel) -> f32| four.iter().map(|t| g(t)).sum::<f32>() * 0.25;
        [
            byte(mean(|t| t.open)),
            byte(mean(|t| t.rough)),
            byte(mean(|t| t.metal)),
            255,
        ]
    });
    vec![base, normal, orm]
}

/// Depth below the highest texel as a share of the whole relief, grey; a surface without relief is 0.
#[must_use]
pub fn depth(name: &str, size: [u32; 2], f: impl Fn(f32, f32) -> Texel) -> Picture {
    let [w, h] = size;
    let at = |k: u32| f(((k % w) as f32 + 0.5) / w as f32, ((k / w) as f32 + 0.5) / h as f32).height;
    let heights: Vec<f32> = (0..w * h).map(at).collect();
    let high = heights.iter().copied().fold(f32::MIN, f32::max);
    let low = heights.iter().copied().fold(f32::MAX, f32::min);
    let span = (high - low).max(1e-6);
    Picture::new(name, w, h, 3, |x, y| {
        let share = (high - heights[(y * w + x) as usize]) / span;
        let grey = (share * 255.0).round() as u8;
        [grey, grey, grey, 255]
    })
}

/// Rounds to a multiple of 4 about the middle: invisible, and it halves the files.
fn coarse(x: f32) -> u8 {
    ((((x - 127.5) / 4.0).round() * 4.0) + 128.0).clamp(0.0, 255.0) as u8
}

/// A linear value in [0, 1] as a byte in steps of 8, fine enough for roughness and occlusion.
fn byte(x: f32) -> u8 {
    (((x.clamp(0.0, 1.0) * 255.0) / 8.0).round() * 8.0).min(255.0) as u8
}

/// A linear value in [0, 1] as an sRGB byte (IEC 61966-2-1), in steps of 2.
#[must_use]
pub fn srgb(x: f32) -> u8 {
    static TABLE: OnceLock<Vec<u8>> = OnceLock::new();
    let table = TABLE.get_or_init(|| {
        (0..4096_u32)
            .map(|k| {
                let x = f64::from(k) / 4095.0;
                let y = if x <= 0.003_130_8 {
                    12.92 * x
                } else {
                    1.055 * ops::pow(x, 1.0 / 2.4) - 0.055
                };
                (((y * 255.0) / 2.0).round() * 2.0).min(255.0) as u8
            })
            .collect()
    });
    table[(x.clamp(0.0, 1.0) * 4095.0).round() as usize]
}

/// Grey of the given linear reflectance.
#[must_use]
pub fn grey(x: f32) -> Vec3 {
    Vec3::splat(x)
}
