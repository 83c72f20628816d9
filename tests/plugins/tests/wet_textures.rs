//! Materials baked for fixed weather look as the shader makes them, to a step of eight bits.

use bevy::prelude::*;
use image::RgbImage;
use rain_core::surface::artist_look::ArtistRules;
use rain_core::surface::{FixedWetness, MaterialTexel, wet_texel};
use rain_plugins::prelude::*;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

const SIZE: [u32; 2] = [64, 64];

fn material(texel: &MaterialTexel) -> StandardMaterial {
    let [r, g, b] = texel.base_colour.map(|c| c as f32);
    StandardMaterial {
        base_color: Color::linear_rgb(r, g, b),
        perceptual_roughness: texel.roughness as f32,
        metallic: texel.metallic as f32,
        reflectance: texel.reflectance as f32,
        ..default()
    }
}

/// The texel as textures of eight bits hold it; its colour in sRGB.
fn in_bytes(texel: MaterialTexel) -> MaterialTexel {
    let byte = |v: f64| (255.0 * v).round() / 255.0;
    let colour = |v: f64| {
        let encoded = f64::from(Color::linear_rgb(v as f32, 0.0, 0.0).to_srgba().red);
        f64::from(Color::srgb(byte(encoded) as f32, 0.0, 0.0).to_linear().red)
    };
    MaterialTexel {
        base_colour: texel.base_colour.map(colour),
        roughness: byte(texel.roughness),
        metallic: byte(texel.metallic),
        reflectance: byte(texel.reflectance),
    }
}

/// Largest difference in the middle of two pictures.
fn apart(a: &RgbImage, b: &RgbImage) -> u8 {
    let middle = (24..40).flat_map(|y| (24..40).map(move |x| (x, y)));
    let differences = middle.flat_map(|(x, y)| {
        let (a, b) = (a.get_pixel(x, y).0, b.get_pixel(x, y).0);
        [0, 1, 2].map(|c| a[c].abs_diff(b[c]))
    });
    differences.max().expect("pixels")
}

#[test]
fn a_baked_texel_is_the_pixel_that_the_shader_shows() {
    if !gpu::available() {
        return;
    }
    let mut test = TestApp::new(SIZE, true);
    world::without_ground(test.world());
    let plate = world::block(
        test.world(),
        "plate",
        Vec3::new(-1.0, -0.1, -1.0),
        Vec3::new(1.0, 0.0, 1.0),
        world::STONE,
    );
    test.world().spawn(Weather::rain(0.0));
    test.look(Vec3::new(0.0, 4.0, 0.01), Vec3::ZERO);
    test.frames(3, FRAME);
    let materials = [
        MaterialTexel {
            base_colour: [0.45, 0.32, 0.2],
            roughness: 0.85,
            metallic: 0.0,
            reflectance: 0.5,
        },
        MaterialTexel {
            base_colour: [0.1, 0.2, 0.6],
            roughness: 0.5,
            metallic: 0.3,
            reflectance: 0.3,
        },
    ];
    let looks = [
        (WetLook::Physical, None),
        (WetLook::Lagarde, Some(ArtistRules::Lagarde)),
        (WetLook::LagardePorous, Some(ArtistRules::LagardePorous)),
        (WetLook::Nguyenova, Some(ArtistRules::Nguyenova)),
    ];
    // Pores, film and water of the shader's fixed states, whose puddles are 8 mm deep.
    let states = [
        (SurfaceState::Wet, [1.0, 0.0, 0.0]),
        (SurfaceState::Drenched, [1.0, 0.5, 0.5]),
        (SurfaceState::Puddle, [1.0, 1.0, 1.0]),
    ];
    for dry in materials {
        let show = |test: &mut TestApp, texel: &MaterialTexel, wetting: Option<SurfaceWetting>| {
            let handle = test
                .world()
                .resource_mut::<Assets<StandardMaterial>>()
                .add(material(texel));
            let mut entity = test.world().entity_mut(plate);
            entity.insert(KeepDry);
            test.frames(2, FRAME);
            let mut entity = test.world().entity_mut(plate);
            entity.insert(MeshMaterial3d(handle));
            if let Some(wetting) = wetting {
                entity.insert(wetting).remove::<KeepDry>();
            }
            test.frames(4, FRAME);
            test.picture()
        };
        let plain = show(&mut test, &dry, None);
        for (look, rules) in looks {
            let mut seen = 0;
            for (state, [wetness, film, water]) in states {
                let by_shader = SurfaceWetting {
                    look: Some(look),
                    state: Some(state),
                    ..default()
                };
                let shown = show(&mut test, &dry, Some(by_shader));
                let weather = FixedWetness {
                    wetness,
                    film,
                    water,
                    depth_m: 0.008,
                    rules,
                    ..FixedWetness::default()
                };
                let baked = show(&mut test, &in_bytes(wet_texel(&dry, &weather, 1.0)), None);
                let off = apart(&shown, &baked);
                assert!(off <= 1, "{look:?} {state:?} {dry:?}: {off}");
                seen = seen.max(apart(&plain, &shown));
            }
            assert!(seen > 4, "{look:?} {dry:?}: water is not seen, {seen}");
        }
    }
}
