//! A million triangles.

use bevy::prelude::*;
use rain_plugins::prelude::*;
use test_support::app::{FRAME, TestApp};
use test_support::gpu;

use crate::scenes::{depth, hollow, place, rain, surfaces_only, terrain};

#[test]
fn a_million_triangles_cover_and_are_ground_within_the_bounds_of_memory() {
    if !gpu::available() {
        return;
    }
    let mut test = TestApp::new([64, 32], true);
    let ground = terrain([708, 708], 0.125, |x, z| Some(hollow(x, z)));
    assert!(ground.indices().is_some_and(|i| i.len() > 3_000_000));
    place(test.world(), ground, Transform::default());
    let weather = test.world().spawn(Weather::rain(0.0)).id();
    let camera = test.camera;
    surfaces_only(&mut test, camera);
    test.look(Vec3::new(0.0, 2.0, 4.0), Vec3::ZERO);
    let start = std::time::Instant::now();
    test.frames(1, FRAME);
    let handed = start.elapsed();
    test.frames(2, FRAME);
    let start = std::time::Instant::now();
    test.frames(1, std::time::Duration::from_secs(2));
    eprintln!("taken in: {handed:?}, cover and ground built: {:?}", start.elapsed());
    let cells = test
        .world()
        .resource::<SurfaceGround>()
        .ground()
        .map(|g| g.frame().cells());
    // 88.5 m square in cells of 25 cm.
    assert_eq!(cells, Some([354, 354]));
    let tiles = test.world().resource::<CoverField>().scene().tiles().len();
    // Tiles of 16 m; the map holds one more at each rim.
    assert!((36..=64).contains(&tiles), "{tiles} tiles");
    test.frames(1, FRAME);
    rain(&mut test, weather, 60.0, 1200);
    assert!(depth(&mut test, 0.0, 0.0) > 0.01, "the hollow fills");
    let ledger = test.world().resource::<SurfaceGround>().ledger();
    assert!(ledger.residual_relative < 1e-9, "{ledger:?}");
    // A still scene is not looked at again: the picture costs what a small one does.
    let exposed = test.world().resource::<CoverField>().version();
    test.frames(5, FRAME);
    assert_eq!(test.world().resource::<CoverField>().version(), exposed);
}
