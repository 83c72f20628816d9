//! One number for the whole simulated state: equal bits, equal hash.

use std::collections::BTreeMap;
use std::hash::Hasher;

use bevy_app::App;
use bevy_ecs::prelude::*;
use twox_hash::XxHash64;

/// Collects state bits in a fixed order. XXH64 with seed 0 over little-endian words.
pub struct StateHasher(XxHash64);

impl StateHasher {
    fn new() -> Self {
        Self(XxHash64::with_seed(0))
    }

    /// Adds an integer.
    pub fn u64(&mut self, value: u64) {
        self.0.write(&value.to_le_bytes());
    }

    /// Adds the bits of a number; −0 and 0 differ.
    pub fn f64(&mut self, value: f64) {
        self.u64(value.to_bits());
    }

    /// Adds the bits of a single-precision number.
    pub fn f32(&mut self, value: f32) {
        self.0.write(&value.to_bits().to_le_bytes());
    }

    /// Adds raw bytes.
    pub fn bytes(&mut self, bytes: &[u8]) {
        self.0.write(bytes);
    }
}

/// Simulated state that can put all its bits into a hash, in an order that never depends on memory layout.
pub trait HashState {
    /// Adds every bit that later state depends on, and nothing that depends on frames.
    fn hash_state(&self, hasher: &mut StateHasher);
}

type Source = fn(&World, &mut StateHasher);

/// What goes into [`state_hash()`], by name; names are hashed in alphabetical order.
#[derive(Resource, Default)]
pub struct StateHashSources(BTreeMap<&'static str, Source>);

/// Lets each phenomenon add its state to [`state_hash()`].
pub trait StateHashAppExt {
    /// Adds whatever `source` puts. A second source of the same name replaces the first.
    fn hash_with(&mut self, name: &'static str, source: Source) -> &mut Self;

    /// Adds a resource (nothing while it does not exist).
    fn hash_resource<R: Resource + HashState>(&mut self, name: &'static str) -> &mut Self;
}

impl StateHashAppExt for App {
    fn hash_with(&mut self, name: &'static str, source: Source) -> &mut Self {
        self.world_mut()
            .get_resource_or_init::<StateHashSources>()
            .0
            .insert(name, source);
        self
    }

    fn hash_resource<R: Resource + HashState>(&mut self, name: &'static str) -> &mut Self {
        self.hash_with(name, |world, hasher| {
            if let Some(resource) = world.get_resource::<R>() {
                resource.hash_state(hasher);
            }
        })
    }
}

/// Hash of all simulated state: the clock, the seed and what each added phenomenon contributes.
#[must_use]
pub fn state_hash(world: &World) -> u64 {
    let mut hasher = StateHasher::new();
    if let Some(sources) = world.get_resource::<StateHashSources>() {
        for (name, source) in &sources.0 {
            hasher.bytes(name.as_bytes());
            source(world, &mut hasher);
        }
    }
    hasher.0.finish()
}
