//! Impacts on glass, drops that sit, wipers: against their twins.

use core::f64::consts::PI;

use glam::DVec3;
use rain_core::constants::GRAVITY;
use rain_core::lens::{
    GlassImpacts, LEAST_DROP_MM, RunningForce, WiperArm, WiperMode, Wipers, air_push_n, cap_radius_m, cap_view,
    cap_volume_m3, radius_after_drying_m, retention_n, running_speed_m_s,
};
use rain_core::rainfall::{Distribution, Spectrum};
use rain_core::splash::ImpactFlux;
use rain_reference::lens as reference;

use crate::check::Worst;

fn rain(rate: f64) -> Spectrum {
    Spectrum::new(Distribution::MarshallPalmer, rate).expect("a rain rate")
}

/// Normals: up, a windscreen, upright, down.
fn normals() -> [DVec3; 4] {
    [0.0_f64, 60.0, 90.0, 180.0].map(|tilt| DVec3::new(0.0, tilt.to_radians().cos(), -tilt.to_radians().sin()))
}

#[test]
fn impacts_on_glass_are_the_sum_over_drops_and_gusts() {
    let (mut number, mut water, mut size, mut covered) =
        (Worst::default(), Worst::default(), Worst::default(), Worst::default());
    let mut bent = Worst::default();
    for rate in [1.0, 25.0, 100.0] {
        let spectrum = rain(rate);
        for normal in normals() {
            for (air, gust) in [(0.0, 1.0), (8.0, 0.0), (28.0, 1.5), (-5.0, 2.0)] {
                // The glass drives along −z: the air comes along +z.
                let air = DVec3::new(0.0, 0.0, air);
                let found = GlassImpacts::new(&spectrum, normal, air, gust);
                let sum = |ends, weight: fn(f64) -> f64| {
                    let (n0, slope) = (spectrum.n0_per_m3_mm, spectrum.slope_per_mm);
                    reference::impacts(n0, slope, normal.y, -air.dot(normal), gust, ends, weight)
                };
                let place = || format!("{rate} mm/h, {normal}, {air}, {gust}");
                let all = sum([LEAST_DROP_MM, 6.0], |_| 1.0);
                number.relative(found.number_per_m2_s, all, 1e-3, place);
                bent.relative(1.05 * found.number_per_m2_s, all, 1e-3, place);
                let cubes = sum([LEAST_DROP_MM, 6.0], |d| PI / 6.0 * d * d * d * 1e-9);
                water.relative(found.water_m_s, cubes, 1e-12, place);
                if all < 1.0 {
                    continue;
                }
                for share in [0.1, 0.5, 0.9, 0.99] {
                    let d = found.diameter_at(share);
                    let below = sum([LEAST_DROP_MM, d], |_| 1.0) / all;
                    size.absolute(below, share, place);
                    let footprint = |d: f64| PI * cap_radius_m(PI / 6.0 * (d * 1e-3).powi(3)).powi(2);
                    covered.relative(
                        found.covered_below_per_s(share),
                        sum([LEAST_DROP_MM, d], footprint),
                        1e-9,
                        place,
                    );
                }
            }
        }
    }
    number.assert_below(2e-4, 48);
    water.assert_below(2e-4, 48);
    size.assert_below(5e-3, 100);
    covered.assert_below(2e-2, 100);
    assert!(bent.error > 0.04, "a wrong flux is found");
}

#[test]
fn without_gusts_glass_is_hit_as_any_surface() {
    let spectrum = rain(25.0);
    for normal in normals() {
        let air = DVec3::new(3.0, 0.0, 12.0);
        let found = GlassImpacts::new(&spectrum, normal, air, 0.0);
        let flux = ImpactFlux::new(&spectrum, LEAST_DROP_MM, 6.0, normal, air);
        let off = (found.number_per_m2_s - flux.number_per_m2_s).abs();
        assert!(off <= 1e-3 * flux.number_per_m2_s, "{normal}: {found:?}, {flux:?}");
    }
    // Upright glass in calm air catches what gusts bring, and none without.
    let upright = |gust| GlassImpacts::new(&spectrum, DVec3::NEG_Z, DVec3::ZERO, gust).number_per_m2_s;
    assert!(upright(0.0) == 0.0 && upright(1.0) > 50.0);
    // Bad numbers count as none.
    let bad = GlassImpacts::new(&spectrum, DVec3::NAN, DVec3::NAN, f64::NAN);
    assert_eq!(bad, GlassImpacts::new(&spectrum, DVec3::Y, DVec3::ZERO, 0.0));
    assert_eq!(GlassImpacts::default().covered_below_per_s(1.0), 0.0);
}

