//! Film, infiltration, inlets, puddles and wet bodies: halving, small steps, sums over directions.

use crate::numerics::{bisect, runge_kutta, simpson};

/// Gravity. Units: m/s².
const G: f64 = 9.806_65;

/// A plane under rain: q = α hᵐ.
#[derive(Debug, Clone, Copy)]
pub struct Plane {
    /// α.
    pub alpha: f64,
    /// m.
    pub m: f64,
    /// Rain. Units: m/s.
    pub rain: f64,
}

impl Plane {
    /// Turbulent flow: α = √S/n.
    pub fn manning(n: f64, slope: f64, rain_mm_h: f64) -> Self {
        Self {
            alpha: slope.sqrt() / n,
            m: 5.0 / 3.0,
            rain: rain_mm_h / 3.6e6,
        }
    }

    /// Laminar flow with f = K/Re: from f = 8 g S h/v² and Re = v h/ν.
    pub fn laminar(friction: f64, slope: f64, rain_mm_h: f64) -> Self {
        Self {
            alpha: 8.0 * G * slope / (friction * 1.004e-6),
            m: 3.0,
            rain: rain_mm_h / 3.6e6,
        }
    }

    /// Depth at x: the rain of `x` runs off. Units: m.
    pub fn steady(&self, x: f64) -> f64 {
        bisect(0.0, 1e5, |h| self.alpha * h.powf(self.m) - self.rain * x)
    }

    /// Depth at x, t after the rain on the steady plane stopped: the root of the implicit equation by halving.
    pub fn recession(&self, x: f64, t: f64) -> f64 {
        let place = |h: f64| self.alpha * h.powf(self.m) / self.rain + self.m * self.alpha * h.powf(self.m - 1.0) * t;
        bisect(0.0, 1e5, |h| place(h) - x)
    }

    /// Depth at (x, t) under rain of any duration, by walking along characteristics dx/dt = m α h^(m−1), dh/dt = rain:
    /// of all that start at the top (at some time) or anywhere on the plane (at time 0), the one that arrives.
    pub fn by_characteristics(&self, x: f64, t: f64, duration: f64, steps: usize) -> f64 {
        let walk = |x0: f64, t0: f64| {
            let mut y = [x0, 0.0];
            // The rain's end is a kink: one walk up to it, one after.
            for (from, to, rain) in [(t0, t.min(duration), self.rain), (t0.max(duration), t, 0.0)] {
                if to > from {
                    y = runge_kutta(from, to, y, steps, |_, y| {
                        [self.m * self.alpha * y[1].max(0.0).powf(self.m - 1.0), rain]
                    });
                }
            }
            y
        };
        let [reached, depth] = walk(0.0, 0.0);
        if reached < x {
            return depth; // what starts on the plane keeps the depth of the first
        }
        let start = bisect(0.0, t.min(duration), |t0| walk(0.0, t0)[0] - x);
        walk(0.0, start)[1]
    }
}

/// Depth at the foot of a plane by the local inertial equations (Bates et al. 2010), explicit on a fine grid, after
/// `time` of rain. The foot is open: the water surface goes on with the slope of the bed. Units: SI.
pub fn local_inertial_foot(n: f64, slope: f64, length: f64, rain: f64, time: f64, cells: usize) -> f64 {
    let dx = length / cells as f64;
    let bed: Vec<f64> = (0..=cells).map(|i| -slope * dx * i as f64).collect();
    let mut h = vec![0.0_f64; cells + 1];
    let mut q = vec![0.0_f64; cells + 1]; // over the right edge of cell i
    let mut t = 0.0;
    while t < time {
        let deepest = h.iter().copied().fold(1e-4, f64::max);
        let dt = (0.3 * dx / (G * deepest).sqrt()).min(0.02).min(time - t);
        for i in 0..cells {
            let next = if i + 1 < cells { h[i + 1] } else { h[i] };
            let (here, there) = (bed[i] + h[i], bed[i + 1] + next);
            let flow = here.max(there) - bed[i].max(bed[i + 1]);
            q[i] = if flow > 1e-9 {
                (q[i] - G * flow * dt * (there - here) / dx)
                    / (1.0 + G * dt * n * n * q[i].abs() / flow.powf(7.0 / 3.0))
            } else {
                0.0
            };
        }
        for i in 0..cells {
            let inflow = if i > 0 { q[i - 1] } else { 0.0 };
            h[i] = (h[i] + dt * (rain + (inflow - q[i]) / dx)).max(0.0);
        }
        t += dt;
    }
    h[cells - 1]
}

