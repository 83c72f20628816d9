//! Scenario tests; see `tests/`.
