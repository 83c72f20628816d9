//! Film, road film, infiltration, inlets, puddles, states and looks of wet surfaces.

mod artist;
mod flow;
mod ground;
mod look;
mod paint;
mod puddle;
mod soil;

use proptest::prelude::ProptestConfig;

/// The same cases in every run.
fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(11),
        ..ProptestConfig::with_cases(cases)
    }
}

/// What a careless caller may pass.
const ANY: [f64; 12] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::MAX,
    f64::MIN,
    1e30,
    1.0,
    1e-30,
    f64::MIN_POSITIVE,
    5e-324,
    0.0,
    -1.0,
];

/// `n` values from `low` to `high`, evenly spaced in their logarithm.
fn log_spaced(low: f64, high: f64, n: usize) -> impl Iterator<Item = f64> + Clone {
    let ratio = (high / low).ln() / (n - 1) as f64;
    (0..n).map(move |i| (low * (ratio * i as f64).exp()).clamp(low, high))
}
