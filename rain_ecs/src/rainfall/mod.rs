//! The drop field's state: what falls, how fast each size class moves, and how far it has moved.

pub mod areas;

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_math::DVec3;
use rain_core::rainfall::terminal_velocity::air_density_kg_m3;
use rain_core::rainfall::{Distribution, FieldMotion, Spectrum};
use rain_core::weather::{GustModel, WeatherConditions};
use serde::{Deserialize, Serialize};

use crate::clock::RainClock;
use crate::schedule::{RainSystems, RainTick};
use crate::snapshot::{RainfallPart, SnapshotAppExt};
use crate::state_hash::{HashState, StateHashAppExt, StateHasher};
use crate::weather::{ActiveWeather, GustState, WeatherState};
use areas::RainAreas;

/// What falls, everywhere: areas change only the intensity. Its spectrum is that of the heaviest rain anywhere, which
/// without areas is the weather's.
#[derive(Resource, Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RainfallField {
    motion: FieldMotion,
    spectrum: Spectrum,
    distribution: Distribution,
    mean_inverse_velocity_s_m: f64,
    wind_m_s: DVec3,
    #[serde(default)]
    mean_wind_m_s: Option<DVec3>,
}

impl Default for RainfallField {
    fn default() -> Self {
        let distribution = Distribution::MarshallPalmer;
        let spectrum = Spectrum {
            intensity_mm_h: 0.0,
            n0_per_m3_mm: 0.0,
            slope_per_mm: 4.1,
        };
        Self {
            motion: FieldMotion::default(),
            spectrum,
            distribution,
            mean_inverse_velocity_s_m: spectrum.mean_inverse_velocity(),
            wind_m_s: DVec3::ZERO,
            mean_wind_m_s: None,
        }
    }
}

impl RainfallField {
    /// Whether anything falls.
    #[must_use]
    pub fn is_raining(&self) -> bool {
        self.spectrum.intensity_mm_h > 0.0
    }

    /// The family of spectra in force.
    #[must_use]
    pub fn distribution(&self) -> Distribution {
        self.distribution
    }

    /// The drop-size distribution at a rain rate (units: mm/h; held in [0, 500]).
    #[must_use]
    pub fn spectrum_at(&self, intensity_mm_h: f64) -> Spectrum {
        let held = if intensity_mm_h > 0.0 {
            intensity_mm_h.min(500.0)
        } else {
            0.0
        };
        if held == self.spectrum.intensity_mm_h {
            return self.spectrum;
        }
        Spectrum::new(self.distribution, held).unwrap_or(self.spectrum)
    }

    /// The drop-size distribution of the heaviest rain anywhere.
    #[must_use]
    pub fn spectrum(&self) -> &Spectrum {
        &self.spectrum
    }

    /// Where the air goes, gusts included: the mean of the last tick. Units: m/s.
    #[must_use]
    pub fn wind_m_s(&self) -> DVec3 {
        self.wind_m_s
    }

    /// The same without gusts: what maps of cover are drawn for, which cannot follow each gust. Units: m/s.
    #[must_use]
    pub fn mean_wind_m_s(&self) -> DVec3 {
        self.mean_wind_m_s.unwrap_or(self.wind_m_s)
    }

    /// Flux mean of 1/v. Units: s/m.
    #[must_use]
    pub fn mean_inverse_velocity_s_m(&self) -> f64 {
        self.mean_inverse_velocity_s_m
    }

    /// The class frames as they stood at the last tick.
    #[must_use]
    pub fn motion(&self) -> &FieldMotion {
        &self.motion
    }

    /// The class frames `seconds` after the last tick: what a frame between ticks shows.
    #[must_use]
    pub fn motion_after(&self, seconds: f64) -> FieldMotion {
        self.motion.after(seconds)
    }

    /// Whether these numbers can have come about: of a field that was read from outside.
    pub(crate) fn is_sound(&self) -> bool {
        let finite = |v: &DVec3, most: f64| v.is_finite() && v.abs().max_element() <= most;
        let s = &self.spectrum;
        self.motion.offset_m.iter().all(|v| finite(v, 1e12))
            && self.motion.velocity_m_s.iter().all(|v| finite(v, 400.0))
            && finite(&self.wind_m_s, 400.0)
            && self.mean_wind_m_s.is_none_or(|wind| finite(&wind, 80.0))
            && (0.0..=500.0).contains(&s.intensity_mm_h)
            && (0.0..1e9).contains(&s.n0_per_m3_mm)
            && (0.1..1e3).contains(&s.slope_per_mm)
            && (0.01..=10.0).contains(&self.mean_inverse_velocity_s_m)
    }

