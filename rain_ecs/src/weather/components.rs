//! What the user sets.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use rain_core::error::{ConfigError, in_range};
use rain_core::rainfall::Distribution;
use rain_core::weather::{ArtistSettings, Keyframe, RainTypes, Timeline, Transition, WeatherConditions, WeatherPreset};
use serde::{Deserialize, Serialize};

use super::state::WeatherState;

/// The weather, uniform over the world. Edit it at any time; the next tick takes it.
///
/// A value outside its domain is reported by [`crate::RainConfigError`], and the last good weather stays in force.
#[derive(Component, Reflect, Debug, Clone, Copy, PartialEq)]
#[reflect(Component, Debug, Clone, PartialEq, Default)]
#[require(WeatherMode, WeatherState)]
pub struct Weather {
    /// Rain rate. Units: mm/h. Domain: [0, 500]. Default: 0.
    pub intensity_mm_h: f64,
    /// Where the air goes. Units: m/s. Domain: length ≤ 80. Default: 0.
    pub wind_m_s: Vec3,
    /// Air temperature. Units: °C. Domain: [−60, 60]. Default: 15.
    pub air_temperature_c: f64,
    /// Relative humidity. Units: none. Domain: [0, 1]. Default: 0.7.
    pub relative_humidity: f64,
    /// Air pressure. Units: Pa. Domain: [30000, 110000]. Default: 101325.
    pub pressure_pa: f64,
    /// Net radiation that the ground receives. Units: W/m². Domain: [−300, 1400]. Default: 150.
    pub net_radiation_w_m2: f64,
    /// Family of drop sizes. Default: Marshall–Palmer.
    #[reflect(ignore)]
    pub distribution: Distribution,
}

impl Default for Weather {
    fn default() -> Self {
        WeatherConditions::default().into()
    }
}

impl Weather {
    /// Ready-made weather.
    #[must_use]
    pub fn preset(preset: WeatherPreset) -> Self {
        preset.conditions().into()
    }

    /// The default weather with this rain rate in mm/h (checked by the next tick, as any edit is).
    #[must_use]
    pub fn rain(intensity_mm_h: f64) -> Self {
        Self {
            intensity_mm_h,
            ..Self::default()
        }
    }

    /// The same numbers as the core's conditions, not yet checked.
    #[must_use]
    pub fn conditions(&self) -> WeatherConditions {
        WeatherConditions {
            intensity_mm_h: self.intensity_mm_h,
            wind_m_s: self.wind_m_s.as_dvec3(),
            air_temperature_c: self.air_temperature_c,
            relative_humidity: self.relative_humidity,
            pressure_pa: self.pressure_pa,
            net_radiation_w_m2: self.net_radiation_w_m2,
            distribution: self.distribution,
        }
    }
}

impl From<WeatherConditions> for Weather {
    fn from(c: WeatherConditions) -> Self {
        Self {
            intensity_mm_h: c.intensity_mm_h,
            wind_m_s: c.wind_m_s.as_vec3(),
            air_temperature_c: c.air_temperature_c,
            relative_humidity: c.relative_humidity,
            pressure_pa: c.pressure_pa,
            net_radiation_w_m2: c.net_radiation_w_m2,
            distribution: c.distribution,
        }
    }
}

/// Drives the [`Weather`] of its entity: each tick uses the timeline's exact means and leaves the value at the tick's
/// end in `Weather`, where edits have no effect until the timeline is removed.
#[derive(Component, Reflect, Debug, Clone, PartialEq)]
#[reflect(opaque)]
#[reflect(Component, Debug, Clone, PartialEq)]
#[require(Weather)]
pub struct WeatherTimeline {
    /// The course of the weather.
    pub timeline: Timeline,
    /// Time on the rain clock at which the timeline's zero lies. Units: s. Domain: ±5e8. Default: 0.
    pub start_s: f64,
}

