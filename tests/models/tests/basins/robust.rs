//! Random histories, bad input, saved states, allocations.

use std::sync::Arc;

use proptest::prelude::*;
use rain_core::surface::Grate;
use rain_core::surface::basins::{BakeOptions, BasinForcing, BasinRun, Basins, Drain, Grid, Inlet};

use super::terrain::{bake, config, drawn, heights, small_fields, unit};

proptest! {
    #![proptest_config(config(192))]

    #[test]
    fn no_history_loses_water(field in small_fields(), seed in any::<u32>()) {
        let pick = |turn: u64, what: u64| unit(turn, what, u64::from(seed));
        let inlet = Inlet::Grate(Grate { perimeter_m: 0.4, area_m2: 0.01 });
        let drains = vec![Drain { x_m: pick(0, 20) * field.nx as f64 * 0.5, z_m: pick(1, 20) * field.nz as f64 * 0.5, inlet }];
        let options = BakeOptions { closed: field.closed, threshold_m: pick(2, 20) * 0.2, drains };
        let baked = Arc::new(Basins::bake(&Grid::new(field.nx, field.nz, field.cell, &field.z), &options).unwrap());
        let mut run = BasinRun::new(Arc::clone(&baked));
        for turn in 0..120 {
            let cell = (pick(turn, 1) * field.z.len() as f64) as usize;
            let kind = (pick(turn, 2) * 6.0) as u32;
            match kind {
                0 => run.add_water(cell, pick(turn, 3)).unwrap(),
                1 => {
                    let wanted = pick(turn, 3);
                    let taken = run.remove_water(cell, wanted).unwrap();
                    prop_assert!((0.0..=wanted).contains(&taken));
                }
                2 => {
                    let exposure: Vec<f64> = (0..baked.basins().len()).map(|leaf| pick(leaf as u64, 100 + turn)).collect();
                    run.set_exposure(&exposure).unwrap();
                }
                _ => {
                    let scale = 10_f64.powf(-1.0 - 6.0 * pick(turn, 4));
                    let forcing = BasinForcing {
                        rain_m_s: scale * pick(turn, 5),
                        runoff_m_s: scale * pick(turn, 6),
                        evaporation_m_s: scale * (pick(turn, 7) - 0.5).max(0.0),
                        seepage_m_s: scale * (pick(turn, 8) - 0.5).max(0.0),
                    };
                    run.advance(&forcing, 10_f64.powf(7.0 * pick(turn, 9) - 3.0)).unwrap();
                }
            }
            let ledger = run.ledger();
            prop_assert!(ledger.residual_relative < 1e-12, "turn {turn}: {ledger:?}\n{field:?}");
            for (basin, at) in baked.basins().iter().enumerate() {
                let volume = run.volume_m3(basin as u32);
                let most = at.volume_m3.unwrap_or(f64::INFINITY);
                prop_assert!(volume >= 0.0 && volume <= most * (1.0 + 1e-9) + 1e-12, "turn {turn} basin {basin}: {volume} of {most}");
                if let Some(children) = at.children && run.level_m(basin as u32).is_none() {
                    let parts: f64 = children.iter().map(|&child| run.volume_m3(child)).sum();
                    prop_assert!((volume - parts).abs() <= 1e-12 * parts, "turn {turn} basin {basin}: {volume} of {parts}");
                }
                if let Some(level) = run.level_m(basin as u32) {
                    prop_assert!(level.is_finite() && level >= at.bottom_m);
                }
            }
            let tops = (0..baked.basins().len() as u32).filter(|&basin| baked.basins()[basin as usize].parent.is_none());
            let stored: f64 = tops.map(|top| run.volume_m3(top)).sum();
            prop_assert!((stored - ledger.stored_m3).abs() <= 1e-9 * stored.max(1e-6), "turn {turn}: {stored} of {ledger:?}");
            let again = BasinRun::restore(Arc::clone(&baked), run.state().clone()).unwrap();
            prop_assert_eq!(again.ledger(), ledger);
        }
    }
}

