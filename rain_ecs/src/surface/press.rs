//! Wheels and feet that press the film: tracks on a wet road.

use std::collections::VecDeque;

use bevy_ecs::prelude::*;
use bevy_math::{DVec2, DVec3};
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::components::Transform;
use bevy_transform::helper::TransformHelper;
use rain_core::error::{ConfigError, in_range};
use rain_core::surface::ground::Ground;
use serde::{Deserialize, Serialize};

use super::ground::SurfaceGround;
use crate::entity_order::{in_order, order_key};
use crate::snapshot::{Apply, SnapshotError, SnapshotPart};
use crate::state_hash::StateHasher;

/// Poses enter state rounded to this. Units: 1/m.
const POSE_STEPS_PER_M: f64 = 65_536.0;
/// Shorter ways gather until they are this long. Units: m.
const STEP_M: f64 = 0.05;
/// A longer way between two ticks is a leap, not a motion. Units: m.
const LEAP_M: f64 = 5.0;
/// How far above the ground the lowest point may be to press its film. Units: m.
const REACH_M: f64 = 0.15;
/// Presses kept for the picture.
const KEPT: usize = 1024;

/// Put on a wheel or a foot: where it moves over the ground it presses the film aside and leaves a track that fills
/// again under rain.
///
/// The tracks are state. They are the same at any frame rate only where poses are set in fixed ticks: between two ticks
/// of different poses the way is straight.
#[derive(Component, Reflect, Debug, Clone, PartialEq)]
#[reflect(Component, Debug, Clone, PartialEq, Default)]
#[require(Transform)]
pub struct FilmPress {
    /// Width of what touches the ground. Units: m. Domain: [0.01, 10]. Default: 0.2, a tyre.
    pub width_m: f32,
    /// Height of the origin above the lowest point. Units: m. Domain: [0, 100]. Default: 0.3, a wheel's radius.
    pub radius_m: f32,
    /// Share of the film that goes; the texture keeps the rest. Units: none. Domain: [0, 1]. Default: 0.7, chosen by
    /// eye.
    pub share: f32,
    #[reflect(ignore)]
    before: Option<DVec3>,
}

impl Default for FilmPress {
    fn default() -> Self {
        Self {
            width_m: 0.2,
            radius_m: 0.3,
            share: 0.7,
            before: None,
        }
    }
}

impl FilmPress {
    /// A wheel of this radius (units: m), otherwise as by default.
    #[must_use]
    pub fn wheel(radius_m: f32) -> Self {
        Self {
            radius_m,
            ..Self::default()
        }
    }

    /// This press, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(&self) -> Result<&Self, ConfigError> {
        in_range("width_m", f64::from(self.width_m), 0.01, 10.0, "0.01 to 10 m")?;
        in_range("radius_m", f64::from(self.radius_m), 0.0, 100.0, "0 to 100 m")?;
        in_range("share", f64::from(self.share), 0.0, 1.0, "0 to 1")?;
        Ok(self)
    }

    /// The way since the last press, if it has become one.
    fn way(&mut self, place: DVec3) -> Option<(DVec3, DVec3)> {
        let place = (place * POSE_STEPS_PER_M).round() / POSE_STEPS_PER_M;
        if !place.is_finite() {
            self.before = None;
            return None;
        }
        let from = *self.before.get_or_insert(place);
        let length = (place - from).length();
        if length < STEP_M {
            return None;
        }
        self.before = Some(place);
        (length <= LEAP_M).then_some((from, place))
    }
}

/// A way on which film was pressed, for the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmPressed {
    /// Start and end (x, z). Units: m.
    pub way_m: [DVec2; 2],
    /// Half of its width. Units: m.
    pub half_width_m: f64,
    /// Share of the film that went.
    pub share: f64,
}

/// The latest presses, oldest first; whoever shows them takes them out. No state.
#[derive(Resource, Debug, Default)]
pub struct FilmPresses(VecDeque<FilmPressed>);

