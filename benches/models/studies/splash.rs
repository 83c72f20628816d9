//! Work against precision of splash thresholds and of counting impacts.

use std::hint::black_box;

use rain_bench::study::{Study, Variant};
use rain_core::splash::{splash_excess, splash_excess_f32};
use rain_reference::splash as reference;

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![excess()]
}

fn excess() -> Study {
    // Diameter, speed, film: 0.08 to 1.2 diameters, where the reference holds.
    let impacts: Vec<(f32, f32, f32)> = (0..600)
        .map(|i| {
            let d = 0.4 + 0.009 * i as f32;
            (
                d,
                2.0 + 7.0 * (i % 13) as f32 / 13.0,
                d * (0.09 + 1.1 * (i % 29) as f32 / 29.0),
            )
        })
        .collect();
    let variant = |name: &str, f: fn(f32, f32, f32) -> f64| {
        let error = impacts
            .iter()
            .map(|&(d, v, film)| {
                let (d64, v64) = (f64::from(d), f64::from(v));
                let exact = reference::cossali_ratio(d64, v64, f64::from(film) / d64).powf(0.625);
                (f(d, v, film) / exact - 1.0).abs()
            })
            .fold(1e-17, f64::max);
        let impacts = impacts.clone();
        Variant::new(name, error, impacts.len() as u64, move || {
            impacts.iter().map(|&(d, v, film)| f(black_box(d), v, film)).sum()
        })
    };
    /// δ^1.44 as δ √δ, the nearest power without a logarithm.
    fn rooted(d: f32, v: f32, film: f32) -> f64 {
        let delta = film / d;
        let threshold = 2100.0 + 5880.0 * delta * delta.sqrt();
        // x^(5/8) = √(x · x^¼).
        f64::from(rain_core::splash::splash_k_f32(d, v) / (threshold * threshold.sqrt().sqrt()).sqrt())
    }
    Study {
        name: "splash-threshold",
        title: "K of an impact over the threshold on a film",
        norm: "max relative error",
        unit: "impact",
        variants: vec![
            variant("f64", |d, v, film| {
                splash_excess(f64::from(d), f64::from(v), f64::from(film))
            }),
            variant("f32", |d, v, film| f64::from(splash_excess_f32(d, v, film))).default(),
            variant("f32, power 3/2 for 1.44", rooted),
        ],
    }
}
