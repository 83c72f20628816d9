//! The occluders of a scene and the tiles drawn from them; what moves redraws only the tiles it touches.

use super::error::CoverError;
use super::height_tiles::{HeightTile, HeightTiles, TILE_CELLS, TileKey};
use super::projection::FallSlope;
use super::raster::{FixedTriangle, MAX_SPAN, Projected, UNITS_PER_M, project_triangle};
use crate::error::{ConfigError, in_range};
use glam::{DVec2, DVec3};
use std::collections::{BTreeMap, BTreeSet};

/// Farthest coordinate from the origin. Units: m.
pub(super) const MAX_COORDINATE_M: f64 = 1.0e7;
/// Farthest height from the reference plane. Units: m. The drift makes heights into places.
pub(super) const MAX_HEIGHT_M: f64 = 1.0e4;

/// Settings of a [`CoverScene`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoverSettings {
    /// Side of a cell in the projected plane. Units: m. Domain: [1/64, 8], a whole multiple of 2⁻¹⁵ m (cells are
    /// placed exactly). Default: 0.25.
    pub cell_m: f64,
    /// Height of the reference plane. Units: m. Domain: [−1e7, 1e7]. Default: 0.
    pub reference_height_m: f64,
    /// Most tiles (64 × 64 cells, 16 KiB each) that the map may hold. Default: 16384, 256 MiB: 4 km² at the default
    /// cell.
    pub max_tiles: usize,
}

impl Default for CoverSettings {
    fn default() -> Self {
        Self {
            cell_m: 0.25,
            reference_height_m: 0.0,
            max_tiles: 16_384,
        }
    }
}

/// The host's name for one occluder, e.g. the bits of an entity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct OccluderId(pub u64);

/// Triangles that were given but cover nothing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct SkippedTriangles {
    /// A coordinate was NaN or infinite.
    pub non_finite: usize,
    /// No area in space (two corners alike, or three on a line).
    pub degenerate: usize,
    /// Parallel to the rain: walls in calm air. Nothing is wrong with them.
    pub edge_on: usize,
}

#[derive(Debug, Clone)]
struct Occluder {
    /// As given: drawn again when the fall direction changes.
    triangles: Vec<[DVec3; 3]>,
    projected: Vec<FixedTriangle>,
    /// (tile, index into `projected`), sorted: a tile is redrawn from its own triangles alone.
    bins: Vec<(TileKey, u32)>,
    skipped: SkippedTriangles,
}

impl Occluder {
    fn new(
        id: OccluderId,
        triangles: Vec<[DVec3; 3]>,
        settings: &CoverSettings,
        drift: DVec2,
    ) -> Result<Self, CoverError> {
        let mut o = Self {
            triangles,
            projected: Vec::new(),
            bins: Vec::new(),
            skipped: SkippedTriangles::default(),
        };
        let tile_units = tile_units(settings);
        for corners in &o.triangles {
            for c in corners.iter().filter(|c| c.is_finite()) {
                in_range(
                    "triangle corner x",
                    c.x,
                    -MAX_COORDINATE_M,
                    MAX_COORDINATE_M,
                    "-1e7 to 1e7 m",
                )?;
                in_range(
                    "triangle corner z",
                    c.z,
                    -MAX_COORDINATE_M,
                    MAX_COORDINATE_M,
                    "-1e7 to 1e7 m",
                )?;
                let y = c.y - settings.reference_height_m;
                in_range(
                    "triangle corner y",
                    y,
                    -MAX_HEIGHT_M,
                    MAX_HEIGHT_M,
                    "within 1e4 m of the reference plane",
                )?;
            }
            let t = match project_triangle(corners, settings.reference_height_m, drift) {
                Projected::Triangle(t) => t,
                Projected::NonFinite => {
                    o.skipped.non_finite += 1;
                    continue;
                }
                Projected::Degenerate => {
                    o.skipped.degenerate += 1;
                    continue;
                }
                Projected::EdgeOn => {
                    o.skipped.edge_on += 1;
                    continue;
                }
                Projected::TooWide(extent_m) => {
                    let allowed_m = MAX_SPAN as f64 / UNITS_PER_M;
                    return Err(CoverError::TooWide {
                        occluder: id,
                        extent_m,
                        allowed_m,
                    });
                }
            };
            let [xs, zs] = t.tile_range(tile_units);
            let needed = ((xs[1] - xs[0] + 1) * (zs[1] - zs[0] + 1)) as usize;
            if needed > settings.max_tiles {
                return Err(CoverError::TooManyTiles {
                    needed,
                    allowed: settings.max_tiles,
                });
            }
            let index = o.projected.len() as u32;
            for x in xs[0]..=xs[1] {
                for z in zs[0]..=zs[1] {
                    // Coordinates are at most about 1e7 m and a tile at least 1 m: keys fit.
                    let key = TileKey {
                        x: x as i32,
                        z: z as i32,
                    };
                    if t.touches(key, tile_units) {
                        o.bins.push((key, index));
                    }
                }
            }
            o.projected.push(t);
        }
        o.bins.sort_unstable();
        Ok(o)
    }

