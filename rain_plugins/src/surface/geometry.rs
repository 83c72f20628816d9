//! The scene's meshes as triangles for the CPU state: what covers, what is ground, of which class.

use std::collections::{BTreeMap, BTreeSet};

use bevy::gltf::GltfMaterialName;
use bevy::mesh::{Mesh, Mesh3d};
use bevy::prelude::*;
use rain_ecs::prelude::*;

use super::OriginalMaterial;
use super::gaps::{Gap, SceneGap, report_ground};
use super::triangles::{MeshTriangles, triangles_of};
use crate::schedule::RainViewSystems;

/// Put on a mesh (or its root) that moves: it covers rain in the picture, but is no ground, and state does not depend
/// on where it is at a frame. Meshes that are seen to move are marked by themselves.
#[derive(Component, Reflect, Clone, Copy, Debug, Default)]
#[reflect(Component, Default)]
pub struct MovesInRain;

/// Hands the meshes over: the cover's and the wet surfaces' plugin both need it.
pub(crate) struct SceneGeometryPlugin;

impl SceneGeometryPlugin {
    /// Adds it once.
    pub(crate) fn add_to(app: &mut App) {
        if !app.is_plugin_added::<Self>() {
            app.add_plugins(Self);
        }
    }
}

impl Plugin for SceneGeometryPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<HandedOver>()
            .register_type::<MovesInRain>()
            .add_message::<SceneGap>()
            .add_systems(
                PostUpdate,
                (hand_over, report_ground)
                    .in_set(RainViewSystems::Surfaces)
                    .run_if(resource_exists::<CoverField>.and_then(resource_exists::<SurfaceScene>)),
            );
    }
}

/// What has been handed over, by owner.
#[derive(Resource, Default)]
struct HandedOver {
    owners: BTreeMap<u64, (SurfaceClass, AssetId<Mesh>)>,
    /// Something was not ready: a material or mesh still being loaded.
    stale: bool,
}

type ChangedSurface = (
    With<Mesh3d>,
    Or<(
        Changed<GlobalTransform>,
        Changed<Mesh3d>,
        Changed<InheritedVisibility>,
        Changed<SurfaceMaterial>,
        Changed<MovesInRain>,
    )>,
);

type Surface = (
    Entity,
    Ref<'static, GlobalTransform>,
    &'static Mesh3d,
    &'static InheritedVisibility,
    OriginalMaterial,
    (
        Option<&'static SurfaceMaterial>,
        Option<&'static GltfMaterialName>,
        Option<&'static Name>,
    ),
);

/// Hands meshes that stand still over to the cover and the ground of the simulation; looks at nothing in a still scene.
fn hand_over(
    mut commands: Commands,
    mut handed: ResMut<HandedOver>,
    mut cover: ResMut<CoverField>,
    mut scene: ResMut<SurfaceScene>,
    meshes: Res<Assets<Mesh>>,
    materials: Res<Assets<StandardMaterial>>,
    surfaces: Query<Surface>,
    moving: Query<(), With<MovesInRain>>,
    parents: Query<&ChildOf>,
    changed: Query<(), ChangedSurface>,
    mut removed: RemovedComponents<Mesh3d>,
    mut events: MessageReader<AssetEvent<Mesh>>,
    mut gaps: MessageWriter<SceneGap>,
) {
    let gone = removed.read().count() > 0;
    // Bevy marks a mesh as changed also when its data has just come: that is no reason to take it in twice.
    let modified: BTreeSet<AssetId<Mesh>> = events
        .read()
        .filter_map(|event| match event {
            AssetEvent::Modified { id } => Some(*id),
            _ => None,
        })
        .collect();
    if !handed.stale && !gone && modified.is_empty() && changed.is_empty() {
        return;
    }
    let handed = &mut *handed;
    handed.stale = false;
    let mut present = BTreeSet::new();
    for (entity, transform, mesh, visible, original, (class, material_name, name)) in &surfaces {
        let owner = entity.to_bits();
        let material = original.handle().map(|h| materials.get(h));
        handed.stale |= matches!(material, Some(None));
        // Leaves and other cut-outs let rain through; glass keeps it off, but nothing lies on it.
        let Some(material) = material.flatten().filter(|m| !m.unlit) else {
            continue;
        };
        if !visible.get() || !matches!(material.alpha_mode, AlphaMode::Opaque) {
            continue;
        }
        if moving.contains(entity) || parents.iter_ancestors(entity).any(|e| moving.contains(e)) {
            continue;
        }
        let known = handed.owners.get(&owner).copied();
        if known.is_some() && (transform.is_changed() && !transform.is_added()) {
            commands.entity(entity).insert(MovesInRain);
            continue;
        }
        let wanted = class.map_or_else(
            || guess(material_name.map(|n| n.0.as_str()), name.map(Name::as_str)),
            |c| c.0,
        );
        present.insert(owner);
        let wanted = (wanted, mesh.0.id());
        if known == Some(wanted) && !modified.contains(&wanted.1) {
            continue;
        }
        let Some(mesh) = meshes.get(&mesh.0) else {
            handed.stale = true;
            present.remove(&owner);
            continue;
        };
        let mut report = |gap: Gap| {
            warn!("{entity}: {gap}");
            gaps.write(SceneGap {
                entity: Some(entity),
                gap,
            });
        };
        match triangles_of(mesh, &transform) {
            // The picture alone knows of it.
            Err(gap) => {
                report(gap);
                cover.remove(owner);
                scene.remove(owner);
            }
            Ok(MeshTriangles { triangles, left_out }) => {
                if left_out.any() {
                    report(Gap::LeftOut(left_out));
                }
                if let Err(error) = cover.set(owner, &triangles, true) {
                    report(Gap::NoCover(error));
                    cover.remove(owner);
                }
                scene.set(owner, &triangles, wanted.0, true);
            }
        }
        handed.owners.insert(owner, wanted);
    }
    let gone: Vec<u64> = handed.owners.keys().filter(|o| !present.contains(o)).copied().collect();
    for owner in gone {
        handed.owners.remove(&owner);
        cover.remove(owner);
        scene.remove(owner);
    }
}

/// The class of a surface by the name of its material, else by its own.
fn guess(material: Option<&str>, name: Option<&str>) -> SurfaceClass {
    [material, name]
        .into_iter()
        .flatten()
        .find_map(surface_class_of_name)
        .unwrap_or_default()
}
