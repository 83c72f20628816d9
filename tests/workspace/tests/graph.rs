//! Who may depend on whom, read from the resolved graph: normal dependencies only, features of the whole workspace
//! unified, which is what is built.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use cargo_metadata::DependencyKind;

use crate::repository::{PLATFORM, metadata};

/// Package name → names of its normal dependencies. Two versions of one package count as one.
type Graph = BTreeMap<String, BTreeSet<String>>;

/// A rule: `package` reaches no package that `forbidden` accepts.
struct Rule {
    package: &'static str,
    forbidden: fn(&str) -> bool,
    why: &'static str,
}

/// Bevy itself or one of its crates.
fn is_bevy(name: &str) -> bool {
    name == "bevy" || name.starts_with("bevy_")
}

/// wgpu and the crates under it that can talk to a device. `wgpu-types` is plain data, and `bevy_reflect` knows it as
/// soon as any member of the workspace draws.
fn is_wgpu(name: &str) -> bool {
    name == "wgpu" || (name.starts_with("wgpu-") && name != "wgpu-types")
}

/// What needs a renderer, a device or assets.
fn is_rendering(name: &str) -> bool {
    is_wgpu(name)
        || matches!(
            name,
            "bevy" | "bevy_render" | "bevy_pbr" | "bevy_core_pipeline" | "bevy_asset" | "bevy_camera" | "bevy_winit"
        )
}

/// What exists for tests and examples only.
fn is_fixture(name: &str) -> bool {
    matches!(name, "test_support" | "street" | "rain_reference")
}

/// The crates that users get.
const SHIPPED: [&str; 5] = ["rain_core", "rain_ecs", "rain_render", "rain_plugins", "rain_cli"];

/// The architecture's rules.
fn rules() -> Vec<Rule> {
    let mut rules = vec![
        Rule {
            package: "rain_core",
            forbidden: |name| is_bevy(name) || name.starts_with("wgpu"),
            why: "the models run with no engine and no GPU",
        },
        Rule {
            package: "rain_ecs",
            forbidden: is_rendering,
            why: "simulation never imports the renderer",
        },
        Rule {
            package: "rain_ecs",
            forbidden: |name| name == "rain_render",
            why: "the two halves do not know each other",
        },
        Rule {
            package: "rain_render",
            forbidden: is_bevy,
            why: "the passes run without Bevy",
        },
        Rule {
            package: "rain_render",
            forbidden: |name| name == "rain_ecs",
            why: "the two halves do not know each other",
        },
    ];
    rules.extend(SHIPPED.map(|package| Rule {
        package,
        forbidden: is_fixture,
        why: "what ships does not depend on test fixtures",
    }));
    rules
}

/// The graph of what is built, members included.
fn graph() -> Graph {
    let metadata = metadata();
    let name = |id: &cargo_metadata::PackageId| metadata[id].name.to_string();
    let resolve = metadata.resolve.as_ref().expect("cargo metadata resolves the graph");
    let mut graph = Graph::new();
    for node in &resolve.nodes {
        let normal = node
            .deps
            .iter()
            .filter(|dep| dep.dep_kinds.iter().any(|kind| kind.kind == DependencyKind::Normal));
        graph
            .entry(name(&node.id))
            .or_default()
            .extend(normal.map(|dep| name(&dep.pkg)));
    }
    graph
}

/// The shortest way from `package` to one that `wanted` accepts, or `None`.
///
/// # Panics
/// Where the graph has no such package: a rule about nothing would hold.
fn way(graph: &Graph, package: &str, wanted: impl Fn(&str) -> bool) -> Option<Vec<String>> {
    assert!(graph.contains_key(package), "no package `{package}` in the graph");
    let mut before: BTreeMap<&str, &str> = BTreeMap::new();
    let mut open = VecDeque::from([package]);
    while let Some(at) = open.pop_front() {
        if at != package && wanted(at) {
            let mut way = vec![at.to_owned()];
            let mut step = at;
            while let Some(previous) = before.get(step) {
                way.push((*previous).to_owned());
                step = previous;
            }
            way.reverse();
            return Some(way);
        }
        for next in graph.get(at).into_iter().flatten() {
            if next != package && !before.contains_key(next.as_str()) {
                before.insert(next, at);
                open.push_back(next);
            }
        }
    }
    None
}

/// One line per broken rule.
fn violations(graph: &Graph, rules: &[Rule]) -> Vec<String> {
    rules
        .iter()
        .filter_map(|rule| {
            let way = way(graph, rule.package, rule.forbidden)?;
            Some(format!("{} ({})", way.join(" → "), rule.why))
        })
        .collect()
}

/// A graph from lines `package: dependency dependency`.
fn made_up(lines: &[&str]) -> Graph {
    lines
        .iter()
        .map(|line| {
            let (package, deps) = line.split_once(':').expect("a colon");
            (package.to_owned(), deps.split_whitespace().map(str::to_owned).collect())
        })
        .collect()
}

