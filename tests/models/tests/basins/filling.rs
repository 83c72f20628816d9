//! Filling, spilling and merging without losses.

use std::sync::Arc;

use proptest::prelude::*;
use rain_core::surface::basins::{BakeOptions, BasinForcing, BasinRun, Basins, Grid};
use rain_reference::basins::{Field, Flooded, Tank, cascade};

use super::terrain::{bake, config, drawn, heights, small_fields, unit};
use crate::check::Worst;

fn run(field: &Field) -> BasinRun {
    BasinRun::new(Arc::new(bake(field)))
}

/// Whether no three pools meet in one pass, where which overflows into which is a matter of order.
fn plain(basins: &Basins) -> bool {
    let mut passes: Vec<_> = basins
        .basins()
        .iter()
        .map(|basin| (basin.spill_cell, basin.parent))
        .collect();
    passes.sort_unstable();
    passes
        .windows(2)
        .all(|pair| pair[0].0 != pair[1].0 || (pair[0].1 == pair[1].1 && pair[0].1.is_some()))
}

/// Whether all heights differ, so that every way downhill is known.
fn distinct(field: &Field) -> bool {
    let mut heights = field.z.clone();
    heights.sort_by(f64::total_cmp);
    heights.windows(2).all(|pair| pair[0] < pair[1])
}

/// Random or smooth ground, bent upwards for some seeds, so that there are pools inside pools.
fn bowl(nx: usize, nz: usize, seed: u64) -> Vec<f64> {
    let mut z = heights(nx, nz, if seed.is_multiple_of(2) { 1 } else { 4 }, seed);
    let bend = [0.0, 0.01, 0.04][seed as usize % 3];
    for (cell, height) in z.iter_mut().enumerate() {
        let (x, row) = (
            (cell % nx) as f64 - 0.5 * nx as f64,
            (cell / nx) as f64 - 0.5 * nz as f64,
        );
        *height += bend * (x * x + row * row);
    }
    z
}

/// Two tanks on a slope: A (3 cells' pit) spills into B, B off the map. Cell 1 m.
fn cascade_field() -> Field {
    // Row by row downhill; walls of 90 around; the way A → B → border is one cell wide.
    let mut field = drawn(&["zzzzzzzzz", "zzzzzzzzz", "zzzzzzzzz"]);
    // x: 1 pit A, 2 rim A, 3 pit B, 4 rim B, then down to the border.
    for (x, height) in [
        (1, 20.0),
        (2, 32.0),
        (3, 1.0),
        (4, 31.0),
        (5, 25.0),
        (6, 20.0),
        (7, 10.0),
        (8, 5.0),
    ] {
        field.z[9 + x] = height;
    }
    field
}

#[test]
fn the_cascade_fills_at_its_published_times() {
    // 12 L and 10 m², 30 L and 6 m²: depths in mm over one cell, catchments by exposure.
    let mut field = cascade_field();
    for height in &mut field.z {
        *height *= 1e-3;
    }
    field.cell = 1.0;
    let baked = Arc::new(Basins::bake(&Grid::new(9, 3, 1.0, &field.z), &BakeOptions::default()).unwrap());
    assert_eq!(baked.basins().len(), 2);
    let find = |bottom: f64| {
        baked
            .basins()
            .iter()
            .position(|basin| basin.bottom_m == bottom)
            .unwrap()
    };
    let (a, b) = (find(20e-3), find(1e-3));
    assert!((baked.basins()[a].volume_m3.unwrap() - 12e-3).abs() < 1e-15);
    assert!((baked.basins()[b].volume_m3.unwrap() - 30e-3).abs() < 1e-15);
    assert_eq!(
        (baked.basins()[a].overflows_to, baked.basins()[b].overflows_to),
        (Some(b as u32), None)
    );
    let mut exposure = [0.0; 2];
    exposure[a] = 10.0 / baked.basins()[a].catchment_m2;
    exposure[b] = 6.0 / baked.basins()[b].catchment_m2;
    let tanks = [
        Tank {
            capacity: 12e-3,
            catchment: 10.0,
            next: Some(1),
        },
        Tank {
            capacity: 30e-3,
            catchment: 6.0,
            next: None,
        },
    ];
    let rain = BasinForcing::rain(36.0 / 3.6e6);
    let mut worst = Worst::default();
    for (time, step) in [
        (120.0, 120.0),
        (120.0, 0.7),
        (262.5, 262.5),
        (262.5, 1.0 / 60.0),
        (362.5, 362.5),
        (362.5, 11.0),
    ] {
        let mut run = BasinRun::new(Arc::clone(&baked));
        run.set_exposure(&exposure).unwrap();
        let mut now = 0.0;
        while now < time {
            let next = f64::min(now + step, time);
            run.advance(&rain, next - now).unwrap();
            now = next;
        }
        let (volumes, left) = cascade(&tanks, 36.0 / 3.6e6, time);
        for (value, truth) in [
            (run.volume_m3(a as u32), volumes[0]),
            (run.volume_m3(b as u32), volumes[1]),
            (run.ledger().left_m3, left),
        ] {
            worst.relative(value, truth, 0.03, || format!("{time} s by {step} s"));
        }
        let (full_a, of_b, out) = match time {
            120.0 => (12e-3, 7.2e-3, 0.0),
            262.5 => (12e-3, 30e-3, 0.0),
            _ => (12e-3, 30e-3, 0.16e-3 * 100.0),
        };
        worst.relative(run.volume_m3(a as u32), full_a, 1e-3, || format!("A after {time} s"));
        worst.relative(run.volume_m3(b as u32), of_b, 1e-3, || format!("B after {time} s"));
        worst.relative(run.ledger().left_m3, out, 1e-3, || format!("left after {time} s"));
        assert!(run.ledger().residual_relative < 1e-14, "{:?}", run.ledger());
    }
    worst.assert_below(1e-11, 36);
    // A tank 5 % larger is seen.
    let wrong = [
        Tank {
            capacity: 12.6e-3,
            ..tanks[0]
        },
        tanks[1],
    ];
    assert!((cascade(&wrong, 36.0 / 3.6e6, 362.5).1 - 0.016).abs() > 1e-4);
}

