//! Configuration errors: what was wrong, where, and what is allowed.

use thiserror::Error;

/// A value that a constructor refuses. Units and domain are those of the named field.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ConfigError {
    /// A number outside its domain, or not finite.
    #[error("{field} is {}, allowed: {allowed}", shown(*.value))]
    OutOfRange {
        /// The field's name with its unit, as in the public API.
        field: &'static str,
        /// The offending value.
        value: f64,
        /// The allowed range in words, with unit.
        allowed: &'static str,
    },
    /// A sequence that must rise does not.
    #[error("{field}: entry {index} ({}) does not come after the one before it ({})", shown(*.value), shown(*.previous))]
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

/// A number in a message: with an exponent where it would fill lines.
#[must_use]
pub fn shown(value: f64) -> String {
    if value == 0.0 || !value.is_finite() || (1e-6..1e16).contains(&value.abs()) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
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

/// `value` held in [min, max]; what is not a number becomes `min`, and -0 a `min` of 0. For evaluators that must always
/// answer.
#[must_use]
#[inline]
pub(crate) fn clamped(value: f64, min: f64, max: f64) -> f64 {
    if value > min { value.min(max) } else { min }
}

/// [`clamped`] in single precision.
#[must_use]
#[inline]
pub(crate) fn clamped_f32(value: f32, min: f32, max: f32) -> f32 {
    if value > min { value.min(max) } else { min }
}

/// `value` held in [min, max]; what is not a number becomes `other`.
#[must_use]
#[inline]
pub(crate) fn clamped_or(value: f64, min: f64, max: f64, other: f64) -> f64 {
    if value.is_nan() {
        other
    } else {
        clamped(value, min, max)
    }
}

/// [`clamped_or`] in single precision.
#[must_use]
#[inline]
pub(crate) fn clamped_or_f32(value: f32, min: f32, max: f32, other: f32) -> f32 {
    if value.is_nan() {
        other
    } else {
        clamped_f32(value, min, max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_must_answer_is_held_in_its_range() {
        for (value, held, other) in [
            (-1.0, 2.0, 2.0),
            (2.0, 2.0, 2.0),
            (2.5, 2.5, 2.5),
            (4.0, 3.0, 3.0),
            (f64::INFINITY, 3.0, 3.0),
            (f64::NEG_INFINITY, 2.0, 2.0),
            (f64::NAN, 2.0, 7.0),
        ] {
            assert_eq!(clamped(value, 2.0, 3.0), held, "{value}");
            assert_eq!(clamped_or(value, 2.0, 3.0, 7.0), other, "{value}");
            assert_eq!(f64::from(clamped_f32(value as f32, 2.0, 3.0)), held, "{value}");
            assert_eq!(f64::from(clamped_or_f32(value as f32, 2.0, 3.0, 7.0)), other, "{value}");
        }
        assert!(clamped(-0.0, 0.0, 1.0).is_sign_positive() && clamped_f32(-0.0, 0.0, 1.0).is_sign_positive());
    }

    #[test]
    fn numbers_in_messages_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (-1.5, "-1.5"),
            (1e15, "1000000000000000"),
            (1e300, "1e300"),
            (-2.5e-300, "-2.5e-300"),
            (f64::NAN, "NaN"),
            (f64::NEG_INFINITY, "-inf"),
        ] {
            assert_eq!(shown(value), text);
        }
        let error = in_range("cell_m", 1e300, 0.0, 1.0, "0 to 1 m").expect_err("too large");
        assert_eq!(error.to_string(), "cell_m is 1e300, allowed: 0 to 1 m");
    }
}
