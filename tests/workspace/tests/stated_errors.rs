//! The errors that the table of models (`docs/physics.md`) states are those of the documentation and of the tests.
//!
//! In the last column a number in backquotes (`1e-12`, `0.3 %`) is a bound against the reference. It stands in the
//! `Error:` paragraph of one of the row's functions, or of the type that they are methods of, and one of the row's tests
//! asserts it. A row without such a number says `exact`, and then none of its functions states one.

use std::collections::{BTreeMap, BTreeSet};

use crate::docs::quoted;
use crate::physics::{Row, TABLE, identifier, rows, subject_of_impl};
use crate::repository::{files_ending, text};

/// What stands in place of a bound.
const EXACT: &str = "exact";

/// Names of what a test holds a bound in: all numbers of its body count then.
const BOUNDS: [&str; 4] = ["bound", "allowed", "tolerance", "published"];

fn is_word(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

/// The numbers in a text, as Rust writes them, with their places; those before `%` as shares of one.
fn numbers(text: &str) -> Vec<(usize, f64)> {
    let mut found = Vec::new();
    let mut before = ' ';
    let mut end = 0;
    for (at, letter) in text.char_indices() {
        if at >= end && letter.is_ascii_digit() && !is_word(before) && before != '.' {
            let rest = &text[at..];
            let run = |from: usize| {
                let stop = |l: char| !(l.is_ascii_digit() || l == '_');
                from + rest[from..].find(stop).unwrap_or(rest.len() - from)
            };
            let mut length = run(0);
            if rest[length..].starts_with('.') && rest[length + 1..].starts_with(|l: char| l.is_ascii_digit()) {
                length = run(length + 1);
            }
            let sign = usize::from(rest[length..].starts_with("e-") || rest[length..].starts_with("e+"));
            let exponent = length + 1 + sign;
            if rest[length..].starts_with('e') && rest[exponent..].starts_with(|l: char| l.is_ascii_digit()) {
                length = run(exponent);
            }
            let value: f64 = rest[..length].replace('_', "").parse().expect("digits are a number");
            let share = rest[length..].trim_start_matches([' ', '\u{a0}']).starts_with('%');
            found.push((at, if share { value / 100.0 } else { value }));
            end = at + length;
        }
        before = letter;
    }
    found
}

fn values(text: &str) -> Vec<f64> {
    numbers(text).into_iter().map(|(_, value)| value).collect()
}

fn holds(values: &[f64], value: f64) -> bool {
    values.iter().any(|other| (other - value).abs() <= 1e-9 * value.abs())
}

/// What a documentation says of errors: from each `Error:` to the end of its paragraph.
fn error_text(doc: &[&str]) -> String {
    doc.split(|line| line.is_empty())
        .map(|paragraph| paragraph.join(" "))
        .filter_map(|paragraph| {
            let at = ["Error: ", "Error against "]
                .iter()
                .filter_map(|word| paragraph.find(word))
                .min()?;
            Some(paragraph[at..].to_owned())
        })
        .collect::<Vec<_>>()
        .join(" ")
}

/// The `Error:` texts of functions by name, of methods by `Type::name` and by name where no function has it, and of types
/// by `Type`.
#[derive(Default)]
struct Documentation(BTreeMap<String, Vec<String>>);

impl Documentation {
    /// Of Rust sources, or of WGSL ones, which have plain comments.
    fn of<'a>(sources: impl Iterator<Item = (bool, &'a str)>) -> Self {
        let (mut texts, mut methods) = (BTreeMap::<String, Vec<String>>::new(), Vec::new());
        for (wgsl, source) in sources {
            let mut doc: Vec<&str> = Vec::new();
            let mut of: Option<&str> = None;
            for line in source.lines() {
                if let Some(rest) = line.strip_prefix("impl") {
                    of = Some(subject_of_impl(rest));
                } else if line.starts_with('}') {
                    of = None;
                }
                let words = line.trim();
                let comment = words.strip_prefix(if wgsl { "//" } else { "///" });
                if let Some(comment) = comment {
                    doc.push(comment.trim());
                    continue;
                }
                if words.starts_with("#[") || (wgsl && words.starts_with('@')) {
                    continue;
                }
                let text = error_text(&std::mem::take(&mut doc));
                let after = |word: &str| {
                    let (before, rest) = words.split_once(word)?;
                    let plain = before.split_whitespace().all(|w| w.starts_with("pub") || w == "const");
                    plain.then(|| identifier(rest))
                };
                if let Some(name) = after("fn ") {
                    match of {
                        Some(of) => {
                            texts.entry(format!("{of}::{name}")).or_default().push(text.clone());
                            methods.push((name, text));
                        }
                        None => texts.entry(name.to_owned()).or_default().push(text),
                    }
                } else if let Some(name) = after("struct ").or_else(|| after("enum ")) {
                    texts.entry(name.to_owned()).or_default().push(text);
                }
            }
        }
        let free: BTreeSet<String> = texts.keys().cloned().collect();
        for (name, text) in methods {
            if !free.contains(name) {
                texts.entry(name.to_owned()).or_default().push(text);
            }
        }
        Self(texts)
    }

    /// All bounds in sight of a row's function: its own, its single-precision twin's, its type's.
    fn stated(&self, function: &str) -> Vec<f64> {
        let twin = format!("{function}_f32");
        let of = function.split_once("::").map(|(of, _)| of);
        [Some(function), Some(twin.as_str()), of]
            .into_iter()
            .flatten()
            .filter_map(|name| self.0.get(name))
            .flatten()
            .flat_map(|text| values(text))
            .collect()
    }

    /// Whether the first clause of its own `Error:` has a number; where several functions have the name, whether that of
    /// each has.
    fn is_bounded(&self, function: &str) -> bool {
        let first = |text: &String| text.split("; ").next().and_then(|t| t.split(". ").next()).map(values);
        self.0.get(function).is_some_and(|texts| {
            let mut clauses = texts.iter().map(first);
            !texts.is_empty() && clauses.all(|values| values.is_some_and(|values| !values.is_empty()))
        })
    }
}