#[test]
fn dependency_rules_hold() {
    let found = violations(&graph(), &rules());
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn the_graph_is_the_real_one() {
    let graph = graph();
    assert!(graph.len() > 150, "only {} packages", graph.len());
    for package in SHIPPED {
        assert!(graph.contains_key(package), "{package}");
    }
    // The forbidden packages are there to be reached: by the crate that may reach them.
    for wanted in ["bevy_render", "bevy_pbr", "bevy_core_pipeline", "bevy_asset", "wgpu"] {
        assert!(
            way(&graph, "rain_plugins", |name| name == wanted).is_some(),
            "rain_plugins does not reach {wanted}"
        );
    }
    assert!(way(&graph, "rain_render", |name| name == "wgpu").is_some());
    assert!(way(&graph, "rain_ecs", |name| name == "bevy_ecs").is_some());
    assert!(way(&graph, "test_support", |name| name == "street").is_some());
}

#[test]
fn each_rule_finds_its_violation() {
    let broken = [
        ("rain_core", "wgpu"),
        ("rain_core", "bevy_math"),
        ("rain_ecs", "bevy_asset"),
        ("rain_ecs", "wgpu-core"),
        ("rain_ecs", "rain_render"),
        ("rain_render", "bevy_ecs"),
        ("rain_render", "rain_ecs"),
        ("rain_cli", "street"),
        ("rain_plugins", "test_support"),
    ];
    for (package, forbidden) in broken {
        let mut graph: Graph = SHIPPED
            .iter()
            .map(|name| ((*name).to_owned(), BTreeSet::new()))
            .collect();
        assert!(
            violations(&graph, &rules()).is_empty(),
            "the empty graph breaks nothing"
        );
        // Through a package between, so that the search and not only the direct dependencies is tested.
        graph.get_mut(package).unwrap().insert("between".to_owned());
        graph.insert("between".to_owned(), BTreeSet::from([forbidden.to_owned()]));
        let found = violations(&graph, &rules());
        assert!(
            found
                .iter()
                .any(|line| line.starts_with(&format!("{package} → between → {forbidden} "))),
            "{package} → {forbidden}: {found:?}"
        );
    }
}

#[test]
fn the_way_is_the_shortest_and_survives_cycles() {
    let graph = made_up(&["a: b c", "b: a d", "c: e", "d: wgpu", "e: b"]);
    assert_eq!(way(&graph, "a", is_wgpu).unwrap(), ["a", "b", "d", "wgpu"]);
    assert_eq!(way(&graph, "a", is_bevy), None);
}

#[test]
fn one_version_of_what_must_agree() {
    for name in ["wgpu", "naga", "glam", "bevy_ecs", "bevy_render"] {
        let versions = versions_in_use(name);
        assert_eq!(versions.len(), 1, "{name}: {versions:?}");
    }
}

#[test]
fn two_versions_would_be_seen() {
    let twice = crate::repository::metadata()
        .packages
        .iter()
        .map(|package| package.name.to_string())
        .find(|name| versions_in_use(name).len() > 1);
    // Some small crate is there twice in every graph of this size; were there none, the check above would prove
    // nothing.
    assert!(
        twice.is_some(),
        "no package has two versions: is `versions_in_use` blind?"
    );
}

/// Package and version → the sets of features with which it is built, as `cargo tree` resolves them.
fn features(edges: &str) -> BTreeMap<String, BTreeSet<String>> {
    let output = std::process::Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .current_dir(crate::repository::root())
        .args(["tree", "--workspace", "--all-features", "--target", PLATFORM])
        .args(["--prefix", "none", "--edges", edges, "--format", "{p};{f}"])
        .output()
        .expect("cargo tree starts");
    assert!(
        output.status.success(),
        "cargo tree: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    features_in(&String::from_utf8_lossy(&output.stdout))
}

/// Reads lines `package version;feature,feature`, with ` (*)` after what has been listed before.
fn features_in(listing: &str) -> BTreeMap<String, BTreeSet<String>> {
    let mut features: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (package, set) in listing.lines().filter_map(|line| line.split_once(';')) {
        let set = set.trim_end_matches(" (*)");
        features.entry(package.to_owned()).or_default().insert(set.to_owned());
    }
    features
}

/// Packages that programs need in another form than tests do.
fn built_twice(
    programs: &BTreeMap<String, BTreeSet<String>>,
    tests: &BTreeMap<String, BTreeSet<String>>,
) -> Vec<String> {
    programs
        .iter()
        .filter(|(package, sets)| tests.get(*package).is_none_or(|others| !sets.is_subset(others)))
        .map(|(package, sets)| format!("{package}: {sets:?} in programs, {:?} with tests", tests.get(package)))
        .collect()
}

#[test]
fn programs_and_tests_share_one_feature_set() {
    let (programs, tests) = (features("normal,build"), features("normal,build,dev"));
    assert!(programs.len() > 150, "only {} packages", programs.len());
    let twice = built_twice(&programs, &tests);
    assert!(
        twice.is_empty(),
        "Bevy may be compiled twice; make the dev-dependency a dependency of workspace_tests\n{}",
        twice.join("\n")
    );
}

#[test]
fn another_feature_would_be_seen() {
    let programs = features_in("rand v1;std\nglam v1;libm,std\n");
    assert!(
        built_twice(
            &programs,
            &features_in("rand v1;std\nglam v1;libm,std (*)\nproptest v1;\n")
        )
        .is_empty()
    );
    assert_eq!(
        built_twice(&programs, &features_in("rand v1;std,sys_rng\nglam v1;libm,std\n")).len(),
        1
    );
    assert_eq!(built_twice(&programs, &features_in("rand v1;std\n")).len(), 1);
}

/// The versions of a package in the resolved graph.
fn versions_in_use(name: &str) -> BTreeSet<String> {
    let metadata = metadata();
    let resolve = metadata.resolve.as_ref().expect("cargo metadata resolves the graph");
    resolve
        .nodes
        .iter()
        .map(|node| &metadata[&node.id])
        .filter(|package| package.name.as_str() == name)
        .map(|package| package.version.to_string())
        .collect()
}
