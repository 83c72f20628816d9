//! The weather in a snapshot.

use bevy_ecs::prelude::*;
use rain_core::lightning::LightningSettings;
use rain_core::weather::{ArtistSettings, GustSettings, Timeline, WeatherConditions};
use serde::{Deserialize, Serialize};

use super::{Apply, SnapshotError, SnapshotPart};
use crate::entity_order::order_key;
use crate::lightning::{ActiveLightning, Lightning};
use crate::weather::{
    ActiveWeather, ArtistControls, GustState, Gusts, LevelCurve, LevelTimeline, WaterByHand, Weather, WeatherMode,
    WeatherState, WeatherTimeline,
};

/// The weather in force: what the user set and what it has done. It is put on the entity whose weather counts, or on a
/// new one.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct WeatherPart {
    set: WeatherConditions,
    mode: WeatherMode,
    controls: Option<ArtistSettings>,
    timeline: Option<(Timeline, f64)>,
    #[serde(default)]
    by_hand: Option<WaterByHand>,
    #[serde(default)]
    levels: Option<(LevelCurve, f64, bool)>,
    #[serde(default)]
    gusts: Option<GustSettings>,
    #[serde(default)]
    lightning: Option<LightningSettings>,
    state: WeatherState,
}

impl SnapshotPart for WeatherPart {
    fn save(world: &World) -> Option<Self> {
        let entity = world.get_resource::<ActiveWeather>()?.entity()?;
        let timeline = world.get::<WeatherTimeline>(entity);
        let state = world.get::<WeatherState>(entity)?.clone();
        // A weather that was refused has had no effect; the one in force is what counts.
        let set = world.get::<Weather>(entity)?.conditions();
        Some(Self {
            set: set.validated().unwrap_or(*state.conditions()),
            mode: *world.get::<WeatherMode>(entity)?,
            controls: world.get::<ArtistControls>(entity).map(|controls| controls.0),
            timeline: timeline.map(|t| (t.timeline.clone(), t.start_s)),
            // As with the weather, what was refused has had no effect.
            by_hand: world.get::<WaterByHand>(entity).map(|_| state.by_hand),
            levels: world
                .get::<LevelTimeline>(entity)
                .map(|t| (t.curve.clone(), t.start_s, t.playing)),
            gusts: world.get::<Gusts>(entity).map(|gusts| {
                let last = world.get_resource::<GustState>().map(|state| state.settings);
                gusts.0.validated().unwrap_or(last.unwrap_or_default())
            }),
            lightning: world.get::<Lightning>(entity).map(|lightning| {
                let last = world.get_resource::<ActiveLightning>().map(ActiveLightning::settings);
                lightning.0.validated().unwrap_or(last.unwrap_or_default())
            }),
            state,
        })
    }

    fn prepare(self, world: &World) -> Result<Apply, SnapshotError> {
        let refused = |what: String| SnapshotError::Refused { part: "weather", what };
        let active = world
            .get_resource::<ActiveWeather>()
            .ok_or(SnapshotError::NoPlugin { part: "weather" })?;
        // Before the first tick none is in force: then the one that will be.
        let entity = active.entity().filter(|&entity| world.get::<Weather>(entity).is_some());
        let entity = entity.or_else(|| {
            let entities = world.iter_entities().filter(|entity| entity.contains::<Weather>());
            entities
                .map(|entity| entity.id())
                .min_by_key(|entity| order_key(*entity))
        });
        let mut state = self.state.validated().map_err(|error| refused(error.to_string()))?;
        let by_hand = match self.by_hand {
            Some(by_hand) => Some(by_hand.validated().map_err(|error| refused(error.to_string()))?),
            None => None,
        };
        state.by_hand = by_hand.unwrap_or_default();
        let levels = match self.levels {
            Some((curve, start_s, playing)) => Some(LevelTimeline {
                curve: curve.validated().map_err(|error| refused(error.to_string()))?,
                start_s,
                playing,
            }),
            None => None,
        };
        let controls = match self.controls {
            Some(settings) => Some(settings.validated().map_err(|error| refused(error.to_string()))?),
            None => None,
        };
        let gusts = match self.gusts {
            Some(settings) => Some(settings.validated().map_err(|error| refused(error.to_string()))?),
            None => None,
        };
        let lightning = match self.lightning {
            Some(settings) => Some(settings.validated().map_err(|error| refused(error.to_string()))?),
            None => None,
        };
        let start_s = self.timeline.as_ref().map_or(0.0, |(_, start_s)| *start_s);
        if !start_s.is_finite() {
            return Err(refused(format!("start_s is {start_s}")));
        }
        let timeline = self
            .timeline
            .map(|(timeline, start_s)| WeatherTimeline { timeline, start_s });
        let (set, mode) = (Weather::from(self.set), self.mode);
        Ok(Box::new(move |world| {
            let mut entity = match entity {
                Some(entity) => world.entity_mut(entity),
                None => world.spawn_empty(),
            };
            entity.insert((set, mode, state));
            match controls {
                Some(controls) => entity.insert(ArtistControls(controls)),
                None => entity.remove::<ArtistControls>(),
            };
            match by_hand {
                Some(by_hand) => entity.insert(by_hand),
                None => entity.remove::<WaterByHand>(),
            };
            match levels {
                Some(levels) => entity.insert(levels),
                None => entity.remove::<LevelTimeline>(),
            };
            match gusts {
                Some(gusts) => entity.insert(Gusts(gusts)),
                None => entity.remove::<Gusts>(),
            };
            match lightning {
                Some(lightning) => entity.insert(Lightning(lightning)),
                None => entity.remove::<Lightning>(),
            };
            match timeline {
                Some(timeline) => entity.insert(timeline),
                None => entity.remove::<WeatherTimeline>(),
            };
            let entity = entity.id();
            world.resource_mut::<ActiveWeather>().restore(entity);
        }))
    }
}