#[test]
fn a_restored_run_goes_on_as_the_first() {
    let field = rain_reference::basins::Field {
        nx: 12,
        nz: 12,
        cell: 0.5,
        z: heights(12, 12, 1, 77),
        closed: false,
    };
    let baked = Arc::new(bake(&field));
    let mut first = BasinRun::new(Arc::clone(&baked));
    let forcing = BasinForcing {
        seepage_m_s: 1e-5,
        ..BasinForcing::rain(1e-4)
    };
    for _ in 0..50 {
        first.advance(&forcing, 9.0).unwrap();
    }
    let mut second = BasinRun::restore(Arc::clone(&baked), first.state().clone()).unwrap();
    for _ in 0..50 {
        first.advance(&forcing, 9.0).unwrap();
        second.advance(&forcing, 9.0).unwrap();
        assert_eq!(first.state(), second.state());
    }
    let other = Arc::new(bake(&drawn(&["999", "919", "999"])));
    assert!(
        BasinRun::restore(other, first.state().clone()).is_err(),
        "the state of other basins"
    );
}

#[test]
fn a_state_that_is_full_below_the_brim_is_refused() {
    for closed in [false, true] {
        let field = rain_reference::basins::Field {
            closed,
            ..drawn(&["999", "919", "999"])
        };
        let baked = Arc::new(bake(&field));
        let mut run = BasinRun::new(Arc::clone(&baked));
        run.add_water(4, 1.0).unwrap();
        let text = ron::to_string(run.state()).unwrap();
        let full = text.replace("full:[false]", "full:[true]");
        assert_ne!(text, full);
        assert!(BasinRun::restore(Arc::clone(&baked), ron::from_str(&text).unwrap()).is_ok());
        assert!(
            BasinRun::restore(baked, ron::from_str(&full).unwrap()).is_err(),
            "{closed}"
        );
    }
}

#[test]
fn bad_steps_are_refused_and_change_nothing() {
    let mut run = BasinRun::new(Arc::new(bake(&drawn(&["999", "919", "999"]))));
    run.add_water(4, 1.0).unwrap();
    let before = run.state().clone();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 1e10] {
        assert!(run.advance(&BasinForcing::rain(1e-6), bad).is_err());
        assert!(run.advance(&BasinForcing::rain(bad), 1.0).is_err());
        assert!(
            run.advance(
                &BasinForcing {
                    evaporation_m_s: bad,
                    ..BasinForcing::default()
                },
                1.0
            )
            .is_err()
        );
        assert!(
            run.advance(
                &BasinForcing {
                    seepage_m_s: bad,
                    ..BasinForcing::default()
                },
                1.0
            )
            .is_err()
        );
        assert!(
            run.advance(
                &BasinForcing {
                    rain_m_s: bad,
                    ..BasinForcing::default()
                },
                1.0
            )
            .is_err()
        );
        assert!(run.set_exposure(&[bad]).is_err());
        assert!(run.add_water(4, bad * 1e6).is_err() && run.remove_water(4, bad * 1e6).is_err());
    }
    assert!(run.set_exposure(&[]).is_err());
    assert_eq!(run.state(), &before);
    run.advance(&BasinForcing::rain(1e-6), 0.0).unwrap();
    assert_eq!(run.state(), &before, "no time, no change");
    assert_eq!(
        (run.remove_water(0, 0.0).unwrap(), run.remove_water(99, 1.0).unwrap()),
        (0.0, 0.0)
    );
    assert_eq!(
        (run.level_at(99), run.depth_at(4, f64::NAN), run.depth_at(99, 0.0)),
        (None, 0.0, 0.0)
    );
    assert_eq!(
        (
            run.basins().cell_at(1.5, 1.5),
            run.basins().cell_at(-0.1, 0.0),
            run.basins().cell_at(3.0, 0.0)
        ),
        (Some(4), None, None)
    );
}

#[test]
fn curves_clamp_and_hold_no_nan() {
    let baked = bake(&drawn(&["9999999", "9151299", "9999999"]));
    for basin in 0..baked.basins().len() as u32 {
        let curve = baked.curve(basin);
        for x in [f64::NAN, f64::NEG_INFINITY, -1.0, 0.0, 1e-300, 1e300, f64::INFINITY] {
            assert!(curve.depth_m(x).is_finite() && curve.volume_m3(x).is_finite() && curve.area_m2(x).is_finite());
        }
        assert_eq!(curve.volume_m3(f64::INFINITY), curve.capacity_m3());
        assert_eq!(curve.area_m2(f64::INFINITY), curve.full_area_m2());
    }
}

