//! Haze of rain for each marked camera: what drops that are not drawn take out and send, far showers, and the glow of
//! lamps.
//!
//! It is seen only: no state depends on it. [`HazeSettings`] on a camera with `RainView` sets it up.

mod far_rain;
mod lamps;
mod settings;
mod view;

pub(crate) use far_rain::FarRainShot;
pub use far_rain::FarRainViewFrame;
pub use rain_core::rainfall::FarRainSettings;
pub use settings::{ArtistFog, HazeSettings, MAX_HAZE_LIMIT_M};
pub(crate) use view::HazeShot;
pub use view::{HazeMask, HazePlugin, HazeViewFrame};
