//! The state of the air and the rain at one moment.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::constants::SEA_LEVEL_PRESSURE_PA;
use crate::error::{ConfigError, in_range};
use crate::rainfall::{Distribution, MAX_INTENSITY_MM_H};

/// The weather at one moment, uniform in space.
///
/// The fields are plain numbers; whatever keeps them in a state calls [`WeatherConditions::validated`] first.
/// Deserialising validates, fills missing fields from [`WeatherConditions::default`] and refuses unknown ones.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "RawConditions")]
pub struct WeatherConditions {
    /// Rain rate on a horizontal plane. Units: mm/h. Domain: [0, 500]. Default: 0.
    pub intensity_mm_h: f64,
    /// Where the air goes. Units: m/s. Domain: length ≤ 80. Default: 0.
    pub wind_m_s: DVec3,
    /// Air temperature at 2 m. Units: °C. Domain: [−60, 60]. Default: 15.
    pub air_temperature_c: f64,
    /// Relative humidity. Units: none. Domain: [0, 1]. Default: 0.7.
    pub relative_humidity: f64,
    /// Air pressure. Units: Pa. Domain: [30000, 110000]. Default: 101325.
    pub pressure_pa: f64,
    /// Net radiation that the ground receives, negative on clear nights. Units: W/m². Domain: [−300, 1400]. Default:
    /// 150.
    pub net_radiation_w_m2: f64,
    /// Family of drop sizes. Default: Marshall–Palmer.
    pub distribution: Distribution,
}

impl Default for WeatherConditions {
    fn default() -> Self {
        Self {
            intensity_mm_h: 0.0,
            wind_m_s: DVec3::ZERO,
            air_temperature_c: 15.0,
            relative_humidity: 0.7,
            pressure_pa: SEA_LEVEL_PRESSURE_PA,
            net_radiation_w_m2: 150.0,
            distribution: Distribution::MarshallPalmer,
        }
    }
}

impl WeatherConditions {
    /// The default conditions with this rain rate.
    ///
    /// # Errors
    /// When `intensity_mm_h` is not finite or outside [0, 500].
    pub fn with_intensity(intensity_mm_h: f64) -> Result<Self, ConfigError> {
        Self {
            intensity_mm_h,
            ..Self::default()
        }
        .validated()
    }

    /// These conditions, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field, in the order of declaration, that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range(
            "intensity_mm_h",
            self.intensity_mm_h,
            0.0,
            MAX_INTENSITY_MM_H,
            "0 to 500 mm/h",
        )?;
        let [x, y, z] = self.wind_m_s.to_array();
        for component in [x, y, z] {
            in_range("wind_m_s", component, -80.0, 80.0, "a vector of length at most 80 m/s")?;
        }
        in_range(
            "wind_m_s",
            self.wind_m_s.length(),
            0.0,
            80.0,
            "a vector of length at most 80 m/s",
        )?;
        in_range("air_temperature_c", self.air_temperature_c, -60.0, 60.0, "-60 to 60 °C")?;
        in_range("relative_humidity", self.relative_humidity, 0.0, 1.0, "0 to 1")?;
        in_range(
            "pressure_pa",
            self.pressure_pa,
            30_000.0,
            110_000.0,
            "30000 to 110000 Pa",
        )?;
        in_range(
            "net_radiation_w_m2",
            self.net_radiation_w_m2,
            -300.0,
            1400.0,
            "-300 to 1400 W/m²",
        )?;
        Ok(self)
    }

    /// Linear blend from `self` (t = 0) to `other` (t = 1); t outside [0, 1] is clamped, NaN counts as 0.
    ///
    /// The drop-size family cannot be blended by name: it is that of the nearer end.
    #[must_use]
    pub fn lerp(&self, other: &Self, t: f64) -> Self {
        let t = if t > 0.0 { t.min(1.0) } else { 0.0 };
        let mix = ConditionValues::of(self) * (1.0 - t) + ConditionValues::of(other) * t;
        mix.conditions(if t < 0.5 { self.distribution } else { other.distribution })
    }
}

/// The numbers of [`WeatherConditions`] as a vector, so that blends and means treat all fields alike.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ConditionValues([f64; 8]);

