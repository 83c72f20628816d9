//! Work against precision of the canopy store, drip sizes and the drops under a leaf.

use std::hint::black_box;

use rain_bench::study::{Study, Variant};
use rain_core::canopy::{
    CanopyStore, DripSizes, LeafType, drip_fall_time_s, drip_fall_time_s_f32, stored_by_lambert_w, stored_by_splitting,
};
use rain_reference::canopy as reference;

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![store(), sizes(), fall_time()]
}

/// Capacity and full-crown evaporation of the published splitting errors. Units: mm, mm/h.
const CAPACITY_MM: f64 = 0.6;
const RAIN_MM_H: f64 = 10.0;
const EVAPORATION_MM_H: f64 = 0.5;

/// Stored, rain, evaporation and time in mm, mm/h and s to stored.
type Step = fn(f64, f64, f64, f64) -> f64;

/// Stored depth after `time` in steps of `dt` by a one-step method.
fn stepped(step: Step, start: f64, [rain, evaporation]: [f64; 2], time: f64, dt: f64) -> f64 {
    let whole = (time / dt) as u32;
    let stored = (0..whole).fold(start, |stored, _| step(stored, rain, evaporation, dt));
    step(stored, rain, evaporation, time - dt * f64::from(whole))
}

fn exact_step(stored: f64, rain: f64, evaporation: f64, dt: f64) -> f64 {
    let store = CanopyStore::from_measured(CAPACITY_MM, 1.0, 0.8).and_then(|store| store.with_stored(stored));
    store.map_or(f64::NAN, |mut store| {
        store.advance(rain, evaporation, dt);
        store.stored_mm()
    })
}

fn split_step(stored: f64, rain: f64, evaporation: f64, dt: f64) -> f64 {
    stored_by_splitting(CAPACITY_MM, stored, rain, evaporation, dt)
}

fn lambert_step(stored: f64, rain: f64, evaporation: f64, dt: f64) -> f64 {
    stored_by_lambert_w(CAPACITY_MM, stored, rain, evaporation, dt)
}

fn store() -> Study {
    // Times at which the separated equation, summed slowly, passes given levels.
    let filling: Vec<(f64, f64)> = (1..60)
        .map(|i| {
            let y = 1.0 - f64::from(i) / 60.0 * 0.94;
            let rates = (RAIN_MM_H / 3600.0, EVAPORATION_MM_H / 3600.0);
            let time = reference::canopy_integral(CAPACITY_MM, rates.0, rates.1, 1.0, y, |_| 1.0);
            (time, CAPACITY_MM * (1.0 - y) * (1.0 + y))
        })
        .collect();
    // And from a full crown in light rain, where the square root is singular.
    let light = 0.2;
    let drying: Vec<(f64, f64)> = (1..20)
        .map(|i| {
            let y = 0.9 * f64::from(i) / 20.0;
            let time =
                reference::canopy_integral(CAPACITY_MM, light / 3600.0, EVAPORATION_MM_H / 3600.0, 0.0, y, |_| 1.0);
            (time, CAPACITY_MM * (1.0 - y) * (1.0 + y))
        })
        .collect();
    let saturation = 7200.0 * CAPACITY_MM / RAIN_MM_H;
    let variant = |name: &str, step: Step, share: f64| {
        let worst = |course: &[(f64, f64)], start: f64, rates: [f64; 2], dt: f64| {
            course
                .iter()
                .map(|&(time, level)| (stepped(step, start, rates, time, dt) - level).abs() / CAPACITY_MM)
                .fold(0.0, f64::max)
        };
        let dt = share * saturation;
        let error = worst(&filling, 0.0, [RAIN_MM_H, EVAPORATION_MM_H], dt).max(worst(
            &drying,
            CAPACITY_MM,
            [light, EVAPORATION_MM_H],
            dt * 5.0,
        ));
        Variant::new(name, error, 64, move || {
            (0..64)
                .map(|i| {
                    let rain = black_box(2.0 + f64::from(i));
                    let time = 7200.0 * CAPACITY_MM / rain;
                    stepped(step, 0.0, [rain, 0.05 * rain], time, share * time)
                })
                .sum()
        })
    };
    Study {
        name: "canopy-store",
        title: "Water on leaves after a shower of one saturation time",
        norm: "max |C − C_ref|/S",
        unit: "shower",
        variants: vec![
            variant("exact, Halley in e-foldings", exact_step, 1.1).default(),
            variant("exact, 100 steps", exact_step, 0.01),
            variant("Lambert W", lambert_step, 1.1),
            variant("splitting, 5 steps", split_step, 0.2),
            variant("splitting, 20 steps", split_step, 0.05),
            variant("splitting, 50 steps", split_step, 0.02),
            variant("splitting, 200 steps", split_step, 0.005),
            variant("splitting, 2000 steps", split_step, 0.0005),
        ],
    }
}

