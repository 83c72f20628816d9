//! `rain bake wet-textures`: textures of a material as they look in fixed weather.

use std::fs::File;
use std::io::{BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, ValueEnum};
use image::{DynamicImage, GrayImage, ImageFormat, ImageReader, Limits, RgbImage, RgbaImage};
use rain_core::error::{ConfigError, in_range};
use rain_core::surface::artist_look::ArtistRules;
use rain_core::surface::{FixedWetness, MaterialTexel, wet_texel};
use serde_json::{Value, json};
use thiserror::Error;

use crate::print;

/// Longest side of a texture. Units: px.
pub const MOST_PIXELS: u32 = 16_384;

/// Whose rules the baked material looks by.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum Look {
    /// Darkened by total reflection inside the film, smoothed by the film.
    #[default]
    Physical,
    /// Lagarde 2013.
    Lagarde,
    /// Lagarde 2013, part 3b, by porosity.
    LagardePorous,
    /// Nguyenova 2021.
    Nguyenova,
}

impl Look {
    fn rules(self) -> Option<ArtistRules> {
        match self {
            Self::Physical => None,
            Self::Lagarde => Some(ArtistRules::Lagarde),
            Self::LagardePorous => Some(ArtistRules::LagardePorous),
            Self::Nguyenova => Some(ArtistRules::Nguyenova),
        }
    }
}

/// Arguments of `rain bake wet-textures`. Images are PNG; all of one size.
#[derive(Debug, Clone, Default, Args)]
pub struct WetTexturesArgs {
    /// Base colour, sRGB; alpha is kept.
    #[arg(long)]
    pub base_color: PathBuf,
    /// Linear: green is roughness, blue metalness (glTF); red (occlusion) is kept.
    #[arg(long)]
    pub orm: Option<PathBuf>,
    /// Linear grey heights of the relief, white at its top: holes flood up to `--flood`.
    #[arg(long)]
    pub height: Option<PathBuf>,
    /// Multiple of the roughness texture, or the roughness without one: 0 to 1 (default: 1).
    #[arg(long, allow_negative_numbers = true)]
    pub roughness: Option<f64>,
    /// Multiple of the metalness texture, or the metalness without one: 0 to 1 (default: 1 with a texture, else 0).
    #[arg(long, allow_negative_numbers = true)]
    pub metallic: Option<f64>,
    /// Reflectance, F0 = 0.16 reflectance²: 0 to 1 (default: 0.5).
    #[arg(long, allow_negative_numbers = true)]
    pub reflectance: Option<f64>,
    /// Saturation of the pores: 0 to 1 (default: 1).
    #[arg(long, allow_negative_numbers = true)]
    pub wetness: Option<f64>,
    /// Share under a film: 0 to 1 (default: 0).
    #[arg(long, allow_negative_numbers = true)]
    pub film: Option<f64>,
    /// Share that stands under water everywhere: 0 to 1 (default: 0).
    #[arg(long, allow_negative_numbers = true)]
    pub water: Option<f64>,
    /// Level up to which holes of `--height` are under water: 0 to 1 (default: 0).
    #[arg(long, allow_negative_numbers = true)]
    pub flood: Option<f64>,
    /// Depth of water whose share is 1, in m: 0 to 1 (default: 0.01).
    #[arg(long, allow_negative_numbers = true)]
    pub depth_m: Option<f64>,
    /// Share of the body that darkens when soaked: 0 to 1 (default: by roughness and metalness).
    #[arg(long, allow_negative_numbers = true)]
    pub porosity: Option<f64>,
    /// Whose rules it looks by.
    #[arg(long, value_enum, default_value_t)]
    pub look: Look,
    /// Folder for `base_color.png`, `orm.png` and `reflectance.png`; made if it is not there.
    #[arg(long)]
    pub out: PathBuf,
    /// Print one JSON object on stdout.
    #[arg(long)]
    pub json: bool,
}

