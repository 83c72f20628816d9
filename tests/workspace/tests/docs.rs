//! The feature table says what exists, where, and which test or scenario shows it; links lead somewhere.

use std::collections::{BTreeMap, BTreeSet};

use crate::repository::{files_ending, root, text};

/// The table of features.
const TABLE: &str = "docs/features.md";

/// How many numbered features each source has.
const FEATURES: [(char, usize); 5] = [('A', 62), ('B', 47), ('C', 217), ('D', 58), ('E', 101)];

/// What a row's state may be.
const STATES: [&str; 3] = ["works", "not yet", "observation or evaluation only"];

/// One row of the table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Row {
    feature: String,
    what: String,
    state: String,
    places: Vec<String>,
    proofs: Vec<String>,
}

/// What is in backquotes in a cell.
pub fn quoted(cell: &str) -> Vec<String> {
    cell.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// Whether a cell names a feature: one of the source letters and a number.
fn is_feature(cell: &str) -> bool {
    let mut letters = cell.chars();
    let known = letters
        .next()
        .is_some_and(|letter| FEATURES.iter().any(|(source, _)| *source == letter));
    let number = letters.as_str();
    known && !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())
}

/// The rows of all tables in a text whose first cell names a feature.
fn rows(text: &str) -> Vec<Row> {
    let mut rows = Vec::new();
    for line in text.lines() {
        let Some(inner) = line.trim().strip_prefix('|').and_then(|line| line.strip_suffix('|')) else {
            continue;
        };
        let cells: Vec<&str> = inner.split('|').map(str::trim).collect();
        if !is_feature(cells[0]) {
            continue;
        }
        let cell = |index: usize| cells.get(index).copied().unwrap_or_default();
        rows.push(Row {
            feature: cell(0).to_owned(),
            what: cell(1).to_owned(),
            state: cell(2).to_owned(),
            places: quoted(cell(3)),
            proofs: quoted(cell(4)),
        });
        assert_eq!(cells.len(), 5, "five cells: {line}");
    }
    rows
}

/// Names of the functions under `#[test]` in all Rust files.
pub fn tests() -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for file in files_ending(&[".rs"]) {
        names.extend(tests_in(&text(file)));
    }
    names
}

/// Names of the functions under `#[test]` in a Rust source.
fn tests_in(source: &str) -> Vec<String> {
    let mut names = Vec::new();
    let mut marked = false;
    for line in source.lines().map(str::trim) {
        if line == "#[test]" {
            marked = true;
        } else if marked && let Some((_, rest)) = line.split_once("fn ") {
            names.push(
                rest.chars()
                    .take_while(|letter| letter.is_alphanumeric() || *letter == '_')
                    .collect(),
            );
            marked = false;
        }
    }
    names
}

/// What is wrong with a row: `exists` says whether a path is there, `tests` are the test functions.
fn faults(row: &Row, exists: impl Fn(&str) -> bool, tests: &BTreeSet<String>) -> Vec<String> {
    let mut faults = Vec::new();
    if row.what.chars().count() < 10 {
        faults.push("no description".to_owned());
    }
    if !STATES.contains(&row.state.as_str()) {
        faults.push(format!("state `{}`", row.state));
    }
    faults.extend(
        row.places
            .iter()
            .filter(|place| !exists(place))
            .map(|place| format!("no file `{place}`")),
    );
    for proof in &row.proofs {
        let there = if proof.contains('/') {
            exists(proof)
        } else {
            tests.contains(proof.rsplit("::").next().unwrap_or(proof))
        };
        if !there {
            faults.push(format!("no test or scenario `{proof}`"));
        }
    }
    if row.state == "works" && row.places.is_empty() {
        faults.push("works, but says not where".to_owned());
    }
    if row.state == "works" && row.proofs.is_empty() {
        faults.push("works, but nothing shows it".to_owned());
    }
    faults.iter().map(|fault| format!("{}: {fault}", row.feature)).collect()
}

/// The targets of Markdown links in a text, code blocks left out.
fn links(text: &str) -> Vec<&str> {
    let mut links = Vec::new();
    let mut code = false;
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            code = !code;
        }
        if code {
            continue;
        }
        for (index, _) in line.match_indices("](") {
            if let Some((target, _)) = line[index + 2..].split_once(')') {
                links.push(target.split_whitespace().next().unwrap_or_default());
            }
        }
    }
    links
}

/// Links of a document, relative to the repository, that lead to nothing.
fn broken_links(document: &str, text: &str) -> Vec<String> {
    let folder = root()
        .join(document)
        .parent()
        .expect("a document is in a folder")
        .to_path_buf();
    let outside = |link: &&str| link.contains("://") || link.starts_with("mailto:") || link.starts_with('#');
    links(text)
        .into_iter()
        .filter(|link| !outside(link))
        .filter(|link| {
            let path = link.split('#').next().unwrap_or_default();
            path.is_empty() || !folder.join(path).exists()
        })
        .map(|link| format!("{document}: {link}"))
        .collect()
}

