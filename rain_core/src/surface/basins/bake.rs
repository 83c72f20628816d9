//! From a height field to its basins.

use std::borrow::Cow;

use serde::Serialize;

use super::catchment::{Catchments, OUT};
use super::curve::{Curve, Stretch, sum_volumes};
use super::drains::{BasinDrain, Drain, Inlet};
use super::flood::{Flood, passes};
use super::grid::Grid;
use super::hierarchy::{DRY, Hierarchy, NOBODY};
use crate::error::{ConfigError, in_range};

/// What the baker assumes.
#[derive(Debug, Clone, PartialEq)]
pub struct BakeOptions {
    /// Whether the border is a wall. Default: open, water leaves over a border cell at that cell's height.
    pub closed: bool,
    /// Basins shallower than this are left out: noise of the heights. Units: m. Domain: [0, 1e3]. Default: 1e-4.
    pub threshold_m: f64,
    /// Inlets.
    pub drains: Vec<Drain>,
}

impl Default for BakeOptions {
    fn default() -> Self {
        Self {
            closed: false,
            threshold_m: 1e-4,
            drains: Vec::new(),
        }
    }
}

/// A hollow that holds water, or two that have become one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Basin {
    /// The basin that it and its sibling become when both are full.
    pub parent: Option<u32>,
    /// The two basins that became this one, the deeper first.
    pub children: Option<[u32; 2]>,
    /// Index of its lowest cell, the first of several.
    pub pit_cell: u32,
    /// Height there. Units: m.
    pub bottom_m: f64,
    /// Level at which the children meet; without children the bottom. Units: m.
    pub sill_m: f64,
    /// Level at which it overflows, none if it cannot. Units: m.
    pub spill_m: Option<f64>,
    /// Cell over which it overflows.
    pub spill_cell: Option<u32>,
    /// The basin without children into whose catchment it overflows; none: off the map.
    pub overflows_to: Option<u32>,
    /// Water it holds when full, that of its children included; none if it cannot overflow. Units: m³.
    pub volume_m3: Option<f64>,
    /// Area of the cells below its spill level. Units: m².
    pub area_m2: f64,
    /// Area whose water runs into it. Units: m².
    pub catchment_m2: f64,
    pub(super) jump: u32,
    /// Cells and water of the children when full.
    base_cells: u32,
    base_volume: f64,
    /// Basins without children in it, or 1.
    pub(super) leaves: u32,
    curve: Stretch,
}

/// The basins of a height field, with everything that running them needs; the heights are not kept.
///
/// Basins are numbered in the order of their spill levels, so children come before parents and a full basin overflows
/// into a lower number (but for its sibling).
#[derive(Debug, Clone, PartialEq)]
pub struct Basins {
    cells: [usize; 2],
    cell_m: f64,
    origin_m: [f64; 2],
    basins: Vec<Basin>,
    labels: Vec<u32>,
    depths: Vec<f64>,
    volumes: Vec<f64>,
    drains: Vec<BasinDrain>,
    off_map_m2: f64,
}

impl Basins {
    /// Finds the basins of a height field.
    ///
    /// O(n) over the cells, O(m log m) over the pits and over the wet cells of each basin; allocates 4 bytes a cell, 16
    /// a wet cell and about 100 a pit, twice that while baking.
    ///
    /// Error: exact heights and areas; volumes as [`Curve::volume_m3`]. Heights are taken as they are: a puddle is as good
    /// as its terrain.
    ///
    /// # Errors
    /// When the grid is empty, its size does not fit, a height is infinite or beyond ±1e7 m, or an option is outside
    /// its domain or off the map.
    pub fn bake(grid: &Grid, options: &BakeOptions) -> Result<Self, ConfigError> {
        let mut holes = grid.validated()?;
        in_range("threshold_m", options.threshold_m, 0.0, 1e3, "0 to 1000 m")?;
        let mut heights = Cow::Borrowed(grid.heights);
        let mut inlets = Vec::with_capacity(options.drains.len());
        for drain in &options.drains {
            drain.inlet.validated()?;
            let cell = grid.cell_at(drain.x_m, drain.z_m).ok_or(ConfigError::OutOfRange {
                field: "drain x_m",
                value: drain.x_m,
                allowed: "a place on the map",
            })?;
            if drain.inlet == Inlet::Hole {
                heights.to_mut()[cell] = f64::NAN;
                holes = true;
            } else {
                inlets.push((cell, drain.inlet));
            }
        }
        let grid = &Grid {
            heights: &heights,
            ..*grid
        };
        let open = !options.closed;
        let catchments = Catchments::new(grid, open, holes);
        let passes = passes(grid, &catchments, open);
        let flood = Flood::new(catchments.pits.len(), &passes);
        let hierarchy = Hierarchy::new(grid, &catchments, &passes, &flood, options.threshold_m);
        drop((passes, flood));
        Ok(Self::assemble(grid, catchments, &hierarchy, &inlets))
    }

