//! The scene's meshes as triangles for the CPU state: what covers, what is ground, of which class.

use std::collections::{BTreeMap, BTreeSet};

use bevy::gltf::GltfMaterialName;
use bevy::math::DVec3;
use bevy::mesh::{Mesh, Mesh3d, PrimitiveTopology, VertexAttributeValues};
use bevy::prelude::*;
use rain_ecs::prelude::*;

use super::OriginalMaterial;
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
            .add_systems(
                PostUpdate,
                hand_over
                    .in_set(RainViewSystems::Surfaces)
                    .run_if(resource_exists::<CoverField>.and_then(resource_exists::<SurfaceScene>)),
            );
    }
}

/// What has been handed over, by owner.
#[derive(Resource, Default)]
struct HandedOver {
    owners: BTreeMap<u64, SurfaceClass>,
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
    Ref<'static, Mesh3d>,
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
) {
    let gone = removed.read().count() > 0;
    if !handed.stale && !gone && changed.is_empty() {
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
        if known == Some(wanted) && !mesh.is_changed() {
            continue;
        }
        let Some(mesh) = meshes.get(&mesh.0) else {
            handed.stale = true;
            present.remove(&owner);
            continue;
        };
        // No data on the CPU: the picture alone knows of it.
        let Some(triangles) = triangles_of(mesh, &transform) else {
            present.remove(&owner);
            continue;
        };
        if let Err(error) = cover.set(owner, &triangles, true) {
            warn!("{entity} does not keep rain off in the simulation: {error}");
        }
        scene.set(owner, &triangles, wanted, true);
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

/// World-space triangles of a mesh; `None` when it is no triangle list or its data lives on the GPU only.
pub(crate) fn triangles_of(mesh: &Mesh, transform: &GlobalTransform) -> Option<Vec<[DVec3; 3]>> {
    if mesh.primitive_topology() != PrimitiveTopology::TriangleList {
        return None;
    }
    let VertexAttributeValues::Float32x3(positions) = mesh.try_attribute(Mesh::ATTRIBUTE_POSITION).ok()? else {
        return None;
    };
    let world: Vec<_> = positions
        .iter()
        .map(|p| transform.transform_point(Vec3::from_array(*p)).as_dvec3())
        .collect();
    let at = |i: usize| world.get(i).copied();
    let triangle = |a: usize, b: usize, c: usize| Some([at(a)?, at(b)?, at(c)?]);
    let corners: Vec<usize> = match mesh.try_indices().ok() {
        Some(indices) => indices.iter().collect(),
        None => (0..positions.len()).collect(),
    };
    corners.chunks_exact(3).map(|t| triangle(t[0], t[1], t[2])).collect()
}
