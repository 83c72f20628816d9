//! The lower body: sides with wheel arches, nose, tail, bonnet, closed underside.

use super::{CarMat, CarParts, FRONT_AXLE_Z, REAR_AXLE_Z, UNDERSIDE_Y, shell};
use crate::mesh::{ALL, BACK, Frame, cos_sin};
use crate::noise::smoothstep;
use glam::{Vec2, Vec3, vec2, vec3};

/// Half the car's length, metres.
pub const HALF_LENGTH: f32 = 2.08;
/// Half the car's width, metres.
pub const HALF_WIDTH: f32 = 0.865;
/// Half the length of a wheel arch, metres.
const ARCH: f32 = 0.375;
/// Top of the wheel arches, metres.
const ARCH_TOP: f32 = 0.675;
/// How far in the wheel houses reach, metres from the middle plane.
const HOUSE_X: f32 = 0.58;
/// Heights of the side's rows, as shares of the way from its lower edge to the shoulder.
const SIDE_ROWS: [f32; 8] = [0.0, 0.16, 0.32, 0.45, 0.58, 0.7, 0.85, 1.0];
/// Rows that round the shoulder: (inset, rise) in metres.
const SHOULDER: [(f32, f32); 3] = [(0.008, 0.03), (0.03, 0.052), (0.065, 0.065)];
/// Rows from the shoulder to the middle plane, as shares.
const DECK: [f32; 7] = [0.08, 0.2, 0.36, 0.54, 0.72, 0.88, 1.0];

/// The side's columns: z in falling order, wheel arches sampled finely.
fn side_columns() -> Vec<f32> {
    let mut z = vec![1.84, 1.78, 1.71];
    let arch = |axle: f32| (0..=14).map(move |k| axle + ARCH * cos_sin(std::f32::consts::PI * (k as f32 / 14.0)).0);
    z.extend(arch(FRONT_AXLE_Z));
    z.extend([0.8, 0.64, 0.4, 0.1, -0.2, -0.34, -0.6, -0.76]);
    z.extend(arch(REAR_AXLE_Z));
    z.extend([-1.68, -1.76, -1.84]);
    z
}

/// Height of the side's upper edge at z: low at the nose, rising to the tail.
fn shoulder(z: f32) -> f32 {
    0.62 + 0.17 * smoothstep(2.3, 0.6, z).clamp(0.0, 1.0) + 0.035 * smoothstep(0.9, -1.9, z)
        - 0.05 * smoothstep(1.5, 2.1, z)
}

fn arch_of(z: f32) -> Option<f32> {
    [FRONT_AXLE_Z, REAR_AXLE_Z]
        .into_iter()
        .find(|a| (z - a).abs() < ARCH + 1e-4)
}

/// Lower edge of the side at z: the sill, or the arch over a wheel.
fn lower_edge(z: f32) -> f32 {
    arch_of(z).map_or(UNDERSIDE_Y, |axle| {
        let t = f64::from(((z - axle) / ARCH).abs().min(1.0));
        let round = rain_core::ops::pow((1.0 - rain_core::ops::pow(t, 2.3)).max(0.0), 1.0 / 2.3) as f32;
        UNDERSIDE_Y + (ARCH_TOP - UNDERSIDE_Y) * round
    })
}

/// How far the skin lies inside the outline at height `y`: in x, and in z at the nose and the tail.
fn inset(y: f32, z: f32) -> (f32, f32) {
    let side = 0.05 * smoothstep(0.42, 0.16, y) + 0.028 * smoothstep(0.62, 0.9, y);
    let end = if z > 0.0 {
        0.05 * smoothstep(0.34, 0.19, y) + 0.05 * smoothstep(0.47, 0.52, y) + 0.07 * smoothstep(0.52, 0.72, y)
    } else {
        0.06 * smoothstep(0.36, 0.19, y) + 0.05 * smoothstep(0.5, 0.55, y) + 0.06 * smoothstep(0.55, 0.95, y)
    };
    (side, end)
}

/// A point of the outline at height `y`.
fn skin(o: Vec2, y: f32) -> Vec3 {
    let (side, end) = inset(y, o.y);
    let x = o.x * (1.0 - side / HALF_WIDTH);
    vec3(x, y, o.y - o.y.signum() * end * smoothstep(1.62, 2.0, o.y.abs()))
}