    fn assemble(grid: &Grid, catchments: Catchments, hierarchy: &Hierarchy, inlets: &[(usize, Inlet)]) -> Self {
        let mut labels = catchments.labels;
        let count = hierarchy.nodes.len();
        let tops = hierarchy.top_levels();
        // Most cells are dry.
        let holder = |label: u32, height: f64| {
            if label & DRY == 0 && height < tops[label as usize] {
                hierarchy.holder(label, height)
            } else {
                NOBODY
            }
        };
        let mut catchment_cells = vec![0_u64; count];
        let mut own_cells = vec![0_usize; count];
        let mut off_map = 0_u64;
        for (label, &height) in labels.iter_mut().zip(grid.heights) {
            if *label != OUT {
                *label = hierarchy.leaf_of_pit[*label as usize];
            }
            if *label == OUT {
                off_map += u64::from(!height.is_nan());
                continue;
            }
            catchment_cells[(*label & !DRY) as usize] += 1;
            let holder = holder(*label, height);
            if holder != NOBODY {
                own_cells[holder as usize] += 1;
            }
        }
        let mut starts = vec![0; count + 1];
        for (index, own) in own_cells.iter().enumerate() {
            starts[index + 1] = starts[index] + own;
        }
        let mut ends = starts.clone();
        let mut depths = vec![0.0; starts[count]];
        for (&label, &height) in labels.iter().zip(grid.heights) {
            let holder = holder(label, height);
            if holder != NOBODY {
                let end = &mut ends[holder as usize];
                depths[*end] = height - hierarchy.nodes[holder as usize].bottom;
                *end += 1;
            }
        }
        let mut baked = Self {
            cells: [grid.nx, grid.nz],
            cell_m: grid.cell_m,
            origin_m: grid.origin_m,
            basins: Vec::with_capacity(count),
            drains: Vec::new(),
            off_map_m2: off_map as f64 * grid.cell_m * grid.cell_m,
            volumes: vec![0.0; depths.len()],
            labels,
            depths,
        };
        let mut wet_cells = own_cells;
        for index in 0..count {
            if hierarchy.nodes[index].children[0] != NOBODY {
                for child in hierarchy.nodes[index].children {
                    wet_cells[index] += wet_cells[child as usize];
                    catchment_cells[index] += catchment_cells[child as usize];
                }
            }
            let curve = Stretch {
                start: starts[index],
                end: starts[index + 1],
            };
            baked.push(hierarchy, index, curve, wet_cells[index], catchment_cells[index]);
        }
        for &(cell, inlet) in inlets {
            if let Some(leaf) = baked.leaf_at(cell) {
                baked.drains.push(BasinDrain {
                    leaf,
                    level_m: grid.heights[cell],
                    inlet,
                });
            }
        }
        baked
    }

