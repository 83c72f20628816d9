//! Closed-in air: whether rain can be in sight at all from a place.
//!
//! Free space around the eye is flooded on a lattice of small cells that the scene's surfaces close; if the flood
//! meets no cell that rain reaches, no rain is in sight and nothing of it need be drawn.
//!
//! # Accuracy
//! A cell is closed when a surface touches it, so gaps narrower than about two cells (0.5 m) count as shut. Surfaces
//! one can see through must not be added.

use std::collections::hash_map::DefaultHasher;
use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::hash::BuildHasherDefault;

use glam::{DVec3, IVec3, Vec3};

/// Edge of a lattice cell. Units: m.
pub const AIR_CELL_M: f64 = 0.25;

/// Cells per edge of a block that is rasterised at once.
const BLOCK: i32 = 16;

/// A triangle whose box holds more blocks than this (some 250 m of level ground) is not put into the index: it is asked
/// for in each block that a flood meets.
const WIDE_BLOCKS: i64 = 4096;

/// Coordinates are taken up to here. Units: m.
const MAX_COORDINATE_M: f64 = 1e8;

/// Largest number of cells flooded; beyond it the air counts as open.
const MAX_CELLS: usize = 400_000;

/// A set of triangles that close air, by owner.
#[derive(Debug, Default, Clone)]
pub struct AirGrid {
    triangles: BTreeMap<u64, Vec<[DVec3; 3]>>,
    /// Which triangles touch a block.
    index: BTreeMap<[i32; 3], Vec<(u64, u32)>>,
    /// Triangles too wide for the index.
    wide: Vec<(u64, u32)>,
    /// Blocks rasterised so far: a bit a cell.
    blocks: BTreeMap<[i32; 3], Vec<u64>>,
    /// Cells of the last flood in the order they were found, and the same to be asked for. Kept for their room.
    found: Vec<IVec3>,
    seen: HashSet<IVec3, BuildHasherDefault<DefaultHasher>>,
}

/// What a flood found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Air {
    /// Rain reaches a cell that is connected to the eye, or the flood grew too large to say.
    Open,
    /// No cell connected to the eye is reached by rain. Holds the flooded cells.
    ClosedIn(BTreeSet<[i32; 3]>),
}

impl AirGrid {
    /// Adds or replaces the surfaces of `owner`. World metres; triangles with non-finite corners are left out.
    pub fn set(&mut self, owner: u64, triangles: Vec<[DVec3; 3]>) {
        self.remove(owner);
        let triangles: Vec<_> = triangles
            .into_iter()
            .filter(|t| {
                t.iter()
                    .all(|p| p.is_finite() && p.abs().max_element() < MAX_COORDINATE_M)
            })
            .collect();
        for (i, triangle) in triangles.iter().enumerate() {
            let Some(blocks) = blocks_of(triangle) else {
                self.wide.push((owner, i as u32));
                self.blocks.clear();
                continue;
            };
            for block in blocks {
                self.index.entry(block).or_default().push((owner, i as u32));
                self.blocks.remove(&block);
            }
        }
        self.triangles.insert(owner, triangles);
    }

    /// Removes the surfaces of `owner`.
    pub fn remove(&mut self, owner: u64) {
        let Some(triangles) = self.triangles.remove(&owner) else {
            return;
        };
        let wide = self.wide.len();
        self.wide.retain(|(o, _)| *o != owner);
        if self.wide.len() < wide {
            self.blocks.clear();
        }
        for block in triangles.iter().filter_map(blocks_of).flatten() {
            if let Some(list) = self.index.get_mut(&block) {
                list.retain(|(o, _)| *o != owner);
            }
            self.blocks.remove(&block);
        }
    }

