//! A height field from a table: one row of heights in metres per line.

use std::io::Read;

use thiserror::Error;

use crate::error::shown;
use crate::table_lines::{LineLimits, TableLines, TooLong};

use super::{GridFrame, HeightField, HeightFieldError, ImportLimits, MAX_COORDINATE_M, MAX_SIDE_CELLS};

/// What can be wrong in a table of heights.
#[derive(Debug, Error)]
pub enum CsvProblem {
    /// A field is no number.
    #[error("the height is {0:?}, which is not a number; a hole is NaN or empty")]
    NotANumber(String),
    /// A height that is infinite or too large.
    #[error("the height is {} m, allowed: -1e7 to 1e7 m, or NaN for a hole", shown(*.0))]
    Height(f64),
    /// A row with more or fewer heights than the first.
    #[error("the row has {found} heights, the first row {expected}")]
    FieldCount {
        /// Heights in the row.
        found: usize,
        /// Heights in the first row.
        expected: usize,
    },
    /// No rows.
    #[error("the table has no rows")]
    NoRows,
    /// More heights than allowed.
    #[error("more than {allowed} heights, or more than 65536 along a side")]
    TooManyHeights {
        /// The limit.
        allowed: usize,
    },
    /// A line that goes on after the bytes allowed.
    #[error("the line is longer than {allowed} bytes")]
    LineTooLong {
        /// The limit.
        allowed: usize,
    },
    /// The file goes on after the bytes allowed.
    #[error("the table is longer than {allowed} bytes")]
    TooLong {
        /// The limit.
        allowed: usize,
    },
    /// The text is not UTF-8, or could not be read.
    #[error("cannot read the table: {0}")]
    Unreadable(csv::Error),
}

/// Longest line: 256 bytes for each of the cells that a side may have.
const MAX_LINE_BYTES: usize = 256 * MAX_SIDE_CELLS;

impl HeightField {
    /// Reads one row of heights (units: m) per line, separated by commas: row = z, column = x. `NaN` (any case) or
    /// nothing between two commas is a hole. The first cell's corner is the origin.
    ///
    /// A byte-order mark, CR LF line ends, spaces around fields, empty lines and lines that start with `#` are
    /// tolerated; there is no quoting and no header. A line may have 16 MiB.
    ///
    /// Allocates the heights and one line.
    ///
    /// # Errors
    /// The first thing wrong, with its line and column; more than `limits` allow; `cell_m` outside [1e-4, 1e4].
    pub fn from_csv(reader: impl Read, cell_m: f64, limits: &ImportLimits) -> Result<Self, HeightFieldError> {
        // One byte more than allowed tells a table that ends from one that goes on.
        let bytes = reader.take((limits.bytes as u64).saturating_add(1));
        let line_limits = LineLimits {
            bytes: MAX_LINE_BYTES,
            // A row may be of another length than the first, and is then to be told so.
            fields: MAX_SIDE_CELLS.min(limits.cells).saturating_add(1),
        };
        let mut csv = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .flexible(true)
            .quoting(false)
            .has_headers(false)
            .from_reader(TableLines::new(bytes, line_limits));
        let table = read_rows(&mut csv, limits);
        if csv.get_ref().inner().limit() == 0 {
            let allowed = limits.bytes;
            return Err(at(csv.position().line(), 1, CsvProblem::TooLong { allowed }));
        }
        let (cells, heights) = table?;
        Self::new(GridFrame::new(cells, cell_m, [0.0, 0.0], limits)?, heights)
    }
}

/// Cells along x and z, and the heights.
fn read_rows(
    csv: &mut csv::Reader<TableLines<impl Read>>,
    limits: &ImportLimits,
) -> Result<([usize; 2], Vec<f64>), HeightFieldError> {
    let mut record = csv::StringRecord::new();
    let mut heights = Vec::new();
    let (mut nx, mut rows) = (0, 0);
    loop {
        match csv.read_record(&mut record) {
            Ok(true) => {}
            Ok(false) => break,
            Err(error) => {
                let problem = match csv.get_ref().too_long() {
                    Some(TooLong::Fields) => CsvProblem::TooManyHeights { allowed: limits.cells },
                    Some(TooLong::Bytes) => CsvProblem::LineTooLong {
                        allowed: MAX_LINE_BYTES,
                    },
                    None => CsvProblem::Unreadable(error),
                };
                return Err(at(csv.get_ref().next_record(), 1, problem));
            }
        }
        let line = csv.get_ref().next_record();
        if rows == 0 {
            nx = record.len();
        }
        if record.len() != nx {
            let problem = CsvProblem::FieldCount {
                found: record.len(),
                expected: nx,
            };
            return Err(at(line, record.len().min(nx) + 1, problem));
        }
        rows += 1;
        if nx > MAX_SIDE_CELLS || rows > MAX_SIDE_CELLS || nx * rows > limits.cells {
            let allowed = limits.cells;
            return Err(at(line, 1, CsvProblem::TooManyHeights { allowed }));
        }
        for (i, field) in record.iter().enumerate() {
            heights.push(height(field).map_err(|problem| at(line, i + 1, problem))?);
        }
    }
    if rows == 0 {
        return Err(at(1, 1, CsvProblem::NoRows));
    }
    Ok(([nx, rows], heights))
}

fn at(line: u64, column: usize, problem: CsvProblem) -> HeightFieldError {
    HeightFieldError::Csv { line, column, problem }
}

fn height(field: &str) -> Result<f64, CsvProblem> {
    if field.is_empty() {
        return Ok(f64::NAN);
    }
    let value: f64 = field.parse().map_err(|_| {
        // Enough to recognise it.
        CsvProblem::NotANumber(field.chars().take(40).collect())
    })?;
    if value.abs() > MAX_COORDINATE_M {
        return Err(CsvProblem::Height(value));
    }
    Ok(value)
}
