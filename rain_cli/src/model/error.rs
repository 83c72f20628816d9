//! What a calculation refuses.

use rain_core::error::ConfigError;
use thiserror::Error;

/// Why a calculation was refused: bad input, all of it.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ModelError {
    /// A model that does not exist.
    #[error("no model is called {name:?}, allowed: {allowed}")]
    UnknownModel {
        /// The name given.
        name: String,
        /// All models.
        allowed: String,
    },
    /// An argument without `=`.
    #[error("{argument:?} is not key=value")]
    NotKeyValue {
        /// The argument.
        argument: String,
    },
    /// A key that the model does not have.
    #[error("{model} has no key {key:?}, allowed: {allowed}")]
    UnknownKey {
        /// The model.
        model: &'static str,
        /// The key given.
        key: String,
        /// All keys of the model.
        allowed: String,
    },
    /// A key given twice.
    #[error("{key} is given twice")]
    Twice {
        /// The key.
        key: &'static str,
    },
    /// A key that must be given.
    #[error("{key} is missing, allowed: {allowed}")]
    Missing {
        /// The key.
        key: &'static str,
        /// What it may be.
        allowed: String,
    },
    /// A value that is no number or word of the key, not finite, or out of its domain.
    #[error("{key} is {value}, allowed: {allowed}")]
    Value {
        /// The key.
        key: &'static str,
        /// The value as given.
        value: String,
        /// What it may be.
        allowed: String,
    },
    /// Values that are each allowed and together are not; the model's own words.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// A file that cannot be read, or is wrong inside.
    #[error("{path}: {problem}")]
    File {
        /// The path.
        path: String,
        /// What is wrong, with line and column where it has them.
        problem: String,
    },
    /// Too much work to be meant.
    #[error("{what} is {value}, allowed: {allowed}")]
    TooMuch {
        /// What there is too much of.
        what: &'static str,
        /// How much.
        value: String,
        /// How much is allowed.
        allowed: String,
    },
}
