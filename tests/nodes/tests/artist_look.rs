//! The sources' own looks in the shader library against their CPU twins.

use rain_core::surface::SurfaceState::{self, Drenched, Dry, Puddle, Wet};
use rain_core::surface::artist_look::{ArtistLook, ArtistRules, artist_surface, lagarde_porosity};

use crate::device::{device, kernel, library};

/// `expression` over `v = input[i]`, or `None` where there is no device.
fn evaluate(expression: &str, input: &[[f32; 4]]) -> Option<Vec<[f32; 4]>> {
    let gpu = device()?;
    let body = format!("let v = input[i]; output[i] = {expression};");
    Some(gpu.compute(&kernel(&library(), "vec4<f32>", "vec4<f32>", &body), input, &[]))
}

const SHARES: [f32; 7] = [0.0, 0.1, 0.35, 0.5, 0.72, 0.9, 1.0];

/// Albedo, gloss, wetness and water in all combinations.
fn surfaces() -> Vec<[f32; 4]> {
    let mut all = Vec::new();
    for albedo in SHARES {
        for gloss in SHARES {
            for wet in [-0.5, 0.0, 0.3, 0.8, 1.0, 1.5] {
                for water in [-1.0, 0.0, 0.25, 0.7, 1.0, 2.0] {
                    all.push([albedo, gloss, wet, water]);
                }
            }
        }
    }
    all
}

#[test]
fn surfaces_by_each_sources_rules_are_the_cpus() {
    let input = surfaces();
    for (rules, number) in [
        (ArtistRules::Lagarde, 1),
        (ArtistRules::LagardePorous, 2),
        (ArtistRules::Nguyenova, 3),
    ] {
        for (porosity, metalness) in [(0.0_f32, 0.0_f32), (0.6, 0.3), (1.0, 1.0)] {
            let call = format!(
                "rain_artist_surface({number}u, ArtistLook(vec3<f32>(v.x), v.y, vec3<f32>(0.04)), {porosity:?}, {metalness:?}, \
                 v.z, v.w)"
            );
            let expression = format!("vec4<f32>({call}.albedo.x, {call}.gloss, {call}.normal_reflectance.y, 0.0)");
            let Some(found) = evaluate(&expression, &input) else {
                return;
            };
            let off = |shift: f64| {
                let worst = input.iter().zip(&found).map(|(i, f)| {
                    let [albedo, gloss, wet, water] = i.map(f64::from);
                    let look = ArtistLook {
                        albedo,
                        gloss,
                        f0: 0.04,
                    };
                    let by = artist_surface(rules, look, porosity.into(), metalness.into(), wet + shift, water);
                    [by.albedo, by.gloss, by.f0]
                        .into_iter()
                        .zip(f)
                        .map(|(a, b)| (a - f64::from(*b)).abs())
                        .fold(0.0, f64::max)
                });
                worst.fold(0.0, f64::max)
            };
            assert!(off(0.0) < 1e-6, "{rules:?} {porosity} {metalness}: {}", off(0.0));
            let inert = rules == ArtistRules::LagardePorous && porosity == 0.0;
            assert!(inert || off(0.1) > 0.01, "{rules:?}: a wetness that is off is found");
        }
    }
}

#[test]
fn porosity_by_gloss_is_the_cpus() {
    let input: Vec<[f32; 4]> = SHARES
        .into_iter()
        .flat_map(|gloss| SHARES.map(|metal| [gloss, metal, 0.0, 0.0]))
        .collect();
    let Some(found) = evaluate("vec4<f32>(rain_lagarde_porosity(v.x, v.y))", &input) else {
        return;
    };
    for (i, f) in input.iter().zip(&found) {
        let wanted = lagarde_porosity(i[0].into(), i[1].into());
        assert!((f64::from(f[0]) - wanted).abs() < 1e-6, "{i:?}: {f:?}, not {wanted}");
    }
    assert!(found.iter().any(|f| f[0] > 0.5) && found.iter().any(|f| f[0] == 0.0));
}

#[test]
fn fixed_states_are_the_states_they_are_called() {
    let input: Vec<[f32; 4]> = (0..=5_u8).map(|n| [f32::from(n), 0.0, 0.0, 0.0]).collect();
    let Some(found) = evaluate("vec4<f32>(rain_fixed_state(u32(v.x)), 0.0)", &input) else {
        return;
    };
    // Saturation, film over texture: what the CPU calls them.
    let state = |f: &[f32; 4]| SurfaceState::of(f[0].into(), f64::from(f[1]), 1.0);
    let states: Vec<_> = found.iter().map(state).collect();
    assert_eq!(states, [Dry, Dry, Wet, Drenched, Puddle, Puddle]);
    // Standing water only from drenched on, and whole in a puddle.
    let water: Vec<f32> = found.iter().map(|f| f[2]).collect();
    assert_eq!(water, [0.0, 0.0, 0.0, 0.5, 1.0, 1.0]);
}
