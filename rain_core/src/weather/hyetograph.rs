//! A timeline read from a CSV table of rain rates.

use std::io::Read;

use thiserror::Error;

use super::conditions::WeatherConditions;
use super::timeline::{Keyframe, Timeline, Transition};
use crate::error::ConfigError;
use crate::table_lines::{LineLimits, TableLines};

/// Most data rows a table may have (11.5 days of one row a second).
pub const MAX_HYETOGRAPH_ROWS: usize = 1_000_000;

/// Most bytes and fields of a line. Far more than there are columns: what is wrong in a line is to be told.
const LINE_LIMITS: LineLimits = LineLimits {
    bytes: 1 << 16,
    fields: 1 << 12,
};

const COLUMNS: [&str; 6] = [
    "time_s",
    "intensity_mm_h",
    "wind_x_m_s",
    "wind_z_m_s",
    "air_temperature_c",
    "relative_humidity",
];

/// Where a table is wrong, and how. The message does not name the file: the caller knows it.
#[derive(Debug, Error)]
#[error("line {line}, column {column}: {problem}")]
pub struct HyetographError {
    /// Line in the file, the first is 1; comments and empty lines count.
    pub line: u64,
    /// Column of the table (not the character), the first is 1.
    pub column: usize,
    /// What is wrong there.
    pub problem: HyetographProblem,
}

/// What can be wrong in a hyetograph table.
#[derive(Debug, Error)]
pub enum HyetographProblem {
    /// The header lacks a column that must be there.
    #[error("the header has no {0:?} column; it needs time_s and intensity_mm_h")]
    MissingColumn(&'static str),
    /// The header names a column that does not exist.
    #[error(
        "unknown column {0:?}; allowed: time_s, intensity_mm_h, wind_x_m_s, wind_z_m_s, air_temperature_c, \
         relative_humidity"
    )]
    UnknownColumn(String),
    /// The header names a column twice.
    #[error("column {0:?} appears twice")]
    DuplicateColumn(String),
    /// A row has more or fewer fields than the header.
    #[error("the row has {found} fields, the header {expected}")]
    FieldCount {
        /// Fields in the row.
        found: usize,
        /// Fields in the header.
        expected: usize,
    },
    /// A field is not a number.
    #[error("{field} is {text:?}, which is not a number")]
    NotANumber {
        /// The column's name.
        field: &'static str,
        /// The field's text.
        text: String,
    },
    /// A number outside its domain, or a time that does not come after the one before it.
    #[error(transparent)]
    Value(#[from] ConfigError),
    /// No data rows.
    #[error("the table has no rows")]
    NoRows,
    /// More rows than [`MAX_HYETOGRAPH_ROWS`].
    #[error("the table has more than {0} rows")]
    TooManyRows(usize),
    /// A line with more than 65536 bytes or 4096 fields.
    #[error("the line is longer than {} bytes or {} fields", LINE_LIMITS.bytes, LINE_LIMITS.fields)]
    LineTooLong,
    /// The text is not UTF-8, or could not be read.
    #[error("cannot read the table: {0}")]
    Unreadable(csv::Error),
}

/// Reads `time_s,intensity_mm_h` (any order, header required) with the optional columns `wind_x_m_s`, `wind_z_m_s`,
/// `air_temperature_c`, `relative_humidity`. Values run linearly from row to row.
///
/// What the table does not say comes from `base`. A byte-order mark, CR LF line ends, spaces around fields, empty
/// lines and lines that start with `#` are tolerated; there is no quoting.
///
/// # Errors
/// The first thing wrong, with its line and column.
pub fn read_hyetograph(reader: impl Read, base: &WeatherConditions) -> Result<Timeline, HyetographError> {
    read_table(reader, base, MAX_HYETOGRAPH_ROWS)
}

