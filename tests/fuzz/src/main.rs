//! Feeds mutated inputs to one target, or to all in turn, for as long as told.
#![allow(clippy::print_stdout, reason = "a program's results")]

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use clap::Parser;
use rain_fuzz::corpus::{corpus, words};
use rain_fuzz::mutate::{Dice, mutate};
use rain_fuzz::{Target, attempt};

/// Bytes that nobody meant: mutates valid inputs and keeps those that panic or take too much memory.
#[derive(Debug, Parser)]
struct Args {
    /// hyetograph, csv, png, gltf or model (default: all, the time shared).
    #[arg(long)]
    target: Option<String>,
    /// How long.
    #[arg(long, default_value_t = 60)]
    seconds: u64,
    /// Seed: the same seed tries the same inputs in the same order.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Instead of fuzzing, write the target's valid inputs into this folder and its words into `FOLDER.dict`.
    #[arg(long, requires = "target")]
    export: Option<PathBuf>,
}

/// Where failing inputs go.
const REGRESSIONS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/regressions");

/// Most inputs kept; enough to see what is wrong.
const MOST_FAILURES: usize = 20;

fn fuzz(target: Target, time: Duration, seed: u64) -> Result<usize, std::io::Error> {
    let (mut pool, words) = (corpus(target), words(target));
    let valid = pool.len();
    let folder = Path::new(REGRESSIONS).join(target.name());
    for entry in std::fs::read_dir(&folder).into_iter().flatten().flatten() {
        pool.push(std::fs::read(entry.path())?);
    }
    let (start, mut round, mut accepted, mut failures) = (Instant::now(), 0_u64, 0_u64, 0);
    while start.elapsed() < time && failures < MOST_FAILURES {
        let mut dice = Dice::new(seed, round);
        round += 1;
        let from = dice.below(pool.len());
        let mut bytes = pool[from].clone();
        mutate(&mut dice, target, &mut bytes, &pool, &words);
        match attempt(target, &bytes) {
            Ok(true) => {
                accepted += 1;
                // What is valid and different may lead further; the pool stays small.
                if pool.len() < 64 * valid && dice.below(8) == 0 {
                    pool.push(bytes);
                }
            }
            Ok(false) => {}
            Err(failure) => {
                failures += 1;
                std::fs::create_dir_all(&folder)?;
                let file = folder.join(format!("{seed}-{round}"));
                std::fs::write(&file, &bytes)?;
                println!("{}: {failure:?} in {}", target.name(), file.display());
            }
        }
    }
    let seconds = start.elapsed().as_secs_f64();
    println!(
        "{:<10} {round} inputs in {seconds:.0} s, {accepted} valid, {failures} failures",
        target.name()
    );
    Ok(failures)
}

/// Writes inputs and dictionary for libFuzzer.
fn export(target: Target, folder: &Path) -> Result<(), std::io::Error> {
    std::fs::create_dir_all(folder)?;
    for (i, bytes) in corpus(target).iter().enumerate() {
        std::fs::write(folder.join(format!("valid-{i}")), bytes)?;
    }
    let quoted = |word: &str| -> String { word.bytes().map(|byte| format!("\\x{byte:02x}")).collect() };
    let dictionary: String = words(target)
        .iter()
        .map(|word| format!("\"{}\"\n", quoted(word)))
        .collect();
    std::fs::write(folder.with_extension("dict"), dictionary)
}

fn main() -> ExitCode {
    let args = Args::parse();
    let targets = match &args.target {
        None => Target::ALL.to_vec(),
        Some(name) => match Target::named(name) {
            Some(target) => vec![target],
            None => {
                let all = Target::ALL.map(Target::name).join(", ");
                eprintln!("--target is {name}, allowed: {all}");
                return ExitCode::from(2);
            }
        },
    };
    if let (Some(folder), [target]) = (&args.export, targets.as_slice()) {
        return match export(*target, folder) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                eprintln!("{}: {error}", folder.display());
                ExitCode::from(2)
            }
        };
    }
    // A panic is caught and told in one line.
    std::panic::set_hook(Box::new(|_| {}));
    let time = Duration::from_secs(args.seconds) / targets.len() as u32;
    let mut failures = 0;
    for target in targets {
        match fuzz(target, time, args.seed) {
            Ok(count) => failures += count,
            Err(error) => {
                eprintln!("{REGRESSIONS}: {error}");
                return ExitCode::from(2);
            }
        }
    }
    ExitCode::from(u8::from(failures > 0))
}