    /// Takes over the weather of this tick and moves on by its length.
    fn tick(&mut self, conditions: &WeatherConditions, gusts: Option<&GustModel>, highest_mm_h: f64, at: Tick) {
        if highest_mm_h != self.spectrum.intensity_mm_h || conditions.distribution != self.distribution {
            // The conditions have been validated before they became state.
            if let Ok(spectrum) = Spectrum::new(conditions.distribution, highest_mm_h) {
                self.spectrum = spectrum;
                self.distribution = conditions.distribution;
                // Dry air keeps the last slant: nothing falls that it could matter to.
                if spectrum.intensity_mm_h > 0.0 {
                    self.mean_inverse_velocity_s_m = spectrum.mean_inverse_velocity();
                }
            }
        }
        self.wind_m_s = conditions.wind_m_s;
        // Dry: vapour thins the air by at most 1 % and speeds drops by at most 0.5 %.
        let density = air_density_kg_m3(conditions.pressure_pa, conditions.air_temperature_c, 0.0);
        self.motion.set_velocity(self.wind_m_s, density);
        self.mean_wind_m_s = gusts.map(|_| conditions.wind_m_s);
        let Some(gusts) = gusts else {
            self.motion.advance(at.seconds);
            return;
        };
        let wind = conditions.wind_m_s;
        let steady = self.motion.velocity_m_s;
        let blow = |motion: &mut FieldMotion, from_s: f64, to_s: f64| {
            for (velocity, steady) in motion.velocity_m_s.iter_mut().zip(&steady) {
                let share = gusts.mean(from_s, to_s, -steady.y + wind.y);
                *velocity = *steady + GustModel::gusty(wind, share) - wind;
            }
        };
        let now_s = at.end_s;
        blow(&mut self.motion, now_s - at.seconds, now_s);
        self.motion.advance(at.seconds);
        self.wind_m_s = GustModel::gusty(wind, gusts.mean(now_s - at.seconds, now_s, 0.0));
        // Frames go on with the coming tick's mean: they meet it where it ends.
        blow(&mut self.motion, now_s, now_s + at.coming_s);
    }
}

/// When a tick is.
#[derive(Debug, Clone, Copy)]
struct Tick {
    /// Its end. Units: s.
    end_s: f64,
    /// Its length. Units: s.
    seconds: f64,
    /// That of the next. Units: s.
    coming_s: f64,
}

impl HashState for RainfallField {
    fn hash_state(&self, hasher: &mut StateHasher) {
        for offset in &self.motion.offset_m {
            for value in offset.to_array() {
                hasher.f64(value);
            }
        }
        hasher.f64(self.spectrum.intensity_mm_h);
    }
}

/// Advances the drop field with the weather.
pub struct RainfallFieldPlugin;

impl Plugin for RainfallFieldPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<RainfallField>()
            .hash_with("rainfall", |world, hasher| {
                if let Some(field) = world.get_resource::<RainfallField>() {
                    field.hash_state(hasher);
                }
                if let Some(areas) = world.get_resource::<RainAreas>() {
                    areas.hash_state(hasher);
                }
            })
            .snapshot_part::<RainfallPart>("rainfall")
            .add_systems(RainTick, advance_field.in_set(RainSystems::Rainfall));
    }
}

fn advance_field(
    mut field: ResMut<RainfallField>,
    clock: Res<RainClock>,
    active: Res<ActiveWeather>,
    weather: Query<&WeatherState>,
    areas: Option<Res<RainAreas>>,
    gusts: Option<Res<GustState>>,
) {
    let state = active.entity().and_then(|entity| weather.get(entity).ok());
    let conditions = state.map_or_else(WeatherConditions::default, |s| *s.conditions());
    let highest_mm_h = areas.map_or(conditions.intensity_mm_h, |areas| areas.highest_mm_h());
    let at = Tick {
        end_s: clock.now_s(),
        seconds: clock.current_tick_s(),
        coming_s: clock.tick_ns() as f64 * 1e-9,
    };
    let gusts = gusts.as_ref().and_then(|gusts| gusts.model());
    field.tick(&conditions, gusts, highest_mm_h, at);
}
