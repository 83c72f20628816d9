//! `rain bench`: error against time of every model's variants, by the workspace's benchmark program, and frames beside
//! other packages' rain.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use clap::{Args, Subcommand};

use crate::peers::{self, PeersArgs};

/// Arguments of `rain bench`.
#[derive(Debug, Args)]
pub struct BenchArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Error against time of every model's variants: prints tables, writes CSV and PNG files.
    Models(ModelsArgs),
    /// Frames with our rain beside the same frames with the rain of `bevy_hanabi` and `bevy_weather`, and our streaks beside
    /// bare quads: prints a table, writes peer-frames.csv.
    Peers(PeersArgs),
}

/// Arguments of `rain bench models`.
#[derive(Debug, Args)]
struct ModelsArgs {
    /// Only studies whose name contains this.
    #[arg(long)]
    only: Option<String>,
    /// A tenth of the time: everything runs, the times are rough.
    #[arg(long)]
    quick: bool,
    /// Where tables and plots go (default: docs/benchmarks of the workspace).
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Runs `rain bench` from the folder `here` or below it; returns the exit code.
#[must_use]
pub fn run(args: &BenchArgs, here: &Path) -> ExitCode {
    let done = root(here).and_then(|root| match &args.what {
        What::Models(models) => start(models, root, here),
        What::Peers(peers) => peers::run(peers, root, here),
    });
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            let _ = writeln!(std::io::stderr(), "rain: {message}");
            ExitCode::from(2)
        }
    }
}

/// The workspace that `here` lies in.
fn workspace(here: &Path) -> Option<&Path> {
    here.ancestors()
        .find(|folder| folder.join("benches/models/Cargo.toml").is_file())
}

fn root(here: &Path) -> Result<&Path, String> {
    workspace(here).ok_or_else(|| {
        format!(
            "rain bench runs in a checkout of its sources; {} lies in none (no benches/models/Cargo.toml above it)",
            here.display()
        )
    })
}

fn start(args: &ModelsArgs, root: &Path, here: &Path) -> Result<(), String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(&cargo);
    command
        .current_dir(root)
        .args(["bench", "-p", "rain_bench", "--bench", "models", "--"]);
    if let Some(only) = &args.only {
        command.args(["--only", only]);
    }
    if args.quick {
        command.arg("--quick");
    }
    if let Some(out) = &args.out {
        // cargo starts the program elsewhere.
        command.arg("--out").arg(here.join(out));
    }
    let status = command.status().map_err(|error| {
        format!(
            "{} does not start: {error}; install Rust from https://rustup.rs",
            cargo.display()
        )
    })?;
    if status.success() {
        Ok(())
    } else {
        Err(format!("the benchmark program ended with {status}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_workspace_is_found_from_below_and_not_from_outside() {
        let package = Path::new(env!("CARGO_MANIFEST_DIR"));
        let root = workspace(package).expect("this package lies in the workspace");
        assert_eq!(Some(root), package.parent());
        assert_eq!(workspace(&root.join("docs")), Some(root));
        assert_eq!(workspace(Path::new("/")), None);
    }
}
