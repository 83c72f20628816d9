//! Haze of rain for each marked camera: what drops that are not drawn take out and send, far showers, mist of splashes, and
//! the glow of lamps.
//!
//! It is seen only: no state depends on it. [`HazeSettings`] on a camera with `RainView` sets it up.

mod area_fog;
mod far_rain;
mod lamps;
mod mirror;
mod settings;
mod splash_mist;
mod view;

pub use area_fog::AreaFog;
pub(crate) use far_rain::FarRainShot;
pub use far_rain::FarRainViewFrame;
pub(crate) use mirror::haze_mirrors;
pub use rain_core::rainfall::FarRainSettings;
pub use settings::{ArtistFog, HazeSettings, HazeSky, MAX_HAZE_LIMIT_M, Mist, SplashMist};
pub(crate) use view::{BowShot, HazeShot, aim_haze};
pub use view::{HazeMask, HazePlugin, HazeViewFrame};
