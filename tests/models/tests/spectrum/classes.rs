//! Size classes: what they hold, and what they cost.

use proptest::prelude::*;
use rain_core::rainfall::{
    CLASS_COUNT, CLASS_EDGES_MM, CLASS_SPEEDS_M_S, ClassErrors, ClassScheme, ClassWeights, Distribution, DropSizes,
    RainKind, Spectrum, gunn_kinzer, terminal_velocity,
};
use rain_reference::spectrum as reference;

use super::{ODD, RATES, config};
use crate::check::Worst;

fn rain(r: f64) -> DropSizes {
    DropSizes::carrying(RainKind::MarshallPalmer, r, gunn_kinzer).unwrap()
}

fn errors(scheme: ClassScheme, classes: usize, (a, b): (f64, f64), r: f64) -> ClassErrors {
    let mut edges = vec![0.0; classes + 1];
    scheme.edges(a, b, gunn_kinzer, &mut edges).unwrap();
    ClassErrors::of(&edges, &rain(r), &rain(25.0), gunn_kinzer).unwrap()
}

#[test]
fn weights_equal_brute_force_for_every_rain() {
    let mut exact = Worst::default();
    let mut water = Worst::default();
    let mut slow = Worst::default();
    for distribution in Distribution::ALL {
        for r in RATES {
            let spectrum = Spectrum::new(distribution, r).unwrap();
            let weights = ClassWeights::new(&spectrum);
            let sizes = DropSizes::from(spectrum);
            for k in 0..CLASS_COUNT {
                let (a, b) = (CLASS_EDGES_MM[k], CLASS_EDGES_MM[k + 1]);
                let place = || format!("{distribution:?} {r} mm/h, class {k}");
                exact.relative(weights.number_per_m3[k], spectrum.moment(0, a, b), 1e-300, place);
                exact.relative(
                    weights.extinction_per_m[k],
                    spectrum.extinction_per_m(a, b),
                    1e-300,
                    place,
                );
                let rate = sizes.rain_rate_mm_h(a, b, terminal_velocity);
                water.absolute(weights.rain_rate_mm_h[k] / r, rate / r, place);
                if r == 25.0 {
                    let n = |d: f64| spectrum.concentration(d);
                    let rate = reference::rain_rate(a, b, n, rain_reference::fall_speed::fit);
                    slow.absolute(weights.rain_rate_mm_h[k] / r, rate / r, place);
                }
            }
        }
    }
    exact.assert_below(1e-12, 800);
    water.assert_below(2e-5, 400);
    slow.assert_below(2e-5, 40);
}

#[test]
fn weights_add_up_to_the_range_and_allocate_nothing() {
    for r in [1.0, 25.0, 100.0] {
        let spectrum = Spectrum::new(Distribution::MarshallPalmer, r).unwrap();
        let mut weights = ClassWeights::new(&spectrum);
        let counted = allocation_counter::measure(|| weights = ClassWeights::new(std::hint::black_box(&spectrum)));
        assert_eq!(counted.count_total, 0);
        let sum = |values: &[f64; CLASS_COUNT]| values.iter().sum::<f64>();
        assert!((sum(&weights.rain_rate_mm_h) / spectrum.rain_rate_mm_h(0.5, 6.0) - 1.0).abs() < 2e-5);
        assert!((sum(&weights.number_per_m3) / spectrum.moment(0, 0.5, 6.0) - 1.0).abs() < 1e-12);
        assert!((sum(&weights.extinction_per_m) / spectrum.extinction_per_m(0.5, 6.0) - 1.0).abs() < 1e-12);
        for k in 0..CLASS_COUNT {
            let d = ClassWeights::rms_diameter_mm(&spectrum, k);
            assert!(d > CLASS_EDGES_MM[k] && d < CLASS_EDGES_MM[k + 1]);
            let one = core::f64::consts::FRAC_PI_4 * 1e-6 * d * d * weights.number_per_m3[k];
            assert!((one / weights.extinction_per_m[k] - 1.0).abs() < 1e-9);
        }
    }
    let dry = ClassWeights::new(&Spectrum::new(Distribution::Drizzle, 0.0).unwrap());
    assert_eq!(dry.number_per_m3, [0.0; CLASS_COUNT]);
    assert_eq!(dry.rain_rate_mm_h, [0.0; CLASS_COUNT]);
    let mist = Spectrum::new(Distribution::Drizzle, 1e-4).unwrap();
    assert!(ClassWeights::rms_diameter_mm(&mist, usize::MAX) > 4.8);
}

#[test]
fn the_fields_edges_and_speeds_are_the_logarithmic_scheme() {
    let mut edges = [0.0; CLASS_COUNT + 1];
    ClassScheme::Logarithmic
        .edges(0.5, 6.0, gunn_kinzer, &mut edges)
        .unwrap();
    for (edge, field) in edges.iter().zip(CLASS_EDGES_MM) {
        assert!((edge - field).abs() < 1e-6);
    }
    let held = rain(25.0);
    for k in 0..CLASS_COUNT {
        let (a, b) = (edges[k], edges[k + 1]);
        let u = held.flux_moment(0, a, b, gunn_kinzer) / held.moment(0, a, b);
        assert!((u - CLASS_SPEEDS_M_S[k]).abs() < 5.1e-3, "{k}: {u}");
    }
}

