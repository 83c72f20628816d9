//! The shader library's water against its CPU twins: what artists place, and how standing water looks.

use rain_core::surface::artist_look::{
    crack_water, drenched_share, nguyenova_puddle_amount, painted_puddle_water, screen_blend,
};
use rain_core::surface::{Water, mud_phase, puddle_map, under_water};

use crate::device::{device, kernel, library};

/// `expression` over `v = input[i]`, or `None` where there is no device.
fn evaluate(expression: &str, input: &[[f32; 4]]) -> Option<Vec<[f32; 4]>> {
    let gpu = device()?;
    let body = format!("let v = input[i]; output[i] = {expression};");
    Some(gpu.compute(&kernel(&library(), "vec4<f32>", "vec4<f32>", &body), input, &[]))
}

/// Every combination of `a` and `b`, with `c` and `d` fixed.
fn grid(a: &[f32], b: &[f32], c: f32, d: f32) -> Vec<[f32; 4]> {
    a.iter().flat_map(|&a| b.iter().map(move |&b| [a, b, c, d])).collect()
}

const SHARES: [f32; 9] = [-0.5, 0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0, 1.5];

#[test]
fn painted_puddles_are_the_cpus() {
    for margin in [0.0, 0.05, 0.4, 1.0] {
        let input = grid(&SHARES, &SHARES, margin, 0.0);
        let Some(found) = evaluate("vec4<f32>(rain_painted_puddle_water(v.x, v.y, v.z))", &input) else {
            return;
        };
        let off = |shift: f64| {
            let wanted = |i: &[f32; 4]| painted_puddle_water(f64::from(i[0]) + shift, i[1].into(), i[2].into());
            let worst = input
                .iter()
                .zip(&found)
                .map(|(i, f)| (f64::from(f[0]) - wanted(i)).abs());
            worst.fold(0.0, f64::max)
        };
        // A margin of 1e-4 magnifies rounding ten thousand times.
        assert!(off(0.0) < 2e-3, "{margin}: {}", off(0.0));
        assert!(off(0.05) > 0.04, "a level that is off is found");
    }
}

#[test]
fn holes_of_a_height_map_are_the_cpus() {
    let input = grid(&SHARES, &SHARES, 0.0, 0.0);
    let Some(found) = evaluate("vec4<f32>(rain_crack_water(v.x, v.y))", &input) else {
        return;
    };
    for (i, f) in input.iter().zip(&found) {
        assert!(
            (f64::from(f[0]) - crack_water(i[0].into(), i[1].into())).abs() < 1e-6,
            "{i:?}: {f:?}"
        );
    }
}

#[test]
fn noise_puddles_are_the_cpus_by_map_and_height() {
    for (height, drenched) in [(0.0, 0.1), (0.3, 0.1), (0.7, 0.4), (0.3, 0.0)] {
        let input = grid(&SHARES[1..8], &SHARES[1..8], height, drenched);
        let Some(found) = evaluate("vec4<f32>(rain_noise_puddle(v.x, v.y, v.z, v.w), 0.0)", &input) else {
            return;
        };
        let off = |shift: f64| {
            let mut worst = 0.0_f64;
            for (i, f) in input.iter().zip(&found) {
                let [level, map, height, drenched] = i.map(f64::from);
                let blended = screen_blend(map, height + shift);
                let amount = nguyenova_puddle_amount(level, blended);
                let film = drenched_share(level, blended, drenched);
                worst = worst.max((f64::from(f[0]) - amount).abs());
                worst = worst.max(drenched * (f64::from(f[2]) - film).abs());
            }
            worst
        };
        assert!(off(0.0) < 1e-6, "{height} {drenched}: {}", off(0.0));
        assert!(off(0.05) > 0.01, "a height that is off is found");
    }
}

#[test]
fn the_map_of_puddles_is_the_cpus() {
    let input: Vec<[f32; 4]> = (0..4000_u16)
        .map(|i| [f32::from(i) * 0.037 - 70.0, f32::from(i % 61) * 0.19 - 5.0, 0.0, 0.0])
        .collect();
    let Some(found) = evaluate(
        "vec4<f32>(rain_puddle_noise(vec2<f32>(0.0), v.xy, vec2<f32>(1.0), 7u))",
        &input,
    ) else {
        return;
    };
    let off = |seed: u32| {
        let error =
            |(i, f): (&[f32; 4], &[f32; 4])| (f64::from(f[0]) - puddle_map(i[0].into(), i[1].into(), seed)).abs();
        input.iter().zip(&found).map(error).fold(0.0, f64::max)
    };
    // At 300 cells from the origin a single knows its place to 3e-5 of a cell; the steepest map rises by 5 a cell.
    assert!(off(7) < 2e-4, "{}", off(7));
    assert!(off(8) > 0.5, "another seed is found");
}

