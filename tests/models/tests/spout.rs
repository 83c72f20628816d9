//! Water that pours: sizes, onset and break-up of jets, pipes, mouths of an eave, the way down.

use core::f64::consts::PI;

use glam::{DVec3, Vec3};
use rain_core::constants::{GRAVITY, WATER_DENSITY, WATER_SURFACE_TENSION, WATER_VISCOSITY};
use rain_core::spout::{
    EAVE_ROOT_M, EAVE_SPACING_M, Outflow, SpoutFall, critical_pipe_flow, eave_mouth, eave_mouths, hanging_drop_m3,
    jet_breakup_s, jet_diameter_m, jetting_weber, spout_fall_f32,
};

use crate::check::Worst;

#[test]
fn drops_of_an_eave_have_five_millimetres_and_it_pours_above_a_millilitre_and_a_half_a_second() {
    let drop = Outflow::of_eave(1e-8).unwrap();
    assert!((drop.drop_mm() - 4.8772).abs() < 1e-4, "{}", drop.drop_mm());
    assert!((drop.drops_per_s() - 1e-8 / 6.0747e-8).abs() < 1e-4);
    assert!(!drop.jets() && drop.speed_m_s == 0.0);
    // Tate's weight, less what stays.
    let weight = hanging_drop_m3(EAVE_ROOT_M) * WATER_DENSITY * GRAVITY;
    assert!((weight / (0.65 * PI * EAVE_ROOT_M * WATER_SURFACE_TENSION) - 1.0).abs() < 1e-12);
    // Clanet & Lasheras: their formula as printed, and where a root of 4 mm begins to pour.
    let mut worst = Worst::default();
    for d in [0.0005_f64, 0.001, 0.002, 0.004, 0.01, 0.05] {
        let bond2 = WATER_DENSITY * GRAVITY * d * d / (2.0 * WATER_SURFACE_TENSION);
        let a = 1.0 + 0.37 * bond2;
        let printed = 4.0 * (a - (a * a - 1.0).sqrt()).powi(2);
        worst.relative(jetting_weber(d), printed, 1e-9, || format!("{d} m"));
    }
    worst.assert_below(1e-9, 6);
    let (mut low, mut high) = (1e-8, 1e-4);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if Outflow::of_eave(middle).unwrap().jets() {
            high = middle;
        } else {
            low = middle;
        }
    }
    assert!((high - 1.43e-6).abs() < 0.01e-6, "{high:e} m³/s");
    // Falling films part into columns between 60 and 120 g/(m s): two regimes of the same water.
    let per_metre = high / EAVE_SPACING_M * WATER_DENSITY;
    assert!((0.055..0.12).contains(&per_metre), "{per_metre} kg/(m s)");
}

#[test]
fn a_falling_jet_breaks_when_the_growth_along_its_way_is_used_up() {
    let mut worst = Worst::default();
    for d in [0.001, 0.004, 0.01] {
        for v in [0.05, 0.3, 1.0, 5.0] {
            let oh = WATER_VISCOSITY / (WATER_DENSITY * WATER_SURFACE_TENSION * d).sqrt();
            let growth = 19.5 * (1.0 + 3.0 * oh).powf(0.85);
            let end = jet_breakup_s(d, v);
            // Simpson's rule over the local time scale of the jet as it thins.
            let rate = |t: f64| {
                let thin = jet_diameter_m(d, v, v + GRAVITY * t);
                (WATER_SURFACE_TENSION / (WATER_DENSITY * thin.powi(3))).sqrt()
            };
            let steps = 4000;
            let h = end / f64::from(steps);
            let sum: f64 = (0..=steps)
                .map(|i| {
                    let weight = match i {
                        0 => 1.0,
                        i if i == steps => 1.0,
                        i if i % 2 == 1 => 4.0,
                        _ => 2.0,
                    };
                    weight * rate(h * f64::from(i))
                })
                .sum();
            worst.relative(sum * h / 3.0, growth, 1e-9, || format!("{d} m, {v} m/s"));
        }
    }
    worst.assert_below(1e-9, 12);
    // A thin stream of a tap breaks within a hand's breadth or two; a gargoyle's jet reaches the ground whole.
    let fall = 0.3 * jet_breakup_s(0.004, 0.3) + 0.5 * GRAVITY * jet_breakup_s(0.004, 0.3).powi(2);
    assert!((0.1..0.5).contains(&fall), "{fall} m");
    assert!(jet_breakup_s(0.03, 1.0) > 1.5);
    // Water is kept: area times speed.
    let thin = jet_diameter_m(0.004, 0.3, 4.3);
    assert!((thin * thin * 4.3 / (0.004 * 0.004 * 0.3) - 1.0).abs() < 1e-12);
}

