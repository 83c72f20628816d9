//! Conditions as a piecewise linear function of time, with exact means and integrals.

use std::ops::{Add, Mul};

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::conditions::{ConditionValues, WeatherConditions};
use crate::error::{ConfigError, in_range};

/// Largest time a key may have, either side of zero. Units: s.
const MAX_TIME_S: f64 = 1e9;

/// How the weather goes from one key to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Transition {
    /// Along a straight line in every field.
    #[default]
    Linear,
    /// Not at all: this key's conditions hold until the next key, then step.
    Hold,
}

/// The conditions at one moment of a [`Timeline`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Keyframe {
    /// Time on the weather clock. Units: s. Domain: [−1e9, 1e9].
    pub time_s: f64,
    /// The conditions at that time. Default: [`WeatherConditions::default`].
    #[serde(default)]
    pub conditions: WeatherConditions,
    /// The way to the next key. Default: linear.
    #[serde(default)]
    pub transition: Transition,
}

impl Keyframe {
    /// This key, if its time and conditions lie in their domains.
    ///
    /// # Errors
    /// Names the first field that does not.
    pub fn validated(self) -> Result<Self, ConfigError> {
        checked_time(self.time_s)?;
        self.conditions.validated()?;
        Ok(self)
    }
}

/// Weather over time: linear (or held) between keys, constant before the first and after the last.
///
/// At a step the value is that after the step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<Keyframe>", into = "Vec<Keyframe>")]
pub struct Timeline {
    keys: Vec<Keyframe>,
}

impl TryFrom<Vec<Keyframe>> for Timeline {
    type Error = ConfigError;
    fn try_from(keys: Vec<Keyframe>) -> Result<Self, ConfigError> {
        Self::new(keys)
    }
}

impl From<Timeline> for Vec<Keyframe> {
    fn from(timeline: Timeline) -> Self {
        timeline.keys
    }
}

impl Timeline {
    /// A timeline through these keys.
    ///
    /// # Errors
    /// No keys, a time that is not finite or beyond ±1e9 s, times that do not rise strictly, or invalid conditions.
    pub fn new(keys: Vec<Keyframe>) -> Result<Self, ConfigError> {
        if keys.is_empty() {
            return Err(ConfigError::Empty { field: "timeline" });
        }
        for (index, key) in keys.iter().enumerate() {
            key.validated()?;
            if index > 0 && key.time_s <= keys[index - 1].time_s {
                return Err(ConfigError::NotIncreasing {
                    field: "time_s",
                    index,
                    value: key.time_s,
                    previous: keys[index - 1].time_s,
                });
            }
        }
        Ok(Self { keys })
    }

    /// A timeline that never changes.
    ///
    /// # Errors
    /// When the conditions are invalid.
    pub fn constant(conditions: WeatherConditions) -> Result<Self, ConfigError> {
        Self::new(vec![Keyframe {
            time_s: 0.0,
            conditions,
            transition: Transition::Hold,
        }])
    }

    /// The keys, times rising strictly. Never empty.
    #[must_use]
    pub fn keys(&self) -> &[Keyframe] {
        &self.keys
    }

    /// The conditions at `time_s`. Error: 1e-12 of the largest value (500 mm/h, 40 °C).
    ///
    /// # Errors
    /// When `time_s` is not finite or beyond ±1e9 s.
    pub fn at(&self, time_s: f64) -> Result<WeatherConditions, ConfigError> {
        checked_time(time_s)?;
        let next = self.keys_until(time_s);
        if next == 0 {
            return Ok(self.keys[0].conditions);
        }
        let from = &self.keys[next - 1];
        match self.keys.get(next) {
            Some(to) if from.transition == Transition::Linear => {
                let t = (time_s - from.time_s) / (to.time_s - from.time_s);
                Ok(from.conditions.lerp(&to.conditions, t))
            }
            _ => Ok(from.conditions),
        }
    }

    /// Mean rain rate over [t0_s, t1_s], exactly (closed form of the linear pieces). Units: mm/h.
    /// For t0_s = t1_s the rate at that time. Error: 1e-9 relative (or of 1 mm/h) against sums of trapezia.
    ///
    /// # Errors
    /// When a time is not finite, beyond ±1e9 s, or t1_s < t0_s.
    pub fn mean_intensity_mm_h(&self, t0_s: f64, t1_s: f64) -> Result<f64, ConfigError> {
        if t0_s == t1_s {
            return Ok(self.at(t0_s)?.intensity_mm_h);
        }
        Ok(self.integral(t0_s, t1_s, |c| c.intensity_mm_h)? / (t1_s - t0_s))
    }

    /// ∫ wind dt over [t0_s, t1_s], exactly: how far the air went. Units: m. Error: 1e-8 m a second against sums of
    /// trapezia.
    ///
    /// # Errors
    /// When a time is not finite, beyond ±1e9 s, or t1_s < t0_s.
    pub fn wind_path_m(&self, t0_s: f64, t1_s: f64) -> Result<DVec3, ConfigError> {
        self.integral(t0_s, t1_s, |c| c.wind_m_s)
    }

