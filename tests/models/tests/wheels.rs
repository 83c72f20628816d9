//! Water thrown by wheels, hydroplaning.

mod bounds;

use glam::Vec3;
use proptest::prelude::*;
use rain_core::wheels::{
    GallawayCase, SprayEmitter, SprayMechanism, Tyre, WheelTrail, WheelWater, drops_per_kg, gallaway_speed_km_h,
    grip_share, horne_speed_km_h, hydroplanes, hydroplaning_speed_km_h, spray_droplet, spray_parcel_kg, spray_reach_m,
    spray_relative_speed_m_s, spray_relaxation_s, track_film_mm, wet_grip, wheel_on_film,
};
use rain_reference::wheels as reference;

use crate::check::Worst;

const BAD: [f64; 7] = [f64::NAN, f64::NEG_INFINITY, -1.0, 0.0, 5e-324, 1e300, f64::INFINITY];

#[test]
fn the_water_met_is_split_as_published() {
    for (film, met, adhesion, tread, rest) in [
        (0.05, 0.24955, 0.18716, 0.06239, 0.0),
        (0.5, 2.4955, 0.37433, 0.62388, 1.4973),
        (2.0, 9.982, 0.37433, 0.99820, 8.60947),
    ] {
        let water = WheelWater::new(&Tyre::default(), 25.0, film);
        for (value, published) in [
            (water.intercepted_kg_s, met),
            (water.adhesion_kg_s, adhesion),
            (water.tread_kg_s, tread),
            (water.bow_kg_s + water.side_kg_s, rest),
        ] {
            assert!(
                (value - published).abs() < 1.5e-5 * met.max(1.0),
                "{film} mm: {value} against {published}"
            );
        }
        assert!((water.bow_kg_s - 0.4 * (water.bow_kg_s + water.side_kg_s)).abs() < 1e-12);
    }
    // The thesis' example, with its 1000 kg/m³: 25 kg/s.
    let water = WheelWater::new(&Tyre::default(), 12.5, 10.0);
    assert!((water.intercepted_kg_s * 1000.0 / 998.2 - 25.0).abs() < 1e-12);
    assert_eq!(
        WheelWater::new(&Tyre::default(), 12.5, 0.0),
        WheelWater::default(),
        "a dry road gives nothing"
    );
}

#[test]
fn the_split_follows_its_definition() {
    let (mut worst, mut sum, mut bent) = (Worst::default(), Worst::default(), Worst::default());
    for width in [0.05, 0.2, 0.6] {
        for grooves in [0.0, 0.25, 1.0] {
            for tread in [0.0, 1.6, 8.0] {
                for film in [1e-6, 0.08, 0.3, 1.0, 10.0, 500.0] {
                    for speed in [0.1, 14.0, 60.0] {
                        let tyre = Tyre {
                            width_m: width,
                            groove_share: grooves,
                            tread_mm: tread,
                            ..Tyre::default()
                        };
                        let water = WheelWater::new(&tyre, speed, film);
                        let [met, adhesion, picked, rest] =
                            reference::wheel_split(speed, width, film, grooves, 0.1, 0.1 * tread);
                        let place = || format!("b {width}, K_t {grooves}, tread {tread}, W {film}, v {speed}");
                        for (value, expected) in [
                            (water.intercepted_kg_s, met),
                            (water.adhesion_kg_s, adhesion),
                            (water.tread_kg_s, picked),
                            (water.bow_kg_s + water.side_kg_s, rest),
                        ] {
                            worst.relative(value, expected, met, place);
                            bent.relative(value * 1.05, expected, met, place);
                        }
                        let parts: f64 = SprayMechanism::ALL.into_iter().map(|each| water.of(each)).sum();
                        sum.relative(parts, water.intercepted_kg_s, 1e-30, place);
                        assert_eq!(water, WheelWater::new(&tyre, -speed, film), "backwards is as forwards");
                    }
                }
            }
        }
    }
    worst.assert_below(1e-15, 600);
    sum.assert_below(1e-15, 150);
    assert!(bent.error > 0.04);
}

