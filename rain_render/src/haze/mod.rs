//! Haze of rain over a finished scene: what drops that are not drawn take out and send, the mist of splashes over what rain
//! hits, and the glow of lamps and the rainbow in all of them.
//!
//! Inputs: extinction, what is drawn singly by distance, areas packed about the eye, lamps, the scene's depth with one or
//! more samples, the cover map, an environment cube map. Output: one premultiplied triangle over the view's colour target, and on demand
//! a mask of what is obscured.
//! Cost: one look at the environment a sample (eight reads of the grid more under areas), an arc tangent pair a lamp, two reads of a
//! table for the rainbow; the grid is one invocation for each of its 512 × 128 intervals.
//! Mist of splashes, where there is some: 8 reads of depth and 4 to 28 of the cover map a sample, 52 more where something stands
//! just below it.
//! Skipped by the host when nothing falls, the view is closed in or no way through the rain is long enough to be seen.

mod encode;
mod params;
mod prepare;

pub use encode::{encode_haze, encode_haze_areas, encode_haze_coverage};
pub use params::{HazeAreas, HazeBow, HazeFar, HazeFog, HazeInput, HazeSplash, MAX_HAZE_LAMPS};
pub use prepare::{HazeGpu, HazeTextures, HazeViewGpu};
