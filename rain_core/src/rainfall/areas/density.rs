//! Painted densities: how much of an area's rain falls at each of its places (Creus & Patow 2013).

use std::fmt;
use std::sync::Arc;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::settings::AreaError;
use super::shape::{MAX_EXTENT_M, MIN_RADIUS_M};
use crate::error::{ConfigError, in_range};

/// Most cells along a side of a map.
pub const MAX_DENSITY_SIDE: usize = 128;

/// Shares of an area's weight on a rectangle about its centre, 256 steps, linear between the middles of cells; beyond its
/// border as on it. Copies share their memory.
#[derive(Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Painting", into = "Painting")]
pub struct DensityMap(Arc<Inner>);

/// A map as it is written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Painting {
    size_m: DVec2,
    cells: [usize; 2],
    values: Vec<u8>,
}

#[derive(PartialEq)]
struct Inner {
    painting: Painting,
    /// Least and greatest value of ever larger blocks of cells: 2, 4, 8 … along a side.
    blocks: Vec<([usize; 2], Vec<[u8; 2]>)>,
}

impl fmt::Debug for DensityMap {
    /// Size, cells and a key of the values: two maps with the same text have the same values but for one chance in 2⁶⁴.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let painting = &self.0.painting;
        // FNV-1a.
        let key = painting.values.iter().fold(0xcbf2_9ce4_8422_2325_u64, |key, value| {
            (key ^ u64::from(*value)).wrapping_mul(0x0100_0000_01b3)
        });
        f.debug_struct("DensityMap")
            .field("size_m", &painting.size_m)
            .field("cells", &painting.cells)
            .field("key", &key)
            .finish()
    }
}

impl TryFrom<Painting> for DensityMap {
    type Error = AreaError;

    fn try_from(painting: Painting) -> Result<Self, AreaError> {
        Self::new(painting.size_m, painting.cells, painting.values)
    }
}

impl From<DensityMap> for Painting {
    fn from(map: DensityMap) -> Self {
        map.0.painting.clone()
    }
}

impl DensityMap {
    /// `size_m`: of the rectangle about the area's centre (x, z); m, each in [0.1, 1e6]. `cells`: along x and z, 2 to 128.
    /// `values`: row by row (row = z, from −z on); 0 no rain, 255 all of it.
    ///
    /// # Errors
    /// Names what is outside its domain; a number of values that is not that of the cells.
    pub fn new(size_m: DVec2, cells: [usize; 2], values: Vec<u8>) -> Result<Self, AreaError> {
        for side in size_m.to_array() {
            in_range("size_m of a density", side, MIN_RADIUS_M, MAX_EXTENT_M, "0.1 to 1e6 m")?;
        }
        for side in cells {
            let most = MAX_DENSITY_SIDE as f64;
            in_range("cells of a density", side as f64, 2.0, most, "2 to 128")?;
        }
        if values.len() != cells[0] * cells[1] {
            return Err(ConfigError::OutOfRange {
                field: "values of a density",
                value: values.len() as f64,
                allowed: "as many as cells",
            }
            .into());
        }
        let mut blocks: Vec<([usize; 2], Vec<[u8; 2]>)> = Vec::new();
        let (mut side, mut finer) = (cells, values.iter().map(|v| [*v; 2]).collect::<Vec<_>>());
        while side[0].max(side[1]) > 1 {
            let coarse = side.map(|n| n.div_ceil(2));
            let of = |i: usize| {
                let (x, z) = (2 * (i % coarse[0]), 2 * (i / coarse[0]));
                let places = [(x, z), (x + 1, z), (x, z + 1), (x + 1, z + 1)];
                places
                    .into_iter()
                    .filter(|(x, z)| *x < side[0] && *z < side[1])
                    .map(|(x, z)| finer[z * side[0] + x])
                    .fold([255, 0], |found, own| [found[0].min(own[0]), found[1].max(own[1])])
            };
            let next: Vec<[u8; 2]> = (0..coarse[0] * coarse[1]).map(of).collect();
            blocks.push((coarse, next.clone()));
            (side, finer) = (coarse, next);
        }
        let painting = Painting { size_m, cells, values };
        Ok(Self(Arc::new(Inner { painting, blocks })))
    }

    /// Size of the rectangle. Units: m.
    #[must_use]
    pub fn size_m(&self) -> DVec2 {
        self.0.painting.size_m
    }

    /// Cells along x and z.
    #[must_use]
    pub fn cells(&self) -> [usize; 2] {
        self.0.painting.cells
    }

    /// The values, row by row.
    #[must_use]
    pub fn values(&self) -> &[u8] {
        &self.0.painting.values
    }

    /// Place in cells, counted from the middle of the first, held on the map.
    fn cell_of(&self, local_m: DVec2) -> DVec2 {
        let cells = DVec2::new(self.cells()[0] as f64, self.cells()[1] as f64);
        let at = (local_m / self.size_m() + 0.5) * cells - 0.5;
        // What is not a number counts as the first cell.
        at.max(DVec2::ZERO).min(cells - 1.0)
    }

    /// The four values about a place and its place between them.
    fn around(&self, local_m: DVec2) -> ([[f64; 2]; 2], DVec2) {
        let at = self.cell_of(local_m);
        let [nx, nz] = self.cells();
        let (x, z) = ((at.x as usize).min(nx - 2), (at.y as usize).min(nz - 2));
        let value = |x: usize, z: usize| f64::from(self.values()[z * nx + x]) / 255.0;
        (
            [[value(x, z), value(x + 1, z)], [value(x, z + 1), value(x + 1, z + 1)]],
            at - DVec2::new(x as f64, z as f64),
        )
    }