fn read_table(reader: impl Read, base: &WeatherConditions, max_rows: usize) -> Result<Timeline, HyetographError> {
    let mut csv = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .flexible(true)
        .quoting(false)
        .has_headers(false)
        .from_reader(TableLines::new(reader, LINE_LIMITS));
    let mut record = csv::StringRecord::new();

    if !next_record(&mut csv, &mut record)? {
        return Err(at(1, 1, HyetographProblem::MissingColumn("time_s")));
    }
    let header_line = csv.get_ref().next_record();
    let header = parse_header(&record, header_line)?;

    let mut keys: Vec<Keyframe> = Vec::new();
    let mut line = header_line;
    while next_record(&mut csv, &mut record)? {
        line = csv.get_ref().next_record();
        if keys.len() == max_rows {
            return Err(at(line, 1, HyetographProblem::TooManyRows(max_rows)));
        }
        if record.len() != header.len() {
            let column = record.len().min(header.len()) + 1;
            let problem = HyetographProblem::FieldCount {
                found: record.len(),
                expected: header.len(),
            };
            return Err(at(line, column, problem));
        }
        let key = parse_row(&record, &header, base, line)?;
        if let Some(last) = keys.last()
            && key.time_s <= last.time_s
        {
            let error = ConfigError::NotIncreasing {
                field: "time_s",
                index: keys.len(),
                value: key.time_s,
                previous: last.time_s,
            };
            return Err(at(line, column_of(&header, "time_s"), error.into()));
        }
        keys.push(key);
    }
    if keys.is_empty() {
        return Err(at(line, 1, HyetographProblem::NoRows));
    }
    Timeline::new(keys).map_err(|error| at(line, 1, error.into()))
}

fn at(line: u64, column: usize, problem: HyetographProblem) -> HyetographError {
    HyetographError { line, column, problem }
}

fn column_of(header: &[&'static str], name: &str) -> usize {
    header
        .iter()
        .position(|&column| column == name)
        .map_or(1, |index| index + 1)
}

fn next_record<R: Read>(
    csv: &mut csv::Reader<TableLines<R>>,
    record: &mut csv::StringRecord,
) -> Result<bool, HyetographError> {
    csv.read_record(record).map_err(|error| {
        let line = csv.get_ref().next_record();
        if csv.get_ref().too_long().is_some() {
            return at(line, 1, HyetographProblem::LineTooLong);
        }
        let column = match error.kind() {
            csv::ErrorKind::Utf8 { err, .. } => err.field() + 1,
            _ => 1,
        };
        at(line, column, HyetographProblem::Unreadable(error))
    })
}

fn parse_header(record: &csv::StringRecord, line: u64) -> Result<Vec<&'static str>, HyetographError> {
    let mut header: Vec<&'static str> = Vec::new();
    for (index, name) in record.iter().enumerate() {
        let known = COLUMNS.into_iter().find(|&column| column == name);
        let known = known.ok_or_else(|| at(line, index + 1, HyetographProblem::UnknownColumn(name.to_owned())))?;
        if header.contains(&known) {
            return Err(at(line, index + 1, HyetographProblem::DuplicateColumn(name.to_owned())));
        }
        header.push(known);
    }
    for needed in ["time_s", "intensity_mm_h"] {
        if !header.contains(&needed) {
            return Err(at(line, header.len() + 1, HyetographProblem::MissingColumn(needed)));
        }
    }
    Ok(header)
}

