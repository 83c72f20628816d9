//! Depressions of a height field and the water in them, against the slow way.

mod bake;
mod drains;
mod filling;
mod large;
mod losses;
mod robust;
mod terrain;
