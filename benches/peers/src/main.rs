//! `peer_frames KIND COUNT`: frames of one scene with one package's rain, as JSON.

mod frames;
mod hanabi;
mod kind;
mod ours;
mod scene;
mod weather;

use std::process::ExitCode;

use kind::Kind;

const USAGE: &str = "usage: peer_frames KIND [COUNT], for example: peer_frames rain_near_only 10000; KIND: none, rain, \
                     rain_near_only, hanabi, weather, weather_own, quads; COUNT: visible drops, needed but for none";

fn run() -> Result<String, String> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let (kind, count) = kind::read(&words).map_err(|error| format!("{error}; {USAGE}"))?;
    let json = if kind == Kind::Quads {
        serde_json::to_string(&rain_quads::pass::times(count, 31)?)
    } else {
        serde_json::to_string(&frames::measured(kind, count)?)
    };
    json.map_err(|error| error.to_string())
}

fn main() -> ExitCode {
    match run() {
        Ok(json) => {
            println!("{json}");
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("peer_frames: {message}");
            ExitCode::from(2)
        }
    }
}
