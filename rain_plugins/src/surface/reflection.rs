//! Mirrored views: what level water shows of the scene.

use bevy::camera::visibility::RenderLayers;
use bevy::camera::{CameraProjection, Exposure, SubCameraView};
use bevy::ecs::query::QueryData;
use bevy::light::{EnvironmentMapLight, Skybox};
use bevy::math::Vec3A;
use bevy::prelude::*;
use rain_render::reflection::MAX_MIRRORS;

use super::state::SurfaceState;
use super::water::{WaterAppearance, WaterImages, WaterLevels};
use crate::cover::AirAroundView;
use crate::haze::{HazeSky, HazeViewFrame};
use crate::rainfall::RainView;
use crate::render_adapter::{DeferredPrepass, WetMaterial, mirror_camera, reflection_image, reflection_target};
use crate::report::{PassName, RainReport, SkipReason};

/// Put on a camera with [`RainView`], a perspective projection and forward materials: wet ground mirrors the scene itself,
/// not only the environment map. Costs a second, smaller view of the scene in frames in which the ground is wet. At most
/// [`MAX_MIRRORS`] active views have it, by the order of their cameras.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default)]
pub struct PlanarReflection {
    /// World height of the mirror; `None`: that of the water ahead. Units: m.
    pub height_m: Option<f32>,
}

/// Size of a mirrored view; that of the moment when the first view asks for one holds. Units: px. Default: 640 × 360.
#[derive(Resource, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Resource, Default)]
pub struct ReflectionSize(pub UVec2);

impl Default for ReflectionSize {
    fn default() -> Self {
        Self(UVec2::new(640, 360))
    }
}

/// Marks the plugin's own mirrored cameras.
#[derive(Component, Reflect, Clone, Copy, Debug, Default)]
#[reflect(Component, Default)]
pub struct RainMirrorView {
    /// Layer of the texture that its picture is kept in.
    pub layer: u32,
}

/// A view in its mirror.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MirrorView {
    /// The camera that it belongs to.
    pub of: Entity,
    /// Its eye. Units: m, world.
    pub eye: Vec3,
    /// Where that looks: another view may look elsewhere from the same place.
    pub forward: Vec3,
    /// Of the mirror. Units: m, world.
    pub height: f32,
    /// Its image under the plane.
    pub(crate) mirrored_eye: Vec3,
    /// Places relative to the mirrored eye to its clip space: without the world's large numbers.
    clip_from_mirrored_eye: Mat4,
}

impl MirrorView {
    /// Places relative to `origin` (world, m) to the mirrored view's clip space.
    #[must_use]
    pub fn clip_from(&self, origin: Vec3) -> Mat4 {
        self.clip_from_mirrored_eye * Mat4::from_translation(origin - self.mirrored_eye)
    }
}

/// The frame's mirrors, by layer.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub struct MirrorFrame {
    /// None: no mirror in this layer.
    pub views: [Option<MirrorView>; MAX_MIRRORS],
}

/// The projection of the view that is mirrored, cut off at the mirror; the target's shape does not change it.
#[derive(Debug, Clone)]
struct MirrorProjection(PerspectiveProjection);

impl CameraProjection for MirrorProjection {
    fn get_clip_from_view(&self) -> Mat4 {
        self.0.get_clip_from_view()
    }

    fn get_clip_from_view_for_sub(&self, sub_view: &SubCameraView) -> Mat4 {
        self.0.get_clip_from_view_for_sub(sub_view)
    }

    fn update(&mut self, _width: f32, _height: f32) {}

    fn far(&self) -> f32 {
        self.0.far()
    }

    fn get_frustum_corners(&self, z_near: f32, z_far: f32) -> [Vec3A; 8] {
        self.0.get_frustum_corners(z_near, z_far)
    }
}

