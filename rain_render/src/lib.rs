//! Rain as wgpu passes, without Bevy and without an ECS.
//!
//! A host hands over plain inputs (camera matrices, the drop container of `rain_core`, a depth map along the rain)
//! and an encoder; this crate uploads, binds and records. Each pass is the same four things: what it is (`mod`),
//! its inputs (`params`), its GPU objects (`prepare`), its commands (`encode`).

mod bindings;
pub mod caustics;
pub mod compose;
pub mod cover;
pub mod far_rain;
pub mod glass;
pub mod gpu_types;
mod guard_band;
pub mod haze;
mod lamps;
pub mod lattice;
pub mod lens;
pub mod masks;
mod overlay;
pub mod params_space;
mod quad_indices;
pub mod rainfall;
pub mod reflection;
pub mod ring_layers;
pub mod slope_mips;
pub mod splash;
pub mod streak_textures;
pub mod water_map;
pub mod waves;
