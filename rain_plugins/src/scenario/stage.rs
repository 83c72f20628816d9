//! Builds a scenario's world: scene, sky, lamps, vehicles, camera, weather.

use std::path::{Path, PathBuf};

use bevy::asset::{LoadState, RecursiveDependencyLoadState, RenderAssetUsages};
use bevy::camera::primitives::Aabb;
use bevy::camera::{Exposure, Hdr, RenderTarget, ScalingMode};
use bevy::core_pipeline::prepass::DepthPrepass;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::gltf::GltfAssetLabel;
use bevy::light::{EnvironmentMapLight, GlobalAmbientLight, Skybox};
use bevy::math::DVec3;
use bevy::post_process::bloom::Bloom;
use bevy::prelude::*;
use bevy::render::render_resource::{
    Extent3d, TextureDimension, TextureFormat, TextureUsages, TextureViewDescriptor, TextureViewDimension,
};
use bevy::world_serialization::{WorldAssetRoot, WorldInstanceReady};
use rain_core::surface::Grate;
use rain_core::surface::basins::{Drain, Inlet};
use rain_ecs::prelude::*;

use super::error::ScenarioError;
use super::file::{Lens, Scenario, Sky};
use super::path::{CameraPath, VehiclePath, wheel_angle_rad};
use super::puddles::PartRoot;
use super::run::RunError;
use super::sky::{Cube, Handedness, SPECULAR_PX, SkyModel, generate, prefilter};
use crate::haze::{HazeSettings, HazeSky, SplashMist};
use crate::lens::{LensDrops, WindscreenWipers};
use crate::rain_bloom::RainBloom;
use crate::rainbow::Rainbow;
use crate::rainfall::RainView;
use crate::render_adapter::{MaskKind, RainMasks, mask_image};
use crate::surface::{KeepDry, MovesInRain, PlanarReflection, WaterLevels};
use crate::waves::{WaterDisturber, WaveWaterSettings};

/// Where the pictures come from.
#[derive(Resource, Clone)]
pub(super) struct Stage {
    pub camera: Entity,
    pub target: Handle<Image>,
    pub masks: Option<RainMasks>,
    /// Roots of glTF files still being spawned.
    waiting: Vec<(PathBuf, Handle<bevy::world_serialization::WorldAsset>, Entity)>,
}

/// A vehicle on its way.
#[derive(Component)]
pub(super) struct OnPath {
    path: VehiclePath,
    scale: f32,
    wheel_prefix: String,
    wheel_radius_m: f64,
    headlights: bool,
}

/// A wheel and how it stood when it was loaded.
#[derive(Component)]
struct Wheel {
    vehicle: Entity,
    rest: Transform,
    /// Its middle in the vehicle's frame.
    place: Vec3,
    /// Units: m.
    radius_m: f32,
}

/// How far springs let a wheel follow the ground. Units: m.
const SPRING_M: f32 = 0.1;

/// The camera's way.
#[derive(Resource)]
pub(super) struct CameraWay(pub CameraPath);

/// Roots whose glTF has been spawned.
#[derive(Resource, Default)]
struct Spawned(Vec<Entity>);

/// Spawns everything of `scenario`; relative files start at `folder`.
pub(super) fn build(app: &mut App, scenario: &Scenario, folder: &Path) -> Result<(), RunError> {
    app.init_resource::<Spawned>();
    app.add_observer(|ready: On<WorldInstanceReady>, mut spawned: ResMut<Spawned>| spawned.0.push(ready.entity));
    let mut waiting = Vec::new();
    for (index, part) in scenario.scene.iter().enumerate() {
        let path = absolute(folder, &part.file)?;
        check_gltf(&path)?;
        let [x, y, z] = part.translation.map(|v| v as f32);
        let transform = Transform::from_xyz(x, y, z)
            .with_rotation(Quat::from_rotation_y(part.yaw_deg.to_radians() as f32))
            .with_scale(Vec3::splat(part.scale as f32));
        let root = spawn_gltf(app, path, transform);
        app.world_mut().entity_mut(root.2).insert(PartRoot(index));
        waiting.push(root);
    }
    for vehicle in &scenario.vehicles {
        let path = absolute(folder, &vehicle.file)?;
        check_gltf(&path)?;
        let root = spawn_gltf(app, path, Transform::from_scale(Vec3::splat(vehicle.scale as f32)));
        app.world_mut().entity_mut(root.2).insert((
            Name::new(vehicle.name.clone()),
            OnPath {
                path: VehiclePath::new(vehicle),
                scale: vehicle.scale as f32,
                wheel_prefix: vehicle.wheel_prefix.clone(),
                wheel_radius_m: vehicle.wheel_radius_m,
                headlights: vehicle.headlights,
            },
        ));
        waiting.push(root);
    }
    light(app, scenario);
    let (stage, sky_diffuse) = camera(app, scenario, waiting);
    app.insert_resource(stage);
    if scenario.environment.probe {
        super::probe::spawn(app, sky_diffuse);
    }
    app.insert_resource(CameraWay(CameraPath::new(scenario)));
    Ok(())
}

