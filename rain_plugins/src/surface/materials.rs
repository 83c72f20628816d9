//! Swaps wet materials in and out.

use std::collections::BTreeMap;

use bevy::asset::{AssetEventSystems, AssetId};
use bevy::ecs::query::QueryData;
use bevy::prelude::*;
use rain_core::surface::SurfaceState;
use rain_ecs::prelude::*;

use super::dynamic::{OwnWetness, give_own_wetness};
use super::flow::{FilmFlow, OWN_FLOW};
use super::geometry::SceneGeometryPlugin;
use super::ground::{GroundFilms, LevelsFromGround, follow_films, follow_ground};
use super::look::WetLook;
use super::map::{GroundMap, GroundMapSettings, create_map, follow_map};
use super::mask_view::aim_mask_views;
use super::paint::{NoisePuddles, PuddlePaint};
use super::reflection::{MirrorFrame, PlanarReflection, RainMirrorView, ReflectionSize, aim_mirrors};
use super::state::{self, create_state, follow_weather};
use super::water::{LEVEL_TEXELS, WaterAppearance, WaterImages, WaterLevels, WaveNormalMaps};
use crate::cover::CoverMap;
use crate::render_adapter::{
    RenderApp, WetMaterial, WetSurface, film_image, level_image, map_image, reflection_image, slope_image,
};
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
    /// Wetness of the pores set by hand, whatever the weather and the cover; films and puddles stay the weather's.
    /// Domain: [0, 1]. `None`: the weather's.
    pub wetness: Option<f32>,
    /// Whose rules it looks by. `None`: the [`WetLook`] of all.
    pub look: Option<WetLook>,
    /// Shows this state always, whatever the weather: dry, wet, drenched or puddle (which its level faces alone can be).
    #[reflect(ignore)]
    pub state: Option<SurfaceState>,
    /// How much drops stand on it instead of a film. Units: none. Domain: [0, 1]. `None`: as smooth as its material is,
    /// paint and glass wholly.
    pub beads: Option<f32>,
    /// Whether only faces that look up get wet: walls stay dry, also in slanted rain. Default: false.
    pub ground_only: bool,
}

impl Default for SurfaceWetting {
    fn default() -> Self {
        Self {
            strength: 1.0,
            porosity: None,
            wetness: None,
            look: None,
            state: None,
            beads: None,
            ground_only: false,
        }
    }
}

impl SurfaceWetting {
    /// Whether a wetness is set by hand that shows without rain.
    pub(super) fn is_by_hand(&self) -> bool {
        self.wetness.is_some_and(|wetness| wetness > 0.0)
    }

    fn uniform(self) -> Vec4 {
        let finite = |v: f32, default: f32| if v.is_finite() { v.clamp(0.0, 1.0) } else { default };
        Vec4::new(
            finite(self.strength, 1.0),
            self.porosity.map_or(-1.0, |p| finite(p, 0.5)),
            0.0,
            self.wetness.map_or(-1.0, |w| finite(w, 0.0)),
        )
    }

    /// See `look` in the wet material's shader; `look` is that of all.
    fn look_uniform(self, look: WetLook) -> Vec4 {
        let state = self.state.map_or(0.0, |state| match state {
            SurfaceState::Dry => 1.0,
            SurfaceState::Wet => 2.0,
            SurfaceState::Drenched => 3.0,
            SurfaceState::Puddle => 4.0,
        });
        let ground_only = f32::from(u8::from(self.ground_only));
        let beads = self.beads.map_or(
            -1.0,
            |share| {
                if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 }
            },
        );
        Vec4::new(self.look.unwrap_or(look).number(), state, ground_only, beads)
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

/// How a mesh takes water: what wet copies of one material differ by.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct WetKey {
    uniform: [[u32; 4]; 9],
    painted: Option<AssetId<Image>>,
    flow_map: Option<AssetId<Image>>,
}

/// Wet copies, by original and by how they take water.
#[derive(Resource, Default)]
struct WetCopies(BTreeMap<AssetId<StandardMaterial>, BTreeMap<WetKey, Handle<WetMaterial>>>);

/// Makes every `StandardMaterial` wet where rain reaches it. Needs the cover map: without `CoverPlugin` nothing gets
/// wet.
pub struct WetSurfacePlugin;

