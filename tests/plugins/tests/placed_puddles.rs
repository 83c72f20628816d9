//! Puddles that artists place on a mesh, and objects with a wetness of their own.

use bevy::mesh::VertexAttributeValues;
use bevy::prelude::*;
use image::RgbImage;
use rain_plugins::prelude::*;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

const SIZE: [u32; 2] = [120, 60];

/// Two plates beside each other, seen from above under an even sky.
struct Plates {
    test: TestApp,
    plates: [Entity; 2],
    weather: Entity,
}

impl Plates {
    fn new() -> Self {
        let mut test = TestApp::new(SIZE, true);
        test.world().insert_resource(SurfaceSettings {
            enabled: false,
            ..default()
        });
        let plates = [-1.1, 1.1].map(|x| {
            world::block(
                test.world(),
                "plate",
                Vec3::new(x - 1.0, -0.1, -1.0),
                Vec3::new(x + 1.0, 0.0, 1.0),
                world::STONE,
            )
        });
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

    /// Gives a plate vertex colours of its own.
    fn colour(&mut self, plate: usize, colour: [f32; 4]) {
        let world = self.test.world();
        let handle = world.get::<Mesh3d>(self.plates[plate]).expect("a mesh").0.clone();
        let mut meshes = world.resource_mut::<Assets<Mesh>>();
        let mut mesh = meshes.get(&handle).expect("its data").clone();
        let count = mesh.count_vertices();
        mesh.insert_attribute(
            Mesh::ATTRIBUTE_COLOR,
            VertexAttributeValues::Float32x4(vec![colour; count]),
        );
        let own = meshes.add(mesh);
        let entity = self.plates[plate];
        world.entity_mut(entity).insert(Mesh3d(own));
    }

    fn rain(&mut self, intensity_mm_h: f64, seconds: u64) {
        let weather = self.weather;
        self.test
            .world()
            .entity_mut(weather)
            .insert(Weather::rain(intensity_mm_h));
        self.test.leap(seconds);
        self.test.frames(3, FRAME);
    }

    /// Mean colour of a plate's middle.
    fn seen(&mut self, plate: usize) -> [f64; 3] {
        let picture: RgbImage = self.test.picture();
        // 45° high from 5 m: 14.5 px a metre.
        let x = if plate == 0 { 44 } else { 76 };
        let mut sum = [0.0; 3];
        for dy in 0..8 {
            for dx in 0..8 {
                let pixel = picture.get_pixel(x - 4 + dx, 26 + dy);
                for c in 0..3 {
                    sum[c] += f64::from(pixel[c]) / 64.0;
                }
            }
        }
        sum
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f64>() / 3.0
}

#[test]
fn painted_depths_flood_with_the_weather_and_white_never_does() {
    if !gpu::available() {
        return;
    }
    let mut plates = Plates::new();
    // Black green: floods first. White: never.
    plates.colour(0, [1.0, 0.0, 1.0, 1.0]);
    plates.colour(1, [1.0; 4]);
    for plate in plates.plates {
        plates.test.world().entity_mut(plate).insert(PuddlePaint {
            show: ShowPaint::Water,
            height_map: false,
            ..default()
        });
    }
    plates.test.frames(4, FRAME);
    assert!(
        plates.seen(0)[1] < 2.0 && plates.seen(1)[1] < 2.0,
        "no water before the rain"
    );
    plates.rain(50.0, 60);
    let (painted, white) = (plates.seen(0), plates.seen(1));
    assert!(painted[1] > 250.0, "{painted:?}");
    assert!(white[1] < 2.0, "{white:?}");

    // The same as surfaces: seen from straight above, a muddy puddle hides its bottom.
    plates.test.world().insert_resource(WaterAppearance {
        turbidity_per_m: 400.0,
        mud_albedo: Vec3::new(0.05, 0.03, 0.01),
        ..default()
    });
    for plate in plates.plates {
        plates.test.world().entity_mut(plate).insert(PuddlePaint {
            height_map: false,
            ..default()
        });
    }
    plates.test.frames(4, FRAME);
    let (puddle, wet) = (plates.seen(0), plates.seen(1));
    assert!(distance(puddle, wet) > 20.0, "{puddle:?} {wet:?}");
}

#[test]
fn fixed_puddles_are_there_without_rain_and_paint_is_no_tint() {
    if !gpu::available() {
        return;
    }
    let mut plates = Plates::new();
    let plain = plates.seen(1);
    // A full puddle; and paint in all colours without one.
    plates.colour(0, [1.0, 1.0, 1.0, 0.0]);
    plates.colour(1, [0.2, 1.0, 0.4, 1.0]);
    for plate in plates.plates {
        plates.test.world().entity_mut(plate).insert(PuddlePaint {
            fixed: true,
            height_map: false,
            ..default()
        });
    }
    plates.test.frames(4, FRAME);
    let (puddle, paint) = (plates.seen(0), plates.seen(1));
    assert!(
        distance(paint, plain) < 2.0,
        "vertex colours are masks here: {paint:?}, {plain:?}"
    );
    assert!(distance(puddle, plain) > 4.0, "{puddle:?} {plain:?}");
}

#[test]
fn noise_puddles_cover_more_at_a_higher_level() {
    if !gpu::available() {
        return;
    }
    let mut plates = Plates::new();
    plates.rain(50.0, 60);
    let mut seen = Vec::new();
    for level in [0.0, 1.0] {
        for plate in plates.plates {
            plates.test.world().entity_mut(plate).insert(NoisePuddles {
                level: Some(level),
                size_m: 0.5,
                height_map: false,
                ..default()
            });
        }
        plates.test.frames(4, FRAME);
        seen.push(plates.test.picture());
    }
    let changed = seen[0]
        .pixels()
        .zip(seen[1].pixels())
        .filter(|(a, b)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 3));
    // Two plates of 2 m by 2 m, 14.5 px a metre.
    let share = changed.count() as f64 / (2.0 * 29.0 * 29.0);
    assert!(share > 0.3, "{share}");
}

#[test]
fn an_object_shows_its_own_wetness_and_keeps_a_tag_of_the_apps() {
    if !gpu::available() {
        return;
    }
    let mut plates = Plates::new();
    let [own, tagged] = plates.plates;
    plates.test.world().entity_mut(own).insert(DynamicWetness::default());
    plates
        .test
        .world()
        .entity_mut(tagged)
        .insert((DynamicWetness::default(), bevy::mesh::MeshTag(42)));
    let dry = plates.seen(0);
    plates.rain(50.0, 60);
    let wet = plates.seen(0);
    assert!(
        wet.iter().zip(dry).all(|(wet, dry)| *wet < dry - 4.0),
        "{wet:?} {dry:?}"
    );
    let tag = |plates: &mut Plates, entity: Entity| plates.test.world().get::<bevy::mesh::MeshTag>(entity).map(|t| t.0);
    assert!(
        tag(&mut plates, own).is_some_and(|t| t & 0xffff == 0xffff),
        "it is soaked"
    );
    assert_eq!(tag(&mut plates, tagged), Some(42));
}
