//! Water waves: dispersion, discrete modes, open-water integrals, moving sources, rings, roughness.

use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

use crate::numerics::{bisect, simpson};

const GRAVITY: f64 = 9.80665;
const DENSITY: f64 = 998.2;
const TENSION: f64 = 0.0728;
const VISCOSITY: f64 = 1.004e-6;

/// ω of the capillary–gravity wave k on water of depth h. Units: rad/s, rad/m, m.
pub fn frequency(k: f64, h: f64) -> f64 {
    ((GRAVITY * k + TENSION * k.powi(3) / DENSITY) * (k * h).tanh()).sqrt()
}

/// dω/dk by central differences, extrapolated to no step.
pub fn group_speed(k: f64, h: f64) -> f64 {
    let slope = |d: f64| (frequency(k + d, h) - frequency(k - d, h)) / (2.0 * d);
    let d = 1e-3 * k;
    (4.0 * slope(0.5 * d) - slope(d)) / 3.0
}

/// Speed of long waves: v² = g h, by halving. Units: m/s.
pub fn shallow_speed(h: f64) -> f64 {
    bisect(0.0, 1e3, |v| v * v - GRAVITY * h)
}

/// Speed and length of the slowest wave on deep water: gravity and tension give the same to ω². Units: m/s, m.
pub fn slowest_wave() -> [f64; 2] {
    let k = bisect(1.0, 1e4, |k| GRAVITY * k - TENSION * k.powi(3) / DENSITY);
    [frequency(k, 1e4) / k, TAU / k]
}

/// The fewest equal steps of an interval with c dt/dx within `courant`, by counting up.
pub fn fewest_steps(courant: f64, speed: f64, interval: f64, cell: f64) -> u32 {
    let mut n = 1;
    while speed * (interval / f64::from(n)) / cell > courant {
        n += 1;
    }
    n
}

/// Largest change of the surface's velocity (h/ρ)∇²J of J = p e^(−r²/2s²)/(2πs²), by differences of J about the middle,
/// extrapolated to no step. Units: SI.
pub fn peak_velocity(momentum: f64, h: f64, s: f64) -> f64 {
    let j = |r: f64| momentum * (-0.5 * (r / s).powi(2)).exp_m1() / (TAU * s * s);
    // Four neighbours at d, less four times the middle: J(0) is left out of `j`.
    let laplacian = |d: f64| 4.0 * j(d) / (d * d);
    let d = 1e-2 * s;
    (-h / DENSITY * (4.0 * laplacian(0.5 * d) - laplacian(d)) / 3.0).abs()
}

/// Decay rate of the amplitude: bulk and bottom. Units: 1/s.
pub fn damping(k: f64, h: f64) -> (f64, f64) {
    let layer = (0.5 * VISCOSITY * frequency(k, h)).sqrt();
    (2.0 * VISCOSITY * k * k, layer * k / (2.0 * k * h).sinh())
}

/// Eigenvalue −L of the mode (m, n) on N² cells between walls: five points, or nine.
pub fn eigenvalue(cells: usize, m: usize, n: usize, nine: bool) -> f64 {
    let [a, b] = [m, n].map(|mode| PI * mode as f64 / cells as f64);
    symbol(a, b, nine)
}

/// −L of a plane wave with phases a and b from cell to cell.
pub fn symbol(a: f64, b: f64, nine: bool) -> f64 {
    if nine {
        (20.0 - 8.0 * (a.cos() + b.cos()) - 4.0 * a.cos() * b.cos()) / 6.0
    } else {
        4.0 - 2.0 * a.cos() - 2.0 * b.cos()
    }
}

/// Numerical over true speed of a plane wave of that many cells, at an angle to the axis.
pub fn speed_ratio(cells_per_wave: f64, angle: f64, courant: f64, nine: bool) -> f64 {
    let k = TAU / cells_per_wave;
    let lambda = symbol(k * angle.cos(), k * angle.sin(), nine);
    2.0 * (0.5 * courant * lambda.sqrt()).asin() / (courant * k)
}

