//! Wetness of objects that move in and out of the rain.

use bevy_ecs::prelude::*;
use bevy_math::{DVec3, Vec3};
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::components::{GlobalTransform, Transform};
use bevy_transform::helper::TransformHelper;
use rain_core::weather::{ColumnForcing, SurfaceClass, SurfaceColumn};

use super::material::SurfaceMaterial;
use crate::clock::RainClock;
use crate::cover::CoverField;
use crate::entity_order::in_order;
use crate::rainfall::areas::RainAreas;
use crate::state_hash::StateHasher;
use crate::weather::{ActiveWeather, WeatherMode, WeatherState};

/// Poses enter state rounded to this. Units: 1/m.
const POSE_STEPS_PER_M: f64 = 65_536.0;
/// An object that has moved by less asks for no new exposure. Units: m.
const STILL_M: f64 = 0.02;

/// Makes an object wet where it is exposed and lets it dry under cover: by the artists' rates
/// ([`WeatherMode::Artist`]) or as a surface of its [`SurfaceMaterial`] (else: metal and paint, like a roof).
///
/// The cover is asked for only when the object has moved or the cover has changed.
#[derive(Component, Reflect, Debug, Clone, PartialEq)]
#[reflect(Component, Debug, Clone, PartialEq, Default)]
#[require(Transform)]
pub struct DynamicWetness {
    /// Where the cover is asked, relative to the entity and turned with it: on top of an object that itself covers.
    /// Units: m. Default: 1 m up.
    pub probe_m: Vec3,
    wetness: f64,
    exposure: f64,
    /// Physical water, above the pores: drips off.
    #[reflect(ignore)]
    pub(super) column: SurfaceColumn,
    #[reflect(ignore)]
    place: Option<DVec3>,
    #[reflect(ignore)]
    cover_version: u64,
}

impl Default for DynamicWetness {
    fn default() -> Self {
        Self {
            probe_m: Vec3::Y,
            wetness: 0.0,
            exposure: 1.0,
            column: SurfaceColumn::default(),
            place: None,
            cover_version: 0,
        }
    }
}

impl DynamicWetness {
    /// How wet it is. Units: none. Domain: [0, 1].
    #[must_use]
    pub fn wetness(&self) -> f64 {
        self.wetness
    }

    /// Film on it (the physical way). Units: mm.
    #[must_use]
    pub fn film_mm(&self) -> f64 {
        self.column.water_level_mm()
    }

    /// Share of the rain that reaches it. Units: none. Domain: [0, 1].
    #[must_use]
    pub fn exposure(&self) -> f64 {
        self.exposure
    }

    /// Wetness, exposure and place, for hashes and snapshots.
    pub(super) fn numbers(&self) -> [f64; 5] {
        let place = self.place.unwrap_or(DVec3::NAN);
        [self.wetness, self.exposure, place.x, place.y, place.z]
    }

    /// Takes over what [`Self::numbers`] gave; the exposure belongs to the cover at hand.
    pub(super) fn set_numbers(&mut self, [wetness, exposure, x, y, z]: [f64; 5], cover_version: u64) {
        (self.wetness, self.exposure) = (wetness, exposure);
        self.place = Some(DVec3::new(x, y, z)).filter(|place| !place.is_nan());
        self.cover_version = cover_version;
    }

    fn see(&mut self, pose: &GlobalTransform, cover: &CoverField) {
        let place =
            (pose.affine().transform_point3(self.probe_m).as_dvec3() * POSE_STEPS_PER_M).round() / POSE_STEPS_PER_M;
        if !place.is_finite() {
            return;
        }
        let still = self
            .place
            .is_some_and(|old| old.distance_squared(place) < STILL_M * STILL_M);
        if still && self.cover_version == cover.version() {
            return;
        }
        self.exposure = f64::from(cover.exposed_at(place));
        self.place = Some(place);
        self.cover_version = cover.version();
    }
}

pub(super) fn hash_objects(world: &World, hasher: &mut StateHasher) {
    for (_, object) in in_order::<DynamicWetness>(world) {
        object.numbers().into_iter().for_each(|v| hasher.f64(v));
        object.column.state_bits().into_iter().for_each(|bits| hasher.u64(bits));
    }
}

/// Wets and dries every object by one tick.
pub(super) fn wet_objects(
    clock: Res<RainClock>,
    active: Res<ActiveWeather>,
    weather: Query<&WeatherState>,
    cover: Option<Res<CoverField>>,
    areas: Option<Res<RainAreas>>,
    poses: TransformHelper,
    mut objects: Query<(Entity, &mut DynamicWetness, Option<&SurfaceMaterial>)>,
) {
    let Some(state) = active.entity().and_then(|entity| weather.get(entity).ok()) else {
        return;
    };
    let areas = areas.as_deref().filter(|areas| !areas.is_uniform());
    let highest = areas.map_or(state.conditions().intensity_mm_h, RainAreas::highest_mm_h);
    let dt_s = clock.current_tick_s();
    for (entity, mut object, material) in &mut objects {
        // Dry and nothing falls: nothing to do.
        if highest == 0.0 && object.wetness == 0.0 && object.column.is_dry() {
            continue;
        }
        if highest > 0.0
            && let Some(cover) = &cover
            // The pose as it is set, not as it was last propagated: that depends on frames.
            && let Ok(pose) = poses.compute_global_transform(entity)
        {
            object.bypass_change_detection().see(&pose, cover);
        }
        // Where it was seen last, to 2 cm.
        let rain = match (areas, object.place) {
            (Some(areas), Some(place)) => areas.rate_at(place),
            _ => highest,
        };
        let class = material.map_or(SurfaceClass::Roof, |material| material.0);
        let properties = state.surfaces().properties(class);
        let forcing = ColumnForcing {
            rain_mm_h: rain * object.exposure,
            evaporation_mm_h: state.evaporation_mm_h().max(0.0),
        };
        let before = object.wetness;
        let this = object.bypass_change_detection();
        let advanced = this.column.advance(properties, forcing, dt_s);
        debug_assert!(advanced.is_ok(), "{advanced:?}");
        this.wetness = match state.mode() {
            WeatherMode::Physical => this.column.wetness(properties),
            WeatherMode::Artist => {
                let settings = state.surfaces().artist_settings();
                settings.object_wetness(before, this.exposure, rain, dt_s)
            }
        };
        if this.wetness != before {
            object.set_changed();
        }
    }
}
