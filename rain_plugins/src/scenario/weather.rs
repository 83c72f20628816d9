//! The scenario's weather: keys in the file, a CSV table or a preset, made into one [`Timeline`].

use std::path::Path;

use rain_core::error::ConfigError;
use rain_core::rainfall::Distribution;
use rain_core::weather::{Keyframe, Timeline, Transition, WeatherConditions, WeatherPreset, read_hyetograph};
use rain_ecs::prelude::{GustSettings, LevelCurve, LevelKey, LightningSettings, WaterByHand};
use serde::{Deserialize, Serialize};

use super::error::ScenarioError;
use super::file::{Scenario, Vector};

/// Longest accepted list of keys.
pub const MAX_KEYS: usize = 100_000;

/// Weather over time: `keys`, or `csv`, or `preset`, one of them. With none it stays as `base`, which is dry by default.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Weather {
    /// Keys in the file itself, strictly rising in time. Domain: at most 100 000. Default: none.
    pub keys: Vec<WeatherKey>,
    /// CSV table relative to the scenario, as [`read_hyetograph`] reads it: a header with `time_s,intensity_mm_h` and, as
    /// wanted, `wind_x_m_s`, `wind_z_m_s`, `air_temperature_c`, `relative_humidity`. Default: none.
    pub csv: Option<String>,
    /// Ready-made steady weather: `dry`, `drizzle`, `light_rain`, `moderate_rain`, `heavy_rain`, `downpour`,
    /// `cloudburst`. Default: none.
    pub preset: Option<WeatherPreset>,
    /// What neither keys nor table state. Units, domains and defaults: those of [`WeatherConditions`].
    pub base: WeatherConditions,
    /// What happens between keys or rows: `linear` or `hold`, as in a hyetograph of bars. Default: `linear`.
    pub transition: Transition,
    /// Which model turns rain into wetness and water. Default: `Physical`.
    pub mode: WeatherMode,
    /// Wetness set by hand, in place of the weather's. Units: none. Domain: [0, 1]. Default: none.
    pub wetness: Option<f64>,
    /// How full puddles are, set by hand, in place of the weather's. Units: none. Domain: [0, 1]. Default: none.
    pub water_level: Option<f64>,
    /// How full holes and cracks are, set by hand; else as `water_level`. Units: none. Domain: [0, 1]. Default: none.
    pub hole_level: Option<f64>,
    /// Levels played back, in place of those set by hand. Default: none.
    pub levels: Option<Levels>,
    /// Swings of the wind about its mean. Units, domains and defaults: those of [`GustSettings`]. Default: none.
    pub gusts: Option<GustSettings>,
    /// Lightning, seen and lit by. Units, domains and defaults: those of [`LightningSettings`]. Default: none.
    pub lightning: Option<LightningSettings>,
}

/// Levels over time, straight between keys; they act in either mode.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Levels {
    /// Keys, strictly rising in time. Domain: 1 to 100 000.
    pub keys: Vec<LevelsAt>,
    /// After how long they start over. Units: s. Domain: not before the last key. Default: never.
    pub period_s: Option<f64>,
}

/// Levels at a time; what a key leaves out is the weather's from there to the next that states it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LevelsAt {
    /// When. Units: s. Domain: [0, 2 592 000]. Default: 0.
    pub time_s: f64,
    /// Wetness. Units: none. Domain: [0, 1].
    pub wetness: Option<f64>,
    /// How full puddles are. Units: none. Domain: [0, 1].
    pub water_level: Option<f64>,
    /// How full holes and cracks are; else as `water_level`. Units: none. Domain: [0, 1].
    pub hole_level: Option<f64>,
}

/// Which model turns rain into wetness and water levels.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum WeatherMode {
    /// Pores, film and evaporation in physical units. The default.
    #[default]
    Physical,
    /// Levels that rise and fall at rates an artist chose.
    Artist,
}

/// Weather at a time. What a key leaves out is taken from the keys around it that state it: between two of them as
/// `transition` says, before the first and after the last as there; when no key states it, from `base`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct WeatherKey {
    /// When. Units: s. Domain: [0, 2 592 000]. Default: 0.
    pub time_s: f64,
    /// Rain rate on level open ground. Units: mm/h. Domain: [0, 500].
    pub intensity_mm_h: Option<f64>,
    /// Where the air goes. Units: m/s. Domain: length ≤ 80.
    pub wind_m_s: Option<Vector>,
    /// Air temperature. Units: °C. Domain: [-60, 60].
    pub air_temperature_c: Option<f64>,
    /// Relative humidity. Units: none. Domain: [0, 1].
    pub relative_humidity: Option<f64>,
    /// Air pressure. Units: Pa. Domain: [30 000, 110 000].
    pub pressure_pa: Option<f64>,
    /// Net radiation on the ground. Units: W/m². Domain: [-300, 1400].
    pub net_radiation_w_m2: Option<f64>,
    /// Family of drop sizes; it holds until a key states another. One of `marshall_palmer`, `drizzle`, `widespread`,
    /// `thunderstorm`.
    pub distribution: Option<Distribution>,
}

