//! The shader's crowns and thrown drops are the CPU's.

use glam::Vec3;
use rain_core::hash::{pcg, pcg3d, unit_f32};
use rain_core::splash::{
    Impact, SecondaryDrop, Splash, crown_height_m, crown_life_s, crown_radius_m_f32, crown_seen_s, secondary_drop,
    splash_excess, splash_excess_f32,
};

use crate::device::{device, kernel, library};

/// Diameter mm, speed m/s, film mm, time s.
fn impacts() -> Vec<[f32; 4]> {
    let mut input = Vec::new();
    for i in 0..4000_u32 {
        let [a, b, c] = pcg3d([i, 1, 2]).map(unit_f32);
        let film = [0.0, 0.01, 0.1, 0.5, 2.0, 30.0][i as usize % 6];
        input.push([0.5 + 5.5 * a, 2.0 + 9.0 * b, film, 0.03 * c]);
    }
    input
}

#[test]
fn crowns_are_the_cpus() {
    let Some(gpu) = device() else { return };
    let body = "let v = input[i];
    let excess = rain_splash_excess(v.x, v.y, v.z);
    output[i] = vec4<f32>(excess, rain_crown_radius(v.x, v.y, v.z, v.w), rain_crown_height(v.x, excess, v.w),
        rain_crown_seen(v.x, v.w, 0.0166));";
    let input = impacts();
    let found: Vec<[f32; 4]> = gpu.compute(&kernel(&library(), "vec4<f32>", "vec4<f32>", body), &input, &[]);
    for ([d, speed, film, time], [excess, radius, height, seen]) in input.iter().copied().zip(found) {
        let known = splash_excess_f32(d, speed, film);
        assert!(
            (excess / known - 1.0).abs() < 1e-4,
            "{d} {speed} {film}: {excess}, not {known}"
        );
        let known = crown_radius_m_f32(d, speed, film, time);
        assert!(
            (radius - known).abs() <= 1e-5 * known + 1e-9,
            "{d} {speed} {film} {time}: {radius}, not {known}"
        );
        // Just above the threshold the height rises as a root, and single precision shows.
        if !(0.99..1.01).contains(&excess) {
            let known = crown_height_m(d.into(), speed.into(), film.into(), time.into());
            assert!(
                (f64::from(height) - known).abs() < 1e-4 * 1e-3 * f64::from(d),
                "{d} {speed} {film} {time}"
            );
        }
        let known = crown_seen_s(d.into(), time.into(), 0.0166_f32.into());
        assert!(
            (f64::from(seen) - known).abs() < 1e-7,
            "{d} {time}: {seen}, not {known}"
        );
    }
    let life: Vec<[f32; 4]> = gpu.compute(
        &kernel(
            &library(),
            "vec4<f32>",
            "vec4<f32>",
            "output[i] = vec4<f32>(rain_crown_life(input[i].x));",
        ),
        &input,
        &[],
    );
    for (v, life) in input.iter().zip(life) {
        assert!((f64::from(life[0]) / crown_life_s(v[0].into()) - 1.0).abs() < 1e-5);
    }
    // Another film is found.
    let bent = impacts()
        .iter()
        .filter(|v| splash_excess(v[0].into(), v[1].into(), f64::from(v[2]) * 1.05 + 0.01) > 0.0)
        .count();
    assert_eq!(bent, input.len());
}

#[test]
fn single_hashes_are_bit_equal() {
    let Some(gpu) = device() else { return };
    let input: Vec<u32> = (0..4096).map(|i: u32| i.wrapping_mul(0x9e37_79b9)).collect();
    let found: Vec<u32> = gpu.compute(
        &kernel(&library(), "u32", "u32", "output[i] = rain_pcg(input[i]);"),
        &input,
        &[],
    );
    assert!(input.iter().zip(found).all(|(word, found)| pcg(*word) == found));
}

#[test]
fn thrown_drops_are_the_cpus() {
    let Some(gpu) = device() else { return };
    let mut input: Vec<[u32; 4]> = Vec::new();
    let mut impacts = Vec::new();
    for i in 0..2000_u32 {
        let [a, b, c] = pcg3d([i, 9, 4]).map(unit_f32);
        let normal = Vec3::new(a - 0.5, 0.6 + b, c - 0.5).normalize();
        impacts.push(Impact {
            diameter_mm: 1.0 + 4.0 * b,
            velocity_m_s: Vec3::new(3.0 * c, -4.0 - 5.0 * a, -1.0),
            normal,
            film_mm: 0.2,
        });
        input.push([i.wrapping_mul(77), i ^ 5, 3, 0]);
    }
    let numbers: Vec<f32> = impacts
        .iter()
        .flat_map(|i| {
            let (v, n) = (i.velocity_m_s, i.normal);
            [i.diameter_mm, v.x, v.y, v.z, n.x, n.y, n.z, 0.0]
        })
        .collect();
    let numbers = gpu.buffer(bytemuck::cast_slice(&numbers), wgpu::BufferUsages::STORAGE);
    let bindings = "@group(0) @binding(2) var<storage, read> numbers: array<vec4<f32>>;
struct Out { drop: vec4<f32>, place: vec4<f32> }\n";
    let body = "let a = numbers[2u * i]; let b = numbers[2u * i + 1u];
    let velocity = a.yzw; let normal = b.xyz; let key = input[i].xyz;
    let excess = rain_splash_excess(a.x, -dot(velocity, normal), 0.2);
    let count = rain_thrown_count(excess, key);
    let drop = rain_thrown_drop(a.x, velocity, normal, key, count, 3u);
    output[i] = Out(drop, vec4<f32>(rain_thrown_place(drop.xyz, drop.w, 0.12), f32(count)));";
    let source = kernel(&(library() + bindings), "vec4<u32>", "Out", body);
    let found: Vec<[f32; 8]> = gpu.compute(&source, &input, &[numbers.as_entire_binding()]);
    let mut other_counts = 0;
    for ((impact, key), out) in impacts.iter().zip(&input).zip(found) {
        let key = [key[0], key[1], key[2]];
        let splash = Splash::new(impact, key);
        if splash.count == 0 {
            continue;
        }
        if out[7] != splash.count as f32 {
            other_counts += 1;
            continue;
        }
        let known = secondary_drop(impact, &splash, key, 3);
        let velocity = Vec3::new(out[0], out[1], out[2]);
        let speed = impact.velocity_m_s.length();
        assert!((out[3] / known.diameter_mm - 1.0).abs() < 1e-6);
        assert!(
            (velocity - known.velocity_m_s).length() < 1e-5 * speed,
            "{impact:?}: {velocity}, {known:?}"
        );
        let drop = SecondaryDrop {
            diameter_mm: out[3],
            velocity_m_s: velocity,
        };
        let place = Vec3::new(out[4], out[5], out[6]);
        assert!((place - drop.place_m(0.12)).length() < 1e-5, "{drop:?}: {place}");
    }
    assert!(other_counts < 4, "{other_counts}");
}
