//! Streak textures: all streaks of one size class in a cube of air, as a picture that is made once.
//!
//! A layer is the picture of one rain rate and one class of diameters: the drops of a cube of `tile_m` seen square on,
//! each a streak as long as the class falls while the shutter is open. It depends on no scene, camera or light, wraps
//! around in both directions, and its mean opacity is 1 − e^(−σ · tile) of its class, in every mip level. Source:
//! Yoshida, Dobashi & Yamamoto (digest B), with its counts, opacities and edges corrected.
//!
//! [`StreakTextures::bake`] is the reference on the CPU; `rain_render` makes the same on a GPU from the same
//! [`TileDrop`]s. [`PackedStreaks`] is what is uploaded and kept on disk (KTX2).
//!
//! # Accuracy
//! Orthographic: no parallax inside the cube. All drops of a class have the class's speed, so their streaks are equally
//! long. Where streaks overlap, light passes both, 1 − ∏(1 − α): the mean opacity of a layer is within 2e-3 of that of a
//! Poisson field. A layer has a whole number of drops; what the rate asks for beyond or below is carried by their
//! opacity ([`StreakLayer::share`]).

mod cache;
mod file;
mod half;
mod layer;
mod packed;
mod raster;
mod settings;

pub use cache::{CacheOutcome, CachedStreaks, StreakCache};
pub use file::StreakFileError;
pub use layer::{StreakLayer, TileDrop};
pub use packed::PackedStreaks;
pub use raster::{OVERLAP_STEPS, StreakTexture, StreakTextures};
pub use settings::{MAX_STREAK_LAYERS, STREAK_TEXTURE_VERSION, StreakTextureSettings};
