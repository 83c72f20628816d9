//! A binary glTF 2.0 under construction: textures, materials, meshes, lights, nodes, one buffer.

use crate::error::StreetError;
use crate::mesh::Mesh;
use glam::{Vec2, Vec3};
use serde_json::{Value, json};
use std::path::Path;

/// A document; every `add_` returns the index of what it added.
#[derive(Debug, Default)]
pub struct Glb {
    bin: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    images: Vec<Value>,
    textures: Vec<Value>,
    materials: Vec<Value>,
    meshes: Vec<Value>,
    lights: Vec<Value>,
    nodes: Vec<Value>,
    roots: Vec<usize>,
}

/// How a mesh's vertices are written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attributes {
    /// Write tangents: wherever the material has a normal map.
    pub tangents: bool,
    /// Write a second texture coordinate, (x, z) divided by this many metres.
    pub detail_m: Option<f32>,
}

fn push<T>(list: &mut Vec<T>, item: T) -> usize {
    list.push(item);
    list.len() - 1
}

impl Glb {
    fn add_view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        while !self.bin.len().is_multiple_of(4) {
            self.bin.push(0);
        }
        let mut view = json!({ "buffer": 0, "byteOffset": self.bin.len(), "byteLength": bytes.len() });
        if let Some(t) = target {
            view["target"] = json!(t);
        }
        self.bin.extend_from_slice(bytes);
        push(&mut self.views, view)
    }

    fn add_accessor(&mut self, bytes: &[u8], count: usize, kind: &str, component: u32, target: u32) -> usize {
        let view = self.add_view(bytes, Some(target));
        push(
            &mut self.accessors,
            json!({ "bufferView": view, "componentType": component, "count": count, "type": kind }),
        )
    }

    /// Adds a PNG, tiled in both directions.
    pub fn add_texture(&mut self, name: &str, png: &[u8]) -> usize {
        let view = self.add_view(png, None);
        let image = push(
            &mut self.images,
            json!({ "name": name, "bufferView": view, "mimeType": "image/png" }),
        );
        push(
            &mut self.textures,
            json!({ "name": name, "source": image, "sampler": 0 }),
        )
    }

    /// Adds a material as the specification writes it.
    pub fn add_material(&mut self, material: Value) -> usize {
        push(&mut self.materials, material)
    }

    /// Adds a mesh of one primitive per (mesh, material, attributes); `None` where all are empty.
    pub fn add_mesh(&mut self, name: &str, parts: &[(&Mesh, usize, Attributes)]) -> Option<usize> {
        let primitives: Vec<Value> = parts
            .iter()
            .filter(|p| !p.0.indices.is_empty())
            .map(|&(m, mat, a)| self.primitive(m, mat, a))
            .collect();
        (!primitives.is_empty()).then(|| push(&mut self.meshes, json!({ "name": name, "primitives": primitives })))
    }

    fn primitive(&mut self, m: &Mesh, material: usize, a: Attributes) -> Value {
        const ARRAY: u32 = 34962;
        let n = m.positions.len();
        let low = m.positions.iter().copied().fold(Vec3::MAX, Vec3::min);
        let high = m.positions.iter().copied().fold(Vec3::MIN, Vec3::max);
        let position = self.add_accessor(&floats(m.positions.iter().map(Vec3::to_array)), n, "VEC3", 5126, ARRAY);
        self.accessors[position]["min"] = json!(low.to_array());
        self.accessors[position]["max"] = json!(high.to_array());
        let normal = self.add_accessor(&floats(m.normals.iter().map(Vec3::to_array)), n, "VEC3", 5126, ARRAY);
        let uv = self.add_accessor(&floats(m.uvs.iter().map(Vec2::to_array)), n, "VEC2", 5126, ARRAY);
        let mut attributes = json!({ "POSITION": position, "NORMAL": normal, "TEXCOORD_0": uv });
        if let Some(tile) = a.detail_m {
            let detail = floats(m.positions.iter().map(|p| [p.x / tile, p.z / tile]));
            attributes["TEXCOORD_1"] = json!(self.add_accessor(&detail, n, "VEC2", 5126, ARRAY));
        }
        if a.tangents {
            let t = floats(m.tangents.iter().map(glam::Vec4::to_array));
            attributes["TANGENT"] = json!(self.add_accessor(&t, n, "VEC4", 5126, ARRAY));
        }
        if !m.colors.is_empty() {
            let colors = floats(m.colors.iter().map(glam::Vec4::to_array));
            attributes["COLOR_0"] = json!(self.add_accessor(&colors, n, "VEC4", 5126, ARRAY));
        }
        let indices: Vec<u8> = if n <= 65_535 {
            m.indices.iter().flat_map(|&i| (i as u16).to_le_bytes()).collect()
        } else {
            m.indices.iter().flat_map(|i| i.to_le_bytes()).collect()
        };
        let component = if n <= 65_535 { 5123 } else { 5125 };
        let indices = self.add_accessor(&indices, m.indices.len(), "SCALAR", component, 34963);
        json!({ "attributes": attributes, "indices": indices, "material": material, "mode": 4 })
    }

    /// Adds a light of `KHR_lights_punctual`.
    pub fn add_light(&mut self, light: Value) -> usize {
        push(&mut self.lights, light)
    }

    /// Adds a node that has no parent.
    pub fn add_root(&mut self, node: Value) -> usize {
        let i = push(&mut self.nodes, node);
        self.roots.push(i);
        i
    }

    /// Adds a node that a later node will name as its child.
    pub fn add_child(&mut self, node: Value) -> usize {
        push(&mut self.nodes, node)
    }

    /// The document as the bytes of a `.glb` file; `extras` goes to the scene.
    ///
    /// # Errors
    /// [`StreetError::Document`] when it cannot be written as JSON.
    pub fn finish(mut self, name: &str, extras: Value) -> Result<Vec<u8>, StreetError> {
        while !self.bin.len().is_multiple_of(4) {
            self.bin.push(0);
        }
        let mut used = vec!["KHR_materials_emissive_strength"];
        let mut root = json!({
            "asset": { "version": "2.0", "generator": "rain: examples/street" },
            "scene": 0,
            "scenes": [{ "name": name, "nodes": self.roots, "extras": extras }],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "materials": self.materials,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{ "byteLength": self.bin.len() }],
        });
        if !self.textures.is_empty() {
            root["samplers"] = json!([{ "magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497 }]);
            root["textures"] = json!(self.textures);
            root["images"] = json!(self.images);
        }
        if !self.lights.is_empty() {
            used.insert(0, "KHR_lights_punctual");
            root["extensions"] = json!({ "KHR_lights_punctual": { "lights": self.lights } });
        }
        root["extensionsUsed"] = json!(used);
        let mut text = serde_json::to_vec(&root).map_err(|source| StreetError::Document { source })?;
        while !text.len().is_multiple_of(4) {
            text.push(b' ');
        }
        let total = 12 + 8 + text.len() + 8 + self.bin.len();
        let mut out = Vec::with_capacity(total);
        out.extend_from_slice(b"glTF");
        for word in [2, total as u32, text.len() as u32] {
            out.extend_from_slice(&word.to_le_bytes());
        }
        out.extend_from_slice(b"JSON");
        out.extend_from_slice(&text);
        out.extend_from_slice(&(self.bin.len() as u32).to_le_bytes());
        out.extend_from_slice(b"BIN\0");
        out.extend_from_slice(&self.bin);
        Ok(out)
    }
}

fn floats<const N: usize>(values: impl Iterator<Item = [f32; N]>) -> Vec<u8> {
    values
        .flat_map(|v| v.into_iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>())
        .collect()
}

/// Writes a file in one step: readers see the old one or the whole new one.
///
/// # Errors
/// [`StreetError::Write`] naming the file.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), StreetError> {
    let fail = |source| StreetError::Write {
        path: path.to_owned(),
        source,
    };
    let mut temporary = path.as_os_str().to_owned();
    temporary.push(format!(".{}.part", std::process::id()));
    std::fs::write(&temporary, bytes).map_err(fail)?;
    std::fs::rename(&temporary, path).map_err(|source| {
        // The part file is of no use to anyone; that it may stay behind is not worth a second error.
        let _ = std::fs::remove_file(&temporary);
        fail(source)
    })
}
