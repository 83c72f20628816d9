//! Clock and seed in a snapshot.

use bevy_ecs::prelude::*;
use serde::{Deserialize, Serialize};

use super::{Apply, SnapshotError, SnapshotPart};
use crate::clock::{ClockState, RainClock};
use crate::seed::RainSeed;

/// The clock's own numbers; whether it is paused is the host's.
#[derive(Serialize, Deserialize)]
pub(crate) struct ClockPart(ClockState);

impl SnapshotPart for ClockPart {
    fn save(world: &World) -> Option<Self> {
        world.get_resource::<RainClock>().map(|clock| Self(clock.state()))
    }

    fn prepare(self, world: &World) -> Result<Apply, SnapshotError> {
        let clock = world
            .get_resource::<RainClock>()
            .ok_or(SnapshotError::NoPlugin { part: "clock" })?
            .with_state(&self.0)
            .ok_or_else(|| SnapshotError::Refused {
                part: "clock",
                what: "a tick, or a time that is not whole ticks".into(),
            })?;
        Ok(Box::new(move |world| world.insert_resource(clock)))
    }
}

#[derive(Serialize, Deserialize)]
pub(crate) struct SeedPart(u64);

impl SnapshotPart for SeedPart {
    fn save(world: &World) -> Option<Self> {
        world.get_resource::<RainSeed>().map(|seed| Self(seed.0))
    }

    fn prepare(self, _: &World) -> Result<Apply, SnapshotError> {
        Ok(Box::new(move |world| world.insert_resource(RainSeed(self.0))))
    }
}
