//! The car: its wheels, its size, its closed underside.

use crate::scene::car_scene;
use glam::Vec3;
use street::car::{HALF_TRACK, WHEEL_RADIUS, WHEELS};

#[test]
fn wheels_turn_about_their_own_axles() {
    let scene = car_scene();
    for (name, x, z) in WHEELS {
        let node = scene.node(name);
        let pivot = node.world.transform_point3(Vec3::ZERO);
        assert!(
            pivot.distance(Vec3::new(x, WHEEL_RADIUS, z)) < 1e-6,
            "{name} at {pivot}"
        );
        let left = name.ends_with("left");
        assert_eq!(left, pivot.x > 0.0, "facing +Z with Y up, left is +X");
        let gltf = scene.document.nodes().find(|n| n.name() == Some(name)).expect("node");
        let mesh = gltf.mesh().expect("a mesh of its own");
        let mut far = 0.0_f32;
        for p in mesh.primitives() {
            let reader = p.reader(|b| Some(&scene.buffers[b.index()]));
            for q in reader.read_positions().expect("positions") {
                far = far.max((q[1] * q[1] + q[2] * q[2]).sqrt());
            }
        }
        assert!(
            (far - WHEEL_RADIUS).abs() < 1e-4,
            "{name} reaches {far} m from its axle: it would not touch the ground"
        );
    }
    assert!(
        (2.0 * HALF_TRACK - (street::layout::RUT_X[1] - street::layout::RUT_X[0])).abs() < 1e-6,
        "wheels run in the ruts"
    );
}

#[test]
fn it_has_the_size_of_a_hatchback_and_stands_on_the_ground() {
    let points = || car_scene().triangles.iter().flat_map(|t| t.corners);
    let low = points().fold(Vec3::MAX, Vec3::min);
    let high = points().fold(Vec3::MIN, Vec3::max);
    let size = high - low;
    assert!(
        (3.8..4.3).contains(&size.z) && (1.65..2.1).contains(&size.x) && (1.4..1.7).contains(&size.y),
        "{size}"
    );
    assert!(low.y.abs() < 1e-3, "lowest point at {}", low.y);
    assert!(
        (low.z + high.z).abs() < 0.15 && (low.x + high.x).abs() < 1e-3,
        "the origin is under its middle"
    );
}

#[test]
fn its_underside_shelters_the_ground() {
    let scene = car_scene();
    for i in 0..9 {
        for j in 0..17 {
            let (x, z) = (-0.7 + 1.4 * (i as f32 / 8.0), -1.7 + 3.4 * (j as f32 / 16.0));
            let (d, _) = scene.hit(Vec3::new(x, 0.001, z), Vec3::Y, 3.0).expect("an underside");
            assert!(d < 0.72, "open to {d} m above {x}, {z}");
        }
    }
    assert!(scene.hit(Vec3::new(1.3, 0.0, 0.0), Vec3::Y, 3.0).is_none());
}

#[test]
fn lamps_glow() {
    let glowing: Vec<&str> = car_scene()
        .document
        .materials()
        .filter(|m| m.emissive_factor().iter().any(|e| *e > 0.0))
        .filter_map(|m| m.name())
        .collect();
    assert_eq!(glowing, ["car-headlamp", "car-taillamp"]);
    // White lamps at the front, red ones at the rear.
    let scene = car_scene();
    for (name, front) in [("car-headlamp", true), ("car-taillamp", false)] {
        let material = scene.material_named(name);
        let mut count = 0;
        for t in scene.triangles.iter().filter(|t| t.material == material) {
            count += 1;
            assert!(
                t.corners.iter().all(|p| (p.z > 1.4) == front && p.z.abs() > 1.4),
                "{name} at {}",
                t.corners[0]
            );
        }
        assert!(count > 8, "{name}: {count} triangles");
    }
}
