//! Losses on the wet area.

use std::sync::Arc;

use proptest::prelude::*;
use rain_core::surface::basins::{BakeOptions, BasinForcing, BasinRun, Basins, Drain, Grid, Inlet};
use rain_reference::basins::{lossy_volume, paraboloid_depth};

use super::terrain::{bake, config, small_fields, unit};
use crate::check::Worst;

const MM_H: f64 = 1.0 / 3.6e6;

/// z = r²/(2·200 m) on cells of 2 cm, up to r = 2.2 m.
fn paraboloid() -> (Arc<Basins>, usize) {
    let n = 221;
    let z: Vec<f64> = (0..n * n)
        .map(|cell| {
            let (x, z) = ((cell % n) as f64 - 110.0, (cell / n) as f64 - 110.0);
            (x * x + z * z) * 4e-4 / 400.0
        })
        .collect();
    let baked = Basins::bake(&Grid::new(n, n, 0.02, &z), &BakeOptions::default()).unwrap();
    assert_eq!(baked.basins().len(), 1);
    (Arc::new(baked), 110 * n + 110)
}

#[test]
fn a_paraboloid_fills_as_in_the_closed_form() {
    let (baked, centre) = paraboloid();
    let catchment = baked.basins()[0].catchment_m2;
    let inflow = 30e-3 / 3600.0;
    let forcing = BasinForcing {
        evaporation_m_s: 2.0 * MM_H,
        seepage_m_s: 1.0 * MM_H,
        ..BasinForcing::rain(inflow / catchment)
    };
    let mut worst = Worst::default();
    let published = [
        (600.0, 2.497_936e-3),
        (3600.0, 5.071_979e-3),
        (7200.0, 6.250_890e-3),
        (36000.0, 7.889_677e-3),
    ];
    for (time, depth) in published {
        let truth = paraboloid_depth(200.0, inflow, 3.0 * MM_H, time);
        assert!((truth - depth).abs() < 1e-9, "{truth}");
        for steps in [1, 37] {
            let mut run = BasinRun::new(Arc::clone(&baked));
            for _ in 0..steps {
                run.advance(&forcing, time / f64::from(steps)).unwrap();
            }
            let level = run.level_at(centre).unwrap();
            worst.relative(level, truth, 1e-9, || format!("{time} s in {steps}"));
            let ledger = run.ledger();
            assert!(ledger.residual_relative < 1e-12, "{ledger:?}");
            assert!((ledger.evaporated_m3 / ledger.infiltrated_m3 - 2.0).abs() < 1e-12);
            if time == 3600.0 {
                worst.relative(run.volume_m3(0), 16.163_48e-3, 1e-9, || "volume".into());
                let area = baked.curve(0).area_m2(run.volume_m3(0));
                assert!((area - 6.373_64).abs() < 0.01, "{area}");
            }
        }
    }
    // Cells of 2 cm under a pool 1 to 2 m across.
    worst.assert_below(1e-3, 9);
    let wrong = paraboloid_depth(200.0, inflow * 1.05, 3.0 * MM_H, 3600.0);
    assert!((wrong / 5.071_979e-3 - 1.0).abs() > 1e-2);
}

#[test]
fn a_pool_without_inflow_dries_at_the_rate_of_evaporation() {
    let (baked, centre) = paraboloid();
    let mut run = BasinRun::new(Arc::clone(&baked));
    run.add_water(centre, baked.curve(0).volume_m3(5e-3)).unwrap();
    let dry = BasinForcing {
        evaporation_m_s: 3.0 * MM_H,
        ..BasinForcing::default()
    };
    let mut worst = Worst::default();
    for minute in 1..=100 {
        run.advance(&dry, 60.0).unwrap();
        worst.absolute(
            run.level_at(centre).unwrap(),
            5e-3 - 3.0 * MM_H * 60.0 * f64::from(minute),
            || format!("{minute} min"),
        );
    }
    worst.assert_below(1e-12, 100);
    assert!(run.volume_m3(0) < 1e-15);
    run.advance(&dry, 60.0).unwrap();
    run.advance(&dry, 60.0).unwrap();
    assert!(run.is_settled() && run.ledger().residual_relative < 1e-12);
}

