//! Wetness and water levels that are played back.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use rain_core::error::{ConfigError, in_range};
use serde::{Deserialize, Serialize};

use super::components::WaterByHand;
use super::systems::ActiveWeather;
use crate::clock::RainClock;
use crate::error::RainConfigError;

/// Levels at a time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelKey {
    /// When. Units: s. Domain: [0, 2 592 000].
    pub time_s: f64,
    /// The levels then; what is `None` here or in the next key is not set between the two.
    pub levels: WaterByHand,
}

/// Levels over time, straight between keys, held before the first and after the last, or played again and again: the
/// table of levels that Lagarde's demonstration animates (Lagarde 2013, E96).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelCurve {
    keys: Vec<LevelKey>,
    period_s: Option<f64>,
}

impl LevelCurve {
    /// A curve through `keys`, whose times rise strictly; with `period_s` it starts over after so long. Units: s.
    ///
    /// # Errors
    /// When there is no key, times do not rise, a level or time is outside its domain, or the period is not above 0 or ends
    /// before the last key.
    pub fn new(keys: Vec<LevelKey>, period_s: Option<f64>) -> Result<Self, ConfigError> {
        Self { keys, period_s }.validated()
    }

    /// This curve, if it could have been made by [`LevelCurve::new`].
    pub(crate) fn validated(self) -> Result<Self, ConfigError> {
        let Some(last) = self.keys.last() else {
            return Err(ConfigError::Empty { field: "keys" });
        };
        for (index, key) in self.keys.iter().enumerate() {
            let value = in_range("time_s", key.time_s, 0.0, 2_592_000.0, "0 to 2592000 s")?;
            key.levels.validated()?;
            if index > 0 && value <= self.keys[index - 1].time_s {
                return Err(ConfigError::NotIncreasing {
                    field: "time_s",
                    index,
                    value,
                    previous: self.keys[index - 1].time_s,
                });
            }
        }
        if let Some(period_s) = self.period_s {
            in_range(
                "period_s",
                period_s,
                f64::MIN_POSITIVE,
                2_592_000.0,
                "above 0 to 2592000 s",
            )?;
            in_range(
                "period_s",
                period_s,
                last.time_s,
                2_592_000.0,
                "not before the last key",
            )?;
        }
        Ok(self)
    }

    /// The levels at a time, which may be any finite number. Units: s.
    #[must_use]
    pub fn at(&self, time_s: f64) -> WaterByHand {
        let time_s = self.period_s.map_or(time_s, |period_s| time_s.rem_euclid(period_s));
        let next = self.keys.partition_point(|key| key.time_s <= time_s);
        let (Some(from), to) = (self.keys.get(next.saturating_sub(1)), self.keys.get(next)) else {
            return WaterByHand::default();
        };
        let Some(to) = to.filter(|_| next > 0) else {
            return from.levels;
        };
        let share = (time_s - from.time_s) / (to.time_s - from.time_s);
        let mix = |a: Option<f64>, b: Option<f64>| Some(a? + (b? - a?) * share);
        WaterByHand {
            wetness: mix(from.levels.wetness, to.levels.wetness),
            water_level: mix(from.levels.water_level, to.levels.water_level),
            hole_level: mix(from.levels.hole_level, to.levels.hole_level),
        }
    }
}

/// Plays levels back: each tick leaves the curve's value in the [`WaterByHand`] of its entity, where edits have no
/// effect. Taking it away, or `playing` off, leaves the levels to be set by hand; taking [`WaterByHand`] away as well
/// gives them back to the weather.
#[derive(Component, Reflect, Debug, Clone, PartialEq)]
#[reflect(opaque)]
#[reflect(Component, Debug, Clone, PartialEq)]
#[require(WaterByHand)]
pub struct LevelTimeline {
    /// The levels.
    pub curve: LevelCurve,
    /// Time on the rain clock at which the curve's zero lies. Units: s. Domain: ±5e8. Default: 0.
    pub start_s: f64,
    /// Whether it plays. Default: true.
    pub playing: bool,
}