/// Why no textures were baked.
#[derive(Debug, Error)]
pub enum WetTexturesError {
    /// A number outside its domain.
    #[error("{0}")]
    Setting(#[from] ConfigError),
    /// A level of holes without heights to find them by.
    #[error("flood is {0}, allowed without a height map: 0")]
    NoHeights(f64),
    /// A file that cannot be read or written.
    #[error("{}: {error}", .path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What happened.
        error: std::io::Error,
    },
    /// A file that is no usable PNG.
    #[error("{}: cannot read the image: {error}", .path.display())]
    Image {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        error: image::ImageError,
    },
    /// Colours where heights should be.
    #[error("{}: the image is {found}, allowed: grey with 8 or 16 bits, with or without alpha", .path.display())]
    NotGrey {
        /// The file.
        path: PathBuf,
        /// Its format.
        found: String,
    },
    /// Textures of different sizes.
    #[error("{}: {} × {} pixels, allowed: {} × {} as the base colour", .path.display(), .found.0, .found.1, .allowed.0, .allowed.1)]
    OtherSize {
        /// The file.
        path: PathBuf,
        /// Its size.
        found: (u32, u32),
        /// That of the base colour.
        allowed: (u32, u32),
    },
}

/// What was baked.
#[derive(Debug, Clone, PartialEq)]
pub struct WetTextures {
    /// Base colour, sRGB, with the alpha of the dry one.
    pub base_color: RgbaImage,
    /// Occlusion (kept), roughness, metalness, linear.
    pub orm: RgbImage,
    /// Reflectance, linear: F0 = 0.16 reflectance².
    pub reflectance: GrayImage,
}

/// Linear value of an sRGB one, 0 to 1 (IEC 61966-2-1).
fn linear(encoded: u8) -> f64 {
    let c = f64::from(encoded) / 255.0;
    if c <= 0.040_45 {
        c / 12.92
    } else {
        rain_core::ops::pow((c + 0.055) / 1.055, 2.4)
    }
}

/// The nearest of 256 steps.
fn byte(value: f64) -> u8 {
    (255.0 * value.clamp(0.0, 1.0)).round() as u8
}

/// sRGB of a linear value.
fn encoded(value: f64) -> u8 {
    let v = value.clamp(0.0, 1.0);
    byte(if v <= 0.003_130_8 {
        12.92 * v
    } else {
        1.055 * rain_core::ops::pow(v, 1.0 / 2.4) - 0.055
    })
}

fn read(path: &Path) -> Result<DynamicImage, WetTexturesError> {
    let failed = |error| WetTexturesError::File {
        path: path.to_owned(),
        error,
    };
    let file = File::open(path).map_err(failed)?;
    let mut reader = ImageReader::with_format(BufReader::new(file), ImageFormat::Png);
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(MOST_PIXELS), Some(MOST_PIXELS));
    reader.limits(limits);
    reader.decode().map_err(|error| WetTexturesError::Image {
        path: path.to_owned(),
        error,
    })
}

fn sized(path: &Path, allowed: (u32, u32)) -> Result<DynamicImage, WetTexturesError> {
    let image = read(path)?;
    let found = (image.width(), image.height());
    if found == allowed {
        Ok(image)
    } else {
        Err(WetTexturesError::OtherSize {
            path: path.to_owned(),
            found,
            allowed,
        })
    }
}

