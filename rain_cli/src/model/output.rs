//! What a model returns, as JSON and as a table.

use std::fmt::Write as _;

use serde_json::{Map, Number, Value};

use super::key::Returned;

/// Named values in order. Numbers are finite.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Output(Vec<(&'static str, Value)>);

/// A number as JSON; what is not finite becomes null, which [`Output::is_finite`] finds.
fn number(value: f64) -> Value {
    Number::from_f64(value).map_or(Value::Null, Value::Number)
}

impl Output {
    /// Values of these names.
    #[must_use]
    pub fn new<const N: usize>(values: [(&'static str, f64); N]) -> Self {
        Self(values.into_iter().map(|(name, value)| (name, number(value))).collect())
    }

    /// The same with `name` set to true or false.
    #[must_use]
    pub fn flag(mut self, name: &'static str, value: bool) -> Self {
        self.0.push((name, Value::Bool(value)));
        self
    }

    /// The same with a list of outputs.
    #[must_use]
    pub fn list(mut self, name: &'static str, rows: Vec<Self>) -> Self {
        self.0
            .push((name, Value::Array(rows.into_iter().map(Self::value).collect())));
        self
    }

    /// The same with an output inside.
    #[must_use]
    pub fn object(mut self, name: &'static str, inner: Self) -> Self {
        self.0.push((name, inner.value()));
        self
    }

    /// As one JSON object.
    #[must_use]
    pub fn value(self) -> Value {
        let object: Map<String, Value> = self
            .0
            .into_iter()
            .map(|(name, value)| (name.to_owned(), value))
            .collect();
        Value::Object(object)
    }

    /// Names in order.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.0.iter().map(|(name, _)| *name)
    }

    /// The JSON text, one line.
    #[must_use]
    pub fn json(&self) -> String {
        self.clone().value().to_string()
    }

    /// A number at the top.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<f64> {
        self.0.iter().find(|(known, _)| *known == name)?.1.as_f64()
    }

    /// Whether every number is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        fn finite(value: &Value) -> bool {
            match value {
                Value::Null => false,
                Value::Array(list) => list.iter().all(finite),
                Value::Object(map) => map.values().all(finite),
                Value::Bool(_) | Value::Number(_) | Value::String(_) => true,
            }
        }
        self.0.iter().all(|(_, value)| finite(value))
    }

    /// For people: a line a value, a table for a list. Units are those of `returned`.
    #[must_use]
    pub fn table(&self, returned: &[Returned]) -> String {
        let mut lines: Vec<(String, String)> = Vec::new();
        let mut tables = String::new();
        for (name, value) in &self.0 {
            let unit = returned.iter().find(|r| r.name == *name).map_or("", |r| r.unit);
            match value {
                Value::Array(rows) => tables += &rows_table(rows),
                Value::Object(map) => {
                    lines.extend(map.iter().map(|(key, value)| (format!("{name}.{key}"), text(value))));
                }
                _ => lines.push((
                    (*name).to_owned(),
                    format!("{} {unit}", text(value)).trim_end().to_owned(),
                )),
            }
        }
        let width = lines.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
        let mut out = tables;
        for (name, value) in lines {
            // Writing to a string cannot fail.
            let _ = writeln!(out, "{name:<width$}  {value}");
        }
        out.trim_end().to_owned()
    }
}

/// Six figures, for reading.
fn text(value: &Value) -> String {
    match value.as_f64() {
        Some(0.0) => "0".to_owned(),
        Some(x) if (1e-3..1e6).contains(&x.abs()) => {
            let places = (5 - x.abs().log10().floor() as i32).max(0) as usize;
            let text = format!("{x:.places$}");
            if text.contains('.') {
                text.trim_end_matches('0').trim_end_matches('.').to_owned()
            } else {
                text
            }
        }
        Some(x) => format!("{x:.5e}"),
        None => value.to_string(),
    }
}

fn rows_table(rows: &[Value]) -> String {
    let objects: Vec<&Map<String, Value>> = rows.iter().filter_map(Value::as_object).collect();
    let Some(first) = objects.first() else {
        return String::new();
    };
    let mut columns: Vec<Vec<String>> = first.keys().map(|name| vec![name.clone()]).collect();
    for object in &objects {
        for column in &mut columns {
            let cell = object.get(&column[0]).map_or(String::new(), text);
            column.push(cell);
        }
    }
    let widths: Vec<usize> = columns
        .iter()
        .map(|column| column.iter().map(String::len).max().unwrap_or(0))
        .collect();
    let mut out = String::new();
    for row in 0..=objects.len() {
        let cells: Vec<String> = columns
            .iter()
            .zip(&widths)
            .map(|(column, width)| format!("{:>width$}", column[row]))
            .collect();
        out += cells.join("  ").trim_end();
        out += "\n";
    }
    out
}
