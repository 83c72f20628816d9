//! Splashes of rain for each marked camera, on whatever the cover map says rain lands on, and of steps in water.
//!
//! They are seen only: no state depends on them, and the water of puddles does not move under them.

mod feet;
mod view;

pub(crate) use view::SplashShot;
pub use view::{MAX_SPLASH_BUDGET, MAX_SPLASH_DISTANCE_M, SplashMask, SplashPlugin, SplashSettings, SplashViewFrame};
