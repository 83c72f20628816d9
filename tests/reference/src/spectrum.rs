//! Drop-size distributions: bulk quantities by brute-force sums.

use crate::numerics::{bisect, simpson};

/// The published N₀, m⁻³ mm⁻¹, and Λ at 1 mm/h, mm⁻¹.
///
/// # Panics
/// On a name that no distribution has.
pub fn published(name: &str) -> (f64, f64) {
    match name {
        "marshall-palmer" => (8000.0, 4.1),
        "drizzle" => (30000.0, 5.7),
        "widespread" => (7000.0, 4.1),
        "thunderstorm" => (1400.0, 3.0),
        _ => panic!("no distribution called {name}"),
    }
}

/// Λ, mm⁻¹, at `r` mm/h.
pub fn slope(name: &str, r: f64) -> f64 {
    published(name).1 * r.powf(-0.21)
}

/// Γ(x) for x > 0 by Stirling's series far out and the recurrence back.
pub fn gamma_function(x: f64) -> f64 {
    let mut shift = 1.0;
    let mut y = x;
    while y < 20.0 {
        shift *= y;
        y += 1.0;
    }
    let series = 1.0 / (12.0 * y) - 1.0 / (360.0 * y.powi(3)) + 1.0 / (1260.0 * y.powi(5)) - 1.0 / (1680.0 * y.powi(7));
    (2.0 * core::f64::consts::PI / y).sqrt() * (y / core::f64::consts::E).powf(y) * series.exp() / shift
}

/// Testud et al. 2001: f(µ).
pub fn gamma_factor(mu: f64) -> f64 {
    6.0 / 4.0_f64.powi(4) * (4.0 + mu).powf(4.0 + mu) / gamma_function(4.0 + mu)
}

/// Testud et al. 2001: normalised gamma distribution, m⁻³ mm⁻¹; `d`, `dm` in mm.
pub fn gamma(nw: f64, dm: f64, mu: f64, d: f64) -> f64 {
    nw * gamma_factor(mu) * (d / dm).powf(mu) * (-(4.0 + mu) * d / dm).exp()
}

/// ∫ f dD over [a, b] mm in steps of at most 0.002 mm, split where fall laws have corners.
pub fn sum(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let mut borders = vec![a];
    borders.extend([0.1, 1.07, 5.8, 7.0].into_iter().filter(|d| *d > a && *d < b));
    borders.push(b);
    borders
        .windows(2)
        .map(|pair| {
            simpson(
                pair[0],
                pair[1],
                (((pair[1] - pair[0]) / 0.004).ceil() as usize).max(16),
                &f,
            )
        })
        .sum()
}

/// Rain rate, mm/h, of N(D) between two diameters: (π/6) D³ mm³ · N · v, as a depth of water.
pub fn rain_rate(a: f64, b: f64, n: impl Fn(f64) -> f64, v: impl Fn(f64) -> f64) -> f64 {
    // mm³ m⁻³ · m/s = 1e-9 m/s; 3.6e6 mm/h per m/s.
    sum(a, b, |d| core::f64::consts::PI / 6.0 * d.powi(3) * n(d) * v(d)) * 1e-9 * 3.6e6
}

/// Diameter below which half of ∫ f dD over [a, b] lies.
pub fn median(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let half = 0.5 * sum(a, b, &f);
    let cells = 4000;
    let h = (b - a) / f64::from(cells);
    // First the cell, then the place in it.
    let mut below = 0.0;
    for i in 0..cells {
        let (from, to) = (a + h * f64::from(i), a + h * f64::from(i + 1));
        let here = simpson(from, to, 2, &f);
        if below + here >= half {
            return bisect(from, to, |d| below + simpson(from, d, 2, &f) - half);
        }
        below += here;
    }
    b
}

/// Diameter at the share `u` of ∫ f dD over [a, b], by bisection.
pub fn quantile(a: f64, b: f64, u: f64, f: impl Fn(f64) -> f64) -> f64 {
    let target = u * simpson(a, b, 4000, &f);
    bisect(a, b, |d| simpson(a, d, 1000, &f) - target)
}
