//! Procedural rings of rain: four layers of a texture of circles, without a simulation.
//!
//! [`RingLayerTile`] is the host's side: the layers of [`rain_core::waves::RingLayers`], the rain, and a clock. A
//! [`RingLayerFrame`] carries a moment over, and [`RingLayerGpu`] draws it.
//!
//! Inputs: the circle texture, uploaded once, and 128 bytes a frame. Output: a slope map (see [`crate::slope_mips`])
//! that repeats, with mips; its variance starts with that of the rings which are not drawn. Any moment can be drawn from
//! any other: nothing is stepped.
//! Cost: up to four reads, hashes and sines a texel, no more in heavy rain than in light. GPU memory: 8 bytes a texel of
//! the circle texture and the map's 10⅔.
//! Skipped by the host when nothing would change: no rain and a flat map, or no time has passed
//! ([`RingLayerTile::wants_pass`]).

mod encode;
mod params;
mod prepare;
mod tile;

pub use params::RingLayerFrame;
pub use prepare::{RingLayerGpu, RingLayersGpu};
pub use tile::RingLayerTile;
