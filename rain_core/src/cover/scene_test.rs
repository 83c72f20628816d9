//! Properties of the scene and its tiles: redraw, equality with a fresh raster, far places, bad input.

use super::height_tiles::{HeightTiles, TileKey};
use super::lookup::OPEN_SKY;
use super::*;
use crate::hash::{pcg3d, unit_f32};
use glam::{DVec2, DVec3};

const T: f64 = 0.169;

pub(super) fn slope(wind_x: f64, wind_z: f64) -> FallSlope {
    FallSlope::new(DVec2::new(wind_x, wind_z), T).unwrap()
}

/// The 12 triangles of an axis-parallel box.
pub(super) fn box_triangles(low: DVec3, high: DVec3) -> Vec<[DVec3; 3]> {
    let corner = |i: usize| {
        DVec3::new(
            if i & 1 == 0 { low.x } else { high.x },
            if i & 2 == 0 { low.y } else { high.y },
            if i & 4 == 0 { low.z } else { high.z },
        )
    };
    let quads = [
        [0, 1, 3, 2],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 3, 7, 6],
        [0, 2, 6, 4],
        [1, 3, 7, 5],
    ];
    quads
        .iter()
        .flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]])
        .map(|t| t.map(corner))
        .collect()
}

/// Coordinates on the 2⁻¹⁶ m lattice that poses have.
fn on_lattice(v: f64) -> f64 {
    (v * 65_536.0).round() / 65_536.0
}

fn random_box(n: u32, origin: DVec3) -> Vec<[DVec3; 3]> {
    let r = |k| pcg3d([n, k, 77]).map(|h| f64::from(unit_f32(h)));
    let ([x, y, z], [a, b, c]) = (r(0), r(1));
    let low = DVec3::new(80.0 * x - 40.0, 6.0 * y, 80.0 * z - 40.0).map(on_lattice) + origin;
    let size = DVec3::new(0.5 + 12.0 * a, 0.2 + 2.0 * b, 0.5 + 12.0 * c).map(on_lattice);
    box_triangles(low, low + size)
}

fn scene_of(boxes: &[(u64, Vec<[DVec3; 3]>)], slope: FallSlope) -> CoverScene {
    let mut scene = CoverScene::new(CoverSettings::default(), slope).unwrap();
    for (id, triangles) in boxes {
        scene.add(OccluderId(*id), triangles).unwrap();
    }
    scene.update();
    scene
}

fn bits(tiles: &HeightTiles) -> Vec<(TileKey, Vec<u32>)> {
    tiles
        .iter()
        .map(|(k, t)| (k, t.heights().iter().map(|h| h.to_bits()).collect()))
        .collect()
}

#[test]
fn a_moved_object_redraws_its_tiles_and_equals_a_fresh_raster() {
    for rain in [slope(0.0, 0.0), slope(8.0, -3.0)] {
        let mut boxes: Vec<_> = (0..40).map(|n| (u64::from(n), random_box(n, DVec3::ZERO))).collect();
        let mut scene = scene_of(&boxes, rain);
        let before = bits(scene.tiles());
        assert_eq!(scene.update(), 0);

        boxes[7].1 = random_box(1007, DVec3::new(0.3, 0.0, 0.0));
        scene.replace(OccluderId(7), &boxes[7].1).unwrap();
        let redrawn = scene.update();
        // A box of at most 12.5 m and its slanted walls touch few 16 m tiles, before and after.
        assert!(
            (1..=12).contains(&redrawn) && scene.tiles().len() > 24,
            "{redrawn} of {}",
            scene.tiles().len()
        );
        let after = bits(scene.tiles());
        assert_ne!(before, after);
        assert_eq!(after, bits(scene_of(&boxes, rain).tiles()));
        // The order of adding does not matter.
        let reversed: Vec<_> = boxes.iter().rev().cloned().collect();
        assert_eq!(after, bits(scene_of(&reversed, rain).tiles()));

        // The same triangles again: nothing to do.
        scene.replace(OccluderId(7), &boxes[7].1).unwrap();
        assert_eq!(scene.update(), 0);

        scene.remove(OccluderId(7)).unwrap();
        assert!(scene.update() > 0);
        boxes.remove(7);
        assert_eq!(bits(scene.tiles()), bits(scene_of(&boxes, rain).tiles()));
        for (id, _) in &boxes {
            scene.remove(OccluderId(*id)).unwrap();
        }
        scene.update();
        assert!(scene.tiles().is_empty() && scene.tiles().highest() == OPEN_SKY);
    }
}