    /// Mean of every field over [t0_s, t1_s], exactly; the drop-size family is that at the middle.
    /// For t0_s = t1_s the conditions at that time. Error: 1e-9 relative (or of 1 mm/h, 40 °C) against sums of trapezia.
    ///
    /// # Errors
    /// When a time is not finite, beyond ±1e9 s, or t1_s < t0_s.
    pub fn mean_conditions(&self, t0_s: f64, t1_s: f64) -> Result<WeatherConditions, ConfigError> {
        let middle = self.at(0.5 * (t0_s + t1_s))?;
        if t0_s == t1_s || self.is_constant(t0_s, t1_s) {
            return Ok(middle);
        }
        let mean = self.integral(t0_s, t1_s, ConditionValues::of)? * (1.0 / (t1_s - t0_s));
        Ok(mean.conditions(middle.distribution))
    }

    /// Whether the conditions are the same all over [t0_s, t1_s): no step strictly inside, no sloping piece.
    #[must_use]
    pub fn is_constant(&self, t0_s: f64, t1_s: f64) -> bool {
        let mut at_s = t0_s;
        loop {
            let index = self.keys_until(at_s);
            let Some(next) = self.keys.get(index) else { return true };
            let here = if index == 0 { next } else { &self.keys[index - 1] };
            let level = index == 0 || here.transition == Transition::Hold || here.conditions == next.conditions;
            if !level || (next.time_s < t1_s && here.conditions != next.conditions) {
                return false;
            }
            if next.time_s >= t1_s {
                return true;
            }
            at_s = next.time_s;
        }
    }

    /// The time of the first key strictly after `time_s`. Units: s.
    #[must_use]
    pub fn next_key_after(&self, time_s: f64) -> Option<f64> {
        self.keys.get(self.keys_until(time_s)).map(|key| key.time_s)
    }

    /// How many keys lie at or before `time_s`.
    fn keys_until(&self, time_s: f64) -> usize {
        self.keys.partition_point(|key| key.time_s <= time_s)
    }

    /// ∫ get(conditions) dt over [t0_s, t1_s], for a `get` that is linear in the conditions.
    fn integral<T>(&self, t0_s: f64, t1_s: f64, get: impl Fn(&WeatherConditions) -> T) -> Result<T, ConfigError>
    where
        T: Default + Copy + Add<Output = T> + Mul<f64, Output = T>,
    {
        checked_time(t0_s)?;
        checked_time(t1_s)?;
        if t1_s < t0_s {
            return Err(ConfigError::NotIncreasing {
                field: "time_s",
                index: 1,
                value: t1_s,
                previous: t0_s,
            });
        }
        let mut sum = T::default();
        let mut from_s = t0_s;
        let mut index = self.keys_until(t0_s);
        while from_s < t1_s {
            let next = self.keys.get(index);
            let to_s = next.map_or(t1_s, |key| key.time_s.min(t1_s));
            let length_s = to_s - from_s;
            sum = sum
                + match (index.checked_sub(1).map(|i| &self.keys[i]), next) {
                    (None, Some(first)) => get(&first.conditions) * length_s,
                    (Some(here), Some(next)) if here.transition == Transition::Linear => {
                        // The mean of a linear piece is its value in the middle.
                        let t = (0.5 * (from_s + to_s) - here.time_s) / (next.time_s - here.time_s);
                        (get(&here.conditions) * (1.0 - t) + get(&next.conditions) * t) * length_s
                    }
                    (Some(here), _) => get(&here.conditions) * length_s,
                    (None, None) => T::default(),
                };
            from_s = to_s;
            index += 1;
        }
        Ok(sum)
    }
}

