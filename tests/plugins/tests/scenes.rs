//! Small scenes that several modules look at: ground with a hollow, at any place and scale, and what pixels say.

use bevy::asset::RenderAssetUsages;
use bevy::camera::RenderTarget;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bevy::render::gpu_readback::{Readback, ReadbackComplete};
use bevy::render::render_resource::{TextureFormat, TextureUsages};
use image::RgbImage;
use rain_plugins::prelude::*;
use rain_plugins::surface::WaterLevels;
use test_support::app::{FRAME, TestApp};

/// A grid of squares around its own origin, so many along x and z; `height` gives none where there is a hole.
pub fn terrain([nx, nz]: [u32; 2], cell_m: f32, height: impl Fn(f32, f32) -> Option<f32>) -> Mesh {
    let at = |i: u32, n: u32| (i as f32 - 0.5 * n as f32) * cell_m;
    let e = 0.04 * cell_m;
    let mut positions = Vec::new();
    let mut normals = Vec::new();
    for j in 0..=nz {
        for i in 0..=nx {
            let (x, z) = (at(i, nx), at(j, nz));
            let h = |x: f32, z: f32| height(x, z).unwrap_or(0.0);
            positions.push([x, h(x, z), z]);
            let slope = |dx: f32, dz: f32| (h(x + dx, z + dz) - h(x - dx, z - dz)) / (2.0 * e);
            normals.push(Vec3::new(-slope(e, 0.0), 1.0, -slope(0.0, e)).normalize().to_array());
        }
    }
    let corner = |i: u32, j: u32| j * (nx + 1) + i;
    let mut indices = Vec::new();
    for j in 0..nz {
        for i in 0..nx {
            if height(at(i, nx) + 0.5 * cell_m, at(j, nz) + 0.5 * cell_m).is_some() {
                let [a, b, c, d] = [corner(i, j), corner(i, j + 1), corner(i + 1, j + 1), corner(i + 1, j)];
                indices.extend([a, b, c, a, c, d]);
            }
        }
    }
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
        .with_inserted_indices(Indices::U32(indices))
}

/// A slope of 1 % with a hollow of 6 cm in its middle, 2 m across.
pub fn hollow(x: f32, z: f32) -> f32 {
    let share = (1.0 - (x * x + z * z) / 4.0).max(0.0);
    0.01 * x - 0.06 * share * share
}

/// A rough grey material.
pub fn stone(world: &mut World) -> Handle<StandardMaterial> {
    world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial {
        base_color: Color::srgb(0.5, 0.5, 0.5),
        perceptual_roughness: 0.9,
        ..default()
    })
}

/// Puts a mesh of [`stone`] into the world.
pub fn place(world: &mut World, mesh: Mesh, transform: Transform) -> Entity {
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
    let material = stone(world);
    world.spawn((Mesh3d(mesh), MeshMaterial3d(material), transform)).id()
}

/// Weather, and a camera that draws no streaks.
pub fn surfaces_only(test: &mut TestApp, camera: Entity) {
    test.world().entity_mut(camera).insert(RainView {
        streak_budget: Some(0),
        ..default()
    });
}

/// [`hollow`] ground around `place_m`, dry, looked at from 4 m beside; no streaks, no rings.
pub fn hollow_at(place_m: Vec3) -> (TestApp, Entity) {
    let mut test = TestApp::new([96, 64], true);
    test.world().insert_resource(WaterAppearance {
        ripple_strength: 0.0,
        ..default()
    });
    let ground = terrain([48, 48], 0.25, |x, z| Some(hollow(x, z)));
    place(test.world(), ground, Transform::from_translation(place_m));
    let weather = test.world().spawn(Weather::rain(0.0)).id();
    let camera = test.camera;
    surfaces_only(&mut test, camera);
    test.look(place_m + Vec3::new(0.0, 2.0, 4.0), place_m);
    test.frames(3, FRAME);
    test.leap(2);
    (test, weather)
}

/// Rains for so long.
pub fn rain(test: &mut TestApp, weather: Entity, intensity_mm_h: f64, seconds: u64) {
    test.world().entity_mut(weather).insert(Weather::rain(intensity_mm_h));
    test.leap(seconds);
    test.frames(4, FRAME);
}

