//! Water at a place, and maps for the picture.

use glam::DVec3;

use super::layers::class_of;
use super::run::Ground;
use crate::error::clamped;
use crate::surface::basins::{BasinRun, Basins};
use crate::surface::height_field::GridFrame;
use crate::weather::{ColumnF32, SurfaceClass, SurfaceProperties};

/// Level where no pool is near, in [`Ground::levels`]. Units: m.
pub const DRY_LEVEL: f32 = -1e9;
/// How far from a surface a place may be to be on it. Units: m.
const REACH_M: f64 = 0.5;
/// Depth to which a basin that cannot overflow is filled by hand. Units: m.
const CLOSED_DEPTH_M: f64 = 0.1;

/// Which surface a place is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum GroundLayer {
    /// The ground, or the pool over it.
    Ground,
    /// The highest surface over the ground.
    Top,
    /// None: in the air, between floors, beside the map.
    #[default]
    Neither,
}

/// The water at a place.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WaterAt {
    /// Which surface it is on.
    pub layer: GroundLayer,
    /// Class of the surface.
    pub class: SurfaceClass,
    /// Film, texture included. Units: mm. 0 under a pool.
    pub film_mm: f64,
    /// Pore water / pore capacity. Units: none. Domain: [0, 1].
    pub saturation: f64,
    /// Depth of the pool over the ground of the cell. Units: m.
    pub puddle_m: f64,
}

/// The hollow that a place lies in, filled to the brim.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoolRoom {
    /// Height of its lowest cell. Units: m.
    pub bottom_m: f64,
    /// Level at which it overflows, for the last time if it does so more than once. Units: m.
    pub spill_m: f64,
}

impl Ground {
    /// Where the cells lie.
    #[must_use]
    pub fn frame(&self) -> &GridFrame {
        &self.frame
    }

    /// The basins of the ground.
    #[must_use]
    pub fn basins(&self) -> &Basins {
        self.basins.basins()
    }

    /// The water in the basins.
    #[must_use]
    pub fn basin_run(&self) -> &BasinRun {
        &self.basins
    }

    /// The properties of a class.
    #[must_use]
    pub fn properties(&self, class: SurfaceClass) -> &SurfaceProperties {
        &self.properties[class.index()]
    }