fn checked_time(time_s: f64) -> Result<f64, ConfigError> {
    in_range("time_s", time_s, -MAX_TIME_S, MAX_TIME_S, "-1e9 to 1e9 s")
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn key(time_s: f64, intensity_mm_h: f64, transition: Transition) -> Keyframe {
        let conditions = WeatherConditions {
            intensity_mm_h,
            wind_m_s: DVec3::new(0.1 * intensity_mm_h, 0.0, -2.0),
            ..WeatherConditions::default()
        };
        Keyframe {
            time_s,
            conditions,
            transition,
        }
    }

    /// Ramp 0→10 over 10 s, hold 10 for 5 s, step to 4, ramp 4→0 over 8 s.
    fn storm() -> Timeline {
        use Transition::{Hold, Linear};
        Timeline::new(vec![
            key(0.0, 0.0, Linear),
            key(10.0, 10.0, Hold),
            key(15.0, 4.0, Linear),
            key(23.0, 0.0, Linear),
        ])
        .expect("valid")
    }

    #[test]
    fn values_on_between_and_outside_the_keys() {
        let t = storm();
        let rate = |s| t.at(s).expect("finite").intensity_mm_h;
        assert_eq!(rate(-5.0), 0.0);
        assert_eq!(rate(2.5), 2.5);
        assert_eq!(rate(10.0), 10.0);
        assert_eq!(rate(14.999), 10.0);
        assert_eq!(rate(15.0), 4.0);
        assert_eq!(rate(19.0), 2.0);
        assert_eq!(rate(1e6), 0.0);
    }

    #[test]
    fn means_are_the_areas_under_the_line() {
        let t = storm();
        // 50 (ramp) + 50 (hold) + 16 (fall), by hand.
        let total = t.mean_intensity_mm_h(0.0, 23.0).expect("valid") * 23.0;
        assert!((total - 116.0).abs() < 1e-12, "{total}");
        assert_eq!(t.mean_intensity_mm_h(-10.0, 0.0), Ok(0.0));
        assert_eq!(t.mean_intensity_mm_h(4.0, 6.0), Ok(5.0));
        assert_eq!(t.mean_intensity_mm_h(14.0, 16.0), Ok((10.0 + 3.75) / 2.0));
        assert_eq!(t.mean_intensity_mm_h(5.0, 5.0), Ok(5.0));
        assert_eq!(t.mean_intensity_mm_h(22.0, 24.0), Ok(0.125));
        let path = t.wind_path_m(0.0, 23.0).expect("valid");
        assert!((path - DVec3::new(11.6, 0.0, -46.0)).length() < 1e-12, "{path}");
        let mean = t.mean_conditions(4.0, 6.0).expect("valid");
        assert_eq!((mean.intensity_mm_h, mean.air_temperature_c), (5.0, 15.0));
    }

    #[test]
    fn constancy_is_found() {
        let t = storm();
        assert!(t.is_constant(-9.0, 0.0));
        assert!(!t.is_constant(-9.0, 0.1));
        assert!(t.is_constant(10.0, 15.0));
        assert!(!t.is_constant(10.0, 15.1));
        assert!(!t.is_constant(16.0, 17.0));
        assert!(t.is_constant(23.0, 1e6));
        let level = Timeline::new(vec![
            key(0.0, 3.0, Transition::Linear),
            key(5.0, 3.0, Transition::Linear),
        ]);
        assert!(level.expect("valid").is_constant(-1.0, 9.0));
        assert_eq!(t.next_key_after(0.0), Some(10.0));
        assert_eq!(t.next_key_after(-1.0), Some(0.0));
        assert_eq!(t.next_key_after(23.0), None);
    }

    #[test]
    fn bad_timelines_are_refused_with_the_reason() {
        let fails = |keys| Timeline::new(keys).expect_err("invalid").to_string();
        assert_eq!(fails(vec![]), "timeline is empty");
        let twice = vec![key(1.0, 0.0, Transition::Linear), key(1.0, 1.0, Transition::Linear)];
        assert_eq!(
            fails(twice),
            "time_s: entry 1 (1) does not come after the one before it (1)"
        );
        assert!(fails(vec![key(f64::NAN, 0.0, Transition::Linear)]).starts_with("time_s is NaN"));
        assert!(fails(vec![key(0.0, -1.0, Transition::Linear)]).starts_with("intensity_mm_h is -1"));
        let t = storm();
        assert!(t.at(f64::INFINITY).is_err());
        assert!(t.mean_intensity_mm_h(2.0, 1.0).is_err());
        assert!(t.wind_path_m(0.0, f64::NAN).is_err());
    }

    proptest! {
        #[test]
        fn the_closed_form_equals_a_fine_sum(
            steps in prop::collection::vec((0.1_f64..20.0, 0.0_f64..120.0, any::<bool>()), 1..12),
            a in -10.0_f64..150.0,
            length in 0.0_f64..100.0,
        ) {
            let mut time = 0.0;
            let mut keys = Vec::new();
            for (gap, rate, hold) in steps {
                time += gap;
                keys.push(key(time, rate, if hold { Transition::Hold } else { Transition::Linear }));
            }
            let t = Timeline::new(keys).expect("valid");
            let n = 20_000;
            let h = length / f64::from(n);
            let sum: f64 = (0..n).map(|i| t.at(a + (f64::from(i) + 0.5) * h).expect("valid").intensity_mm_h * h).sum();
            let exact = t.mean_intensity_mm_h(a, a + length).expect("valid") * length;
            // A step inside a cell of the sum costs at most half a cell of the largest rate, twelve times.
            prop_assert!((sum - exact).abs() <= 12.0 * 120.0 * h + 1e-9, "{sum} {exact}");
            // Additive over any split.
            let m = a + 0.37 * length;
            let parts = t.mean_intensity_mm_h(a, m).expect("valid") * (m - a)
                + t.mean_intensity_mm_h(m, a + length).expect("valid") * (a + length - m);
            prop_assert!((parts - exact).abs() <= 1e-9 * (1.0 + exact), "{parts} {exact}");
        }
    }
}
