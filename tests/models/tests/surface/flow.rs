//! Sheet flow, the film step, road film.

use proptest::prelude::*;
use rain_core::surface::{
    FlowLaw, RoadFilmFit, RoadSurface, SheetFlow, drained_film, drained_film_f32, fast_film_step_f32, film_step,
    film_step_f32, recession_share,
};
use rain_reference::surface as truth;
use rain_reference::surface_inertial::Runoff;

use super::{ANY, config, log_spaced};
use crate::check::Worst;

fn manning(manning_n: f64, slope: f64, length_m: f64, rain: f64) -> SheetFlow {
    SheetFlow::new(FlowLaw::Manning { manning_n }, slope, length_m, rain).expect("valid")
}

fn laminar(friction: f64, slope: f64, length_m: f64, rain: f64) -> SheetFlow {
    SheetFlow::new(FlowLaw::Laminar { friction }, slope, length_m, rain).expect("valid")
}

#[test]
fn sheet_flow_has_its_check_values() {
    for (n, slope, length, rain, depth_mm, time_s) in [
        (0.015, 0.02, 5.0, 50.0, 0.832_39, 59.932),
        (0.011, 0.025, 7.5, 25.0, 0.543_84, 78.313),
        (0.05, 0.01, 4.0, 100.0, 2.797_93, 100.725),
    ] {
        let flow = manning(n, slope, length, rain);
        assert!((flow.steady_depth_m(length) * 1e3 - depth_mm).abs() < 5.1e-6);
        assert!((flow.equilibrium_time_s() - time_s).abs() < 5.1e-4);
    }
    let smooth = laminar(24.0, 0.02, 3.0, 20.0);
    assert!((smooth.steady_depth_m(3.0) * 1e3 - 0.6349).abs() < 5.1e-5);
    let flow = manning(0.015, 0.02, 5.0, 50.0);
    for (t, depth_mm) in [(10.0, 0.138_89), (20.0, 0.277_78), (40.0, 0.555_56)] {
        assert!((flow.rising_depth_m(5.0, t) * 1e3 - depth_mm).abs() < 5.1e-6);
    }
    assert!((flow.discharge_m2_s(flow.steady_depth_m(5.0)) - 6.944_444e-5).abs() < 5e-12);
    for (t, depth_mm) in [
        (10.0, 0.701_49),
        (30.0, 0.490_25),
        (60.0, 0.290_47),
        (120.0, 0.127_65),
        (300.0, 0.034_29),
    ] {
        let depth = flow.recession_depth_m(5.0, t) * 1e3;
        assert!((depth - depth_mm).abs() < 5.1e-6, "{t}: {depth}");
        assert_eq!(flow.depth_m(5.0, 1e4 + t, 1e4) * 1e3, depth);
    }
}

#[test]
fn sheet_flow_is_the_implicit_equation_over_its_domain() {
    let (mut steady, mut flux) = (Worst::default(), Worst::default());
    let (mut falling, mut wrong) = (Worst::default(), Worst::default());
    let (mut settling, mut passing) = (Worst::default(), Worst::default());
    for rain in log_spaced(1e-3, 1e4, 6) {
        for slope in [1e-6, 1e-3, 0.05, 10.0] {
            for resistance in log_spaced(1e-3, 10.0, 4) {
                for x in [0.01, 1.0, 1e4] {
                    let friction = 24.0 + 900.0 * resistance;
                    let planes = [
                        (
                            manning(resistance, slope, 1e4, rain),
                            truth::Plane::manning(resistance, slope, rain),
                        ),
                        (
                            laminar(friction, slope, 1e4, rain),
                            truth::Plane::laminar(friction, slope, rain),
                        ),
                    ];
                    for (flow, plane) in planes {
                        let h = plane.steady(x);
                        steady.relative(flow.steady_depth_m(x), h, 0.0, || format!("{flow:?} {x}"));
                        let whole = plane.steady(1e4) / plane.rain;
                        settling.relative(flow.equilibrium_time_s(), whole, 0.0, || format!("{flow:?}"));
                        if h < 1e3 {
                            flux.relative(flow.discharge_m2_s(h), plane.rain * x, 0.0, || format!("{flow:?} {x}"));
                        }
                        for share in log_spaced(1e-4, 1e6, 9) {
                            let t = share * h / plane.rain;
                            let depth = plane.recession(x, t);
                            falling.relative(flow.recession_depth_m(x, t), depth, 0.0, || {
                                format!("{flow:?} {x} {share}")
                            });
                            wrong.relative(1.05 * flow.recession_depth_m(x, t), depth, 0.0, String::new);
                            // While it rains, after long rain, after rain too short for the steady depth.
                            let place = || format!("{flow:?} {x} {share}");
                            let risen = h.min(plane.rain * t);
                            passing.relative(flow.rising_depth_m(x, t), risen, 0.0, place);
                            passing.relative(flow.depth_m(x, t, 2.0 * t), risen, 0.0, place);
                            let kept = (0.1 * h).min(depth);
                            let short = 0.1 * h / plane.rain;
                            passing.relative(flow.depth_m(x, short + t, short), kept, 0.0, place);
                        }
                    }
                }
            }
        }
    }
    steady.assert_below(2e-15, 500);
    flux.assert_below(1e-14, 500);
    falling.assert_below(1e-14, 5000);
    settling.assert_below(2e-15, 500);
    passing.assert_below(1e-14, 15_000);
    assert!(wrong.error > 0.04, "a depth 5 % off goes unseen");
}