#[test]
fn hydroplaning_speeds_have_the_published_values() {
    let mut worst = Worst::default();
    for (pressure, speed) in [(180.0, 85.2), (220.0, 94.2), (250.0, 100.4), (700.0, 168.0)] {
        assert!((horne_speed_km_h(pressure) - speed).abs() < 0.06, "{pressure}");
        assert_eq!(hydroplaning_speed_km_h(pressure).ok(), Some(horne_speed_km_h(pressure)));
        worst.relative(
            horne_speed_km_h(pressure),
            reference::horne_from_knots(pressure),
            1.0,
            || format!("{pressure}"),
        );
    }
    worst.assert_below(1e-3, 4);
    for (pressure, tread, water, texture, speed) in [
        (220.0, 7.0, 3.0, 0.5, 87.73),
        (220.0, 2.0, 5.0, 0.5, 80.57),
        (165.0, 6.0, 2.5, 1.0, 84.22),
    ] {
        let case = GallawayCase {
            spin_down_percent: 10.0,
            pressure_kpa: pressure,
            tread_mm: tread,
            water_mm: water,
            texture_mm: texture,
        };
        assert!(
            (gallaway_speed_km_h(&case) - speed).abs() < 6e-3,
            "{}",
            gallaway_speed_km_h(&case)
        );
    }
}

#[test]
fn gallaway_follows_the_formula_in_its_own_units() {
    let (mut worst, mut bent) = (Worst::default(), Worst::default());
    for spin in [0.1, 10.0, 60.0] {
        for pressure in [100.0, 220.0, 900.0] {
            for tread in [0.0, 1.6, 8.0, 20.0] {
                for water in [0.1, 1.0, 5.0, 100.0] {
                    for texture in [0.0, 0.2, 1.0, 3.0] {
                        let case = GallawayCase {
                            spin_down_percent: spin,
                            pressure_kpa: pressure,
                            tread_mm: tread,
                            water_mm: water,
                            texture_mm: texture,
                        };
                        let psi = pressure / 6.894_757_293_168;
                        let mph = reference::gallaway_mph(spin, psi, tread / 25.4 * 32.0, water / 25.4, texture / 25.4);
                        let value = gallaway_speed_km_h(&case);
                        worst.relative(value, mph * 1.609344, 1.0, || format!("{case:?}"));
                        bent.relative(value * 1.05, mph * 1.609344, 1.0, String::new);
                    }
                }
            }
        }
    }
    worst.assert_below(1e-15, 500);
    assert!(bent.error > 0.04);
}

#[test]
fn a_tyre_floats_on_deep_water_at_speed_only() {
    let tyre = Tyre::default();
    assert_eq!(tyre.groove_void_mm(), 2.0);
    assert!(hydroplanes(&tyre, 30.0, 3.0) && hydroplanes(&tyre, -30.0, 3.0));
    assert!(!hydroplanes(&tyre, 30.0, 1.0) && !hydroplanes(&tyre, 20.0, 3.0));
    assert!(
        hydroplanes(&Tyre { tread_mm: 1.6, ..tyre }, 30.0, 1.0),
        "a worn one on less"
    );
    for (ratio, share) in [
        (0.0, 1.0),
        (0.6, 1.0),
        (0.85, 0.55),
        (1.1, 0.1),
        (9.0, 0.1),
        (-0.85, 0.55),
    ] {
        assert!((grip_share(ratio) - share).abs() < 1e-12, "{ratio}");
    }
    assert_eq!(wet_grip(&tyre, 30.0, 0.5), 1.0);
    assert!((wet_grip(&tyre, 60.0, 3.0) - 0.1).abs() < 1e-12);
    assert!(!hydroplanes(&tyre, f64::NAN, 3.0) && !hydroplanes(&tyre, 30.0, f64::NAN));
}