impl Plugin for WetSurfacePlugin {
    fn build(&self, app: &mut App) {
        if app.get_sub_app(RenderApp).is_none() {
            return; // a server has no materials
        }
        SceneGeometryPlugin::add_to(app);
        super::auto_paint::build(app);
        app.register_type::<KeepDry>()
            .register_type::<SurfaceWetting>()
            .register_type::<PlanarReflection>()
            .register_type::<PuddlePaint>()
            .register_type::<NoisePuddles>()
            .register_type::<FilmFlow>()
            .register_type::<RainMirrorView>()
            .register_type::<ReflectionSize>()
            .register_type::<WaterAppearance>()
            .register_type::<WetLook>()
            .init_resource::<WetCopies>()
            .init_resource::<MirrorFrame>()
            .init_resource::<ReflectionSize>()
            .register_type::<WaveNormalMaps>()
            .init_resource::<WaterAppearance>()
            .init_resource::<WaveNormalMaps>()
            .init_resource::<WetLook>()
            .init_resource::<WaterLevels>()
            .init_resource::<LevelsFromGround>()
            .init_resource::<GroundFilms>()
            .init_resource::<GroundMapSettings>()
            .add_systems(Startup, (create_state, create_map, create_images).chain())
            .add_systems(
                PostUpdate,
                (
                    give_own_wetness,
                    check_appearance.run_if(resource_changed::<WaterAppearance>),
                    follow_wave_maps.run_if(resource_changed::<WaveNormalMaps>),
                    (
                        follow_weather,
                        follow_ground,
                        follow_films,
                        follow_map.run_if(resource_exists::<GroundMap>),
                        aim_mirrors,
                        aim_mask_views,
                    )
                        .chain()
                        .in_set(RainViewSystems::Surfaces),
                    // Bevy looks for changed materials after its asset events. A swap that it sees a frame late is drawn
                    // once with the pipeline of one material and the bindings of the other, which stops the renderer.
                    (
                        (
                            follow_originals,
                            follow_settings,
                            wet_meshes.run_if(resource_exists::<CoverMap>),
                        )
                            .chain()
                            .run_if(something_is_wet),
                        dry_meshes.run_if(not(something_is_wet)),
                    )
                        .chain()
                        .before(AssetEventSystems),
                )
                    .run_if(resource_exists::<state::SurfaceState>),
            );
    }
}

/// Settings outside their domain are named; until they are mended, water looks as by default.
fn check_appearance(appearance: Res<WaterAppearance>) {
    if let Err(error) = appearance.validated() {
        error!("water looks as by default: {error}");
    }
}

/// All wet materials show the present maps of waves.
fn follow_wave_maps(maps: Res<WaveNormalMaps>, mut wet: ResMut<Assets<WetMaterial>>) {
    if let Err(error) = maps.validated() {
        error!("no normal maps of waves: {error}");
    }
    let images = maps.images().map(|images| images.map(Handle::clone));
    for (_, material) in wet.iter_mut() {
        [material.extension.wave_normals, material.extension.more_wave_normals] = both(images.as_ref());
    }
}

fn both(images: Option<&[Handle<Image>; 2]>) -> [Option<Handle<Image>>; 2] {
    images.map_or([None, None], |images| images.clone().map(Some))
}

fn create_images(mut commands: Commands, mut images: ResMut<Assets<Image>>, map: Option<Res<GroundMap>>) {
    commands.insert_resource(WaterImages {
        levels: images.add(level_image(LEVEL_TEXELS)),
        films: images.add(film_image(LEVEL_TEXELS)),
        map: images.add(map_image(map.map(|map| *map.map().settings()))),
        ripples: images.add(slope_image(256)),
        waves: images.add(slope_image(256)),
        // Of no size before a view asks for a mirror.
        reflection: images.add(reflection_image(UVec2::ONE, 1)),
        caustics: None,
    });
}

/// Painted meshes wear the wet material also when dry: their vertex colours are no tint.
fn something_is_wet(surface: Res<state::SurfaceState>) -> bool {
    surface.shown
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
        for copy in copies.0.get(id).into_iter().flat_map(BTreeMap::values) {
            if let Some(mut material) = wet.get_mut(copy) {
                material.base = original.clone();
            }
        }
    }
}

/// A mesh that may be given a wet copy.
#[derive(QueryData)]
struct Wettable {
    entity: Entity,
    material: &'static MeshMaterial3d<StandardMaterial>,
    wetting: Option<&'static SurfaceWetting>,
    paint: Option<&'static PuddlePaint>,
    noise: Option<&'static NoisePuddles>,
    flow: Option<&'static FilmFlow>,
    own: Option<&'static OwnWetness>,
}

