use glam::{DVec2, DVec3};

use super::*;
use crate::cover::{ClassShare, CoverScene, CoverSettings, FallSlope, OccluderId};
use crate::weather::{ColumnForcing, SurfaceClass};

const TICK_S: f64 = 1.0 / 32.0;

/// Two triangles over a rectangle, heights by a function of the corners.
fn quad(low: [f64; 2], high: [f64; 2], y: impl Fn(f64, f64) -> f64) -> Vec<[DVec3; 3]> {
    let p = |x: f64, z: f64| DVec3::new(x, y(x, z), z);
    let (a, b) = (p(low[0], low[1]), p(high[0], low[1]));
    let (c, d) = (p(high[0], high[1]), p(low[0], high[1]));
    vec![[a, d, c], [a, c, b]]
}

/// A street of 24 × 12 m at `at`: a road that falls by 2 % along x with a bowl in the middle, lawn along one side, a
/// roof over the end.
fn street(at: DVec3) -> GroundScene {
    let mut road = Vec::new();
    let height = |x: f64, z: f64| {
        let r2 = ((x - 12.0) * (x - 12.0) + (z - 4.0) * (z - 4.0)) / 4.0;
        0.02 * (24.0 - x) - 0.15 * (1.0 - r2).max(0.0)
    };
    for i in 0..96 {
        for j in 0..32 {
            let (x, z) = (f64::from(i) * 0.25, f64::from(j) * 0.25);
            road.extend(quad([x, z], [x + 0.25, z + 0.25], height));
        }
    }
    let lawn = quad([0.0, 8.0], [24.0, 12.0], |x, _| 0.02 * (24.0 - x) + 0.1);
    let roof = quad([18.0, 0.0], [23.0, 6.0], |_, _| 4.0);
    let moved =
        |triangles: Vec<[DVec3; 3]>| -> Vec<[DVec3; 3]> { triangles.into_iter().map(|t| t.map(|c| c + at)).collect() };
    let mut scene = GroundScene::default();
    scene.set(1, &moved(road), SurfaceClass::Asphalt, true);
    scene.set(2, &moved(lawn), SurfaceClass::Grass, true);
    scene.set(3, &moved(roof), SurfaceClass::Roof, true);
    scene
}

fn ground(at: DVec3) -> Ground {
    Ground::build(&street(at), &GroundSettings::default()).expect("valid")
}

fn rain(rain_mm_h: f64) -> ColumnForcing {
    ColumnForcing {
        rain_mm_h,
        evaporation_mm_h: 0.1,
    }
}

fn run(ground: &mut Ground, forcing: ColumnForcing, seconds: f64) {
    for _ in 0..(seconds / TICK_S) as u32 {
        ground.advance(&forcing, TICK_S, 1).expect("valid");
    }
}

fn bits(ground: &Ground) -> Vec<u64> {
    let mut bits = Vec::new();
    ground.for_each_state_bits(|b| bits.push(b));
    bits
}

#[test]
fn layers_are_the_ground_and_what_stands_over_it() {
    let mut scene = street(DVec3::ZERO);
    // A kerb slab on the road, a wall, a ceiling that faces down, and rubbish.
    scene.set(4, &quad([2.0, 2.0], [4.0, 4.0], |_, _| 0.55), SurfaceClass::Stone, true);
    let n = f64::NAN;
    let rubbish = [
        [DVec3::new(n, 0.0, 0.0), DVec3::X, DVec3::Z],
        [DVec3::ZERO; 3],
        [DVec3::ZERO, DVec3::X, DVec3::Y],
    ];
    scene.set(5, &rubbish, SurfaceClass::Soil, true);
    let down: Vec<_> = quad([6.0, 1.0], [7.0, 2.0], |_, _| 2.0)
        .into_iter()
        .map(|[a, b, c]| [a, c, b])
        .collect();
    scene.set(6, &down, SurfaceClass::Soil, true);
    // What moves is no ground.
    scene.set(
        7,
        &quad([0.0, 0.0], [24.0, 12.0], |_, _| 9.0),
        SurfaceClass::Roof,
        false,
    );
    let layers = scene.layers(&GroundSettings::default()).expect("valid");
    assert_eq!(layers.frame().cells(), [96, 48]);
    let at = |x: f64, z: f64| (z / 0.25) as usize * 96 + (x / 0.25) as usize;
    assert_eq!(layers.ground()[at(3.0, 3.0)], 0.55, "a slab is the ground on it");
    assert_eq!(layers.classes()[at(3.0, 3.0)], SurfaceClass::Stone.index() as u8);
    assert_eq!(layers.classes()[at(3.0, 10.0)], SurfaceClass::Grass.index() as u8);
    assert_eq!(layers.top()[at(20.0, 3.0)], 4.0);
    assert!(layers.top()[at(6.5, 1.5)].is_nan() && layers.top()[at(1.0, 1.0)].is_nan());
    let left_out = layers.left_out();
    assert_eq!((left_out.not_finite, left_out.degenerate, left_out.not_up), (1, 1, 3));
}

