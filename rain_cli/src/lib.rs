//! What the `rain` program computes without an engine: the models as a calculator, puddles of a scene, streak
//! textures, benchmarks.
//!
//! Nothing here needs Bevy or a GPU; without the feature `scenarios` this package does not build them.

pub mod bake;
pub mod bench;
pub mod model;
pub mod peers;
pub mod print;
pub mod streaks;
pub mod wet_textures;