#[test]
fn sheet_flow_is_what_arrives_along_characteristics_after_short_and_long_rain() {
    let mut worst = Worst::default();
    let planes = [
        (
            manning(0.015, 0.02, 5.0, 50.0),
            truth::Plane::manning(0.015, 0.02, 50.0),
        ),
        (laminar(60.0, 0.01, 5.0, 20.0), truth::Plane::laminar(60.0, 0.01, 20.0)),
    ];
    for (flow, plane) in planes {
        let whole = flow.equilibrium_time_s();
        for duration in [0.3, 0.8, 2.0] {
            for time in [0.2, 0.5, 0.9, 1.4, 2.5, 4.0] {
                for x in [0.5, 2.0, 5.0] {
                    let (t, d) = (time * whole, duration * whole);
                    let depth = plane.by_characteristics(x, t, d, 150);
                    worst.relative(flow.depth_m(x, t, d), depth, 1e-7, || format!("{plane:?} {x} {t} {d}"));
                }
            }
        }
    }
    // The walk's own error: its speed is not smooth where the depth is 0.
    worst.assert_below(1e-5, 100);
}

#[test]
fn sheet_flow_is_near_the_equations_with_pressure_and_inertia() {
    for (n, slope, length, rain) in [(0.015, 0.02, 5.0, 50.0), (0.05, 0.01, 4.0, 100.0)] {
        let flow = manning(n, slope, length, rain);
        let full = |time| truth::local_inertial_foot(n, slope, length, rain / 3.6e6, time, 100);
        // The foot of the grid is the last cell's middle; its steady depth differs by less than 1 %.
        let x = length * (1.0 - 0.5 / 100.0);
        let steady = full(4.0 * flow.equilibrium_time_s());
        assert!((steady / flow.steady_depth_m(x) - 1.0).abs() < 0.01, "{steady}");
        let t = 0.5 * flow.equilibrium_time_s();
        assert!((full(t) / flow.rising_depth_m(x, t) - 1.0).abs() < 0.01);
    }
}