#[test]
fn scenes_far_away_and_huge_planes_are_the_same_ground() {
    // By whole cells, so that the grids agree.
    let (near, far) = (ground(DVec3::ZERO), ground(DVec3::new(1e5, 0.0, -1e5)));
    for (a, b) in near.heights.iter().zip(&far.heights) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
    let mut plane = GroundScene::default();
    plane.set(
        1,
        &quad([-4e5, -4e5], [5e5, 5e5], |x, _| 1e-3 * x),
        SurfaceClass::Soil,
        true,
    );
    let settings = GroundSettings {
        domain: Some(GroundDomain {
            low_m: [0.0, 0.0],
            high_m: [30.0, 20.0],
        }),
        ..GroundSettings::default()
    };
    let layers = plane.layers(&settings).expect("cut to the domain");
    for (cell, &y) in layers.ground().iter().enumerate() {
        let x = (cell % 120) as f64 * 0.25 + 0.125;
        assert!((y - 1e-3 * x).abs() < 1e-9, "{cell}: {y}");
    }
    // Without a domain the cells grow until they are few enough.
    let whole = plane.layers(&GroundSettings::default()).expect("coarser");
    let [nx, nz] = whole.frame().cells();
    assert!(nx * nz <= 1 << 20 && whole.frame().cell_m() > 500.0);
}

#[test]
fn water_stands_in_the_hollow_runs_off_the_slope_and_leaves_the_roofs_shadow_dry() {
    let at = DVec3::new(1e5, 20.0, -1e5);
    let mut ground = ground(at);
    run(&mut ground, rain(60.0), 600.0);
    let water = |x: f64, y: f64, z: f64| ground.water_at(at + DVec3::new(x, y, z));
    let bowl = water(12.0, 0.1, 4.0);
    assert!(bowl.puddle_m > 0.01 && bowl.layer == GroundLayer::Ground, "{bowl:?}");
    let slope = water(4.0, 0.4, 4.0);
    assert!(
        slope.puddle_m == 0.0 && slope.film_mm > 0.8 && slope.saturation == 1.0,
        "{slope:?}"
    );
    let under = water(20.0, 0.1, 3.0);
    assert!(
        under.film_mm == 0.0 && under.saturation == 0.0 && under.class == SurfaceClass::Asphalt,
        "{under:?}"
    );
    let roof = water(20.0, 4.1, 3.0);
    assert!(roof.film_mm > 0.05 && roof.layer == GroundLayer::Top, "{roof:?}");
    assert_eq!(water(20.0, 2.0, 3.0), WaterAt::default(), "in the air");
    assert_eq!(water(f64::NAN, 0.0, 0.0), WaterAt::default());
    assert_eq!(water(500.0, 0.0, 0.0), WaterAt::default());
    assert_eq!(water(4.0, 0.6, 10.0).class, SurfaceClass::Grass);
    let ledger = ground.ledger();
    assert!(ledger.residual_relative < 1e-12, "{ledger:?}");
    let fallen = 60.0e-3 / 3600.0 * 600.0 * 24.0 * 12.0;
    assert!((ledger.rain_m3 - fallen).abs() < 1e-12 * fallen, "{ledger:?}");
    assert!(
        ledger.gutters_m3 > 0.1 && ledger.off_map_m3 > 0.1 && ledger.infiltrated_m3 > 0.1 && ledger.basins_m3 > 0.01
    );
}

