//! Split screens, cuts, resized targets, sample counts, projections, layers: each view shows what it would show alone.

use bevy::camera::visibility::RenderLayers;
use bevy::camera::{ClearColorConfig, Hdr, ScalingMode, Viewport};
use bevy::prelude::*;
use bevy::render::render_resource::Extent3d;
use image::RgbImage;
use rain_plugins::prelude::*;
use rain_plugins::surface::WaterLevels;
use test_support::app::{FRAME, TestApp, spawn_camera, target_image};
use test_support::{gpu, world};

use crate::scenes::{
    Difference, brightness, broken_channels, difference, hollow, part, place, rain, surfaces_only, terrain,
};

const SIZE: [u32; 2] = [96, 54];

/// Two places of the scene, 40 m apart.
const HERE: Vec3 = Vec3::new(-20.0, 0.0, 0.0);
const THERE: Vec3 = Vec3::new(20.0, 0.0, 0.0);

/// Ground with a hollow at each of two places and a roof beside each, after ten minutes of rain; rings are off, because
/// they move.
fn street(size: [u32; 2]) -> (TestApp, Entity) {
    street_of(size, [HERE, THERE], 0.25)
}

/// A street with its two places where they are wanted, on a grid of cells of this side.
fn street_of(size: [u32; 2], places: [Vec3; 2], cell_m: f64) -> (TestApp, Entity) {
    let mut test = TestApp::new(size, true);
    test.world().insert_resource(WaterAppearance {
        ripple_strength: 0.0,
        ..default()
    });
    test.world().insert_resource(SurfaceSettings { cell_m, ..default() });
    let level = |x: f32, z: f32| hollow(x, z) - 0.01 * x;
    let two = |x: f32, z: f32| Some(places.iter().map(|p| level(x - p.x, z)).sum::<f32>());
    let length = 2.0 * (places[1].x - places[0].x + 12.0);
    place(
        test.world(),
        terrain([length as u32, 28], 0.5, two),
        Transform::default(),
    );
    for at in places {
        let low = at + Vec3::new(1.0, 3.0, -5.0);
        world::block(test.world(), "roof", low, low + Vec3::new(3.0, 0.2, 5.0), world::STONE);
    }
    let weather = test.world().spawn(Weather::rain(0.0)).id();
    look_at(&mut test, places[0]);
    test.frames(3, FRAME);
    test.leap(2);
    rain(&mut test, weather, 60.0, 600);
    (test, weather)
}

/// Where a camera stands to see a place: hollow, and ground in the open and under the roof.
fn stand(at: Vec3) -> Transform {
    Transform::from_translation(at + Vec3::new(0.5, 2.2, 4.5)).looking_at(at + Vec3::new(0.5, 0.0, 0.0), Vec3::Y)
}

fn look_at(test: &mut TestApp, at: Vec3) {
    let camera = test.camera;
    test.world().entity_mut(camera).insert(stand(at));
}

/// Adds a camera without streaks.
fn add_camera(test: &mut TestApp, target: &Handle<Image>, at: Vec3) -> Entity {
    let camera = spawn_camera(&mut test.app, target, true);
    surfaces_only(test, camera);
    test.world().entity_mut(camera).insert(stand(at));
    camera
}

/// Lets a second and some frames pass: the number of streaks follows a view's size over a second, or at once after a
/// pause.
fn settle(test: &mut TestApp) {
    test.leap(1);
    test.frames(4, FRAME);
}

fn alike(what: &str, a: &RgbImage, b: &RgbImage) {
    let Difference { mean, share } = difference(a, b);
    assert!(
        mean < 0.6 && share < 0.005,
        "{what}: {mean} in the mean, {share} of the pixels"
    );
}

/// What one camera alone shows of a place, at this size; `streaks` as well or surfaces only.
fn alone(size: [u32; 2], at: Vec3, streaks: bool) -> RgbImage {
    let (mut test, _) = street(size);
    let camera = test.camera;
    if !streaks {
        surfaces_only(&mut test, camera);
    }
    look_at(&mut test, at);
    settle(&mut test);
    test.picture()
}

