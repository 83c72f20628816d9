//! The ground: a cambered carriageway with ruts and hollows, kerbs, gutters, drains, pavements, a small square, cross streets.

use crate::layout::{
    CROSS_FAR_Z, CROSS_HALF_X, CROSS_WALL_Z, DRAINS, FACADE_X, GUTTER_DEPTH, GUTTER_X, HOLLOWS, Hollow, KERB_HEIGHT,
    KERB_WIDTH, ROAD_HALF_LENGTH, ROAD_HALF_WIDTH, ROW_END_Z, RUT_DEPTH, RUT_HALF_WIDTH, RUT_X, SQUARE_X, SQUARE_Z,
};
use crate::materials::{Mat, Parts};
use crate::mesh::{Frame, Mesh};
use crate::noise::{smoothstep, value};
use crate::textures::ground::{ASPHALT_LENGTH_M, ASPHALT_WIDTH_M};
use glam::{Vec2, Vec3, vec2, vec3};
use rain_core::ops;

/// Length of a dash of the centre line and of the gap after it, metres.
const DASH_M: f32 = 3.0;
/// Zebra crossings: range of z, metres.
const ZEBRAS: [[f32; 2]; 2] = [[24.0, 27.0], [-30.0, -27.0]];
/// Height of the road's edge below its crown where the longitudinal undulation is zero, metres.
const EDGE_DROP: f32 = 0.065_2 + GUTTER_DEPTH;

/// Fall of the pavements towards their kerbs.
const PAVEMENT_FALL: f32 = 0.018;
/// Length of a piece of kerb. The pavement behind it is cut at the same places, so that no crack opens. Metres.
const KERB_STEP: f32 = 0.5;

/// Gentle rise and fall along the street; it ends before the cross streets. Metres.
fn undulation(z: f32) -> f32 {
    let wave = ops::sin(f64::from(z) / 28.0 * std::f64::consts::TAU + 0.7) as f32;
    0.02 * wave * (1.0 - smoothstep(29.0, 34.0, z.abs()))
}

fn sunk(hollows: &[Hollow], x: f32, z: f32) -> f32 {
    let at = vec2(x, z);
    let share =
        |h: &Hollow| (1.0 - at.distance_squared(vec2(h.centre[0], h.centre[1])) / (h.radius * h.radius)).max(0.0);
    hollows.iter().map(|h| h.depth * share(h) * share(h)).sum()
}

/// The carriageway as built, before traffic sank hollows and ruts into it. Metres.
#[must_use]
pub fn road_as_built(x: f32, z: f32) -> f32 {
    let a = x.abs();
    // 2 % cross fall from a rounded crown.
    let camber = -0.02 * ((a * a + 0.0625).sqrt() - 0.25);
    let gutter = -GUTTER_DEPTH * smoothstep(GUTTER_X - 0.2, GUTTER_X + 0.15, a);
    let along = camber + gutter + undulation(z);
    // Into the cross street, which falls gently away to its far kerb.
    let end = smoothstep(31.0, ROAD_HALF_LENGTH, z.abs());
    let cross = -EDGE_DROP - 0.012 * (z.abs() - ROAD_HALF_LENGTH).max(0.0);
    along + (cross - along) * end
}

/// Height of the carriageway, hollows and wheel ruts included. Metres.
#[must_use]
pub fn road_height(x: f32, z: f32) -> f32 {
    let a = x.abs();
    let rut: f32 = RUT_X
        .iter()
        .map(|r| {
            let t = (a - r) / RUT_HALF_WIDTH;
            RUT_DEPTH * ops::expf(-0.5 * t * t)
        })
        .sum();
    let traffic = 1.0 - smoothstep(30.0, 34.0, z.abs());
    road_as_built(x, z) - rut * traffic - sunk(&HOLLOWS, x, z)
}

