//! From a file to a validated [`Scenario`].

use std::path::Path;

use ron::extensions::Extensions;

use super::error::ScenarioError;
use super::file::Scenario;
use super::locate::locate;
use super::validate::FieldProblem;
use super::weather::core_timeline;

/// Largest scenario file. Units: bytes.
const MAX_BYTES: u64 = 64 << 20;

fn options() -> ron::Options {
    ron::Options::default().with_default_extension(
        Extensions::IMPLICIT_SOME | Extensions::UNWRAP_NEWTYPES | Extensions::UNWRAP_VARIANT_NEWTYPES,
    )
}

impl Scenario {
    /// Reads and validates a scenario and its weather table.
    ///
    /// # Errors
    /// When a file cannot be read, or with the place and reason of the first thing wrong in it.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, ScenarioError> {
        let path = path.as_ref();
        let io = |message: String| ScenarioError::Io {
            file: path.to_path_buf(),
            message,
        };
        let bytes = std::fs::metadata(path).map_err(|e| io(e.to_string()))?.len();
        if bytes > MAX_BYTES {
            return Err(io(format!("{bytes} bytes, allowed: at most {MAX_BYTES}")));
        }
        let text = std::fs::read_to_string(path).map_err(|e| io(e.to_string()))?;
        Self::parse(&text, path)
    }

    /// Like [`load`](Self::load), from text that stands (or would stand) in the file `path`: relative names start in its
    /// folder, and errors name it.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn parse(text: &str, path: &Path) -> Result<Self, ScenarioError> {
        let mut scenario: Self = options().from_str(text).map_err(|e| ScenarioError::Syntax {
            file: path.to_path_buf(),
            line: e.span.start.line,
            column: e.span.start.col,
            message: e.code.to_string(),
        })?;
        scenario.folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
        if scenario.name.is_empty() {
            scenario.name = path
                .file_stem()
                .map(|s| s.to_string_lossy().into_owned())
                .unwrap_or_default();
        }
        scenario.validate().map_err(|FieldProblem { field, value, allowed }| {
            let (line, column) = locate(text, &field);
            ScenarioError::Field {
                file: path.to_path_buf(),
                line,
                column,
                field,
                value,
                allowed,
            }
        })?;
        // The table is part of the input: what is wrong with it is said now, not in the middle of a run.
        core_timeline(&scenario)?;
        Ok(scenario)
    }

    /// The scenario as RON text that [`parse`](Self::parse) reads back to an equal one.
    ///
    /// # Errors
    /// When a value cannot be written.
    pub fn to_ron(&self) -> Result<String, ron::Error> {
        options().to_string_pretty(self, ron::ser::PrettyConfig::default())
    }
}

#[cfg(test)]
#[path = "load_tests.rs"]
mod tests;
