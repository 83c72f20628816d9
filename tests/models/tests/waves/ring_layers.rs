//! Procedural rings: the source's formulas, clocks and layers; their number and roughness under rain.

use proptest::prelude::*;
use rain_core::rainfall::{Distribution, DropSizes, Spectrum, terminal_velocity};
use rain_core::waves::{
    CircleSettings, RING_CYCLES, RING_FADE, RingForcing, RingGrowth, RingIntensity, RingLayerSettings, RingLayers,
    rain_slope_variance, ring_clocks, ring_layer_weights, ring_presence_f32, ring_profile_f32, slope_variance,
};
use rain_reference::waves as truth;

use super::super::check::Worst;
use super::cases;

fn rain(intensity_mm_h: f64) -> DropSizes {
    Spectrum::new(Distribution::MarshallPalmer, intensity_mm_h)
        .unwrap()
        .into()
}

fn layers(settings: &RingLayerSettings) -> RingLayers {
    RingLayers::new(settings).expect("within its domain")
}

#[test]
fn a_ring_has_the_sources_profile() {
    // R, p, ω: the slope over the steepness.
    for (nearness, phase, weight, expected) in [
        (0.5, 0.6, 1.0, 0.0618),
        (1.0, 1.0 / 18.0, 1.0, 17.0 / 18.0),
        (0.9, 0.3, 0.4, -0.1164),
        (0.0, 0.4, 1.0, 0.0),
    ] {
        let value = ring_profile_f32(nearness, phase, weight);
        assert!((value - expected).abs() < 2e-4, "{value}, not {expected}");
    }
    let mut worst = Worst::default();
    for index in 0..30_000_u32 {
        let [a, b, c] = rain_core::hash::pcg3d([index, 3, 4]).map(rain_core::hash::unit_f32);
        let exact = truth::ring_of_a_circle(a.into(), b.into(), c.into());
        worst.absolute(f64::from(ring_profile_f32(a, b, c)), exact, || format!("{a} {b} {c}"));
    }
    worst.assert_below(3e-6, 30_000);
    let wrong = truth::ring_of_a_circle(0.8, 0.27, 0.7) - truth::ring_of_a_circle(0.8, 0.27 * 1.05, 0.7);
    assert!(wrong.abs() > 1e-2, "{wrong}");
    // The front runs a radius in a cycle, and the ring is a third of a radius wide.
    for phase in [0.4_f32, 0.6, 0.8] {
        // Beside the wave the sine of 3π is left, which is no number in single precision: 9e-8.
        let lit = |distance: f32| ring_profile_f32(1.0 - distance, phase, 1.0).abs() > 1e-6;
        assert!(!lit(phase + 0.001) && lit(phase - 0.01) && lit(phase - 0.32) && !lit(phase - 0.335));
    }
}

#[test]
fn clocks_are_the_sources_and_never_jump() {
    let mut worst = Worst::default();
    for i in 0..2000 {
        let time = 0.0317 * f64::from(i);
        let (parts, _) = ring_clocks(time, 1.6);
        for (part, exact) in parts.into_iter().zip(truth::ring_times(time)) {
            // Around the circle: 0 is next to 1.
            let apart = (part - exact + 0.5).rem_euclid(1.0) - 0.5;
            worst.absolute(apart, 0.0, || format!("{time} s"));
        }
    }
    worst.assert_below(1e-12, 8000);
    // Part and whole cycles go on over the end of the common period, 62.5 s, and after thirty years.
    for (start, step, bound) in [(62.4, 1e-3, 1e-9), (1e9 - 0.1, 1e-3, 1e-6)] {
        let turns = |time: f64| {
            let (parts, wholes) = ring_clocks(time, 1.6);
            [0, 1, 2, 3].map(|k| f64::from(wholes[k]) + parts[k])
        };
        for i in 0..200 {
            let time = start + step * f64::from(i);
            let (before, after) = (turns(time), turns(time + step));
            for (k, rate) in [1.0, 0.85, 0.93, 1.13].into_iter().enumerate() {
                let advance = (after[k] - before[k]).rem_euclid(f64::from(RING_CYCLES[k]));
                assert!(
                    (advance - 1.6 * rate * step).abs() < bound,
                    "layer {k} at {time} s: {advance}"
                );
            }
        }
    }
    for bad in [f64::NAN, f64::NEG_INFINITY, -1.0, f64::INFINITY] {
        for (time, frequency) in [(bad, 1.6), (10.0, bad)] {
            let (parts, wholes) = ring_clocks(time, frequency);
            assert!(parts.iter().all(|p| (0.0..1.0).contains(p)), "{time} {frequency}");
            assert!(wholes.iter().zip(RING_CYCLES).all(|(w, most)| *w < most));
        }
    }
}