/// A source without comments and without what stands in strings.
fn code(source: &str) -> String {
    let mut kept = String::with_capacity(source.len());
    for line in source.lines() {
        let mut letters = line.chars().peekable();
        let mut string = false;
        while let Some(letter) = letters.next() {
            match letter {
                '\\' if string => drop(letters.next()),
                // Not the quote that is itself a character.
                '"' if !kept.ends_with('\'') => {
                    string = !string;
                    kept.push('"');
                }
                '/' if !string && letters.peek() == Some(&'/') => break,
                _ if !string => kept.push(letter),
                _ => {}
            }
        }
        kept.push('\n');
    }
    kept
}

/// The functions of a Rust source: name, body, whether it is a test.
fn bodies(code: &str) -> Vec<(String, String, bool)> {
    let lines: Vec<&str> = code.lines().collect();
    let mut found = Vec::new();
    let mut test = false;
    for (index, line) in lines.iter().enumerate() {
        let words = line.trim_start();
        if words == "#[test]" {
            test = true;
        } else if let Some((before, rest)) = words.split_once("fn ")
            && before.split_whitespace().all(|w| w.starts_with("pub") || w == "const")
        {
            let end = format!("{}}}", " ".repeat(line.len() - words.len()));
            let body: Vec<&str> = lines[index..]
                .iter()
                .copied()
                .take_while(|line| !line.starts_with(&end))
                .collect();
            found.push((identifier(rest).to_owned(), body.join("\n"), test));
            test = false;
        }
    }
    found
}

/// What stands in the parentheses of every call of something with `assert` in its name; of `assert_below` only the bound.
fn assertions(body: &str) -> Vec<&str> {
    let mut found = Vec::new();
    for (at, word) in body.match_indices("assert") {
        let rest = &body[at + word.len()..];
        let name = rest.find(|letter| !is_word(letter)).unwrap_or(rest.len());
        let Some(open) = rest[name..].trim_start_matches('!').strip_prefix('(') else {
            continue;
        };
        let only_first = rest[..name].starts_with("_below");
        let (mut depth, mut end) = (1_u32, open.len());
        for (index, letter) in open.char_indices() {
            match letter {
                '(' | '[' | '{' => depth += 1,
                ')' | ']' | '}' => depth -= 1,
                ',' if only_first && depth == 1 => {
                    end = index;
                    break;
                }
                _ => {}
            }
            if depth == 0 {
                end = index;
                break;
            }
        }
        found.push(&open[..end]);
    }
    found
}

