//! Water that pours: the shader's fall is the CPU's, drops and jets are where the CPU has them and end on the ground.

use glam::{DVec3, Vec2, Vec3};
use rain_core::hash::{pcg3d, unit_f32};
use rain_core::spout::{Outflow, SpoutFall, jet_diameter_m, spout_fall_f32};
use rain_render::gpu_types::SplashPart;
use rain_render::splash::{SplashGpu, SpoutStream};

use super::scene::{Extra, ROOF, Scene};
use crate::device::{device, kernel, library};

#[test]
fn the_fall_is_the_cpus() {
    let Some(gpu) = device() else { return };
    let input: Vec<[f32; 8]> = (0..3000_u32)
        .map(|i| {
            let [a, b, c] = pcg3d([i, 8, 1]).map(unit_f32);
            let [d, e, _] = pcg3d([i, 9, 1]).map(unit_f32);
            let terminal = if i % 3 == 0 { 100.0 } else { 2.0 + 7.5 * d };
            [
                3.0 * a - 1.5,
                -2.0 * b * b,
                2.0 * c - 1.0,
                terminal,
                12.0 * e - 6.0,
                0.0,
                3.0,
                1.8 * unit_f32(i.wrapping_mul(0x9e37_79b9)),
            ]
        })
        .collect();
    let flat: Vec<[f32; 4]> = input
        .iter()
        .flat_map(|v| [[v[0], v[1], v[2], v[3]], [v[4], v[5], v[6], v[7]]])
        .collect();
    let numbers = gpu.buffer(bytemuck::cast_slice(&flat), wgpu::BufferUsages::STORAGE);
    let bindings = "@group(0) @binding(2) var<storage, read> numbers: array<vec4<f32>>;
struct Out { place: vec4<f32>, more: vec4<f32> }\n";
    let body = "let v = numbers[2u * i]; let w = numbers[2u * i + 1u];
    let place = rain_spout_place(v.xyz, v.w, w.xyz, w.w);
    let time = rain_spout_time(v.xyz, v.w, -place.y);
    output[i] = Out(vec4<f32>(place, time), vec4<f32>(rain_spout_speed(v.xyz, v.w, w.w), f32(input[i]), 0.0, 0.0));";
    let index: Vec<u32> = (0..input.len() as u32).collect();
    let source = kernel(&(library() + bindings), "u32", "Out", body);
    let found: Vec<[f32; 8]> = gpu.compute(&source, &index, &[numbers.as_entire_binding()]);
    for (v, out) in input.iter().zip(found) {
        let (velocity, wind, age) = (Vec3::new(v[0], v[1], v[2]), Vec3::new(v[4], 0.0, v[6]), v[7]);
        let known = spout_fall_f32(velocity, v[3], wind, age);
        let allowed = if v[3] > 50.0 { 2e-4 } else { 2e-5 };
        let place = Vec3::new(out[0], out[1], out[2]);
        assert!((place - known).length() < allowed, "{v:?}: {place}, not {known}");
        // Near the mouth a way of a tenth of a millimetre is a time of milliseconds.
        if known.y < -0.05 {
            assert!((out[3] - age).abs() < 1e-3, "{v:?}: {} s back", out[3]);
        }
        // Quadratic drag: v = v_t (u + tanh τ)/(1 + u tanh τ).
        let (start, slope) = (
            f64::from(-v[1] / v[3]),
            (f64::from(age) * 9.80665 / f64::from(v[3])).tanh(),
        );
        let speed = f64::from(v[3]) * (start + slope) / (1.0 + start * slope);
        assert!(
            (f64::from(out[4]) / speed.max(0.1) - speed / speed.max(0.1)).abs() < 1e-4,
            "{v:?}: {}, {speed}",
            out[4]
        );
    }
}

/// A mouth 3 m over level ground at the scene's x, y, relative to an eye at the scene's default place.
fn mouth(scene: &Scene, at: DVec3, outflow: &Outflow, velocity: Vec3) -> SpoutStream {
    let drop = (!outflow.jets()).then(|| outflow.drop_mm());
    let fall = SpoutFall::new(velocity.as_dvec3(), drop, DVec3::ZERO);
    SpoutStream {
        place_m: (at - scene.eye_m).as_vec3(),
        velocity_m_s: velocity,
        terminal_m_s: fall.terminal_m_s() as f32,
        period_s: (1.0 / outflow.drops_per_s()) as f32,
        released: 1234.25,
        limit_s: 1.6,
        outward: Vec2::X,
        jet_m: outflow.diameter_m as f32,
        breakup_s: outflow.breakup_s as f32,
        drop_mm: outflow.drop_mm() as f32,
        weight: 1.0,
        key: [7, 3],
    }
}

fn parts_of(scene: &Scene, mouths: &[SpoutStream]) -> Option<Vec<SplashPart>> {
    let gpu = device()?;
    let pipelines = SplashGpu::new(&gpu.device);
    let extra = Extra {
        mouths,
        ..Extra::default()
    };
    let (parts, found) = scene.parts_with(&gpu, &pipelines, 4096, extra);
    assert_eq!(found as usize, parts.len());
    Some(parts)
}

