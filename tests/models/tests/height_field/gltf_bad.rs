//! Broken and oversized scenes: refused with the place, never a panic, never a giant allocation.

use rain_core::surface::height_field::{HeightField, HeightFieldError, ImportLimits};
use rain_fuzz::glb::{Builder, Mode, container, square};

use super::{LIMITS, refused};

fn scene() -> Builder {
    let mut b = Builder::default();
    let positions = b.positions(&square([0.0, 1.0, 0.0]));
    let indices = b.indices(&[0, 1, 2, 2, 1, 3], 2);
    let mesh = b.mesh(positions, Some(indices), Mode::Triangles, None, "");
    b.node(&format!(r#""mesh":{mesh}"#), true);
    b
}

fn read(bytes: &[u8]) -> Result<HeightField, HeightFieldError> {
    HeightField::from_gltf(bytes, None, 0.5, &LIMITS).map(|import| import.field)
}

/// The scene with one piece of its JSON replaced.
fn changed(from: &str, to: &str) -> Vec<u8> {
    let b = scene();
    let json = b.json(None);
    assert!(json.contains(from), "{from} is not in {json}");
    container(&json.replacen(from, to, 1), b.binary())
}

#[test]
fn every_cut_is_refused() {
    let whole = scene().glb();
    assert!(read(&whole).is_ok());
    for end in 0..whole.len() {
        assert!(read(&whole[..end]).is_err(), "cut at {end}");
    }
}

#[test]
fn broken_containers_are_refused() {
    let whole = scene().glb();
    let with = |at: usize, word: u32| {
        let mut bytes = whole.clone();
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
        read(&bytes)
    };
    refused(with(4, 1), &["GLB", "version"]);
    for length in [0, 3, 11, 12, 19] {
        refused(with(8, length), &["GLB"]);
    }
    refused(with(8, u32::MAX), &["GLB", "shorter than its header says"]);
    refused(with(12, u32::MAX), &["GLB", "cut off"]);
    refused(with(16, 0x1234), &["GLB", "not JSON"]);
    refused(with(12, 0), &["text is broken"]);
    refused(read(b""), &["text is broken"]);
    refused(read(b"{}"), &["text is broken"]);
    refused(read(b"[[[[[[[[[["), &["text is broken"]);
    // Without its binary chunk.
    refused(
        read(&container(&scene().json(None), &[])),
        &["buffer 0", "no binary chunk"],
    );
}

#[test]
fn wrong_references_are_refused_with_their_place() {
    refused(
        read(&changed(r#""POSITION":0"#, r#""POSITION":9"#)),
        &["meshes[0].primitives[0].attributes", "out of bounds"],
    );
    refused(
        read(&changed(r#""indices":1"#, r#""indices":9"#)),
        &["meshes[0].primitives[0].indices"],
    );
    refused(
        read(&changed(r#""mesh":0"#, r#""mesh":4294967295"#)),
        &["nodes[0].mesh"],
    );
    refused(
        read(&changed(r#"{"nodes":[0]}"#, r#"{"nodes":[7]}"#)),
        &["scenes[0].nodes[0]"],
    );
    refused(
        read(&changed(r#""buffer":0"#, r#""buffer":5"#)),
        &["bufferViews[0].buffer"],
    );
    refused(read(&changed(r#""scene":0"#, r#""scene":3"#)), &["scene"]);
    refused(read(&changed(r#""mode":4"#, r#""mode":44"#)), &["mode", "Invalid"]);
    refused(
        read(&changed(r#""mesh":0"#, r#""mesh":0,"children":[0]"#)),
        &["node 0 appears twice"],
    );
}

#[test]
fn data_out_of_their_buffer_are_refused() {
    for (from, to) in [
        (r#""byteOffset":0"#, r#""byteOffset":100"#),
        (r#""byteOffset":0"#, r#""byteOffset":18446744073709551615"#),
        (r#""byteLength":48"#, r#""byteLength":18446744073709551615"#),
        (r#""byteLength":48"#, r#""byteLength":47"#),
        (r#""count":4"#, r#""count":5"#),
        (r#""bufferView":0,"#, r#""bufferView":0,"byteOffset":4,"#),
        (
            r#""bufferView":0,"#,
            r#""bufferView":0,"byteOffset":18446744073709551615,"#,
        ),
        (r#""byteLength":48"#, r#""byteLength":48,"byteStride":16"#),
        (r#""byteLength":48"#, r#""byteLength":48,"byteStride":4"#),
    ] {
        refused(read(&changed(from, to)), &["buffer view 0"]);
    }
    refused(
        read(&changed(r#""byteLength":60}]"#, r#""byteLength":4000}]"#)),
        &["buffer 0", "60 bytes", "4000"],
    );
}

#[test]
fn wrong_types_and_indices_are_refused() {
    refused(read(&changed(r#""VEC3""#, r#""VEC4""#)), &["accessor 0", "positions"]);
    refused(read(&changed("5126", "5125")), &["accessor 0", "positions"]);
    refused(read(&changed("5123", "5122")), &["accessor 1", "indices"]);
    refused(read(&changed(r#""SCALAR""#, r#""VEC2""#)), &["accessor 1", "indices"]);
    let mut b = Builder::default();
    let positions = b.positions(&square([0.0, 1.0, 0.0]));
    let indices = b.indices(&[0, 1, 4], 4);
    let mesh = b.mesh(positions, Some(indices), Mode::Triangles, None, "");
    b.node(&format!(r#""mesh":{mesh}"#), true);
    refused(read(&b.glb()), &["accessor 1", "vertex 4 of 4"]);
    let mut b = Builder::default();
    let positions = b.sparse_positions(3, &[(3, [1.0; 3])]);
    let mesh = b.mesh(positions, None, Mode::Triangles, None, "");
    b.node(&format!(r#""mesh":{mesh}"#), true);
    refused(read(&b.glb()), &["accessor 0", "vertex 3 of 3"]);
}

#[test]
fn counts_without_data_allocate_nothing() {
    let mut b = Builder::default();
    let positions = b.sparse_positions(3, &[(0, [1.0; 3])]);
    let mesh = b.mesh(positions, None, Mode::Triangles, None, "");
    b.node(&format!(r#""mesh":{mesh}"#), true);
    for count in ["18446744073709551615", "4000000000", "300000000"] {
        let json = b.json(None).replacen(r#""count":3"#, &format!(r#""count":{count}"#), 1);
        let bytes = container(&json, b.binary());
        let used = allocation_counter::measure(|| refused(read(&bytes), &["accessor 0", count, "201326592"]));
        assert!(used.bytes_max < 1 << 20, "{count}: {} bytes", used.bytes_max);
    }
    let json = b
        .json(None)
        .replacen(r#""sparse":{"count":1"#, r#""sparse":{"count":4"#, 1);
    refused(
        read(&container(&json, b.binary())),
        &["accessor 0", "4 elements", "allowed: 3"],
    );
}

#[test]
fn vertices_without_data_take_no_memory() {
    let mut b = Builder::default();
    let count = 3_usize << 18;
    // One triangle somewhere in a long list; all the others are points at the origin.
    let changes = [
        (60_000, [0.0, 1.0, 0.0]),
        (60_001, [0.0, 1.0, 2.0]),
        (60_002, [2.0, 1.0, 0.0]),
    ];
    let positions = b.sparse_positions(count, &changes);
    let mesh = b.mesh(positions, None, Mode::Triangles, None, "");
    b.node(&format!(r#""mesh":{mesh},"translation":[5,1,0]"#), true);
    let limits = ImportLimits {
        triangles: count / 3,
        ..LIMITS
    };
    let bytes = b.glb();
    let mut import = None;
    let used = allocation_counter::measure(|| import = HeightField::from_gltf(&bytes, None, 0.5, &limits).ok());
    assert!(used.bytes_max < 1 << 18, "{} bytes", used.bytes_max);
    let import = import.expect("a triangle faces up");
    assert_eq!(import.field.height(0, 0), Some(2.0));
    assert_eq!(import.field.frame().origin(), [5.0, 0.0]);
    assert_eq!(import.left_out.not_up, count / 3 - 1);
    let fewer = ImportLimits {
        triangles: count / 3 - 1,
        ..LIMITS
    };
    assert!(HeightField::from_gltf(&bytes, None, 0.5, &fewer).is_err());
}

#[test]
fn many_copies_of_a_mesh_count_each_time() {
    let mut b = Builder::default();
    let positions = b.positions(&square([0.0, 1.0, 0.0]));
    let mesh = b.mesh(positions, None, Mode::Strip, None, "");
    for i in 0..10 {
        b.node(&format!(r#""mesh":{mesh},"translation":[{i},0,0]"#), true);
    }
    let read = |triangles: usize| HeightField::from_gltf(&b.glb(), None, 0.5, &ImportLimits { triangles, ..LIMITS });
    assert!(read(20).is_ok());
    refused(read(19), &["more than 19 triangles"]);
}

#[test]
fn broken_coordinates_are_left_out() {
    let mut b = Builder::default();
    let [p, q, r, s] = square([0.0, 1.0, 0.0]);
    let positions = b.positions(&[
        p,
        q,
        r,
        r,
        q,
        s,
        p,
        [f32::NAN, 0.0, 0.0],
        r,
        p,
        [0.0, f32::INFINITY, 0.0],
        r,
    ]);
    let mesh = b.mesh(positions, None, Mode::Triangles, None, "");
    b.node(&format!(r#""mesh":{mesh}"#), true);
    let import = HeightField::from_gltf(&b.glb(), None, 0.5, &LIMITS).expect("a scene");
    assert_eq!(import.left_out.not_finite, 2);
    assert!(import.field.heights().iter().all(|h| *h == 1.0));
    // A node that is no place leaves nothing.
    refused(
        read(&changed(r#""mesh":0"#, r#""mesh":0,"rotation":[0,0,0,0]"#)),
        &["no triangle faces up", "2 are not finite"],
    );
    refused(
        read(&changed(r#""mesh":0"#, r#""mesh":0,"scale":[1,1,0]"#)),
        &["no triangle faces up"],
    );
}

#[test]
fn buffers_elsewhere_are_refused() {
    let b = scene();
    let folder = std::env::temp_dir();
    for uri in [
        "../secret.bin",
        "/etc/passwd",
        "http://example.org/a.bin",
        "file:///etc/passwd",
        "a/../../b",
        "%2e%2e/b",
        "%ff",
        "%4",
        "missing-file.bin",
        ".",
    ] {
        let json = b.json(Some(uri));
        refused(
            HeightField::from_gltf(json.as_bytes(), Some(&folder), 0.5, &LIMITS),
            &["buffer 0"],
        );
        refused(
            HeightField::from_gltf(json.as_bytes(), None, 0.5, &LIMITS),
            &["buffer 0"],
        );
    }
    for uri in ["data:;base64,!!!!", "data:", "data:;base64,AAAA"] {
        refused(read(b.json(Some(uri)).as_bytes()), &["buffer 0"]);
    }
}

#[test]
fn extensions_that_move_triangles_are_refused_and_others_are_not() {
    let require = |name: &str| changed(r#"{"asset""#, &format!(r#"{{"extensionsRequired":["{name}"],"asset""#));
    for harmless in [
        "KHR_materials_unlit",
        "KHR_texture_transform",
        "KHR_texture_basisu",
        "KHR_mesh_quantization",
    ] {
        assert!(read(&require(harmless)).is_ok(), "{harmless}");
    }
    for needed in [
        "KHR_draco_mesh_compression",
        "EXT_meshopt_compression",
        "EXT_mesh_gpu_instancing",
    ] {
        refused(read(&require(needed)), &["extensionsRequired", needed]);
    }
}

#[test]
fn bounds_of_positions_are_not_needed() {
    let b = scene();
    let json = b.json(None);
    let start = json.find(r#","min""#).expect("bounds");
    let end = start + json[start..].find('}').expect("an end");
    let without = format!("{}{}", &json[..start], &json[end..]);
    assert!(read(&container(&without, b.binary())).is_ok());
}

#[test]
fn files_too_long_are_refused() {
    let bytes = scene().glb();
    let limits = ImportLimits {
        bytes: bytes.len() - 1,
        ..LIMITS
    };
    refused(HeightField::from_gltf(&bytes, None, 0.5, &limits), &["bytes, allowed"]);
}