impl WeatherKey {
    /// The stated values over `base`.
    fn over(&self, base: &WeatherConditions) -> WeatherConditions {
        WeatherConditions {
            intensity_mm_h: self.intensity_mm_h.unwrap_or(base.intensity_mm_h),
            wind_m_s: self.wind_m_s.map_or(base.wind_m_s, Into::into),
            air_temperature_c: self.air_temperature_c.unwrap_or(base.air_temperature_c),
            relative_humidity: self.relative_humidity.unwrap_or(base.relative_humidity),
            pressure_pa: self.pressure_pa.unwrap_or(base.pressure_pa),
            net_radiation_w_m2: self.net_radiation_w_m2.unwrap_or(base.net_radiation_w_m2),
            distribution: self.distribution.unwrap_or(base.distribution),
        }
    }

    /// Field, value and allowed range of the first thing wrong with this key.
    pub(super) fn check(
        &self,
        before: Option<&Self>,
        base: &WeatherConditions,
    ) -> Result<(), (&'static str, f64, String)> {
        if !(0.0..=2_592_000.0).contains(&self.time_s) {
            return Err(("time_s", self.time_s, "0 to 2592000 s".into()));
        }
        if let Some(before) = before
            && self.time_s <= before.time_s
        {
            return Err((
                "time_s",
                self.time_s,
                format!("later than the key before it ({} s)", before.time_s),
            ));
        }
        match self.over(base).validated() {
            Err(ConfigError::OutOfRange { field, value, allowed }) => Err((field, value, allowed.into())),
            Err(other) => Err(("time_s", self.time_s, other.to_string())),
            Ok(_) => Ok(()),
        }
    }
}

impl LevelsAt {
    pub(super) fn core(&self) -> LevelKey {
        LevelKey {
            time_s: self.time_s,
            levels: WaterByHand {
                wetness: self.wetness,
                water_level: self.water_level,
                hole_level: self.hole_level,
            },
        }
    }
}

impl Weather {
    /// The levels to play back.
    ///
    /// # Errors
    /// What is wrong with them, which validation reports with the field.
    pub fn level_curve(&self) -> Result<Option<LevelCurve>, ConfigError> {
        let Some(levels) = &self.levels else { return Ok(None) };
        LevelCurve::new(levels.keys.iter().map(LevelsAt::core).collect(), levels.period_s).map(Some)
    }

    /// The weather as a timeline: keys filled, the preset taken, or the table read from `folder`.
    ///
    /// # Errors
    /// When the table cannot be read or is wrong, with its line; when keys or `base` are out of their domains, which
    /// validation reports with the field.
    pub fn timeline(&self, folder: &Path) -> Result<Timeline, ScenarioError> {
        if let Some(csv) = &self.csv {
            let path = folder.join(csv);
            let file = std::fs::File::open(&path).map_err(|e| ScenarioError::Io {
                file: path.clone(),
                message: e.to_string(),
            })?;
            let table = read_hyetograph(file, &self.base).map_err(|e| ScenarioError::Csv {
                file: path.clone(),
                line: e.line,
                message: format!("column {}: {}", e.column, e.problem),
            })?;
            let keys = table
                .keys()
                .iter()
                .map(|key| Keyframe {
                    transition: self.transition,
                    ..*key
                })
                .collect();
            return Timeline::new(keys).map_err(|e| ScenarioError::Io {
                file: path,
                message: e.to_string(),
            });
        }
        let wrong = |e: ConfigError| ScenarioError::Io {
            file: folder.to_path_buf(),
            message: e.to_string(),
        };
        match self.preset {
            Some(preset) => Timeline::constant(preset.conditions()).map_err(wrong),
            None if self.keys.is_empty() => Timeline::constant(self.base).map_err(wrong),
            None => Timeline::new(fill(&self.keys, &self.base, self.transition)).map_err(wrong),
        }
    }
}