#[test]
fn class_errors_are_those_published() {
    // Classes over 0.5–6 mm; number and water flux error in % at 1, 5, 25, 100 mm/h, range of the rms speed error, and
    // its largest value.
    let published = [
        (6, [2.0, 0.9, 0.0, -0.7], [-0.8, -1.7, -2.3, -2.6], (8.0, 11.0), 23.0),
        (8, [1.2, 0.5, 0.0, -0.4], [-0.4, -1.0, -1.3, -1.5], (6.0, 8.0), 17.0),
        (12, [0.5, 0.2, 0.0, -0.2], [-0.2, -0.4, -0.6, -0.7], (4.0, 5.0), 11.0),
        (16, [0.3, 0.1, 0.0, -0.1], [-0.1, -0.2, -0.3, -0.4], (3.0, 4.0), 8.0),
    ];
    for (classes, number, water, rms, largest) in published {
        for (i, r) in [1.0, 5.0, 25.0, 100.0].into_iter().enumerate() {
            let found = errors(ClassScheme::Logarithmic, classes, (0.5, 6.0), r);
            assert!(
                (100.0 * found.number_flux - number[i]).abs() < 0.051,
                "{classes}, {r}: {found:?}"
            );
            assert!(
                (100.0 * found.water_flux - water[i]).abs() < 0.051,
                "{classes}, {r}: {found:?}"
            );
            let speed = 100.0 * found.speed_rms;
            assert!(speed > rms.0 - 0.8 && speed < rms.1 + 0.5, "{classes}, {r}: {found:?}");
            assert!(
                (100.0 * found.speed_max - largest).abs() < 0.6,
                "{classes}, {r}: {found:?}"
            );
        }
    }
}

#[test]
fn other_schemes_are_no_better() {
    let worst = |scheme, classes, range| {
        [1.0, 5.0, 25.0, 100.0]
            .into_iter()
            .map(|r| errors(scheme, classes, range, r))
            .map(|e| (e.number_flux.abs(), e.water_flux.abs(), e.speed_rms))
            .fold((0.0, 0.0, 0.0), |a: (f64, f64, f64), b| {
                (a.0.max(b.0), a.1.max(b.1), a.2.max(b.2))
            })
    };
    // Sixteen classes of equal speed over 0.2–6 mm: number 0.6 %, water 0.55 %.
    let (number, water, _) = worst(ClassScheme::EqualSpeed, 16, (0.2, 6.0));
    assert!(
        (number - 0.006).abs() < 1e-3 && (water - 0.0055).abs() < 1e-3,
        "{number} {water}"
    );
    // Equal steps of diameter need about twice as many.
    let log = worst(ClassScheme::Logarithmic, 12, (0.5, 6.0));
    let equal = worst(ClassScheme::EqualDiameter, 12, (0.5, 6.0));
    assert!(equal.0 > 2.0 * log.0 && equal.2 > 1.4 * log.2, "{log:?} {equal:?}");
    // More classes, less error.
    for scheme in ClassScheme::ALL {
        let mut last = f64::INFINITY;
        for classes in [6, 8, 12, 16, 24] {
            let (number, water, speed) = worst(scheme, classes, (0.5, 6.0));
            assert!(number + water + speed < last, "{scheme:?} {classes}");
            last = number + water + speed;
        }
    }
}

#[test]
fn one_diameter_a_class_held_at_one_rate_misses_extinction() {
    for (r, percent) in [(1.0, 2.0), (5.0, 1.2), (25.0, 0.0), (100.0, -1.3)] {
        let found = errors(ClassScheme::Logarithmic, 12, (0.2, 6.0), r);
        assert!((100.0 * found.extinction - percent).abs() < 0.11, "{r}: {found:?}");
    }
}

#[test]
fn bad_edges_are_refused() {
    let rain = rain(5.0);
    let mut edges = [0.0; 3];
    for (a, b) in [
        (0.0, 6.0),
        (f64::NAN, 6.0),
        (0.5, f64::NAN),
        (2.0, 1.0),
        (1.0, 1.0),
        (0.5, 21.0),
    ] {
        assert!(
            ClassScheme::EqualSpeed.edges(a, b, gunn_kinzer, &mut edges).is_err(),
            "[{a}, {b}]"
        );
    }
    assert!(
        ClassScheme::EqualSpeed
            .edges(0.5, 6.0, gunn_kinzer, &mut edges[..1])
            .is_err()
    );
    for bad in [
        &[][..],
        &[1.0],
        &[1.0, 0.5],
        &[0.0, 1.0],
        &[1.0, 2.0, f64::NAN],
        &[1.0, 1.0],
    ] {
        assert!(ClassErrors::of(bad, &rain, &rain, gunn_kinzer).is_err(), "{bad:?}");
    }
    for x in ODD {
        assert!(
            ClassErrors::of(&[0.5, 1.0, x], &rain, &rain, gunn_kinzer).is_err() || x > 1.0,
            "{x}"
        );
    }
}

#[test]
fn classes_between_any_edges_are_conserving_at_the_held_rate() {
    proptest!(config(), |(a in 0.2..1.0_f64, ratio in 2.0..20.0_f64, classes in 2_usize..20)| {
        for scheme in ClassScheme::ALL {
            let mut edges = vec![0.0; classes + 1];
            scheme.edges(a, (a * ratio).min(6.0), gunn_kinzer, &mut edges).unwrap();
            prop_assert!(edges.windows(2).all(|pair| pair[0] < pair[1]));
            let held = rain(25.0);
            let found = ClassErrors::of(&edges, &held, &held, gunn_kinzer).unwrap();
            prop_assert!(found.number_flux.abs() < 1e-12 && found.extinction.abs() < 1e-12);
            // Water is undercounted: larger drops than the mean carry it, and faster.
            prop_assert!(found.water_flux < 1e-12 && found.speed_rms <= found.speed_max);
        }
    });
}