/// Height of the pavement: the kerb's top, 1.8 % fall towards it, slabs that have settled a little. Metres.
#[must_use]
pub fn pavement_height(x: f32, z: f32) -> f32 {
    let inland = (x.abs() - ROAD_HALF_WIDTH)
        .min(ROAD_HALF_LENGTH - z.abs())
        .clamp(0.0, FACADE_X - ROAD_HALF_WIDTH);
    let settled = 0.008 * (value(77, x / 64.0, z / 64.0, 48, 48) - 0.5) * smoothstep(0.2, 0.6, inland);
    KERB_HEIGHT - EDGE_DROP + undulation(z) + PAVEMENT_FALL * inland + settled - sunk(&HOLLOWS, x, z)
}

/// Height of the open ground at (x, z): carriageway, pavement or square. Metres.
#[must_use]
pub fn ground_height(x: f32, z: f32) -> f32 {
    let (a, b) = (x.abs(), z.abs());
    if (ROAD_HALF_LENGTH..=CROSS_FAR_Z).contains(&b) || (a <= ROAD_HALF_WIDTH && b < ROAD_HALF_LENGTH) {
        road_height(x, z)
    } else if b > CROSS_FAR_Z {
        far_pavement_height(z)
    } else if x > FACADE_X && (SQUARE_Z[0]..=SQUARE_Z[1]).contains(&z) {
        square_height(x, z)
    } else {
        pavement_height(x, z)
    }
}

fn far_pavement_height(z: f32) -> f32 {
    road_as_built(0.0, CROSS_FAR_Z) + KERB_HEIGHT + PAVEMENT_FALL * (z.abs() - CROSS_FAR_Z)
}

fn square_height(x: f32, z: f32) -> f32 {
    pavement_height(FACADE_X, z) + 0.012 * (x - FACADE_X)
}

/// A mesh over a lattice of (x, z), each cell in the material that `choose` names; normals from the height itself.
fn lattice_mesh(
    parts: &mut Parts,
    xs: &[f32],
    zs: &[f32],
    height: impl Fn(f32, f32) -> f32,
    choose: impl Fn(f32, f32) -> (Mat, Option<Vec2>),
) {
    let mut made: Vec<(Mat, Vec<u32>)> = Vec::new();
    for j in 0..zs.len() - 1 {
        for i in 0..xs.len() - 1 {
            let (mat, grate) = choose(0.5 * (xs[i] + xs[i + 1]), 0.5 * (zs[j] + zs[j + 1]));
            let slot = made.iter().position(|m| m.0 == mat).unwrap_or_else(|| {
                made.push((mat, vec![u32::MAX; xs.len() * zs.len()]));
                made.len() - 1
            });
            let mesh = parts.get(mat);
            let corner = |made: &mut [(Mat, Vec<u32>)], mesh: &mut Mesh, i: usize, j: usize| {
                let known = made[slot].1[j * xs.len() + i];
                if known != u32::MAX && grate.is_none() {
                    return known;
                }
                let (x, z) = (xs[i], zs[j]);
                let e = 0.05;
                let slope = |a: f32, b: f32| (a - b) / (2.0 * e);
                let dx = slope(height(x + e, z), height(x - e, z));
                let dz = slope(height(x, z + e), height(x, z - e));
                let uv = match (mat, grate) {
                    (_, Some(o)) => vec2((x - o.x) / 0.3, (z - o.y) / 0.5),
                    (Mat::Asphalt, _) if z.abs() <= ROAD_HALF_LENGTH => {
                        vec2(x / ASPHALT_WIDTH_M + 0.5, z / ASPHALT_LENGTH_M)
                    }
                    (Mat::Asphalt, _) => vec2((z.abs() - ROAD_HALF_LENGTH) / 8.0, x / ASPHALT_LENGTH_M),
                    (Mat::Setts, _) => vec2(x, z) / 1.6,
                    _ => vec2(x, z) / 2.0,
                };
                let p = vec3(x, height(x, z), z);
                let v = mesh.vertex(p, vec3(-dx, 1.0, -dz).normalize(), uv, Vec3::X, 1.0);
                made[slot].1[j * xs.len() + i] = v;
                v
            };
            let a = corner(&mut made, mesh, i, j + 1);
            let b = corner(&mut made, mesh, i + 1, j + 1);
            let c = corner(&mut made, mesh, i + 1, j);
            let d = corner(&mut made, mesh, i, j);
            mesh.triangle(a, b, c);
            mesh.triangle(a, c, d);
        }
    }
}