/// The words of a code.
fn words(code: &str) -> impl Iterator<Item = &str> {
    code.split(|letter| !is_word(letter)).filter(|word| !word.is_empty())
}

/// What each test of a Rust source asserts: numbers that something is below or equal to, also in constants and in the
/// functions of the same source that it calls.
fn asserted(source: &str) -> Vec<(String, Vec<f64>)> {
    let code = code(source);
    let bodies = bodies(&code);
    let constants: BTreeMap<&str, &str> = code
        .split("const ")
        .skip(1)
        .filter_map(|rest| {
            let (value, _) = rest.split_once(';')?;
            value.split_once(" = ").map(|(_, value)| (identifier(rest), value))
        })
        .collect();
    let mut all = Vec::new();
    for (name, body, _) in bodies.iter().filter(|(_, _, test)| *test) {
        let mut found = Vec::new();
        let (mut open, mut seen) = (vec![body.as_str()], BTreeSet::new());
        while let Some(body) = open.pop() {
            for group in assertions(body) {
                // What something must be above is a negative control.
                let above = |at: usize| group[..at].trim_end().ends_with(['>']) || group[..at].ends_with(">= ");
                found.extend(
                    numbers(group)
                        .into_iter()
                        .filter(|(at, _)| !above(*at))
                        .map(|(_, value)| value),
                );
                for word in words(group) {
                    if let Some(value) = constants.get(word) {
                        found.extend(values(value));
                    }
                    if BOUNDS.contains(&word) {
                        found.extend(values(body));
                    }
                }
            }
            for word in words(body) {
                for (name, called, test) in &bodies {
                    if name == word && !test && seen.insert(name) {
                        open.push(called);
                    }
                }
            }
        }
        all.push((name.clone(), found));
    }
    all
}

/// What is wrong with the last cell of a row.
fn faults(row: &Row, documentation: &Documentation, tests: &BTreeMap<String, Vec<f64>>) -> Vec<String> {
    let mut faults = Vec::new();
    let stated: Vec<f64> = row.functions.iter().flat_map(|f| documentation.stated(f)).collect();
    let asserted: Vec<f64> = row
        .tests
        .iter()
        .filter_map(|t| tests.get(t))
        .flatten()
        .copied()
        .collect();
    let spans = quoted(&row.error);
    let mut bounded = false;
    for span in spans.iter().filter(|span| *span != EXACT) {
        let bare = span.trim_end_matches('%').trim_end();
        match (bare.parse::<f64>(), values(span).first()) {
            (Ok(_), Some(&value)) => {
                bounded = true;
                if !holds(&stated, value) {
                    faults.push(format!("no function's `Error:` says {span}"));
                }
                if !holds(&asserted, value) {
                    faults.push(format!("no test asserts {span}"));
                }
            }
            _ => faults.push(format!("`{span}` is neither a number nor `{EXACT}`")),
        }
    }
    if spans.is_empty() {
        faults.push(format!("neither a bound in backquotes nor `{EXACT}`"));
    } else if !bounded {
        let of = row.functions.iter().filter(|f| documentation.is_bounded(f));
        faults.extend(of.map(|f| format!("`{EXACT}`, but the documentation of `{f}` states a number")));
    }
    faults
        .iter()
        .map(|fault| format!("{}: {fault}", row.quantity))
        .collect()
}

#[test]
fn every_error_in_the_table_is_documented_and_asserted() {
    let sources: Vec<(bool, String)> = files_ending(&[".rs", ".wgsl"])
        .into_iter()
        .map(|file| (file.ends_with(".wgsl"), text(file)))
        .collect();
    let documentation = Documentation::of(sources.iter().map(|(wgsl, source)| (*wgsl, source.as_str())));
    let mut tests: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for (_, source) in sources.iter().filter(|(wgsl, _)| !wgsl) {
        for (name, found) in asserted(source) {
            tests.entry(name).or_default().extend(found);
        }
    }
    let rows = rows(&text(TABLE));
    let faults: Vec<String> = rows
        .iter()
        .flat_map(|row| faults(row, &documentation, &tests))
        .collect();
    assert!(faults.is_empty(), "{} faults\n{}", faults.len(), faults.join("\n"));
    let bounds = rows
        .iter()
        .flat_map(|row| quoted(&row.error))
        .filter(|span| span != EXACT);
    assert!(bounds.count() > 200, "few rows state a bound: is the scan blind?");
}

