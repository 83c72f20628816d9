//! The files themselves: size, determinism, errors, textures, materials.

use crate::scene::{car_scene, folder, street_scene};
use street::StreetError;

#[test]
fn one_seed_gives_the_same_bytes() {
    let again = street::street_glb(street::DEFAULT_SEED).expect("no file involved");
    assert_eq!(again.len(), street_scene().bytes.len());
    assert!(again == street_scene().bytes, "the street differs between two runs");
    assert!(
        street::car::glb().expect("no file involved") == car_scene().bytes,
        "the car differs between two runs"
    );
    let other = street::street_glb(street::DEFAULT_SEED + 1).expect("no file involved");
    assert!(other != street_scene().bytes, "the seed has no influence");
}

#[test]
fn files_are_of_a_size_that_a_software_renderer_bears() {
    let (street, car) = (street_scene(), car_scene());
    assert!(
        street.bytes.len() < 12 << 20,
        "street.glb has {} bytes",
        street.bytes.len()
    );
    assert!(car.bytes.len() < 1 << 20, "car.glb has {} bytes", car.bytes.len());
    assert!(
        (60_000..200_000).contains(&street.triangles.len()),
        "{} triangles",
        street.triangles.len()
    );
    assert!(
        (4_000..20_000).contains(&car.triangles.len()),
        "{} triangles",
        car.triangles.len()
    );
    assert!(street.document.materials().len() <= 28);
    let nodes_with_mesh = street.document.nodes().filter(|n| n.mesh().is_some()).count();
    assert!(nodes_with_mesh <= 60, "{nodes_with_mesh} meshes to draw");
}

#[test]
fn an_unwritable_folder_is_a_typed_error() {
    let dir = folder("unwritable");
    std::fs::create_dir_all(&dir).expect("own folder");
    let file = dir.join("plain-file");
    std::fs::write(&file, b"not a folder").expect("own file");
    let inside = file.join("deeper");
    match street::generate(&inside, 1) {
        Err(e @ StreetError::Write { .. }) => assert!(e.to_string().contains("plain-file"), "{e}"),
        other => panic!("expected a write error, got {other:?}"),
    }
    // A folder where the file should go: nothing half written stays behind.
    std::fs::create_dir_all(dir.join(street::STREET_FILE).join("occupied")).expect("own folder");
    assert!(matches!(street::generate(&dir, 1), Err(StreetError::Write { .. })));
    let left: Vec<String> = std::fs::read_dir(&dir)
        .expect("own folder")
        .flatten()
        .map(|e| e.file_name().to_string_lossy().into_owned())
        .collect();
    assert!(left.iter().all(|n| !n.ends_with(".part")), "{left:?}");
    std::fs::remove_dir_all(dir).expect("own folder");
}

#[test]
fn every_normal_map_comes_with_tangents() {
    let mut mapped = 0;
    for scene in [street_scene(), car_scene()] {
        for mesh in scene.document.meshes() {
            for p in mesh.primitives() {
                if p.material().normal_texture().is_some() {
                    mapped += 1;
                    assert!(p.get(&gltf::Semantic::Tangents).is_some(), "{:?}", p.material().name());
                }
            }
        }
    }
    assert!(mapped > 15, "{mapped} primitives with a normal map");
}

/// Mean linear reflectance of a material's base colour.
fn mean_albedo(name: &str) -> f32 {
    let scene = street_scene();
    let material = scene
        .document
        .materials()
        .find(|m| m.name() == Some(name))
        .expect("material");
    let pbr = material.pbr_metallic_roughness();
    let image = &scene.images[pbr.base_color_texture().expect("texture").texture().source().index()];
    let linear = |byte: u8| {
        let s = f32::from(byte) / 255.0;
        if s <= 0.040_45 {
            s / 12.92
        } else {
            ((s + 0.055) / 1.055).powf(2.4)
        }
    };
    let factor = pbr.base_color_factor();
    let n = image.pixels.len() as f32;
    image
        .pixels
        .iter()
        .enumerate()
        .map(|(k, b)| linear(*b) * factor[k % 3])
        .sum::<f32>()
        / n
}

#[test]
fn dry_surfaces_have_the_reflectance_of_what_they_are() {
    let expect = [
        ("asphalt", 0.09, 0.14),
        ("slabs", 0.22, 0.38),
        ("brick", 0.1, 0.25),
        ("plaster-cream", 0.4, 0.6),
        ("roof-tiles", 0.08, 0.2),
        ("sandstone", 0.3, 0.5),
        ("setts", 0.1, 0.3),
    ];
    for (name, low, high) in expect {
        let a = mean_albedo(name);
        assert!(a > low && a < high, "{name}: {a}");
    }
}