#[test]
fn intensity_brings_layers_in_by_quarters() {
    for (intensity, expected) in [
        (0.0, [0.0; 4]),
        (0.3, [1.0, 0.2, 0.0, 0.0]),
        (0.33, [1.0, 0.32, 0.0, 0.0]),
        (0.6, [1.0, 1.0, 0.4, 0.0]),
        (0.66, [1.0, 1.0, 0.64, 0.0]),
        (1.0, [1.0; 4]),
        (f64::NAN, [0.0; 4]),
        (7.0, [1.0; 4]),
        (-1.0, [0.0; 4]),
    ] {
        for (weight, expected) in ring_layer_weights(intensity).into_iter().zip(expected) {
            assert!(
                (weight - expected).abs() < 1e-12,
                "{intensity}: {weight}, not {expected}"
            );
        }
    }
    // Chances below the weight have their ring, with a soft edge.
    assert_eq!((ring_presence_f32(0.3, 0.5), ring_presence_f32(0.6, 0.5)), (1.0, 0.0));
    assert_eq!((ring_presence_f32(0.999, 1.0), ring_presence_f32(0.0, 0.0)), (1.0, 0.0));
    let edge = ring_presence_f32(0.5, 0.5);
    assert!((edge - 0.5).abs() < 1e-5, "{edge}");
    let mut worst = Worst::default();
    for i in 0..=1000_u16 {
        for j in 0..=100_u16 {
            let (chance, weight) = (f32::from(i) / 1000.0, f32::from(j) / 100.0);
            let fade = f64::from(RING_FADE);
            let exact = ((f64::from(weight) * (1.0 + fade) - f64::from(chance)) / fade).clamp(0.0, 1.0);
            worst.absolute(f64::from(ring_presence_f32(chance, weight)), exact, || {
                format!("{chance} {weight}")
            });
        }
    }
    worst.assert_below(3e-6, 101_101);
    for weight in [0.0_f32, 0.02, 0.1, 0.5, 0.93, 1.0] {
        let count = 20_000_u16;
        let present = |i: u16| f64::from(ring_presence_f32((f32::from(i) + 0.5) / f32::from(count), weight));
        let mean = (0..count).map(present).sum::<f64>() / f64::from(count);
        assert!((mean - f64::from(weight)).abs() < 0.055, "{weight}: {mean}");
    }
}

#[test]
fn the_composed_slope_is_the_sources_normal() {
    let settings = RingLayerSettings::lagarde();
    let rings = layers(&settings);
    let circles = rings.circles().clone();
    let texture = |u: f64, v: f64| {
        let [x, z] = [u, v].map(|at| (at.rem_euclid(1.0) * 256.0) as u32);
        let point = circles.at(x, z);
        let [x, z] = point.outward.map(f64::from);
        [f64::from(point.nearness), x, z, f64::from(point.offset) / 65536.0]
    };
    for (intensity, time) in [(0.3, 7.3), (0.6, 1000.0), (1.0, 31.7)] {
        let (mut worst, mut steepest) = (Worst::default(), 0.0_f64);
        let state = rings.state(time, intensity, 1.0);
        for (row, column) in (0..256)
            .step_by(3)
            .flat_map(|row| (0..256).map(move |column| (row, column)))
        {
            // −0.55 of 256 texels is not a whole number of them: the source's offsets go to the nearest texel.
            let [u, v] = [column, row].map(|cell| (f64::from(cell) + 0.5) / 256.0);
            let round = |at: f64| (at * 256.0 - 0.5).round() / 256.0 + 0.5 / 256.0;
            let [x, z] = truth::ring_layers_normal(
                |u, v| texture(round(u), round(v)),
                [u, v],
                truth::ring_times(time),
                intensity,
            );
            let slope = rings.slope(&state, column, row).map(f64::from);
            worst.absolute(slope[0], -x, || format!("{column}, {row}"));
            worst.absolute(slope[1], -z, || format!("{column}, {row}"));
            steepest = steepest.max(x.hypot(z));
        }
        worst.assert_below(5e-6, 40_000);
        assert!(steepest > 0.1 && steepest < 1.33, "{steepest}");
        // Another time is told apart.
        let other = rings.state(time + 0.05, intensity, 1.0);
        let moved = (0..256).map(|c| (rings.slope(&state, c, 80)[0] - rings.slope(&other, c, 80)[0]).abs());
        assert!(moved.fold(0.0, f32::max) > 0.01);
    }
}