#[test]
fn each_half_of_a_split_screen_shows_what_a_camera_alone_shows() {
    if !gpu::available() {
        return;
    }
    let half = [SIZE[0] / 2, SIZE[1]];
    let (mut test, _) = street(SIZE);
    let target = test.target.clone();
    let first = test.camera;
    let second = spawn_camera(&mut test.app, &target, true);
    test.world().entity_mut(second).insert(stand(THERE));
    for (camera, order, x) in [(first, 0, 0), (second, 1, half[0])] {
        let mut view = test.world().get_mut::<Camera>(camera).expect("a camera");
        view.order = order;
        view.viewport = Some(Viewport {
            physical_position: UVec2::new(x, 0),
            physical_size: UVec2::from_array(half),
            ..default()
        });
        if order > 0 {
            view.clear_color = ClearColorConfig::None;
        }
    }
    settle(&mut test);
    let both = test.picture();
    for (x, at) in [(0, HERE), (half[0], THERE)] {
        let own = alone(half, at, true);
        let found = part(&both, x, 0, half[0], half[1]);
        alike("half of the screen", &found, &own);
        let dry = alone(half, at, false);
        assert!(
            difference(&own, &dry).mean > 0.5,
            "streaks show: {:?}",
            difference(&own, &dry)
        );
    }
    // Each half shows another place: the halves are not one picture twice.
    let [left, right] = [0, half[0]].map(|x| part(&both, x, 0, half[0], half[1]));
    assert!(difference(&left, &right).mean > 1.0);
}

#[test]
fn a_second_target_shows_a_dry_place_under_its_roof_forty_metres_from_the_first_view() {
    if !gpu::available() {
        return;
    }
    let own = alone(SIZE, THERE, false);
    let (mut test, _) = street(SIZE);
    // The picture's own map, not the ground's memory.
    let camera = test.camera;
    surfaces_only(&mut test, camera);
    let target = target_image(&mut test.app, SIZE);
    let second = add_camera(&mut test, &target, THERE);
    settle(&mut test);
    let found = test.picture_of(&target);
    alike("a second target", &found, &own);
    let without_memory = |enabled: bool, test: &mut TestApp| {
        test.world().insert_resource(SurfaceSettings { enabled, ..default() });
        test.frames(4, FRAME);
        test.picture_of(&target)
    };
    let found = without_memory(false, &mut test);
    // Open ground before the roof, and ground under it.
    let (open, under) = (
        brightness(&part(&found, 4, 30, 12, 6)),
        brightness(&part(&found, 66, 22, 12, 5)),
    );
    assert!(under > open + 15.0, "{under} under the roof, {open} in the open");
    // Two cameras in one place show one picture, whatever stands between them in the world's order.
    test.world().entity_mut(second).insert(stand(HERE));
    test.frames(2, FRAME);
    let first = test.picture();
    alike("two in one place", &test.picture_of(&target), &first);
}

#[test]
fn an_inactive_camera_far_away_changes_nothing() {
    if !gpu::available() {
        return;
    }
    let own = alone(SIZE, THERE, false);
    let (mut test, _) = street(SIZE);
    let first = test.camera;
    look_at(&mut test, Vec3::new(900.0, 0.0, 0.0));
    test.world().get_mut::<Camera>(first).expect("a camera").is_active = false;
    let target = target_image(&mut test.app, SIZE);
    add_camera(&mut test, &target, THERE);
    settle(&mut test);
    alike("the active one", &test.picture_of(&target), &own);
}

