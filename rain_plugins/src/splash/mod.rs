//! Splashes of rain for each marked camera, on whatever the cover map says rain lands on, of steps in water, and water that
//! pours from eaves and pipes.
//!
//! They are seen only: no state depends on them, and the water of puddles does not move under them.

mod aim;
mod feet;
mod spouts;
mod view;

pub(crate) use view::SplashShot;
pub use view::{MAX_SPLASH_BUDGET, MAX_SPLASH_DISTANCE_M, SplashMask, SplashPlugin, SplashSettings, SplashViewFrame};
