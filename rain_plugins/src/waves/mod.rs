//! Water that moves: rings under rain, and waves that wheels, feet and other things make in puddles near the view.
//!
//! Rings are a small tile of water that repeats over the world: simulated, with the drops of the present rain falling
//! into it ([`RippleTile`]), or procedural ([`RingSource::Layers`]). Waves are a tile of real puddles, with their shores,
//! that follows the view ([`WaveTile`]): they run while something disturbs them and sleep when calm, out of sight or dry.
//! Both are seen only: no state depends on them.
//!
//! | file | concept |
//! |---|---|
//! | `caustics.rs` | [`ThrownLight`]: sunlight that puddles throw onto walls |
//! | `disturb.rs` | [`WaterDisturber`]: what moves the water; [`WaterContact`]: the water that it stands in |
//! | `rings.rs` | the tile of rings, and where they come from |
//! | `snapshot.rs` | the waves in a snapshot |
//! | `tile.rs` | the tile of puddles |

mod caustics;
mod disturb;
mod rings;
mod snapshot;
mod tile;

use bevy::prelude::*;
use rain_ecs::snapshot::SnapshotAppExt;
use rain_ecs::splash::{FootSplash, FootSystems};
use rain_render::ring_layers::RingLayerFrame;
use rain_render::waves::{RippleSettings, RippleTile, WaveFrame, WaveTile, WaveTileSettings};

pub use caustics::ThrownLight;
pub use disturb::{WaterContact, WaterDisturber};
pub use rain_core::waves::{CircleSettings, RingGrowth, RingIntensity, RingLayerSettings};
pub use rings::{RainRings, RingSource};
pub use tile::PuddleWaves;

use crate::render_adapter::RenderApp;
use crate::schedule::RainViewSystems;
use crate::surface::WaterLevels;

/// Settings of rings and waves. Those of the tiles take effect when the tile is made: when the app starts, or when it is
/// first switched on; the switches and `ring_source`
/// at any time.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default)]
#[reflect(Resource, Default)]
pub struct WaveWaterSettings {
    /// The tile of puddles.
    #[reflect(ignore)]
    pub waves: WaveTileSettings,
    /// The tile of rings.
    #[reflect(ignore)]
    pub rings: RippleSettings,
    /// Where rings come from. What does not validate is named in the log, and the last good source stays.
    #[reflect(ignore)]
    pub ring_source: RingSource,
    /// No interactive water: wheels and feet leave puddles still, touch no water ([`WaterContact`]), and no step of the
    /// waves is worked out.
    pub no_waves: bool,
    /// No rings under rain.
    pub no_rings: bool,
}

/// A frame's work for the GPU, taken by the render world.
#[derive(Debug, Default)]
pub(crate) struct Handover {
    pub frame: WaveFrame,
    /// Procedural rings in place of the frame.
    pub layers: Option<RingLayerFrame>,
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
            .register_type::<WaterContact>()
            .register_type::<WaveWaterSettings>()
            .add_message::<FootSplash>()
            .init_resource::<WaveWaterSettings>()
            .init_resource::<ThrownLight>()
            .snapshot_part::<snapshot::WavesPart>(snapshot::PART)
            .add_systems(Startup, create_tiles)
            .add_systems(
                PostUpdate,
                (
                    create_tiles.run_if(resource_changed::<WaveWaterSettings>),
                    (rings::choose_rings, rings::rain_on_water)
                        .chain()
                        .run_if(resource_exists::<RainRings>),
                    caustics::throw_light.after(rings::rain_on_water),
                    tile::move_water
                        .after(FootSystems)
                        .run_if(resource_exists::<PuddleWaves>.and_then(resource_exists::<WaterLevels>)),
                )
                    .in_set(RainViewSystems::Views),
            );
    }
}

fn create_tiles(
    mut commands: Commands,
    settings: Res<WaveWaterSettings>,
    rings: Option<Res<RainRings>>,
    waves: Option<Res<PuddleWaves>>,
) {
    if !settings.no_rings && rings.is_none() {
        match RippleTile::new(&settings.rings) {
            Ok(tile) => commands.insert_resource(RainRings::new(tile)),
            Err(error) => error!("no rings on water: {error}"),
        }
    }
    if !settings.no_waves && waves.is_none() {
        match WaveTile::new(&settings.waves) {
            Ok(tile) => commands.insert_resource(PuddleWaves::new(tile)),
            Err(error) => error!("no waves on water: {error}"),
        }
    }
}
