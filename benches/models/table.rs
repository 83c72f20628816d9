//! Results as CSV.

use std::path::Path;

use serde::Serialize;

use crate::study::Study;
use crate::timing::Time;

/// One variant's line.
#[derive(Debug, Serialize)]
struct Line<'a> {
    variant: &'a str,
    default: bool,
    error: f64,
    norm: &'a str,
    ns_per_evaluation: f64,
    ns_low: f64,
    ns_high: f64,
    evaluation: &'a str,
    ratio_to_default: f64,
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
                variant: &variant.name,
                default: variant.default,
                error: rounded(variant.error),
                norm: study.norm,
                ns_per_evaluation: rounded(time.median_ns),
                ns_low: rounded(time.low_ns),
                ns_high: rounded(time.high_ns),
                evaluation: study.unit,
                ratio_to_default: rounded(time.median_ns / default),
            })
            .map_err(failed)?;
    }
    writer.flush().map_err(|error| format!("{}: {error}", path.display()))
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

/// A time with a fitting unit.
#[must_use]
pub fn duration(ns: f64) -> String {
    match ns {
        ns if ns < 1e3 => format!("{ns:.3} ns"),
        ns if ns < 1e6 => format!("{:.3} µs", ns * 1e-3),
        ns => format!("{:.3} ms", ns * 1e-6),
    }
}
