//! Lightning, thunder and gusts.

use core::f64::consts::PI;

use crate::numerics::simpson;

/// Speed of sound from pressure and density of an ideal diatomic gas of molar mass 28.965 g/mol, m/s.
pub fn sound_speed(celsius: f64) -> f64 {
    let pressure = 101_325.0;
    let density = pressure * 0.028_965 / (8.314_46 * (celsius + 273.15));
    (7.0 / 5.0 * pressure / density).sqrt()
}

/// How far a ray that grazes the ground gets until it has risen to a height, m: Snell's law through air whose temperature
/// falls by `lapse` K/m, in small steps.
pub fn grazing_ray(height: f64, kelvin: f64, lapse: f64) -> f64 {
    // With z = h s² the start is no pole.
    simpson(0.0, 1.0, 2000, |s| {
        let z = height * s * s;
        let speed = ((kelvin - lapse * z) / kelvin).sqrt();
        let (cos, sin) = (speed, (1.0 - speed * speed).max(0.0).sqrt());
        if sin == 0.0 {
            2.0 * height * (kelvin / (lapse * height)).sqrt()
        } else {
            cos / sin * 2.0 * height * s
        }
    })
}

/// Mean of a stroke's current over an interval after it, A: a plain sum of many small steps.
pub fn mean_current(peak: f64, continuing: f64, from: f64, to: f64) -> f64 {
    let current = |t: f64| {
        if t < 0.0 {
            return 0.0;
        }
        let pulse = peak * (-t / 150e-6).exp() + peak / 30.0 * (-t / 2e-3).exp();
        pulse + if t < continuing { 100.0 } else { 0.0 }
    };
    // Where the current jumps, pieces end; where it falls steeply, they are short.
    let mut ends = vec![from, to];
    ends.extend(
        [0.0, 0.5e-3, 1e-3, 2e-3, 5e-3, 0.02, continuing]
            .into_iter()
            .filter(|t| *t > from && *t < to),
    );
    ends.sort_by(f64::total_cmp);
    let sum: f64 = ends
        .windows(2)
        .map(|p| {
            let edge = 1e-12 * (p[1] - p[0]);
            simpson(p[0] + edge, p[1] - edge, 2000, current)
        })
        .sum();
    sum / (to - from)
}

/// What a path of straight pieces gives a place, lx per lm/m: each piece cut into many points.
pub fn line_illuminance(path: &[[f64; 3]], place: [f64; 3]) -> f64 {
    let mut lux = 0.0;
    for piece in path.windows(2) {
        let cuts = 50;
        let length = distance(piece[0], piece[1]) / f64::from(cuts);
        for i in 0..cuts {
            let s = (f64::from(i) + 0.5) / f64::from(cuts);
            let at = core::array::from_fn(|k| piece[0][k] + s * (piece[1][k] - piece[0][k]));
            lux += length / (4.0 * PI * distance(at, place).powi(2));
        }
    }
    lux
}

/// Between two places.
pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

/// Kaimal's spectrum n S/σ² at a reduced frequency.
pub fn kaimal(f: f64) -> f64 {
    6.8 * f / (1.0 + 10.2 * f).powf(5.0 / 3.0)
}

/// Its share below a reduced frequency: the integral of n S/σ² over ln n.
pub fn kaimal_below(f: f64) -> f64 {
    // From where there is nothing left.
    simpson((1e-9_f64).ln(), f.ln(), 20_000, |ln| kaimal(ln.exp()))
}

/// A drop of this terminal speed in a wind that swings, du/dt = (g/v)(U − u), and its mean speed over an interval: small
/// steps of Runge and Kutta from `before` seconds earlier, at rest with the mean wind.
pub fn swept(wind: impl Fn(f64) -> f64, terminal: f64, before: f64, from: f64, to: f64) -> f64 {
    let rate = 9.806_65 / terminal;
    let slope = |t: f64, u: f64| rate * (wind(t) - u);
    let walk = |u: &mut f64, path: &mut f64, start: f64, end: f64, steps: u32| {
        let h = (end - start) / f64::from(steps);
        for i in 0..steps {
            let t = start + h * f64::from(i);
            let a = slope(t, *u);
            let b = slope(t + h / 2.0, *u + h / 2.0 * a);
            let c = slope(t + h / 2.0, *u + h / 2.0 * b);
            let d = slope(t + h, *u + h * c);
            let next = *u + h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
            // Hermite's cubic between the two.
            let end_slope = slope(t + h, next);
            *path += h / 2.0 * (*u + next) + h * h / 12.0 * (a - end_slope);
            *u = next;
        }
    };
    let (mut u, mut unused, mut path) = (0.0, 0.0, 0.0);
    walk(&mut u, &mut unused, from - before, from, 40_000);
    walk(&mut u, &mut path, from, to, 4000);
    path / (to - from)
}
