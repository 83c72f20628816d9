//! The scene that all share: ground, a few boxes far off, one light, one camera that draws into an image.

use bevy::camera::RenderTarget;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::prelude::*;
use bevy::render::render_resource::{TextureFormat, TextureUsages};
use bevy::render::renderer::{RenderDevice, RenderQueue};
use rain_plugins::scenario::headless;
use rain_quads::field::{EYE_M, SIZE};

/// An app without plugins of anybody's rain, not yet finished.
pub fn app() -> App {
    let mut app = App::new();
    // A peer asks for windows; there is no display.
    app.add_plugins(headless::plugins().disable::<bevy::winit::WinitPlugin>());
    app
}

/// Finishes the app and puts the scene in; returns the camera.
pub fn build(app: &mut App) -> Entity {
    headless::finish(app);
    let mut target = Image::new_target_texture(SIZE[0], SIZE[1], TextureFormat::Rgba8UnormSrgb, None);
    target.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    let world = app.world_mut();
    let target = world.resource_mut::<Assets<Image>>().add(target);
    world.insert_resource(GlobalAmbientLight {
        brightness: 400.0,
        ..default()
    });
    let material = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial {
        base_color: Color::linear_rgb(0.35, 0.35, 0.35),
        perceptual_roughness: 0.9,
        ..default()
    });
    let mut block = |size: Vec3, centre: Vec3| {
        let mesh = world
            .resource_mut::<Assets<Mesh>>()
            .add(Cuboid::new(size.x, size.y, size.z));
        world.spawn((
            Mesh3d(mesh),
            MeshMaterial3d(material.clone()),
            Transform::from_translation(centre),
        ));
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