#[test]
fn what_is_met_is_thrown_pushed_aside_or_left() {
    let tyre = Tyre::default();
    let mut worst = Worst::default();
    for speed in [-40.0, -3.0, 1.0, 5.0, 12.0, 15.0, 17.0, 30.0, 90.0] {
        for film in [0.01, 0.5, 3.0, 40.0] {
            let water = WheelWater::new(&tyre, speed, film);
            let trail = WheelTrail::new(&tyre, speed, film);
            let sum = trail.thrown.intercepted_kg_s + trail.aside_kg_s + trail.left_kg_s;
            let place = || format!("{speed} m/s on {film} mm");
            worst.relative(sum, water.intercepted_kg_s, 1e-30, place);
            // W_after = W − (what left the track)/(ρ b v).
            let taken = trail.thrown.intercepted_kg_s + trail.aside_kg_s;
            let after = film - taken / (998.2 * 0.2 * speed.abs()) * 1e3;
            worst.absolute(trail.film_after_mm / film, after / film, place);
            assert!((0.0..=film).contains(&trail.film_after_mm));
        }
    }
    worst.assert_below(1e-15, 72);
    let slow = WheelTrail::new(&tyre, 2.0, 0.08);
    assert!(
        (slow.film_after_mm - 0.08).abs() < 1e-15 && slow.thrown == WheelWater::default(),
        "{slow:?}"
    );
    let fast = WheelTrail::new(&tyre, 25.0, 3.0);
    assert_eq!((fast.film_after_mm, fast.aside_kg_s), (0.0, 0.0));
    assert_eq!(
        WheelTrail::new(&tyre, 0.0, 3.0).film_after_mm,
        3.0,
        "a wheel at rest leaves the film"
    );
    // Spray starts at 48 to 64 km/h, splash earlier.
    for (km_h, spray, splash) in [
        (9.0, 0.0, 0.0),
        (30.0, 0.0, 1.0),
        (48.0, 0.0, 1.0),
        (56.0, 0.5, 1.0),
        (64.0, 1.0, 1.0),
    ] {
        assert!(
            (SprayMechanism::Adhesion.airborne_share(km_h / 3.6) - spray).abs() < 1e-12,
            "{km_h}"
        );
        assert!(
            (SprayMechanism::Side.airborne_share(-km_h / 3.6) - splash).abs() < 1e-12,
            "{km_h}"
        );
    }
}

#[test]
fn spray_leaves_along_the_rim_and_to_the_sides() {
    let tyre = Tyre::default();
    for mechanism in SprayMechanism::ALL {
        let (least, most) = mechanism.diameters_mm();
        let mut mean = Vec3::ZERO;
        for index in 0..2000 {
            let drop = spray_droplet(&tyre, mechanism, 20.0, 3, index);
            assert_eq!(drop, spray_droplet(&tyre, mechanism, 20.0, 3, index), "no hidden state");
            assert!((least as f32..=most as f32 * 1.000_001).contains(&drop.diameter_mm));
            assert!(drop.place_m.x.abs() <= 0.1 && drop.place_m.y >= 0.0 && drop.place_m.z <= 0.0);
            assert!(drop.velocity_m_s.y > 0.0);
            let v = drop.velocity_m_s;
            match mechanism {
                SprayMechanism::Adhesion | SprayMechanism::Tread => {
                    let angle = f64::from((-drop.place_m.z).atan2(0.31 - drop.place_m.y));
                    let [forwards, up] = reference::rim_velocity(0.31, 20.0, angle);
                    assert!((f64::from(v.z) - forwards).abs() < 1e-3 && (f64::from(v.y) - up).abs() < 1e-3);
                    let range = if mechanism == SprayMechanism::Tread {
                        4.9..30.1
                    } else {
                        19.9..100.1
                    };
                    assert!(range.contains(&angle.to_degrees()), "{}", angle.to_degrees());
                }
                SprayMechanism::Bow | SprayMechanism::Side => {
                    let turn = v.x.abs().atan2(v.z).to_degrees();
                    let range = if mechanism == SprayMechanism::Bow {
                        19.9..40.1
                    } else {
                        39.9..60.1
                    };
                    assert!(range.contains(&turn), "{turn}");
                    assert!((9.99..=20.01).contains(&v.length()));
                    assert!(v.x * drop.place_m.x > 0.0, "outwards");
                }
            }
            let back = spray_droplet(&tyre, mechanism, -20.0, 3, index);
            assert_eq!(
                back.velocity_m_s,
                v * Vec3::new(1.0, 1.0, -1.0),
                "backwards it is mirrored"
            );
            mean += v;
        }
        assert!((mean.x / 2000.0).abs() < 0.6, "both sides alike: {mean}");
    }
    for bad in BAD {
        for mechanism in SprayMechanism::ALL {
            let drop = spray_droplet(&tyre, mechanism, bad as f32, 1, 1);
            assert!(drop.velocity_m_s.is_finite() && drop.place_m.is_finite());
        }
    }
    assert_eq!(
        spray_droplet(&tyre, SprayMechanism::Bow, f32::NAN, 1, 1).velocity_m_s,
        Vec3::ZERO
    );
}

#[test]
fn drops_of_a_kilogram_are_counted() {
    let mut worst = Worst::default();
    for mechanism in SprayMechanism::ALL {
        let (from, to) = mechanism.diameters_mm();
        worst.relative(drops_per_kg(mechanism), reference::drops_per_kg(from, to), 1.0, || {
            format!("{mechanism:?}")
        });
    }
    worst.assert_below(1e-13, 4);
}