#[derive(QueryData)]
pub(super) struct Mirrored {
    entity: Entity,
    camera: &'static Camera,
    transform: &'static GlobalTransform,
    projection: &'static Projection,
    reflection: &'static PlanarReflection,
    exposure: Option<&'static Exposure>,
    environment: Option<&'static EnvironmentMapLight>,
    open_sky: Option<&'static HazeSky>,
    sky: Option<&'static Skybox>,
    fog: Option<&'static DistanceFog>,
    layers: Option<&'static RenderLayers>,
    /// Deferred materials know no mirror.
    deferred: Has<DeferredPrepass>,
}

/// Water farther away than this does not choose the mirror's height. Units: m.
const REACH_M: f32 = 30.0;

/// Height of the water ahead: the mean of the levels before the eye, the nearer the heavier.
fn water_ahead(levels: &WaterLevels, eye: Vec3, forward: Vec3) -> Option<f32> {
    let flat = forward.with_y(0.0).normalize_or_zero();
    let (mut sum, mut weights) = (0.0, 0.0);
    for (at, level) in levels.pools() {
        let to = Vec3::new(at.x as f32 - eye.x, 0.0, at.y as f32 - eye.z);
        let distance = to.length();
        let height = level as f32;
        if distance > REACH_M || to.dot(flat) < 0.5 * distance || height > eye.y - 0.1 {
            continue;
        }
        let weight = 1.0 / (distance * distance).max(4.0);
        sum += weight * height;
        weights += weight;
    }
    (weights > 0.0).then(|| sum / weights)
}

/// Where a mirrored camera stands and how it sees.
struct Aim {
    transform: Transform,
    projection: MirrorProjection,
    view: MirrorView,
}

/// Mirrors a view about the water ahead, or says why not.
fn aim(
    view: &MirroredItem,
    surface: &SurfaceState,
    levels: &WaterLevels,
    strength: f32,
    closed_in: Option<Entity>,
) -> Result<Aim, SkipReason> {
    if strength <= 0.0 {
        return Err(SkipReason::Disabled);
    }
    if !surface.wet && !surface.placed {
        return Err(SkipReason::Dry);
    }
    // Where no rain can be in sight, no ground is wet but by hand.
    let by_hand = surface.placed || surface.by_hand.water_level.is_some_and(|level| level > 0.0);
    if closed_in == Some(view.entity) && !by_hand {
        return Err(SkipReason::Indoors);
    }
    let Projection::Perspective(own) = view.projection else {
        return Err(SkipReason::Unsupported);
    };
    if view.deferred {
        return Err(SkipReason::Unsupported);
    }
    let eye = view.transform.translation();
    let height = view
        .reflection
        .height_m
        .or_else(|| water_ahead(levels, eye, view.transform.forward().into()))
        .or(surface.ground_m)
        .filter(|h| h.is_finite() && *h < eye.y - 0.02)
        .ok_or(SkipReason::NoWater)?;
    let reflect = Mat4::from_translation(Vec3::Y * (2.0 * height)) * Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0));
    let transform = Transform::from_matrix(reflect * view.transform.to_matrix());
    // The scene under the plane is not mirrored; the plane in view space looks up.
    let view_from_world = view.transform.affine().matrix3.inverse();
    let normal = Vec3::from((view_from_world * Vec3A::NEG_Y).normalize());
    // Cameras learn their picture's shape after this; that of the frame before may be another.
    let size = view.camera.physical_viewport_size().unwrap_or_default();
    let projection = MirrorProjection(PerspectiveProjection {
        near_clip_plane: normal.extend(height - eye.y),
        aspect_ratio: if size.min_element() > 0 {
            size.x as f32 / size.y as f32
        } else {
            own.aspect_ratio
        },
        ..own.clone()
    });
    let turned = Mat4::from_mat3(Mat3::from_quat(transform.rotation) * Mat3::from_diagonal(transform.scale));
    Ok(Aim {
        view: MirrorView {
            of: view.entity,
            eye,
            forward: view.transform.forward().into(),
            height,
            mirrored_eye: transform.translation,
            clip_from_mirrored_eye: projection.get_clip_from_view() * turned.inverse(),
        },
        transform,
        projection,
    })
}

