//! What gameplay asks of the rain, on the CPU and without a renderer.

use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_math::DVec3;
use rain_core::haze::{
    EXTINCTION_EFFICIENCY, KOSCHMIEDER_CONTRAST, MAX_VISIBILITY_M, extinction_per_m, transmittance, visibility_m,
};
use rain_core::surface::SurfaceState;
use rain_core::surface::ground::{GroundLayer, WaterAt};
use rain_core::weather::{SurfaceClass, SurfaceProperties};
use rain_core::wheels::{GroundWater, Tyre, ground_friction};

use crate::cover::CoverField;
use crate::rainfall::RainfallField;
use crate::rainfall::areas::RainAreas;
use crate::surface::SurfaceGround;
use crate::weather::{ActiveWeather, WeatherState};

/// A pool of this depth splashes underfoot. Units: m.
const SPLASHING_M: f64 = 0.003;

/// How wet a surface sounds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum SoundWetness {
    /// No water.
    #[default]
    Dry,
    /// Water in the pores alone.
    Damp,
    /// A film.
    Wet,
    /// A pool of 3 mm and more.
    Puddle,
}

/// What a footstep or a wheel sounds like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct SurfaceSound {
    /// How wet.
    pub wetness: SoundWetness,
    /// On what.
    pub class: SurfaceClass,
}

/// Questions about the rain, for any system.
///
/// Places are world coordinates in m; where a place is on a surface the cell's water counts, as the last tick left it.
/// Off the ground's map, between floors and where no ground is built, a place counts as open ground of class asphalt if
/// it is exposed, else as dry. A place that is not finite is dry, not exposed, and on asphalt. Nothing is allocated.
#[derive(SystemParam)]
pub struct RainQueries<'w, 's> {
    surface: Option<Res<'w, SurfaceGround>>,
    cover: Option<Res<'w, CoverField>>,
    field: Option<Res<'w, RainfallField>>,
    areas: Option<Res<'w, RainAreas>>,
    active: Option<Res<'w, ActiveWeather>>,
    weather: Query<'w, 's, &'static WeatherState>,
}

impl RainQueries<'_, '_> {
    fn weather(&self) -> Option<&WeatherState> {
        self.weather.get(self.active.as_ref()?.entity()?).ok()
    }

    /// The water at a place, all of it at once.
    #[must_use]
    pub fn water_at(&self, place: impl Into<DVec3>) -> WaterAt {
        let place = place.into();
        if !place.is_finite() {
            return WaterAt::default();
        }
        let ground = self.surface.as_ref().and_then(|surface| surface.ground());
        if let Some(ground) = ground {
            let level = self.weather().and_then(|weather| weather.by_hand().water_level);
            let water = level.map_or_else(|| ground.water_at(place), |level| ground.water_at_filled(place, level));
            if water.layer != GroundLayer::Neither {
                return self.with_hand(water, place);
            }
        }
        match self.weather() {
            Some(weather) if self.exposed_at(place) > 0.5 => WaterAt {
                film_mm: weather.water_level_mm(SurfaceClass::Asphalt),
                saturation: weather.wetness(SurfaceClass::Asphalt),
                ..WaterAt::default()
            },
            _ => WaterAt::default(),
        }
    }

    /// The water of a surface with what is set by hand: where the rain reaches it, as the picture has it.
    fn with_hand(&self, water: WaterAt, place: DVec3) -> WaterAt {
        let Some(weather) = self.weather().filter(|weather| weather.by_hand().is_set()) else {
            return water;
        };
        let exposure = f64::from(self.exposed_at(place));
        let by_hand = weather.by_hand();
        WaterAt {
            saturation: by_hand.wetness.map_or(water.saturation, |wetness| wetness * exposure),
            film_mm: match by_hand.water_level {
                Some(_) if water.puddle_m > 0.0 => 0.0,
                Some(_) => weather.water_level_mm(water.class) * exposure,
                None => water.film_mm,
            },
            ..water
        }
    }

    /// Pore water / pore capacity; 1 under a pool. Units: none. Domain: [0, 1].
    #[must_use]
    pub fn wetness_at(&self, place: impl Into<DVec3>) -> f64 {
        let water = self.water_at(place);
        if water.puddle_m > 0.0 { 1.0 } else { water.saturation }
    }

    /// Depth of film and pool. Units: m.
    #[must_use]
    pub fn water_depth_at(&self, place: impl Into<DVec3>) -> f64 {
        let water = self.water_at(place);
        water.puddle_m + water.film_mm * 1e-3
    }

    /// Share of the rain that reaches a place. Units: none. Domain: [0, 1]; 1 = open sky, also without a cover map. On
    /// the ground it is what the cell's water knows (to 1/510), elsewhere the cover map is asked.
    #[must_use]
    pub fn exposed_at(&self, place: impl Into<DVec3>) -> f32 {
        let place = place.into();
        if !place.is_finite() {
            return 0.0;
        }
        let known = self.surface.as_ref().filter(|surface| surface.is_exposure_known());
        if let Some(ground) = known.and_then(|surface| surface.ground())
            && let Some(share) = ground.exposure_at(place)
        {
            return share;
        }
        self.cover.as_ref().map_or(1.0, |cover| cover.exposed_at(place))
    }

