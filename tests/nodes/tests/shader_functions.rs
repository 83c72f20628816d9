//! Small functions of the shader library against their CPU twins, closed forms and integrals.

use rain_core::optics::disc_share_within;
use rain_core::rainfall::contrast_gain;
use rain_core::surface::{closed_film_share, film_roughness};

use crate::device::{device, kernel, library};

/// `function` of the library over four numbers each, or `None` where there is no device.
fn evaluate(function: &str, input: &[[f32; 4]]) -> Option<Vec<[f32; 4]>> {
    let gpu = device()?;
    let body = format!("let v = input[i]; output[i] = {function};");
    Some(gpu.compute(&kernel(&library(), "vec4<f32>", "vec4<f32>", &body), input, &[]))
}

/// `count` even steps from `from` to `to`, both ends included.
fn steps(from: f32, to: f32, count: u16) -> impl Iterator<Item = f32> {
    (0..=count).map(move |i| from + (to - from) * f32::from(i) / f32::from(count))
}

#[test]
fn contrast_is_the_cpus_gain() {
    let input: Vec<[f32; 4]> = [1.0, 2.0, 4.0, 6.0, 32.0]
        .into_iter()
        .flat_map(|gain| steps(0.0, 1.0, 64).map(move |opacity| [opacity, gain, 0.0, 0.0]))
        .collect();
    let Some(found) = evaluate("vec4<f32>(rain_contrast(v.x, v.y))", &input) else {
        return;
    };
    let off = |factor: f64| {
        input
            .iter()
            .zip(&found)
            .map(|(i, f)| (f64::from(f[0]) - contrast_gain(i[0].into(), factor * f64::from(i[1]))).abs())
            .fold(0.0, f64::max)
    };
    assert!(off(1.0) < 2e-6, "{}", off(1.0));
    assert!(off(1.05) > 1e-3, "a wrong gain is found");
}

#[test]
fn a_strip_covers_its_width_wherever_it_lies() {
    // Pixel centres 1 px apart across a strip whose axis lies at v.x: their coverage adds up to the width.
    let input: Vec<[f32; 4]> = [1.0, 1.5, 2.0, 3.7]
        .into_iter()
        .flat_map(|width| steps(-0.5, 0.5, 20).map(move |axis| [axis, width, 0.0, 0.0]))
        .collect();
    let sum = (-6..=6)
        .map(|pixel| format!("rain_strip(f32({pixel}) - v.x, v.y)"))
        .collect::<Vec<_>>()
        .join(" + ");
    let Some(found) = evaluate(&format!("vec4<f32>({sum})"), &input) else {
        return;
    };
    for (i, f) in input.iter().zip(&found) {
        assert!((f[0] - i[1]).abs() < 1e-5, "{i:?}: {f:?}");
    }
}

#[test]
fn a_drop_spreads_light_as_a_sphere_does() {
    const STEPS: u16 = 2000;
    let angles: Vec<[f32; 4]> = steps(0.0, 1.1, STEPS).map(|theta| [theta, 0.0, 0.0, 0.0]).collect();
    let Some(found) = evaluate("vec4<f32>(rain_drop_phase(v.x))", &angles) else {
        return;
    };
    let (mut share, mut compared) = (0.0, 0);
    for (pair, values) in angles.windows(2).zip(found.windows(2)) {
        let (a, b) = (f64::from(pair[0][0]), f64::from(pair[1][0]));
        let mean = 0.5 * (f64::from(values[0][0]) * a.sin() + f64::from(values[1][0]) * b.sin());
        share += core::f64::consts::TAU * mean * (b - a);
        let degrees = b.to_degrees();
        if (10.0..=60.0).contains(&degrees) {
            let sphere = disc_share_within(b, 1.333);
            assert!(
                (share / sphere - 1.0).abs() < 0.08,
                "within {degrees} degrees: {share}, a sphere {sphere}"
            );
            compared += 1;
        }
    }
    assert!(compared > 1000, "{compared}");
}

