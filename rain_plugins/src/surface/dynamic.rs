//! Objects with a wetness of their own, in the picture.

use bevy::mesh::MeshTag;
use bevy::prelude::*;
use rain_ecs::prelude::*;

use super::state::SurfaceState;

/// A mesh that shows the wetness of the [`DynamicWetness`] on itself or the nearest ancestor, in its [`MeshTag`]. Given
/// by itself to meshes that have no tag of the app's own.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OwnWetness;

/// Film that closes over paint and metal. Units: mm.
const FILM_MM: f64 = 0.1;

/// Wetness and film share, 16 bits each. A wetness set by hand takes the place of its own where rain reaches it.
fn tag(wetness: &DynamicWetness, by_hand: Option<f64>) -> MeshTag {
    let part = |share: f64| (share.clamp(0.0, 1.0) * 65_535.0).round() as u32;
    let shown = by_hand.map_or(wetness.wetness(), |given| given * wetness.exposure());
    MeshTag(part(shown) | part(wetness.film_mm() / FILM_MM) << 16)
}

/// Hands the wetness of moving objects to the meshes that they are made of.
pub(super) fn give_own_wetness(
    mut commands: Commands,
    surface: Option<Res<SurfaceState>>,
    objects: Query<(Entity, &DynamicWetness)>,
    children: Query<&Children>,
    mut meshes: Query<(Option<&mut MeshTag>, Has<OwnWetness>), With<Mesh3d>>,
) {
    let by_hand = surface.and_then(|surface| surface.by_hand.wetness);
    for (object, wetness) in &objects {
        let tag = tag(wetness, by_hand);
        for entity in std::iter::once(object).chain(children.iter_descendants(object)) {
            match meshes.get_mut(entity) {
                Ok((Some(mut own), true)) => {
                    own.set_if_neq(tag.clone());
                }
                Ok((None, _)) => {
                    commands.entity(entity).insert((OwnWetness, tag.clone()));
                }
                // The tag is the app's, or there is no mesh.
                Ok((Some(_), false)) | Err(_) => {}
            }
        }
    }
}
