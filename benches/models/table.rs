//! Results as CSV.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::study::Study;
use crate::timing::Time;

/// One variant's line.
#[derive(Debug, Serialize, Deserialize)]
pub struct Line {
    /// Its name.
    pub variant: String,
    /// Whether the library uses it unless told otherwise.
    pub default: bool,
    /// Error in `norm`.
    pub error: f64,
    /// What the error is.
    pub norm: String,
    /// Median time of an evaluation. Units: ns.
    pub ns_per_evaluation: f64,
    /// Lower end of its 95 % interval. Units: ns.
    pub ns_low: f64,
    /// Upper end of its 95 % interval. Units: ns.
    pub ns_high: f64,
    /// What one evaluation is.
    pub evaluation: String,
    /// Time over the default's.
    pub ratio_to_default: f64,
}

/// Three significant digits: more are noise.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// Writes the study with its times to `path`.
///
/// # Errors
/// When the file cannot be written; the message names it.
pub fn write(study: &Study, times: &[Time], path: &Path) -> Result<(), String> {
    let failed = |error: csv::Error| format!("{}: {error}", path.display());
    let default = default_time(study, times);
    let mut writer = csv::Writer::from_path(path).map_err(failed)?;
    for (variant, time) in study.variants.iter().zip(times) {
        writer
            .serialize(Line {
                variant: variant.name.clone(),
                default: variant.default,
                error: rounded(variant.error),
                norm: study.norm.to_owned(),
                ns_per_evaluation: rounded(time.median_ns),
                ns_low: rounded(time.low_ns),
                ns_high: rounded(time.high_ns),
                evaluation: study.unit.to_owned(),
                ratio_to_default: rounded(time.median_ns / default),
            })
            .map_err(failed)?;
    }
    writer.flush().map_err(|error| format!("{}: {error}", path.display()))
}

/// The lines of a table that [`write()`] wrote.
///
/// # Errors
/// When the file cannot be read; the message names it.
pub fn read(path: &Path) -> Result<Vec<Line>, String> {
    let failed = |error: csv::Error| format!("{}: {error}", path.display());
    csv::Reader::from_path(path)
        .map_err(failed)?
        .deserialize()
        .collect::<Result<_, _>>()
        .map_err(failed)
}

/// Time of the default variant. Units: ns.
fn default_time(study: &Study, times: &[Time]) -> f64 {
    study
        .variants
        .iter()
        .zip(times)
        .find(|(variant, _)| variant.default)
        .map_or(f64::NAN, |(_, time)| time.median_ns)
}

/// The same for people: one line a variant.
pub fn text(study: &Study, times: &[Time]) -> String {
    use std::fmt::Write;
    let default = default_time(study, times);
    let mut out = format!("{}: {}; time per {}\n", study.title, study.norm, study.unit);
    let width = study
        .variants
        .iter()
        .map(|variant| variant.name.chars().count())
        .max()
        .unwrap_or(0);
    for (variant, time) in study.variants.iter().zip(times) {
        let mark = if variant.default { '*' } else { ' ' };
        // Writing to a string cannot fail.
        let _ = writeln!(
            out,
            "{mark} {:<width$}  error {:9.2e}  {:>11}  x {:.2}",
            variant.name,
            variant.error,
            duration(time.median_ns),
            time.median_ns / default,
        );
    }
    out
}

/// A time in three significant digits with a fitting unit.
#[must_use]
pub fn duration(ns: f64) -> String {
    let (value, unit) = match ns {
        ns if ns < 1e3 => (ns, "ns"),
        ns if ns < 1e6 => (ns * 1e-3, "µs"),
        ns if ns < 1e9 => (ns * 1e-6, "ms"),
        ns => (ns * 1e-9, "s"),
    };
    let decimals = match value {
        v if v < 1.0 => 3,
        v if v < 10.0 => 2,
        v if v < 100.0 => 1,
        _ => 0,
    };
    format!("{value:.decimals$} {unit}")
}
