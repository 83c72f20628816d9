//! What the baker finds.

use proptest::prelude::*;
use rain_core::surface::basins::{BakeOptions, Basins, Grid};
use rain_reference::basins::Field;

use super::terrain::{bake, config, drawn, small_fields};
use crate::check::Worst;

fn same(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a == b || (a.is_nan() && b.is_nan()))
}

proptest! {
    #![proptest_config(config(256))]

    #[test]
    fn filled_surface_is_that_of_the_sweeps(field in small_fields()) {
        let filled = bake(&field).filled(&field.z).unwrap();
        let mut truth = field.filled();
        prop_assert!(same(&filled, &truth), "{field:?}\n{filled:?}\n{truth:?}");
        if let Some(first) = truth.iter_mut().find(|level| level.is_finite()) {
            *first += 1e-9;
            prop_assert!(!same(&filled, &truth), "the comparison finds a wrong cell");
        }
    }

    #[test]
    fn top_basins_are_the_connected_wet_sets(field in small_fields()) {
        let baked = bake(&field);
        let filled = field.filled();
        let mut sets: Vec<(usize, f64, f64)> = field
            .wet_sets()
            .iter()
            .map(|set| {
                let volume = field.volume(set, filled[set[0]]);
                let lowest = set.iter().copied().min_by(|&a, &b| field.z[a].total_cmp(&field.z[b]).then(a.cmp(&b)));
                (lowest.unwrap(), volume, set.len() as f64 * 0.25)
            })
            .collect();
        sets.sort_by_key(|set| set.0);
        let report = baked.report();
        let cell = |row: &rain_core::surface::basins::BasinRow| (row.z_m / 0.5) as usize * field.nx + (row.x_m / 0.5) as usize;
        let mut tops: Vec<_> = report.basins.iter().filter(|row| row.parent.is_none()).collect();
        tops.sort_by_key(|row| cell(row));
        prop_assert_eq!(tops.len(), sets.len(), "{:?}", field);
        let mut total = 0.0;
        for (row, (pit, volume, area)) in tops.iter().zip(&sets) {
            prop_assert_eq!(cell(row), *pit);
            prop_assert_eq!(row.area_m2, *area);
            prop_assert_eq!(row.bottom_m, field.z[*pit]);
            if filled[*pit].is_finite() {
                prop_assert_eq!(row.spill_m, Some(filled[*pit]));
                prop_assert!((row.volume_m3.unwrap() - volume).abs() <= 1e-12 * volume);
                total += volume;
            } else {
                prop_assert_eq!((row.spill_m, row.volume_m3, row.overflows_to), (None, None, None));
            }
        }
        prop_assert!((report.total_volume_m3 - total).abs() <= 1e-12 * total);
    }

    #[test]
    fn curves_are_those_of_flooding_at_every_level(field in small_fields()) {
        let baked = bake(&field);
        for (index, basin) in baked.basins().iter().enumerate() {
            let curve = baked.curve(index as u32);
            let spill = basin.spill_m.unwrap_or(basin.sill_m + 3.0);
            for share in [0.001, 0.3, 0.77, 1.0] {
                let level = if share < 1.0 { basin.sill_m + share * (spill - basin.sill_m) } else { spill };
                if level <= basin.sill_m {
                    continue;
                }
                let cells = field.connected(basin.pit_cell as usize, |cell| field.z[cell] < level);
                prop_assert!(!cells.iter().any(|&cell| field.is_outlet(cell) && field.z[cell] < level));
                let truth = field.volume(&cells, level);
                let volume = curve.volume_m3(level - basin.bottom_m);
                prop_assert!((volume - truth).abs() <= 1e-12 * truth, "{volume} {truth} basin {index} level {level}\n{field:?}");
                let depth = curve.depth_m(truth);
                prop_assert!((depth - (level - basin.bottom_m)).abs() <= 1e-12 * depth);
                if share < 1.0 {
                    prop_assert_eq!(curve.area_m2(truth), cells.len() as f64 * 0.25);
                }
            }
            // Just above the spill level it is more than itself.
            if let Some(spill) = basin.spill_m {
                let cells = field.connected(basin.pit_cell as usize, |cell| field.z[cell] <= spill);
                let own = field.connected(basin.pit_cell as usize, |cell| field.z[cell] < spill);
                let out = cells.iter().any(|&cell| field.is_outlet(cell));
                let lower = cells.iter().any(|&cell| field.z[cell] < spill && !own.contains(&cell));
                prop_assert!(out || lower, "basin {index} of {field:?}");
            }
        }
    }

    #[test]
    fn every_pit_is_a_leaf_and_every_cell_runs_to_one_or_off_the_map(field in small_fields()) {
        let baked = bake(&field);
        let leaves: Vec<_> = baked.basins().iter().filter(|basin| basin.children.is_none()).collect();
        let mut pits: Vec<u32> = field.pits().iter().map(|pit| pit[0] as u32).collect();
        let mut found: Vec<u32> = leaves.iter().map(|leaf| leaf.pit_cell).collect();
        pits.sort_unstable();
        found.sort_unstable();
        prop_assert_eq!(found, pits);
        let area: f64 = leaves.iter().map(|leaf| leaf.catchment_m2).sum();
        let ground = field.z.iter().filter(|z| !z.is_nan()).count() as f64 * 0.25;
        prop_assert_eq!(area + baked.off_map_m2(), ground);
        for cell in 0..field.z.len() {
            let hole = field.neighbours(cell).iter().any(|&other| field.z[other].is_nan());
            if field.z[cell].is_nan() || hole {
                prop_assert_eq!(baked.leaf_at(cell), None);
            } else if let Some(next) = field.downhill(cell) {
                prop_assert_eq!(baked.leaf_at(cell), baked.leaf_at(next));
            } else if field.is_outlet(cell) {
                prop_assert_eq!(baked.leaf_at(cell), None);
            }
        }
    }

    #[test]
    fn the_tree_is_consistent(field in small_fields()) {
        let baked = bake(&field);
        for (index, basin) in baked.basins().iter().enumerate() {
            let index = index as u32;
            if let Some(parent) = basin.parent {
                let parent_basin = &baked.basins()[parent as usize];
                prop_assert!(parent > index);
                prop_assert!(parent_basin.children.unwrap().contains(&index));
                prop_assert_eq!(basin.spill_m, Some(parent_basin.sill_m));
            }
            if let Some([a, b]) = basin.children {
                let [a, b] = [a, b].map(|child| baked.basins()[child as usize]);
                prop_assert!(a.bottom_m <= b.bottom_m && basin.bottom_m == a.bottom_m);
                prop_assert_eq!(a.spill_cell, b.spill_cell);
                prop_assert!((basin.catchment_m2 - a.catchment_m2 - b.catchment_m2).abs() < 1e-9);
            }
            // A basin overflows into its sibling, at the top into one that fills no higher; so water gets away.
            if let Some(target) = basin.overflows_to {
                match basin.parent {
                    Some(parent) => {
                        prop_assert!(baked.basins()[target as usize].children.is_none());
                        let inside = |mut at: u32, of: u32| loop {
                            if at == of { return true }
                            match baked.basins()[at as usize].parent { Some(next) => at = next, None => return false }
                        };
                        prop_assert!(inside(target, parent) && !inside(target, index));
                    }
                    None => {
                        prop_assert!(baked.top(target) < index);
                        prop_assert!(baked.basins()[baked.top(target) as usize].spill_m <= basin.spill_m);
                    }
                }
            }
        }
    }

    #[test]
    fn mirrored_and_turned_fields_have_the_same_basins(field in small_fields()) {
        let rows = |field: &Field| {
            let mut rows: Vec<[u64; 4]> = bake(field)
                .report()
                .basins
                .iter()
                .map(|row| [row.bottom_m, row.spill_m.unwrap_or(9e9), row.area_m2, (row.volume_m3.unwrap_or(9e9) * 1e9).round()].map(f64::to_bits))
                .collect();
            rows.sort_unstable();
            rows
        };
        let (nx, nz) = (field.nx, field.nz);
        let mirrored = Field { z: (0..nx * nz).map(|cell| field.z[cell / nx * nx + nx - 1 - cell % nx]).collect(), ..field.clone() };
        let turned = Field { nx: nz, nz: nx, z: (0..nx * nz).map(|cell| field.z[cell % nz * nx + cell / nz]).collect(), ..field.clone() };
        let distinct = { let mut z = field.z.clone(); z.sort_by(f64::total_cmp); z.dedup(); z.len() == field.z.len() };
        // Where heights are equal, which two of three pools are siblings is a matter of order; tops are not.
        if distinct {
            prop_assert_eq!(rows(&field), rows(&mirrored));
            prop_assert_eq!(rows(&field), rows(&turned));
        }
        let total = bake(&field).report().total_volume_m3;
        for other in [mirrored, turned] {
            prop_assert!((bake(&other).report().total_volume_m3 - total).abs() <= 1e-12 * total);
        }
    }

    #[test]
    fn the_threshold_only_leaves_out_the_shallow(field in small_fields(), threshold in 0.0_f64..1.5) {
        let all = bake(&field);
        let grid = Grid::new(field.nx, field.nz, field.cell, &field.z);
        let options = BakeOptions { closed: field.closed, threshold_m: threshold, ..BakeOptions::default() };
        let baked = Basins::bake(&grid, &options).unwrap();
        let depth = |basin: &rain_core::surface::basins::Basin| basin.spill_m.map_or(f64::INFINITY, |spill| spill - basin.bottom_m);
        for basin in baked.basins() {
            prop_assert!(depth(basin) >= threshold);
        }
        let tops = |baked: &Basins| -> f64 {
            let tops = baked.basins().iter().filter(|basin| basin.parent.is_none() && depth(basin) >= threshold);
            tops.filter_map(|basin| basin.volume_m3).sum()
        };
        prop_assert!((tops(&all) - tops(&baked)).abs() <= 1e-12 * tops(&all));
        let leaves: f64 = baked.basins().iter().filter(|basin| basin.children.is_none()).map(|basin| basin.catchment_m2).sum();
        let ground = field.z.iter().filter(|z| !z.is_nan()).count() as f64 * 0.25;
        prop_assert_eq!(leaves + baked.off_map_m2(), ground);
        for (index, basin) in baked.basins().iter().enumerate() {
            prop_assert_eq!(baked.curve(index as u32).depth_m(0.0), basin.sill_m - basin.bottom_m);
        }
    }
}

