//! The ground and the objects in a snapshot.

use bevy_ecs::prelude::*;
use rain_core::surface::ground::{Ground, GroundState};
use rain_core::weather::{SurfaceClass, SurfaceColumn};
use serde::{Deserialize, Serialize};

use super::dynamic::DynamicWetness;
use super::ground::SurfaceGround;
use super::material::SurfaceMaterial;
use super::scene::{SurfaceScene, SurfaceSettings};
use crate::clock::RainClock;
use crate::cover::CoverField;
use crate::entity_order::in_order;
use crate::snapshot::{Apply, SnapshotError, SnapshotPart};
use crate::weather::ActiveWeather;

/// The ground's water. Where the ground is not built yet it is built from the scene.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SurfacePart {
    ground: Option<GroundState>,
    cursor: Option<usize>,
    again: bool,
}

impl SnapshotPart for SurfacePart {
    fn save(world: &World) -> Option<Self> {
        let surface = world.get_resource::<SurfaceGround>()?;
        Some(Self {
            ground: surface.ground.as_ref().map(Ground::state),
            cursor: surface.cursor,
            again: surface.again,
        })
    }

    fn prepare(self, world: &World) -> Result<Apply, SnapshotError> {
        const PART: &str = "surface";
        let refused = |what: String| SnapshotError::Refused { part: PART, what };
        let missing = || SnapshotError::NoPlugin { part: PART };
        let surface = world.get_resource::<SurfaceGround>().ok_or_else(missing)?;
        let scene = world.get_resource::<SurfaceScene>().ok_or_else(missing)?;
        let settings = world.get_resource::<SurfaceSettings>().ok_or_else(missing)?;
        let (cursor, again) = (self.cursor, self.again);
        let Some(state) = self.ground else {
            return match &surface.ground {
                Some(_) => Err(refused("it has no ground, this world has one".into())),
                None => Ok(Box::new(move |world| {
                    let cover = world.get_resource::<CoverField>().map(CoverField::version);
                    let mut surface = world.resource_mut::<SurfaceGround>();
                    (surface.cursor, surface.again) = (cursor, again);
                    surface.sees_cover(cover);
                })),
            };
        };
        let mut ground = match &surface.ground {
            Some(ground) if surface.is_built_from(scene, settings) => ground.clone(),
            _ => {
                let clock = world.get_resource::<RainClock>().ok_or_else(missing)?;
                let tick_s = clock.tick_ns() as f64 / 1e9;
                Ground::build(scene.scene(), &settings.ground(tick_s)).map_err(|error| refused(error.to_string()))?
            }
        };
        ground.restore(&state).map_err(|error| refused(error.to_string()))?;
        if cursor.is_some_and(|cell| cell >= ground.exposure().len()) {
            return Err(refused("a cell that does not exist".into()));
        }
        let (version, settings) = (scene.scene().version(), settings.clone());
        Ok(Box::new(move |world| {
            let cover = world.get_resource::<CoverField>().map(CoverField::version);
            let mut surface = world.resource_mut::<SurfaceGround>();
            surface.put(ground, version, settings);
            (surface.cursor, surface.again) = (cursor, again);
            surface.sees_cover(cover);
        }))
    }
}

/// One object's water.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ObjectState {
    wetness: f64,
    exposure: f64,
    place: Option<[f64; 3]>,
    column: SurfaceColumn,
}

/// The objects' water in the order of their entities: a world with as many objects, spawned in the same order, takes it.
#[derive(Serialize, Deserialize)]
pub(super) struct ObjectsPart(Vec<ObjectState>);

impl SnapshotPart for ObjectsPart {
    fn save(world: &World) -> Option<Self> {
        world.get_resource::<SurfaceGround>()?;
        let state = |(_, object): (Entity, &DynamicWetness)| {
            let [wetness, exposure, x, y, z] = object.numbers();
            ObjectState {
                wetness,
                exposure,
                place: (!x.is_nan()).then_some([x, y, z]),
                column: object.column,
            }
        };
        Some(Self(in_order::<DynamicWetness>(world).into_iter().map(state).collect()))
    }

    fn prepare(self, world: &World) -> Result<Apply, SnapshotError> {
        let refused = |what: String| SnapshotError::Refused {
            part: "dynamic_wetness",
            what,
        };
        let objects = in_order::<DynamicWetness>(world);
        if objects.len() != self.0.len() {
            let (found, here) = (self.0.len(), objects.len());
            return Err(refused(format!("it has {found} objects, this world {here}")));
        }
        let weather = ActiveWeather::state(world).cloned().unwrap_or_default();
        let mut changes = Vec::with_capacity(objects.len());
        for ((entity, _), state) in objects.into_iter().zip(self.0) {
            let class = world.get::<SurfaceMaterial>(entity).map_or(SurfaceClass::Roof, |m| m.0);
            SurfaceColumn::restore(state.column.ledger(), weather.surfaces().properties(class))
                .map_err(|error| refused(error.to_string()))?;
            let share = |v: f64| (0.0..=1.0).contains(&v);
            let place = state.place.unwrap_or([f64::NAN; 3]);
            let placed = state.place.is_none_or(|place| place.iter().all(|v| v.is_finite()));
            if !(share(state.wetness) && share(state.exposure) && placed) {
                return Err(refused("an object's wetness, exposure or place".into()));
            }
            let numbers = [state.wetness, state.exposure, place[0], place[1], place[2]];
            changes.push((entity, numbers, state.column));
        }
        Ok(Box::new(move |world| {
            let cover = world.get_resource::<CoverField>().map_or(0, CoverField::version);
            for (entity, numbers, column) in changes {
                if let Some(mut object) = world.get_mut::<DynamicWetness>(entity) {
                    object.column = column;
                    object.set_numbers(numbers, cover);
                }
            }
        }))
    }
}