#[test]
fn detail_normals_are_blended_by_what_lies_aslant() {
    // UDN: r = normalize(n1.xy + n2.xy, n1.z).
    let input = grid(&[-0.4, 0.0, 0.2], &[-0.1, 0.0, 0.3], 0.1, -0.25);
    let Some(found) = evaluate("vec4<f32>(rain_udn(v.xy, v.zw), 0.0, 0.0)", &input) else {
        return;
    };
    for (i, f) in input.iter().zip(&found) {
        let length = (1.0 + i[0] * i[0] + i[1] * i[1]).sqrt();
        let base = [-i[0] / length, -i[1] / length, 1.0 / length];
        for axis in 0..2 {
            let slope = -(base[axis] + i[axis + 2]) / base[2];
            assert!((f[axis] - slope).abs() < 1e-6, "{i:?}: {f:?}, not {slope}");
        }
    }
    let texels = [[0.5, 0.5, 0.0, 0.0], [1.0, 0.5, 0.0, 0.0], [0.5, 1.0, 0.0, 0.0]];
    let Some(found) = evaluate("vec4<f32>(rain_normal_aslant(v.xy), 0.0, 0.0)", &texels) else {
        return;
    };
    assert_eq!(
        found,
        [[0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 0.0]]
    );
}

#[test]
fn noise_puddles_have_no_steps_and_use_the_whole_range() {
    let input: Vec<[f32; 4]> = (0..20_000_u16)
        .map(|i| [f32::from(i) * 0.002 - 20.0, 1.37, 0.0, 0.0])
        .collect();
    let Some(found) = evaluate(
        "vec4<f32>(rain_puddle_noise(vec2<f32>(0.0), v.xy, vec2<f32>(1.0), 7u))",
        &input,
    ) else {
        return;
    };
    let values: Vec<f32> = found.iter().map(|f| f[0]).collect();
    assert!(values.iter().all(|v| (0.0..=1.0).contains(v)));
    let step = values.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f32::max);
    // The steepest octave rises by at most some 4 a unit after the spread.
    assert!(step < 0.03, "{step}");
    let low = values.iter().filter(|v| **v < 0.1).count();
    let high = values.iter().filter(|v| **v > 0.9).count();
    assert!(low > 200 && high > 200, "{low} low, {high} high");
}

const LOOKS: [Water; 3] = [
    Water::CLEAR,
    Water::MUDDY,
    Water {
        absorption_per_m: [0.34, 0.06, 0.01],
        turbidity_per_m: 5.0,
        mud_albedo: [0.30, 0.22, 0.13],
    },
];

#[test]
fn mud_seen_at_an_angle_is_the_cpus() {
    let input = grid(&[-0.5, 0.0, 0.3, 0.66, 0.7, 0.85, 1.0, 2.0], &[0.0], 0.0, 0.0);
    let Some(found) = evaluate("vec4<f32>(rain_mud_phase(v.x))", &input) else {
        return;
    };
    let off = |shift: f64| {
        let worst = input
            .iter()
            .zip(&found)
            .map(|(i, f)| (f64::from(f[0]) / mud_phase(f64::from(i[0]) + shift) - 1.0).abs());
        worst.fold(0.0, f64::max)
    };
    assert!(off(0.0) < 1e-6, "{}", off(0.0));
    assert!(off(0.05) > 0.02, "an angle that is off is found");
}

#[test]
fn ground_under_water_is_the_cpus() {
    let depths = [0.0, 0.001, 0.01, 0.1, 1.0];
    let cosines = [0.0, 0.05, 0.2, 0.5, 0.9, 1.0];
    let mut worst = (0.0_f64, 0.0_f64);
    for water in LOOKS {
        let [r, g, b] = water.absorption_per_m;
        let [mr, mg, mb] = water.mud_albedo;
        let zero = "vec4<f32>(0.0)";
        let look = format!(
            "WaterLook(vec4<f32>({r:?}, {g:?}, {b:?}, 0.0), vec4<f32>({mr:?}, {mg:?}, {mb:?}, {:?}), {zero}, {zero}, {zero}, {zero}, {zero}, {zero})",
            water.turbidity_per_m
        );
        for dry in [0.0, 0.1, 0.4, 1.0] {
            let input = grid(&depths, &cosines, dry, 0.0);
            let expression = format!("vec4<f32>(rain_under_water(vec3<f32>(v.z), {look}, v.x, v.y), 0.0)");
            let Some(found) = evaluate(&expression, &input) else {
                return;
            };
            for (i, f) in input.iter().zip(&found) {
                let [depth, cosine, dry, _] = i.map(f64::from);
                let off = |depth: f64| {
                    let wanted = under_water([dry; 3], &water, depth, cosine);
                    (0..3).map(|c| (f64::from(f[c]) - wanted[c]).abs()).fold(0.0, f64::max)
                };
                worst.0 = worst.0.max(off(depth));
                worst.1 = worst.1.max(off(1.2 * depth));
            }
        }
    }
    assert!(worst.0 < 1e-5, "{}", worst.0);
    assert!(worst.1 > 0.01, "a depth that is off is found: {}", worst.1);
}

