//! What is recorded over the run: rain, wetness, water and budget against time.

use rain_core::weather::SurfaceClass;

/// Name of a surface class in a [`Timeline`], as in the scenario's text: `asphalt`.
#[must_use]
pub fn surface_name(class: SurfaceClass) -> String {
    format!("{class:?}").to_lowercase()
}

/// A named sequence, one value per time of its [`Timeline`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// Name, as in legends and expectations (`asphalt`).
    pub name: String,
    /// Values, in the unit of the field that holds the series.
    pub values: Vec<f64>,
}

impl Series {
    /// An empty series.
    #[must_use]
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            values: Vec::new(),
        }
    }
}

/// The record of a run. Every sequence has as many values as `times_s`, which rises.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Timeline {
    /// When. Units: s.
    pub times_s: Vec<f64>,
    /// Rain rate. Units: mm/h.
    pub intensity_mm_h: Vec<f64>,
    /// Pore water over capacity, per surface class, named by [`surface_name`]. Units: none, [0, 1].
    pub wetness: Vec<Series>,
    /// Mean film outside basins, per surface class, named likewise; and other stores that are depths of water. Units: mm.
    pub water_level_mm: Vec<Series>,
    /// Terms of the water budget over the domain's area. Units: mm.
    pub budget_mm: Vec<Series>,
    /// When pictures were taken. Units: s.
    pub captures_s: Vec<f64>,
}

impl Timeline {
    /// The value of a sequence at `time_s`, linear between records; not a number outside the record (by more than 1 µs),
    /// or when the sequence is of another length.
    #[must_use]
    pub fn value_at(&self, values: &[f64], time_s: f64) -> f64 {
        let times = &self.times_s;
        let (Some(&first), Some(&last)) = (times.first(), times.last()) else {
            return f64::NAN;
        };
        if values.len() != times.len() || !(time_s >= first - 1e-6 && time_s <= last + 1e-6) {
            return f64::NAN;
        }
        let next = times.partition_point(|t| *t <= time_s);
        if next == 0 || next == times.len() {
            return values[next.saturating_sub(1)];
        }
        let (a, b) = (times[next - 1], times[next]);
        values[next - 1] + (values[next] - values[next - 1]) * (time_s - a) / (b - a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_between_records() {
        let timeline = Timeline {
            times_s: vec![0.0, 10.0, 20.0],
            ..Timeline::default()
        };
        let values = [1.0, 3.0, 2.0];
        for (time, value) in [(0.0, 1.0), (5.0, 2.0), (10.0, 3.0), (15.0, 2.5), (20.0, 2.0)] {
            assert_eq!(timeline.value_at(&values, time), value);
        }
        for time in [-0.1, 20.1, f64::NAN] {
            assert!(timeline.value_at(&values, time).is_nan());
        }
        assert!(timeline.value_at(&values[..2], 5.0).is_nan());
        assert!(Timeline::default().value_at(&[], 0.0).is_nan());
    }
}
