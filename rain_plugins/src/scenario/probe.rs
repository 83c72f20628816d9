//! What surfaces near the camera mirror: the scene itself, drawn into a cube map from the eye before each capture.
//!
//! # Accuracy
//! One point for the whole picture: what stands closer to a mirroring surface than to the eye is mirrored in the wrong
//! place. Diffuse light is mixed from the open sky and from what surrounds the eye, the same for the whole picture.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use bevy::asset::RenderAssetUsages;
use bevy::camera::{Exposure, Hdr, RenderTarget};
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::light::EnvironmentMapLight;
use bevy::prelude::*;
use bevy::render::gpu_readback::{Readback, ReadbackComplete};
use bevy::render::render_resource::{TextureFormat, TextureUsages};

use super::headless;
use super::run::RunError;
use super::sky::{Cube, Handedness, SPECULAR_PX, irradiance, prefilter};
use super::stage::{Stage, cube_image};

/// Updates after which the faces must have come back from the GPU.
const PATIENCE_UPDATES: u32 = 50;

/// Share of the diffuse light that comes from the eye's surroundings, the rest from the open sky. Chosen by eye: at 0
/// streets are lit as if they had no houses, at 1 a street seen from indoors is as dark as the room.
const SURROUNDED: f32 = 0.65;

/// Forward and up of the six cameras.
const FACES: [(Vec3, Vec3); 6] = [
    (Vec3::X, Vec3::Y),
    (Vec3::NEG_X, Vec3::Y),
    (Vec3::Y, Vec3::Z),
    (Vec3::NEG_Y, Vec3::Z),
    (Vec3::Z, Vec3::Y),
    (Vec3::NEG_Z, Vec3::Y),
];

/// Six cameras that stand in the eye, asleep between captures.
#[derive(Resource, Clone)]
pub(super) struct Probe {
    faces: Vec<(Entity, Handle<Image>)>,
    exposure: f32,
    /// Diffuse map of the open sky.
    sky_diffuse: Cube,
}

type Faces = Arc<Mutex<Vec<(usize, Vec<u8>)>>>;

/// Spawns the cameras; they take sky, fog and exposure from the main one.
pub(super) fn spawn(app: &mut App, sky_diffuse: Cube) {
    let world = app.world_mut();
    let camera = world.resource::<Stage>().camera;
    let (Some(skybox), Some(light), Some(exposure)) = (
        world.get::<bevy::light::Skybox>(camera).cloned(),
        world.get::<EnvironmentMapLight>(camera).cloned(),
        world.get::<Exposure>(camera).copied(),
    ) else {
        return;
    };
    let fog = world.get::<DistanceFog>(camera).cloned();
    let mut faces = Vec::new();
    for index in 0..FACES.len() {
        let mut image = Image::new_target_texture(SPECULAR_PX, SPECULAR_PX, TextureFormat::Rgba16Float, None);
        image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
        image.asset_usage = RenderAssetUsages::RENDER_WORLD;
        let image = world.resource_mut::<Assets<Image>>().add(image);
        let mut face = world.spawn((
            Name::new(format!("probe {index}")),
            Camera3d::default(),
            Camera {
                is_active: false,
                order: -10 + index as isize,
                ..default()
            },
            RenderTarget::from(image.clone()),
            Hdr,
            Tonemapping::None,
            exposure,
            Msaa::Off,
            skybox.clone(),
            light.clone(),
            Projection::Perspective(PerspectiveProjection {
                fov: std::f32::consts::FRAC_PI_2,
                aspect_ratio: 1.0,
                near: 0.1,
                ..default()
            }),
            Transform::default(),
        ));
        if let Some(fog) = fog.clone() {
            face.insert(fog);
        }
        faces.push((face.id(), image));
    }
    world.insert_resource(Probe {
        faces,
        exposure: exposure.exposure(),
        sky_diffuse,
    });
}

