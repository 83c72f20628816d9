//! What keeps the rain off: the scene's occluders and the map drawn from them.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_math::{DVec2, DVec3};
use rain_core::cover::{ClassShare, CoverError, CoverScene, CoverSettings, FallSlope, OccluderId, SkippedTriangles};
use rain_core::rainfall::{CLASS_COUNT, CLASS_SPEEDS_M_S, ClassWeights};
use serde::{Deserialize, Serialize};

use crate::rainfall::RainfallField;
use crate::schedule::{RainSystems, RainTick};
use crate::snapshot::{Apply, SnapshotAppExt, SnapshotError, SnapshotPart};
use crate::state_hash::{HashState, StateHashAppExt, StateHasher};

/// By how much the fall direction may turn before the map follows. Units: rad.
const TOLERANCE_RAD: f64 = core::f64::consts::PI / 180.0;
/// Slope of a calm day: flux mean of 1/v at 25 mm/h. Units: s/m.
const CALM_INVERSE_SPEED: f64 = 0.169;
/// Classes of drops that exposure is asked for: slow, middling, fast.
const SHARES: usize = 3;

/// The cover map of the world, on the CPU: no renderer is needed.
///
/// The host puts in the triangles of what stops rain, by owner (e.g. the bits of an entity), and replaces them when
/// something moves. The map follows the rain's fall direction (to 1°) in [`RainSystems::Cover`]. Tree crowns let rain
/// through and do not belong here.
#[derive(Resource, Debug, Clone)]
pub struct CoverField {
    scene: CoverScene,
    shares: [ClassShare; SHARES],
    version: u64,
}

impl CoverField {
    /// An empty map: open sky everywhere.
    ///
    /// # Errors
    /// When a setting is outside its domain.
    pub fn new(settings: CoverSettings) -> Result<Self, CoverError> {
        let slope = FallSlope::new(DVec2::ZERO, CALM_INVERSE_SPEED)?;
        let share = ClassShare {
            inverse_speed_s_per_m: CALM_INVERSE_SPEED,
            share: 1.0,
        };
        Ok(Self {
            scene: CoverScene::new(settings, slope)?,
            shares: [share; SHARES],
            version: 0,
        })
    }

    /// Puts in or replaces the triangles of an owner (world coordinates, m). What is not `opaque` to rain is taken
    /// out. Drawn by the next tick. The same again changes nothing.
    ///
    /// # Errors
    /// When a corner lies too far away, a triangle is too wide, or the map would need more tiles than allowed. Then the
    /// map stays as it was.
    pub fn set(&mut self, owner: u64, triangles: &[[DVec3; 3]], opaque: bool) -> Result<(), CoverError> {
        let id = OccluderId(owner);
        if !opaque {
            self.remove(owner);
            return Ok(());
        }
        match self.scene.replace(id, triangles) {
            Err(CoverError::UnknownOccluder { .. }) => self.scene.add(id, triangles),
            done => done,
        }
    }

    /// Takes an owner out; whether it was there.
    pub fn remove(&mut self, owner: u64) -> bool {
        self.scene.remove(OccluderId(owner)).is_ok()
    }

    /// The map.
    #[must_use]
    pub fn scene(&self) -> &CoverScene {
        &self.scene
    }

    /// Triangles that cover nothing.
    #[must_use]
    pub fn skipped(&self) -> SkippedTriangles {
        self.scene.skipped()
    }

    /// Drops that exposure is asked for, and their shares of the rain.
    #[must_use]
    pub fn shares(&self) -> &[ClassShare] {
        &self.shares
    }

    /// Counts redraws of the map and turns of the rain.
    #[must_use]
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Share of the rain that reaches a point on a surface: 1 = open sky. Units: none. A point that is not finite or
    /// beyond 1e7 m is under open sky.
    #[must_use]
    pub fn exposed_at(&self, point: DVec3) -> f32 {
        let tiles = self.scene.tiles();
        let highest = f64::from(tiles.highest()) + self.scene.settings().reference_height_m;
        if tiles.is_empty() || point.y >= highest {
            return 1.0;
        }
        let mean = self.scene.slope().mean_inverse_speed_s_per_m();
        self.scene.exposure(point, mean).unwrap_or(1.0)
    }

