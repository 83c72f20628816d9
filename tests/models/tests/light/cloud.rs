//! Light through clouds.

use rain_core::optics::{CLOUD_ASYMMETRY, cloud_optical_depth, cloud_transmittance, cloud_water_kg_m2};
use rain_reference::light::cloud as reference;

use super::NOT_NUMBERS;

#[test]
fn clouds_are_their_formulas() {
    for (rate, column) in [(0.0, 3000.0), (1.0, 1000.0), (25.0, 3000.0), (100.0, 5000.0)] {
        let water = 0.18 * (1.0 + f64::sqrt(column * 1e-3 * rate));
        assert!((cloud_water_kg_m2(rate, column) / water - 1.0).abs() <= 1e-15);
        let depth = cloud_optical_depth(water, 1e-5);
        assert!((depth / (1.5 * water / (1000.0 * 1e-5)) - 1.0).abs() <= 1e-15);
        let through = 1.0 / (1.0 + 0.5 * 3.0_f64.sqrt() * (1.0 - 0.85) * depth);
        assert!((cloud_transmittance(depth, 0.85) / through - 1.0).abs() <= 1e-15);
    }
    for bad in NOT_NUMBERS {
        assert!(cloud_water_kg_m2(bad, 3000.0).is_finite() && cloud_water_kg_m2(1.0, bad).is_finite());
        assert!(cloud_optical_depth(bad, 1e-5).is_finite() && cloud_optical_depth(1.0, bad).is_finite());
        assert!((0.0..=1.0).contains(&cloud_transmittance(bad, 0.85)));
        assert!((0.0..=1.0).contains(&cloud_transmittance(10.0, bad)));
    }
}

#[test]
fn clouds_let_through_what_their_drops_do() {
    for depth in [1.0, 10.0, 40.0, 100.0] {
        let walked = reference::slab_transmittance(depth, CLOUD_ASYMMETRY, 20_000);
        let ours = cloud_transmittance(depth, CLOUD_ASYMMETRY);
        // A hundredth of it is chance.
        assert!((ours - walked).abs() < 0.03, "{depth}: {ours} {walked}");
    }
}
