//! Error against time: what is measured, and how it is written and drawn.

pub mod study;
