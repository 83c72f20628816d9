//! Every formula of a wheel against its twin, over the whole domain.

use proptest::prelude::*;
use rain_core::wheels::{
    SprayEmitter, SprayMechanism, Tyre, grip_share, horne_speed_km_h, hydroplanes, hydroplaning_speed_km_h,
    spray_droplet, spray_parcel_kg, spray_reach_m, spray_relative_speed_m_s, spray_relaxation_s, track_film_mm,
    wet_grip,
};
use rain_reference::fall_speed;
use rain_reference::wheels as reference;

use super::BAD;
use crate::check::Worst;

/// Tyres of every kind, with their grooves' void in mm.
fn tyres() -> impl Iterator<Item = (Tyre, f64)> {
    [(0.25, 8.0), (0.25, 1.6), (1.0, 50.0), (0.4, 0.5)]
        .into_iter()
        .flat_map(|(groove_share, tread_mm)| {
            [10.0, 165.0, 220.0, 2000.0].map(|pressure_kpa| {
                let tyre = Tyre {
                    groove_share,
                    tread_mm,
                    pressure_kpa,
                    ..Tyre::default()
                };
                (tyre, groove_share * tread_mm)
            })
        })
}

#[test]
fn hydroplaning_speed_is_the_root_of_its_square() {
    let (mut worst, mut bent) = (Worst::default(), Worst::default());
    for i in 0..=200 {
        let pressure = 10.0 * 200_f64.powf(f64::from(i) / 200.0);
        let expected = reference::horne(pressure);
        worst.relative(horne_speed_km_h(pressure), expected, 1e-30, || format!("{pressure}"));
        bent.relative(1.05 * horne_speed_km_h(pressure), expected, 1e-30, String::new);
        // Both ends of the domain count.
        if let Ok(checked) = hydroplaning_speed_km_h(pressure) {
            assert_eq!(checked, horne_speed_km_h(pressure));
        } else {
            assert!(i == 200, "{pressure}");
        }
    }
    worst.assert_below(1e-15, 201);
    assert!(bent.error > 0.04);
    for (bad, held) in [(f64::NAN, 10.0), (-1.0, 10.0), (1e300, 2000.0), (f64::INFINITY, 2000.0)] {
        assert_eq!(horne_speed_km_h(bad), horne_speed_km_h(held));
    }
}

#[test]
fn grip_is_one_smooth_step_in_speed_and_one_in_film() {
    let (mut share, mut grip, mut bent) = (Worst::default(), Worst::default(), Worst::default());
    for i in 0..=3000 {
        let ratio = 1e-3 * f64::from(i) * 1.5;
        for ratio in [ratio, -ratio, 100.0 * ratio] {
            share.absolute(grip_share(ratio), reference::grip(ratio), || format!("{ratio}"));
            bent.absolute(grip_share(1.05 * ratio), reference::grip(ratio), String::new);
        }
    }
    for (tyre, void) in tyres() {
        for i in 0..=40 {
            let film = 1.4 * void * f64::from(i) / 40.0;
            for v in [0.0, 8.0, 14.0, 18.0, 25.0, -25.0, 70.0, 200.0] {
                let expected = reference::wet_grip(v, tyre.pressure_kpa, film, void);
                grip.absolute(wet_grip(&tyre, v, film), expected, || {
                    format!("{v} m/s, {film} mm, {tyre:?}")
                });
            }
        }
    }
    share.assert_below(1e-15, 9000);
    grip.assert_below(2e-15, 5000);
    assert!(bent.error > 0.04);
    for bad in BAD {
        assert!((0.1 - 1e-15..=1.0).contains(&grip_share(bad)), "{bad}");
        for other in BAD {
            assert!(
                (0.1 - 1e-15..=1.0).contains(&wet_grip(&Tyre::default(), bad, other)),
                "{bad} {other}"
            );
        }
    }
    // Without grooves any water is deep.
    let slick = Tyre {
        groove_share: 0.0,
        ..Tyre::default()
    };
    assert_eq!(
        (wet_grip(&slick, 60.0, 0.0), wet_grip(&slick, 60.0, 1e-3)),
        (1.0, grip_share(60.0 * 3.6 / horne_speed_km_h(220.0)))
    );
    assert_eq!(
        (grip_share(f64::NAN), grip_share(f64::INFINITY)),
        (1.0, grip_share(2.0))
    );
}

#[test]
fn tyres_float_exactly_above_speed_and_void() {
    let mut cases = 0;
    for (tyre, void) in tyres() {
        let speed = reference::horne(tyre.pressure_kpa) / 3.6;
        for v in [0.0, 0.5, 0.999_999, 1.000_001, 2.0, 100.0] {
            for film in [0.0, 0.5, 0.999_999, 1.000_001, 3.0, 1e6] {
                for sign in [-1.0, 1.0] {
                    assert_eq!(
                        hydroplanes(&tyre, sign * v * speed, film * void),
                        v > 1.0 && film > 1.0,
                        "{v} {film} {tyre:?}"
                    );
                    cases += 1;
                }
            }
        }
        // On the border: at the speed it floats, on water that just fills the grooves it does not.
        assert!(!hydroplanes(&tyre, 10.0 * speed, tyre.groove_void_mm()));
        for bad in [f64::NAN, f64::NEG_INFINITY, -1.0] {
            assert!(!hydroplanes(&tyre, 10.0 * speed, bad));
        }
        assert!(!hydroplanes(&tyre, f64::NAN, 1e3));
        assert!(hydroplanes(&tyre, f64::INFINITY, f64::INFINITY) && hydroplanes(&tyre, f64::NEG_INFINITY, 1e3));
    }
    assert!(cases > 1000);
}

