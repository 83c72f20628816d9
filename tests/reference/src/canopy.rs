//! Canopy store and drips.

use crate::numerics::{bisect, runge_kutta, simpson};

/// Where the water of a crown's interval went, mm.
#[derive(Debug, Clone, Copy, Default)]
pub struct CanopyEnd {
    /// Stored at the end.
    pub stored: f64,
    /// Dripped.
    pub drip: f64,
    /// Down the trunk.
    pub stemflow: f64,
    /// Into the air.
    pub evaporated: f64,
}

/// The state form of Weber et al. 2016 stepped by Runge–Kutta: q = 1 − √(1 − C/S), dC/dt = R (1 − q) − E.
///
/// Rates in mm/s, depths in mm. Time runs as s², since √ is singular in a full crown. An empty crown evaporates at most
/// what it intercepts.
pub fn canopy_by_runge_kutta(
    capacity: f64,
    stored: f64,
    rain: f64,
    evaporation: f64,
    time: f64,
    q_max: f64,
    steps: usize,
) -> CanopyEnd {
    let rates = |stored: f64| {
        let q = 1.0 - (1.0 - (stored / capacity).clamp(0.0, 1.0)).sqrt();
        let loss = if stored <= 0.0 {
            evaporation.min(rain)
        } else {
            evaporation
        };
        [
            rain * (1.0 - q) - loss,
            rain * q.min(q_max),
            rain * (q - q.min(q_max)),
            loss,
        ]
    };
    let end = time.sqrt();
    let mut y = [stored, 0.0, 0.0, 0.0];
    for n in 0..steps {
        let (from, to) = (end * n as f64 / steps as f64, end * (n + 1) as f64 / steps as f64);
        y = runge_kutta(from, to, y, 1, |s, y| rates(y[0]).map(|rate| 2.0 * s * rate));
        // What was not there has not evaporated.
        y[3] += y[0].min(0.0);
        y[0] = y[0].clamp(0.0, capacity);
    }
    CanopyEnd {
        stored: y[0],
        drip: y[1],
        stemflow: y[2],
        evaporated: y[3],
    }
}

/// ∫ f(y) dt for y = √(1 − C/S) going from `from` to `to`, with dt = −2 S y dy/(R y − E): Simpson's rule on pieces that
/// halve the distance to the equilibrium E/R.
pub fn canopy_integral(capacity: f64, rain: f64, evaporation: f64, from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let still = evaporation / rain;
    let mut total = 0.0;
    let mut start = from;
    loop {
        let half = 0.5 * (start + still);
        let last = (start - half).abs() >= (start - to).abs();
        let end = if last { to } else { half };
        total += simpson(start, end, 400, |y| {
            f(y) * -2.0 * capacity * y / (rain * y - evaporation)
        });
        if last {
            return total;
        }
        start = end;
    }
}

/// w with w e^w = x on the branch w ≥ −1.
pub fn lambert_w0(x: f64) -> f64 {
    bisect(-1.0, 800.0, |w| {
        if w > 600.0 {
            w + w.ln() - x.ln()
        } else {
            w * w.exp() - x
        }
    })
}

/// Shares of volume of the drips of needles, matte and coated broad leaves, in classes of 0.5 mm from 1 to 8 mm, in
/// hundredths (Weber et al. 2016, table 4).
pub const DRIP_HUNDREDTHS: [(f64, [u32; 3]); 14] = [
    (1.25, [0, 0, 0]),
    (1.75, [1, 1, 1]),
    (2.25, [2, 1, 2]),
    (2.75, [5, 2, 4]),
    (3.25, [8, 4, 7]),
    (3.75, [19, 6, 17]),
    (4.25, [15, 8, 37]),
    (4.75, [17, 18, 28]),
    (5.25, [13, 22, 4]),
    (5.75, [10, 23, 0]),
    (6.25, [6, 12, 0]),
    (6.75, [3, 3, 0]),
    (7.25, [1, 0, 0]),
    (7.75, [0, 0, 0]),
];

/// Volume per mm of diameter of the measured classes; `leaf` 0 to 2.
pub fn drip_volume_density(leaf: usize, diameter: f64) -> f64 {
    let class = DRIP_HUNDREDTHS
        .iter()
        .find(|(middle, _)| diameter >= middle - 0.25 && diameter < middle + 0.25);
    class.map_or(0.0, |(_, shares)| f64::from(shares[leaf]) / 100.0 / 0.5)
}

/// Volume per mm of diameter of the Gaussian fit (table 3), not normalised.
pub fn drip_gaussian_density(leaf: usize, diameter: f64) -> f64 {
    let (a, b, c) = [(0.17, 4.45, 1.19), (0.24, 5.40, 0.84), (0.37, 4.37, 0.50)][leaf];
    a * (-(diameter - b).powi(2) / (2.0 * c * c)).exp() / 0.5
}