    /// Area of the cells that have a ground. Units: m².
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        self.ground_cells as f64 * self.frame.cell_m() * self.frame.cell_m()
    }

    /// The cell that holds (x, z); none beside the map.
    #[must_use]
    pub fn cell_at(&self, x_m: f64, z_m: f64) -> Option<usize> {
        self.basins.basins().cell_at(x_m, z_m)
    }

    /// Height of the ground at (x, z); none beside the map and over holes. Units: m.
    #[must_use]
    pub fn height_at(&self, x_m: f64, z_m: f64) -> Option<f64> {
        let height = f64::from(self.heights_f32[self.cell_at(x_m, z_m)?]);
        height.is_finite().then_some(self.base_m + height)
    }

    /// The water at a place. Not finite or beside the map: on neither layer, no water.
    ///
    /// A place is on the surface that is nearest in height, if that is within 0.5 m; in a pool it is on the ground.
    #[must_use]
    pub fn water_at(&self, place: DVec3) -> WaterAt {
        self.water_under(place, |leaf| self.levels[leaf as usize])
    }

    /// [`Ground::water_at`] with every basin filled by hand, as in [`Ground::levels_filled`]. Films and pores are as they
    /// are.
    #[must_use]
    pub fn water_at_filled(&self, place: DVec3, share: f64) -> WaterAt {
        self.water_under(place, |leaf| self.level_filled(leaf, share))
    }

    /// The water at a place under these levels of the basins without children.
    fn water_under(&self, place: DVec3, level: impl Fn(u32) -> f64) -> WaterAt {
        let Some(cell) = self
            .cell_at(place.x, place.z)
            .filter(|&cell| !self.heights[cell].is_nan())
        else {
            return WaterAt::default();
        };
        let ground = self.heights[cell];
        let leaf = self.basins.basins().wettable_leaf_at(cell);
        let puddle_m = leaf.map_or(0.0, |leaf| (level(leaf) - ground).max(0.0));
        // Distance to what is between the ground and the water's surface.
        let to_ground = if place.y > ground {
            (place.y - ground - puddle_m).max(0.0)
        } else {
            ground - place.y
        };
        let above = self.cover.find(cell);
        let to_top = above.map_or(f64::INFINITY, |at| (place.y - self.cover.top[at]).abs());
        if to_ground <= REACH_M && to_ground <= to_top {
            let class = class_of(self.class[cell]);
            return WaterAt {
                layer: GroundLayer::Ground,
                class,
                film_mm: if puddle_m > 0.0 { 0.0 } else { self.cells.film[cell] },
                saturation: self.saturation(class, self.cells.pores[cell]),
                puddle_m,
            };
        }
        match above {
            Some(at) if to_top <= REACH_M => WaterAt {
                layer: GroundLayer::Top,
                class: SurfaceClass::Roof,
                film_mm: self.cover.columns.film[at],
                saturation: self.saturation(SurfaceClass::Roof, self.cover.columns.pores[at]),
                puddle_m: 0.0,
            },
            _ => WaterAt::default(),
        }
    }

    /// Share of the rain that reaches a place on the ground, by the exposure of its cell; none where the place is not on
    /// the ground. Units: none.
    #[must_use]
    pub fn exposure_at(&self, place: DVec3) -> Option<f32> {
        let cell = self.cell_at(place.x, place.z)?;
        // A hole is never near.
        let near = (place.y - self.heights[cell]).abs() <= REACH_M;
        near.then(|| f32::from(self.exposure[cell]) / 255.0)
    }

    /// The hollow that would flood a place on the ground; none on slopes and roofs, beside the map, and where water
    /// cannot leave.
    #[must_use]
    pub fn pool_room_at(&self, place: DVec3) -> Option<PoolRoom> {
        let cell = self.cell_at(place.x, place.z)?;
        let basins = self.basins.basins();
        let basin = basins.basins()[basins.top(basins.wettable_leaf_at(cell)?) as usize];
        let spill_m = basin.spill_m?;
        // A hole is never near.
        let on_ground = (place.y - self.heights[cell]).abs() <= REACH_M;
        (on_ground && place.y < spill_m).then_some(PoolRoom {
            bottom_m: basin.bottom_m,
            spill_m,
        })
    }

    fn saturation(&self, class: SurfaceClass, pores_mm: f64) -> f64 {
        (pores_mm / self.properties[class.index()].pore_capacity_mm).clamp(0.0, 1.0)
    }

    /// Height that [`Ground::ground_heights`] and [`Ground::levels`] count from. Units: m.
    #[must_use]
    pub fn base_height_m(&self) -> f64 {
        self.base_m
    }

    /// Ground of each cell above the base height, row by row; NaN = hole. Units: m.
    #[must_use]
    pub fn ground_heights(&self) -> &[f32] {
        &self.heights_f32
    }

    /// Class of each cell's ground, as [`SurfaceClass::index`].
    #[must_use]
    pub fn classes(&self) -> &[u8] {
        &self.class
    }

    /// Counts changes of films and pores.
    #[must_use]
    pub fn film_version(&self) -> u64 {
        self.film_version
    }

    /// Counts changes of levels, by 0.1 mm and more.
    #[must_use]
    pub fn level_version(&self) -> u64 {
        self.level_version
    }

    /// Water on a cell's ground, for grids in single precision; dry beyond the last cell.
    /// Error: 6e-8 relative, by rounding.
    #[must_use]
    pub fn cell_water(&self, cell: usize) -> ColumnF32 {
        let of = |values: &[f64]| values.get(cell).map_or(0.0, |&v| v as f32);
        ColumnF32 {
            pores_mm: of(&self.cells.pores),
            film_mm: of(&self.cells.film),
            soil_s: of(&self.cells.tau),
        }
    }

    /// Film of each cell's ground, row by row: as many as `out` holds. Units: mm.
    pub fn films_into(&self, out: &mut [f32]) {
        for (out, &film) in out.iter_mut().zip(&self.cells.film) {
            *out = film as f32;
        }
    }

    /// Saturation of each cell's ground, row by row: as many as `out` holds. Units: none.
    pub fn saturations_into(&self, out: &mut [f32]) {
        for ((out, &pores), &class) in out.iter_mut().zip(&self.cells.pores).zip(&self.class) {
            *out = self.saturation(class_of(class), pores) as f32;
        }
    }

    /// Level of the pool over each cell above the base height, row by row, [`DRY_LEVEL`] where there is none. Units: m.
    ///
    /// A dry cell beside a pool has its level, too (of several the highest): so a picture that compares the level with
    /// the ground under each pixel finds the shoreline between cell centres. Does nothing if `out` is not as long as
    /// the grid.
    pub fn levels(&self, out: &mut [f32]) {
        self.levels_under(out, |leaf| self.levels[leaf as usize]);
    }

    /// [`Ground::levels`] with every basin filled by hand, whatever water it holds: from its bottom to this share of the
    /// height at which it overflows, or of 0.1 m where it cannot. Basins within a larger one share its level, so the
    /// lowest ground of each floods first. `share` is held in [0, 1]; what is not a number counts as 0.
    pub fn levels_filled(&self, share: f64, out: &mut [f32]) {
        self.levels_under(out, |leaf| self.level_filled(leaf, share));
    }

    fn level_filled(&self, leaf: u32, share: f64) -> f64 {
        let basins = self.basins.basins();
        let top = &basins.basins()[basins.top(leaf) as usize];
        let full = top.spill_m.unwrap_or(top.bottom_m + CLOSED_DEPTH_M);
        top.bottom_m + clamped(share, 0.0, 1.0) * (full - top.bottom_m)
    }

    fn levels_under(&self, out: &mut [f32], level: impl Fn(u32) -> f64) {
        if out.len() != self.heights.len() {
            return;
        }
        out.fill(DRY_LEVEL);
        let [nx, nz] = self.frame.cells();
        let over = |cell: usize| {
            let level = level(self.basins.basins().wettable_leaf_at(cell)?);
            (level > self.heights[cell]).then_some(level)
        };
        for &cell in &self.wettable {
            let cell = cell as usize;
            let Some(level) = over(cell) else { continue };
            let level = (level - self.base_m) as f32;
            let (x, z) = (cell % nx, cell / nx);
            for row in z.saturating_sub(1)..(z + 2).min(nz) {
                for column in x.saturating_sub(1)..(x + 2).min(nx) {
                    let at = row * nx + column;
                    // A neighbour that is wet writes its own.
                    if at == cell || over(at).is_none() {
                        out[at] = out[at].max(level);
                    }
                }
            }
        }
    }
}