impl WeatherTimeline {
    /// A timeline whose zero is the rain clock's.
    #[must_use]
    pub fn new(timeline: Timeline) -> Self {
        Self { timeline, start_s: 0.0 }
    }

    /// From one weather to another, evenly over `over_s` from `start_s` on the rain clock on. Units: s.
    ///
    /// # Errors
    /// When a weather or a time is outside its domain, or `over_s` is not above 0.
    pub fn blend(from: &Weather, to: &Weather, start_s: f64, over_s: f64) -> Result<Self, ConfigError> {
        let key = |time_s: f64, weather: &Weather| Keyframe {
            time_s,
            conditions: weather.conditions(),
            transition: Transition::Linear,
        };
        let timeline = Timeline::new(vec![key(0.0, from), key(over_s, to)])?;
        Ok(Self { timeline, start_s })
    }
}

/// Which of the two ways gives [`WeatherState::wetness`] and [`WeatherState::water_level_mm`]. Both are always
/// computed, so that switching does not jump to a dry start.
#[derive(Component, Reflect, Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[reflect(Component, Debug, Clone, PartialEq, Default)]
pub enum WeatherMode {
    /// Water in mm per surface class, from physics.
    #[default]
    Physical,
    /// Levels in [0, 1] with rates and targets per intensity.
    Artist,
}

/// Settings of the artists' levels; without it [`ArtistSettings::default`] holds. Checked like [`Weather`].
#[derive(Component, Reflect, Debug, Clone, Copy, PartialEq, Default)]
#[reflect(opaque)]
#[reflect(Component, Debug, Clone, PartialEq, Default)]
#[require(Weather)]
pub struct ArtistControls(pub ArtistSettings);

/// The artists' speeds come from a table of rain types by the rain's intensity: rows may be changed and added. It writes
/// the rising speeds of [`ArtistControls`]; the rest of them stays.
#[derive(Component, Reflect, Debug, Clone, PartialEq, Default)]
#[reflect(opaque)]
#[reflect(Component, Debug, Clone, PartialEq, Default)]
#[require(ArtistControls)]
pub struct RainTypeTable(pub RainTypes);

/// Wetness and water level set by hand, in place of what the weather has made of them: what surfaces show and what
/// [`crate::RainQueries`] answers. The water itself goes on underneath and is there again when this is taken away.
///
/// Checked like [`Weather`]: what lies outside its domain is reported, and the last good values stay in force.
#[derive(Component, Reflect, Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[reflect(Component, Debug, Clone, PartialEq, Default)]
#[require(Weather)]
pub struct WaterByHand {
    /// Wetness of everything that rain reaches: 0 dry, 1 soaked. Units: none. Domain: [0, 1]. `None`: the weather's.
    pub wetness: Option<f64>,
    /// How full puddles, holes and the film of open ground are: 0 none, 1 about to spill; the film is then
    /// [`ArtistSettings::full_level_mm`]. Units: none. Domain: [0, 1]. `None`: the weather's.
    pub water_level: Option<f64>,
    /// How full holes and cracks are, apart from puddles: the first of Lagarde's two flood levels (E25). Units: none.
    /// Domain: [0, 1]. `None`: as `water_level` says.
    #[serde(default)]
    pub hole_level: Option<f64>,
}

impl WaterByHand {
    /// These values, if they lie in their domains.
    ///
    /// # Errors
    /// Names the first that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range("wetness", self.wetness.unwrap_or(0.0), 0.0, 1.0, "0 to 1")?;
        in_range("water_level", self.water_level.unwrap_or(0.0), 0.0, 1.0, "0 to 1")?;
        in_range("hole_level", self.hole_level.unwrap_or(0.0), 0.0, 1.0, "0 to 1")?;
        Ok(self)
    }

    /// Whether anything is set.
    #[must_use]
    pub fn is_set(&self) -> bool {
        self.wetness.is_some() || self.water_level.is_some() || self.hole_level.is_some()
    }
}