fn scene() -> Scene {
    Scene {
        eye_m: DVec3::new(1.2, 7.0, -0.2),
        rain_mm_h: 0.0,
        reach_m: 0.0,
        ..Scene::default()
    }
}

/// Height over the ground of both ends. Infinite reverse-Z, looking down.
fn heights(scene: &Scene, part: &SplashPart) -> [f64; 2] {
    [0, 1].map(|end| scene.eye_m.y - 0.05 / f64::from(part.shape[end]))
}

#[test]
fn drips_fall_where_the_cpu_has_them_and_splash_on_the_ground() {
    let scene = scene();
    let at = DVec3::new(1.0, 3.0, 0.0);
    let outflow = Outflow::of_eave(1e-6).expect("drips");
    assert!(!outflow.jets());
    let stream = mouth(&scene, at, &outflow, Vec3::ZERO);
    let Some(parts) = parts_of(&scene, &[stream]) else {
        return;
    };
    let fall = SpoutFall::new(DVec3::ZERO, Some(outflow.drop_mm()), DVec3::ZERO);
    let landed = fall.time_to_fall_s(3.0);
    let period = f64::from(stream.period_s);
    let ages: Vec<f64> = (0..)
        .map(|k| (0.25 + f64::from(k)) * period)
        .take_while(|age| *age < landed)
        .collect();
    assert!(ages.len() > 8, "{}", ages.len());
    let drops: Vec<_> = parts.iter().filter(|part| part.form[0] == 0.0).collect();
    for age in &ages {
        let height = 3.0 + fall.place_m(*age).y;
        let near = drops.iter().filter(|part| {
            let [head, tail] = heights(&scene, part);
            let before = 3.0 + fall.place_m((age - f64::from(scene.exposure_s)).max(0.0)).y;
            (head - height).abs() < 5e-4 && (tail - before).abs() < 5e-4
        });
        assert_eq!(near.count(), 1, "{age} s: {height} m");
    }
    // What hangs at the mouth has gathered for a quarter of the time.
    let hanging = drops.iter().filter(|part| {
        heights(&scene, part) == [heights(&scene, part)[0]; 2] && (heights(&scene, part)[0] - 3.0).abs() < 1e-3
    });
    assert_eq!(hanging.count(), 1);
    // None lies under the ground; what was thrown flies near it.
    assert!(drops.iter().all(|part| heights(&scene, part)[0] > -1e-3));
    // A crown stands for a fiftieth of a second: at some moment of a period, where it fell.
    let crowned = (0..40).find_map(|i| {
        let shifted = SpoutStream {
            released: 1234.0 + f64::from(i) / 40.0,
            ..stream
        };
        let parts = parts_of(&scene, &[shifted])?;
        parts.into_iter().find(|part| part.form[0] == 1.0)
    });
    let crown = crowned.expect("drops of 5 mm splash");
    let foot = scene.pixel((at.with_y(0.0) - scene.eye_m).as_vec3());
    let off = (Vec2::new(crown.ends[0], crown.ends[1]) - foot).length();
    // Drops part by a centimetre or two.
    assert!(off < 0.03 * Scene::focal_px() / 7.0, "{off} px");
}

#[test]
fn a_jet_goes_its_parabola_thins_and_breaks_into_drops() {
    let scene = scene();
    let at = DVec3::new(0.4, 3.0, 0.0);
    let outflow = Outflow::of_pipe(1.2e-5, 0.005).expect("pours");
    assert!(
        outflow.jets() && (0.05..0.4).contains(&outflow.breakup_s),
        "{outflow:?}"
    );
    let velocity = Vec3::X * outflow.speed_m_s as f32;
    // Four drops to a parcel, so that all that is in the air is drawn.
    let single = mouth(&scene, at, &outflow, velocity);
    let stream = SpoutStream {
        period_s: 4.0 * single.period_s,
        weight: 4.0,
        ..single
    };
    let Some(parts) = parts_of(&scene, &[stream]) else {
        return;
    };
    let fall = SpoutFall::new(velocity.as_dvec3(), None, DVec3::ZERO);
    // Everything in the air lies on the way, seen from above.
    let on_way = |height: f64| {
        let age = fall.time_to_fall_s(3.0 - height);
        (age, scene.pixel((at + fall.place_m(age) - scene.eye_m).as_vec3()))
    };
    let (mut pieces, mut drops) = (Vec::new(), 0);
    for part in parts.iter().filter(|part| part.form[0] == 0.0) {
        let [head, _] = heights(&scene, part);
        if head < 0.3 {
            // Near the ground thrown drops fly, too.
            continue;
        }
        let (age, pixel) = on_way(head);
        let off = (Vec2::new(part.ends[0], part.ends[1]) - pixel).length();
        assert!(
            off < 0.04 * Scene::focal_px() / (7.0 - head as f32),
            "{head}: {off} px off"
        );
        if age < 0.8 * outflow.breakup_s {
            let ends = heights(&scene, part);
            let middle = on_way(0.5 * (ends[0] + ends[1])).0;
            let speed = (fall.place_m(middle + 1e-4) - fall.place_m((middle - 1e-4).max(0.0))).length();
            let speed = speed / (1e-4 + middle.min(1e-4));
            let thin = jet_diameter_m(outflow.diameter_m, outflow.speed_m_s, speed);
            // Below a pixel its width is its coverage.
            let away = 7.0 - 0.5 * (ends[0] + ends[1]);
            let width = f64::from(part.light[3]) * away / f64::from(Scene::focal_px());
            pieces.push((middle / outflow.breakup_s, width / thin));
        } else if age > 1.2 * outflow.breakup_s {
            drops += 1;
        }
    }
    assert!(pieces.len() > 3 && drops > 10, "{} pieces, {drops} drops", pieces.len());
    // It thins by continuity, and swells and shrinks by up to a third before it breaks.
    assert!(
        pieces
            .iter()
            .all(|(share, width)| (width - 1.0).abs() < 0.03 + 0.35 * share / 0.85),
        "{pieces:?}"
    );
    assert!(pieces.iter().any(|(_, width)| (width - 1.0).abs() > 0.05));
    // The pieces join: where one ends the next begins.
    let mut ends: Vec<[f64; 2]> = parts
        .iter()
        .filter(|part| part.form[0] == 0.0)
        .map(|part| heights(&scene, part))
        .filter(|h| on_way(h[1]).0 < 0.8 * outflow.breakup_s)
        .collect();
    ends.sort_by(|a, b| b[0].total_cmp(&a[0]));
    assert!(
        ends.windows(2).all(|pair| (pair[0][1] - pair[1][0]).abs() < 2e-3),
        "{ends:?}"
    );
    assert!((ends[0][0] - 3.0).abs() < 1e-3);
}

