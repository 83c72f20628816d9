//! Near rain: one screen-space quad a drop; those of the nearest drops have a pattern.
//!
//! Inputs: what the view's drops are chosen from, or a list of them, the view, the cover map, an environment cube map.
//! Output: premultiplied streaks over the view's colour target, depth-tested, and on demand a coverage mask.
//! Cost: two looks at each lattice cell about the view and at the drops in it; one compute invocation and four vertices a drop;
//! pixels covered. Nothing that grows with the number of drops is uploaded, unless they are listed.
//! Skipped by the host when nothing falls or no rain reaches the view volume.

mod choose;
mod encode;
mod near;
mod params;
mod prepare;
mod project;

pub use encode::{encode_behind, encode_coverage, encode_draw, encode_project};
pub(crate) use params::SEEN_FROM_M;
pub use params::{Drops, Lighting, RainfallInput, Shutter};
pub(crate) use prepare::NO_DROP;
pub use prepare::{COVERAGE_FORMAT, DEPTH_FORMAT, RainfallGpu, RainfallTextures, RainfallViewGpu, StreakDraws};
