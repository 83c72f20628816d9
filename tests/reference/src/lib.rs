//! The slow truth: every model of the library once more in double precision, in the most obvious way, written from the
//! papers. It shares no code with `rain_core`: an error there cannot hide here.
//!
//! Integrals are plain sums over many points, differential equations are stepped by Dormand–Prince with a tight
//! tolerance, and closed forms are those of the textbooks.

pub mod air;
pub mod areas;
pub mod artist_look;
pub mod basins;
pub mod canopy;
pub mod container;
pub mod cover;
pub mod drop;
pub mod fall;
pub mod fall_speed;
pub mod field;
pub mod hash;
pub mod height_field;
pub mod lens;
pub mod light;
pub mod lightning;
pub mod numerics;
pub mod spectrum;
pub mod splash;
pub mod surface;
pub mod surface_inertial;
pub mod waves;
pub mod weather;
pub mod wheels;
