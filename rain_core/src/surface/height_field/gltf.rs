//! A height field from a glTF or GLB file: the ground as rain finds it from above.

use std::path::{Component, Path};

use glam::{DAffine3, DMat4, DQuat, DVec3};
use gltf::json::validation::{Error as Fault, Validate};
use gltf::material::AlphaMode;
use gltf::mesh::Mode;
use gltf::scene::Transform;
use gltf::{Document, Node, Primitive, Semantic, buffer, json};
use serde::Deserialize;
use thiserror::Error;

use super::accessor::{Buffers, indices, positions};
use super::triangles::{Bounds, LeftOutTriangles, TriangleRaster};
use super::{HeightField, HeightFieldError, ImportLimits, check_bytes};

/// Words of a name that mark a tree's crown.
const CANOPY_WORDS: [&str; 3] = ["canopy", "foliage", "leaves"];

/// Extensions that a file may require without changing where its triangles are.
const HARMLESS: [&str; 6] = [
    "KHR_materials_",
    "KHR_texture_",
    "KHR_lights_",
    "EXT_texture_",
    "MSFT_texture_",
    "KHR_mesh_quantization",
];

/// What is wrong with a glTF file.
#[derive(Debug, Error)]
pub enum GltfProblem {
    /// The binary container is cut off or inconsistent.
    #[error("the GLB container is broken: {0}")]
    Container(&'static str),
    /// The JSON does not parse.
    #[error("the glTF text is broken: {0}")]
    Json(json::Error),
    /// The JSON parses, and makes no sense.
    #[error("the glTF is invalid at {place}: {fault}")]
    Invalid {
        /// Path inside the JSON.
        place: String,
        /// What is wrong there.
        fault: String,
    },
    /// A buffer is missing, too short, or cannot be read.
    #[error("buffer {buffer}: {problem}")]
    Buffer {
        /// Its index.
        buffer: usize,
        /// What is wrong.
        problem: String,
    },
    /// Data that reach out of their buffer.
    #[error("buffer view {view} is shorter than what is read from it, or lies outside its buffer")]
    OutOfBuffer {
        /// Index of the buffer view.
        view: usize,
    },
    /// An accessor of another type than its use asks for.
    #[error("accessor {accessor} has the wrong type for {wanted}")]
    Type {
        /// Its index.
        accessor: usize,
        /// Use and type.
        wanted: &'static str,
    },
    /// An accessor with more elements than allowed.
    #[error("accessor {accessor} has {count} elements, allowed: {allowed}")]
    Count {
        /// Its index.
        accessor: usize,
        /// Its elements.
        count: usize,
        /// The limit.
        allowed: usize,
    },
    /// An index of a vertex that does not exist.
    #[error("accessor {accessor} names vertex {index} of {vertices}")]
    Index {
        /// The accessor's index.
        accessor: usize,
        /// The index that it holds.
        index: usize,
        /// Vertices that there are.
        vertices: usize,
    },
    /// A node that hangs under two others, or under itself.
    #[error("node {0} appears twice in the scene's tree")]
    NodeTwice(usize),
}

/// A height field, and what of the file is not in it.
#[derive(Debug, Clone)]
pub struct GltfImport {
    /// The height field; its frame is in the world's metres.
    pub field: HeightField,
    /// Triangles that are no ground.
    pub left_out: LeftOutTriangles,
    /// Primitives left out because their material is alpha-masked or blended.
    pub transparent: usize,
    /// Primitives left out as tree crowns.
    pub canopy: usize,
}

/// What this crate reads of anybody's extras.
#[derive(Debug, Default, Deserialize)]
struct Extras {
    canopy: Option<bool>,
}

/// Whether something is marked as a crown: by `"canopy": true` or `false` in its extras, else by a word of its name.
fn marked(name: Option<&str>, extras: &json::Extras) -> Option<bool> {
    let extras = extras.as_ref();
    if let Some(Ok(Extras { canopy: Some(canopy) })) = extras.map(|e| json::deserialize::from_str(e.get())) {
        return Some(canopy);
    }
    let canopy = name?
        .split(|c: char| !c.is_alphabetic())
        .any(|word| CANOPY_WORDS.iter().any(|w| word.eq_ignore_ascii_case(w)));
    canopy.then_some(true)
}

/// A primitive where it stands.
struct Instance<'a> {
    world: DAffine3,
    primitive: Primitive<'a>,
}

