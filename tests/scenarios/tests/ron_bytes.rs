//! Scenarios that nobody meant: no panic, an error with a place, and what is accepted can be written and read again.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

use rain_fuzz::Target;
use rain_fuzz::mutate::{Dice, mutate};
use rain_plugins::scenario::{Scenario, ScenarioError};

/// Valid scenarios: those of the examples, and small ones whose every byte matters.
fn corpus() -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenarios");
    let mut texts: Vec<Vec<u8>> = std::fs::read_dir(folder)
        .expect("the examples are there")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "ron"))
        .map(|path| std::fs::read(path).expect("it can be read"))
        .collect();
    texts.sort();
    for small in [
        "(duration_s: 2, captures: Times([1]), outputs: (size: (16, 9), contact_sheet: false, timeline: false))",
        "(duration_s: 60, weather: (keys: [(time_s: 0, intensity_mm_h: 5), (time_s: 60, intensity_mm_h: 50)]))",
        "()",
    ] {
        texts.push(small.as_bytes().to_vec());
    }
    texts
}

const WORDS: [&str; 22] = [
    "duration_s:",
    "captures:",
    "Times(",
    "Every(",
    "weather:",
    "keys:",
    "time_s:",
    "intensity_mm_h:",
    "outputs:",
    "size:",
    "Some(",
    "None",
    "true",
    "inf",
    "-inf",
    "NaN",
    "(",
    ")",
    "[",
    "]",
    "r#\"",
    "/*",
];

/// Parses as the program does. Returns whether it was accepted.
fn parse(bytes: &[u8]) -> bool {
    let Ok(text) = core::str::from_utf8(bytes) else {
        return false;
    };
    // Tables named in it are looked for in a folder that does not exist.
    let path = Path::new("/no/such/folder/made-up.ron");
    match Scenario::parse(text, path) {
        Ok(scenario) => {
            let again = scenario.to_ron().expect("what was read can be written");
            let read = Scenario::parse(&again, path).unwrap_or_else(|error| panic!("{error}\n{again}"));
            assert_eq!(read.to_ron().expect("written"), again);
            true
        }
        Err(error) => {
            match &error {
                ScenarioError::Syntax { line, column, .. } | ScenarioError::Field { line, column, .. } => {
                    assert!(*line >= 1 && *column >= 1, "{error}");
                }
                ScenarioError::Io { .. } | ScenarioError::Csv { .. } => {}
            }
            assert!(!error.to_string().is_empty());
            false
        }
    }
}

/// One seeded round; panics with the text where the parser did.
#[track_caller]
fn round(pool: &[Vec<u8>], seed: u64, number: u64) -> bool {
    let mut dice = Dice::new(seed, number);
    let mut bytes = pool[dice.below(pool.len())].clone();
    mutate(&mut dice, Target::Csv, &mut bytes, pool, &WORDS);
    catch_unwind(AssertUnwindSafe(|| parse(&bytes)))
        .unwrap_or_else(|_| panic!("round {number}:\n{}", String::from_utf8_lossy(&bytes)))
}

#[test]
fn broken_scenarios_do_no_harm() {
    let pool = corpus();
    assert!(
        pool.len() >= 5 && pool.iter().all(|bytes| parse(bytes)),
        "the corpus is valid"
    );
    let accepted = (0..3000).filter(|number| round(&pool, 7, *number)).count();
    assert!((60..2900).contains(&accepted), "{accepted} of 3000 accepted");
    // As long as one likes.
    if let Some(seconds) = std::env::var("RAIN_FUZZ_SECONDS").ok().and_then(|s| s.parse().ok()) {
        let (start, mut number) = (Instant::now(), 0);
        while start.elapsed() < Duration::from_secs(seconds) {
            round(&pool, 11, number);
            number += 1;
        }
        eprintln!("{number} scenarios");
    }
}

#[test]
fn cut_scenarios_do_no_harm() {
    for bytes in corpus() {
        // Three has no factor in common with the layout: every kind of place is cut.
        for end in (0..bytes.len()).step_by(3) {
            parse(&bytes[..end]);
        }
    }
}

#[test]
fn nesting_without_end_is_refused() {
    for piece in ["(", "[", "Some(", "weather: (", "{\"a\": ", "/*"] {
        let text = piece.repeat(100_000);
        assert!(!parse(text.as_bytes()), "{piece}");
        assert!(!parse(format!("(scene: {text}").as_bytes()), "{piece}");
    }
}
