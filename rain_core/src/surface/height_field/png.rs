//! A height field from a grey image.

use std::io::Cursor;

use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits};
use thiserror::Error;

use super::{GridFrame, HeightField, HeightFieldError, ImportLimits, MAX_COORDINATE_M};
use crate::error::in_range;

/// Why an image is no height field.
#[derive(Debug, Error)]
pub enum PngProblem {
    /// The file is no PNG, or broken.
    #[error("cannot read the image: {0}")]
    Unreadable(#[from] ImageError),
    /// The image has colours.
    #[error("the image is {0}, allowed: grey with 8 or 16 bits, with or without alpha")]
    NotGrey(String),
}

impl HeightField {
    /// Reads a grey PNG: image row = z, image column = x. Black is height 0, white (65535, or 255 with 8 bits) is
    /// `height_scale_m` (units: m, domain: ±1e7), in between linear in the stored value. Where there is an alpha
    /// channel, alpha 0 is a hole. The first cell's corner is the origin.
    ///
    /// # Errors
    /// When the file is no PNG or broken, has colours, holds more than `limits` allow, or a number lies outside its
    /// domain.
    pub fn from_png(
        bytes: &[u8],
        cell_m: f64,
        height_scale_m: f64,
        limits: &ImportLimits,
    ) -> Result<Self, HeightFieldError> {
        in_range(
            "height_scale_m",
            height_scale_m,
            -MAX_COORDINATE_M,
            MAX_COORDINATE_M,
            "-1e7 to 1e7 m",
        )?;
        super::check_bytes(bytes.len() as u64, limits)?;
        let mut reader = ImageReader::with_format(Cursor::new(bytes), ImageFormat::Png);
        let mut memory = Limits::default();
        // The widest pixel has 8 bytes; the decoder needs a row or two and the inflated chunks beside.
        memory.max_alloc = Some((limits.cells as u64).saturating_mul(8).saturating_add(1 << 24));
        reader.limits(memory);
        let decoder = reader.into_decoder().map_err(PngProblem::Unreadable)?;
        let (nx, nz) = decoder.dimensions();
        // Refused before anything of that size is allocated.
        let frame = GridFrame::new([nx as usize, nz as usize], cell_m, [0.0, 0.0], limits)?;
        let image = DynamicImage::from_decoder(decoder).map_err(PngProblem::Unreadable)?;
        // +0 turns the −0 of a negative scale into 0.
        let height = |value: u16, white: f64| f64::from(value) / white * height_scale_m + 0.0;
        let or_hole = |alpha: u16, height: f64| if alpha == 0 { f64::NAN } else { height };
        let heights = match image {
            DynamicImage::ImageLuma8(image) => image.pixels().map(|p| height(p.0[0].into(), 255.0)).collect(),
            DynamicImage::ImageLuma16(image) => image.pixels().map(|p| height(p.0[0], 65535.0)).collect(),
            DynamicImage::ImageLumaA8(image) => image
                .pixels()
                .map(|p| or_hole(p.0[1].into(), height(p.0[0].into(), 255.0)))
                .collect(),
            DynamicImage::ImageLumaA16(image) => image
                .pixels()
                .map(|p| or_hole(p.0[1], height(p.0[0], 65535.0)))
                .collect(),
            other => return Err(PngProblem::NotGrey(format!("{:?}", other.color())).into()),
        };
        Self::new(frame, heights)
    }
}
