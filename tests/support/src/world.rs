//! Small worlds of boxes, put together by hand so that a test knows every edge.

use bevy::asset::RenderAssetUsages;
use bevy::prelude::*;
use bevy::render::render_resource::{
    Extent3d, TextureDimension, TextureFormat, TextureViewDescriptor, TextureViewDimension,
};
use rain_plugins::prelude::SurfaceSettings;

/// Colour of [`block`]s: linear reflectance of a mid-grey stone.
pub const STONE: [f32; 3] = [0.35, 0.35, 0.35];

/// A box from its low to its high corner (metres), of a rough material with this linear reflectance.
pub fn block(world: &mut World, name: &str, low: Vec3, high: Vec3, reflectance: [f32; 3]) -> Entity {
    let material = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial {
        base_color: Color::linear_rgb(reflectance[0], reflectance[1], reflectance[2]),
        perceptual_roughness: 0.9,
        ..default()
    });
    block_of(world, name, low, high, material)
}

/// Like [`block`], of a material that the test made.
pub fn block_of(world: &mut World, name: &str, low: Vec3, high: Vec3, material: Handle<StandardMaterial>) -> Entity {
    let size = high - low;
    let mesh = world
        .resource_mut::<Assets<Mesh>>()
        .add(Cuboid::new(size.x, size.y, size.z));
    world
        .spawn((
            Name::new(name.to_owned()),
            Mesh3d(mesh),
            MeshMaterial3d(material),
            Transform::from_translation(0.5 * (low + high)),
        ))
        .id()
}

/// Level ground, 80 m square, its top at y = 0.
pub fn ground(world: &mut World) -> Entity {
    block(
        world,
        "ground",
        Vec3::new(-40.0, -0.5, -40.0),
        Vec3::new(40.0, 0.0, 40.0),
        STONE,
    )
}

/// No ground in the simulation: pictures and masks go by the weather and by what covers at the moment, as they do on
/// roofs, walls and whatever else lies above the ground.
///
/// # Panics
/// Without the rain plugins.
pub fn without_ground(world: &mut World) {
    world.resource_mut::<SurfaceSettings>().enabled = false;
}

/// Half the side of the [`roof`]. Units: m.
pub const ROOF_HALF: f32 = 5.0;
/// Height of the roof's underside. Units: m.
pub const ROOF_LOW: f32 = 4.0;
/// Height of the roof's top. Units: m.
pub const ROOF_HIGH: f32 = 4.1;

/// A square roof around the origin, 10 m wide, 4 m above the ground, with nothing under it.
pub fn roof(world: &mut World) -> Entity {
    block(
        world,
        "roof",
        Vec3::new(-ROOF_HALF, ROOF_LOW, -ROOF_HALF),
        Vec3::new(ROOF_HALF, ROOF_HIGH, ROOF_HALF),
        STONE,
    )
}

/// A closed room around the origin: inside 6 × 3 × 6 m, walls, floor and ceiling 0.3 m thick. Returns its walls: the
/// one at low z first (a camera that looks along −Z faces it).
pub fn room(world: &mut World) -> [Entity; 4] {
    let (a, b, h) = (3.0, 3.3, 3.0);
    let mut wall =
        |name: &str, low: [f32; 3], high: [f32; 3]| block(world, name, Vec3::from(low), Vec3::from(high), STONE);
    wall("floor", [-b, 0.0, -b], [b, 0.05, b]);
    wall("ceiling", [-b, h, -b], [b, h + 0.3, b]);
    [
        wall("wall at low z", [-b, 0.0, -b], [b, h, -a]),
        wall("wall at high z", [-b, 0.0, a], [b, h, b]),
        wall("wall at low x", [-b, 0.0, -b], [-a, h, b]),
        wall("wall at high x", [a, 0.0, -b], [b, h, b]),
    ]
}

/// A cube map of one colour, each channel full or empty: what surrounds a camera.
pub fn cube_of(world: &mut World, colour: [bool; 3]) -> Handle<Image> {
    // Half floats: one and zero.
    let channel = |lit: bool| if lit { 0x3c00_u16 } else { 0 }.to_le_bytes();
    let [r, g, b] = colour.map(channel);
    let texel = [r, g, b, channel(true)].concat();
    let mut image = Image::new(
        Extent3d {
            width: 4,
            height: 4,
            depth_or_array_layers: 6,
        },
        TextureDimension::D2,
        texel.repeat(16 * 6),
        TextureFormat::Rgba16Float,
        RenderAssetUsages::RENDER_WORLD,
    );
    image.texture_view_descriptor = Some(TextureViewDescriptor {
        dimension: Some(TextureViewDimension::Cube),
        ..default()
    });
    world.resource_mut::<Assets<Image>>().add(image)
}