    /// Floods the free air around `eye` (world metres) up to `range_m`.
    ///
    /// `reached` says whether rain reaches a point. An eye inside a surface's own cell starts from the free cells next
    /// to it; with none, the air counts as open, as it does for an eye 1e8 m or further away, or nowhere.
    ///
    /// Allocates when it is larger than all before, where it meets blocks of the lattice for the first time since a
    /// surface in them changed, and the cells of closed-in air: keep these, and ask again only when the eye leaves them
    /// or a surface changes.
    pub fn flood(&mut self, eye: DVec3, range_m: f64, mut reached: impl FnMut(DVec3) -> bool) -> Air {
        if !eye.is_finite() || eye.abs().max_element() >= MAX_COORDINATE_M {
            return Air::Open;
        }
        let start = cell_of(eye);
        self.found.clear();
        self.seen.clear();
        for offset in NEIGHBOURS.iter().copied().chain([IVec3::ZERO]) {
            if !self.solid(start + offset) && (offset == IVec3::ZERO || self.solid(start)) {
                self.find(start + offset);
            }
        }
        if self.found.is_empty() {
            return Air::Open;
        }
        let reach = (range_m / AIR_CELL_M).ceil() as i32;
        let mut next = 0;
        while let Some(&cell) = self.found.get(next) {
            next += 1;
            if reached((cell.as_dvec3() + 0.5) * AIR_CELL_M) {
                return Air::Open;
            }
            if self.found.len() > MAX_CELLS {
                return Air::Open;
            }
            for offset in NEIGHBOURS {
                let beside = cell + offset;
                let away = beside - start;
                if away.dot(away) <= reach * reach && !self.seen.contains(&beside) && !self.solid(beside) {
                    self.find(beside);
                }
            }
        }
        Air::ClosedIn(self.found.iter().map(IVec3::to_array).collect())
    }

    /// Adds a cell to the flood, once.
    fn find(&mut self, cell: IVec3) {
        if self.seen.insert(cell) {
            self.found.push(cell);
        }
    }

    fn solid(&mut self, cell: IVec3) -> bool {
        let block = cell.map_div(BLOCK);
        let inside = cell - IVec3::from_array(block) * BLOCK;
        let bit = ((inside.z * BLOCK + inside.y) * BLOCK + inside.x) as usize;
        if !self.index.contains_key(&block) && self.wide.is_empty() {
            return false;
        }
        if !self.blocks.contains_key(&block) {
            let raster = self.rasterise(block);
            self.blocks.insert(block, raster);
        }
        self.blocks[&block][bit / 64] >> (bit % 64) & 1 == 1
    }

    fn rasterise(&self, block: [i32; 3]) -> Vec<u64> {
        let mut bits = vec![0; (BLOCK * BLOCK * BLOCK) as usize / 64];
        let origin = IVec3::from_array(block) * BLOCK;
        let indexed = self.index.get(&block).into_iter().flatten();
        for (owner, i) in indexed.chain(&self.wide) {
            let triangle = self.triangles[owner][*i as usize];
            if !touches_block(&triangle, block) {
                continue;
            }
            // Relative to the block: single precision is enough.
            let local = triangle.map(|p| (p / AIR_CELL_M - origin.as_dvec3()).as_vec3());
            let low = local[0].min(local[1]).min(local[2]).floor().as_ivec3().max(IVec3::ZERO);
            let high = local[0]
                .max(local[1])
                .max(local[2])
                .floor()
                .as_ivec3()
                .min(IVec3::splat(BLOCK - 1));
            for z in low.z..=high.z {
                for y in low.y..=high.y {
                    for x in low.x..=high.x {
                        if touches(&local, IVec3::new(x, y, z).as_vec3() + 0.5) {
                            let bit = ((z * BLOCK + y) * BLOCK + x) as usize;
                            bits[bit / 64] |= 1 << (bit % 64);
                        }
                    }
                }
            }
        }
        bits
    }
}

/// The lattice cell that holds a point; a coordinate that is not a number counts as 0.
///
/// Error: exact.
#[must_use]
pub fn cell_of(p: DVec3) -> IVec3 {
    (p / AIR_CELL_M).floor().as_ivec3()
}

