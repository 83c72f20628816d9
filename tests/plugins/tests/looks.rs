//! Looks of wet surfaces: the sources' own rules against materials made by hand, fixed states, what stays dry.

use bevy::prelude::*;
use rain_plugins::prelude::*;
use rain_plugins::render_adapter::WetMaterial;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

use crate::tiles::{Tiles, distance, rough, state, stripes};

/// Spread of brightness over its mean.
fn contrast(pixels: &[[f64; 3]]) -> f64 {
    let n = pixels.len() as f64;
    let mean = pixels.iter().map(|p| p[1]).sum::<f64>() / n;
    let square = pixels.iter().map(|p| (p[1] - mean).powi(2)).sum::<f64>() / n;
    square.sqrt() / mean
}

/// A material as a source's rules make it, typed from the listings: albedo, gloss, F₀.
fn by_hand(albedo: f32, gloss: f32, f0: f32) -> StandardMaterial {
    StandardMaterial {
        perceptual_roughness: (1.0 - gloss).max(0.045),
        reflectance: (f0 / 0.16).sqrt(),
        ..rough(albedo)
    }
}

#[test]
fn each_sources_look_is_its_listing_on_the_picture_and_switches_live() {
    if !gpu::available() {
        return;
    }
    // Albedo 0.6, gloss 0.1: wet 0.18 and 0.25; porosity 1 wet 0.12 and 0.46; under water gloss 1, F₀ 0.02.
    let wet = SurfaceState::Wet;
    let puddle = SurfaceState::Puddle;
    let cases = [
        (WetLook::Lagarde, wet, by_hand(0.18, 0.25, 0.04)),
        (WetLook::Lagarde, puddle, by_hand(0.18, 1.0, 0.02)),
        (WetLook::LagardePorous, wet, by_hand(0.12, 0.46, 0.04)),
        (WetLook::LagardePorous, puddle, by_hand(0.12, 1.0, 0.02)),
        (WetLook::Nguyenova, wet, by_hand(0.18, 0.25, 0.04)),
        (WetLook::Nguyenova, puddle, by_hand(0.144, 1.0, 0.04)),
    ];
    let mut tiles = Tiles::new([rough(0.6), rough(0.6), rough(0.6)]);
    // The third lies where the first does, in its stead.
    let place = Transform::from_xyz(Tiles::x(0, 3), 0.0, 0.0);
    tiles.put(2, (KeepDry, place, Visibility::Hidden));
    let hand = tiles.plates[2];
    tiles.put(
        1,
        SurfaceWetting {
            look: Some(WetLook::Physical),
            ..state(wet)
        },
    );
    tiles.put(0, state(wet));
    tiles.test.frames(4, FRAME);
    let physical = tiles.seen();
    for (look, state_of, material) in cases {
        tiles.put(0, (state(state_of), Visibility::Visible));
        tiles.test.world().insert_resource(look);
        let handle = tiles
            .test
            .world()
            .resource_mut::<Assets<StandardMaterial>>()
            .add(material);
        tiles.put(2, Visibility::Hidden);
        tiles.test.world().entity_mut(hand).insert(MeshMaterial3d(handle));
        tiles.test.frames(4, FRAME);
        let seen = tiles.seen();
        assert!(
            distance(seen[1], physical[1]) < 0.5,
            "a mesh with a look of its own keeps it: {seen:?}"
        );
        assert!(
            distance(seen[0], physical[0]) > 5.0,
            "{look:?} is not physics: {seen:?}, {physical:?}"
        );
        tiles.put(0, Visibility::Hidden);
        tiles.put(2, Visibility::Visible);
        tiles.test.frames(4, FRAME);
        let by_hand = tiles.seen();
        assert!(
            distance(seen[0], by_hand[0]) < 1.0,
            "{look:?} {state_of:?}: {seen:?}, by hand {by_hand:?}"
        );
    }
    tiles.put(2, Visibility::Hidden);
    tiles.put(0, Visibility::Visible);
    tiles.put(0, state(wet));
    tiles.test.world().insert_resource(WetLook::Physical);
    tiles.test.frames(4, FRAME);
    assert!(distance(tiles.seen()[0], physical[0]) < 0.5, "and back");
}

