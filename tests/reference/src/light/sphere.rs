//! Rays traced through a sphere of water, vector by vector.

use super::fresnel;

/// x, y, z.
pub type Vector = [f64; 3];

pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn plus(a: Vector, b: Vector, s: f64) -> Vector {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

pub(super) fn unit(a: Vector) -> Vector {
    a.map(|c| c / dot(a, a).sqrt())
}

pub(super) fn mirrored(d: Vector, n: Vector) -> Vector {
    unit(plus(d, n, -2.0 * dot(d, n)))
}

/// Snell's law; `n` against the ray, `ratio` = index before / index beyond.
pub(super) fn refracted(d: Vector, n: Vector, ratio: f64) -> Vector {
    let c = -dot(d, n);
    let k = 1.0 - ratio * ratio * (1.0 - c * c);
    unit(plus(d.map(|x| x * ratio), n, ratio * c - k.max(0.0).sqrt()))
}

/// What leaves a unit sphere.
pub struct Ray {
    /// Unit vector.
    pub direction: Vector,
    /// Power of each polarisation (s, p) over that of the incident one.
    pub power: [f64; 2],
}

/// The rays that leave a unit sphere of `index` hit by a ray along `direction` where the outward normal is `normal`:
/// reflected outside, straight through, after one inner reflection, …, `orders` in all.
pub fn trace(direction: Vector, normal: Vector, index: f64, orders: usize) -> Vec<Ray> {
    let incidence = (-dot(direction, normal)).clamp(-1.0, 1.0).acos();
    let outside = fresnel(incidence, 1.0, index);
    let mut rays = vec![Ray {
        direction: mirrored(direction, normal),
        power: outside,
    }];
    let mut d = refracted(direction, normal, 1.0 / index);
    let mut power = outside.map(|f| 1.0 - f);
    let mut point = normal;
    while rays.len() < orders {
        // The other end of the chord.
        point = unit(plus(point, d, -2.0 * dot(point, d)));
        let inward = point.map(|c| -c);
        let inner_incidence = (-dot(d, inward)).clamp(-1.0, 1.0).acos();
        let inside = fresnel(inner_incidence, index, 1.0);
        rays.push(Ray {
            direction: refracted(d, inward, index),
            power: [0, 1].map(|i| power[i] * (1.0 - inside[i])),
        });
        power = [0, 1].map(|i| power[i] * inside[i]);
        d = mirrored(d, inward);
    }
    rays
}

/// The traced rays at impact parameter `s`, view along −z.
pub fn at_impact(s: f64, index: f64, orders: usize) -> Vec<Ray> {
    trace([0.0, 0.0, -1.0], [s, 0.0, (1.0 - s * s).sqrt()], index, orders)
}

/// Angle of the straight refracted ray from straight on.
pub fn deviation(s: f64, index: f64) -> f64 {
    let d = at_impact(s, index, 2)[1].direction;
    d[0].hypot(d[1]).atan2(-d[2])
}

/// Shares of each order over the disc: rings of equal width in the angle of incidence.
pub fn energy(index: f64, orders: usize) -> Vec<f64> {
    let rings = 4000;
    let mut shares = vec![0.0; orders];
    for i in 0..rings {
        let theta = (f64::from(i) + 0.5) / f64::from(rings) * core::f64::consts::FRAC_PI_2;
        let weight = core::f64::consts::FRAC_PI_2 / f64::from(rings) * (2.0 * theta).sin();
        for (share, ray) in shares.iter_mut().zip(at_impact(theta.sin(), index, orders)) {
            *share += weight * 0.5 * (ray.power[0] + ray.power[1]);
        }
    }
    shares
}

/// Angle from the antisolar point of the brightest ray with `reflections` inner reflections, by a search over s, and s.
pub fn bow(reflections: usize, index: f64) -> (f64, f64) {
    let angle = |s: f64| {
        let d = at_impact(s, index, reflections + 2)[reflections + 1].direction;
        // Straight back is +z.
        d[0].hypot(d[1]).atan2(d[2])
    };
    // One inner reflection: the widest angle; two: the narrowest.
    let better = |a: f64, b: f64| if reflections % 2 == 1 { a > b } else { a < b };
    let mut best = (angle(0.7), 0.7);
    for i in 0..=3000 {
        let s = 0.7 + 0.2999 * f64::from(i) / 3000.0;
        if better(angle(s), best.0) {
            best = (angle(s), s);
        }
    }
    let (mut a, mut b) = (best.1 - 2e-4, best.1 + 2e-4);
    for _ in 0..100 {
        let (p, q) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
        if better(angle(p), angle(q)) {
            b = q;
        } else {
            a = p;
        }
    }
    (angle(0.5 * (a + b)), 0.5 * (a + b))
}