#[test]
fn the_bottom_is_where_snell_puts_it() {
    // Angle of the view from straight down, depth.
    let angles: Vec<f32> = (0..28_u8).map(|i| f32::from(i) * 0.05).collect();
    let input = grid(&angles, &[-0.1, 0.0, 0.01, 0.3], 0.0, 0.0);
    let expression =
        "vec4<f32>(rain_refraction_shift(vec3<f32>(sin(v.x) * 0.6, cos(v.x), sin(v.x) * 0.8), v.y), 0.0, 0.0)";
    let Some(found) = evaluate(expression, &input) else {
        return;
    };
    for (i, f) in input.iter().zip(&found) {
        let (angle, depth) = (f64::from(i[0]), f64::from(i[1]).max(0.0));
        let refracted = (angle.sin() / 1.333).asin();
        let run = depth * (angle.tan() - refracted.tan());
        let error = (f64::from(f[0]) - 0.6 * run)
            .abs()
            .max((f64::from(f[1]) - 0.8 * run).abs());
        assert!(error < 1e-5 * (1.0 + run), "{i:?}: {f:?}, not {run}");
    }
}

#[test]
fn a_shift_on_the_ground_is_the_same_in_pixels() {
    // Gradients of a ground seen askew; v is the shift.
    let input = grid(&[-0.02, 0.0, 0.013], &[-0.01, 0.02], 0.0, 0.0);
    let (ddx, ddy) = ([0.01_f32, 0.002_f32], [0.004_f32, -0.03_f32]);
    let call = |most: f32| {
        format!(
            "vec4<f32>(rain_shift_in_pixels(v.xy, vec2<f32>({:?}, {:?}), vec2<f32>({:?}, {:?}), {most:?}), 0.0, 0.0)",
            ddx[0], ddx[1], ddy[0], ddy[1]
        )
    };
    let (Some(found), Some(held)) = (evaluate(&call(100.0), &input), evaluate(&call(0.5), &input)) else {
        return;
    };
    for ((i, f), h) in input.iter().zip(&found).zip(&held) {
        for axis in 0..2 {
            let back = f[0] * ddx[axis] + f[1] * ddy[axis];
            assert!((back - i[axis]).abs() < 1e-6, "{i:?}: {back}");
        }
        assert!(h[0].hypot(h[1]) < 0.5 + 1e-5, "{h:?}");
    }
    let flat = "vec4<f32>(rain_shift_in_pixels(v.xy, vec2<f32>(0.1, 0.1), vec2<f32>(0.2, 0.2), 9.0), 0.0, 0.0)";
    let Some(found) = evaluate(flat, &input) else { return };
    assert!(
        found.iter().all(|f| f == &[0.0; 4]),
        "a ground seen edge on moves nothing"
    );
}

#[test]
fn wind_waves_run_where_they_are_sent_as_fast_and_as_long_as_they_are_told() {
    let zero = "vec4<f32>(0.0)";
    let call = |per_m: f32, [vx, vz]: [f32; 2]| {
        let ambient = format!("vec4<f32>(0.01, {per_m:?}, {vx:?}, {vz:?})");
        format!(
            "vec4<f32>(rain_wind_slopes(WaterLook({zero}, {zero}, {ambient}, {zero}, {zero}, {zero}, {zero}, {zero}), v.xy, v.z), \
             0.0, 0.0)"
        )
    };
    let places = |shift: [f32; 2], time: f32| -> Vec<[f32; 4]> {
        (0..4000_u16)
            .map(|i| {
                let (x, z) = (f32::from(i % 64) * 0.031, f32::from(i / 64) * 0.043);
                [x + shift[0], z + shift[1], time, 0.0]
            })
            .collect()
    };
    // How alike the slopes are here and now, and there and then.
    let alike = |per_m: f32, velocity: [f32; 2], shift: [f32; 2], time: f32| -> Option<f64> {
        let now = evaluate(&call(per_m, velocity), &places([0.0; 2], 3.0))?;
        let then = evaluate(&call(per_m, velocity), &places(shift, 3.0 + time))?;
        let dot = |a: &[[f32; 4]], b: &[[f32; 4]]| -> f64 {
            a.iter().zip(b).map(|(a, b)| f64::from(a[0] * b[0] + a[1] * b[1])).sum()
        };
        Some(dot(&now, &then) / (dot(&now, &now) * dot(&then, &then)).sqrt())
    };
    let velocity = [0.24, -0.18];
    let Some(with) = alike(2.0, velocity, [0.06, -0.045], 0.25) else {
        return;
    };
    let against = alike(2.0, velocity, [-0.06, 0.045], 0.25).expect("a device");
    let across = alike(2.0, velocity, [0.045, 0.06], 0.25).expect("a device");
    assert!(
        with > 0.8 && with > against + 0.3 && with > across + 0.2,
        "{with} {against} {across}"
    );
    // A step of a tenth of the length changes long and short waves alike; the same step changes short ones more.
    let near = |per_m: f32, step: f32| alike(per_m, velocity, [0.8 * step, -0.6 * step], 0.0).expect("a device");
    assert!((near(0.5, 0.1) - near(2.0, 0.025)).abs() < 0.1);
    assert!(near(0.5, 0.1) > near(4.0, 0.1) + 0.3);
}
