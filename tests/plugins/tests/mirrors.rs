//! Level water mirrors the scene in each view that asks for it.

use std::time::Duration;

use bevy::camera::Viewport;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::prelude::*;
use image::RgbImage;
use rain_plugins::prelude::*;
use test_support::app::{FRAME, TestApp, spawn_camera, target_image};
use test_support::gpu;

use crate::scenes::{difference, place, surfaces_only, terrain};

const SIZE: [u32; 2] = [96, 54];

/// Two plates under water, at different heights, each with a bright column behind it.
const PLATES: [Vec3; 2] = [Vec3::ZERO, Vec3::new(12.0, -1.5, 0.0)];

fn ponds() -> TestApp {
    let mut test = TestApp::new(SIZE, true);
    test.world().insert_resource(SurfaceSettings {
        enabled: false,
        ..default()
    });
    test.world().insert_resource(WaterAppearance {
        ripple_strength: 0.0,
        wave_strength: 0.0,
        ..default()
    });
    for (at, colour) in PLATES.into_iter().zip([[0.9, 0.1, 0.05], [0.05, 0.2, 0.9]]) {
        let plate = place(
            test.world(),
            terrain([8, 8], 0.5, |_, _| Some(0.0)),
            Transform::from_translation(at),
        );
        test.world().entity_mut(plate).insert(NoisePuddles {
            level: Some(1.0),
            size_m: 1000.0,
            height_map: false,
            ..default()
        });
        let material = test
            .world()
            .resource_mut::<Assets<StandardMaterial>>()
            .add(StandardMaterial {
                base_color: Color::BLACK,
                emissive: LinearRgba::rgb(colour[0], colour[1], colour[2]) * 3_000.0,
                ..default()
            });
        let mesh = test
            .world()
            .resource_mut::<Assets<Mesh>>()
            .add(Cuboid::new(0.6, 2.0, 0.6));
        let column = at + Vec3::new(0.0, 1.0, -2.5);
        test.world().spawn((
            Mesh3d(mesh),
            MeshMaterial3d(material),
            Transform::from_translation(column),
            KeepDry,
        ));
    }
    test.world().spawn((Weather::rain(20.0), WeatherMode::Artist));
    let camera = test.camera;
    surfaces_only(&mut test, camera);
    test.world().entity_mut(camera).insert(stand(0));
    test.frames(3, FRAME);
    test.leap(600);
    test
}

fn stand(plate: usize) -> Transform {
    let at = PLATES[plate];
    Transform::from_translation(at + Vec3::new(0.0, 0.8, 2.5)).looking_at(at, Vec3::Y)
}

/// Adds a view of a plate, with a mirror at the plate's own height.
fn add_view(test: &mut TestApp, plate: usize) -> (Entity, Handle<Image>) {
    let target = target_image(&mut test.app, SIZE);
    let camera = spawn_camera(&mut test.app, &target, true);
    surfaces_only(test, camera);
    let reflection = PlanarReflection {
        height_m: Some(PLATES[plate].y),
    };
    test.world().entity_mut(camera).insert((stand(plate), reflection));
    (camera, target)
}

/// A plate's picture from one camera alone, mirrored or not.
fn alone(plate: usize, mirrored: bool) -> RgbImage {
    let mut test = ponds();
    let camera = test.camera;
    test.world().entity_mut(camera).insert(stand(plate));
    if mirrored {
        test.world().entity_mut(camera).insert(PlanarReflection {
            height_m: Some(PLATES[plate].y),
        });
    }
    test.frames(4, FRAME);
    test.picture()
}

