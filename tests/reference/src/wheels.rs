//! Water thrown by wheels, hydroplaning, swept sources.

use crate::numerics::{runge_kutta, simpson};

/// Water met and its split, kg/s: `[met, adhesion, tread, bow and side]`. Width in m, depths in mm.
pub fn wheel_split(speed: f64, width: f64, film: f64, grooves: f64, clings: f64, carried: f64) -> [f64; 4] {
    let met = 998.2 * width * speed * film / 1000.0;
    let adhesion = 998.2 * width * speed * (1.0 - grooves) * film.min(clings) / 1000.0;
    let tread = 998.2 * width * speed * grooves * film.min(carried) / 1000.0;
    [met, adhesion, tread, met - adhesion - tread]
}

/// Horne & Dreher 1963 as printed: 9 knots times the root of the pressure in psi; km/h from kPa.
pub fn horne_from_knots(pressure: f64) -> f64 {
    9.0 * 1.852 * (pressure * 1000.0 / 6_894.757_293_168).sqrt()
}

/// Gallaway et al. 1979 in its own units: spin-down %, psi, 32nds of an inch, inches, inches; mph.
pub fn gallaway_mph(spin: f64, psi: f64, tread: f64, water: f64, texture: f64) -> f64 {
    let first = 10.409 / water.powf(0.06) + 3.507;
    let second = (28.952 / water.powf(0.06) - 7.817) * texture.powf(0.14);
    spin.powf(0.04) * psi.powf(0.3) * (tread + 1.0).powf(0.06) * first.max(second)
}

/// A point of the rim of a wheel that rolls forwards at `speed`, `angle` behind the contact, by differences of the
/// cycloid: `[forwards, up]` velocity.
pub fn rim_velocity(radius: f64, speed: f64, angle: f64) -> [f64; 2] {
    // A point that has turned by a since it touched the ground.
    let at = |a: f64| [radius * (a - a.sin()), radius * (1.0 - a.cos())];
    let (h, rate) = (1e-5, speed / radius);
    let (before, after) = (at(angle - h), at(angle + h));
    [0, 1].map(|i| (after[i] - before[i]) / (2.0 * h) * rate)
}

/// Drops in a kilogram whose volume is spread evenly over the logarithm of diameters from `from` to `to` mm.
pub fn drops_per_kg(from: f64, to: f64) -> f64 {
    simpson(from.ln(), to.ln(), 2000, |l| {
        1.0 / (998.2 * std::f64::consts::PI / 6.0 * (l.exp() / 1000.0).powi(3))
    }) / (to / from).ln()
}

/// Way and speed through the air of a drop under du/dt = −g u²/v², in steps that start small.
pub fn slowed(start: f64, terminal: f64, time: f64) -> [f64; 2] {
    runge_kutta(0.0, 1.0, [0.0, start], 20_000, |s, y| {
        [y[1], -9.80665 * y[1] * y[1] / (terminal * terminal)].map(|rate| 3.0 * s * s * time * rate)
    })
}
