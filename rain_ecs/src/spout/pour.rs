//! A tick of every spout: rain on its roof, water to the ground.

use bevy_ecs::prelude::*;
use bevy_math::{DVec2, DVec3, Vec3};
use bevy_transform::helper::TransformHelper;
use rain_core::spout::SpoutFall;
use rain_core::surface::ground::Ground;
use rain_core::weather::{ColumnForcing, SurfaceClass};

use super::components::{Spout, SpoutForm, SpoutWater};
use crate::clock::RainClock;
use crate::entity_order::{in_order, order_key};
use crate::error::RainConfigError;
use crate::rainfall::RainfallField;
use crate::rainfall::areas::RainAreas;
use crate::state_hash::StateHasher;
use crate::surface::{SurfaceGround, SurfaceMaterial};
use crate::weather::{ActiveWeather, WeatherState};

/// Poses enter state rounded to this. Units: 1/m.
const POSE_STEPS_PER_M: f64 = 65_536.0;
/// Most places on the ground that an eave feeds.
const MOST_PLACES: f64 = 512.0;

pub(super) fn hash_spouts(world: &World, hasher: &mut StateHasher) {
    for (_, water) in in_order::<SpoutWater>(world) {
        water.column.state_bits().into_iter().for_each(|bits| hasher.u64(bits));
    }
}

/// Takes over what is good.
pub(super) fn check_spouts(
    mut spouts: Query<(Entity, &Spout, &mut SpoutWater), Changed<Spout>>,
    mut errors: MessageWriter<RainConfigError>,
) {
    for (entity, spout, mut water) in &mut spouts {
        match spout.validated() {
            Ok(good) => water.spout = Some(good),
            Err(error) => {
                errors.write(RainConfigError { entity, error });
            }
        }
    }
}

/// Where what leaves `mouth` with this velocity lands (x, z); below the mouth where no ground is known.
fn landing(ground: &Ground, mouth: DVec3, fall: &SpoutFall) -> DVec2 {
    let below = DVec2::new(mouth.x, mouth.z);
    let mut at = below;
    // The ground where it lands may lie higher or lower than that under the mouth.
    for _ in 0..2 {
        let Some(height) = ground.height_at(at.x, at.y) else {
            break;
        };
        let way = fall.place_m(fall.time_to_fall_s((mouth.y - height).max(0.0)));
        at = below + DVec2::new(way.x, way.z);
    }
    at
}

/// Gathers the tick's rain on every roof and lets it pour.
pub(super) fn pour(
    clock: Res<RainClock>,
    active: Res<ActiveWeather>,
    weather: Query<&WeatherState>,
    areas: Option<Res<RainAreas>>,
    field: Option<Res<RainfallField>>,
    mut surface: Option<ResMut<SurfaceGround>>,
    poses: TransformHelper,
    mut spouts: Query<(Entity, &mut SpoutWater, Option<&SurfaceMaterial>)>,
    mut order: Local<Vec<Entity>>,
) {
    let Some(state) = active.entity().and_then(|entity| weather.get(entity).ok()) else {
        return;
    };
    let areas = areas.as_deref().filter(|areas| !areas.is_uniform());
    let highest = areas.map_or(state.conditions().intensity_mm_h, RainAreas::highest_mm_h);
    let dt_s = clock.current_tick_s();
    if spouts.is_empty() || dt_s <= 0.0 {
        return;
    }
    // Waters meet on the ground: the order of entities decides, not that of memory.
    order.clear();
    order.extend(spouts.iter().map(|(entity, ..)| entity));
    order.sort_unstable_by_key(|entity| order_key(*entity));
    let mut ground = surface
        .as_mut()
        .and_then(|surface| surface.bypass_change_detection().ground_mut());
    for &entity in &*order {
        let Ok((_, mut water, material)) = spouts.get_mut(entity) else {
            continue;
        };
        let water = water.bypass_change_detection();
        let Some(spout) = water.spout else { continue };
        if highest == 0.0 && water.column.is_dry() {
            water.flow_m3_s = 0.0;
            continue;
        }
        // The pose as it is set, not as it was last propagated: that depends on frames.
        let Ok(pose) = poses.compute_global_transform(entity) else {
            continue;
        };
        let place = (pose.translation().as_dvec3() * POSE_STEPS_PER_M).round() / POSE_STEPS_PER_M;
        if !place.is_finite() {
            continue;
        }
        let class = material.map_or(SurfaceClass::Roof, |material| material.0);
        let properties = spout.roof(state.surfaces().properties(class));
        let forcing = ColumnForcing {
            rain_mm_h: areas.map_or(highest, |areas| areas.rate_at(place)),
            evaporation_mm_h: state.evaporation_mm_h().max(0.0),
        };
        let before = water.column.ledger().drained_mm;
        let advanced = water.column.advance(&properties, forcing, dt_s);
        debug_assert!(advanced.is_ok(), "{advanced:?}");
        let poured_m3 = (water.column.ledger().drained_mm - before).max(0.0) * 1e-3 * f64::from(spout.catchment_m2);
        water.flow_m3_s = poured_m3 / dt_s;
        let Some(ground) = ground.as_deref_mut().filter(|_| spout.feeds_ground && poured_m3 > 0.0) else {
            continue;
        };
        let turned = |v: Vec3| {
            let v = pose.rotation().mul_vec3(v).as_dvec3();
            // A scale of 0 has no direction: all comes down below.
            let v = if v.is_finite() { v } else { DVec3::ZERO };
            (v * POSE_STEPS_PER_M).round() / POSE_STEPS_PER_M
        };
        let wind = field.as_ref().map_or(DVec3::ZERO, |field| field.wind_m_s());
        let outflow = water.outflow();
        let drop_mm = outflow
            .filter(|outflow| !outflow.jets())
            .map(|outflow| outflow.drop_mm());
        let speed = outflow.map_or(0.0, |outflow| outflow.speed_m_s);
        let (along, count, direction) = match spout.form {
            SpoutForm::Eave { length_m } => {
                let length_m = f64::from(length_m);
                let count = (length_m / ground.frame().cell_m()).ceil().clamp(1.0, MOST_PLACES);
                (turned(Vec3::X) * length_m, count, DVec3::NEG_Y)
            }
            SpoutForm::Pipe { .. } => (DVec3::ZERO, 1.0, turned(Vec3::NEG_Z)),
        };
        let fall = SpoutFall::new(direction * speed, drop_mm, wind);
        for i in 0..count as u32 {
            let mouth = place + along * ((f64::from(i) + 0.5) / count - 0.5);
            // Amounts and places are in their domain.
            let _ = ground.add_water(landing(ground, mouth, &fall), poured_m3 / count);
        }
    }
}
