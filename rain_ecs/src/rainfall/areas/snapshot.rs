//! Rain areas in a snapshot.

use bevy_ecs::prelude::*;
use rain_core::error::in_range;
use rain_core::rainfall::areas::{AreaSettings, MAX_AREAS};
use serde::{Deserialize, Serialize};

use super::components::{RainArea, RainOutside};
use super::state::RainAreas;
use crate::clock::RainClock;
use crate::entity_order::{in_order, order_key};
use crate::snapshot::{Apply, SnapshotError, SnapshotPart};

/// The areas in force. They are put on the entities that have areas, in order; what is left over loses its area, and new
/// ones are made for what is missing.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AreasPart {
    areas: Vec<AreaSettings>,
    outside: f64,
}

impl SnapshotPart for AreasPart {
    fn save(world: &World) -> Option<Self> {
        let (areas, outside) = world.get_resource::<RainAreas>()?.saved();
        Some(Self { areas, outside })
    }

    fn prepare(self, _: &World) -> Result<Apply, SnapshotError> {
        let refused = |what: String| SnapshotError::Refused {
            part: "rain_areas",
            what,
        };
        in_range("outside", self.outside, 0.0, 1.0, "0 to 1").map_err(|error| refused(error.to_string()))?;
        if self.areas.len() > MAX_AREAS {
            return Err(refused(format!("{} areas", self.areas.len())));
        }
        for area in &self.areas {
            area.check().map_err(|error| refused(error.to_string()))?;
        }
        Ok(Box::new(move |world| {
            let entities: Vec<Entity> = in_order::<RainArea>(world)
                .into_iter()
                .map(|(entity, _)| entity)
                .collect();
            for &entity in entities.iter().skip(self.areas.len()) {
                world.entity_mut(entity).remove::<RainArea>();
            }
            let mut known = Vec::with_capacity(self.areas.len());
            let mut there = entities.into_iter();
            for area in self.areas {
                let component = RainArea(area.clone());
                let entity = match there.next() {
                    Some(entity) => world.entity_mut(entity).insert(component).id(),
                    None => world.spawn(component).id(),
                };
                known.push((entity, area));
            }
            known.sort_unstable_by_key(|(entity, _)| order_key(*entity));
            world.insert_resource(RainOutside(self.outside));
            let now_s = world.get_resource::<RainClock>().map_or(0.0, RainClock::now_s);
            world.resource_mut::<RainAreas>().restore(known, self.outside, now_s);
        }))
    }
}
