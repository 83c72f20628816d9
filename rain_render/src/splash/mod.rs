//! Splashes: crowns and the drops that they throw, made from hashes around the view.
//!
//! Inputs: tables of the rain (`SplashField` of `rain_core`), the view, the cover map (height and normal of what rain
//! lands on), the map of standing water, an environment cube map, the nearest lamps, what is transparent, steps in water,
//! mouths of eaves and pipes that water pours from.
//! Output: premultiplied quads over the view's colour target, depth-tested, and on demand a coverage mask. Nothing is stored
//! or uploaded for a splash of rain; a step is 32 bytes, a mouth 80.
//! Cost: one invocation for a cell of 0.25 m and a slot of 0.1 s, a copy of each part into an order that does not change from
//! run to run; six vertices a part; pixels covered.
//! Skipped by the host when nothing falls or pours and nobody steps in water, the view is closed in or nothing is known of the
//! ground.

mod encode;
mod params;
mod prepare;

pub use encode::{encode_splash_behind, encode_splash_coverage, encode_splash_draw, encode_splash_make};
pub use params::{MAX_FEET, MAX_MOUTHS, SplashInput, SpoutStream, StepSplash};
pub use prepare::{SplashGpu, SplashTextures, SplashViewGpu};
