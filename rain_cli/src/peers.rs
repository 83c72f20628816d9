//! `rain bench peers`: frames with our rain beside frames with other packages' rain, by programs of their own.
//!
//! The programs lie in a workspace of their own (`benches/peers`), so that what is compared with is no dependency. All contenders
//! of a count are kept running and draw a few frames each in turn, so that what else the machine does falls on all of them
//! alike; a cost is a turn less the empty scene's before and after. They are built as games are shipped: without optimisation
//! the engine takes longer for each of our systems than the systems take.

use std::fmt::Write as _;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use clap::Args;
use serde_json::Value;

/// What draws rain into the scene, as `peer_frames` names it; the first is what the others are divided by.
const KINDS: [&str; 5] = ["rain_near_only", "rain", "hanabi", "weather", "weather_own"];

/// The scene without rain that a contender is compared with: for all but the whole of our rain it is not lit.
fn dry_kind(kind: &str) -> usize {
    usize::from(kind == "rain")
}

/// Those scenes.
const DRY: [&str; 2] = ["none", "none_lit"];

/// Frames of a turn that count.
const FRAMES: u32 = 4;

/// Turns before contenders are started anew: where a program's memory comes to lie is chance, and up to 2 ms a frame.
const TURNS_OF_A_START: u32 = 6;

/// A software device asks for memory at each draw. Whether the C library gives it back to the system in between depends on
/// what else lies there, and costs up to 3 ms a frame; here it never does, for none of them.
const KEPT_MEMORY: (&str, &str) = (
    "GLIBC_TUNABLES",
    "glibc.malloc.mmap_threshold=33554432:glibc.malloc.trim_threshold=4294967296",
);

/// Arguments of `rain bench peers`.
#[derive(Debug, Args)]
pub struct PeersArgs {
    /// Turns of each contender at each count.
    #[arg(long, default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=10_000))]
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
    /// That on the wall where the system does not tell.
    cpu_ms: f64,
}

impl Cost {
    fn read(json: &Value) -> Option<Self> {
        let wall_ms = json["wall_ms"].as_f64()?;
        Some(Self {
            wall_ms,
            cpu_ms: json["cpu_ms"].as_f64().unwrap_or(wall_ms),
        })
    }

    /// What this is over the mean of two others.
    fn over(self, before: Self, after: Self) -> Self {
        Self {
            wall_ms: self.wall_ms - 0.5 * (before.wall_ms + after.wall_ms),
            cpu_ms: self.cpu_ms - 0.5 * (before.cpu_ms + after.cpu_ms),
        }
    }
}

/// What one contender at one count cost.
#[derive(Debug)]
struct Row {
    count: u32,
    name: String,
    shown: Value,
    wall_ms: f64,
    /// The middle one of all turns, and where it lies with a chance of 95 %.
    cpu_ms: [f64; 3],
    /// Over that of what it is compared with.
    ratio: f64,
    /// How much more it cost than ours in the same turn, and where that lies with a chance of 95 %; not of passes.
    more_ms: Option<[f64; 3]>,
}

/// Builds and runs the programs; prints the table and writes it as CSV.
///
/// # Errors
/// When a program does not build, start or end well.
pub fn run(args: &PeersArgs, root: &Path, here: &Path) -> Result<(), String> {
    let programs = built(root)?;
    let mut rows = Vec::new();
    for count in &args.counts {
        let mut say = std::io::stderr();
        let _ = writeln!(say, "{count} drops: passes");
        rows.extend(quads(&programs, *count)?);
        let _ = writeln!(say, "{count} drops: {} turns", args.rounds);
        rows.extend(frames(&programs, *count, args.rounds)?);
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
            "--release",
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
        Ok(target.join("release"))
    } else {
        Err(format!(
            "the programs of benches/peers do not build: cargo ended with {status}"
        ))
    }
}

/// A program that has its scene ready and waits for its turn.
struct Contender {
    kind: String,
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
}