/// Depth of the puddle at a place. Units: m.
pub fn depth(test: &mut TestApp, x: f64, z: f64) -> f32 {
    test.world().resource::<WaterLevels>().depth_at(x, z)
}

/// How two pictures differ: the mean over all channels, and the share of pixels that differ by more than 12 of 255.
#[derive(Debug, Clone, Copy)]
pub struct Difference {
    pub mean: f64,
    pub share: f64,
}

pub fn difference(a: &RgbImage, b: &RgbImage) -> Difference {
    assert_eq!(a.dimensions(), b.dimensions());
    let (mut sum, mut many) = (0.0, 0.0);
    for (a, b) in a.pixels().zip(b.pixels()) {
        let off = a.0.iter().zip(b.0).map(|(x, y)| f64::from(x.abs_diff(y)));
        sum += off.clone().sum::<f64>() / 3.0;
        many += f64::from(u8::from(off.fold(0.0, f64::max) > 12.0));
    }
    let count = f64::from(a.width() * a.height());
    Difference {
        mean: sum / count,
        share: many / count,
    }
}

/// Part of a picture.
pub fn part(picture: &RgbImage, x: u32, y: u32, width: u32, height: u32) -> RgbImage {
    image::imageops::crop_imm(picture, x, y, width, height).to_image()
}

/// Mean brightness of a part of a picture. Units: 0 to 255.
pub fn brightness(picture: &RgbImage) -> f64 {
    let sum: f64 = picture.pixels().flat_map(|p| p.0).map(f64::from).sum();
    sum / f64::from(picture.width() * picture.height()) / 3.0
}

#[derive(Resource, Default)]
struct Halves(Option<Vec<u8>>);

/// Has Bevy ask for the size of a camera's new target, which it does when the projection has changed.
fn look_again(test: &mut TestApp, camera: Entity) {
    let mut projection = test.world().get_mut::<Projection>(camera).expect("a camera");
    projection.set_changed();
}

/// Draws the camera's view into half floats and counts the channels that are NaN or infinite; 64 × 32 pixels.
pub fn broken_channels(test: &mut TestApp, camera: Entity) -> usize {
    let mut target = Image::new_target_texture(64, 32, TextureFormat::Rgba16Float, None);
    target.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    let target = test.world().resource_mut::<Assets<Image>>().add(target);
    let own = test.world().get::<RenderTarget>(camera).expect("a target").clone();
    test.world()
        .entity_mut(camera)
        .insert((RenderTarget::from(target.clone()), bevy::camera::Hdr));
    look_again(test, camera);
    test.frames(2, FRAME);
    test.app.insert_resource(Halves::default());
    let readback = test
        .world()
        .spawn(Readback::texture(target))
        .observe(|done: On<ReadbackComplete>, mut out: ResMut<Halves>| out.0 = Some(done.data.clone()))
        .id();
    let mut data = None;
    for _ in 0..50 {
        test.frames(1, FRAME);
        data = test.world().resource_mut::<Halves>().0.take();
        if data.is_some() {
            break;
        }
    }
    test.world().despawn(readback);
    test.world()
        .entity_mut(camera)
        .insert(own)
        .remove::<bevy::camera::Hdr>();
    let data = data.expect("a picture in half floats");
    assert!(data.len() >= 64 * 32 * 8, "{} bytes", data.len());
    assert!(data.iter().any(|b| *b != 0), "the picture is empty");
    let halves = data.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]]));
    halves.filter(|h| h & 0x7c00 == 0x7c00).count()
}

#[derive(Resource, Default)]
struct Texels(Option<Vec<u8>>);

/// The bytes of a texture, row after row, with what gaps there are between rows.
pub fn read_texture(test: &mut TestApp, image: &Handle<Image>) -> Vec<u8> {
    test.app.insert_resource(Texels::default());
    let readback = test
        .world()
        .spawn(Readback::texture(image.clone()))
        .observe(|done: On<ReadbackComplete>, mut out: ResMut<Texels>| out.0 = Some(done.data.clone()))
        .id();
    let mut data = None;
    for _ in 0..50 {
        test.frames(1, std::time::Duration::ZERO);
        data = test.world().resource_mut::<Texels>().0.take();
        if data.is_some() {
            break;
        }
    }
    test.world().despawn(readback);
    data.expect("the texture comes back")
}
