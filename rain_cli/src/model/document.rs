//! The tables of `docs/calculator.md`, written from the models themselves.

use std::fmt::Write as _;
use std::path::Path;

use super::key::Default;
use super::{Model, ModelError, calculate_with, models};

/// The hyetograph of the example, `storm.csv`.
pub const EXAMPLE_TIMELINE: &str = "time_s,intensity_mm_h\n0,0\n300,40\n900,40\n1200,0\n";

/// A section for each model: what it takes, what it returns, an example with its result.
///
/// # Errors
/// When an example is refused.
pub fn document() -> Result<String, ModelError> {
    let mut out = String::new();
    for model in models() {
        section(&mut out, model)?;
    }
    Ok(out.trim_end().to_owned() + "\n")
}

/// A cell of a table.
fn cell(text: &str) -> String {
    if text.is_empty() {
        "–".to_owned()
    } else {
        text.replace('|', "\\|")
    }
}

fn section(out: &mut String, model: &Model) -> Result<(), ModelError> {
    // Writing to a string cannot fail.
    let _ = write!(
        out,
        "## {}\n\n{}.\n\n| Key | Meaning | Unit | Allowed | Default |\n|---|---|---|---|---|\n",
        model.name,
        capital(model.what)
    );
    for key in model.keys {
        let default = match key.default {
            Default::Required => "required".to_owned(),
            Default::Value(text) => format!("`{text}`"),
            Default::Words(text) => text.to_owned(),
        };
        let _ = writeln!(
            out,
            "| `{}` | {} | {} | {} | {default} |",
            key.name,
            cell(key.what),
            cell(key.unit),
            cell(&key.allowed())
        );
    }
    out.push_str("\n| Returns | Meaning | Unit |\n|---|---|---|\n");
    for returned in model.returns {
        let _ = writeln!(
            out,
            "| `{}` | {} | {} |",
            returned.name,
            cell(returned.what),
            cell(returned.unit)
        );
    }
    let arguments: Vec<String> = model.example.iter().map(|a| (*a).to_owned()).collect();
    let timeline = |_: &Path| Ok(EXAMPLE_TIMELINE.as_bytes().to_vec());
    let output = calculate_with(model.name, &arguments, &timeline)?;
    let _ = write!(
        out,
        "\n```text\n$ rain model {} {}\n{}\n```\n\n",
        model.name,
        model.example.join(" "),
        output.table(model.returns)
    );
    Ok(())
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters
        .next()
        .map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}
