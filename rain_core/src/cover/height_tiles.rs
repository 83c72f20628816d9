//! World-anchored tiles of the highest occluder along the rain.
//!
//! The projected plane is cut into cells that stay in their place in the world, 64 × 64 to a tile. Tiles are keyed by
//! integers and held in key order: precision does not fall off with distance, and no result depends on an order of
//! hashing.

use super::lookup::OPEN_SKY;
use core::cell::Cell;
use std::collections::BTreeMap;

/// Cells along the side of a tile.
pub const TILE_CELLS: usize = 64;

/// Place of a tile in the projected plane, in whole tiles from the origin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TileKey {
    /// Along world x. Units: tiles.
    pub x: i32,
    /// Along world z. Units: tiles.
    pub z: i32,
}

/// 64 × 64 heights, row by row: x runs fastest.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightTile {
    heights: Vec<f32>,
    highest: f32,
}

impl HeightTile {
    fn empty() -> Self {
        Self {
            heights: vec![OPEN_SKY; TILE_CELLS * TILE_CELLS],
            highest: OPEN_SKY,
        }
    }

    /// Fills the tile by `draw`, which gets the cells at [`OPEN_SKY`].
    fn redraw(&mut self, draw: impl FnOnce(&mut [f32])) {
        self.heights.fill(OPEN_SKY);
        draw(&mut self.heights);
        self.highest = self.heights.iter().copied().fold(OPEN_SKY, f32::max);
    }

    /// Heights above the reference plane, row by row, [`OPEN_SKY`] where nothing covers. Units: m.
    #[must_use]
    pub fn heights(&self) -> &[f32] {
        &self.heights
    }

    /// The highest of them.
    #[must_use]
    pub fn highest(&self) -> f32 {
        self.highest
    }
}

/// The tiles that hold anything, in key order.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightTiles {
    tiles: BTreeMap<TileKey, HeightTile>,
    highest: f32,
}

impl Default for HeightTiles {
    fn default() -> Self {
        Self {
            tiles: BTreeMap::new(),
            highest: OPEN_SKY,
        }
    }
}

impl HeightTiles {
    /// The tile at `key`, if anything lies in it.
    #[must_use]
    pub fn get(&self, key: TileKey) -> Option<&HeightTile> {
        self.tiles.get(&key)
    }

    /// All tiles in key order.
    pub fn iter(&self) -> impl Iterator<Item = (TileKey, &HeightTile)> {
        self.tiles.iter().map(|(key, tile)| (*key, tile))
    }

    /// How many tiles hold anything.
    #[must_use]
    pub fn len(&self) -> usize {
        self.tiles.len()
    }

    /// Whether nothing is covered.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.tiles.is_empty()
    }

    /// The highest occluder of the map, or [`OPEN_SKY`]. Units: m above the reference plane.
    #[must_use]
    pub fn highest(&self) -> f32 {
        self.highest
    }

    pub(crate) fn remove(&mut self, key: TileKey) {
        self.tiles.remove(&key);
    }

    /// Fills a tile by `draw`, which gets the cells at [`OPEN_SKY`]. Allocates it where there was none.
    pub(crate) fn redraw(&mut self, key: TileKey, draw: impl FnOnce(&mut [f32])) {
        self.tiles.entry(key).or_insert_with(HeightTile::empty).redraw(draw);
    }

    pub(crate) fn find_highest(&mut self) {
        self.highest = self.tiles.values().map(HeightTile::highest).fold(OPEN_SKY, f32::max);
    }

    /// A reader for places that lie close together.
    #[must_use]
    pub fn reader(&self) -> TileReader<'_> {
        TileReader {
            tiles: self,
            last: Cell::new(None),
        }
    }
}

/// Reads single cells and remembers the last tile: the samples of one look-up mostly lie in one tile.
#[derive(Debug)]
pub struct TileReader<'a> {
    tiles: &'a HeightTiles,
    last: Cell<Option<(TileKey, Option<&'a HeightTile>)>>,
}

impl TileReader<'_> {
    /// Height of a cell counted from the origin of the projected plane, [`OPEN_SKY`] outside every tile.
    /// Units: m above the reference plane.
    #[must_use]
    pub fn height(&self, cell_x: i64, cell_z: i64) -> f32 {
        let side = TILE_CELLS as i64;
        let (Ok(x), Ok(z)) = (
            i32::try_from(cell_x.div_euclid(side)),
            i32::try_from(cell_z.div_euclid(side)),
        ) else {
            return OPEN_SKY;
        };
        let key = TileKey { x, z };
        let tile = match self.last.get() {
            Some((last, tile)) if last == key => tile,
            _ => {
                let tile = self.tiles.get(key);
                self.last.set(Some((key, tile)));
                tile
            }
        };
        tile.map_or(OPEN_SKY, |t| {
            t.heights[(cell_z.rem_euclid(side) * side + cell_x.rem_euclid(side)) as usize]
        })
    }
}
