//! Flow of films over slopes, and wheel ruts, in the shader library against their CPU twins.

use rain_core::surface::{RutLanes, film_wave_slope, film_wave_speed_of_mm, film_wave_velocity, film_wavelets};

use crate::device::{device, kernel, library};

/// `expression` over `v = input[i]`, or `None` where there is no device.
fn evaluate(expression: &str, input: &[[f32; 4]]) -> Option<Vec<[f32; 4]>> {
    let gpu = device()?;
    let body = format!("let v = input[i]; output[i] = {expression};");
    Some(gpu.compute(&kernel(&library(), "vec4<f32>", "vec4<f32>", &body), input, &[]))
}

#[test]
fn the_speed_of_running_films_is_the_cpus() {
    let n = 0.0125;
    let mut input = Vec::new();
    for sine in [0.0_f32, 1e-4, 0.01, 0.05, 0.3, 0.9] {
        for angle in [0.0_f32, 0.7, 2.0, -1.3] {
            for film in [-1.0_f32, 0.0, 0.02, 0.5, 2.0] {
                input.push([sine * angle.cos(), (1.0 - sine * sine).sqrt(), sine * angle.sin(), film]);
            }
        }
    }
    let per_slope = film_wave_speed_of_mm(n);
    let call = format!("rain_film_wave_velocity(v.xyz, v.w, {per_slope:?})");
    let slope = format!("rain_film_wave_slope(v.w, length({call}))");
    let Some(found) = evaluate(&format!("vec4<f32>({call}, {slope}, 0.0)"), &input) else {
        return;
    };
    let worst = |factor: f64| {
        let off = input.iter().zip(&found).map(|(i, f)| {
            let [x, y, z, film] = i.map(f64::from);
            let velocity = film_wave_velocity([x, y, z], film * factor, n);
            let speed = velocity[0].hypot(velocity[1]);
            let apart = (velocity[0] - f64::from(f[0])).hypot(velocity[1] - f64::from(f[1]));
            // A normal given in single precision.
            let steep = (film_wave_slope(film * factor, speed) - f64::from(f[2])).abs();
            (apart / speed.max(1e-6)).max(steep)
        });
        off.fold(0.0, f64::max)
    };
    assert!(worst(1.0) < 1e-5, "{}", worst(1.0));
    assert!(worst(1.1) > 1e-2, "another film is found");
    let level: Vec<_> = input
        .iter()
        .zip(&found)
        .filter(|(i, _)| i[0] == 0.0 && i[2] == 0.0)
        .collect();
    assert!(
        !level.is_empty() && level.iter().all(|(_, f)| **f == [0.0; 4]),
        "none runs on level ground"
    );
}

#[test]
fn wavelets_are_the_cpus_at_any_time_and_far_from_the_origin() {
    // Place relative to the eye, time; velocity and footprint by turns.
    for (velocity, footprint) in [([0.1_f32, 0.0_f32], 0.0_f32), ([-0.03, 0.08], 0.02), ([0.0, -0.4], 0.1)] {
        for eye in [[0.0_f32, 0.0], [-37.25, 1000.5]] {
            let input: Vec<[f32; 4]> = (0..3000_u16)
                .map(|i| {
                    let i = f32::from(i);
                    [0.0171 * i - 20.0, (i * 0.37) % 11.0 - 5.0, (i * 0.613) % 64.0, 0.0]
                })
                .collect();
            let call = format!(
                "vec4<f32>(rain_film_wavelets(vec2<f32>({:?}, {:?}), v.xy, v.z, vec2<f32>({:?}, {:?}), {footprint:?}), 0.0)",
                eye[0], eye[1], velocity[0], velocity[1]
            );
            let Some(found) = evaluate(&call, &input) else {
                return;
            };
            let off = |late: f64| {
                let apart = input.iter().zip(&found).map(|(i, f)| {
                    let place = [0, 1].map(|axis| f64::from(eye[axis]) + f64::from(i[axis]));
                    let time = f64::from(i[2]) + late;
                    let wanted = film_wavelets(place, time, velocity.map(f64::from), footprint.into());
                    (wanted[0] - f64::from(f[0])).hypot(wanted[1] - f64::from(f[1]))
                });
                apart.fold(0.0, f64::max)
            };
            assert!(off(0.0) < 5e-3, "{velocity:?} {eye:?}: {}", off(0.0));
            assert!(footprint > 0.05 || off(0.1) > 0.1, "another moment is found");
        }
    }
    // What a pixel cannot show is told, and what it shows and does not adds up to one.
    let input: Vec<[f32; 4]> = (0..40_u8).map(|i| [0.01 * f32::from(i), 0.0, 0.0, 0.0]).collect();
    let call = "vec4<f32>(rain_film_wavelets(vec2<f32>(0.0), vec2<f32>(1.0), 0.3, vec2<f32>(0.1, 0.0), v.x), \
                0.6 * pow(rain_flow_resolved(8.0, v.x), 2.0) + 0.4 * pow(rain_flow_resolved(32.0, v.x), 2.0))";
    let Some(found) = evaluate(call, &input) else {
        return;
    };
    assert!(found.iter().all(|f| (f[2] + f[3] - 1.0).abs() < 1e-6), "{found:?}");
    assert!(found[0][2] == 0.0 && found[39][2] == 1.0);
}

#[test]
fn wheel_ruts_are_the_cpus() {
    let lanes = RutLanes {
        direction_rad: 0.7,
        lane_m: 3.5,
        offset_m: 1.75,
        track_m: 1.5,
        half_width_m: 0.25,
        depth: 0.6,
    };
    let input: Vec<[f32; 4]> = (0..2000_u16)
        .map(|i| [f32::from(i) * 0.0371 - 30.0, f32::from(i % 47) * 0.31 - 7.0, 0.0, 0.0])
        .collect();
    let (cos, sin) = (0.7_f32.cos(), 0.7_f32.sin());
    let call = format!(
        "vec4<f32>(rain_across_and_along(v.xy, vec2<f32>({cos:?}, {sin:?})), \
         rain_rut_height(rain_across_and_along(v.xy, vec2<f32>({cos:?}, {sin:?})).x - 1.75, \
         vec3<f32>(3.5, 0.75, 0.25), 0.6), 0.0)"
    );
    let Some(found) = evaluate(&call, &input) else {
        return;
    };
    let worst = |lanes: RutLanes| {
        let off = input.iter().zip(&found).map(|(i, f)| {
            let [across, along] = lanes.across_and_along(i[0].into(), i[1].into());
            let wanted = [across, along, lanes.height(across)];
            let apart = wanted.iter().zip(f).map(|(w, f)| (w - f64::from(*f)).abs());
            apart.fold(0.0, f64::max)
        });
        off.fold(0.0, f64::max)
    };
    assert!(worst(lanes) < 3e-5, "{}", worst(lanes));
    let other = RutLanes { track_m: 1.6, ..lanes };
    assert!(worst(other) > 1e-2, "another track is found");
}
