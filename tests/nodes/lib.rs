//! Tests of the passes; see `tests/`.
