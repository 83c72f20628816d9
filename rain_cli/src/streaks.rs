//! `rain bake streaks`: streak textures into a folder of KTX2 files.

use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, ValueEnum};
use rain_core::rainfall::{
    CacheOutcome, CachedStreaks, Distribution, PackedStreaks, StreakCache, StreakLayer, StreakTextureSettings,
};
use serde_json::{Value, json};

use crate::print;

/// Family of drop sizes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Family {
    MarshallPalmer,
    Drizzle,
    Widespread,
    Thunderstorm,
}

impl From<Family> for Distribution {
    fn from(family: Family) -> Self {
        match family {
            Family::MarshallPalmer => Self::MarshallPalmer,
            Family::Drizzle => Self::Drizzle,
            Family::Widespread => Self::Widespread,
            Family::Thunderstorm => Self::Thunderstorm,
        }
    }
}

/// Arguments of `rain bake streaks`.
#[derive(Debug, Args)]
pub struct StreaksArgs {
    /// Folder that keeps the textures; a file that is there and right is not made again.
    #[arg(long, default_value = ".")]
    out: PathBuf,
    /// The set of Yoshida, Dobashi and Yamamoto: 1, 5, 10, 20 mm/h, 1.0 to 2.0 mm, 1/30 s.
    #[arg(long)]
    yoshida: bool,
    /// Family of drop sizes.
    #[arg(long, value_enum, default_value = "marshall-palmer")]
    distribution: Family,
    /// Rain rates in mm/h, rising, with commas between them (default: 1,5,25,100).
    #[arg(long, value_delimiter = ',')]
    intensities_mm_h: Option<Vec<f64>>,
    /// Borders of the size classes in mm, rising, with commas between them (default: six classes from 0.5 to 6).
    #[arg(long, value_delimiter = ',')]
    diameter_edges_mm: Option<Vec<f64>>,
    /// Texels along a side: a power of two (default: 512).
    #[arg(long)]
    texels: Option<u32>,
    /// Side of the cube of air in m (default: 1).
    #[arg(long, allow_negative_numbers = true)]
    tile_m: Option<f64>,
    /// Shutter time in s (default: 1/60).
    #[arg(long, allow_negative_numbers = true)]
    exposure_s: Option<f64>,
    /// Seed of the drops' places (default: 1).
    #[arg(long)]
    seed: Option<u64>,
    /// Print one JSON object on stdout.
    #[arg(long)]
    json: bool,
}

impl StreaksArgs {
    fn settings(&self) -> StreakTextureSettings {
        let base = if self.yoshida {
            StreakTextureSettings::yoshida()
        } else {
            StreakTextureSettings::default()
        };
        StreakTextureSettings {
            distribution: self.distribution.into(),
            intensities_mm_h: self.intensities_mm_h.clone().unwrap_or(base.intensities_mm_h),
            diameter_edges_mm: self.diameter_edges_mm.clone().unwrap_or(base.diameter_edges_mm),
            texels: self.texels.unwrap_or(base.texels),
            tile_m: self.tile_m.unwrap_or(base.tile_m),
            exposure_s: self.exposure_s.unwrap_or(base.exposure_s),
            seed: self.seed.unwrap_or(base.seed),
        }
    }
}

/// Runs `rain bake streaks` and prints; returns the exit code.
#[must_use]
pub fn run(args: &StreaksArgs) -> ExitCode {
    match bake(args) {
        Ok((cached, layers)) => {
            let text = if args.json {
                report_json(&cached, &layers).to_string()
            } else {
                report_table(&cached, &layers)
            };
            print::finish(&text, 0)
        }
        Err(message) => {
            let _ = writeln!(std::io::stderr(), "rain: {message}");
            ExitCode::from(2)
        }
    }
}

fn bake(args: &StreaksArgs) -> Result<(CachedStreaks, Vec<StreakLayer>), String> {
    let settings = args.settings();
    let layers = settings.layers().map_err(|error| error.to_string())?;
    let cached = StreakCache::new(&args.out)
        .get(&settings, PackedStreaks::bake)
        .map_err(|error| error.to_string())?;
    match &cached.not_stored {
        Some(error) => Err(error.to_string()),
        None => Ok((cached, layers)),
    }
}

/// Whether the textures were read or made, and why a file was replaced.
fn outcome(cached: &CachedStreaks) -> (&'static str, Option<String>) {
    match &cached.outcome {
        CacheOutcome::Read => ("read", None),
        CacheOutcome::Made => ("made", None),
        CacheOutcome::Remade(why) => ("remade", Some(why.to_string())),
    }
}

fn report_json(cached: &CachedStreaks, layers: &[StreakLayer]) -> Value {
    let settings = cached.textures.settings();
    let (outcome, why) = outcome(cached);
    let layers: Vec<Value> = layers
        .iter()
        .map(|l| {
            json!({
                "intensity_mm_h": l.intensity_mm_h, "min_mm": l.min_mm, "max_mm": l.max_mm,
                "speed_m_s": l.speed_m_s, "path_m": l.path_m, "number_per_m3": l.number_per_m3, "drops": l.drops,
                "share": l.share, "unit": l.unit, "extinction_per_m": l.extinction_per_m,
                "mean_opacity": l.mean_opacity(),
            })
        })
        .collect();
    json!({
        "file": cached.path.to_string_lossy(), "key": format!("{:016x}", settings.key()), "outcome": outcome,
        "why": why, "texels": settings.texels, "levels": settings.level_count(), "bytes": settings.bytes(),
        "tile_m": settings.tile_m, "exposure_s": settings.exposure_s, "seed": settings.seed, "layers": layers,
    })
}

/// The report for people: a line a layer.
fn report_table(cached: &CachedStreaks, layers: &[StreakLayer]) -> String {
    use std::fmt::Write as _;
    let settings = cached.textures.settings();
    let (outcome, why) = outcome(cached);
    let mut out = format!(
        "{}: {outcome}{}; {} layers of {} texels a side, {:.2} MB\n",
        cached.path.display(),
        why.map_or(String::new(), |why| format!(" ({why})")),
        layers.len(),
        settings.texels,
        settings.bytes() as f64 * 1e-6
    );
    out += " mm/h       diameters mm   m/s   streak m    drops  mean opacity\n";
    for l in layers {
        // Writing to a string cannot fail.
        let _ = writeln!(
            out,
            "{:>5} {:>8.3} to {:>6.3} {:>5.2} {:>10.4} {:>8} {:>13.3e}",
            l.intensity_mm_h,
            l.min_mm,
            l.max_mm,
            l.speed_m_s,
            l.path_m,
            l.drops,
            l.mean_opacity()
        );
    }
    out.trim_end().to_owned()
}
