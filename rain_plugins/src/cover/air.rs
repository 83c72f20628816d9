//! Closed-in views: a camera in a room without openings draws no rain at all.

use std::collections::{BTreeMap, BTreeSet};

use bevy::mesh::{Mesh, Mesh3d};
use bevy::prelude::*;
use rain_core::cover::air::{Air, AirGrid, cell_of};
use rain_core::rainfall::{FADE_END, RANGE_CAP_M};
use rain_ecs::prelude::*;

use crate::rainfall::{RainView, leading_view};
use crate::surface::{MeshTriangles, OriginalMaterial, triangles_of};

/// Whether the first active [`RainView`] stands in closed-in air; other views are not judged and draw.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AirAroundView {
    /// The view from which no rain can be in sight.
    pub closed_in: Option<Entity>,
}

/// What closes air, on the CPU: surfaces whose material is opaque or cut out and whose mesh keeps its data. What rain
/// reaches is the simulation's [`CoverField`] to say.
#[derive(Resource, Default)]
pub(super) struct Surroundings {
    air: AirGrid,
    owners: BTreeMap<u64, AssetId<Mesh>>,
    /// Entities not yet taken in, or moved.
    stale: bool,
    /// The last flood that found no rain, and the cell it started from.
    flooded: Option<BTreeSet<[i32; 3]>>,
    start: IVec3,
    /// The cell from which the last flood found rain: until something changes, it finds it again.
    open: Option<IVec3>,
    /// What moved lately: left out of the walls until it stands still.
    moving: BTreeSet<u64>,
    /// Version of the cover that the last flood asked.
    cover_version: Option<u64>,
    /// Meshes whose data has changed since they were last looked at.
    modified: BTreeSet<AssetId<Mesh>>,
}

type ChangedSurface = (
    With<Mesh3d>,
    Or<(Changed<GlobalTransform>, Changed<Mesh3d>, Changed<InheritedVisibility>)>,
);

/// A flood stays valid while the eye is this close to where it started. Units: cells.
const SAME_PLACE: i32 = 8;

type Surface = (
    Entity,
    Ref<'static, GlobalTransform>,
    &'static Mesh3d,
    &'static InheritedVisibility,
    OriginalMaterial,
);

pub(super) fn judge_air(
    mut surroundings: ResMut<Surroundings>,
    mut judged: ResMut<AirAroundView>,
    field: Res<RainfallField>,
    cover: Option<Res<CoverField>>,
    meshes: Res<Assets<Mesh>>,
    materials: Res<Assets<StandardMaterial>>,
    views: Query<(Entity, &Camera, &Projection, &GlobalTransform), With<RainView>>,
    surfaces: Query<Surface>,
    changed: Query<(), ChangedSurface>,
    mut removed: RemovedComponents<Mesh3d>,
    mut events: MessageReader<AssetEvent<Mesh>>,
) {
    let gone = removed.read().count() > 0;
    judged.closed_in = None;
    surroundings
        .modified
        .extend(events.read().filter_map(|event| match event {
            AssetEvent::Modified { id } => Some(*id),
            _ => None,
        }));
    let Some(cover) = cover.filter(|_| field.is_raining()) else {
        surroundings.stale = true;
        return;
    };
    // Without perspective a camera may stand anywhere along its rays: it is in no room.
    let eyes = views
        .iter()
        .filter(|(_, _, projection, _)| !matches!(projection, Projection::Orthographic(_)));
    let lead = leading_view(eyes.map(|(view, camera, _, at)| (view, camera, (view, at))));
    let Some((view, at)) = lead else { return };
    let eye = at.translation().as_dvec3();
    let s = &mut *surroundings;
    // In a still scene no mesh is looked at twice.
    if s.stale || gone || !s.modified.is_empty() || !s.moving.is_empty() || !changed.is_empty() {
        take_in(s, &meshes, &materials, &surfaces);
        s.modified.clear();
    }
    if s.cover_version.replace(cover.version()) != Some(cover.version()) {
        s.flooded = None;
        s.open = None;
    }
    let cell = cell_of(eye);
    if s.open == Some(cell) {
        return;
    }
    let same_place = (cell - s.start).abs().max_element() <= SAME_PLACE;
    if let Some(flooded) = &s.flooded
        && same_place
        && flooded.contains(&cell.to_array())
    {
        judged.closed_in = Some(view);
        return;
    }
    let inverse_speed = field.mean_inverse_velocity_s_m();
    let range = RANGE_CAP_M * FADE_END + f64::from(SAME_PLACE) * rain_core::cover::air::AIR_CELL_M;
    // Without an answer for a point, rain counts as reaching it.
    let reached = |p| !cover.scene().covered(p, inverse_speed).unwrap_or(false);
    s.start = cell;
    s.open = None;
    s.flooded = match s.air.flood(eye, range, reached) {
        Air::ClosedIn(cells) => Some(cells),
        Air::Open => {
            s.open = Some(cell);
            None
        }
    };
    judged.closed_in = s.flooded.is_some().then_some(view);
}

/// Brings the walls up to date with what was added, moved or removed.
fn take_in(
    s: &mut Surroundings,
    meshes: &Assets<Mesh>,
    materials: &Assets<StandardMaterial>,
    surfaces: &Query<Surface>,
) {
    let mut changed = false;
    let mut present = BTreeSet::new();
    let mut unresolved = false;
    for (entity, transform, mesh, visible, original) in surfaces {
        let owner = entity.to_bits();
        let material = original.handle().map(|h| materials.get(h));
        // A material still being loaded is asked for again.
        unresolved |= matches!(material, Some(None));
        let opaque = material
            .flatten()
            .is_some_and(|m| matches!(m.alpha_mode, AlphaMode::Opaque | AlphaMode::Mask(_)));
        if !opaque || !visible.get() {
            continue;
        }
        present.insert(owner);
        let held = s.owners.get(&owner).copied();
        let known = held.is_some();
        let seen = known || s.moving.contains(&owner);
        let other = held.is_some_and(|id| id != mesh.0.id()) || s.modified.contains(&mesh.0.id());
        if seen && (transform.is_changed() || other) {
            s.moving.insert(owner);
            if known {
                s.air.remove(owner);
                s.owners.remove(&owner);
                changed = true;
            }
            continue;
        }
        if s.moving.remove(&owner) || !known {
            let known_triangles = meshes.get(&mesh.0).and_then(|m| triangles_of(m, &transform).ok());
            let Some(MeshTriangles { triangles, .. }) = known_triangles else {
                // No data on the CPU: it cannot close here, so the air counts as open.
                present.remove(&owner);
                continue;
            };
            s.air.set(owner, triangles);
            s.owners.insert(owner, mesh.0.id());
            changed = true;
        }
    }
    let gone: Vec<u64> = s.owners.keys().filter(|o| !present.contains(o)).copied().collect();
    for owner in gone {
        s.air.remove(owner);
        s.owners.remove(&owner);
        changed = true;
    }
    s.stale = unresolved;
    if changed {
        s.flooded = None;
        s.open = None;
    }
}