    fn tiles(&self) -> impl Iterator<Item = TileKey> {
        self.bins.chunk_by(|a, b| a.0 == b.0).map(|bin| bin[0].0)
    }

    fn draw(&self, key: TileKey, cell_units: i64, heights: &mut [f32]) {
        let first = self.bins.partition_point(|(k, _)| *k < key);
        for (_, index) in self.bins[first..].iter().take_while(|(k, _)| *k == key) {
            self.projected[*index as usize].draw(key, cell_units, heights);
        }
    }
}

fn tile_units(settings: &CoverSettings) -> i64 {
    cell_units(settings) * TILE_CELLS as i64
}

fn cell_units(settings: &CoverSettings) -> i64 {
    (settings.cell_m * UNITS_PER_M) as i64
}

/// Everything that stops rain in a scene, and the height tiles drawn from it.
///
/// Changes are noted at once and drawn by [`Self::update`]; until then questions see the tiles as last drawn.
/// The result depends only on what is in the scene and how the rain falls, bit for bit, not on the order or history of
/// changes.
#[derive(Debug, Clone)]
pub struct CoverScene {
    settings: CoverSettings,
    slope: FallSlope,
    /// Drift that the occluders are projected with.
    drift: DVec2,
    /// Drift that the tiles were last drawn with.
    drawn_drift: DVec2,
    occluders: BTreeMap<OccluderId, Occluder>,
    users: BTreeMap<TileKey, BTreeSet<OccluderId>>,
    dirty: BTreeSet<TileKey>,
    tiles: HeightTiles,
}