#[test]
fn each_view_has_a_mirror_of_its_own_at_its_own_height() {
    if !gpu::available() {
        return;
    }
    let mut test = ponds();
    let first = test.camera;
    test.world().entity_mut(first).remove::<RainView>();
    let views = [add_view(&mut test, 0), add_view(&mut test, 1)];
    test.frames(2, FRAME);
    test.reset();
    test.frames(4, FRAME);
    assert_eq!(test.recorded(PassName::Reflection), 8, "two views, four frames");
    for (plate, (_, target)) in views.iter().enumerate() {
        let found = test.picture_of(target);
        let (own, plain) = (alone(plate, true), alone(plate, false));
        let mirrored = difference(&own, &plain);
        assert!(
            mirrored.share > 0.03,
            "plate {plate}: the column is mirrored: {mirrored:?}"
        );
        let off = difference(&found, &own);
        assert!(
            off.mean < 0.1 * mirrored.mean,
            "plate {plate}: {off:?}, mirrored {mirrored:?}"
        );
    }
    // One of them ends: the other has the first mirror now, without a frame of the wrong one.
    let (gone, (_, target)) = (views[0].0, &views[1]);
    let before = test.picture_of(target);
    test.world().despawn(gone);
    let after = test.picture_of(target);
    let off = difference(&before, &after);
    assert!(off.share == 0.0, "{off:?}");
}

#[test]
fn a_mirror_has_the_shape_of_its_picture_at_once() {
    if !gpu::available() {
        return;
    }
    let mut test = ponds();
    let camera = test.camera;
    let plain = test.picture();
    test.world().entity_mut(camera).insert(PlanarReflection {
        height_m: Some(PLATES[0].y),
    });
    test.frames(3, Duration::ZERO);
    let before = test.picture();
    assert!(difference(&before, &plain).share > 0.03, "the column is mirrored");
    let draw_in = |test: &mut TestApp, viewport: Option<Viewport>| {
        test.world().get_mut::<Camera>(camera).expect("a camera").viewport = viewport;
    };
    draw_in(
        &mut test,
        Some(Viewport {
            physical_size: UVec2::splat(SIZE[1]),
            ..default()
        }),
    );
    test.frames(3, Duration::ZERO);
    assert!(difference(&test.picture(), &before).share > 0.03, "a square picture");
    draw_in(&mut test, None);
    assert!(test.picture() == before, "the first frame of the old shape");
}

/// A bright column beside the first plate.
fn column(test: &mut TestApp, z: f32, colour: [f32; 3]) {
    let world = test.world();
    let material = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial {
        base_color: Color::BLACK,
        emissive: LinearRgba::rgb(colour[0], colour[1], colour[2]) * 3_000.0,
        ..default()
    });
    let mesh = world.resource_mut::<Assets<Mesh>>().add(Cuboid::new(0.6, 2.0, 0.6));
    let at = Transform::from_xyz(0.0, 1.0, z);
    world.spawn((Mesh3d(mesh), MeshMaterial3d(material), at, KeepDry));
}

#[test]
fn puddles_that_need_no_weather_mirror_and_views_back_to_back_have_a_mirror_each() {
    if !gpu::available() {
        return;
    }
    let mut test = ponds();
    column(&mut test, 2.5, [0.1, 0.9, 0.1]);
    let weather = test
        .world()
        .query_filtered::<Entity, With<Weather>>()
        .single(test.world())
        .expect("one weather");
    test.world().despawn(weather);
    let camera = test.camera;
    let from = |z: f32| Transform::from_xyz(0.0, 0.8, 0.0).looking_at(Vec3::new(0.0, 0.0, z), Vec3::Y);
    test.world().entity_mut(camera).insert(from(1.4));
    test.frames(4, FRAME);
    let plain = test.picture();
    let mirror = PlanarReflection { height_m: Some(0.0) };
    test.world().entity_mut(camera).insert(mirror);
    test.frames(4, FRAME);
    test.reset();
    test.frames(4, FRAME);
    assert_eq!(test.recorded(PassName::Reflection), 4, "no weather, and a puddle");
    let own = test.picture();
    let mirrored = difference(&own, &plain);
    assert!(mirrored.share > 0.03, "{mirrored:?}");
    // A view the other way, before it in order.
    let target = target_image(&mut test.app, SIZE);
    let other = spawn_camera(&mut test.app, &target, true);
    surfaces_only(&mut test, other);
    test.world().entity_mut(other).insert((from(-1.4), mirror));
    test.world().get_mut::<Camera>(other).expect("a camera").order = -1;
    test.frames(4, FRAME);
    let off = difference(&test.picture(), &own);
    assert!(off.mean < 0.1 * mirrored.mean, "{off:?}, mirrored {mirrored:?}");
    // Where the puddle does not fill, there is nothing to mirror.
    let mut noises = test.world().query::<&mut NoisePuddles>();
    for mut noise in noises.iter_mut(test.world()) {
        noise.level = Some(0.0);
    }
    test.frames(2, FRAME);
    test.reset();
    test.frames(2, FRAME);
    assert_eq!(
        (
            test.recorded(PassName::Reflection),
            test.skipped(PassName::Reflection, SkipReason::Dry)
        ),
        (0, 4)
    );
}

