//! The scene that a ground is made of: triangles by owner, the domain, the grid.

use std::collections::BTreeMap;

use glam::DVec3;

use super::error::GroundError;
use super::layers::GroundLayers;
use crate::error::{ConfigError, in_range};
use crate::surface::basins::Drain;
use crate::surface::height_field::{GridFrame, ImportLimits, MAX_COORDINATE_M, usable};
use crate::weather::{SurfaceClass, SurfaceProperties};

/// Least upward part of a unit normal that makes a triangle ground: 78° from level.
pub(super) const LEAST_UP: f64 = 0.2;
/// Most cells that any ground may have.
const MOST_CELLS: usize = 1 << 24;

/// A rectangle of the horizontal plane. Units: m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundDomain {
    /// Lowest x and z.
    pub low_m: [f64; 2],
    /// Highest x and z.
    pub high_m: [f64; 2],
}

/// How a ground is made.
#[derive(Debug, Clone, PartialEq)]
pub struct GroundSettings {
    /// Where there is ground. Default: the bounds of the static triangles that face up.
    pub domain: Option<GroundDomain>,
    /// Side of a cell; doubled until the grid has at most `max_cells`. Units: m. Domain: [0.01, 100]. Default: 0.25,
    /// above which puddles as wide as a car lose their shape; wheel ruts aslant to the cells want 0.125 (see the module).
    pub cell_m: f64,
    /// Most cells. Domain: [1, 2²⁴]. Default: 2²⁰.
    pub max_cells: usize,
    /// Surfaces up to this far above the lowest one are the ground on it, not a roof over it: kerbs, road slabs on
    /// terrain. Units: m. Domain: [0, 10]. Default: 0.3.
    pub step_m: f64,
    /// Hollows shallower than this hold no puddle of their own. Units: m. Domain: [0, 10]. Default: 1e-3.
    pub puddle_threshold_m: f64,
    /// Steps over which the cells are spread: each is advanced once in so many. Domain: [1, 65536]. Default: 32, one
    /// second of the default tick.
    pub interval_steps: u32,
    /// How often the basins are advanced in an interval. Domain: [1, `interval_steps`]. Default: 8.
    pub basin_steps: u32,
    /// Inlets.
    pub drains: Vec<Drain>,
    /// Properties of each class, by [`SurfaceClass::index`].
    pub properties: [SurfaceProperties; SurfaceClass::COUNT],
}

impl Default for GroundSettings {
    fn default() -> Self {
        Self {
            domain: None,
            cell_m: 0.25,
            max_cells: 1 << 20,
            step_m: 0.3,
            puddle_threshold_m: 1e-3,
            interval_steps: 32,
            basin_steps: 8,
            drains: Vec::new(),
            properties: SurfaceClass::ALL.map(SurfaceClass::properties),
        }
    }
}

impl GroundSettings {
    /// Checks every number.
    ///
    /// # Errors
    /// Names the first field outside its domain.
    pub fn validated(&self) -> Result<(), ConfigError> {
        in_range("cell_m", self.cell_m, 0.01, 100.0, "0.01 to 100 m")?;
        in_range(
            "max_cells",
            self.max_cells as f64,
            1.0,
            MOST_CELLS as f64,
            "1 to 16777216",
        )?;
        in_range("step_m", self.step_m, 0.0, 10.0, "0 to 10 m")?;
        in_range("puddle_threshold_m", self.puddle_threshold_m, 0.0, 10.0, "0 to 10 m")?;
        in_range(
            "interval_steps",
            f64::from(self.interval_steps),
            1.0,
            65_536.0,
            "1 to 65536",
        )?;
        in_range(
            "basin_steps",
            f64::from(self.basin_steps),
            1.0,
            f64::from(self.interval_steps),
            "1 to interval_steps",
        )?;
        if let Some(GroundDomain { low_m, high_m }) = self.domain {
            const FAR: &str = "-1e7 to 1e7 m, low below high";
            for axis in [0, 1] {
                in_range("domain low_m", low_m[axis], -MAX_COORDINATE_M, MAX_COORDINATE_M, FAR)?;
                in_range("domain high_m", high_m[axis], low_m[axis], MAX_COORDINATE_M, FAR)?;
            }
        }
        for properties in self.properties {
            properties.validated()?;
        }
        Ok(())
    }

