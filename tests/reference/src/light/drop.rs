//! Rays traced through a falling drop: hit by small steps and halving, Fresnel's amplitudes of both polarisations with
//! the plane of incidence turning from surface to surface, total reflection with its phases.
//!
//! Lengths in D/2, y up. A line of sight is followed backwards, from the eye into the drop and out to where its light
//! comes from; what unpolarised light loses does not depend on the sense.

use super::sphere::{Vector, dot, mirrored, plus, refracted, unit};
use crate::drop::{cosine_terms, printed_radius, volume};

/// A body of revolution about the vertical.
#[derive(Debug, Clone)]
pub enum Shape {
    /// r = Σ aₙ cos nθ, θ from downward.
    Series(Vec<f64>),
    /// Two half spheroids on one circle of radius 1 around the origin: height of the upper, of the lower one.
    Halves(f64, f64),
}

impl Shape {
    /// The unit sphere.
    pub fn sphere() -> Self {
        Self::Series(vec![1.0])
    }

    /// Beard & Chuang 1987 with the volume of the unit sphere.
    pub fn falling(diameter_mm: f64) -> Self {
        let mut terms = cosine_terms(diameter_mm);
        let scale = volume(|theta| printed_radius(&terms, theta)).powf(-1.0 / 3.0);
        terms[0] += 1.0;
        Self::Series(terms.iter().map(|a| a * scale).collect())
    }

    /// Negative inside, positive outside.
    fn outside(&self, p: Vector) -> f64 {
        match self {
            Self::Series(terms) => {
                let length = dot(p, p).sqrt();
                let theta = (-p[1] / length.max(1e-300)).clamp(-1.0, 1.0).acos();
                let radius: f64 = terms
                    .iter()
                    .enumerate()
                    .map(|(n, a)| a * (n as f64 * theta).cos())
                    .sum();
                length - radius
            }
            Self::Halves(upper, lower) => p[0].hypot(p[2]).hypot(p[1] / if p[1] > 0.0 { upper } else { lower }) - 1.0,
        }
    }

    /// Outward unit normal, by differences of [`Shape::outside`].
    fn normal(&self, p: Vector) -> Vector {
        let h = 1e-4;
        unit([0, 1, 2].map(|i| {
            let at = |step: f64| {
                let mut q = p;
                q[i] += step;
                self.outside(q)
            };
            // Fourth order: 1e-12.
            (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h)
        }))
    }

    /// Radius and height of the widest circle, by looking at many points.
    pub fn widest(&self) -> [f64; 2] {
        let at = |i: u32| {
            let theta = core::f64::consts::PI * f64::from(i) / 20_000.0;
            let towards = [theta.sin(), -theta.cos(), 0.0];
            let r = crate::numerics::bisect(0.0, 3.0, |r| self.outside(towards.map(|c| r * c)));
            [r * towards[0], r * towards[1]]
        };
        (0..=20_000)
            .map(at)
            .fold([0.0; 2], |best, p| if p[0] > best[0] { p } else { best })
    }

    /// Lowest and highest point.
    pub fn ends(&self) -> [f64; 2] {
        [-1.0, 1.0].map(|y| crate::numerics::bisect(0.0, 3.0, |length| self.outside([0.0, y * length, 0.0])) * y)
    }

    /// The first point on the way from `from` along `direction` where the sign changes: steps of 1/50 from 1/1000 on,
    /// then halving.
    fn hit(&self, from: Vector, direction: Vector) -> Option<Vector> {
        let sign = self.outside(plus(from, direction, 1e-3)) > 0.0;
        let mut before = 1e-3;
        while before < 8.0 {
            let after = before + 0.02;
            if (self.outside(plus(from, direction, after)) > 0.0) != sign {
                let (mut a, mut b) = (before, after);
                for _ in 0..50 {
                    let middle = 0.5 * (a + b);
                    if (self.outside(plus(from, direction, middle)) > 0.0) == sign {
                        a = middle;
                    } else {
                        b = middle;
                    }
                }
                return Some(plus(from, direction, 0.5 * (a + b)));
            }
            before = after;
        }
        None
    }
}

