//! The wet ground of a scene: film, pores and basins on a grid over its horizontal domain.
//!
//! [`GroundScene`] takes a scene's triangles and draws them into a grid of two layers: the ground (the lowest surface
//! that faces up, kerbs and slabs on it included) and what stands over it. [`Ground`] runs the water: rain that reaches
//! the ground fills pores and film of its cell ([`SurfaceColumn`](crate::weather::SurfaceColumn)), what runs off fills
//! the basin at the end of its way ([`BasinRun`](super::basins::BasinRun)); rain that is kept off wets what stands
//! over the cell and drains into gutters. All water is accounted for ([`GroundLedger`]).
//!
//! | file | concept |
//! |---|---|
//! | `scene.rs` | triangles by owner, the domain and the grid |
//! | `layers.rs` | the two layers of every cell |
//! | `cells.rs` | pores and film of the cells, one interval |
//! | `inflow.rs` | water underway from cells to basins |
//! | `run.rs` | [`Ground`]: cells and basins in turns |
//! | `exposure.rs` | share of the rain that reaches each cell |
//! | `disturb.rs` | wheels, feet, added water |
//! | `ledger.rs` | where all water came from and went to |
//! | `query.rs` | water at a place; maps for the picture |
//! | `carry.rs` | water taken over when the scene changes |
//! | `state.rs` | snapshots |
//! | `error.rs` | what is refused |
//!
//! # Accuracy
//! Runoff is at its basin within three intervals; there is no flow from cell to cell. Film and drain of a cell are those
//! of its class, whose slope and flow length stand for the way to the next gully or hollow. Rain that the wind drives
//! past a roof's edge is kept off the cell behind it and wets what stands over that cell, not the roof that caught it.
//! A cell is under water as a whole.
//!
//! Cells of 0.25 m against those of 1/64 m, in 20 m of street with hollows of 0.6 to 1.5 m radius after a shower: levels
//! of puddles within 2 mm (rms), their water within 15 % of the mean, the depth at a place 0.1 mm off in the mean; cells
//! of 0.5 m have their water wrong by most of it.
//!
//! Wheel ruts are narrower (half a metre wide, 12 mm deep, on a crown of 2 %): cells of 0.25 m that such a rut crosses
//! aslant are dams in it and lose more than half of its puddles' water, while cells of 0.125 m keep every puddle, six times
//! as long as wide and more, with 60 to 110 % of its water, at any angle. A road with ruts that does not run along the
//! cells' rows wants [`GroundSettings::cell_m`] of 0.125 m.
//!
//! Each cell sees the mean conditions of its interval (default 1 s), so against advancing every tick films are up to one
//! interval late and basins up to three; within that delay they agree to 2e-3 of what they hold even while the rain rises
//! from 0 to 400 mm/h in four seconds, and once all has come to rest to 1e-6.

mod carry;
mod cells;
mod disturb;
mod error;
mod exposure;
mod inflow;
mod layers;
mod ledger;
mod query;
mod run;
#[cfg(test)]
mod ruts_tests;
mod scene;
mod state;
#[cfg(test)]
mod tests;

pub use disturb::Pressed;
pub use error::GroundError;
pub use layers::{GroundLayers, LeftOutGround};
pub use ledger::GroundLedger;
pub use query::{DRY_LEVEL, GroundLayer, PoolRoom, WaterAt};
pub use run::{Ground, UnevenRain};
pub use scene::{GroundDomain, GroundScene, GroundSettings};
pub use state::{GROUND_STATE_VERSION, GroundState};
