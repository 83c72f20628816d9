//! Small perceptual goldens.

use std::path::{Path, PathBuf};

use image::RgbImage;

/// Largest golden. Units: bytes.
pub const MAX_BYTES: u64 = 20 << 10;

/// Structural likeness of two pictures of one size, 0…1 (1: the same): luma by SSIM, colour by root mean square
/// (`image_compare::rgb_hybrid_compare`).
///
/// # Panics
/// When the sizes differ.
#[must_use]
pub fn likeness(a: &RgbImage, b: &RgbImage) -> f64 {
    image_compare::rgb_hybrid_compare(a, b)
        .expect("two pictures of one size")
        .score
}

/// Compares `picture` with the golden of this name in `folder`; below `bound` it is written to `target/goldens/` and
/// the test fails. With `RAIN_CREATE_GOLDENS=1` a missing golden is written instead.
///
/// # Panics
/// When the picture is not alike, or the golden is missing, too large or of another size.
pub fn check(folder: &Path, name: &str, picture: &RgbImage, bound: f64) {
    let path = folder.join(format!("{name}.png"));
    if !path.is_file() {
        let create = std::env::var("RAIN_CREATE_GOLDENS").is_ok_and(|v| v == "1");
        assert!(
            create,
            "{} is missing; RAIN_CREATE_GOLDENS=1 writes it (the picture is {})",
            path.display(),
            keep(name, picture).display()
        );
        std::fs::create_dir_all(folder).expect("the folder of goldens");
        picture.save(&path).expect("the golden is written");
        eprintln!("created {}: look at it before it is committed", path.display());
    }
    let bytes = std::fs::metadata(&path).expect("the golden").len();
    assert!(
        bytes <= MAX_BYTES,
        "{}: {bytes} bytes, at most {MAX_BYTES}",
        path.display()
    );
    let golden = image::open(&path).expect("the golden is a picture").to_rgb8();
    assert_eq!(golden.dimensions(), picture.dimensions(), "{name}");
    let score = likeness(&golden, picture);
    assert!(
        score >= bound,
        "{name}: likeness {score:.4}, at least {bound}; the picture is {}",
        keep(name, picture).display()
    );
}

/// Writes a picture where somebody can look at it.
fn keep(name: &str, picture: &RgbImage) -> PathBuf {
    let folder = std::env::current_exe()
        .ok()
        .and_then(|exe| exe.ancestors().nth(3).map(Path::to_path_buf))
        .unwrap_or_else(std::env::temp_dir)
        .join("goldens");
    let path = folder.join(format!("{name}.png"));
    let written = std::fs::create_dir_all(&folder).is_ok() && picture.save(&path).is_ok();
    if written {
        path
    } else {
        PathBuf::from("not kept: the folder cannot be written")
    }
}
