//! Error against time: what is measured, how it is timed, written and drawn.

pub mod plot;
pub mod study;
pub mod table;
pub mod timing;
