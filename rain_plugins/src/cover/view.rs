//! The cover camera: where it stands, and when it draws.

use bevy::asset::RenderAssetUsages;
use bevy::camera::primitives::Aabb;
use bevy::camera::visibility::{InheritedVisibility, RenderLayers};
use bevy::ecs::query::QueryData;
use bevy::light::cluster::Clusters;
use bevy::math::{DVec2, DVec3, Vec3Swizzles as _};
use bevy::prelude::*;
use rain_core::cover::{FallSlope, ShearedOrthographic, ShearedOrthographicSettings};
use rain_ecs::prelude::*;
use rain_render::cover::CoverPlacement;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use super::air::{AirAroundView, Surroundings, judge_air};
use super::projection::ShearedProjection;
use crate::rainfall::{RainView, ViewPlace, leading_view};
use crate::render_adapter::{DeferredPrepass, RenderApp, cover_camera, cover_image};
use crate::report::{PassName, RainReport, SkipReason};
use crate::schedule::RainViewSystems;
use crate::surface::{SceneGeometryPlugin, SurfaceState};

/// Settings of the cover map. Changes take effect with the next redraw, `texels` only before the app's first update.
#[derive(Resource, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Resource, Default)]
pub struct CoverSettings {
    /// Side of the covered square. Units: m. Domain: [10, 400]. Default: 60.
    pub extent_m: f32,
    /// Texels per side. Domain: [64, 4096]. Default: 1024.
    pub texels: u32,
    /// How far the eye may move off the map's centre before it is drawn anew. Units: m. Default: 6.
    pub margin_m: f32,
    /// Off: nothing stops rain.
    pub enabled: bool,
}

impl Default for CoverSettings {
    fn default() -> Self {
        Self {
            extent_m: 60.0,
            texels: 1024,
            margin_m: 6.0,
            enabled: true,
        }
    }
}

/// Marks the plugin's own depth-only camera.
#[derive(Component, Reflect, Clone, Copy, Debug, Default)]
#[reflect(Component, Default)]
pub struct RainCoverView;

/// The kept map: where it lies and the texture that holds it.
#[derive(Resource, Clone, Debug)]
pub struct CoverMap {
    /// Texels per side: those of the settings when the app started.
    pub texels: u32,
    /// Depth texture (Depth32Float), valid once `placement` is set.
    pub image: Handle<Image>,
    /// Where the kept map lies; `None` until it has been drawn once.
    pub placement: Option<CoverPlacement>,
    /// True in frames that draw it.
    pub redraw: bool,
    /// The projection it was drawn with, and the fall it was drawn along.
    drawn: Option<(ShearedOrthographic, FallSlope)>,
    /// Set by the render world when a drawn map held every mesh that was ready to be drawn.
    pub(crate) complete: Arc<AtomicBool>,
}

/// Heights beyond this above or below the eye do not cover (sky domes). Units: m.
const VERTICAL_REACH_M: f32 = 150.0;

/// The fall direction may turn by this before the map is drawn anew. Units: rad.
const DIRECTION_TOLERANCE: f64 = std::f64::consts::PI / 180.0;

/// Draws and keeps the cover map.
pub struct CoverPlugin;

impl Plugin for CoverPlugin {
    fn build(&self, app: &mut App) {
        if app.get_sub_app(RenderApp).is_none() {
            return; // a server draws no map
        }
        SceneGeometryPlugin::add_to(app);
        app.init_resource::<CoverSettings>()
            .register_type::<CoverSettings>()
            .register_type::<RainCoverView>()
            .add_systems(Startup, create_map)
            .add_systems(
                PostUpdate,
                (
                    spawn_view,
                    follow_deferred,
                    watch_occluders.run_if(map_is_wanted),
                    aim_view,
                    judge_air,
                )
                    .chain()
                    .in_set(RainViewSystems::Cover),
            )
            .init_resource::<OccluderWatch>()
            .init_resource::<AirAroundView>()
            .init_resource::<Surroundings>();
    }
}

