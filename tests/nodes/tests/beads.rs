//! Drops on paint and glass in the shader library against their CPU twins.

use rain_core::surface::{BEAD_CELLS_M, Beads, bead_at, trickle_at};

use crate::device::{device, kernel, library};

fn evaluate(expression: &str, input: &[[f32; 4]]) -> Option<Vec<[f32; 4]>> {
    let gpu = device()?;
    let body = format!("let v = input[i]; output[i] = {expression};");
    Some(gpu.compute(&kernel(&library(), "vec4<f32>", "vec4<f32>", &body), input, &[]))
}

/// Points of which at most this share may differ: those beside a border, which single precision puts on the other side.
const BESIDE_A_BORDER: f64 = 0.002;

fn apart(wanted: &Beads, found: [f32; 4]) -> f64 {
    let [x, y, cover, _] = found.map(f64::from);
    (wanted.slope[0] - x)
        .abs()
        .max((wanted.slope[1] - y).abs())
        .max((wanted.cover - cover).abs())
}

fn share_apart(input: &[[f32; 4]], found: &[[f32; 4]], wanted: impl Fn([f64; 4]) -> Beads) -> f64 {
    let differing = input
        .iter()
        .zip(found)
        .filter(|(i, f)| apart(&wanted(i.map(f64::from)), **f) > 0.02)
        .count();
    differing as f64 / input.len() as f64
}

#[test]
fn drops_lie_where_the_cpu_puts_them() {
    let input: Vec<[f32; 4]> = (0..20_000_u16)
        .map(|i| {
            let i = f32::from(i);
            [
                (0.000_37 * i) % 0.5 - 0.25,
                (0.001_13 * i) % 0.4 - 0.2,
                (0.1 * i) % 1.0,
                0.0,
            ]
        })
        .collect();
    for lattice in 0..BEAD_CELLS_M.len() {
        let Some(found) = evaluate(
            &format!("vec4<f32>(rain_bead_at(v.xy, {lattice}u, 77u, v.z), 0.0)"),
            &input,
        ) else {
            return;
        };
        let off = |seed: u32| share_apart(&input, &found, |[x, y, wet, _]| bead_at([x, y], lattice, seed, wet));
        assert!(off(77) < BESIDE_A_BORDER, "lattice {lattice}: {}", off(77));
        assert!(off(78) > 0.1, "another seed has other drops: {}", off(78));
        let covered = found.iter().filter(|f| f[2] > 0.0).count();
        assert!(covered > 1000, "{covered} points lie under drops");
    }
}

#[test]
fn trickles_are_the_cpus_at_any_time() {
    let input: Vec<[f32; 4]> = (0..20_000_u16)
        .map(|i| {
            let i = f32::from(i);
            [
                (0.000_37 * i) % 2.0 - 1.0,
                (0.001_13 * i) % 1.5 - 0.75,
                (0.311 * i) % 512.0,
                1.0 - (0.0371 * i) % 0.5,
            ]
        })
        .collect();
    let Some(found) = evaluate("vec4<f32>(rain_trickle_at(v.xy, v.z, 5u, v.w), 0.0)", &input) else {
        return;
    };
    let off = |late: f64| {
        share_apart(&input, &found, |[x, y, time, wet]| {
            trickle_at([x, y], time + late, 5, wet)
        })
    };
    assert!(off(0.0) < BESIDE_A_BORDER, "{}", off(0.0));
    assert!(off(0.2) > 2.0 * BESIDE_A_BORDER, "another moment differs: {}", off(0.2));
}

#[test]
fn what_a_pixel_cannot_show_is_told_as_hidden() {
    let input: Vec<[f32; 4]> = (0..60_u8).map(|i| [0.0001 * f32::from(i), 0.0, 0.0, 0.0]).collect();
    let call = "rain_beads(vec2<f32>(0.1234, 0.4), v.x, 1.0, 3u, 1.0, 0.0)";
    let Some(found) = evaluate(call, &input) else {
        return;
    };
    assert_eq!(found[0][3], 0.0, "near, all of them are seen");
    assert!(found.windows(2).all(|w| w[1][3] >= w[0][3]), "{found:?}");
    let far = found[found.len() - 1];
    assert_eq!([far[0], far[1], far[2]], [0.0; 3]);
    // Of both lattices, by the mean squares of their radii.
    assert!(
        (far[3] - (1.0 - (1.0 - 0.2171) * (1.0 - 0.1882))).abs() < 1e-5,
        "{}",
        far[3]
    );
    let dry = evaluate("rain_beads(vec2<f32>(v.x, 0.4), 0.0002, 1.0, 3u, 0.0, 1.0)", &input).unwrap_or_default();
    assert!(dry.iter().all(|f| *f == [0.0; 4]), "none on what is dry");
}