#[test]
fn sheet_flow_runs_along_the_fall_line_of_a_plane_askew() {
    let (n, slopes, length, rain) = (0.05, [0.03, 0.04], 4.0, 50.0);
    let slope = f64::hypot(slopes[0], slopes[1]);
    let flow = manning(n, slope, 2.0 * length, rain);
    // From the upper walls water flows straight down; the longest way ends at the foot of the steeper side.
    let path = |at: [f64; 2]| (at[0] * slope / slopes[0]).min(at[1] * slope / slopes[1]);
    let settling = flow.steady_depth_m(path([length; 2])) / (rain / 3.6e6);
    // (Relative L1, worst of all cells that are not beside the ridge where both walls' waters meet) while half of it
    // rises and when it is steady, on a grid of `cells`².
    let seen = |cells: usize, flow: &SheetFlow| {
        let width = length / cells as f64;
        let mut grid = Runoff::dry([cells; 2], width, slopes, n);
        let compare = |grid: &Runoff, time: f64| {
            let (mut off, mut all, mut worst) = (0.0, 0.0, Worst::default());
            for y in 0..cells {
                for x in 0..cells {
                    // What a cell passes on is the discharge at its lower corner.
                    let at = [x, y].map(|i| (i + 1) as f64 * width);
                    let expected = flow.rising_depth_m(path(at), time);
                    let depth = grid.depth[grid.cell(x, y)];
                    off += (depth - expected).abs();
                    all += expected;
                    let ways = [0, 1].map(|i| at[i] * slope / slopes[i]);
                    if (ways[0] - ways[1]).abs() > 0.3 * length && path(at) > 0.3 * length {
                        worst.relative(depth, expected, 0.0, || format!("cell {x} {y}"));
                    }
                }
            }
            (off / all, worst)
        };
        grid.run(rain / 3.6e6, 0.5 * settling);
        let rising = compare(&grid, 0.5 * settling);
        grid.run(rain / 3.6e6, 2.5 * settling);
        let steady = compare(&grid, f64::INFINITY);
        let mass = (grid.stored() + grid.left) / grid.fallen - 1.0;
        assert!(mass.abs() < 1e-12, "mass {mass:.1e}");
        assert!(grid.depth.iter().all(|h| *h >= 0.0));
        (rising, steady)
    };
    let ((rising, _), (steady, _)) = seen(40, &flow);
    let ((fine_rising, worst_rising), (fine_steady, worst_steady)) = seen(80, &flow);
    assert!(
        fine_rising < 0.022 && fine_steady < 0.022,
        "{fine_rising} {fine_steady}"
    );
    worst_steady.assert_below(0.021, 2000);
    // Where the rise meets the steady depth there is a kink, which the grid rounds off.
    worst_rising.assert_below(0.09, 2000);
    // What is left is the grid's: it halves with its cells.
    assert!(
        rising > 1.5 * fine_rising && steady > 1.5 * fine_steady,
        "{rising} {steady}"
    );
    let (_, (off, _)) = seen(80, &manning(1.05 * n, slope, 2.0 * length, rain));
    assert!(off > 0.035, "5 % of the roughness goes unseen: {off}");
}

#[test]
fn five_newton_steps_reach_the_last_bit_of_the_recession() {
    for power in [3, 5] {
        let mut worst = Worst::default();
        let mut early = Worst::default();
        for c in log_spaced(1e-12, 1e12, 400) {
            let root = rain_reference::numerics::bisect(0.0, 1.0, |u| u.powi(i32::from(power)) + c * u * u - 1.0);
            worst.relative(recession_share(power, c, 5), root, 0.0, || format!("{power} {c}"));
            early.relative(recession_share(power, c, 3), root, 0.0, || format!("{power} {c}"));
        }
        worst.assert_below(1e-15, 400);
        assert!(early.error > 1e-9, "three steps would do: {}", early.error);
        for c in ANY {
            assert!((0.0..=1.0).contains(&recession_share(power, c, 5)), "{c}");
        }
    }
}

