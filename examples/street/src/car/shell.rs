//! A closed shell around the car: columns around it, rows up it, a material for each patch.

use super::{CarMat, CarParts};
use crate::mesh::Mesh;
use glam::{Vec2, Vec3};

/// A point on the outline of a rounded rectangle with half sizes 1: `x^n + z^n = 1` along the direction (x, z).
fn rounded(x: f32, z: f32, n: i32) -> Vec2 {
    let power = |a: f32| rain_core::ops::pow(f64::from(a.abs()), f64::from(n));
    let norm = rain_core::ops::pow(power(x) + power(z), 1.0 / f64::from(n)) as f32;
    Vec2::new(x, z) / norm
}

/// Columns of half an outline, from the middle of the front along the left side (+x) to the middle of the rear, as points of a
/// rounded rectangle with half sizes `half`; the sides get a column at each z of `side`, in falling order.
#[must_use]
pub fn outline(half: Vec2, n: i32, side: &[f32]) -> Vec<Vec2> {
    let ends = [0.0, 0.14, 0.28, 0.42, 0.54, 0.64, 0.73, 0.81, 0.88, 0.94, 0.98];
    let mut list: Vec<Vec2> = ends.iter().map(|&q| rounded(q, 1.0, n) * half).collect();
    for &z in side {
        // The direction whose outline point has this z, by repeated substitution.
        let mut r = z / half.y;
        for _ in 0..40 {
            r += (z - rounded(1.0, r, n).y * half.y) / half.y;
        }
        list.push(rounded(1.0, r, n) * half);
    }
    list.extend(ends.iter().rev().map(|&q| rounded(q, -1.0, n) * half));
    list
}

/// Adds the shell whose left half (columns `0..count`, front to rear) `point` gives; `choose` names the material of the patch
/// between columns k, k + 1 and rows j, j + 1.
pub fn add(
    parts: &mut CarParts,
    count: usize,
    rows: usize,
    point: impl Fn(usize, usize) -> Vec3,
    choose: impl Fn(usize, usize) -> Option<CarMat>,
) {
    let around = 2 * (count - 1);
    let whole = |i: usize, j: usize| {
        let i = i % around;
        let p = if i < count {
            point(i, j)
        } else {
            point(around - i, j) * Vec3::new(-1.0, 1.0, 1.0)
        };
        (p, Vec2::new(p.z, -p.y))
    };
    let mut mesh = Mesh::default();
    mesh.surface(around, rows - 1, true, whole);
    let width = around as u32 + 1;
    // Both halves meet in the middle plane: there the normal lies in it.
    for (p, n) in mesh.positions.iter().zip(&mut mesh.normals) {
        if p.x.abs() < 1e-4 {
            n.x = 0.0;
            *n = n.normalize_or(Vec3::Y);
        }
    }
    let mut maps: Vec<(CarMat, Vec<u32>)> = Vec::new();
    for t in mesh.indices.chunks_exact(3) {
        let i = t.iter().map(|v| v % width).min().unwrap_or_default() as usize;
        let j = t.iter().map(|v| v / width).min().unwrap_or_default() as usize;
        let column = if i < count - 1 { i } else { around - 1 - i };
        let Some(mat) = choose(column, j) else { continue };
        let slot = maps.iter().position(|m| m.0 == mat).unwrap_or_else(|| {
            maps.push((mat, vec![u32::MAX; mesh.positions.len()]));
            maps.len() - 1
        });
        let target = parts.get(mat);
        for &v in t {
            let v = v as usize;
            if maps[slot].1[v] == u32::MAX {
                let tangent = mesh.tangents[v];
                maps[slot].1[v] = target.vertex(
                    mesh.positions[v],
                    mesh.normals[v],
                    mesh.uvs[v],
                    tangent.truncate(),
                    tangent.w,
                );
            }
            target.indices.push(maps[slot].1[v]);
        }
    }
}
