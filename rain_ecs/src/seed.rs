//! The one random seed.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::state_hash::{HashState, StateHasher};

/// Seed of everything random. Same seed, same input, same rain. Domain: any. Default: 0.
#[derive(Resource, Reflect, Debug, Clone, Copy, PartialEq, Eq, Default)]
#[reflect(Resource, Debug, Clone, PartialEq, Default)]
pub struct RainSeed(pub u64);

impl HashState for RainSeed {
    fn hash_state(&self, hasher: &mut StateHasher) {
        hasher.u64(self.0);
    }
}
