//! The ground of a scene against cells advanced one by one every tick, and its water balance under anything.

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use rain_core::surface::ground::{DRY_LEVEL, Ground, GroundDomain, GroundScene, GroundSettings};
use rain_core::weather::{ColumnForcing, SurfaceClass, SurfaceColumn};

use super::config;
use crate::check::Worst;

const TICK_S: f64 = 1.0 / 32.0;
const SIDE: usize = 24;
const CELL_M: f64 = 0.25;

/// Ground that falls towards one bowl, heights at cell centres.
fn bowl(x: f64, z: f64) -> f64 {
    let r2 = (x - 3.0) * (x - 3.0) + (z - 3.0) * (z - 3.0);
    0.004 * r2
}

/// A scene whose cell centres have exactly the heights of a function: each cell is a level square.
fn terraces(height: impl Fn(f64, f64) -> f64, class: impl Fn(usize) -> SurfaceClass) -> GroundScene {
    let mut scene = GroundScene::default();
    for row in 0..SIDE {
        for column in 0..SIDE {
            let (x, z) = (column as f64 * CELL_M, row as f64 * CELL_M);
            let y = height(x + 0.5 * CELL_M, z + 0.5 * CELL_M);
            let p = |dx: f64, dz: f64| DVec3::new(x + dx * CELL_M, y, z + dz * CELL_M);
            let (a, b, c, d) = (p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(0.0, 1.0));
            let owner = (row * SIDE + column) as u64;
            scene.set(owner, &[[a, d, c], [a, c, b]], class(row), true);
        }
    }
    scene
}

fn settings() -> GroundSettings {
    GroundSettings {
        domain: Some(GroundDomain {
            low_m: [0.0; 2],
            high_m: [SIDE as f64 * CELL_M; 2],
        }),
        ..GroundSettings::default()
    }
}

fn classes(row: usize) -> SurfaceClass {
    if row < SIDE / 2 {
        SurfaceClass::Asphalt
    } else {
        SurfaceClass::Concrete
    }
}

/// One bowl that takes all water of the cells inside the level at which it runs over the open border, the rest runs off:
/// every cell a column of its own, the level by bisection over a sum of cells.
fn cell_by_cell(rain: impl Fn(f64) -> f64, seconds: f64) -> (f64, Vec<f64>, f64) {
    let centre = |i: usize| (i as f64 + 0.5) * CELL_M;
    let heights: Vec<f64> = (0..SIDE * SIDE)
        .map(|i| bowl(centre(i % SIDE), centre(i / SIDE)))
        .collect();
    let mut columns = vec![SurfaceColumn::default(); SIDE * SIDE];
    let (mut pool_m3, mut level) = (0.0, f64::NEG_INFINITY);
    let area = CELL_M * CELL_M;
    for tick in 0..(seconds / TICK_S) as usize {
        let rain_mm_h = rain(tick as f64 * TICK_S);
        let forcing = ColumnForcing {
            rain_mm_h,
            evaporation_mm_h: 0.0,
        };
        for (cell, column) in columns.iter_mut().enumerate() {
            if level > heights[cell] {
                pool_m3 += rain_mm_h * TICK_S / 3600.0 * 1e-3 * area;
                continue;
            }
            let before = column.ledger().drained_mm;
            column
                .advance(&classes(cell / SIDE).properties(), forcing, TICK_S)
                .expect("valid");
            pool_m3 += (column.ledger().drained_mm - before) * 1e-3 * area;
        }
        let volume = |level: f64| -> f64 { heights.iter().map(|h| (level - h).max(0.0) * area).sum() };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if volume(middle) < pool_m3 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let risen = 0.5 * (low + high);
        // What stood as film on a cell that is reached joins the pool.
        for (cell, column) in columns.iter_mut().enumerate() {
            if risen > heights[cell] && level <= heights[cell] && pool_m3 > 1e-12 {
                pool_m3 += column.water_level_mm() * 1e-3 * area;
            }
        }
        level = if pool_m3 > 1e-12 { risen } else { f64::NEG_INFINITY };
    }
    let films = columns.iter().map(SurfaceColumn::water_level_mm).collect();
    (pool_m3, films, level)
}

#[test]
fn the_ground_is_its_cells_advanced_one_by_one() {
    // Rain for two minutes, then rest until all that runs has run.
    let rain = |t: f64| if t < 120.0 { 60.0 } else { 0.0 };
    let seconds = 600.0;
    let mut ground = Ground::build(&terraces(bowl, classes), &settings()).expect("valid");
    for tick in 0..(seconds / TICK_S) as usize {
        let forcing = ColumnForcing {
            rain_mm_h: rain(tick as f64 * TICK_S),
            evaporation_mm_h: 0.0,
        };
        ground.advance(&forcing, TICK_S, 1).expect("valid");
    }
    let (pool_m3, films, level) = cell_by_cell(rain, seconds);
    let ledger = ground.ledger();
    assert!(pool_m3 > 0.01, "{pool_m3}");
    let mut worst = Worst::default();
    worst.relative(ledger.basins_m3 + ledger.underway_m3, pool_m3, 1e-6, || {
        "the pool after ten minutes".into()
    });
    worst.assert_below(3e-3, 1);
    let mut worst = Worst::default();
    let mut dry = 0;
    for (cell, &film) in films.iter().enumerate() {
        let (x, z) = ((cell % SIDE) as f64, (cell / SIDE) as f64);
        let y = bowl((x + 0.5) * CELL_M, (z + 0.5) * CELL_M);
        let here = ground.water_at(DVec3::new((x + 0.5) * CELL_M, y, (z + 0.5) * CELL_M));
        assert_eq!(here.class, classes(cell / SIDE));
        if here.puddle_m == 0.0 && level < y {
            worst.absolute(here.film_mm, film, || format!("cell {cell}"));
            dry += 1;
        } else if here.puddle_m > 0.0 {
            assert!(
                (here.puddle_m - (level - y)).abs() < 1e-4,
                "{cell}: {here:?} {level} {y}"
            );
        }
    }
    worst.assert_below(2e-3, 300);
    assert!(dry < SIDE * SIDE, "some cells are under water");
    // Another rain by 5 % is noticed.
    let (more, _, _) = cell_by_cell(|t| 1.05 * rain(t), seconds);
    assert!((ledger.basins_m3 / more - 1.0).abs() > 0.02);
}