#[test]
fn drops_on_glass_are_caps_held_by_hysteresis() {
    let mut worst = Worst::default();
    for i in 0..=40 {
        let r = 1e-5 * 10_f64.powf(0.1 * f64::from(i));
        worst.relative(cap_volume_m3(r), reference::cap_volume(r), 0.0, || format!("{r}"));
        assert!((cap_radius_m(cap_volume_m3(r)) / r - 1.0).abs() < 1e-14);
        // Furmidge with 30° and 60°; ½ρv² on 4/3 r h; wedges.
        let hold = 0.0728 * 2.0 * r * (30_f64.to_radians().cos() - 60_f64.to_radians().cos());
        assert!((retention_n(r) / hold - 1.0).abs() < 1e-14);
        let push = 0.5 * 1.2041 * (0.4_f64 * 20.0).powi(2) * 4.0 / 3.0 * r * r * (PI / 8.0).tan();
        assert!((air_push_n(r, 20.0) / push - 1.0).abs() < 1e-14);
        let speed = 1e-6 / (3.0 * PI * 1.002e-3 * 10.0 * r / (PI / 4.0));
        assert!((running_speed_m_s(1e-6, r) / speed.min(2.0) - 1.0).abs() < 1e-14);
    }
    worst.assert_below(1e-12, 41);
    // On upright glass drops from 3 mm on run, at some 0.1 m/s.
    let radius = |d: f64| cap_radius_m(PI / 6.0 * (d * 1e-3).powi(3));
    let run =
        |d: f64, gravity: [f64; 2], air: [f64; 2]| RunningForce::new(radius(d), gravity, air).velocity_m_s(radius(d));
    assert_eq!(run(2.5, [0.0, -GRAVITY], [0.0; 2]), [0.0; 2]);
    let four = run(4.0, [0.0, -GRAVITY], [0.0; 2]);
    assert!(four[0] == 0.0 && (-0.4..-0.05).contains(&four[1]), "{four:?}");
    // On a windscreen of 30° slope, drops of 2 to 3 mm climb from about 100 km/h on.
    let climbs = |d: f64, km_h: f64| {
        let along = km_h / 3.6 * 30_f64.to_radians().cos();
        run(d, [0.0, -0.5 * GRAVITY], [0.0, along])[1] > 0.0
    };
    for d in [2.0, 3.0] {
        assert!(!climbs(d, 90.0) && climbs(d, 115.0), "{d} mm");
    }
    for bad in [f64::NAN, -1.0, f64::INFINITY] {
        let all = [
            cap_volume_m3(bad),
            cap_radius_m(bad),
            retention_n(bad),
            air_push_n(1e-3, bad),
            running_speed_m_s(bad, bad),
            radius_after_drying_m(bad, bad, bad, bad),
        ];
        assert!(all.iter().all(|x| x.is_finite() && *x >= 0.0), "{all:?}");
    }
}

#[test]
fn drops_on_glass_dry_as_diffusion_has_it() {
    let (mut still, mut stream) = (Worst::default(), Worst::default());
    for r in [3e-4, 1e-3, 3e-3] {
        // A deficit of 4 g/m³ is air of 15 °C at 70 %.
        let life = r * r * 1.5e9 / 4.0;
        let time = 0.1 * life;
        still.relative(
            radius_after_drying_m(r, 4e-3, 0.0, time),
            reference::drying(r, 4e-3, 0.0, time),
            0.0,
            || format!("{r}"),
        );
        for speed in [1.0, 10.0, 40.0] {
            let found = radius_after_drying_m(r, 4e-3, speed, 0.1 * time);
            stream.relative(found, reference::drying(r, 4e-3, speed, 0.1 * time), 0.0, || {
                format!("{r} {speed}")
            });
            assert!(found < radius_after_drying_m(r, 4e-3, 0.0, 0.1 * time));
        }
    }
    still.assert_below(1e-6, 3);
    stream.assert_below(1e-2, 9);
    assert_eq!(radius_after_drying_m(1e-3, 4e-3, 0.0, 1e8), 0.0);
}

