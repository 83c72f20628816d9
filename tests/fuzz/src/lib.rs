//! Bytes that nobody meant, for everything that reads files or arguments: no panic, no blow-up of memory.
//!
//! Each [`Target`] takes any bytes. [`corpus`] has valid inputs for it, [`mutate`] breaks them in seeded ways,
//! [`repair`] mends their shells, and
//! [`attempt`] says what went wrong. The program of this package does so for as long as it is told; its tests replay
//! the corpus, everything that once failed (`regressions/`), and some thousand mutations. `libfuzzer/` hands the same
//! targets to a coverage-guided fuzzer.

pub mod corpus;
pub mod glb;
pub mod mutate;
pub mod repair;
pub mod target;

pub use target::{Failure, Target, attempt, attempt_mended};