impl ConditionValues {
    pub(super) fn of(c: &WeatherConditions) -> Self {
        let [x, y, z] = c.wind_m_s.to_array();
        Self([
            c.intensity_mm_h,
            x,
            y,
            z,
            c.air_temperature_c,
            c.relative_humidity,
            c.pressure_pa,
            c.net_radiation_w_m2,
        ])
    }

    pub(super) fn conditions(self, distribution: Distribution) -> WeatherConditions {
        let [
            intensity_mm_h,
            x,
            y,
            z,
            air_temperature_c,
            relative_humidity,
            pressure_pa,
            net_radiation_w_m2,
        ] = self.0;
        // Blends and means lie between valid values, but for rounding: without the clamps the mean of a spell of 100 %
        // humidity may be refused. A length is only known to a last bit, so the wind stays as far below its bound.
        WeatherConditions {
            intensity_mm_h: intensity_mm_h.clamp(0.0, MAX_INTENSITY_MM_H),
            wind_m_s: DVec3::new(x, y, z).clamp_length_max(80.0 * (1.0 - 4.0 * f64::EPSILON)),
            air_temperature_c: air_temperature_c.clamp(-60.0, 60.0),
            relative_humidity: relative_humidity.clamp(0.0, 1.0),
            pressure_pa: pressure_pa.clamp(30_000.0, 110_000.0),
            net_radiation_w_m2: net_radiation_w_m2.clamp(-300.0, 1400.0),
            distribution,
        }
    }
}

impl std::ops::Add for ConditionValues {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl std::ops::Mul<f64> for ConditionValues {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self(self.0.map(|v| v * factor))
    }
}

/// [`WeatherConditions`] as written in a file, before validation.
#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
struct RawConditions {
    intensity_mm_h: f64,
    wind_m_s: DVec3,
    air_temperature_c: f64,
    relative_humidity: f64,
    pressure_pa: f64,
    net_radiation_w_m2: f64,
    distribution: Distribution,
}

impl Default for RawConditions {
    fn default() -> Self {
        let d = WeatherConditions::default();
        Self {
            intensity_mm_h: d.intensity_mm_h,
            wind_m_s: d.wind_m_s,
            air_temperature_c: d.air_temperature_c,
            relative_humidity: d.relative_humidity,
            pressure_pa: d.pressure_pa,
            net_radiation_w_m2: d.net_radiation_w_m2,
            distribution: d.distribution,
        }
    }
}

impl TryFrom<RawConditions> for WeatherConditions {
    type Error = ConfigError;
    fn try_from(raw: RawConditions) -> Result<Self, ConfigError> {
        Self {
            intensity_mm_h: raw.intensity_mm_h,
            wind_m_s: raw.wind_m_s,
            air_temperature_c: raw.air_temperature_c,
            relative_humidity: raw.relative_humidity,
            pressure_pa: raw.pressure_pa,
            net_radiation_w_m2: raw.net_radiation_w_m2,
            distribution: raw.distribution,
        }
        .validated()
    }
}

#[cfg(test)]
mod tests {
    use serde::de::IntoDeserializer;
    use serde::de::value::{Error, MapDeserializer};

    use super::*;