const NEIGHBOURS: [IVec3; 6] = [IVec3::X, IVec3::NEG_X, IVec3::Y, IVec3::NEG_Y, IVec3::Z, IVec3::NEG_Z];

trait MapDiv {
    fn map_div(self, by: i32) -> [i32; 3];
}

impl MapDiv for IVec3 {
    fn map_div(self, by: i32) -> [i32; 3] {
        self.to_array().map(|v| v.div_euclid(by))
    }
}

/// Blocks that a triangle touches; none when its box holds more than [`WIDE_BLOCKS`].
fn blocks_of(triangle: &[DVec3; 3]) -> Option<Vec<[i32; 3]>> {
    let low = cell_of(triangle[0].min(triangle[1]).min(triangle[2])).map_div(BLOCK);
    let high = cell_of(triangle[0].max(triangle[1]).max(triangle[2])).map_div(BLOCK);
    let along = |axis: usize| i64::from(high[axis]) - i64::from(low[axis]) + 1;
    if along(0).saturating_mul(along(1)).saturating_mul(along(2)) > WIDE_BLOCKS {
        return None;
    }
    let mut out = Vec::new();
    for z in low[2]..=high[2] {
        for y in low[1]..=high[1] {
            for x in low[0]..=high[0] {
                // Large slanted triangles touch few of the blocks of their box.
                if touches_block(triangle, [x, y, z]) {
                    out.push([x, y, z]);
                }
            }
        }
    }
    Some(out)
}

fn touches_block(triangle: &[DVec3; 3], block: [i32; 3]) -> bool {
    let centre = IVec3::from_array(block).as_dvec3() + 0.5;
    let local = triangle.map(|p| (p / (AIR_CELL_M * f64::from(BLOCK)) - centre).as_vec3() + 0.5);
    touches(&local, Vec3::splat(0.5))
}

