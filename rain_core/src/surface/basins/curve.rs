//! Volume and level of a basin: exact, piecewise linear between the heights of its cells.

use crate::error::clamped;

/// Largest volume and depth that are looked at. Units: m³, m.
const MOST: f64 = 1e30;

/// Volume against level of one basin. Depths are above the basin's lowest cell, so that nothing cancels.
///
/// Error: below 1e-12 of the volume against a sum over all cells; level(volume(s)) returns s to 1e-12 of the depth.
#[derive(Debug, Clone, Copy)]
pub struct Curve<'a> {
    /// Depths of the cells between sill and spill level, rising. Units: m.
    pub(super) depths: &'a [f64],
    /// Volume when the level is at these. Units: m³.
    pub(super) volumes: &'a [f64],
    /// Cells below the sill: those of the basins inside.
    pub(super) base_cells: u32,
    /// Depth of the sill; 0 of a basin with none inside. Units: m.
    pub(super) base_depth: f64,
    /// Volume of the basins inside. Units: m³.
    pub(super) base_volume: f64,
    /// Depth at which it overflows; infinite if it cannot. Units: m.
    pub(super) spill_depth: f64,
    /// Volume at which it overflows; infinite if it cannot. Units: m³.
    pub(super) capacity: f64,
    /// Area of a cell. Units: m².
    pub(super) cell_area: f64,
}

impl Curve<'_> {
    /// Stretches between two cell heights.
    pub(super) fn last_stretch(&self) -> usize {
        self.depths.len()
    }

    /// Wet area in a stretch: of those with this many cells of its own. Units: m².
    pub(super) fn area_in(&self, stretch: usize) -> f64 {
        (f64::from(self.base_cells) + stretch as f64) * self.cell_area
    }

    /// Depth and volume where a stretch begins.
    pub(super) fn start_of(&self, stretch: usize) -> (f64, f64) {
        match stretch.checked_sub(1) {
            None => (self.base_depth, self.base_volume),
            Some(cell) => (self.depths[cell], self.volumes[cell]),
        }
    }

    /// Depth and volume where a stretch ends.
    pub(super) fn end_of(&self, stretch: usize) -> (f64, f64) {
        if stretch < self.depths.len() {
            (self.depths[stretch], self.volumes[stretch])
        } else {
            (self.spill_depth, self.capacity)
        }
    }

    /// The stretch that begins at or below a volume, the last of several.
    pub(super) fn stretch_at(&self, volume: f64) -> usize {
        self.volumes.partition_point(|&knot| knot <= volume)
    }

    /// Depth in a stretch.
    pub(super) fn depth_in(&self, stretch: usize, volume: f64) -> f64 {
        let (depth, start) = self.start_of(stretch);
        let area = self.area_in(stretch);
        if area > 0.0 && volume > start {
            let reached = depth + (volume - start) / area;
            if reached < self.end_of(stretch).0 {
                reached
            } else {
                self.end_of(stretch).0
            }
        } else {
            depth
        }
    }

    /// Depth of water above the lowest cell. Units: m. Volumes (m³) below that of the basins inside give the sill,
    /// above the capacity the spill level; NaN counts as none. Where it cannot overflow, volumes above 1e30 m³ count as
    /// that.
    ///
    /// Error: 1e-12 of the depth against a sum over all cells.
    #[must_use]
    pub fn depth_m(&self, volume_m3: f64) -> f64 {
        let volume_m3 = clamped(volume_m3, 0.0, MOST);
        self.depth_in(self.stretch_at(volume_m3), volume_m3)
    }

    /// Water at a depth above the lowest cell. Units: m³. Depths (m) outside the sill and spill level count as these,
    /// NaN as the sill. Where it cannot overflow, depths above 1e30 m count as that.
    ///
    /// Error: 1e-12 relative against a sum over all cells.
    #[must_use]
    pub fn volume_m3(&self, depth_m: f64) -> f64 {
        let depth_m = clamped(depth_m, 0.0, MOST);
        if depth_m >= self.spill_depth {
            return self.capacity;
        }
        let stretch = self.depths.partition_point(|&knot| knot <= depth_m);
        let (depth, volume) = self.start_of(stretch);
        if depth_m > depth {
            volume + self.area_in(stretch) * (depth_m - depth)
        } else {
            volume
        }
    }

    /// Wet area at a volume, just above where it jumps. Units: m². Error: none, cells are counted.
    #[must_use]
    pub fn area_m2(&self, volume_m3: f64) -> f64 {
        self.area_in(self.stretch_at(volume_m3))
    }

    /// Wet area when full: all cells below the spill level. Units: m².
    #[must_use]
    pub fn full_area_m2(&self) -> f64 {
        self.area_in(self.last_stretch())
    }

    /// Volume at which it overflows, infinite if it cannot. Units: m³.
    #[must_use]
    pub fn capacity_m3(&self) -> f64 {
        self.capacity
    }
}

/// Where the curve of a basin lies in the common arrays.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Stretch {
    pub(super) start: usize,
    pub(super) end: usize,
}

/// Sorts a basin's depths and writes the volume at each; returns that at `end_depth`.
pub(super) fn sum_volumes(
    depths: &mut [f64],
    volumes: &mut [f64],
    base: (f64, f64, u32),
    end_depth: f64,
    cell_area: f64,
) -> f64 {
    depths.sort_unstable_by(f64::total_cmp);
    let (mut depth, mut total, base_cells) = base;
    let mut lost = 0.0;
    let mut area = f64::from(base_cells) * cell_area;
    let mut grow = |to: f64, area: f64| {
        // Neumaier: the sum stays exact to the last bit over millions of cells.
        let term = area * (to - depth) - lost;
        let sum = total + term;
        lost = (sum - total) - term;
        total = sum;
        depth = to;
        sum
    };
    for (index, (&to, volume)) in depths.iter().zip(volumes).enumerate() {
        *volume = grow(to, area);
        area = (f64::from(base_cells) + (index + 1) as f64) * cell_area;
    }
    if end_depth.is_finite() {
        grow(end_depth, area)
    } else {
        f64::INFINITY
    }
}