/// The drawn primitives of a scene, and how many were left out.
#[derive(Default)]
struct Scene<'a> {
    instances: Vec<Instance<'a>>,
    transparent: usize,
    canopy: usize,
}

impl HeightField {
    /// Draws the default scene of a glTF or GLB file into the smallest grid around what faces up: over each cell centre
    /// the highest opaque triangle that faces up (by its winding; a node that mirrors turns it, `doubleSided` does
    /// not).
    ///
    /// Buffers are those in the file, `data:` URIs, and files under `folder` (none where it is `None`). Left out are
    /// primitives whose material is alpha-masked or blended; tree crowns, which are nodes, meshes or materials with
    /// `"canopy": true` in their extras or `canopy`, `foliage` or `leaves` as a word of their name (`"canopy": false`
    /// keeps them; a node's mark counts for all below it); points and lines. Skins and morph targets stay in their
    /// rest pose. The first scene stands in for a default; without any scene, all root nodes are drawn.
    ///
    /// Allocates the heights and, one primitive at a time, its vertices and indices.
    ///
    /// # Errors
    /// When the file is broken, requires an extension that moves triangles, has nothing that faces up, or holds more
    /// than `limits` allow.
    pub fn from_gltf(
        bytes: &[u8],
        folder: Option<&Path>,
        cell_m: f64,
        limits: &ImportLimits,
    ) -> Result<GltfImport, HeightFieldError> {
        check_bytes(bytes.len() as u64, limits)?;
        let (text, blob) = split(bytes)?;
        let document = parse(text)?;
        let buffers = read_buffers(&document, blob, folder, limits)?;
        let scene = collect(&document)?;
        let mut bounds = Bounds::none();
        for_each_triangle(&scene, &buffers, limits, |t| {
            bounds.add(&t);
            Ok(())
        })?;
        let mut raster = TriangleRaster::new(bounds.frame(cell_m, limits)?);
        for_each_triangle(&scene, &buffers, limits, |t| raster.add(t))?;
        let left_out = raster.left_out();
        Ok(GltfImport {
            field: raster.finish()?,
            left_out,
            transparent: scene.transparent,
            canopy: scene.canopy,
        })
    }
}

/// The JSON and the binary chunk of a GLB file, or all of a glTF file.
fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), GltfProblem> {
    use GltfProblem::Container;
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes, None));
    }
    let word = |at: usize| -> Option<usize> {
        let bytes = bytes.get(at..at.checked_add(4)?)?;
        Some(u32::from_le_bytes(bytes.try_into().ok()?) as usize)
    };
    match word(4) {
        Some(2) => {}
        Some(_) => return Err(Container("its version is not 2")),
        None => return Err(Container("the header is cut off")),
    }
    let length = word(8).ok_or(Container("the header is cut off"))?;
    let all = bytes
        .get(..length)
        .ok_or(Container("the file is shorter than its header says"))?;
    let chunk = |at: usize, kind: &[u8; 4], wrong: &'static str| {
        let size = word(at).ok_or(Container("a chunk header is cut off"))?;
        if bytes.get(at + 4..at + 8) != Some(kind) {
            return Err(Container(wrong));
        }
        let end = (at + 8).checked_add(size).ok_or(Container("a chunk is too long"))?;
        let data = all.get(at + 8..end).ok_or(Container("a chunk is cut off"))?;
        Ok((data, end))
    };
    let (text, end) = chunk(12, b"JSON", "the first chunk is not JSON")?;
    // A chunk of another kind may follow and is to be skipped.
    let binary = chunk(end.next_multiple_of(4), b"BIN\0", "").ok().map(|(data, _)| data);
    Ok((text, binary))
}