/// ∫ density/Dⁿ dD from 1 mm to `end`, class by class.
pub fn drip_sum(density: impl Fn(f64) -> f64, n: i32, end: f64) -> f64 {
    let mut total = 0.0;
    let mut from = 1.0;
    while from < end {
        let to = (from + 0.5_f64).min(end);
        // The edges belong to the next class; stay inside.
        let inside = |d: f64| d.clamp(from + 1e-12, (from + 0.5) - 1e-12);
        total += simpson(from, to, 40, |d| density(inside(d)) / d.powi(n));
        from += 0.5;
    }
    total
}

/// The diameter below which the share `u` of ∫ density/Dⁿ dD lies.
pub fn drip_quantile(density: impl Fn(f64) -> f64, n: i32, u: f64) -> f64 {
    let whole = drip_sum(&density, n, 8.0);
    bisect(1.0, 8.0, |d| drip_sum(&density, n, d) - u * whole)
}

/// Shares of the drip at 40, 100, 150, 200 cm under canopies 7.8, 6.8, 5.8 and 4.8 m thick, in hundredths (table 2).
pub const RADIAL_HUNDREDTHS: [(f64, [u32; 4]); 4] = [
    (7.8, [26, 18, 22, 34]),
    (6.8, [24, 20, 25, 31]),
    (5.8, [21, 19, 30, 30]),
    (4.8, [24, 22, 28, 26]),
];

/// Distance and speed after `time` of a drop that starts at rest under quadratic drag.
pub fn drip_fall(time: f64, terminal: f64, gravity: f64) -> [f64; 2] {
    runge_kutta(0.0, time, [0.0, 0.0], 4000, |_, y| {
        [y[1], gravity * (1.0 - (y[1] / terminal).powi(2))]
    })
}

/// Volume of a drop of `diameter` mm, m³: a stack of discs.
pub fn drop_volume(diameter: f64) -> f64 {
    let r = diameter / 2000.0;
    simpson(-r, r, 1, |z| std::f64::consts::PI * (r - z) * (r + z))
}

/// Which of the measured distances 0.4, 1, 1.5 and 2 m is nearest to a place, scaled to a crown of 2 m.
pub fn nearest_ring(radius: f64, crown: f64) -> usize {
    let at = 2.0 * radius / crown;
    let rings = [0.4, 1.0, 1.5, 2.0];
    let mut best = 0;
    for ring in 1..4 {
        if (at - rings[ring]).abs() < (at - rings[best]).abs() {
            best = ring;
        }
    }
    best
}

/// Shares of the drip by distance, between the rows of table 2 in hundredths.
pub fn ring_shares(thickness: f64) -> [f64; 4] {
    let mut rows = RADIAL_HUNDREDTHS;
    rows.reverse();
    let pair = rows
        .windows(2)
        .find(|pair| thickness <= pair[1].0)
        .expect("within the rows");
    let t = (thickness - pair[0].0) / (pair[1].0 - pair[0].0);
    [0, 1, 2, 3].map(|n| (f64::from(pair[0].1[n]) * (1.0 - t) + f64::from(pair[1].1[n]) * t) / 100.0)
}

/// Time to fall: cosh(g t/v) = e^(g d/v²), by 2 sinh²(x/2) = cosh x − 1.
pub fn drip_time(distance: f64, terminal: f64) -> f64 {
    let x = 9.80665 * distance / (terminal * terminal);
    let turned = if x < 700.0 {
        2.0 * (0.5 * x.exp_m1()).sqrt().asinh()
    } else {
        x + std::f64::consts::LN_2
    };
    terminal / 9.80665 * turned
}

/// Way fallen: ln cosh y = ½ ln(1 + sinh² y).
pub fn drip_way(time: f64, terminal: f64) -> f64 {
    let y = 9.80665 * time / terminal;
    let turned = if y < 300.0 {
        0.5 * y.sinh().powi(2).ln_1p()
    } else {
        y - std::f64::consts::LN_2
    };
    terminal * terminal / 9.80665 * turned
}

/// The drop, by index from the newest, that is nearest in time to a point: all that are near are tried.
pub fn nearest_drop(distance: f64, period: f64, phase: f64, terminal: f64) -> (u64, f64) {
    let time = drip_time(distance, terminal);
    let about = (time / period) as i64;
    (about - 3..about + 4)
        .filter(|&index| index >= 0)
        .map(|index| (index as u64, (index as f64 + phase) * period))
        .min_by(|a, b| (a.1 - time).abs().total_cmp(&(b.1 - time).abs()))
        .expect("one is there")
}