/// Draws the cube from the main camera's place and lets the camera mirror it. Time stands still meanwhile.
pub(super) fn refresh(app: &mut App) -> Result<(), RunError> {
    let Some(probe) = app.world().get_resource::<Probe>().cloned() else {
        return Ok(());
    };
    let camera = app.world().resource::<Stage>().camera;
    let eye = app
        .world()
        .get::<Transform>(camera)
        .map(|t| t.translation)
        .unwrap_or_default();
    let faces = Faces::default();
    let mut readers = Vec::new();
    let world = app.world_mut();
    for (i, ((entity, image), (forward, up))) in probe.faces.iter().zip(FACES).enumerate() {
        if let Some(mut camera) = world.get_mut::<Camera>(*entity) {
            camera.is_active = true;
        }
        if let Some(mut transform) = world.get_mut::<Transform>(*entity) {
            *transform = Transform::from_translation(eye).looking_to(forward, up);
        }
        let sink = faces.clone();
        let reader = world
            .spawn(Readback::texture(image.clone()))
            .observe(move |done: On<ReadbackComplete>| {
                let mut sink = sink.lock().unwrap_or_else(PoisonError::into_inner);
                if !sink.iter().any(|(k, _)| *k == i) {
                    sink.push((i, done.data.clone()));
                }
            })
            .id();
        readers.push(reader);
    }
    headless::step(app, Duration::ZERO)?;
    for (entity, _) in &probe.faces {
        if let Some(mut camera) = app.world_mut().get_mut::<Camera>(*entity) {
            camera.is_active = false;
        }
    }
    for _ in 0..PATIENCE_UPDATES {
        if faces.lock().unwrap_or_else(PoisonError::into_inner).len() == FACES.len() {
            break;
        }
        headless::step(app, Duration::ZERO)?;
    }
    for reader in readers {
        app.world_mut().despawn(reader);
    }
    let mut drawn = faces.lock().unwrap_or_else(PoisonError::into_inner).clone();
    if drawn.len() != FACES.len() {
        return Err(RunError::Renderer(
            "the reflection probe did not come back from the GPU".into(),
        ));
    }
    drawn.sort_by_key(|(i, _)| *i);
    let texels: Vec<Vec<[f32; 3]>> = drawn.iter().map(|(_, bytes)| half_texels(bytes)).collect();
    let Some(intensity) = app.world().get::<EnvironmentMapLight>(camera).map(|l| l.intensity) else {
        return Ok(());
    };
    // The faces hold exposed radiance; the light multiplies both of its maps by its intensity.
    let scale = 1.0 / (intensity * probe.exposure).max(1e-12);
    let cube = Cube::from_fn(SPECULAR_PX, Handedness::FlippedZ, |d| {
        look_up(&texels, Vec3::from_array(d)).map(|v| v * scale)
    });
    // 32 pixels a face are enough for diffuse light.
    let here = irradiance(&cube.clone().with_smaller()[2]);
    let sky = &probe.sky_diffuse;
    let mixed = Cube::from_fn(sky.size, Handedness::FlippedZ, |d| {
        let (a, b) = (Vec3::from_array(sky.sample(d)), Vec3::from_array(here.sample(d)));
        a.lerp(b, SURROUNDED).to_array()
    });
    let diffuse = cube_image(std::slice::from_ref(&mixed));
    let specular = cube_image(&prefilter(cube));
    let mut images = app.world_mut().resource_mut::<Assets<Image>>();
    let (diffuse, specular) = (images.add(diffuse), images.add(specular));
    if let Some(mut light) = app.world_mut().get_mut::<EnvironmentMapLight>(camera) {
        light.diffuse_map = diffuse;
        light.specular_map = specular;
    }
    Ok(())
}

/// Linear RGB of half-precision RGBA texels.
fn half_texels(bytes: &[u8]) -> Vec<[f32; 3]> {
    // Broken normals of a model make texels that are no numbers; one of them would blacken the whole filtered map.
    let half = |b: &[u8]| {
        let v = half::f16::from_le_bytes([b[0], b[1]]).to_f32();
        if v.is_nan() { 0.0 } else { v.clamp(0.0, 1000.0) }
    };
    bytes
        .chunks_exact(8)
        .map(|t| [half(&t[0..2]), half(&t[2..4]), half(&t[4..6])])
        .collect()
}

/// The drawn value towards a direction, linear between texels.
fn look_up(faces: &[Vec<[f32; 3]>], direction: Vec3) -> [f32; 3] {
    let (index, _) = FACES
        .iter()
        .enumerate()
        .map(|(i, (forward, _))| (i, forward.dot(direction)))
        .fold((0, f32::MIN), |best, next| if next.1 > best.1 { next } else { best });
    let (forward, up) = FACES[index];
    let right = forward.cross(up);
    let depth = forward.dot(direction).max(1e-6);
    let size = SPECULAR_PX as f32;
    let last = size - 1.0;
    let px = (0.5 * (right.dot(direction) / depth + 1.0) * size - 0.5).clamp(0.0, last);
    let py = (0.5 * (1.0 - up.dot(direction) / depth) * size - 0.5).clamp(0.0, last);
    let (x0, y0) = (px as usize, py as usize);
    let (x1, y1) = ((x0 + 1).min(last as usize), (y0 + 1).min(last as usize));
    let (u, v) = (px - x0 as f32, py - y0 as f32);
    let at = |x: usize, y: usize| {
        let t = faces[index]
            .get(y * SPECULAR_PX as usize + x)
            .copied()
            .unwrap_or_default();
        Vec3::from_array(t)
    };
    let top = at(x0, y0).lerp(at(x1, y0), u);
    let bottom = at(x0, y1).lerp(at(x1, y1), u);
    top.lerp(bottom, v).to_array()
}