fn parse_row(
    record: &csv::StringRecord,
    header: &[&'static str],
    base: &WeatherConditions,
    line: u64,
) -> Result<Keyframe, HyetographError> {
    let mut key = Keyframe {
        time_s: 0.0,
        conditions: *base,
        transition: Transition::Linear,
    };
    for (index, (&field, text)) in header.iter().zip(record.iter()).enumerate() {
        let value: f64 = text.parse().map_err(|_| {
            at(
                line,
                index + 1,
                HyetographProblem::NotANumber {
                    field,
                    text: text.to_owned(),
                },
            )
        })?;
        match field {
            "time_s" => key.time_s = value,
            "intensity_mm_h" => key.conditions.intensity_mm_h = value,
            "wind_x_m_s" => key.conditions.wind_m_s.x = value,
            "wind_z_m_s" => key.conditions.wind_m_s.z = value,
            "air_temperature_c" => key.conditions.air_temperature_c = value,
            _ => key.conditions.relative_humidity = value,
        }
        // Checked after each field, so that an error is reported where its cause stands.
        key.validated().map_err(|error| at(line, index + 1, error.into()))?;
    }
    Ok(key)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Timeline, HyetographError> {
        read_hyetograph(text.as_bytes(), &WeatherConditions::default())
    }

    fn message(text: &str) -> String {
        read(text).expect_err("must be refused").to_string()
    }

    #[test]
    fn a_plain_table_is_linear_between_rows() {
        let t = read("time_s,intensity_mm_h\n0,0\n60,30\n120,0\n").expect("valid");
        assert_eq!(t.keys().len(), 3);
        assert_eq!(t.at(30.0).expect("finite").intensity_mm_h, 15.0);
        assert_eq!(t.mean_intensity_mm_h(0.0, 120.0), Ok(15.0));
        assert_eq!(
            t.at(30.0).expect("finite").air_temperature_c,
            WeatherConditions::default().air_temperature_c
        );
    }

    #[test]
    fn bom_crlf_comments_spaces_empty_lines_and_all_columns() {
        let text = "\u{feff}# gauge 7\r\nintensity_mm_h, time_s ,wind_x_m_s,wind_z_m_s,air_temperature_c,relative_humidity\r\n\r\n \
                    2.5 , 0,3,-1,11,0.9\r\n# gap\r\n5e0,10,4,0,12,0.95";
        let t = read(text).expect("valid");
        let first = t.at(0.0).expect("finite");
        assert_eq!(
            (first.intensity_mm_h, first.wind_m_s.x, first.wind_m_s.z),
            (2.5, 3.0, -1.0)
        );
        let last = t.at(10.0).expect("finite");
        assert_eq!(
            (last.intensity_mm_h, last.air_temperature_c, last.relative_humidity),
            (5.0, 12.0, 0.95)
        );
    }

    #[test]
    fn errors_name_line_and_column() {
        assert_eq!(
            message("time_s,intensity_mm_h\n# note\n0,1\n5,heavy\n"),
            "line 4, column 2: intensity_mm_h is \"heavy\", which is not a number"
        );
        assert_eq!(
            message("time_s,intensity_mm_h\n0,1\n5,501\n"),
            "line 3, column 2: intensity_mm_h is 501, allowed: 0 to 500 mm/h"
        );
        assert_eq!(
            message("intensity_mm_h,time_s\n0,1\n5,1\n"),
            "line 3, column 2: time_s: entry 1 (1) does not come after the one before it (1)"
        );
        assert_eq!(
            message("time_s,intensity_mm_h\n0,1\n5\n"),
            "line 3, column 2: the row has 1 fields, the header 2"
        );
        assert_eq!(
            message("time_s,intensity_mm_h\n0,1,5\n"),
            "line 2, column 3: the row has 3 fields, the header 2"
        );
        assert!(message("time_s,rain\n0,1\n").starts_with("line 1, column 2: unknown column \"rain\""));
        assert!(message("time_s,time_s\n0,1\n").starts_with("line 1, column 2: column \"time_s\" appears twice"));
        assert!(message("time_s\n0\n").starts_with("line 1, column 2: the header has no \"intensity_mm_h\""));
        assert!(message("0,1\n5,2\n").starts_with("line 1, column 1: unknown column \"0\""));
        assert_eq!(
            message("time_s,intensity_mm_h\n"),
            "line 1, column 1: the table has no rows"
        );
        assert!(message("").starts_with("line 1, column 1: the header has no \"time_s\""));
        assert!(message("time_s,intensity_mm_h\nNaN,1\n").starts_with("line 2, column 1: time_s is NaN"));
        assert!(message("time_s,intensity_mm_h\n0,inf\n").starts_with("line 2, column 2: intensity_mm_h is inf"));
        assert!(message("time_s,intensity_mm_h,wind_z_m_s\n0,1,90\n").starts_with("line 2, column 3: wind_m_s is 90"));
    }

    #[test]
    fn bytes_that_are_not_text_are_an_error_with_a_place() {
        let error = read_hyetograph(&b"time_s,intensity_mm_h\n0,\xff\n"[..], &WeatherConditions::default());
        let error = error.expect_err("not UTF-8");
        assert_eq!((error.line, error.column), (2, 2));
    }

    #[test]
    fn the_length_of_a_line_is_bounded() {
        for byte in [b',', b'7'] {
            let text = b"time_s,intensity_mm_h\n0,1\n".chain(std::io::repeat(byte));
            let error = read_hyetograph(text, &WeatherConditions::default());
            assert_eq!(
                error.expect_err("too long").to_string(),
                "line 3, column 1: the line is longer than 65536 bytes or 4096 fields"
            );
        }
    }

    #[test]
    fn the_row_count_is_bounded() {
        let table = |max_rows| {
            let text = &b"time_s,intensity_mm_h\n0,1\n1,2\n2,3\n3,4\n"[..];
            read_table(text, &WeatherConditions::default(), max_rows)
        };
        assert_eq!(table(4).expect("just enough").keys().len(), 4);
        assert_eq!(
            table(3).expect_err("one too many").to_string(),
            "line 5, column 1: the table has more than 3 rows"
        );
    }
}
