//! `rain_quads COUNT [PAIRS]`: our draw pass beside a bare one over the same quads, as JSON.

use std::process::ExitCode;

fn run() -> Result<String, String> {
    let mut words = std::env::args().skip(1);
    let usage = "usage: rain_quads COUNT [PAIRS], for example: rain_quads 10000 31";
    let mut number = |what: &str, default: Option<u32>| match (words.next(), default) {
        (Some(word), _) => match word.parse::<u32>() {
            Ok(n) if n > 0 => Ok(n),
            _ => Err(format!("{what} must be a whole number above 0, not {word:?}; {usage}")),
        },
        (None, Some(default)) => Ok(default),
        (None, None) => Err(usage.to_owned()),
    };
    let count = number("COUNT", None)?;
    let pairs = number("PAIRS", Some(31))?;
    let times = rain_quads::pass::times(count, pairs as usize)?;
    serde_json::to_string(&times).map_err(|error| error.to_string())
}

fn main() -> ExitCode {
    match run() {
        Ok(json) => {
            println!("{json}");
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("rain_quads: {message}");
            ExitCode::from(2)
        }
    }
}