#[test]
fn the_ledger_closes_at_any_moment() {
    let mut ground = ground(DVec3::ZERO);
    for tick in 0..3200_u32 {
        let forcing = ColumnForcing {
            rain_mm_h: if tick % 900 < 500 { f64::from(tick % 97) } else { 0.0 },
            evaporation_mm_h: 0.3 + f64::from(tick % 11) * 0.01,
        };
        let steps = if tick % 400 == 0 { 50 } else { 1 + tick / 7 % 3 };
        ground
            .advance(&forcing, TICK_S * f64::from(steps), steps)
            .expect("valid");
        if tick % 50 == 0 {
            let place = DVec2::new(f64::from(tick % 24), 4.0);
            ground.add_water(place, 1e-3).expect("valid");
            let pressed = ground
                .press(place, place + DVec2::new(1.5, 0.3), 0.2, 0.8, 0.25)
                .expect("valid");
            ground.land(place + 1.0, 0.5 * pressed.thrown_m3).expect("valid");
        }
        if tick % 37 == 0 {
            let ledger = ground.ledger();
            assert!(ledger.residual_relative < 1e-12, "{tick}: {ledger:?}");
        }
    }
    let ledger = ground.ledger();
    assert!(
        ledger.airborne_m3 > 0.0 && ledger.underway_m3 > 0.0 && ledger.added_m3 > 0.06,
        "{ledger:?}"
    );
    // The comparison notices a thousandth of a litre.
    ground.totals.added.add(1e-6);
    assert!(ground.ledger().residual_relative > 1e-9);
}

#[test]
fn it_dries_and_a_dry_ground_is_left_alone() {
    let mut ground = ground(DVec3::ZERO);
    run(&mut ground, rain(60.0), 300.0);
    assert!(!ground.is_dry());
    let sun = ColumnForcing {
        rain_mm_h: 0.0,
        evaporation_mm_h: 1.0,
    };
    for _ in 0..1000 {
        ground.advance(&sun, 600.0, 19_200).expect("valid");
    }
    assert!(ground.is_dry(), "{:?}", ground.ledger());
    let (films, levels) = (ground.film_version(), ground.level_version());
    let before = ground.cells.clone();
    run(&mut ground, sun, 10.0);
    assert_eq!((films, levels), (ground.film_version(), ground.level_version()));
    assert_eq!(before, ground.cells);
    assert!(ground.ledger().residual_relative < 1e-12);
    // The soil recovers over the dry spell as it would have without skips.
    let tau = |g: &Ground| g.cells.tau[40 * 96 + 8];
    assert!(tau(&ground) > 0.0);
    let soil = SurfaceClass::Grass.properties().infiltration.curve();
    // Row 40 has its turn in slice 8, where the dry time since is noted.
    let expected = soil.recovered(tau(&ground), ground.pending[8].idle_s + 3.0 * 86_400.0);
    ground.advance(&sun, 3.0 * 86_400.0, 1).expect("valid");
    let drizzle = rain(0.2);
    run(&mut ground, drizzle, 2.0);
    assert!(
        (tau(&ground) / expected - 1.0).abs() < 1e-2,
        "{} {expected}",
        tau(&ground)
    );
}

