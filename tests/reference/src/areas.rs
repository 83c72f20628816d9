//! Rain areas the slow way: distances by searching along the outline, areas by counting cells.

use std::f64::consts::PI;

/// An outline about the origin.
#[derive(Debug, Clone)]
pub enum Outline {
    /// Everywhere.
    Plane,
    /// Half axes along x and y, m.
    Ellipse([f64; 2]),
    /// Corners, m.
    Polygon(Vec<[f64; 2]>),
}

/// What falls in it.
#[derive(Debug, Clone, Copy)]
pub enum Rain {
    /// mm/h.
    Shower(f64),
    /// Times the weather's.
    Multiple(f64),
    /// Times all.
    Factor(f64),
}

/// An area: centre (m), turn of its first axis (rad), outline, width of its edge (m), strength, rain.
#[derive(Debug, Clone)]
pub struct Area {
    /// m.
    pub centre: [f64; 2],
    /// rad.
    pub turn: f64,
    /// About the centre.
    pub outline: Outline,
    /// m.
    pub edge: f64,
    /// 0 to 1.
    pub strength: f64,
    /// What falls.
    pub rain: Rain,
}

/// Least value of a function with one minimum between two places: thirds are cut off.
fn least(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..95 {
        let third = (high - low) / 3.0;
        if f(low + third) < f(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    f(0.5 * (low + high))
}

/// Distance of (x, y) from the outline, negative inside, m.
pub fn distance(outline: &Outline, [x, y]: [f64; 2]) -> f64 {
    match outline {
        Outline::Plane => f64::NEG_INFINITY,
        Outline::Ellipse([a, b]) => {
            let away = |angle: f64| (x - a * angle.cos()).hypot(y - b * angle.sin());
            let steps = 720;
            let step = 2.0 * PI / f64::from(steps);
            let nearest = (0..steps)
                .map(f64::from)
                .min_by(|p, q| away(p * step).total_cmp(&away(q * step)))
                .unwrap_or(0.0);
            let found = least((nearest - 1.0) * step, (nearest + 1.0) * step, away);
            if (x / a).powi(2) + (y / b).powi(2) < 1.0 {
                -found
            } else {
                found
            }
        }
        Outline::Polygon(corners) => {
            let (mut nearest, mut turned) = (f64::INFINITY, 0.0);
            for (i, &[px, py]) in corners.iter().enumerate() {
                let [qx, qy] = corners[(i + 1) % corners.len()];
                let away = |t: f64| (x - px - t * (qx - px)).hypot(y - py - t * (qy - py));
                nearest = nearest.min(least(0.0, 1.0, away)).min(away(0.0)).min(away(1.0));
                let turn = (qy - y).atan2(qx - x) - (py - y).atan2(px - x);
                turned += turn - 2.0 * PI * (turn / (2.0 * PI)).round();
            }
            if f64::abs(turned) > PI { -nearest } else { nearest }
        }
    }
}

/// Weight of an area at (x, y).
pub fn weight(area: &Area, [x, y]: [f64; 2]) -> f64 {
    let (dx, dy) = (x - area.centre[0], y - area.centre[1]);
    let (c, s) = (area.turn.cos(), area.turn.sin());
    let d = distance(&area.outline, [c * dx + s * dy, c * dy - s * dx]);
    let inside = if area.edge == 0.0 {
        if d < 0.0 { 1.0 } else { 0.0 }
    } else {
        let t = (0.5 - d / area.edge).clamp(0.0, 1.0);
        3.0 * t * t - 2.0 * t * t * t
    };
    area.strength * inside
}

/// Rain rate at (x, y), mm/h, under the weather's, of which `outside` falls where no area is.
pub fn rate(areas: &[Area], outside: f64, weather: f64, place: [f64; 2]) -> f64 {
    let mut rate = outside * weather;
    for area in areas {
        rate = match area.rain {
            Rain::Shower(own) => rate.max(own * weight(area, place)),
            Rain::Multiple(share) => rate.max(share * weather * weight(area, place)),
            Rain::Factor(_) => rate,
        };
    }
    for area in areas {
        if let Rain::Factor(factor) = area.rain {
            let w = weight(area, place);
            rate *= w * factor + (1.0 - w);
        }
    }
    rate.min(500.0)
}

/// ∫ weight dA over a square of ±`half` about the centre, m², by `cells` squared points.
pub fn ground(area: &Area, half: f64, cells: u32) -> f64 {
    let edge = 2.0 * half / f64::from(cells);
    let at = |i: u32| (f64::from(i) + 0.5) * edge - half;
    let sum: f64 = (0..cells)
        .flat_map(|i| (0..cells).map(move |j| (i, j)))
        .map(|(i, j)| weight(area, [area.centre[0] + at(i), area.centre[1] + at(j)]))
        .sum();
    sum * edge * edge
}
