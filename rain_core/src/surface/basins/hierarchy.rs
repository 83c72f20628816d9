//! Which basins lie inside which: the binary tree of merging pools.

use super::catchment::{Catchments, OUT};
use super::flood::{Flood, Pass, other_side, sortable};
use super::grid::Grid;

/// No such basin.
pub(super) const NOBODY: u32 = u32::MAX;
/// Marks a pit whose catchment belongs to a basin although its own hollow does not.
pub(super) const DRY: u32 = 1 << 31;

/// A basin while the tree grows.
#[derive(Clone, Copy)]
pub(super) struct Node {
    pub(super) parent: u32,
    pub(super) children: [u32; 2],
    /// Lowest cell and its height.
    pub(super) pit_cell: u32,
    pub(super) bottom: f64,
    /// Level at which the children meet; of a leaf its bottom.
    pub(super) sill: f64,
    /// Level at which it overflows, infinite if it cannot.
    pub(super) spill: f64,
    pub(super) spill_cell: u32,
    /// The pit into whose catchment it overflows; after renumbering the basin, or [`OUT`].
    pub(super) target: u32,
    /// Order among equal spill levels: basins inside others first, then as they came.
    rank: (bool, u32),
    kept: bool,
    /// Reached over its parents: its jump goes to an ancestor about half-way to the top.
    pub(super) jump: u32,
    depth: u32,
}

/// All basins that are deep enough, children before parents, in the order in which they would overflow.
pub(super) struct Hierarchy {
    pub(super) nodes: Vec<Node>,
    /// For each pit the leaf basin that takes its catchment, or [`OUT`]; [`DRY`] is added where the pit's own hollow
    /// is a basin too shallow to be kept.
    pub(super) leaf_of_pit: Vec<u32>,
}

struct Builder {
    nodes: Vec<Node>,
    /// Union of pits.
    roots: Vec<u32>,
    /// Of a union's root: the basin that holds it all.
    top: Vec<u32>,
    /// Where the catchment of a pit that was given up goes.
    redirect: Vec<u32>,
    threshold: f64,
}

impl Hierarchy {
    /// Merges pits over the passes below their flood level, lowest first (Kruskal 1956). A basin shallower than
    /// `threshold` when it meets another is part of the other; at the top of the hierarchy it is dropped.
    pub(super) fn new(grid: &Grid, catchments: &Catchments, passes: &[Pass], flood: &Flood, threshold: f64) -> Self {
        let mut builder = Builder::new(grid, catchments, threshold);
        for pass in passes {
            if pass.pits[1] != OUT && pass.level < flood.levels[pass.pits[0] as usize] {
                builder.merge(pass);
            }
        }
        let mut dropped = vec![false; catchments.pits.len()];
        for (order, &(pit, pass)) in flood.outlets.iter().enumerate() {
            let pass = &passes[pass as usize];
            let top = builder.top_of(pit);
            let target = other_side(pass, pit);
            let node = &mut builder.nodes[top as usize];
            close(node, pass, target, (true, order as u32));
            if pass.level - node.bottom < threshold {
                node.kept = false;
                builder.redirect[top as usize] = target;
                dropped[top as usize] = true;
            }
        }
        builder.finish(&dropped)
    }

    /// For each basin the spill level of the one at the top above it.
    pub(super) fn top_levels(&self) -> Vec<f64> {
        let mut levels: Vec<f64> = self.nodes.iter().map(|node| node.spill).collect();
        for index in (0..levels.len()).rev() {
            let parent = self.nodes[index].parent;
            if parent != NOBODY {
                levels[index] = levels[parent as usize];
            }
        }
        levels
    }

    /// The lowest basin on the way up from `leaf` whose spill level is above `height`.
    pub(super) fn holder(&self, leaf: u32, height: f64) -> u32 {
        let mut at = leaf;
        loop {
            let node = &self.nodes[at as usize];
            if node.spill > height {
                return at;
            }
            if node.parent == NOBODY {
                return NOBODY;
            }
            at = if self.nodes[node.jump as usize].spill > height {
                node.parent
            } else {
                node.jump
            };
        }
    }
}

fn close(node: &mut Node, pass: &Pass, target: u32, rank: (bool, u32)) {
    node.spill = pass.level;
    node.spill_cell = pass.cell;
    node.target = target;
    node.rank = rank;
}

impl Builder {
    fn new(grid: &Grid, catchments: &Catchments, threshold: f64) -> Self {
        let leaf = |&cell: &u32| {
            let bottom = grid.heights[cell as usize];
            Node {
                parent: NOBODY,
                children: [NOBODY; 2],
                pit_cell: cell,
                bottom,
                sill: bottom,
                spill: f64::INFINITY,
                spill_cell: NOBODY,
                target: OUT,
                rank: (true, u32::MAX),
                kept: true,
                jump: NOBODY,
                depth: 0,
            }
        };
        let pits = 0..catchments.pits.len() as u32;
        Self {
            nodes: catchments.pits.iter().map(leaf).collect(),
            roots: pits.clone().collect(),
            top: pits.clone().collect(),
            redirect: pits.collect(),
            threshold,
        }
    }

