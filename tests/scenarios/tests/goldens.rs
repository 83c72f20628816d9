//! What frames look like, held against small goldens.

use std::path::Path;

use image::RgbImage;
use rain_plugins::scenario::file::{Outputs, ScenePart};
use rain_plugins::scenario::{Scenario, Session};
use test_support::golden::{check, likeness};
use test_support::shots::{Plan, View, steady};
use test_support::{assets, gpu};

/// Least likeness: other drivers round otherwise; other weather is far below (see the negative control).
const BOUND: f64 = 0.94;

fn folder() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/goldens"))
}

/// The street from one of its places, 128 × 72.
fn street(view: &str, intensity_mm_h: f64, seconds: f64) -> RgbImage {
    let (files, layout) = assets::street_folder();
    let view = layout.view(view).expect("a place on the street");
    let view = View::new(view.eye.map(f64::from), view.target.map(f64::from)).fov(50.0);
    let plan = Plan::new(steady(intensity_mm_h, [1.5, 0.0, 0.5]), seconds, &[view]);
    let scenario = Scenario {
        scene: vec![ScenePart::from_file(street::STREET_FILE)],
        outputs: Outputs {
            size: [128, 72],
            masks: Vec::new(),
            ..plan.scenario.outputs.clone()
        },
        // As users see it.
        environment: Scenario::default().environment,
        ..plan.scenario
    };
    let mut session = Session::new(&scenario, files).expect("the scenario starts");
    session.capture(seconds).expect("a capture").frame
}

#[test]
fn the_wet_street_looks_like_its_golden_and_the_dry_one_does_not() {
    if !gpu::available() {
        return;
    }
    let wet = street("street", 25.0, 300.0);
    check(folder(), "street_rain", &wet, BOUND);
    let dry = street("street", 0.0, 300.0);
    check(folder(), "street_dry", &dry, BOUND);
    let score = likeness(&wet, &dry);
    assert!(score < BOUND - 0.03, "rain and no rain are alike by {score}");
}

#[test]
fn the_view_out_of_the_arcade_looks_like_its_golden() {
    if !gpu::available() {
        return;
    }
    check(folder(), "arcade_rain", &street("arcade", 50.0, 300.0), BOUND);
}
