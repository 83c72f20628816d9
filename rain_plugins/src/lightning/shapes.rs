//! Meshes of channels and of the glowing cloud.

use bevy::asset::RenderAssetUsages;
use bevy::math::DVec3;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use rain_core::lightning::GLOW_SPREAD_M;

/// The glow is drawn out to so many of its deviations.
const GLOW_REACH: f32 = 3.5;

/// Square tubes along paths, `width_m` wide, relative to `origin`.
pub(super) fn tubes<'a>(paths: impl Iterator<Item = &'a [DVec3]>, origin: DVec3, width_m: f32) -> Mesh {
    let mut positions: Vec<[f32; 3]> = Vec::new();
    let mut indices: Vec<u32> = Vec::new();
    for path in paths.filter(|path| path.len() > 1) {
        let along = (path[path.len() - 1] - path[0]).as_vec3().normalize_or(Vec3::Y);
        let (u, v) = along.any_orthonormal_pair();
        let half = 0.5 * width_m;
        let first = positions.len() as u32;
        for point in path {
            let at = (*point - origin).as_vec3();
            positions.extend([u, v, -u, -v].map(|side| (at + half * side).to_array()));
        }
        for ring in 0..path.len() as u32 - 1 {
            for side in 0..4 {
                let corner = |ring: u32, side: u32| first + 4 * ring + side % 4;
                let (a, b) = (corner(ring, side), corner(ring, side + 1));
                let (c, d) = (corner(ring + 1, side), corner(ring + 1, side + 1));
                indices.extend([a, c, b, b, c, d]);
            }
        }
    }
    let count = positions.len();
    mesh(positions, vec![[0.0; 2]; count], indices)
}

/// A level square whose texture coordinates are deviations from the middle of the glow.
pub(super) fn glow() -> Mesh {
    let corners = [[-1.0_f32, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let reach = GLOW_REACH * GLOW_SPREAD_M as f32;
    mesh(
        corners.map(|[x, z]| [reach * x, 0.0, reach * z]).to_vec(),
        corners.map(|c| c.map(|v| GLOW_REACH * v)).to_vec(),
        vec![0, 1, 2, 0, 2, 3],
    )
}

fn mesh(positions: Vec<[f32; 3]>, uvs: Vec<[f32; 2]>, indices: Vec<u32>) -> Mesh {
    let normals = vec![[0.0, 1.0, 0.0]; positions.len()];
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
        .with_inserted_indices(Indices::U32(indices))
}
