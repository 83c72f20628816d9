//! What stands in the sources: Bevy's render internals only in the adapter, no oversized files, no marks of
//! unfinished work.

use crate::repository::{files_ending, text};

/// Paths that only the render adapter may name: they move with every version of Bevy.
const INTERNALS: [&str; 6] = [
    "bevy::render",
    "bevy::pbr",
    "bevy::core_pipeline",
    "bevy_render",
    "bevy_pbr",
    "bevy_core_pipeline",
];

/// The one folder that names them.
const ADAPTER: &str = "rain_plugins/src/render_adapter/";

/// Folders of what ships.
const SHIPPED: [&str; 5] = ["rain_core/", "rain_ecs/", "rain_render/", "rain_plugins/", "rain_cli/"];

/// Longest source file, in lines: one concept fits.
const LONGEST: usize = 700;

/// Text that has no place in a finished file. Written in two halves so that this file passes its own check.
const MARKS: [&str; 9] = [
    concat!("TO", "DO"),
    concat!("FIX", "ME"),
    concat!("XX", "X"),
    concat!("to", "do!("),
    concat!("unimpl", "emented!("),
    concat!("db", "g!("),
    concat!("assert!(tr", "ue)"),
    concat!("#[ign", "ore"),
    concat!("/work/", "main"),
];

/// Whether `part` stands in `line` with no letter, digit or underscore on either side of it.
fn has_word(line: &str, part: &str) -> bool {
    let is_word = |letter: Option<char>| letter.is_some_and(|letter| letter.is_alphanumeric() || letter == '_');
    line.match_indices(part).any(|(start, _)| {
        let starts_word = part.starts_with(|letter: char| letter.is_alphanumeric());
        let ends_word = part.ends_with(|letter: char| letter.is_alphanumeric());
        !(starts_word && is_word(line[..start].chars().next_back())
            || ends_word && is_word(line[start + part.len()..].chars().next()))
    })
}

/// A source without its line comments (those in strings included: none of what we look for needs a `//`).
fn without_comments(source: &str) -> String {
    source
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default())
        .collect::<Vec<_>>()
        .join("\n")
}

/// The full paths of a use tree: `a::{b, c::{d, e}}` gives `a::b`, `a::c::d`, `a::c::e`.
fn flatten(tree: &str, prefix: &str, out: &mut Vec<String>) {
    let tree = tree.trim();
    let Some(open) = tree.find('{') else {
        let path = tree.split(" as ").next().unwrap_or_default().trim();
        if !path.is_empty() {
            out.push(format!("{prefix}{path}"));
        }
        return;
    };
    let prefix = format!("{prefix}{}", tree[..open].trim());
    let (mut depth, mut start) = (0_usize, open + 1);
    for (index, letter) in tree.char_indices().skip_while(|(index, _)| *index <= open) {
        match letter {
            '{' => depth += 1,
            '}' if depth == 0 => {
                flatten(&tree[start..index], &prefix, out);
                return;
            }
            '}' => depth -= 1,
            ',' if depth == 0 => {
                flatten(&tree[start..index], &prefix, out);
                start = index + 1;
            }
            _ => {}
        }
    }
}

/// The paths that a source names: those of its `use` items, flattened, and every `a::b` in its code.
fn paths(source: &str) -> Vec<String> {
    let code = without_comments(source);
    let mut paths = Vec::new();
    for statement in code.split(';') {
        let lines = statement.trim_start();
        // A `use` may follow attributes, a visibility or the end of another item.
        if let Some(at) = lines.rfind("use ").filter(|at| !has_identifier_before(&lines[..*at])) {
            flatten(&lines[at + "use ".len()..], "", &mut paths);
        }
    }
    let word = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == ':';
    paths.extend(
        code.split(|letter| !word(letter))
            .map(|path| path.trim_end_matches("::"))
            .filter(|path| path.contains("::"))
            .map(str::to_owned),
    );
    paths
}

/// Whether a text ends in the middle of a word.
fn has_identifier_before(text: &str) -> bool {
    text.chars()
        .next_back()
        .is_some_and(|letter| letter.is_alphanumeric() || letter == '_')
}

