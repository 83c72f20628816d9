//! One model's variants on the plane of error against time.

/// What is compared: one quantity, one error norm, several ways to compute it.
pub struct Study {
    /// File name of the table and the plot: lower case, dashes.
    pub name: &'static str,
    /// Heading of the plot.
    pub title: &'static str,
    /// What the error is, with its unit ("max |v − v_ref|, m/s").
    pub norm: &'static str,
    /// What one evaluation is ("drop", "cell step", "rain state").
    pub unit: &'static str,
    /// The ways to compute it. Exactly one is the default.
    pub variants: Vec<Variant>,
}

impl Study {
    /// What would make its plot lie: not exactly one default, or an error that is not a number.
    #[must_use]
    pub fn fault(&self) -> Option<String> {
        let defaults = self.variants.iter().filter(|variant| variant.default).count();
        if defaults != 1 {
            return Some(format!("{}: {defaults} defaults, must be 1", self.name));
        }
        let bad = self
            .variants
            .iter()
            .find(|variant| !variant.error.is_finite() || variant.error < 0.0 || variant.evaluations == 0)?;
        Some(format!("{}: {} has error {}", self.name, bad.name, bad.error))
    }
}

/// One way to compute a model's quantity.
pub struct Variant {
    /// Short name, as in the legend ("Beard 1976, f32").
    pub name: String,
    /// Whether the library uses it unless told otherwise.
    pub default: bool,
    /// Error in the study's norm, measured before timing.
    pub error: f64,
    /// Evaluations that one call of `run` makes.
    pub evaluations: u64,
    /// Makes them, over varied input, and returns something that depends on every result.
    pub run: Box<dyn FnMut() -> f64>,
}

impl Variant {
    /// A variant that is not the default.
    pub fn new(name: impl Into<String>, error: f64, evaluations: u64, run: impl FnMut() -> f64 + 'static) -> Self {
        Self {
            name: name.into(),
            default: false,
            error,
            evaluations,
            run: Box::new(run),
        }
    }

    /// The same, marked as the default.
    #[must_use]
    pub fn default(self) -> Self {
        Self { default: true, ..self }
    }
}
