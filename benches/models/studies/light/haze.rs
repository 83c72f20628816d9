//! Optical depth of haze: height profile, what drawn drops leave to it.

use std::hint::black_box;

use rain_bench::study::{Study, Variant};
use rain_core::haze::{FogTable, HazeSharing, HeightHaze, mean_decay_f32, transmittance, transmittance_f32};
use rain_core::rainfall::{CLASS_COUNT, CLASS_EDGES_MM, Distribution, Spectrum};
use rain_reference::light::haze as reference;

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![profile(), sharing()]
}

/// Largest error over `inputs` and a variant that evaluates them.
fn variant<I: Copy + 'static>(
    name: impl Into<String>,
    inputs: &[I],
    truth: &[f64],
    value: impl Fn(I) -> f64 + 'static,
) -> Variant {
    let error = inputs
        .iter()
        .zip(truth)
        .map(|(input, y)| (value(*input) - y).abs())
        .fold(0.0, f64::max);
    let inputs = inputs.to_vec();
    Variant::new(name, error, inputs.len() as u64, move || {
        inputs.iter().map(|input| value(black_box(*input))).sum()
    })
}

fn profile() -> Study {
    const BASE: f64 = 0.01;
    const SCALE: f64 = 25.0;
    let ways: Vec<[f64; 2]> = [0.0, 1.0, 2e-3, 5.0, 20.0, 60.0]
        .iter()
        .flat_map(|&up| [10.0, 50.0, 200.0, 800.0].map(|way| [up, way]))
        .collect();
    let truth: Vec<f64> = ways
        .iter()
        .map(|[up, way]| (-reference::profile_depth(BASE, 0.0, SCALE, 1.5, 1.5 + up, *way)).exp())
        .collect();
    let closed = move |[up, way]: [f64; 2]| {
        HeightHaze::new(BASE, 0.0, SCALE).map_or(f64::NAN, |haze| transmittance(haze.depth(1.5, 1.5 + up, way)))
    };
    let single = |[up, way]: [f64; 2]| {
        let (up, way) = (up as f32, way as f32);
        let low = BASE as f32 * transmittance_f32(1.5 / SCALE as f32);
        f64::from(transmittance_f32(low * way * mean_decay_f32(up / SCALE as f32)))
    };
    let mut variants = vec![
        variant("closed form", &ways, &truth, closed).default(),
        variant("closed form, f32", &ways, &truth, single),
        variant("(1 - e^-x)/x as printed, f32", &ways, &truth, |[up, way]| {
            let x = up as f32 / SCALE as f32;
            let low = BASE as f32 * (-1.5 / SCALE as f32).exp();
            let mean = if x == 0.0 { 1.0 } else { (1.0 - (-x).exp()) / x };
            f64::from((-low * way as f32 * mean).exp())
        }),
    ];
    variants.extend([4, 16, 64, 256].iter().map(|&steps| {
        variant(format!("march, {steps} steps"), &ways, &truth, move |[up, way]| {
            reference::marched(way, steps, |s| BASE * (-(1.5 + up * s / way) / SCALE).exp())
        })
    }));
    Study {
        name: "haze-height",
        title: "Transmittance of haze that thins out with height",
        norm: "max |T - T_ref|",
        unit: "ray",
        variants,
    }
}

fn sharing() -> Study {
    let ranges: [f64; CLASS_COUNT] = core::array::from_fn(|k| (0.8 * 1.45_f64.powi(k as i32)).min(15.0));
    let ways: Vec<f64> = (0..48).map(|i| 0.3 * 1.17_f64.powi(i)).collect();
    let study = |spectrum: Spectrum| -> Option<Study> {
        let account = HazeSharing::new(&spectrum, 2.0, ranges, true).ok()?;
        let class_of = |d: f64| {
            (1..CLASS_COUNT)
                .find(|&k| d < CLASS_EDGES_MM[k])
                .map_or(CLASS_COUNT - 1, |k| k - 1)
        };
        let table = FogTable::new(&spectrum, 2.0, true, |d| ranges[class_of(d)]).ok()?;
        let sigma = spectrum.extinction_per_m(0.0, f64::INFINITY);
        let shares = account.classes().map(|class| class.share);
        let weight = move |s: f64| {
            let drawn: f64 = (0..CLASS_COUNT)
                .map(|k| shares[k] * (reference::near_weight(s, ranges[k]) + reference::mid_weight(s, ranges[k])))
                .sum();
            sigma * (2.0 - drawn)
        };
        let corners: Vec<f64> = ranges
            .iter()
            .flat_map(|z| [0.8 * z, 1.2 * z, (0.8 * z).max(3.2), 1.5 * (0.8 * z).max(3.2)])
            .chain([0.1, 0.2, 24.0, 36.0].iter().copied())
            .collect();
        let truth: Vec<f64> = ways
            .iter()
            .map(|s| (-reference::along(*s, &corners, weight)).exp())
            .collect();
        let mut variants = vec![
            variant("table of 64, f32", &ways, &truth, move |s| {
                f64::from(transmittance_f32(table.depth_f32(s as f32)))
            })
            .default(),
            variant("closed form, 12 classes", &ways, &truth, move |s| {
                account.fog_transmittance(s)
            }),
            variant("one range, 10 m", &ways, &truth, move |s| {
                let drawn: f64 = shares.iter().sum();
                transmittance(rain_core::haze::single_range_fog_depth(sigma, 2.0, s, 10.0, drawn))
            }),
            variant("whole rain as fog, drops counted twice", &ways, &truth, move |s| {
                transmittance(2.0 * sigma * s)
            }),
        ];
        variants.extend([4, 16, 64].iter().map(|&steps| {
            variant(format!("march, {steps} steps"), &ways, &truth, move |s| {
                reference::marched(s, steps, weight)
            })
        }));
        Some(Study {
            name: "haze-sharing",
            title: "Fog left by drawn drops, 100 mm/h",
            norm: "max |T - T_ref|",
            unit: "ray",
            variants,
        })
    };
    Spectrum::new(Distribution::MarshallPalmer, 100.0)
        .ok()
        .and_then(study)
        .expect("rates, ranges and Q are in their domains")
}