#[test]
fn a_turned_wind_redraws_and_leaves_no_history() {
    let boxes: Vec<_> = (0..20).map(|n| (u64::from(n), random_box(n, DVec3::ZERO))).collect();
    let mut scene = scene_of(&boxes, slope(2.0, 0.0));
    scene.set_slope(slope(2.001, 0.0)).unwrap();
    assert_eq!(scene.update(), 0, "a turn far below half a degree draws nothing");
    scene.set_slope(slope(-9.0, 4.0)).unwrap();
    let point = DVec3::new(1.0, 1.0, 2.0);
    assert!(scene.covered(point, T).is_ok());
    assert!(scene.update() > 10);
    scene.set_slope(slope(5.0, 5.0)).unwrap();
    scene.update();
    assert_eq!(bits(scene.tiles()), bits(scene_of(&boxes, slope(5.0, 5.0)).tiles()));
}

#[test]
fn far_from_the_origin_is_as_at_the_origin() {
    // 6250 tiles along x, −3125 along z.
    let far = DVec3::new(100_000.0, 0.0, -50_000.0);
    let rain = slope(7.3, -2.1);
    let here: Vec<_> = (0..30).map(|n| (u64::from(n), random_box(n, DVec3::ZERO))).collect();
    let there: Vec<_> = (0..30).map(|n| (u64::from(n), random_box(n, far))).collect();
    let (a, b) = (scene_of(&here, rain), scene_of(&there, rain));
    let shifted: Vec<_> = bits(a.tiles())
        .into_iter()
        .map(|(k, heights)| {
            (
                TileKey {
                    x: k.x + 6250,
                    z: k.z - 3125,
                },
                heights,
            )
        })
        .collect();
    assert!(shifted.len() > 20);
    assert_eq!(shifted, bits(b.tiles()));
    let mut covered = 0;
    for n in 0..3000 {
        let r = pcg3d([n, 1, 9]).map(|h| f64::from(unit_f32(h)));
        let p = DVec3::new(80.0 * r[0] - 40.0, 3.0 * r[1], 80.0 * r[2] - 40.0).map(on_lattice);
        for inverse in [1.0 / 2.29, 1.0 / 6.3] {
            let here = a.covered(p, inverse).unwrap();
            assert_eq!(here, b.covered(p + far, inverse).unwrap(), "{p}");
            assert_eq!(
                a.exposure(p, inverse).unwrap().to_bits(),
                b.exposure(p + far, inverse).unwrap().to_bits()
            );
            covered += u32::from(here);
        }
    }
    assert!((600..5400).contains(&covered), "{covered}");
}

#[test]
fn exposure_runs_from_0_under_the_roof_to_1_in_the_open() {
    let mut scene = CoverScene::new(CoverSettings::default(), slope(0.0, 0.0)).unwrap();
    let ground = box_triangles(DVec3::new(-20.0, -1.0, -20.0), DVec3::new(20.0, 0.0, 20.0));
    scene.add(OccluderId(0), &ground).unwrap();
    let roof = box_triangles(DVec3::new(0.0, 4.0, -5.0), DVec3::new(6.0, 4.2, 5.0));
    scene.add(OccluderId(1), &roof).unwrap();
    scene.update();
    let at = |x: f64| scene.exposure(DVec3::new(x, 0.0, 0.3), 1.0 / 6.3).unwrap();
    assert_eq!([at(3.0), at(-3.0), at(9.0)], [0.0, 1.0, 1.0]);
    let (mut last, mut border) = (1.0, 0);
    for i in 0..400 {
        let e = at(-1.0 + 0.005 * f64::from(i));
        assert!(e <= last, "rises under the roof");
        assert!(last - e < 0.03, "{e} after {last}");
        border += i32::from(e > 0.0 && e < 1.0);
        last = e;
    }
    // One cell wide, 0.25 m in steps of 5 mm, about the edge of the roof.
    assert!((45..=55).contains(&border), "{border}");
    assert!((at(0.0) - 0.5).abs() < 0.05, "{}", at(0.0));
    // On the roof itself it rains.
    assert_eq!(scene.exposure(DVec3::new(3.0, 4.2, 0.0), 1.0 / 6.3).unwrap(), 1.0);
    let classes = [0.2, 0.5, 0.3].map(|share| ClassShare {
        inverse_speed_s_per_m: T,
        share,
    });
    assert!((scene.flux_exposure(DVec3::new(-3.0, 0.0, 0.0), &classes).unwrap() - 1.0).abs() < 1.0e-6);
    assert!(scene.flux_exposure(DVec3::ZERO, &[]).is_err());
}

