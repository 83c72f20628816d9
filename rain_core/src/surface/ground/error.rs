//! What a ground refuses.

use thiserror::Error;

use crate::error::ConfigError;
use crate::surface::height_field::HeightFieldError;

/// Why a ground could not be made, changed or restored. What was there stays as it was.
#[derive(Debug, Error)]
pub enum GroundError {
    /// A number outside its domain, or not finite.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The grid could not be made.
    #[error(transparent)]
    Grid(#[from] HeightFieldError),
    /// No static triangle faces up inside the domain.
    #[error("no static triangle faces up inside the domain: there is no ground")]
    NoGround,
    /// A snapshot of another version of this library.
    #[error("the ground's snapshot has version {found}, supported: {supported}")]
    Version {
        /// The snapshot's.
        found: u32,
        /// This library's.
        supported: u32,
    },
    /// A snapshot of another scene or another grid.
    #[error("the snapshot is of another ground: its {what} differs")]
    OtherGround {
        /// What differs.
        what: &'static str,
    },
    /// A snapshot that no ground can have written.
    #[error("the ground's snapshot is damaged: {what}")]
    Damaged {
        /// What is wrong.
        what: &'static str,
    },
}
