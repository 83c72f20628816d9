//! Error against time of every model's variants: timed by criterion, written as CSV and PNG.
//!
//! `rain bench models` starts it; so does `cargo bench -p rain_bench`.
#![allow(clippy::print_stdout, reason = "a program's results")]

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use rain_bench::study::Study;
use rain_bench::timing::{self, Effort};
use rain_bench::{page, plot, studies, table};

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

fn run(args: &Args) -> Result<(), String> {
    let mut studies = studies::all();
    let wanted = |study: &Study| args.only.as_ref().is_none_or(|only| study.name.contains(only.as_str()));
    if !studies.iter().any(wanted) {
        return Err("no study's name contains that; --list names them".to_owned());
    }
    if args.list {
        for study in &studies {
            println!("{:<28} {} variants: {}", study.name, study.variants.len(), study.title);
        }
        return Ok(());
    }
    if let Some(fault) = studies.iter().find_map(Study::fault) {
        return Err(fault);
    }
    std::fs::create_dir_all(&args.out).map_err(|error| format!("{}: {error}", args.out.display()))?;
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("criterion");
    let effort = if args.quick { Effort::QUICK } else { Effort::FULL };
    for study in studies.iter_mut().filter(|study| wanted(study)) {
        let times = timing::time(study, &folder, effort)?;
        table::write(study, &times, &args.out.join(format!("{}.csv", study.name)))?;
        plot::draw(study, &times, &args.out.join(format!("{}.png", study.name)))?;
        println!("{}", table::text(study, &times));
    }
    page::write(&studies, &args.out)
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
