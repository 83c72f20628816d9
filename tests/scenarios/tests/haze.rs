//! Haze of rain in a scenario: it takes a part of the picture that grows with distance.

use rain_plugins::prelude::PassName;
use rain_plugins::scenario::file::ScenePart;
use rain_plugins::scenario::{Scenario, Session};
use test_support::shots::{Pixel, Plan, View, steady};
use test_support::{assets, gpu};

/// The street seen from its middle in 80 mm/h with or without haze, nearly no streaks and no splashes; and how many frames
/// recorded haze.
fn street(haze: bool) -> (View, Vec<Pixel>, u64) {
    let (files, layout) = assets::street_folder();
    let view = layout.view("street").expect("a place on the street");
    let view = View::new(view.eye.map(f64::from), view.target.map(f64::from)).fov(50.0);
    let mut plan = Plan::new(steady(80.0, [0.0; 3]), 2.0, &[view]);
    plan.scenario.scene = vec![ScenePart::from_file(street::STREET_FILE)];
    plan.scenario.environment = Scenario::default().environment;
    plan.scenario.rain.haze = haze;
    plan.scenario.rain.splash_budget = 0;
    plan.scenario.rain.streak_budget = 1;
    let mut session = Session::new(&plan.scenario, files).expect("the scenario starts");
    let pixels = plan.shot(&mut session, 0).pixels();
    let passes = session.passes().passes;
    (view, pixels, passes.get(&PassName::Haze).map_or(0, |p| p.recorded))
}

#[test]
fn haze_grows_with_distance_and_is_left_out_where_the_scenario_says_so() {
    if !gpu::available() {
        return;
    }
    let (view, with, recorded) = street(true);
    let (_, without, none) = street(false);
    assert!(recorded > 0);
    assert_eq!(none, 0);
    // Mean change of the picture between two distances. Units: steps of 8 bits.
    let change = |from: f64, to: f64| {
        let pairs: Vec<f64> = with
            .iter()
            .zip(&without)
            .filter(|(p, _)| {
                p.surface
                    .is_some_and(|at| (from..to).contains(&(at - view.eye).length()))
            })
            .map(|(p, q)| (p.brightness - q.brightness).abs())
            .collect();
        assert!(pairs.len() > 200, "{} pixels from {from} to {to} m", pairs.len());
        pairs.iter().sum::<f64>() / pairs.len() as f64
    };
    let (near, far) = (change(0.0, 8.0), change(25.0, 60.0));
    // Optical depths are as 6 m to 40 m.
    assert!(far > 2.0 * near && far > 1.0, "{near} near, {far} far");
}