#[test]
fn sheet_flow_clamps_and_refuses() {
    let flow = manning(0.015, 0.02, 5.0, 50.0);
    for a in ANY {
        for b in ANY {
            for depth in [
                flow.steady_depth_m(a),
                flow.discharge_m2_s(a),
                flow.rising_depth_m(a, b),
                flow.recession_depth_m(a, b),
                flow.depth_m(a, b, 60.0),
                flow.depth_m(5.0, a, b),
            ] {
                assert!(depth.is_finite() && depth >= 0.0, "{a} {b}: {depth}");
            }
        }
    }
    assert_eq!(flow.recession_depth_m(5.0, f64::INFINITY), 0.0);
    let dry = manning(0.015, 0.02, 5.0, 0.0);
    assert_eq!(
        (
            dry.depth_m(5.0, 9.0, 99.0),
            dry.equilibrium_time_s(),
            dry.recession_depth_m(5.0, 1.0)
        ),
        (0.0, 0.0, 0.0)
    );
    let law = FlowLaw::Manning { manning_n: 0.015 };
    let refused = |law, slope, length, rain, field: &str| {
        let message = SheetFlow::new(law, slope, length, rain)
            .expect_err("refused")
            .to_string();
        assert!(message.starts_with(field), "{message}");
    };
    for bad in [f64::NAN, f64::INFINITY, -1.0, 1e9] {
        refused(law, bad, 5.0, 50.0, "slope");
        refused(law, 0.02, bad, 50.0, "length_m");
        refused(law, 0.02, 5.0, bad, "intensity_mm_h");
        refused(FlowLaw::Manning { manning_n: bad }, 0.02, 5.0, 50.0, "manning_n");
        refused(FlowLaw::Laminar { friction: bad }, 0.02, 5.0, 50.0, "friction");
    }
    refused(law, 0.0, 5.0, 50.0, "slope");
}

proptest! {
    #![proptest_config(config(200))]

    #[test]
    fn sheet_flow_falls_after_rain_and_deepens_downhill(
        n in 0.005_f64..0.3,
        slope in 1e-4_f64..0.5,
        rain in 0.1_f64..200.0,
        duration in 0.0_f64..500.0,
        time in 0.0_f64..2000.0,
        later in 0.0_f64..500.0,
        x in 0.0_f64..20.0,
        more in 0.0_f64..5.0,
        turbulent: bool,
    ) {
        let flow = if turbulent { manning(n, slope, 30.0, rain) } else { laminar(1e3 * n.max(0.024), slope, 30.0, rain) };
        let h = flow.depth_m(x, time, duration);
        prop_assert!(h >= 0.0 && h <= flow.steady_depth_m(x) && h <= rain / 3.6e6 * duration.min(time) * (1.0 + 1e-15));
        prop_assert!(flow.depth_m(x + more, time, duration) >= h);
        let after = flow.depth_m(x, duration.max(time) + later, duration);
        prop_assert!(after <= flow.depth_m(x, duration.max(time), duration) * (1.0 + 1e-14));
    }

    #[test]
    fn water_on_a_plane_is_kept(slope in 1e-3_f64..0.2, rain in 1.0_f64..100.0, part in 0.1_f64..1.5, late in 0.1_f64..4.0) {
        // Stored now = stored at the rain's end − what ran off at the foot since.
        let flow = manning(0.02, slope, 6.0, rain);
        let (duration, span) = (part * flow.equilibrium_time_s(), late * flow.equilibrium_time_s());
        let stored = |t: f64| rain_reference::numerics::simpson(0.0, 1.0, 2000, |s| {
            flow.depth_m(6.0 * s * s, t, duration) * 12.0 * s
        });
        let ran_off = rain_reference::numerics::simpson(0.0, span, 4000, |t| {
            flow.discharge_m2_s(flow.depth_m(6.0, duration + t, duration))
        });
        let (before, after) = (stored(duration), stored(duration + span));
        prop_assert!((before - after - ran_off).abs() < 2e-4 * before, "{before} {after} {ran_off}");
    }
}

#[test]
fn the_film_step_has_its_check_values() {
    assert!((drained_film(1e-3, 1.0, 10.0) * 1e3 - 0.907_730_5).abs() < 5e-8);
    assert!((drained_film(2e-3, 0.5, 60.0) * 1e3 - 1.322_555_3).abs() < 5e-8);
    let after_a_minute = |dt: f64| {
        let steps = (60.0 / dt).round() as u32;
        (0..steps).fold(0.0, |h, _| film_step(h, 1e-5, 1.8856, dt))
    };
    let exact = 4.620_847_418e-4;
    for (dt, published) in [(20.0, 8.2e-3), (5.0, 5.2e-4), (1.0, 2.1e-5)] {
        let found = (after_a_minute(dt) / exact - 1.0).abs();
        assert!((found / published - 1.0).abs() < 0.03, "dt {dt}: {found:.2e}");
    }
    let euler = |dt: f64| {
        let steps = (60.0 / dt).round() as u32;
        (0..steps).fold(0.0_f64, |h, _| h + dt * (1e-5 - 1.8856 * h.powf(5.0 / 3.0)))
    };
    for (dt, error) in [(20.0, 8.4e-2), (5.0, 1.9e-2), (1.0, 3.8e-3)] {
        let found = (euler(dt) / exact - 1.0).abs();
        assert!((found / error - 1.0).abs() < 0.03, "Euler, dt {dt}: {found:.2e}");
    }
    let settled = (0..100_000).fold(0.0, |h, _| film_step(h, 1e-5, 1.8856, 0.1));
    assert!((settled - 6.834_870e-4).abs() < 1e-9);
}