/// Numbers from `low` to `high` in equal steps of at most `step`.
fn steps(low: f32, high: f32, step: f32) -> Vec<f32> {
    let n = ((high - low) / step - 1e-3).ceil().max(1.0) as usize;
    (0..=n).map(|k| low + (high - low) * (k as f32 / n as f32)).collect()
}

fn road_surface(x: f32, z: f32) -> (Mat, Option<Vec2>) {
    let a = x.abs();
    if a > GUTTER_X {
        let drain = DRAINS.iter().find(|d| (d[1] - z).abs() < 0.25 && d[0] * x > 0.0);
        return match drain {
            Some(d) => (Mat::Grate, Some(vec2(d[0] - 0.15, d[1] - 0.25))),
            None => (Mat::Setts, None),
        };
    }
    let zebra = ZEBRAS.iter().any(|r| z > r[0] && z < r[1]) && ((a + 0.25) % 1.0) < 0.5;
    let near_zebra = ZEBRAS.iter().any(|r| z > r[0] - 2.0 && z < r[1] + 2.0);
    let dash = a < 0.06 && z.rem_euclid(2.0 * DASH_M) < DASH_M && !near_zebra && z.abs() < 33.0;
    if zebra || dash {
        (Mat::RoadPaint, None)
    } else {
        (Mat::Asphalt, None)
    }
}

fn kerb_run(mesh: &mut Mesh, f: &Frame, length: f32, top: impl Fn(Vec3) -> f32) {
    // (distance behind the kerb's face, height above its front): face, rounded edge, top, up to the pavement's edge.
    let profile = [
        (0.0, -0.19),
        (0.0, -0.022),
        (0.008, -0.006),
        (0.024, 0.0),
        (KERB_WIDTH, PAVEMENT_FALL * KERB_WIDTH),
    ];
    let zs = steps(0.0, length, KERB_STEP);
    let mut girth = vec![0.0_f32];
    for w in profile.windows(2) {
        let d = vec2(w[1].0 - w[0].0, w[1].1 - w[0].1).length();
        girth.push(girth[girth.len() - 1] + d);
    }
    let point = |k: usize, i: usize| {
        let p = f.at(zs[i], 0.0, -profile[k].0);
        vec3(p.x, top(p) + profile[k].1, p.z)
    };
    for i in 0..zs.len() - 1 {
        for k in 0..profile.len() - 1 {
            let uv = |k: usize, i: usize| vec2(-girth[k], zs[i]);
            mesh.quad_uv(
                [point(k, i), point(k, i + 1), point(k + 1, i + 1), point(k + 1, i)],
                [uv(k, i), uv(k, i + 1), uv(k + 1, i + 1), uv(k + 1, i)],
            );
        }
    }
}

