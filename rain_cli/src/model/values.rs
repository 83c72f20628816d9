//! Arguments, checked against a model's keys.

use std::path::PathBuf;
use std::str::FromStr;

use super::error::ModelError;
use super::key::{Default, Key, Kind};

#[derive(Debug, Clone, PartialEq)]
enum Value {
    Number(f64),
    Count(u32),
    Word(&'static str),
    Flag(bool),
    File(PathBuf),
}

/// The values of a model's keys, defaults filled in, each in its domain.
#[derive(Debug, Clone, PartialEq)]
pub struct Values(Vec<(&'static str, Value)>);

impl Values {
    /// Reads `key=value` arguments.
    ///
    /// # Errors
    /// Names the first that is unknown, given twice, missing, no number or word, not finite, or out of its domain.
    pub fn parse(model: &'static str, keys: &'static [Key], arguments: &[String]) -> Result<Self, ModelError> {
        let mut values: Vec<(&'static str, Value)> = Vec::new();
        for argument in arguments {
            let Some((name, text)) = argument.split_once('=') else {
                return Err(ModelError::NotKeyValue {
                    argument: argument.clone(),
                });
            };
            let Some(key) = keys.iter().find(|key| key.name == name) else {
                let names: Vec<&str> = keys.iter().map(|key| key.name).collect();
                return Err(ModelError::UnknownKey {
                    model,
                    key: name.to_owned(),
                    allowed: names.join(", "),
                });
            };
            if values.iter().any(|(known, _)| *known == key.name) {
                return Err(ModelError::Twice { key: key.name });
            }
            values.push((key.name, read(key, text)?));
        }
        for key in keys {
            if values.iter().any(|(known, _)| *known == key.name) {
                continue;
            }
            match key.default {
                Default::Value(text) => values.push((key.name, read(key, text)?)),
                Default::Words(_) => {}
                Default::Required => {
                    return Err(ModelError::Missing {
                        key: key.name,
                        allowed: key.allowed(),
                    });
                }
            }
        }
        Ok(Self(values))
    }

    fn get(&self, name: &str) -> Option<&Value> {
        self.0.iter().find(|(known, _)| *known == name).map(|(_, value)| value)
    }

    /// A number that has a value or a default.
    ///
    /// # Panics
    /// When the model has no such key: its own mistake.
    #[must_use]
    pub fn number(&self, name: &str) -> f64 {
        self.optional(name).unwrap_or_else(|| panic!("no number {name}"))
    }

    /// A number, where it was given.
    #[must_use]
    pub fn optional(&self, name: &str) -> Option<f64> {
        match self.get(name)? {
            Value::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// A whole number.
    ///
    /// # Panics
    /// When the model has no such key: its own mistake.
    #[must_use]
    pub fn count(&self, name: &str) -> u32 {
        match self.get(name) {
            Some(Value::Count(count)) => *count,
            _ => panic!("no count {name}"),
        }
    }

    /// The word chosen.
    ///
    /// # Panics
    /// When the model has no such key: its own mistake.
    #[must_use]
    pub fn word(&self, name: &str) -> &'static str {
        match self.get(name) {
            Some(Value::Word(word)) => word,
            _ => panic!("no word {name}"),
        }
    }

    /// The word chosen as one of the library's kinds.
    ///
    /// # Errors
    /// When the library does not know a word that the key allows: the model's own mistake.
    pub fn parsed<T: FromStr>(&self, name: &'static str) -> Result<T, ModelError> {
        let word = self.word(name);
        word.parse().map_err(|_| ModelError::Value {
            key: name,
            value: word.to_owned(),
            allowed: "another word".to_owned(),
        })
    }

    /// Whether a flag is set.
    ///
    /// # Panics
    /// When the model has no such key: its own mistake.
    #[must_use]
    pub fn flag(&self, name: &str) -> bool {
        match self.get(name) {
            Some(Value::Flag(flag)) => *flag,
            _ => panic!("no flag {name}"),
        }
    }

    /// The path of a file.
    ///
    /// # Panics
    /// When the model has no such key: its own mistake.
    #[must_use]
    pub fn file(&self, name: &str) -> &PathBuf {
        match self.get(name) {
            Some(Value::File(path)) => path,
            _ => panic!("no file {name}"),
        }
    }
}

/// Enough of a value to recognise it, in quotes where it could not be seen otherwise.
fn quoted(text: &str) -> String {
    let start: String = text.chars().take(80).collect();
    if start.is_empty() || start.contains(|c: char| c.is_whitespace() || c.is_control()) {
        format!("{start:?}")
    } else {
        start
    }
}

fn read(key: &Key, text: &str) -> Result<Value, ModelError> {
    let wrong = || ModelError::Value {
        key: key.name,
        value: quoted(text),
        allowed: key.allowed(),
    };
    match key.kind {
        Kind::Number { min, max, above } => {
            let number: f64 = text.parse().map_err(|_| wrong())?;
            let inside = number.is_finite() && number >= min && number <= max && !(above && number <= min);
            // Adding zero makes −0 into 0.
            inside.then_some(Value::Number(number + 0.0)).ok_or_else(wrong)
        }
        Kind::Count { min, max } => {
            let count: u32 = text.parse().map_err(|_| wrong())?;
            (min..=max)
                .contains(&count)
                .then_some(Value::Count(count))
                .ok_or_else(wrong)
        }
        Kind::Choice(words) => {
            let word = words.iter().find(|word| **word == text).ok_or_else(wrong)?;
            Ok(Value::Word(word))
        }
        Kind::Flag => match text {
            "true" => Ok(Value::Flag(true)),
            "false" => Ok(Value::Flag(false)),
            _ => Err(wrong()),
        },
        Kind::File if text.is_empty() => Err(wrong()),
        Kind::File => Ok(Value::File(text.into())),
    }
}