/// Fills what keys leave out; see [`WeatherKey`].
fn fill(keys: &[WeatherKey], base: &WeatherConditions, transition: Transition) -> Vec<Keyframe> {
    let column = |get: &dyn Fn(&WeatherKey) -> Option<f64>| -> Vec<Option<f64>> {
        let stated: Vec<(f64, f64)> = keys.iter().filter_map(|k| Some((k.time_s, get(k)?))).collect();
        let mut next = 0;
        keys.iter()
            .map(|key| {
                while next < stated.len() && stated[next].0 <= key.time_s {
                    next += 1;
                }
                match (next.checked_sub(1).map(|i| stated[i]), stated.get(next)) {
                    (None, after) => after.map(|a| a.1),
                    (Some(before), Some(after)) if transition == Transition::Linear => {
                        let share = (key.time_s - before.0) / (after.0 - before.0);
                        Some(before.1 + (after.1 - before.1) * share)
                    }
                    (Some(before), _) => Some(before.1),
                }
            })
            .collect()
    };
    let intensity = column(&|k| k.intensity_mm_h);
    let wind = [0, 1, 2].map(|axis| column(&|k| k.wind_m_s.map(|w| w[axis])));
    let temperature = column(&|k| k.air_temperature_c);
    let humidity = column(&|k| k.relative_humidity);
    let pressure = column(&|k| k.pressure_pa);
    let radiation = column(&|k| k.net_radiation_w_m2);
    let mut distribution = keys.iter().find_map(|k| k.distribution);
    keys.iter()
        .enumerate()
        .map(|(i, key)| {
            distribution = key.distribution.or(distribution);
            let filled = WeatherKey {
                time_s: key.time_s,
                intensity_mm_h: intensity[i],
                wind_m_s: wind[0][i].zip(wind[1][i]).zip(wind[2][i]).map(|((x, y), z)| [x, y, z]),
                air_temperature_c: temperature[i],
                relative_humidity: humidity[i],
                pressure_pa: pressure[i],
                net_radiation_w_m2: radiation[i],
                distribution,
            };
            Keyframe {
                time_s: key.time_s,
                conditions: filled.over(base),
                transition,
            }
        })
        .collect()
}

/// The scenario's weather as a timeline.
///
/// # Errors
/// As [`Weather::timeline`].
pub fn core_timeline(scenario: &Scenario) -> Result<Timeline, ScenarioError> {
    scenario.weather.timeline(&scenario.folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_are_filled_from_both_sides() {
        let key = |time_s, rate: Option<f64>, temperature: Option<f64>| WeatherKey {
            time_s,
            intensity_mm_h: rate,
            air_temperature_c: temperature,
            ..WeatherKey::default()
        };
        let mut keys = vec![
            key(0.0, Some(2.0), None),
            key(10.0, None, Some(10.0)),
            key(30.0, None, None),
            key(40.0, Some(10.0), Some(4.0)),
            key(50.0, None, None),
        ];
        keys[2].distribution = Some(Distribution::Thunderstorm);
        keys[1].wind_m_s = Some([1.0, 2.0, 3.0]);
        let base = WeatherConditions {
            relative_humidity: 0.55,
            ..WeatherConditions::default()
        };
        let mut weather = Weather {
            keys,
            base,
            ..Weather::default()
        };
        let timeline = weather.timeline(Path::new("")).unwrap();
        let of = |get: &dyn Fn(&WeatherConditions) -> f64| -> Vec<f64> {
            timeline.keys().iter().map(|k| get(&k.conditions)).collect()
        };
        assert_eq!(of(&|c| c.intensity_mm_h), [2.0, 4.0, 8.0, 10.0, 10.0]);
        assert_eq!(of(&|c| c.air_temperature_c), [10.0, 10.0, 6.0, 4.0, 4.0]);
        assert_eq!(of(&|c| c.relative_humidity), [0.55; 5]);
        assert_eq!(of(&|c| c.wind_m_s.y), [2.0; 5]);
        assert_eq!(timeline.keys()[4].conditions.distribution, Distribution::Thunderstorm);
        assert_eq!(timeline.at(5.0).unwrap().intensity_mm_h, 3.0);
        weather.transition = Transition::Hold;
        let held = weather.timeline(Path::new("")).unwrap();
        assert_eq!(held.keys()[2].conditions.intensity_mm_h, 2.0);
        assert_eq!(held.at(39.0).unwrap().intensity_mm_h, 2.0);
    }

    #[test]
    fn presets_and_base() {
        for preset in WeatherPreset::ALL {
            let weather = Weather {
                preset: Some(preset),
                ..Weather::default()
            };
            assert_eq!(
                weather.timeline(Path::new("")).unwrap().at(99.0).unwrap(),
                preset.conditions()
            );
        }
        let base = WeatherConditions {
            intensity_mm_h: 7.0,
            ..WeatherConditions::default()
        };
        let weather = Weather {
            base,
            ..Weather::default()
        };
        assert_eq!(weather.timeline(Path::new("")).unwrap().at(99.0).unwrap(), base);
    }
}
