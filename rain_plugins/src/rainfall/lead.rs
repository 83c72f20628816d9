//! Which of several views leads.

use bevy::prelude::*;

/// The view that what all views share follows (cover map, window of the ground, wave tile): of the active ones that of
/// the lowest order, then the one spawned first. It does not depend on which components cameras carry.
pub(crate) fn leading_view<'a, T>(views: impl IntoIterator<Item = (Entity, &'a Camera, T)>) -> Option<T> {
    views
        .into_iter()
        .filter(|(_, camera, _)| camera.is_active)
        .min_by_key(|(entity, camera, _)| (camera.order, entity.index_u32()))
        .map(|(_, _, view)| view)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_order_leads_then_the_first_and_never_an_inactive_one() {
        let camera = |order, is_active| Camera {
            order,
            is_active,
            ..default()
        };
        let mut world = World::new();
        let views: Vec<_> = [(1, true), (0, true), (0, true), (-1, false)]
            .into_iter()
            .map(|(order, active)| (world.spawn_empty().id(), camera(order, active)))
            .collect();
        let lead = |of: &[usize]| leading_view(of.iter().map(|&i| (views[i].0, &views[i].1, i)));
        assert_eq!(lead(&[0, 1, 2, 3]), Some(1));
        assert_eq!(lead(&[2, 3, 1, 0]), Some(1));
        assert_eq!(lead(&[3, 0]), Some(0));
        assert_eq!(lead(&[3]), None);
    }
}