/// dh/dt = P − k h^(5/3), stopped at 0, in equal steps.
pub fn film(h: f64, rain: f64, drain: f64, time: f64, steps: usize) -> f64 {
    let dt = time / steps as f64;
    let mut h = h;
    for _ in 0..steps {
        [h] = runge_kutta(0.0, dt, [h], 1, |_, y| [rain - drain * y[0].max(0.0).powf(5.0 / 3.0)]);
        h = h.max(0.0);
    }
    h
}

/// Gallaway et al. 1971 (first) or 1979: mm above the texture.
pub fn gallaway(first: bool, texture: f64, length: f64, rate: f64, slope: f64) -> f64 {
    if first {
        0.014_867_6 * texture.powf(0.11) * length.powf(0.43) * rate.powf(0.59) / slope.powf(0.42) - texture
    } else {
        0.0190 * texture.powf(0.125) * length.powf(0.519) * rate.powf(0.562) / slope.powf(0.364) - texture
    }
}

/// The rain rate at which that is 0, by halving its logarithm.
pub fn gallaway_covering(first: bool, texture: f64, length: f64, slope: f64) -> f64 {
    bisect(-40.0, 40.0, |rate| gallaway(first, texture, length, rate.exp(), slope)).exp()
}

/// Water behind a Green–Ampt front that started at `from` (mm), `hours` later under standing water. From
/// K dt = F/(F + M) dF: with F = M (eˢ − 1) the integrand is M (eˢ − 1); by Simpson's rule, its inverse by halving.
/// M = front, K in mm/h.
pub fn green_ampt(conductivity: f64, front: f64, from: f64, hours: f64) -> f64 {
    let start = (from / front).ln_1p();
    let time = |s: f64| simpson(start, s, 300, |s| front * s.exp_m1()) / conductivity;
    let most = from + conductivity * hours + (2.0 * conductivity * hours * front).sqrt();
    let end = bisect(start, (1.001 * most / front).ln_1p() + 1e-300, |s| time(s) - hours);
    front * end.exp_m1()
}

/// The same under constant rain on dry soil: all of it up to the depth at which K (1 + M/F) is the rain.
pub fn green_ampt_rain(conductivity: f64, front: f64, rain: f64, hours: f64) -> f64 {
    if rain <= conductivity {
        return rain * hours;
    }
    let pond = bisect(0.0, 1e9, |f| conductivity * (f + front) - rain * f);
    if rain * hours <= pond {
        rain * hours
    } else {
        green_ampt(conductivity, front, pond, hours - pond / rain)
    }
}

/// Discharge of an inlet. Units: m³/s.
pub fn inlet(perimeter: f64, area: f64, depth: f64) -> f64 {
    (1.66 * perimeter * depth.powf(1.5)).min(0.67 * area * (2.0 * G * depth).sqrt())
}

/// Depth over an inlet in a pond of constant area after `time`, in small steps.
pub fn inlet_drained(perimeter: f64, area: f64, depth: f64, pond: f64, time: f64, steps: usize) -> f64 {
    let [d] = runge_kutta(0.0, time, [depth], steps, |_, y| {
        [-inlet(perimeter, area, y[0].max(0.0)) / pond]
    });
    d.max(0.0)
}

/// Level of a puddle in z = r²/(2R) by stepping its volume: dV/dt = Q − e A, A = 2πR h, V = πR h².
pub fn puddle(radius: f64, level: f64, inflow: f64, loss: f64, time: f64, steps: usize) -> f64 {
    let c = core::f64::consts::PI * radius;
    let [v] = runge_kutta(0.0, time, [c * level * level], steps, |_, v| {
        [inflow - loss * 2.0 * c * (v[0].max(0.0) / c).sqrt()]
    });
    (v.max(0.0) / c).sqrt()
}

/// The time in which that puddle rises from dry to `level`: ∫ A/(Q − e A) dh by Simpson's rule.
pub fn puddle_rise_time(radius: f64, level: f64, inflow: f64, loss: f64) -> f64 {
    let area = |h: f64| core::f64::consts::TAU * radius * h;
    simpson(0.0, level, 200_000, |h| area(h) / (inflow - loss * area(h)))
}

/// Fresnel's unpolarised reflectance from a medium of index 1 to one of index `n` (below 1: from the denser side).
pub fn fresnel(cos: f64, n: f64) -> f64 {
    let sin2 = (1.0 - cos * cos) / (n * n);
    if sin2 >= 1.0 {
        return 1.0;
    }
    let t = (1.0 - sin2).sqrt();
    let s = (cos - n * t) / (cos + n * t);
    let p = (n * cos - t) / (n * cos + t);
    0.5 * (s * s + p * p)
}

