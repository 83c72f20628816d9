//! Meshes that no artist meant: it rains on, what cannot be used is named, and no pixel is broken.

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use rain_plugins::prelude::*;
use rain_plugins::surface::LeftOut;
use test_support::app::{FRAME, TestApp};
use test_support::gpu;

use crate::scenes::{brightness, broken_channels, depth, hollow, hollow_at, part, place, rain, surfaces_only, terrain};

/// A triangle list of these corners, with the attributes a test adds.
fn list(positions: Vec<[f32; 3]>) -> Mesh {
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
}

/// A level square, 1 m wide.
fn square() -> Vec<[f32; 3]> {
    let [a, b, c, d] = [[-0.5, 0.0, -0.5], [-0.5, 0.0, 0.5], [0.5, 0.0, 0.5], [0.5, 0.0, -0.5]];
    vec![a, b, c, a, c, d]
}

/// Everything said about the scene since [`listen`].
#[derive(Resource, Default)]
struct Said(Vec<SceneGap>);

/// Keeps what is said from now on.
fn listen(test: &mut TestApp) {
    test.app.init_resource::<Said>();
    test.app
        .add_systems(Last, |mut said: ResMut<Said>, mut gaps: MessageReader<SceneGap>| {
            said.0.extend(gaps.read().cloned());
        });
}

fn gaps(test: &mut TestApp) -> Vec<SceneGap> {
    test.world().resource::<Said>().0.clone()
}

/// A mesh, what is said of it, and its name.
fn bad_meshes() -> Vec<(&'static str, Mesh, Option<Gap>)> {
    let nan = f32::NAN;
    let mut broken = square();
    broken[1][1] = nan;
    broken[4][0] = f32::INFINITY;
    let left_out = |not_finite, no_area, no_vertex| {
        Some(Gap::LeftOut(LeftOut {
            not_finite,
            no_area,
            no_vertex,
        }))
    };
    let normals = |normal: [f32; 3], mesh: Mesh| {
        let count = mesh.count_vertices();
        mesh.with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![normal; count])
    };
    let up = |mesh: Mesh| normals([0.0, 1.0, 0.0], mesh);
    let uvs = |uv: [f32; 2], mesh: Mesh| {
        let count = mesh.count_vertices();
        mesh.with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, vec![uv; count])
    };
    let strip = Mesh::new(PrimitiveTopology::TriangleStrip, RenderAssetUsages::default()).with_inserted_attribute(
        Mesh::ATTRIBUTE_POSITION,
        vec![[-0.5, 0.0, -0.5], [-0.5, 0.0, 0.5], [0.5, 0.0, -0.5], [0.5, 0.0, 0.5]],
    );
    let lines = Mesh::new(PrimitiveTopology::LineList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, vec![[0.0; 3], [1.0, 1.0, 0.0]]);
    vec![
        ("corners that are not finite", up(list(broken)), left_out(2, 0, 0)),
        (
            "no area",
            up(list(vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]])),
            left_out(0, 1, 0),
        ),
        ("no normals and no texture coordinates", list(square()), None),
        ("normals that are no numbers", normals([nan; 3], list(square())), None),
        ("normals of no length", normals([0.0; 3], list(square())), None),
        (
            "texture coordinates that are no numbers",
            uvs([nan; 2], up(list(square()))),
            None,
        ),
        ("no triangles", up(list(Vec::new())), None),
        (
            "indices beyond the vertices",
            up(list(square())).with_inserted_indices(Indices::U32(vec![0, 1, 2, 3, 4, 900])),
            left_out(0, 0, 1),
        ),
        ("a strip", up(strip), None),
        ("lines", up(lines), Some(Gap::NotTriangles)),
    ]
}

#[test]
fn bad_meshes_are_named_and_break_no_pixel_and_the_rest_gets_wet() {
    if !gpu::available() {
        return;
    }
    let (mut test, weather) = hollow_at(Vec3::ZERO);
    listen(&mut test);
    let mut wanted = Vec::new();
    for (i, (name, mesh, gap)) in (0_u8..).zip(bad_meshes()) {
        let at = Vec3::new(f32::from(i % 5) * 1.1 - 2.2, 0.4, f32::from(i / 5) * 1.1 - 2.0);
        let entity = place(test.world(), mesh, Transform::from_translation(at));
        test.world().entity_mut(entity).insert(Name::new(name));
        wanted.extend(gap.map(|gap| SceneGap {
            entity: Some(entity),
            gap,
        }));
    }
    // Squeezed to nothing, and nowhere.
    place(test.world(), list(square()), Transform::from_scale(Vec3::ZERO));
    place(test.world(), list(square()), Transform::from_xyz(f32::NAN, 0.0, 0.0));
    test.frames(2, FRAME);
    let said = gaps(&mut test);
    for gap in &wanted {
        assert_eq!(said.iter().filter(|g| *g == gap).count(), 1, "{gap:?} in {said:?}");
    }
    // The two without place or size.
    assert_eq!(said.len(), wanted.len() + 2, "{said:?}");

    let camera = test.camera;
    test.world().entity_mut(camera).insert(RainView {
        streak_budget: Some(2_000),
        ..default()
    });
    assert_eq!(broken_channels(&mut test, camera), 0, "dry");
    rain(&mut test, weather, 60.0, 1200);
    assert_eq!(broken_channels(&mut test, camera), 0, "wet");
    assert!(test.recorded(PassName::Cover) > 0 && test.recorded(PassName::Rainfall) > 0);
    let surface = test.world().resource::<SurfaceGround>();
    assert!(surface.ground().is_some() && surface.error().is_none());
    assert!(surface.ledger().residual_relative < 1e-9);
    assert!(depth(&mut test, 0.0, 0.0) > 0.01, "the hollow under them fills");
}

