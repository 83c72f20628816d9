//! The areas in force.

use bevy_ecs::change_detection::DetectChanges;
use bevy_ecs::prelude::*;
use bevy_math::{DVec2, DVec3};
use rain_core::error::ConfigError;
use rain_core::rainfall::areas::{AreaField, AreaSettings, MAX_AREAS};
use rain_core::surface::ground::UnevenRain;

use super::components::{RainArea, RainAreaRefused, RainOutside};
use crate::clock::RainClock;
use crate::entity_order::order_key;
use crate::state_hash::{HashState, StateHasher};
use crate::weather::{ActiveWeather, WeatherState};

/// The rain areas in force, as the last tick took them.
#[derive(Resource, Debug, Default)]
pub struct RainAreas {
    /// In the order of their entities.
    known: Vec<(Entity, AreaSettings)>,
    outside: f64,
    /// At the end of the last tick.
    field: AreaField,
    now_s: f64,
    weather_mm_h: f64,
    started: bool,
}

impl RainAreas {
    /// Whether the weather's rain falls everywhere as it is.
    #[must_use]
    pub fn is_uniform(&self) -> bool {
        !self.started || (self.known.is_empty() && self.outside == 1.0)
    }

    /// The areas in force with their entities, in the order of these.
    pub fn areas(&self) -> impl ExactSizeIterator<Item = (Entity, &AreaSettings)> {
        self.known.iter().map(|(entity, area)| (*entity, area))
    }

    /// The areas as they stood at the end of the last tick.
    #[must_use]
    pub fn field(&self) -> &AreaField {
        &self.field
    }

    /// The areas `seconds` after the last tick: what a frame between ticks shows. The memory of `into` is used again.
    pub fn field_after(&self, seconds: f64, into: &mut AreaField) {
        let outside = if self.is_uniform() { 1.0 } else { self.outside };
        into.clear(outside);
        for (_, area) in &self.known {
            into.push(area, DVec2::ZERO, self.now_s + seconds);
        }
    }

    /// The weather's rate in the last tick. Units: mm/h.
    #[must_use]
    pub fn weather_mm_h(&self) -> f64 {
        self.weather_mm_h
    }

    /// Rain rate in the open at a place (world, m). Units: mm/h.
    #[must_use]
    pub fn rate_at(&self, place: DVec3) -> f64 {
        if self.is_uniform() {
            self.weather_mm_h
        } else {
            self.field.rate_at(DVec2::new(place.x, place.z), self.weather_mm_h)
        }
    }

    /// Rain rate where no area is. Units: mm/h.
    #[must_use]
    pub fn outside_mm_h(&self) -> f64 {
        if self.is_uniform() {
            self.weather_mm_h
        } else {
            AreaField::new(self.outside).rate_at(DVec2::ZERO, self.weather_mm_h)
        }
    }

    /// No rate anywhere is above this; the weather's without areas. Units: mm/h.
    #[must_use]
    pub fn highest_mm_h(&self) -> f64 {
        if self.is_uniform() {
            self.weather_mm_h
        } else {
            self.field.highest_mm_h(self.weather_mm_h)
        }
    }

    /// What a snapshot keeps.
    pub(super) fn saved(&self) -> (Vec<AreaSettings>, f64) {
        let areas = self.known.iter().map(|(_, area)| area.clone()).collect();
        (areas, if self.started { self.outside } else { 1.0 })
    }

    /// Takes over areas that have been checked, at the clock's time.
    pub(super) fn restore(&mut self, known: Vec<(Entity, AreaSettings)>, outside: f64, now_s: f64) {
        (self.known, self.outside, self.now_s, self.started) = (known, outside, now_s, true);
        self.place();
    }

    fn place(&mut self) {
        let mut field = std::mem::take(&mut self.field);
        self.field_after(0.0, &mut field);
        self.field = field;
    }

    /// The same for the ground, which looks back.
    pub(crate) fn under(&self) -> Option<UnderAreas<'_>> {
        (!self.is_uniform()).then(|| UnderAreas {
            areas: self,
            field: self.field.clone(),
            highest_mm_h: self.highest_mm_h(),
        })
    }
}

impl HashState for RainAreas {
    /// Nothing without areas.
    fn hash_state(&self, hasher: &mut StateHasher) {
        if self.is_uniform() {
            return;
        }
        hasher.f64(self.outside);
        hasher.u64(self.known.len() as u64);
        for (_, area) in &self.known {
            // The debug text of a number is its shortest exact one.
            hasher.bytes(format!("{area:?}").as_bytes());
        }
    }
}

/// The rain of areas as shares of the highest rate.
pub(crate) struct UnderAreas<'a> {
    areas: &'a RainAreas,
    field: AreaField,
    highest_mm_h: f64,
}

impl UnevenRain for UnderAreas<'_> {
    fn look_back(&mut self, ago_s: f64) {
        self.areas.field_after(-ago_s, &mut self.field);
        self.highest_mm_h = self.field.highest_mm_h(self.areas.weather_mm_h);
    }

    fn share_at(&self, place_m: [f64; 2]) -> f64 {
        if self.highest_mm_h > 0.0 {
            self.field.rate_at(place_m.into(), self.areas.weather_mm_h) / self.highest_mm_h
        } else {
            0.0
        }
    }
}

/// Takes over what users changed, if it is valid, and places the areas at the end of the tick.
pub(super) fn follow_areas(
    mut areas: ResMut<RainAreas>,
    clock: Res<RainClock>,
    outside: Res<RainOutside>,
    active: Res<ActiveWeather>,
    weather: Query<&WeatherState>,
    components: Query<(Entity, Ref<RainArea>)>,
    mut refused: MessageWriter<RainAreaRefused>,
) {
    let this = areas.bypass_change_detection();
    let state = active.entity().and_then(|entity| weather.get(entity).ok());
    this.weather_mm_h = state.map_or(0.0, |state| state.conditions().intensity_mm_h);
    this.now_s = clock.now_s();
    this.outside = if outside.0 > 0.0 { outside.0.min(1.0) } else { 0.0 };
    this.started = true;
    if components.is_empty() && this.known.is_empty() {
        this.field.clear(this.outside);
        return;
    }
    let mut before = std::mem::take(&mut this.known).into_iter().peekable();
    let mut present: Vec<_> = components.iter().collect();
    present.sort_unstable_by_key(|(entity, _)| order_key(*entity));
    for (entity, area) in present {
        while before.next_if(|(old, _)| order_key(*old) < order_key(entity)).is_some() {}
        let old = before.next_if(|(old, _)| *old == entity).map(|(_, settings)| settings);
        let wanted = if old.is_none() || area.is_changed() {
            match area.0.check() {
                _ if this.known.len() >= MAX_AREAS => {
                    if area.is_changed() {
                        let error = ConfigError::OutOfRange {
                            field: "number of rain areas",
                            value: (this.known.len() + 1) as f64,
                            allowed: "up to 256",
                        };
                        refused.write(RainAreaRefused {
                            entity,
                            error: error.into(),
                        });
                    }
                    None
                }
                Ok(()) => Some(area.0.clone()),
                Err(error) => {
                    if area.is_changed() {
                        refused.write(RainAreaRefused { entity, error });
                    }
                    old
                }
            }
        } else {
            old
        };
        if let Some(settings) = wanted {
            this.known.push((entity, settings));
        }
    }
    this.place();
}