#[test]
fn wipers_pass_where_a_search_finds_them() {
    let arm = WiperArm {
        pivot_m: [0.1, -0.4],
        blade_m: [0.1, 0.6],
        turn_rad: [3.0, 0.6],
    };
    let mut worst = Worst::default();
    for mode in [WiperMode::Interval, WiperMode::Slow, WiperMode::Fast] {
        let [period, moving] = mode.cycle_s().expect("a cycle");
        for step in 0..60_u32 {
            let time = 0.11 * f64::from(step);
            let wipers = Wipers {
                arms: [Some(arm), None],
                mode,
                time_s: time,
            };
            let at = time.rem_euclid(period);
            let swing = if at < moving {
                (1.0 - (2.0 * PI * at / moving).cos()) / 2.0
            } else {
                0.0
            };
            assert!((wipers.swing() - swing).abs() < 1e-12);
            for angle in [0.7_f64, 1.2, 1.9, 2.5, 2.9] {
                let place = [0.1 + 0.4 * angle.cos(), -0.4 + 0.4 * angle.sin()];
                let found = wipers.since_s(place);
                let known = reference::since(period, moving, 3.0, 0.6, angle, time);
                assert_eq!(found.is_some(), known.is_some(), "{mode:?} {time} {angle}");
                if let (Some(found), Some(known)) = (found, known) {
                    worst.absolute(found, known, || format!("{mode:?} {time} {angle}"));
                }
            }
        }
    }
    worst.assert_below(1e-9, 500);
    let going = Wipers {
        arms: [Some(arm), None],
        mode: WiperMode::Fast,
        time_s: 9.0,
    };
    for outside in [
        [0.1, -0.35],
        [0.1, 0.3],
        [0.1 + 0.4 * 0.5_f64.cos(), -0.4 + 0.4 * 0.5_f64.sin()],
        [f64::NAN, 0.0],
    ] {
        assert_eq!(going.since_s(outside), None, "{outside:?}");
    }
    assert_eq!(
        Wipers {
            mode: WiperMode::Off,
            ..going
        }
        .since_s([0.1, 0.0]),
        None
    );
    assert!(Wipers::default().rests());
    // What an arm refuses.
    assert!(arm.validated().is_ok());
    assert!(
        WiperArm {
            pivot_m: [f64::NAN, 0.0],
            ..arm
        }
        .validated()
        .is_err()
    );
    assert!(
        WiperArm {
            blade_m: [0.5, 0.4],
            ..arm
        }
        .validated()
        .is_err()
    );
    assert!(
        WiperArm {
            turn_rad: [1.0, 1.0],
            ..arm
        }
        .validated()
        .is_err()
    );
}

#[test]
fn a_drop_on_glass_shows_the_scene_upside_down_with_a_dark_rim() {
    let mut worst = Worst::default();
    for i in 0..=100 {
        let share = f64::from(i) / 100.0;
        let found = cap_view(share);
        let lean = (share * (PI / 4.0).sin()).asin();
        let out = (1.333 * lean.sin()).asin();
        worst.absolute(found.deviation_rad, out - lean, || format!("{share}"));
        // Fresnel by angles; straight on by the indices.
        let reflected = if share == 0.0 {
            (0.333_f64 / 2.333).powi(2)
        } else {
            let (minus, plus) = (out - lean, out + lean);
            0.5 * ((minus.sin() / plus.sin()).powi(2) + (minus.tan() / plus.tan()).powi(2))
        };
        worst.absolute(found.transmission, 1.0 - reflected, || format!("{share}"));
    }
    worst.assert_below(1e-14, 202);
    // 25.5° at the rim, where more than a tenth of the light is lost.
    let rim = cap_view(1.0);
    assert!((rim.deviation_rad.to_degrees() - 25.5).abs() < 0.1, "{rim:?}");
    assert!(rim.transmission < 0.9 && cap_view(0.5).transmission > 0.97, "{rim:?}");
    assert_eq!(cap_view(f64::NAN), cap_view(0.0));
    assert_eq!(cap_view(7.0), rim);
}