#[test]
fn at_most_four_mirrors_are_drawn_and_none_where_nobody_asks() {
    if !gpu::available() {
        return;
    }
    let mut test = ponds();
    let memory = |test: &TestApp| test.app.world().resource::<RainReport>().snapshot().gpu_memory_bytes;
    test.frames(2, FRAME);
    assert_eq!(test.recorded(PassName::Reflection), 0);
    let without = memory(&test);
    let views: Vec<Entity> = (0..6).map(|i| add_view(&mut test, i % 2).0).collect();
    test.frames(2, FRAME);
    test.reset();
    test.frames(3, FRAME);
    assert_eq!(test.recorded(PassName::Reflection), 12, "four of six");
    // 640 × 360 half-float texels and their blurred copies, four times.
    let more = memory(&test) - without;
    assert!((7_000_000..11_000_000).contains(&more), "{more} bytes");
    for view in views {
        test.world().despawn(view);
    }
    test.frames(1, FRAME);
    test.reset();
    test.frames(3, FRAME);
    assert_eq!(test.recorded(PassName::Reflection), 0);
}

#[test]
fn a_mirror_shows_the_haze_before_what_it_mirrors() {
    if !gpu::available() {
        return;
    }
    // A column far behind the plate, mirrored at its front edge, in a fog that hides half of it.
    let picture = |mirrored: bool, fog: Option<ArtistFog>| {
        let mut test = ponds();
        let camera = test.camera;
        let world = test.world();
        // What is mirrored is then a share of linear light.
        world.entity_mut(camera).insert(Tonemapping::None);
        for (_, material) in world.resource_mut::<Assets<StandardMaterial>>().iter_mut() {
            if material.emissive != LinearRgba::BLACK {
                material.emissive = LinearRgba::rgb(0.5, 0.0, 0.0);
            }
        }
        world.entity_mut(camera).insert(HazeSettings {
            enabled: fog.is_some(),
            artist: fog,
            ..default()
        });
        if mirrored {
            test.world()
                .entity_mut(camera)
                .insert(PlanarReflection { height_m: Some(0.0) });
        }
        test.frames(4, FRAME);
        test.picture()
    };
    let red = |picture: &RgbImage| {
        // Where the column's image lies: the lower half, about the middle.
        let mut sum = 0.0;
        for x in SIZE[0] * 2 / 5..SIZE[0] * 3 / 5 {
            for y in SIZE[1] / 2..SIZE[1] * 4 / 5 {
                let [r, _, b] = picture.get_pixel(x, y).0;
                let linear = |v: u8| f64::from(Srgba::gamma_function(f32::from(v) / 255.0));
                sum += linear(r) - linear(b);
            }
        }
        sum
    };
    let fog = |density_per_m| {
        Some(ArtistFog {
            density_per_m,
            gain: 0.0,
            colour: Some(LinearRgba::BLACK),
            ..default()
        })
    };
    let clear = red(&picture(true, None)) - red(&picture(false, None));
    let hazy = red(&picture(true, fog(0.3))) - red(&picture(false, fog(0.3)));
    // The eye is 2.6 m before the water, the column 2.2 m behind: e^(−0.3·4.8) = 0.24 of it is left; 0.46 with the fog on the
    // first way alone.
    assert!(clear > 2.0, "the column is mirrored: {clear}");
    assert!(hazy < 0.35 * clear && hazy > 0.12 * clear, "{hazy} of {clear}");
}