fn create_map(mut commands: Commands, mut images: ResMut<Assets<Image>>, settings: Res<CoverSettings>) {
    let texels = settings.texels.clamp(64, 4096);
    let mut image = cover_image(texels);
    image.asset_usage = RenderAssetUsages::RENDER_WORLD;
    commands.insert_resource(CoverMap {
        texels,
        image: images.add(image),
        placement: None,
        redraw: false,
        drawn: None,
        complete: Arc::default(),
    });
}

/// Spawned after the first [`RainView`], never in `Startup`: plugins that adopt "the first new camera" must find the
/// game's camera, not this one.
fn spawn_view(
    mut commands: Commands,
    settings: Res<CoverSettings>,
    map: Res<CoverMap>,
    views: Query<Option<&RenderLayers>, With<RainView>>,
    cover: Query<(), With<RainCoverView>>,
) {
    let Some(layers) = views.iter().next() else { return };
    if !cover.is_empty() || !settings.enabled {
        return;
    }
    let Ok(projection) = ShearedOrthographic::new(ShearedOrthographicSettings::default()) else {
        return;
    };
    let mut entity = commands.spawn((
        RainCoverView,
        cover_camera(map.texels),
        Projection::custom(ShearedProjection(projection)),
    ));
    // Without clusters the view is not lit, so no shadow cascades are rendered for it.
    entity.remove::<Clusters>();
    if let Some(layers) = layers {
        entity.insert(layers.clone());
    }
}

/// Deferred materials are drawn in deferred prepasses alone, and Bevy's renderer stops at a view with another prepass: the
/// cover view has one where a view of rain has.
fn follow_deferred(
    mut commands: Commands,
    views: Query<Has<DeferredPrepass>, With<RainView>>,
    cover: Query<(Entity, Has<DeferredPrepass>), With<RainCoverView>>,
) {
    let wanted = views.iter().any(|deferred| deferred);
    for (entity, deferred) in &cover {
        if wanted && !deferred {
            commands.entity(entity).insert(DeferredPrepass);
        } else if deferred && !wanted {
            commands.entity(entity).remove::<DeferredPrepass>();
        }
    }
}

/// What the watch has seen since the map was last drawn.
#[derive(Resource, Default)]
struct OccluderWatch {
    changed: bool,
    /// Heights of everything that covers near the view. Units: m.
    top: f32,
    bottom: f32,
    count: usize,
}

type Occluder = (
    Ref<'static, GlobalTransform>,
    Ref<'static, Mesh3d>,
    &'static Aabb,
    Ref<'static, InheritedVisibility>,
);

/// Something falls or is wet: while the scene is dry, meshes are not looked at.
fn map_is_wanted(field: Res<RainfallField>, surface: Option<Res<SurfaceState>>) -> bool {
    field.is_raining() || surface.is_some_and(|s| s.wet)
}

