//! The occluders of a scene and the tiles drawn from them; what moves redraws only the tiles it touches.

use super::error::CoverError;
use super::height_tiles::{HeightTiles, TILE_CELLS, TileKey};
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

#[derive(Debug, Clone, Default)]
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
        triangles: &[[DVec3; 3]],
        settings: &CoverSettings,
        drift: DVec2,
    ) -> Result<Self, CoverError> {
        let mut occluder = Self::default();
        occluder.set(id, triangles, settings, drift)?;
        Ok(occluder)
    }

    /// Becomes another, in the room that there is. After an error it is of no use but for that.
    fn set(
        &mut self,
        id: OccluderId,
        triangles: &[[DVec3; 3]],
        settings: &CoverSettings,
        drift: DVec2,
    ) -> Result<(), CoverError> {
        self.triangles.clear();
        self.triangles.extend_from_slice(triangles);
        self.projected.clear();
        self.bins.clear();
        self.skipped = SkippedTriangles::default();
        let tile_units = tile_units(settings);
        for corners in triangles {
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
                    self.skipped.non_finite += 1;
                    continue;
                }
                Projected::Degenerate => {
                    self.skipped.degenerate += 1;
                    continue;
                }
                Projected::EdgeOn => {
                    self.skipped.edge_on += 1;
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
            let index = self.projected.len() as u32;
            for x in xs[0]..=xs[1] {
                for z in zs[0]..=zs[1] {
                    // Coordinates are at most about 1e7 m and a tile at least 1 m: keys fit.
                    let key = TileKey {
                        x: x as i32,
                        z: z as i32,
                    };
                    if t.touches(key, tile_units) {
                        self.bins.push((key, index));
                    }
                }
            }
            self.projected.push(t);
        }
        self.bins.sort_unstable();
        Ok(())
    }

    fn copy_from(&mut self, other: &Self) {
        self.triangles.clone_from(&other.triangles);
        self.projected.clone_from(&other.projected);
        self.bins.clone_from(&other.bins);
        self.skipped = other.skipped;
    }

    fn touches(&self, key: TileKey) -> bool {
        self.bins.binary_search_by_key(&key, |(k, _)| *k).is_ok()
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
///
/// [`Self::add`] allocates an occluder, [`Self::set_slope`] all of them anew when the lattice direction changes.
/// [`Self::replace`] and [`Self::update`] allocate only what grows: for an occluder with more triangles, or in more
/// tiles, than it or the largest before had, and where it comes into a tile (16 KiB if nothing was in it). Questions
/// allocate nothing.
#[derive(Debug, Clone)]
pub struct CoverScene {
    settings: CoverSettings,
    slope: FallSlope,
    /// Drift that the occluders are projected with.
    drift: DVec2,
    /// Drift that the tiles were last drawn with.
    drawn_drift: DVec2,
    occluders: BTreeMap<OccluderId, Occluder>,
    users: Users,
    dirty: DirtyTiles,
    tiles: HeightTiles,
    /// Room for the occluder that replaces another.
    spare: Occluder,
}

/// The occluders in each tile that has any.
type Users = BTreeMap<TileKey, BTreeSet<OccluderId>>;

fn attach(users: &mut Users, id: OccluderId, occluder: &Occluder) {
    for key in occluder.tiles() {
        users.entry(key).or_default().insert(id);
    }
}

fn check_tiles(users: &Users, settings: &CoverSettings) -> Result<(), CoverError> {
    let (needed, allowed) = (users.len(), settings.max_tiles);
    if needed > allowed {
        Err(CoverError::TooManyTiles { needed, allowed })
    } else {
        Ok(())
    }
}

/// Tiles to be drawn again.
#[derive(Debug, Clone, Default)]
struct DirtyTiles {
    /// Some more than once.
    keys: Vec<TileKey>,
    /// Of them at the beginning: sorted, and none twice.
    sorted: usize,
}

impl DirtyTiles {
    fn add(&mut self, occluder: &Occluder) {
        self.keys.extend(occluder.tiles());
        // Whoever changes much and never draws must not fill the memory.
        if self.keys.len() > 2 * self.sorted + 4096 {
            self.sort();
        }
    }

    fn sort(&mut self) {
        self.keys.sort_unstable();
        self.keys.dedup();
        self.sorted = self.keys.len();
    }

    fn clear(&mut self) {
        self.keys.clear();
        self.sorted = 0;
    }
}

/// Takes an occluder out of the tiles that `stays` does not touch.
fn detach(users: &mut Users, id: OccluderId, occluder: &Occluder, stays: &Occluder) {
    for key in occluder.tiles().filter(|key| !stays.touches(*key)) {
        if let Some(here) = users.get_mut(&key) {
            here.remove(&id);
            if here.is_empty() {
                users.remove(&key);
            }
        }
    }
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
            users: Users::new(),
            dirty: DirtyTiles::default(),
            tiles: HeightTiles::default(),
            spare: Occluder::default(),
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
        let occluder = Occluder::new(id, triangles, &self.settings, self.drift)?;
        attach(&mut self.users, id, &occluder);
        if let Err(error) = check_tiles(&self.users, &self.settings) {
            detach(&mut self.users, id, &occluder, &Occluder::default());
            return Err(error);
        }
        self.dirty.add(&occluder);
        self.occluders.insert(id, occluder);
        Ok(())
    }

    /// Replaces an occluder's triangles, as when it moved. The same triangles again change nothing.
    ///
    /// # Errors
    /// When the id is not in use, and as in [`Self::add`].
    pub fn replace(&mut self, id: OccluderId, triangles: &[[DVec3; 3]]) -> Result<(), CoverError> {
        let Some(held) = self.occluders.get_mut(&id) else {
            return Err(CoverError::UnknownOccluder { id });
        };
        if held.triangles == triangles {
            return Ok(());
        }
        let new = &mut self.spare;
        new.set(id, triangles, &self.settings, self.drift)?;
        attach(&mut self.users, id, new);
        detach(&mut self.users, id, held, new);
        let checked = check_tiles(&self.users, &self.settings);
        if checked.is_ok() {
            self.dirty.add(held);
            self.dirty.add(new);
            held.copy_from(new);
        } else {
            attach(&mut self.users, id, held);
            detach(&mut self.users, id, new, held);
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
        detach(&mut self.users, id, &old, &Occluder::default());
        self.dirty.add(&old);
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
                turned.insert(*id, Occluder::new(*id, &o.triangles, &self.settings, drift)?);
            }
            let mut users = Users::new();
            for (id, o) in &turned {
                attach(&mut users, *id, o);
            }
            check_tiles(&users, &self.settings)?;
            self.dirty.keys.extend(self.users.keys().chain(users.keys()));
            self.dirty.sort();
            (self.occluders, self.users, self.drift) = (turned, users, drift);
        }
        self.slope = slope;
        Ok(())
    }

    /// Draws every tile that something changed in and returns how many those were (0 when nothing moved).
    pub fn update(&mut self) -> usize {
        self.dirty.sort();
        let cell = cell_units(&self.settings);
        for &key in &self.dirty.keys {
            let Some(users) = self.users.get(&key) else {
                self.tiles.remove(key);
                continue;
            };
            self.tiles.redraw(key, |heights| {
                for o in users.iter().filter_map(|id| self.occluders.get(id)) {
                    o.draw(key, cell, heights);
                }
            });
        }
        let count = self.dirty.keys.len();
        self.dirty.clear();
        if count > 0 {
            self.tiles.find_highest();
        }
        self.drawn_drift = self.drift;
        count
    }

    /// Fixed-point units of a cell's side.
    pub(super) fn cell_units(&self) -> i64 {
        cell_units(&self.settings)
    }
}
