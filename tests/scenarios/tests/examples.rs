//! Scenarios that come with the repository, played small.

use std::path::Path;

use rain_plugins::scenario::Scenario;
use rain_plugins::scenario::run::{RunOptions, run};
use tempfile::TempDir;
use test_support::{assets, gpu};

#[test]
fn a_minute_floods_and_dries_a_painted_court() {
    if !gpu::available() {
        return;
    }
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenarios/flooding_minute.ron");
    let scenario = Scenario::load(&file).expect("it is valid");
    let out = TempDir::new().expect("a temporary folder");
    let options = RunOptions {
        scene: None,
        assets: Some(assets::street_folder().0.to_path_buf()),
        out: out.path().join("results"),
        frames: None,
        size: Some([320, 180]),
        seed: None,
    };
    let report = run(scenario, &options, |_| {}).expect("it runs");
    assert_eq!(report.frames, 8);
    assert!(
        report.expectations.len() >= 9,
        "{} expectations",
        report.expectations.len()
    );
    for row in &report.expectations {
        assert!(row.passed, "{}: {:?}", row.text, row.value);
    }
}
