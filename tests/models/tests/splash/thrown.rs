//! Counts, impacts and secondary drops: the same words in double precision.

use glam::Vec3;
use proptest::prelude::*;
use rain_core::splash::{Impact, Splash, SplashKind, for_each_impact, hashed_poisson, secondary_drop};
use rain_reference::hash::{chi_squared_per_degree, correlation};
use rain_reference::splash as reference;

use super::falling;
use crate::check::Worst;

#[test]
fn counts_are_the_inverse_of_the_distribution() {
    let mut off = 0;
    let mut cases = 0;
    for mean in [0.0, 1e-9, 1e-3, 0.3, 1.0, 7.5, 29.9, 30.0, 30.1, 90.0, 433.0] {
        for i in 0..400_u32 {
            let key = [i.wrapping_mul(0x9e37_79b9), 5, i];
            off += u32::from(hashed_poisson(mean, key) != reference::hashed_count(mean, key));
            cases += 1;
        }
    }
    assert_eq!((off, cases), (0, 4400));
    // Another mean gives other counts: the comparison sees 5 %.
    let bent = (0..400).filter(|&i| hashed_poisson(31.5, [i, 1, 2]) != reference::hashed_count(30.0, [i, 1, 2]));
    assert!(bent.count() > 300);
}

#[test]
fn impacts_are_those_of_the_words() {
    let mut count = 0;
    for seed in [0, 7, u32::MAX] {
        for cell in [[0, 0], [-1, 5], [i32::MIN, i32::MAX], [123_456, -9]] {
            for (slot, mean) in [(0, 3.0), (u32::MAX, 11.0), (77, 0.2), (5, 64.0)] {
                let mut ours = Vec::new();
                for_each_impact(seed, cell, slot, mean, |event| ours.push(event));
                let known = reference::impacts_of(seed, cell.map(i64::from), slot, mean);
                assert_eq!(ours.len(), known.len(), "{cell:?} {slot}");
                for (event, ([x, z, moment], key)) in ours.iter().zip(known) {
                    assert_eq!(event.place.map(f64::from), [x, z]);
                    assert_eq!((f64::from(event.moment), event.key), (moment, key));
                    count += 1;
                }
            }
        }
    }
    assert!(count > 500, "{count}");
    for bad in [f64::NAN, f64::NEG_INFINITY, -1.0, 0.0] {
        for_each_impact(1, [0, 0], 0, bad, |event| panic!("{bad}: {event:?}"));
    }
    let mut most = 0;
    for_each_impact(1, [0, 0], 0, f64::INFINITY, |_| most += 1);
    assert!((990_000..1_010_000).contains(&most), "held at a million: {most}");
}

#[test]
fn places_and_moments_of_impacts_are_uniform_and_independent() {
    let mut events = Vec::new();
    for n in 0..4000_u32 {
        for_each_impact(3, [(n % 64) as i32, (n / 64) as i32], n % 7, 16.0, |event| {
            events.push(event)
        });
    }
    // Five standard deviations of a Poisson count, and of χ²/dof.
    assert!(
        (events.len() as f64 - 64_000.0).abs() < 5.0 * 64_000_f64.sqrt(),
        "{}",
        events.len()
    );
    let bound = 5.0 * (2.0_f64 / 255.0).sqrt();
    for which in 0..3 {
        let values = events
            .iter()
            .map(|e| f64::from([e.place[0], e.place[1], e.moment][which]));
        let chi = chi_squared_per_degree(values, 256);
        assert!((chi - 1.0).abs() < bound, "{which}: {chi}");
    }
    for [a, b] in [[0, 1], [1, 2], [0, 2]] {
        let pairs: Vec<(f64, f64)> = (events.iter())
            .map(|e| [e.place[0], e.place[1], e.moment].map(f64::from))
            .map(|v| (v[a], v[b]))
            .collect();
        assert!(correlation(&pairs).abs() < 5.0 / (pairs.len() as f64).sqrt(), "{a} {b}");
    }
    // Moments that crowd together are noticed.
    let crowded = events.iter().map(|e| f64::from(e.moment).powf(1.05));
    assert!((chi_squared_per_degree(crowded, 256) - 1.0).abs() > bound);
}

