//! The table of models (`docs/physics.md`) names functions, tests and sources that exist, and every public model of
//! `rain_core` stands in it.

use std::collections::{BTreeMap, BTreeSet};

use crate::docs::{quoted, reference_keys, tests};
use crate::repository::{files_ending, text};

/// The table.
pub const TABLE: &str = "docs/physics.md";

/// Head of its parts.
const HEAD: &str = "| Quantity | Equation (units, domain) | Function | Test | Source | Known error |";

/// Folders of `rain_core` whose public functions are models.
pub const MODELS: [&str; 13] = [
    "canopy",
    "cover",
    "haze",
    "lens",
    "lightning",
    "optics",
    "rainfall",
    "sound",
    "splash",
    "spout",
    "surface",
    "waves",
    "wheels",
];

/// One model.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Row {
    pub quantity: String,
    pub functions: Vec<String>,
    pub tests: Vec<String>,
    pub sources: Vec<String>,
    pub error: String,
}

/// What a source's key looks like: letters, then a year.
fn is_key(word: &str) -> bool {
    let letters = word.trim_end_matches(|letter: char| letter.is_ascii_digit());
    letters.len() >= 3 && word.len() == letters.len() + 4 && letters.chars().all(char::is_alphabetic)
}

/// Every row under a table head.
///
/// # Panics
/// At a row that has not six cells.
pub fn rows(text: &str) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut inside = false;
    for line in text.lines() {
        if line == HEAD {
            inside = true;
            continue;
        }
        inside &= line.starts_with('|');
        if !inside || line.starts_with("|---") {
            continue;
        }
        // `\|` is a bar inside a cell.
        let line = line.replace("\\|", "¦");
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        assert_eq!(cells.len(), 6, "six cells: {line}");
        rows.push(Row {
            quantity: cells[0].to_owned(),
            functions: quoted(cells[2]),
            tests: quoted(cells[3]),
            sources: cells[4]
                .split(|letter: char| !letter.is_alphanumeric())
                .filter(|word| is_key(word))
                .map(str::to_owned)
                .collect(),
            error: cells[5].to_owned(),
        });
    }
    rows
}

/// The identifier that starts `text`.
pub fn identifier(text: &str) -> &str {
    let end = text.find(|letter: char| !(letter.is_alphanumeric() || letter == '_'));
    &text[..end.unwrap_or(text.len())]
}

/// The type that a line which starts with `impl` is about; `rest` is what follows that word.
pub fn subject_of_impl(rest: &str) -> &str {
    // `impl<T> Trait for Type<T> {`: the type is what follows the last `for`.
    let subject = rest.rsplit(" for ").next().unwrap_or(rest).trim();
    let subject = match subject.strip_prefix('<') {
        Some(generics) => generics.split_once('>').map_or(generics, |(_, rest)| rest).trim(),
        None => subject,
    };
    identifier(subject)
}

/// Names of all functions and constants in a Rust or WGSL source, alone and as `Type::function` where they stand in an
/// `impl`.
fn functions(source: &str) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let mut of: Option<&str> = None;
    for line in source.lines() {
        if let Some(rest) = line.strip_prefix("impl") {
            of = Some(subject_of_impl(rest));
        } else if line.starts_with('}') {
            of = None;
        }
        let words = line.trim_start();
        if words.starts_with("//") {
            continue;
        }
        if let Some(rest) = words.strip_prefix("pub const ").filter(|rest| !rest.starts_with("fn ")) {
            names.insert(identifier(rest).to_owned());
        } else if let Some((before, rest)) = words.split_once("fn ")
            && before
                .split_whitespace()
                .all(|word| word.chars().all(|l| l.is_alphanumeric() || "()_:\"".contains(l)))
        {
            let name = identifier(rest);
            names.insert(name.to_owned());
            if let Some(of) = of {
                names.insert(format!("{of}::{name}"));
            }
        }
    }
    names
}

/// The public functions of a source that stand in no `impl`.
fn public_functions(source: &str) -> Vec<String> {
    source
        .lines()
        .take_while(|line| *line != "#[cfg(test)]")
        .filter_map(|line| {
            line.strip_prefix("pub fn ")
                .or_else(|| line.strip_prefix("pub const fn "))
        })
        .map(|rest| identifier(rest).to_owned())
        .collect()
}

/// What is wrong with a row.
fn faults(row: &Row, known: &BTreeSet<String>, tests: &BTreeSet<String>, keys: &BTreeSet<String>) -> Vec<String> {
    let mut faults = Vec::new();
    if row.functions.is_empty() {
        faults.push("no function".to_owned());
    }
    if row.tests.is_empty() {
        faults.push("no test".to_owned());
    }
    if row.error.is_empty() {
        faults.push("nothing about its error".to_owned());
    }
    let missing = |what: &str, names: &[String], there: &BTreeSet<String>| -> Vec<String> {
        names
            .iter()
            .filter(|name| !there.contains(*name))
            .map(|name| format!("no {what} `{name}`"))
            .collect()
    };
    faults.extend(missing("function", &row.functions, known));
    faults.extend(missing("test", &row.tests, tests));
    faults.extend(missing("source", &row.sources, keys));
    faults
        .iter()
        .map(|fault| format!("{}: {fault}", row.quantity))
        .collect()
}