#[test]
fn every_feature_has_one_row_in_order() {
    let found: Vec<String> = rows(&text(TABLE)).into_iter().map(|row| row.feature).collect();
    let wanted: Vec<String> = FEATURES
        .iter()
        .flat_map(|(letter, count)| (1..=*count).map(move |number| format!("{letter}{number}")))
        .collect();
    let missing: Vec<&String> = wanted.iter().filter(|feature| !found.contains(feature)).collect();
    assert!(missing.is_empty(), "no row for {missing:?}");
    assert_eq!(found, wanted, "rows in the order of the sources, none twice");
}

#[test]
fn every_row_holds() {
    let tests = tests();
    assert!(tests.len() > 60, "only {} tests found", tests.len());
    let rows = rows(&text(TABLE));
    assert!(rows.iter().any(|row| row.state == "works"), "no row works");
    let faults: Vec<String> = rows
        .iter()
        .flat_map(|row| faults(row, |path| root().join(path).exists(), &tests))
        .collect();
    assert!(faults.is_empty(), "{} faults\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn the_counts_in_the_table_are_those_of_its_rows() {
    let text = text(TABLE);
    let mut counted: BTreeMap<String, usize> = BTreeMap::new();
    for row in rows(&text) {
        *counted.entry(row.state).or_default() += 1;
    }
    for state in STATES {
        let line = format!("- {state}: {}", counted.get(state).copied().unwrap_or(0));
        assert!(text.lines().any(|found| found == line), "{TABLE} should say `{line}`");
    }
}

#[test]
fn faulty_rows_are_found() {
    let tests = BTreeSet::from(["drops_fall".to_owned()]);
    let exists = |path: &str| path == "rain_core/src/lib.rs" || path == "examples/scenarios/storm.ron";
    let check = |line: &str| {
        let rows = rows(line);
        assert_eq!(rows.len(), 1, "{line}");
        faults(&rows[0], exists, &tests)
    };
    assert!(check("| A1 | Drops fall down | works | `rain_core/src/lib.rs` | `rainfall::drops_fall` |").is_empty());
    assert!(
        check("| A1 | Drops fall down | works | `rain_core/src/lib.rs` | `examples/scenarios/storm.ron` |").is_empty()
    );
    assert!(check("| A1 | Drops fall down | not yet | – | – |").is_empty());
    let bad = [
        (
            "| A1 | Drops fall down | works | `rain_core/src/lib.rs` | `no_such_test` |",
            "no test or scenario",
        ),
        (
            "| A1 | Drops fall down | works | `rain_core/src/lib.rs` | `examples/scenarios/none.ron` |",
            "no test or",
        ),
        (
            "| A1 | Drops fall down | works | `rain_core/src/none.rs` | `drops_fall` |",
            "no file",
        ),
        ("| A1 | Drops fall down | works | – | `drops_fall` |", "says not where"),
        (
            "| A1 | Drops fall down | works | `rain_core/src/lib.rs` | – |",
            "nothing shows it",
        ),
        ("| A1 | Drops fall down | soon | – | – |", "state `soon`"),
        ("| A1 | Drops | not yet | – | – |", "no description"),
    ];
    for (line, fault) in bad {
        let found = check(line);
        assert!(found.len() == 1 && found[0].contains(fault), "{line}: {found:?}");
    }
    assert!(
        rows("| Feature | What | State | Where | Shown by |\n|---|---|---|---|---|\n| F1 | x | y | z | w |").is_empty()
    );
}

#[test]
fn test_functions_are_told_from_others() {
    let source = "fn helper() {}\n#[test]\n#[should_panic]\nfn panics() {}\n    #[test]\n    fn holds(x in 0..4) {}\nfn other() {}";
    assert_eq!(tests_in(source), ["panics", "holds"]);
}

#[test]
fn links_lead_somewhere() {
    let mut documents = files_ending(&[".md"]);
    documents.retain(|name| *name == "README.md" || name.starts_with("docs/"));
    assert!(documents.contains(&"README.md"), "no README.md");
    assert!(documents.len() >= 4, "only {documents:?}");
    let broken: Vec<String> = documents
        .iter()
        .flat_map(|name| broken_links(name, &text(name)))
        .collect();
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

/// The keys of the list of references.
pub fn reference_keys() -> Vec<String> {
    text("docs/references.md")
        .lines()
        .filter_map(|line| line.strip_prefix("| ")?.split(" |").next())
        .filter(|key| *key != "Key")
        .map(str::to_owned)
        .collect()
}

#[test]
fn source_keys_are_in_the_list_of_references() {
    let keys = reference_keys();
    assert!(keys.len() >= 20, "only {keys:?}");
    assert_eq!(
        keys.iter().collect::<BTreeSet<_>>().len(),
        keys.len(),
        "a key stands twice"
    );
    let table = text(TABLE);
    let named: Vec<&str> = table
        .lines()
        .filter_map(|line| line.strip_prefix("Source: [")?.strip_suffix("](references.md)."))
        .collect();
    assert_eq!(named.len(), FEATURES.len(), "one source for each letter: {named:?}");
    for key in named {
        assert!(keys.iter().any(|known| known == key), "{key}");
    }
}

#[test]
fn broken_links_are_found() {
    let text = "[a](features.md) [b](none.md) ![c](../no.png \"title\") [d](https://x.y/z) [e](#part) [f](features.md#g)\n\
                ```\n[g](in_code.md)\n```\n";
    assert_eq!(
        broken_links("docs/x.md", text),
        ["docs/x.md: none.md", "docs/x.md: ../no.png"]
    );
}
