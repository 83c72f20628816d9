//! The library's rays through a drop, its swing and its outline are the CPU's.

use glam::{Vec2, Vec3};
use rain_core::hash::{pcg3d, unit_f32};
use rain_core::optics::{
    WATER_INDEX, drop_glint, light_lobe, outline_heights, outline_radius, swing_at, swinging_body, time_inside,
};

use crate::device::{device, kernel, library};

/// A number in [−1, 1].
fn number(i: u32, k: u32) -> f32 {
    2.0 * unit_f32(pcg3d([i, k, 77])[0]) - 1.0
}

fn vector(i: u32, k: u32) -> Vec3 {
    Vec3::new(number(i, k), number(i, k + 1), number(i, k + 2))
}

#[test]
fn rays_through_a_near_drop_are_the_cpus() {
    let Some(gpu) = device() else { return };
    let (mut input, mut bodies): (Vec<[[f32; 4]; 3]>, Vec<_>) = (Vec::new(), Vec::new());
    for i in 0..8000 {
        let body = swinging_body(3.0 + 3.0 * number(i, 0), 0.2 * number(i, 1));
        let (Some(view), through, Some(light)) = (
            vector(i, 10).try_normalize(),
            vector(i, 20),
            vector(i, 30).try_normalize(),
        ) else {
            continue;
        };
        input.push([
            [view.x, view.y, view.z, body.upper()],
            [through.x, through.y, through.z, body.lower()],
            light.extend(0.0).to_array(),
        ]);
        bodies.push(body);
    }
    let source = kernel(
        &(library()
            + "struct In { view: vec4<f32>, through: vec4<f32>, light: vec4<f32> }\n\
               struct Out { normal: vec4<f32>, rays: BodyRays, glint: vec4<f32> }\n"),
        "In",
        "Out",
        "let h = vec2<f32>(input[i].view.w, input[i].through.w);
        let view = input[i].view.xyz;
        let normal = rain_body_enter(h, input[i].through.xyz, view);
        output[i].normal = vec4<f32>(normal, 0.0);
        output[i].rays = rain_body_rays(h, view, normal);
        output[i].glint = vec4<f32>(rain_glint(output[i].rays, input[i].light.xyz, 30.0));",
    );
    let found: Vec<[[f32; 4]; 5]> = gpu.compute(&source, &input, &[]);
    let (mut normals, mut directions, mut shares, mut glints) = (0.0_f32, 0.0_f32, 0.0_f32, 0.0_f32);
    let mut compared = 0;
    for ((given, body), found) in input.iter().zip(&bodies).zip(&found) {
        let xyz = |v: &[f32; 4]| Vec3::from_slice(&v[..3]);
        let view = xyz(&given[0]);
        let Some(normal) = body.enter(xyz(&given[1]), view) else {
            // Beside the body: the normal of its rim.
            assert!(xyz(&found[0]).is_normalized(), "{given:?}: {found:?}");
            continue;
        };
        if -normal.dot(view) < 0.1 {
            continue;
        }
        normals = normals.max(xyz(&found[0]).distance(normal));
        let rays = body.rays::<3>(view, normal, WATER_INDEX).expect("unit vectors");
        // Right at the angle of total reflection shares rise vertically.
        if (rays[1].weight - found[2][3]).abs() > 1e-3 {
            assert!(rays[1].weight < 0.4, "{rays:?} {found:?}");
            continue;
        }
        compared += 1;
        for (ray, found) in rays.iter().zip(&found[1..]) {
            shares = shares.max((ray.weight - found[3]).abs());
            if ray.weight > 1e-2 {
                directions = directions.max(ray.direction.distance(xyz(found)));
            }
        }
        glints = glints.max((drop_glint(&rays, xyz(&given[2]), 30.0) - found[4][0]).abs());
    }
    assert!(compared > 2500, "{compared}");
    assert!(normals < 1e-5, "{normals}");
    assert!(directions < 1e-4 && shares < 1e-4, "{directions} {shares}");
    assert!(glints < 1e-3, "{glints}");
}

#[test]
fn swing_outline_and_crossing_of_a_near_drop_are_the_cpus() {
    let Some(gpu) = device() else { return };
    let input: Vec<[[f32; 4]; 3]> = (0..6000)
        .map(|i| {
            [
                [
                    3.2 + 3.2 * number(i, 0),
                    0.5 + 0.5 * number(i, 1),
                    100.0 * number(i, 2),
                    5.0 + 4.0 * number(i, 3),
                ],
                [
                    1.2 * number(i, 4),
                    1.2 * number(i, 5),
                    0.01 + 3.0 * number(i, 6).abs(),
                    number(i, 7),
                ],
                [number(i, 8), 20.0 + 19.0 * number(i, 9), number(i, 10), 0.0],
            ]
        })
        .collect();
    let source = kernel(
        &(library()
            + "struct In { drop: vec4<f32>, point: vec4<f32>, lobe: vec4<f32> }\n\
               struct Out { swing: vec4<f32>, outline: vec4<f32>, times: vec4<f32> }\n"),
        "In",
        "Out",
        "let d = input[i].drop; let p = input[i].point; let l = input[i].lobe;
        let deflection = 0.2 * l.z;
        let body = rain_swinging_body(d.x, deflection);
        output[i].swing = vec4<f32>(rain_swing(d.x, d.y, d.z, d.w), body, rain_lobe(l.x, l.y));
        let outline = rain_outline_heights(body, l.x);
        output[i].outline = vec4<f32>(outline, rain_outline_radius(outline), 0.0);
        output[i].times = vec4<f32>(rain_time_inside(p.xy, p.zw, outline), 0.0, 0.0);",
    );
    let found: Vec<[[f32; 4]; 3]> = gpu.compute(&source, &input, &[]);
    let mut worst = [0.0_f32; 5];
    let (mut crossed, mut differ) = (0, 0);
    for (given, found) in input.iter().zip(&found) {
        let [d, p, l] = given;
        let swing = swing_at(d[0].into(), d[1].into(), d[2].into(), d[3].into()) as f32;
        let body = swinging_body(d[0], 0.2 * l[2]);
        let outline = outline_heights(body, l[0]);
        let mut see = |k: usize, off: f32| worst[k] = worst[k].max(off.abs());
        see(0, found[0][0] - swing);
        see(1, found[0][1] - body.upper());
        see(1, found[0][2] - body.lower());
        see(2, found[0][3] / light_lobe(l[0], l[1]) - 1.0);
        see(3, found[1][0] - outline[0]);
        see(3, found[1][1] - outline[1]);
        see(3, found[1][2] - outline_radius(outline));
        match time_inside(Vec2::new(p[0], p[1]), Vec2::new(p[2], p[3]), outline) {
            Some([from, to]) if to - from > 1e-2 => {
                crossed += 1;
                let speed = Vec2::new(p[2], p[3]).length();
                see(4, (found[2][0] - from) * speed);
                see(4, (found[2][1] - to) * speed);
            }
            Some(_) => {}
            None => differ += i32::from(found[2][1] - found[2][0] > 1e-2),
        }
    }
    assert!(crossed > 2000 && differ == 0, "{crossed} {differ}");
    // 1e-3 turns at the largest amplitude, 0.15.
    assert!(worst[0] < 1e-3, "{worst:?}");
    assert!(worst[1] < 1e-5 && worst[2] < 1e-4 && worst[3] < 1e-5, "{worst:?}");
    // At the rim the square root magnifies rounding.
    assert!(worst[4] < 1e-4, "{worst:?}");
}