/// Height of the bonnet and of the deck under the cabin above the shoulder, at share `t` of the way to the middle.
fn crown(z: f32, t: f32) -> f32 {
    // No rise at the very ends, where all columns meet in the middle of the nose and of the tail.
    let high = 0.075 * (1.0 - smoothstep(1.3, 1.99, z.abs()));
    high * (1.0 - (1.0 - t) * (1.0 - t))
}

fn point(o: Vec2, j: usize) -> Vec3 {
    let top = shoulder(o.y);
    if j < SIDE_ROWS.len() {
        let low = lower_edge(o.y);
        return skin(o, low + (top - low) * SIDE_ROWS[j]);
    }
    let edge = skin(o, top);
    let j = j - SIDE_ROWS.len();
    let scale = |p: Vec3, inset: f32| {
        // Inwards in x, and at the ends in z as well, so that nose and tail are rounded too.
        let end = smoothstep(1.6, 2.0, o.y.abs()) * o.y.signum();
        vec3(p.x - inset * (p.x / HALF_WIDTH), p.y, p.z - inset * end)
    };
    if j < SHOULDER.len() {
        let (inset, rise) = SHOULDER[j];
        return scale(edge, inset) + Vec3::Y * rise;
    }
    let (inset, rise) = SHOULDER[SHOULDER.len() - 1];
    let p = scale(edge, inset) + Vec3::Y * rise;
    let t = DECK[j - SHOULDER.len()];
    // The ends of the deck draw back a little: an outline in plan that is curved, not square.
    vec3(p.x * (1.0 - t), p.y + crown(o.y, t), p.z)
}

/// Builds the lower body with its lamps, plates, mirrors, door seams and underside.
pub fn build(parts: &mut CarParts) {
    let columns = shell::outline(vec2(HALF_WIDTH, HALF_LENGTH), 6, &side_columns());
    let rows = SIDE_ROWS.len() + SHOULDER.len() + DECK.len();
    let choose = |k: usize, j: usize| {
        let mid = 0.5 * (columns[k] + columns[k + 1]);
        let (x, z) = (mid.x / HALF_WIDTH, mid.y);
        let lamp_corner = x > 0.56 && z > 1.72;
        Some(match j {
            0 | 1 if z.abs() > 1.7 => CarMat::Plastic,
            0 if arch_of(z).is_none() => CarMat::Plastic,
            2 | 3 if z > 1.7 && x < 0.45 => CarMat::Plastic,
            5 | 6 if lamp_corner => CarMat::Headlamp,
            5 if z > 1.7 && x < 0.5 => CarMat::Plastic,
            4..=6 if z < -1.8 && x > 0.66 => CarMat::Taillamp,
            _ => CarMat::Paint,
        })
    };
    shell::add(parts, columns.len(), rows, |k, j| point(columns[k], j), choose);
    underside(parts, &columns);
    seams(parts, &columns);
    fittings(parts);
}

/// A floor, and wheel houses let into it.
fn underside(parts: &mut CarParts, columns: &[Vec2]) {
    let m = parts.get(CarMat::Plastic);
    let y = UNDERSIDE_Y;
    for w in columns.windows(2) {
        let [a, b] = [point(w[0], 0), point(w[1], 0)];
        let in_arch = arch_of(0.5 * (w[0].y + w[1].y)).is_some();
        let limit = if in_arch { HOUSE_X } else { f32::MAX };
        let (xa, xb) = (a.x.min(limit), b.x.min(limit));
        if (a.z - b.z).abs() > 1e-5 && xa + xb > 1e-3 {
            m.quad(
                [vec3(-xa, y, a.z), vec3(-xb, y, b.z), vec3(xb, y, b.z), vec3(xa, y, a.z)],
                1.0,
            );
        }
        if in_arch {
            for s in [1.0_f32, -1.0] {
                let p = |x: f32, y: f32, z: f32| vec3(x * s, y, z);
                let order = |q: [Vec3; 4]| if s > 0.0 { q } else { [q[1], q[0], q[3], q[2]] };
                let roof = [
                    p(HOUSE_X, b.y, b.z),
                    p(a.x.min(b.x), b.y, b.z),
                    p(a.x, a.y, a.z),
                    p(HOUSE_X, a.y, a.z),
                ];
                m.quad(order(roof), 1.0);
                let wall = [
                    p(HOUSE_X, y, a.z),
                    p(HOUSE_X, y, b.z),
                    p(HOUSE_X, b.y, b.z),
                    p(HOUSE_X, a.y, a.z),
                ];
                m.quad(order(wall), 1.0);
            }
        }
    }
}

