//! `rain bench peers`: frames with our rain beside frames with other packages' rain, by programs of their own.
//!
//! The programs lie in a workspace of their own (`benches/peers`), so that what is compared with is no dependency. Rounds
//! are interleaved; costs are differences and ratios within a round, their medians over rounds.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::Args;
use serde_json::Value;

/// What draws rain into the scene, as `peer_frames` names it; the first is what the others are divided by.
const KINDS: [&str; 5] = ["rain_near_only", "rain", "hanabi", "weather", "weather_own"];

/// Arguments of `rain bench peers`.
#[derive(Debug, Args)]
pub struct PeersArgs {
    /// Interleaved rounds.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=1000))]
    rounds: u32,
    /// Visible drops, such as 10000,50000.
    #[arg(long, value_delimiter = ',', default_values_t = [10_000, 50_000, 200_000],
          value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    counts: Vec<u32>,
    /// Folder of the table peer-frames.csv (default: docs/benchmarks of the workspace).
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Time on the wall and on all cores. Units: ms.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Cost {
    wall_ms: f64,
    /// NaN where the system does not tell.
    cpu_ms: f64,
}

impl Cost {
    fn read(json: &Value) -> Option<Self> {
        Some(Self {
            wall_ms: json["wall_ms"].as_f64()?,
            cpu_ms: json["cpu_ms"].as_f64().unwrap_or(f64::NAN),
        })
    }

    fn over(self, other: Self) -> Self {
        Self {
            wall_ms: self.wall_ms - other.wall_ms,
            cpu_ms: self.cpu_ms - other.cpu_ms,
        }
    }
}

/// What one contender at one count cost in every round.
#[derive(Debug, Default)]
struct Row {
    costs: Vec<Cost>,
    /// Cost on all cores over that of what it is compared with, round by round.
    ratios: Vec<f64>,
    shown: Value,
}

/// Rows in the table's order.
type Rows = BTreeMap<(u32, usize, String), Row>;

/// Builds and runs the programs; prints the table and writes it as CSV.
///
/// # Errors
/// When a program does not build, start or end well.
pub fn run(args: &PeersArgs, root: &Path, here: &Path) -> Result<(), String> {
    let programs = built(root)?;
    let mut rows = Rows::new();
    for round in 0..args.rounds {
        let mut say = std::io::stderr();
        let _ = writeln!(say, "round {} of {}", round + 1, args.rounds);
        let dry = frame(&programs, "none", 0)?.0;
        for count in &args.counts {
            quads(&programs, *count, &mut rows)?;
            let mut first = None;
            for (place, kind) in KINDS.iter().enumerate() {
                let (frame, shown) = frame(&programs, kind, *count)?;
                let cost = frame.over(dry);
                let base = *first.get_or_insert(cost);
                push(&mut rows, (*count, place, (*kind).to_owned()), cost, base, shown);
            }
        }
    }
    let out = args
        .out
        .as_ref()
        .map_or_else(|| root.join("docs/benchmarks"), |out| here.join(out));
    let path = out.join("peer-frames.csv");
    std::fs::write(&path, csv(&rows)).map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    let text = format!("{}\ntable: {}\n", table(&rows), path.display());
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(format!("cannot write to stdout: {error}")),
        _ => Ok(()),
    }
}

/// Builds `peer_frames`; returns the folder that it lies in.
fn built(root: &Path) -> Result<PathBuf, String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), |dir| root.join(dir));
    let status = Command::new(&cargo)
        .current_dir(root)
        .args([
            "build",
            "--locked",
            "--manifest-path",
            "benches/peers/Cargo.toml",
            "--target-dir",
        ])
        .arg(&target)
        .status()
        .map_err(|error| {
            format!(
                "{} does not start: {error}; install Rust from https://rustup.rs",
                cargo.display()
            )
        })?;
    if status.success() {
        Ok(target.join("debug"))
    } else {
        Err(format!(
            "the programs of benches/peers do not build: cargo ended with {status}"
        ))
    }
}

/// What a program prints.
fn answer(programs: &Path, kind: &str, count: u32) -> Result<Value, String> {
    let program = programs.join(format!("peer_frames{}", std::env::consts::EXE_SUFFIX));
    let output = Command::new(&program)
        .args([kind, &count.max(1).to_string()])
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| format!("{} does not start: {error}", program.display()))?;
    if !output.status.success() {
        return Err(format!("peer_frames {kind} {count} ended with {}", output.status));
    }
    serde_json::from_slice(&output.stdout)
        .map_err(|error| format!("peer_frames {kind} {count} printed no JSON: {error}"))
}

fn part(json: &Value, name: &str, of: &str) -> Result<Cost, String> {
    Cost::read(&json[name]).ok_or_else(|| format!("peer_frames {of} does not say what {name} took"))
}

