//! What a listener hears of the rain, for a game's audio: levels, not samples.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_math::DVec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::components::GlobalTransform;
use rain_core::ops;
use rain_core::sound::{
    SOUND_PLACES, SOUND_RINGS, WATER_SOUND_SHARE, heard_share, rain_sound_w_m2, sound_level_db, sound_share,
};
use rain_core::weather::SurfaceClass;

use crate::clock::RainClock;
use crate::lightning::{ActiveLightning, RainListener};
use crate::queries::{RainQueries, SoundWetness};
use crate::schedule::{RainSystems, RainTick};

/// Put on what listens: levels of the rain around it, written after each tick. Without it nothing is computed.
///
/// Levels are in dB re 20 µPa and 0 where nothing is heard. Drops are heard where they land within 17 m, by what they
/// land on, the rate and the exposure of the place ([`rain_core::sound`]).
#[derive(Component, Reflect, Debug, Clone, Copy, PartialEq, Default)]
#[reflect(opaque)]
#[reflect(Component, Debug, Clone, PartialEq, Default)]
#[require(RainListener)]
pub struct RainSound {
    /// Rain on ground of each class, in the order of [`SurfaceClass::ALL`]. Units: dB.
    pub ground_db: [f32; SurfaceClass::COUNT],
    /// Rain on standing water. Units: dB.
    pub water_db: f32,
    /// Rain on what covers the listener, as on a sheet roof. Units: dB.
    pub shelter_db: f32,
    /// All of these together. Units: dB.
    pub rain_db: f32,
    /// Thunder at this moment. Units: dB.
    pub thunder_db: f32,
    /// Share of the rain that reaches the listener: 1 in the open, 0 under a roof. Units: none. Domain: [0, 1].
    pub exposure: f32,
    /// Rain rate in the open where the listener is. Units: mm/h.
    pub rain_mm_h: f32,
}

impl RainSound {
    /// Of rain on ground of a class. Units: dB.
    #[must_use]
    pub fn on(&self, class: SurfaceClass) -> f32 {
        self.ground_db[class.index()]
    }
}

/// Writes [`RainSound`]s. Nothing runs while there is none.
#[derive(Debug, Clone, Copy, Default)]
pub struct RainSoundPlugin;

impl Plugin for RainSoundPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<RainSound>().add_systems(
            RainTick,
            listen
                .in_set(RainSystems::Sound)
                .run_if(any_with_component::<RainSound>),
        );
    }
}

/// Height of ears over the ground. Units: m.
const EARS_M: f64 = 1.7;

fn listen(
    clock: Res<RainClock>,
    queries: RainQueries,
    sky: Option<Res<ActiveLightning>>,
    mut listeners: Query<(Entity, &GlobalTransform, &mut RainSound)>,
) {
    let now_s = clock.now_s();
    for (entity, place, mut sound) in &mut listeners {
        let mut found = around(&queries, place.translation().as_dvec3());
        let thunder = sky.as_ref().map_or(0.0, |sky| {
            let levels = sky
                .heard_by(entity)
                .filter_map(|(arrived_s, thunder)| thunder.level_at(now_s - arrived_s));
            levels.fold(0.0, together)
        });
        found.thunder_db = thunder as f32;
        sound.set_if_neq(found);
    }
}

/// Two sounds at once. Units: dB.
fn together(a: f64, b: f64) -> f64 {
    let intensity = |db: f64| {
        if db > 0.0 {
            1e-12 * ops::pow(10.0, 0.1 * db)
        } else {
            0.0
        }
    };
    sound_level_db(intensity(a) + intensity(b))
}

/// The rain around a place.
fn around(queries: &RainQueries, place: DVec3) -> RainSound {
    let rate = queries.rain_at(place);
    let exposure = f64::from(queries.exposed_at(place));
    let mut classes = [0.0; SurfaceClass::COUNT];
    let mut water = 0.0;
    if rate > 0.0 {
        let share = 1.0 / SOUND_PLACES as f64;
        for [radius, area] in SOUND_RINGS {
            let heard = heard_share(area * share, ops::sqrt(radius * radius + EARS_M * EARS_M));
            for i in 0..SOUND_PLACES {
                let angle = core::f64::consts::TAU * (i as f64 + radius) * share;
                let off = radius * DVec3::new(ops::cos(angle), 0.0, ops::sin(angle));
                let ground = place + off - EARS_M * DVec3::Y;
                let rain = rate * f64::from(queries.exposed_at(ground));
                if rain <= 0.0 {
                    continue;
                }
                let on = queries.surface_sound_at(ground);
                if on.wetness == SoundWetness::Puddle {
                    water += heard * rain_sound_w_m2(rain, WATER_SOUND_SHARE);
                } else {
                    classes[on.class.index()] += heard * rain_sound_w_m2(rain, sound_share(on.class));
                }
            }
        }
    }
    // What covers the listener is as good as a plane: half of its sound comes down.
    let shelter = 0.5 * rain_sound_w_m2(rate * (1.0 - exposure), sound_share(SurfaceClass::Roof));
    let all = classes.iter().sum::<f64>() + water + shelter;
    let db = |intensity: f64| sound_level_db(intensity) as f32;
    RainSound {
        ground_db: classes.map(db),
        water_db: db(water),
        shelter_db: db(shelter),
        rain_db: db(all),
        thunder_db: 0.0,
        exposure: exposure as f32,
        rain_mm_h: rate as f32,
    }
}
