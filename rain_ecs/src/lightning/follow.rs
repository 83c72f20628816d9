//! Which flashes are on, and whose thunder is on its way.

use std::sync::Arc;

use bevy_ecs::change_detection::DetectChanges;
use bevy_ecs::prelude::*;
use bevy_math::DVec3;
use bevy_transform::components::GlobalTransform;
use rain_core::lightning::{Channel, Flash, LightningSettings, Thunder, for_each_flash};
use rain_core::weather::WeatherConditions;

use super::components::{Lightning, LightningFlash, RainListener, ThunderHeard};
use crate::clock::RainClock;
use crate::error::RainConfigError;
use crate::seed::RainSeed;
use crate::weather::{ActiveWeather, WeatherState};

/// Thunder of older flashes has passed: 30 km and the length of a flash. Units: s.
const LONGEST_WAIT_S: f64 = 110.0;
/// Flashes are told of this far back in a longer tick. Units: s.
const TOLD_S: f64 = 10.0;
/// Thunder that is not heard where the listener is may be so this much later. Units: s.
const LOOK_AGAIN_S: f64 = 2.0;

/// A flash with its path.
#[derive(Debug, Clone)]
pub struct ActiveFlash {
    /// The flash.
    pub flash: Flash,
    /// Its path.
    pub channel: Arc<Channel>,
    /// A [`LightningFlash`] has been written.
    told: bool,
    ears: Vec<Ear>,
}

/// A listener and a flash.
#[derive(Debug, Clone)]
struct Ear {
    listener: Entity,
    heard: Option<Thunder>,
    /// Nothing arrives before this. Units: s.
    not_before_s: f64,
}

/// The flashes of the last two minutes up to one tick ahead, which frames between ticks show. Heard and seen only: no part
/// of the state hash or of snapshots.
#[derive(Resource, Debug, Clone, Default)]
pub struct ActiveLightning {
    flashes: Vec<ActiveFlash>,
    settings: LightningSettings,
    of: Option<(Entity, u64)>,
    /// Flashes before this are in the list. Units: s.
    known_to_s: f64,
    /// End of the last tick. Units: s.
    now_s: f64,
}

impl ActiveLightning {
    /// The flashes whose light is not over at `time_s`, or whose thunder may still come.
    #[must_use]
    pub fn flashes(&self) -> &[ActiveFlash] {
        &self.flashes
    }

    /// Whether a weather with [`Lightning`] is in force.
    #[must_use]
    pub fn is_on(&self) -> bool {
        self.of.is_some()
    }

    /// The settings in force.
    #[must_use]
    pub fn settings(&self) -> LightningSettings {
        self.settings
    }

    /// Thunder that has begun to arrive at a listener, with the time on the rain clock at which it did (s).
    pub fn heard_by(&self, listener: Entity) -> impl Iterator<Item = (f64, &Thunder)> + '_ {
        self.flashes.iter().filter_map(move |active| {
            let ear = active.ears.iter().find(|ear| ear.listener == listener)?;
            let thunder = ear.heard.as_ref()?;
            Some((active.flash.time_s + thunder.delay_s, thunder))
        })
    }

    /// Adds the flashes in [from_s, to_s).
    fn add(&mut self, seed: u64, from_s: f64, to_s: f64) {
        let flashes = &mut self.flashes;
        for_each_flash(&self.settings, seed, from_s, to_s, |flash| {
            flashes.push(ActiveFlash {
                flash,
                channel: Arc::new(Channel::of(&flash)),
                told: false,
                ears: Vec::new(),
            });
        });
    }
}