impl LevelTimeline {
    /// Plays a curve whose zero is the rain clock's.
    #[must_use]
    pub fn new(curve: LevelCurve) -> Self {
        Self {
            curve,
            start_s: 0.0,
            playing: true,
        }
    }
}

/// Sets what the timeline of the weather in force says for the end of this tick.
pub(super) fn play_levels(
    clock: Res<RainClock>,
    active: Res<ActiveWeather>,
    mut timelines: Query<(Ref<LevelTimeline>, &mut WaterByHand)>,
    mut errors: MessageWriter<RainConfigError>,
) {
    let Some((timeline, mut by_hand)) = active.entity().and_then(|entity| timelines.get_mut(entity).ok()) else {
        return;
    };
    if !timeline.playing {
        return;
    }
    match in_range("start_s", timeline.start_s, -5e8, 5e8, "-5e8 to 5e8 s") {
        Ok(_) => {
            by_hand.set_if_neq(timeline.curve.at(clock.now_s() - timeline.start_s));
        }
        Err(error) if timeline.is_changed() => {
            if let Some(entity) = active.entity() {
                errors.write(RainConfigError { entity, error });
            }
        }
        Err(_) => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(time_s: f64, wetness: f64, water_level: Option<f64>) -> LevelKey {
        LevelKey {
            time_s,
            levels: WaterByHand {
                wetness: Some(wetness),
                water_level,
                hole_level: None,
            },
        }
    }

    #[test]
    fn levels_run_straight_between_keys_and_start_over() {
        let keys = vec![
            key(10.0, 0.0, None),
            key(20.0, 1.0, Some(0.5)),
            key(40.0, 0.5, Some(0.0)),
        ];
        let once = LevelCurve::new(keys.clone(), None).expect("valid");
        for (time_s, wetness, water_level) in [
            (-5.0, 0.0, None),
            (10.0, 0.0, None),
            (15.0, 0.5, None),
            (20.0, 1.0, Some(0.5)),
            (30.0, 0.75, Some(0.25)),
            (40.0, 0.5, Some(0.0)),
            (99.0, 0.5, Some(0.0)),
        ] {
            let levels = once.at(time_s);
            assert_eq!(
                (levels.wetness, levels.water_level),
                (Some(wetness), water_level),
                "at {time_s} s"
            );
            assert_eq!(levels.hole_level, None);
        }
        let again = LevelCurve::new(keys, Some(60.0)).expect("valid");
        for time_s in [0.0, 12.5, 20.0, 33.0, 59.0] {
            assert_eq!(again.at(time_s + 120.0), once.at(time_s), "at {time_s} s");
            assert_eq!(again.at(time_s - 60.0), once.at(time_s), "at {time_s} s");
        }
    }

    #[test]
    fn a_wrong_curve_is_refused_by_name() {
        let good = || vec![key(0.0, 0.0, None), key(20.0, 1.0, None)];
        let refused = |keys, period_s| LevelCurve::new(keys, period_s).expect_err("refused").to_string();
        assert!(refused(vec![], None).contains("keys"));
        assert!(refused(vec![key(1.0, 0.0, None), key(1.0, 0.0, None)], None).contains("time_s"));
        assert!(refused(vec![key(f64::NAN, 0.0, None)], None).contains("time_s"));
        assert!(refused(vec![key(0.0, 1.5, None)], None).contains("wetness"));
        assert!(refused(vec![key(0.0, 1.0, Some(f64::INFINITY))], None).contains("water_level"));
        assert!(refused(good(), Some(19.0)).contains("period_s"));
        assert!(refused(good(), Some(0.0)).contains("period_s"));
        assert!(LevelCurve::new(good(), Some(20.0)).is_ok());
    }
}