#[test]
fn in_wind_slow_drops_reach_farther_under_the_roof() {
    let mut scene = CoverScene::new(CoverSettings::default(), slope(5.0, 0.0)).unwrap();
    let roof = box_triangles(DVec3::new(0.0, 4.0, -50.0), DVec3::new(30.0, 4.2, 50.0));
    scene.add(OccluderId(1), &roof).unwrap();
    scene.update();
    for u in [2.29, 3.42, 4.81, 6.3, 9.12] {
        // Covered from where the drop that just passes the roof's windward edge lands.
        let edge = 4.0 * 5.0 / u;
        let at = |x: f64| scene.exposure(DVec3::new(x, 0.0, 0.0), 1.0 / u).unwrap();
        assert_eq!([at(edge - 0.8), at(edge + 0.8)], [1.0, 0.0], "u = {u}");
    }
    let (slow, fast) = (1.0 / 2.29, 1.0 / 9.12);
    let classes = [(slow, 1.0), (fast, 3.0)].map(|(i, share)| ClassShare {
        inverse_speed_s_per_m: i,
        share,
    });
    let mixed = scene.flux_exposure(DVec3::new(5.0, 0.0, 0.0), &classes).unwrap();
    assert_eq!(mixed, 0.25);
}

#[test]
fn a_slope_does_not_cover_itself() {
    for (wind, rise) in [(0.0, 1.0), (0.0, -1.0), (5.0, 0.5), (5.0, -0.5), (10.0, -0.25)] {
        let mut scene = CoverScene::new(CoverSettings::default(), slope(wind, 0.0)).unwrap();
        let p = |x: f64, z: f64| DVec3::new(x, rise * x, z);
        let hill = [
            [p(-30.0, -30.0), p(30.0, -30.0), p(30.0, 30.0)],
            [p(-30.0, -30.0), p(30.0, 30.0), p(-30.0, 30.0)],
        ];
        scene.add(OccluderId(3), &hill).unwrap();
        scene.update();
        let mut bare = 0;
        for n in 0..500 {
            let r = pcg3d([n, 3, 4]).map(|h| f64::from(unit_f32(h)));
            let at = p(20.0 * r[0] - 10.0, 20.0 * r[1] - 10.0);
            for u in [4.81, 8.0] {
                assert_eq!(
                    scene.exposure(at, 1.0 / u).unwrap(),
                    1.0,
                    "{at}, wind {wind}, rise {rise}"
                );
                bare += u32::from(scene.covered(at, 1.0 / u).unwrap());
            }
        }
        // Without the clearance the hill would lie in its own shadow here and there.
        assert!(bare > 50, "{bare}");
    }
}

#[test]
fn what_covers_nothing_is_counted() {
    let mut scene = CoverScene::new(CoverSettings::default(), slope(0.0, 0.0)).unwrap();
    let p = |x, y, z| DVec3::new(x, y, z);
    let (a, b, c) = (p(0.0, 2.0, 0.0), p(4.0, 2.0, 0.0), p(0.0, 2.0, 4.0));
    let triangles = [
        [a, b, c],
        [a, p(f64::NAN, 2.0, 0.0), c],
        [a, b, p(0.0, f64::INFINITY, 0.0)],
        [a, a, c],
        [a, b, p(2.0, 2.0, 0.0)],
        [a, b, p(1.0, 5.0, 0.0)],
    ];
    scene.add(OccluderId(1), &triangles).unwrap();
    scene.update();
    assert_eq!(
        scene.skipped(),
        SkippedTriangles {
            non_finite: 2,
            degenerate: 2,
            edge_on: 1
        }
    );
    assert!(
        scene
            .tiles()
            .iter()
            .all(|(_, t)| t.heights().iter().all(|h| *h == 2.0 || *h == OPEN_SKY))
    );
    assert!(scene.covered(p(1.0, 0.0, 1.0), T).unwrap());
    assert_eq!(scene.occluder_height(p(1.0, 0.0, 1.0)).unwrap(), Some(2.0));
    assert_eq!(scene.occluder_height(p(-1.0, 0.0, 1.0)).unwrap(), None);
    // In wind the wall is seen from the side.
    scene.set_slope(slope(0.0, 6.0)).unwrap();
    assert_eq!(
        scene.skipped(),
        SkippedTriangles {
            non_finite: 2,
            degenerate: 2,
            edge_on: 0
        }
    );
}