/// Every function of the workspace's Rust and WGSL sources.
fn all_functions() -> BTreeSet<String> {
    files_ending(&[".rs", ".wgsl"])
        .into_iter()
        .flat_map(|file| functions(&text(file)))
        .collect()
}

#[test]
fn every_row_of_the_table_holds() {
    let rows = rows(&text(TABLE));
    assert!(rows.len() > 100, "only {} rows", rows.len());
    let (known, tests) = (all_functions(), tests());
    let keys: BTreeSet<String> = reference_keys().into_iter().collect();
    assert!(
        known.len() > 500 && tests.len() > 200,
        "{} functions, {} tests",
        known.len(),
        tests.len()
    );
    let faults: Vec<String> = rows.iter().flat_map(|row| faults(row, &known, &tests, &keys)).collect();
    assert!(faults.is_empty(), "{} faults\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn every_public_model_stands_in_the_table() {
    let named: BTreeSet<String> = rows(&text(TABLE))
        .into_iter()
        .flat_map(|row| row.functions)
        .map(|name| name.rsplit("::").next().unwrap_or_default().to_owned())
        .collect();
    let mut found = 0_usize;
    let mut missing: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for file in files_ending(&[".rs"]) {
        let Some(folder) = file
            .strip_prefix("rain_core/src/")
            .and_then(|path| path.split('/').next())
        else {
            continue;
        };
        if !MODELS.contains(&folder) {
            continue;
        }
        for function in public_functions(&text(file)) {
            found += 1;
            // A single-precision twin shares its double's row.
            let twin = function.trim_end_matches("_f32");
            if !named.contains(&function) && !named.contains(twin) {
                missing.entry(file).or_default().push(function);
            }
        }
    }
    assert!(found > 60, "only {found} public functions: is the scan blind?");
    assert!(missing.is_empty(), "not in {TABLE}: {missing:#?}");
}

#[test]
fn faulty_rows_are_told_from_good_ones() {
    let known = functions(
        "impl Spectrum {\n    pub fn moment(&self) {}\n}\npub fn speed() {}\nfn rain_hash(x: u32) {}\npub const F0: f64 = 0.02;",
    );
    assert!(
        known.contains("F0")
            && known.contains("Spectrum::moment")
            && known.contains("moment")
            && known.contains("rain_hash")
    );
    assert!(!known.contains("Spectrum::speed"));
    let tests = BTreeSet::from(["holds".to_owned()]);
    let keys = BTreeSet::from(["Beard1976".to_owned()]);
    let check = |line: &str| {
        let rows = rows(&format!(
            "{HEAD}\n|---|---|---|---|---|---|\n{line}\n\n| not | a | row |"
        ));
        assert_eq!(rows.len(), 1, "{line}");
        faults(&rows[0], &known, &tests, &keys)
    };
    assert!(
        check("| a | b \\| c | `Spectrum::moment`, `speed` | `holds` (1 %) | Beard1976, choice | 1 % |").is_empty()
    );
    for (line, fault) in [
        ("| a | b | `Spectrum::speed` | `holds` | choice | 1 % |", "no function"),
        ("| a | b | – | `holds` | choice | 1 % |", "no function"),
        ("| a | b | `speed` | – | choice | 1 % |", "no test"),
        ("| a | b | `speed` | `fails` | choice | 1 % |", "no test `fails`"),
        (
            "| a | b | `speed` | `holds` | Beard1977 | 1 % |",
            "no source `Beard1977`",
        ),
        ("| a | b | `speed` | `holds` | choice | |", "its error"),
    ] {
        let found = check(line);
        assert!(found.len() == 1 && found[0].contains(fault), "{line}: {found:?}");
    }
}

#[test]
fn functions_are_found_in_every_spelling() {
    let source = "impl<'a> Iterator for Rows<'a> {\n    fn next(&mut self) {}\n}\nimpl Grid {\n    #[must_use]\n    pub const fn \
                  cells(&self) {}\n    pub(crate) fn inner() {}\n}\n// fn commented()\nimpl<T> Deref for Held<T> {\n    fn deref() {}\n}\n";
    let found = functions(source);
    for name in ["Rows::next", "Grid::cells", "Grid::inner", "Held::deref", "cells"] {
        assert!(found.contains(name), "{name} in {found:?}");
    }
    assert!(!found.contains("commented"));
    assert_eq!(
        public_functions(
            "pub fn a() {}\n    pub fn b() {}\npub const fn c() {}\nfn d() {}\n#[cfg(test)]\npub fn e() {}"
        ),
        ["a", "c"]
    );
}
