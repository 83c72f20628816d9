//! What steps in water throw: the shader's drops and sheets are the CPU's, and fly where the CPU has them.

use glam::{DVec3, Vec2, Vec3};
use rain_core::hash::{pcg3d, unit_f32};
use rain_core::splash::{FOOT_DROPS, FOOT_SPLASH_S, foot_drop, foot_drop_count, foot_sheet};
use rain_render::gpu_types::SplashPart;
use rain_render::splash::{MAX_FEET, SplashGpu, StepSplash};

use super::scene::{Extra, SIZE, Scene};
use crate::device::{device, kernel, library};

#[test]
fn drops_and_sheets_of_steps_are_the_cpus() {
    let Some(gpu) = device() else { return };
    let input: Vec<[u32; 4]> = (0..3000_u32)
        .map(|i| {
            let strength = unit_f32(pcg3d([i, 4, 7])[0]);
            [i.wrapping_mul(0x9e37_79b9), i ^ 0x55, 11 * i, strength.to_bits()]
        })
        .collect();
    let bindings = "struct Out { drop: vec4<f32>, outward: vec4<f32>, sheet: vec4<f32> }\n";
    let body = "let v = input[i];
    let strength = bitcast<f32>(v.w);
    let found = rain_foot_drop(strength, v.xyz, i % 8u);
    output[i] = Out(found.drop, vec4<f32>(found.outward, f32(rain_foot_drop_count(strength))),
        vec4<f32>(rain_foot_sheet(strength, 0.15 * rain_unit(v.x)), 0.0));";
    let source = kernel(&(library() + bindings), "vec4<u32>", "Out", body);
    let found: Vec<[f32; 12]> = gpu.compute(&source, &input, &[]);
    let (mut other_counts, mut standing) = (0, 0);
    for (i, (v, out)) in input.iter().zip(found).enumerate() {
        let strength = f32::from_bits(v[3]);
        let count = foot_drop_count(strength);
        let sheet = foot_sheet(strength, 0.15 * unit_f32(v[0]));
        for (out, known) in out[8..11].iter().zip(sheet) {
            assert!(
                (out - known).abs() <= 1e-5 * known + 1e-7,
                "{strength}: {out}, not {known}"
            );
        }
        standing += u32::from(sheet[2] > 0.0);
        if out[7] != count as f32 {
            other_counts += 1;
            continue;
        }
        let (drop, from) = foot_drop(strength, [v[0], v[1], v[2]], i as u32 % 8);
        assert!((out[3] / drop.diameter_mm - 1.0).abs() < 1e-6);
        let velocity = Vec3::new(out[0], out[1], out[2]);
        assert!((velocity - drop.velocity_m_s).length() < 1e-5, "{velocity}, {drop:?}");
        assert!((0.05 * Vec3::new(out[4], out[5], out[6]) - from).length() < 1e-6);
    }
    assert!(other_counts < 4 && standing > 2000, "{other_counts} {standing}");
}

fn drops(parts: &[SplashPart]) -> Vec<(Vec2, Vec2)> {
    let drops = parts.iter().filter(|part| part.form[0] == 0.0);
    drops
        .map(|p| (Vec2::new(p.ends[0], p.ends[1]), Vec2::new(p.ends[2], p.ends[3])))
        .collect()
}

#[test]
fn a_steps_drops_fly_where_the_cpu_has_them_and_land() {
    let Some(gpu) = device() else { return };
    let pipelines = SplashGpu::new(&gpu.device);
    let scene = Scene {
        eye_m: DVec3::new(1.5, 1.6, 0.0),
        rain_mm_h: 0.0,
        reach_m: 0.0,
        ..Scene::default()
    };
    let step = |x: f32, age_s: f32, strength: f32, key: u32| StepSplash {
        place_m: Vec3::new(x, -1.6, 0.1),
        age_s,
        strength,
        key: [key, 2, 3],
    };
    let steps = [step(0.1, 0.09, 1.0, 5), step(-0.3, 0.15, 0.4, 6)];
    let parts_of = |steps: &[StepSplash]| {
        let extra = Extra {
            feet: steps,
            ..Extra::default()
        };
        scene.parts_with(&gpu, &pipelines, 4096, extra)
    };
    let (parts, found) = parts_of(&steps);
    assert_eq!(found as usize, parts.len());
    let mut known = Vec::new();
    for step in &steps {
        for index in 0..foot_drop_count(step.strength) {
            let (drop, from) = foot_drop(step.strength, step.key, index);
            let now = drop.place_m(step.age_s);
            if now.y >= 0.0 {
                let before = drop.place_m((step.age_s - scene.exposure_s).max(0.0));
                known.push((
                    scene.pixel(step.place_m + from + now),
                    scene.pixel(step.place_m + from + before),
                    drop.diameter_mm,
                ));
            }
        }
    }
    let same = |a: &(Vec2, Vec2), b: &(Vec2, Vec2, f32)| (a.0 - b.0).length() < 0.5 && (a.1 - b.1).length() < 0.5;
    let drawn = drops(&parts);
    assert!(drawn.iter().all(|drop| known.iter().any(|own| same(drop, own))));
    let large: Vec<_> = known.iter().filter(|own| own.2 > 1.5).collect();
    let missed = large
        .iter()
        .filter(|own| !drawn.iter().any(|drop| same(drop, own)))
        .count();
    assert!(large.len() > 30 && missed == 0, "{missed} of {}", large.len());
    assert!(
        drawn
            .iter()
            .all(|(head, _)| head.cmpge(Vec2::ZERO).all() && head.cmple(SIZE).all())
    );
    // The young step's sheet stands, the older one's is gone.
    assert_eq!(parts.iter().filter(|part| part.form[0] == 1.0).count(), 1);
    // All have landed by the end, and no list of steps is drawn beyond its bound.
    let (late, _) = parts_of(&[step(0.1, FOOT_SPLASH_S, 1.0, 5)]);
    assert!(late.is_empty(), "{} drops still fly", late.len());
    let crowd: Vec<StepSplash> = (0..20).map(|i| step(0.0, 0.09, 1.0, i)).collect();
    let (many, _) = parts_of(&crowd);
    assert!(many.len() <= MAX_FEET * (FOOT_DROPS as usize + 1) && many.len() > 300);
    // Nobody steps: nothing.
    assert_eq!(parts_of(&[]).1, 0);
}
