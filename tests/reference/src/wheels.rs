//! Water thrown by wheels, hydroplaning, swept sources.

use crate::hash::pcg3d;
use crate::numerics::{bisect, runge_kutta, simpson};

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

/// The step that rises smoothly from 0 to 1, from its slope 6t(1 − t).
pub fn smooth(t: f64) -> f64 {
    simpson(0.0, t.clamp(0.0, 1.0), 4, |t| 6.0 * t * (1.0 - t))
}

/// The speed in km/h whose square over 6.35² is the pressure in kPa.
pub fn horne(pressure: f64) -> f64 {
    bisect(0.0, 1000.0, |v| (v / 6.35).powi(2) - pressure)
}

/// Grip left at a share of the hydroplaning speed: from 1 at 0.6 to 0.1 at 1.1.
pub fn grip(ratio: f64) -> f64 {
    1.0 - 0.9 * smooth((ratio.abs() - 0.6) / 0.5)
}

/// Grip of a tyre whose grooves take in `void` mm of the film: that of deep water where the film fills them, all of it
/// up to half of that.
pub fn wet_grip(speed: f64, pressure: f64, film: f64, void: f64) -> f64 {
    let filled = smooth(film / (0.5 * void) - 1.0);
    (1.0 - filled) + filled * grip(3.6 * speed / horne(pressure))
}

/// Film of a track that closes: dW/dt = (beside − W)/τ.
pub fn closing_track(after: f64, beside: f64, elapsed: f64, closing: f64) -> f64 {
    let end = elapsed / closing;
    runge_kutta(0.0, end, [after], 20 + (400.0 * end) as usize, |_, w| [beside - w[0]])[0]
}

/// Smallest and largest drops, mm, of adhesion, tread, bow and side.
pub const SPRAY_MM: [(f64, f64); 4] = [(0.1, 0.5), (0.5, 3.0), (1.0, 5.0), (1.0, 5.0)];

/// Speeds in km/h at which the water of adhesion, tread, bow and side begins to fly and at which all of it does.
pub const ONSET_KM_H: [(f64, f64); 4] = [(48.0, 64.0), (48.0, 64.0), (10.0, 30.0), (10.0, 30.0)];

/// A drop of spray by its description: `[x, y, z, vx, vy, vz]`, m and m/s, and its diameter in mm. `kind` counts
/// adhesion, tread, bow, side.
pub fn spray_drop(kind: usize, width: f64, radius: f64, speed: f64, seed: u32, index: u32) -> ([f64; 6], f64) {
    let unit = |word: u32| f64::from(word / 256) / 16_777_216.0;
    let [a, b, c] = pcg3d([index, seed, kind as u32 ^ 0x7370_7279]);
    let [d, e, _] = pcg3d([a ^ 0x9e37_79b9, b, c]);
    let within = |from: f64, to: f64, word: u32| from * (1.0 - unit(word)) + to * unit(word);
    let (least, most) = SPRAY_MM[kind];
    let diameter = within(least.ln(), most.ln(), a).exp();
    let across = within(-0.5 * width, 0.5 * width, b);
    let v = speed.abs();
    let drop = if kind < 2 {
        let angle = if kind == 0 {
            within(20.0, 100.0, c)
        } else {
            within(5.0, 30.0, c)
        };
        let (sin, cos) = angle.to_radians().sin_cos();
        let aside = within(-5.0, 5.0, d).to_radians().sin();
        [
            across,
            radius - radius * cos,
            -radius * sin,
            v * aside,
            v * sin,
            v - v * cos,
        ]
    } else {
        let turn = if kind == 2 {
            within(20.0, 40.0, c)
        } else {
            within(40.0, 60.0, c)
        };
        let rise = within(10.0, 35.0, d).to_radians();
        let share = v * within(0.5, 1.0, e);
        let run = share * rise.cos();
        let side = if across < 0.0 { -1.0 } else { 1.0 };
        [
            0.5 * side * width,
            0.0,
            0.0,
            side * run * turn.to_radians().sin(),
            share * rise.sin(),
            run * turn.to_radians().cos(),
        ]
    };
    let back = if speed < 0.0 { -1.0 } else { 1.0 };
    (
        [drop[0], drop[1], back * drop[2], drop[3], drop[4], back * drop[5]],
        diameter,
    )
}
