//! What the weather has done.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use rain_core::error::{ConfigError, in_range};
use rain_core::weather::{ArtistState, SurfaceClass, SurfaceColumn, WeatherConditions, WeatherSurfaces};

use serde::{Deserialize, Serialize};

use super::components::{WaterByHand, WeatherMode};
use crate::state_hash::{HashState, StateHasher};

/// The weather in force and the state of open ground under it, after the last tick. Written by the weather systems
/// alone.
#[derive(Component, Reflect, Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[reflect(opaque)]
#[reflect(Component, Debug, Clone, Default)]
pub struct WeatherState {
    pub(super) conditions: WeatherConditions,
    pub(super) last_good: WeatherConditions,
    pub(super) surfaces: WeatherSurfaces,
    pub(super) mode: WeatherMode,
    /// Set, not simulated: a snapshot has it with what else the user set.
    #[serde(skip)]
    pub(crate) by_hand: WaterByHand,
    pub(super) timeline_refused: bool,
    /// Wetness and water level of each class before the last tick.
    pub(super) before: [[f64; 2]; SurfaceClass::COUNT],
}

impl WeatherState {
    /// The mean conditions over the last tick: what acted on the ground, and what moved the air.
    #[must_use]
    pub fn conditions(&self) -> &WeatherConditions {
        &self.conditions
    }

    /// The mode in force in the last tick.
    #[must_use]
    pub fn mode(&self) -> WeatherMode {
        self.mode
    }

    /// What is set by hand, as the last tick took it.
    #[must_use]
    pub fn by_hand(&self) -> &WaterByHand {
        &self.by_hand
    }

    /// Wetness of a class, as set by hand or by the mode in force: pore water / capacity, or the artists' wet level.
    /// Units: none. Domain: [0, 1].
    #[must_use]
    pub fn wetness(&self, class: SurfaceClass) -> f64 {
        if let Some(wetness) = self.by_hand.wetness {
            return wetness;
        }
        match self.mode {
            WeatherMode::Physical => self.surfaces.wetness(class),
            WeatherMode::Artist => self.surfaces.artist().wetness,
        }
    }

    /// Mean film of a class outside basins, as set by hand or by the mode in force: water on the surface, or the artists'
    /// puddle level times the depth it stands for. Units: mm.
    #[must_use]
    pub fn water_level_mm(&self, class: SurfaceClass) -> f64 {
        if let Some(level) = self.by_hand.water_level {
            return level * self.surfaces.artist_settings().full_level_mm;
        }
        match self.mode {
            WeatherMode::Physical => self.surfaces.water_level_mm(class),
            WeatherMode::Artist => self.surfaces.artist().puddles * self.surfaces.artist_settings().full_level_mm,
        }
    }

    /// [`WeatherState::wetness`] between the last two ticks, at [`crate::RainClock::interpolation`].
    #[must_use]
    pub fn wetness_at(&self, class: SurfaceClass, interpolation: f32) -> f64 {
        mix(self.before[class.index()][0], self.wetness(class), interpolation)
    }

    /// [`WeatherState::water_level_mm`] between the last two ticks, at [`crate::RainClock::interpolation`].
    #[must_use]
    pub fn water_level_mm_at(&self, class: SurfaceClass, interpolation: f32) -> f64 {
        mix(self.before[class.index()][1], self.water_level_mm(class), interpolation)
    }

    /// The water of a class (the physical way).
    #[must_use]
    pub fn column(&self, class: SurfaceClass) -> &SurfaceColumn {
        self.surfaces.column(class)
    }

    /// All classes with their properties.
    #[must_use]
    pub fn surfaces(&self) -> &WeatherSurfaces {
        &self.surfaces
    }

    /// The artists' levels, as the weather drives them.
    #[must_use]
    pub fn artist(&self) -> &ArtistState {
        self.surfaces.artist()
    }

    /// The artists' levels that are shown: what is set by hand over what the weather drives.
    #[must_use]
    pub fn shown_levels(&self) -> ArtistState {
        let mut levels = *self.surfaces.artist();
        levels.wetness = self.by_hand.wetness.unwrap_or(levels.wetness);
        levels.holes = (self.by_hand.hole_level)
            .or(self.by_hand.water_level)
            .unwrap_or(levels.holes);
        levels.puddles = self.by_hand.water_level.unwrap_or(levels.puddles);
        levels
    }

    /// Penman's potential evaporation, negative for dew (which wets nothing). Units: mm/h.
    #[must_use]
    pub fn evaporation_mm_h(&self) -> f64 {
        self.surfaces.evaporation_mm_h()
    }

    /// Rain since the start. Units: mm.
    #[must_use]
    pub fn rain_mm(&self) -> f64 {
        self.surfaces.rain_mm()
    }

    /// Whether it does not rain and nothing is wet, by the mode in force and by hand: what lets a scene without rain areas
    /// skip all rain work.
    #[must_use]
    pub fn is_dry_and_settled(&self) -> bool {
        let WaterByHand {
            wetness,
            water_level,
            hole_level,
        } = self.by_hand;
        self.conditions.intensity_mm_h == 0.0
            && wetness.unwrap_or(0.0) == 0.0
            && water_level.unwrap_or(0.0) == 0.0
            && hole_level.unwrap_or(0.0) == 0.0
            && match self.mode {
                WeatherMode::Physical => self.surfaces.ground_is_dry(),
                WeatherMode::Artist => self.surfaces.artist().is_dry(),
            }
    }

    /// This state, if it can have come about: after it was read from outside.
    pub(crate) fn validated(self) -> Result<Self, ConfigError> {
        for [wetness, level_mm] in self.before {
            in_range("wetness before the last tick", wetness, 0.0, 1.0, "0 to 1")?;
            in_range("level before the last tick", level_mm, 0.0, 1e12, "0 to 1e12 mm")?;
        }
        Ok(Self {
            conditions: self.conditions.validated()?,
            last_good: self.last_good.validated()?,
            surfaces: self.surfaces.validated()?,
            ..self
        })
    }

    /// Remembers the levels that the coming tick starts from.
    pub(super) fn keep_before(&mut self) {
        self.before = SurfaceClass::ALL.map(|class| [self.wetness(class), self.water_level_mm(class)]);
    }
}

fn mix(before: f64, now: f64, interpolation: f32) -> f64 {
    before + (now - before) * f64::from(interpolation.clamp(0.0, 1.0))
}

impl HashState for WeatherState {
    fn hash_state(&self, hasher: &mut StateHasher) {
        for c in [&self.conditions, &self.last_good] {
            let [x, y, z] = c.wind_m_s.to_array();
            for value in [
                c.intensity_mm_h,
                x,
                y,
                z,
                c.air_temperature_c,
                c.relative_humidity,
                c.pressure_pa,
                c.net_radiation_w_m2,
            ] {
                hasher.f64(value);
            }
            hasher.u64(c.distribution as u64);
        }
        hasher.u64(self.mode as u64);
        if self.by_hand.is_set() {
            for value in [self.by_hand.wetness, self.by_hand.water_level] {
                hasher.f64(value.unwrap_or(-1.0));
            }
            if let Some(level) = self.by_hand.hole_level {
                hasher.f64(level);
            }
        }
        self.surfaces.for_each_state_bits(|bits| hasher.u64(bits));
    }
}
