//! Scenarios that come with the repository, played small.

use std::path::Path;

use rain_plugins::scenario::Scenario;
use rain_plugins::scenario::run::{RunOptions, run};
use rain_plugins::scenario::session::Session;
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

fn sized(scenario: &Scenario, size: [u32; 2]) -> Scenario {
    let mut scenario = scenario.clone();
    scenario.outputs.size = size;
    scenario
}

#[test]
fn a_thunderstorm_lights_the_street_for_a_moment() {
    if !gpu::available() {
        return;
    }
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenarios/thunderstorm.ron");
    let scenario = Scenario::load(&file).expect("it is valid");
    let mut session = Session::new(&sized(&scenario, [160, 90]), assets::street_folder().0).expect("it starts");
    let light: Vec<f64> = scenario
        .captures
        .times_s()
        .iter()
        .map(|time_s| {
            let capture = session.capture(*time_s).expect("a picture");
            let sum: f64 = capture.frame.pixels().flat_map(|p| p.0).map(f64::from).sum();
            sum / f64::from(3 * 160 * 90)
        })
        .collect();
    // Before the flash, in its first stroke, between strokes, in the second.
    assert!(light[1] > light[0] + 15.0, "{light:?}");
    assert!(light[2] < light[1] - 10.0 && light[3] > light[2] + 5.0, "{light:?}");
    assert!((light[2] - light[0]).abs() < 6.0, "dark between the strokes: {light:?}");
}