#[test]
fn a_pipe_runs_at_critical_depth_until_it_is_full() {
    let (mut worst, mut flows) = (Worst::default(), Worst::default());
    let mut before = 0.0;
    for i in 0..60 {
        let flow = 1e-6 * 1.2_f64.powi(i);
        let d = 0.1;
        let pipe = critical_pipe_flow(flow, d).unwrap();
        assert!(pipe.depth_m >= before && pipe.depth_m <= d);
        before = pipe.depth_m;
        flows.relative(pipe.area_m2 * pipe.speed_m_s, flow, 1e-9, || {
            format!("{flow:e} m³/s: flow")
        });
        if pipe.depth_m < d {
            // The Froude number of what is under the surface is 1; area and width by summing up strips.
            let strips = 100_000;
            let chord = |y: f64| 2.0 * (y * (d - y)).max(0.0).sqrt();
            let h = pipe.depth_m / f64::from(strips);
            let area: f64 = (0..strips).map(|k| chord(h * (f64::from(k) + 0.5)) * h).sum();
            let froude2 = flow * flow * chord(pipe.depth_m) / (GRAVITY * area.powi(3));
            worst.relative(froude2, 1.0, 1.0, || format!("{flow:e} m³/s: Froude"));
            // Straub's fit of critical depth, in SI units.
            if (0.3..0.8).contains(&(pipe.depth_m / d)) {
                let straub = 1.01 / d.powf(0.26) * (flow * flow / GRAVITY).powf(0.25);
                assert!(
                    (pipe.depth_m / straub - 1.0).abs() < 0.05,
                    "{flow}: {}, {straub}",
                    pipe.depth_m
                );
            }
        }
    }
    worst.assert_below(1e-6, 40);
    flows.assert_below(1e-12, 60);
    // 0.1 m full at 50 l/s.
    let full = critical_pipe_flow(0.05, 0.1).unwrap();
    assert!((full.depth_m - 0.1).abs() < 1e-12 && (full.speed_m_s - 0.05 / (0.0025 * PI)).abs() < 1e-9);
    // A trickle drips from the lip; a shower's water of a roof leaves as a jet.
    assert!(!Outflow::of_pipe(1e-8, 0.1).unwrap().jets());
    let jet = Outflow::of_pipe(1e-3, 0.1).unwrap();
    assert!(jet.jets() && jet.speed_m_s > 0.4 && jet.diameter_m < 0.1);
}

#[test]
fn mouths_share_the_water_of_an_eave() {
    for length in [0.02, 1.0, 7.3, 60.0] {
        let count = eave_mouths(length);
        assert!((f64::from(count) * EAVE_SPACING_M - length).abs() <= EAVE_SPACING_M);
        let mouths: Vec<_> = (0..count).map(|i| eave_mouth(i, count, length, 7)).collect();
        let sum: f64 = mouths.iter().map(|mouth| mouth.share).sum();
        assert!((sum / f64::from(count) - 1.0).abs() < 1e-12);
        assert!(mouths.windows(2).all(|pair| pair[1].along_m > pair[0].along_m));
        assert!(
            mouths
                .iter()
                .all(|m| (0.0..=length).contains(&m.along_m) && m.share > 0.0 && (0.0..1.0).contains(&m.phase))
        );
    }
    // Some drip while others pour; another eave is another one.
    let [a, b] = [1, 2].map(|key| (0..400).map(|i| eave_mouth(i, 400, 9.7, key).share).collect::<Vec<_>>());
    assert_ne!(a, b);
    let few = a.iter().filter(|share| **share < 0.5).count();
    let many = a.iter().filter(|share| **share > 1.5).count();
    assert!((100..220).contains(&few) && (50..150).contains(&many), "{few}, {many}");
    assert_eq!(eave_mouths(f64::NAN), 1);
    assert_eq!(eave_mouths(-3.0), 1);
}

