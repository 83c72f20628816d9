//! The rain that is compared with other packages' rain, and its pass beside a bare one over the same quads.

pub mod clock;
pub mod field;
pub mod pass;