impl FilmPresses {
    /// Takes all out.
    pub fn take(&mut self) -> impl Iterator<Item = FilmPressed> {
        self.0.drain(..)
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn put(&mut self, pressed: FilmPressed) {
        if self.0.len() == KEPT {
            self.0.pop_front();
        }
        self.0.push_back(pressed);
    }
}

fn touches(ground: &Ground, place: DVec3, radius_m: f64) -> bool {
    ground
        .height_at(place.x, place.z)
        .is_some_and(|height| (place.y - radius_m - height).abs() <= REACH_M)
}

/// Presses the film under everything that has moved since the last tick.
pub(super) fn press_films(
    mut surface: ResMut<SurfaceGround>,
    mut pressed: ResMut<FilmPresses>,
    poses: TransformHelper,
    mut presses: Query<(Entity, &mut FilmPress)>,
    mut order: Local<Vec<Entity>>,
) {
    if presses.is_empty() {
        return;
    }
    let Some(ground) = surface.bypass_change_detection().ground_mut() else {
        return;
    };
    // Ways may cross: the order of entities decides, not that of memory.
    order.clear();
    order.extend(presses.iter().map(|(entity, _)| entity));
    order.sort_unstable_by_key(|entity| order_key(*entity));
    let pressed = pressed.bypass_change_detection();
    for &entity in &*order {
        // The pose as it is set, not as it was last propagated: that depends on frames.
        let (Ok((_, mut press)), Ok(pose)) = (presses.get_mut(entity), poses.compute_global_transform(entity)) else {
            continue;
        };
        let press = press.bypass_change_detection();
        let way = press.way(pose.translation().as_dvec3());
        let (Some((from, to)), true) = (way, press.validated().is_ok()) else {
            continue;
        };
        let radius_m = f64::from(press.radius_m);
        if !touches(ground, from, radius_m) || !touches(ground, to, radius_m) {
            continue;
        }
        let [from, to] = [from, to].map(|at| DVec2::new(at.x, at.z));
        let (half_width_m, share) = (0.5 * f64::from(press.width_m), f64::from(press.share));
        // All numbers have been checked.
        let Ok(taken) = ground.press(from, to, half_width_m, share, 0.0) else {
            continue;
        };
        if taken.thrown_m3 > 0.0 {
            // Nothing lies beside: it comes down where it was.
            let _ = ground.land(to, taken.thrown_m3);
        }
        pressed.put(FilmPressed {
            way_m: [from, to],
            half_width_m,
            share,
        });
    }
}

pub(super) fn hash_presses(world: &World, hasher: &mut StateHasher) {
    for (_, press) in in_order::<FilmPress>(world) {
        let place = press.before.unwrap_or(DVec3::NAN);
        place.to_array().into_iter().for_each(|v| hasher.f64(v));
    }
}

/// Where each press was, in the order of their entities.
#[derive(Serialize, Deserialize)]
pub(super) struct PressPart(Vec<Option<[f64; 3]>>);

impl SnapshotPart for PressPart {
    fn save(world: &World) -> Option<Self> {
        let places: Vec<_> = in_order::<FilmPress>(world)
            .into_iter()
            .map(|(_, press)| press.before.map(|place| place.to_array()))
            .collect();
        (!places.is_empty()).then_some(Self(places))
    }

    fn prepare(self, world: &World) -> Result<Apply, SnapshotError> {
        let refused = |what: String| SnapshotError::Refused {
            part: "film_press",
            what,
        };
        let entities: Vec<_> = in_order::<FilmPress>(world)
            .into_iter()
            .map(|(entity, _)| entity)
            .collect();
        if entities.len() != self.0.len() {
            let (found, here) = (self.0.len(), entities.len());
            return Err(refused(format!("it has {found} wheels and feet, this world {here}")));
        }
        let sound = |place: &Option<[f64; 3]>| place.is_none_or(|place| place.iter().all(|v| v.is_finite()));
        if !self.0.iter().all(sound) {
            return Err(refused("a place that is no number".into()));
        }
        Ok(Box::new(move |world| {
            for (entity, place) in entities.into_iter().zip(self.0) {
                if let Some(mut press) = world.get_mut::<FilmPress>(entity) {
                    press.before = place.map(DVec3::from_array);
                }
            }
            if let Some(mut pressed) = world.get_resource_mut::<FilmPresses>() {
                pressed.0.clear();
            }
        }))
    }
}
