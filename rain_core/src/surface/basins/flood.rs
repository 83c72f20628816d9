//! Passes between catchments, and the level to which each is flooded from outside.
//!
//! The lowest pass between two catchments is the lowest, over neighbouring cells on either side, of the higher of the
//! two. A path between pits that is lowest at its highest point leads over such passes only, since from a pass the way
//! down to either pit is never higher; so flooding works on pits and passes, and all levels are heights of cells.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::catchment::{Catchments, OUT};
use super::grid::{DIAGONAL, Grid};

/// The lowest connection of two catchments.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pass {
    /// Height of the higher of the two cells. Units: m.
    pub(super) level: f64,
    /// That cell.
    pub(super) cell: u32,
    /// Descent from that cell to the other, in heights per cell; infinite off the map.
    pub(super) slope: f64,
    /// The two pits; the second may be [`OUT`].
    pub(super) pits: [u32; 2],
}

impl Pass {
    /// Lowest first; of equal ones the cell of lower index, and over the same cell the steeper.
    fn order(&self) -> (u64, u32, u64, [u32; 2]) {
        (sortable(self.level), self.cell, !sortable(self.slope), self.pits)
    }
}

/// Bits that sort as the numbers do; both zeros are one.
pub(super) fn sortable(value: f64) -> u64 {
    let bits = (value + 0.0).to_bits();
    if bits >> 63 == 0 { bits | 1 << 63 } else { !bits }
}

/// The lowest pass of every pair, by open addressing.
struct PassTable {
    keys: Vec<u64>,
    passes: Vec<Pass>,
    used: usize,
}

const FREE: u64 = u64::MAX;

const EMPTY: Pass = Pass {
    level: 0.0,
    cell: 0,
    slope: 0.0,
    pits: [OUT; 2],
};

impl PassTable {
    fn new() -> Self {
        Self {
            keys: vec![FREE; 1 << 10],
            passes: vec![EMPTY; 1 << 10],
            used: 0,
        }
    }

    /// The pair's slot, or the free one where it belongs.
    fn slot(&self, key: u64) -> usize {
        let shift = 64 - self.keys.len().trailing_zeros();
        let mut slot = (key.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> shift) as usize;
        while self.keys[slot] != key && self.keys[slot] != FREE {
            slot = (slot + 1) & (self.keys.len() - 1);
        }
        slot
    }

    /// Keeps the first in order.
    fn offer(&mut self, a: u32, b: u32, level: f64, cell: u32, slope: f64) {
        let pits = [a.min(b), a.max(b)];
        let key = u64::from(pits[0]) << 32 | u64::from(pits[1]);
        let pass = Pass {
            level,
            cell,
            slope,
            pits,
        };
        let slot = self.slot(key);
        if self.keys[slot] == FREE {
            self.keys[slot] = key;
            self.passes[slot] = pass;
            self.used += 1;
            if self.used * 2 > self.keys.len() {
                self.grow();
            }
        } else if level <= self.passes[slot].level && pass.order() < self.passes[slot].order() {
            self.passes[slot] = pass;
        }
    }

    fn grow(&mut self) {
        let size = self.keys.len() * 2;
        let keys = core::mem::replace(&mut self.keys, vec![FREE; size]);
        let passes = core::mem::replace(&mut self.passes, vec![EMPTY; size]);
        for (key, pass) in keys.into_iter().zip(passes) {
            if key != FREE {
                let slot = self.slot(key);
                self.keys[slot] = key;
                self.passes[slot] = pass;
            }
        }
    }

    /// All passes in order.
    fn sorted(self) -> Vec<Pass> {
        let used = |pass: &Pass| pass.pits[0] != OUT;
        let mut passes: Vec<Pass> = self.passes.into_iter().filter(used).collect();
        passes.sort_unstable_by_key(Pass::order);
        passes
    }
}

