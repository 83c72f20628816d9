//! Meshes: unit normals, fronts outside, no degenerate triangles, nothing out of bounds.

use crate::scene::{Scene, car_scene, street_scene};
use glam::{Vec3, Vec4};

fn scenes() -> [(&'static str, &'static Scene); 2] {
    [("street", street_scene()), ("car", car_scene())]
}

#[test]
fn normals_and_tangents_are_unit_vectors_at_right_angles() {
    for (name, scene) in scenes() {
        for mesh in scene.document.meshes() {
            for p in mesh.primitives() {
                let reader = p.reader(|b| Some(&scene.buffers[b.index()]));
                let normals: Vec<Vec3> = reader.read_normals().expect("normals").map(Vec3::from).collect();
                for n in &normals {
                    assert!((n.length() - 1.0).abs() < 1e-4, "{name} {:?}: normal {n}", mesh.name());
                }
                let Some(tangents) = reader.read_tangents() else {
                    continue;
                };
                for (t, n) in tangents.map(Vec4::from).zip(&normals) {
                    assert!(
                        (t.truncate().length() - 1.0).abs() < 1e-4 && t.w.abs() == 1.0,
                        "{name} {:?}: {t}",
                        mesh.name()
                    );
                    assert!(
                        t.truncate().dot(*n).abs() < 1e-3,
                        "{name} {:?}: tangent {t} normal {n}",
                        mesh.name()
                    );
                }
            }
        }
    }
}

#[test]
fn no_triangle_is_degenerate() {
    for (name, scene) in scenes() {
        for t in &scene.triangles {
            let [a, b, c] = t.corners;
            let area = 0.5 * (b - a).cross(c - a).length();
            assert!(area > 5e-9, "{name}, material {}: {a} {b} {c}", t.material);
            assert!(t.corners.iter().all(|p| p.is_finite()));
        }
    }
}

#[test]
fn fronts_face_the_way_of_their_normals() {
    for (name, scene) in scenes() {
        let (mut all, mut wrong) = (0_u32, 0_u32);
        for t in scene.triangles.iter().filter(|t| !scene.masked[t.material]) {
            let [a, b, c] = t.corners;
            all += 1;
            wrong += u32::from((b - a).cross(c - a).dot(t.normals.iter().sum()) <= 0.0);
        }
        // Smooth normals turn past a sliver's own at the sharpest bends of the car's shell, nowhere else.
        assert!(f64::from(wrong) <= 0.001 * f64::from(all), "{name}: {wrong} of {all}");
    }
}

#[test]
fn everything_lies_within_the_layouts_bounds() {
    let layout = street::layout();
    let (low, high) = (Vec3::from(layout.min), Vec3::from(layout.max));
    for t in &street_scene().triangles {
        for p in t.corners {
            assert!(p.cmpge(low - 0.01).all() && p.cmple(high + 0.01).all(), "{p}");
        }
    }
}

#[test]
fn ground_is_seen_from_above() {
    // Looking straight down on open ground, one must meet a front, or the road would be invisible.
    let scene = street_scene();
    for (x, z) in [
        (0.5, 0.3),
        (-2.0, 20.2),
        (3.37, 5.1),
        (5.0, -12.0),
        (9.0, 15.0),
        (0.3, 39.0),
        (12.0, -38.2),
        (-8.0, 44.7),
    ] {
        let near = scene.near(x, z, 0.1);
        let from = Vec3::new(x, 1.0, z);
        let (_, t) = crate::scene::first_hit(near.into_iter(), from, Vec3::NEG_Y, 3.0).expect("ground");
        let [a, b, c] = t.corners;
        assert!((b - a).cross(c - a).y > 0.0, "the ground at {x}, {z} faces down");
    }
}