#[derive(QueryData)]
#[query_data(mutable)]
pub(super) struct MirrorCamera {
    entity: Entity,
    mirror: &'static RainMirrorView,
    camera: &'static mut Camera,
    transform: &'static mut Transform,
    global: &'static mut GlobalTransform,
    projection: &'static mut Projection,
}

/// Mirrors the views that ask for it about the water, each in its layer, or puts mirrors to sleep.
pub(super) fn aim_mirrors(
    mut commands: Commands,
    mut frame: ResMut<MirrorFrame>,
    surface: Res<SurfaceState>,
    levels: Res<WaterLevels>,
    appearance: Res<WaterAppearance>,
    (wanted_size, water): (Res<ReflectionSize>, Res<WaterImages>),
    report: Res<RainReport>,
    air: Option<Res<AirAroundView>>,
    views: Query<Mirrored, (With<RainView>, Without<RainMirrorView>)>,
    mut mirrors: Query<MirrorCamera>,
    mut images: ResMut<Assets<Image>>,
    mut wet: ResMut<Assets<WetMaterial>>,
    mut kept: Local<(usize, UVec2)>,
) {
    frame.views = default();
    let mut asking: Vec<_> = views.iter().filter(|v| v.camera.is_active).collect();
    asking.sort_by_key(|v| (v.camera.order, v.entity.index_u32()));
    if asking.len() > MAX_MIRRORS {
        warn_once!("{} views ask for a mirror, {MAX_MIRRORS} have one", asking.len());
        asking.truncate(MAX_MIRRORS);
    }
    if asking.is_empty() && !mirrors.is_empty() {
        report.skipped(PassName::Reflection, SkipReason::NoView);
    }
    let closed_in = air.as_ref().and_then(|air| air.closed_in);
    let mut aims: [Option<Aim>; MAX_MIRRORS] = default();
    for (slot, view) in aims.iter_mut().zip(&asking) {
        match aim(view, &surface, &levels, appearance.reflection_strength, closed_in) {
            Ok(aim) => *slot = Some(aim),
            Err(reason) => report.skipped(PassName::Reflection, reason),
        }
    }
    let (layers, size) = &mut *kept;
    if *layers == 0 {
        // Mirrors and the texture that keeps them are of one size for good.
        *size = wanted_size.0;
    }
    let wanted = aims.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
    if wanted > *layers {
        *layers = wanted;
        let grown = images.insert(water.reflection.id(), reflection_image(*size, wanted as u32));
        debug_assert!(grown.is_ok(), "the handle is alive");
        // What is bound is the old texture.
        for _ in wet.iter_mut() {}
    }
    let mut spawned = [false; MAX_MIRRORS];
    for mut own in &mut mirrors {
        let layer = own.mirror.layer as usize;
        let (Some(Some(aim)), Some(view)) = (aims.get(layer), asking.get(layer)) else {
            own.camera.is_active = false;
            continue;
        };
        spawned[layer] = true;
        frame.views[layer] = Some(aim.view);
        own.camera.is_active = true;
        *own.transform = aim.transform;
        *own.global = GlobalTransform::from(aim.transform);
        *own.projection = Projection::custom(aim.projection.clone());
        let mut mirror = commands.entity(own.entity);
        // What lights and veils the view, lights and veils its mirror.
        macro_rules! follow {
            ($($field:ident: $type:ty),*) => {
                $(match view.$field {
                    Some(value) => { mirror.insert(value.clone()); }
                    None => { mirror.remove::<$type>(); }
                })*
            };
        }
        follow!(exposure: Exposure, environment: EnvironmentMapLight, open_sky: HazeSky, sky: Skybox);
        follow!(fog: DistanceFog, layers: RenderLayers);
    }
    for (layer, aim) in (0..).zip(aims) {
        let Some(aim) = aim.filter(|_| !spawned[layer as usize]) else {
            continue;
        };
        let target = images.add(reflection_target(*size));
        commands.spawn((
            RainMirrorView { layer },
            mirror_camera(target),
            HazeViewFrame::default(),
            aim.transform,
            Projection::custom(aim.projection),
        ));
    }
}