/// Bakes the textures of a material for fixed weather, texel by texel with the functions of the shader.
///
/// # Errors
/// When a setting lies outside its domain, or an image cannot be read or does not fit.
pub fn bake(args: &WetTexturesArgs) -> Result<WetTextures, WetTexturesError> {
    let share = |name, value: Option<f64>, default| in_range(name, value.unwrap_or(default), 0.0, 1.0, "0 to 1");
    let default = FixedWetness::default();
    let weather = FixedWetness {
        wetness: args.wetness.unwrap_or(default.wetness),
        film: args.film.unwrap_or(default.film),
        water: args.water.unwrap_or(default.water),
        flood: args.flood.unwrap_or(default.flood),
        depth_m: args.depth_m.unwrap_or(default.depth_m),
        porosity: args.porosity,
        rules: args.look.rules(),
        ..default
    }
    .validated()?;
    let roughness = share("roughness", args.roughness, 1.0)?;
    let metallic = share("metallic", args.metallic, if args.orm.is_some() { 1.0 } else { 0.0 })?;
    let reflectance = share("reflectance", args.reflectance, 0.5)?;
    if weather.flood > 0.0 && args.height.is_none() {
        return Err(WetTexturesError::NoHeights(weather.flood));
    }
    let base = read(&args.base_color)?.into_rgba8();
    let size = base.dimensions();
    let orm = args.orm.as_deref().map(|path| sized(path, size)).transpose()?;
    let orm = orm.map(DynamicImage::into_rgb8);
    let heights = args.height.as_deref().map(|path| {
        let image = sized(path, size)?;
        match image {
            DynamicImage::ImageLuma8(_)
            | DynamicImage::ImageLuma16(_)
            | DynamicImage::ImageLumaA8(_)
            | DynamicImage::ImageLumaA16(_) => Ok(image.into_luma16()),
            other => Err(WetTexturesError::NotGrey {
                path: path.to_owned(),
                found: format!("{:?}", other.color()),
            }),
        }
    });
    let heights = heights.transpose()?;
    let mut out = WetTextures {
        base_color: base,
        orm: RgbImage::new(size.0, size.1),
        reflectance: GrayImage::new(size.0, size.1),
    };
    for (x, y, pixel) in out.base_color.enumerate_pixels_mut() {
        let [r, g, b, alpha] = pixel.0;
        let packed = orm.as_ref().map_or([255; 3], |orm| orm.get_pixel(x, y).0);
        let dry = MaterialTexel {
            base_colour: [r, g, b].map(linear),
            roughness: roughness * f64::from(packed[1]) / 255.0,
            metallic: metallic * f64::from(packed[2]) / 255.0,
            reflectance,
        };
        let height = heights
            .as_ref()
            .map_or(1.0, |heights| f64::from(heights.get_pixel(x, y).0[0]) / 65_535.0);
        let wet = wet_texel(&dry, &weather, height);
        let [r, g, b] = wet.base_colour.map(encoded);
        pixel.0 = [r, g, b, alpha];
        out.orm
            .put_pixel(x, y, image::Rgb([packed[0], byte(wet.roughness), byte(wet.metallic)]));
        out.reflectance.put_pixel(x, y, image::Luma([byte(wet.reflectance)]));
    }
    Ok(out)
}

/// Writes the textures into a folder; returns their paths.
///
/// # Errors
/// When the folder or a file cannot be written.
pub fn write(textures: &WetTextures, folder: &Path) -> Result<[PathBuf; 3], WetTexturesError> {
    std::fs::create_dir_all(folder).map_err(|error| WetTexturesError::File {
        path: folder.to_owned(),
        error,
    })?;
    let paths = ["base_color.png", "orm.png", "reflectance.png"].map(|name| folder.join(name));
    let saved = |path: &Path, saved: image::ImageResult<()>| {
        saved.map_err(|error| WetTexturesError::Image {
            path: path.to_owned(),
            error,
        })
    };
    saved(
        &paths[0],
        textures.base_color.save_with_format(&paths[0], ImageFormat::Png),
    )?;
    saved(&paths[1], textures.orm.save_with_format(&paths[1], ImageFormat::Png))?;
    saved(
        &paths[2],
        textures.reflectance.save_with_format(&paths[2], ImageFormat::Png),
    )?;
    Ok(paths)
}

/// Runs `rain bake wet-textures` and prints; returns the exit code.
#[must_use]
pub fn run(args: &WetTexturesArgs) -> ExitCode {
    match bake(args).and_then(|textures| Ok((textures.base_color.dimensions(), write(&textures, &args.out)?))) {
        Ok(((width, height), paths)) => {
            let [base_color, orm, reflectance] = paths.map(|path| path.display().to_string());
            let text = if args.json {
                let report: Value = json!({
                    "size": [width, height], "base_color": base_color, "orm": orm, "reflectance": reflectance,
                });
                report.to_string()
            } else {
                format!("{width} × {height} texels\n{base_color}\n{orm}\n{reflectance}")
            };
            print::finish(&text, 0)
        }
        Err(error) => {
            let _ = writeln!(std::io::stderr(), "rain: {error}");
            ExitCode::from(2)
        }
    }
}
