//! Choosing, checking and advancing the weather.

use bevy_ecs::change_detection::DetectChanges;
use bevy_ecs::prelude::*;
use rain_core::weather::ArtistSettings;

use super::components::{ArtistControls, RainTypeTable, WaterByHand, Weather, WeatherMode, WeatherTimeline};
use super::state::WeatherState;
use crate::clock::RainClock;
use crate::entity_order::order_key;
use crate::error::RainConfigError;

/// The entity whose [`Weather`] counts.
#[derive(Resource, Debug, Clone, Default, PartialEq, Eq)]
pub struct ActiveWeather {
    entity: Option<Entity>,
    ignored: Vec<Entity>,
    /// Another entity counts since this tick: what it carries has not been checked, however old it is.
    switched: bool,
}

impl ActiveWeather {
    /// The entity in force since the last tick, if there is any weather.
    #[must_use]
    pub fn entity(&self) -> Option<Entity> {
        self.entity
    }
}

impl ActiveWeather {
    /// State of the weather in force.
    pub(crate) fn state(world: &World) -> Option<&WeatherState> {
        world.get::<WeatherState>(world.get_resource::<Self>()?.entity()?)
    }

    /// Lets this entity's weather count from now on, until the next tick looks.
    pub(crate) fn restore(&mut self, entity: Entity) {
        self.entity = Some(entity);
    }
}

/// A second [`Weather`] exists and has no effect. Written once per entity that becomes ignored.
#[derive(Message, Debug, Clone, Copy, PartialEq, Eq)]
pub struct WeatherIgnored {
    /// The entity without effect.
    pub entity: Entity,
    /// The entity that counts.
    pub active: Entity,
}

/// Finds the weather that counts: lowest index, then generation.
pub(super) fn choose_weather(
    weathers: Query<Entity, With<Weather>>,
    mut active: ResMut<ActiveWeather>,
    mut messages: MessageWriter<WeatherIgnored>,
) {
    let mut entities: Vec<Entity> = weathers.iter().collect();
    entities.sort_unstable_by_key(|entity| order_key(*entity));
    let first = entities.first().copied();
    active.switched = active.entity != first;
    if active.switched {
        active.entity = first;
        active.ignored.clear();
    }
    let Some(first) = first else { return };
    if entities.len() == 1 && active.ignored.is_empty() {
        return;
    }
    let others = &entities[1..];
    for &entity in others {
        if !active.ignored.contains(&entity) {
            messages.write(WeatherIgnored { entity, active: first });
        }
    }
    active.ignored = others.to_vec();
}

/// Reads the speeds of the present rain out of the table; under a timeline, of the rain at the end of the last tick.
pub(super) fn follow_rain_types(
    active: Res<ActiveWeather>,
    mut weathers: Query<(&Weather, &WeatherState, &RainTypeTable, &mut ArtistControls)>,
) {
    let Some((weather, state, table, mut controls)) = active.entity().and_then(|e| weathers.get_mut(e).ok()) else {
        return;
    };
    // A weather that is refused rains on as it did.
    let conditions = weather.conditions().validated().unwrap_or(state.last_good);
    let row = table.0.at(conditions.intensity_mm_h);
    let settings = row.settings(&controls.0);
    controls.set_if_neq(ArtistControls(settings));
}

/// Takes over what the user changed, if it is valid.
pub(super) fn check_weather(
    active: Res<ActiveWeather>,
    mut weathers: Query<(
        Ref<Weather>,
        &WeatherMode,
        &mut WeatherState,
        Option<Ref<WeatherTimeline>>,
        Option<Ref<ArtistControls>>,
        Option<Ref<WaterByHand>>,
    )>,
    mut errors: MessageWriter<RainConfigError>,
) {
    let Some(entity) = active.entity() else { return };
    let Ok((weather, &mode, mut state, timeline, controls, by_hand)) = weathers.get_mut(entity) else {
        return;
    };
    let state = &mut *state;
    state.mode = mode;
    // Under a timeline the weather is output, until the timeline is refused.
    let driven = timeline.is_some() && !state.timeline_refused;
    let fresh = active.switched;
    if (fresh || weather.is_changed()) && !driven {
        match weather.conditions().validated() {
            Ok(conditions) => state.last_good = conditions,
            Err(error) => {
                errors.write(RainConfigError { entity, error });
            }
        }
    }
    if timeline.is_none_or(|timeline| timeline.is_changed()) {
        state.timeline_refused = false;
    }
    let refused = match controls {
        Some(controls) if fresh || controls.is_changed() => state.surfaces.set_artist_settings(controls.0).err(),
        Some(_) => None,
        None if *state.surfaces.artist_settings() != ArtistSettings::default() => {
            state.surfaces.set_artist_settings(ArtistSettings::default()).err()
        }
        None => None,
    };
    if let Some(error) = refused {
        errors.write(RainConfigError { entity, error });
    }
    match by_hand {
        Some(by_hand) if fresh || by_hand.is_changed() => match by_hand.validated() {
            Ok(by_hand) => state.by_hand = by_hand,
            Err(error) => {
                errors.write(RainConfigError { entity, error });
            }
        },
        Some(_) => {}
        None => state.by_hand = WaterByHand::default(),
    }
}

/// Advances the weather in force by one tick.
pub(super) fn advance_weather(
    clock: Res<RainClock>,
    active: Res<ActiveWeather>,
    mut weathers: Query<(&mut Weather, &mut WeatherState, Option<&WeatherTimeline>)>,
    mut errors: MessageWriter<RainConfigError>,
) {
    let Some(entity) = active.entity() else { return };
    let Ok((mut weather, mut state, timeline)) = weathers.get_mut(entity) else {
        return;
    };
    let state = &mut *state;
    state.keep_before();
    let mut report = |error| {
        errors.write(RainConfigError { entity, error });
    };
    if let Some(driver) = timeline
        && !state.timeline_refused
    {
        let (from_s, to_s) = (clock.tick_start_s() - driver.start_s, clock.now_s() - driver.start_s);
        let moved = driver.timeline.at(to_s).and_then(|end| {
            let mean = state.surfaces.advance_along(&driver.timeline, from_s, to_s)?;
            Ok((mean, end))
        });
        match moved {
            Ok((mean, end)) => {
                state.conditions = mean;
                state.last_good = end;
                weather.set_if_neq(end.into());
                return;
            }
            // Only a bad `start_s` gets here.
            Err(error) => {
                state.timeline_refused = true;
                report(error);
            }
        }
    }
    match state.surfaces.advance(&state.last_good, clock.current_tick_s()) {
        Ok(()) => state.conditions = state.last_good,
        Err(error) => report(error),
    }
}
