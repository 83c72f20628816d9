//! Maps of 4096² cells.

use std::sync::Arc;

use rain_core::surface::basins::{BakeOptions, BasinForcing, BasinRun, Basins, Grid};

use super::terrain::fractal;

const N: usize = 4096;
const AREA_M2: f64 = (N * N) as f64;

/// The basins of cells of 1 m, and the most memory that baking them took beside the heights. Units: bytes a cell.
fn bake(heights: &[f64], closed: bool) -> (Basins, f64) {
    let options = BakeOptions {
        closed,
        threshold_m: 0.0,
        ..BakeOptions::default()
    };
    let mut baked = None;
    let used = allocation_counter::measure(|| {
        baked = Basins::bake(&Grid::new(N, N, 1.0, heights), &options).ok();
    });
    (baked.expect("a valid grid"), used.bytes_max as f64 / AREA_M2)
}

fn inside(cell: usize) -> bool {
    (1..N - 1).contains(&(cell % N)) && (1..N - 1).contains(&(cell / N))
}

/// The eight around a cell inside.
fn around(cell: usize) -> [usize; 8] {
    [
        cell - N - 1,
        cell - N,
        cell - N + 1,
        cell - 1,
        cell + 1,
        cell + N - 1,
        cell + N,
        cell + N + 1,
    ]
}

/// Whether this is the filled surface, the lowest on which all water finds its way off the map: the ground on the
/// border; nowhere below the ground; where above it, no neighbour lower (else it is too high); and every set of
/// connected cells of one level with a lower neighbour or on the border (else it is too low).
fn is_filled(heights: &[f64], filled: &[f64]) -> bool {
    let mut seen = vec![false; N * N];
    let mut open = Vec::new();
    let lower = |cell: usize| around(cell).iter().any(|&other| filled[other] < filled[cell]);
    for start in 0..N * N {
        if !inside(start) {
            if filled[start] != heights[start] {
                return false;
            }
            continue;
        }
        if filled[start] < heights[start] || (filled[start] > heights[start] && lower(start)) {
            return false;
        }
        if seen[start] || lower(start) {
            continue;
        }
        let mut out = false;
        open.push(start);
        seen[start] = true;
        while let Some(cell) = open.pop() {
            for other in around(cell).into_iter().filter(|&other| filled[other] == filled[start]) {
                if !inside(other) || lower(other) {
                    out = true;
                } else if !seen[other] {
                    seen[other] = true;
                    open.push(other);
                }
            }
        }
        if !out {
            return false;
        }
    }
    true
}

#[test]
fn fractal_ground_of_4096_squared_is_baked_and_rained_on() {
    let heights = fractal(N, 5);
    let (baked, memory) = bake(&heights, false);
    assert!(memory < 24.0, "{memory} bytes a cell");
    let mut filled = baked.filled(&heights).expect("the baked grid");
    assert!(is_filled(&heights, &filled));
    let (mut volume, mut catchments) = (0.0, baked.off_map_m2());
    for (basin, at) in baked.basins().iter().enumerate() {
        let spill = at.spill_m.expect("open");
        assert!(at.bottom_m <= at.sill_m && at.sill_m <= spill, "{basin}: {at:?}");
        assert_eq!(at.bottom_m, heights[at.pit_cell as usize]);
        let full = at.volume_m3.expect("open");
        let (depth, deepest) = (baked.curve(basin as u32).depth_m(full), spill - at.bottom_m);
        assert!((depth - deepest).abs() <= 1e-12 * deepest, "{basin}: {depth} of {at:?}");
        match at.parent {
            Some(above) => assert_eq!(baked.basins()[above as usize].sill_m, spill),
            None => {
                volume += full;
                catchments += at.catchment_m2;
            }
        }
    }
    assert!(baked.basins().len() > 100_000);
    assert_eq!(catchments, AREA_M2, "every cell runs to one basin or off the map");
    let stood: f64 = heights.iter().zip(&filled).map(|(ground, level)| level - ground).sum();
    assert!((volume - stood).abs() <= 1e-12 * stood, "{volume} of {stood}");
    // Three hours of 36 mm/h, and drying.
    let covered = AREA_M2 - baked.off_map_m2();
    let tops: Vec<u32> = (0..baked.basins().len() as u32)
        .filter(|&basin| baked.basins()[basin as usize].parent.is_none())
        .collect();
    let mut run = BasinRun::new(Arc::new(baked));
    run.advance(&BasinForcing::rain(1e-5), 3.0 * 3600.0).expect("valid");
    let wet = run.ledger();
    assert!((wet.rain_m3 - covered * 0.108).abs() < 1e-9 * wet.rain_m3, "{wet:?}");
    assert!(
        wet.residual_relative < 1e-12 && wet.left_m3 > 0.0 && wet.stored_m3 <= volume,
        "{wet:?}"
    );
    let held: f64 = tops.iter().map(|&top| run.volume_m3(top)).sum();
    assert!((held - wet.stored_m3).abs() <= 1e-9 * held, "{held} of {wet:?}");
    let dry = BasinForcing {
        evaporation_m_s: 1e-6,
        ..BasinForcing::default()
    };
    run.advance(&dry, 3600.0).expect("valid");
    let later = run.ledger();
    assert!(later.residual_relative < 1e-12 && later.evaporated_m3 > 0.0 && later.stored_m3 < wet.stored_m3);
    // A hair too high or too low somewhere would be seen.
    let wet_cell = (0..N * N)
        .find(|&cell| filled[cell] > heights[cell] + 1e-3)
        .expect("a puddle");
    for error in [1e-9, -1e-9] {
        filled[wet_cell] += error;
        assert!(!is_filled(&heights, &filled), "{error}");
        filled[wet_cell] -= error;
    }
}

#[test]
fn flats_and_slopes_of_4096_squared_have_no_basin_and_a_pan_has_one() {
    let mut heights = vec![3.0; N * N];
    let (flat, memory) = bake(&heights, false);
    assert!(flat.basins().is_empty() && memory < 24.0, "{memory} bytes a cell");
    assert_eq!(flat.off_map_m2(), AREA_M2);
    // Walled in, it is one basin without a brim.
    let (walled, memory) = bake(&heights, true);
    assert_eq!((walled.basins().len(), walled.off_map_m2()), (1, 0.0));
    let at = &walled.basins()[0];
    assert_eq!((at.spill_m, at.volume_m3, at.catchment_m2), (None, None, AREA_M2));
    assert!(memory < 32.0, "{memory} bytes a cell");
    // With a rim of 0.5 m, a pan.
    for cell in (0..N * N).filter(|&cell| !inside(cell)) {
        heights[cell] = 3.5;
    }
    let (pan, memory) = bake(&heights, false);
    assert_eq!(pan.basins().len(), 1);
    let wet = ((N - 2) * (N - 2)) as f64;
    let at = &pan.basins()[0];
    assert_eq!(
        (at.spill_m, at.volume_m3, at.area_m2),
        (Some(3.5), Some(0.5 * wet), wet)
    );
    assert!(memory < 32.0, "{memory} bytes a cell");
    for tilt in [[0.02, -0.013], [0.0, -1e-6]] {
        for (cell, height) in heights.iter_mut().enumerate() {
            *height = tilt[0] * (cell % N) as f64 + tilt[1] * (cell / N) as f64;
        }
        let (slope, memory) = bake(&heights, false);
        assert!(
            slope.basins().is_empty() && memory < 24.0,
            "{tilt:?}: {memory} bytes a cell"
        );
        assert_eq!(slope.off_map_m2(), AREA_M2);
    }
}