#[test]
fn poured_water_stands_where_flooding_cell_by_cell_puts_it() {
    let mut exact = 0;
    let mut nested = 0;
    for seed in 0..200_u64 {
        let size = |salt| 6 + (unit(seed, salt, 8) * 8.0) as usize;
        let (nx, nz) = (size(0), size(1));
        let field = Field {
            nx,
            nz,
            cell: 0.5,
            z: bowl(nx, nz, seed),
            closed: false,
        };
        let mut run = run(&field);
        let basins = Arc::clone(run.basins());
        if !plain(&basins) || !distinct(&field) {
            continue;
        }
        exact += 1;
        nested += u32::from(basins.basins().iter().any(|basin| basin.children.is_some()));
        let mut truth = Flooded::new(field.clone());
        let total = basins.report().total_volume_m3.max(0.1);
        let mut poured = 0.0;
        for turn in 0..16 {
            let cell = (unit(turn, 1, seed) * field.z.len() as f64) as usize;
            let volume = 0.2 * total * unit(turn, 2, seed);
            run.add_water(cell, volume).unwrap();
            truth.pour(cell, volume);
            poured += volume;
            let ledger = run.ledger();
            assert!(ledger.residual_relative < 1e-14);
            assert!((ledger.added_m3 - poured).abs() < 1e-12 * poured);
            assert!(
                (ledger.left_m3 - truth.left).abs() < 1e-9 * poured,
                "seed {seed}: {} {}",
                ledger.left_m3,
                truth.left
            );
            for cell in 0..field.z.len() {
                let (depth, expected) = (run.depth_at(cell, field.z[cell]), truth.surface[cell] - field.z[cell]);
                assert!(
                    (depth - expected).abs() < 1e-9,
                    "seed {seed}, cell {cell}: {depth} {expected}"
                );
            }
        }
    }
    assert!(
        exact > 100 && nested > 50,
        "{exact} fields, {nested} with basins inside basins"
    );
}

proptest! {
    #![proptest_config(config(256))]

    #[test]
    fn steps_of_any_length_end_at_the_same_water(field in small_fields(), seed in any::<u32>()) {
        let start = run(&field);
        let basins = Arc::clone(start.basins());
        let exposure: Vec<f64> = (0..basins.basins().len()).map(|leaf| unit(leaf as u64, 3, u64::from(seed)) * 2.0).collect();
        let rain = BasinForcing::rain(1e-3);
        let mut ends = Vec::new();
        for step in [3000.0, 700.0, 61.0, 7.3] {
            let mut run = start.clone();
            run.set_exposure(&exposure).unwrap();
            let mut now = 0.0;
            while now < 3000.0 {
                let next = f64::min(now + step, 3000.0);
                run.advance(&rain, next - now).unwrap();
                now = next;
            }
            let ledger = run.ledger();
            prop_assert!(ledger.residual_relative < 1e-13, "{ledger:?}");
            prop_assert!((ledger.rain_m3 - 3.0 * exposed(&basins, &exposure)).abs() < 1e-12 * ledger.rain_m3.max(1e-3));
            ends.push(run);
        }
        for end in &ends[1..] {
            for basin in 0..basins.basins().len() as u32 {
                let (a, b) = (ends[0].volume_m3(basin), end.volume_m3(basin));
                prop_assert!((a - b).abs() <= 1e-9 * (1.0 + a), "basin {basin}: {a} {b}\n{field:?}");
            }
        }
    }
}