#[test]
fn smooth_things_and_metals_keep_their_colour_by_porosity() {
    if !gpu::available() {
        return;
    }
    let smooth = StandardMaterial {
        perceptual_roughness: 0.3,
        ..rough(0.5)
    };
    let metal = StandardMaterial {
        metallic: 1.0,
        ..rough(0.5)
    };
    let mut tiles = Tiles::new([rough(0.5), smooth, metal]);
    tiles.test.frames(2, FRAME);
    let dry = tiles.seen();
    tiles.test.world().insert_resource(WetLook::LagardePorous);
    for plate in 0..3 {
        tiles.put(plate, state(SurfaceState::Wet));
    }
    tiles.test.frames(4, FRAME);
    let wet = tiles.seen();
    let change: Vec<f64> = (0..3).map(|i| distance(dry[i], wet[i])).collect();
    assert!(change[0] > 30.0 && change[1] < 4.0 && change[2] < 4.0, "{change:?}");
}

#[test]
fn the_four_states_look_dry_dark_glossy_and_like_water() {
    if !gpu::available() {
        return;
    }
    for look in [WetLook::Physical, WetLook::Lagarde] {
        let mut tiles = Tiles::new([rough(0.5)]);
        tiles.test.world().insert_resource(look);
        // In the mirror image of the light.
        tiles.test.look(Vec3::new(0.3, 1.0, -0.4) * 4.0, Vec3::ZERO);
        let lights: Vec<Entity> = {
            let world = tiles.test.world();
            let mut lights = world.query_filtered::<Entity, With<DirectionalLight>>();
            lights.iter(world).collect()
        };
        for light in lights {
            tiles
                .test
                .world()
                .get_mut::<DirectionalLight>(light)
                .expect("a light")
                .illuminance = 600.0;
        }
        let mut seen = Vec::new();
        for of in [
            SurfaceState::Dry,
            SurfaceState::Wet,
            SurfaceState::Drenched,
            SurfaceState::Puddle,
        ] {
            tiles.put(0, state(of));
            tiles.test.frames(4, FRAME);
            let picture = tiles.test.picture();
            let places = (16..44).flat_map(|y| (106..134).map(move |x| (x, y)));
            let mut bright: Vec<f64> = places.map(|(x, y)| f64::from(picture.get_pixel(x, y).0[1])).collect();
            bright.sort_by(f64::total_cmp);
            // The body beside the highlight, and the highlight.
            seen.push((bright[bright.len() / 8], bright[bright.len() - 1]));
        }
        let gloss: Vec<f64> = seen.iter().map(|(body, peak)| peak - body).collect();
        assert!(seen[1].0 < seen[0].0 - 15.0, "{look:?}: wet ground is darker: {seen:?}");
        assert!(
            seen[3].0 < seen[0].0 - 15.0,
            "{look:?}: so is the ground of a puddle: {seen:?}"
        );
        assert!(
            gloss[2] > gloss[1] + 5.0 && gloss[3] > gloss[2] + 5.0,
            "{look:?}: the highlight sharpens from wet over drenched to puddle: {seen:?}"
        );
    }
}

#[test]
fn wet_ground_keeps_its_relief_and_standing_water_fills_it() {
    if !gpu::available() {
        return;
    }
    for look in [WetLook::Physical, WetLook::Lagarde] {
        let mut tiles = Tiles::new([rough(0.5)]);
        // Slopes of 30° towards −x and +x in turns.
        let slopes = stripes(&mut tiles.test, &[[64, 128, 238], [192, 128, 238]].repeat(4));
        let material = StandardMaterial {
            normal_map_texture: Some(slopes),
            ..rough(0.5)
        };
        let handle = tiles
            .test
            .world()
            .resource_mut::<Assets<StandardMaterial>>()
            .add(material);
        tiles.put(0, MeshMaterial3d(handle));
        tiles.test.world().insert_resource(look);
        tiles.test.frames(4, FRAME);
        let mut contrasts = Vec::new();
        for of in [SurfaceState::Dry, SurfaceState::Wet, SurfaceState::Puddle] {
            tiles.put(0, state(of));
            tiles.test.frames(4, FRAME);
            let picture = tiles.test.picture();
            contrasts.push(contrast(&tiles.pixels(&picture, 0)));
        }
        let [dry, wet, puddle] = [contrasts[0], contrasts[1], contrasts[2]];
        assert!(dry > 0.02, "{look:?}: {contrasts:?}");
        assert!(wet > 0.7 * dry, "{look:?}: wet ground keeps its normals: {contrasts:?}");
        assert!(puddle < 0.15 * dry, "{look:?}: water is flat: {contrasts:?}");
    }
}

