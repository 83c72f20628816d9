//! Which of several views leads.

use bevy::math::{DVec3, Vec3Swizzles};
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

/// A place amid all eyes from which none is farther than `reach` along x and z, at the leading one's height; none where
/// they lie farther apart, with how far. Eyes that are not finite do not count.
pub(crate) fn amid_eyes(lead: DVec3, eyes: impl IntoIterator<Item = DVec3>, reach: f64) -> Result<DVec3, f64> {
    let (low, high) = eyes
        .into_iter()
        .filter(|eye| eye.is_finite())
        .fold((lead, lead), |(low, high), eye| (low.min(eye), high.max(eye)));
    let apart = (high - low).xz().max_element();
    if apart <= 2.0 * reach {
        Ok((0.5 * (low + high)).with_y(lead.y))
    } else {
        Err(apart)
    }
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

    #[test]
    fn what_views_share_lies_amid_those_that_it_can_hold() {
        let eye = |x: f64, z: f64| DVec3::new(x, 1.7, z);
        let lead = eye(0.0, 0.0);
        assert_eq!(amid_eyes(lead, [lead], 24.0), Ok(lead));
        let other = DVec3::new(20.0, 9.0, -8.0);
        assert_eq!(amid_eyes(lead, [lead, other], 24.0), Ok(eye(10.0, -4.0)));
        assert_eq!(amid_eyes(lead, [lead, eye(0.0, 49.0)], 24.0), Err(49.0));
        assert_eq!(amid_eyes(lead, [lead, DVec3::NAN], 24.0), Ok(lead));
    }
}
