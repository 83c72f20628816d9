//! Plates in a row, seen from above.

use bevy::asset::RenderAssetUsages;
use bevy::image::{Image, ImageFilterMode, ImageSampler, ImageSamplerDescriptor};
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use image::RgbImage;
use rain_plugins::prelude::*;
use test_support::app::{FRAME, TestApp};

pub const SIZE: [u32; 2] = [240, 60];
/// 45° high from 5 m. Units: px/m.
pub const PER_M: f32 = 14.5;

/// Plates of 2 m by 2 m in a row, seen from above; no streaks, no ground, no wind.
pub struct Tiles {
    pub test: TestApp,
    pub plates: Vec<Entity>,
    weather: Entity,
}

/// A rough material with this albedo.
pub fn rough(albedo: f32) -> StandardMaterial {
    StandardMaterial {
        base_color: Color::linear_rgb(albedo, albedo, albedo),
        perceptual_roughness: 0.9,
        ..default()
    }
}

/// A linear texture of one row; each pixel (r, g, b) in 255ths.
pub fn stripes(test: &mut TestApp, pixels: &[[u8; 3]]) -> Handle<Image> {
    let data: Vec<u8> = pixels.iter().flat_map(|[r, g, b]| [*r, *g, *b, 255]).collect();
    let size = Extent3d {
        width: pixels.len() as u32,
        height: 1,
        depth_or_array_layers: 1,
    };
    let mut image = Image::new(
        size,
        TextureDimension::D2,
        data,
        TextureFormat::Rgba8Unorm,
        RenderAssetUsages::default(),
    );
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        mag_filter: ImageFilterMode::Nearest,
        min_filter: ImageFilterMode::Nearest,
        ..default()
    });
    test.world().resource_mut::<Assets<Image>>().add(image)
}

impl Tiles {
    pub fn new(materials: impl IntoIterator<Item = StandardMaterial>) -> Self {
        let mut test = TestApp::new(SIZE, true);
        let materials: Vec<StandardMaterial> = materials.into_iter().collect();
        test.world().insert_resource(SurfaceSettings {
            enabled: false,
            ..default()
        });
        let count = materials.len();
        let plane = Plane3d::default().mesh().size(2.0, 2.0).build();
        let tangents = vec![[1.0_f32, 0.0, 0.0, 1.0]; plane.count_vertices()];
        let plane = plane.with_inserted_attribute(Mesh::ATTRIBUTE_TANGENT, tangents);
        let plates = materials.into_iter().enumerate().map(|(i, material)| {
            let world = test.world();
            let material = world.resource_mut::<Assets<StandardMaterial>>().add(material);
            let mesh = world.resource_mut::<Assets<Mesh>>().add(plane.clone());
            let at = Transform::from_xyz(Self::x(i, count), 0.0, 0.0);
            world.spawn((Mesh3d(mesh), MeshMaterial3d(material), at)).id()
        });
        let plates: Vec<Entity> = plates.collect();
        let weather = test.world().spawn((Weather::rain(0.0), WeatherMode::Artist)).id();
        let camera = test.camera;
        test.world().entity_mut(camera).insert(RainView {
            streak_budget: Some(0),
            ..default()
        });
        test.look(Vec3::new(0.0, 5.0, 0.01), Vec3::ZERO);
        test.frames(3, FRAME);
        Self { test, plates, weather }
    }

    pub fn x(i: usize, count: usize) -> f32 {
        2.2 * (i as f32 - 0.5 * (count as f32 - 1.0))
    }

    pub fn put(&mut self, plate: usize, bundle: impl Bundle) {
        let entity = self.plates[plate];
        self.test.world().entity_mut(entity).insert(bundle);
    }

    /// A plate's mesh with this colour in every vertex.
    pub fn painted(&mut self, colour: [f32; 4]) -> Mesh3d {
        let mesh = Plane3d::default().mesh().size(2.0, 2.0).build();
        let count = mesh.count_vertices();
        let mesh = mesh.with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, vec![colour; count]);
        Mesh3d(self.test.world().resource_mut::<Assets<Mesh>>().add(mesh))
    }

    /// A material with this map of depths, which shifts nothing.
    pub fn relief(&mut self, material: StandardMaterial, depths: Handle<Image>) -> MeshMaterial3d<StandardMaterial> {
        let material = StandardMaterial {
            depth_map: Some(depths),
            parallax_depth_scale: 0.0,
            ..material
        };
        let world = self.test.world();
        MeshMaterial3d(world.resource_mut::<Assets<StandardMaterial>>().add(material))
    }

    pub fn rain(&mut self, intensity_mm_h: f64, seconds: u64) {
        let weather = self.weather;
        self.test
            .world()
            .entity_mut(weather)
            .insert(Weather::rain(intensity_mm_h));
        self.test.leap(seconds);
        self.test.frames(3, FRAME);
    }

    /// The artists' levels go to these targets while it rains, and no farther: wetness, holes, puddles.
    pub fn levels(&mut self, targets: [f64; 3]) {
        let mut settings = ArtistSettings::dynamic_rain();
        let [wetness, holes, puddles] = targets;
        settings.wetness.target = wetness;
        settings.holes.target = holes;
        settings.puddles.target = puddles;
        let weather = self.weather;
        self.test.world().entity_mut(weather).insert(ArtistControls(settings));
    }

    /// The pixels in the middle of a plate, 1.2 m on a side, row by row.
    pub fn pixels(&self, picture: &RgbImage, plate: usize) -> Vec<[f64; 3]> {
        let middle = 120.0 + PER_M * Self::x(plate, self.plates.len());
        let mut pixels = Vec::new();
        for y in 22..38 {
            for dx in 0..16 {
                let x = (middle - 8.0) as u32 + dx;
                pixels.push(picture.get_pixel(x, y).0.map(f64::from));
            }
        }
        pixels
    }

    /// Mean colour of every plate's middle.
    pub fn seen(&mut self) -> Vec<[f64; 3]> {
        let picture = self.test.picture();
        let mean = |plate: usize| {
            let pixels = self.pixels(&picture, plate);
            let n = pixels.len() as f64;
            [0, 1, 2].map(|c| pixels.iter().map(|p| p[c]).sum::<f64>() / n)
        };
        (0..self.plates.len()).map(mean).collect()
    }
}

pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f64>() / 3.0
}

pub fn state(state: SurfaceState) -> SurfaceWetting {
    SurfaceWetting {
        state: Some(state),
        ..default()
    }
}
