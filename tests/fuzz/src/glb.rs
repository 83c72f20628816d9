//! Small glTF files, written by hand: valid ones to start from, and broken ones to be refused.

/// A GLB file of a JSON text and a binary chunk.
#[must_use]
pub fn container(json: &str, binary: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let (json, binary) = (padded(json.as_bytes(), b' '), padded(binary, 0));
    let mut out = b"glTF".to_vec();
    let length = 12 + 8 + json.len() + if binary.is_empty() { 0 } else { 8 + binary.len() };
    for word in [2, length as u32, json.len() as u32] {
        out.extend(word.to_le_bytes());
    }
    out.extend(b"JSON");
    out.extend(json);
    if !binary.is_empty() {
        out.extend((binary.len() as u32).to_le_bytes());
        out.extend(b"BIN\0");
        out.extend(binary);
    }
    out
}

/// How a mesh's vertices make triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// Three corners each.
    Triangles = 4,
    /// A strip.
    Strip = 5,
    /// A fan.
    Fan = 6,
}

/// A scene that grows by meshes and nodes.
#[derive(Debug, Clone, Default)]
pub struct Builder {
    binary: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
    materials: Vec<String>,
    meshes: Vec<String>,
    nodes: Vec<String>,
    roots: Vec<usize>,
}

impl Builder {
    fn view(&mut self, bytes: impl IntoIterator<Item = u8>) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let start = self.binary.len();
        self.binary.extend(bytes);
        let length = self.binary.len() - start;
        self.views
            .push(format!(r#"{{"buffer":0,"byteOffset":{start},"byteLength":{length}}}"#));
        self.views.len() - 1
    }

    fn accessor(&mut self, json: String) -> usize {
        self.accessors.push(json);
        self.accessors.len() - 1
    }

    /// An accessor of positions.
    pub fn positions(&mut self, points: &[[f32; 3]]) -> usize {
        let view = self.view(points.iter().flatten().flat_map(|v| v.to_le_bytes()));
        let bound = |f: fn(f32, f32) -> f32, start: f32| {
            let finite = |i: usize| points.iter().map(move |p| p[i]).filter(|v| v.is_finite());
            let v = [0, 1, 2].map(|i| finite(i).fold(start, f));
            format!("[{:?},{:?},{:?}]", v[0], v[1], v[2])
        };
        let (low, high) = (bound(f32::min, f32::MAX), bound(f32::max, f32::MIN));
        let count = points.len();
        self.accessor(format!(
            r#"{{"bufferView":{view},"componentType":5126,"count":{count},"type":"VEC3","min":{low},"max":{high}}}"#
        ))
    }

    /// An accessor of `count` positions, all at the origin but for those listed.
    pub fn sparse_positions(&mut self, count: usize, changes: &[(u16, [f32; 3])]) -> usize {
        let indices = self.view(changes.iter().flat_map(|(i, _)| i.to_le_bytes()));
        let values = self.view(changes.iter().flat_map(|(_, p)| p.iter().flat_map(|v| v.to_le_bytes())));
        let n = changes.len();
        self.accessor(format!(
            r#"{{"componentType":5126,"count":{count},"type":"VEC3","min":[0,0,0],"max":[1,1,1],"sparse":{{"count":{n},"indices":{{"bufferView":{indices},"componentType":5123}},"values":{{"bufferView":{values}}}}}}}"#
        ))
    }

    /// An accessor of indices with 1, 2 or 4 bytes each.
    pub fn indices(&mut self, indices: &[u32], bytes: usize) -> usize {
        let view = self.view(indices.iter().flat_map(|i| i.to_le_bytes().into_iter().take(bytes)));
        let kind = [0, 5121, 5123, 0, 5125][bytes];
        let count = indices.len();
        self.accessor(format!(
            r#"{{"bufferView":{view},"componentType":{kind},"count":{count},"type":"SCALAR"}}"#
        ))
    }

    /// A material of the members given, such as `"alphaMode":"MASK"`.
    pub fn material(&mut self, members: &str) -> usize {
        self.materials.push(format!("{{{members}}}"));
        self.materials.len() - 1
    }

    /// A mesh of one primitive. `members` go into the mesh, such as `"name":"canopy"`.
    pub fn mesh(
        &mut self,
        positions: usize,
        indices: Option<usize>,
        mode: Mode,
        material: Option<usize>,
        members: &str,
    ) -> usize {
        let indices = indices.map_or(String::new(), |i| format!(r#","indices":{i}"#));
        let material = material.map_or(String::new(), |i| format!(r#","material":{i}"#));
        let members = if members.is_empty() {
            String::new()
        } else {
            format!("{members},")
        };
        let mode = mode as u32;
        self.meshes.push(format!(
            r#"{{{members}"primitives":[{{"attributes":{{"POSITION":{positions}}},"mode":{mode}{indices}{material}}}]}}"#
        ));
        self.meshes.len() - 1
    }

    /// A node of the members given, such as `"mesh":0,"children":[2]`; a root where `root`.
    pub fn node(&mut self, members: &str, root: bool) -> usize {
        self.nodes.push(format!("{{{members}}}"));
        if root {
            self.roots.push(self.nodes.len() - 1);
        }
        self.nodes.len() - 1
    }

    /// The JSON text, its buffer with this URI (none: the binary chunk).
    #[must_use]
    pub fn json(&self, uri: Option<&str>) -> String {
        let list = |name: &str, items: &[String]| {
            if items.is_empty() {
                String::new()
            } else {
                format!(r#","{name}":[{}]"#, items.join(","))
            }
        };
        let roots: Vec<String> = self.roots.iter().map(ToString::to_string).collect();
        let uri = uri.map_or(String::new(), |uri| format!(r#","uri":"{uri}""#));
        [
            r#"{"asset":{"version":"2.0"},"scene":0"#.to_owned(),
            format!(r#","scenes":[{{"nodes":[{}]}}]"#, roots.join(",")),
            list("nodes", &self.nodes),
            list("meshes", &self.meshes),
            list("materials", &self.materials),
            list("accessors", &self.accessors),
            list("bufferViews", &self.views),
            format!(r#","buffers":[{{"byteLength":{}{uri}}}]}}"#, self.binary.len()),
        ]
        .concat()
    }

    /// The bytes of the buffer.
    #[must_use]
    pub fn binary(&self) -> &[u8] {
        &self.binary
    }

    /// The file as GLB.
    #[must_use]
    pub fn glb(&self) -> Vec<u8> {
        container(&self.json(None), &self.binary)
    }
}

/// Corners of a flat square of side 2 around (x, z) at height y, in the order of a strip that faces up.
#[must_use]
pub fn square([x, y, z]: [f32; 3]) -> [[f32; 3]; 4] {
    [
        [x - 1.0, y, z - 1.0],
        [x - 1.0, y, z + 1.0],
        [x + 1.0, y, z - 1.0],
        [x + 1.0, y, z + 1.0],
    ]
}
