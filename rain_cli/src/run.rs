//! `rain run`.

use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use rain_cli::print;
use rain_plugins::scenario::report::Report;
use rain_plugins::scenario::{Progress, RunError, RunOptions, Scenario, run as run_scenario};

#[derive(Debug, Args)]
pub struct RunArgs {
    /// Scenario file (RON).
    scenario: PathBuf,
    /// glTF file that replaces the scenario's scene.
    #[arg(long)]
    scene: Option<PathBuf>,
    /// Where relative scene files are looked up (default: beside the scenario).
    #[arg(long)]
    assets: Option<PathBuf>,
    /// Where results go (default: a folder named after the scenario).
    #[arg(long)]
    out: Option<PathBuf>,
    /// Number of captures, spread evenly over the scenario's own; expectations are left out.
    #[arg(long)]
    frames: Option<u32>,
    /// Size of the pictures, such as 1280x720.
    #[arg(long, value_parser = parse_size)]
    size: Option<[u32; 2]>,
    /// Seed of every random choice.
    #[arg(long)]
    seed: Option<u64>,
    /// Print the report as JSON on stdout.
    #[arg(long)]
    json: bool,
}

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let wrong = || format!("{text} is no size, allowed: WIDTHxHEIGHT, each 1 to 8192");
    let (w, h) = text.split_once(['x', 'X']).ok_or_else(wrong)?;
    let side = |s: &str| s.parse().ok().filter(|v| (1..=8192).contains(v)).ok_or_else(wrong);
    Ok([side(w)?, side(h)?])
}

/// Runs and prints; returns the exit code of `docs/conventions.md`.
pub fn run(args: &RunArgs) -> ExitCode {
    let out = args
        .out
        .clone()
        .unwrap_or_else(|| PathBuf::from(args.scenario.file_stem().unwrap_or_default()));
    let options = RunOptions {
        scene: args.scene.clone(),
        assets: args.assets.clone(),
        out: out.clone(),
        frames: args.frames,
        size: args.size,
        seed: args.seed,
    };
    match execute(&args.scenario, &options) {
        Ok(report) => {
            let text = if args.json {
                report.to_json().unwrap_or_default()
            } else {
                format!("{}\nresults: {}", report.table(), out.display())
            };
            print::finish(&text, u8::from(!report.passed()))
        }
        Err(error) => {
            let _ = writeln!(std::io::stderr(), "rain: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

/// Loads and runs one scenario behind a progress bar.
pub fn execute(path: &std::path::Path, options: &RunOptions) -> Result<Report, RunError> {
    let scenario = Scenario::load(path)?;
    let bar = ProgressBar::with_draw_target(Some(scenario.captures.len() as u64), ProgressDrawTarget::stderr());
    if let Ok(style) = ProgressStyle::with_template("{msg:24} [{bar:30}] {pos}/{len} {elapsed}") {
        bar.set_style(style.progress_chars("=> "));
    }
    let result = run_scenario(scenario, options, |progress| match progress {
        Progress::Loading => bar.set_message("loading"),
        Progress::Captures { done, all, time_s } => {
            bar.set_length(all as u64);
            bar.set_position(done as u64);
            bar.set_message(format!("at {time_s:.1} s"));
        }
        Progress::Writing => bar.set_message("writing"),
    });
    bar.finish_and_clear();
    result
}
