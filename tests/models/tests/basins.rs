//! Depressions of a height field, against the slow way.