#[test]
fn turns_cost_little_against_advancing_every_tick() {
    let every = GroundSettings {
        interval_steps: 1,
        basin_steps: 1,
        ..GroundSettings::default()
    };
    let scene = street(DVec3::ZERO);
    let mut exact = Ground::build(&scene, &every).expect("valid");
    let mut turns = Ground::build(&scene, &GroundSettings::default()).expect("valid");
    let mut past = Vec::new();
    let mut compared = 0;
    for tick in 0..6400_u32 {
        // Up in four seconds, steady to 100 s, then down.
        let t = f64::from(tick) * TICK_S;
        let forcing = rain(100.0 * t.min(4.0) * if t < 100.0 { 1.0 } else { (2.0 - t / 100.0).max(0.0) });
        for ground in [&mut exact, &mut turns] {
            ground.advance(&forcing, TICK_S, 1).expect("valid");
        }
        if tick % 4 != 3 {
            continue;
        }
        let (a, b) = (exact.ledger(), turns.ledger());
        past.push([a.film_m3, a.basins_m3]);
        // Films are up to one second late, basins up to three and a step of theirs.
        for (value, which, late) in [(b.film_m3, 0, 8), (b.basins_m3, 1, 26)] {
            let seen = past.iter().rev().take(late + 1).map(|p| p[which]);
            let low = seen.clone().fold(f64::INFINITY, f64::min);
            let high = seen.fold(0.0, f64::max);
            let allowed = 2e-3 * high + 1e-6;
            assert!(
                value > low - allowed && value < high + allowed,
                "{t}: {which}, {low} {value} {high}"
            );
            compared += 1;
        }
    }
    assert!(compared == 3200);
    // When all has come to rest there is next to no difference.
    let last = |ground: &Ground| ground.ledger().basins_m3;
    let difference = (last(&exact) - last(&turns)).abs();
    assert!(difference < 1e-6 * last(&exact), "{difference}");
}

#[test]
fn long_ticks_end_where_short_ones_do() {
    let mut short = ground(DVec3::ZERO);
    let mut long = short.clone();
    run(&mut short, rain(40.0), 480.0);
    for _ in 0..60 {
        long.advance(&rain(40.0), 8.0, 256).expect("valid");
    }
    let (a, b) = (short.ledger(), long.ledger());
    for (x, y) in [
        (a.film_m3, b.film_m3),
        (a.basins_m3 + a.underway_m3, b.basins_m3 + b.underway_m3),
    ] {
        assert!((x - y).abs() < 0.01 * x, "{a:?} {b:?}");
    }
}

#[test]
fn a_press_takes_film_aside_and_up() {
    let mut ground = ground(DVec3::ZERO);
    run(&mut ground, rain(60.0), 300.0);
    let before = ground.ledger();
    let (from, to) = (DVec2::new(2.0, 2.125), DVec2::new(6.0, 2.125));
    let film = |g: &Ground, z: f64| g.water_at(DVec3::new(4.0, 0.4, z)).film_mm;
    let old = film(&ground, 2.125);
    let pressed = ground.press(from, to, 0.125, 0.9, 0.25).expect("valid");
    let taken = 4.0 * 0.25 * 0.9 * old * 1e-3;
    assert!(
        (pressed.aside_m3 + pressed.thrown_m3 - taken).abs() < 0.02 * taken,
        "{pressed:?} {taken}"
    );
    assert!((pressed.thrown_m3 - 0.25 * taken).abs() < 0.02 * taken);
    assert!((film(&ground, 2.125) - 0.1 * old).abs() < 1e-9);
    assert!(film(&ground, 2.375) > old && film(&ground, 1.875) > old);
    let after = ground.ledger();
    assert!((before.film_m3 - after.film_m3 - pressed.thrown_m3).abs() < 1e-12);
    assert!((ground.airborne_m3() - pressed.thrown_m3).abs() < 1e-15);
    assert!(ground.land(to, 1.0).expect("valid") <= pressed.thrown_m3 * (1.0 + 1e-12));
    assert!(ground.airborne_m3() < 1e-15 && ground.ledger().residual_relative < 1e-12);
    // Two ways end to end press as one does, but for the cells that they share.
    let mut once = ground.clone();
    once.press(from, to, 0.3, 0.5, 1.0).expect("valid");
    let middle = DVec2::new(3.37, 2.125);
    ground.press(from, middle, 0.3, 0.5, 1.0).expect("valid");
    ground.press(middle, to, 0.3, 0.5, 1.0).expect("valid");
    assert!((once.airborne_m3() - ground.airborne_m3()).abs() < 1e-2 * once.airborne_m3());
    for bad in [f64::NAN, -0.1, 1.1] {
        assert!(ground.press(from, to, 0.3, bad, 0.0).is_err() && ground.press(from, to, 0.3, 0.0, bad).is_err());
    }
    assert!(ground.press(from, DVec2::NAN, 0.3, 0.5, 0.0).is_err());
    assert!(ground.add_water(from, f64::NAN).is_err() && ground.add_water(DVec2::NAN, 1.0).is_err());
}

