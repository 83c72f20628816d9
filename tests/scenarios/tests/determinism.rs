//! The same in, the same out, at any frame rate.

use std::path::Path;

use rain_plugins::scenario::weather::WeatherKey;
use test_support::shots::{Plan, View, steady};
use test_support::{gpu, world};

fn plan(seed: u64) -> Plan {
    let view = View::new([0.0, 1.7, 9.0], [0.0, 1.0, 0.0]);
    let mut plan = Plan::new(steady(0.0, [0.0; 3]), 30.0, &[view]);
    // Rain and wind that change all the time.
    let key = |time_s: f64, rate: f64, wind: f64| WeatherKey {
        time_s,
        intensity_mm_h: Some(rate),
        wind_m_s: Some([wind, 0.0, 0.3 * wind]),
        ..WeatherKey::default()
    };
    plan.scenario.weather.keys = vec![key(0.0, 3.0, 0.0), key(0.3, 60.0, 3.0), key(30.0, 20.0, -2.0)];
    plan.scenario.seed = seed;
    plan
}

#[test]
fn the_same_scenario_twice_gives_the_same_hash_and_the_same_masks() {
    if !gpu::available() {
        return;
    }
    let run = |seed: u64| {
        let plan = plan(seed);
        let mut session = plan.session(Path::new("."), |world| {
            world::ground(world);
            world::roof(world);
        });
        let shot = plan.shoot(&mut session).remove(0);
        (session.state_hash(), shot.capture.masks)
    };
    let (first, second, other) = (run(5), run(5), run(6));
    assert_eq!(first.0, second.0, "state hash");
    assert!(first.1 == second.1, "masks differ");
    assert!(
        first.1.len() == 4 && first.1[0].1.iter().any(|t| *t > 0),
        "the masks show rain"
    );
    // Another seed is another run: other drops, though the same weather.
    assert_ne!(first.0, other.0, "state hash of another seed");
    assert!(first.1[0] != other.1[0], "the rain mask of another seed");
}

#[test]
fn any_frame_rate_ends_in_the_same_state_hash() {
    if !gpu::available() {
        return;
    }
    let play = |fps: f64, until_s: f64| {
        let mut plan = plan(5);
        plan.scenario.outputs.size = [16, 9];
        plan.scenario.outputs.masks.clear();
        plan.scenario.rain.streak_budget = 500;
        let mut session = plan.session(Path::new("."), |_| {});
        session.play(until_s, fps).expect("frames");
        session.state_hash()
    };
    let hashes = [30.0, 60.0, 144.0].map(|fps| play(fps, 0.5));
    assert_eq!(hashes[0], hashes[1], "30 and 60 Hz");
    assert_eq!(hashes[0], hashes[2], "30 and 144 Hz");
    // A tick more is another state.
    assert_ne!(hashes[0], play(30.0, 0.5 + 1.0 / 30.0));
}
