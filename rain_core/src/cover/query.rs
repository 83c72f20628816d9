//! Questions to a [`CoverScene`]: is a point covered, and how exposed is it?

use super::error::CoverError;
use super::height_tiles::{TILE_CELLS, TileKey, TileReader};
use super::lookup::{self, OPEN_SKY};
use super::raster::{UNITS_PER_M, fixed_point};
use super::scene::{CoverScene, MAX_COORDINATE_M, MAX_HEIGHT_M};
use crate::error::in_range;
use glam::{DVec2, DVec3, Vec2};

/// How far over a surface an occluder must stand to count in [`CoverScene::exposure`]. Units: cells. The filter reads
/// up to √2 cells aside; less, and ground that slopes by one in one covers itself.
const SURFACE_CLEARANCE_CELLS: f32 = 1.6;
/// Most tiles searched along a drop's way for the highest occluder: 2 km at the default cell.
const MAX_TILES_ALONG: usize = 128;

/// A class of drops and its share of what falls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClassShare {
    /// 1/u of the class. Units: s/m. Domain: [0.01, 10].
    pub inverse_speed_s_per_m: f64,
    /// Its share of the flux, in any unit (only ratios count). Domain: ≥ 0.
    pub share: f64,
}

/// A point and a class of drops, made relative to the cell that the point projects into.
struct Probe<'a> {
    scene: &'a CoverScene,
    reader: TileReader<'a>,
    /// Origin: the cell of the projected point, counted from the world's.
    cell: [i64; 2],
    texel: f32,
    q: Vec2,
    y: f32,
    shift: Vec2,
}

impl Probe<'_> {
    fn height(&self, q: Vec2) -> f32 {
        let cell = (q / self.texel).floor();
        self.reader
            .height(self.cell[0] + cell.x as i64, self.cell[1] + cell.y as i64)
    }

    fn covered_at(&self, q: Vec2) -> bool {
        let highest = self.highest_along(q);
        highest > self.y && lookup::covered(q, self.y, self.shift, highest, |q| self.height(q))
    }

    /// Bound on the height at which a drop through `q` can have met anything, or its own height if nothing stands in
    /// its way: the tiles on its path from the highest occluder of the map down, each with the part of the path in it.
    /// (With one bound for the whole map, a tower would hide the low roofs from the three starts.)
    fn highest_along(&self, q: Vec2) -> f32 {
        let tiles = self.scene.tiles();
        let rise = tiles.highest() - self.y;
        if rise <= 0.0 {
            return self.y;
        }
        let side = TILE_CELLS as i64;
        let base = self.cell.map(|c| c.div_euclid(side));
        let inside = DVec2::new(
            self.cell[0].rem_euclid(side) as f64,
            self.cell[1].rem_euclid(side) as f64,
        );
        let start = (inside + (q / self.texel).as_dvec2()) / TILE_CELLS as f64;
        let way = -(self.shift * rise / self.texel).as_dvec2() / TILE_CELLS as f64;
        let mut at = start.floor();
        // Parts of the way at which the next tile along each axis is entered, and between two such.
        let next_edge = |a: f64, s: f64, w: f64| {
            if w > 0.0 {
                (a + 1.0 - s) / w
            } else if w < 0.0 {
                (a - s) / w
            } else {
                f64::INFINITY
            }
        };
        let mut enter = DVec2::new(next_edge(at.x, start.x, way.x), next_edge(at.y, start.y, way.y));
        let (between, step) = (way.abs().recip(), way.signum());
        let (mut from, mut highest) = (0.0_f64, self.y);
        for _ in 0..MAX_TILES_ALONG {
            let to = enter.min_element().min(1.0);
            let key = [base[0] + at.x as i64, base[1] + at.y as i64].map(|k| i32::try_from(k).ok());
            if let [Some(x), Some(z)] = key
                && let Some(tile) = tiles.get(TileKey { x, z })
                && tile.highest() > self.y + rise * from as f32
            {
                highest = highest.max(tile.highest().min(self.y + rise * to as f32));
            }
            if to >= 1.0 {
                break;
            }
            from = to;
            if enter.x <= enter.y {
                at.x += step.x;
                enter.x += between.x;
            } else {
                at.y += step.y;
                enter.y += between.y;
            }
        }
        highest
    }
}

