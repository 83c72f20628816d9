//! Configuration errors: what was wrong, where, and what is allowed.

use thiserror::Error;

/// A value that a constructor refuses. Units and domain are those of the named field.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ConfigError {
    /// A number outside its domain, or not finite.
    #[error("{field} is {value}, allowed: {allowed}")]
    OutOfRange {
        /// The field's name with its unit, as in the public API.
        field: &'static str,
        /// The offending value.
        value: f64,
        /// The allowed range in words, with unit.
        allowed: &'static str,
    },
    /// A sequence that must rise does not.
    #[error("{field}: entry {index} ({value}) does not come after the one before it ({previous})")]
    NotIncreasing {
        /// The sequence's name with its unit.
        field: &'static str,
        /// Index of the first entry out of order.
        index: usize,
        /// Its value.
        value: f64,
        /// The value before it.
        previous: f64,
    },
    /// A sequence or table with nothing in it.
    #[error("{field} is empty")]
    Empty {
        /// The field's name.
        field: &'static str,
    },
}

/// `value` if it is finite and in `[min, max]`, else [`ConfigError::OutOfRange`].
///
/// # Errors
/// When `value` is NaN, infinite or outside the closed interval.
pub fn in_range(
    field: &'static str,
    value: f64,
    min: f64,
    max: f64,
    allowed: &'static str,
) -> Result<f64, ConfigError> {
    if value.is_finite() && value >= min && value <= max {
        Ok(value)
    } else {
        Err(ConfigError::OutOfRange { field, value, allowed })
    }
}

/// `value` held in [min, max]; what is not a number becomes `min`. For evaluators that must always answer.
#[must_use]
pub(crate) fn clamped(value: f64, min: f64, max: f64) -> f64 {
    if value.is_nan() { min } else { value.clamp(min, max) }
}

/// [`clamped`] in single precision.
#[must_use]
pub(crate) fn clamped_f32(value: f32, min: f32, max: f32) -> f32 {
    if value.is_nan() { min } else { value.clamp(min, max) }
}