#[test]
fn the_first_frame_after_a_cut_is_as_good_as_the_thirtieth() {
    if !gpu::available() {
        return;
    }
    // So far apart, and of so small cells, that the cover map and the window of the ground have to follow.
    let places = [-40.0, 40.0].map(|x| Vec3::new(x, 0.0, 0.0));
    let (mut test, _) = street_of(SIZE, places, 0.05);
    let camera = test.camera;
    surfaces_only(&mut test, camera);
    // Pipelines of both places are there.
    for at in [places[0], places[1], places[0]] {
        look_at(&mut test, at);
        test.frames(3, FRAME);
    }
    let corner = |test: &mut TestApp| test.world().resource::<WaterLevels>().corner_m;
    let here = test.picture();
    let first = corner(&mut test);
    test.reset();
    look_at(&mut test, places[1]);
    let cut = test.picture();
    assert!(test.recorded(PassName::Cover) >= 1, "the map follows");
    assert!(corner(&mut test).x > first.x + 20.0, "so does the window of the ground");
    test.frames(30, std::time::Duration::ZERO);
    let settled = test.picture();
    let found = difference(&cut, &settled);
    assert!(found.mean == 0.0, "{found:?}");
    // There is a puddle there, as here.
    let levels = test.world().resource::<WaterLevels>().clone();
    assert!(levels.depth_at(40.0, 0.0) > 0.002 && levels.depth_at(37.0, 0.0) == 0.0);
    look_at(&mut test, places[0]);
    let back = test.picture();
    assert!(difference(&back, &here).mean < 0.3, "{:?}", difference(&back, &here));
    // A cut to where there is nothing, and back.
    look_at(&mut test, Vec3::new(5_000.0, 0.0, 0.0));
    let nothing = test.picture();
    assert!(difference(&nothing, &here).mean > 10.0);
    look_at(&mut test, places[0]);
    let again = test.picture();
    assert!(difference(&again, &back).mean == 0.0);
}

#[test]
fn a_resized_target_shows_what_one_of_that_size_shows() {
    if !gpu::available() {
        return;
    }
    let (mut test, _) = street(SIZE);
    let camera = test.camera;
    surfaces_only(&mut test, camera);
    test.frames(26, FRAME);
    for size in [[64, 64], [120, 40], SIZE] {
        let target = test.target.clone();
        let [width, height] = size;
        test.world()
            .resource_mut::<Assets<Image>>()
            .get_mut(&target)
            .expect("the target")
            .resize(Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            });
        test.frames(1, std::time::Duration::ZERO);
        let found = test.picture();
        let own = {
            let (mut fresh, _) = street(size);
            let camera = fresh.camera;
            surfaces_only(&mut fresh, camera);
            fresh.frames(26, FRAME);
            fresh.picture()
        };
        alike("resized", &found, &own);
    }
    // With streaks too: the containers follow.
    test.world().entity_mut(camera).insert(RainView {
        streak_budget: Some(2_000),
        ..default()
    });
    test.reset();
    test.frames(3, FRAME);
    assert_eq!(test.recorded(PassName::Rainfall), 3);
}

#[test]
fn wet_ground_is_the_same_with_samples_and_in_high_range() {
    if !gpu::available() {
        return;
    }
    let (mut test, _) = street(SIZE);
    let camera = test.camera;
    surfaces_only(&mut test, camera);
    test.frames(3, FRAME);
    let plain = test.picture();
    // Edges of roofs differ with samples; the ground does not.
    let ground = |picture: &RgbImage| part(picture, 0, 27, 60, 27);
    for (msaa, hdr) in [(Msaa::Sample4, false), (Msaa::Off, true), (Msaa::Sample4, true)] {
        let mut entity = test.world().entity_mut(camera);
        entity.insert(msaa);
        if hdr {
            entity.insert(Hdr);
        } else {
            entity.remove::<Hdr>();
        }
        test.frames(3, FRAME);
        let found = test.picture();
        let off = difference(&ground(&plain), &ground(&found));
        assert!(off.mean < 1.0, "{msaa:?}, high range {hdr}: {off:?}");
        // Streaks have pipelines for each.
        test.world().entity_mut(camera).insert(RainView {
            streak_budget: Some(2_000),
            contrast: 16.0,
            ..default()
        });
        test.reset();
        test.frames(3, FRAME);
        assert_eq!(test.recorded(PassName::Rainfall), 3);
        assert!(test.picture() != found, "streaks show");
        surfaces_only(&mut test, camera);
    }
}