/// Amplitude of a mode after `steps` steps from rest: u₀ = 1, u₁ = (2 − C²λ)/2, and the two roots of
/// (1+a)z² − (2−C²λ)z + (1−a) = 0, which must be a complex pair.
///
/// # Panics
/// When the roots are real.
pub fn mode_amplitude(lambda: f64, courant: f64, a: f64, steps: u64) -> f64 {
    let middle = 2.0 - courant * courant * lambda;
    let modulus = ((1.0 - a) / (1.0 + a)).sqrt();
    let cosine = middle / (2.0 * ((1.0 - a) * (1.0 + a)).sqrt());
    assert!(cosine.abs() < 1.0, "over-damped");
    let angle = cosine.acos();
    let sine_share = (0.5 * middle / modulus - cosine) / angle.sin();
    let n = steps as f64;
    modulus.powf(n) * ((n * angle).cos() + sine_share * (n * angle).sin())
}

/// Bessel's J₀ as the mean of cos(x sin t) over a quarter turn: equal steps converge faster than any power.
pub fn bessel_j0(x: f64) -> f64 {
    let points = (0.5 * x.abs()) as usize + 24;
    let h = FRAC_PI_2 / points as f64;
    (0..points)
        .map(|i| (x * ((i as f64 + 0.5) * h).sin()).cos())
        .sum::<f64>()
        / points as f64
}

/// s²∫e^(−k²s²/2) q(k) J₀(kr) k dk: what a Gaussian of width s becomes when each wave k is multiplied by q(k).
pub fn hankel(r: f64, s: f64, panels: usize, q: impl Fn(f64) -> f64) -> f64 {
    let integrand = |k: f64| (-0.5 * k * k * s * s).exp() * q(k) * bessel_j0(k * r) * k;
    s * s * simpson(0.0, 7.0 / s, panels, integrand)
}

/// erf by its integral.
pub fn erf(x: f64) -> f64 {
    2.0 / PI.sqrt() * simpson(0.0, x.clamp(-7.0, 7.0), 400, |t| (-t * t).exp())
}

/// Mean of e^(−r²/2s²) over a segment, by its integral.
pub fn swept_weight(point: [f64; 2], from: [f64; 2], to: [f64; 2], s: f64) -> f64 {
    simpson(0.0, 1.0, 2000, |t| {
        let r2: f64 = (0..2)
            .map(|axis| (point[axis] - from[axis] - t * (to[axis] - from[axis])).powi(2))
            .sum();
        (-0.5 * r2 / (s * s)).exp()
    })
}

/// s²∇² of [`swept_weight`], by the integral of the Gaussian's.
pub fn swept_laplacian(point: [f64; 2], from: [f64; 2], to: [f64; 2], s: f64) -> f64 {
    simpson(0.0, 1.0, 2000, |t| {
        let r2: f64 = (0..2)
            .map(|axis| ((point[axis] - from[axis] - t * (to[axis] - from[axis])) / s).powi(2))
            .sum();
        (-0.5 * r2).exp() * (r2 - 2.0)
    })
}

/// The packet (2π)^(−½) ∫√κ e^(−κ²/2) cos(κx − π/4) dκ, its antiderivative and its first two derivatives: the power of
/// κ goes up by one, the phase by a quarter turn. κ = q² takes the root away.
pub fn packet(x: f64) -> [f64; 4] {
    let panels = 400 + (8.0 * x.abs()) as usize;
    [-1, 0, 1, 2].map(|derivative: i32| {
        let phase = FRAC_PI_2 * f64::from(derivative) - FRAC_PI_4;
        simpson(0.0, 3.2, panels, |q| {
            let kappa = q * q;
            2.0 * q.powi(2 * derivative + 2) * (-0.5 * kappa * kappa).exp() * (kappa * x + phase).cos()
        }) / TAU.sqrt()
    })
}

/// Largest |F′| and |F″| of the packet, by looking at every 1/64 of a width.
pub fn steepest() -> [f64; 2] {
    (-512..512)
        .map(|i| packet(f64::from(i) / 64.0))
        .fold([0.0, 0.0], |[a, b], row| [a.max(row[2].abs()), b.max(row[3].abs())])
}

