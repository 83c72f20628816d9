//! `rain bake`: the puddles of a scene or height field.

use std::fs::File;
use std::path::{Path, PathBuf};

use clap::Args;
use rain_core::surface::height_field::{HeightField, HeightFieldError, ImportLimits};

/// Cell of a scene where none is given. Units: m.
pub const SCENE_CELL_M: f64 = 0.25;
/// Cell of an image or table where none is given. Units: m.
pub const GRID_CELL_M: f64 = 1.0;

/// Arguments of `rain bake`.
#[derive(Debug, Args)]
pub struct BakeArgs {
    /// glTF or GLB scene, grey PNG, or CSV table of heights.
    file: PathBuf,
    /// Side of a cell in m (default: 0.25 for a scene, 1 for an image or table).
    #[arg(long)]
    cell_m: Option<f64>,
    /// Height of white in a PNG in m; black is 0.
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    height_scale_m: f64,
    /// No water leaves over the border.
    #[arg(long)]
    closed: bool,
    /// Print one JSON object on stdout.
    #[arg(long)]
    json: bool,
}

/// Reads a height field from a file of any kind, told by its ending.
///
/// # Errors
/// What is wrong, with the file's name.
pub fn read(path: &Path, cell_m: Option<f64>, height_scale_m: f64) -> Result<HeightField, String> {
    let failed = |error: std::io::Error| format!("{}: {error}", path.display());
    let wrong = |error: HeightFieldError| format!("{}: {error}", path.display());
    let limits = ImportLimits::default();
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    let file = File::open(path).map_err(failed)?;
    let length = file.metadata().map_err(failed)?.len();
    if length > limits.bytes as u64 {
        return Err(format!("{}: {length} bytes, allowed: {}", path.display(), limits.bytes));
    }
    match ending.as_deref() {
        Some("csv") => HeightField::from_csv(file, cell_m.unwrap_or(GRID_CELL_M), &limits).map_err(wrong),
        Some("png") => {
            let bytes = std::fs::read(path).map_err(failed)?;
            HeightField::from_png(&bytes, cell_m.unwrap_or(GRID_CELL_M), height_scale_m, &limits).map_err(wrong)
        }
        Some("glb" | "gltf") => {
            let bytes = std::fs::read(path).map_err(failed)?;
            let cell_m = cell_m.unwrap_or(SCENE_CELL_M);
            HeightField::from_gltf(&bytes, path.parent(), cell_m, &limits)
                .map(|import| import.field)
                .map_err(wrong)
        }
        _ => Err(format!(
            "{}: the file's ending is not known, allowed: .glb, .gltf, .png, .csv",
            path.display()
        )),
    }
}

/// Runs `rain bake` and prints; returns the exit code.
#[must_use]
pub fn run(args: &BakeArgs) -> std::process::ExitCode {
    use std::io::Write as _;
    match read(&args.file, args.cell_m, args.height_scale_m) {
        Ok(field) => {
            let [nx, nz] = field.cells();
            let _ = writeln!(std::io::stdout(), "{nx} × {nz} cells of {} m", field.cell_m());
            std::process::ExitCode::SUCCESS
        }
        Err(message) => {
            let _ = writeln!(std::io::stderr(), "rain: {message}");
            std::process::ExitCode::from(2)
        }
    }
}