#[test]
fn an_orthographic_view_shows_wet_ground_evenly() {
    if !gpu::available() {
        return;
    }
    let mut test = TestApp::new([64, 64], true);
    test.world().insert_resource(SurfaceSettings {
        enabled: false,
        ..default()
    });
    test.world().insert_resource(WaterAppearance {
        turbidity_per_m: 60.0,
        ripple_strength: 0.0,
        ..default()
    });
    let plate = place(
        test.world(),
        terrain([8, 8], 0.5, |_, _| Some(0.0)),
        Transform::default(),
    );
    // A puddle all over it: the view's angle shows in how much light enters the water.
    test.world().entity_mut(plate).insert(NoisePuddles {
        level: Some(1.0),
        size_m: 1000.0,
        height_map: false,
        ..default()
    });
    test.world().spawn((Weather::rain(20.0), WeatherMode::Artist));
    let camera = test.camera;
    surfaces_only(&mut test, camera);
    test.world().entity_mut(camera).insert((
        Projection::Orthographic(OrthographicProjection {
            scaling_mode: ScalingMode::FixedVertical { viewport_height: 3.0 },
            ..OrthographicProjection::default_3d()
        }),
        Transform::from_xyz(0.0, 0.3, 0.0).looking_to(Vec3::NEG_Y, Vec3::NEG_Z),
    ));
    test.frames(3, FRAME);
    test.leap(600);
    let picture = test.picture();
    let corners = [(2, 2), (56, 2), (2, 56), (56, 56), (29, 29)];
    let seen = corners.map(|(x, y)| brightness(&part(&picture, x, y, 6, 6)));
    let spread = seen.iter().fold(0.0_f64, |s, v| s.max((v - seen[4]).abs()));
    assert!(spread < 1.5, "{seen:?}");
    assert_eq!(broken_channels(&mut test, camera), 0);
}

/// Brightness of the ground in the lower half of the picture.
fn near(test: &mut TestApp) -> f64 {
    brightness(&part(&test.picture(), 0, SIZE[1] / 2, SIZE[0], SIZE[1] / 2))
}

#[test]
fn what_a_view_does_not_see_does_not_cover_in_its_picture() {
    if !gpu::available() {
        return;
    }
    let mut test = TestApp::new(SIZE, true);
    test.world().insert_resource(SurfaceSettings {
        enabled: false,
        ..default()
    });
    world::ground(test.world());
    let roof = world::roof(test.world());
    test.world().entity_mut(roof).insert(RenderLayers::layer(1));
    let weather = test.world().spawn(Weather::rain(0.0)).id();
    let camera = test.camera;
    surfaces_only(&mut test, camera);
    test.look(Vec3::new(0.0, 1.7, 3.0), Vec3::new(0.0, 0.0, 0.0));
    test.frames(3, FRAME);
    let dry = near(&mut test);
    rain(&mut test, weather, 50.0, 300);
    let wet = near(&mut test);
    assert!(wet < dry - 10.0, "no roof for this view: {wet}, dry {dry}");
    test.world()
        .entity_mut(camera)
        .insert(RenderLayers::from_layers(&[0, 1]));
    test.frames(4, FRAME);
    let covered = near(&mut test);
    assert!(
        (covered - dry).abs() < 2.0,
        "its roof keeps the ground dry: {covered}, dry {dry}"
    );
    test.world().entity_mut(camera).remove::<RenderLayers>();
    test.frames(4, FRAME);
    let again = near(&mut test);
    assert!((again - wet).abs() < 2.0, "{again}, wet {wet}");
}
