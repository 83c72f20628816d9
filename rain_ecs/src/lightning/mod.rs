//! Lightning of a storm: flashes as they happen, thunder as it arrives.
//!
//! | file | concept |
//! |---|---|
//! | `components.rs` | [`Lightning`], [`RainListener`] and the messages |
//! | `follow.rs` | [`ActiveLightning`]: which flashes are on, which thunder is on its way |
//!
//! Flashes are a pure function of the seed and the time: pause, rewind and snapshots need nothing kept. Which thunder a
//! listener has heard is no part of the simulated state.

mod components;
mod follow;

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;

pub use components::{Lightning, LightningFlash, RainListener, ThunderHeard};
pub use follow::{ActiveFlash, ActiveLightning};

use crate::schedule::{RainSystems, RainTick};

/// Lets weathers with [`Lightning`] flash. Nothing runs while there is none.
#[derive(Debug, Clone, Copy, Default)]
pub struct LightningEventsPlugin;

impl Plugin for LightningEventsPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<ActiveLightning>()
            .register_type::<Lightning>()
            .register_type::<RainListener>()
            .add_message::<LightningFlash>()
            .add_message::<ThunderHeard>()
            .add_systems(
                RainTick,
                follow::follow_lightning
                    .in_set(RainSystems::Lightning)
                    .run_if(follow::lightning_is_used),
            );
    }
}