#[test]
fn mechanisms_throw_from_their_speeds_on() {
    let mut share = Worst::default();
    for (kind, mechanism) in SprayMechanism::ALL.into_iter().enumerate() {
        let (from, to) = reference::ONSET_KM_H[kind];
        assert_eq!(mechanism.diameters_mm(), reference::SPRAY_MM[kind]);
        assert_eq!(mechanism.onset_m_s(), (from / 3.6, to / 3.6));
        for i in -800..=800 {
            let v = 0.05 * f64::from(i);
            let expected = reference::smooth((v.abs() * 3.6 - from) / (to - from));
            share.absolute(mechanism.airborne_share(v), expected, || {
                format!("{mechanism:?} at {v} m/s")
            });
        }
        for bad in BAD {
            assert!((0.0..=1.0).contains(&mechanism.airborne_share(bad)), "{bad}");
        }
    }
    share.assert_below(1e-15, 6400);
    for (tyre, void) in tyres() {
        assert_eq!(tyre.groove_void_mm(), void);
        assert_eq!(tyre.carried_mm(), 0.1 * tyre.tread_mm);
    }
}

#[test]
fn droplets_are_those_described() {
    let (mut place, mut velocity, mut size, mut bent) =
        (Worst::default(), Worst::default(), Worst::default(), Worst::default());
    for (width_m, radius_m) in [(0.2, 0.31), (0.001, 0.01), (3.0, 3.0)] {
        let tyre = Tyre {
            width_m,
            radius_m,
            ..Tyre::default()
        };
        for (kind, mechanism) in SprayMechanism::ALL.into_iter().enumerate() {
            for speed in [-200.0_f32, -7.0, 0.0, 0.3, 20.0, 200.0] {
                for index in 0..120 {
                    let drop = spray_droplet(&tyre, mechanism, speed, 77, index);
                    let ([x, y, z, vx, vy, vz], diameter) =
                        reference::spray_drop(kind, width_m, radius_m, f64::from(speed), 77, index);
                    let at = || format!("{mechanism:?} {index} at {speed} m/s");
                    for (value, expected) in drop.place_m.to_array().into_iter().zip([x, y, z]) {
                        place.absolute(
                            f64::from(value) / (width_m + radius_m),
                            expected / (width_m + radius_m),
                            at,
                        );
                    }
                    let v = f64::from(speed.abs().max(1e-3));
                    for (value, expected) in drop.velocity_m_s.to_array().into_iter().zip([vx, vy, vz]) {
                        velocity.absolute(f64::from(value) / v, expected / v, at);
                        bent.absolute(1.05 * f64::from(value) / v, expected / v, at);
                    }
                    size.relative(f64::from(drop.diameter_mm), diameter, 1e-30, at);
                }
            }
        }
    }
    place.assert_below(3e-7, 20_000);
    velocity.assert_below(3e-7, 20_000);
    size.assert_below(1e-7, 8000);
    assert!(bent.error > 0.04);
    // Beyond the domain the speed is held.
    for (beyond, held) in [
        (1e30_f32, 200.0_f32),
        (f32::INFINITY, 200.0),
        (f32::NEG_INFINITY, -200.0),
        (f32::NAN, 0.0),
    ] {
        assert_eq!(
            spray_droplet(&Tyre::default(), SprayMechanism::Side, beyond, 1, 2),
            spray_droplet(&Tyre::default(), SprayMechanism::Side, held, 1, 2)
        );
    }
}

#[test]
fn air_slows_spray_over_the_whole_domain() {
    let (mut time, mut speed, mut way) = (Worst::default(), Worst::default(), Worst::default());
    for d in [0.05, 0.1, 0.5, 1.0, 3.0, 5.8, 100.0] {
        let v = fall_speed::fit(d);
        let length = v * v / 9.80665;
        for i in -40..=40 {
            let u = 10_f64.powf(0.1 * f64::from(i));
            let expected = v / 9.80665 * (v / u).min(1.0);
            time.relative(spray_relaxation_s(d, u), expected, 1e-30, || format!("{d} mm, {u} m/s"));
            assert_eq!(spray_relaxation_s(d, -u), spray_relaxation_s(d, u));
            for t in [0.0, 1e-6, 1e-3, 0.1, 3.0, 1e4, 1e9] {
                // 1/u grows by g t/v², and the way is that much of the logarithm.
                let slowed = 1.0 / (1.0 / u + t / length);
                let place = || format!("{d} mm, {u} m/s, {t} s");
                speed.relative(spray_relative_speed_m_s(d, u, t), slowed, 1e-30, place);
                if u * t > length {
                    way.relative(spray_reach_m(d, u, t), length * (u / slowed).ln(), 1e-30, place);
                }
            }
        }
    }
    time.assert_below(3e-15, 500);
    speed.assert_below(3e-15, 3000);
    way.assert_below(3e-15, 1000);
    for (bad, held) in [(f64::NAN, 0.05), (-1.0, 0.05), (0.0, 0.05), (1e300, 100.0)] {
        assert_eq!(spray_reach_m(bad, 10.0, 1.0), spray_reach_m(held, 10.0, 1.0));
        assert_eq!(spray_relaxation_s(bad, 10.0), spray_relaxation_s(held, 10.0));
    }
    assert_eq!((spray_reach_m(1.0, 0.0, 9.0), spray_reach_m(1.0, 9.0, 0.0)), (0.0, 0.0));
}

