//! Light on the scene while a flash lasts.

use std::f32::consts::PI;

use bevy::camera::visibility::NoFrustumCulling;
use bevy::ecs::system::SystemParam;
use bevy::light::{DirectionalLight, GlobalAmbientLight, NotShadowCaster, NotShadowReceiver, Skybox};
use bevy::math::DVec3;
use bevy::prelude::*;
use rain_core::haze::{EXTINCTION_EFFICIENCY, extinction_per_m};
use rain_core::lightning::{FlashLight, LONGEST_FLASH_S};
use rain_ecs::lightning::ActiveFlash;
use rain_ecs::prelude::*;

use super::settings::LightningLook;
use super::shapes;
use crate::held::Held;
use crate::rainfall::{RainView, leading_view};
use crate::render_adapter::LightningMaterial;
use crate::surface::{KeepDry, MovesInRain};

/// Colour of a channel of some 25 000 K, of luminance 1. Linear.
const COLOUR: Vec3 = Vec3::new(0.78, 0.96, 2.0);
/// Shortest time that light is averaged over: an eye's and a camera's exposure. Units: s.
const EXPOSURE_S: f32 = 1.0 / 60.0;
/// Longest: of the frames that take longer, the last part. Units: s.
const LONGEST_EXPOSURE_S: f32 = 0.1;
/// Of the light that rain takes out of the direct way, what still arrives, from everywhere. By eye.
const SCATTERED: f32 = 0.5;
/// Luminance that clouds beside the glow get, as a share of the mean over the sky. By eye: at 0 a sky is cut out behind
/// what the flash lights.
const SKY_SHARE: f32 = 0.5;
/// Luminous width of a channel. Units: m.
const WIDTH_M: f32 = 0.05;
/// Narrowest that a channel is drawn. Units: px. Its light is that of its true width.
const LEAST_PX: f32 = 1.8;

/// Marks the directional light that lightning owns. It is hidden while nothing flashes.
#[derive(Component, Reflect, Clone, Copy, Debug, Default)]
#[reflect(Component, Default)]
pub struct LightningLight;

/// Things in the world that show a flash; kept for the next when it is over.
#[derive(Debug)]
struct Slot {
    flash: Option<u64>,
    /// Channel, branches, glow.
    parts: [Entity; 3],
    materials: [Handle<LightningMaterial>; 3],
    /// As drawn. Units: m.
    width_m: f32,
    /// Channel and branches are drawn.
    is_seen: bool,
}

/// What is in the world for flashes.
#[derive(Resource, Default, Debug)]
pub(super) struct Shown {
    light: Option<Entity>,
    glow_mesh: Option<Handle<Mesh>>,
    slots: Vec<Slot>,
    ambient: Held<f32>,
    skies: Vec<(Entity, Held<f32>)>,
    /// The last frame showed something.
    lit: bool,
    good: LightningLook,
}

/// Whether a flash may be on, the last frame showed one, or a storm has just begun.
pub(super) fn something_flashes(clock: Res<RainClock>, sky: Res<ActiveLightning>, shown: Res<Shown>) -> bool {
    let now_s = frame_time(&clock);
    let on = |active: &ActiveFlash| active.flash.time_s <= now_s && active.flash.time_s + LONGEST_FLASH_S + 0.2 > now_s;
    shown.lit || (sky.is_on() && shown.slots.is_empty()) || sky.flashes().iter().any(on)
}

/// Time that the frame shows. Units: s.
fn frame_time(clock: &RainClock) -> f64 {
    clock.now_s() + f64::from(clock.interpolation()) * clock.tick_ns() as f64 * 1e-9
}

/// The view that flashes are shown to.
#[derive(Clone, Copy)]
struct Eye {
    at: DVec3,
    /// Width of a pixel at a distance of 1.
    pixel: f32,
}

type Seeing = (
    Entity,
    &'static Camera,
    &'static GlobalTransform,
    &'static Projection,
    Has<RainView>,
);

