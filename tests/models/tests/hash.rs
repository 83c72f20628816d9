//! Hashes of integers in place of random sequences: equal to the published functions, and free of patterns.

use proptest::prelude::*;
use rain_core::hash::{open_unit_f32, pcg, pcg3d, unit_f32};
use rain_reference::hash as truth;

/// Consecutive keys that the statistics look at.
const KEYS: u32 = 1 << 20;

fn unit(h: u32) -> f64 {
    f64::from(unit_f32(h))
}

/// Five standard deviations of χ²/dof about 1.
fn is_uniform(chi_squared: f64, bins: usize) -> bool {
    (chi_squared - 1.0).abs() < 5.0 * (2.0 / (bins as f64 - 1.0)).sqrt()
}

#[test]
fn consecutive_keys_give_uniform_values_and_pairs() {
    let singles = truth::chi_squared_per_degree((0..KEYS).map(|n| unit(pcg(n))), 1024);
    assert!(is_uniform(singles, 1024), "{singles}");
    let pairs = truth::chi_squared_of_pairs((0..KEYS).map(|n| (unit(pcg(n)), unit(pcg(n + 1)))), 32);
    assert!(is_uniform(pairs, 1024), "{pairs}");
}

#[test]
fn each_word_of_neighbouring_cells_is_uniform_and_the_words_are_independent() {
    let cells = || (0..KEYS).map(|n| pcg3d([n & 127, (n >> 7) & 127, n >> 14]));
    for word in 0..3 {
        let chi = truth::chi_squared_per_degree(cells().map(|h| unit(h[word])), 1024);
        assert!(is_uniform(chi, 1024), "word {word}: {chi}");
        let pairs = truth::chi_squared_of_pairs(cells().map(|h| (unit(h[word]), unit(h[(word + 1) % 3]))), 32);
        assert!(is_uniform(pairs, 1024), "words from {word}: {pairs}");
    }
}

#[test]
fn neighbours_along_each_axis_are_uncorrelated() {
    for axis in 0..3 {
        let pairs: Vec<(f64, f64)> = (0..1_u32 << 16)
            .map(|n| {
                let cell = [n & 63, (n >> 6) & 63, n >> 12];
                let mut next = cell;
                next[axis] += 1;
                (unit(pcg3d(cell)[0]), unit(pcg3d(next)[0]))
            })
            .collect();
        let correlation = truth::correlation(&pairs);
        // Five standard deviations of the correlation of 2¹⁶ independent pairs.
        assert!(correlation.abs() < 5.0 / 256.0, "axis {axis}: {correlation}");
    }
}

#[test]
fn the_statistics_find_the_hash_of_sines() {
    // The usual shader hash: its values repeat, and neighbouring values lie on lines.
    let sine = |n: u32| {
        f64::from(
            ((n as f32 * 12.9898).sin() * 43_758.547)
                .rem_euclid(1.0)
                .min(0.999_999_94),
        )
    };
    let singles = truth::chi_squared_per_degree((0..KEYS).map(sine), 1024);
    assert!(!is_uniform(singles, 1024) && singles > 10.0, "{singles}");
    assert!(truth::correlation(&(0..1000).map(|n| (f64::from(n), f64::from(n + 1))).collect::<Vec<_>>()) > 0.999);
}

#[test]
fn units_stay_inside_their_intervals() {
    for h in [0, 1, 255, 256, 511, 512, u32::MAX - 511, u32::MAX - 1, u32::MAX] {
        let (half_open, open) = (unit_f32(h), open_unit_f32(h));
        assert!((0.0..1.0).contains(&half_open), "{h}");
        assert!(open > 0.0 && open < 1.0, "{h}");
        // Truncation of the exact value to 24 and to 23 bits and a half.
        let exact = f64::from(h) / 4_294_967_296.0;
        assert!((f64::from(half_open) - exact).abs() <= 1.0 / 16_777_216.0);
        assert!((f64::from(open) - exact).abs() <= 1.0 / 16_777_216.0);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(18), ..ProptestConfig::default() })]

    #[test]
    fn hashes_are_the_published_integer_functions(x: u32, y: u32, z: u32) {
        prop_assert_eq!(pcg(x), truth::pcg(x));
        prop_assert_eq!(pcg3d([x, y, z]), truth::pcg3d([x, y, z]));
    }
}
