//! Drops on the lens of a camera, or on the windscreen it looks through. Seen only: no state depends on them.
//!
//! Off by default: without [`LensDrops`] on a camera no pass is recorded and nothing is computed.

mod glass;
mod view;

pub use glass::LensGlass;
pub(crate) use glass::LensShot;
pub use view::{LensDrops, LensPlugin, WindscreenWipers};
