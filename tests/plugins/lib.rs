//! Plugin tests; see `tests/`.