#[test]
fn rain_in_small_parcels_ends_in_the_same_pools() {
    let mut compared = 0;
    for seed in 0..80_u64 {
        let field = Field {
            nx: 10,
            nz: 9,
            cell: 0.5,
            z: bowl(10, 9, seed),
            closed: false,
        };
        let mut run = run(&field);
        let basins = Arc::clone(run.basins());
        if !plain(&basins) || !distinct(&field) || basins.basins().is_empty() {
            continue;
        }
        let mut truth = Flooded::new(field.clone());
        let time = 0.6 * basins.report().total_volume_m3 / (90.0 * 0.25) / 1e-3;
        run.advance(&BasinForcing::rain(1e-3), time).unwrap();
        let parcels = 400;
        let leaves = basins.basins().iter().filter(|basin| basin.children.is_none());
        for _ in 0..parcels {
            for leaf in leaves.clone() {
                truth.pour(
                    leaf.pit_cell as usize,
                    leaf.catchment_m2 * 1e-3 * time / f64::from(parcels),
                );
            }
        }
        let rain = run.ledger().rain_m3;
        assert!((rain - truth.left - truth.stored()).abs() < 1e-9 * rain);
        assert!((run.ledger().left_m3 - truth.left).abs() < 0.01 * rain, "seed {seed}");
        let volume = |depth: &dyn Fn(usize) -> f64| (0..90).map(depth).sum::<f64>();
        let apart = |cell: usize| (run.depth_at(cell, field.z[cell]) - truth.surface[cell] + field.z[cell]).abs();
        assert!(
            volume(&apart) * 0.25 < 0.02 * rain,
            "seed {seed}: {} of {rain}",
            volume(&apart) * 0.25
        );
        compared += 1;
    }
    assert!(compared > 50, "{compared}");
}

fn exposed(basins: &Basins, exposure: &[f64]) -> f64 {
    let leaves = basins
        .basins()
        .iter()
        .zip(exposure)
        .filter(|(basin, _)| basin.children.is_none());
    leaves.map(|(basin, share)| basin.catchment_m2 * share).sum()
}

#[test]
fn two_pools_meet_and_part_and_meet_again() {
    let field = drawn(&["99999999", "95555559", "95155259", "95555559", "97999999"]);
    let mut run = run(&field);
    let basins = Arc::clone(run.basins());
    let top = basins.basins().iter().position(|basin| basin.parent.is_none()).unwrap() as u32;
    let [a, b] = basins.basins()[top as usize].children.unwrap();
    let cells = [2 * 8 + 2, 2 * 8 + 5];
    run.add_water(cells[0], 5.0).unwrap();
    assert_eq!(
        (run.volume_m3(a), run.volume_m3(b), run.volume_m3(top)),
        (4.0, 1.0, 5.0)
    );
    assert_eq!(
        (run.level_m(a), run.level_m(b), run.level_m(top)),
        (Some(5.0), Some(3.0), None)
    );
    run.add_water(cells[0], 2.0 + 9.0).unwrap();
    assert_eq!(
        (run.level_m(a), run.level_m(b), run.level_m(top)),
        (Some(5.5), Some(5.5), Some(5.5))
    );
    assert_eq!((run.volume_m3(a), run.volume_m3(top)), (4.0, 16.0));
    assert_eq!(run.depth_at(8 + 1, 5.0), 0.5);
    // The wheel takes the sheet above the sill and then only what is in its own pool.
    assert_eq!(run.remove_water(cells[1], 11.0).unwrap(), 11.0);
    assert_eq!((run.volume_m3(a), run.volume_m3(b)), (4.0, 1.0));
    assert_eq!(run.remove_water(cells[1], 11.0).unwrap(), 1.0);
    assert_eq!(
        (run.volume_m3(a), run.volume_m3(b), run.level_at(cells[1])),
        (4.0, 0.0, Some(2.0))
    );
    run.add_water(cells[1], 3.0 + 36.0 + 8.0).unwrap();
    let ledger = run.ledger();
    assert_eq!(
        (run.level_m(top), ledger.left_m3, ledger.removed_m3, ledger.stored_m3),
        (Some(7.0), 8.0, 12.0, 43.0)
    );
    assert_eq!(ledger.residual_relative, 0.0);
}

#[test]
fn what_stands_still_is_settled_and_still_counts() {
    let field = drawn(&["9999999", "9141239", "9999995", "9999999"]);
    let mut run = run(&field);
    assert!(!run.is_settled());
    run.advance(&BasinForcing::default(), 1.0).unwrap();
    assert!(run.is_settled(), "dry");
    let rain = BasinForcing::rain(1e-2);
    run.advance(&rain, 1e4).unwrap();
    run.advance(&rain, 1.0).unwrap();
    assert!(run.is_settled(), "all full and spilling");
    let before = run.ledger();
    for _ in 0..1000 {
        run.advance(&rain, 0.1).unwrap();
    }
    let after = run.ledger();
    assert_eq!(after.stored_m3, before.stored_m3);
    let (rained, left) = (after.rain_m3 - before.rain_m3, after.left_m3 - before.left_m3);
    assert!(rained > 0.0 && (rained - left).abs() < 1e-11 * rained);
    assert!(after.residual_relative < 1e-14);
    run.remove_water(7 + 1, 0.1).unwrap();
    assert!(!run.is_settled());
}