#[test]
fn an_eye_under_a_mouth_sees_no_drop_that_is_right_before_it() {
    let scene = Scene {
        eye_m: DVec3::new(1.0, 2.0, 0.0),
        ..scene()
    };
    let outflow = Outflow::of_eave(1.2e-6).expect("drips");
    let stream = mouth(&scene, DVec3::new(1.02, 3.0, 0.0), &outflow, Vec3::ZERO);
    let (mut drawn, mut nearest) = (0, f64::INFINITY);
    for step in 0..40_u8 {
        let shifted = SpoutStream {
            released: 1234.0 + f64::from(step) / 40.0,
            ..stream
        };
        let Some(parts) = parts_of(&scene, &[shifted]) else {
            return;
        };
        for part in parts.iter().filter(|part| part.form[0] == 0.0) {
            let away = 2.0 - heights(&scene, part)[0];
            (drawn, nearest) = (drawn + 1, nearest.min(away));
        }
    }
    // Those farther down are seen, the nearest of them beyond a hand's breadth.
    assert!(drawn > 200 && (0.09..0.2).contains(&nearest), "{drawn}, {nearest} m");
}

#[test]
fn a_mouth_at_the_edge_of_a_roof_pours_past_it_to_the_ground() {
    let scene = scene();
    // Just inside the map's last texels of the roof.
    let roof = ROOF[4];
    let at = DVec3::new(ROOF[0] + 0.01, roof - 0.02, 0.5 * (ROOF[1] + ROOF[3]));
    let outflow = Outflow::of_eave(1e-6).expect("drips");
    let eye = DVec3::new(ROOF[0] - 0.5, 7.0, at.z);
    let scene = Scene { eye_m: eye, ..scene };
    let stream = SpoutStream {
        outward: Vec2::NEG_X,
        limit_s: 3.0,
        ..mouth(&scene, at, &outflow, Vec3::ZERO)
    };
    let Some(parts) = parts_of(&scene, &[stream]) else {
        return;
    };
    let lowest = parts
        .iter()
        .filter(|part| part.form[0] == 0.0)
        .map(|part| heights(&scene, part)[0])
        .fold(9.0, f64::min);
    assert!((-0.01..0.6).contains(&lowest), "{lowest} m");
    // Where nothing is known of the ground it falls as far as it is looked for.
    let beyond = SpoutStream {
        place_m: Vec3::new(2000.0, -1.0, 0.0),
        ..stream
    };
    assert_eq!(
        parts_of(&scene, &[beyond]).map(|parts| parts.len()),
        Some(0),
        "out of reach"
    );
    // Nonsense draws nothing that is not finite.
    let broken = SpoutStream {
        velocity_m_s: Vec3::NAN,
        terminal_m_s: f32::NAN,
        period_s: f32::NAN,
        released: f64::NAN,
        limit_s: f32::NAN,
        jet_m: f32::NAN,
        breakup_s: f32::NAN,
        drop_mm: f32::NAN,
        weight: f32::NAN,
        ..stream
    };
    let parts = parts_of(&scene, &[broken]).expect("a device");
    assert!(parts.iter().all(|part| {
        part.ends
            .iter()
            .chain(&part.shape)
            .chain(&part.light)
            .all(|v| v.is_finite())
    }));
}
