//! The order of entities in which state is advanced, hashed and saved: that of their numbers, not that of memory.

use bevy_ecs::prelude::*;

/// What entities are sorted by: the same in every world that spawned alike.
pub(crate) fn order_key(entity: Entity) -> (u32, u32) {
    (entity.index_u32(), entity.generation().to_bits())
}

/// Every entity that carries a `C`, with it, in order.
pub(crate) fn in_order<C: Component>(world: &World) -> Vec<(Entity, &C)> {
    let mut found: Vec<_> = world
        .iter_entities()
        .filter_map(|entity| entity.get::<C>().map(|component| (entity.id(), component)))
        .collect();
    found.sort_unstable_by_key(|(entity, _)| order_key(*entity));
    found
}
