//! Inlets and holes.

use std::sync::Arc;

use proptest::prelude::*;
use rain_core::surface::Grate;
use rain_core::surface::basins::{BakeOptions, BasinForcing, BasinRun, Basins, Drain, Grid, Inlet};
use rain_reference::basins::{Field, inlet};
use rain_reference::numerics::runge_kutta;

use super::terrain::{config, drawn, small_fields, unit};
use crate::check::Worst;

fn with_drain(field: &Field, drains: Vec<Drain>) -> BasinRun {
    let options = BakeOptions {
        closed: field.closed,
        threshold_m: 0.0,
        drains,
    };
    BasinRun::new(Arc::new(
        Basins::bake(&Grid::new(field.nx, field.nz, field.cell, &field.z), &options).unwrap(),
    ))
}

#[test]
fn inlets_take_what_the_manual_says() {
    let mut worst = Worst::default();
    let grate = Inlet::Grate(Grate {
        perimeter_m: 1.2,
        area_m2: 0.05,
    });
    for step in 0..4000 {
        let depth = 1e-6 * 1.004_f64.powi(step);
        worst.relative(grate.flow_m3_s(depth), inlet(1.2, 0.05, depth), 1e-300, || {
            format!("{depth} m")
        });
    }
    worst.assert_below(1e-14, 4000);
    let mut last = 0.0;
    for step in 0..1000 {
        let flow = grate.flow_m3_s(f64::from(step) * 1e-3);
        assert!(flow >= last);
        last = flow;
    }
}

#[test]
fn inlets_are_finite_and_checked() {
    for depth in [f64::NAN, f64::NEG_INFINITY, -1.0, 0.0, 1e-300, 1e300, f64::INFINITY] {
        let flow = Inlet::Constant { capacity_m3_s: 1.0 }.flow_m3_s(depth);
        assert_eq!(flow, if depth > 0.0 { 1.0 } else { 0.0 });
        assert_eq!(Inlet::Hole.flow_m3_s(depth), 0.0);
    }
    for value in [f64::NAN, -1.0, f64::INFINITY, 1e4] {
        assert!(Inlet::Constant { capacity_m3_s: value }.validated().is_err());
        assert!(
            Inlet::Grate(Grate {
                perimeter_m: value,
                area_m2: 0.1
            })
            .validated()
            .is_err()
        );
        assert!(
            Inlet::Grate(Grate {
                perimeter_m: 1.0,
                area_m2: value
            })
            .validated()
            .is_err()
        );
        let z = [0.0; 4];
        let drains = vec![Drain {
            x_m: value,
            z_m: 0.5,
            inlet: Inlet::Hole,
        }];
        assert!(
            Basins::bake(
                &Grid::new(2, 2, 1.0, &z),
                &BakeOptions {
                    drains,
                    ..BakeOptions::default()
                }
            )
            .is_err()
        );
    }
}

#[test]
fn a_grate_holds_the_level_that_an_integration_gives() {
    // A tub of 16 m² with walls 1 m high, a grate in its floor.
    let field = drawn(&["111111", "100001", "100001", "100001", "100001", "111111"]);
    let drain = Drain {
        x_m: 2.5,
        z_m: 2.5,
        inlet: Inlet::Grate(Grate {
            perimeter_m: 1.2,
            area_m2: 0.05,
        }),
    };
    let mut worst = Worst::default();
    for inflow in [1e-3, 5e-3, 3e-2] {
        let forcing = BasinForcing::rain(inflow / 16.0);
        for (start, time, steps) in [(0.0, 600.0, 1), (0.0, 600.0, 600), (4.8, 120.0, 1), (4.8, 120.0, 97)] {
            let [truth] = runge_kutta(0.0, time, [start], 20_000, |_, [volume]| {
                [inflow - inlet(1.2, 0.05, volume / 16.0)]
            });
            let mut run = with_drain(&field, vec![drain]);
            let catchment = run.basins().basins()[0].catchment_m2;
            run.set_exposure(&[16.0 / catchment]).unwrap();
            run.add_water(14, start).unwrap();
            for _ in 0..steps {
                run.advance(&forcing, time / f64::from(steps)).unwrap();
            }
            worst.relative(run.volume_m3(0), truth, 0.1, || {
                format!("{inflow} from {start} in {steps}")
            });
            assert!(run.ledger().residual_relative < 1e-12);
        }
    }
    worst.assert_below(1e-4, 12);
}