#[test]
fn losses_follow_a_rough_bottom() {
    let n = 12;
    let inside = |cell: usize| (1..n - 1).contains(&(cell % n)) && (1..n - 1).contains(&(cell / n));
    let z: Vec<f64> = (0..n * n)
        .map(|cell| {
            let (x, y) = ((cell % n) as f64 - 5.5, (cell / n) as f64 - 5.5);
            if inside(cell) {
                2e-4 * (x * x + y * y) + 1e-5 * unit(cell as u64, 0, 5)
            } else {
                0.1
            }
        })
        .collect();
    let baked = Arc::new(Basins::bake(&Grid::new(n, n, 0.5, &z), &BakeOptions::default()).unwrap());
    assert_eq!(baked.basins().iter().filter(|basin| basin.parent.is_none()).count(), 1);
    let catchment = baked.basins().last().unwrap().catchment_m2;
    let cells: Vec<f64> = (0..n * n).filter(|&cell| inside(cell)).map(|cell| z[cell]).collect();
    let mut worst = Worst::default();
    for (inflow, loss, time) in [(2e-5, 2e-6, 1800.0), (2e-5, 5e-6, 3600.0), (5e-5, 1e-6, 900.0)] {
        let truth = lossy_volume(&cells, 0.5, inflow, loss, time);
        let forcing = BasinForcing {
            seepage_m_s: loss,
            ..BasinForcing::rain(inflow / catchment)
        };
        for steps in [1, 100] {
            let mut run = BasinRun::new(Arc::clone(&baked));
            for _ in 0..steps {
                run.advance(&forcing, time / f64::from(steps)).unwrap();
            }
            worst.relative(run.ledger().stored_m3, truth, 1e-9, || {
                format!("{inflow} {loss} {steps}")
            });
        }
        assert!(truth > 1e-4);
    }
    worst.assert_below(1e-10, 6);
    let wrong = lossy_volume(&cells, 0.5, 2e-5, 1.05 * 2e-6, 1800.0);
    assert!((wrong / lossy_volume(&cells, 0.5, 2e-5, 2e-6, 1800.0) - 1.0).abs() > 1e-3);
}

#[test]
fn a_pool_that_rested_at_a_bend_leaves_it_the_same_way_however_time_is_cut() {
    let mut rose = 0;
    for case in 0..200_u64 {
        let pick = |what: u64| unit(case, what, 21);
        // A pit in a level yard of five cells: the drain holds the pool at the yard's level, until rain on open water
        // alone is more than runoff and all losses, and wetting the yard pays.
        let z = [0.0, 0.0, -1.0, 0.0, 0.0];
        let drain = Drain {
            x_m: 1.25,
            z_m: 0.25,
            inlet: Inlet::Constant {
                capacity_m3_s: 1e-4 + 4e-4 * pick(0),
            },
        };
        let options = BakeOptions {
            closed: true,
            drains: vec![drain],
            ..BakeOptions::default()
        };
        let baked = Arc::new(Basins::bake(&Grid::new(5, 1, 0.5, &z), &options).unwrap());
        let wet = BasinForcing {
            rain_m_s: 1e-4 * pick(1),
            runoff_m_s: 1.7e-3,
            evaporation_m_s: 1e-4 + 1e-4 * pick(2),
            seepage_m_s: 6e-4,
        };
        let open = BasinForcing {
            rain_m_s: 1.9e-3,
            runoff_m_s: 3e-5 * pick(3),
            ..wet
        };
        let ends = [1500.0, 310.0, 11.7].map(|step| {
            let mut run = BasinRun::new(Arc::clone(&baked));
            let mut rested = 0.0;
            for forcing in [&wet, &open] {
                let mut now = 0.0;
                while now < 1500.0 {
                    let next = f64::min(now + step, 1500.0);
                    run.advance(forcing, next - now).unwrap();
                    now = next;
                }
                if forcing == &wet {
                    rested = run.volume_m3(0);
                }
            }
            assert!(run.ledger().residual_relative < 1e-12);
            (rested, run.volume_m3(0))
        });
        for end in &ends {
            assert!((end.1 - ends[0].1).abs() < 1e-9, "case {case}: {ends:?}");
            rose += u32::from(end.0 == 0.25 && end.1 > 0.25);
        }
    }
    assert!(rose > 100, "{rose}: the balance was there");
}

