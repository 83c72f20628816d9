//! Cover: questions, what moves, and air that is closed in.

use std::hint::black_box;

use glam::{DVec2, DVec3};
use rain_core::cover::air::{Air, AirGrid};
use rain_core::cover::{
    ClassShare, CoverScene, CoverSettings, FallSlope, OccluderId, ShearedOrthographic, ShearedOrthographicSettings,
};

use super::allocations;

/// A roof of two triangles over [x, x + 6] × [z, z + 4].
fn roof(x: f64, y: f64, z: f64) -> [[DVec3; 3]; 2] {
    let [a, b, c, d] = [(0.0, 0.0), (6.0, 0.0), (6.0, 4.0), (0.0, 4.0)].map(|(i, j)| DVec3::new(x + i, y, z + j));
    [[a, b, c], [a, c, d]]
}

/// A street of 50 roofs with a lorry and a car.
fn street() -> CoverScene {
    let slope = FallSlope::new(DVec2::new(4.0, 1.0), 0.169).expect("inside the domain");
    let mut scene = CoverScene::new(CoverSettings::default(), slope).expect("valid");
    for i in 0..50 {
        let roof = roof(7.0 * f64::from(i), 4.0, 6.0 * f64::from(i % 5));
        scene.add(OccluderId(u64::from(i as u32)), &roof).expect("new");
    }
    scene.add(OccluderId(100), &lorry(0.0)).expect("new");
    scene.add(OccluderId(101), &roof(0.0, 1.5, 60.0)).expect("new");
    scene.update();
    scene
}

fn lorry(x: f64) -> Vec<[DVec3; 3]> {
    [roof(x, 3.0, 40.0), roof(x + 6.0, 3.5, 40.0), roof(x + 12.0, 3.5, 40.0)].concat()
}

#[test]
fn questions_to_the_cover_allocate_nothing() {
    let scene = street();
    let classes = [
        ClassShare {
            inverse_speed_s_per_m: 0.3,
            share: 1.0,
        },
        ClassShare {
            inverse_speed_s_per_m: 0.12,
            share: 3.0,
        },
    ];
    let mut covered = 0;
    let count = allocations(|| {
        for i in 0..500 {
            let point = DVec3::new(0.7 * f64::from(i), 0.01 * f64::from(i % 300), f64::from(i % 31));
            covered += u32::from(scene.covered(point, 0.2).expect("inside"));
            black_box(scene.occluder_height(point).expect("inside"));
            black_box(scene.exposure(point, 0.2).expect("inside"));
            black_box(scene.flux_exposure(point, &classes).expect("inside"));
            black_box((
                scene.tiles().reader().height(i.into(), 3),
                scene.skipped(),
                scene.drawn_drift(),
            ));
        }
    });
    assert_eq!(count, 0);
    assert!(covered > 50, "{covered}");
}

#[test]
fn what_moves_among_the_same_tiles_is_drawn_again_without_allocating() {
    let mut scene = street();
    // To and fro within their tiles.
    let ways: Vec<_> = (0..40)
        .map(|step| 0.05 * f64::from(20 - (step - 20_i32).abs()))
        .collect();
    let lorries: Vec<_> = ways.iter().map(|x| lorry(*x)).collect();
    let pass = |scene: &mut CoverScene| {
        let mut drawn = 0;
        for (x, lorry) in ways.iter().zip(&lorries) {
            scene.replace(OccluderId(100), lorry).expect("known");
            scene
                .replace(OccluderId(101), &roof(*x, 1.5, 57.0 - 4.0 * x))
                .expect("known");
            drawn += scene.update();
        }
        drawn
    };
    let first = pass(&mut scene);
    let once = scene.clone();
    let mut again = 0;
    assert_eq!(allocations(|| again = pass(&mut scene)), 0);
    assert!(first > 80 && again > 80, "{first} {again}");
    assert_eq!(scene.tiles(), once.tiles(), "the same way ends at the same tiles");
    // What stands still is not drawn.
    let triangles = lorry(0.05);
    scene.replace(OccluderId(100), &triangles).expect("known");
    scene.update();
    let count = allocations(|| {
        scene.replace(OccluderId(100), &triangles).expect("known");
        assert_eq!(scene.update(), 0);
    });
    assert_eq!(count, 0);
    // Rain that turns by less than the lattice's step is noted only.
    let slope = FallSlope::new(DVec2::new(4.0, 1.000_1), 0.169).expect("inside the domain");
    assert_eq!(allocations(|| scene.set_slope(slope).expect("fits")), 0);
}

