//! Swaps wet materials in and out.

use std::collections::BTreeMap;

use bevy::asset::{AssetEventSystems, AssetId};
use bevy::ecs::query::QueryData;
use bevy::prelude::*;

use super::state::{SurfaceState, create_state, follow_weather};
use crate::cover::CoverMap;
use crate::render_adapter::{RenderApp, WetMaterial, WetSurface};
use crate::schedule::RainViewSystems;

/// Keeps a mesh's material as it is, however wet the weather.
#[derive(Component, Reflect, Clone, Copy, Debug, Default)]
#[reflect(Component, Default)]
pub struct KeepDry;

/// Refines how a mesh takes water; without it, everything is guessed from its material.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default)]
pub struct SurfaceWetting {
    /// How much of the weather's wetness the surface takes. Units: none. Domain: [0, 1]. Default: 1.
    pub strength: f32,
    /// Share of the body that darkens when soaked. Domain: [0, 1]. `None`: from roughness and metalness.
    pub porosity: Option<f32>,
}

impl Default for SurfaceWetting {
    fn default() -> Self {
        Self {
            strength: 1.0,
            porosity: None,
        }
    }
}

impl SurfaceWetting {
    fn uniform(self) -> Vec4 {
        let finite = |v: f32, default: f32| if v.is_finite() { v.clamp(0.0, 1.0) } else { default };
        Vec4::new(
            finite(self.strength, 1.0),
            self.porosity.map_or(-1.0, |p| finite(p, 0.5)),
            0.0,
            0.0,
        )
    }
}

/// The material a mesh had when it was dry.
#[derive(Component, Clone, Debug)]
pub struct DryMaterial(Handle<StandardMaterial>);

/// The `StandardMaterial` of a mesh, dry or wet.
#[derive(QueryData)]
pub struct OriginalMaterial {
    own: Option<&'static MeshMaterial3d<StandardMaterial>>,
    dry: Option<&'static DryMaterial>,
}

impl OriginalMaterialItem<'_, '_> {
    /// The handle of the material that the app gave to the mesh.
    #[must_use]
    pub fn handle(&self) -> Option<&Handle<StandardMaterial>> {
        self.own.map(|m| &m.0).or(self.dry.map(|d| &d.0))
    }
}

/// Wet copies, by original and by how they take water.
#[derive(Resource, Default)]
struct WetCopies(BTreeMap<(AssetId<StandardMaterial>, [u32; 4]), Handle<WetMaterial>>);

/// Makes every `StandardMaterial` wet where rain reaches it. Needs the cover map: without `CoverPlugin` nothing gets
/// wet.
pub struct WetSurfacePlugin;

impl Plugin for WetSurfacePlugin {
    fn build(&self, app: &mut App) {
        if app.get_sub_app(RenderApp).is_none() {
            return; // a server has no materials
        }
        app.register_type::<KeepDry>()
            .register_type::<SurfaceWetting>()
            .init_resource::<WetCopies>()
            .add_systems(Startup, create_state)
            .add_systems(
                PostUpdate,
                (
                    follow_weather.in_set(RainViewSystems::Surfaces),
                    // Bevy looks for changed materials after its asset events. A swap that it sees a frame late is drawn
                    // once with the pipeline of one material and the bindings of the other, which stops the renderer.
                    (
                        (follow_originals, wet_meshes.run_if(resource_exists::<CoverMap>)).run_if(something_is_wet),
                        dry_meshes.run_if(not(something_is_wet)),
                    )
                        .chain()
                        .before(AssetEventSystems),
                )
                    .run_if(resource_exists::<SurfaceState>),
            );
    }
}

fn something_is_wet(surface: Res<SurfaceState>) -> bool {
    surface.wet
}

/// Changes of an original reach its wet copies.
fn follow_originals(
    mut events: MessageReader<AssetEvent<StandardMaterial>>,
    originals: Res<Assets<StandardMaterial>>,
    copies: Res<WetCopies>,
    mut wet: ResMut<Assets<WetMaterial>>,
) {
    for event in events.read() {
        let AssetEvent::Modified { id } = event else { continue };
        let Some(original) = originals.get(*id) else { continue };
        for ((of, _), copy) in copies.0.range((*id, [0; 4])..=(*id, [u32::MAX; 4])) {
            debug_assert_eq!(of, id);
            if let Some(mut material) = wet.get_mut(copy) {
                material.base = original.clone();
            }
        }
    }
}

/// Gives every mesh that has none a wet copy of its material.
fn wet_meshes(
    mut commands: Commands,
    surface: Res<SurfaceState>,
    map: Res<CoverMap>,
    originals: Res<Assets<StandardMaterial>>,
    mut wet: ResMut<Assets<WetMaterial>>,
    mut copies: ResMut<WetCopies>,
    meshes: Query<(Entity, &MeshMaterial3d<StandardMaterial>, Option<&SurfaceWetting>), Without<KeepDry>>,
    exempt: Query<(Entity, &DryMaterial), With<KeepDry>>,
) {
    for (entity, dry) in &exempt {
        commands
            .entity(entity)
            .insert(MeshMaterial3d(dry.0.clone()))
            .remove::<(MeshMaterial3d<WetMaterial>, DryMaterial)>();
    }
    for (entity, material, wetting) in &meshes {
        let Some(original) = originals.get(&material.0) else {
            continue;
        };
        // Glass and other blended surfaces keep their material; so does what is not lit.
        if original.unlit || !matches!(original.alpha_mode, AlphaMode::Opaque | AlphaMode::Mask(_)) {
            continue;
        }
        let wetting = wetting.copied().unwrap_or_default().uniform();
        let key = (material.0.id(), wetting.to_array().map(f32::to_bits));
        let copy = copies.0.entry(key).or_insert_with(|| {
            wet.add(WetMaterial {
                base: original.clone(),
                extension: WetSurface {
                    wetting,
                    cover: map.image.clone(),
                    params: surface.handles.params.clone(),
                },
            })
        });
        commands
            .entity(entity)
            .insert((MeshMaterial3d(copy.clone()), DryMaterial(material.0.clone())))
            .remove::<MeshMaterial3d<StandardMaterial>>();
    }
}

/// Gives every mesh its own material back.
fn dry_meshes(
    mut commands: Commands,
    mut copies: ResMut<WetCopies>,
    meshes: Query<(Entity, &DryMaterial, Has<MeshMaterial3d<StandardMaterial>>)>,
) {
    for (entity, dry, replaced) in &meshes {
        let mut entity = commands.entity(entity);
        entity.remove::<(MeshMaterial3d<WetMaterial>, DryMaterial)>();
        // A material that the app set meanwhile stays.
        if !replaced {
            entity.insert(MeshMaterial3d(dry.0.clone()));
        }
    }
    copies.0.clear();
}