#[test]
fn whole_numbers_of_textures_tile() {
    for repeats in [1, 2, 3, 5] {
        let rings = layers(&RingLayerSettings {
            repeats,
            ..Default::default()
        });
        let state = rings.state(3.21, 1.0, 1.0);
        let mut steepest = 0.0_f32;
        for cell in 0..256 {
            for (a, b) in [
                (rings.slope(&state, cell, 17), rings.slope(&state, cell + 256, 17)),
                (rings.slope(&state, 40, cell), rings.slope(&state, 40, cell + 256)),
            ] {
                assert_eq!(a, b, "{repeats} times, cell {cell}");
                steepest = steepest.max(a[0].abs());
            }
        }
        assert!(steepest > 0.05, "{steepest}");
        if repeats == 2 {
            assert_eq!(
                rings.slope(&state, 7, 9),
                rings.slope(&state, 135, 137),
                "half a side on"
            );
        } else if repeats == 1 {
            assert_ne!(rings.slope(&state, 7, 9), rings.slope(&state, 135, 137));
        }
    }
}

#[test]
fn chance_decides_anew_which_circles_have_a_ring() {
    let rings = layers(&RingLayerSettings::default());
    let frequency = rings.settings().frequency_hz;
    // The first layer alone, half of its circles, at the same part of two cycles: other rings.
    let lit = |cycle: f64| -> Vec<bool> {
        let state = rings.state((20.0 + cycle) / frequency, 0.125, 1.0);
        (0..256 * 256)
            .map(|i| rings.slope(&state, i % 256, i / 256) != [0.0; 2])
            .collect()
    };
    let (first, second, whole) = (lit(0.0), lit(1.0), lit(100.0));
    let count = |a: &[bool]| a.iter().filter(|lit| **lit).count();
    let both = first.iter().zip(&second).filter(|(a, b)| **a && **b).count();
    assert!(count(&first) > 3000 && count(&second) > 3000);
    assert!(both < 3 * count(&first) / 4, "{both} of {}", count(&first));
    assert_eq!(first, whole, "a common period on they are the same");
    // In the source's way every circle has one in each cycle.
    let strong = layers(&RingLayerSettings {
        growth: RingGrowth::Strength,
        ..Default::default()
    });
    let state = |cycle: f64| strong.state((20.0 + cycle) / frequency, 0.125, 1.0);
    for i in 0..256 {
        let (a, b) = (strong.slope(&state(0.0), i, 99)[0], strong.slope(&state(1.0), i, 99)[0]);
        assert!((a - b).abs() < 1e-4, "{i}: {a} {b}");
    }
}

#[test]
fn rings_are_as_many_as_large_drops_until_all_circles_are_in_use() {
    let rings = layers(&RingLayerSettings::default());
    let most = rings.rings_per_m2_s(1.0);
    assert!((200.0..800.0).contains(&most), "{most}");
    let mut last = 0.0;
    for intensity in [0.5, 3.0, 8.0, 15.0] {
        let drops = rain(intensity).flux_moment(0, 2.0, 8.0, terminal_velocity);
        let forcing = rings.forcing(&rain(intensity));
        let found = rings.rings_per_m2_s(forcing.intensity);
        assert!(
            forcing.gain == 1.0 && (found / drops - 1.0).abs() < 1e-9,
            "{intensity} mm/h: {found}, not {drops}"
        );
        assert!(found > 2.0 * last);
        last = found;
    }
    let heavy = rings.forcing(&rain(100.0));
    assert!(
        heavy.intensity == 1.0 && heavy.gain > 1.5 && heavy.gain <= 2.0,
        "{heavy:?}"
    );
    assert_eq!(rings.forcing(&rain(0.0)), RingForcing::default(), "flat without rain");
    assert_eq!((rings.intensity_of(f64::NAN), rings.intensity_of(1e9)), (0.0, 1.0));
    let rows = layers(&RingLayerSettings::lagarde());
    for (rate, expected) in [(2.0, 0.33), (5.0, 0.66), (10.0, 1.0), (50.0, 1.0)] {
        let forcing = rows.forcing(&rain(rate));
        assert!((forcing.intensity - expected).abs() < 1e-3, "{forcing:?}");
        assert!(forcing.gain == 1.0 && forcing.hidden_variance == 0.0);
    }
    let fixed = layers(&RingLayerSettings {
        intensity: RingIntensity::Fixed(0.7),
        ..Default::default()
    });
    assert_eq!(
        (fixed.forcing(&rain(1.0)).intensity, fixed.forcing(&rain(0.0)).intensity),
        (0.7, 0.0)
    );
}

