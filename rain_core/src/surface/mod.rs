//! Water on the ground: film, road film, infiltration, basins, and how wet surfaces look.

pub mod basins;
pub mod height_field;