    /// Adds the next basin; its children are there.
    fn push(&mut self, hierarchy: &Hierarchy, index: usize, curve: Stretch, wet: usize, catchment: u64) {
        let node = &hierarchy.nodes[index];
        let area = self.cell_m * self.cell_m;
        let some = |index: u32| (index != NOBODY).then_some(index);
        let children = (node.children[0] != NOBODY).then_some(node.children);
        let base_volume = children.map_or(0.0, |children| {
            children
                .iter()
                .filter_map(|&child| self.basins[child as usize].volume_m3)
                .sum()
        });
        let own = curve.end - curve.start;
        let base = (node.sill - node.bottom, base_volume, (wet - own) as u32);
        let volume = sum_volumes(
            &mut self.depths[curve.start..curve.end],
            &mut self.volumes[curve.start..curve.end],
            base,
            node.spill - node.bottom,
            area,
        );
        self.basins.push(Basin {
            parent: some(node.parent),
            children,
            pit_cell: node.pit_cell,
            bottom_m: node.bottom,
            sill_m: node.sill,
            spill_m: node.spill.is_finite().then_some(node.spill),
            spill_cell: some(node.spill_cell),
            overflows_to: some(node.target),
            volume_m3: volume.is_finite().then_some(volume),
            area_m2: wet as f64 * area,
            catchment_m2: catchment as f64 * area,
            jump: node.jump,
            base_cells: base.2,
            base_volume,
            leaves: children.map_or(1, |children| {
                children.iter().map(|&child| self.basins[child as usize].leaves).sum()
            }),
            curve,
        });
    }

    /// All basins; a basin's number is its index.
    #[must_use]
    pub fn basins(&self) -> &[Basin] {
        &self.basins
    }

    /// Drains that lie in basins.
    #[must_use]
    pub fn drains(&self) -> &[BasinDrain] {
        &self.drains
    }

    /// Cells along x and z.
    #[must_use]
    pub fn cells(&self) -> [usize; 2] {
        self.cells
    }

    /// Edge of a cell. Units: m.
    #[must_use]
    pub fn cell_m(&self) -> f64 {
        self.cell_m
    }

    /// Area whose water leaves the map (or falls into a hole) without reaching a basin. Units: m².
    #[must_use]
    pub fn off_map_m2(&self) -> f64 {
        self.off_map_m2
    }

