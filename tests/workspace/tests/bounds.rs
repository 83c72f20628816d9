//! Every public function of a model says in its documentation how far it is from its reference.
//!
//! A paragraph that starts with `Error:` gives the bound, or says `exact`, `none` or an order of convergence, or whose bound it is (`that of …`,
//! `as …`); the tests that `docs/physics.md` names assert it.

use std::collections::BTreeMap;

use crate::physics::{MODELS, identifier};
use crate::repository::{files_ending, text};

/// What stands in place of a number.
const WORDS: [&str; 7] = [
    "exact",
    "none",
    "one rounding",
    "second order",
    "that of ",
    "those of ",
    "as ",
];

/// The public functions that stand in no `impl`, with their documentation, a paragraph an entry.
fn documented(source: &str) -> Vec<(String, Vec<String>)> {
    let mut functions = Vec::new();
    let mut paragraphs: Vec<String> = Vec::new();
    let mut inside = false;
    for line in source.lines().take_while(|line| *line != "#[cfg(test)]") {
        if let Some(doc) = line.strip_prefix("///") {
            let doc = doc.trim();
            if doc.is_empty() {
                inside = false;
            } else if inside {
                let last = paragraphs.last_mut().expect("one is open");
                last.push(' ');
                last.push_str(doc);
            } else {
                paragraphs.push(doc.to_owned());
                inside = true;
            }
            continue;
        }
        inside = false;
        let signature = line
            .strip_prefix("pub fn ")
            .or_else(|| line.strip_prefix("pub const fn "));
        if let Some(rest) = signature {
            functions.push((identifier(rest).to_owned(), std::mem::take(&mut paragraphs)));
        } else if !line.starts_with("#[") {
            paragraphs.clear();
        }
    }
    functions
}

/// A text without what stands in backquotes: names have digits too.
fn without_code(text: &str) -> String {
    text.split('`').step_by(2).collect()
}

/// Whether a paragraph states a bound: a sentence that starts with `Error:` or `Error against …:`.
fn states_a_bound(paragraph: &str) -> bool {
    paragraph.match_indices("Error").any(|(at, word)| {
        let before = paragraph[..at].trim_end();
        let starts = before.is_empty() || before.ends_with(['.', ')']);
        let after = &paragraph[at + word.len()..];
        let bound = if after.starts_with(" against ") {
            after.split_once(": ").map(|(_, bound)| bound)
        } else {
            after.strip_prefix(": ")
        };
        starts
            && bound.is_some_and(|bound| {
                WORDS.iter().any(|word| bound.starts_with(word))
                    || without_code(bound).chars().any(|letter| letter.is_ascii_digit())
            })
    })
}

/// The public functions of a source whose documentation states no bound.
fn boundless(source: &str) -> Vec<String> {
    documented(source)
        .into_iter()
        .filter(|(_, paragraphs)| !paragraphs.iter().any(|paragraph| states_a_bound(paragraph)))
        .map(|(name, _)| name)
        .collect()
}

#[test]
fn every_public_model_states_its_error() {
    let mut found = 0_usize;
    let mut missing: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for file in files_ending(&[".rs"]) {
        let folder = file
            .strip_prefix("rain_core/src/")
            .and_then(|path| path.split('/').next());
        if !folder.is_some_and(|folder| MODELS.contains(&folder)) {
            continue;
        }
        let source = text(file);
        found += documented(&source).len();
        let boundless = boundless(&source);
        if !boundless.is_empty() {
            missing.insert(file, boundless);
        }
    }
    assert!(found > 150, "only {found} public functions: is the scan blind?");
    assert!(missing.is_empty(), "no `Error:` with a bound: {missing:#?}");
}

#[test]
fn functions_without_a_bound_are_found() {
    let function = |doc: &str| format!("{doc}\n#[must_use]\n#[inline]\npub fn f(x: f64) -> f64 {{\n    x\n}}\n");
    for good in [
        "/// A model.\n///\n/// Error: 1e-12 relative.",
        "/// A model in m/s. Error: 3e-7 relative.\n/// More.",
        "/// A model.\n///\n/// Error: exact, the same integers.",
        "/// A model.\n///\n/// Error: that of [`g`].",
        "/// A model.\n///\n/// Error: against the sum over\n/// drops 2 %.",
        "/// A model. Error against [`g`]: 6e-7 of it.",
        "/// A model.\n///\n/// # Errors\n/// When wrong.\n///\n/// Error: 1e-15.",
    ] {
        assert!(boundless(&function(good)).is_empty(), "{good}");
    }
    for bad in [
        "",
        "/// A model with 12 terms.",
        "/// A model.\n///\n/// # Errors\n/// When x is above 1.",
        "/// A model.\n///\n/// Error: rounding.",
        "/// A model.\n///\n/// Error: small, see [`g_f32`].",
        "/// A model.\n///\n/// Error:\n///\n/// 1e-12.",
        "/// Returns the Error: 5 of them.",
    ] {
        assert_eq!(boundless(&function(bad)), ["f"], "{bad}");
    }
    // A bound is that of the function below it, not of the next one.
    let two = format!("{}{}", function("/// A. Error: 1e-12."), function("/// B."));
    assert_eq!(boundless(&two), ["f"]);
    let apart = "/// A. Error: 1e-12.\nstruct S;\npub fn f() {}\npub const fn g() {}\n    pub fn h() {}\n#[cfg(test)]\npub fn i() {}";
    assert_eq!(boundless(apart), ["f", "g"]);
}
