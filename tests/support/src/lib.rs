//! Rain.
