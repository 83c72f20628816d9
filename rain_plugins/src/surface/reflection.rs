//! The mirrored view: what level water shows of the scene.

use bevy::camera::visibility::RenderLayers;
use bevy::camera::{CameraProjection, Exposure, SubCameraView};
use bevy::ecs::query::QueryData;
use bevy::light::{EnvironmentMapLight, Skybox};
use bevy::math::Vec3A;
use bevy::prelude::*;

use super::state::SurfaceState;
use super::water::{WaterAppearance, WaterLevels};
use crate::cover::AirAroundView;
use crate::rainfall::RainView;
use crate::render_adapter::{mirror_camera, reflection_target};
use crate::report::{PassName, RainReport, SkipReason};

/// Put on a camera with [`RainView`] and a perspective projection: wet ground mirrors the scene itself, not only the
/// environment map. Costs a second, smaller view of the scene in frames in which the ground is wet. The first such
/// view has it.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default)]
pub struct PlanarReflection {
    /// World height of the mirror; `None`: that of the water ahead. Units: m.
    pub height_m: Option<f32>,
}

/// Size of the mirrored view. Set it before the first update. Units: px. Default: 640 × 360.
#[derive(Resource, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Resource, Default)]
pub struct ReflectionSize(pub UVec2);

impl Default for ReflectionSize {
    fn default() -> Self {
        Self(UVec2::new(640, 360))
    }
}

/// Marks the plugin's own mirrored camera.
#[derive(Component, Reflect, Clone, Copy, Debug, Default)]
#[reflect(Component, Default)]
pub struct RainMirrorView;

/// What the frame's mirror shows.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub struct MirrorFrame {
    /// World to the mirrored view's clip space, the eye it belongs to and the mirror's height in m; `None`: no mirror
    /// this frame.
    pub view: Option<(Mat4, Vec3, f32)>,
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
    sky: Option<&'static Skybox>,
    fog: Option<&'static DistanceFog>,
    layers: Option<&'static RenderLayers>,
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

/// Mirrors the first view that asks for it about the water, or puts the mirror to sleep.
pub(super) fn aim_mirror(
    mut commands: Commands,
    mut frame: ResMut<MirrorFrame>,
    surface: Res<SurfaceState>,
    levels: Res<WaterLevels>,
    appearance: Res<WaterAppearance>,
    size: Res<ReflectionSize>,
    report: Res<RainReport>,
    air: Option<Res<AirAroundView>>,
    views: Query<Mirrored, (With<RainView>, Without<RainMirrorView>)>,
    mut mirrors: Query<
        (
            Entity,
            &mut Camera,
            &mut Transform,
            &mut GlobalTransform,
            &mut Projection,
        ),
        With<RainMirrorView>,
    >,
    mut image_assets: ResMut<Assets<Image>>,
) {
    frame.view = None;
    let view = views.iter().find(|v| v.camera.is_active);
    let found = mirrors.single_mut();
    let reason = match &view {
        None => Some(SkipReason::NoView),
        Some(_) if appearance.reflection_strength <= 0.0 => Some(SkipReason::Disabled),
        Some(_) if !surface.wet => Some(SkipReason::Dry),
        // Where no rain can be in sight, no ground is wet.
        Some(v) if air.as_ref().is_some_and(|a| a.closed_in == Some(v.entity)) => Some(SkipReason::Indoors),
        Some(v) if !matches!(v.projection, Projection::Perspective(_)) => Some(SkipReason::Unsupported),
        Some(_) => None,
    };
    let height = view.as_ref().and_then(|v| {
        let eye = v.transform.translation();
        let height = v
            .reflection
            .height_m
            .or_else(|| water_ahead(&levels, eye, v.transform.forward().into()))
            .or(surface.ground_m);
        height.filter(|h| h.is_finite() && *h < eye.y - 0.02)
    });
    let reason = reason.or(height.is_none().then_some(SkipReason::NoWater));
    if let Some(reason) = reason {
        if view.is_some() || found.is_ok() {
            report.skipped(PassName::Reflection, reason);
        }
        if let Ok((_, mut camera, ..)) = found {
            camera.is_active = false;
        }
        return;
    }
    let (Some(view), Some(height)) = (view, height) else {
        return;
    };
    let Projection::Perspective(own) = view.projection else {
        return;
    };
    let eye = view.transform.translation();
    let reflect = Mat4::from_translation(Vec3::Y * (2.0 * height)) * Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0));
    let world_from_view = reflect * view.transform.to_matrix();
    let transform = Transform::from_matrix(world_from_view);
    // The scene under the plane is not mirrored; the plane in view space looks up.
    let view_from_world = view.transform.affine().matrix3.inverse();
    let normal = (view_from_world * Vec3A::NEG_Y).normalize();
    let normal = Vec3::from(normal);
    let projection = MirrorProjection(PerspectiveProjection {
        near_clip_plane: normal.extend(height - eye.y),
        ..own.clone()
    });
    let clip_from_world = projection.get_clip_from_view() * world_from_view.inverse();
    let Ok((mirror, mut camera, mut own_transform, mut global, mut own_projection)) = found else {
        let target = image_assets.add(reflection_target(size.0));
        commands.spawn((
            RainMirrorView,
            mirror_camera(target),
            transform,
            Projection::custom(projection),
        ));
        return;
    };
    frame.view = Some((clip_from_world, eye, height));
    camera.is_active = true;
    *own_transform = transform;
    *global = GlobalTransform::from(transform);
    *own_projection = Projection::custom(projection);
    let mut mirror = commands.entity(mirror);
    // What lights and veils the view, lights and veils its mirror.
    macro_rules! follow {
        ($($field:ident: $type:ty),*) => {
            $(match view.$field {
                Some(value) => { mirror.insert(value.clone()); }
                None => { mirror.remove::<$type>(); }
            })*
        };
    }
    follow!(exposure: Exposure, environment: EnvironmentMapLight, sky: Skybox, fog: DistanceFog, layers: RenderLayers);
}