#[test]
fn a_constant_inlet_lets_the_rest_stand() {
    let field = drawn(&["55555", "50125", "55555"]);
    let drain = |capacity_m3_s| Drain {
        x_m: 2.5,
        z_m: 1.5,
        inlet: Inlet::Constant { capacity_m3_s },
    };
    let rate = |run: &BasinRun, inflow: f64| BasinForcing::rain(inflow / run.basins().basins()[0].catchment_m2);
    // It lies at 1 m: what is below stays; above it takes up to its capacity.
    let mut run = with_drain(&field, vec![drain(0.01)]);
    let forcing = rate(&run, 0.008);
    run.advance(&forcing, 500.0).unwrap();
    assert!((run.volume_m3(0) - 1.0).abs() < 1e-12, "held at its own level");
    assert!((run.ledger().drained_m3 - 0.008 * 375.0).abs() < 1e-12);
    let forcing = rate(&run, 0.012);
    run.advance(&forcing, 100.0).unwrap();
    assert!((run.volume_m3(0) - 1.2).abs() < 1e-12);
    run.advance(&BasinForcing::default(), 1e3).unwrap();
    assert!((run.volume_m3(0) - 1.0).abs() < 1e-12);
    assert!(run.ledger().residual_relative < 1e-13);
    let mut run = with_drain(&field, vec![drain(0.0)]);
    let forcing = rate(&run, 0.008);
    run.advance(&forcing, 500.0).unwrap();
    assert!((run.volume_m3(0) - 4.0).abs() < 1e-12, "a blocked one takes nothing");
}

#[test]
fn a_hole_takes_all() {
    let field = drawn(&["55555", "50125", "55555"]);
    let mut run = with_drain(
        &field,
        vec![Drain {
            x_m: 1.5,
            z_m: 1.5,
            inlet: Inlet::Hole,
        }],
    );
    assert!(run.basins().basins().is_empty() && run.basins().drains().is_empty());
    assert_eq!(run.basins().off_map_m2(), 14.0);
    run.advance(&BasinForcing::rain(1.0), 10.0).unwrap();
    run.add_water(7, 3.0).unwrap();
    assert_eq!(run.ledger().left_m3, 3.0);
}

proptest! {
    #![proptest_config(config(160))]

    #[test]
    fn steps_of_any_length_end_alike_with_inlets(field in small_fields(), seed in any::<u32>(), rain in 1e-5_f64..1e-2) {
        let pick = |turn: u64| unit(turn, 9, u64::from(seed));
        let drains = (0..3).map(|turn| Drain {
            x_m: pick(turn) * field.nx as f64 * field.cell,
            z_m: pick(turn + 10) * field.nz as f64 * field.cell,
            inlet: if pick(turn + 20) < 0.5 {
                Inlet::Constant { capacity_m3_s: 0.02 * pick(turn + 30) }
            } else {
                Inlet::Grate(Grate { perimeter_m: pick(turn + 40), area_m2: 0.1 * pick(turn + 50) })
            },
        });
        let start = with_drain(&field, drains.collect());
        let wet = BasinForcing { seepage_m_s: 0.2 * rain, ..BasinForcing::rain(rain) };
        let mut ends = Vec::new();
        for step in [400.0, 13.0] {
            let mut run = start.clone();
            for forcing in [wet, BasinForcing::default(), wet] {
                let mut now = 0.0;
                while now < 400.0 {
                    let next = f64::min(now + step, 400.0);
                    run.advance(&forcing, next - now).unwrap();
                    now = next;
                }
            }
            let ledger = run.ledger();
            prop_assert!(ledger.residual_relative < 1e-12, "{ledger:?}");
            prop_assert!(ledger.drained_m3 >= 0.0);
            ends.push(run);
        }
        for basin in 0..start.basins().basins().len() as u32 {
            let (a, b) = (ends[0].volume_m3(basin), ends[1].volume_m3(basin));
            prop_assert!((a - b).abs() <= 1e-9 * (1.0 + a), "basin {basin}: {a} {b}\n{field:?}");
        }
    }
}
