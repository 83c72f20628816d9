//! Shape and oscillation of a drop, and its streak.
