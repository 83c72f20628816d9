//! Puddles of the scene's own ground: they fill where a hollow is, the picture shows them, and their passes come and go.

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use rain_plugins::prelude::*;
use rain_plugins::surface::WaterLevels;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

/// Cells along a side of the ground, and their size. Units: m.
const CELLS: u32 = 48;
const CELL_M: f32 = 0.25;

/// A slope of 1 % with a hollow of 6 cm in its middle.
fn height(x: f32, z: f32) -> f32 {
    let share = (1.0 - (x * x + z * z) / 4.0).max(0.0);
    0.01 * x - 0.06 * share * share
}

fn hollow_ground() -> Mesh {
    let at = |i: u32| (i as f32 - 0.5 * CELLS as f32) * CELL_M;
    let mut positions = Vec::new();
    let mut normals = Vec::new();
    for j in 0..=CELLS {
        for i in 0..=CELLS {
            let (x, z) = (at(i), at(j));
            positions.push([x, height(x, z), z]);
            let slope = |dx: f32, dz: f32| (height(x + dx, z + dz) - height(x - dx, z - dz)) / 0.02;
            normals.push(
                Vec3::new(-slope(0.01, 0.0), 1.0, -slope(0.0, 0.01))
                    .normalize()
                    .to_array(),
            );
        }
    }
    let corner = |i: u32, j: u32| j * (CELLS + 1) + i;
    let indices = (0..CELLS)
        .flat_map(|j| (0..CELLS).map(move |i| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [corner(i, j), corner(i, j + 1), corner(i + 1, j + 1), corner(i + 1, j)];
            [a, b, c, a, c, d]
        })
        .collect();
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
        .with_inserted_indices(Indices::U32(indices))
}

/// The ground with a hollow under a dry sky, and its weather.
pub(crate) fn hollow() -> (TestApp, Entity) {
    let mut test = TestApp::new([160, 90], true);
    let mesh = test.world().resource_mut::<Assets<Mesh>>().add(hollow_ground());
    let material = test
        .world()
        .resource_mut::<Assets<StandardMaterial>>()
        .add(StandardMaterial {
            base_color: Color::srgb(0.5, 0.5, 0.5),
            perceptual_roughness: 0.9,
            ..default()
        });
    test.world()
        .spawn((Mesh3d(mesh), MeshMaterial3d(material), Transform::default()));
    let weather = test.world().spawn(Weather::rain(0.0)).id();
    let camera = test.camera;
    test.world().entity_mut(camera).insert((
        RainView {
            streak_budget: Some(0),
            ..default()
        },
        PlanarReflection::default(),
    ));
    test.look(Vec3::new(0.0, 2.0, 4.0), Vec3::ZERO);
    (test, weather)
}

#[test]
fn a_hollow_fills_shows_water_and_dries_and_its_passes_come_and_go() {
    if !gpu::available() {
        return;
    }
    let (mut test, weather) = hollow();
    test.frames(3, FRAME);
    test.leap(2);
    test.frames(3, FRAME);
    assert!(
        test.world().resource::<SurfaceGround>().ground().is_some(),
        "the ground is built from the mesh"
    );
    let passes = [PassName::Ripples, PassName::Waves, PassName::Reflection];
    for pass in passes {
        assert_eq!(test.recorded(pass), 0, "{pass:?} on dry ground");
    }

    test.world().entity_mut(weather).insert(Weather::rain(60.0));
    test.leap(1200);
    test.frames(4, FRAME);
    let levels = test.world().resource::<WaterLevels>().clone();
    let level = levels.surface_at(0.0, 0.0).expect("a puddle in the hollow");
    assert!((-0.055..0.02).contains(&level), "{level}");
    assert!(
        levels.surface_at(5.0, 0.0).is_none() && levels.surface_at(-5.0, 3.0).is_none(),
        "none on the slope"
    );
    assert!(levels.depth_at(0.0, 0.0) > 0.01 && levels.depth_at(5.0, 0.0) == 0.0);
    assert!(test.recorded(PassName::Ripples) > 0 && test.recorded(PassName::Reflection) > 0);
    let ledger = test.world().resource::<SurfaceGround>().ledger();
    assert!(
        ledger.basins_m3 > 0.01 && ledger.residual_relative < 1e-12,
        "{ledger:?}"
    );

    // Something that moves through the puddle makes waves; where it stands still it makes none.
    let foot = test
        .world()
        .spawn((
            WaterDisturber {
                radius_m: 0.05,
                ..default()
            },
            Transform::from_xyz(0.0, level, 0.0),
        ))
        .id();
    test.frames(3, FRAME);
    assert_eq!(test.recorded(PassName::Waves), 0, "it stands still");
    for step in 1..4_u8 {
        test.world()
            .entity_mut(foot)
            .insert(Transform::from_xyz(0.1 * f32::from(step), level, 0.0));
        test.frames(1, FRAME);
    }
    assert!(test.recorded(PassName::Waves) > 0, "it moves");

    test.world().entity_mut(weather).insert(Weather {
        net_radiation_w_m2: 900.0,
        relative_humidity: 0.2,
        ..Weather::rain(0.0)
    });
    // The road dries in an hour or two, the puddle does not, and is still seen.
    test.leap(10_800);
    test.frames(4, FRAME);
    let state = test.world().get::<WeatherState>(weather).expect("the weather").clone();
    assert_eq!(
        (
            state.wetness(SurfaceClass::Asphalt),
            state.water_level_mm(SurfaceClass::Asphalt)
        ),
        (0.0, 0.0)
    );
    assert!(test.world().resource::<WaterLevels>().depth_at(0.0, 0.0) > 0.01);
    test.reset();
    test.frames(2, FRAME);
    assert!(
        test.recorded(PassName::Reflection) > 0,
        "the puddle outlasts the wet road"
    );

    test.leap(1_000_000);
    test.frames(4, FRAME);
    assert!(!test.world().resource::<WaterLevels>().any_water(), "all has dried");
    test.reset();
    test.frames(3, FRAME);
    for pass in passes {
        assert_eq!(test.recorded(pass), 0, "{pass:?} after all has dried");
    }
}

#[test]
fn the_ground_stays_wet_under_what_has_just_come() {
    if !gpu::available() {
        return;
    }
    // Mean change of the picture's lower middle when a roof comes over the slope, out of sight.
    let change = |remembers: bool| {
        let (mut test, weather) = hollow();
        test.world().insert_resource(SurfaceSettings {
            enabled: remembers,
            ..default()
        });
        test.frames(3, FRAME);
        test.leap(2);
        test.world().entity_mut(weather).insert(Weather::rain(60.0));
        test.leap(1200);
        test.frames(4, FRAME);
        let before = test.picture();
        let roof = world::block(
            test.world(),
            "roof",
            Vec3::new(-4.0, 4.0, -4.0),
            Vec3::new(4.0, 4.1, 3.0),
            world::STONE,
        );
        test.world().entity_mut(roof).insert(MovesInRain);
        test.frames(4, FRAME);
        let after = test.picture();
        let region = (50..80).flat_map(|y| (20..140).map(move |x| (x, y)));
        let differences = region.map(|(x, y)| {
            let (a, b) = (before.get_pixel(x, y).0, after.get_pixel(x, y).0);
            a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(b))).sum::<f64>() / 3.0
        });
        differences.sum::<f64>() / (30.0 * 120.0)
    };
    let (with, without) = (change(true), change(false));
    assert!(without > 4.0, "without a memory the ground dries at once: {without}");
    assert!(with < 0.25 * without, "{with}, without a memory {without}");
}