#[test]
fn levels_reach_one_cell_beyond_the_water() {
    let mut ground = ground(DVec3::new(0.0, 1000.0, 0.0));
    let mut levels = vec![0.0; 96 * 48];
    ground.levels(&mut levels);
    assert!(levels.iter().all(|l| *l == DRY_LEVEL));
    let version = ground.level_version();
    run(&mut ground, rain(60.0), 600.0);
    assert!(ground.level_version() > version);
    ground.levels(&mut levels);
    let depth = |cell: usize| levels[cell] - ground.ground_heights()[cell];
    let wet = (0..levels.len()).filter(|&c| depth(c) > 0.0).count();
    let beside = (0..levels.len())
        .filter(|&c| levels[c] > -1e6 && depth(c) <= 0.0)
        .count();
    assert!(wet > 50 && beside > 20 && beside < wet, "{wet} {beside}");
    let place = ground.water_at(DVec3::new(12.0, 1000.1, 4.0));
    let cell = ground.cell_at(12.0, 4.0).expect("inside");
    assert!((f64::from(depth(cell)) - place.puddle_m).abs() < 1e-5);
    let (mut films, mut saturations) = (vec![0.0; 96 * 48], vec![0.0; 96 * 48]);
    ground.films_into(&mut films);
    ground.saturations_into(&mut saturations);
    assert!(films.iter().any(|f| *f > 0.5) && saturations.iter().all(|s| (0.0..=1.0).contains(s)));
}

#[test]
fn basins_are_filled_by_hand_without_touching_the_water() {
    let ground = ground(DVec3::ZERO);
    let before = bits(&ground);
    let cells = ground.ground_heights().len();
    let mut levels = vec![0.0; cells];
    let mut last = 0;
    for share in [0.0, 0.25, 0.5, 1.0] {
        ground.levels_filled(share, &mut levels);
        let depth = |cell: usize| levels[cell] - ground.ground_heights()[cell];
        let wet = (0..cells).filter(|&cell| depth(cell) > 0.0).count();
        assert!(wet > last || share == 0.0, "{share}: {wet} cells, {last} before");
        let deepest = (0..cells).map(depth).fold(0.0, f32::max);
        let bowl = DVec3::new(12.1, 0.15, 4.1);
        let water = ground.water_at_filled(bowl, share);
        assert_eq!(water.layer, GroundLayer::Ground);
        assert!(water.puddle_m <= f64::from(deepest) + 1e-6, "{water:?}");
        assert_eq!(water.puddle_m > 0.0, share > 0.0);
        let slope = ground.water_at_filled(DVec3::new(3.1, 0.42, 4.1), share);
        assert_eq!(slope.puddle_m, 0.0, "none on the slope");
        last = wet;
    }
    assert!(last > 20, "{last}");
    // Full is where the water would spill: a storm fills no higher.
    let full = levels.clone();
    let mut stormy = ground.clone();
    run(&mut stormy, rain(400.0), 900.0);
    stormy.levels(&mut levels);
    let pairs = levels.iter().zip(&full).filter(|(now, _)| **now > DRY_LEVEL);
    assert!(pairs.clone().count() > 20 && pairs.clone().all(|(now, full)| (now - full).abs() < 2e-3));
    // What is no share counts as the nearest end.
    for (bad, held) in [(f64::NAN, 0.0), (-1.0, 0.0), (7.0, 1.0)] {
        let (mut a, mut b) = (vec![0.0; cells], vec![0.0; cells]);
        ground.levels_filled(bad, &mut a);
        ground.levels_filled(held, &mut b);
        assert_eq!(a, b, "{bad}");
    }
    assert_eq!(bits(&ground), before);
}

