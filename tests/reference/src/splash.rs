//! Splash thresholds and crowns.

use crate::fall_speed::measured;
use crate::numerics::bisect;

/// Density, dynamic viscosity and surface tension of water at 20 °C.
const WATER: (f64, f64, f64) = (998.2, 1.002e-3, 0.0728);

/// Weber, Reynolds and Ohnesorge number; D in mm.
pub fn impact_numbers(diameter: f64, speed: f64) -> [f64; 3] {
    let (density, viscosity, tension) = WATER;
    let d = diameter / 1000.0;
    [
        density * d * speed.powi(2) / tension,
        density * d * speed / viscosity,
        viscosity / (density * tension * d).sqrt(),
    ]
}

/// K = We^½ Re^¼.
pub fn k(diameter: f64, speed: f64) -> f64 {
    let [weber, reynolds, _] = impact_numbers(diameter, speed);
    weber.powf(0.5) * reynolds.powf(0.25)
}

/// Cossali et al. 1997: We Oh^(−0.4) over 2100 + 5880 δ^1.44.
pub fn cossali_ratio(diameter: f64, speed: f64, film_share: f64) -> f64 {
    let [weber, _, ohnesorge] = impact_numbers(diameter, speed);
    weber * ohnesorge.powf(-0.4) / (2100.0 + 5880.0 * film_share.powf(1.44))
}

/// The diameter at which `ratio`, growing with diameter, is 1 at the measured fall speed.
pub fn crossing(ratio: impl Fn(f64, f64) -> f64) -> f64 {
    bisect(0.3, 5.0, |d| ratio(d, measured(d)) - 1.0)
}

/// Yarin & Weiss 1995, in mm: D (2/(3δ))^¼ √(v t/D); D in mm, t in ms.
pub fn crown_radius(diameter: f64, speed: f64, film_share: f64, time: f64) -> f64 {
    diameter * (2.0 / (3.0 * film_share)).powf(0.25) * (speed * time / diameter).sqrt()
}

/// Radius of the half sphere's crater whose potential energy ∫ ρ g z π (R² − z²) dz = π ρ g R⁴/4 is `energy`, m.
pub fn crater_radius(energy: f64) -> f64 {
    let work = |radius: f64| {
        let n = 2000;
        let h = radius / f64::from(n);
        (0..n)
            .map(|i| (f64::from(i) + 0.5) * h)
            .map(|z| WATER.0 * 9.80665 * z * std::f64::consts::PI * (radius * radius - z * z) * h)
            .sum::<f64>()
    };
    bisect(0.0, 1.0, |radius| work(radius) - energy)
}

/// Chance of `count` events where `mean` are expected, by products.
pub fn poisson(mean: f64, count: u32) -> f64 {
    (1..=count).fold((-mean).exp(), |chance, i| chance * mean / f64::from(i))
}

/// Number, water (m/s), energy and pressure of drops on a plane by a sum over diameters from `from` to `to` mm.
///
/// `density(D)` per m³ and mm, `speed(D)` m/s, `normal` and `wind` as x, y, z.
pub fn impact_sums(
    density: impl Fn(f64) -> f64,
    speed: impl Fn(f64) -> f64,
    from: f64,
    to: f64,
    normal: [f64; 3],
    wind: [f64; 3],
) -> [f64; 4] {
    let n = 200_000;
    let h = (to - from) / f64::from(n);
    let mut sums = [0.0; 4];
    for i in 0..n {
        let d = from + (f64::from(i) + 0.5) * h;
        let w = [wind[0], wind[1] - speed(d), wind[2]];
        let toward = -(w[0] * normal[0] + w[1] * normal[1] + w[2] * normal[2]);
        if toward <= 0.0 {
            continue;
        }
        let number = density(d) * toward * h;
        let volume = std::f64::consts::PI / 6.0 * (d / 1000.0).powi(3);
        let squared = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
        sums[0] += number;
        sums[1] += number * volume;
        sums[2] += number * volume * WATER.0 * squared / 2.0;
        sums[3] += number * volume * WATER.0 * toward;
    }
    sums
}
