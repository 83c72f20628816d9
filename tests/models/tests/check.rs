//! Comparisons that say where they failed, and that are themselves checked.

/// Largest relative deviation seen, with the place where it was seen.
#[derive(Debug, Default, Clone)]
pub struct Worst {
    /// Largest deviation.
    pub error: f64,
    /// Where.
    pub place: String,
    /// Number of comparisons.
    pub count: usize,
}

impl Worst {
    /// Compares relative to the reference, but to no less than `scale`.
    pub fn relative(&mut self, value: f64, reference: f64, scale: f64, place: impl FnOnce() -> String) {
        self.absolute(
            value / reference.abs().max(scale),
            reference / reference.abs().max(scale),
            place,
        );
    }

    /// Compares absolutely. What is not a number counts as an infinite error.
    pub fn absolute(&mut self, value: f64, reference: f64, place: impl FnOnce() -> String) {
        self.count += 1;
        let difference = (value - reference).abs();
        let error = if difference.is_nan() { f64::INFINITY } else { difference };
        if error > self.error || self.count == 1 {
            self.error = error;
            self.place = place();
        }
    }

    /// At least `count` comparisons, none off by more than `bound`.
    #[track_caller]
    pub fn assert_below(&self, bound: f64, count: usize) {
        assert!(self.count >= count, "only {} comparisons", self.count);
        assert!(
            self.error <= bound,
            "off by {:.3e} at {}, allowed {bound:.3e}",
            self.error,
            self.place
        );
    }
}

#[test]
fn a_wrong_value_and_an_empty_comparison_are_found() {
    let mut worst = Worst::default();
    worst.relative(1.05, 1.0, 1e-9, || "first".into());
    worst.relative(2.0, 2.0, 1e-9, || "second".into());
    assert!((worst.error - 0.05).abs() < 1e-12 && worst.place == "first");
    assert!(std::panic::catch_unwind(|| worst.assert_below(0.04, 1)).is_err());
    assert!(std::panic::catch_unwind(|| worst.assert_below(0.06, 3)).is_err());
    worst.assert_below(0.06, 2);
    worst.absolute(f64::NAN, 1.0, || "nan".into());
    assert!(std::panic::catch_unwind(|| worst.assert_below(1e9, 1)).is_err());
}
