//! The scene through a glass in the rain: drops that show it upside down, mist, wiper blades.
//!
//! Inputs: the finished scene (HDR, before tonemapping) and the drops of a glass ([`LensInput`]). Output: the same size of
//! picture in another texture. Cost: a copy of the view at an eighth of its size (1/4 of a read each pixel), one read each
//! pixel where there is no mist and six where there is, then one read each pixel of a drop; 32 bytes a drop are uploaded.
//! Skipped by the host when the glass is dry.
//!
//! # Accuracy
//! Drops show what the picture holds: beyond its edge they repeat the edge. Their image is a mean of 8 × 8 pixels, about
//! what they shrink the scene by at 1280 × 720; single lights in large drops are softer than they would be.

mod encode;
mod params;
mod prepare;

pub use encode::encode_lens;
pub use params::LensInput;
pub use prepare::{LensGpu, LensViewGpu};
