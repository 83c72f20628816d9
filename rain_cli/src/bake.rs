//! `rain bake`: the puddles of a scene or height field; what else is made ahead is a subcommand.

use std::fmt::Write as _;
use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Subcommand};
use rain_core::error::in_range;
use rain_core::surface::basins::{BakeOptions, BakeReport, Basins, Grid};
use rain_core::surface::height_field::{HeightField, HeightFieldError, ImportLimits, MAX_COORDINATE_M};
use serde_json::{Value, json};

use crate::print;
use crate::streaks::{self, StreaksArgs};
use crate::wet_textures::{self, WetTexturesArgs};

/// Cell of a scene where none is given. Units: m.
pub const SCENE_CELL_M: f64 = 0.25;
/// Shallowest basin of a scene where nothing is said: its single-precision corners make flat ground uneven. Units: m.
pub const SCENE_THRESHOLD_M: f64 = 1e-4;
/// Cell of an image or table where none is given. Units: m.
pub const GRID_CELL_M: f64 = 1.0;

/// Arguments of `rain bake`.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct BakeArgs {
    #[command(subcommand)]
    what: Option<What>,
    /// glTF or GLB scene, grey PNG, or CSV table of heights.
    #[arg(required = true)]
    file: Option<PathBuf>,
    /// Side of a cell in m (default: 0.25 for a scene, 1 for an image or table).
    #[arg(long, allow_negative_numbers = true)]
    cell_m: Option<f64>,
    /// Height of white in a PNG in m; black is 0.
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    height_scale_m: f64,
    /// No water leaves over the border.
    #[arg(long)]
    closed: bool,
    /// Leave out basins shallower than this, in m (default: 0.0001 for a scene, 0 for an image or table).
    #[arg(long, allow_negative_numbers = true)]
    threshold_m: Option<f64>,
    /// Print one JSON object on stdout.
    #[arg(long)]
    json: bool,
}

/// What is baked instead of puddles.
#[derive(Debug, Subcommand)]
enum What {
    /// Textures of a material as they look in fixed weather.
    WetTextures(WetTexturesArgs),
    /// Streak textures of rain, as a KTX2 file.
    Streaks(StreaksArgs),
}

/// A file name's ending in lower case.
fn ending(path: &Path) -> Option<String> {
    path.extension().map(|e| e.to_string_lossy().to_lowercase())
}

/// Reads a height field from a file of any kind, told by its ending.
///
/// # Errors
/// What is wrong, with the file's name.
pub fn read(path: &Path, cell_m: Option<f64>, height_scale_m: f64) -> Result<HeightField, String> {
    let failed = |error: std::io::Error| format!("{}: {error}", path.display());
    let wrong = |error: HeightFieldError| format!("{}: {error}", path.display());
    let limits = ImportLimits::default();
    let file = File::open(path).map_err(failed)?;
    let length = file.metadata().map_err(failed)?.len();
    if length > limits.bytes as u64 {
        return Err(format!("{}: {length} bytes, allowed: {}", path.display(), limits.bytes));
    }
    match ending(path).as_deref() {
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
pub fn run(args: &BakeArgs) -> ExitCode {
    match &args.what {
        Some(What::WetTextures(args)) => return wet_textures::run(args),
        Some(What::Streaks(args)) => return streaks::run(args),
        None => {}
    }
    match bake(args) {
        Ok(report) => {
            let text = if args.json {
                report_json(&report).to_string()
            } else {
                report_table(&report)
            };
            print::finish(&text, 0)
        }
        Err(message) => {
            let _ = writeln!(std::io::stderr(), "rain: {message}");
            ExitCode::from(2)
        }
    }
}

fn bake(args: &BakeArgs) -> Result<BakeReport, String> {
    // Where it does not count, it is still checked.
    in_range(
        "height_scale_m",
        args.height_scale_m,
        -MAX_COORDINATE_M,
        MAX_COORDINATE_M,
        "-1e7 to 1e7 m",
    )
    .map_err(|error| error.to_string())?;
    let file = args.file.as_deref().ok_or("no file is named")?;
    let field = read(file, args.cell_m, args.height_scale_m)?;
    let scene = matches!(ending(file).as_deref(), Some("glb" | "gltf"));
    let threshold_m = args.threshold_m.unwrap_or(if scene { SCENE_THRESHOLD_M } else { 0.0 });
    basins(&field, args.closed, threshold_m).map_err(|error| format!("{}: {error}", file.display()))
}

/// The basins of a height field.
///
/// # Errors
/// When the threshold lies outside its domain.
pub fn basins(field: &HeightField, closed: bool, threshold_m: f64) -> Result<BakeReport, String> {
    let [nx, nz] = field.cells();
    let mut grid = Grid::new(nx, nz, field.cell_m(), field.heights());
    grid.origin_m = field.frame().origin();
    let options = BakeOptions {
        closed,
        threshold_m,
        ..BakeOptions::default()
    };
    Basins::bake(&grid, &options)
        .map(|basins| basins.report())
        .map_err(|error| error.to_string())
}

/// The report as one JSON object; what does not exist is null.
#[must_use]
pub fn report_json(report: &BakeReport) -> Value {
    let basins: Vec<Value> = report
        .basins
        .iter()
        .map(|b| {
            json!({
                "id": b.id, "parent": b.parent, "x_m": b.x_m, "z_m": b.z_m, "bottom_m": b.bottom_m,
                "spill_m": b.spill_m, "volume_m3": b.volume_m3, "area_m2": b.area_m2, "overflows_to": b.overflows_to,
            })
        })
        .collect();
    json!({
        "cells": report.cells, "cell_m": report.cell_m, "basins": basins,
        // The sum of nothing is −0; adding zero makes it 0.
        "total_volume_m3": report.total_volume_m3 + 0.0,
    })
}

/// The report for people: a line a basin.
fn report_table(report: &BakeReport) -> String {
    let [nx, nz] = report.cells;
    let mut out = format!(
        "{nx} × {nz} cells of {} m, {} basins, {:.6} m³ in all\n",
        report.cell_m,
        report.basins.len(),
        report.total_volume_m3 + 0.0
    );
    let number = |value: Option<f64>| value.map_or("-".to_owned(), |v| format!("{v:.4}"));
    let id = |value: Option<u32>| value.map_or("-".to_owned(), |v| v.to_string());
    if !report.basins.is_empty() {
        out += "    id parent         x_m         z_m   bottom_m    spill_m   volume_m3     area_m2 overflows_to\n";
    }
    for b in &report.basins {
        // Writing to a string cannot fail.
        let _ = writeln!(
            out,
            "{:>6} {:>6} {:>11.3} {:>11.3} {:>10.4} {:>10} {:>11} {:>11.4} {:>12}",
            b.id,
            id(b.parent),
            b.x_m,
            b.z_m,
            b.bottom_m,
            number(b.spill_m),
            number(b.volume_m3),
            b.area_m2,
            id(b.overflows_to)
        );
    }
    out.trim_end().to_owned()
}