    /// Takes over how it rains and draws what changed.
    fn tick(&mut self, field: &RainfallField) {
        if field.is_raining() {
            let wind = field.mean_wind_m_s();
            let wind = DVec2::new(wind.x, wind.z);
            // Both in the domain of the weather; only together they may be too slanted: then the last slope stays.
            if let Ok(slope) = FallSlope::new(wind, field.mean_inverse_velocity_s_m())
                && slope.angle_to(self.scene.slope()) > TOLERANCE_RAD
                && self.scene.set_slope(slope).is_ok()
            {
                self.shares = shares(field);
                self.version += 1;
            }
        }
        self.version += u64::from(self.scene.update() > 0);
    }
}

impl Default for CoverField {
    fn default() -> Self {
        // The defaults are valid.
        Self::new(CoverSettings::default()).unwrap_or_else(|error| unreachable!("{error}"))
    }
}

/// The drop field's classes in three groups, each with its flux and its mean of 1/v.
fn shares(field: &RainfallField) -> [ClassShare; SHARES] {
    let rates = ClassWeights::new(field.spectrum()).rain_rate_mm_h;
    core::array::from_fn(|group| {
        let of = CLASS_COUNT / SHARES;
        let (mut flux, mut inverse) = (0.0, 0.0);
        for class in group * of..(group + 1) * of {
            flux += rates[class];
            inverse += rates[class] / CLASS_SPEEDS_M_S[class];
        }
        if flux > 0.0 {
            ClassShare {
                inverse_speed_s_per_m: (inverse / flux).clamp(0.01, 10.0),
                share: flux,
            }
        } else {
            ClassShare {
                inverse_speed_s_per_m: CALM_INVERSE_SPEED,
                share: 1e-6,
            }
        }
    })
}

impl HashState for CoverField {
    fn hash_state(&self, hasher: &mut StateHasher) {
        for value in CoverPart::of(self).numbers() {
            hasher.f64(value);
        }
    }
}

/// How the map's rain falls; the occluders are the host's.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CoverPart {
    wind_m_s: [f64; 2],
    mean_inverse_speed_s_per_m: f64,
    shares: [[f64; 2]; SHARES],
}

impl CoverPart {
    fn of(field: &CoverField) -> Self {
        let slope = field.scene.slope();
        Self {
            wind_m_s: slope.wind_m_s().to_array(),
            mean_inverse_speed_s_per_m: slope.mean_inverse_speed_s_per_m(),
            shares: field.shares.map(|c| [c.inverse_speed_s_per_m, c.share]),
        }
    }

    fn numbers(&self) -> impl Iterator<Item = f64> {
        let shares = self.shares.into_iter().flatten();
        self.wind_m_s
            .into_iter()
            .chain([self.mean_inverse_speed_s_per_m])
            .chain(shares)
    }
}

impl SnapshotPart for CoverPart {
    fn save(world: &World) -> Option<Self> {
        world.get_resource::<CoverField>().map(Self::of)
    }

    fn prepare(self, world: &World) -> Result<Apply, SnapshotError> {
        let damaged = |what: String| SnapshotError::Refused { part: "cover", what };
        let mut field = world
            .get_resource::<CoverField>()
            .ok_or(SnapshotError::NoPlugin { part: "cover" })?
            .clone();
        let slope = FallSlope::new(DVec2::from(self.wind_m_s), self.mean_inverse_speed_s_per_m)
            .map_err(|error| damaged(error.to_string()))?;
        for ([inverse, share], class) in self.shares.into_iter().zip(&mut field.shares) {
            if !((0.01..=10.0).contains(&inverse) && share > 0.0 && share.is_finite()) {
                return Err(damaged("a share of the rain".into()));
            }
            (class.inverse_speed_s_per_m, class.share) = (inverse, share);
        }
        field
            .scene
            .set_slope(slope)
            .map_err(|error| damaged(error.to_string()))?;
        field.scene.update();
        field.version += 1;
        Ok(Box::new(move |world| world.insert_resource(field)))
    }
}

/// Adds the [`CoverField`], empty.
pub struct CoverFieldPlugin;

impl Plugin for CoverFieldPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<CoverField>()
            .hash_resource::<CoverField>("cover")
            .snapshot_part::<CoverPart>("cover")
            .add_systems(RainTick, follow_rain.in_set(RainSystems::Cover));
    }
}

fn follow_rain(field: Option<Res<RainfallField>>, mut cover: ResMut<CoverField>) {
    if let Some(field) = field {
        cover.bypass_change_detection().tick(&field);
    }
}
