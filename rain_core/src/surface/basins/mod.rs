//! Puddles from geometry: depressions of a height field, their volume and level, overflow from one to the next.
//!
//! [`Basins::bake`] finds every hollow of a height field, which hollows become one when they are full, how volume and
//! level belong together, and where each overflows (priority flood: Barnes, Lehman & Mulla 2014; depression hierarchy:
//! Barnes, Callaghan & Wickert 2020). [`BasinRun`] fills, spills and merges them under rain, losses and drains (Barnes,
//! Callaghan & Wickert 2021, here in time): from event to event, at a cost for each basin, not for each cell.
//!
//! # Accuracy
//! Water runs to its basin at once and stands level; there are no waves of filling and no flow resistance. Cells are
//! wet or dry as a whole. Hollows shallower than the threshold count as part of the neighbour they overflow into.
//! Losses act on the wet area only.

mod bake;
mod catchment;
mod curve;
mod drains;
mod events;
mod flood;
mod grid;
mod hierarchy;
mod march;
mod run;
mod state;
mod step;

pub use bake::{BakeOptions, BakeReport, Basin, BasinRow, Basins};
pub use curve::Curve;
pub use drains::{BasinDrain, Drain, Inlet};
pub use grid::Grid;
pub use run::{BasinForcing, BasinRun};
pub use state::{BasinLedger, BasinState};