#[test]
fn refused_changes_leave_the_scene_as_it_was() {
    let settings = CoverSettings {
        max_tiles: 200,
        ..Default::default()
    };
    let mut scene = CoverScene::new(settings, slope(0.0, 0.0)).unwrap();
    let roof = box_triangles(DVec3::new(0.0, 4.0, 0.0), DVec3::new(40.0, 4.2, 40.0));
    scene.add(OccluderId(1), &roof).unwrap();
    scene.update();
    let before = bits(scene.tiles());
    let plate = |half: f64| box_triangles(DVec3::new(-half, 0.0, -half), DVec3::new(half, 0.1, half));

    assert_eq!(
        scene.add(OccluderId(1), &roof),
        Err(CoverError::DuplicateOccluder { id: OccluderId(1) })
    );
    assert_eq!(
        scene.remove(OccluderId(2)),
        Err(CoverError::UnknownOccluder { id: OccluderId(2) })
    );
    assert_eq!(
        scene.replace(OccluderId(2), &roof),
        Err(CoverError::UnknownOccluder { id: OccluderId(2) })
    );
    // One triangle alone too large, and many small ones too many.
    assert!(matches!(
        scene.add(OccluderId(2), &plate(500.0)),
        Err(CoverError::TooManyTiles { allowed: 200, .. })
    ));
    let rows: Vec<_> = (0..30_u32)
        .flat_map(|i| {
            let at = DVec3::new(0.0, 1.0, 50.0 * f64::from(i));
            box_triangles(at, at + DVec3::new(150.0, 1.0, 1.0))
        })
        .collect();
    assert!(matches!(
        scene.add(OccluderId(2), &rows),
        Err(CoverError::TooManyTiles { allowed: 200, .. })
    ));
    assert!(matches!(
        scene.replace(OccluderId(1), &rows),
        Err(CoverError::TooManyTiles { allowed: 200, .. })
    ));
    let wide = [[DVec3::ZERO, DVec3::new(20_000.0, 0.0, 0.0), DVec3::new(0.0, 0.0, 1.0)]];
    let error = scene.add(OccluderId(2), &wide).unwrap_err();
    assert_eq!(
        error.to_string(),
        "occluder 2 spans 20000 m of the projected plane, allowed: up to 16384 m"
    );
    let far = [[DVec3::ZERO, DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.0, 0.0, 1.0e9)]];
    assert!(matches!(scene.add(OccluderId(2), &far), Err(CoverError::Config(_))));
    let high = [[DVec3::ZERO, DVec3::new(1.0, 1.0e30, 0.0), DVec3::new(0.0, 0.0, 1.0)]];
    assert!(matches!(scene.add(OccluderId(2), &high), Err(CoverError::Config(_))));
    // Walls of 1 km leave no trace in calm air and need kilometres in a storm.
    let tower = box_triangles(DVec3::new(0.0, 0.0, 0.0), DVec3::new(10.0, 1000.0, 10.0));
    scene.add(OccluderId(5), &tower).unwrap();
    assert!(scene.set_slope(slope(60.0, 60.0)).is_err());
    assert_eq!(*scene.slope(), slope(0.0, 0.0));
    scene.remove(OccluderId(5)).unwrap();
    scene.update();
    assert_eq!(bits(scene.tiles()), before);

    assert!(scene.covered(DVec3::NAN, T).is_err());
    assert!(scene.covered(DVec3::new(0.0, f64::INFINITY, 0.0), T).is_err());
    assert!(scene.covered(DVec3::ZERO, f64::NAN).is_err());
    assert!(scene.exposure(DVec3::ZERO, 0.0).is_err());
    for cell_m in [0.0, f64::NAN, 0.1, 9.0] {
        let settings = CoverSettings {
            cell_m,
            ..Default::default()
        };
        assert!(CoverScene::new(settings, slope(0.0, 0.0)).is_err(), "{cell_m}");
    }
}

#[test]
fn a_tower_does_not_hide_the_low_roofs() {
    // A 120 m tower 30 m upwind, to the side: one height bound for the whole map would start far above the roof.
    let mut scene = CoverScene::new(CoverSettings::default(), slope(10.0, 0.0)).unwrap();
    scene
        .add(
            OccluderId(1),
            &box_triangles(DVec3::new(0.0, 4.0, -5.0), DVec3::new(6.0, 4.2, 5.0)),
        )
        .unwrap();
    scene
        .add(
            OccluderId(2),
            &box_triangles(DVec3::new(-30.0, 0.0, 40.0), DVec3::new(-20.0, 120.0, 50.0)),
        )
        .unwrap();
    scene.update();
    let mut covered = 0;
    for i in 0..60 {
        let (x, u) = (0.25 + 0.2 * f64::from(i), 4.12);
        let crossing = x - (4.1 - 1.0) * 10.0 / u;
        let expected = (0.0..6.0).contains(&crossing);
        if crossing.abs() < 0.5 || (crossing - 6.0).abs() < 0.5 {
            continue;
        }
        assert_eq!(
            scene.covered(DVec3::new(x, 1.0, 0.0), 1.0 / u).unwrap(),
            expected,
            "{x}"
        );
        covered += u32::from(expected);
    }
    assert!(covered > 10);
}
