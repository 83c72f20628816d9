//! What users set.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use rain_core::rainfall::areas::{AreaError, AreaSettings};

/// A part of the ground where it rains otherwise than elsewhere: a shower, a dry hole, the edge of a front. Spawn as many as
/// wanted (256 count at once), edit them at any time; the next tick takes it.
///
/// Overlapping areas give the heaviest of their rates ([`rain_core::rainfall::areas`]). An area that is refused is reported
/// by [`RainAreaRefused`], and its last good settings stay in force; a new one does not count until it is mended.
#[derive(Component, Reflect, Debug, Clone, PartialEq, Default)]
#[reflect(opaque)]
#[reflect(Component, Debug, Clone, PartialEq, Default)]
pub struct RainArea(pub AreaSettings);

/// Share of the weather's rain that falls where no area is. Default: 1, so that areas add to the weather; 0: it rains in
/// areas alone. Held in [0, 1]; what is not a number is 0.
#[derive(Resource, Reflect, Debug, Clone, Copy, PartialEq)]
#[reflect(Resource, Debug, Clone, PartialEq, Default)]
pub struct RainOutside(pub f64);

impl Default for RainOutside {
    fn default() -> Self {
        Self(1.0)
    }
}

/// A [`RainArea`] cannot be used as it is. Written once per change of the component, by the first tick that sees it.
#[derive(Message, Debug, Clone, PartialEq)]
pub struct RainAreaRefused {
    /// The entity that carries it.
    pub entity: Entity,
    /// What is wrong.
    pub error: AreaError,
}
