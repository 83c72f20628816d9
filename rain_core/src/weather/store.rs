//! An account of water that loses nothing to rounding.

use serde::{Deserialize, Serialize};

/// A sum kept as an unevaluated pair of doubles, so that millions of small transfers close to the last bit.
///
/// Plain f64 sums lose up to half a unit in the last place per addition: 24 h at 60 Hz are five million additions,
/// 5e-10 of the total. The pair keeps about 32 digits.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Store {
    high: f64,
    low: f64,
}

impl Store {
    pub(crate) fn new(amount: f64) -> Self {
        Self { high: amount, low: 0.0 }
    }

    /// The amount, rounded to one double.
    pub(crate) fn total(self) -> f64 {
        self.high
    }

    /// Both halves, for hashes and snapshots.
    pub(crate) fn parts(self) -> [f64; 2] {
        [self.high, self.low]
    }

    /// Adds `amount` (which may be negative). Two-sum of Knuth 1969, then renormalised. Error: 1e-16 of the sum after five
    /// million amounts.
    pub(crate) fn add(&mut self, amount: f64) {
        let sum = self.high + amount;
        let part = sum - self.high;
        let error = (self.high - (sum - part)) + (amount - part);
        let low = self.low + error;
        self.high = sum + low;
        self.low = low - (self.high - sum);
    }

    /// Adds all of `other`.
    pub(crate) fn add_store(&mut self, other: Self) {
        self.add(other.low);
        self.add(other.high);
    }

    /// Makes the amount exactly `target` and returns what was above it (a pair, so nothing is rounded away). Error: 1e-32.
    pub(crate) fn cut_to(&mut self, target: f64) -> Self {
        let mut excess = *self;
        excess.add(-target);
        *self = Self::new(target);
        excess
    }

    /// This many times as much.
    pub(crate) fn scaled(self, factor: f64) -> Self {
        let mut scaled = Self::new(self.high * factor);
        scaled.add(self.low * factor);
        scaled
    }

    /// The negative.
    pub(crate) fn negated(self) -> Self {
        Self {
            high: -self.high,
            low: -self.low,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_million_small_amounts_add_up() {
        let mut store = Store::default();
        let mut plain = 0.0;
        let amount = 1.0 / 3.0 * 1e-4;
        let n = 5_184_000;
        for _ in 0..n {
            store.add(amount);
            plain += amount;
        }
        let exact = f64::from(n) * amount;
        assert!(
            (store.total() - exact).abs() <= 1e-16 * exact,
            "{}",
            store.total() - exact
        );
        assert!(
            (plain - exact).abs() > 1e-13 * exact,
            "a plain sum does drift, or this test shows nothing"
        );
    }

    #[test]
    fn cutting_conserves() {
        let mut store = Store::new(0.1);
        store.add(1e-20);
        store.add(0.2);
        let mut excess = store.cut_to(0.25);
        assert_eq!(store.total(), 0.25);
        excess.add(0.25);
        excess.add(-0.1);
        excess.add(-0.2);
        assert!((excess.total() - 1e-20).abs() < 1e-32, "{:e}", excess.total());
    }
}