    fn root(&mut self, pit: u32) -> u32 {
        let mut at = pit;
        while self.roots[at as usize] != at {
            let above = self.roots[self.roots[at as usize] as usize];
            self.roots[at as usize] = above;
            at = above;
        }
        at
    }

    fn top_of(&mut self, pit: u32) -> u32 {
        let root = self.root(pit);
        self.top[root as usize]
    }

    fn merge(&mut self, pass: &Pass) {
        let roots = pass.pits.map(|pit| self.root(pit));
        if roots[0] == roots[1] {
            return;
        }
        let tops = roots.map(|root| self.top[root as usize]);
        let bottoms = tops.map(|top| {
            let node = &self.nodes[top as usize];
            (sortable(node.bottom), node.pit_cell)
        });
        let deep = usize::from(bottoms[1] < bottoms[0]);
        let shallow = 1 - deep;
        self.roots[roots[shallow] as usize] = roots[deep];
        if pass.level - self.nodes[tops[shallow] as usize].bottom < self.threshold {
            // Nothing inside it was deep enough either, so it is one pit's basin.
            self.nodes[tops[shallow] as usize].kept = false;
            self.redirect[tops[shallow] as usize] = pass.pits[deep];
            return;
        }
        let parent = self.nodes.len() as u32;
        let order = parent * 2;
        for side in [deep, shallow] {
            let node = &mut self.nodes[tops[side] as usize];
            node.parent = parent;
            close(node, pass, pass.pits[1 - side], (false, order + side as u32));
        }
        let below = self.nodes[tops[deep] as usize];
        self.nodes.push(Node {
            parent: NOBODY,
            children: [tops[deep], tops[shallow]],
            sill: pass.level,
            spill: f64::INFINITY,
            spill_cell: NOBODY,
            target: OUT,
            rank: (true, u32::MAX),
            ..below
        });
        self.top[roots[deep] as usize] = parent;
    }

    /// Numbers what is kept and resolves all references.
    fn finish(self, dropped: &[bool]) -> Hierarchy {
        let mut order: Vec<u32> = (0..self.nodes.len() as u32)
            .filter(|&node| self.nodes[node as usize].kept)
            .collect();
        order.sort_unstable_by_key(|&node| {
            let node = &self.nodes[node as usize];
            (sortable(node.spill), node.rank)
        });
        let mut number = vec![NOBODY; self.nodes.len()];
        for (new, &old) in order.iter().enumerate() {
            number[old as usize] = new as u32;
        }
        let renumber = |node: u32| if node == NOBODY { NOBODY } else { number[node as usize] };
        let leaf_of_pit = self.resolve(dropped, &number);
        let mut nodes: Vec<Node> = order.iter().map(|&old| self.nodes[old as usize]).collect();
        for index in (0..nodes.len()).rev() {
            let mut node = nodes[index];
            node.parent = renumber(node.parent);
            node.children = node.children.map(renumber);
            if node.target != OUT {
                let leaf = leaf_of_pit[node.target as usize];
                node.target = if leaf == OUT { OUT } else { leaf & !DRY };
            }
            (node.jump, node.depth) = if node.parent == NOBODY {
                (index as u32, 0)
            } else {
                let above = &nodes[node.parent as usize];
                let far = &nodes[above.jump as usize];
                let even = above.depth - far.depth == far.depth - nodes[far.jump as usize].depth;
                (if even { far.jump } else { node.parent }, above.depth + 1)
            };
            nodes[index] = node;
        }
        Hierarchy { nodes, leaf_of_pit }
    }

    /// Follows the redirections of pits that were given up.
    fn resolve(&self, dropped: &[bool], number: &[u32]) -> Vec<u32> {
        let mut resolved = vec![NOBODY - 1; self.redirect.len()];
        let mut way = Vec::new();
        for pit in 0..self.redirect.len() as u32 {
            let mut at = pit;
            way.clear();
            let mut end = loop {
                if at == OUT {
                    break OUT;
                }
                if resolved[at as usize] != NOBODY - 1 {
                    break resolved[at as usize];
                }
                if self.redirect[at as usize] == at {
                    resolved[at as usize] = number[at as usize];
                    break number[at as usize];
                }
                way.push(at);
                at = self.redirect[at as usize];
            };
            while let Some(passed) = way.pop() {
                if dropped[passed as usize] && end != OUT {
                    end |= DRY;
                }
                resolved[passed as usize] = end;
            }
        }
        resolved
    }
}
