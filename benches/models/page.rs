//! All results on one page of Markdown, beside the tables and plots that it shows.

use std::fmt::Write as _;
use std::path::Path;

use crate::study::Study;
use crate::table::{Line, duration, read};

/// What the figures were measured on.
fn machine() -> String {
    let processor = std::fs::read_to_string("/proc/cpuinfo")
        .ok()
        .and_then(|text| {
            let line = text.lines().find(|line| line.starts_with("model name"))?;
            Some(line.split_once(':')?.1.trim().to_owned())
        })
        .unwrap_or_else(|| std::env::consts::ARCH.to_owned());
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{processor}, {cores} cores, release profile")
}

/// One study: heading, plot, table.
fn section(page: &mut String, study: &Study, lines: &[Line]) {
    let norm = study.norm.replace('|', "\\|");
    // Writing to a string cannot fail.
    let _ = writeln!(page, "\n## {}\n\n![{1}]({1}.png)\n", study.title, study.name);
    let _ = writeln!(
        page,
        "| Variant | {norm} | Time per {} | Ratio |\n|---|---|---|---|",
        study.unit
    );
    for line in lines {
        let mark = if line.default { "**" } else { "" };
        let _ = writeln!(
            page,
            "| {mark}{}{mark} | {:.2e} | {} | {:.2} |",
            line.variant.replace('|', "\\|"),
            line.error,
            duration(line.ns_per_evaluation),
            line.ratio_to_default,
        );
    }
}

/// Writes `README.md` into `folder`, from the tables of `studies` that lie there.
///
/// # Errors
/// When a table cannot be read or the page cannot be written; the message names the file.
pub fn write(studies: &[Study], folder: &Path) -> Result<(), String> {
    let mut page = format!(
        "# Error against time\n\n\
         Written by `rain bench models`: every variant of every model with its error in the study's norm and its time, as \
         medians of samples (the CSV files hold their 95 % intervals). The default is bold, ratios are to it. Numerical \
         error is meant, against a slow reference in double precision or against measurements where the norm says so; \
         how far each model is from nature stands in [physics.md](../physics.md).\n\nMeasured on {}.\n",
        machine()
    );
    for study in studies {
        let table = folder.join(format!("{}.csv", study.name));
        if table.exists() {
            section(&mut page, study, &read(&table)?);
        }
    }
    let path = folder.join("README.md");
    std::fs::write(&path, page).map_err(|error| format!("{}: {error}", path.display()))
}
