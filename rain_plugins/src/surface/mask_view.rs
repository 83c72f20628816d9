//! The view of masks: what wet materials know of each pixel of a view that has masks.

use bevy::camera::visibility::RenderLayers;
use bevy::camera::{RenderTarget, SubCameraView};
use bevy::ecs::query::QueryData;
use bevy::prelude::*;

use super::state::SurfaceState;
use crate::rainfall::RainView;
use crate::render_adapter::{DepthPrepass, RainMasks, mask_camera, mask_target};

/// Marks the plugin's own cameras that draw masks.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct RainMaskView {
    /// The view whose masks it draws, in the main world.
    pub of: Entity,
    /// Size of its target. Units: px.
    size: UVec2,
}

/// A view that may have masks.
#[derive(QueryData)]
pub(super) struct Masked {
    entity: Entity,
    camera: &'static Camera,
    msaa: Option<&'static Msaa>,
    at: &'static GlobalTransform,
    projection: &'static Projection,
    layers: Option<&'static RenderLayers>,
}

#[derive(QueryData)]
#[query_data(mutable)]
pub(super) struct MaskCamera {
    entity: Entity,
    mask: &'static mut RainMaskView,
    camera: &'static mut Camera,
    transform: &'static mut Transform,
    global: &'static mut GlobalTransform,
    projection: &'static mut Projection,
    target: &'static mut RenderTarget,
}

/// How a camera of masks stands and sees: as its view does.
struct Aim {
    transform: Transform,
    projection: Projection,
    sub_view: Option<SubCameraView>,
    layers: Option<RenderLayers>,
    size: UVec2,
}

fn aim(view: &MaskedItem) -> Option<Aim> {
    // Multisampled views have no masks.
    let has_masks = view.camera.is_active && view.msaa == Some(&Msaa::Off);
    let size = view
        .camera
        .physical_viewport_size()
        .filter(|size| size.min_element() > 0);
    Some(Aim {
        transform: view.at.compute_transform(),
        projection: view.projection.clone(),
        sub_view: view.camera.sub_camera_view,
        layers: view.layers.cloned(),
        size: size.filter(|_| has_masks)?,
    })
}

/// Lets a camera of masks look where each view with masks looks while something wet is shown; else it sleeps, and goes
/// with its view.
pub(super) fn aim_mask_views(
    mut commands: Commands,
    surface: Res<SurfaceState>,
    views: Query<Masked, (With<RainView>, With<RainMasks>, With<DepthPrepass>)>,
    mut cameras: Query<MaskCamera, Without<RainMasks>>,
    mut images: ResMut<Assets<Image>>,
) {
    let mut aimed = Vec::new();
    for mut own in &mut cameras {
        let of = own.mask.of;
        let Ok(view) = views.get(of) else {
            commands.entity(own.entity).despawn();
            continue;
        };
        aimed.push(of);
        let aim = aim(&view).filter(|_| surface.shown);
        own.camera.is_active = aim.is_some();
        let Some(aim) = aim else { continue };
        if own.mask.size != aim.size {
            own.mask.size = aim.size;
            *own.target = RenderTarget::from(images.add(mask_target(aim.size)));
        }
        own.camera.sub_camera_view = aim.sub_view;
        *own.transform = aim.transform;
        *own.global = GlobalTransform::from(aim.transform);
        *own.projection = aim.projection;
        let mut camera = commands.entity(own.entity);
        match aim.layers {
            Some(layers) => camera.insert(layers),
            None => camera.remove::<RenderLayers>(),
        };
    }
    if !surface.shown {
        return;
    }
    for view in views.iter().filter(|view| !aimed.contains(&view.entity)) {
        let Some(aim) = aim(&view) else { continue };
        let mut camera = commands.spawn((
            RainMaskView {
                of: view.entity,
                size: aim.size,
            },
            mask_camera(images.add(mask_target(aim.size)), aim.sub_view),
            aim.transform,
            aim.projection,
        ));
        if let Some(layers) = aim.layers {
            camera.insert(layers);
        }
    }
}