#[test]
fn the_film_step_is_second_order_and_its_drain_exact() {
    let (rain, drain) = (1e-5, 1.8856);
    let truth_60 = truth::film(0.0, rain, drain, 60.0, 60_000);
    let error = |dt: f64| {
        let steps = (60.0 / dt).round() as u32;
        ((0..steps).fold(0.0, |h, _| film_step(h, rain, drain, dt)) / truth_60 - 1.0).abs()
    };
    for dt in [4.0, 2.0, 1.0] {
        let order = (error(dt) / error(0.5 * dt)).log2();
        assert!((1.85..2.15).contains(&order), "order {order} at {dt}");
    }
    let mut worst = Worst::default();
    for h in log_spaced(1e-7, 1e-2, 11) {
        for drain in log_spaced(1e-3, 100.0, 6) {
            let reference = truth::film(h, 0.0, drain, 20.0, 20_000);
            worst.relative(drained_film(h, drain, 20.0), reference, 0.0, || format!("{h} {drain}"));
        }
    }
    // Rounding of 20 000 steps of the reference.
    worst.assert_below(3e-12, 60);
}

#[test]
fn single_precision_film_steps_stay_near_the_double_ones() {
    let (mut plain, mut fast, mut drained) = (Worst::default(), Worst::default(), Worst::default());
    for h in log_spaced(1e-30, 1.0, 60).chain([0.0]) {
        for drain in log_spaced(1e-4, 1e4, 9).chain([0.0]) {
            for dt in [0.0, 1e-3, 1.0 / 60.0, 1.0, 60.0, 1e9] {
                let (hf, kf, df) = (h as f32, drain as f32, dt as f32);
                let exact = drained_film(f64::from(hf), f64::from(kf), f64::from(df));
                drained.relative(f64::from(drained_film_f32(hf, kf, df)), exact, 1e-36, || {
                    format!("{h} {drain} {dt}")
                });
                for rain in [0.0_f32, 1e-8, 1e-5, -1e-6] {
                    let exact = film_step(f64::from(hf), f64::from(rain), f64::from(kf), f64::from(df));
                    let water = f64::from(hf) + f64::from(rain).abs() * f64::from(df);
                    let place = || format!("{h} {rain} {drain} {dt}");
                    plain.relative(
                        f64::from(film_step_f32(hf, rain, kf, df)) - exact,
                        0.0,
                        water + 1e-36,
                        place,
                    );
                    fast.absolute(
                        (f64::from(fast_film_step_f32(hf, rain, kf, df)) - exact) / (water + 1e-36),
                        0.0,
                        || format!("{h} {rain} {drain} {dt}"),
                    );
                }
            }
        }
    }
    drained.assert_below(4e-7, 3000);
    plain.assert_below(6e-7, 10_000);
    fast.assert_below(6e-7, 10_000);
}

#[test]
fn roundings_of_many_short_film_steps_add_up_as_stated() {
    // A minute, by the length of a step: against the same steps in double precision.
    for (steps, allowed) in [(3600, 1e-3), (240, 4e-5), (60, 1e-5)] {
        let dt = (60.0 / f64::from(steps)) as f32;
        let mut worst = Worst::default();
        for h in [0.0_f32, 1e-5, 1e-4, 1e-3, 1e-2] {
            for rain in [0.0_f32, 1e-6, 1e-5, 1e-4] {
                for drain in [0.01_f32, 0.1, 1.0, 10.0] {
                    let double = (0..steps).fold(f64::from(h), |h, _| {
                        film_step(h, f64::from(rain), f64::from(drain), f64::from(dt))
                    });
                    for step in [film_step_f32, fast_film_step_f32] {
                        let single = (0..steps).fold(h, |h, _| step(h, rain, drain, dt));
                        worst.relative(f64::from(single), double, 1e-30, || {
                            format!("{h} {rain} {drain}, {steps}")
                        });
                    }
                }
            }
        }
        worst.assert_below(allowed, 160);
        assert!(worst.error > 0.2 * allowed, "{steps} steps: {}", worst.error);
    }
}

