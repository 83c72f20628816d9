//! What can be wrong with a scenario, with file, line, column, field and allowed range.

use std::path::PathBuf;

use thiserror::Error;

/// Why a scenario was refused. All of these are bad input (exit code 2).
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ScenarioError {
    /// A file could not be read.
    #[error("{}: {message}", file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// What the system said.
        message: String,
    },
    /// The text is not a scenario: broken RON, an unknown field, a wrong type.
    #[error("{}:{line}:{column}: {message}", file.display())]
    Syntax {
        /// The file.
        file: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What was found and what was expected.
        message: String,
    },
    /// A weather table is wrong.
    #[error("{}:{line}: {message}", file.display())]
    Csv {
        /// The file.
        file: PathBuf,
        /// Line, from 1 (the header's).
        line: u64,
        /// The column, its value and what is allowed.
        message: String,
    },
    /// A value is out of its domain or does not fit the others.
    #[error("{}:{line}:{column}: {field} is {value}, allowed: {allowed}", file.display())]
    Field {
        /// The file.
        file: PathBuf,
        /// Line of the value, or of the innermost enclosing value that is written in the file; from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// Path of the field, such as `vehicles[0].path[2].time_s`.
        field: String,
        /// The value as read.
        value: String,
        /// The allowed range in words, with unit.
        allowed: String,
    },
}
