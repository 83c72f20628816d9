//! The water map: films and pores of the ground around the view, finer than the simulation's ground.
//!
//! Square levels follow the view, each twice as coarse as the one before. Every texel holds what a cell of
//! [`rain_core::surface::ground::Ground`] does (pores, film, soil clock) and takes the same step in single precision
//! ([`rain_core::weather::ColumnF32`]), under the rain that the map of what covers now lets through: it sees the edge of
//! an awning, a truck that stands and leaves, a wheel's track. It is a view: it starts from the ground's cells and books
//! no water.
//!
//! [`WaterMap`] is the host's side, plain state without a GPU: where the levels lie, the weather that they have not seen,
//! presses of wheels and feet, and a bound on what a step would change. A [`WaterMapFrame`] carries a frame's work over
//! and [`WaterMapGpu`] does it.
//!
//! Each frame: [`WaterMap::set_ground`] when the ground has changed, [`WaterMap::follow`], [`WaterMap::advance`],
//! [`WaterMap::press`]; when [`WaterMap::rest`] is `None`: [`WaterMap::take`], [`WaterMapGpu::prepare`],
//! [`WaterMapGpu::encode`].
//!
//! Output: a texture of as many layers as levels, sampled with repeat (see `rain_water_map` in `lib/water_map.wgsl`):
//! share under a closed film, pore saturation, height over the ground's base, 1.
//! Cost: a step reads and writes 12 bytes a texel and writes 8; presses cost their own boxes. GPU memory: 20 bytes a
//! texel, 8 a ground cell.
//! Skipped: while all is dry; and while what has gathered since the last step would change no texel by
//! [`WaterMapSettings::seen_share`].

mod encode;
mod frame;
mod map;
mod params;
mod prepare;
mod press;

pub use frame::WaterMapFrame;
pub use map::{WaterMap, WaterMapPlace, WaterMapRest};
pub use params::{GroundCell, GroundPlace, MAX_LEVELS, WATER_MAP_FORMAT, WaterMapSettings};
pub use prepare::{WaterMapGpu, WaterMapInput, WaterMapPasses};
pub use press::{MAX_PRESSES, WaterPress};
