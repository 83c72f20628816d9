//! Every package that is built may be used in a program under MIT or Apache-2.0.

use spdx::{Expression, Licensee, ParseMode};

use crate::repository::{metadata, root};

/// Licences that we accept: permissive, or of fonts that may be bundled.
const ALLOWED: [&str; 15] = [
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "ISC",
    "MIT",
    "MIT-0",
    "OFL-1.1",
    "Ubuntu-font-1.0",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// Why a licence expression is not acceptable, or nothing. `A/B` is read as `A OR B`, as old manifests mean it.
fn objection(expression: Option<&str>) -> Option<String> {
    let Some(text) = expression else {
        return Some("no licence expression".to_owned());
    };
    let expression = match Expression::parse_mode(text, ParseMode::LAX) {
        Ok(expression) => expression,
        Err(error) => return Some(format!("`{text}` is no licence expression: {}", error.reason)),
    };
    let allowed = ALLOWED.map(|name| Licensee::parse(name).expect("an SPDX name"));
    let fits = expression.evaluate(|wanted| allowed.iter().any(|licensee| licensee.satisfies(wanted)));
    (!fits).then(|| format!("`{text}` is not on the list"))
}

#[test]
fn every_package_has_an_accepted_licence() {
    let metadata = metadata();
    let resolve = metadata.resolve.as_ref().expect("cargo metadata resolves the graph");
    assert!(resolve.nodes.len() > 150, "only {} packages", resolve.nodes.len());
    let found: Vec<String> = resolve
        .nodes
        .iter()
        .map(|node| &metadata[&node.id])
        .filter_map(|package| Some(format!("{}: {}", package.name, objection(package.license.as_deref())?)))
        .collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn or_and_with_are_understood() {
    for fine in [
        "MIT",
        "MIT/Apache-2.0",
        "Apache-2.0 OR GPL-2.0-only",
        "(MIT OR Apache-2.0) AND Unicode-3.0",
    ] {
        assert_eq!(objection(Some(fine)), None, "{fine}");
    }
    for bad in [
        "GPL-3.0-only",
        "MIT AND GPL-2.0-only",
        "MPL-2.0",
        "Apache-2.0 WITH Classpath-exception-2.0",
        "no such",
    ] {
        assert!(objection(Some(bad)).is_some(), "{bad}");
    }
    assert!(objection(None).is_some());
}

#[test]
fn our_own_licence_texts_are_there() {
    let metadata = metadata();
    for package in metadata.workspace_packages() {
        assert_eq!(
            package.license.as_deref(),
            Some("MIT OR Apache-2.0"),
            "{}",
            package.name
        );
    }
    for (file, line) in [("LICENSE-MIT", "MIT License"), ("LICENSE-APACHE", "Apache License")] {
        let text = std::fs::read_to_string(root().join(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
        assert_eq!(
            text.lines().find(|line| !line.trim().is_empty()).map(str::trim),
            Some(line),
            "{file}"
        );
    }
}