/// Brightness of three wet plates in a row with these normals.
fn wet_plates(normals: [Option<[f32; 3]>; 3]) -> [f64; 3] {
    let mut test = TestApp::new([96, 48], true);
    test.world().insert_resource(SurfaceSettings {
        enabled: false,
        ..default()
    });
    for (x, normal) in [-1.2, 0.0, 1.2].into_iter().zip(normals) {
        let mesh = list(square());
        let mesh = match normal {
            Some(normal) => mesh.with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![normal; 6]),
            None => mesh,
        };
        place(test.world(), mesh, Transform::from_xyz(x, 0.0, 0.0));
    }
    let camera = test.camera;
    surfaces_only(&mut test, camera);
    test.look(Vec3::new(0.0, 2.5, 0.01), Vec3::ZERO);
    let weather = test.world().spawn(Weather::rain(0.0)).id();
    test.frames(3, FRAME);
    rain(&mut test, weather, 50.0, 300);
    let picture = test.picture();
    // 45° high from 2.5 m: 23.2 px a metre.
    [20, 48, 76].map(|x| brightness(&part(&picture, x - 4, 20, 8, 8)))
}

#[test]
fn a_mesh_without_usable_normals_gets_wet_like_one_with_them() {
    if !gpu::available() {
        return;
    }
    // The sun's glint differs from place to place: each is compared with a proper one where it lies.
    let up = Some([0.0, 1.0, 0.0]);
    let proper = wet_plates([up; 3]);
    let found = wet_plates([up, None, Some([f32::NAN; 3])]);
    assert!(proper[0] > 20.0, "{proper:?}");
    for (found, proper) in found.into_iter().zip(proper) {
        assert!(
            (found - proper).abs() < 1.0,
            "{found} where a proper one shows {proper}"
        );
    }
}

#[test]
fn ground_with_holes_and_open_meshes_holds_water_where_it_is_ground() {
    if !gpu::available() {
        return;
    }
    let mut test = TestApp::new([96, 64], true);
    listen(&mut test);
    // A second hollow has a hole at its bottom; a sheet without thickness stands beside.
    let holes = |x: f32, z: f32| {
        let drained = (x - 5.0).hypot(z) < 0.3;
        (!drained).then(|| hollow(x, z) + hollow(x - 5.0, z) - 0.01 * (x - 5.0))
    };
    let ground = terrain([64, 48], 0.25, holes);
    place(test.world(), ground, Transform::default());
    let sheet = vec![[-3.0, 0.0, -2.0], [-3.0, 1.0, -2.0], [-1.0, 0.0, -2.0]];
    place(test.world(), list(sheet), Transform::default());
    let weather = test.world().spawn(Weather::rain(0.0)).id();
    test.look(Vec3::new(2.5, 3.0, 6.0), Vec3::new(2.5, 0.0, 0.0));
    test.frames(3, FRAME);
    test.leap(2);
    assert!(gaps(&mut test).is_empty(), "nothing is wrong with them");
    rain(&mut test, weather, 60.0, 1200);
    assert!(depth(&mut test, 0.0, 0.0) > 0.01, "the closed hollow fills");
    assert_eq!(depth(&mut test, 4.0, 0.0), 0.0, "the other runs out through its hole");
    let ledger = test.world().resource::<SurfaceGround>().ledger();
    assert!(ledger.residual_relative < 1e-9, "{ledger:?}");
    let camera = test.camera;
    assert_eq!(broken_channels(&mut test, camera), 0);
}

#[test]
fn a_scene_without_area_has_no_ground_says_so_and_rains_on() {
    if !gpu::available() {
        return;
    }
    for mesh in [
        None,
        Some(list(vec![[0.0; 3]; 9])),
        Some(list(vec![[0.0; 3], [0.0, 3.0, 0.0], [1.0, 0.0, 0.0]])),
    ] {
        let mut test = TestApp::new([64, 32], true);
        listen(&mut test);
        let any = mesh.is_some();
        if let Some(mesh) = mesh {
            place(test.world(), mesh, Transform::default());
        }
        test.world().spawn(Weather::rain(50.0));
        test.frames(3, FRAME);
        test.frames(1, std::time::Duration::from_secs(2));
        let said = gaps(&mut test);
        let no_ground = said.iter().filter(|g| matches!(g.gap, Gap::NoGround(_))).count();
        assert_eq!(no_ground, usize::from(any), "{said:?}");
        test.frames(3, FRAME);
        assert_eq!(gaps(&mut test).len(), said.len(), "said once");
        assert!(test.world().resource::<SurfaceGround>().ground().is_none());
        assert!(test.recorded(PassName::Rainfall) > 0);
        let camera = test.camera;
        assert_eq!(broken_channels(&mut test, camera), 0);
    }
}
