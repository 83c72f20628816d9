//! `rain model`: each physical model as a calculator.
//!
//! One file per phenomenon holds its models: name, keys, what comes back, and the function that calls `rain_core`.
//! Arguments are read, checked and printed here, the same for all.

mod canopy;
mod document;
mod drop;
mod error;
mod key;
mod light;
mod output;
mod rainfall;
mod surface;
mod values;
mod waves;
mod weather;
mod wheels;

use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::path::Path;
use std::process::ExitCode;

use clap::Args;
use serde_json::{Value, json};

pub use document::{EXAMPLE_TIMELINE, document};
pub use error::ModelError;
pub use key::{Default, Key, Kind, Returned};
pub use output::Output;
use values::Values;

use crate::print;

/// How a model reads the files that its keys name.
pub type ReadFile<'a> = &'a dyn Fn(&Path) -> io::Result<Vec<u8>>;

/// A model as a calculator.
#[derive(Debug)]
pub struct Model {
    /// Its name on the command line.
    pub name: &'static str,
    /// What it computes, and from whom.
    pub what: &'static str,
    /// What it takes.
    pub keys: &'static [Key],
    /// What comes back, in order.
    pub returns: &'static [Returned],
    /// A call that works, for the documentation.
    pub example: &'static [&'static str],
    run: fn(&Values, ReadFile<'_>) -> Result<Output, ModelError>,
}

/// Every model.
#[must_use]
pub fn models() -> Vec<&'static Model> {
    [
        rainfall::MODELS,
        drop::MODELS,
        light::MODELS,
        canopy::MODELS,
        surface::MODELS,
        wheels::MODELS,
        waves::MODELS,
        weather::MODELS,
    ]
    .into_iter()
    .flatten()
    .copied()
    .collect()
}

/// Runs the model `name` on `key=value` arguments.
///
/// # Errors
/// What is wrong with the arguments.
pub fn calculate(name: &str, arguments: &[String]) -> Result<Output, ModelError> {
    calculate_with(name, arguments, &|path| std::fs::read(path))
}

/// The same with another way to read files.
///
/// # Errors
/// What is wrong with the arguments.
pub fn calculate_with(name: &str, arguments: &[String], read_file: ReadFile<'_>) -> Result<Output, ModelError> {
    let model = find(name)?;
    let values = Values::parse(model.name, model.keys, arguments)?;
    (model.run)(&values, read_file)
}

fn find(name: &str) -> Result<&'static Model, ModelError> {
    let models = models();
    models.iter().find(|model| model.name == name).copied().ok_or_else(|| {
        let names: Vec<&str> = models.iter().map(|model| model.name).collect();
        ModelError::UnknownModel {
            name: name.to_owned(),
            allowed: names.join(", "),
        }
    })
}

/// Every word that an argument may hold: names of models and keys, and choices.
#[must_use]
pub fn words() -> Vec<&'static str> {
    let mut words = vec!["=", "\n", "NaN", "inf", "true", "false"];
    for model in models() {
        words.push(model.name);
        for key in model.keys {
            words.push(key.name);
            if let Kind::Choice(choices) = key.kind {
                words.extend(choices);
            }
        }
    }
    words.sort_unstable();
    words.dedup();
    words
}

/// Arguments of `rain model`.
#[derive(Debug, Args)]
pub struct ModelArgs {
    /// The model; without one, all are listed.
    name: Option<String>,
    /// What it takes, such as diameter_mm=2.
    #[arg(value_name = "KEY=VALUE")]
    arguments: Vec<String>,
    /// List the models and their keys.
    #[arg(long)]
    list: bool,
    /// Print one JSON object on stdout.
    #[arg(long)]
    json: bool,
}

/// Runs `rain model` and prints; returns the exit code.
#[must_use]
pub fn run(args: &ModelArgs) -> ExitCode {
    let text = match &args.name {
        Some(name) if !args.list => match calculate(name, &args.arguments) {
            Ok(output) if args.json => output.json(),
            Ok(output) => output.table(find(name).map_or(&[], |model| model.returns)),
            Err(error) => {
                let _ = writeln!(io::stderr(), "rain: {error}");
                return ExitCode::from(2);
            }
        },
        name => {
            let listed: Result<Vec<_>, _> = match name {
                Some(name) => find(name).map(|model| vec![model]),
                None => Ok(models()),
            };
            match listed {
                Ok(models) if args.json => json_list(&models).to_string(),
                Ok(models) => text_list(&models),
                Err(error) => {
                    let _ = writeln!(io::stderr(), "rain: {error}");
                    return ExitCode::from(2);
                }
            }
        }
    };
    print::finish(&text, 0)
}

/// The models and their keys for people.
fn text_list(models: &[&Model]) -> String {
    let mut out = String::new();
    for model in models {
        // Writing to a string cannot fail.
        let _ = writeln!(out, "{}: {}", model.name, model.what);
        for key in model.keys {
            let default = match key.default {
                Default::Required => "required".to_owned(),
                Default::Value(text) | Default::Words(text) => format!("default: {text}"),
            };
            let _ = writeln!(out, "  {:<24} {} ({}; {default})", key.name, key.what, key.allowed());
        }
        let names: Vec<&str> = model.returns.iter().map(|r| r.name).collect();
        let _ = writeln!(out, "  returns {}\n", names.join(", "));
    }
    out.trim_end().to_owned()
}

/// The same for machines.
fn json_list(models: &[&Model]) -> Value {
    let list: Vec<Value> = models
        .iter()
        .map(|model| {
            let keys: Vec<Value> = model
                .keys
                .iter()
                .map(|key| {
                    json!({
                        "name": key.name, "what": key.what, "unit": key.unit, "allowed": key.allowed(),
                        "default": match key.default {
                            Default::Required => Value::Null,
                            Default::Value(text) | Default::Words(text) => text.into(),
                        },
                    })
                })
                .collect();
            let returns: Vec<Value> = model
                .returns
                .iter()
                .map(|r| json!({"name": r.name, "unit": r.unit, "what": r.what}))
                .collect();
            json!({"name": model.name, "what": model.what, "keys": keys, "returns": returns})
        })
        .collect();
    json!({ "models": list })
}