fn absolute(folder: &Path, file: &str) -> Result<PathBuf, RunError> {
    let path = folder.join(file);
    std::fs::canonicalize(&path).map_err(|e| RunError::Asset {
        file: path,
        message: e.to_string(),
    })
}

/// Reads a glTF's structure before the engine does, so that what is wrong with it is said in full.
fn check_gltf(path: &Path) -> Result<(), RunError> {
    let bad = |message: String| RunError::Asset {
        file: path.to_path_buf(),
        message,
    };
    let document = gltf::Gltf::open(path).map_err(|e| bad(format!("not a glTF that can be read: {e}")))?;
    if document.scenes().len() == 0 {
        return Err(bad("holds no scene".into()));
    }
    let folder = path.parent().unwrap_or(Path::new("."));
    let buffers = document.buffers().filter_map(|b| match b.source() {
        gltf::buffer::Source::Uri(uri) => Some(uri.to_owned()),
        gltf::buffer::Source::Bin => None,
    });
    let images = document.images().filter_map(|i| match i.source() {
        gltf::image::Source::Uri { uri, .. } => Some(uri.to_owned()),
        gltf::image::Source::View { .. } => None,
    });
    for uri in buffers.chain(images).filter(|u| !u.starts_with("data:")) {
        let decoded = uri.replace("%20", " ");
        if !folder.join(&decoded).is_file() {
            return Err(bad(format!("names {uri}, which is not there")));
        }
    }
    if let Some(blob) = &document.blob {
        for buffer in document.buffers() {
            if matches!(buffer.source(), gltf::buffer::Source::Bin) && blob.len() < buffer.length() {
                return Err(bad(format!(
                    "is cut short: its buffer has {} of {} bytes",
                    blob.len(),
                    buffer.length()
                )));
            }
        }
    }
    Ok(())
}

type Waiting = (PathBuf, Handle<bevy::world_serialization::WorldAsset>, Entity);

fn spawn_gltf(app: &mut App, path: PathBuf, transform: Transform) -> Waiting {
    let handle = app
        .world()
        .resource::<AssetServer>()
        .load(GltfAssetLabel::Scene(0).from_asset(path.clone()));
    let entity = app
        .world_mut()
        .spawn((WorldAssetRoot(handle.clone()), transform, Visibility::default()))
        .id();
    (path, handle, entity)
}

fn light(app: &mut App, scenario: &Scenario) {
    let environment = &scenario.environment;
    let world = app.world_mut();
    // All diffuse light comes from the sky map.
    world.insert_resource(GlobalAmbientLight {
        brightness: 0.0,
        ..default()
    });
    world.insert_resource(ClearColor(Color::BLACK));
    if let Some(sun) = &environment.sun {
        let direction = Vec3::from_array(sun.direction.map(|v| v as f32));
        world.spawn((
            DirectionalLight {
                illuminance: sun.illuminance_lux as f32,
                shadow_maps_enabled: true,
                ..default()
            },
            Transform::default().looking_to(direction, Vec3::Y),
        ));
    }
}

