//! Shape and oscillation of a drop.

use crate::numerics::simpson;

/// Beard & Chuang 1987: D in mm, c₀…c₁₀ × 10⁴.
pub const CHUANG: [(f64, [i32; 11]); 9] = [
    (2.0, [-131, -120, -376, -96, -4, 15, 5, 0, -2, 0, 1]),
    (2.5, [-201, -172, -567, -137, 3, 29, 8, -2, -4, 0, 1]),
    (3.0, [-282, -230, -779, -175, 21, 46, 11, -6, -7, 0, 3]),
    (3.5, [-369, -285, -998, -207, 48, 68, 13, -13, -10, 0, 5]),
    (4.0, [-458, -335, -1211, -227, 83, 89, 12, -21, -13, 1, 8]),
    (4.5, [-549, -377, -1421, -240, 126, 110, 9, -31, -16, 4, 11]),
    (5.0, [-644, -416, -1629, -246, 176, 131, 2, -44, -18, 9, 14]),
    (5.5, [-742, -454, -1837, -244, 234, 150, -7, -58, -19, 15, 19]),
    (6.0, [-840, -480, -2034, -237, 297, 166, -21, -72, -19, 24, 23]),
];

/// cₙ of a diameter: linear between rows, as D² below the first.
pub fn cosine_terms(diameter_mm: f64) -> Vec<f64> {
    let value = |row: usize, n: usize| f64::from(CHUANG[row].1[n]) * 1e-4;
    (0..11)
        .map(|n| {
            if diameter_mm <= 2.0 {
                return value(0, n) * (diameter_mm / 2.0).powi(2);
            }
            let d = diameter_mm.min(6.0);
            let row = (0..8).find(|&row| d <= CHUANG[row + 1].0).expect("inside the table");
            let t = (d - CHUANG[row].0) / (CHUANG[row + 1].0 - CHUANG[row].0);
            value(row, n) * (1.0 - t) + value(row + 1, n) * t
        })
        .collect()
}

/// 1 + Σ cₙ cos nθ as printed, not scaled.
pub fn printed_radius(terms: &[f64], theta: f64) -> f64 {
    1.0 + terms
        .iter()
        .enumerate()
        .map(|(n, c)| c * (n as f64 * theta).cos())
        .sum::<f64>()
}

/// Volume of an axisymmetric r(θ) over that of the unit sphere.
pub fn volume(r: impl Fn(f64) -> f64) -> f64 {
    simpson(0.0, core::f64::consts::PI, 400, |theta| {
        0.5 * r(theta).powi(3) * theta.sin()
    })
}

/// r/(D/2) scaled to the sphere's volume.
pub fn scaled_radius(diameter_mm: f64) -> impl Fn(f64) -> f64 {
    let terms = cosine_terms(diameter_mm);
    let scale = volume(|theta| printed_radius(&terms, theta)).powf(-1.0 / 3.0);
    move |theta| scale * printed_radius(&terms, theta)
}

/// Height over width, by looking at many points.
pub fn axis_ratio(r: impl Fn(f64) -> f64) -> f64 {
    let (mut width, mut low, mut high) = (0.0_f64, 0.0_f64, 0.0_f64);
    for i in 0..=20_000 {
        let theta = core::f64::consts::PI * f64::from(i) / 20_000.0;
        width = width.max(2.0 * r(theta) * theta.sin());
        low = low.max(r(theta) * theta.cos());
        high = high.max(-r(theta) * theta.cos());
    }
    (low + high) / width
}

/// Outward normal at θ by differences of the outline's points: away from the axis, up.
pub fn normal(r: impl Fn(f64) -> f64, theta: f64) -> [f64; 2] {
    let point = |t: f64| [r(t) * t.sin(), -r(t) * t.cos()];
    // Fourth-order difference.
    let h = 1e-3;
    let [tx, ty] = [0, 1].map(|i| {
        (8.0 * (point(theta + h)[i] - point(theta - h)[i]) - (point(theta + 2.0 * h)[i] - point(theta - 2.0 * h)[i]))
            / (12.0 * h)
    });
    let length = tx.hypot(ty);
    [ty / length, -tx / length]
}

/// Legendre polynomials 2 and 3 as printed in tables.
pub fn legendre(n: usize, x: f64) -> f64 {
    match n {
        2 => (3.0 * x * x - 1.0) / 2.0,
        3 => (5.0 * x * x * x - 3.0 * x) / 2.0,
        _ => unreachable!("only the modes that are used"),
    }
}

/// Rayleigh 1879, as ω² = n(n−1)(n+2)σ/(ρa³), in Hz.
pub fn mode_frequency(n: f64, diameter_m: f64) -> f64 {
    let omega2 = n * (n - 1.0) * (n + 2.0) * 0.0728 / 998.2 / (diameter_m / 2.0).powi(3);
    omega2.sqrt() / core::f64::consts::TAU
}

/// Lamb 1932: 1/τ = (n−1)(2n+1)ν/a².
pub fn mode_decay(n: f64, diameter_m: f64) -> f64 {
    1.0 / ((n - 1.0) * (2.0 * n + 1.0) * 1.004e-6 / (diameter_m / 2.0).powi(2))
}

/// Volume of a ball, mm³: a stack of discs.
pub fn ball(diameter: f64) -> f64 {
    let r = 0.5 * diameter;
    simpson(-r, r, 1, |z| core::f64::consts::PI * (r - z) * (r + z))
}

/// Amplitude of a drop kept swinging: between 0 at 1 mm and 0.15 at 5 mm.
pub fn amplitude(diameter: f64) -> f64 {
    let share = ((diameter - 1.0) / 4.0).clamp(0.0, 1.0);
    0.15 * share
}