#[test]
fn tracks_close_as_integrated() {
    let mut worst = Worst::default();
    for (after, beside) in [(0.0, 1.0), (1.0, 0.0), (0.3, 1000.0), (2.0, 2.0), (5e-324, 3.0)] {
        for elapsed in [0.0, 1e-3, 0.3, 4.0, 40.0] {
            for closing in [0.5, 5.0, 1e9] {
                let expected = reference::closing_track(after, beside, elapsed, closing);
                let scale = f64::max(after, beside);
                worst.absolute(
                    track_film_mm(after, beside, elapsed, closing) / scale,
                    expected / scale,
                    || format!("{after} to {beside}, {elapsed} s of {closing}"),
                );
            }
        }
    }
    worst.assert_below(2e-13, 75);
    assert_eq!(track_film_mm(1.0, 2.0, 1e9, 5e-324), 2.0);
}

#[test]
fn parcels_share_out_what_is_alive() {
    let mut worst = Worst::default();
    for flow in [0.0, 1e-6, 3.0, 1e6] {
        for life in [0.0, 0.01, 0.8, 1e4] {
            for budget in [1_u32, 7, 2000, u32::MAX] {
                for least in [1e-12, 1e-6, 1e3] {
                    let parcel = spray_parcel_kg(flow, life, budget, least);
                    worst.relative(parcel, f64::max(flow * life / f64::from(budget), least), 1e-30, || {
                        format!("{flow} kg/s {life} s {budget}")
                    });
                    assert!(flow * life / parcel <= f64::from(budget) * (1.0 + 1e-15));
                }
            }
        }
    }
    worst.assert_below(1e-15, 190);
    assert_eq!(spray_parcel_kg(1.0, 1.0, 0, 1e-6), 1.0, "no budget is a budget of one");
    for bad in BAD {
        assert!((1e-12..=1e10).contains(&spray_parcel_kg(bad, bad, 1, bad)), "{bad}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 128,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(14),
        ..ProptestConfig::default()
    })]

    #[test]
    fn spray_never_speeds_up_and_never_turns(d in 0.01_f64..10.0, u in 0.0_f64..60.0, t in 0.0_f64..5.0, more in 0.0_f64..5.0) {
        let (now, later) = (spray_relative_speed_m_s(d, u, t), spray_relative_speed_m_s(d, u, t + more));
        prop_assert!((0.0..=u).contains(&now) && later <= now);
        let (near, far) = (spray_reach_m(d, u, t), spray_reach_m(d, u, t + more));
        prop_assert!(near <= far && far <= u * (t + more) * (1.0 + 1e-15));
        // A way cut in two is the same way.
        let rest = spray_reach_m(d, now, more);
        prop_assert!((near + rest - far).abs() <= 1e-12 * far.max(1e-9));
        prop_assert!(spray_relaxation_s(d, u + more) <= spray_relaxation_s(d, u));
    }

    #[test]
    fn parcels_and_rest_are_all_the_water(flows in prop::collection::vec((0.0_f64..20.0, 0.0_f64..0.1), 1..60), parcel in 1e-6_f64..1.0) {
        let mut emitter = SprayEmitter::default();
        let (mut met, mut thrown) = (0.0, 0.0);
        for (flow, dt) in flows {
            met += flow * dt;
            thrown += f64::from(emitter.advance(flow, dt, parcel)) * parcel;
            prop_assert!((0.0..=parcel * (1.0 + 1e-9)).contains(&emitter.pending_kg()));
        }
        prop_assert!((thrown + emitter.pending_kg() - met).abs() <= 1e-12 * met.max(parcel));
    }

    #[test]
    fn floating_begins_at_one_speed(pressure in 10.0_f64..2000.0, film in 0.0_f64..10.0, v in 0.0_f64..80.0, more in 1.0_f64..2.0) {
        let tyre = Tyre { pressure_kpa: pressure, ..Tyre::default() };
        // More speed and more water never put a tyre back on the road.
        prop_assert!(!hydroplanes(&tyre, v, film) || hydroplanes(&tyre, v * more, film * more));
        prop_assert!(grip_share(more * v / 30.0) <= grip_share(v / 30.0));
    }
}
