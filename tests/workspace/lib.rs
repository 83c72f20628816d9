//! Workspace checks; see `tests/`.
