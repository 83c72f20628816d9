//! Far rain: the part of a shower's curtain that is drawn as particles of many drops.
//!
//! Inputs: the particles of [`rain_core::rainfall::FarRain::fill`]; the view, an environment cube map. Output: premultiplied
//! particles over the view's colour target, tested against the scene's depth, and on demand what they obscure.
//! Cost: one draw, six vertices and 32 bytes a particle; pixels covered, each with two cosines. GPU memory: 32 bytes a particle.
//! Skipped by the host when no area is in view from outside.

mod encode;
mod params;
mod prepare;

pub use encode::{encode_far_rain, encode_far_rain_coverage};
pub use params::FarRainInput;
pub use prepare::{FarRainGpu, FarRainViewGpu};
