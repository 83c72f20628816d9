//! Scenes: what of a file becomes ground, and where.

use std::path::Path;

use rain_core::surface::height_field::{GltfImport, HeightField};
use rain_fuzz::corpus::base64;
use rain_fuzz::glb::{Builder, Mode, square};

use super::LIMITS;

fn read(builder: &Builder) -> GltfImport {
    HeightField::from_gltf(&builder.glb(), None, 0.5, &LIMITS).expect("a scene")
}

/// One mesh under one node of these members.
fn one(mode: Mode, points: &[[f32; 3]], indices: Option<(&[u32], usize)>, node: &str) -> GltfImport {
    let mut b = Builder::default();
    let positions = b.positions(points);
    let indices = indices.map(|(list, bytes)| b.indices(list, bytes));
    let mesh = b.mesh(positions, indices, mode, None, "");
    b.node(&format!(r#""mesh":{mesh}{node}"#), true);
    read(&b)
}

/// A square of side 2 around the origin, tilted: y = 1 + x/2 + z/4.
fn tilted() -> [[f32; 3]; 4] {
    square([0.0, 0.0, 0.0]).map(|[x, _, z]| [x, 1.0 + 0.5 * x + 0.25 * z, z])
}

#[track_caller]
fn is_tilted(field: &HeightField) {
    assert_eq!((field.cells(), field.frame().origin()), ([4, 4], [-1.0, -1.0]));
    for row in 0..4 {
        for column in 0..4 {
            let [x, z] = field.frame().centre_m(column, row);
            let h = field.height(column, row).expect("inside");
            assert!((h - 1.0 - 0.5 * x - 0.25 * z).abs() < 1e-6, "{column}, {row}: {h}");
        }
    }
}

#[test]
fn strips_fans_and_lists_with_and_without_indices_are_one_surface() {
    let [a, b, c, d] = tilted();
    is_tilted(&one(Mode::Strip, &[a, b, c, d], None, "").field);
    is_tilted(&one(Mode::Fan, &[a, b, d, c], None, "").field);
    is_tilted(&one(Mode::Triangles, &[a, b, c, c, b, d], None, "").field);
    for bytes in [1, 2, 4] {
        is_tilted(&one(Mode::Triangles, &[d, c, b, a], Some((&[3, 2, 1, 1, 2, 0], bytes)), "").field);
        is_tilted(&one(Mode::Strip, &[d, c, b, a], Some((&[3, 2, 1, 0], bytes)), "").field);
        is_tilted(&one(Mode::Fan, &[d, c, b, a], Some((&[3, 2, 0, 1], bytes)), "").field);
    }
}

#[test]
fn sparse_positions_replace_zeros() {
    let [a, b, c, d] = tilted();
    let mut builder = Builder::default();
    let positions = builder.sparse_positions(7, &[(1, a), (2, b), (4, c), (6, d)]);
    let indices = builder.indices(&[1, 2, 4, 4, 2, 6], 2);
    let mesh = builder.mesh(positions, Some(indices), Mode::Triangles, None, "");
    builder.node(&format!(r#""mesh":{mesh}"#), true);
    is_tilted(&read(&builder).field);
}

#[test]
fn nodes_move_turn_and_scale_what_hangs_under_them() {
    // Scale 2, a quarter turn about y (x → −z), then 10 along x and 3 up; the child half a metre along x before that.
    let mut b = Builder::default();
    let positions = b.positions(&[[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.5, 0.0]]);
    let mesh = b.mesh(positions, None, Mode::Triangles, None, "");
    let child = b.node(&format!(r#""mesh":{mesh},"translation":[0.5,0,0]"#), false);
    b.node(
        &format!(
            r#""children":[{child}],"translation":[10,3,0],"rotation":[0,0.70710678,0,0.70710678],"scale":[2,2,2]"#
        ),
        true,
    );
    let field = read(&b).field;
    // Corners: (0.5, 0, 0) → (10, 3, −1), (0.5, 0, 1) → (12, 3, −1), (1.5, 0.5, 0) → (10, 4, −3).
    let [x, z] = field.frame().origin();
    assert!((x - 10.0).abs() < 1e-6 && (z + 3.0).abs() < 1e-6, "{x} {z}");
    assert_eq!(field.cells(), [4, 4]);
    let h = field.height(0, 3).expect("inside");
    assert!((h - 3.125).abs() < 1e-6, "{h}");
    assert!(field.height(3, 0).is_some_and(f64::is_nan));
}

#[test]
fn a_matrix_is_read_by_columns() {
    let matrix = r#","matrix":[2,0,0,0, 0,1,0,0, 0,0,2,0, 7,5,-3,1]"#;
    let field = one(Mode::Strip, &square([0.0, 0.0, 0.0]), None, matrix).field;
    assert_eq!((field.cells(), field.frame().origin()), ([8, 8], [5.0, -5.0]));
    assert!(field.heights().iter().all(|h| *h == 5.0));
}

#[test]
fn a_mirrored_node_still_faces_where_it_is_seen_from() {
    let flat = square([0.0, 1.0, 0.0]);
    for scale in ["[-1,1,1]", "[1,1,-1]", "[-2,1,-1]"] {
        let import = one(Mode::Strip, &flat, None, &format!(r#","scale":{scale}"#));
        assert_eq!(import.left_out.not_up, 0, "{scale}");
        assert!(import.field.heights().iter().all(|h| *h == 1.0), "{scale}");
    }
    // Turned over by a mirror in y: its face looks down.
    for scale in ["[1,-1,1]", "[-1,-1,-1]"] {
        let mut b = Builder::default();
        let positions = b.positions(&flat);
        let mesh = b.mesh(positions, None, Mode::Strip, None, "");
        b.node(&format!(r#""mesh":{mesh},"scale":{scale}"#), true);
        let error = HeightField::from_gltf(&b.glb(), None, 0.5, &LIMITS).expect_err("nothing faces up");
        assert!(error.to_string().contains("no triangle faces up"), "{error}");
    }
}

#[test]
fn masked_blended_and_canopy_meshes_are_left_out() {
    let mut b = Builder::default();
    let ground = b.positions(&square([0.0, 1.0, 0.0]));
    let above = b.positions(&square([0.0, 5.0, 0.0]));
    let mask = b.material(r#""alphaMode":"MASK""#);
    let blend = b.material(r#""alphaMode":"BLEND""#);
    let opaque = b.material(r#""alphaMode":"OPAQUE","doubleSided":true"#);
    let leaves = b.material(r#""name":"Oak leaves""#);
    let meshes = [
        b.mesh(ground, None, Mode::Strip, Some(opaque), r#""name":"canopyless road""#),
        b.mesh(above, None, Mode::Strip, Some(mask), ""),
        b.mesh(above, None, Mode::Strip, Some(blend), ""),
        b.mesh(above, None, Mode::Strip, Some(leaves), ""),
        b.mesh(above, None, Mode::Strip, None, r#""name":"tree_Canopy.001""#),
        b.mesh(
            above,
            None,
            Mode::Strip,
            None,
            r#""extras":{"canopy":true,"other":[1]}"#,
        ),
    ];
    for mesh in meshes {
        b.node(&format!(r#""mesh":{mesh}"#), true);
    }
    let plain = b.mesh(above, None, Mode::Strip, None, "");
    b.node(&format!(r#""mesh":{plain},"name":"foliage-12""#), true);
    // A mark counts for what hangs below it.
    let child = b.node(&format!(r#""mesh":{plain}"#), false);
    b.node(&format!(r#""children":[{child}],"name":"canopy""#), true);
    let import = read(&b);
    assert_eq!((import.transparent, import.canopy), (2, 5));
    assert!(import.field.heights().iter().all(|h| *h == 1.0));
    // A steel canopy is kept by saying so.
    b.node(
        &format!(r#""mesh":{plain},"name":"canopy","extras":{{"canopy":false}}"#),
        true,
    );
    let import = read(&b);
    assert_eq!((import.transparent, import.canopy), (2, 5));
    assert!(import.field.heights().iter().all(|h| *h == 5.0));
}

#[test]
fn a_buffer_may_be_text_inside_or_a_file_beside() {
    let mut b = Builder::default();
    let positions = b.positions(&tilted());
    let mesh = b.mesh(positions, None, Mode::Strip, None, "");
    b.node(&format!(r#""mesh":{mesh}"#), true);
    let inside = b.json(Some(&format!(
        "data:application/octet-stream;base64,{}",
        base64(b.binary())
    )));
    is_tilted(
        &HeightField::from_gltf(inside.as_bytes(), None, 0.5, &LIMITS)
            .expect("a scene")
            .field,
    );

    let folder = std::env::temp_dir().join(format!("rain-height-field-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("sub")).expect("a folder");
    std::fs::write(folder.join("sub/the bytes.bin"), b.binary()).expect("written");
    let beside = b.json(Some("sub/the%20bytes.bin"));
    let import = HeightField::from_gltf(beside.as_bytes(), Some(&folder), 0.5, &LIMITS).expect("a scene");
    std::fs::remove_dir_all(&folder).expect("removed");
    is_tilted(&import.field);
}

/// Every real model: closed meshes, whose ground the grid must find wherever any of their triangles faces up.
#[test]
fn real_models_become_ground() {
    let Some(folder) = std::env::var_os("RAIN_ASSETS").filter(|v| !v.is_empty()) else {
        eprintln!("skipped: RAIN_ASSETS names no folder of real models");
        return;
    };
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(folder);
    let mut models = 0;
    for entry in std::fs::read_dir(&folder).expect("RAIN_ASSETS is a folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|e| e != "glb") {
            continue;
        }
        let bytes = std::fs::read(&path).expect("read");
        let import = HeightField::from_gltf(&bytes, path.parent(), 0.02, &LIMITS).expect("a scene");
        let field = &import.field;
        let [nx, nz] = field.cells();
        let name = path.display();
        assert!(nx >= 40 && nz >= 40, "{name}: {nx} × {nz}");
        // City tiles fill their square; the truck leaves its corners free.
        assert!(
            field.holes() * 4 < nx * nz,
            "{name}: {} holes of {}",
            field.holes(),
            nx * nz
        );
        let ground = field.heights().iter().copied().filter(|h| !h.is_nan());
        let (low, high) = ground.fold((f64::MAX, f64::MIN), |(a, b), h| (a.min(h), b.max(h)));
        assert!(low > -0.01 && high > low && high < 2.0, "{name}: {low} to {high}");
        models += 1;
    }
    assert!(models >= 10, "only {models} models in {}", folder.display());
}