/// A cube map as an image; `levels` from large to small.
pub(super) fn cube_image(levels: &[Cube]) -> Image {
    let size = levels[0].size;
    let face_bytes = |cube: &Cube, face: usize| {
        let bytes = cube.rgba16_bytes();
        let n = bytes.len() / 6;
        bytes[face * n..(face + 1) * n].to_vec()
    };
    let data: Vec<u8> = (0..6)
        .flat_map(|f| levels.iter().flat_map(move |l| face_bytes(l, f)))
        .collect();
    let mut image = Image::new_uninit(
        Extent3d {
            width: size,
            height: size,
            depth_or_array_layers: 6,
        },
        TextureDimension::D2,
        TextureFormat::Rgba16Float,
        RenderAssetUsages::RENDER_WORLD,
    );
    image.data = Some(data);
    image.texture_descriptor.mip_level_count = levels.len() as u32;
    image.texture_view_descriptor = Some(TextureViewDescriptor {
        dimension: Some(TextureViewDimension::Cube),
        ..default()
    });
    image
}

fn camera(app: &mut App, scenario: &Scenario, waiting: Vec<Waiting>) -> (Stage, Cube) {
    let [width, height] = scenario.outputs.size;
    let environment = &scenario.environment;
    let Sky::Overcast(sky) = &environment.sky;
    let model = SkyModel::new(sky, scenario.seed);
    let maps = generate(&model, Handedness::FlippedZ);
    let world = app.world_mut();
    let mut images = world.resource_mut::<Assets<Image>>();
    let mut target = Image::new_target_texture(width, height, TextureFormat::Rgba8UnormSrgb, None);
    target.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    target.asset_usage = RenderAssetUsages::RENDER_WORLD;
    let target = images.add(target);
    let skybox = images.add(cube_image(std::slice::from_ref(&maps.sky)));
    let diffuse = images.add(cube_image(std::slice::from_ref(&maps.diffuse)));
    let specular = images.add(cube_image(&maps.specular));
    let open = Cube::from_fn(SPECULAR_PX, Handedness::FlippedZ, |d| model.radiance(d, false));
    let open = images.add(cube_image(&prefilter(open)));
    let masks = (!scenario.outputs.masks.is_empty()).then(|| RainMasks {
        rain: images.add(mask_image(MaskKind::Rain, width, height)),
        wet: images.add(mask_image(MaskKind::Surface, width, height)),
        depth: images.add(mask_image(MaskKind::Surface, width, height)),
        water: images.add(mask_image(MaskKind::Surface, width, height)),
    });
    let brightness = sky.zenith_luminance_cd_m2 as f32;
    let projection = match scenario.camera.orthographic_m {
        Some(height_m) => Projection::Orthographic(OrthographicProjection {
            scaling_mode: ScalingMode::FixedVertical {
                viewport_height: height_m as f32,
            },
            ..OrthographicProjection::default_3d()
        }),
        None => Projection::Perspective(PerspectiveProjection {
            near: 0.05,
            aspect_ratio: width as f32 / height as f32,
            ..default()
        }),
    };
    let mut camera = world.spawn((
        Name::new("camera"),
        Camera3d::default(),
        Camera {
            is_active: false,
            ..default()
        },
        RenderTarget::from(target.clone()),
        Hdr,
        Tonemapping::AcesFitted,
        Exposure {
            ev100: environment.exposure_ev100 as f32,
        },
        DepthPrepass,
        Msaa::Off,
        Skybox {
            image: Some(skybox),
            brightness,
            ..default()
        },
        EnvironmentMapLight {
            diffuse_map: diffuse,
            specular_map: specular,
            intensity: brightness,
            ..default()
        },
        projection,
        Transform::default(),
    ));
    if environment.bloom {
        camera.insert(Bloom::NATURAL);
    }
    if let Some(visibility) = environment.fog_visibility_m {
        // The veil has the horizon's luminance; fog colours are blended in after exposure.
        let exposed = brightness
            * Exposure {
                ev100: environment.exposure_ev100 as f32,
            }
            .exposure();
        let horizon = sky.tint.map(|t| (t / sky.zenith_to_horizon) as f32 * exposed);
        camera.insert(DistanceFog {
            color: Color::linear_rgb(horizon[0], horizon[1], horizon[2]),
            falloff: FogFalloff::from_visibility_contrast(visibility as f32, 0.02),
            ..default()
        });
    }
    if scenario.rain.enabled {
        camera.insert(RainView {
            enabled: true,
            streak_budget: Some(scenario.rain.streak_budget),
            contrast: scenario.rain.contrast as f32,
            exposure_s: scenario.rain.exposure_s as f32,
            cards: scenario.rain.cards,
            far_rain: scenario.rain.far_rain,
            near_patterns: scenario.rain.near_patterns,
            lamps: scenario.rain.lamps,
            ..default()
        });
        camera.insert(HazeSettings {
            enabled: scenario.rain.haze,
            cloud_base_m: scenario.rain.cloud_base_m as f32,
            glow: scenario.rain.glow as f32,
            splash_mist: (scenario.rain.splash_mist > 0.0).then(|| SplashMist {
                gain: scenario.rain.splash_mist as f32,
                ..default()
            }),
            ..default()
        });
        camera.insert(HazeSky {
            specular_map: open,
            intensity: brightness,
        });
        if scenario.rain.rainbow > 0.0 {
            camera.insert(Rainbow {
                strength: scenario.rain.rainbow as f32,
                ..default()
            });
        }
        if scenario.rain.bloom > 0.0 {
            camera.insert(RainBloom {
                gain: scenario.rain.bloom as f32,
                ..default()
            });
        }
        if environment.reflection {
            camera.insert(PlanarReflection::default());
        }
        match scenario.rain.lens {
            Lens::Off => {}
            Lens::Camera => {
                camera.insert(LensDrops::default());
            }
            Lens::Windscreen(mode) => {
                camera.insert((LensDrops::windscreen(), WindscreenWipers { mode, ..default() }));
            }
        }
        if let Some(masks) = &masks {
            camera.insert(masks.clone());
        }
    }
    let stage = Stage {
        camera: camera.id(),
        target,
        masks: masks.filter(|_| scenario.rain.enabled),
        waiting,
    };
    (stage, maps.diffuse)
}