impl CoverScene {
    /// An empty scene: open sky everywhere.
    ///
    /// # Errors
    /// When a setting is not finite or outside its domain.
    pub fn new(settings: CoverSettings, slope: FallSlope) -> Result<Self, CoverError> {
        const CELL: &str = "1/64 to 8 m, a whole multiple of 1/32768 m";
        in_range("cell_m", settings.cell_m, 1.0 / 64.0, 8.0, CELL)?;
        if (settings.cell_m * 32_768.0).fract() != 0.0 {
            return Err(ConfigError::OutOfRange {
                field: "cell_m",
                value: settings.cell_m,
                allowed: CELL,
            }
            .into());
        }
        let far = MAX_COORDINATE_M;
        in_range(
            "reference_height_m",
            settings.reference_height_m,
            -far,
            far,
            "-1e7 to 1e7 m",
        )?;
        in_range("max_tiles", settings.max_tiles as f64, 1.0, 1.0e6, "1 to 1e6")?;
        let drift = slope.snapped_drift();
        Ok(Self {
            settings,
            slope,
            drift,
            drawn_drift: drift,
            occluders: BTreeMap::new(),
            users: BTreeMap::new(),
            dirty: BTreeSet::new(),
            tiles: HeightTiles::default(),
        })
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &CoverSettings {
        &self.settings
    }

    /// How the rain falls, as set last.
    #[must_use]
    pub fn slope(&self) -> &FallSlope {
        &self.slope
    }

    /// Drift that the tiles were drawn with, the lattice direction nearest to the rain's. Units: m/m.
    #[must_use]
    pub fn drawn_drift(&self) -> DVec2 {
        self.drawn_drift
    }

    /// The tiles as last drawn.
    #[must_use]
    pub fn tiles(&self) -> &HeightTiles {
        &self.tiles
    }

    /// Triangles of the present occluders that cover nothing.
    #[must_use]
    pub fn skipped(&self) -> SkippedTriangles {
        self.occluders
            .values()
            .fold(SkippedTriangles::default(), |sum, o| SkippedTriangles {
                non_finite: sum.non_finite + o.skipped.non_finite,
                degenerate: sum.degenerate + o.skipped.degenerate,
                edge_on: sum.edge_on + o.skipped.edge_on,
            })
    }

    /// Puts triangles into the scene, in world coordinates, m. Both sides stop rain. Triangles that are not finite or
    /// have no area are skipped and counted ([`Self::skipped`]).
    ///
    /// # Errors
    /// When the id is in use, a corner lies more than 1e7 m from the origin or 1e4 m above or below the reference
    /// plane, a triangle is wider than 16384 m in the projected plane, or the map would need more tiles than allowed
    /// (a single triangle counts with its bounding rectangle).
    pub fn add(&mut self, id: OccluderId, triangles: &[[DVec3; 3]]) -> Result<(), CoverError> {
        if self.occluders.contains_key(&id) {
            return Err(CoverError::DuplicateOccluder { id });
        }
        let occluder = Occluder::new(id, triangles.to_vec(), &self.settings, self.drift)?;
        self.attach(id, &occluder);
        if let Err(error) = self.check_tiles() {
            self.detach(id, &occluder);
            return Err(error);
        }
        self.soil(&occluder);
        self.occluders.insert(id, occluder);
        Ok(())
    }

    /// Replaces an occluder's triangles, as when it moved. The same triangles again change nothing.
    ///
    /// # Errors
    /// When the id is not in use, and as in [`Self::add`].
    pub fn replace(&mut self, id: OccluderId, triangles: &[[DVec3; 3]]) -> Result<(), CoverError> {
        match self.occluders.get(&id) {
            None => return Err(CoverError::UnknownOccluder { id }),
            Some(old) if old.triangles == triangles => return Ok(()),
            Some(_) => (),
        }
        let new = Occluder::new(id, triangles.to_vec(), &self.settings, self.drift)?;
        let Some(old) = self.occluders.remove(&id) else {
            return Err(CoverError::UnknownOccluder { id });
        };
        self.detach(id, &old);
        self.attach(id, &new);
        let checked = self.check_tiles();
        if checked.is_err() {
            self.detach(id, &new);
            self.attach(id, &old);
            self.occluders.insert(id, old);
        } else {
            self.soil(&old);
            self.soil(&new);
            self.occluders.insert(id, new);
        }
        checked
    }

    /// Takes an occluder out of the scene.
    ///
    /// # Errors
    /// When the id is not in use.
    pub fn remove(&mut self, id: OccluderId) -> Result<(), CoverError> {
        let Some(old) = self.occluders.remove(&id) else {
            return Err(CoverError::UnknownOccluder { id });
        };
        self.detach(id, &old);
        self.soil(&old);
        Ok(())
    }

    /// Sets how the rain falls. Tiles are drawn anew only when the nearest lattice direction
    /// ([`FallSlope::snapped_drift`]) is another one.
    ///
    /// # Errors
    /// When the slanted scene would need more tiles than allowed, or a triangle becomes too wide.
    pub fn set_slope(&mut self, slope: FallSlope) -> Result<(), CoverError> {
        let drift = slope.snapped_drift();
        if drift != self.drift {
            let mut turned = BTreeMap::new();
            for (id, o) in &self.occluders {
                turned.insert(*id, Occluder::new(*id, o.triangles.clone(), &self.settings, drift)?);
            }
            let mut users: BTreeMap<TileKey, BTreeSet<OccluderId>> = BTreeMap::new();
            for (id, o) in &turned {
                o.tiles().for_each(|key| _ = users.entry(key).or_default().insert(*id));
            }
            if users.len() > self.settings.max_tiles {
                return Err(CoverError::TooManyTiles {
                    needed: users.len(),
                    allowed: self.settings.max_tiles,
                });
            }
            self.dirty.extend(self.users.keys());
            self.dirty.extend(users.keys());
            (self.occluders, self.users, self.drift) = (turned, users, drift);
        }
        self.slope = slope;
        Ok(())
    }

    /// Draws every tile that something changed in and returns how many those were (0 when nothing moved).
    pub fn update(&mut self) -> usize {
        let dirty = core::mem::take(&mut self.dirty);
        let cell = cell_units(&self.settings);
        for &key in &dirty {
            let old = self.tiles.take(key);
            if let Some(users) = self.users.get(&key) {
                let tile = HeightTile::drawn(old, |heights| {
                    for o in users.iter().filter_map(|id| self.occluders.get(id)) {
                        o.draw(key, cell, heights);
                    }
                });
                self.tiles.put(key, tile);
            }
        }
        if !dirty.is_empty() {
            self.tiles.find_highest();
        }
        self.drawn_drift = self.drift;
        dirty.len()
    }

    /// Fixed-point units of a cell's side.
    pub(super) fn cell_units(&self) -> i64 {
        cell_units(&self.settings)
    }

    fn attach(&mut self, id: OccluderId, occluder: &Occluder) {
        occluder
            .tiles()
            .for_each(|key| _ = self.users.entry(key).or_default().insert(id));
    }

    fn detach(&mut self, id: OccluderId, occluder: &Occluder) {
        for key in occluder.tiles() {
            if let Some(users) = self.users.get_mut(&key) {
                users.remove(&id);
                if users.is_empty() {
                    self.users.remove(&key);
                }
            }
        }
    }

    fn soil(&mut self, occluder: &Occluder) {
        self.dirty.extend(occluder.tiles());
    }

    fn check_tiles(&self) -> Result<(), CoverError> {
        let (needed, allowed) = (self.users.len(), self.settings.max_tiles);
        if needed > allowed {
            Err(CoverError::TooManyTiles { needed, allowed })
        } else {
            Ok(())
        }
    }
}