#[test]
fn two_pits_in_a_bowl_are_three_basins() {
    let field = drawn(&["99999999", "95555559", "95155259", "95555559", "97999999"]);
    let report = bake(&field).report();
    assert_eq!(report.cells, [8, 5]);
    assert_eq!(report.basins.len(), 3);
    let rows = &report.basins;
    let place = |x: f64| {
        rows.iter()
            .position(|row| row.x_m == x && row.parent.is_some())
            .unwrap()
    };
    let (a, b) = (place(2.5), place(5.5));
    let top = rows.iter().position(|row| row.parent.is_none()).unwrap();
    assert_eq!(
        (rows[a].bottom_m, rows[a].spill_m, rows[a].volume_m3, rows[a].area_m2),
        (1.0, Some(5.0), Some(4.0), 1.0)
    );
    assert_eq!(
        (rows[b].bottom_m, rows[b].spill_m, rows[b].volume_m3, rows[b].area_m2),
        (2.0, Some(5.0), Some(3.0), 1.0)
    );
    assert_eq!(rows[top].volume_m3, Some(4.0 + 3.0 + 18.0 * 2.0));
    assert_eq!(
        (rows[top].spill_m, rows[top].overflows_to, rows[top].area_m2),
        (Some(7.0), None, 18.0)
    );
    assert_eq!((rows[top].x_m, rows[top].z_m, rows[top].bottom_m), (2.5, 2.5, 1.0));
    assert_eq!(rows[a].overflows_to, Some(b as u32));
    assert_eq!(rows[b].overflows_to, Some(a as u32));
    assert_eq!(report.total_volume_m3, 43.0);
}

