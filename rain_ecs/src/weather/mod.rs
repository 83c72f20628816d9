//! The weather of a world: what the user sets, how it changes, what it does to open ground.
//!
//! | file | concept |
//! |---|---|
//! | `components.rs` | [`Weather`], [`WeatherTimeline`], [`WeatherMode`], [`ArtistControls`], [`WaterByHand`] |
//! | `gusts.rs` | [`Gusts`], which have the wind swing |
//! | `levels.rs` | [`LevelTimeline`], which plays levels set by hand |
//! | `state.rs` | [`WeatherState`], the output |
//! | `systems.rs` | choosing, checking and advancing in [`crate::RainTick`] |
//!
//! One weather counts: that of the entity with the lowest index (then generation). Others are left alone and
//! reported once by a [`WeatherIgnored`] message.

mod components;
mod gusts;
mod levels;
mod state;
mod systems;

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;

pub use components::{ArtistControls, RainTypeTable, WaterByHand, Weather, WeatherMode, WeatherTimeline};
pub use gusts::{GustState, Gusts};
pub use levels::{LevelCurve, LevelKey, LevelTimeline};
pub use state::WeatherState;
pub use systems::{ActiveWeather, WeatherIgnored};

use crate::schedule::{RainSystems, RainTick};
use crate::snapshot::{SnapshotAppExt, WeatherPart};
use crate::state_hash::{HashState, StateHashAppExt};

/// Adds the weather. Needs [`crate::RainClockPlugin`] to run.
#[derive(Debug, Clone, Copy, Default)]
pub struct WeatherPlugin;

impl Plugin for WeatherPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<ActiveWeather>()
            .init_resource::<GustState>()
            .add_message::<crate::RainConfigError>()
            .add_message::<WeatherIgnored>()
            .register_type::<Weather>()
            .register_type::<WeatherTimeline>()
            .register_type::<WeatherMode>()
            .register_type::<ArtistControls>()
            .register_type::<WaterByHand>()
            .register_type::<Gusts>()
            .register_type::<LevelTimeline>()
            .register_type::<RainTypeTable>()
            .register_type::<WeatherState>()
            .snapshot_part::<WeatherPart>("weather")
            .hash_with("weather", |world, hasher| {
                let active = world.get_resource::<ActiveWeather>().and_then(ActiveWeather::entity);
                if let Some(state) = active.and_then(|entity| world.get::<WeatherState>(entity)) {
                    state.hash_state(hasher);
                }
            })
            .add_systems(
                RainTick,
                (
                    (
                        systems::choose_weather,
                        systems::follow_rain_types,
                        levels::play_levels,
                        systems::check_weather,
                        gusts::follow_gusts.run_if(gusts::gusts_are_used),
                    )
                        .chain()
                        .in_set(RainSystems::Input),
                    systems::advance_weather.in_set(RainSystems::Weather),
                ),
            );
    }
}
