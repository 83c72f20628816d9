//! `peer_frames KIND COUNT`: one scene with one package's rain. Prints what is in it as a line of JSON; then, for each line with a
//! number of frames on stdin, draws so many and prints what one took. Who keeps several such programs can have them take
//! turns, so that what else the machine does falls on all of them alike.

mod frames;
mod hanabi;
mod kind;
mod ours;
mod scene;
mod weather;

use std::io::Write as _;
use std::process::ExitCode;

use kind::Kind;

const USAGE: &str = "usage: peer_frames KIND [COUNT], for example: echo 12 | peer_frames rain_near_only 10000; KIND: none, \
                     none_lit, rain, rain_near_only, hanabi, weather, weather_own, quads; COUNT: visible drops, needed but for none and none_lit; \
                     stdin: numbers of frames, one a line";

/// Most frames of a turn.
const MOST_FRAMES: u32 = 10_000;

fn say(line: &impl serde::Serialize) -> Result<(), String> {
    let text = serde_json::to_string(line).map_err(|error| error.to_string())?;
    let mut out = std::io::stdout().lock();
    writeln!(out, "{text}")
        .and_then(|()| out.flush())
        .map_err(|error| format!("cannot write to stdout: {error}"))
}

fn run() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let (kind, count) = kind::read(&words).map_err(|error| format!("{error}; {USAGE}"))?;
    if kind == Kind::Quads {
        return say(&rain_quads::pass::times(count, 31)?);
    }
    let mut frames = frames::Frames::new(kind, count)?;
    say(&frames.scene)?;
    for line in std::io::stdin().lines() {
        let line = line.map_err(|error| format!("cannot read stdin: {error}"))?;
        match line.trim().parse() {
            Ok(number @ 1..=MOST_FRAMES) => say(&frames.turn(number)?)?,
            _ => {
                return Err(format!(
                    "a number of frames is from 1 to {MOST_FRAMES}, not {line:?}; {USAGE}"
                ));
            }
        }
    }
    Ok(())
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("peer_frames: {message}");
            ExitCode::from(2)
        }
    }
}
