//! Masks as 16-bit grey PNG files, linear: no gamma, no colour profile.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageBuffer, ImageFormat, Luma};
use thiserror::Error;

/// A mask could not be written or read.
#[derive(Debug, Error)]
pub enum MaskError {
    /// There are not as many texels as pixels.
    #[error("a mask of {} x {} pixels has {texels} texels", size[0], size[1])]
    Size {
        /// Width and height.
        size: [u32; 2],
        /// Texels given.
        texels: usize,
    },
    /// The encoder or decoder failed.
    #[error("{}: {source}", path.display())]
    Image {
        /// The file; empty when encoding to memory.
        path: PathBuf,
        /// Why.
        source: image::ImageError,
    },
    /// The file is a picture of another kind.
    #[error("{}: pixels are {found}, allowed: 16-bit grey", path.display())]
    Kind {
        /// The file.
        path: PathBuf,
        /// What its pixels are.
        found: String,
    },
}

/// A mask in memory, row by row from the top left.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MaskImage {
    /// Width and height. Units: pixels.
    pub size: [u32; 2],
    /// Values as in the file.
    pub texels: Vec<u16>,
}

/// Texel of a share (coverage, saturation). Domain: [0, 1], clamped; what is not a number becomes 0.
#[must_use]
pub fn texel_from_coverage(share: f32) -> u16 {
    // The cast takes NaN to 0 and saturates.
    (share * 65535.0 + 0.5) as u16
}

/// Share of a texel, [0, 1].
#[must_use]
pub fn coverage_from_texel(texel: u16) -> f64 {
    f64::from(texel) / 65535.0
}

/// Texel of a view distance in metres, rounded to mm. Farther than 65.534 m, infinite or not a number (nothing there):
/// 65535.
#[must_use]
pub fn texel_from_depth(distance_m: f32) -> u16 {
    if distance_m.is_nan() {
        u16::MAX
    } else {
        (distance_m * 1000.0 + 0.5) as u16
    }
}

/// View distance of a texel. Units: m; 65.535 stands for anything farther.
#[must_use]
pub fn depth_from_texel(texel: u16) -> f64 {
    f64::from(texel) / 1000.0
}

/// Texel of a depth of water in metres, rounded to 0.01 mm; from 0.65535 m on 65535, not a number 0.
#[must_use]
pub fn texel_from_water(depth_m: f32) -> u16 {
    // The cast takes NaN to 0 and saturates.
    (depth_m * 1e5 + 0.5) as u16
}

/// Depth of water of a texel. Units: m; 0.65535 stands for anything deeper.
#[must_use]
pub fn water_from_texel(texel: u16) -> f64 {
    f64::from(texel) / 1e5
}

/// The PNG file's bytes.
///
/// # Errors
/// When the number of texels is not width × height, or the encoder fails.
pub fn encode(size: [u32; 2], texels: &[u16]) -> Result<Vec<u8>, MaskError> {
    let wrong = || MaskError::Size {
        size,
        texels: texels.len(),
    };
    if texels.len() != size[0] as usize * size[1] as usize || texels.is_empty() {
        return Err(wrong());
    }
    let picture: ImageBuffer<Luma<u16>, Vec<u16>> =
        ImageBuffer::from_raw(size[0], size[1], texels.to_vec()).ok_or_else(wrong)?;
    let mut bytes = Cursor::new(Vec::new());
    picture
        .write_to(&mut bytes, ImageFormat::Png)
        .map_err(|source| MaskError::Image {
            path: PathBuf::new(),
            source,
        })?;
    Ok(bytes.into_inner())
}

/// Reads a mask.
///
/// # Errors
/// When the file cannot be read, is no PNG, or is not 16-bit grey.
pub fn read(path: impl AsRef<Path>) -> Result<MaskImage, MaskError> {
    let path = path.as_ref().to_path_buf();
    let picture = match image::open(&path) {
        Ok(picture) => picture,
        Err(source) => return Err(MaskError::Image { path, source }),
    };
    match picture {
        DynamicImage::ImageLuma16(grey) => Ok(MaskImage {
            size: [grey.width(), grey.height()],
            texels: grey.into_raw(),
        }),
        other => Err(MaskError::Kind {
            path,
            found: format!("{:?}", other.color()),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::super::output::tests::Folder;
    use super::*;

    #[test]
    fn every_value_survives() {
        let folder = Folder::new("masks");
        let texels: Vec<u16> = (0..=u16::MAX).collect();
        let path = folder.0.join("m.png");
        std::fs::write(&path, encode([512, 128], &texels).unwrap()).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        // Bit depth 16, colour type 0 (grey) in the header; no gamma and no colour profile.
        assert_eq!(bytes[24..26], [16, 0]);
        for chunk in [b"gAMA", b"sRGB", b"iCCP"] {
            assert!(!bytes.windows(4).any(|w| w == chunk), "{chunk:?}");
        }
        assert_eq!(
            read(&path).unwrap(),
            MaskImage {
                size: [512, 128],
                texels
            }
        );
    }

    #[test]
    fn refuses_other_pictures_and_sizes() {
        let folder = Folder::new("masks_other");
        assert!(matches!(
            encode([3, 3], &[0; 8]),
            Err(MaskError::Size { texels: 8, .. })
        ));
        assert!(matches!(encode([0, 3], &[]), Err(MaskError::Size { .. })));
        let path = folder.0.join("rgb.png");
        image::RgbImage::new(2, 2).save(&path).unwrap();
        assert!(matches!(read(&path), Err(MaskError::Kind { .. })));
        let missing = read(folder.0.join("none.png")).unwrap_err().to_string();
        assert!(missing.contains("none.png"), "{missing}");
    }

    #[test]
    fn values_and_texels() {
        for texel in [0, 1, 2, 30_000, 65_534, 65_535] {
            assert_eq!(texel_from_coverage(coverage_from_texel(texel) as f32), texel);
            assert_eq!(texel_from_depth(depth_from_texel(texel) as f32), texel);
        }
        assert_eq!([f32::NAN, -1.0, 2.0].map(texel_from_coverage), [0, 0, 65_535]);
        assert_eq!(
            [f32::NAN, f32::INFINITY, 1e9, -1.0].map(texel_from_depth),
            [65_535, 65_535, 65_535, 0]
        );
    }
}