#[test]
fn where_only_ground_gets_wet_walls_stay_dry_in_slanted_rain() {
    if !gpu::available() {
        return;
    }
    let mut test = TestApp::new([80, 60], true);
    let wall = world::block(
        test.world(),
        "wall",
        Vec3::new(-1.0, 0.0, -2.0),
        Vec3::new(0.0, 2.0, 2.0),
        world::STONE,
    );
    let weather = test.world().spawn(Weather::rain(0.0)).id();
    let camera = test.camera;
    test.world().entity_mut(camera).insert(RainView {
        streak_budget: Some(0),
        ..default()
    });
    // The face at x = 0 below, the top above; rain comes from +x.
    test.look(Vec3::new(3.0, 4.0, 0.0), Vec3::new(-0.2, 1.8, 0.0));
    let mut seen = Vec::new();
    for (rain, ground_only) in [(0.0, false), (30.0, false), (30.0, true)] {
        test.world().entity_mut(wall).insert(SurfaceWetting {
            ground_only,
            ..default()
        });
        test.world().entity_mut(weather).insert(Weather {
            wind_m_s: Vec3::new(-12.0, 0.0, 0.0),
            ..Weather::rain(rain)
        });
        test.leap(300);
        test.frames(3, FRAME);
        let picture = test.picture();
        let mean = |rows: std::ops::Range<u32>| {
            let n = f64::from(rows.len() as u32 * 20);
            let pixels = rows.flat_map(|y| (30..50).map(move |x| (x, y)));
            pixels
                .map(|(x, y)| f64::from(picture.get_pixel(x, y).0[1]))
                .sum::<f64>()
                / n
        };
        // Top and face.
        seen.push((mean(22..27), mean(34..46)));
    }
    let [dry, all, ground] = [seen[0], seen[1], seen[2]];
    assert!(all.0 < dry.0 - 8.0 && all.1 < dry.1 - 4.0, "both get wet: {seen:?}");
    assert!(ground.0 < dry.0 - 8.0, "the top still does: {seen:?}");
    assert!((ground.1 - dry.1).abs() < 1.5, "the face does not: {seen:?}");
}

#[test]
fn a_fixed_state_needs_no_rain_and_goes_with_its_component() {
    if !gpu::available() {
        return;
    }
    let mut tiles = Tiles::new([rough(0.5), rough(0.5)]);
    tiles.test.frames(2, FRAME);
    let dry = tiles.seen();
    tiles.put(0, state(SurfaceState::Wet));
    tiles.test.frames(4, FRAME);
    let seen = tiles.seen();
    assert!(
        distance(seen[0], dry[0]) > 8.0 && distance(seen[1], dry[1]) < 1.0,
        "{seen:?} {dry:?}"
    );
    let plate = tiles.plates[0];
    tiles.test.world().entity_mut(plate).remove::<SurfaceWetting>();
    tiles.test.frames(4, FRAME);
    assert_eq!(tiles.seen(), dry);
    assert!(tiles.test.world().get::<MeshMaterial3d<WetMaterial>>(plate).is_none());
    // Gone in the rain: as wet as its neighbour, which never had one.
    tiles.put(0, state(SurfaceState::Dry));
    tiles.rain(50.0, 60);
    let held = tiles.seen();
    assert!(
        distance(held[0], dry[0]) < 1.0 && distance(held[1], dry[1]) > 8.0,
        "{held:?}"
    );
    tiles.test.world().entity_mut(plate).remove::<SurfaceWetting>();
    tiles.test.frames(4, FRAME);
    assert!(distance(tiles.seen()[0], dry[0]) > 8.0);
}
