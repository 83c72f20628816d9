//! Puddles from geometry: depressions of a height field, their volume and level, overflow from one to the next.