#[test]
fn what_grows_is_allocated_once() {
    let mut scene = street();
    let far = roof(500.0, 3.0, 40.0);
    let grown = allocations(|| {
        scene.replace(OccluderId(101), &far).expect("known");
        assert!(scene.update() > 0);
    });
    assert!(grown > 0, "it came into new tiles");
    let before = scene.tiles().len();
    let more: Vec<_> = (0..30)
        .flat_map(|i| roof(500.0, 3.0 + 0.01 * f64::from(i), 40.0))
        .collect();
    let grown = allocations(|| {
        scene.replace(OccluderId(101), &more).expect("known");
        scene.update();
    });
    assert!(grown > 0, "it has more triangles");
    let back = allocations(|| {
        scene.replace(OccluderId(101), &far).expect("known");
        scene.update();
        scene.replace(OccluderId(101), &more).expect("known");
        scene.update();
    });
    assert_eq!((back, scene.tiles().len()), (0, before));
}

#[test]
fn refused_changes_leave_the_cover_as_it_was() {
    let settings = CoverSettings {
        max_tiles: 2,
        ..CoverSettings::default()
    };
    let mut scene = CoverScene::new(settings, FallSlope::new(DVec2::ZERO, 0.169).expect("calm")).expect("valid");
    scene.add(OccluderId(1), &roof(2.0, 3.0, 2.0)).expect("fits");
    scene.add(OccluderId(2), &roof(3.0, 3.0, 3.0)).expect("fits");
    scene.update();
    let before = scene.clone();
    // Both at a corner of four tiles.
    assert!(scene.replace(OccluderId(1), &roof(14.0, 3.0, 14.0)).is_err());
    assert_eq!(scene.update(), 0);
    assert_eq!(scene.tiles(), before.tiles());
    // And it can still move within its own.
    scene.replace(OccluderId(1), &roof(4.0, 5.0, 2.0)).expect("fits");
    assert_eq!(scene.update(), 1);
    assert_eq!(scene.tiles().highest(), 5.0);
    scene.remove(OccluderId(1)).expect("known");
    scene.remove(OccluderId(2)).expect("known");
    assert_eq!((scene.update(), scene.tiles().len()), (1, 0));
}

#[test]
fn a_map_that_follows_a_view_is_framed_without_allocating() {
    let slope = FallSlope::new(DVec2::new(4.0, 1.0), 0.169).expect("inside the domain");
    let count = allocations(|| {
        for i in 0..50 {
            let eye = DVec3::new(f64::from(i), 2.0, 0.0);
            let map = ShearedOrthographic::new(ShearedOrthographicSettings {
                centre: eye,
                drift: slope.drift(),
                ..ShearedOrthographicSettings::default()
            })
            .expect("inside the domain");
            black_box((
                map.clip_from_world(eye),
                map.texture_uv(eye),
                map.holds(eye, 10.0),
                map.camera_rotation(),
            ));
        }
    });
    assert_eq!(count, 0);
}

#[test]
fn open_air_is_seen_again_without_allocating() {
    let mut grid = AirGrid::default();
    grid.set(1, roof(0.0, 3.0, 0.0).to_vec());
    // Under the roof and on into the open; rain reaches what no roof covers.
    let reached = |p: DVec3| p.y > 3.0 || !(0.0..6.0).contains(&p.x) || !(0.0..4.0).contains(&p.z);
    let mut walk = || {
        for i in 0..20 {
            let eye = DVec3::new(3.0 + 0.3 * f64::from(i), 1.7, 2.0);
            assert_eq!(grid.flood(eye, 20.0, reached), Air::Open);
        }
    };
    walk();
    assert_eq!(allocations(walk), 0);
}