/// What may happen to a ground.
#[derive(Debug, Clone)]
enum Event {
    Rain(f64, f64, u32),
    Add(f64, f64, f64),
    Press(f64, f64, f64, f64, f64, f64),
    Land(f64, f64, f64),
    Expose(usize, u8),
}

fn event() -> impl Strategy<Value = Event> {
    let place = -1.0..7.0_f64;
    prop_oneof![
        4 => (0.0..500.0_f64, 0.0..1.5_f64, 1..120_u32).prop_map(|(r, e, n)| Event::Rain(r, e, n)),
        2 => (0.0..1.0_f64, 0.0..2.0_f64, 1..2000_u32).prop_map(|(_, e, n)| Event::Rain(0.0, e, n)),
        1 => (place.clone(), place.clone(), 0.0..0.2_f64).prop_map(|(x, z, v)| Event::Add(x, z, v)),
        1 => (place.clone(), place.clone(), place.clone(), place.clone(), 0.0..0.5_f64, 0.0..1.0_f64)
            .prop_map(|(a, b, c, d, w, s)| Event::Press(a, b, c, d, w, s)),
        1 => (place.clone(), place, 0.0..0.1_f64).prop_map(|(x, z, v)| Event::Land(x, z, v)),
        1 => (0..SIDE * SIDE, any::<u8>()).prop_map(|(cell, e)| Event::Expose(cell, e)),
    ]
}

proptest! {
    #![proptest_config(config(24))]

    /// Whatever happens, no water is made or lost, no amount is negative, and levels lie over the ground.
    #[test]
    fn the_grounds_water_balance_closes_under_anything(
        events in prop::collection::vec(event(), 1..24),
        tilt in -0.02..0.02_f64,
        wave in 0.0..0.1_f64,
    ) {
        let height = |x: f64, z: f64| {
            tilt * x + wave * ((1.7 * x).sin() * (2.3 * z).cos()) + 0.002 * (x - 3.0) * (x - 3.0)
        };
        let class = |row: usize| SurfaceClass::ALL[row % SurfaceClass::COUNT];
        let mut ground = Ground::build(&terraces(height, class), &settings()).expect("valid");
        for event in events {
            match event {
                Event::Rain(rain_mm_h, evaporation_mm_h, ticks) => {
                    let forcing = ColumnForcing { rain_mm_h, evaporation_mm_h };
                    // Some of it in long ticks.
                    for _ in 0..ticks.min(100) {
                        let steps = if ticks > 100 { ticks / 20 } else { 1 };
                        ground.advance(&forcing, TICK_S * f64::from(steps), steps).expect("valid");
                    }
                }
                Event::Add(x, z, v) => ground.add_water(DVec2::new(x, z), v).expect("valid"),
                Event::Press(a, b, c, d, width, share) => {
                    let pressed = ground.press(DVec2::new(a, b), DVec2::new(c, d), width, share, 0.3).expect("valid");
                    prop_assert!(pressed.aside_m3 >= 0.0 && pressed.thrown_m3 >= -1e-18);
                }
                Event::Land(x, z, v) => {
                    let landed = ground.land(DVec2::new(x, z), v).expect("valid");
                    prop_assert!(landed <= v * (1.0 + 1e-12));
                }
                Event::Expose(cell, share) => ground.set_exposure(cell, &[share; 40]),
            }
            let ledger = ground.ledger();
            prop_assert!(ledger.residual_relative < 1e-12, "{:?}", ledger);
            for amount in [ledger.film_m3, ledger.pores_m3, ledger.basins_m3, ledger.evaporated_m3,
                ledger.infiltrated_m3, ledger.off_map_m3, ledger.gutters_m3] {
                prop_assert!(amount >= 0.0 && amount.is_finite(), "{:?}", ledger);
            }
            let out = ledger.stored_m3() + ledger.drained_m3() + ledger.evaporated_m3 + ledger.infiltrated_m3;
            prop_assert!((ledger.supplied_m3() - out).abs() <= 1e-9 * ledger.supplied_m3().max(1e-6));
        }
        let mut levels = vec![0.0; SIDE * SIDE];
        ground.levels(&mut levels);
        let mut saturations = vec![0.0; SIDE * SIDE];
        ground.saturations_into(&mut saturations);
        for (cell, (&level, &saturation)) in levels.iter().zip(&saturations).enumerate() {
            prop_assert!((0.0..=1.0).contains(&saturation));
            prop_assert!(level == DRY_LEVEL || level > ground.ground_heights()[cell] - 1.0);
        }
        let saved = ground.state();
        let text = ron::to_string(&saved).expect("text");
        let sent = ron::from_str(&text).expect("a state");
        prop_assert!(saved == sent, "every bit comes through");
        ground.restore(&sent).expect("its own state");
    }
}