/// The render internals that a source names.
fn internals(source: &str) -> Vec<String> {
    let names = |path: &str, internal: &str| {
        path.trim_start_matches("::")
            .strip_prefix(internal)
            .is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
    };
    let mut found = paths(source);
    found.retain(|path| INTERNALS.iter().any(|internal| names(path, internal)));
    found.sort();
    found.dedup();
    found
}

/// The scenario runner is an application on top of Bevy: it builds cameras and reads pictures back like any game.
const RUNNER: &str = "rain_plugins/src/scenario/";

#[test]
fn only_the_adapter_names_render_internals() {
    let sources: Vec<&str> = files_ending(&[".rs"])
        .into_iter()
        .filter(|name| SHIPPED.iter().any(|folder| name.starts_with(folder)))
        .collect();
    assert!(sources.len() >= 30, "only {} files of what ships", sources.len());
    let mut outside = Vec::new();
    let mut inside = 0_usize;
    for name in sources {
        let found = internals(&text(name));
        if name.starts_with(RUNNER) {
            continue;
        }
        if name.starts_with(ADAPTER) {
            inside += found.len();
        } else {
            outside.extend(found.into_iter().map(|path| format!("{name}: {path}")));
        }
    }
    assert!(inside > 0, "nothing in {ADAPTER} names them: is the scan blind?");
    assert!(
        outside.is_empty(),
        "{} uses outside {ADAPTER}\n{}",
        outside.len(),
        outside.join("\n")
    );
}

#[test]
fn internals_are_found_in_every_spelling() {
    let cases: [(&str, &[&str]); 9] = [
        ("use bevy::render::RenderApp;", &["bevy::render::RenderApp"]),
        ("pub use bevy_render::view;", &["bevy_render::view"]),
        (
            "#[cfg(x)]\npub(crate) use bevy::{\n    prelude::*,\n    pbr::{Material as M, wireframe},\n};",
            &["bevy::pbr::Material", "bevy::pbr::wireframe"],
        ),
        (
            "use bevy::{prelude::*, camera::{Camera, visibility::{self, Layer}}, core_pipeline};",
            &["bevy::core_pipeline"],
        ),
        (
            "fn f() { g(bevy::render::view::Msaa::Off); }",
            &["bevy::render::view::Msaa::Off"],
        ),
        ("mod a {\n    use ::bevy::pbr::X;\n}", &["::bevy::pbr::X"]),
        (
            "// use bevy::render::X;\n/// See [`bevy_render::X`].\nuse bevy::prelude::*;",
            &[],
        ),
        ("use bevy::camera::Camera;\nuse bevy::light::PointLight;", &[]),
        ("use bevy::renderer_of_mine::X;\nfn use_of() {}", &[]),
    ];
    for (source, wanted) in cases {
        assert_eq!(internals(source), wanted, "{source}");
    }
}

#[test]
fn no_source_file_is_too_long() {
    let sources = files_ending(&[".rs", ".wgsl"]);
    assert!(sources.len() >= 40, "only {} sources", sources.len());
    let long: Vec<String> = sources
        .into_iter()
        .map(|name| (text(name).lines().count(), name))
        .filter(|(lines, _)| *lines > LONGEST)
        .map(|(lines, name)| format!("{name}: {lines} lines"))
        .collect();
    assert!(long.is_empty(), "{}", long.join("\n"));
}

#[test]
fn no_marks_of_unfinished_work() {
    let texts = files_ending(&[
        ".rs", ".wgsl", ".md", ".toml", ".ron", ".yml", ".yaml", ".sh", ".ci/run",
    ]);
    assert!(texts.len() >= 50, "only {} text files", texts.len());
    let mut found = Vec::new();
    for name in texts {
        for (index, line) in text(name).lines().enumerate() {
            for mark in MARKS.iter().filter(|mark| has_word(line, mark)) {
                found.push(format!("{name}:{}: {mark}", index + 1));
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn marks_are_found_as_words() {
    let find = |line: &str| MARKS.iter().filter(|mark| has_word(line, mark)).count();
    assert_eq!(find(concat!("// TO", "DO: later")), 1);
    assert_eq!(find(concat!("    to", "do!()")), 1);
    assert_eq!(find(concat!("#[ign", "ore = \"slow\"]")), 1);
    assert_eq!(find(concat!("let X", "XXL = 1;")), 0);
    assert_eq!(find("method_to_do(1)"), 0);
}
