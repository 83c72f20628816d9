//! Numbers out of a glTF file's buffers, with every bound checked: a file may say anything.

use std::collections::BTreeMap;

use glam::{DAffine3, DVec3};
use gltf::accessor::{DataType, Dimensions};
use gltf::{Accessor, buffer};

use super::gltf::GltfProblem;

/// The buffers of a file, in its order.
pub(super) type Buffers = [Vec<u8>];

/// Elements at equal distances in a piece of a buffer.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
}

impl<'a> Elements<'a> {
    /// `count` elements of `size` bytes from `offset` bytes into `view`.
    fn new(
        buffers: &'a Buffers,
        view: &buffer::View<'_>,
        offset: usize,
        size: usize,
        count: usize,
    ) -> Result<Self, GltfProblem> {
        let wrong = || GltfProblem::OutOfBuffer { view: view.index() };
        let start = view.offset().checked_add(offset).ok_or_else(wrong)?;
        let end = view.offset().checked_add(view.length()).ok_or_else(wrong)?;
        let buffer = buffers.get(view.buffer().index()).ok_or_else(wrong)?;
        let bytes = buffer.get(start..end).ok_or_else(wrong)?;
        let stride = view.stride().unwrap_or(size);
        if stride < size {
            return Err(wrong());
        }
        let needed = match count.checked_sub(1) {
            None => 0,
            Some(gaps) => gaps
                .checked_mul(stride)
                .and_then(|bytes| bytes.checked_add(size))
                .ok_or_else(wrong)?,
        };
        if needed > bytes.len() {
            return Err(wrong());
        }
        Ok(Self { bytes, stride, size })
    }

    /// The bytes of an element below the count it was made for.
    fn get(&self, index: usize) -> &'a [u8] {
        let start = index * self.stride;
        &self.bytes[start..start + self.size]
    }
}

/// A number of type `kind` at the start of `bytes`; `normalised` maps integers to [0, 1] or [−1, 1].
fn number(bytes: &[u8], kind: DataType, normalised: bool) -> f64 {
    let (value, full) = match (kind, bytes) {
        (DataType::I8, [a, ..]) => (f64::from(*a as i8), 127.0),
        (DataType::U8, [a, ..]) => (f64::from(*a), 255.0),
        (DataType::I16, [a, b, ..]) => (f64::from(i16::from_le_bytes([*a, *b])), 32767.0),
        (DataType::U16, [a, b, ..]) => (f64::from(u16::from_le_bytes([*a, *b])), 65535.0),
        (DataType::U32, [a, b, c, d, ..]) => (f64::from(u32::from_le_bytes([*a, *b, *c, *d])), 4_294_967_295.0),
        (DataType::F32, [a, b, c, d, ..]) => return f64::from(f32::from_le_bytes([*a, *b, *c, *d])),
        _ => return f64::NAN,
    };
    if normalised { (value / full).max(-1.0) } else { value }
}

/// Positions of vertices: never much larger than the bytes that they were read from.
pub(super) enum Positions {
    /// One for each vertex.
    Dense(Vec<DVec3>),
    /// A file may name any number of vertices and have data for a few: the others are all in one place.
    Sparse {
        count: usize,
        others: DVec3,
        changed: BTreeMap<usize, DVec3>,
    },
}

impl Positions {
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Dense(list) => list.len(),
            Self::Sparse { count, .. } => *count,
        }
    }

    /// The position of a vertex below the count.
    pub(super) fn get(&self, index: usize) -> DVec3 {
        match self {
            Self::Dense(list) => list[index],
            Self::Sparse { others, changed, .. } => changed.get(&index).copied().unwrap_or(*others),
        }
    }

    pub(super) fn transform(&mut self, by: &DAffine3) {
        let transform = |p: &mut DVec3| *p = by.transform_point3(*p);
        match self {
            Self::Dense(list) => list.iter_mut().for_each(transform),
            Self::Sparse { others, changed, .. } => changed.values_mut().chain([others]).for_each(transform),
        }
    }

    /// Puts a vertex elsewhere; whether there is one of this index.
    fn set(&mut self, index: usize, to: DVec3) -> bool {
        let there = index < self.len();
        match self {
            Self::Dense(list) if there => list[index] = to,
            Self::Sparse { changed, .. } if there => {
                changed.insert(index, to);
            }
            _ => {}
        }
        there
    }
}

