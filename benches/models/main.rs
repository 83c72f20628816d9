//! Error against time of every model's variants: timed by criterion, written as CSV and PNG.
//!
//! `rain bench models` starts it; so does `cargo bench -p rain_bench`.
#![allow(clippy::print_stdout, reason = "a program's results")]

mod studies;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use rain_bench::study::Study;
use rain_bench::timing::{self, Effort};
use rain_bench::{plot, table};

/// Error against time of every model's variants.
#[derive(Debug, Parser)]
struct Args {
    /// Only studies whose name contains this.
    #[arg(long)]
    only: Option<String>,
    /// Where tables and plots go.
    #[arg(long, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/benchmarks"))]
    out: PathBuf,
    /// A tenth of the time: everything runs, the times are rough.
    #[arg(long)]
    quick: bool,
    /// Name the studies and stop.
    #[arg(long)]
    list: bool,
    /// What cargo adds.
    #[arg(long, hide = true)]
    bench: bool,
}

/// Faults of a study that would make its plot lie.
fn fault(study: &Study) -> Option<String> {
    let defaults = study.variants.iter().filter(|variant| variant.default).count();
    if defaults != 1 {
        return Some(format!("{}: {defaults} defaults, must be 1", study.name));
    }
    let bad = study
        .variants
        .iter()
        .find(|variant| !variant.error.is_finite() || variant.error < 0.0 || variant.evaluations == 0)?;
    Some(format!("{}: {} has error {}", study.name, bad.name, bad.error))
}

fn run(args: &Args) -> Result<(), String> {
    let mut studies = studies::all();
    if let Some(only) = &args.only {
        studies.retain(|study| study.name.contains(only.as_str()));
        if studies.is_empty() {
            return Err(format!("no study's name contains `{only}`; --list names them"));
        }
    }
    if args.list {
        for study in &studies {
            println!("{:<28} {} variants: {}", study.name, study.variants.len(), study.title);
        }
        return Ok(());
    }
    if let Some(fault) = studies.iter().find_map(fault) {
        return Err(fault);
    }
    std::fs::create_dir_all(&args.out).map_err(|error| format!("{}: {error}", args.out.display()))?;
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("criterion");
    let effort = if args.quick { Effort::QUICK } else { Effort::FULL };
    for mut study in studies {
        let times = timing::time(&mut study, &folder, effort)?;
        table::write(&study, &times, &args.out.join(format!("{}.csv", study.name)))?;
        plot::draw(&study, &times, &args.out.join(format!("{}.png", study.name)))?;
        println!("{}", table::text(&study, &times));
    }
    Ok(())
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}