#[test]
fn the_film_step_takes_anything() {
    for h in ANY {
        for rain in ANY {
            for drain in ANY {
                for dt in ANY {
                    let film = film_step(h, rain, drain, dt);
                    assert!(film.is_finite() && film >= 0.0, "{h} {rain} {drain} {dt}: {film}");
                    for film in [
                        film_step_f32(h as f32, rain as f32, drain as f32, dt as f32),
                        fast_film_step_f32(h as f32, rain as f32, drain as f32, dt as f32),
                        drained_film_f32(h as f32, drain as f32, dt as f32),
                    ] {
                        assert!(film.is_finite() && film >= 0.0, "{h} {rain} {drain} {dt}: {film}");
                    }
                }
            }
        }
    }
    assert_eq!(film_step(1e-3, 1.0, 1.0, 0.0), 1e-3, "no time");
    assert_eq!(film_step(1e-3, f64::NAN, 0.0, 9.0), 1e-3, "no rain");
    assert_eq!(film_step(f64::NAN, 0.0, 1.0, 9.0), 0.0);
    assert_eq!(
        film_step(1e-6, -1e-3, 1.0, 60.0),
        0.0,
        "evaporation stops at the dry ground"
    );
}

proptest! {
    #![proptest_config(config(256))]

    #[test]
    fn the_film_never_makes_water_and_drains_in_any_cut(
        h in 0.0_f64..0.01,
        rain in 0.0_f64..1e-4,
        drain in 0.0_f64..100.0,
        dt in 0.0_f64..1e4,
        more in 0.0_f64..1e-3,
    ) {
        let after = film_step(h, rain, drain, dt);
        prop_assert!(after >= 0.0 && after <= (h + rain * dt) * (1.0 + 1e-15));
        prop_assert!(film_step(h + more, rain, drain, dt) >= after);
        prop_assert!(film_step(h, rain, 1.1 * drain, dt) <= after);
        let cut = drained_film(drained_film(h, drain, 0.3 * dt), drain, 0.7 * dt);
        prop_assert!((cut - drained_film(h, drain, dt)).abs() <= 1e-14 * cut);
        prop_assert_eq!(film_step(h, 0.0, drain, dt), drained_film(h, drain, dt), "no rain");
        let filled = h + rain * dt;
        prop_assert!((film_step(h, rain, 0.0, dt) - filled).abs() <= 1e-15 * filled, "no drain");
    }
}

fn road(texture_depth_mm: f64, length_m: f64, slope: f64) -> RoadSurface {
    RoadSurface {
        texture_depth_mm,
        length_m,
        slope,
    }
}

#[test]
fn the_road_film_has_its_check_values() {
    for (texture, length, rain, slope, first, second) in [
        (0.5, 5.0, 50.0, 0.02, 0.9310, 1.0036),
        (1.0, 7.5, 25.0, 0.015, 0.3783, 0.5221),
        (0.8, 10.0, 100.0, 0.025, 1.9826, 2.3102),
    ] {
        let road = road(texture, length, slope);
        for (fit, expected) in [(RoadFilmFit::Gallaway1971, first), (RoadFilmFit::Gallaway1979, second)] {
            let film = road.film_mm(fit, rain).expect("valid");
            assert!((film - expected).abs() < 5.1e-5, "{fit:?} {film}");
        }
    }
    let inside = road(2.0, 2.0, 0.05)
        .film_mm(RoadFilmFit::Gallaway1979, 0.5)
        .expect("valid");
    assert!(
        inside < 0.0 && inside > -2.0,
        "light rain stays inside the texture: {inside}"
    );
    assert_eq!(road(0.8, 5.0, 0.02).film_mm(RoadFilmFit::Gallaway1971, 0.0), Ok(-0.8));
}

