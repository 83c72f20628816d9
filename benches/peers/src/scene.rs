//! The scene that all share: ground, a few boxes far off, one light, one camera that draws into an image.

use bevy::asset::uuid_handle;
use bevy::camera::RenderTarget;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::prelude::*;
use bevy::render::render_resource::{AsBindGroup, TextureFormat, TextureUsages};
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bevy::shader::{Shader, ShaderRef};
use rain_plugins::scenario::headless;
use rain_quads::field::{EYE_M, SIZE};

/// One colour, whatever the light.
#[derive(Asset, AsBindGroup, TypePath, Debug, Clone)]
struct Flat {
    #[uniform(0)]
    colour: LinearRgba,
}

/// The shader of [`Flat`].
const FLAT: Handle<Shader> = uuid_handle!("5f0c7f0e-2f0b-4a55-9a0d-3a2f6a0c81d4");

impl Material for Flat {
    fn fragment_shader() -> ShaderRef {
        FLAT.into()
    }
}

/// An app without plugins of anybody's rain, not yet finished.
pub fn app() -> App {
    let mut app = App::new();
    // A peer asks for windows; there is no display.
    app.add_plugins(headless::plugins().disable::<bevy::winit::WinitPlugin>())
        .add_plugins(MaterialPlugin::<Flat>::default());
    app
}

/// Finishes the app and puts the scene in; returns the camera.
pub fn build(app: &mut App, lit: bool) -> Entity {
    headless::finish(app);
    let shader = Shader::from_wgsl(include_str!("flat.wgsl"), "flat.wgsl");
    let added = app
        .world_mut()
        .resource_mut::<Assets<Shader>>()
        .insert(FLAT.id(), shader);
    debug_assert!(added.is_ok(), "the handle is constant");
    let mut target = Image::new_target_texture(SIZE[0], SIZE[1], TextureFormat::Rgba8UnormSrgb, None);
    target.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    let world = app.world_mut();
    let target = world.resource_mut::<Assets<Image>>().add(target);
    world.insert_resource(GlobalAmbientLight {
        brightness: 400.0,
        ..default()
    });
    let colour = LinearRgba::rgb(0.35, 0.35, 0.35);
    let flat = world.resource_mut::<Assets<Flat>>().add(Flat { colour });
    let material = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial {
        base_color: colour.into(),
        perceptual_roughness: 0.9,
        ..default()
    });
    let mut block = |size: Vec3, centre: Vec3| {
        let mesh = world
            .resource_mut::<Assets<Mesh>>()
            .add(Cuboid::new(size.x, size.y, size.z));
        let mut block = world.spawn((Mesh3d(mesh), Transform::from_translation(centre)));
        if lit {
            block.insert(MeshMaterial3d(material.clone()));
        } else {
            block.insert(MeshMaterial3d(flat.clone()));
        }
    };
    block(Vec3::new(200.0, 1.0, 200.0), Vec3::new(0.0, -0.5, 0.0));
    for (x, height) in [(-16.0, 9.0), (-5.0, 5.0), (4.0, 14.0), (15.0, 7.0)] {
        block(Vec3::new(6.0, height, 6.0), Vec3::new(x, 0.5 * height, -30.0));
    }
    world.spawn((
        DirectionalLight {
            illuminance: 8_000.0,
            ..default()
        },
        Transform::default().looking_to(Vec3::new(0.3, -1.0, -0.4), Vec3::Y),
    ));
    world
        .spawn((
            Camera3d::default(),
            RenderTarget::from(target),
            Msaa::Off,
            Tonemapping::AcesFitted,
            Transform::from_translation(EYE_M),
        ))
        .id()
}

/// The device that the app draws with.
pub fn device(app: &App) -> (wgpu::Device, wgpu::Queue) {
    let device = app.world().resource::<RenderDevice>().wgpu_device().clone();
    let queue = &app.world().resource::<RenderQueue>().0;
    (device, (***queue).clone())
}