#[test]
fn what_lies_higher_dries_first() {
    let mut ground = ground(DVec3::ZERO);
    run(&mut ground, rain(100.0), 900.0);
    // Along the flank of the bowl, from its bottom to the slope around it.
    let places: Vec<DVec3> = (0..10)
        .map(|i| {
            let x = 12.125 + 0.25 * f64::from(i);
            let cell = ground.cell_at(x, 4.125).expect("on the map");
            let height = ground.base_height_m() + f64::from(ground.ground_heights()[cell]);
            DVec3::new(x, height, 4.125)
        })
        .collect();
    let mut dry_at = vec![f64::INFINITY; places.len()];
    let sun = ColumnForcing {
        rain_mm_h: 0.0,
        evaporation_mm_h: 2.0,
    };
    for minute in 0..4000 {
        ground.advance(&sun, 60.0, 1920).expect("valid");
        for (place, at) in places.iter().zip(&mut dry_at) {
            let water = ground.water_at(*place);
            if water.puddle_m == 0.0 && water.film_mm < 0.01 && *at == f64::INFINITY {
                *at = f64::from(minute);
            }
        }
    }
    assert!(dry_at.iter().all(|at| at.is_finite()), "{dry_at:?}");
    let rises = places.windows(2).zip(dry_at.windows(2));
    for (place, at) in rises.filter(|(place, _)| place[1].y > place[0].y) {
        assert!(at[1] <= at[0], "{place:?} {dry_at:?}");
    }
    assert!(dry_at[0] > 4.0 * dry_at[9], "{dry_at:?}");
}

#[test]
fn exposure_follows_the_cover_map() {
    let mut ground = ground(DVec3::ZERO);
    let wind = FallSlope::new(DVec2::new(4.0, 0.0), 0.17).expect("valid");
    let mut cover = CoverScene::new(CoverSettings::default(), wind).expect("valid");
    let classes = [ClassShare {
        inverse_speed_s_per_m: 0.17,
        share: 1.0,
    }];
    assert!(
        ground.refresh_exposure(&cover, &classes, 0, usize::MAX).expect("valid"),
        "open sky"
    );
    assert!(ground.exposure().iter().all(|e| *e == 255));
    let roof = quad([18.0, 0.0], [23.0, 6.0], |_, _| 4.0);
    cover.add(OccluderId(1), &roof).expect("valid");
    cover.update();
    for first in (0..96 * 48).step_by(1000) {
        ground.refresh_exposure(&cover, &classes, first, 1000).expect("valid");
    }
    // Every cell holds what the cover says, but for the rounding to 255ths.
    let mut between = 0;
    for (cell, &held) in ground.exposure().iter().enumerate() {
        let [x, z] = ground.frame.centre_m(cell % 96, cell / 96);
        let place = DVec3::new(x, ground.heights[cell], z);
        if place.y.is_nan() {
            continue;
        }
        let share = f64::from(cover.flux_exposure(place, &classes).expect("finite"));
        assert!(
            (f64::from(held) / 255.0 - share).abs() < 1.0 / 510.0 + 1e-7,
            "{place}: {held} {share}"
        );
        between += u32::from(share > 0.0 && share < 1.0);
    }
    assert!(between > 20, "{between} cells lie on the border");
    let at = |x: f64| ground.exposure()[12 * 96 + (x / 0.25) as usize];
    // The rain slants along +x by 0.68 m/m: the shadow lies 2.6 m down the wind.
    assert_eq!((at(19.0), at(21.5), at(23.6)), (255, 0, 0));
    run(&mut ground, rain(50.0), 60.0);
    let ledger = ground.ledger();
    assert!(ledger.residual_relative < 1e-12 && ledger.gutters_m3 > 0.0);
}

