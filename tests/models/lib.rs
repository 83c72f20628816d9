//! Holds the test binary `models`.
