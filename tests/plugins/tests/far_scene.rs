//! The same scene far from the world's origin, and a hundredth and a hundred times as large.

use bevy::prelude::*;
use image::RgbImage;
use rain_plugins::prelude::*;
use rain_plugins::surface::WaterLevels;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

use crate::scenes::{broken_channels, depth, difference, hollow, hollow_at, place, rain, surfaces_only, terrain};

/// Over 100 km away, by whole tiles of waves (64 m, 512 m) and rings (2 m), whole repeats of the noise (2048 m), whole cells of
/// the ground and whole texels of the cover map: everything that repeats or snaps is the same there.
const FAR: Vec3 = Vec3::new(122_880.0, 0.0, -122_880.0);

/// A slope with a hollow, and a roof beside it, dry and after 20 minutes of rain; wind ruffles the water.
fn pictures(at: Vec3) -> [RgbImage; 2] {
    let (mut test, weather) = hollow_at(at);
    world::block(
        test.world(),
        "roof",
        at + Vec3::new(1.5, 2.5, -3.0),
        at + Vec3::new(5.5, 2.75, 1.0),
        world::STONE,
    );
    test.leap(2);
    let dry = test.picture();
    test.world().entity_mut(weather).insert(Weather {
        wind_m_s: Vec3::new(6.0, 0.0, 2.0),
        ..Weather::rain(60.0)
    });
    test.leap(1200);
    test.frames(4, FRAME);
    assert!(depth(&mut test, f64::from(at.x), f64::from(at.z)) > 0.01);
    [dry, test.picture()]
}

#[test]
fn a_scene_at_100_km_looks_like_the_same_scene_at_the_origin() {
    if !gpu::available() {
        return;
    }
    let [dry, wet] = pictures(Vec3::ZERO);
    let [far_dry, far_wet] = pictures(FAR);
    let changed = difference(&dry, &wet);
    assert!(changed.mean > 8.0, "rain changes the picture: {changed:?}");
    // What single-precision vertices do to the dry picture, here 8 mm steps, is Bevy's own.
    let bare = difference(&dry, &far_dry);
    assert!(bare.mean < 0.5 && bare.share < 0.01, "dry: {bare:?}");
    let found = difference(&wet, &far_wet);
    assert!(found.mean < 1.0 && found.share < 0.03, "wet: {found:?}, dry: {bare:?}");
}

/// A plate with noise puddles full of wind waves, seen from close by.
fn noise(at: Vec3, wind: f32) -> RgbImage {
    let mut test = TestApp::new([96, 64], true);
    test.world().insert_resource(SurfaceSettings {
        enabled: false,
        ..default()
    });
    test.world().insert_resource(WaterAppearance {
        ripple_strength: 0.0,
        wave_strength: 4.0,
        wave_length_m: 2.0,
        ..default()
    });
    let plate = terrain([8, 8], 0.5, |_, _| Some(0.0));
    let plate = place(test.world(), plate, Transform::from_translation(at));
    test.world().entity_mut(plate).insert(NoisePuddles {
        size_m: 0.5,
        level: Some(0.8),
        height_map: false,
        ..default()
    });
    test.world().spawn((
        Weather {
            wind_m_s: Vec3::new(wind, 0.0, 0.3 * wind),
            ..Weather::rain(20.0)
        },
        WeatherMode::Artist,
    ));
    let camera = test.camera;
    surfaces_only(&mut test, camera);
    test.look(at + Vec3::new(0.0, 0.75, 1.0), at);
    test.frames(3, FRAME);
    test.leap(600);
    test.picture()
}

#[test]
fn noise_puddles_and_wind_waves_at_100_km_keep_their_pattern_and_their_grain() {
    if !gpu::available() {
        return;
    }
    let (near, calm, far) = (noise(Vec3::ZERO, 8.0), noise(Vec3::ZERO, 0.0), noise(FAR, 8.0));
    let waves = difference(&near, &calm);
    assert!(waves.mean > 1.5, "waves show: {waves:?}");
    // Vertices lie up to 8 mm off there, by Bevy's own single precision; the shortest of these waves has 10 cm.
    let found = difference(&near, &far);
    assert!(found.mean < 0.4 * waves.mean, "{found:?}, without waves {waves:?}");
    let other = noise(FAR + Vec3::new(3.0, 0.0, 0.0), 8.0);
    let other = difference(&near, &other);
    assert!(
        other.mean > 2.0 * found.mean,
        "another place differs: {other:?}, the same {found:?}"
    );
}

#[test]
fn scenes_of_a_hundredth_and_a_hundred_times_the_size_rain_and_hold_water() {
    if !gpu::available() {
        return;
    }
    for scale in [0.01_f32, 100.0] {
        let mut test = TestApp::new([64, 32], true);
        test.world().insert_resource(SurfaceSettings {
            cell_m: 0.25 * f64::from(scale).clamp(0.04, 1.0),
            ..default()
        });
        let ground = terrain([48, 48], 0.25, |x, z| Some(hollow(x, z)));
        place(test.world(), ground, Transform::from_scale(Vec3::splat(scale)));
        let weather = test.world().spawn(Weather::rain(0.0)).id();
        test.look(scale * Vec3::new(0.0, 2.0, 4.0), Vec3::ZERO);
        test.frames(3, FRAME);
        test.leap(2);
        rain(&mut test, weather, 60.0, 1200);
        let surface = test.world().resource::<SurfaceGround>();
        let cells = surface.ground().map(|g| g.frame().cells()).expect("a ground");
        assert!(cells[0] * cells[1] <= 1 << 20 && cells[0] >= 12, "{scale}: {cells:?}");
        assert!(surface.ledger().residual_relative < 1e-9);
        let deep = test.world().resource::<WaterLevels>().depth_at(0.0, 0.0);
        if scale > 1.0 {
            assert!(deep > 1e-3 && deep < 6.0, "{scale}: {deep} m");
        } else {
            // A hollow of 0.6 mm holds no puddle: water keeps its size, whatever the scene's.
            assert!(deep == 0.0, "{scale}: {deep} m");
        }
        let camera = test.camera;
        assert_eq!(broken_channels(&mut test, camera), 0);
    }
}