#[test]
fn pools_that_touch_only_at_their_brim_are_separate_and_spill_one_way() {
    let field = drawn(&["9999999", "9919295", "9999999"]);
    assert_eq!(bake(&field).report().basins.len(), 2, "two pits of one level");
    let field = drawn(&["9999999", "9415259", "9999999"]);
    let report = bake(&field).report();
    assert_eq!(report.basins.len(), 3);
    // 1 | 5 | 2 | 5 | off the map: both fill to 5, the first through the second.
    let field = drawn(&["999999", "915255", "999999"]);
    let rows = bake(&field).report().basins;
    assert_eq!(rows.len(), 2);
    assert!(rows.iter().all(|row| row.parent.is_none() && row.spill_m == Some(5.0)));
    let first = rows.iter().find(|row| row.bottom_m == 1.0).unwrap();
    let second = rows.iter().find(|row| row.bottom_m == 2.0).unwrap();
    assert_eq!((first.overflows_to, second.overflows_to), (Some(second.id), None));
}

#[test]
fn a_pool_that_reaches_the_border_leaves_there() {
    // Rain on the border cell of 4 runs into the deeper pit; pools that reach the cell leave the map over it.
    let baked = bake(&drawn(&["9999499", "9133909", "9999999"]));
    let rows = baked.report().basins;
    assert_eq!(rows.len(), 2);
    assert!(
        rows.iter()
            .all(|row| (row.spill_m, row.overflows_to) == (Some(4.0), None))
    );
    assert_eq!(baked.leaf_at(4), baked.leaf_at(7 + 5));
    assert_ne!(baked.leaf_at(4), baked.leaf_at(7 + 3));
}