fn sizes() -> Study {
    let shares: Vec<f64> = (0..24).map(|i| (f64::from(i) + 0.5) / 24.0).collect();
    let exact: Vec<f64> = shares
        .iter()
        .map(|&u| reference::drip_quantile(|d| reference::drip_gaussian_density(0, d), 3, u))
        .collect();
    let variant = |classes: usize| {
        let sizes = DripSizes::gaussian(LeafType::NeedleCoated, classes);
        let error = (shares.iter().zip(&exact))
            .map(|(&u, d)| (sizes.diameter_by_number(u) - d).abs())
            .fold(0.0, f64::max);
        Variant::new(format!("{classes} classes"), error, 1000, move || {
            (0..1000)
                .map(|i| sizes.diameter_by_number(black_box(f64::from(i) / 1000.0)))
                .sum()
        })
    };
    Study {
        name: "drip-sizes",
        title: "Drip diameter by number from the Gaussian fit",
        norm: "max |D − D_ref|, mm",
        unit: "drop",
        variants: vec![
            variant(14),
            variant(28),
            variant(56),
            variant(140).default(),
            variant(560),
            variant(2800),
        ],
    }
}

/// arcosh(e^x) as printed, in single precision.
fn printed_f32(distance: f32, terminal: f32) -> f32 {
    let g = 9.80665_f32;
    terminal / g * (g * distance / (terminal * terminal)).exp().acosh()
}

fn fall_time() -> Study {
    let places: Vec<(f32, f32)> = (0..400)
        .map(|i| (1e-4 * 1.034_f32.powi(i), 4.0 + 5.0 * (i % 7) as f32 / 7.0))
        .collect();
    let error = |f: &dyn Fn(f32, f32) -> f64| {
        places
            .iter()
            .map(|&(d, v)| {
                // (v/g) ln(e^x + √(e^(2x) − 1)), its square root from a series where it cancels.
                let x = 9.80665 * f64::from(d) / f64::from(v).powi(2);
                let arcosh = x + (1.0 + (-(-2.0 * x).exp_m1()).sqrt()).ln();
                let exact = f64::from(v) / 9.80665 * arcosh;
                (f(d, v) / exact - 1.0).abs()
            })
            .fold(1e-17, f64::max)
    };
    let double = |d: f32, v: f32| drip_fall_time_s(f64::from(d), f64::from(v));
    let single = |d: f32, v: f32| f64::from(drip_fall_time_s_f32(d, v));
    let printed = |d: f32, v: f32| f64::from(printed_f32(d, v));
    let variant = |name: &str, f: fn(f32, f32) -> f64| {
        let places = places.clone();
        Variant::new(name, error(&f), places.len() as u64, move || {
            places.iter().map(|&(d, v)| f(black_box(d), v)).sum()
        })
    };
    Study {
        name: "drip-fall-time",
        title: "Time since a drip let go, 0.1 mm to 60 m below the leaf",
        norm: "max relative error",
        unit: "drop",
        variants: vec![
            variant("f64", double),
            variant("f32", single).default(),
            variant("as printed, f32", printed),
        ],
    }
}