    /// Volume and level of a basin.
    ///
    /// # Panics
    /// When there is no such basin.
    #[must_use]
    pub fn curve(&self, basin: u32) -> Curve<'_> {
        let at = &self.basins[basin as usize];
        Curve {
            depths: &self.depths[at.curve.start..at.curve.end],
            volumes: &self.volumes[at.curve.start..at.curve.end],
            base_cells: at.base_cells,
            base_depth: at.sill_m - at.bottom_m,
            base_volume: at.base_volume,
            spill_depth: at.spill_m.map_or(f64::INFINITY, |spill| spill - at.bottom_m),
            capacity: at.volume_m3.unwrap_or(f64::INFINITY),
            cell_area: self.cell_m * self.cell_m,
        }
    }

    /// The basin without children into which a cell's water runs; none when it leaves the map or falls into a hole.
    /// A cell that does not exist has none.
    #[must_use]
    pub fn leaf_at(&self, cell: usize) -> Option<u32> {
        let label = *self.labels.get(cell)?;
        (label != OUT).then_some(label & !DRY)
    }

    /// The cell (x, z) that holds a place on the map; none outside.
    #[must_use]
    pub fn cell_at(&self, x_m: f64, z_m: f64) -> Option<usize> {
        self.grid(&[]).cell_at(x_m, z_m)
    }

    /// The leaf whose water may stand on the cell: as [`Self::leaf_at`], but none for hollows that were too shallow to
    /// be kept.
    #[must_use]
    pub fn wettable_leaf_at(&self, cell: usize) -> Option<u32> {
        self.labels.get(cell).copied().filter(|label| label & DRY == 0)
    }

    /// The basin at the top of the hierarchy that holds this one.
    #[must_use]
    pub fn top(&self, basin: u32) -> u32 {
        let mut at = basin;
        while self.basins[at as usize].jump != at {
            at = self.basins[at as usize].jump;
        }
        at
    }

    /// Level to which each cell fills: the ground where it stays dry, NaN in holes, infinite where water cannot leave.
    /// Units: m. Hollows left out for being too shallow stay as they are.
    ///
    /// # Errors
    /// When `heights` (as baked) has another length.
    pub fn filled(&self, heights: &[f64]) -> Result<Vec<f64>, ConfigError> {
        if heights.len() != self.labels.len() {
            return Err(ConfigError::OutOfRange {
                field: "heights.len()",
                value: heights.len() as f64,
                allowed: "that of the baked grid",
            });
        }
        let tops: Vec<f64> = (0..self.basins.len() as u32)
            .map(|basin| self.basins[self.top(basin) as usize].spill_m.unwrap_or(f64::INFINITY))
            .collect();
        let level = |(&height, &label): (&f64, &u32)| {
            if label & DRY == 0 && tops[label as usize] > height {
                tops[label as usize]
            } else {
                height
            }
        };
        Ok(heights.iter().zip(&self.labels).map(level).collect())
    }

    fn grid<'a>(&self, heights: &'a [f64]) -> Grid<'a> {
        Grid {
            nx: self.cells[0],
            nz: self.cells[1],
            cell_m: self.cell_m,
            origin_m: self.origin_m,
            heights,
        }
    }

    /// What `rain bake` prints.
    #[must_use]
    pub fn report(&self) -> BakeReport {
        let merged_at_once = |basin: &Basin| basin.children.is_some() && basin.spill_m == Some(basin.sill_m);
        // Pools of one level that meet in one place become one at once: the steps between are no basins.
        let mut ids = vec![None; self.basins.len()];
        let mut listed = 0;
        for (id, basin) in ids.iter_mut().zip(&self.basins) {
            if !merged_at_once(basin) {
                *id = Some(listed);
                listed += 1;
            }
        }
        let parent = |basin: u32| {
            let mut at = self.basins[basin as usize].parent;
            while let Some(above) = at
                && merged_at_once(&self.basins[above as usize])
            {
                at = self.basins[above as usize].parent;
            }
            at
        };
        let row = |index: usize, id: u32| {
            let basin = &self.basins[index];
            let [x_m, z_m] = self.grid(&[]).centre(basin.pit_cell as usize);
            let above = parent(index as u32);
            // The target's leaf lies inside the neighbour that has the same parent.
            let neighbour = basin.overflows_to.map(|leaf| {
                let mut at = leaf;
                while let Some(next) = parent(at)
                    && Some(next) != above
                {
                    at = next;
                }
                at
            });
            BasinRow {
                id,
                parent: above.and_then(|above| ids[above as usize]),
                x_m,
                z_m,
                bottom_m: basin.bottom_m,
                spill_m: basin.spill_m,
                volume_m3: basin.volume_m3,
                area_m2: basin.area_m2,
                overflows_to: neighbour.and_then(|neighbour| ids[neighbour as usize]),
            }
        };
        let basins: Vec<BasinRow> = ids
            .iter()
            .enumerate()
            .filter_map(|(index, id)| id.map(|id| row(index, id)))
            .collect();
        let top = basins.iter().filter(|basin| basin.parent.is_none());
        BakeReport {
            cells: self.cells,
            cell_m: self.cell_m,
            // Not `sum`, which makes nothing -0.
            total_volume_m3: top
                .filter_map(|basin| basin.volume_m3)
                .fold(0.0, |sum, volume| sum + volume),
            basins,
        }
    }
}

/// The basins of a height field as plain numbers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BakeReport {
    /// Cells along x and z.
    pub cells: [usize; 2],
    /// Edge of a cell. Units: m.
    pub cell_m: f64,
    /// All basins, those inside others included; a basin's id is its index.
    pub basins: Vec<BasinRow>,
    /// Volumes at the top of the hierarchy, those that have one. Units: m³.
    pub total_volume_m3: f64,
}

/// A basin as plain numbers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BasinRow {
    /// Number.
    pub id: u32,
    /// The basin of which it is a part when that is full enough; none at the top.
    pub parent: Option<u32>,
    /// Centre of the lowest cell. Units: m.
    pub x_m: f64,
    /// Centre of the lowest cell. Units: m.
    pub z_m: f64,
    /// Height of the lowest cell. Units: m.
    pub bottom_m: f64,
    /// Level at which it overflows; none if it cannot. Units: m.
    pub spill_m: Option<f64>,
    /// Σ (spill level − ground) · cell²; none if it cannot overflow. Units: m³.
    pub volume_m3: Option<f64>,
    /// Area of the cells below the spill level. Units: m².
    pub area_m2: f64,
    /// The neighbour it overflows into (inside the same parent, or at the top); none: off the map.
    pub overflows_to: Option<u32>,
}
