//! The ellipse x²/a² + y²/b² = 1 about the origin: nearest point, distance, tangents, rays.

use glam::{DVec2, Vec2Swizzles};

use crate::ops;

/// Steps of Newton's method; it is done after four to six.
const STEPS: u32 = 24;

/// The point of the ellipse nearest to `p` (m). `radii_m`: a along x, b along y, both above 0, in either order.
///
/// Newton's method on 1/‖q(w)‖, concave and rising in w, from the left: it approaches the root from one side and never
/// fails. Of several nearest points (on the middle of the long axis) the one with positive coordinates is taken. What is
/// not finite counts as the origin.
///
/// Error: 1e-12 of the larger radius and the distance, against bisection.
#[must_use]
pub fn ellipse_nearest(p: DVec2, radii_m: DVec2) -> DVec2 {
    let p = if p.is_finite() { p } else { DVec2::ZERO };
    let swap = radii_m.x < radii_m.y;
    let (p, radii) = if swap { (p.yx(), radii_m.yx()) } else { (p, radii_m) };
    let (a, b) = (radii.x, radii.y);
    let (x, y) = (p.x.abs(), p.y.abs());
    let gap = (a - b) * (a + b);
    let mut w = (b * y).max(a * x - gap);
    let q = if w > 0.0 {
        for _ in 0..STEPS {
            let (u, v) = (a * x / (w + gap), b * y / w);
            let square = u * u + v * v;
            let slope = u * u / (w + gap) + v * v / w;
            let step = square / slope * (square.sqrt() - 1.0);
            w += step.max(0.0);
            if step <= 1e-16 * w {
                break;
            }
        }
        let q = DVec2::new(a * x / (w + gap), b * y / w);
        DVec2::new(a * q.x, b * q.y)
    } else if gap > 0.0 {
        let k = (a * x / gap).min(1.0);
        DVec2::new(a * k, b * ((1.0 - k) * (1.0 + k)).sqrt())
    } else {
        DVec2::new(a, 0.0)
    };
    let q = DVec2::new(q.x.copysign(p.x), q.y.copysign(p.y));
    if swap { q.yx() } else { q }
}

/// Signed distance from the ellipse: negative inside. Units: m. Arguments as [`ellipse_nearest`].
///
/// Error: 1e-12 of the larger radius and the distance, against bisection.
#[must_use]
pub fn ellipse_distance(p: DVec2, radii_m: DVec2) -> f64 {
    let p = if p.is_finite() { p } else { DVec2::ZERO };
    let distance = (p - ellipse_nearest(p, radii_m)).length();
    if (p / radii_m).length_squared() < 1.0 {
        -distance
    } else {
        distance
    }
}

/// [`ellipse_distance`] in single precision, as the shader has it.
///
/// Error: 2e-6 of the larger radius and the distance, for radii within 1000 times each other.
#[must_use]
pub fn ellipse_distance_f32(p: [f32; 2], radii_m: [f32; 2]) -> f32 {
    let [mut x, mut y] = p.map(|v| if v.is_finite() { v.abs() } else { 0.0 });
    let [mut a, mut b] = radii_m;
    if a < b {
        (x, y, a, b) = (y, x, b, a);
    }
    let gap = (a - b) * (a + b);
    let mut w = (b * y).max(a * x - gap);
    let (qx, qy) = if w > 1e-6 * b * b {
        for _ in 0..STEPS {
            let (u, v) = (a * x / (w + gap), b * y / w);
            let square = u * u + v * v;
            let slope = u * u / (w + gap) + v * v / w;
            let step = square / slope * (square.sqrt() - 1.0);
            w += step.max(0.0);
            if step <= 1e-7 * w {
                break;
            }
        }
        (a * (a * x / (w + gap)), b * (b * y / w))
    } else if gap > 0.0 {
        let k = (a * x / gap).min(1.0);
        (a * k, b * ((1.0 - k) * (1.0 + k)).sqrt())
    } else {
        (a, 0.0)
    };
    let (dx, dy) = (x - qx, y - qy);
    let distance = (dx * dx + dy * dy).sqrt();
    let (ux, uy) = (x / a, y / b);
    if ux * ux + uy * uy < 1.0 { -distance } else { distance }
}

/// The two points whose tangents meet in `p` (m), that of the smaller angle parameter first; none from inside or on the
/// ellipse.
///
/// Error: 1e-11 of the larger radius: each point is on the ellipse and its tangent passes through `p`.
#[must_use]
pub fn ellipse_tangents(p: DVec2, radii_m: DVec2) -> Option<[DVec2; 2]> {
    let u = p / radii_m;
    let far = u.length();
    if !far.is_finite() || far <= 1.0 {
        return None;
    }
    // In the plane scaled to the unit circle the points lie about `u` by an angle of cosine 1/|u|.
    let (along, cosine) = (u / far, 1.0 / far);
    let sine = ((far - 1.0) * (far + 1.0)).sqrt() / far;
    let across = DVec2::new(-along.y, along.x);
    Some([
        (along * cosine - across * sine) * radii_m,
        (along * cosine + across * sine) * radii_m,
    ])
}

/// Where a ray from `p` (m) along `direction` (any length but 0) is in the ellipse: the entry's and the exit's distance.
/// Units: m. None where it misses or only touches; an entry behind `p` is 0.
///
/// Error: 1e-11 of the larger radius and the distance: both points are on the ellipse.
#[must_use]
pub fn ellipse_ray(p: DVec2, direction: DVec2, radii_m: DVec2) -> Option<[f64; 2]> {
    let e = direction.try_normalize()?;
    let (u, d) = (p / radii_m, e / radii_m);
    let (a, b) = (d.length_squared(), u.dot(d));
    // |u × d|² is the discriminant's part that does not cancel: B² − A·K = A − (u × d)².
    let cross = u.perp_dot(d);
    let square = a - cross * cross;
    if square.is_nan() || square <= 0.0 {
        return None;
    }
    let root = ops::sqrt(square);
    let (near, far) = ((-b - root) / a, (-b + root) / a);
    (far > 0.0).then_some([near.max(0.0), far])
}