/// Gaps around the doors, and where the bonnet ends.
fn seams(parts: &mut CarParts, columns: &[Vec2]) {
    for z in [0.64_f32, -0.34] {
        let Some(&o) = columns
            .iter()
            .min_by(|a, b| (a.y - z).abs().total_cmp(&(b.y - z).abs()))
        else {
            continue;
        };
        for j in 1..SIDE_ROWS.len() {
            let [a, b] = [point(o, j - 1), point(o, j)].map(|p| p + vec3(0.0015, 0.0, 0.0));
            for s in [1.0_f32, -1.0] {
                let f = |p: Vec3, dz: f32| vec3(p.x * s, p.y, p.z + dz * s);
                parts
                    .get(CarMat::Plastic)
                    .quad([f(a, 0.004), f(a, -0.004), f(b, -0.004), f(b, 0.004)], 1.0);
            }
        }
    }
}

fn ellipsoid(parts: &mut CarParts, mat: CarMat, centre: Vec3, half: Vec3) {
    parts.get(mat).surface(14, 8, true, |i, j| {
        let (c, s) = cos_sin(-(i as f32) / 14.0 * std::f32::consts::TAU);
        let (cv, sv) = cos_sin((j as f32 / 8.0 - 0.5) * std::f32::consts::PI);
        (
            centre + half * vec3(cv * c, sv, cv * s),
            vec2(i as f32 / 14.0, -(j as f32) / 8.0),
        )
    });
}

fn fittings(parts: &mut CarParts) {
    for s in [1.0_f32, -1.0] {
        // Mirrors on their stalks, door handles.
        ellipsoid(
            parts,
            CarMat::Paint,
            vec3(0.93 * s, 0.97, 0.56),
            vec3(0.095, 0.065, 0.075),
        );
        let f = Frame::world(vec3(0.83 * s, 0.9, 0.57));
        parts
            .get(CarMat::Plastic)
            .block(&f, [-0.05, -0.01, -0.03], [0.06, 0.05, 0.03], 1.0, ALL);
        for z in [-0.16, -0.62] {
            let f = Frame::world(vec3(0.848 * s, 0.73, z));
            parts
                .get(CarMat::Plastic)
                .block(&f, [-0.012, -0.014, -0.09], [0.012, 0.014, 0.0], 1.0, ALL);
        }
        // Fog lamps in the bumper.
        ellipsoid(
            parts,
            CarMat::Alloy,
            vec3(0.52 * s, 0.32, 1.985),
            vec3(0.06, 0.035, 0.03),
        );
    }
    let front = Frame::facing(vec3(0.0, 0.36, HALF_LENGTH - 0.012), Vec3::Z);
    parts
        .get(CarMat::Plate)
        .block(&front, [-0.26, -0.055, -0.02], [0.26, 0.055, 0.02], 1.0, ALL & !BACK);
    let rear = Frame::facing(vec3(0.0, 0.62, -HALF_LENGTH + 0.065), Vec3::NEG_Z);
    parts
        .get(CarMat::Plate)
        .block(&rear, [-0.26, -0.055, -0.02], [0.26, 0.055, 0.012], 1.0, ALL & !BACK);
    // Badge, exhaust.
    let badge = Frame::facing(vec3(0.0, 0.535, HALF_LENGTH - 0.1), Vec3::Z);
    parts
        .get(CarMat::Alloy)
        .block(&badge, [-0.055, -0.035, -0.02], [0.055, 0.035, 0.03], 1.0, ALL & !BACK);
    parts.get(CarMat::Alloy).tube(
        vec3(-0.5, 0.225, -1.9),
        vec3(-0.5, 0.225, -2.06),
        [0.032, 0.032],
        10,
        1.0,
        true,
    );
}