#[test]
fn emitters_keep_the_mass_at_any_step_and_the_budget() {
    let parcel = spray_parcel_kg(3.0, 0.8, 2000, 1e-9);
    assert!((parcel - 3.0 * 0.8 / 2000.0).abs() < 1e-15);
    assert_eq!(
        spray_parcel_kg(1e-9, 1.0, 2000, 1e-6),
        1e-6,
        "no smaller than the least"
    );
    let run = |steps: u32| {
        let mut emitter = SprayEmitter::default();
        let count: u64 = (0..steps)
            .map(|_| u64::from(emitter.advance(3.0, 2.0 / f64::from(steps), parcel)))
            .sum();
        (count, count as f64 * parcel + emitter.pending_kg())
    };
    for steps in [1, 7, 60, 480] {
        let (count, mass) = run(steps);
        assert!((mass - 6.0).abs() < 1e-12, "{mass}");
        assert!(count.abs_diff(run(1).0) <= 1);
        assert!(count as f64 * 0.8 / 2.0 <= 2000.0, "alive at once");
    }
    let mut emitter = SprayEmitter::default();
    for bad in BAD {
        assert_eq!(emitter.advance(1.0, 1e-3, bad.min(0.0)), 0);
        emitter.advance(bad, bad, 1.0);
        assert!(emitter.pending_kg().is_finite() && emitter.pending_kg() >= 0.0);
        assert!(spray_parcel_kg(bad, bad, 0, bad).is_finite());
    }
    assert!(emitter.take() >= 0.0 && emitter.pending_kg() == 0.0);
}

#[test]
fn air_slows_spray_by_quadratic_drag() {
    let (mut speed, mut way) = (Worst::default(), Worst::default());
    for d in [0.1, 0.5, 1.0, 3.0] {
        let terminal = rain_core::rainfall::terminal_velocity(d);
        for start in [1.0, 10.0, 30.0] {
            for time in [0.0, 0.01, 0.3, 2.0] {
                let [x, u] = reference::slowed(start, terminal, time);
                let place = || format!("{d} mm, {start} m/s, {time} s");
                speed.relative(spray_relative_speed_m_s(d, start, time), u, 1e-9, place);
                way.relative(spray_reach_m(d, start, time), x, 1e-9, place);
            }
        }
        assert!((spray_relaxation_s(d, terminal) - terminal / 9.80665).abs() < 1e-12);
        let fast = spray_relaxation_s(d, -10.0 * terminal);
        assert!(
            (fast * 10.0 * 9.80665 / terminal - 1.0).abs() < 1e-12,
            "ten times as fast, a tenth of the time"
        );
    }
    speed.assert_below(1e-13, 48);
    way.assert_below(1e-13, 48);
    for a in BAD {
        for b in BAD {
            for value in [
                spray_relaxation_s(a, b),
                spray_relative_speed_m_s(a, b, b),
                spray_reach_m(a, b, a),
            ] {
                assert!(value.is_finite() && value >= 0.0, "{a} {b} {value}");
            }
        }
    }
}

#[test]
fn tracks_close_without_overshoot() {
    assert!((track_film_mm(0.0, 1.0, 5.0, 5.0) - (1.0 - (-1.0_f64).exp())).abs() < 1e-15);
    assert_eq!(track_film_mm(0.3, 1.0, 0.0, 0.0), 0.3);
    assert_eq!(track_film_mm(0.3, 1.0, 1.0, 0.0), 1.0);
    for a in BAD {
        for b in BAD {
            assert!((0.0..=1000.0).contains(&track_film_mm(a, b, a, b)), "{a} {b}");
        }
    }
}