/// Gives every mesh that has none a wet copy of its material.
fn wet_meshes(
    mut commands: Commands,
    surface: Res<state::SurfaceState>,
    look: Res<WetLook>,
    map: Res<CoverMap>,
    water: Res<WaterImages>,
    wave_maps: Res<WaveNormalMaps>,
    originals: Res<Assets<StandardMaterial>>,
    mut wet: ResMut<Assets<WetMaterial>>,
    mut copies: ResMut<WetCopies>,
    mut errors: MessageWriter<RainConfigError>,
    meshes: Query<Wettable, Without<KeepDry>>,
    exempt: Query<(Entity, &DryMaterial), With<KeepDry>>,
) {
    for (entity, dry) in &exempt {
        commands
            .entity(entity)
            .insert(MeshMaterial3d(dry.0.clone()))
            .remove::<(MeshMaterial3d<WetMaterial>, DryMaterial)>();
    }
    let wave_images = wave_maps.images().map(|images| images.map(Handle::clone));
    for mesh in &meshes {
        let id = mesh.material.0.id();
        let Some(original) = originals.get(id) else {
            continue;
        };
        // Glass and other blended surfaces keep their material; so does what is not lit.
        if original.unlit || !matches!(original.alpha_mode, AlphaMode::Opaque | AlphaMode::Mask(_)) {
            continue;
        }
        let mut refuse = |error| {
            errors.write(RainConfigError {
                entity: mesh.entity,
                error,
            });
        };
        // What does not validate counts as absent.
        let paint = mesh.paint.and_then(|p| p.validated().map_err(&mut refuse).ok());
        let noise = mesh.noise.and_then(|n| n.validated().map_err(&mut refuse).ok());
        let flow = mesh.flow.and_then(|f| f.validated().map_err(&mut refuse).ok());
        let refined = mesh.wetting.copied().unwrap_or_default();
        let (mut wetting, look) = (refined.uniform(), refined.look_uniform(*look));
        wetting.z = f32::from(u8::from(mesh.own.is_some()));
        let [paint_uniform, paint_flags] = paint.map_or([Vec4::ZERO; 2], PuddlePaint::uniform);
        let [noise_uniform, noise_flags, ruts, rut_shape] = noise.map_or([Vec4::ZERO; 4], NoisePuddles::uniform);
        let flow_uniform = flow.map_or(OWN_FLOW, FilmFlow::uniform);
        let flow_map = flow.and_then(|flow| flow.map.clone());
        let painted = paint.and_then(PuddlePaint::texture);
        let uniform = [
            wetting,
            paint_uniform,
            paint_flags,
            noise_uniform,
            noise_flags,
            look,
            ruts,
            rut_shape,
            flow_uniform,
        ];
        let key = WetKey {
            uniform: uniform.map(|v| v.to_array().map(f32::to_bits)),
            painted: painted.as_ref().map(Handle::id),
            flow_map: flow_map.as_ref().map(Handle::id),
        };
        let [wave_normals, more_wave_normals] = both(wave_images.as_ref());
        let copy = copies.0.entry(id).or_default().entry(key).or_insert_with(|| {
            wet.add(WetMaterial {
                base: original.clone(),
                extension: WetSurface {
                    wetting,
                    paint: paint_uniform,
                    paint_flags,
                    noise: noise_uniform,
                    noise_flags,
                    look,
                    ruts,
                    rut_shape,
                    flow: flow_uniform,
                    cover: map.image.clone(),
                    params: surface.handles.params.clone(),
                    levels: water.levels.clone(),
                    films: water.films.clone(),
                    map: water.map.clone(),
                    ripples: water.ripples.clone(),
                    waves: water.waves.clone(),
                    reflection: water.reflection.clone(),
                    caustics: water.caustics.clone(),
                    painted,
                    wave_normals,
                    more_wave_normals,
                    flow_map,
                },
            })
        });
        commands
            .entity(mesh.entity)
            .insert((MeshMaterial3d(copy.clone()), DryMaterial(mesh.material.0.clone())))
            .remove::<MeshMaterial3d<StandardMaterial>>();
    }
}

type ChangedWetting = Or<(
    Changed<SurfaceWetting>,
    Changed<PuddlePaint>,
    Changed<NoisePuddles>,
    Changed<FilmFlow>,
    Added<OwnWetness>,
)>;

/// A mesh whose way to take water changed gets its own material back, from which it is made wet anew; all of them when
/// the look of all has changed.
fn follow_settings(
    mut commands: Commands,
    mut shown: Local<WetLook>,
    look: Res<WetLook>,
    changed: Query<(Entity, &DryMaterial), (With<MeshMaterial3d<WetMaterial>>, ChangedWetting)>,
    all: Query<(Entity, &DryMaterial), With<MeshMaterial3d<WetMaterial>>>,
    (mut wetting, mut paint, mut noise, mut flow): (
        RemovedComponents<SurfaceWetting>,
        RemovedComponents<PuddlePaint>,
        RemovedComponents<NoisePuddles>,
        RemovedComponents<FilmFlow>,
    ),
) {
    let everything = std::mem::replace(&mut *shown, *look) != *look;
    let gone = wetting
        .read()
        .chain(paint.read())
        .chain(noise.read())
        .chain(flow.read());
    let gone: Vec<Entity> = gone.filter(|_| !everything).collect();
    let changed = changed.iter().filter(|_| !everything);
    let gone = gone.into_iter().filter_map(|entity| all.get(entity).ok());
    for (entity, dry) in changed.chain(gone).chain(all.iter().filter(|_| everything)) {
        commands
            .entity(entity)
            .insert(MeshMaterial3d(dry.0.clone()))
            .remove::<(MeshMaterial3d<WetMaterial>, DryMaterial)>();
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