/// Whether a triangle touches the unit cube around `centre`: separating axes (Akenine-Möller 2001).
fn touches(triangle: &[Vec3; 3], centre: Vec3) -> bool {
    let v = triangle.map(|p| p - centre);
    let half = 0.5 + 1e-4;
    let low = v[0].min(v[1]).min(v[2]);
    let high = v[0].max(v[1]).max(v[2]);
    if low.max_element() > half || high.min_element() < -half {
        return false;
    }
    let edges = [v[1] - v[0], v[2] - v[1], v[0] - v[2]];
    let normal = edges[0].cross(edges[1]);
    if normal.dot(v[0]).abs() > half * normal.abs().element_sum() {
        return false;
    }
    for edge in edges {
        for axis in [Vec3::X.cross(edge), Vec3::Y.cross(edge), Vec3::Z.cross(edge)] {
            let p = v.map(|q| axis.dot(q));
            let radius = half * axis.abs().element_sum();
            if p[0].min(p[1]).min(p[2]) > radius || p[0].max(p[1]).max(p[2]) < -radius {
                return false;
            }
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quad(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]) -> Vec<[DVec3; 3]> {
        let [a, b, c, d] = [a, b, c, d].map(DVec3::from_array);
        vec![[a, b, c], [a, c, d]]
    }

    /// A room 4 × 3 × 5 m with its lowest corner at `o`; `door`: leaves out a wall.
    fn room(o: DVec3, door: bool) -> Vec<[DVec3; 3]> {
        let p = |x: f64, y: f64, z: f64| (o + DVec3::new(x, y, z)).to_array();
        let mut t = quad(p(0., 0., 0.), p(4., 0., 0.), p(4., 0., 5.), p(0., 0., 5.));
        t.extend(quad(p(0., 3., 0.), p(4., 3., 0.), p(4., 3., 5.), p(0., 3., 5.)));
        t.extend(quad(p(0., 0., 0.), p(0., 3., 0.), p(0., 3., 5.), p(0., 0., 5.)));
        t.extend(quad(p(4., 0., 0.), p(4., 3., 0.), p(4., 3., 5.), p(4., 0., 5.)));
        t.extend(quad(p(0., 0., 0.), p(4., 0., 0.), p(4., 3., 0.), p(0., 3., 0.)));
        if !door {
            t.extend(quad(p(0., 0., 5.), p(4., 0., 5.), p(4., 3., 5.), p(0., 3., 5.)));
        }
        t
    }

    /// Rain reaches what lies outside the room's box.
    fn outside(o: DVec3) -> impl Fn(DVec3) -> bool {
        move |p| {
            let q = p - o;
            q.min_element() < 0.0 || q.x > 4.0 || q.y > 3.0 || q.z > 5.0
        }
    }

    #[test]
    fn a_room_is_closed_in_and_a_missing_wall_opens_it() {
        for o in [DVec3::ZERO, DVec3::new(-3.1, 7.3, 100_000.2)] {
            let eye = o + DVec3::new(2.0, 1.6, 2.0);
            let mut grid = AirGrid::default();
            grid.set(1, room(o, false));
            let Air::ClosedIn(cells) = grid.flood(eye, 15.0, outside(o)) else {
                panic!("a closed room is open");
            };
            // 4 × 3 × 5 m without the cells that walls touch.
            assert!(cells.len() > 2500 && cells.len() < 3900, "{}", cells.len());
            grid.set(1, room(o, true));
            assert_eq!(grid.flood(eye, 15.0, outside(o)), Air::Open);
            grid.remove(1);
            assert_eq!(grid.flood(eye, 15.0, outside(o)), Air::Open);
        }
    }

    #[test]
    fn slanted_walls_have_no_leaks() {
        // A tetrahedron: every face slanted.
        let [a, b, c, d] = [
            DVec3::new(0.0, 0.0, 0.0),
            DVec3::new(7.0, 0.3, 0.7),
            DVec3::new(2.9, 0.1, 6.1),
            DVec3::new(3.0, 5.3, 2.2),
        ];
        let mut grid = AirGrid::default();
        grid.set(9, vec![[a, b, c], [a, b, d], [b, c, d], [a, c, d]]);
        let centre = (a + b + c + d) / 4.0;
        assert!(matches!(
            grid.flood(centre, 20.0, |p| (p - centre).length() > 8.0),
            Air::ClosedIn(_)
        ));
    }

    #[test]
    fn a_ground_of_kilometres_closes_air_like_a_small_one() {
        // A room without a floor of its own, on ground that reaches to the horizon.
        let walls: Vec<_> = room(DVec3::ZERO, false).into_iter().skip(2).collect();
        let far = 8_000.0;
        let ground = quad([-far, 0., -far], [far, 0., -far], [far, 0., far], [-far, 0., far]);
        let eye = DVec3::new(2.0, 1.6, 2.0);
        let mut grid = AirGrid::default();
        grid.set(1, walls);
        assert_eq!(grid.flood(eye, 15.0, outside(DVec3::ZERO)), Air::Open, "no floor");
        grid.set(2, ground);
        let Air::ClosedIn(cells) = grid.flood(eye, 15.0, outside(DVec3::ZERO)) else {
            panic!("the ground is no floor");
        };
        assert!(cells.len() > 2500 && cells.len() < 3900, "{}", cells.len());
        grid.remove(2);
        assert_eq!(grid.flood(eye, 15.0, outside(DVec3::ZERO)), Air::Open, "taken away");
    }

    #[test]
    fn non_finite_triangles_are_left_out() {
        let mut grid = AirGrid::default();
        grid.set(
            1,
            vec![
                [DVec3::NAN, DVec3::X, DVec3::Y],
                [DVec3::splat(f64::INFINITY), DVec3::X, DVec3::Y],
            ],
        );
        assert_eq!(grid.flood(DVec3::ZERO, 2.0, |p| p.length() > 1.0), Air::Open);
    }
}