/// Builds all open ground.
pub fn build(parts: &mut Parts) {
    let half = [
        0.06,
        0.25,
        0.5,
        0.75,
        1.0,
        1.25,
        1.5,
        1.75,
        2.0,
        2.25,
        2.5,
        2.75,
        3.0,
        GUTTER_X,
        3.35,
        ROAD_HALF_WIDTH,
    ];
    let xs: Vec<f32> = half.iter().rev().map(|x| -x).chain(half).collect();
    let zs = steps(-ROAD_HALF_LENGTH, ROAD_HALF_LENGTH, 0.25);
    lattice_mesh(parts, &xs, &zs, road_height, road_surface);
    // The pavements' rows end where the kerbs' pieces do, but for the ends, which lie behind the kerbs across.
    let edge = ROAD_HALF_LENGTH - KERB_WIDTH;
    let mut rows = steps(-ROAD_HALF_LENGTH, ROAD_HALF_LENGTH, KERB_STEP);
    let last = rows.len() - 1;
    (rows[0], rows[last]) = (-edge, edge);
    for sign in [-1.0_f32, 1.0] {
        let mirror = |low: f32, high: f32, step: f32| {
            let (a, b) = (low * sign, high * sign);
            steps(a.min(b), a.max(b), step)
        };
        let kerb_x = ROAD_HALF_WIDTH + KERB_WIDTH;
        let pavement = |_: f32, _: f32| (Mat::Slabs, None);
        let across = mirror(kerb_x, FACADE_X + 0.05, 0.5);
        lattice_mesh(parts, &across, &rows, pavement_height, pavement);
        // Cross street beyond this end of the row, its far pavement, and the strips along the corner houses.
        let whole = steps(-CROSS_HALF_X, CROSS_HALF_X, 1.0);
        lattice_mesh(
            parts,
            &whole,
            &mirror(ROAD_HALF_LENGTH, CROSS_FAR_Z, 1.0),
            road_height,
            |_, _| (Mat::Asphalt, None),
        );
        let far = mirror(CROSS_FAR_Z + KERB_WIDTH, CROSS_WALL_Z + 0.05, 1.0);
        lattice_mesh(parts, &whole, &far, |_, z| far_pavement_height(z), pavement);
        for side in [-1.0_f32, 1.0] {
            let strip = if side > 0.0 {
                steps(FACADE_X, CROSS_HALF_X, 1.0)
            } else {
                steps(-CROSS_HALF_X, -FACADE_X, 1.0)
            };
            lattice_mesh(parts, &strip, &mirror(ROW_END_Z, edge, 0.5), pavement_height, pavement);
            let start = if side * sign > 0.0 { kerb_x } else { CROSS_HALF_X };
            let f = Frame::facing(vec3(start * side, 0.0, ROAD_HALF_LENGTH * sign), Vec3::Z * sign);
            kerb_run(parts.get(Mat::Kerb), &f, CROSS_HALF_X - kerb_x, |_| {
                KERB_HEIGHT - EDGE_DROP
            });
        }
        let f = Frame::facing(
            vec3(ROAD_HALF_WIDTH * sign, 0.0, -ROAD_HALF_LENGTH * sign),
            Vec3::X * -sign,
        );
        kerb_run(parts.get(Mat::Kerb), &f, 2.0 * ROAD_HALF_LENGTH, |p| {
            KERB_HEIGHT - EDGE_DROP + undulation(p.z)
        });
        let f = Frame::facing(vec3(CROSS_HALF_X * sign, 0.0, CROSS_FAR_Z * sign), Vec3::Z * -sign);
        kerb_run(parts.get(Mat::Kerb), &f, 2.0 * CROSS_HALF_X, |_| {
            far_pavement_height(CROSS_FAR_Z)
        });
    }
    let square = steps(FACADE_X, SQUARE_X + 0.05, 0.5);
    lattice_mesh(
        parts,
        &square,
        &steps(SQUARE_Z[0], SQUARE_Z[1], 0.5),
        square_height,
        |_, _| (Mat::Setts, None),
    );
    back_yards(parts.get(Mat::Slabs));
}

/// Ground behind and under the houses, so that no height field ends in a hole.
fn back_yards(mesh: &mut Mesh) {
    let y = -0.2;
    let far = CROSS_WALL_Z + 14.0;
    let wide = CROSS_HALF_X + 14.0;
    let mut plate = |x: [f32; 2], z: [f32; 2]| {
        mesh.quad(
            [
                vec3(x[0], y, z[1]),
                vec3(x[1], y, z[1]),
                vec3(x[1], y, z[0]),
                vec3(x[0], y, z[0]),
            ],
            2.0,
        );
    };
    for s in [-1.0_f32, 1.0] {
        let sorted = |a: f32, b: f32| [(a * s).min(b * s), (a * s).max(b * s)];
        plate(sorted(FACADE_X, wide), [-ROW_END_Z, ROW_END_Z]);
        plate([-wide, wide], sorted(CROSS_WALL_Z, far));
        for t in [-1.0_f32, 1.0] {
            plate(
                [(CROSS_HALF_X * t).min(wide * t), (CROSS_HALF_X * t).max(wide * t)],
                sorted(ROW_END_Z, CROSS_WALL_Z),
            );
        }
    }
}