/// Positions of vertices, sparse changes applied. At most `limit`.
pub(super) fn positions(buffers: &Buffers, accessor: &Accessor<'_>, limit: usize) -> Result<Positions, GltfProblem> {
    let index = accessor.index();
    let (kind, count) = (accessor.data_type(), accessor.count());
    // Integers are KHR_mesh_quantization.
    if accessor.dimensions() != Dimensions::Vec3 || kind == DataType::U32 {
        return Err(GltfProblem::Type {
            accessor: index,
            wanted: "positions: three floats or short integers",
        });
    }
    if count > limit {
        return Err(GltfProblem::Count {
            accessor: index,
            count,
            allowed: limit,
        });
    }
    let (size, step) = (accessor.size(), kind.size());
    let vector =
        |bytes: &[u8]| DVec3::from_array([0, 1, 2].map(|i| number(&bytes[i * step..], kind, accessor.normalized())));
    // The bytes are known to be there before anything is allocated; only a sparse accessor may lack them.
    let mut list = match accessor.view() {
        Some(view) => {
            let elements = Elements::new(buffers, &view, accessor.offset(), size, count)?;
            Positions::Dense((0..count).map(|i| vector(elements.get(i))).collect())
        }
        None => Positions::Sparse {
            count,
            others: DVec3::ZERO,
            changed: BTreeMap::new(),
        },
    };
    if let Some(sparse) = accessor.sparse() {
        let changes = sparse.count();
        if changes > count {
            return Err(GltfProblem::Count {
                accessor: index,
                count: changes,
                allowed: count,
            });
        }
        let (indices, values) = (sparse.indices(), sparse.values());
        let index_kind = match indices.index_type() {
            gltf::accessor::sparse::IndexType::U8 => DataType::U8,
            gltf::accessor::sparse::IndexType::U16 => DataType::U16,
            gltf::accessor::sparse::IndexType::U32 => DataType::U32,
        };
        let places = Elements::new(buffers, &indices.view(), indices.offset(), index_kind.size(), changes)?;
        let changed = Elements::new(buffers, &values.view(), values.offset(), size, changes)?;
        for i in 0..changes {
            let place = number(places.get(i), index_kind, false) as usize;
            if !list.set(place, vector(changed.get(i))) {
                return Err(GltfProblem::Index {
                    accessor: index,
                    index: place,
                    vertices: count,
                });
            }
        }
    }
    Ok(list)
}

/// Indices of vertices, each below `vertices`. At most `limit`.
pub(super) fn indices(
    buffers: &Buffers,
    accessor: &Accessor<'_>,
    vertices: usize,
    limit: usize,
) -> Result<Vec<usize>, GltfProblem> {
    let (kind, count) = (accessor.data_type(), accessor.count());
    let whole = matches!(kind, DataType::U8 | DataType::U16 | DataType::U32);
    let view = accessor.view();
    let (true, Dimensions::Scalar, Some(view), None) = (whole, accessor.dimensions(), view, accessor.sparse()) else {
        return Err(GltfProblem::Type {
            accessor: accessor.index(),
            wanted: "indices: one unsigned integer each, not sparse",
        });
    };
    if count > limit {
        return Err(GltfProblem::Count {
            accessor: accessor.index(),
            count,
            allowed: limit,
        });
    }
    let elements = Elements::new(buffers, &view, accessor.offset(), kind.size(), count)?;
    (0..count)
        .map(|i| {
            let index = number(elements.get(i), kind, false) as usize;
            if index < vertices {
                Ok(index)
            } else {
                Err(GltfProblem::Index {
                    accessor: accessor.index(),
                    index,
                    vertices,
                })
            }
        })
        .collect()
}
