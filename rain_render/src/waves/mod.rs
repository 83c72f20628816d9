//! Water that waves: a tile of puddles around the view, and a small tile of rain's rings that repeats over the world.
//!
//! Both are the explicit scheme of [`rain_core::waves::WaveField`] on the GPU: two levels of heights in single
//! precision on square cells, fixed sub-steps below its proved bound, walls at the shore by the depth of each cell.
//! [`WaveTile`] and [`RippleTile`] are the host's side, plain state without a GPU: where the tile stands, its depths,
//! clock and disturbances, and a bound on what still moves. A [`WaveFrame`] carries a frame's work over, and
//! [`WaveTileGpu`] does it for either.
//!
//! Each frame: [`WaveTile::follow`] (asks for the depth of cells that come in), [`WaveTile::advance`]; when
//! [`WaveTile::wants_pass`]: [`WaveTile::take`], [`WaveTileGpu::prepare`], [`WaveTileGpu::encode`].
//!
//! Output: a slope map (see [`crate::slope_mips`]) of as many texels as cells, with mips; it may repeat where it came
//! from a [`RippleTile`]. Between two steps heights are interpolated, so waves run smoothly at any frame rate, up to a
//! step late.
//! Cost: a step reads 16 bytes a cell and writes 4; sources cost their own cells; the map once a frame. GPU memory: 12
//! bytes a cell and the map's 10⅔.
//! Skipped by the host while calm: [`WaveTile::wants_pass`] is false when no water is disturbed and the last flat map
//! has been drawn.

mod calm;
mod encode;
mod frame;
mod params;
mod place;
mod prepare;
mod rings;
mod saved;
mod tile;

pub use calm::CalmBound;
pub use frame::WaveFrame;
pub use params::{Disturbance, MAX_DISTURBANCES, RippleSettings, WaveTileSettings, water_depth_m};
pub use prepare::{WaveTileGpu, WavesGpu};
pub use rings::RippleTile;
pub use saved::{SavedWaves, SavedWavesError};
pub use tile::WaveTile;