/// Notes whether anything that covers near the view has moved, appeared, vanished or changed.
fn watch_occluders(
    mut watch: ResMut<OccluderWatch>,
    settings: Res<CoverSettings>,
    views: Query<(Entity, &Camera, ViewPlace), With<RainView>>,
    occluders: Query<Occluder>,
    mut removed: RemovedComponents<Mesh3d>,
    mut meshes: MessageReader<AssetEvent<Mesh>>,
    mut materials: MessageReader<AssetEvent<StandardMaterial>>,
    mut images: MessageReader<AssetEvent<Image>>,
) {
    let asset_changed = meshes.read().any(|e| matches!(e, AssetEvent::Modified { .. }))
        | materials.read().any(|e| matches!(e, AssetEvent::Modified { .. }))
        // An alpha-masked leaf covers only once its texture is there.
        | images.read().any(|e| matches!(e, AssetEvent::LoadedWithDependencies { .. }));
    let gone = removed.read().count() > 0;
    watch.changed |= asset_changed | gone;
    let Some(eye) = leading_view(views).map(|view| view.place()) else {
        return;
    };
    let reach = settings.extent_m;
    let (mut top, mut bottom, mut count) = (f32::MIN, f32::MAX, 0);
    for (transform, mesh, bounds, visible) in &occluders {
        let centre = transform.affine().transform_point3a(bounds.center);
        let radius = transform.radius_vec3a(bounds.half_extents);
        let offset = Vec3::from(centre) - eye;
        if offset.xz().abs().max_element() > reach + radius {
            continue;
        }
        if transform.is_changed() || mesh.is_changed() || visible.is_changed() {
            watch.changed = true;
        }
        if visible.get() {
            let m = transform.affine().matrix3;
            let half = m.x_axis.y.abs() * bounds.half_extents.x
                + m.y_axis.y.abs() * bounds.half_extents.y
                + m.z_axis.y.abs() * bounds.half_extents.z;
            top = top.max(centre.y + half);
            bottom = bottom.min(centre.y - half);
            count += 1;
        }
    }
    if count != watch.count {
        watch.changed = true;
        watch.count = count;
    }
    (watch.top, watch.bottom) = (top, bottom);
}

#[derive(QueryData)]
struct SeenFrom {
    around: ViewPlace,
    layers: Option<&'static RenderLayers>,
}

#[derive(QueryData)]
#[query_data(mutable)]
struct CoverCamera {
    entity: Entity,
    transform: &'static mut Transform,
    global: &'static mut GlobalTransform,
    camera: &'static mut Camera,
    projection: &'static mut Projection,
    layers: Option<&'static RenderLayers>,
}

/// The place around which the map is drawn: amid all eyes if none is farther than `reach` from there, else that of the
/// leading one; the others then see open sky beyond the map.
fn centre_of(lead: DVec3, eyes: impl IntoIterator<Item = DVec3>, reach: f64) -> DVec3 {
    let (low, high) = eyes
        .into_iter()
        .filter(|eye| eye.is_finite())
        .fold((lead, lead), |(low, high), eye| (low.min(eye), high.max(eye)));
    let apart = (high - low).xz().max_element();
    if apart <= 2.0 * reach {
        (0.5 * (low + high)).with_y(lead.y)
    } else {
        warn_once!(
            "views lie {apart:.0} m apart: rain passes through roofs around those that the cover map does not reach"
        );
        lead
    }
}