/// A lake in a bowl of n² cells, and so many hollows on the slope above that overflow into it one by one.
fn lake(n: usize, every: usize) -> Arc<Basins> {
    let (width, middle) = (2 * n, (n / 2) as f64);
    let brim = 2e-5 * middle * middle;
    let z: Vec<f64> = (0..width * n)
        .map(|cell| {
            let (x, y) = ((cell % width) as f64, (cell / width) as f64);
            let border = x == 0.0 || y == 0.0 || x == (width - 1) as f64 || y == (n - 1) as f64;
            let hollow = [cell % width, cell / width].map(|at| at % every == every / 2);
            if border {
                if x == 0.0 && y == middle { brim } else { 1e3 }
            } else if x < n as f64 {
                1e-5 * ((x - middle).powi(2) + (y - middle).powi(2)) + 1e-9 * unit(cell as u64, 0, 3)
            } else {
                let slope = brim + (x - n as f64) * 0.01 + (y - middle).abs() * 1e-4;
                slope
                    - if hollow == [true; 2] {
                        0.05 * (0.2 + unit(cell as u64, 1, 3))
                    } else {
                        0.0
                    }
            }
        })
        .collect();
    Arc::new(Basins::bake(&Grid::new(width, n, 0.1, &z), &BakeOptions::default()).unwrap())
}

#[test]
fn many_inflows_into_a_lake_with_losses_end_as_in_short_steps() {
    let baked = lake(61, 5);
    assert!(baked.basins().len() > 100);
    let forcing = BasinForcing {
        evaporation_m_s: 1.5e-5,
        ..BasinForcing::rain(1e-5)
    };
    let ends = [1, 400].map(|steps| {
        let mut run = BasinRun::new(Arc::clone(&baked));
        for _ in 0..steps {
            run.advance(&forcing, 2e4 / f64::from(steps)).unwrap();
        }
        let ledger = run.ledger();
        assert!(ledger.residual_relative < 1e-12, "{ledger:?}");
        run
    });
    let mut worst = Worst::default();
    for basin in 0..baked.basins().len() as u32 {
        worst.absolute(ends[1].volume_m3(basin), ends[0].volume_m3(basin), || {
            format!("{basin}")
        });
    }
    worst.assert_below(1e-9, 100);
}

proptest! {
    #![proptest_config(config(192))]

    #[test]
    fn steps_of_any_length_end_alike_with_losses(field in small_fields(), loss in 0.0_f64..8e-4, direct in 0.0_f64..2e-3) {
        let baked = Arc::new(bake(&field));
        let wet = BasinForcing { rain_m_s: direct, runoff_m_s: 1e-3, evaporation_m_s: 0.25 * loss, seepage_m_s: loss };
        let dry = BasinForcing { rain_m_s: 0.0, runoff_m_s: 2e-5, ..wet };
        let mut ends = Vec::new();
        for step in [1500.0, 310.0, 11.7] {
            let mut run = BasinRun::new(Arc::clone(&baked));
            for forcing in [&wet, &dry, &wet] {
                let mut now = 0.0;
                while now < 1500.0 {
                    let next = f64::min(now + step, 1500.0);
                    run.advance(forcing, next - now).unwrap();
                    now = next;
                }
            }
            let ledger = run.ledger();
            prop_assert!(ledger.residual_relative < 1e-12, "{ledger:?}");
            ends.push(run);
        }
        for end in &ends[1..] {
            for basin in 0..baked.basins().len() as u32 {
                let (a, b) = (ends[0].volume_m3(basin), end.volume_m3(basin));
                prop_assert!((a - b).abs() <= 1e-9 * (1.0 + a), "basin {basin}: {a} {b}\n{field:?}");
            }
        }
    }

    #[test]
    fn more_rain_never_leaves_less_water(field in small_fields(), loss in 0.0_f64..8e-4, rain in 1e-5_f64..1e-3) {
        let baked = Arc::new(bake(&field));
        let stored = |rain: f64| {
            let mut run = BasinRun::new(Arc::clone(&baked));
            run.advance(&BasinForcing { seepage_m_s: loss, ..BasinForcing::rain(rain) }, 900.0).unwrap();
            let ledger = run.ledger();
            assert!(ledger.stored_m3 >= 0.0 && ledger.infiltrated_m3 >= 0.0 && ledger.left_m3 >= 0.0);
            ledger.stored_m3
        };
        prop_assert!(stored(1.1 * rain) >= stored(rain) - 1e-12);
    }
}
