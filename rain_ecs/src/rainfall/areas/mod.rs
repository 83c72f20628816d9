//! Rain areas in the world: where it rains, and how much.
//!
//! | file | concept |
//! |---|---|
//! | `components.rs` | [`RainArea`] and [`RainOutside`], what users set |
//! | `state.rs` | [`RainAreas`], the areas in force and the rate at a place |
//! | `snapshot.rs` | their part of a snapshot |

mod components;
mod snapshot;
mod state;

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;

pub use components::{RainArea, RainAreaRefused, RainOutside};
pub use state::RainAreas;

use crate::schedule::{RainSystems, RainTick};
use crate::snapshot::SnapshotAppExt;

/// Lets [`RainArea`]s change where it rains. Without one nothing differs from a world without this plugin.
pub struct RainAreasPlugin;

impl Plugin for RainAreasPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<RainAreas>()
            .init_resource::<RainOutside>()
            .register_type::<RainArea>()
            .register_type::<RainOutside>()
            .add_message::<RainAreaRefused>()
            .snapshot_part::<snapshot::AreasPart>("rain_areas")
            .add_systems(RainTick, state::follow_areas.in_set(RainSystems::Areas));
    }
}
