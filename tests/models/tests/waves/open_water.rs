//! The field and the Hankel integral: waves on water without borders.

use rain_core::waves::{Stencil, WaveField, WaveSettings};
use rain_reference::waves as truth;

const S: f64 = 0.01;
const C: f64 = 0.221_431_3;

/// t, r; then ω = ck and the full dispersion relation on 5 mm. Metres and seconds; a height of 1 at the start.
const CHECKS: [(f64, f64, f64, f64); 7] = [
    (0.25, 0.0, -0.036_526, -0.036_151),
    (0.25, 0.05, 0.032_596, 0.036_644),
    (0.5, 0.0, -0.008_366, -0.008_357),
    (0.5, 0.05, -0.012_138, -0.012_072),
    (0.5, 0.10, -0.032_562, -0.028_627),
    (0.5, 0.11, 0.078_712, 0.082_766),
    (0.5, 0.13, 0.030_704, 0.027_783),
];

#[test]
fn the_integral_gives_the_published_heights() {
    for (t, r, shallow, full) in CHECKS {
        let plain = truth::hankel(r, S, 600, |k| (C * k * t).cos());
        assert!((plain - shallow).abs() < 5.1e-7, "{plain} is not {shallow}");
        let dispersive = truth::hankel(r, S, 600, |k| (truth::frequency(k, 0.005) * t).cos());
        assert!((dispersive - full).abs() < 5.1e-7, "{dispersive} is not {full}");
    }
    for (r, height) in [
        (0.0, 0.004_113_1),
        (0.05, 0.004_640_8),
        (0.10, 0.009_868_1),
        (0.11, 0.008_459_6),
    ] {
        // sin(ωt)/ω tends to t.
        let started = truth::hankel(
            r,
            S,
            600,
            |k| if k == 0.0 { 0.5 } else { (C * k * 0.5).sin() / (C * k) },
        );
        assert!((started - height).abs() < 5.1e-8, "{started} is not {height}");
    }
}

/// An undamped field with the Gaussian in its middle after half a second.
fn after_half_a_second(cells: usize, cell_m: f64, stencil: Stencil, velocity: bool) -> WaveField {
    let steps = (C * 0.5 / (stencil.max_courant() * cell_m)).ceil() as u32;
    let settings = WaveSettings {
        cells_x: cells as u32,
        cells_z: cells as u32,
        cell_m,
        speed_m_s: C,
        damping_per_s: 0.0,
        stencil,
        step_ns: Some(500_000_000 / u64::from(steps)),
        ..WaveSettings::default()
    };
    let mut field = WaveField::new(&settings).expect("below the bound");
    let middle = (cells / 2) as f64;
    let gauss: Vec<f32> = (0..cells * cells)
        .map(|index| {
            let (x, z) = ((index % cells) as f64 - middle, (index / cells) as f64 - middle);
            (-0.5 * (x * x + z * z) * (cell_m / S).powi(2)).exp() as f32
        })
        .collect();
    if velocity {
        field.set_state(&[], &gauss).expect("finite");
    } else {
        field.set_state(&gauss, &[]).expect("finite");
    }
    field.step(steps);
    field
}

/// Relative L2 error on r ≤ 0.16 m along the axis and the diagonal.
fn errors(cell_m: f64, stencil: Stencil) -> [f64; 2] {
    let cells = (0.4 / cell_m) as usize | 1;
    let field = after_half_a_second(cells, cell_m, stencil, false);
    let middle = cells / 2;
    [(1, 0), (1, 1)].map(|(dx, dz)| {
        let step = cell_m * f64::from((dx + dz) as u8).sqrt();
        let (mut error, mut norm) = (0.0, 0.0);
        for k in 0..=(0.16 / step) as usize {
            let exact = truth::hankel(k as f64 * step, S, 200, |k| (C * k * 0.5).cos());
            let value = f64::from(field.heights()[(middle + k * dz) * cells + middle + k * dx]);
            error += (value - exact).powi(2);
            norm += exact * exact;
        }
        (error / norm).sqrt()
    })
}

#[test]
fn halving_the_cell_quarters_the_error() {
    let runs = [0.004, 0.002, 0.001].map(|cell| errors(cell, Stencil::FivePoint));
    for (errors, published) in runs.iter().zip([[9.1e-2, 2.2e-2], [2.3e-2, 5.1e-3], [5.6e-3, 1.2e-3]]) {
        for (error, published) in errors.iter().zip(published) {
            assert!((error / published - 1.0).abs() < 0.12, "{error} is not {published}");
        }
    }
    for pair in runs.windows(2) {
        for direction in [0, 1] {
            let order = (pair[0][direction] / pair[1][direction]).log2();
            assert!((1.9..2.3).contains(&order), "order {order} in direction {direction}");
        }
    }
    // Nine points are the same in both directions, not better.
    let [axis, diagonal] = errors(0.002, Stencil::NinePoint);
    assert!((axis / diagonal - 1.0).abs() < 0.2, "{axis} and {diagonal}");
    assert!(diagonal > runs[1][1]);
}

#[test]
fn a_start_with_velocity_is_second_order_too() {
    let exact = truth::hankel(
        0.1,
        S,
        600,
        |k| if k == 0.0 { 0.5 } else { (C * k * 0.5).sin() / (C * k) },
    );
    let errors = [(101, 0.004), (201, 0.002), (401, 0.001)].map(|(cells, cell)| {
        let field = after_half_a_second(cells, cell, Stencil::FivePoint, true);
        let at = cells / 2 * cells + cells / 2 + (0.1 / cell).round() as usize;
        (f64::from(field.heights()[at]) / exact - 1.0).abs()
    });
    assert!(errors[2] < 2e-3, "{errors:?}");
    for pair in errors.windows(2) {
        assert!(pair[0] / pair[1] > 3.0, "{errors:?}");
    }
}