#[test]
fn what_pours_falls_by_quadratic_drag_and_ends_where_it_is_asked() {
    let mut worst = Worst::default();
    let mut single = Worst::default();
    for drop_mm in [None, Some(1.0), Some(4.9)] {
        for v in [DVec3::ZERO, DVec3::new(0.6, -0.4, 0.2), DVec3::new(2.0, 0.0, 0.0)] {
            let wind = DVec3::new(-3.0, 0.0, 8.0);
            let fall = SpoutFall::new(v, drop_mm, wind);
            let vt = fall.terminal_m_s();
            // Euler's midpoint rule on both equations of motion.
            let (mut place, mut speed) = (DVec3::ZERO, v);
            let h = 1e-4;
            for step in 1..=10_000_u32 {
                let slope = |u: DVec3| {
                    let pull = (wind - u) * GRAVITY / vt;
                    pull.with_y(-GRAVITY * (1.0 - u.y * u.y / vt / vt))
                };
                let middle = speed + 0.5 * h * slope(speed);
                place += h * middle;
                speed += h * slope(middle);
                if step % 1000 == 0 {
                    let t = h * f64::from(step);
                    let exact = fall.place_m(t);
                    worst.absolute((exact - place).length(), 0.0, || format!("{drop_mm:?} {v} {t}"));
                    let near = spout_fall_f32(v.as_vec3(), vt as f32, wind.as_vec3(), t as f32).as_dvec3();
                    single.absolute((near - exact).length(), 0.0, || format!("{drop_mm:?} {v} {t}"));
                    let back = fall.time_to_fall_s(-exact.y);
                    worst.absolute(back, t, || format!("{drop_mm:?} {v} {t}: back"));
                }
            }
        }
    }
    worst.assert_below(1e-7, 150);
    single.assert_below(2e-5, 80);
}

#[test]
fn nothing_pours_of_nothing_and_bad_numbers_are_held() {
    for flow in [f64::NAN, -1.0, 0.0, 1e-12, f64::NEG_INFINITY] {
        assert_eq!(Outflow::of_eave(flow), None);
        assert_eq!(Outflow::of_pipe(flow, 0.1), None);
        assert_eq!(critical_pipe_flow(flow, 0.1), None);
    }
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0, 1e300] {
        let pipe = Outflow::of_pipe(1e-4, bad).unwrap();
        assert!(pipe.speed_m_s.is_finite() && pipe.diameter_m > 0.0 && pipe.breakup_s.is_finite());
        for value in [
            hanging_drop_m3(bad),
            jetting_weber(bad),
            jet_breakup_s(bad, bad),
            jet_diameter_m(bad, bad, 1.0),
        ] {
            assert!(value > 0.0, "{bad}: {value}");
        }
        let fall = SpoutFall::new(DVec3::splat(bad), Some(bad), DVec3::splat(bad));
        assert!(fall.place_m(bad).is_finite() && fall.time_to_fall_s(bad).is_finite());
        assert!(spout_fall_f32(Vec3::ZERO, bad as f32, Vec3::ZERO, bad as f32).is_finite());
    }
    let flood = Outflow::of_eave(f64::INFINITY).unwrap();
    assert!(flood.flow_m3_s.is_finite() && flood.diameter_m.is_finite() && flood.breakup_s.is_finite());
    // Water does not start upwards.
    assert_eq!(SpoutFall::new(DVec3::Y, None, DVec3::Y).velocity_m_s(), DVec3::ZERO);
}
