//! Splash thresholds and crowns.

use crate::fall_speed::{fit, measured};
use crate::hash::{pcg, pcg3d};
use crate::numerics::{bisect, simpson};

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

/// Mass of a drop, kg: a stack of discs.
pub fn drop_mass(diameter: f64) -> f64 {
    let r = diameter / 2000.0;
    // The cross-section is a parabola in height: Simpson's rule is exact.
    WATER.0 * simpson(-r, r, 1, |z| std::f64::consts::PI * (r - z) * (r + z))
}

/// K at the threshold: We Oh^(−0.4) is K^1.6. Dry 57.7, a film of 0.08 to 1.2 diameters by Cossali et al. 1997, thinner
/// ones in proportion between both; D and film in mm.
pub fn threshold_k(diameter: f64, film: f64) -> f64 {
    let cossali = |delta: f64| 2100.0 + 5880.0 * delta.powf(1.44);
    let delta = film / diameter;
    let value = if delta >= 1.2 {
        cossali(1.2)
    } else if delta >= 0.08 {
        cossali(delta)
    } else {
        let share = delta / 0.08;
        (1.0 - share) * 57.7_f64.powf(1.6) + share * cossali(0.08)
    };
    value.powf(1.0 / 1.6)
}

/// The diameter at which a drop that falls at the fit's terminal speed reaches the threshold, mm.
pub fn threshold_diameter(film: f64) -> f64 {
    bisect(0.1, 10.0, |d| k(d, fit(d)) - threshold_k(d, film))
}

/// Life of a crown, s: the capillary time, at least 10 and at most 20 ms.
pub fn crown_life(diameter: f64) -> f64 {
    let time = (WATER.0 / WATER.2).powf(0.5) * (diameter / 1000.0).powf(1.5);
    time.clamp(0.010, 0.020)
}

/// How much of a crown is left, by the rate 6s(1 − s) at which it fades in the second half of its life.
pub fn crown_left(diameter: f64, time: f64) -> f64 {
    let half = 0.5 * crown_life(diameter);
    let end = ((time - half) / half).clamp(0.0, 1.0);
    simpson(end, 1.0, 4, |s| 6.0 * s * (1.0 - s))
}

/// Height of the rim, m: a parabola with its peak in the middle of the life.
pub fn crown_height(diameter: f64, speed: f64, film: f64, time: f64) -> f64 {
    let over = (k(diameter, speed) / threshold_k(diameter, film) - 1.0).max(0.0);
    let peak = diameter / 1000.0 * (0.6 * over.sqrt()).min(2.5);
    let off = 2.0 * time / crown_life(diameter) - 1.0;
    (peak * (1.0 - off) * (1.0 + off)).max(0.0)
}

/// Splashes by relative intensity: what the slope of each piece adds up to.
pub fn table_splashes(x: f64) -> f64 {
    let part = |from: f64, to: f64| x.clamp(from, to) - from;
    20.0 / 0.33 * part(0.0, 0.33) + 20.0 / 0.33 * part(0.33, 0.66) + 20.0 / 0.34 * part(0.66, 1.0)
}

/// Uniform in [0, 1) from 24 bits.
fn unit(word: u32) -> f64 {
    f64::from(word / 256) / 16_777_216.0
}

/// The count whose cumulative chance first exceeds a hashed number of 48 bits; means above 30 in equal parts.
pub fn hashed_count(mean: f64, key: [u32; 3]) -> u32 {
    let parts = (mean / 30.0).ceil().max(1.0) as u32;
    let mut total = 0;
    for index in 0..parts {
        let [a, b, _] = pcg3d([key[0], key[1] ^ pcg(index), key[2]]);
        let u = (u64::from(a / 256) * 16_777_216 + u64::from(b / 256)) as f64 / 281_474_976_710_656.0;
        let (mut count, mut below) = (0, 0.0);
        loop {
            below += poisson(mean / f64::from(parts), count);
            if u < below || count > 500 {
                break;
            }
            count += 1;
        }
        total += count;
    }
    total
}

/// Place, moment and key of every impact of a cell and a slot.
pub fn impacts_of(seed: u32, cell: [i64; 2], slot: u32, mean: f64) -> Vec<([f64; 3], [u32; 3])> {
    let word = |i: i64| i.rem_euclid(1 << 32) as u32;
    let sum = |a: u32, b: u32| word(i64::from(a) + i64::from(b));
    let [a, b, c] = pcg3d([word(cell[0]), word(cell[1]), slot]);
    let key = pcg3d([a ^ seed, b, sum(c, seed)]);
    (0..hashed_count(mean, key))
        .map(|index| {
            let own = pcg3d([sum(key[0], index), key[1], key[2] ^ pcg(index)]);
            (pcg3d(own).map(unit), own)
        })
        .collect()
}

/// A drop thrown out by its description.
#[derive(Debug, Clone, Copy)]
pub struct Thrown {
    /// Diameter over that of the drop that fell.
    pub size: f64,
    /// Speed over the impact's normal speed.
    pub speed: f64,
    /// Over the ground, rad.
    pub rise: f64,
    /// About the normal, turns.
    pub around: f64,
}

/// Drop `index` of `count`.
pub fn thrown(key: [u32; 3], index: u32, count: u32) -> Thrown {
    let last = (u64::from(key[2]) + u64::from(index)) % (1 << 32);
    let [a, b, c] = pcg3d([key[0] ^ pcg(index), key[1], last as u32]);
    let [spin, _, _] = pcg3d([key[2], key[0], key[1] ^ 0x7370_6c61]);
    let small = 1.0 - unit(a).powi(2);
    Thrown {
        size: 0.3 - 0.25 * small,
        speed: 0.1 + 0.4 * (0.5 * unit(b) + 0.5 * small),
        rise: (40.0 + 30.0 * unit(c)).to_radians(),
        around: unit(spin) + (f64::from(index) + unit(b.rotate_left(13))) / f64::from(count),
    }
}

/// A drop that a step throws, by its description.
#[derive(Debug, Clone, Copy)]
pub struct FromStep {
    /// Diameter, mm.
    pub diameter_mm: f64,
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// From level, rad.
    pub rise: f64,
    /// About the sole, turns.
    pub around: f64,
}

/// Drop `index` of the `count` drops of a step of `strength`.
pub fn from_step(strength: f64, key: [u32; 3], index: u32, count: u32) -> FromStep {
    let last = (u64::from(key[2]) + u64::from(index)) % (1 << 32);
    let [a, b, c] = pcg3d([key[0] ^ pcg(index), key[1], last as u32]);
    FromStep {
        diameter_mm: 1.5 + 5.0 * unit(a).powi(2),
        speed_m_s: strength.sqrt() * (0.8 + 1.7 * unit(b)),
        rise: (25.0 + 40.0 * unit(c)).to_radians(),
        around: (f64::from(index) + unit(b.rotate_left(13))) / f64::from(count),
    }
}

/// Radius and height, m, and opacity of the sheet of a step of `strength` after `age_s`.
pub fn sheet_of_step(strength: f64, age_s: f64) -> [f64; 3] {
    let share = age_s / 0.12;
    if !(0.0..1.0).contains(&share) || strength <= 0.0 {
        return [0.0; 3];
    }
    let rest = 1.0 - share;
    [
        0.05 + 0.15 * strength.sqrt() * share,
        0.16 * strength.sqrt() * share * rest,
        if share < 0.5 { 0.25 } else { 0.5 * rest },
    ]
}