/// Mean square slope over the map and many moments.
fn mean_square(rings: &RingLayers, intensity: f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for moment in 0..40 {
        let state = rings.state(1.37 * f64::from(moment), intensity, 1.0);
        for i in 0..128 * 128 {
            let [x, z] = rings.slope(&state, 2 * (i % 128), 2 * (i / 128)).map(f64::from);
            sum += x * x + z * z;
            count += 1.0;
        }
    }
    sum / count
}

#[test]
fn drawn_and_hidden_rings_are_as_rough_as_the_rain_makes_the_water() {
    for growth in [RingGrowth::Number, RingGrowth::Strength] {
        let rings = layers(&RingLayerSettings {
            growth,
            ..Default::default()
        });
        for intensity in [0.1, 0.4, 1.0] {
            let ratio = rings.drawn_slope_variance(intensity, 1.0) / mean_square(&rings, intensity);
            eprintln!("{growth:?}, {intensity}: {ratio:.3} of the mean square");
            assert!((ratio - 1.0).abs() < 0.05, "{growth:?}, {intensity}: {ratio}");
        }
    }
    let rings = layers(&RingLayerSettings::default());
    for rate in [1.0, 3.0, 15.0, 50.0] {
        let forcing = rings.forcing(&rain(rate));
        let drawn = rings.drawn_slope_variance(forcing.intensity, forcing.gain);
        let all = rain_slope_variance(&rain(rate), 0.005, 0.6, 0.0);
        eprintln!(
            "{rate} mm/h: ⟨s²⟩ {all:.2e}, drawn {:.3} of it, {forcing:?}",
            drawn / all
        );
        assert!(drawn > 0.0 && drawn < all);
        assert!(((drawn + forcing.hidden_variance) / all - 1.0).abs() < 1e-9);
        let spectrum = Spectrum::new(Distribution::MarshallPalmer, rate).unwrap();
        let sum = slope_variance(&spectrum, 0.005, 0.6, 0.0);
        assert!((all / sum - 1.0).abs() < 2e-3, "{all} {sum}");
    }
    assert_eq!(rain_slope_variance(&rain(0.0), 0.005, 0.6, 0.0), 0.0);
}

#[test]
fn ring_settings_outside_their_domain_are_refused() {
    type Change = fn(&mut RingLayerSettings);
    let bad: [(Change, &str); 12] = [
        (|s| s.cells = 100, "cells"),
        (|s| s.side_m = 0.0, "side_m"),
        (|s| s.side_m = f64::NAN, "side_m"),
        (|s| s.repeats = 0, "repeats"),
        (|s| s.repeats = 17, "repeats"),
        (|s| s.frequency_hz = 0.0, "frequency_hz"),
        (|s| s.steepness = 1.1, "steepness"),
        (|s| s.intensity = RingIntensity::Fixed(f64::NAN), "intensity"),
        (|s| s.least_drop_mm = 0.0, "least_drop_mm"),
        (|s| s.depth_m = 0.0, "depth_m"),
        (|s| s.damping_per_s = f64::INFINITY, "damping_per_s"),
        (|s| s.circles.texels = 3, "texels"),
    ];
    for (change, field) in bad {
        let mut settings = RingLayerSettings::default();
        change(&mut settings);
        let message = RingLayers::new(&settings).expect_err(field).to_string();
        assert!(message.starts_with(field), "{message}");
    }
}

proptest! {
    #![proptest_config(cases(24))]

    #[test]
    fn any_valid_rings_are_finite_and_bounded(
        seed: u32,
        distortion in 0.0_f64..=0.5,
        repeats in 1_u32..=16,
        time in 0.0_f64..1e9,
        intensity in 0.0_f64..=1.0,
    ) {
        let rings = layers(&RingLayerSettings {
            circles: CircleSettings { texels: 64, least_radius: 0.06, largest_radius: 0.2, distortion, seed },
            cells: 64,
            repeats,
            ..Default::default()
        });
        let state = rings.state(time, intensity, 2.0);
        for i in 0..64 * 64 {
            let [x, z] = rings.slope(&state, i % 64, i / 64);
            prop_assert!(x.hypot(z) <= 4.0 * 0.7 * 1.001, "{x} {z}");
        }
    }
}