#[test]
fn a_changed_scene_keeps_its_water() {
    let mut old = ground(DVec3::ZERO);
    run(&mut old, rain(60.0), 401.3);
    for (cell_m, share) in [(0.25, 1e-9), (0.1, 0.03), (0.7, 0.2)] {
        let mut scene = street(DVec3::ZERO);
        scene.remove(3);
        let settings = GroundSettings {
            cell_m,
            ..GroundSettings::default()
        };
        let mut new = Ground::build(&scene, &settings).expect("valid");
        new.take_over(&old).expect("valid");
        let (a, b) = (old.ledger(), new.ledger());
        assert!(b.residual_relative < 1e-12, "{cell_m}: {b:?}");
        assert!((a.rain_m3 - b.rain_m3).abs() < 1e-12 * a.rain_m3);
        let (x, y) = (a.basins_m3 + a.underway_m3, b.basins_m3 + b.underway_m3);
        assert!((x - y).abs() < (share + 0.05) * x, "{cell_m}: {x} {y}");
        run(&mut new, rain(60.0), 30.0);
        assert!(new.ledger().residual_relative < 1e-12);
        assert!(new.water_at(DVec3::new(12.0, 0.1, 4.0)).puddle_m > 0.01);
    }
}

#[test]
fn a_restored_state_goes_on_bit_for_bit() {
    let mut first = ground(DVec3::ZERO);
    run(&mut first, rain(60.0), 123.4);
    first
        .press(DVec2::new(2.0, 2.0), DVec2::new(6.0, 2.5), 0.2, 0.9, 0.5)
        .expect("valid");
    let saved = first.state();
    let mut second = ground(DVec3::ZERO);
    second.restore(&saved).expect("valid");
    assert_eq!(second.state(), saved);
    for (rate, seconds) in [(60.0, 40.0), (0.0, 300.0), (5.0, 20.0)] {
        run(&mut first, rain(rate), seconds);
        run(&mut second, rain(rate), seconds);
        assert!(bits(&first) == bits(&second), "{rate}");
    }
    // Damaged, or of another ground.
    let untouched = bits(&second);
    let mut other = ground(DVec3::new(0.0, 1.0, 0.0));
    let refused = |ground: &mut Ground, state: &GroundState, text: &str| {
        let message = ground.restore(state).expect_err("refused").to_string();
        assert!(message.contains(text), "{message}");
    };
    refused(&mut other, &saved, "scene");
    let damaged = |change: fn(&mut GroundState)| {
        let mut state = saved.clone();
        change(&mut state);
        state
    };
    refused(&mut second, &damaged(|s| s.version = 2), "version 2");
    refused(&mut second, &damaged(|s| s.cells.film[77] = f64::NAN), "cell");
    refused(&mut second, &damaged(|s| s.cells.film[77] += 1.0), "ledger");
    refused(&mut second, &damaged(|s| s.cells.pores[77] = 400.0), "pores");
    refused(&mut second, &damaged(|s| s.cells.film.truncate(7)), "cells");
    refused(&mut second, &damaged(|s| s.inflow.due.truncate(0)), "underway");
    refused(&mut second, &damaged(|s| s.pending[3].time_s = -1.0), "rows");
    refused(&mut second, &damaged(|s| s.pending.truncate(7)), "turns");
    refused(&mut second, &damaged(|s| s.interval_steps = 5), "interval");
    assert!(bits(&second) == untouched);
}

#[test]
fn bad_input_is_refused_and_changes_nothing() {
    let scene = street(DVec3::ZERO);
    let build = |change: fn(&mut GroundSettings)| {
        let mut settings = GroundSettings::default();
        change(&mut settings);
        Ground::build(&scene, &settings).expect_err("refused").to_string()
    };
    assert!(build(|s| s.cell_m = f64::NAN).starts_with("cell_m is NaN"));
    assert!(build(|s| s.max_cells = 0).starts_with("max_cells is 0"));
    assert!(build(|s| s.step_m = -1.0).starts_with("step_m is -1"));
    assert!(build(|s| s.interval_steps = 0).starts_with("interval_steps is 0"));
    assert!(build(|s| s.basin_steps = 33).starts_with("basin_steps is 33"));
    assert!(build(|s| s.puddle_threshold_m = f64::INFINITY).starts_with("puddle_threshold_m"));
    assert!(build(|s| s.properties[0].slope = -1.0).starts_with("slope is -1"));
    let beside = GroundDomain {
        low_m: [100.0, 100.0],
        high_m: [110.0, 110.0],
    };
    let elsewhere = GroundSettings {
        domain: Some(beside),
        ..GroundSettings::default()
    };
    assert!(matches!(Ground::build(&scene, &elsewhere), Err(GroundError::NoGround)));
    let empty = Ground::build(&GroundScene::default(), &GroundSettings::default());
    assert!(matches!(empty, Err(GroundError::NoGround)));
    let mut ground = ground(DVec3::ZERO);
    let before = bits(&ground);
    assert!(ground.advance(&rain(f64::NAN), 1.0, 1).is_err());
    assert!(ground.advance(&rain(1.0), -1.0, 1).is_err());
    assert!(ground.advance(&rain(1e5), 1.0, 1).is_err());
    ground.advance(&rain(1.0), 0.0, 1).expect("does nothing");
    assert!(bits(&ground) == before);
}

