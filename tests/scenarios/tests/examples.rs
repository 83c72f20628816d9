//! Scenarios that come with the repository, played small.

use std::path::Path;

use bevy::math::DVec3;
use rain_plugins::scenario::run::{RunOptions, run};
use rain_plugins::scenario::{Scenario, Session};
use tempfile::TempDir;
use test_support::shots::View;
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

#[test]
fn a_rainbow_stands_over_the_plain_opposite_a_low_sun() {
    if !gpu::available() {
        return;
    }
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenarios/rainbow.ron");
    let folder = assets::street_folder().0;
    let picture = |rainbow: f64| {
        let mut scenario = Scenario::load(&file).expect("it is valid");
        scenario.rain.rainbow = rainbow;
        scenario.outputs.size = [320, 180];
        scenario.environment.bloom = false;
        let mut session = Session::new(&scenario, folder).expect("it starts");
        session.capture(2.0).expect("a capture").frame
    };
    let (with, without) = (picture(1.0), picture(0.0));
    // Opposite the sun, as the scenario has both.
    let opposite = DVec3::new(0.12, -0.25, 1.0).normalize();
    let view = View::new([-1.6, 1.65, -6.0], [3.2, 12.2, 40.0]).fov(56.0);
    let forward = (view.target - view.eye).normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let up = right.cross(forward);
    let half = (0.5 * view.fov_y_deg.to_radians()).tan();
    // What the bow adds to red and blue, by the angle, where the sky is.
    let mut rings = [[0.0_f64; 3]; 60];
    for y in 0..90 {
        for x in 0..320 {
            let ndc = [(f64::from(x) + 0.5) / 160.0 - 1.0, 1.0 - (f64::from(y) + 0.5) / 90.0];
            let ray = (forward + right * (ndc[0] * half * 16.0 / 9.0) + up * (ndc[1] * half)).normalize();
            let degrees = ray.angle_between(opposite).to_degrees();
            let (on, off) = (with.get_pixel(x, y).0, without.get_pixel(x, y).0);
            if let Some(ring) = rings.get_mut(degrees as usize).filter(|_| ray.y > 0.1) {
                ring[0] += f64::from(on[0]) - f64::from(off[0]);
                ring[1] += f64::from(on[2]) - f64::from(off[2]);
                ring[2] += 1.0;
            }
        }
    }
    let mean = |degrees: usize, channel: usize| rings[degrees][channel] / rings[degrees][2];
    let greatest = |channel: usize| (30..50).max_by(|a, b| mean(*a, channel).total_cmp(&mean(*b, channel)));
    assert_eq!(greatest(0), Some(41), "red: {rings:?}");
    assert!(
        greatest(1).is_some_and(|ring| (39..=40).contains(&ring)),
        "blue: {rings:?}"
    );
    assert!(mean(41, 0) > 12.0, "it is seen: {}", mean(41, 0));
    assert!(
        mean(46, 0) < 0.2 * mean(41, 0) && mean(36, 0) > mean(46, 0),
        "dark outside: {rings:?}"
    );
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