impl ActiveFlash {
    /// The thunder that has begun to arrive at a listener by `now_s` and had not by the last tick.
    fn arrival(&mut self, listener: Entity, place: DVec3, now_s: f64, air_temperature_c: f64) -> Option<Thunder> {
        let index = match self.ears.iter().position(|ear| ear.listener == listener) {
            Some(index) => index,
            None => {
                self.ears.push(Ear {
                    listener,
                    heard: None,
                    not_before_s: self.flash.time_s,
                });
                self.ears.len() - 1
            }
        };
        let ear = &mut self.ears[index];
        if ear.heard.is_some() || now_s < ear.not_before_s {
            return None;
        }
        let Some(thunder) = Thunder::heard(&self.flash, &self.channel, place, air_temperature_c) else {
            ear.not_before_s = now_s + LOOK_AGAIN_S;
            return None;
        };
        let arrives_s = self.flash.time_s + thunder.delay_s;
        if arrives_s > now_s {
            // Who goes towards it at less than the speed of sound meets it after half of the time left.
            ear.not_before_s = now_s + 0.5 * (arrives_s - now_s);
            return None;
        }
        ear.heard = Some(thunder);
        Some(thunder)
    }
}

/// Whether there is lightning, or was.
pub(super) fn lightning_is_used(lightning: Query<(), With<Lightning>>, active: Res<ActiveLightning>) -> bool {
    active.of.is_some() || !lightning.is_empty()
}

/// Finds the flashes of this tick, and what arrives in it.
pub(super) fn follow_lightning(
    clock: Res<RainClock>,
    seed: Res<RainSeed>,
    active: Res<ActiveWeather>,
    storms: Query<(Ref<Lightning>, &WeatherState)>,
    listeners: Query<(Entity, &GlobalTransform), With<RainListener>>,
    mut sky: ResMut<ActiveLightning>,
    mut flashes: MessageWriter<LightningFlash>,
    mut thunders: MessageWriter<ThunderHeard>,
    mut errors: MessageWriter<RainConfigError>,
) {
    let Some((entity, (lightning, state))) = active.entity().and_then(|e| Some((e, storms.get(e).ok()?))) else {
        *sky = ActiveLightning::default();
        return;
    };
    let sky = &mut *sky;
    let of = Some((entity, seed.0));
    let fresh = sky.of != of;
    if fresh || lightning.is_changed() {
        match lightning.0.validated() {
            Ok(settings) => sky.settings = settings,
            Err(error) => {
                if fresh {
                    // There are no good ones yet: it does not flash.
                    sky.settings.flashes_per_km2_min = 0.0;
                }
                errors.write(RainConfigError { entity, error });
            }
        }
    }
    let (start_s, now_s) = (clock.tick_start_s(), clock.now_s());
    let WeatherConditions { air_temperature_c, .. } = *state.conditions();
    // The clock was set, or this is the first tick: what is on its way is found again.
    if fresh || sky.now_s != start_s {
        sky.flashes.clear();
        sky.add(seed.0, start_s - LONGEST_WAIT_S, start_s);
        for flash in &mut sky.flashes {
            flash.told = true;
            for (listener, place) in &listeners {
                let _ = flash.arrival(listener, place.translation().as_dvec3(), start_s, air_temperature_c);
            }
        }
        sky.known_to_s = start_s;
        sky.of = of;
    }
    sky.now_s = now_s;
    let ahead_s = now_s + clock.tick_ns() as f64 * 1e-9;
    let from_s = sky.known_to_s.max(now_s - LONGEST_WAIT_S);
    sky.add(seed.0, from_s, ahead_s);
    sky.known_to_s = ahead_s;
    sky.flashes
        .retain(|active| active.flash.time_s > now_s - LONGEST_WAIT_S);
    for active in &mut sky.flashes {
        let began_s = active.flash.time_s;
        if began_s > now_s {
            continue;
        }
        if !active.told {
            active.told = true;
            if began_s > now_s - TOLD_S {
                flashes.write(LightningFlash { flash: active.flash });
            }
        }
        for (listener, place) in &listeners {
            let place = place.translation().as_dvec3();
            if let Some(thunder) = active.arrival(listener, place, now_s, air_temperature_c) {
                thunders.write(ThunderHeard {
                    listener,
                    flash: active.flash,
                    thunder,
                });
            }
        }
    }
}