/// A frame, and what is seen in it.
fn frame(programs: &Path, kind: &str, count: u32) -> Result<(Cost, Value), String> {
    let json = answer(programs, kind, count)?;
    Ok((part(&json, "frame", kind)?, json["shown"].clone()))
}

/// Our draw pass beside the bare quads.
fn quads(programs: &Path, count: u32, rows: &mut Rows) -> Result<(), String> {
    let json = answer(programs, "quads", count)?;
    let bare = part(&json, "bare", "quads")?;
    for (place, name) in ["bare", "draw", "soft", "project", "listed", "list"]
        .into_iter()
        .enumerate()
    {
        let key = (count, KINDS.len() + place, format!("pass: {name}"));
        push(rows, key, part(&json, name, "quads")?, bare, json["shown"].clone());
    }
    Ok(())
}

fn push(rows: &mut Rows, key: (u32, usize, String), cost: Cost, base: Cost, shown: Value) {
    let row = rows.entry(key).or_default();
    row.costs.push(cost);
    // Where a system does not tell what ran, the wall must do.
    let ran = cost.cpu_ms / base.cpu_ms;
    row.ratios.push(if ran.is_finite() {
        ran
    } else {
        cost.wall_ms / base.wall_ms
    });
    row.shown = shown;
}

/// The middle one, the lowest, the highest.
fn spread(values: impl Iterator<Item = f64>) -> [f64; 3] {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    let at = |i: usize| sorted.get(i).copied().unwrap_or(f64::NAN);
    [at(sorted.len() / 2), at(0), at(sorted.len().saturating_sub(1))]
}

/// The columns of a row behind count and contender.
fn columns(row: &Row) -> [String; 8] {
    let shown = |name: &str| row.shown[name].as_f64().unwrap_or_default();
    let [ratio, low, high] = spread(row.ratios.iter().copied());
    [
        format!("{:.0}", shown("visible")),
        format!("{:.1}", shown("length_px")),
        format!("{:.2}", shown("width_px")),
        format!("{:.1}", spread(row.costs.iter().map(|c| c.wall_ms))[0]),
        format!("{:.1}", spread(row.costs.iter().map(|c| c.cpu_ms))[0]),
        format!("{ratio:.2}"),
        format!("{low:.2}"),
        format!("{high:.2}"),
    ]
}

fn csv(rows: &Rows) -> String {
    let mut out =
        String::from("count,contender,visible,length_px,width_px,wall_ms,cpu_ms,ratio,ratio_low,ratio_high\n");
    for ((count, _, name), row) in rows {
        let _ = writeln!(out, "{count},{name},{}", columns(row).join(","));
    }
    out
}

fn table(rows: &Rows) -> String {
    let mut out = String::from(
        "Cost over the same frame without rain (of passes: over an empty one); ratio of what ran on all cores, to\n\
         rain_near_only and to the bare quads, with its range over the rounds.\n\n\
         count    contender        visible  length, px  width, px  wall, ms   cpu, ms  ratio\n",
    );
    for ((count, _, name), row) in rows {
        let [visible, length, width, wall, cpu, ratio, low, high] = columns(row);
        let _ = writeln!(
            out,
            "{count:<8} {name:<16} {visible:>7}  {length:>10}  {width:>9}  {wall:>8}  {cpu:>8}  {ratio} ({low} to {high})"
        );
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cost(wall_ms: f64, cpu_ms: f64) -> Cost {
        Cost { wall_ms, cpu_ms }
    }

    #[test]
    fn ratios_are_taken_within_rounds() {
        let mut rows = Rows::new();
        let key = || (10, 2, "hanabi".to_owned());
        for (own, base) in [(30.0, 10.0), (40.0, 20.0), (90.0, 90.0)] {
            push(&mut rows, key(), cost(1.0, own), cost(1.0, base), Value::Null);
        }
        let text = csv(&rows);
        assert!(
            text.ends_with("10,hanabi,0,0.0,0.00,1.0,40.0,2.00,1.00,3.00\n"),
            "{text}"
        );
        assert!(table(&rows).contains("2.00 (1.00 to 3.00)"));
    }

    #[test]
    fn the_wall_counts_where_nothing_else_is_known() {
        let mut rows = Rows::new();
        let key = (10, 2, "hanabi".to_owned());
        push(&mut rows, key, cost(3.0, f64::NAN), cost(2.0, f64::NAN), Value::Null);
        assert!(csv(&rows).ends_with(",NaN,1.50,1.50,1.50\n"), "{}", csv(&rows));
    }

    #[test]
    fn what_says_no_time_is_refused() {
        let json = serde_json::json!({"frame": {"wall_ms": 2.5, "cpu_ms": null}});
        let read = part(&json, "frame", "none").expect("a time");
        assert!(read.wall_ms == 2.5 && read.cpu_ms.is_nan());
        assert!(part(&json, "bare", "quads").is_err_and(|e| e.contains("bare")));
    }
}
