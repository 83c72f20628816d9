//! A glTF read back: triangles in world space, rays against them, nodes and lights.

use glam::{Mat4, Quat, Vec3};
use serde_json::Value;
use std::path::PathBuf;
use std::sync::OnceLock;

/// A triangle in world space.
pub struct Triangle {
    pub corners: [Vec3; 3],
    pub normals: [Vec3; 3],
    pub material: usize,
}

/// A node with its world transform.
pub struct Node {
    pub name: String,
    pub world: Mat4,
    pub light: Option<usize>,
}

/// A whole file.
pub struct Scene {
    pub document: gltf::Document,
    pub buffers: Vec<gltf::buffer::Data>,
    pub images: Vec<gltf::image::Data>,
    pub json: Value,
    pub bytes: Vec<u8>,
    pub triangles: Vec<Triangle>,
    pub nodes: Vec<Node>,
    /// Per material: alpha-masked.
    pub masked: Vec<bool>,
}

/// A folder of this test run.
pub fn folder(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("street-{}-{name}", std::process::id()))
}

/// The street and the car, generated once.
pub fn both() -> &'static (Scene, Scene) {
    static SCENES: OnceLock<(Scene, Scene)> = OnceLock::new();
    SCENES.get_or_init(|| {
        let dir = folder("shared");
        let returned = street::generate(&dir, street::DEFAULT_SEED).expect("the target folder is writable");
        assert_eq!(returned, street::layout());
        let scenes = (
            Scene::read(&dir.join(street::STREET_FILE)),
            Scene::read(&dir.join(street::CAR_FILE)),
        );
        std::fs::remove_dir_all(dir).expect("own folder");
        scenes
    })
}

pub fn street_scene() -> &'static Scene {
    &both().0
}

pub fn car_scene() -> &'static Scene {
    &both().1
}

impl Scene {
    fn read(path: &std::path::Path) -> Self {
        let bytes = std::fs::read(path).expect("generated file");
        // `import` validates the document and decodes every picture.
        let (document, buffers, images) = gltf::import(path).expect("valid glTF");
        let length = u32::from_le_bytes(bytes[12..16].try_into().expect("four bytes")) as usize;
        let json: Value = serde_json::from_slice(&bytes[20..20 + length]).expect("JSON chunk");
        let masked = document
            .materials()
            .map(|m| m.alpha_mode() == gltf::material::AlphaMode::Mask)
            .collect();
        let mut scene = Self {
            document,
            buffers,
            images,
            json,
            bytes,
            triangles: Vec::new(),
            nodes: Vec::new(),
            masked,
        };
        let roots: Vec<usize> = scene
            .document
            .default_scene()
            .expect("a scene")
            .nodes()
            .map(|n| n.index())
            .collect();
        for root in roots {
            scene.visit(root, Mat4::IDENTITY);
        }
        scene
    }

    fn visit(&mut self, index: usize, parent: Mat4) {
        let node = self.document.nodes().nth(index).expect("node");
        let (t, r, s) = node.transform().decomposed();
        let world = parent * Mat4::from_scale_rotation_translation(s.into(), Quat::from_array(r), t.into());
        let light = self.json["nodes"][index]["extensions"]["KHR_lights_punctual"]["light"]
            .as_u64()
            .map(|l| l as usize);
        self.nodes.push(Node {
            name: node.name().expect("every node is named").to_owned(),
            world,
            light,
        });
        if let Some(mesh) = node.mesh() {
            for p in mesh.primitives() {
                let reader = p.reader(|b| Some(&self.buffers[b.index()]));
                let positions: Vec<Vec3> = reader
                    .read_positions()
                    .expect("positions")
                    .map(|p| world.transform_point3(p.into()))
                    .collect();
                let normals: Vec<Vec3> = reader
                    .read_normals()
                    .expect("normals")
                    .map(|n| world.transform_vector3(n.into()).normalize())
                    .collect();
                let indices: Vec<u32> = reader.read_indices().expect("indices").into_u32().collect();
                let material = p.material().index().expect("a material of its own");
                for t in indices.chunks_exact(3) {
                    let t = [t[0] as usize, t[1] as usize, t[2] as usize];
                    self.triangles.push(Triangle {
                        corners: t.map(|i| positions[i]),
                        normals: t.map(|i| normals[i]),
                        material,
                    });
                }
            }
        }
        for child in node.children().map(|c| c.index()).collect::<Vec<_>>() {
            self.visit(child, world);
        }
    }

    pub fn material_named(&self, name: &str) -> usize {
        self.document
            .materials()
            .position(|m| m.name() == Some(name))
            .expect("material")
    }

    pub fn node(&self, name: &str) -> &Node {
        self.nodes
            .iter()
            .find(|n| n.name == name)
            .unwrap_or_else(|| panic!("no node {name}"))
    }

    /// Distance and triangle of the first opaque hit within `reach`.
    pub fn hit(&self, from: Vec3, direction: Vec3, reach: f32) -> Option<(f32, &Triangle)> {
        first_hit(
            self.triangles.iter().filter(|t| !self.masked[t.material]),
            from,
            direction,
            reach,
        )
    }

    /// Opaque triangles whose horizontal bounds touch a square.
    pub fn near(&self, x: f32, z: f32, half: f32) -> Vec<&Triangle> {
        let touches = |t: &&Triangle| {
            let low = t.corners[0].min(t.corners[1]).min(t.corners[2]);
            let high = t.corners[0].max(t.corners[1]).max(t.corners[2]);
            low.x <= x + half && high.x >= x - half && low.z <= z + half && high.z >= z - half
        };
        self.triangles
            .iter()
            .filter(|t| !self.masked[t.material])
            .filter(touches)
            .collect()
    }
}

/// Möller & Trumbore 1997, both sides, in f64 corners enough for metres.
pub fn first_hit<'a>(
    triangles: impl Iterator<Item = &'a Triangle>,
    from: Vec3,
    direction: Vec3,
    reach: f32,
) -> Option<(f32, &'a Triangle)> {
    let (from, direction) = (from.as_dvec3(), direction.normalize().as_dvec3());
    let mut best: Option<(f32, &Triangle)> = None;
    for t in triangles {
        let [a, b, c] = t.corners.map(|p| p.as_dvec3());
        let (e1, e2) = (b - a, c - a);
        let p = direction.cross(e2);
        let det = e1.dot(p);
        if det.abs() < 1e-12 {
            continue;
        }
        let s = from - a;
        let u = s.dot(p) / det;
        let q = s.cross(e1);
        let v = direction.dot(q) / det;
        let d = (e2.dot(q) / det) as f32;
        if u >= -1e-9 && v >= -1e-9 && u + v <= 1.0 + 1e-9 && d > 0.0 && d < best.map_or(reach, |b| b.0) {
            best = Some((d, t));
        }
    }
    best
}
