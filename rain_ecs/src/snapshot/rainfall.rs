//! The drop field in a snapshot.

use bevy_ecs::prelude::*;
use serde::{Deserialize, Serialize};

use super::{Apply, SnapshotError, SnapshotPart};
use crate::rainfall::RainfallField;

#[derive(Serialize, Deserialize)]
pub(crate) struct RainfallPart(RainfallField);

impl SnapshotPart for RainfallPart {
    fn save(world: &World) -> Option<Self> {
        world.get_resource::<RainfallField>().map(|field| Self(*field))
    }

    fn prepare(self, _: &World) -> Result<Apply, SnapshotError> {
        if !self.0.is_sound() {
            return Err(SnapshotError::Refused {
                part: "rainfall",
                what: "a number that is not finite or outside its domain".into(),
            });
        }
        Ok(Box::new(move |world| world.insert_resource(self.0)))
    }
}
