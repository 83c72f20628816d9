//! What the user sets and what the user is told.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::components::Transform;
use rain_core::lightning::{Flash, LightningSettings, Thunder};

use crate::weather::Weather;

/// Has the storm of its [`Weather`] flash. Without it there is no lightning and nothing is computed.
///
/// A value outside its domain is reported by [`crate::RainConfigError`], and the last good settings stay in force.
#[derive(Component, Reflect, Debug, Clone, Copy, PartialEq, Default)]
#[reflect(opaque)]
#[reflect(Component, Debug, Clone, PartialEq, Default)]
#[require(Weather)]
pub struct Lightning(pub LightningSettings);

/// Ears: put on a camera or a player. Thunder arrives there, and [`RainSound`](crate::sound::RainSound) is of there.
#[derive(Component, Reflect, Debug, Clone, Copy, PartialEq, Default)]
#[reflect(Component, Debug, Clone, PartialEq, Default)]
#[require(Transform)]
pub struct RainListener;

/// A flash begins. Written by the tick in which it does; in a tick longer than 10 s, for its last 10 s.
#[derive(Message, Debug, Clone, Copy, PartialEq)]
pub struct LightningFlash {
    /// When, where, and its strokes.
    pub flash: Flash,
}

/// The thunder of a flash begins to arrive at a listener. Written by the tick in which it does.
#[derive(Message, Debug, Clone, Copy, PartialEq)]
pub struct ThunderHeard {
    /// The entity with [`RainListener`].
    pub listener: Entity,
    /// The flash it comes from.
    pub flash: Flash,
    /// Delay, length, loudness and course.
    pub thunder: Thunder,
}
