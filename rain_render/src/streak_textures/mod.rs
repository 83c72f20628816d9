//! Streak textures on the GPU: the twin of [`rain_core::rainfall::StreakTextures`].
//!
//! Inputs: the drops of every layer, made by `rain_core` and uploaded once. Output: an array of [`STREAK_FORMAT`]
//! textures with all mips, one layer for each rain rate and size class, which repeats in both directions; a texel is
//! opacity over the layer's unit.
//! Cost: one workgroup a drop, and 2⅔ invocations a texel of a layer; once. GPU memory: 2⅔ bytes a texel of a layer;
//! while it is made 12 bytes a texel of one layer more.
//! Skipped while the key of the settings is that of the textures ([`StreakArray::wants_pass`]): a host that has them on
//! disk uploads them instead ([`StreakArray::upload`]).

mod encode;
mod params;
mod prepare;

pub use encode::encode_streak_textures;
pub use params::STREAK_FORMAT;
pub use prepare::{StreakArray, StreakTextureGpu};
