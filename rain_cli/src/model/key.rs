//! What a model takes: names, kinds, domains, defaults.

/// What a key's value may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A number in [min, max], or in (min, max] where `above`.
    Number {
        /// Lowest value.
        min: f64,
        /// Highest value.
        max: f64,
        /// Whether the lowest value itself is not allowed.
        above: bool,
    },
    /// A whole number in [min, max].
    Count {
        /// Lowest value.
        min: u32,
        /// Highest value.
        max: u32,
    },
    /// One of these words.
    Choice(&'static [&'static str]),
    /// `true` or `false`.
    Flag,
    /// The path of a file.
    File,
}

/// What stands in for a key that is not given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Default {
    /// Nothing: the key must be given.
    Required,
    /// This text, as if it had been given.
    Value(&'static str),
    /// Something that depends on other keys, in words.
    Words(&'static str),
}

/// One key of a model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Key {
    /// Its name with its unit.
    pub name: &'static str,
    /// What its value may be.
    pub kind: Kind,
    /// What stands in for it.
    pub default: Default,
    /// Its unit; empty where it has none.
    pub unit: &'static str,
    /// What it is.
    pub what: &'static str,
}

impl Key {
    /// A number in [min, max] that must be given.
    #[must_use]
    pub const fn number(name: &'static str, [min, max]: [f64; 2], unit: &'static str, what: &'static str) -> Self {
        let kind = Kind::Number { min, max, above: false };
        Self::required(name, kind, unit, what)
    }

    /// A number in (min, max] that must be given.
    #[must_use]
    pub const fn above(name: &'static str, [min, max]: [f64; 2], unit: &'static str, what: &'static str) -> Self {
        let kind = Kind::Number { min, max, above: true };
        Self::required(name, kind, unit, what)
    }

    /// A whole number in [min, max] that must be given.
    #[must_use]
    pub const fn count(name: &'static str, [min, max]: [u32; 2], what: &'static str) -> Self {
        Self::required(name, Kind::Count { min, max }, "", what)
    }

    /// One of some words; the first is the default.
    #[must_use]
    pub const fn choice(name: &'static str, words: &'static [&'static str], what: &'static str) -> Self {
        Self::required(name, Kind::Choice(words), "", what).or(words[0])
    }

    /// `true` or `false`.
    #[must_use]
    pub const fn flag(name: &'static str, default: bool, what: &'static str) -> Self {
        Self::required(name, Kind::Flag, "", what).or(if default { "true" } else { "false" })
    }

    /// A file that must be given.
    #[must_use]
    pub const fn file(name: &'static str, what: &'static str) -> Self {
        Self::required(name, Kind::File, "", what)
    }

    /// The same with a default value.
    #[must_use]
    pub const fn or(mut self, default: &'static str) -> Self {
        self.default = Default::Value(default);
        self
    }

    /// The same, optional; `words` say what stands in for it.
    #[must_use]
    pub const fn or_words(mut self, words: &'static str) -> Self {
        self.default = Default::Words(words);
        self
    }

    const fn required(name: &'static str, kind: Kind, unit: &'static str, what: &'static str) -> Self {
        Self {
            name,
            kind,
            default: Default::Required,
            unit,
            what,
        }
    }

    /// What is allowed, in words.
    #[must_use]
    pub fn allowed(&self) -> String {
        let unit = if self.unit.is_empty() {
            String::new()
        } else {
            format!(" {}", self.unit)
        };
        match self.kind {
            Kind::Number { min, max, above: false } => format!("{min} to {max}{unit}"),
            Kind::Number { min, max, above: true } => format!("above {min}, to {max}{unit}"),
            Kind::Count { min, max } => format!("a whole number from {min} to {max}"),
            Kind::Choice(words) => words.join(", "),
            Kind::Flag => "true, false".into(),
            Kind::File => "the path of a file".into(),
        }
    }
}

/// One value that a model returns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Returned {
    /// Its key in the JSON object.
    pub name: &'static str,
    /// Its unit; empty where it has none.
    pub unit: &'static str,
    /// What it is.
    pub what: &'static str,
}

/// One returned value: name, unit, meaning.
#[must_use]
pub const fn returns(name: &'static str, unit: &'static str, what: &'static str) -> Returned {
    Returned { name, unit, what }
}