#[test]
fn the_calculator_agrees_and_refuses_bad_input() {
    let report = wheel_on_film(Tyre::default(), 90.0, 2.5).expect("valid");
    assert_eq!(report.water, WheelWater::new(&Tyre::default(), 25.0, 2.5));
    assert_eq!(report.trail, WheelTrail::new(&Tyre::default(), 25.0, 2.5));
    assert!(!report.hydroplaning && (report.hydroplaning_speed_km_h - 94.185).abs() < 1e-2);
    assert!(wheel_on_film(Tyre::default(), -120.0, 2.5).expect("valid").hydroplaning);
    let tyre = Tyre::default();
    for (tyre, speed, film, field) in [
        (tyre, f64::NAN, 1.0, "speed_km_h is NaN"),
        (tyre, 1.0, -1.0, "film_mm is -1"),
        (tyre, 1.0, f64::INFINITY, "film_mm is inf"),
        (Tyre { width_m: 0.0, ..tyre }, 1.0, 1.0, "width_m is 0"),
        (Tyre { tread_mm: -1.0, ..tyre }, 1.0, 1.0, "tread_mm is -1"),
        (
            Tyre {
                groove_share: 1.5,
                ..tyre
            },
            1.0,
            1.0,
            "groove_share is 1.5",
        ),
        (
            Tyre {
                pressure_kpa: f64::NAN,
                ..tyre
            },
            1.0,
            1.0,
            "pressure_kpa is NaN",
        ),
    ] {
        let error = wheel_on_film(tyre, speed, film).expect_err("refused");
        assert!(error.to_string().starts_with(field), "{error}");
    }
    for bad in [f64::NAN, 0.0, -1.0, 1e9] {
        assert!(hydroplaning_speed_km_h(bad).is_err());
        assert!(horne_speed_km_h(bad).is_finite());
    }
    for a in BAD {
        for b in BAD {
            let (water, trail) = (WheelWater::new(&tyre, a, b), WheelTrail::new(&tyre, a, b));
            assert!(water.intercepted_kg_s.is_finite() && water.side_kg_s >= 0.0, "{a} {b}");
            assert!(trail.film_after_mm.is_finite() && trail.left_kg_s >= 0.0, "{a} {b}");
            assert!((0.1 - 1e-12..=1.0).contains(&wet_grip(&tyre, a, b)), "{a} {b}");
            let case = GallawayCase {
                spin_down_percent: a,
                pressure_kpa: b,
                tread_mm: a,
                water_mm: b,
                texture_mm: a,
            };
            assert!(gallaway_speed_km_h(&case).is_finite() && gallaway_speed_km_h(&case) > 0.0);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 128,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(13),
        ..ProptestConfig::default()
    })]

    #[test]
    fn more_film_and_speed_never_mean_less_water(
        speed in 0.0_f64..80.0,
        film in 0.0_f64..50.0,
        more in 1.0_f64..3.0,
        tread in 0.0_f64..10.0,
    ) {
        let tyre = Tyre { tread_mm: tread, ..Tyre::default() };
        let base = WheelWater::new(&tyre, speed, film);
        for richer in [WheelWater::new(&tyre, speed * more, film), WheelWater::new(&tyre, speed, film * more)] {
            for mechanism in SprayMechanism::ALL {
                prop_assert!(richer.of(mechanism) >= base.of(mechanism) - 1e-13 * richer.intercepted_kg_s);
            }
        }
    }

    #[test]
    fn grip_falls_with_speed_and_film(speed in 0.0_f64..60.0, film in 0.0_f64..8.0, more in 1.0_f64..2.0) {
        let tyre = Tyre::default();
        let grip = wet_grip(&tyre, speed, film);
        prop_assert!((0.1 - 1e-12..=1.0).contains(&grip));
        prop_assert!(wet_grip(&tyre, speed * more, film) <= grip + 1e-15);
        prop_assert!(wet_grip(&tyre, speed, film * more) <= grip + 1e-15);
    }

    #[test]
    fn deeper_water_floats_a_tyre_earlier(water in 0.1_f64..50.0, more in 1.0_f64..3.0, texture in 0.0_f64..3.0) {
        let at = |water_mm: f64, pressure_kpa: f64| gallaway_speed_km_h(&GallawayCase {
            spin_down_percent: 10.0, pressure_kpa, tread_mm: 5.0, water_mm, texture_mm: texture,
        });
        prop_assert!(at(water * more, 220.0) <= at(water, 220.0) + 1e-9);
        prop_assert!(at(water, 220.0 * more) >= at(water, 220.0));
        prop_assert!(horne_speed_km_h(100.0 * more) >= horne_speed_km_h(100.0));
    }

    #[test]
    fn closing_composes(after in 0.0_f64..5.0, beside in 0.0_f64..5.0, a in 0.0_f64..10.0, b in 0.0_f64..10.0) {
        let once = track_film_mm(after, beside, a + b, 4.0);
        let twice = track_film_mm(track_film_mm(after, beside, a, 4.0), beside, b, 4.0);
        prop_assert!((once - twice).abs() < 1e-13);
    }
}
