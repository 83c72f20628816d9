//! Depressions of a height field, the slow way.
