//! Fresnel reflection, refraction in a drop, streaks, extinction.

mod cloud;
mod drop;
mod formulas;
mod fresnel;
mod haze;
mod near_streak;
mod rainbow;
mod sharing;
mod sphere;
mod streak;

use proptest::prelude::ProptestConfig;
use proptest::test_runner::RngSeed;

const NOT_NUMBERS: [f64; 4] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0];

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 256,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(9),
        ..ProptestConfig::default()
    }
}