#[test]
fn a_drop_in_even_light_shows_what_it_does_not_lose() {
    let input = [
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 3.0],
    ];
    let function = "vec4<f32>(rain_drop_radiance(vec3<f32>(v.x), vec3<f32>(v.y), vec3<f32>(v.z), v.w), 0.0)";
    let Some(found) = evaluate(function, &input) else {
        return;
    };
    // Ahead 88.4 %, behind 6.6 %; a sun behind the eye: the reflected share over all directions, and hardly more.
    for (f, wanted) in found
        .iter()
        .zip([0.884, 0.066, 0.95, 0.066 / (4.0 * core::f32::consts::PI)])
    {
        assert!((f[0] - wanted).abs() < 1e-4, "{f:?}, not {wanted}");
    }
}

#[test]
fn clearance_grows_with_the_slope_and_ends() {
    // 1024 texels over 60 m; v.x is the angle of the surface from level.
    let input: Vec<[f32; 4]> = steps(0.0, 1.57, 40).map(|angle| [angle, 0.0, 0.0, 0.0]).collect();
    let function = "vec4<f32>(rain_exposure_bias(CoverParams(vec2<f32>(0.0), vec2<f32>(0.0), 1.0 / 60.0, 0.0, 1.0, \
                    0.0, 0.0, 0.0, 1024.0, 1.0), vec3<f32>(sin(v.x), cos(v.x), 0.0)))";
    let Some(found) = evaluate(function, &input) else {
        return;
    };
    assert!((found[0][0] - 0.03).abs() < 1e-6);
    for (i, f) in input.iter().zip(&found) {
        let slope = i[0].sin() / i[0].cos().max(0.15);
        let wanted = 0.03 + (2.5 * 60.0 / 1024.0 * slope).min(0.6);
        assert!((f[0] - wanted).abs() < 1e-4, "{i:?}: {f:?}, not {wanted}");
    }
    assert!((found.last().expect("forty angles")[0] - 0.63).abs() < 1e-6);
}

#[test]
fn a_film_closes_above_the_texture() {
    // Water level and texture depth in mm; exposure.
    let mut input: Vec<[f32; 4]> = steps(0.0, 3.0, 60).map(|level| [level, 0.8, 0.5, 0.0]).collect();
    input.extend(steps(0.0, 0.2, 60).map(|level| [level, 0.05, 1.0, 0.0]));
    let function = "vec4<f32>(rain_point_film(vec4<f32>(1.0, v.x, v.y, 0.0), v.z))";
    let Some(found) = evaluate(function, &input) else {
        return;
    };
    for (i, f) in input.iter().zip(&found) {
        let wanted = closed_film_share(f64::from(i[0] * i[2]), f64::from(i[1]));
        assert!((f64::from(f[0]) - wanted).abs() < 1e-5, "{i:?}: {f:?}, not {wanted}");
    }
    assert!(found[0][0] == 0.0 && found[59][0] == 1.0);
}

#[test]
fn the_roughness_under_a_film_is_the_cpus() {
    // Perceptual roughness of the bare ground and of the film; film over a texture of 1 mm.
    let mut input = Vec::new();
    for dry in [0.2_f32, 0.45, 0.9, 1.0] {
        for water in [0.05_f32, 0.16, 0.22] {
            input.extend(steps(0.0, 2.0, 30).map(|film| [dry, water, film, 0.0]));
        }
    }
    let function = "vec4<f32>(rain_film_roughness(v.x, v.y, rain_closed_film(v.z, 1.0)))";
    let Some(found) = evaluate(function, &input) else {
        return;
    };
    for ([dry, water, film, _], f) in input.into_iter().zip(&found) {
        let square = |x: f32| f64::from(x) * f64::from(x);
        let wanted = film_roughness(square(dry), square(water), film.into(), 1.0).sqrt();
        assert!(
            (f64::from(f[0]) - wanted).abs() < 1e-5,
            "{dry} {water} {film}: {} not {wanted}",
            f[0]
        );
    }
}