impl CoverScene {
    fn probe(&self, point: DVec3, inverse_speed_s_per_m: f64) -> Result<Probe<'_>, CoverError> {
        for (field, value) in [("point.x", point.x), ("point.z", point.z)] {
            in_range(field, value, -MAX_COORDINATE_M, MAX_COORDINATE_M, "-1e7 to 1e7 m")?;
        }
        let y = point.y - self.settings().reference_height_m;
        in_range(
            "point.y",
            y,
            -MAX_HEIGHT_M,
            MAX_HEIGHT_M,
            "within 1e4 m of the reference plane",
        )?;
        let inverse = in_range(
            "inverse_speed_s_per_m",
            inverse_speed_s_per_m,
            0.01,
            10.0,
            "0.01 to 10 s/m",
        )?;
        let units = fixed_point(point, self.settings().reference_height_m, self.drawn_drift());
        let side = self.cell_units();
        let rest = units.map(|u| (u.rem_euclid(side) as f64 / UNITS_PER_M) as f32);
        // The wind may have turned a little since the map was drawn: the true drift minus the map's.
        let shift = self.slope().wind_m_s() * inverse - self.drawn_drift();
        Ok(Probe {
            scene: self,
            reader: self.tiles().reader(),
            cell: units.map(|u| u.div_euclid(side)),
            texel: self.settings().cell_m as f32,
            q: Vec2::from(rest),
            y: y as f32,
            shift: shift.as_vec2(),
        })
    }

    /// Height of the highest occluder on the mean drop's way to `point` or on from it. Units: m, world y;
    /// `None` under open sky.
    ///
    /// # Errors
    /// When the point is not finite or outside the map's domain.
    pub fn occluder_height(&self, point: DVec3) -> Result<Option<f64>, CoverError> {
        let probe = self.probe(point, self.slope().mean_inverse_speed_s_per_m())?;
        let height = probe.height(probe.q);
        Ok((height > OPEN_SKY).then(|| f64::from(height) + self.settings().reference_height_m))
    }

    /// Whether drops of fall speed u = 1/`inverse_speed_s_per_m` are stopped before they reach a point in the air.
    /// Outside the map: open sky. For a point on a surface ask [`Self::exposure`].
    ///
    /// Error: misclassified are up to 5 % of the points in the air of a scene, and 5 % more for each metre of cell, all
    /// classes counted alike, in wind to 20 m/s. None in the open and none half a metre away from the edges of one roof.
    ///
    /// # Errors
    /// When the point is not finite or outside the map's domain, or the inverse speed is outside [0.01, 10] s/m.
    pub fn covered(&self, point: DVec3, inverse_speed_s_per_m: f64) -> Result<bool, CoverError> {
        let probe = self.probe(point, inverse_speed_s_per_m)?;
        Ok(probe.covered_at(probe.q))
    }

    /// Share of the drops of one class that reach a point on a surface: 1 = open sky, 0 = covered, with a border one to
    /// two cells wide. What stands less than 1.6 cells over the point, measured along the drop's way, does not count:
    /// the surface itself.
    ///
    /// Error: 1 % on average about a roof, all of it along the rim.
    ///
    /// # Errors
    /// As in [`Self::covered`].
    pub fn exposure(&self, point: DVec3, inverse_speed_s_per_m: f64) -> Result<f32, CoverError> {
        let mut probe = self.probe(point, inverse_speed_s_per_m)?;
        let clearance = SURFACE_CLEARANCE_CELLS * probe.texel;
        probe.y += clearance;
        probe.q -= clearance * probe.shift;
        Ok(lookup::soft_exposure(probe.q, probe.texel, |q| probe.covered_at(q)))
    }

    /// Share of the whole rain that reaches a point on a surface: [`Self::exposure`] of each class, weighted by flux.
    ///
    /// # Errors
    /// When a share is negative or not finite or all are 0, and as in [`Self::covered`].
    pub fn flux_exposure(&self, point: DVec3, classes: &[ClassShare]) -> Result<f32, CoverError> {
        let (mut sum, mut open) = (0.0, 0.0);
        for class in classes {
            let share = in_range("share", class.share, 0.0, f64::MAX, "finite, not negative")?;
            sum += share;
            open += share * f64::from(self.exposure(point, class.inverse_speed_s_per_m)?);
        }
        in_range("sum of shares", sum, f64::MIN_POSITIVE, f64::MAX, "above 0")?;
        Ok((open / sum) as f32)
    }
}
