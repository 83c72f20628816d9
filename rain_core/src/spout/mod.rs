//! Water that pours from roofs: how it leaves a mouth, and how it falls.
//!
//! An [`Outflow`] is the water of one mouth of an eave or of a pipe: it drips, or runs as a jet that thins as it falls and
//! breaks up into drops. [`eave_mouth`] places the mouths of an eave, [`SpoutFall`] is the way of what leaves.
//!
//! | file | concept |
//! |---|---|
//! | `outflow.rs` | dripping, jetting, size of drops, break-up |
//! | `mouths.rs` | mouths along an eave, and what each carries |
//! | `fall.rs` | the way through the air |
//!
//! # Accuracy
//! Onset of jets and break-up are laws of still nozzles: waves on the roof's film let real jets break earlier. Drops of a
//! broken jet are as large as hanging ones.

mod fall;
mod mouths;
mod outflow;

pub use fall::{SpoutFall, spout_fall_f32};
pub use mouths::{EAVE_SPACING_M, EaveMouth, eave_mouth, eave_mouths};
pub use outflow::{
    EAVE_ROOT_M, Outflow, PipeFlow, critical_pipe_flow, hanging_drop_m3, jet_breakup_s, jet_diameter_m, jetting_weber,
};
