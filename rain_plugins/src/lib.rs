//! Rain for Bevy: add [`RainPlugins`], spawn a [`Weather`](prelude::Weather), mark the camera with
//! [`RainView`](prelude::RainView), load any glTF, and it rains.
//!
//! ```no_run
//! use bevy::prelude::*;
//! use rain_plugins::prelude::*;
//!
//! fn main() {
//!     App::new()
//!         .add_plugins((DefaultPlugins, RainPlugins))
//!         .add_systems(Startup, |mut commands: Commands| {
//!             commands.spawn(Weather::preset(WeatherPreset::HeavyRain));
//!             commands.spawn((Camera3d::default(), RainView::default(), Transform::from_xyz(0.0, 1.7, 8.0)));
//!         })
//!         .run();
//! }
//! ```
//!
//! Each phenomenon is a small plugin that may be used alone or left out of the group
//! (`RainPlugins.build().disable::<WetSurfacePlugin>()`):
//!
//! | plugin | what it adds |
//! |---|---|
//! | `RainEcsPlugin` | clock, weather, drop field: the simulation, without a renderer |
//! | [`cloud_light::CloudLightPlugin`] | clouds of the rain that dim lights and skies that ask for it |
//! | [`cover::CoverPlugin`] | what stops rain |
//! | [`haze::HazePlugin`] | haze of rain, far showers, glow of lamps |
//! | [`rain_bloom::RainBloomPlugin`] | a wider bloom in rain, for cameras that ask for it |
//! | [`rainbow::RainbowPlugin`] | rainbows in the haze of cameras that ask for them |
//! | [`rainfall::RainfallPlugin`] | streaks near each marked camera, cards of many beyond |
//! | [`splash::SplashPlugin`] | splashes where the rain lands |
//! | [`lightning::LightningPlugin`] | flashes of storms that ask for them, and their light |
//! | [`lens::LensPlugin`] | drops on the glass of cameras that ask for it |
//! | [`surface::WetSurfacePlugin`] | wet materials, puddles, the mirrored view |
//! | [`waves::WavesPlugin`] | rings of rain and interactive waves on puddles |
//! | [`render_adapter::RainRenderPlugin`] | the passes |

pub mod cloud_light;
pub mod cover;
pub mod haze;
mod held;
pub mod lens;
pub mod lightning;
pub mod rain_bloom;
pub mod rainbow;
pub mod rainfall;
pub mod render_adapter;
pub mod report;
#[cfg(feature = "scenario")]
pub mod scenario;
pub mod schedule;
pub mod splash;
pub mod surface;
pub mod waves;

use bevy::app::PluginGroupBuilder;
use bevy::camera::CameraUpdateSystems;
use bevy::camera::visibility::VisibilitySystems;
use bevy::prelude::*;
use bevy::transform::TransformSystems;

use schedule::RainViewSystems;

/// Everything: weather, drop field, cover, near rain, wet surfaces.
pub struct RainPlugins;

impl PluginGroup for RainPlugins {
    fn build(self) -> PluginGroupBuilder {
        PluginGroupBuilder::start::<Self>()
            .add(rain_ecs::RainEcsPlugin::default())
            .add(RainSchedulePlugin)
            .add(render_adapter::RainRenderPlugin)
            .add(cover::CoverPlugin)
            .add(rainfall::RainfallPlugin)
            .add(haze::HazePlugin)
            .add(rainbow::RainbowPlugin)
            .add(cloud_light::CloudLightPlugin)
            .add(rain_bloom::RainBloomPlugin)
            .add(splash::SplashPlugin)
            .add(surface::WetSurfacePlugin)
            .add(waves::WavesPlugin)
            .add(lens::LensPlugin)
            .add(lightning::LightningPlugin)
    }
}

/// Orders the per-view systems of all other plugins.
pub struct RainSchedulePlugin;

impl Plugin for RainSchedulePlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<report::RainReport>().configure_sets(
            PostUpdate,
            (
                RainViewSystems::Cover
                    .after(TransformSystems::Propagate)
                    .after(VisibilitySystems::VisibilityPropagate)
                    .before(CameraUpdateSystems),
                RainViewSystems::Views
                    .after(RainViewSystems::Cover)
                    .after(CameraUpdateSystems),
                RainViewSystems::Surfaces
                    .after(RainViewSystems::Cover)
                    .after(TransformSystems::Propagate)
                    .before(CameraUpdateSystems),
            ),
        );
    }
}

/// What users type.
pub mod prelude {
    pub use crate::cloud_light::{CloudLight, CloudLightPlugin};
    pub use crate::cover::CoverSettings;
    pub use crate::haze::{
        AreaFog, ArtistFog, FarRainSettings, HazeMask, HazePlugin, HazeSettings, HazeSky, Mist, SplashMist,
    };
    pub use crate::lens::{LensDrops, LensGlass, WindscreenWipers};
    pub use crate::lightning::{LightningLight, LightningLook};
    pub use crate::rain_bloom::{RainBloom, RainBloomPlugin};
    pub use crate::rainbow::{Rainbow, RainbowPlugin};
    pub use crate::rainfall::{BudgetedTime, CardSettings, RainFrameBudget, RainShare, RainView, SeenThrough};
    pub use crate::render_adapter::RainRenderStatus;
    pub use crate::report::{PassName, RainReport, SkipReason};
    pub use crate::splash::{SplashMask, SplashSettings};
    pub use crate::surface::{
        AutoPaint, AutoPaintDone, AutoPaintError, FilmFlow, Gap, GroundMapSettings, KeepDry, MovesInRain, NoisePuddles,
        PaintSource, PlanarReflection, PuddlePaint, SceneGap, ShowPaint, SurfaceWetting, WaterAppearance,
        WaveNormalMaps, WetLook, WheelRuts,
    };
    pub use crate::waves::{RingLayerSettings, RingSource, WaterContact, WaterDisturber, WaveWaterSettings};
    pub use crate::{
        RainPlugins, cover::CoverPlugin, lens::LensPlugin, lightning::LightningPlugin, rainfall::RainfallPlugin,
        splash::SplashPlugin, surface::WetSurfacePlugin, waves::WavesPlugin,
    };
    pub use rain_core::lens::{WiperArm, WiperMode};
    pub use rain_core::surface::SurfaceState;
    pub use rain_ecs::prelude::*;
}
