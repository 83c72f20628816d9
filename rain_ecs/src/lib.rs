//! Rain as components and systems of an ECS, with no renderer.
//!
//! [`RainEcsPlugin`] adds everything; each phenomenon is also a plugin of its own. State advances in the [`RainTick`]
//! schedule, which [`RainClockPlugin`] runs in fixed ticks of the virtual time, so any frame rate ends in the same
//! state, bit for bit ([`state_hash()`]).
//!
//! ```
//! use bevy_app::App;
//! use bevy_time::TimePlugin;
//! use rain_ecs::prelude::*;
//!
//! let mut app = App::new();
//! app.add_plugins((TimePlugin, RainEcsPlugin::default()));
//! app.world_mut().spawn(Weather::preset(WeatherPreset::HeavyRain));
//! app.update();
//! ```

pub mod clock;
pub mod cover;
mod entity_order;
pub mod error;
pub mod history;
pub mod lightning;
pub mod queries;
pub mod rainfall;
pub mod schedule;
pub mod seed;
pub mod snapshot;
pub mod sound;
pub mod splash;
pub mod spout;
pub mod state_hash;
pub mod surface;
pub mod weather;

use bevy_app::{App, Plugin};

pub use clock::{RainClock, RainClockPlugin};
pub use cover::{CoverField, CoverFieldPlugin};
pub use error::RainConfigError;
pub use history::{RainHistory, RainHistoryPlugin};
pub use lightning::LightningEventsPlugin;
pub use queries::RainQueries;
pub use rainfall::areas::{RainArea, RainAreas, RainAreasPlugin};
pub use rainfall::{RainfallField, RainfallFieldPlugin};
pub use schedule::{RainSystems, RainTick};
pub use seed::RainSeed;
pub use snapshot::RainSnapshot;
pub use sound::RainSoundPlugin;
pub use splash::FootSplashPlugin;
pub use spout::SpoutPlugin;
pub use state_hash::state_hash;
pub use surface::SurfaceGroundPlugin;
pub use weather::WeatherPlugin;

/// What an application usually names.
pub mod prelude {
    pub use crate::RainEcsPlugin;
    pub use crate::clock::{RainClock, RainClockPlugin};
    pub use crate::cover::{CoverField, CoverFieldPlugin};
    pub use crate::error::RainConfigError;
    pub use crate::history::{HistorySample, RainHistory, RainHistoryPlugin};
    pub use crate::lightning::{
        ActiveFlash, ActiveLightning, Lightning, LightningEventsPlugin, LightningFlash, RainListener, ThunderHeard,
    };
    pub use crate::queries::{RainQueries, SoundWetness, SurfaceSound};
    pub use crate::rainfall::areas::{RainArea, RainAreaRefused, RainAreas, RainAreasPlugin, RainOutside};
    pub use crate::rainfall::{RainfallField, RainfallFieldPlugin};
    pub use crate::schedule::{RainSystems, RainTick};
    pub use crate::seed::RainSeed;
    pub use crate::snapshot::{RainSnapshot, SnapshotAppExt, SnapshotError};
    pub use crate::sound::{RainSound, RainSoundPlugin};
    pub use crate::splash::{Foot, FootSplash, FootSplashPlugin, FootSplashSettings, FootStep, PaintedStep};
    pub use crate::spout::{Spout, SpoutForm, SpoutPlugin, SpoutWater};
    pub use crate::state_hash::{HashState, StateHashAppExt, StateHasher, state_hash};
    pub use crate::surface::{
        DynamicWetness, FilmPress, FilmPresses, SurfaceGround, SurfaceGroundPlugin, SurfaceMaterial, SurfaceScene,
        SurfaceSettings, surface_class_of_name,
    };
    pub use crate::weather::{
        ActiveWeather, ArtistControls, GustState, Gusts, LevelCurve, LevelKey, LevelTimeline, RainTypeTable,
        WaterByHand, Weather, WeatherIgnored, WeatherMode, WeatherPlugin, WeatherState, WeatherTimeline,
    };
    pub use rain_core::lightning::LightningSettings;
    pub use rain_core::rainfall::Distribution;
    pub use rain_core::rainfall::areas::{AreaFade, AreaKey, AreaMotion, AreaRain, AreaSettings, AreaShape};
    pub use rain_core::weather::{
        ArtistSettings, GustSettings, RainType, RainTypes, SurfaceClass, Timeline, WeatherConditions, WeatherPreset,
    };
}

/// Every plugin of this crate: the clock and all phenomena.
///
/// The application brings `bevy_time::TimePlugin` (part of Bevy's default and minimal plugins); without it time
/// stands still.
#[derive(Debug, Clone, Default)]
pub struct RainEcsPlugin {
    /// Tick length and fast-forward bound. Default: 1/32 s, 256 ticks.
    pub clock: RainClock,
}

impl Plugin for RainEcsPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins((
            RainClockPlugin {
                clock: self.clock.clone(),
            },
            WeatherPlugin,
            RainAreasPlugin,
            RainfallFieldPlugin,
            CoverFieldPlugin,
            SurfaceGroundPlugin,
            SpoutPlugin,
            FootSplashPlugin,
            LightningEventsPlugin,
            RainSoundPlugin,
        ));
    }
}
