//! The `rain` program.

#[cfg(feature = "scenarios")]
mod check;
#[cfg(feature = "scenarios")]
mod run;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use rain_cli::{bake, bench, model, print};

/// Rain for game engines: scenarios, models as a calculator, puddles.
#[derive(Debug, Parser)]
#[command(name = "rain", version, about)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run a scenario: frames, masks, contact sheet, timeline plot and report.
    #[cfg(feature = "scenarios")]
    Run(run::RunArgs),
    /// Run every scenario given (folders too) and say which expectations held.
    #[cfg(feature = "scenarios")]
    Check(check::CheckArgs),
    /// Compute a physical model: `rain model terminal-speed diameter_mm=2`. Without a name, list them.
    Model(model::ModelArgs),
    /// Find the puddles of a scene or height field, or make streak textures (`rain bake streaks`).
    Bake(bake::BakeArgs),
    /// Measure.
    Bench(bench::BenchArgs),
}

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            let printed = error.print();
            // Help and version are no errors; everything else is bad input.
            return print::written(printed, if error.use_stderr() { 2 } else { 0 });
        }
    };
    match cli.command {
        #[cfg(feature = "scenarios")]
        Command::Run(args) => run::run(&args),
        #[cfg(feature = "scenarios")]
        Command::Check(args) => check::check(&args),
        Command::Model(args) => model::run(&args),
        Command::Bake(args) => bake::run(&args),
        Command::Bench(args) => bench::run(&args, &std::env::current_dir().unwrap_or_default()),
    }
}
