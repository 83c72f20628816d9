//! The lattice: cells of rain beyond the single drops, each a card with a picture of its streaks.
//!
//! Inputs: the cards of [`rain_core::rainfall::LatticePlan::fill`], from far to near, and their streak textures
//! ([`crate::streak_textures`]); the view, lamps, the cover map, an environment cube map, the scene's depth.
//! Output: premultiplied streaks over the view's colour target, and on demand a coverage mask. With the scene's depth a
//! card counts for the part of its cell that lies before the scene; without, it is tested like any other surface.
//! Cost: one draw, six vertices and 80 bytes a card; pixels covered, each with up to eight look-ups in the textures and,
//! where a streak is, the cover map's. GPU memory: 80 bytes a card.
//! Skipped by the host when nothing falls, no card is left, or the textures are not there yet.

mod encode;
mod params;
mod prepare;

pub use encode::{encode_lattice, encode_lattice_behind, encode_lattice_coverage};
pub use params::LatticeInput;
pub use prepare::{LatticeGpu, LatticeViewGpu};
