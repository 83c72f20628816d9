//! Closed-in air against clipped triangles and a flood without an index.

use std::collections::BTreeSet;

use glam::DVec3;
use rain_core::cover::air::{AIR_CELL_M, Air, AirGrid, cell_of};
use rain_reference::air as reference;
use rain_reference::cover::Triangle;

use super::{block, random};

/// A room with slanted furniture and, if `open`, a missing piece of its wall.
fn room(n: u32, open: bool) -> Vec<Triangle> {
    let [a, b, c] = random(n, 1, 0);
    let low = [10.0 * a - 5.0, 2.0 * b, 10.0 * c - 5.0];
    let high = [low[0] + 2.0 + a, low[1] + 1.5 + b, low[2] + 2.0 + c];
    let mut triangles = block(low, high);
    if open {
        triangles.remove(2 * (n as usize % 6));
    }
    for i in 0..4 {
        triangles.push([1, 2, 3].map(|k| {
            let at = random(n, 10 + i, k);
            [0, 1, 2].map(|axis| low[axis] + at[axis] * (high[axis] - low[axis]))
        }));
    }
    triangles
}

#[test]
fn floods_meet_the_cells_that_clipped_triangles_leave_free() {
    let (mut closed, mut opened, mut exact, mut cells) = (0, 0, 0, 0);
    for n in 0..24 {
        let triangles = room(n, n % 4 == 3);
        let (low, high) = triangles
            .iter()
            .flatten()
            .fold(([f64::MAX; 3], [f64::MIN; 3]), |(a, b), p| {
                ([0, 1, 2].map(|i| p[i].min(a[i])), [0, 1, 2].map(|i| p[i].max(b[i])))
            });
        let rain = |p: [f64; 3]| (0..3).any(|i| p[i] < low[i] - 0.5 || p[i] > high[i] + 0.5);
        let share = random(n, 2, 0);
        let eye = [0, 1, 2].map(|i| low[i] + (0.15 + 0.7 * share[i]) * (high[i] - low[i]));
        let mut grid = AirGrid::default();
        grid.set(7, triangles.iter().map(|t| t.map(DVec3::from)).collect());
        let shipped = match grid.flood(DVec3::from(eye), 6.0, |p| rain(p.to_array())) {
            Air::Open => None,
            Air::ClosedIn(found) => Some(found),
        };
        // Between cells as they are and cells grown by the room that the shipped test gives to rounding.
        let slow = |grow: f64| -> Option<BTreeSet<[i32; 3]>> {
            reference::flood(&triangles, eye, AIR_CELL_M, 24, grow, rain)
                .map(|found| found.into_iter().map(|cell| cell.map(|c| c as i32)).collect())
        };
        let (wide, narrow) = (slow(0.0), slow(2e-4));
        if wide == narrow {
            assert_eq!(shipped, wide, "room {n}");
            exact += 1;
        }
        match &shipped {
            Some(found) => {
                closed += 1;
                cells += found.len();
                assert!(found.contains(&cell_of(DVec3::from(eye)).to_array()) || found.len() > 1);
                // Half a cell aside is another set.
                assert_ne!(Some(found), slow(0.3).as_ref(), "room {n}");
            }
            None => opened += 1,
        }
    }
    assert!(
        exact >= 20 && closed >= 12 && opened >= 4 && cells > 3000,
        "{exact} {closed} {opened} {cells}"
    );
}

#[test]
fn air_takes_nonsense_and_nothing() {
    let mut grid = AirGrid::default();
    assert_eq!(grid.flood(DVec3::ZERO, 3.0, |_| true), Air::Open);
    // Nothing anywhere and no rain: all the cells within range.
    let Air::ClosedIn(found) = grid.flood(DVec3::ZERO, 1.0, |_| false) else {
        panic!("no rain reached it");
    };
    let slow = reference::flood(&[], [0.0; 3], AIR_CELL_M, 4, 0.0, |_| false).expect("no rain");
    assert_eq!(found.len(), slow.len());
    let far = room(3, false).iter().map(|t| t.map(|p| DVec3::from(p) * 1e9)).collect();
    grid.set(1, far);
    grid.set(2, vec![[DVec3::NAN; 3], [DVec3::ZERO; 3]]);
    for eye in [DVec3::splat(1e7), DVec3::NAN, DVec3::splat(f64::INFINITY)] {
        assert_eq!(grid.flood(eye, 1.0, |_| true), Air::Open, "{eye}");
    }
}
