//! Mips of slope maps: far water keeps the roughness that its ripples had nearby.
//!
//! A slope map is an [`SLOPE_FORMAT`] texture, one for every pass that makes ripples or waves: r and g the slope of the
//! surface along world x and z (∂h/∂x, ∂h/∂z), b the variance of the slope lost to filtering (⟨s²⟩ − ⟨s⟩², the sum of
//! both axes; in the finest level that of waves too short for its texels), a the height above the level in mm. All four filter linearly.
//!
//! Inputs: the finest level. Output: all others, each texel from the four below it: slopes and heights are averaged,
//! and the variance gains what the average hides, so ⟨s⟩² + b is the same in every level.
//! Cost: a dispatch for each four levels, 1⅓ reads and ⅓ writes a texel. Skipped by the host when the finest level has
//! not changed.

mod encode;
mod params;
mod prepare;

pub use encode::encode_slope_mips;
pub use params::{SLOPE_FORMAT, slope_levels, slope_texture};
pub use prepare::{SlopeMipsGpu, SlopeMipsTarget};
