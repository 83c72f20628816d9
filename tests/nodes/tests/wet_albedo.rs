//! The shader's darkening of wet bodies is Lekner & Dorf's.

use crate::device::{device, kernel, library};

/// Dry and wet reflectance, from the table of `docs/physics.md` (Lekner & Dorf 1988, n = 1.333 over 1.55).
const TABLE: [(f32, f32); 10] = [
    (0.05, 0.02461),
    (0.10, 0.05056),
    (0.15, 0.07795),
    (0.20, 0.10691),
    (0.30, 0.17009),
    (0.40, 0.24139),
    (0.50, 0.32247),
    (0.60, 0.41546),
    (0.80, 0.64929),
    (0.95, 0.88491),
];

#[test]
fn wet_albedo_is_the_table_of_lekner_and_dorf_and_a_half_dark_formula_is_found() {
    let Some(gpu) = device() else { return };
    let dry: Vec<[f32; 4]> = TABLE.iter().map(|(d, _)| [*d, 1.0, 0.0, 0.0]).collect();
    let run = |function: &str| {
        let body = format!("output[i] = vec4<f32>({function}(input[i].xyz), 0.0);");
        gpu.compute::<_, [f32; 4]>(&kernel(&library(), "vec4<f32>", "vec4<f32>", &body), &dry, &[])
    };
    let off = |found: &[[f32; 4]]| {
        TABLE
            .iter()
            .zip(found)
            .map(|((_, wet), f)| (f[0] - wet).abs())
            .fold(0.0, f32::max)
    };
    let found = run("rain_wet_albedo");
    // The table has five digits.
    assert!(off(&found) < 2e-5, "{found:?}");
    // The ends: white loses the surface's reflection alone, black stays black.
    assert!(
        found
            .iter()
            .all(|f| (f[1] - 0.979_627).abs() < 1e-5 && f[2].abs() < 1e-6)
    );
    assert!(
        off(&run("0.5 * ")) > 0.01,
        "half of the dry albedo passes for the formula"
    );
}