/// Points the cover camera and decides whether this frame draws it.
fn aim_view(
    mut map: ResMut<CoverMap>,
    mut watch: ResMut<OccluderWatch>,
    settings: Res<CoverSettings>,
    report: Res<RainReport>,
    field: Res<RainfallField>,
    surface: Option<Res<SurfaceState>>,
    mut commands: Commands,
    views: Query<(Entity, &Camera, SeenFrom), (With<RainView>, Without<RainCoverView>)>,
    mut cover: Query<CoverCamera, With<RainCoverView>>,
) {
    map.redraw = false;
    let Ok(CoverCameraItem {
        entity,
        mut transform,
        mut global,
        mut camera,
        mut projection,
        layers,
    }) = cover.single_mut()
    else {
        return;
    };
    camera.is_active = false;
    let lead = leading_view(views);
    // What the leading view sees is what covers.
    let seen = lead.as_ref().and_then(|l| l.layers);
    if lead.is_some() && layers != seen {
        watch.changed = true;
        match seen {
            Some(seen) => commands.entity(entity).insert(seen.clone()),
            None => commands.entity(entity).remove::<RenderLayers>(),
        };
    }
    let margin = f64::from(settings.margin_m.clamp(0.0, 0.45 * settings.extent_m));
    let extent = f64::from(settings.extent_m.clamp(10.0, 400.0));
    let active = views.iter().filter(|(_, camera, _)| camera.is_active);
    let view = lead.map(|l| {
        let own = l.around.place().as_dvec3();
        centre_of(
            own,
            active.map(|(_, _, v)| v.around.place().as_dvec3()),
            0.5 * extent - margin,
        )
    });
    let wet = surface.is_some_and(|s| s.wet);
    let reason = match view {
        _ if !settings.enabled => Some(SkipReason::Disabled),
        None => Some(SkipReason::NoView),
        Some(_) if !wet && !field.is_raining() => Some(SkipReason::Dry),
        Some(_) => None,
    };
    if let Some(reason) = reason {
        report.skipped(PassName::Cover, reason);
        // Nobody watches meanwhile: whatever happens counts as a change.
        watch.changed = true;
        return;
    }
    let eye = view.unwrap_or_default();
    let wind = field.mean_wind_m_s();
    let Ok(slope) = FallSlope::new(DVec2::new(wind.x, wind.z), field.mean_inverse_velocity_s_m()) else {
        report.skipped(PassName::Cover, SkipReason::Disabled);
        return;
    };
    let kept = map.drawn.as_ref().is_some_and(|(drawn, along)| {
        drawn.holds(eye, 0.5 * extent - margin)
            && along.angle_to(&slope) <= DIRECTION_TOLERANCE
            && (drawn.settings().extent_m - extent).abs() < 1e-9
            && (drawn.settings().low_m..drawn.settings().high_m).contains(&eye.y)
    });
    if kept && !watch.changed && map.complete.load(Relaxed) {
        report.skipped(PassName::Cover, SkipReason::NothingMoved);
        return;
    }
    let (top, bottom) = if watch.count == 0 {
        (eye.y as f32 + 1.0, eye.y as f32 - 1.0)
    } else {
        (
            (watch.top + 0.5).min(eye.y as f32 + VERTICAL_REACH_M),
            (watch.bottom - 0.5).max(eye.y as f32 - VERTICAL_REACH_M),
        )
    };
    let high_m = f64::from(top.max(bottom + 1.0));
    let drawn = ShearedOrthographic::new(ShearedOrthographicSettings {
        centre: eye,
        extent_m: extent,
        texels: map.texels,
        low_m: f64::from(bottom),
        high_m,
        // Texels are anchored in this plane: it must not follow the eye step by step.
        reference_height_m: (eye.y / 1000.0).round() * 1000.0,
        drift: slope.drift(),
    });
    let Ok(drawn) = drawn else {
        report.skipped(PassName::Cover, SkipReason::Disabled);
        return;
    };
    watch.changed = false;
    map.redraw = true;
    *transform =
        Transform::from_translation(drawn.camera_position().as_vec3()).with_rotation(drawn.camera_rotation().as_quat());
    *global = GlobalTransform::from(*transform);
    *projection = Projection::custom(ShearedProjection(drawn));
    camera.is_active = true;
    map.placement = Some(CoverPlacement {
        centre_m: drawn.corner() + 0.5 * extent,
        plane_m: drawn.settings().reference_height_m,
        extent_m: extent,
        top_m: high_m,
        range_m: high_m - drawn.settings().low_m,
        highest_m: high_m,
        wind_m_s: slope.wind_m_s(),
        inverse_speed_s_m: slope.mean_inverse_speed_s_per_m(),
        texels: map.texels,
    });
    map.drawn = Some((drawn, slope));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_lies_amid_views_that_it_can_hold() {
        let eye = |x: f64, z: f64| DVec3::new(x, 1.7, z);
        let lead = eye(0.0, 0.0);
        assert_eq!(centre_of(lead, [lead], 24.0), lead);
        assert_eq!(
            centre_of(lead, [lead, DVec3::new(20.0, 9.0, -8.0)], 24.0),
            eye(10.0, -4.0)
        );
        assert_eq!(centre_of(lead, [lead, eye(0.0, 49.0)], 24.0), lead);
        assert_eq!(centre_of(lead, [lead, DVec3::NAN], 24.0), lead);
    }
}