/// Parses and validates. Missing bounds of positions are forgiven: nothing here uses them.
fn parse(text: &[u8]) -> Result<Document, GltfProblem> {
    let root: json::Root = json::deserialize::from_slice(text).map_err(GltfProblem::Json)?;
    // The validation of primitives takes these indices for valid.
    for (m, mesh) in root.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            if primitive.attributes.values().any(|a| a.value() >= root.accessors.len()) {
                return Err(GltfProblem::Invalid {
                    place: format!("meshes[{m}].primitives[{p}].attributes"),
                    fault: Fault::IndexOutOfBounds.to_string(),
                });
            }
        }
    }
    let mut first = None;
    root.validate(&root, json::Path::new, &mut |place, fault| {
        if first.is_some() {
            return;
        }
        let place = place().to_string();
        let bounds = place.ends_with(".min") || place.ends_with(".max");
        let harmless = matches!(fault, Fault::Unsupported) && HARMLESS.iter().any(|name| place.contains(name));
        if !(bounds || harmless) {
            first = Some(GltfProblem::Invalid {
                place,
                fault: fault.to_string(),
            });
        }
    });
    match first {
        Some(problem) => Err(problem),
        None => Ok(Document::from_json_without_validation(root)),
    }
}

fn read_buffers(
    document: &Document,
    mut blob: Option<&[u8]>,
    folder: Option<&Path>,
    limits: &ImportLimits,
) -> Result<Vec<Vec<u8>>, HeightFieldError> {
    let mut buffers = Vec::new();
    for buffer in document.buffers() {
        let wrong = |problem: String| GltfProblem::Buffer {
            buffer: buffer.index(),
            problem,
        };
        let bytes = match buffer.source() {
            buffer::Source::Bin => blob
                .take()
                .ok_or_else(|| wrong("the file has no binary chunk for it".into()))?
                .to_vec(),
            buffer::Source::Uri(uri) if uri.starts_with("data:") => {
                buffer::Data::from_source(buffer.source(), None)
                    .map_err(|error| wrong(error.to_string()))?
                    .0
            }
            buffer::Source::Uri(uri) => read_file(uri, folder, limits).map_err(wrong)?,
        };
        if bytes.len() < buffer.length() {
            let problem = format!("{} bytes, the file says {}", bytes.len(), buffer.length());
            return Err(wrong(problem).into());
        }
        buffers.push(bytes);
    }
    Ok(buffers)
}

/// Reads a buffer beside the file.
fn read_file(uri: &str, folder: Option<&Path>, limits: &ImportLimits) -> Result<Vec<u8>, String> {
    let folder = folder.ok_or("it is another file, and no folder was given")?;
    let name = percent_decoded(uri).ok_or_else(|| format!("{uri:?} is no valid name"))?;
    let relative = Path::new(&name);
    let inside = relative
        .components()
        .all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    if name.contains(':') || !inside {
        return Err(format!("{uri:?} is not a file beside or below the glTF"));
    }
    let path = folder.join(relative);
    let failed = |error: std::io::Error| format!("{}: {error}", path.display());
    let metadata = std::fs::metadata(&path).map_err(failed)?;
    if !metadata.is_file() {
        return Err(format!("{} is no file", path.display()));
    }
    check_bytes(metadata.len(), limits).map_err(|error| format!("{}: {error}", path.display()))?;
    std::fs::read(&path).map_err(failed)
}

fn percent_decoded(text: &str) -> Option<String> {
    let mut bytes = text.bytes();
    let mut out = Vec::new();
    while let Some(byte) = bytes.next() {
        if byte == b'%' {
            let mut digit = || char::from(bytes.next()?).to_digit(16);
            out.push((digit()? * 16 + digit()?) as u8);
        } else {
            out.push(byte);
        }
    }
    String::from_utf8(out).ok()
}