#[test]
fn the_road_film_is_the_regression_over_its_domain() {
    let (mut worst, mut covering, mut wrong) = (Worst::default(), Worst::default(), Worst::default());
    for texture in log_spaced(0.01, 10.0, 5) {
        for length in log_spaced(0.1, 1e3, 5) {
            for slope in log_spaced(1e-4, 1.0, 5) {
                for fit in [RoadFilmFit::Gallaway1971, RoadFilmFit::Gallaway1979] {
                    let found = road(texture, length, slope)
                        .covering_intensity_mm_h(fit)
                        .expect("valid");
                    let first = fit == RoadFilmFit::Gallaway1971;
                    let exact = truth::gallaway_covering(first, texture, length, slope);
                    covering.relative(found, exact, 0.0, || format!("{texture} {length} {slope}"));
                }
                for rain in log_spaced(1e-3, 500.0, 5).chain([0.0]) {
                    for fit in [RoadFilmFit::Gallaway1971, RoadFilmFit::Gallaway1979] {
                        let first = fit == RoadFilmFit::Gallaway1971;
                        let exact = truth::gallaway(first, texture, length, rain, slope);
                        let film = road(texture, length, slope).film_mm(fit, rain).expect("valid");
                        worst.relative(film, exact, exact + texture, || {
                            format!("{texture} {length} {slope} {rain}")
                        });
                        let off = road(texture, length, (1.05 * slope).min(1.0))
                            .film_mm(fit, rain)
                            .expect("valid");
                        wrong.relative(off, exact, exact + texture, String::new);
                    }
                }
            }
        }
    }
    worst.assert_below(5e-15, 1000);
    covering.assert_below(1e-13, 200);
    assert!(wrong.error > 0.01, "a slope 5 % off goes unseen");
}

#[test]
fn a_road_outside_the_domain_is_refused() {
    for bad in [f64::NAN, f64::INFINITY, -1.0, 0.0, 1e9] {
        let film = |r: RoadSurface| {
            r.film_mm(RoadFilmFit::Gallaway1971, 10.0)
                .expect_err("refused")
                .to_string()
        };
        assert!(film(road(bad, 5.0, 0.02)).starts_with("texture_depth_mm"));
        assert!(film(road(0.8, bad, 0.02)).starts_with("length_m"));
        assert!(film(road(0.8, 5.0, bad)).starts_with("slope"));
        assert!(
            road(bad, 5.0, 0.02)
                .covering_intensity_mm_h(RoadFilmFit::Gallaway1971)
                .is_err()
        );
    }
    for bad in [f64::NAN, f64::INFINITY, -1.0, 501.0] {
        let error = road(0.8, 5.0, 0.02)
            .film_mm(RoadFilmFit::Gallaway1979, bad)
            .expect_err("refused");
        assert!(error.to_string().starts_with("intensity_mm_h"));
    }
}

proptest! {
    #![proptest_config(config(256))]

    #[test]
    fn the_road_film_rises_with_rain_and_length_and_ends_at_the_covering_rain(
        texture in 0.1_f64..3.0,
        length in 0.5_f64..50.0,
        slope in 0.001_f64..0.1,
        rain in 0.0_f64..400.0,
        first: bool,
    ) {
        let fit = if first { RoadFilmFit::Gallaway1971 } else { RoadFilmFit::Gallaway1979 };
        let r = road(texture, length, slope);
        let film = r.film_mm(fit, rain).expect("valid");
        prop_assert!(film >= -texture);
        prop_assert!(r.film_mm(fit, rain + 1.0).expect("valid") > film);
        prop_assert!(road(texture, 1.1 * length, slope).film_mm(fit, rain).expect("valid") >= film);
        prop_assert!(road(texture, length, 1.1 * slope).film_mm(fit, rain).expect("valid") <= film);
        let covering = r.covering_intensity_mm_h(fit).expect("valid");
        if covering <= 500.0 {
            prop_assert!(r.film_mm(fit, covering).expect("valid").abs() < 1e-12 * texture);
        }
    }
}