impl Contender {
    /// Starts a program; returns it with what it says of its scene.
    fn start(programs: &Path, kind: &str, count: u32) -> Result<(Self, Value), String> {
        let program = programs.join(format!("peer_frames{}", std::env::consts::EXE_SUFFIX));
        let mut child = Command::new(&program)
            .args([kind, &count.to_string()])
            .env(KEPT_MEMORY.0, KEPT_MEMORY.1)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::inherit())
            .spawn()
            .map_err(|error| format!("{} does not start: {error}", program.display()))?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(format!("{} has no pipes", program.display()));
        };
        let mut contender = Self {
            kind: format!("{kind} {count}"),
            child,
            input,
            output: BufReader::new(output),
        };
        let scene = contender.answer()?;
        Ok((contender, scene))
    }

    fn answer(&mut self) -> Result<Value, String> {
        let mut line = String::new();
        let read = self.output.read_line(&mut line);
        if !matches!(read, Ok(bytes) if bytes > 0) {
            return Err(format!("peer_frames {} ended without an answer", self.kind));
        }
        serde_json::from_str(&line).map_err(|error| format!("peer_frames {} printed no JSON: {error}", self.kind))
    }

    fn turn(&mut self) -> Result<Cost, String> {
        writeln!(self.input, "{FRAMES}")
            .map_err(|error| format!("peer_frames {} does not listen: {error}", self.kind))?;
        let json = self.answer()?;
        Cost::read(&json).ok_or_else(|| format!("peer_frames {} does not say how long it took", self.kind))
    }
}