/// A complex number.
type Complex = [f64; 2];

fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

fn over(a: Complex, b: Complex) -> Complex {
    let square = b[0] * b[0] + b[1] * b[1];
    times(a, [b[0] / square, -b[1] / square])
}

/// Amplitudes (s, p) reflected, by the complex cosine beyond the surface; |·|² is the reflectance.
fn reflected_amplitudes(cosine: f64, before: f64, beyond: f64) -> [Complex; 2] {
    let square = 1.0 - (before / beyond).powi(2) * (1.0 - cosine * cosine);
    let inner = if square >= 0.0 {
        [square.sqrt(), 0.0]
    } else {
        [0.0, (-square).sqrt()]
    };
    let ratio = |p: f64, q: f64| {
        let (a, b) = (p * cosine, inner.map(|c| q * c));
        over([a - b[0], -b[1]], [a + b[0], b[1]])
    };
    [ratio(before, beyond), ratio(beyond, before)]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// An axis that is not along `a`.
fn skew(a: Vector) -> Vector {
    if a[0].abs() < 0.5 {
        [1.0, 0.0, 0.0]
    } else {
        [0.0, 1.0, 0.0]
    }
}

/// A complex electric field, as a vector of real and one of imaginary parts.
type Field = [Vector; 2];

/// `field` of a ray along `from` after a surface with `normal` that turns it along `to`, each polarisation times its
/// amplitude. Along a ray s is across the plane of incidence and p = direction × s.
fn turned(field: Field, from: Vector, to: Vector, normal: Vector, amplitudes: [Complex; 2]) -> Field {
    let mut across = cross(from, normal);
    if dot(across, across) < 1e-20 {
        // Head on there is no plane of incidence: any will do.
        across = cross(from, skew(from));
    }
    let s = unit(across);
    let (p_from, p_to) = (cross(from, s), cross(to, s));
    let part = |axis: Vector| [dot(field[0], axis), dot(field[1], axis)];
    let (in_s, in_p) = (times(part(s), amplitudes[0]), times(part(p_from), amplitudes[1]));
    [0, 1].map(|i| plus(s.map(|c| c * in_s[i]), p_to, in_p[i]))
}

/// One way that light takes from the surroundings to the eye.
#[derive(Debug, Clone, Copy)]
pub struct Path {
    /// Where the light comes from, unit vector from the drop outward.
    pub direction: Vector,
    /// Share of that radiance which arrives.
    pub weight: f64,
    /// Inner reflections; `None` for the one outside.
    pub inner: Option<usize>,
}

/// What is seen in one direction.
#[derive(Debug, Clone)]
pub struct Seen {
    /// Where the line of sight meets the drop.
    pub point: Vector,
    /// Outward unit normal there.
    pub normal: Vector,
    /// The paths; those by total reflection inside have no share and are left out.
    pub paths: Vec<Path>,
}

impl Seen {
    /// Radiance for an environment.
    pub fn radiance(&self, environment: impl Fn(Vector) -> f64) -> f64 {
        self.paths
            .iter()
            .map(|path| path.weight * environment(path.direction))
            .sum()
    }
}

/// The line of sight along `view` (unit) through `through`, up to `orders` inner reflections or until 1e-7 of the light
/// is left; `None` where it misses.
pub fn see(shape: &Shape, through: Vector, view: Vector, index: f64, orders: usize) -> Option<Seen> {
    let point = shape.hit(plus(through, view, -4.0), view)?;
    let normal = shape.normal(point);
    let side = unit(cross(view, skew(view)));
    let other = cross(view, side);
    // Unpolarised: half of each of two fields across one another.
    let mut fields = [[side, [0.0; 3]], [other, [0.0; 3]]];
    let power =
        |fields: [Field; 2]| -> f64 { 0.5 * fields.iter().flatten().map(|part| dot(*part, *part)).sum::<f64>() };
    let through_of =
        |reflected: [Complex; 2]| reflected.map(|r| [(1.0 - r[0] * r[0] - r[1] * r[1]).max(0.0).sqrt(), 0.0]);

    let cosine = (-dot(view, normal)).clamp(0.0, 1.0);
    let reflected = reflected_amplitudes(cosine, 1.0, index);
    let away = mirrored(view, normal);
    let mut paths = vec![Path {
        direction: away,
        weight: power(fields.map(|f| turned(f, view, away, normal, reflected))),
        inner: None,
    }];
    let mut direction = refracted(view, normal, 1.0 / index);
    fields = fields.map(|f| turned(f, view, direction, normal, through_of(reflected)));
    let mut place = point;
    for inner in 0..=orders {
        // A ray along the surface leaves the loop: nothing is left to hit.
        let Some(end) = shape.hit(place, direction) else { break };
        let inward = shape.normal(end).map(|c| -c);
        let cosine = (-dot(direction, inward)).clamp(0.0, 1.0);
        let reflected = reflected_amplitudes(cosine, index, 1.0);
        if index * index * (1.0 - cosine * cosine) < 1.0 {
            let out = refracted(direction, inward, index);
            paths.push(Path {
                direction: out,
                weight: power(fields.map(|f| turned(f, direction, out, inward, through_of(reflected)))),
                inner: Some(inner),
            });
        }
        let back = mirrored(direction, inward);
        if power(fields) < 1e-7 {
            break;
        }
        fields = fields.map(|f| turned(f, direction, back, inward, reflected));
        (direction, place) = (back, end);
    }
    Some(Seen { point, normal, paths })
}

/// What is seen on a grid of `side`² parallel lines of sight that covers the drop from −1.2 to 1.2 across and up: of
/// each that meets it, a point and what is seen.
pub fn picture(shape: &Shape, view: Vector, index: f64, orders: usize, side: u32) -> Vec<(Vector, Seen)> {
    let right = unit(cross(view, [0.0, 1.0, 0.0]));
    let up = cross(right, view);
    let middle = 0.5 * (shape.ends()[0] + shape.ends()[1]);
    let place = |i: u32| 2.4 * ((f64::from(i) + 0.5) / f64::from(side) - 0.5);
    (0..side * side)
        .filter_map(|i| {
            let through = plus(plus([0.0, middle, 0.0], right, place(i % side)), up, place(i / side));
            Some((through, see(shape, through, view, index, orders)?))
        })
        .collect()
}

/// Mean of an environment over the cap of half-angle `half` around `axis`, by rings of equal area.
pub fn cap_mean(environment: impl Fn(Vector) -> f64, axis: Vector, half: f64) -> f64 {
    let side = unit(cross(axis, skew(axis)));
    let other = cross(axis, side);
    let mut sum = 0.0;
    for ring in 0..100 {
        let cos = 1.0 - (1.0 - half.cos()) * (f64::from(ring) + 0.5) / 100.0;
        let sin = (1.0 - cos * cos).sqrt();
        for spoke in 0..200 {
            let (y, x) = (core::f64::consts::TAU * (f64::from(spoke) + 0.5) / 200.0).sin_cos();
            sum += environment(plus(plus(axis.map(|c| c * cos), side, sin * x), other, sin * y));
        }
    }
    sum / 20_000.0
}

/// Luminance of the overcast sky over that of its zenith, (1 + 2 sin γ)/3 (CIE), over a ground of `ground`.
pub fn overcast(direction: Vector, ground: f64) -> f64 {
    if direction[1] > 0.0 {
        (1.0 + 2.0 * direction[1]) / 3.0
    } else {
        ground
    }
}

/// A lamp in the direction `towards` (unit) with a soft rim of `radius` rad, of radiance 1, in the dark.
pub fn lamp(direction: Vector, towards: Vector, radius: f64) -> f64 {
    (-(1.0 - dot(direction, towards)) / (1.0 - radius.cos())).exp()
}
