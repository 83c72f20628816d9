//! What is transparent before a view: rain behind it is drawn before it.

use std::sync::Arc;

use bevy::camera::primitives::Aabb;
use bevy::camera::visibility::RenderLayers;
use bevy::prelude::*;
use rain_render::glass::{MAX_PANES, Pane};

use super::view::RainViewFrame;
use crate::render_adapter::DrawnSky;

/// A mesh that is seen through: rain behind its box is drawn before it, all other rain after it.
///
/// Meshes whose `StandardMaterial` is blended (`AlphaMode::Blend`, `Premultiplied`, `Add`, `Multiply`) get it by themselves
/// and lose it with that; put it on blended meshes of other materials. Remove it from one of a `StandardMaterial`, and all
/// rain is drawn over it until its material changes. A view tells the nearest eight apart. In views of Bevy's atmosphere,
/// which draws its sky over what lies before nothing, rain comes after everything.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default)]
pub struct SeenThrough;

/// A box in the world: its middle and half axes. Units: m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PaneBox {
    centre: Vec3,
    half_axes: [Vec3; 3],
}

/// The transparent boxes that a view tells apart, the nearest first.
#[derive(Component, Clone, Debug, Default)]
pub struct ViewPanes(Arc<Vec<PaneBox>>);

impl ViewPanes {
    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// The same relative to an eye.
    pub(crate) fn seen_from(&self, eye: Vec3) -> Vec<Pane> {
        let panes = self.0.iter();
        panes
            .filter_map(|own| Pane::new(own.centre - eye, own.half_axes))
            .collect()
    }
}

fn is_blended(material: &StandardMaterial) -> bool {
    !matches!(
        material.alpha_mode,
        AlphaMode::Opaque | AlphaMode::Mask(_) | AlphaMode::AlphaToCoverage
    )
}

/// Marks what is blended. A blended material is never swapped for a wet one.
pub(super) fn mark_blended(
    mut commands: Commands,
    materials: Option<Res<Assets<StandardMaterial>>>,
    mut events: MessageReader<AssetEvent<StandardMaterial>>,
    all: Query<(Entity, Ref<MeshMaterial3d<StandardMaterial>>, Has<SeenThrough>)>,
) {
    let Some(materials) = materials else { return };
    let came = events
        .read()
        .any(|event| matches!(event, AssetEvent::Added { .. } | AssetEvent::Modified { .. }));
    for (entity, material, marked) in &all {
        if !came && !material.is_changed() {
            continue;
        }
        let Some(own) = materials.get(&material.0) else {
            continue;
        };
        match (is_blended(own), marked) {
            (true, false) => {
                commands.entity(entity).insert(SeenThrough);
            }
            (false, true) => {
                commands.entity(entity).remove::<SeenThrough>();
            }
            _ => {}
        }
    }
}

/// Chooses the nearest boxes of each view.
pub(super) fn choose_panes(
    glass: Query<(&GlobalTransform, &Aabb, &InheritedVisibility, Option<&RenderLayers>), With<SeenThrough>>,
    mut found: Local<Vec<(f32, PaneBox)>>,
    mut views: Query<
        (
            &Camera,
            &GlobalTransform,
            Option<&RenderLayers>,
            Has<DrawnSky>,
            &mut ViewPanes,
        ),
        With<RainViewFrame>,
    >,
) {
    for (camera, transform, layers, atmosphere, mut chosen) in &mut views {
        if !camera.is_active {
            continue;
        }
        let eye = transform.translation();
        let layers = layers.cloned().unwrap_or_default();
        found.clear();
        for (place, bounds, visible, own_layers) in &glass {
            if atmosphere || !visible.get() || !layers.intersects(&own_layers.cloned().unwrap_or_default()) {
                continue;
            }
            let half = Vec3::from(bounds.half_extents);
            let matrix = place.affine().matrix3;
            let own = PaneBox {
                centre: place.affine().transform_point3(bounds.center.into()),
                half_axes: [
                    Vec3::from(matrix.x_axis) * half.x,
                    Vec3::from(matrix.y_axis) * half.y,
                    Vec3::from(matrix.z_axis) * half.z,
                ],
            };
            let reach: f32 = own.half_axes.iter().map(|axis| axis.length()).sum();
            let distance = own.centre.distance(eye) - reach;
            if distance.is_finite() {
                found.push((distance, own));
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let boxes = found.iter().take(MAX_PANES).map(|(_, own)| *own);
        let mut out = Arc::try_unwrap(std::mem::take(&mut chosen.0)).unwrap_or_default();
        out.clear();
        out.extend(boxes);
        chosen.0 = Arc::new(out);
    }
}
