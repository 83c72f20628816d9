//! Work against precision of hydroplaning speeds.

use std::hint::black_box;

use rain_bench::study::{Study, Variant};
use rain_core::wheels::{GallawayCase, gallaway_speed_km_h, horne_speed_km_h};
use rain_reference::wheels as reference;

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![hydroplaning()]
}

fn hydroplaning() -> Study {
    let cases: Vec<GallawayCase> = (0..300)
        .map(|i| GallawayCase {
            spin_down_percent: 10.0,
            pressure_kpa: 165.0 + 85.0 * f64::from(i % 17) / 17.0,
            tread_mm: 1.6 + 6.4 * f64::from(i % 11) / 11.0,
            water_mm: 2.5 + 7.5 * f64::from(i % 23) / 23.0,
            texture_mm: 0.2 + 1.0 * f64::from(i % 7) / 7.0,
        })
        .collect();
    let variant = |name: &str, f: fn(&GallawayCase) -> f64| {
        let squares: f64 = cases
            .iter()
            .map(|case| {
                let mph = reference::gallaway_mph(
                    case.spin_down_percent,
                    case.pressure_kpa / 6.894_757_293_168,
                    case.tread_mm / 25.4 * 32.0,
                    case.water_mm / 25.4,
                    case.texture_mm / 25.4,
                );
                (f(case) / (mph * 1.609344) - 1.0).powi(2)
            })
            .sum();
        let error = (squares / cases.len() as f64).sqrt().max(1e-17);
        let cases = cases.clone();
        Variant::new(name, error, cases.len() as u64, move || {
            cases.iter().map(|case| f(black_box(case))).sum()
        })
    };
    Study {
        name: "hydroplaning-speed",
        title: "Hydroplaning speed on 2.5 to 10 mm of water: two models against the fit to tests",
        norm: "rms |v/v_Gallaway − 1|",
        unit: "wheel",
        variants: vec![
            variant("Horne & Dreher 1963", |case| horne_speed_km_h(case.pressure_kpa)).default(),
            variant("Gallaway et al. 1979", gallaway_speed_km_h),
        ],
    }
}