    /// The grid over a domain: with the cell doubled until it has at most `max_cells`.
    fn frame(&self, domain: &GroundDomain) -> Result<GridFrame, GroundError> {
        let limits = ImportLimits {
            cells: self.max_cells,
            ..ImportLimits::default()
        };
        let mut cell_m = self.cell_m;
        loop {
            let cells = [0, 1].map(|i| ((domain.high_m[i] - domain.low_m[i]) / cell_m).ceil().max(1.0));
            let fits = cells[0] * cells[1] <= self.max_cells as f64 && cells[0].max(cells[1]) <= 65_536.0;
            if fits || cell_m > 5e3 {
                return Ok(GridFrame::around(domain.low_m, domain.high_m, cell_m, &limits)?);
            }
            cell_m *= 2.0;
        }
    }
}

/// One owner's triangles.
#[derive(Debug, Clone, PartialEq)]
struct Owner {
    triangles: Vec<[DVec3; 3]>,
    class: SurfaceClass,
    fixed: bool,
}

/// Triangles by owner (e.g. the bits of an entity), each owner of one surface class.
///
/// Corners run counter-clockwise seen from above where a triangle faces up (+y). Triangles without area, not finite or
/// beyond 1e7 m are left out and counted when the layers are drawn. The result does not depend on the order in which
/// owners were put in.
#[derive(Debug, Clone, Default)]
pub struct GroundScene {
    owners: BTreeMap<u64, Owner>,
    version: u64,
}

impl GroundScene {
    /// Puts an owner's triangles in (world coordinates, m), or replaces them. What moves (`is_static` = false) is no
    /// ground and changes nothing. The same again changes nothing. Allocates a copy.
    pub fn set(&mut self, owner: u64, triangles: &[[DVec3; 3]], class: SurfaceClass, is_static: bool) {
        let was = self.owners.get(&owner);
        if was.is_some_and(|o| o.triangles == triangles && o.class == class && o.fixed == is_static) {
            return;
        }
        let was_fixed = was.is_some_and(|o| o.fixed);
        let kept = if is_static { triangles.to_vec() } else { Vec::new() };
        self.owners.insert(
            owner,
            Owner {
                triangles: kept,
                class,
                fixed: is_static,
            },
        );
        self.version += u64::from(was_fixed || is_static);
    }

    /// Takes an owner out; one that is not there changes nothing.
    pub fn remove(&mut self, owner: u64) {
        let was = self.owners.remove(&owner);
        self.version += u64::from(was.is_some_and(|o| o.fixed));
    }

    /// Whether an owner is in the scene.
    #[must_use]
    pub fn contains(&self, owner: u64) -> bool {
        self.owners.contains_key(&owner)
    }

    /// Number of owners.
    #[must_use]
    pub fn len(&self) -> usize {
        self.owners.len()
    }

    /// Whether there is nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.owners.is_empty()
    }

    /// Counts changes of what is static.
    #[must_use]
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Static triangles with their class, by rising owner.
    pub(super) fn triangles(&self) -> impl Iterator<Item = (&[DVec3; 3], SurfaceClass)> {
        let fixed = self.owners.values().filter(|o| o.fixed);
        fixed.flat_map(|o| o.triangles.iter().map(|t| (t, o.class)))
    }

    /// Horizontal bounds of the static triangles that face up; none without any.
    #[must_use]
    pub fn bounds(&self) -> Option<GroundDomain> {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for (corners, _) in self.triangles() {
            if usable(corners) && faces_up(corners) {
                for c in corners {
                    low = [low[0].min(c.x), low[1].min(c.z)];
                    high = [high[0].max(c.x), high[1].max(c.z)];
                }
            }
        }
        (low[0] <= high[0]).then_some(GroundDomain {
            low_m: low,
            high_m: high,
        })
    }

    /// Draws the layers.
    ///
    /// # Errors
    /// When a setting is outside its domain, the grid would be too large or nothing faces up inside the domain.
    pub fn layers(&self, settings: &GroundSettings) -> Result<GroundLayers, GroundError> {
        settings.validated()?;
        let domain = settings.domain.or_else(|| self.bounds()).ok_or(GroundError::NoGround)?;
        GroundLayers::draw(self, settings.frame(&domain)?, settings.step_m)
    }
}

/// Whether a triangle faces up by more than [`LEAST_UP`]; not without area.
pub(super) fn faces_up([a, b, c]: &[DVec3; 3]) -> bool {
    let normal = (*b - *a).cross(*c - *a);
    normal.y > LEAST_UP * normal.length()
}