#[test]
fn stale_errors_are_found() {
    let source = "/// A speed. Error: 1e-12 relative (f32 `x_9` 2e-6); model error 5 %.\npub fn speed() {}\n\n/// By \
                  definition. Error: exact; choices are good to 3 %.\npub fn name() {}\n\n/// Grows.\n///\n/// Error: \
                  relative 4e-7.\n#[derive(Debug)]\npub struct Drop {}\nimpl Drop {\n    /// Falls.\n    pub fn fall() {}\n    \
                  /// Error: 7e-3.\n    pub fn speed() {}\n}\n";
    let checks = "const LIMIT: f64 = 4.0e-7;\nfn close(a: f64) {\n    assert!(a < 0.05, \"{a} 1e-30\");\n}\n#[test]\nfn \
                  holds() {\n    let x = 3e-3; // 2e-3\n    worst.assert_below(1e-12, 500);\n    assert!(a <= 2e-6 && off > \
                  7e-3);\n    close(1.0);\n    assert!(x < LIMIT);\n}\n";
    let wgsl = "// On the device. Error: 1e-4 relative.\n@fragment\nfn shade() {}\n";
    let documentation = Documentation::of([(false, source), (true, wgsl)].into_iter());
    let tests: BTreeMap<String, Vec<f64>> = asserted(checks).into_iter().collect();
    let check = |functions: &str, error: &str| {
        let row = Row {
            quantity: "a".into(),
            functions: quoted(functions),
            tests: vec!["holds".into()],
            sources: Vec::new(),
            error: error.into(),
        };
        faults(&row, &documentation, &tests)
    };
    for (functions, error) in [
        ("`speed`", "`1e-12`, f32 `2e-6`; 7 to 9 % in nature"),
        ("`speed`", "`1.0e-12` relative, `5 %` in nature"),
        ("`speed`", "`0.05`"),
        ("`Drop::fall`", "`4e-7`"),
        ("`name`", "`exact`; a choice"),
        ("`Drop::fall`", "`exact`"),
        ("`name`, `speed`", "`exact` but for the speed, `1e-12`"),
    ] {
        let found = check(functions, error);
        assert!(found.is_empty(), "{functions} {error}: {found:?}");
    }
    for (functions, error, fault) in [
        ("`speed`", "1e-12", "neither a bound"),
        ("`speed`", "`1e-11`", "`Error:` says 1e-11"),
        ("`name`", "`1e-12`", "`Error:` says 1e-12"),
        ("`speed`", "`4e-7`", "`Error:` says 4e-7"),
        ("`shade`", "`1e-4`", "asserts 1e-4"),
        ("`Drop::speed`", "`7e-3`", "asserts 7e-3"),
        ("`name`", "`3 %`", "asserts 3 %"),
        ("`speed`", "`exact`", "states a number"),
        ("`shade`", "`exact`", "states a number"),
        ("`speed`", "`small`", "neither a number"),
    ] {
        let found = check(functions, error).join(" ");
        assert!(found.contains(fault), "{functions} {error}: {found}");
    }
    // Of a test's own text only what is asserted, and not what must be exceeded.
    let asserted = &tests["holds"];
    for (value, there) in [(1e-12, true), (4e-7, true), (0.05, true)]
        .into_iter()
        .chain([3e-3, 2e-3, 7e-3, 1e-30, 500.0].map(|value| (value, false)))
    {
        assert_eq!(holds(asserted, value), there, "{value} in {asserted:?}");
    }
}

#[test]
fn numbers_are_read_as_rust_writes_them() {
    assert_eq!(
        values("1e-12, 0.3 %, 5_000, (2.5E) v1 x_2 1.0e-7_f64 7..9 40 % f32 2e-6; 10–20 %"),
        [1e-12, 0.003, 5000.0, 2.5, 1e-7, 7.0, 0.4, 2e-6, 10.0, 0.2]
    );
    assert_eq!(code("a \"b // \\\" c\" d // e\n'\"' f\n"), "a \"\" d \n'\"' f\n");
}