#[test]
fn curves_without_a_brim_end_at_a_depth_that_is_a_number() {
    for rows in [["999", "919", "999"], ["393", "313", "333"]] {
        let baked = bake(&rain_reference::basins::Field {
            closed: true,
            ..drawn(&rows)
        });
        let top = baked.basins().len() as u32 - 1;
        let curve = baked.curve(top);
        assert_eq!(curve.capacity_m3(), f64::INFINITY);
        let mut before = (0.0, 0.0);
        for x in [f64::NAN, -1.0, 0.0, 1.0, 1e6, 1e30, 1e300, f64::INFINITY] {
            let now = (curve.depth_m(x), curve.volume_m3(x));
            assert!(now.0.is_finite() && now.1.is_finite(), "{x}: {now:?}");
            assert!(now.0 >= before.0 && now.1 >= before.1, "{x}: {now:?} after {before:?}");
            before = now;
        }
        assert_eq!(before, (curve.depth_m(1e30), curve.volume_m3(1e30)));
    }
}

#[test]
fn steps_and_questions_allocate_nothing() {
    let field = rain_reference::basins::Field {
        nx: 64,
        nz: 64,
        cell: 0.5,
        z: heights(64, 64, 1, 3),
        closed: false,
    };
    let mut run = BasinRun::new(Arc::new(bake(&field)));
    let rain = BasinForcing {
        evaporation_m_s: 1e-6,
        ..BasinForcing::rain(1e-4)
    };
    let dry = BasinForcing {
        evaporation_m_s: 1e-5,
        ..BasinForcing::default()
    };
    let basins = run.basins().basins().len() as u32;
    let exposure = vec![0.9; basins as usize];
    let info = allocation_counter::measure(|| {
        for turn in 0..200 {
            let forcing = if turn % 50 < 30 { &rain } else { &dry };
            run.advance(forcing, 20.0).unwrap();
            run.add_water(turn * 7, 0.01).unwrap();
            run.remove_water(turn * 11, 0.02).unwrap();
            run.set_exposure(&exposure).unwrap();
            for basin in 0..basins {
                std::hint::black_box((run.volume_m3(basin), run.level_m(basin)));
            }
            std::hint::black_box((run.depth_at(turn * 5, 0.1), run.ledger(), run.is_settled()));
        }
    });
    assert_eq!(info.count_total, 0);
    assert!(run.ledger().left_m3 > 0.0 && run.ledger().residual_relative < 1e-12);
}

#[test]
fn the_bake_is_the_same_every_time() {
    let z = heights(96, 64, 0, 5);
    let grid = Grid::new(96, 64, 1.0, &z);
    let first = Basins::bake(&grid, &BakeOptions::default()).unwrap();
    assert!(first.basins().len() > 100);
    assert_eq!(first, Basins::bake(&grid, &BakeOptions::default()).unwrap());
}

#[test]
fn a_state_that_was_written_down_goes_on_to_the_same_bits() {
    let field = rain_reference::basins::Field {
        nx: 48,
        nz: 48,
        cell: 0.5,
        z: heights(48, 48, 2, 3),
        closed: false,
    };
    let baked = Arc::new(bake(&field));
    let mut run = BasinRun::new(Arc::clone(&baked));
    let rain = BasinForcing {
        evaporation_m_s: 1e-6,
        ..BasinForcing::rain(1e-4)
    };
    for _ in 0..50 {
        run.advance(&rain, 7.3).unwrap();
    }
    let text = ron::to_string(run.state()).unwrap();
    let mut restored = BasinRun::restore(Arc::clone(&baked), ron::from_str(&text).unwrap()).unwrap();
    assert_eq!(restored.state(), run.state());
    for run in [&mut run, &mut restored] {
        for _ in 0..50 {
            run.advance(&rain, 3.1).unwrap();
        }
    }
    assert_eq!(restored.state(), run.state());
    assert!(run.ledger().rain_m3 > 0.0);
    // A state of other basins is refused.
    let other = Arc::new(bake(&rain_reference::basins::Field {
        z: heights(48, 48, 5, 3),
        ..field
    }));
    assert!(BasinRun::restore(other, ron::from_str(&text).unwrap()).is_err());
}
