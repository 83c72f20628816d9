//! Near rain: one screen-space quad a drop; those of the nearest drops have a pattern.
//!
//! Inputs: the container's drop records and class placements, the view, the cover map, an environment cube map.
//! Output: premultiplied streaks over the view's colour target, depth-tested, and on demand a coverage mask.
//! Cost: one compute invocation and four vertices a drop; pixels covered.
//! Skipped by the host when nothing falls or no rain reaches the view volume.

mod encode;
mod near;
mod params;
mod prepare;
mod project;

pub use encode::{encode_behind, encode_coverage, encode_draw, encode_project};
pub use params::{Lighting, RainfallInput, Shutter};
pub use prepare::{COVERAGE_FORMAT, DEPTH_FORMAT, RainfallGpu, RainfallTextures, RainfallViewGpu, StreakDraws};