#[test]
fn secondary_drops_are_those_of_the_words() {
    let (mut size, mut velocity, mut volume, mut bent) =
        (Worst::default(), Worst::default(), Worst::default(), Worst::default());
    for (normal, velocity_m_s, film) in [
        (Vec3::Y, Vec3::new(0.0, -9.0, 0.0), 0.0),
        (Vec3::Y, Vec3::new(3.0, -8.0, 1.0), 0.4),
        (Vec3::new(0.3, 0.9, -0.1).normalize(), Vec3::new(2.0, -8.0, 0.0), 0.2),
        (Vec3::NEG_X, Vec3::new(7.0, -4.0, 0.0), 0.0),
    ] {
        for diameter_mm in [1.0_f32, 2.7, 5.0] {
            let impact = Impact {
                diameter_mm,
                velocity_m_s,
                normal,
                film_mm: film,
            };
            let (n, v) = (normal.as_dvec3(), velocity_m_s.as_dvec3());
            let (t, b) = normal.any_orthonormal_pair();
            let (toward, along) = (-v.dot(n), v - n * v.dot(n));
            for seed in 0..60_u32 {
                let key = [seed, 3, seed.wrapping_mul(77_777)];
                let splash = Splash::new(&impact, key);
                let mut cubes = 0.0;
                for index in 0..splash.count {
                    let drop = secondary_drop(&impact, &splash, key, index);
                    let known = reference::thrown(key, index, splash.count);
                    cubes += known.size.powi(3);
                    let place = || format!("{index} of {splash:?} on {normal}");
                    size.relative(
                        f64::from(drop.diameter_mm) / f64::from(diameter_mm),
                        known.size,
                        1e-30,
                        place,
                    );
                    let turn = core::f64::consts::TAU * known.around;
                    let run = t.as_dvec3() * turn.cos() + b.as_dvec3() * turn.sin();
                    let thrown = toward * known.speed * (n * known.rise.sin() + run * known.rise.cos()) + 0.3 * along;
                    let expected = thrown.clamp_length_max(0.5 * v.length());
                    let off = (drop.velocity_m_s.as_dvec3() - expected).length() / v.length();
                    velocity.absolute(off, 0.0, place);
                    bent.absolute(
                        (1.05 * drop.velocity_m_s.as_dvec3() - expected).length() / v.length(),
                        0.0,
                        place,
                    );
                }
                let whole = core::f64::consts::PI / 6.0 * f64::from(diameter_mm).powi(3);
                volume.absolute(f64::from(splash.thrown_mm3) / whole, cubes, || format!("{splash:?}"));
                let sum = f64::from(splash.thrown_mm3) + f64::from(splash.retained_mm3);
                volume.absolute(sum / whole, 1.0, || format!("{splash:?}"));
                // Linear in the excess, the fraction by hash.
                let mean = 5.0 + 25.0 * ((f64::from(splash.excess) - 1.0) / 18.0).clamp(0.0, 1.0);
                let count = f64::from(splash.count);
                assert!(splash.count == 0 || (count - mean).abs() < 1.0 + 1e-5, "{splash:?}");
            }
        }
    }
    size.assert_below(2e-7, 5000);
    velocity.assert_below(1e-6, 5000);
    volume.assert_below(1e-6, 1000);
    assert!(bent.error > 0.02);
}

#[test]
fn counts_of_secondary_drops_have_the_stated_mean() {
    let n = 20_000_u32;
    for (d, film) in [(0.9_f32, 0.0), (1.7, 0.0), (2.0, 0.3)] {
        let splashes: Vec<Splash> = (0..n).map(|i| Splash::new(&falling(d, film), [i, 9, 4])).collect();
        let mean = 5.0 + 25.0 * ((f64::from(splashes[0].excess) - 1.0) / 18.0).min(1.0);
        let found = splashes.iter().map(|s| f64::from(s.count)).sum::<f64>() / f64::from(n);
        // Two neighbouring counts: five standard deviations.
        let sigma = (mean.fract() * (1.0 - mean.fract()) / f64::from(n)).sqrt();
        assert!((found - mean).abs() < 5.0 * sigma + 1e-6, "{d}: {found} {mean}");
        assert!(splashes.iter().all(|s| s.kind != SplashKind::Deposition));
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 256,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(15),
        ..ProptestConfig::default()
    })]

    #[test]
    fn no_splash_makes_water_or_speed(
        d in 0.0_f32..10.0, film in 0.0_f32..20.0, key in any::<[u32; 3]>(),
        v in [-20.0_f32..20.0, -20.0_f32..20.0, -20.0_f32..20.0], n in [-1.0_f32..1.0, -1.0_f32..1.0, -1.0_f32..1.0],
    ) {
        prop_assume!(Vec3::from(n).length() > 0.1);
        let impact = Impact { diameter_mm: d, velocity_m_s: v.into(), normal: n.into(), film_mm: film };
        let splash = Splash::new(&impact, key);
        let whole = core::f32::consts::PI / 6.0 * d * d * d;
        prop_assert!(splash.thrown_mm3 >= 0.0 && splash.retained_mm3 >= 0.0);
        prop_assert!((splash.thrown_mm3 + splash.retained_mm3 - whole).abs() <= 1e-6 * whole);
        prop_assert!(splash.count == 0 || (5..=30).contains(&splash.count));
        let normal = Vec3::from(n).normalize();
        for index in 0..splash.count {
            let drop = secondary_drop(&impact, &splash, key, index);
            let velocity = drop.velocity_m_s.as_dvec3();
            prop_assert!(velocity.length() <= 0.5 * impact.velocity_m_s.as_dvec3().length() * (1.0 + 1e-6));
            prop_assert!(velocity.dot(normal.as_dvec3()) > 0.0, "away from the ground");
            prop_assert!((0.05 * d * 0.999_999..=0.3 * d * 1.000_001).contains(&drop.diameter_mm));
        }
    }
}