    /// The share at a place relative to the centre (x, z, m). Units: none. In [0, 1].
    ///
    /// Error: 1e-13, that of the place in cells.
    #[must_use]
    pub fn at(&self, local_m: DVec2) -> f64 {
        let ([[a, b], [c, d]], t) = self.around(local_m);
        let (near, far) = (a + (b - a) * t.x, c + (d - c) * t.x);
        near + (far - near) * t.y
    }

    /// ∂share/∂(x, z) at a place, of one side where two cells meet; 0 beyond the map. Units: 1/m.
    ///
    /// Error: 1e-14 over the size of a cell.
    #[must_use]
    pub fn slope_at(&self, local_m: DVec2) -> DVec2 {
        let ([[a, b], [c, d]], t) = self.around(local_m);
        let cells = DVec2::new(self.cells()[0] as f64, self.cells()[1] as f64);
        let slope = DVec2::new((b - a) + (d - c - b + a) * t.y, (c - a) + (d - c - b + a) * t.x);
        let inside = (local_m / self.size_m() + 0.5) * cells - 0.5;
        let held = inside.cmpge(DVec2::ZERO) & inside.cmple(cells - 1.0);
        DVec2::select(held, slope * cells / self.size_m(), DVec2::ZERO)
    }

    /// Shares that occur within `radius_m` of a place: none is below the first or above the second. Units: none.
    ///
    /// Error: the bounds hold; they are those of the cells about the place, at most five along each axis.
    #[must_use]
    pub fn within(&self, local_m: DVec2, radius_m: f64) -> [f64; 2] {
        if radius_m <= 0.0 {
            return [self.at(local_m); 2];
        }
        let reach = DVec2::splat(radius_m);
        let low = self.cell_of(local_m - reach).floor();
        let high = self.cell_of(local_m + reach).ceil();
        let (mut low, mut high) = (low.as_usizevec2(), high.as_usizevec2());
        let mut level = 0;
        while (high - low).max_element() > 4 && level < self.0.blocks.len() {
            (low, high, level) = (low / 2, high / 2, level + 1);
        }
        let mut found = [255, 0];
        for z in low.y..=high.y {
            for x in low.x..=high.x {
                let own = match level.checked_sub(1) {
                    None => [self.values()[z * self.cells()[0] + x]; 2],
                    Some(level) => {
                        let (side, values) = &self.0.blocks[level];
                        values[z * side[0] + x]
                    }
                };
                found = [found[0].min(own[0]), found[1].max(own[1])];
            }
        }
        found.map(|value| f64::from(value) / 255.0)
    }

    /// Least and greatest share. Units: none.
    #[must_use]
    pub fn extremes(&self) -> [f64; 2] {
        let last = self.0.blocks.last().and_then(|(_, values)| values.first());
        last.map_or([0.0, 1.0], |found| found.map(|value| f64::from(value) / 255.0))
    }

    /// Rows behind an area's own: half the size and the cells, then twelve values to a row, three to a number.
    pub(super) fn rows(&self) -> impl Iterator<Item = [f32; 4]> + '_ {
        let half = 0.5 * self.size_m();
        let [nx, nz] = self.cells();
        let head = [half.x as f32, half.y as f32, nx as f32, nz as f32];
        let rows = self.values().chunks(12).map(|twelve| {
            core::array::from_fn(|i| {
                let three = twelve.get(3 * i..).unwrap_or_default();
                let value = three
                    .iter()
                    .take(3)
                    .rev()
                    .fold(0_u32, |sum, v| sum << 8 | u32::from(*v));
                value as f32
            })
        });
        core::iter::once(head).chain(rows)
    }
}

/// How many rows [`DensityMap::rows`] has for so many values.
pub(super) fn density_rows(values: usize) -> usize {
    1 + values.div_ceil(12)
}

/// [`DensityMap::at`] in single precision from its rows, as the shader has it. Broken rows give 0.
///
/// Error: 4e-6 times the cells along a side.
pub(super) fn density_at_f32(rows: &[[f32; 4]], local_m: [f32; 2]) -> f32 {
    let Some((head, values)) = rows.split_first() else {
        return 0.0;
    };
    let cells = [head[2], head[3]];
    let at = [0, 1].map(|i| {
        let cell = (local_m[i] / (2.0 * head[i]) + 0.5) * cells[i] - 0.5;
        crate::error::clamped_f32(cell, 0.0, cells[i] - 1.0)
    });
    let low = [0, 1].map(|i| (at[i] as usize).min((cells[i] as usize).saturating_sub(2)));
    let value = |x: usize, z: usize| {
        let index = (low[1] + z) * cells[0] as usize + low[0] + x;
        let three = values.get(index / 12).map_or(0, |row| row[index % 12 / 3] as u32);
        (three >> (8 * (index % 3)) & 255) as f32 / 255.0
    };
    let t = [at[0] - low[0] as f32, at[1] - low[1] as f32];
    let near = value(0, 0) + (value(1, 0) - value(0, 0)) * t[0];
    let far = value(0, 1) + (value(1, 1) - value(0, 1)) * t[0];
    near + (far - near) * t[1]
}
