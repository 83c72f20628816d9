//! Fall from rest and the response to wind.

use crate::numerics::runge_kutta;

/// Gravity, density of water and air, viscosity of air at 20 °C. SI.
const G: f64 = 9.80665;
const WATER: f64 = 998.2;
const AIR: f64 = 1.2041;
const VISCOSITY: f64 = 1.816e-5;

/// Drag coefficient of a sphere, Clift & Gauvin 1970.
fn sphere_drag(re: f64) -> f64 {
    24.0 / re * (1.0 + 0.15 * re.powf(0.687)) + 0.42 / (1.0 + 42500.0 * re.powf(-1.16))
}

/// Acceleration of a falling drop whose drag grows from a sphere's to that of its terminal shape, linearly in v/v_t.
pub fn drag_acceleration(diameter_mm: f64, terminal: f64, speed: f64) -> f64 {
    let weight = G * (WATER - AIR) / WATER;
    if speed <= 0.0 {
        return weight;
    }
    let re = |v: f64| AIR * v * diameter_mm * 1e-3 / VISCOSITY;
    let d = diameter_mm * 1e-3;
    let terminal_drag = 4.0 * (WATER - AIR) * G * d / (3.0 * AIR * terminal * terminal);
    let k = terminal_drag / sphere_drag(re(terminal));
    let drag = sphere_drag(re(speed)) * (1.0 + (k - 1.0) * speed / terminal);
    weight * (1.0 - drag / terminal_drag * (speed / terminal).powi(2))
}

/// Speeds from rest at ascending heights (m) by [`drag_acceleration`], Runge–Kutta with steps of `dt` s.
pub fn speeds_at(diameter_mm: f64, terminal: f64, heights: &[f64], dt: f64) -> Vec<f64> {
    let mut speeds = Vec::new();
    let mut state = [0.0, 0.0];
    for &height in heights {
        loop {
            let next = runge_kutta(0.0, dt, state, 1, |_, s| {
                [drag_acceleration(diameter_mm, terminal, s[0]), s[0]]
            });
            if next[1] >= height {
                let share = (height - state[1]) / (next[1] - state[1]);
                speeds.push(state[0] + share * (next[0] - state[0]));
                break;
            }
            state = next;
        }
    }
    speeds
}

/// Fall height from rest at which [`drag_acceleration`] has brought the drop to `share` of its terminal speed. Units:
/// m.
pub fn height_to_share(diameter_mm: f64, terminal: f64, share: f64, dt: f64) -> f64 {
    let mut state = [0.0, 0.0];
    loop {
        let next = runge_kutta(0.0, dt, state, 1, |_, s| {
            [drag_acceleration(diameter_mm, terminal, s[0]), s[0]]
        });
        if next[0] >= share * terminal {
            let part = (share * terminal - state[0]) / (next[0] - state[0]);
            return state[1] + part * (next[1] - state[1]);
        }
        state = next;
    }
}

/// (v, z) at `time` by integration of dv/dt = g (1 − v/v_t)(1 + c v/v_t) from `initial`.
pub fn stiffened_fall(terminal: f64, c: f64, time: f64, initial: f64, steps: usize) -> [f64; 2] {
    runge_kutta(0.0, time, [initial, 0.0], steps, |_, s| {
        let u = s[0] / terminal;
        [G * (1.0 - u) * (1.0 + c * u), s[0]]
    })
}

/// (u, x) at `dt` of a drop in a wind that goes linearly from `start` to `end`: du/dt = (g/v_t)(U − u).
pub fn lagging_drop(terminal: f64, velocity: f64, start: f64, end: f64, dt: f64, steps: usize) -> [f64; 2] {
    runge_kutta(0.0, dt, [velocity, 0.0], steps, |t, s| {
        let wind = start + (end - start) * t / dt;
        [G / terminal * (wind - s[0]), s[0]]
    })
}

/// Amplitude of a drop's swing in a wind sin(2πft), after the transient: integrated over whole periods.
pub fn gust_amplitude(terminal: f64, frequency: f64) -> f64 {
    let omega = core::f64::consts::TAU * frequency;
    let settled = (40.0 * terminal / G * frequency).ceil() / frequency;
    // Fourier components over one period.
    let steps = 2000;
    let h = 1.0 / frequency / f64::from(steps);
    let mut state = runge_kutta(0.0, settled, [0.0], 20_000, |t, s| {
        [G / terminal * ((omega * t).sin() - s[0])]
    });
    let (mut sine, mut cosine) = (0.0, 0.0);
    for i in 0..steps {
        let t = h * f64::from(i);
        sine += state[0] * (omega * t).sin();
        cosine += state[0] * (omega * t).cos();
        state = runge_kutta(t, t + h, state, 1, |t, s| [G / terminal * ((omega * t).sin() - s[0])]);
    }
    (sine * sine + cosine * cosine).sqrt() * 2.0 / f64::from(steps)
}

/// c of the drag law, from its values at 0, 4 and 8 mm.
pub fn stiffness(d: f64) -> f64 {
    // The parabola's top is at 8.564 mm.
    let d = d.clamp(0.0, 8.564);
    let [at_0, at_4, at_8] = [0.397, 1.0534, 1.3098];
    let parabola = at_0 * (d - 4.0) * (d - 8.0) / 32.0 - at_4 * d * (d - 8.0) / 16.0 + at_8 * d * (d - 4.0) / 32.0;
    parabola.clamp(0.3, 1.25)
}

/// Angle of the diagonal of a rectangle, by half of it.
pub fn slant(wind: f64, fall: f64) -> f64 {
    2.0 * (wind / (wind.hypot(fall) + fall)).atan()
}

/// A number as an integer over a power of two: (integer, power).
///
/// # Panics
/// For numbers below 2⁻⁹⁰ in magnitude (0 aside) and from 2⁵³ on.
pub fn binary(x: f64) -> (i128, u32) {
    let bits = x.to_bits();
    let power = 1075 - ((bits >> 52) & 0x7FF) as i32;
    assert!(x == 0.0 || (0..=142).contains(&power), "{x}");
    let digits = i128::from(bits & 0xF_FFFF_FFFF_FFFF) + (1 << 52);
    let signed = if x < 0.0 { -digits } else { digits };
    // Without the zeros at the end.
    let spare = if x == 0.0 {
        0
    } else {
        digits.trailing_zeros().min(power as u32)
    };
    if x == 0.0 {
        (0, 0)
    } else {
        (signed >> spare, power as u32 - spare)
    }
}

/// Share and whole number of start + rate · time, in integers.
pub fn exact_turns(start: f64, rate: f64, time: f64) -> (f64, i128) {
    let [(s, s_bits), (r, r_bits), (t, t_bits)] = [start, rate, time].map(binary);
    let bits = s_bits.max(r_bits + t_bits);
    let product = (r * t).checked_mul(1 << (bits - r_bits - t_bits)).expect("fits");
    parts(product + (s << (bits - s_bits)), 1 << bits)
}

/// Share and whole number of numerator/denominator, in integers.
pub fn parts(numerator: i128, denominator: i128) -> (f64, i128) {
    let rest = numerator.rem_euclid(denominator);
    (rest as f64 / denominator as f64, numerator.div_euclid(denominator))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_do_not_matter() {
        let coarse = speeds_at(2.0, 6.49, &[1.0, 4.0], 2e-3);
        let fine = speeds_at(2.0, 6.49, &[1.0, 4.0], 5e-4);
        assert!(coarse.iter().zip(fine).all(|(a, b)| (a - b).abs() < 1e-5));
    }
}
