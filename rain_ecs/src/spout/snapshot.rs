//! The roofs' water in a snapshot.

use bevy_ecs::prelude::*;
use rain_core::weather::{SurfaceClass, SurfaceColumn};
use serde::{Deserialize, Serialize};

use super::components::{Spout, SpoutWater};
use crate::entity_order::in_order;
use crate::snapshot::{Apply, SnapshotError, SnapshotPart};
use crate::surface::SurfaceMaterial;
use crate::weather::ActiveWeather;

/// The water of every roof in the order of their entities: a world with as many spouts, spawned in the same order, takes
/// it.
#[derive(Serialize, Deserialize)]
pub(super) struct SpoutPart(Vec<SurfaceColumn>);

impl SnapshotPart for SpoutPart {
    fn save(world: &World) -> Option<Self> {
        let columns: Vec<_> = in_order::<SpoutWater>(world)
            .into_iter()
            .map(|(_, water)| water.column)
            .collect();
        (!columns.is_empty()).then_some(Self(columns))
    }

    fn prepare(self, world: &World) -> Result<Apply, SnapshotError> {
        let refused = |what: String| SnapshotError::Refused { part: "spouts", what };
        let entities: Vec<_> = in_order::<SpoutWater>(world)
            .into_iter()
            .map(|(entity, _)| entity)
            .collect();
        if entities.len() != self.0.len() {
            let (found, here) = (self.0.len(), entities.len());
            return Err(refused(format!("it has {found} spouts, this world {here}")));
        }
        let weather = ActiveWeather::state(world).cloned().unwrap_or_default();
        for (&entity, column) in entities.iter().zip(&self.0) {
            let class = world.get::<SurfaceMaterial>(entity).map_or(SurfaceClass::Roof, |m| m.0);
            SurfaceColumn::restore(column.ledger(), weather.surfaces().properties(class))
                .map_err(|error| refused(error.to_string()))?;
        }
        Ok(Box::new(move |world| {
            for (entity, column) in entities.into_iter().zip(self.0) {
                let spout = world.get::<Spout>(entity).and_then(|spout| spout.validated().ok());
                if let Some(mut water) = world.get_mut::<SpoutWater>(entity) {
                    water.column = column;
                    water.flow_m3_s = 0.0;
                    water.spout = water.spout.or(spout);
                }
            }
        }))
    }
}
