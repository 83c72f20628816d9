//! Light that rain's rings throw onto walls: mirrored rays gathered in a map that tiles the world as the rings do.

mod encode;
mod params;
mod prepare;

pub use params::{CAUSTIC_FORMAT, CausticFrame, caustic_texture};
pub use prepare::CausticsGpu;