#[test]
fn lamps_carry_lights_in_candela() {
    let scene = street_scene();
    let lights = scene.json["extensions"]["KHR_lights_punctual"]["lights"]
        .as_array()
        .expect("lights");
    assert_eq!(street::layout().lamps.len(), 8);
    for lamp in street::layout().lamps {
        let node = scene.node(&format!("{}-light", lamp.name));
        let light = &lights[node.light.expect("a light")];
        assert_eq!(light["type"], "spot");
        let cd = light["intensity"].as_f64().expect("a number");
        assert!((300.0..5000.0).contains(&cd), "{cd} cd");
        let at = node.world.transform_point3(glam::Vec3::ZERO);
        assert!(
            at.distance(glam::Vec3::from(lamp.head())) < 0.15,
            "{} at {at}",
            lamp.name
        );
        let down = node.world.transform_vector3(glam::Vec3::NEG_Z);
        assert!(down.y < -0.999, "{} shines along {down}", lamp.name);
    }
    let headlights = ["headlight-left", "headlight-right"].map(|n| car_scene().node(n));
    for (node, side) in headlights.iter().zip([1.0_f32, -1.0]) {
        assert!(node.light.is_some());
        let along = node.world.transform_vector3(glam::Vec3::NEG_Z);
        assert!(
            along.z > 0.99 && along.y < -0.01 && along.y > -0.1,
            "{} shines along {along}",
            node.name
        );
        assert!(node.world.transform_point3(glam::Vec3::ZERO).x * side > 0.4);
    }
}

#[test]
fn the_court_carries_its_puddles_in_its_vertex_colours() {
    let bytes = street::court::glb(street::DEFAULT_SEED).expect("no file involved");
    assert!(bytes.len() < 6 << 20, "court.glb has {} bytes", bytes.len());
    assert!(bytes == street::court::glb(street::DEFAULT_SEED).expect("no file involved"));
    let (document, buffers, _) = gltf::import_slice(&bytes).expect("valid glTF");
    let ground = document
        .nodes()
        .find(|n| n.name() == Some("ground"))
        .expect("there is ground");
    let primitive = ground
        .mesh()
        .and_then(|m| m.primitives().next())
        .expect("it has a mesh");
    let reader = primitive.reader(|buffer| Some(&buffers[buffer.index()]));
    let positions: Vec<[f32; 3]> = reader.read_positions().expect("positions").collect();
    let colors: Vec<[f32; 4]> = reader.read_colors(0).expect("colours").into_rgba_f32().collect();
    assert_eq!(positions.len(), colors.len());
    let at = |x: f32, z: f32| {
        let near = |p: &[f32; 3]| (p[0] - x).hypot(p[2] - z);
        let nearest = (0..positions.len()).min_by(|&a, &b| near(&positions[a]).total_cmp(&near(&positions[b])));
        colors[nearest.expect("vertices")]
    };
    for [x, z, _, _] in street::court::PUDDLES {
        let [ripples, depth, wettable, fixed] = at(x, z);
        assert!(depth < 0.2 && fixed < 0.2, "a puddle at {x}, {z}: {depth}, {fixed}");
        assert_eq!((ripples, wettable), (1.0, 1.0));
    }
    assert_eq!(at(-5.9, 5.9), [1.0; 4], "no puddle in a corner");
    let depth = image::load_from_memory(&street::court::depth_png(street::DEFAULT_SEED).expect("no file involved"))
        .expect("a picture")
        .into_luma8();
    let (low, high) = depth.iter().fold((255, 0), |(l, h), &v| (l.min(v), h.max(v)));
    assert_eq!((low, high), (0, 255), "the relief spans the whole range");
}

#[test]
fn the_plain_is_open_around_its_road_and_reaches_the_horizon() {
    let bytes = street::plain::glb(street::DEFAULT_SEED).expect("no file involved");
    assert!(bytes.len() < 16 << 20, "plain.glb has {} bytes", bytes.len());
    assert!(bytes == street::plain::glb(street::DEFAULT_SEED).expect("no file involved"));
    let (document, buffers, _) = gltf::import_slice(&bytes).expect("valid glTF");
    let mut far = 0.0_f32;
    for name in ["road", "meadow", "furrows"] {
        let node = document.nodes().find(|n| n.name() == Some(name)).expect(name);
        let primitive = node.mesh().and_then(|m| m.primitives().next()).expect("it has a mesh");
        let reader = primitive.reader(|buffer| Some(&buffers[buffer.index()]));
        let positions: Vec<[f32; 3]> = reader.read_positions().expect("positions").collect();
        for [x, y, z] in &positions {
            assert!((y - street::plain::height(*x, *z)).abs() < 1e-3, "{name} at {x}, {z}");
            assert!(name != "road" || x.abs() <= street::plain::ROAD_HALF_M);
            far = far.max(x.hypot(*z));
        }
        let corner = |i: u32| glam::Vec3::from(positions[i as usize]);
        let indices: Vec<u32> = reader.read_indices().expect("indices").into_u32().collect();
        for t in indices.chunks_exact(3) {
            let up = (corner(t[1]) - corner(t[0])).cross(corner(t[2]) - corner(t[0])).y;
            assert!(up > 0.0, "{name} faces down at {}", corner(t[0]));
        }
    }
    assert!(far > 4500.0, "its corners are {far} m away");
    let trees: Vec<_> = document
        .nodes()
        .filter(|n| n.name().is_some_and(|n| n.starts_with("hedge-tree-")))
        .collect();
    assert!(trees.len() > 60, "{} trees", trees.len());
    for tree in trees {
        let [x, y, z] = tree.transform().decomposed().0;
        assert!(x.abs() > 8.0, "a tree on the verge at {x}, {z}");
        let into = street::plain::height(x, z) - y;
        assert!(into > 0.3 && into < 1.2, "a tree at {x}, {z} stands {into} m deep");
    }
}
