//! Water that pours from roofs.
//!
//! | file | concept |
//! |---|---|
//! | `components.rs` | [`Spout`], [`SpoutForm`], [`SpoutWater`] |
//! | `pour.rs` | the roof's water, tick by tick, and what it brings to the ground |
//! | `snapshot.rs` | its part of a snapshot |

mod components;
mod pour;
mod snapshot;

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;

pub use components::{Spout, SpoutForm, SpoutWater};

use crate::schedule::{RainSystems, RainTick};
use crate::snapshot::SnapshotAppExt;
use crate::state_hash::StateHashAppExt;

/// Lets [`Spout`]s gather the rain of their roofs and pour it on the ground. Needs no renderer.
pub struct SpoutPlugin;

impl Plugin for SpoutPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<Spout>()
            .add_message::<crate::RainConfigError>()
            .hash_with("spouts", pour::hash_spouts)
            .snapshot_part::<snapshot::SpoutPart>("spouts")
            .add_systems(
                RainTick,
                (
                    pour::check_spouts.in_set(RainSystems::Input),
                    pour::pour.in_set(RainSystems::Spouts),
                ),
            );
    }
}
