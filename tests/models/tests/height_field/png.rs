//! Images of heights.

use std::io::Cursor;

use image::{DynamicImage, ImageBuffer, ImageFormat, Luma, LumaA, Rgb};
use rain_core::surface::height_field::{HeightField, ImportLimits};
use rain_fuzz::Target;
use rain_fuzz::repair::repair;

use super::{LIMITS, refused};

fn encoded(image: DynamicImage) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, ImageFormat::Png).expect("encoded");
    bytes.into_inner()
}

fn grey16(nx: u32, nz: u32, value: impl Fn(u32, u32) -> u16) -> Vec<u8> {
    encoded(DynamicImage::ImageLuma16(ImageBuffer::from_fn(nx, nz, |x, z| {
        Luma([value(x, z)])
    })))
}

#[test]
fn sixteen_bits_keep_their_steps() {
    // Every value that there is, in rows of 256.
    let bytes = grey16(256, 256, |x, z| (256 * z + x) as u16);
    let field = HeightField::from_png(&bytes, 2.0, 65.535, &LIMITS).expect("an image");
    assert_eq!(field.cells(), [256, 256]);
    assert_eq!(field.cell_m(), 2.0);
    for (i, h) in field.heights().iter().enumerate() {
        // One step is 1 mm.
        assert!((h - i as f64 * 1e-3).abs() < 1e-12, "{i}: {h}");
    }
}

#[test]
fn eight_bits_reach_from_black_to_white() {
    let bytes = encoded(DynamicImage::ImageLuma8(ImageBuffer::from_fn(4, 2, |x, _| {
        Luma([(85 * x) as u8])
    })));
    let field = HeightField::from_png(&bytes, 1.0, -3.0, &LIMITS).expect("an image");
    assert_eq!(field.heights(), [0.0, -1.0, -2.0, -3.0, 0.0, -1.0, -2.0, -3.0]);
}

#[test]
fn no_alpha_is_a_hole() {
    let alpha = ImageBuffer::from_fn(2, 1, |x, _| LumaA([65535_u16, 65535 * x as u16]));
    let field =
        HeightField::from_png(&encoded(DynamicImage::ImageLumaA16(alpha)), 1.0, 1.0, &LIMITS).expect("an image");
    assert!(field.heights()[0].is_nan() && field.heights()[1] == 1.0);
    let alpha = ImageBuffer::from_fn(2, 1, |x, _| LumaA([255_u8, x as u8]));
    let field = HeightField::from_png(&encoded(DynamicImage::ImageLumaA8(alpha)), 1.0, 1.0, &LIMITS).expect("an image");
    assert!(field.heights()[0].is_nan() && field.heights()[1] == 1.0);
}

#[test]
fn bad_images_are_refused() {
    let good = grey16(5, 4, |x, z| (x * z) as u16);
    let read = |bytes: &[u8]| HeightField::from_png(bytes, 1.0, 1.0, &LIMITS);
    assert!(read(&good).is_ok());
    for end in 0..good.len() - 12 {
        refused(read(&good[..end]), &["cannot read the image"]);
    }
    refused(read(b"no image"), &["cannot read the image"]);
    let colour = ImageBuffer::from_fn(2, 2, |_, _| Rgb([1_u8, 2, 3]));
    refused(
        read(&encoded(DynamicImage::ImageRgb8(colour))),
        &["Rgb8", "grey with 8 or 16 bits"],
    );
    for bad in [f64::NAN, f64::INFINITY, 1.1e7] {
        refused(
            HeightField::from_png(&good, 1.0, bad, &LIMITS),
            &["height_scale_m", "-1e7 to 1e7 m"],
        );
        refused(HeightField::from_png(&good, bad, 1.0, &LIMITS), &["cell_m"]);
    }
    let few = ImportLimits { cells: 19, ..LIMITS };
    refused(HeightField::from_png(&good, 1.0, 1.0, &few), &["5 × 4", "19 cells"]);
    let short = ImportLimits { bytes: 10, ..LIMITS };
    refused(HeightField::from_png(&good, 1.0, 1.0, &short), &["allowed: 10"]);
}

#[test]
fn a_header_that_claims_a_giant_takes_no_memory() {
    let mut bytes = grey16(5, 4, |_, _| 0);
    // Width and height; then the header's checksum is made right again.
    bytes[16..24].copy_from_slice(&[0, 0, 0xff, 0xff, 0, 0, 0xff, 0xff]);
    repair(Target::Png, &mut bytes);
    let used = allocation_counter::measure(|| {
        refused(HeightField::from_png(&bytes, 1.0, 1.0, &LIMITS), &["65535 × 65535"]);
    });
    assert!(used.bytes_max < 1 << 20, "{} bytes", used.bytes_max);
}
