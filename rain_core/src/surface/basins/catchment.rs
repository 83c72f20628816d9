//! Where the water of every cell runs to: steepest descent, flats resolved.

use super::grid::{DIAGONAL, Grid};

/// Water of this cell leaves the map.
pub(super) const OUT: u32 = u32::MAX;
/// Not known yet.
const NONE: u32 = u32::MAX - 1;
/// Marks a value as a pit's number rather than the index of the next cell downhill.
const PIT: u32 = 1 << 31;

/// Every cell's pit.
pub(super) struct Catchments {
    /// For each cell the number of its pit, or [`OUT`].
    pub(super) labels: Vec<u32>,
    /// For each pit its cell: of a flat one, the first.
    pub(super) pits: Vec<u32>,
}

impl Catchments {
    /// Follows the steepest of eight descents. Equal ones: the neighbour of lower index. A border cell without a
    /// lower neighbour leaves an open map; a cell beside a hole falls into it. A flat drains to its nearest way out
    /// (in steps, equal distance: the earlier found), or is a pit as a whole.
    pub(super) fn new(grid: &Grid, open: bool, holes: bool) -> Self {
        let mut labels = vec![NONE; grid.heights.len()];
        let mut level_cells = Vec::new();
        for row in 0..grid.nz {
            for column in 0..grid.nx {
                let cell = row * grid.nx + column;
                let inside = column > 0 && column + 1 < grid.nx && row > 0 && row + 1 < grid.nz;
                labels[cell] = if inside {
                    downhill_inside(grid, cell, holes)
                } else {
                    downhill_at_border(grid, cell, open)
                };
                if labels[cell] == NONE {
                    level_cells.push(cell as u32);
                }
            }
        }
        drain_flats(grid, &mut labels, &level_cells);
        let pits = find_pits(grid, &mut labels, &level_cells);
        follow(&mut labels);
        Self { labels, pits }
    }
}

/// The lower neighbour of a cell that has all eight.
fn downhill_inside(grid: &Grid, cell: usize, holes: bool) -> u32 {
    let (heights, nx) = (grid.heights, grid.nx);
    let height = heights[cell];
    let above = &heights[cell - nx - 1..][..3];
    let beside = &heights[cell - 1..][..3];
    let below = &heights[cell + nx - 1..][..3];
    if holes {
        let sum = above[0] + above[1] + above[2] + beside[0] + beside[1] + beside[2] + below[0] + below[1] + below[2];
        if sum.is_nan() {
            return OUT;
        }
    }
    let candidates = [
        ((height - above[0]) * DIAGONAL, cell - nx - 1),
        (height - above[1], cell - nx),
        ((height - above[2]) * DIAGONAL, cell - nx + 1),
        (height - beside[0], cell - 1),
        (height - beside[2], cell + 1),
        ((height - below[0]) * DIAGONAL, cell + nx - 1),
        (height - below[1], cell + nx),
        ((height - below[2]) * DIAGONAL, cell + nx + 1),
    ];
    let mut best = (0.0, NONE);
    for (drop, other) in candidates {
        if drop > best.0 {
            best = (drop, other as u32);
        }
    }
    best.1
}

/// The same at the edge of the map.
fn downhill_at_border(grid: &Grid, cell: usize, open: bool) -> u32 {
    let height = grid.heights[cell];
    if height.is_nan() {
        return OUT;
    }
    let mut best = (0.0, if open { OUT } else { NONE });
    let mut beside_hole = false;
    grid.neighbours(cell, |other| {
        beside_hole |= grid.heights[other].is_nan();
        let straight = other % grid.nx == cell % grid.nx || other / grid.nx == cell / grid.nx;
        let weight = if straight { 1.0 } else { DIAGONAL };
        let drop = (height - grid.heights[other]) * weight;
        if drop > best.0 {
            best = (drop, other as u32);
        }
    });
    if beside_hole { OUT } else { best.1 }
}

/// Lets flats with a way out drain to it, breadth first from all ways out.
fn drain_flats(grid: &Grid, labels: &mut [u32], level_cells: &[u32]) {
    let mut queue = Vec::new();
    let mut exits = Vec::new();
    for &cell in level_cells {
        let mut exit = NONE;
        grid.neighbours(cell as usize, |other| {
            if exit == NONE && labels[other] != NONE && grid.heights[other] == grid.heights[cell as usize] {
                exit = other as u32;
            }
        });
        if exit != NONE {
            queue.push(cell);
            exits.push(exit);
        }
    }
    for (&cell, &exit) in queue.iter().zip(&exits) {
        labels[cell as usize] = exit;
    }
    spread(grid, labels, &mut queue, |from| from);
}

/// What is left are pits: numbers them in rising order of their first cell and labels their cells.
fn find_pits(grid: &Grid, labels: &mut [u32], level_cells: &[u32]) -> Vec<u32> {
    let mut pits = Vec::new();
    let mut queue = Vec::new();
    for &cell in level_cells {
        if labels[cell as usize] == NONE {
            let label = PIT | pits.len() as u32;
            pits.push(cell);
            labels[cell as usize] = label;
            queue.clear();
            queue.push(cell);
            spread(grid, labels, &mut queue, |_| label);
        }
    }
    pits
}

/// Gives all unlabelled cells of equal height around those in the queue, and around these, a label.
fn spread(grid: &Grid, labels: &mut [u32], queue: &mut Vec<u32>, label: impl Fn(u32) -> u32) {
    let mut next = 0;
    while let Some(&cell) = queue.get(next) {
        next += 1;
        grid.neighbours(cell as usize, |other| {
            if labels[other] == NONE && grid.heights[other] == grid.heights[cell as usize] {
                labels[other] = label(cell);
                queue.push(other as u32);
            }
        });
    }
}

/// Replaces every pointer downhill by what is at its end.
fn follow(labels: &mut [u32]) {
    for start in 0..labels.len() {
        let mut cell = start;
        while labels[cell] < PIT {
            cell = labels[cell] as usize;
        }
        let end = labels[cell];
        cell = start;
        while labels[cell] < PIT {
            let next = labels[cell] as usize;
            labels[cell] = end;
            cell = next;
        }
    }
    for label in labels {
        if *label != OUT {
            *label &= !PIT;
        }
    }
}
