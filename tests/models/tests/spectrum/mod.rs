//! Drop-size distributions: shapes, normalisation, bulk quantities, sampling, classes.

mod bulk;
mod classes;
mod formulas;
mod laws;
mod sampling;

use proptest::prelude::ProptestConfig;

/// What no evaluator may stumble over.
const ODD: [f64; 9] = [
    f64::NAN,
    f64::NEG_INFINITY,
    -1.0,
    -0.0,
    0.0,
    f64::MIN_POSITIVE,
    1e-9,
    1e30,
    f64::INFINITY,
];

/// Rain rates of the whole domain. Units: mm/h.
const RATES: [f64; 9] = [1e-4, 0.01, 0.5, 1.0, 5.0, 25.0, 50.0, 100.0, 500.0];

fn config() -> ProptestConfig {
    ProptestConfig {
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(5),
        ..ProptestConfig::with_cases(128)
    }
}
