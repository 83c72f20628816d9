//! Drops on glass in the shader are the CPU's.

use rain_core::lens::{WiperArm, WiperMode, Wipers, cap_view};

use crate::device::{device, kernel, library};

#[test]
fn what_a_drop_on_glass_shows_is_the_cpus() {
    let Some(gpu) = device() else { return };
    let input: Vec<[f32; 4]> = (0..=200_u16).map(|i| [f32::from(i) / 200.0, 0.0, 0.0, 0.0]).collect();
    let body = "output[i] = vec4<f32>(rain_cap_view(input[i].x), 0.0, 0.0);";
    let found: Vec<[f32; 4]> = gpu.compute(&kernel(&library(), "vec4<f32>", "vec4<f32>", body), &input, &[]);
    let off = |factor: f64| {
        let each = input.iter().zip(&found).map(|(v, f)| {
            let known = cap_view(factor * f64::from(v[0]));
            let turn = (f64::from(f[0]) - known.deviation_rad.tan()).abs();
            turn.max((f64::from(f[1]) - known.transmission).abs())
        });
        each.fold(0.0, f64::max)
    };
    // Differences of products of numbers below 1, in single precision, steepest at the rim.
    assert!(off(1.0) < 4e-6, "{}", off(1.0));
    assert!(off(0.95) > 1e-2, "another slope is found");
}

#[test]
fn wipers_pass_in_the_shader_when_they_pass_on_the_cpu() {
    let Some(gpu) = device() else { return };
    let arm = WiperArm {
        pivot_m: [0.1, -0.4],
        blade_m: [0.1, 0.6],
        turn_rad: [3.0, 0.6],
    };
    for (mode, time_s) in [
        (WiperMode::Slow, 0.5),
        (WiperMode::Fast, 17.3),
        (WiperMode::Interval, 8.2),
    ] {
        let wipers = Wipers {
            arms: [Some(arm), None],
            mode,
            time_s,
        };
        let [period, moving] = mode.cycle_s().expect("a cycle");
        let places: Vec<[f32; 4]> = (0..4096_u32)
            .map(|i| [0.02 * (i % 64) as f32 - 0.6, 0.02 * (i / 64) as f32 - 0.6, 0.0, 0.0])
            .collect();
        let body = format!(
            "output[i] = vec4<f32>(rain_wiped_since(vec4<f32>(0.1, -0.4, 0.1, 0.6), vec2<f32>(3.0, 0.6), \
             vec4<f32>({period:?}, {moving:?}, {:?}, {time_s:?}), input[i].xy));",
            time_s % period
        );
        let found: Vec<[f32; 4]> = gpu.compute(&kernel(&library(), "vec4<f32>", "vec4<f32>", &body), &places, &[]);
        let (mut passed, mut apart) = (0, 0);
        for (place, found) in places.iter().zip(found) {
            let known = wipers.since_s([f64::from(place[0]), f64::from(place[1])]);
            match (known, found[0] >= 0.0) {
                // The arc cosine is steep at the ends of the swing: 1e-6 there is 1e-3 of the cycle.
                (Some(known), true) if (known - f64::from(found[0])).abs() < 2e-3 * period => passed += 1,
                (None, false) => {}
                _ => apart += 1,
            }
        }
        // On the rim of the arc, or at the very place of the blade, the two may fall to either side.
        assert!(passed > 200 && apart <= 4, "{mode:?}: {passed} passed, {apart} apart");
    }
}
