//! When pictures are taken.

use serde::{Deserialize, Serialize};

/// When pictures are taken. Domain: at most 10 000, strictly rising, within the duration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Captures {
    /// At these times. Units: s.
    Times(Vec<f64>),
    /// Evenly, both ends included; a single one is taken at the start.
    Even {
        /// The first. Units: s. Domain: [0, `end_s`].
        start_s: f64,
        /// The last. Units: s. Domain: [`start_s`, `duration_s`].
        end_s: f64,
        /// How many. Domain: 0…10 000.
        count: u32,
    },
}

impl Default for Captures {
    fn default() -> Self {
        Self::Times(Vec::new())
    }
}

impl Captures {
    /// How many captures there are.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Times(times) => times.len(),
            Self::Even { count, .. } => *count as usize,
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The times, in order. Units: s.
    #[must_use]
    pub fn times_s(&self) -> Vec<f64> {
        match self {
            Self::Times(times) => times.clone(),
            Self::Even { start_s, end_s, count } => (0..*count)
                .map(|i| match count.saturating_sub(1) {
                    0 => *start_s,
                    // The last is the end itself, not the end with a rounding error past the duration.
                    last if i == last => *end_s,
                    last => start_s + (end_s - start_s) * f64::from(i) / f64::from(last),
                })
                .collect(),
        }
    }

    /// `count` captures spread evenly from the first of these to the last (`rain run --frames`); with fewer than two
    /// here, from there (or the start) to the end of the duration.
    #[must_use]
    pub fn resampled(&self, count: u32, duration_s: f64) -> Self {
        let times = self.times_s();
        Self::Even {
            start_s: times.first().copied().unwrap_or(0.0),
            end_s: times.last().copied().filter(|_| times.len() > 1).unwrap_or(duration_s),
            count,
        }
    }
}

/// The view is drawn for a while before a capture, 30 frames a second: what moves only while it is seen, such as the
/// waves behind a wheel, is under way then.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunUp {
    /// Index of the capture. Domain: 0 to the number of captures − 1. Required.
    pub capture: usize,
    /// How long. Units: s. Domain: [0, 60]. Required.
    pub seconds: f64,
}