/// A strip that moves along x at 2 m/s, 6 m wide, with the full rain.
struct Strip {
    now_s: f64,
    at_s: f64,
}

impl UnevenRain for Strip {
    fn look_back(&mut self, ago_s: f64) {
        self.at_s = self.now_s - ago_s;
    }

    fn share_at(&self, [x, _]: [f64; 2]) -> f64 {
        let behind = 2.0 * self.at_s - x;
        f64::from(u8::from((0.0..6.0).contains(&behind)))
    }
}

#[test]
fn rain_in_a_moving_strip_wets_what_it_crosses_and_the_ledger_closes() {
    let mut ground = ground(DVec3::ZERO);
    let mut strip = Strip { now_s: 0.0, at_s: 0.0 };
    let dry = ColumnForcing {
        rain_mm_h: 300.0,
        evaporation_mm_h: 0.0,
    };
    for step in 1..=(15 * 32) {
        strip.now_s = f64::from(step) * TICK_S;
        ground.advance_under(&dry, TICK_S, 1, Some(&mut strip)).expect("valid");
        let ledger = ground.ledger();
        assert!(ledger.residual_relative < 1e-12, "{step}: {ledger:?}");
    }
    // The strip has crossed the street: 24 by 12 m under 300 mm/h for three seconds.
    let rain = ground.ledger().rain_m3;
    let expected = 24.0 * 12.0 * 300e-3 / 3600.0 * 3.0;
    assert!((rain / expected - 1.0).abs() < 0.05, "{rain} {expected}");
    // Behind it the ground is as wet everywhere, ahead of it dry: look at a second strip that is half way.
    let mut second = self::ground(DVec3::ZERO);
    for step in 1..=(7 * 32) {
        strip.now_s = f64::from(step) * TICK_S;
        second.advance_under(&dry, TICK_S, 1, Some(&mut strip)).expect("valid");
    }
    let wet = |x: f64| second.water_at(DVec3::new(x, 0.02 * (24.0 - x), 2.1)).saturation;
    assert!(
        wet(4.1) > 0.0 && wet(8.1) > 0.0 && wet(16.1) == 0.0,
        "{} {} {}",
        wet(4.1),
        wet(8.1),
        wet(16.1)
    );
    // Interrupted and restored, bit for bit.
    let mut restored = self::ground(DVec3::ZERO);
    restored.restore(&second.state()).expect("fits");
    assert_eq!(bits(&restored), bits(&second));
    for step in 1..=64 {
        strip.now_s = 7.0 + f64::from(step) * TICK_S;
        for ground in [&mut restored, &mut second] {
            ground.advance_under(&dry, TICK_S, 1, Some(&mut strip)).expect("valid");
        }
    }
    assert_eq!(bits(&restored), bits(&second));
}

#[test]
fn the_full_share_everywhere_is_the_plain_rain_bit_for_bit() {
    struct All;
    impl UnevenRain for All {
        fn look_back(&mut self, _: f64) {}
        fn share_at(&self, _: [f64; 2]) -> f64 {
            1.0
        }
    }
    let (mut plain, mut under) = (ground(DVec3::ZERO), ground(DVec3::ZERO));
    run(&mut plain, rain(40.0), 20.0);
    for _ in 0..(20.0 / TICK_S) as u32 {
        under
            .advance_under(&rain(40.0), TICK_S, 1, Some(&mut All))
            .expect("valid");
    }
    assert_eq!(bits(&plain), bits(&under));
    assert!(plain.ledger().rain_m3 > 0.0);
}
