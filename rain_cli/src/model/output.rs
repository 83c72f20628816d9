//! What a model returns, as JSON and as a table.

use std::fmt::Write as _;

use super::key::Returned;

/// One returned value.
#[derive(Debug, Clone, PartialEq)]
enum Field {
    Number(f64),
    Flag(bool),
    /// A series; all rows have the same names.
    Rows(Vec<Output>),
    Object(Output),
}

/// Named values in order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Output(Vec<(&'static str, Field)>);

impl Output {
    /// Numbers of these names.
    #[must_use]
    pub fn new<const N: usize>(values: [(&'static str, f64); N]) -> Self {
        // Adding zero makes −0 into 0.
        Self(values.map(|(name, value)| (name, Field::Number(value + 0.0))).into())
    }

    /// The same with `name` set to true or false.
    #[must_use]
    pub fn flag(mut self, name: &'static str, value: bool) -> Self {
        self.0.push((name, Field::Flag(value)));
        self
    }

    /// The same with a series.
    #[must_use]
    pub fn rows(mut self, name: &'static str, rows: Vec<Self>) -> Self {
        self.0.push((name, Field::Rows(rows)));
        self
    }

    /// The same with an output inside.
    #[must_use]
    pub fn object(mut self, name: &'static str, inner: Self) -> Self {
        self.0.push((name, Field::Object(inner)));
        self
    }

    /// Names in order.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.0.iter().map(|(name, _)| *name)
    }

    /// A number at the top.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<f64> {
        self.0.iter().find_map(|(known, field)| match field {
            Field::Number(value) if *known == name => Some(*value),
            _ => None,
        })
    }

    /// Whether every number is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.0.iter().all(|(_, field)| match field {
            Field::Number(value) => value.is_finite(),
            Field::Flag(_) => true,
            Field::Rows(rows) => rows.iter().all(Self::is_finite),
            Field::Object(inner) => inner.is_finite(),
        })
    }

    /// One JSON object on one line. A number that is not finite would be null; models return none.
    #[must_use]
    pub fn json(&self) -> String {
        let members: Vec<String> = self
            .0
            .iter()
            .map(|(name, field)| {
                let value = match field {
                    Field::Number(value) => serde_json::Value::from(*value).to_string(),
                    Field::Flag(value) => value.to_string(),
                    Field::Rows(rows) => format!("[{}]", rows.iter().map(Self::json).collect::<Vec<_>>().join(",")),
                    Field::Object(inner) => inner.json(),
                };
                format!("\"{name}\":{value}")
            })
            .collect();
        format!("{{{}}}", members.join(","))
    }

    /// For people: a table for a series, then a line a value. Units are those of `returned`.
    #[must_use]
    pub fn table(&self, returned: &[Returned]) -> String {
        let mut lines: Vec<(String, String)> = Vec::new();
        let mut out = String::new();
        for (name, field) in &self.0 {
            let unit = returned.iter().find(|r| r.name == *name).map_or("", |r| r.unit);
            match field {
                Field::Rows(rows) => out += &rows_table(rows),
                Field::Object(inner) => {
                    let of = |(key, value): &(&str, Field)| (format!("{name}.{key}"), text(value));
                    lines.extend(inner.0.iter().map(of));
                }
                _ => lines.push((
                    (*name).to_owned(),
                    format!("{} {unit}", text(field)).trim_end().to_owned(),
                )),
            }
        }
        let width = lines.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
        for (name, value) in lines {
            // Writing to a string cannot fail.
            let _ = writeln!(out, "{name:<width$}  {value}");
        }
        out.trim_end().to_owned()
    }
}

/// Six figures, for reading.
fn text(field: &Field) -> String {
    match field {
        Field::Number(0.0) => "0".to_owned(),
        Field::Number(x) if (1e-3..1e6).contains(&x.abs()) => {
            let places = (5 - x.abs().log10().floor() as i32).max(0) as usize;
            let text = format!("{x:.places$}");
            if text.contains('.') {
                text.trim_end_matches('0').trim_end_matches('.').to_owned()
            } else {
                text
            }
        }
        Field::Number(x) => format!("{x:.5e}"),
        Field::Flag(value) => value.to_string(),
        Field::Rows(rows) => format!("{} rows", rows.len()),
        Field::Object(inner) => inner.json(),
    }
}

fn rows_table(rows: &[Output]) -> String {
    let Some(first) = rows.first() else {
        return String::new();
    };
    let columns: Vec<Vec<String>> = first
        .names()
        .enumerate()
        .map(|(i, name)| {
            let cells = rows
                .iter()
                .map(|row| row.0.get(i).map_or(String::new(), |(_, field)| text(field)));
            core::iter::once(name.to_owned()).chain(cells).collect()
        })
        .collect();
    let widths: Vec<usize> = columns
        .iter()
        .map(|column| column.iter().map(String::len).max().unwrap_or(0))
        .collect();
    let mut out = String::new();
    for row in 0..=rows.len() {
        let cells = columns
            .iter()
            .zip(&widths)
            .map(|(column, width)| format!("{:>width$}", column[row]));
        let line: Vec<String> = cells.collect();
        out += line.join("  ").trim_end();
        out += "\n";
    }
    out
}