/// Age from which (bump·|F′| + push·|F″|)/s · √(s/max(s, ct)) e^(−decay t) is below `slope`, by halving in [0, 1000] s.
pub fn ring_lifetime(heights: [f64; 2], s: f64, c: f64, decay: f64, slope: f64) -> f64 {
    let [bump, push] = steepest();
    let start = (heights[0] * bump + heights[1].abs() * push) / s;
    let steepness = |t: f64| start * (s / (c * t).max(s)).sqrt() * (-decay * t).exp();
    if steepness(0.0) <= slope {
        return 0.0;
    }
    bisect(0.0, 1e3, |t| slope - steepness(t))
}

/// ∫∫|∇u|² d²r dt of an impact of momentum p and volume v with width s on water of depth h, damping k_d: the transform
/// of each wave is that of a damped oscillator started with a height and a velocity; its square is summed over time and
/// k.
pub fn slope_integral(momentum: f64, volume: f64, s: f64, h: f64, k_d: f64) -> f64 {
    let (gamma, c) = (0.5 * k_d, (GRAVITY * h).sqrt());
    simpson(0.0, 7.0 / s, 400, |k| {
        if k == 0.0 {
            return 0.0;
        }
        let w0 = c * k;
        let gauss = (-0.5 * k * k * s * s).exp();
        let (u, v) = (volume * gauss, -h / DENSITY * momentum * k * k * gauss);
        let d = w0 * w0 - gamma * gamma;
        let (height, end) = if d > 0.0 {
            (d.sqrt(), 20.0 / gamma)
        } else {
            // Over-damped waves are slower.
            ((-d).sqrt(), 20.0 / (gamma - (-d).sqrt()).max(0.02 * gamma))
        };
        let square = |t: f64| {
            let (cosine, sine) = if d > 0.0 {
                let fade = (-gamma * t).exp();
                (fade * (height * t).cos(), fade * (height * t).sin() / height)
            } else {
                let [slow, fast] = [height, -height].map(|rate| ((rate - gamma) * t).exp());
                (0.5 * (slow + fast), 0.5 * (slow - fast) / height)
            };
            (u * cosine + (v + gamma * u) * sine).powi(2)
        };
        let panels = 200 + (2.0 * height * end) as usize;
        k * k * k * simpson(0.0, end, panels, square)
    }) / TAU
}

/// Lagarde's animated circle: slope outwards over the steepness, from R, the part of the cycle and the layer's weight.
#[must_use]
pub fn ring_of_a_circle(nearness: f64, drop_frac: f64, weight: f64) -> f64 {
    let saturate = |x: f64| x.clamp(0.0, 1.0);
    let time_frac = drop_frac - 1.0 + nearness;
    let drop_factor = saturate(0.2 + weight * 0.8 - drop_frac);
    drop_factor * nearness * ((time_frac * 9.0).clamp(0.0, 3.0) * std::f64::consts::PI).sin()
}

/// Lagarde's times of the four layers.
#[must_use]
pub fn ring_times(time: f64) -> [f64; 4] {
    let (times, adds) = ([1.0, 0.85, 0.93, 1.13], [0.0, 0.2, 0.45, 0.7]);
    std::array::from_fn(|k| ((time * times[k] + adds[k]) * 1.6).rem_euclid(1.0))
}

/// Lagarde's composed normal before it is normalised, x and y of it: `at(u, v)` reads the circle texture (distance,
/// direction x and y, time offset), which repeats.
#[must_use]
pub fn ring_layers_normal(
    at: impl Fn(f64, f64) -> [f64; 4],
    [u, v]: [f64; 2],
    times: [f64; 4],
    intensity: f64,
) -> [f64; 2] {
    let offsets = [[0.25, 0.0], [-0.55, 0.3], [0.6, 0.85], [0.5, -0.75]];
    let mut normal = [0.0; 2];
    for k in 0..4 {
        let weight = ((intensity - 0.25 * k as f64) * 4.0).clamp(0.0, 1.0);
        let [distance, x, y, offset] = at(u + offsets[k][0], v + offsets[k][1]);
        let factor = ring_of_a_circle(distance, (offset + times[k]).rem_euclid(1.0), weight);
        normal[0] += weight * x * factor * 0.35;
        normal[1] += weight * y * factor * 0.35;
    }
    normal
}