/// Walks the scene's tree.
fn collect(document: &Document) -> Result<Scene<'_>, GltfProblem> {
    let roots: Vec<Node<'_>> = match document.default_scene().or_else(|| document.scenes().next()) {
        Some(scene) => scene.nodes().collect(),
        None => {
            let mut child = vec![false; document.nodes().len()];
            for node in document.nodes() {
                node.children().for_each(|c| child[c.index()] = true);
            }
            document.nodes().filter(|n| !child[n.index()]).collect()
        }
    };
    let mut scene = Scene::default();
    let mut seen = vec![false; document.nodes().len()];
    let mut open: Vec<_> = roots.into_iter().map(|n| (n, DAffine3::IDENTITY, false)).collect();
    // Children are put on top in reverse, so that everything comes in the file's order.
    open.reverse();
    while let Some((node, parent, above)) = open.pop() {
        if std::mem::replace(&mut seen[node.index()], true) {
            return Err(GltfProblem::NodeTwice(node.index()));
        }
        let world = parent * local(node.transform());
        let canopy = marked(node.name(), node.extras()).unwrap_or(above);
        if let Some(mesh) = node.mesh() {
            let canopy = marked(mesh.name(), mesh.extras()).unwrap_or(canopy);
            for primitive in mesh.primitives() {
                let material = primitive.material();
                if material.alpha_mode() != AlphaMode::Opaque {
                    scene.transparent += 1;
                } else if marked(material.name(), material.extras()).unwrap_or(canopy) {
                    scene.canopy += 1;
                } else {
                    scene.instances.push(Instance { world, primitive });
                }
            }
        }
        let children: Vec<_> = node.children().collect();
        open.extend(children.into_iter().rev().map(|child| (child, world, canopy)));
    }
    Ok(scene)
}

/// A node's own transform in double precision.
fn local(transform: Transform) -> DAffine3 {
    match transform {
        Transform::Matrix { matrix } => {
            let columns = matrix.map(|column| column.map(f64::from));
            DAffine3::from_mat4(DMat4::from_cols_array_2d(&columns))
        }
        Transform::Decomposed {
            translation,
            rotation,
            scale,
        } => {
            let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
            // Written in single precision, so of length 1 only to that.
            let rotation = DQuat::from_array(rotation.map(f64::from)).normalize();
            DAffine3::from_scale_rotation_translation(vector(scale), rotation, vector(translation))
        }
    }
}

/// Every triangle of the scene in the world, in the file's order, wound so that it faces where it is seen from.
fn for_each_triangle(
    scene: &Scene<'_>,
    buffers: &Buffers,
    limits: &ImportLimits,
    mut visit: impl FnMut([DVec3; 3]) -> Result<(), HeightFieldError>,
) -> Result<(), HeightFieldError> {
    let allowed = limits.triangles;
    let most = allowed.saturating_mul(3);
    let (mut triangles, mut vertices) = (0_usize, 0_usize);
    for Instance { world, primitive } in &scene.instances {
        let mode = primitive.mode();
        if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            continue;
        }
        let Some(accessor) = primitive.get(&Semantic::Positions) else {
            continue;
        };
        let mut points = positions(buffers, &accessor, most)?;
        points.transform(world);
        let order = match primitive.indices() {
            Some(accessor) => Some(indices(buffers, &accessor, points.len(), most)?),
            None => None,
        };
        let corners = order.as_ref().map_or_else(|| points.len(), Vec::len);
        let count = match mode {
            Mode::Triangles => corners / 3,
            _ => corners.saturating_sub(2),
        };
        vertices = vertices.saturating_add(points.len());
        triangles = triangles.saturating_add(count);
        if triangles > allowed || vertices > most {
            return Err(HeightFieldError::TooManyTriangles { allowed });
        }
        let mirrored = world.matrix3.determinant() < 0.0;
        let point = |i: usize| points.get(order.as_ref().map_or(i, |order| order[i]));
        for i in 0..count {
            let [a, b, c] = match mode {
                Mode::Triangles => [3 * i, 3 * i + 1, 3 * i + 2],
                Mode::TriangleStrip => [i, i + 1 + i % 2, i + 2 - i % 2],
                _ => [i + 1, i + 2, 0],
            };
            let (b, c) = if mirrored { (c, b) } else { (b, c) };
            visit([point(a), point(b), point(c)])?;
        }
    }
    Ok(())
}
