//! Rain against triangles, the slow way: the way of every drop against every triangle.

/// A triangle's corners (x, y, z), y up, m.
pub type Triangle = [[f64; 3]; 3];

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Six times the volume of the tetrahedron that three vectors span.
fn volume(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// Where the line through `point` along `way` goes through a triangle, its rim included. `None` where it passes beside
/// it, or runs in its plane.
///
/// The line winds the same way round all three edges (Plücker 1865); the volumes on the edges are the weights of the
/// corners opposite.
pub fn crossing(triangle: &Triangle, point: [f64; 3], way: [f64; 3]) -> Option<[f64; 3]> {
    let [a, b, c] = triangle.map(|corner| minus(corner, point));
    let w = [volume(way, b, c), volume(way, c, a), volume(way, a, b)];
    let sum = w[0] + w[1] + w[2];
    let inside = w.iter().all(|w| *w >= 0.0) || w.iter().all(|w| *w <= 0.0);
    if !inside || sum == 0.0 {
        return None;
    }
    Some([0, 1, 2].map(|i| point[i] + (w[0] * a[i] + w[1] * b[i] + w[2] * c[i]) / sum))
}

/// The 12 triangles of an axis-parallel box.
pub fn block(low: [f64; 3], high: [f64; 3]) -> Vec<Triangle> {
    let corner = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { low[axis] } else { high[axis] });
    [
        [0, 1, 3, 2],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 3, 7, 6],
        [0, 2, 6, 4],
        [1, 3, 7, 5],
    ]
    .iter()
    .flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]])
    .map(|t| t.map(corner))
    .collect()
}

/// Velocity of a drop: `wind` (x, z) sideways, `speed` down, m/s.
fn velocity(wind: [f64; 2], speed: f64) -> [f64; 3] {
    [wind[0], -speed, wind[1]]
}

/// Height of the highest triangle that a drop had to pass on its way to `point`. `None`: it comes from the sky.
pub fn stopped_at(triangles: &[Triangle], point: [f64; 3], wind: [f64; 2], speed: f64) -> Option<f64> {
    let mut highest = None;
    for triangle in triangles {
        if let Some(at) = crossing(triangle, point, velocity(wind, speed))
            && at[1] > point[1]
            && highest.is_none_or(|height| at[1] > height)
        {
            highest = Some(at[1]);
        }
    }
    highest
}

/// Height of the highest triangle on the whole way, up and down, of a drop that passes `point`.
pub fn highest_on_the_way(triangles: &[Triangle], point: [f64; 3], wind: [f64; 2], speed: f64) -> Option<f64> {
    triangles
        .iter()
        .filter_map(|triangle| crossing(triangle, point, velocity(wind, speed)))
        .map(|at| at[1])
        .max_by(f64::total_cmp)
}

/// Where a drop that passes `point` meets the level `height`, or met it: (x, z).
pub fn met_level(point: [f64; 3], height: f64, wind: [f64; 2], speed: f64) -> [f64; 2] {
    let seconds = (point[1] - height) / speed;
    [point[0] + wind[0] * seconds, point[2] + wind[1] * seconds]
}

/// Angle between two directions, rad.
pub fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    let length = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let (a, b) = (a.map(|x| x / length(a)), b.map(|x| x / length(b)));
    // Half the chord: no cancellation for small angles.
    2.0 * (0.5 * length(minus(a, b))).min(1.0).asin()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A roof 3 m high over 0 ≤ x ≤ 4, 0 ≤ z ≤ 2.
    fn roof() -> [Triangle; 2] {
        let [a, b, c, d] = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]].map(|[x, z]| [x, 3.0, z]);
        [[a, b, c], [a, c, d]]
    }

    #[test]
    fn a_roof_stops_what_fell_through_it() {
        let stopped = |x: f64, y: f64, wind: f64| stopped_at(&roof(), [x, y, 1.0], [wind, 0.0], 5.0);
        assert_eq!(stopped(2.0, 1.0, 0.0), Some(3.0));
        assert_eq!(stopped(5.0, 1.0, 0.0), None);
        assert_eq!(stopped(2.0, 3.5, 0.0), None, "above it");
        assert_eq!(stopped(2.0, 3.0, 0.0), None, "on it");
        // 2 m down at 5 m/s take 0.4 s: 10 m/s carry the drop 4 m.
        assert_eq!(stopped(3.9, 1.0, 10.0), None);
        assert_eq!(stopped(4.1, 1.0, 10.0), Some(3.0));
        assert_eq!(stopped(7.9, 1.0, 10.0), Some(3.0));
        assert_eq!(stopped(8.1, 1.0, 10.0), None);
        assert_eq!(highest_on_the_way(&roof(), [2.0, 3.5, 1.0], [0.0, 0.0], 5.0), Some(3.0));
        assert_eq!(met_level([4.0, 1.0, 1.0], 3.0, [10.0, 0.0], 5.0), [0.0, 1.0]);
        // The rim between both halves belongs to the roof, and a wall is no roof to what falls along it.
        assert_eq!(stopped_at(&roof(), [2.0, 0.0, 1.0], [0.0, 0.0], 5.0), Some(3.0));
        let wall = [[[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 3.0, 0.0]]];
        assert_eq!(stopped_at(&wall, [2.0, 0.0, 0.0], [0.0, 0.0], 5.0), None);
        assert!((angle([1.0, 0.0, 0.0], [1.0, 1e-9, 0.0]) - 1e-9).abs() < 1e-24);
        assert!((angle([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]) - core::f64::consts::PI).abs() < 1e-15);
    }
}