#[test]
fn flats_border_pits_holes_and_single_cells_have_no_basin() {
    for rows in [
        &["0"][..],
        &["5205"],
        &["5", "2", "0", "5"],
        &["333", "333", "333"],
        &["999", "990", "999"],
        &["9999", "90 9", "9999"],
        &["    ", "    "],
        &["9 9", " 1 ", "9 9"],
    ] {
        let report = bake(&drawn(rows)).report();
        assert!(report.basins.is_empty(), "{rows:?}");
        assert_eq!(report.total_volume_m3.to_bits(), 0, "not -0");
    }
    let ring = bake(&drawn(&["99999", "90009", "90909", "90009", "99999"])).report();
    assert_eq!(ring.basins.len(), 1, "a flat pit around a hill");
    assert_eq!(
        (ring.basins[0].x_m, ring.basins[0].z_m, ring.basins[0].volume_m3),
        (1.5, 1.5, Some(72.0))
    );
}

#[test]
fn closed_maps_cannot_spill() {
    let field = Field {
        closed: true,
        ..drawn(&["12", "34"])
    };
    let report = bake(&field).report();
    assert_eq!(report.basins.len(), 1);
    let only = report.basins[0];
    assert_eq!(
        (only.spill_m, only.volume_m3, only.overflows_to, only.area_m2),
        (None, None, None, 4.0)
    );
    assert_eq!(report.total_volume_m3, 0.0);
    let hole = Field {
        closed: true,
        ..drawn(&["999", "9 9", "999"])
    };
    assert!(bake(&hole).report().basins.is_empty(), "a hole drains a closed map");
}

#[test]
fn bad_grids_and_options_are_refused() {
    let z = [0.0; 6];
    let grid = Grid::new(3, 2, 1.0, &z);
    let options = BakeOptions::default();
    assert!(Basins::bake(&grid, &options).is_ok());
    let mut bad = vec![
        Grid { nx: 0, ..grid },
        Grid { nz: 0, ..grid },
        Grid { nx: 4, ..grid },
        Grid { nx: usize::MAX, ..grid },
        Grid {
            nx: 1 << 20,
            nz: 1 << 20,
            ..grid
        },
        Grid {
            origin_m: [f64::NAN, 0.0],
            ..grid
        },
    ];
    bad.extend([0.0, -1.0, f64::NAN, f64::INFINITY, 1e-9].map(|cell_m| Grid { cell_m, ..grid }));
    for grid in bad {
        assert!(Basins::bake(&grid, &options).is_err(), "{grid:?}");
    }
    for height in [f64::INFINITY, f64::NEG_INFINITY, 1e8, -1e300] {
        let z = [0.0, 0.0, height, 0.0, 0.0, 0.0];
        let message = Basins::bake(&Grid::new(3, 2, 1.0, &z), &options)
            .unwrap_err()
            .to_string();
        assert!(
            message.contains("heights is") && message.contains("NaN for a hole"),
            "{message}"
        );
    }
    for threshold_m in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(
            Basins::bake(
                &grid,
                &BakeOptions {
                    threshold_m,
                    ..options.clone()
                }
            )
            .is_err()
        );
    }
    assert!(Basins::bake(&grid, &options).unwrap().filled(&[0.0; 5]).is_err());
    // Signed zeros are one height, tiny heights are heights.
    let z = [1.0, 1.0, 1.0, 1.0, -0.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0];
    let baked = Basins::bake(&Grid::new(3, 4, 1.0, &z), &options).unwrap();
    assert_eq!((baked.basins().len(), baked.basins()[0].volume_m3), (1, Some(2.0)));
}

#[test]
fn volumes_do_not_cancel_far_above_the_sea() {
    // Millimetres on a mountain: prefix sums of the heights themselves would keep few digits, in f32 none.
    let n = 200;
    let depth = |x: usize, z: usize| {
        1e-3 * (1.0 - ((x as f64 - 99.5).powi(2) + (z as f64 - 99.5).powi(2)) / 99.5_f64.powi(2)).max(0.0)
    };
    let mut worst = Worst::default();
    for base in [0.0, 100.0, 8000.0] {
        let z: Vec<f64> = (0..n * n).map(|cell| base - depth(cell % n, cell / n)).collect();
        let baked = Basins::bake(&Grid::new(n, n, 0.05, &z), &BakeOptions::default()).unwrap();
        let truth: f64 = z.iter().map(|z| base - z).sum::<f64>() * 0.0025;
        worst.relative(baked.report().total_volume_m3, truth, 1e-9, || format!("{base}"));
    }
    worst.assert_below(1e-12, 3);
}
