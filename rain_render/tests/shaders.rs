//! Every module is valid WGSL, and every struct that crosses to the GPU has the same layout on both sides.

use naga::valid::{Capabilities, ValidationFlags, Validator};
use rain_render::params_space::ParamsSpace;
use rain_render::{compose, gpu_types};

fn parse(source: &str) -> naga::Module {
    naga::front::wgsl::parse_str(source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)))
}

#[test]
fn every_module_is_valid() {
    let mut checked = 0;
    for pass in compose::PASSES {
        let declared = compose::module(pass.name);
        for space in [ParamsSpace::Uniform, ParamsSpace::Storage] {
            let source = space.source(&declared);
            let module = parse(&source);
            assert!(!module.entry_points.is_empty(), "{} has no entry point", pass.name);
            let uniform = module
                .global_variables
                .iter()
                .any(|(_, v)| v.space == naga::AddressSpace::Uniform);
            assert!(
                !uniform || space == ParamsSpace::Uniform,
                "{} keeps a uniform buffer",
                pass.name
            );
            // Halves in words are a part of every WebGPU.
            Validator::new(ValidationFlags::all(), Capabilities::SHADER_FLOAT16_IN_FLOAT32)
                .validate(&module)
                .unwrap_or_else(|e| panic!("{}: {}", pass.name, e.emit_to_string(&source)));
        }
        checked += 1;
    }
    assert_eq!(
        checked,
        std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/passes"))
            .unwrap()
            .count()
    );
}

#[test]
fn haze_of_several_samples_is_valid() {
    let source = compose::haze_of_samples();
    assert!(source.contains("texture_depth_multisampled_2d") && source.contains("sample_index"));
    Validator::new(ValidationFlags::all(), Capabilities::MULTISAMPLED_SHADING)
        .validate(&parse(&source))
        .unwrap_or_else(|e| panic!("{}", e.emit_to_string(&source)));
}

#[test]
fn libraries_have_no_bindings_and_are_all_listed() {
    for library in compose::LIBRARIES {
        assert!(!library.source.contains("@group"), "{}", library.name);
        assert!(!library.source.contains('#'), "{} has a directive", library.name);
    }
    let files = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/lib"))
        .unwrap()
        .count();
    assert_eq!(compose::LIBRARIES.len(), files);
}

/// (name, size, [(member, offset)]) of a WGSL struct.
fn wgsl_layout(module: &naga::Module, name: &str) -> Option<(usize, Vec<(String, usize)>)> {
    module.types.iter().find_map(|(_, ty)| match &ty.inner {
        naga::TypeInner::Struct { members, span } if ty.name.as_deref() == Some(name) => Some((
            *span as usize,
            members
                .iter()
                .map(|m| (m.name.clone().unwrap(), m.offset as usize))
                .collect(),
        )),
        _ => None,
    })
}

fn differences(module: &naga::Module, layout: &gpu_types::Layout) -> Vec<String> {
    let (name, size, members) = layout;
    let Some((span, wgsl)) = wgsl_layout(module, name) else {
        return vec![format!("{name} is not in types.wgsl")];
    };
    let rust: Vec<(String, usize)> = members.iter().map(|(n, o)| ((*n).to_string(), *o)).collect();
    let mut out = Vec::new();
    if span != *size {
        out.push(format!("{name}: {span} bytes in WGSL, {size} in Rust"));
    }
    if wgsl != rust {
        out.push(format!("{name}: {wgsl:?} in WGSL, {rust:?} in Rust"));
    }
    out
}

#[test]
fn struct_layouts_agree() {
    let module = parse(compose::TYPES);
    let layouts = gpu_types::layouts();
    let structs = compose::TYPES.matches("\nstruct ").count();
    assert_eq!(layouts.len(), structs, "every struct of types.wgsl has a twin");
    for layout in &layouts {
        assert_eq!(differences(&module, layout), Vec::<String>::new());
    }
    // Two swapped members are found.
    let mut wrong = layouts[0].clone();
    wrong.2.swap(0, 2);
    assert!(!differences(&module, &wrong).is_empty());
}