fn eye(views: &Query<Seeing, With<Camera3d>>) -> Option<Eye> {
    let of = |marked: bool| {
        let views = views.iter().filter(|(.., is_marked)| *is_marked == marked);
        leading_view(views.map(|(entity, camera, at, projection, _)| (entity, camera, (camera, at, projection))))
    };
    let (camera, at, projection) = of(true).or_else(|| of(false))?;
    let height = camera.physical_viewport_size().map_or(720, |size| size.y).max(1);
    let half_tan = 1.0 / projection.get_clip_from_view().y_axis.y.abs().max(1e-3);
    Some(Eye {
        at: at.translation().as_dvec3(),
        pixel: 2.0 * half_tan / height as f32,
    })
}

/// What flashes light.
#[derive(SystemParam)]
pub(super) struct Lit<'w, 's> {
    ambient: Option<ResMut<'w, GlobalAmbientLight>>,
    skies: Query<'w, 's, (Entity, &'static mut Skybox)>,
    lights: Query<
        'w,
        's,
        (
            &'static mut DirectionalLight,
            &'static mut Transform,
            &'static mut Visibility,
        ),
        With<LightningLight>,
    >,
    parts: Query<'w, 's, &'static mut Visibility, (With<MeshMaterial3d<LightningMaterial>>, Without<LightningLight>)>,
    meshes: Option<ResMut<'w, Assets<Mesh>>>,
    materials: Option<ResMut<'w, Assets<LightningMaterial>>>,
}

/// Takes away what the last frame's flash has added, before anybody else looks at it: clouds dim what is the app's own.
pub(super) fn take_back(
    mut shown: ResMut<Shown>,
    ambient: Option<ResMut<GlobalAmbientLight>>,
    mut skies: Query<&mut Skybox>,
) {
    if let Some(mut ambient) = ambient
        && let Some(own) = shown.ambient.take_back(ambient.brightness)
    {
        ambient.brightness = own;
    }
    for (entity, mut held) in shown.skies.drain(..) {
        if let Ok(mut sky) = skies.get_mut(entity)
            && let Some(own) = held.take_back(sky.brightness)
        {
            sky.brightness = own;
        }
    }
}

/// Whether the last frame showed a flash.
pub(super) fn was_lit(shown: Res<Shown>) -> bool {
    shown.lit
}

pub(super) fn show_lightning(
    mut commands: Commands,
    time: Res<Time>,
    clock: Res<RainClock>,
    sky: Res<ActiveLightning>,
    look: Res<LightningLook>,
    field: Res<RainfallField>,
    rain: RainQueries,
    views: Query<Seeing, With<Camera3d>>,
    mut shown: ResMut<Shown>,
    mut lit: Lit,
) {
    let shown = &mut *shown;
    if look.is_changed() {
        match look.validated() {
            Ok(good) => shown.good = good,
            Err(error) => error!("lightning: {error}"),
        }
    }
    let look = shown.good;
    let now_s = frame_time(&clock);
    let window_s = time.delta_secs().clamp(EXPOSURE_S, LONGEST_EXPOSURE_S);
    let extinction = extinction_per_m(field.spectrum(), EXTINCTION_EFFICIENCY) as f32;
    let (mut direct, mut towards, mut ambient) = (0.0, Vec3::ZERO, 0.0);
    let (mut on, mut going_on) = (Vec::new(), Vec::new());
    for active in sky.flashes() {
        let Some(eye) = eye(&views).filter(|_| look.enabled && look.gain > 0.0) else {
            break;
        };
        let since_s = now_s - active.flash.time_s;
        if (0.0..active.flash.duration_s() + 0.1).contains(&since_s) {
            going_on.push(active.flash.id);
        }
        let [all, first] = active.flash.mean_current_a(now_s - f64::from(window_s), now_s);
        if all <= 0.1 {
            continue;
        }
        let currents = [all, first].map(|current| current as f32 * look.gain);
        let light = FlashLight::at(&active.flash, &active.channel, eye.at);
        let lux = currents[0] * light.direct_lux_a[0] as f32 + currents[1] * light.direct_lux_a[1] as f32;
        // Half of what drops take out is bent so little that it still comes from the flash.
        let way = light.distance_m * light.towards;
        let passed = rain.seen_through(eye.at, eye.at + way).sqrt() as f32;
        direct += lux * passed;
        towards += lux * passed * light.towards.as_vec3();
        ambient += SCATTERED * lux * (1.0 - passed);
        let under = rain
            .seen_through(eye.at, eye.at + active.flash.cloud_base_m * DVec3::Y)
            .sqrt() as f32;
        ambient += currents[0] * light.glow_lux_a as f32 * (SCATTERED + (1.0 - SCATTERED) * under);
        on.push((active, light, currents, eye));
    }
    shown.lit = !on.is_empty() || !going_on.is_empty();
    if look.enabled && shown.slots.is_empty() {
        warm_up(&mut commands, shown, &mut lit);
    }
    light_scene(&mut commands, shown, &mut lit, direct, towards, ambient, look.shadows);
    show_channels(&mut commands, shown, &mut lit, &on, &going_on, extinction);
}

/// Directional light, ambient light and sky.
fn light_scene(
    commands: &mut Commands,
    shown: &mut Shown,
    lit: &mut Lit,
    direct_lux: f32,
    towards: Vec3,
    ambient_lux: f32,
    shadows: bool,
) {
    let mean = ambient_lux / PI;
    if mean > 0.0 {
        if let Some(ambient) = &mut lit.ambient
            && let Some(sum) = shown.ambient.write(ambient.brightness, |own| own + mean)
        {
            ambient.brightness = sum;
        }
        for (entity, mut sky) in &mut lit.skies {
            let mut held = Held::default();
            if let Some(sum) = held.write(sky.brightness, |own| own + SKY_SHARE * mean) {
                sky.brightness = sum;
            }
            shown.skies.push((entity, held));
        }
    }
    let pose = Transform::default().looking_to(-towards.normalize_or(Vec3::Y), Vec3::X);
    let light = DirectionalLight {
        color: Color::linear_rgb(COLOUR.x, COLOUR.y, COLOUR.z),
        illuminance: direct_lux,
        shadow_maps_enabled: shadows,
        ..default()
    };
    match shown.light.and_then(|entity| lit.lights.get_mut(entity).ok()) {
        Some((mut own, mut transform, mut visible)) if direct_lux > 0.0 => {
            (*own, *transform, *visible) = (light, pose, Visibility::Visible);
        }
        Some((.., mut visible)) => {
            visible.set_if_neq(Visibility::Hidden);
        }
        None if direct_lux > 0.0 => {
            let name = Name::new("lightning");
            shown.light = Some(
                commands
                    .spawn((name, LightningLight, light, pose, Visibility::Visible))
                    .id(),
            );
        }
        None => {}
    }
}

/// Channels, branches and glow.
fn show_channels(
    commands: &mut Commands,
    shown: &mut Shown,
    lit: &mut Lit,
    on: &[(&ActiveFlash, FlashLight, [f32; 2], Eye)],
    going_on: &[u64],
    extinction: f32,
) {
    let (Some(meshes), Some(materials)) = (&mut lit.meshes, &mut lit.materials) else {
        return; // a server draws nothing
    };
    for slot in &mut shown.slots {
        let Some(id) = slot.flash else { continue };
        let is_on = on.iter().any(|(active, ..)| active.flash.id == id);
        // Between strokes it is dark, and kept.
        if !is_on && !going_on.contains(&id) {
            slot.flash = None;
        }
        for (part, entity) in slot.parts.into_iter().enumerate() {
            let is_shown = is_on && (part == 2 || slot.is_seen);
            if let Ok(mut visible) = lit.parts.get_mut(entity) {
                visible.set_if_neq(if is_shown {
                    Visibility::Visible
                } else {
                    Visibility::Hidden
                });
            }
        }
    }
    for (active, light, currents, eye) in on {
        let known = shown.slots.iter().position(|slot| slot.flash == Some(active.flash.id));
        let index = known.unwrap_or_else(|| {
            let width_m = WIDTH_M.max(LEAST_PX * eye.pixel * light.distance_m as f32);
            let origin = active.flash.place_m;
            let channel = &active.channel;
            let glow = shown
                .glow_mesh
                .get_or_insert_with(|| meshes.add(shapes::glow()))
                .clone();
            let tubes = |paths: &[&[DVec3]], width_m: f32| shapes::tubes(paths.iter().copied(), origin, width_m);
            let branches: Vec<&[DVec3]> = channel.branches().iter().map(Vec::as_slice).collect();
            // Within the cloud there is nothing to be seen but the glow.
            let is_seen = !channel.seen().is_empty();
            let all = [
                is_seen.then(|| meshes.add(tubes(&[channel.seen()], width_m))),
                is_seen.then(|| meshes.add(tubes(&branches, 0.6 * width_m))),
                Some(glow),
            ];
            let base = origin.y + active.flash.cloud_base_m;
            let places = [origin, origin, channel.glow_centre().with_y(base)].map(|at| at.as_vec3());
            let index = match shown.slots.iter().position(|slot| slot.flash.is_none()) {
                Some(index) => index,
                None => {
                    shown.slots.push(new_slot(commands, materials));
                    shown.slots.len() - 1
                }
            };
            let slot = &mut shown.slots[index];
            (slot.flash, slot.width_m, slot.is_seen) = (Some(active.flash.id), width_m, is_seen);
            for ((part, mesh), place) in slot.parts.into_iter().zip(all).zip(places) {
                let mut part = commands.entity(part);
                match mesh {
                    Some(mesh) => part.insert((Mesh3d(mesh), Transform::from_translation(place), Visibility::Visible)),
                    None => part.insert(Visibility::Hidden),
                };
            }
            index
        });
        let slot = &shown.slots[index];
        // A tube that sends by Lambert's law shows its flux over π² times its width.
        let tube = |part: usize, width: f32| currents[part] * light.lumens_m_a[part] as f32 / (PI * PI * width);
        let luminances = [
            tube(0, slot.width_m),
            tube(1, 0.6 * slot.width_m),
            currents[0] * light.glow_cd_m2_a as f32,
        ];
        // Haze is drawn over what stands in depth, not over what is added to the picture.
        for (part, luminance) in luminances.into_iter().enumerate() {
            let is_glow = part == 2;
            if let Some(mut material) = materials.get_mut(&slot.materials[part]) {
                material.light = (luminance * COLOUR).extend(if is_glow { extinction } else { 0.0 });
                material.glow = Vec4::new(f32::from(u8::from(is_glow)), (active.flash.id % 4096) as f32, 0.0, 0.0);
            }
        }
    }
}

/// Draws nothing that is seen until the first flash, so that it need not wait for its pipelines.
fn warm_up(commands: &mut Commands, shown: &mut Shown, lit: &mut Lit) {
    let (Some(meshes), Some(materials)) = (&mut lit.meshes, &mut lit.materials) else {
        return;
    };
    let slot = new_slot(commands, materials);
    let line = [DVec3::ZERO, DVec3::Y];
    let mesh = meshes.add(shapes::tubes(std::iter::once(line.as_slice()), DVec3::ZERO, 0.0));
    for part in slot.parts {
        commands
            .entity(part)
            .insert((Mesh3d(mesh.clone()), Visibility::Visible));
    }
    shown.slots.push(slot);
}

fn new_slot(commands: &mut Commands, materials: &mut Assets<LightningMaterial>) -> Slot {
    let materials = core::array::from_fn(|part| {
        materials.add(LightningMaterial {
            added: part == 2,
            ..default()
        })
    });
    let parts = core::array::from_fn(|part| {
        let material: Handle<LightningMaterial> = Handle::clone(&materials[part]);
        commands
            .spawn((
                Name::new(["lightning channel", "lightning branches", "lightning glow"][part]),
                MeshMaterial3d(material),
                NoFrustumCulling,
                NotShadowCaster,
                NotShadowReceiver,
                KeepDry,
                MovesInRain,
                Visibility::Hidden,
                Transform::default(),
            ))
            .id()
    });
    Slot {
        flash: None,
        parts,
        materials,
        width_m: WIDTH_M,
        is_seen: false,
    }
}
