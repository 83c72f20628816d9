//! Water that moves: rings under rain, and waves that wheels, feet and other things make in puddles near the view.
//!
//! Rings are a small tile of water that repeats over the world, into which the drops of the present rain fall
//! ([`RippleTile`]). Waves are a tile of real puddles, with their shores, that follows the view ([`WaveTile`]): they run
//! while something disturbs them and sleep when calm, out of sight or dry. Both are seen only: no state depends on them.
//!
//! | file | concept |
//! |---|---|
//! | `disturb.rs` | [`WaterDisturber`]: what moves the water |
//! | `rings.rs` | the tile of rings |
//! | `tile.rs` | the tile of puddles |

mod disturb;
mod rings;
mod tile;

use bevy::prelude::*;
use rain_ecs::splash::{FootSplash, FootSystems};
use rain_render::waves::{RippleSettings, RippleTile, WaveFrame, WaveTile, WaveTileSettings};

pub use disturb::WaterDisturber;
pub use rings::RainRings;
pub use tile::PuddleWaves;

use crate::render_adapter::RenderApp;
use crate::schedule::RainViewSystems;
use crate::surface::WaterLevels;

/// Settings of rings and waves. Changes take effect when the app starts.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct WaveWaterSettings {
    /// The tile of puddles.
    pub waves: WaveTileSettings,
    /// The tile of rings.
    pub rings: RippleSettings,
    /// No interactive waves: wheels and feet leave puddles still.
    pub no_waves: bool,
    /// No rings under rain.
    pub no_rings: bool,
}

/// A frame's work for the GPU, taken by the render world.
#[derive(Debug, Default)]
pub(crate) struct Handover {
    pub frame: WaveFrame,
    pub wanted: bool,
}

/// Rings and waves on water. Needs the wet surfaces that show them.
pub struct WavesPlugin;

impl Plugin for WavesPlugin {
    fn build(&self, app: &mut App) {
        if app.get_sub_app(RenderApp).is_none() {
            return; // nobody sees them on a server
        }
        app.register_type::<WaterDisturber>()
            .add_message::<FootSplash>()
            .init_resource::<WaveWaterSettings>()
            .add_systems(Startup, create_tiles)
            .add_systems(
                PostUpdate,
                (
                    rings::rain_on_water.run_if(resource_exists::<RainRings>),
                    tile::move_water
                        .after(FootSystems)
                        .run_if(resource_exists::<PuddleWaves>.and_then(resource_exists::<WaterLevels>)),
                )
                    .in_set(RainViewSystems::Views),
            );
    }
}

fn create_tiles(mut commands: Commands, settings: Res<WaveWaterSettings>) {
    if !settings.no_rings {
        match RippleTile::new(&settings.rings) {
            Ok(tile) => commands.insert_resource(RainRings::new(tile)),
            Err(error) => error!("no rings on water: {error}"),
        }
    }
    if !settings.no_waves {
        match WaveTile::new(&settings.waves) {
            Ok(tile) => commands.insert_resource(PuddleWaves::new(tile)),
            Err(error) => error!("no waves on water: {error}"),
        }
    }
}