    /// Coefficient of friction of a tyre ([`Tyre::default`]) at a place and speed (m/s, either way; what is not a number
    /// counts as 0): falls with film and texture, on standing water with speed. Units: none. In [0.01, 1].
    #[must_use]
    pub fn friction_at(&self, place: impl Into<DVec3>, speed_m_s: f64) -> f64 {
        self.friction_of(&Tyre::default(), place, speed_m_s)
    }

    /// [`RainQueries::friction_at`] of a given tyre.
    #[must_use]
    pub fn friction_of(&self, tyre: &Tyre, place: impl Into<DVec3>, speed_m_s: f64) -> f64 {
        let water = self.water_at(place);
        let texture_mm = self.with_properties(water.class, |p| p.texture_depth_mm);
        let water_mm = GroundWater {
            saturation: water.saturation,
            // A pool stands over the texture.
            film_mm: water.film_mm + if water.puddle_m > 0.0 { texture_mm } else { 0.0 } + water.puddle_m * 1e3,
            texture_mm,
        };
        ground_friction(water.class, &water_mm, tyre, speed_m_s)
    }

    /// What a step at a place sounds like.
    #[must_use]
    pub fn surface_sound_at(&self, place: impl Into<DVec3>) -> SurfaceSound {
        let water = self.water_at(place);
        let texture_mm = self.with_properties(water.class, |p| p.texture_depth_mm);
        let wetness = if water.puddle_m >= SPLASHING_M {
            SoundWetness::Puddle
        } else if water.puddle_m > 0.0 {
            SoundWetness::Wet
        } else {
            match SurfaceState::of(water.saturation, water.film_mm, texture_mm) {
                SurfaceState::Dry => SoundWetness::Dry,
                SurfaceState::Wet => SoundWetness::Damp,
                SurfaceState::Drenched | SurfaceState::Puddle => SoundWetness::Wet,
            }
        };
        SurfaceSound {
            wetness,
            class: water.class,
        }
    }

    /// Rain rate in the open at a place, rain areas included; times [`RainQueries::exposed_at`] it is what reaches the
    /// place. Units: mm/h. In [0, 500].
    #[must_use]
    pub fn rain_at(&self, place: impl Into<DVec3>) -> f64 {
        let place = place.into();
        match (&self.areas, self.weather()) {
            _ if !place.is_finite() => 0.0,
            (Some(areas), _) => areas.rate_at(place),
            (None, Some(weather)) => weather.conditions().intensity_mm_h,
            (None, None) => 0.0,
        }
    }

    /// How far something dark can be told from the horizon through the rain outside all areas (Koschmieder). Units: m.
    /// 1e9 when dry.
    #[must_use]
    pub fn visibility_m(&self) -> f64 {
        let rate = self.areas.as_ref().filter(|areas| !areas.is_uniform());
        self.visibility_in(rate.map(|areas| areas.outside_mm_h()))
    }

    /// [`RainQueries::visibility_m`] in rain as it falls at a place.
    #[must_use]
    pub fn visibility_at(&self, place: impl Into<DVec3>) -> f64 {
        self.visibility_in(Some(self.rain_at(place)))
    }

    /// In rain of this rate, or of the field's.
    fn visibility_in(&self, rate_mm_h: Option<f64>) -> f64 {
        self.field.as_ref().map_or(MAX_VISIBILITY_M, |field| {
            let spectrum = rate_mm_h.map_or(*field.spectrum(), |rate| field.spectrum_at(rate));
            visibility_m(extinction_per_m(&spectrum, EXTINCTION_EFFICIENCY), KOSCHMIEDER_CONTRAST)
        })
    }

    /// Share of the light that passes through the rain between two places, areas counted along the way. Units: none. In
    /// [0, 1]; 1 for places that are not finite.
    #[must_use]
    pub fn seen_through(&self, from: impl Into<DVec3>, to: impl Into<DVec3>) -> f64 {
        let (from, to) = (from.into(), to.into());
        let Some(field) = &self.field else { return 1.0 };
        if !(from.is_finite() && to.is_finite()) {
            return 1.0;
        }
        let of = |rate: f64| extinction_per_m(&field.spectrum_at(rate), EXTINCTION_EFFICIENCY);
        let depth = match &self.areas {
            Some(areas) if !areas.is_uniform() => areas.field().along(from, to, areas.weather_mm_h(), of),
            _ => extinction_per_m(field.spectrum(), EXTINCTION_EFFICIENCY) * from.distance(to),
        };
        transmittance(depth)
    }

    fn with_properties(&self, class: SurfaceClass, of: impl Fn(&SurfaceProperties) -> f64) -> f64 {
        match (
            self.surface.as_ref().and_then(|surface| surface.ground()),
            self.weather(),
        ) {
            (Some(ground), _) => of(ground.properties(class)),
            (None, Some(weather)) => of(weather.surfaces().properties(class)),
            (None, None) => of(&class.properties()),
        }
    }
}
