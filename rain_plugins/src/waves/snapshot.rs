//! The waves on puddles in a snapshot. They are seen only: a world without a renderer has none, and takes none.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use bevy::prelude::*;
use rain_ecs::snapshot::{Apply, SnapshotError, SnapshotPart};
use rain_render::waves::SavedWaves;
use serde::{Deserialize, Serialize};

use super::disturb::DisturberMotion;
use super::tile::PuddleWaves;
use crate::render_adapter::WaveLevels;

/// Name of the part.
pub(super) const PART: &str = "seen_waves";

/// A tile's water with the numbers of its cells in base64 of their little-endian bytes.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Water {
    cells: u32,
    corner: Option<[i64; 2]>,
    left_ns: u64,
    bound_m: [f64; 2],
    wet: String,
    depths: String,
    heights_m: [String; 2],
}

/// The tile, what it has taken in, and where disturbers were, in the order of their entities.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WavesPart {
    water: Water,
    now_ns: Option<u64>,
    eye: Option<[f32; 3]>,
    filled_ns: Option<u64>,
    motions: Vec<DisturberMotion>,
}

fn text<T: bytemuck::Pod>(values: &[T]) -> String {
    STANDARD.encode(bytemuck::cast_slice(values))
}

fn numbers<T: bytemuck::Pod>(text: &str) -> Result<Vec<T>, SnapshotError> {
    let bytes = STANDARD
        .decode(text)
        .map_err(|error| refused(format!("its base64: {error}")))?;
    if bytes.len() % size_of::<T>() != 0 {
        return Err(refused(format!("{} bytes are no whole numbers", bytes.len())));
    }
    Ok(bytemuck::pod_collect_to_vec(&bytes))
}

fn refused(what: String) -> SnapshotError {
    SnapshotError::Refused { part: PART, what }
}

/// The disturbers' motions in the order of their entities.
fn in_order(world: &World) -> Vec<(Entity, DisturberMotion)> {
    let mut found: Vec<_> = world
        .iter_entities()
        .filter_map(|entity| Some((entity.id(), *entity.get::<DisturberMotion>()?)))
        .collect();
    found.sort_unstable_by_key(|(entity, _)| (entity.index_u32(), entity.generation().to_bits()));
    found
}

impl SnapshotPart for WavesPart {
    fn save(world: &World) -> Option<Self> {
        let waves = world.get_resource::<PuddleWaves>()?;
        let tile = waves.tile();
        let levels = if tile.is_calm() {
            Some([Vec::new(), Vec::new()])
        } else {
            world.get_resource::<WaveLevels>().and_then(|levels| levels.read(world))
        };
        let saved = levels.and_then(|[now, before]| tile.save([&now, &before]).ok());
        let Some(saved) = saved else {
            warn!("the waves on puddles are not in the snapshot: their heights could not be read");
            return None;
        };
        let (now_ns, eye, filled_ns) = waves.followed();
        Some(Self {
            water: Water {
                cells: saved.cells,
                corner: saved.corner,
                left_ns: saved.left_ns,
                bound_m: saved.bound_m,
                wet: text(&saved.wet),
                depths: text(&saved.depths),
                heights_m: saved.heights_m.each_ref().map(|level| text(level)),
            },
            now_ns,
            eye: eye.map(Into::into),
            filled_ns,
            motions: in_order(world).into_iter().map(|(_, motion)| motion).collect(),
        })
    }

    fn prepare(self, world: &World) -> Result<Apply, SnapshotError> {
        let waves = world
            .get_resource::<PuddleWaves>()
            .ok_or(SnapshotError::NoPlugin { part: PART })?;
        let water = self.water;
        let [now, before] = &water.heights_m;
        let saved = SavedWaves {
            cells: water.cells,
            corner: water.corner,
            left_ns: water.left_ns,
            bound_m: water.bound_m,
            wet: numbers(&water.wet)?,
            depths: numbers(&water.depths)?,
            heights_m: [numbers(now)?, numbers(before)?],
        };
        let mut tile = waves.tile().clone();
        tile.restore(&saved).map_err(|error| refused(error.to_string()))?;
        let eye = self.eye.map(Vec3::from);
        let places = self.motions.iter().filter_map(|motion| motion.before).chain(eye);
        if let Some(place) = places.into_iter().find(|place| !place.is_finite()) {
            return Err(refused(format!("the place {place}")));
        }
        let (now_ns, filled_ns, motions) = (self.now_ns, self.filled_ns, self.motions);
        Ok(Box::new(move |world| {
            let disturbers = in_order(world);
            // Other disturbers than then have no way behind them yet.
            let same = disturbers.len() == motions.len();
            for (index, (entity, _)) in disturbers.into_iter().enumerate() {
                let motion = motions.get(index).filter(|_| same).copied().unwrap_or_default();
                world.entity_mut(entity).insert(motion);
            }
            world
                .resource_mut::<PuddleWaves>()
                .put_back(tile, now_ns, eye, filled_ns);
        }))
    }

    fn absent(world: &mut World) {
        if let Some(mut waves) = world.get_resource_mut::<PuddleWaves>() {
            waves.still();
        }
    }
}
