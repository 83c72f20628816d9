//! Named conditions and the intensity classes they come from.

use std::str::FromStr;

use glam::DVec3;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::conditions::WeatherConditions;
use crate::rainfall::Distribution;

/// Intensity class by rain rate (Barani 2020 after Kelkar 1945, table 4.1 of the traffic-rain thesis).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum IntensityClass {
    /// No rain.
    None,
    /// Up to 2.5 mm/h.
    Light,
    /// Above 2.5 and up to 7.5 mm/h. The table says "2.6 to 7.5"; the gap below 2.6 is closed here.
    Moderate,
    /// Above 7.5 mm/h.
    Heavy,
}

impl IntensityClass {
    /// The class of a rain rate in mm/h. Zero, negative and NaN are [`IntensityClass::None`].
    #[must_use]
    pub fn of(intensity_mm_h: f64) -> Self {
        if intensity_mm_h > 7.5 {
            Self::Heavy
        } else if intensity_mm_h > 2.5 {
            Self::Moderate
        } else if intensity_mm_h > 0.0 {
            Self::Light
        } else {
            Self::None
        }
    }
}

/// Ready-made weather, from dry to cloudburst.
///
/// Rates: light, moderate and heavy are the representative 2, 5 and 10 mm/h of the thesis' table 4.2; the finer classes
/// around them (its C18) are chosen: drizzle 0.5, downpour 50 and cloudburst 100 mm/h. Wind, temperature, humidity and
/// radiation are plausible mid-latitude daytime values, chosen, not measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WeatherPreset {
    /// No rain, a sunny spell, light wind.
    #[default]
    Dry,
    /// 0.5 mm/h in small drops, nearly saturated air.
    Drizzle,
    /// 2 mm/h of widespread rain.
    LightRain,
    /// 5 mm/h of widespread rain.
    ModerateRain,
    /// 10 mm/h.
    HeavyRain,
    /// 50 mm/h from a thunderstorm.
    Downpour,
    /// 100 mm/h from a thunderstorm, gale.
    Cloudburst,
}

impl WeatherPreset {
    /// All presets in rising order of rain rate.
    pub const ALL: [Self; 7] = [
        Self::Dry,
        Self::Drizzle,
        Self::LightRain,
        Self::ModerateRain,
        Self::HeavyRain,
        Self::Downpour,
        Self::Cloudburst,
    ];

    /// The name that [`FromStr`] reads, in snake case.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Dry => "dry",
            Self::Drizzle => "drizzle",
            Self::LightRain => "light_rain",
            Self::ModerateRain => "moderate_rain",
            Self::HeavyRain => "heavy_rain",
            Self::Downpour => "downpour",
            Self::Cloudburst => "cloudburst",
        }
    }

    /// The conditions that the preset stands for.
    #[must_use]
    pub fn conditions(self) -> WeatherConditions {
        // rate mm/h, wind x and z m/s, temperature °C, humidity, net radiation W/m², drop sizes
        let (intensity_mm_h, wind_x, wind_z, air_temperature_c, relative_humidity, net_radiation_w_m2, distribution) =
            match self {
                Self::Dry => (0.0, 2.0, 0.0, 18.0, 0.60, 250.0, Distribution::MarshallPalmer),
                Self::Drizzle => (0.5, 1.5, 0.5, 12.0, 0.92, 60.0, Distribution::Drizzle),
                Self::LightRain => (2.0, 3.0, 0.5, 12.0, 0.88, 70.0, Distribution::Widespread),
                Self::ModerateRain => (5.0, 4.0, 1.0, 12.0, 0.92, 40.0, Distribution::Widespread),
                Self::HeavyRain => (10.0, 6.0, 1.5, 13.0, 0.94, 20.0, Distribution::MarshallPalmer),
                Self::Downpour => (50.0, 8.0, 2.0, 17.0, 0.95, 10.0, Distribution::Thunderstorm),
                Self::Cloudburst => (100.0, 14.0, 4.0, 19.0, 0.96, 0.0, Distribution::Thunderstorm),
            };
        WeatherConditions {
            intensity_mm_h,
            wind_m_s: DVec3::new(wind_x, 0.0, wind_z),
            air_temperature_c,
            relative_humidity,
            net_radiation_w_m2,
            distribution,
            ..WeatherConditions::default()
        }
    }
}

/// A preset name that does not exist.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "weather preset {name:?} is unknown, allowed: dry, drizzle, light_rain, moderate_rain, heavy_rain, downpour, \
     cloudburst"
)]
pub struct UnknownPreset {
    /// What was given.
    pub name: String,
}

impl FromStr for WeatherPreset {
    type Err = UnknownPreset;

    /// Upper and lower case, spaces, `-` and `_` count the same: `Light rain`, `light-rain`, `light_rain`.
    fn from_str(text: &str) -> Result<Self, UnknownPreset> {
        let key = text.trim().to_ascii_lowercase().replace([' ', '-'], "_");
        Self::ALL
            .into_iter()
            .find(|preset| preset.name() == key)
            .ok_or_else(|| UnknownPreset { name: text.to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_are_valid_rise_and_parse_back() {
        let mut last = -1.0;
        for preset in WeatherPreset::ALL {
            let conditions = preset.conditions().validated().expect("in the domain");
            assert!(conditions.intensity_mm_h > last);
            last = conditions.intensity_mm_h;
            assert_eq!(preset.name().parse::<WeatherPreset>(), Ok(preset));
        }
        assert_eq!(" Light-Rain ".parse::<WeatherPreset>(), Ok(WeatherPreset::LightRain));
        let error = "hail".parse::<WeatherPreset>().expect_err("unknown").to_string();
        assert!(error.starts_with("weather preset \"hail\" is unknown"), "{error}");
        for preset in WeatherPreset::ALL {
            assert!(error.contains(preset.name()), "{error}");
        }
    }

    #[test]
    fn presets_fall_in_the_class_they_are_named_after() {
        let class = |preset: WeatherPreset| IntensityClass::of(preset.conditions().intensity_mm_h);
        assert_eq!(class(WeatherPreset::Dry), IntensityClass::None);
        assert_eq!(class(WeatherPreset::Drizzle), IntensityClass::Light);
        assert_eq!(class(WeatherPreset::LightRain), IntensityClass::Light);
        assert_eq!(class(WeatherPreset::ModerateRain), IntensityClass::Moderate);
        for heavy in [
            WeatherPreset::HeavyRain,
            WeatherPreset::Downpour,
            WeatherPreset::Cloudburst,
        ] {
            assert_eq!(class(heavy), IntensityClass::Heavy);
        }
    }

    #[test]
    fn class_borders_are_those_of_the_table() {
        assert_eq!(IntensityClass::of(2.5), IntensityClass::Light);
        assert_eq!(IntensityClass::of(2.6), IntensityClass::Moderate);
        assert_eq!(IntensityClass::of(7.5), IntensityClass::Moderate);
        assert_eq!(IntensityClass::of(7.6), IntensityClass::Heavy);
        assert_eq!(IntensityClass::of(f64::NAN), IntensityClass::None);
        assert_eq!(IntensityClass::of(-1.0), IntensityClass::None);
    }
}
