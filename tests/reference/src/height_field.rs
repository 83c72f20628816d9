//! The highest triangle over a point, the slow way.

/// A triangle's corners (x, y, z), y up.
pub type Triangle = [[f64; 3]; 3];

/// Twice the area of (a, b, p) in the (x, z) plane: positive where a → b → p turns from x towards z.
fn area2(a: [f64; 3], b: [f64; 3], p: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (p[1] - a[2]) - (b[2] - a[2]) * (p[0] - a[0])
}

/// Height of the highest triangle that faces up and whose rim, moved outwards by `grow` (units: m, may be negative),
/// has (x, z) inside it. NaN where there is none.
pub fn highest(triangles: &[Triangle], x: f64, z: f64, grow: f64) -> f64 {
    let mut best = f64::NAN;
    for &[a, b, c] in triangles {
        // Right-hand rule with y up: what faces up turns from z towards x.
        let twice = -area2(a, b, [c[0], c[2]]);
        if twice.is_nan() || twice <= 0.0 {
            continue;
        }
        let edges = [(b, c), (c, a), (a, b)];
        let inside = edges.iter().all(|&(from, to)| {
            let length = (to[0] - from[0]).hypot(to[2] - from[2]);
            -area2(from, to, [x, z]) >= -grow * length
        });
        if !inside {
            continue;
        }
        // Height by Cramer's rule in the plane through the corners.
        let u = -area2(c, a, [x, z]) / twice;
        let v = -area2(a, b, [x, z]) / twice;
        let y = a[1] + u * (b[1] - a[1]) + v * (c[1] - a[1]);
        if best.is_nan() || y > best {
            best = y;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tilted_triangle_over_its_middle() {
        let up = [[0.0, 1.0, 0.0], [0.0, 2.0, 2.0], [2.0, 3.0, 0.0]];
        assert!((highest(&[up], 0.5, 0.5, 0.0) - 1.75).abs() < 1e-15);
        assert!(highest(&[up], 1.5, 1.5, 0.0).is_nan());
        let [a, b, c] = up;
        assert!(highest(&[[a, c, b]], 0.5, 0.5, 0.0).is_nan(), "faces down");
    }
}