/// Steps until every glTF stands in the world with all its textures.
pub(super) fn wait_until_loaded(
    app: &mut App,
    mut step: impl FnMut(&mut App) -> Result<(), RunError>,
) -> Result<(), RunError> {
    // Loading is on other threads; ten minutes without an end is a broken file, not a slow disk.
    const PATIENCE: std::time::Duration = std::time::Duration::from_secs(600);
    let start = std::time::Instant::now();
    loop {
        step(app)?;
        let stage = app.world().resource::<Stage>();
        let server = app.world().resource::<AssetServer>();
        let spawned = &app.world().resource::<Spawned>().0;
        let mut done = true;
        for (path, handle, entity) in &stage.waiting {
            let failed = match (
                server.load_state(handle),
                server.recursive_dependency_load_state(handle),
            ) {
                (LoadState::Failed(e), _) => Some(e.to_string()),
                (_, RecursiveDependencyLoadState::Failed(e)) => Some(e.to_string()),
                _ => None,
            };
            if let Some(message) = failed {
                return Err(RunError::Asset {
                    file: path.clone(),
                    message,
                });
            }
            done &= spawned.contains(entity) && server.is_loaded_with_dependencies(handle);
        }
        if done {
            return Ok(());
        }
        if start.elapsed() > PATIENCE {
            return Err(RunError::Renderer(
                "a scene file did not load within ten minutes".into(),
            ));
        }
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
}

/// After loading: lamps to the scenario's strength, wheels found.
pub(super) fn dress(app: &mut App, scenario: &Scenario) {
    let world = app.world_mut();
    let factor = scenario.environment.lamps as f32;
    for mut light in world.query::<&mut PointLight>().iter_mut(world) {
        light.intensity *= factor;
        light.shadow_maps_enabled = false;
    }
    for mut light in world.query::<&mut SpotLight>().iter_mut(world) {
        light.intensity *= factor;
        light.shadow_maps_enabled = false;
    }
    let vehicles: Vec<(Entity, String, bool)> = world
        .query::<(Entity, &OnPath)>()
        .iter(world)
        .map(|(e, v)| (e, v.wheel_prefix.clone(), v.headlights))
        .collect();
    for (vehicle, prefix, headlights) in vehicles {
        world.entity_mut(vehicle).insert(MovesInRain);
        let mut stack = vec![vehicle];
        while let Some(entity) = stack.pop() {
            if let Some(children) = world.get::<Children>(entity) {
                stack.extend(children.iter());
            }
            if !headlights {
                let mut entity = world.entity_mut(entity);
                if entity.contains::<SpotLight>() {
                    entity.insert(Visibility::Hidden);
                }
            }
            let is_wheel = world.get::<Name>(entity).is_some_and(|n| n.starts_with(&prefix));
            if is_wheel && let Some(transform) = world.get::<Transform>(entity) {
                let rest = *transform;
                let global = |e: Entity| world.get::<GlobalTransform>(e).copied().unwrap_or_default();
                let place = global(entity).reparented_to(&global(vehicle)).translation;
                let radius_m = world.get::<OnPath>(vehicle).map_or(0.3, |v| v.wheel_radius_m as f32);
                let wheel = Wheel {
                    vehicle,
                    rest,
                    place,
                    radius_m,
                };
                let disturber = WaterDisturber { radius_m, ..default() };
                let press = FilmPress::wheel(radius_m);
                world.entity_mut(entity).insert((wheel, disturber, press));
            }
        }
    }
    // What shines or is far away is no wet surface.
    let emissive: Vec<Entity> = {
        let mut query = world.query::<(Entity, &MeshMaterial3d<StandardMaterial>)>();
        let materials = world.resource::<Assets<StandardMaterial>>();
        query
            .iter(world)
            .filter(|(_, m)| materials.get(&m.0).is_some_and(|m| m.unlit))
            .map(|(e, _)| e)
            .collect()
    };
    for entity in emissive {
        world.entity_mut(entity).insert(KeepDry);
    }
}

impl OnPath {
    fn pose_at(&self, time_s: f64) -> Transform {
        let pose = self.path.at(time_s);
        Transform {
            translation: Vec3::from_array(pose.position.map(|v| v as f32)),
            rotation: Quat::from_rotation_y(pose.yaw_rad as f32),
            scale: Vec3::splat(self.scale),
        }
    }
}

/// Time of the frame that is being made. Units: s.
#[derive(Resource, Default)]
struct FrameTime(f64);

/// Has vehicles move in the simulation's ticks too: what they do to the ground does not depend on frames.
pub(super) fn move_in_ticks(app: &mut App) {
    app.init_resource::<FrameTime>()
        .add_systems(RainTick, pose_for_tick.in_set(RainSystems::Input))
        .add_systems(Update, pose_for_frame);
}

fn pose_for_tick(clock: Res<RainClock>, mut vehicles: Query<(&OnPath, &mut Transform)>) {
    for (vehicle, mut transform) in &mut vehicles {
        transform.set_if_neq(vehicle.pose_at(clock.now_s()));
    }
}

fn pose_for_frame(time: Res<FrameTime>, mut vehicles: Query<(&OnPath, &mut Transform)>) {
    for (vehicle, mut transform) in &mut vehicles {
        transform.set_if_neq(vehicle.pose_at(time.0));
    }
}

/// Puts vehicles, wheels and camera where they are at `time_s`.
pub(super) fn pose(app: &mut App, time_s: f64) {
    let world = app.world_mut();
    if let Some(mut frame) = world.get_resource_mut::<FrameTime>() {
        frame.0 = time_s;
    }
    let mut turned = Vec::new();
    for (entity, vehicle, mut transform) in world.query::<(Entity, &OnPath, &mut Transform)>().iter_mut(world) {
        let pose = vehicle.path.at(time_s);
        let next = vehicle.pose_at(time_s);
        // A vehicle that stands must not count as moved.
        transform.set_if_neq(next);
        turned.push((entity, next, wheel_angle_rad(pose.distance_m, vehicle.wheel_radius_m)));
    }
    let ground = world.get_resource::<WaterLevels>().cloned().unwrap_or_default();
    for (wheel, mut transform) in world.query::<(&Wheel, &mut Transform)>().iter_mut(world) {
        if let Some((_, vehicle, angle)) = turned.iter().find(|(v, ..)| *v == wheel.vehicle) {
            let mut next = wheel.rest;
            next.rotation *= Quat::from_rotation_x((angle % std::f64::consts::TAU) as f32);
            let at = vehicle.transform_point(wheel.place);
            let sunk = ground
                .ground_at(at.x.into(), at.z.into())
                .map_or(0.0, |height| height + wheel.radius_m - at.y);
            next.translation.y += sunk.clamp(-SPRING_M, SPRING_M) / vehicle.scale.y;
            transform.set_if_neq(next);
        }
    }
    let pose = world.resource::<CameraWay>().0.at(time_s);
    let camera = world.resource::<Stage>().camera;
    let eye = DVec3::from_array(pose.eye).as_vec3();
    let target = DVec3::from_array(pose.target).as_vec3();
    let up = if (target - eye).normalize_or_zero().y.abs() > 0.999 {
        Vec3::NEG_Z
    } else {
        Vec3::Y
    };
    let mut entity = world.entity_mut(camera);
    if let Some(mut transform) = entity.get_mut::<Transform>() {
        transform.set_if_neq(Transform::from_translation(eye).looking_at(target, up));
    }
    if let Some(mut projection) = entity.get_mut::<Projection>() {
        let fov = (pose.fov_y_deg as f32).to_radians();
        if let Projection::Perspective(p) = &*projection
            && p.fov != fov
        {
            let mut next = p.clone();
            next.fov = fov;
            *projection = Projection::Perspective(next);
        }
    }
}

/// Starts the scenario's weather.
pub(super) fn weather(app: &mut App, scenario: &Scenario) -> Result<(), RunError> {
    let timeline = super::weather::core_timeline(scenario)?;
    let mode = match scenario.weather.mode {
        super::weather::WeatherMode::Physical => WeatherMode::Physical,
        super::weather::WeatherMode::Artist => WeatherMode::Artist,
    };
    app.world_mut().resource_mut::<SurfaceSettings>().drains = scenario
        .drains
        .iter()
        .map(|drain| Drain {
            x_m: drain.position[0],
            z_m: drain.position[1],
            inlet: Inlet::Grate(Grate {
                perimeter_m: drain.perimeter_m,
                area_m2: drain.area_m2,
            }),
        })
        .collect();
    super::spouts::spawn(app, scenario);
    let by_hand = WaterByHand {
        wetness: scenario.weather.wetness,
        water_level: scenario.weather.water_level,
        hole_level: scenario.weather.hole_level,
    };
    let levels = scenario.weather.level_curve().map_err(|error| ScenarioError::Io {
        file: scenario.folder.clone(),
        message: error.to_string(),
    })?;
    let mut weather = app.world_mut().spawn((
        Name::new("weather"),
        Weather::default(),
        WeatherTimeline::new(timeline),
        mode,
    ));
    if by_hand.is_set() {
        weather.insert(by_hand);
    }
    if let Some(curve) = levels {
        weather.insert(LevelTimeline::new(curve));
    }
    if let Some(gusts) = scenario.weather.gusts {
        weather.insert(Gusts(gusts));
    }
    if let Some(lightning) = scenario.weather.lightning {
        weather.insert(Lightning(lightning));
    }
    app.insert_resource(RainOutside(scenario.areas.outside));
    for area in &scenario.areas.list {
        app.world_mut()
            .spawn((Name::new(area.name.clone()), RainArea(area.settings())));
    }
    app.insert_resource(scenario.water.appearance());
    if let Some(mut settings) = app.world_mut().get_resource_mut::<WaveWaterSettings>() {
        settings.no_waves = !scenario.water.simulation;
    }
    Ok(())
}

/// Horizontal bounds of every mesh: min x, min z, max x, max z. Units: m.
pub(super) fn bounds(world: &mut World) -> Option<[f64; 4]> {
    let mut out: Option<[f64; 4]> = None;
    for (bounds, transform) in world.query::<(&Aabb, &GlobalTransform)>().iter(world) {
        let centre = transform.affine().transform_point3a(bounds.center);
        let m = transform.affine().matrix3;
        let half = m.x_axis.abs() * bounds.half_extents.x
            + m.y_axis.abs() * bounds.half_extents.y
            + m.z_axis.abs() * bounds.half_extents.z;
        let (low, high) = (centre - half, centre + half);
        if !low.is_finite() || !high.is_finite() {
            continue;
        }
        let b = out.get_or_insert([f64::MAX, f64::MAX, f64::MIN, f64::MIN]);
        b[0] = b[0].min(f64::from(low.x));
        b[1] = b[1].min(f64::from(low.z));
        b[2] = b[2].max(f64::from(high.x));
        b[3] = b[3].max(f64::from(high.z));
    }
    out
}