/// Every pair of catchments that touch, and every catchment that touches an open border, with its lowest pass.
pub(super) fn passes(grid: &Grid, catchments: &Catchments, open: bool) -> Vec<Pass> {
    let labels = &catchments.labels;
    let heights = grid.heights;
    let (nx, nz) = (grid.nx, grid.nz);
    let mut table = PassTable::new();
    let mut meet = |cell: usize, other: usize, weight: f64| {
        if labels[cell] != labels[other] {
            let (a, b) = (heights[cell], heights[other]);
            // A hole has no height; the cells beside it leave the map as it does.
            if a >= b {
                table.offer(labels[cell], labels[other], a, cell as u32, (a - b) * weight);
            } else if b > a {
                table.offer(labels[cell], labels[other], b, other as u32, (b - a) * weight);
            }
        }
    };
    for row in 0..nz {
        for cell in row * nx..(row + 1) * nx {
            let column = cell - row * nx;
            if column + 1 < nx {
                meet(cell, cell + 1, 1.0);
            }
            if row + 1 < nz {
                if column > 0 {
                    meet(cell, cell + nx - 1, DIAGONAL);
                }
                meet(cell, cell + nx, 1.0);
                if column + 1 < nx {
                    meet(cell, cell + nx + 1, DIAGONAL);
                }
            }
        }
    }
    if open {
        let rows = (0..nx).chain((nz - 1) * nx..nz * nx);
        let columns = (0..nz).flat_map(|row| [row * nx, row * nx + nx - 1]);
        for cell in rows.chain(columns) {
            let height = heights[cell];
            let mut leave = |from: usize| {
                if labels[from] != OUT && heights[from] <= height {
                    table.offer(labels[from], OUT, height, cell as u32, f64::INFINITY);
                }
            };
            // Rain on the cell may run inwards, but a pool that reaches it leaves the map.
            leave(cell);
            grid.neighbours(cell, leave);
        }
    }
    table.sorted()
}

/// How far each catchment fills when water may leave the map.
pub(super) struct Flood {
    /// For each pit the level of its filled surface; infinite where nothing can leave. Units: m.
    pub(super) levels: Vec<f64>,
    /// For one pit of each basin at the top of the hierarchy, in the order in which a flood from outside enters them:
    /// the pit, and the pass over which its basin overflows.
    pub(super) outlets: Vec<(u32, u32)>,
}

impl Flood {
    /// Floods from outside, always over the lowest pass at hand (Prim 1957).
    pub(super) fn new(pits: usize, passes: &[Pass]) -> Self {
        let around = Around::new(pits, passes);
        let mut levels = vec![f64::INFINITY; pits];
        let mut outlets = Vec::new();
        // Level after the pass, then the pass's own: what is connected below the level comes before the next basin.
        let mut heap = BinaryHeap::new();
        let entry = |flooded: f64, index: u32, pit: u32| {
            let pass = &passes[index as usize];
            let level = if pass.level > flooded { pass.level } else { flooded };
            Reverse((sortable(level), sortable(pass.level), index, pit))
        };
        for (index, pass) in passes.iter().enumerate() {
            if pass.pits[1] == OUT {
                heap.push(entry(f64::NEG_INFINITY, index as u32, pass.pits[0]));
            }
        }
        let mut done = vec![false; pits];
        while let Some(Reverse((level, own, index, pit))) = heap.pop() {
            if core::mem::replace(&mut done[pit as usize], true) {
                continue;
            }
            let pass = &passes[index as usize];
            let from = other_side(pass, pit);
            let flooded = if from == OUT {
                f64::NEG_INFINITY
            } else {
                levels[from as usize]
            };
            if own == level {
                levels[pit as usize] = pass.level;
                outlets.push((pit, index));
            } else {
                levels[pit as usize] = flooded;
            }
            for &next in around.of(pit) {
                let other = other_side(&passes[next as usize], pit);
                if other != OUT && !done[other as usize] {
                    heap.push(entry(levels[pit as usize], next, other));
                }
            }
        }
        Self { levels, outlets }
    }
}

/// The pit on the other side of a pass.
pub(super) fn other_side(pass: &Pass, pit: u32) -> u32 {
    if pass.pits[0] == pit {
        pass.pits[1]
    } else {
        pass.pits[0]
    }
}

/// The passes around every pit.
struct Around {
    starts: Vec<u32>,
    passes: Vec<u32>,
}

impl Around {
    fn new(pits: usize, passes: &[Pass]) -> Self {
        let mut starts = vec![0; pits + 2];
        let ends = |pass: &Pass| pass.pits.into_iter().filter(|&pit| pit != OUT);
        for pass in passes {
            for pit in ends(pass) {
                starts[pit as usize + 2] += 1;
            }
        }
        for index in 2..starts.len() {
            starts[index] += starts[index - 1];
        }
        let mut list = vec![0; starts[pits + 1] as usize];
        for (index, pass) in passes.iter().enumerate() {
            for pit in ends(pass) {
                let slot = &mut starts[pit as usize + 1];
                list[*slot as usize] = index as u32;
                *slot += 1;
            }
        }
        Self { starts, passes: list }
    }

    fn of(&self, pit: u32) -> &[u32] {
        &self.passes[self.starts[pit as usize] as usize..self.starts[pit as usize + 1] as usize]
    }
}
