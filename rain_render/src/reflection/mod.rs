//! Blurred copies of the mirrored view, for films that are no clean mirror.
//!
//! Inputs: the finest level of a layer of a [`REFLECTION_FORMAT`] texture. Output: all coarser ones, each a 4 × 4 tent filter of
//! the one above it, so that a lamp's highlight stays round.
//! Cost: a dispatch a level, 16 reads for each texel written: about 5 reads for each texel of the finest level.
//! Skipped by the host when no mirrored view was drawn.

mod prepare;

pub use prepare::{MAX_MIRRORS, REFLECTION_FORMAT, ReflectionMipsGpu, ReflectionMipsTarget, encode_reflection_mips};