/// R̄(n) = ∫ F dcos², n ≥ 1.
pub fn mean_reflectance(n: f64) -> f64 {
    simpson(0.0, 1.0, 20_000, |c| 2.0 * c * fresnel(c, n))
}

/// Lekner & Dorf 1988 as printed, with R̄ by quadrature; `indices` = [liquid, solid].
pub fn lekner_dorf(dry: f64, indices: [f64; 2], entry: f64) -> f64 {
    let [liquid, solid] = indices;
    let a_d = 1.0 - dry;
    let gain = (1.0 - mean_reflectance(solid / liquid)) / (1.0 - mean_reflectance(solid));
    let a = a_d * ((1.0 - a_d) * gain + a_d);
    let p = 1.0 - (1.0 - mean_reflectance(liquid)) / (liquid * liquid);
    (1.0 - entry) * (1.0 - a / (1.0 - p * (1.0 - a)))
}

/// A soaked body as Lekner & Dorf print it, for coefficients `light` = [how much more the grains absorb in water, share
/// that the water's surface returns] and the share `entry` of the light that never enters.
pub fn soaked(dry: f64, light: [f64; 2], entry: f64) -> f64 {
    let [gain, returned] = light;
    let a_d = 1.0 - dry;
    let absorbed = a_d * ((1.0 - a_d) * gain + a_d);
    (1.0 - entry) * (1.0 - absorbed / (1.0 - returned * (1.0 - absorbed)))
}

/// Integral over the directions inside the water, cut where total reflection begins.
fn inside(n: f64, f: impl Fn(f64) -> f64) -> f64 {
    let critical = (1.0 - 1.0 / (n * n)).sqrt();
    // Near the critical angle F falls like a square root: c = critical + (1 − critical) u² is smooth there.
    let total = simpson(0.0, critical, 2000, |c| if c > 0.0 { 2.0 * c * f(c) } else { 0.0 });
    let span = 1.0 - critical;
    total
        + simpson(0.0, 1.0, 2000, |u| {
            let c = critical + span * u * u;
            2.0 * c * f(c) * 2.0 * span * u
        })
}

/// Two layers: smooth water of index `n`, depth × absorption = `optical_depth`, over a Lambertian body of albedo `b`.
/// Light at `cos` in the air is refracted in, attenuated, scattered, and at the surface partly returned, bounce by
/// bounce until nothing is left. The albedo without the mirror on top.
pub fn two_layers(b: f64, n: f64, cos: f64, optical_depth: f64) -> f64 {
    let refracted = (1.0 - (1.0 - cos * cos) / (n * n)).sqrt();
    let arrives = (1.0 - fresnel(cos, n)) * (-optical_depth / refracted).exp();
    let leaves = inside(n, |c| (1.0 - fresnel(c, 1.0 / n)) * (-optical_depth / c).exp());
    let returns = inside(n, |c| fresnel(c, 1.0 / n) * (-2.0 * optical_depth / c).exp());
    let (mut light, mut out) = (arrives, 0.0);
    for _ in 0..2000 {
        light *= b;
        out += light * leaves;
        light *= returns;
    }
    out
}

/// Light that water of an optical depth scatters once into a ray that goes up with cosine `mu` under water, for an even
/// sky of radiance 1, without the way out through the surface: scattering over all losses is 1, phase function of Henyey &
/// Greenstein 1941 with mean cosine `g`. Sum over the cone of refracted sky.
pub fn scattered_once(mu: f64, g: f64, n: f64, optical_depth: f64) -> f64 {
    const RINGS: usize = 120;
    const SPOKES: usize = 60;
    let edge = (1.0 - 1.0 / (n * n)).sqrt();
    let mut sum = 0.0;
    for i in 0..RINGS {
        let down = edge + (1.0 - edge) * (i as f64 + 0.5) / RINGS as f64;
        let in_air = (1.0 - n * n * (1.0 - down * down)).max(0.0).sqrt();
        let way = 1.0 / mu + 1.0 / down;
        let met = down / (mu + down) * (1.0 - (-optical_depth * way).exp());
        for j in 0..SPOKES {
            let turn = core::f64::consts::TAU * (j as f64 + 0.5) / SPOKES as f64;
            let cos = ((1.0 - mu * mu) * (1.0 - down * down)).sqrt() * turn.cos() - mu * down;
            let phase = (1.0 - g * g) / (4.0 * core::f64::consts::PI * (1.0 + g * g - 2.0 * g * cos).powf(1.5));
            sum += phase * (1.0 - fresnel(in_air, n)) * met;
        }
    }
    sum * (1.0 - edge) / RINGS as f64 * core::f64::consts::TAU / SPOKES as f64
}