    fn parse(fields: &[(&'static str, f64)]) -> Result<WeatherConditions, Error> {
        let map: MapDeserializer<'_, _, Error> = MapDeserializer::new(fields.iter().copied());
        WeatherConditions::deserialize(map.into_deserializer())
    }

    #[test]
    fn each_field_is_checked_and_named() {
        type Set = fn(&mut WeatherConditions, f64);
        let fields: [(&str, Set, f64, f64); 6] = [
            ("intensity_mm_h", |c, v| c.intensity_mm_h = v, 0.0, 500.0),
            ("wind_m_s", |c, v| c.wind_m_s.z = v, -80.0, 80.0),
            ("air_temperature_c", |c, v| c.air_temperature_c = v, -60.0, 60.0),
            ("relative_humidity", |c, v| c.relative_humidity = v, 0.0, 1.0),
            ("pressure_pa", |c, v| c.pressure_pa = v, 30_000.0, 110_000.0),
            ("net_radiation_w_m2", |c, v| c.net_radiation_w_m2 = v, -300.0, 1400.0),
        ];
        for (name, set, min, max) in fields {
            for good in [min, 0.5 * (min + max), max] {
                let mut c = WeatherConditions::default();
                set(&mut c, good);
                assert!(c.validated().is_ok(), "{name} = {good}");
            }
            let margin = 1e-6 * (max - min);
            for bad in [min - margin, max + margin, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let mut c = WeatherConditions::default();
                set(&mut c, bad);
                let message = c.validated().expect_err("out of the domain").to_string();
                assert!(message.starts_with(name), "{message}");
            }
        }
        let slanted = WeatherConditions {
            wind_m_s: DVec3::new(60.0, 0.0, 60.0),
            ..WeatherConditions::default()
        };
        assert!(slanted.validated().is_err(), "the length counts, not the components");
    }

    #[test]
    fn lerp_meets_both_ends_and_the_middle() {
        let a = WeatherConditions::default();
        let b = WeatherConditions {
            intensity_mm_h: 20.0,
            wind_m_s: DVec3::new(4.0, 0.0, -2.0),
            air_temperature_c: 5.0,
            relative_humidity: 0.9,
            pressure_pa: 99_000.0,
            net_radiation_w_m2: 50.0,
            distribution: Distribution::Thunderstorm,
        };
        assert_eq!(a.lerp(&b, 0.0), a);
        assert_eq!(a.lerp(&b, f64::NAN), a);
        assert_eq!(a.lerp(&b, 1.0), b);
        assert_eq!(a.lerp(&b, 7.0), b);
        let mid = a.lerp(&b, 0.5);
        assert_eq!(mid.intensity_mm_h, 10.0);
        assert_eq!(mid.wind_m_s, DVec3::new(2.0, 0.0, -1.0));
        assert_eq!(mid.air_temperature_c, 10.0);
        assert!((mid.relative_humidity - 0.8).abs() < 1e-15);
        assert_eq!(mid.net_radiation_w_m2, 100.0);
        assert_eq!(mid.distribution, Distribution::Thunderstorm);
        assert_eq!(a.lerp(&b, 0.49).distribution, Distribution::MarshallPalmer);
    }

    #[test]
    fn blends_and_means_of_extremes_stay_valid() {
        use super::super::timeline::{Keyframe, Timeline, Transition};
        let extreme = |wind: DVec3, high: bool| WeatherConditions {
            intensity_mm_h: if high { 500.0 } else { 0.0 },
            wind_m_s: wind,
            air_temperature_c: if high { 60.0 } else { -60.0 },
            relative_humidity: if high { 1.0 } else { 0.0 },
            pressure_pa: if high { 110_000.0 } else { 30_000.0 },
            net_radiation_w_m2: if high { 1400.0 } else { -300.0 },
            distribution: Distribution::MarshallPalmer,
        };
        let mut checked = 0;
        for wind in [
            DVec3::X * 80.0,
            DVec3::new(48.0, 0.0, -64.0),
            DVec3::splat(80.0 / 3_f64.sqrt() - 1e-13),
        ] {
            for high in [false, true] {
                let c = extreme(wind, high);
                // The rain rises, so that the spell is not constant and the rest is averaged.
                let other = WeatherConditions {
                    intensity_mm_h: 250.0,
                    ..c
                };
                let key = |time_s, conditions| Keyframe {
                    time_s,
                    conditions,
                    transition: Transition::Linear,
                };
                let timeline = Timeline::new(vec![key(0.0, c), key(7.3, other)]).expect("valid");
                for i in 1..400 {
                    let t = f64::from(i) * 0.0173;
                    assert!(c.lerp(&c, t / 7.0).validated().is_ok(), "{c:?} {t}");
                    let mean = timeline.mean_conditions(0.3 * t, t).expect("times in the domain");
                    assert!(mean.validated().is_ok(), "{mean:?} {t}");
                    checked += 1;
                }
            }
        }
        assert!(checked > 2000);
    }

    #[test]
    fn deserialising_fills_validates_and_refuses_unknown_fields() {
        let c = parse(&[("intensity_mm_h", 12.0), ("relative_humidity", 0.9)]).expect("valid");
        assert_eq!(
            c,
            WeatherConditions {
                intensity_mm_h: 12.0,
                relative_humidity: 0.9,
                ..Default::default()
            }
        );
        let out = parse(&[("relative_humidity", 90.0)]).expect_err("percent").to_string();
        assert_eq!(out, "relative_humidity is 90, allowed: 0 to 1");
        let unknown = parse(&[("rain", 1.0)]).expect_err("unknown").to_string();
        assert!(unknown.contains("rain"), "{unknown}");
    }
}
