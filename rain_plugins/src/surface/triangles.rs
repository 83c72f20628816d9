//! World-space triangles of a mesh, and what of it is no triangle.

use bevy::math::DVec3;
use bevy::mesh::{Mesh, PrimitiveTopology, VertexAttributeValues};
use bevy::prelude::*;

use super::gaps::{Gap, LeftOut};

/// The triangles of a mesh that the simulation can use. Units: m, world.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MeshTriangles {
    pub triangles: Vec<[DVec3; 3]>,
    /// Those that it cannot.
    pub left_out: LeftOut,
}

/// World-space triangles of a mesh: of a list or a strip, with or without indices.
///
/// # Errors
/// [`Gap::NotTriangles`] and [`Gap::NoPositions`].
pub(crate) fn triangles_of(mesh: &Mesh, transform: &GlobalTransform) -> Result<MeshTriangles, Gap> {
    let strip = match mesh.primitive_topology() {
        PrimitiveTopology::TriangleList => false,
        PrimitiveTopology::TriangleStrip => true,
        _ => return Err(Gap::NotTriangles),
    };
    let Ok(VertexAttributeValues::Float32x3(positions)) = mesh.try_attribute(Mesh::ATTRIBUTE_POSITION) else {
        return Err(Gap::NoPositions);
    };
    let world: Vec<_> = positions
        .iter()
        .map(|p| transform.transform_point(Vec3::from_array(*p)).as_dvec3())
        .collect();
    let corners: Vec<usize> = match mesh.try_indices().ok() {
        Some(indices) => indices.iter().collect(),
        None => (0..positions.len()).collect(),
    };
    let count = if strip {
        corners.len().saturating_sub(2)
    } else {
        corners.len() / 3
    };
    let mut out = MeshTriangles {
        triangles: Vec::with_capacity(count),
        left_out: LeftOut::default(),
    };
    for i in 0..count {
        // Every other triangle of a strip runs the other way round.
        let [a, b, c] = match (strip, i % 2) {
            (false, _) => [3 * i, 3 * i + 1, 3 * i + 2],
            (true, 0) => [i, i + 1, i + 2],
            (true, _) => [i + 1, i, i + 2],
        };
        let corner = |i: usize| world.get(corners[i]).copied();
        let (Some(a), Some(b), Some(c)) = (corner(a), corner(b), corner(c)) else {
            out.left_out.no_vertex += 1;
            continue;
        };
        let triangle = [a, b, c];
        if !triangle.iter().all(|p| p.is_finite()) {
            out.left_out.not_finite += 1;
        } else if (b - a).cross(c - a) == DVec3::ZERO {
            // A strip has such to go on elsewhere.
            out.left_out.no_area += u32::from(!strip);
        } else {
            out.triangles.push(triangle);
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use bevy::asset::RenderAssetUsages;
    use bevy::mesh::Indices;

    use super::*;

    fn mesh(topology: PrimitiveTopology, positions: Vec<[f32; 3]>) -> Mesh {
        Mesh::new(topology, RenderAssetUsages::default()).with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
    }

    const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [1.0, 0.0, 1.0]];

    #[test]
    fn a_strip_is_the_triangles_of_a_list() {
        let at = GlobalTransform::from(Transform::from_xyz(5.0, 0.0, 0.0));
        let strip = triangles_of(&mesh(PrimitiveTopology::TriangleStrip, SQUARE.to_vec()), &at).expect("a strip");
        let list = mesh(PrimitiveTopology::TriangleList, SQUARE.to_vec());
        let list = list.with_inserted_indices(Indices::U16(vec![0, 1, 2, 2, 1, 3]));
        let list = triangles_of(&list, &at).expect("a list");
        assert_eq!(strip, list);
        assert!(strip.triangles.len() == 2 && !strip.left_out.any());
        let up = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).y > 0.0;
        assert!(strip.triangles.iter().all(|t| up(*t)));
    }

    #[test]
    fn what_is_no_triangle_is_counted_and_the_rest_is_kept() {
        let mut positions = SQUARE.to_vec();
        positions.push([f32::NAN, 0.0, 0.0]);
        let list = mesh(PrimitiveTopology::TriangleList, positions);
        let list = list.with_inserted_indices(Indices::U32(vec![0, 1, 2, 0, 1, 4, 0, 0, 1, 0, 1, 77, 2, 1]));
        let found = triangles_of(&list, &GlobalTransform::IDENTITY).expect("a list");
        assert_eq!(found.triangles.len(), 1);
        assert_eq!(
            found.left_out,
            LeftOut {
                not_finite: 1,
                no_area: 1,
                no_vertex: 1
            }
        );
    }

    #[test]
    fn lines_and_meshes_without_positions_are_named() {
        let at = GlobalTransform::IDENTITY;
        assert_eq!(
            triangles_of(&mesh(PrimitiveTopology::LineList, SQUARE.to_vec()), &at),
            Err(Gap::NotTriangles)
        );
        let bare = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default());
        assert_eq!(triangles_of(&bare, &at), Err(Gap::NoPositions));
        let empty = triangles_of(&mesh(PrimitiveTopology::TriangleList, Vec::new()), &at).expect("an empty list");
        assert!(empty.triangles.is_empty() && !empty.left_out.any());
    }
}