impl Drop for Contender {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Frames of all contenders at one count, in turn; started anew every few turns.
fn frames(programs: &Path, count: u32, rounds: u32) -> Result<Vec<Row>, String> {
    let mut costs = vec![Vec::new(); KINDS.len()];
    let mut scenes = Vec::new();
    let mut left = rounds;
    while left > 0 {
        let turns = left.min(TURNS_OF_A_START);
        scenes = started(programs, count, turns, &mut costs)?;
        left -= turns;
    }
    let ours = middle(costs[0].iter().map(|cost| cost.cpu_ms))[0];
    Ok(scenes
        .iter()
        .zip(KINDS)
        .zip(&costs)
        .map(|((scene, kind), own)| {
            let cpu_ms = middle(own.iter().map(|cost| cost.cpu_ms));
            Row {
                count,
                name: kind.to_owned(),
                shown: scene["shown"].clone(),
                wall_ms: middle(own.iter().map(|cost| cost.wall_ms))[0],
                cpu_ms,
                ratio: cpu_ms[0] / ours,
                more_ms: Some(middle(
                    own.iter().zip(&costs[0]).map(|(cost, ours)| cost.cpu_ms - ours.cpu_ms),
                )),
            }
        })
        .collect())
}

/// Adds some turns of all contenders to their costs; returns what they say of their scenes.
fn started(programs: &Path, count: u32, turns: u32, costs: &mut [Vec<Cost>]) -> Result<Vec<Value>, String> {
    let mut dry = Vec::new();
    for kind in DRY {
        dry.push(Contender::start(programs, kind, count)?.0);
    }
    let (mut contenders, mut scenes) = (Vec::new(), Vec::new());
    for kind in KINDS {
        let (contender, scene) = Contender::start(programs, kind, count)?;
        contenders.push(contender);
        scenes.push(scene);
    }
    let empty = |dry: &mut Vec<Contender>| dry.iter_mut().map(Contender::turn).collect::<Result<Vec<_>, _>>();
    let mut before = empty(&mut dry)?;
    for _ in 0..turns {
        let mut took = Vec::new();
        for contender in &mut contenders {
            took.push(contender.turn()?);
        }
        let after = empty(&mut dry)?;
        for ((list, turn), kind) in costs.iter_mut().zip(took).zip(KINDS) {
            let dry = dry_kind(kind);
            list.push(turn.over(before[dry], after[dry]));
        }
        before = after;
    }
    Ok(scenes)
}

/// Our draw pass beside the bare quads.
fn quads(programs: &Path, count: u32) -> Result<Vec<Row>, String> {
    let (_, json) = Contender::start(programs, "quads", count)?;
    let part =
        |name: &str| Cost::read(&json[name]).ok_or_else(|| format!("peer_frames quads does not say what {name} took"));
    let bare = part("bare")?;
    let mut rows = Vec::new();
    for name in ["bare", "draw", "soft", "project", "listed", "list"] {
        let cost = part(name)?;
        rows.push(Row {
            count,
            name: format!("pass: {name}"),
            shown: json["shown"].clone(),
            wall_ms: cost.wall_ms,
            cpu_ms: [cost.cpu_ms; 3],
            ratio: cost.cpu_ms / bare.cpu_ms,
            more_ms: None,
        });
    }
    Ok(rows)
}

/// The middle one, and the two between which it lies with a chance of 95 %: the sign test's.
fn middle(values: impl Iterator<Item = f64>) -> [f64; 3] {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len() as f64;
    let at = |rank: f64| {
        let index = rank.clamp(0.0, (n - 1.0).max(0.0)) as usize;
        sorted.get(index).copied().unwrap_or(f64::NAN)
    };
    let half = 0.98 * n.sqrt();
    [at(0.5 * n), at((0.5 * n - half).floor()), at((0.5 * n + half).ceil())]
}

/// The columns of a row behind count and contender.
fn columns(row: &Row) -> [String; 11] {
    let shown = |name: &str| row.shown[name].as_f64().unwrap_or_default();
    let [cpu, low, high] = row.cpu_ms;
    let [more, more_low, more_high] = row
        .more_ms
        .map_or_else(Default::default, |more| more.map(|ms| format!("{ms:.1}")));
    [
        format!("{:.0}", shown("visible")),
        format!("{:.1}", shown("length_px")),
        format!("{:.2}", shown("width_px")),
        format!("{:.1}", row.wall_ms),
        format!("{cpu:.1}"),
        format!("{low:.1}"),
        format!("{high:.1}"),
        format!("{:.2}", row.ratio),
        more,
        more_low,
        more_high,
    ]
}

fn csv(rows: &[Row]) -> String {
    let mut out = String::from(
        "count,contender,visible,length_px,width_px,wall_ms,cpu_ms,cpu_low_ms,cpu_high_ms,ratio,more_ms,more_low_ms,more_high_ms\n",
    );
    for row in rows {
        let _ = writeln!(out, "{},{},{}", row.count, row.name, columns(row).join(","));
    }
    out
}

fn table(rows: &[Row]) -> String {
    let mut out = String::from(
        "Cost over the same frame without rain (of passes: over an empty one), the middle of all turns, and where it lies with a\n\
         chance of 95 %; ratio of what ran on all cores, to rain_near_only and to the bare quads; how much more it was in the same turn.\n\n\
         count    contender        visible  length, px  width, px  wall, ms   cpu, ms                     ratio  more, ms\n",
    );
    for row in rows {
        let [
            visible,
            length,
            width,
            wall,
            cpu,
            low,
            high,
            ratio,
            more,
            more_low,
            more_high,
        ] = columns(row);
        let between = |low: &str, high: &str| {
            if low == high {
                String::new()
            } else {
                format!("({low} to {high})")
            }
        };
        let (range, more_range) = (between(&low, &high), between(&more_low, &more_high));
        let _ = writeln!(
            out,
            "{:<8} {:<16} {visible:>7}  {length:>10}  {width:>9}  {wall:>8}  {cpu:>8} {range:<17}  {ratio:>5}  {more:>8} {more_range}",
            row.count, row.name
        );
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_is_compared_with_the_empty_ones_around_it() {
        let cost = |wall_ms, cpu_ms| Cost { wall_ms, cpu_ms };
        assert_eq!(cost(9.0, 30.0).over(cost(4.0, 10.0), cost(6.0, 14.0)), cost(4.0, 18.0));
    }

    #[test]
    fn the_middle_lies_between_its_bounds() {
        assert_eq!(middle([3.0, 1.0, 2.0].into_iter()), [2.0, 1.0, 3.0]);
        let many = middle((0..100).map(f64::from));
        assert_eq!(many, [50.0, 40.0, 60.0]);
        assert!(middle(std::iter::empty()).iter().all(|v| v.is_nan()));
    }

    #[test]
    fn rows_say_what_they_are_compared_with() {
        let row = Row {
            count: 10,
            name: "hanabi".to_owned(),
            shown: serde_json::json!({"visible": 12}),
            wall_ms: 1.0,
            cpu_ms: [40.0, 35.0, 44.0],
            ratio: 2.0,
            more_ms: Some([20.0, 18.5, 21.0]),
        };
        let rows = [row];
        assert!(csv(&rows).ends_with("10,hanabi,12,0.0,0.00,1.0,40.0,35.0,44.0,2.00,20.0,18.5,21.0\n"));
        let table = table(&rows);
        assert!(table.contains("40.0 (35.0 to 44.0)"), "{table}");
        assert!(table.contains("2.00      20.0 (18.5 to 21.0)"), "{table}");
    }

    #[test]
    fn the_wall_counts_where_nothing_else_is_known() {
        let read = |json: Value| Cost::read(&json);
        assert_eq!(
            read(serde_json::json!({"wall_ms": 2.5, "cpu_ms": null})),
            Some(Cost {
                wall_ms: 2.5,
                cpu_ms: 2.5
            })
        );
        assert_eq!(read(serde_json::json!({"cpu_ms": 1.0})), None);
    }
}
