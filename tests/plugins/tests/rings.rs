//! Rings of rain show on deep, level, open water alone, from either source.

use std::time::Duration;

use bevy::mesh::VertexAttributeValues;
use bevy::prelude::*;
use image::RgbImage;
use rain_plugins::prelude::*;
use rain_plugins::waves::RainRings;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

const SIZE: [u32; 2] = [128, 96];

/// A full puddle that is always there: red lets it ring, no alpha is water.
const PUDDLE: [f32; 4] = [1.0, 1.0, 1.0, 0.0];

/// A painted plate of 3 m under rain, seen from straight above its middle with the sun behind the eye: what tilts the
/// water moves the sun's image.
struct Plate {
    test: TestApp,
    plate: Entity,
    weather: Entity,
    normal: Vec3,
}

impl Plate {
    /// With a plate that leans by an angle towards +z.
    fn new(source: RingSource, lean: f32) -> Self {
        let mut test = TestApp::new(SIZE, true);
        let mut waves = WaveWaterSettings {
            ring_source: source,
            ..default()
        };
        // Cells of 2 mm show nearly all that the drops make.
        waves.rings.side_m = 0.5;
        test.world().insert_resource(waves);
        test.world().insert_resource(SurfaceSettings {
            enabled: false,
            ..default()
        });
        let plate = world::block(
            test.world(),
            "plate",
            Vec3::new(-1.5, -0.05, -1.5),
            Vec3::new(1.5, 0.05, 1.5),
            world::STONE,
        );
        let turn = Quat::from_rotation_x(lean);
        test.world().entity_mut(plate).insert(Transform::from_rotation(turn));
        let normal = turn * Vec3::Y;
        let sun = test
            .world()
            .query_filtered::<Entity, With<DirectionalLight>>()
            .single(test.world())
            .expect("one sun");
        test.world()
            .entity_mut(sun)
            .insert(Transform::default().looking_to(-normal, Vec3::X));
        let weather = test.world().spawn(Weather::rain(0.0)).id();
        let camera = test.camera;
        test.world().entity_mut(camera).insert(RainView {
            streak_budget: Some(0),
            ..default()
        });
        test.look(normal * 5.0, Vec3::ZERO);
        let mut plate = Self {
            test,
            plate,
            weather,
            normal,
        };
        plate.paint(PUDDLE, 0.02);
        plate
    }

    /// Paints all of the plate. `depth_m`: of a full puddle.
    fn paint(&mut self, colour: [f32; 4], depth_m: f32) {
        let world = self.test.world();
        let handle = world.get::<Mesh3d>(self.plate).expect("a mesh").0.clone();
        let mut meshes = world.resource_mut::<Assets<Mesh>>();
        let mut mesh = meshes.get(&handle).expect("its data").clone();
        let count = mesh.count_vertices();
        mesh.insert_attribute(
            Mesh::ATTRIBUTE_COLOR,
            VertexAttributeValues::Float32x4(vec![colour; count]),
        );
        let own = meshes.add(mesh);
        world.entity_mut(self.plate).insert((
            Mesh3d(own),
            PuddlePaint {
                fixed: true,
                height_map: false,
                depth_m,
                ..default()
            },
        ));
        self.test.frames(4, FRAME);
    }

    fn rain(&mut self, intensity_mm_h: f64) {
        let weather = self.weather;
        self.test
            .world()
            .entity_mut(weather)
            .insert(Weather::rain(intensity_mm_h));
        self.test.leap(120);
        // The solver's tile fills.
        self.test.frames(40, FRAME);
    }

    fn source(&mut self, source: RingSource) {
        self.test.world().resource_mut::<WaveWaterSettings>().ring_source = source;
    }

    /// The pixel of a place on the plate, whose height is the plate's top.
    fn pixel(&mut self, x: f32, z: f32) -> UVec2 {
        let normal = self.normal;
        let camera = self.test.camera;
        let world = self.test.world();
        let along = Vec3::X.cross(normal);
        let place = 0.05 * normal + x * Vec3::X + z * along;
        let at = *world.get::<GlobalTransform>(camera).expect("a place");
        let camera = world.get::<Camera>(camera).expect("a camera");
        camera.world_to_viewport(&at, place).expect("in view").as_uvec2()
    }

    /// Mean change from one picture to another of the part of the plate with x between two values, within 0.5 m of its
    /// middle line, over some moments.
    fn moves(&mut self, low: f32, high: f32) -> f64 {
        let (a, b) = (self.pixel(low, -0.5), self.pixel(high, 0.5));
        let (low, high) = (a.min(b), a.max(b));
        assert!((high - low).min_element() > 4, "{low} {high}");
        let mut sum = 0.0;
        let mut last: Option<RgbImage> = None;
        for _ in 0..4 {
            self.test.frames(7, FRAME);
            let picture = self.test.picture();
            if let Some(last) = last {
                let pixels = (low.y..high.y).flat_map(|y| (low.x..high.x).map(move |x| (x, y)));
                let changes = pixels.map(|(x, y)| {
                    let (a, b) = (last.get_pixel(x, y).0, picture.get_pixel(x, y).0);
                    a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(b))).sum::<f64>() / 3.0
                });
                sum += changes.sum::<f64>() / f64::from((high - low).element_product());
            }
            last = Some(picture);
        }
        sum / 3.0
    }
}

fn sources() -> [RingSource; 2] {
    [RingSource::Drops, RingSource::Layers(RingLayerSettings::default())]
}

#[test]
fn a_puddle_half_under_cover_rings_in_its_open_half_only() {
    if !gpu::available() {
        return;
    }
    for source in sources() {
        let mut plate = Plate::new(source, 0.0);
        // Above the eye, over the half at low x.
        let roof = world::block(
            plate.test.world(),
            "roof",
            Vec3::new(-4.0, 7.0, -4.0),
            Vec3::new(0.0, 7.1, 4.0),
            world::STONE,
        );
        plate.rain(20.0);
        let (covered, open) = (plate.moves(-0.8, -0.3), plate.moves(0.3, 0.8));
        eprintln!("{source:?}: covered {covered:.3}, open {open:.3}");
        assert!(open > 0.3, "{source:?}: {open}");
        assert!(
            covered < 0.02 * open,
            "{source:?}: {covered} under cover, {open} in the open"
        );

        plate.test.world().despawn(roof);
        plate.test.frames(10, FRAME);
        let (was_covered, open) = (plate.moves(-0.8, -0.3), plate.moves(0.3, 0.8));
        assert!(
            was_covered > 0.4 * open,
            "{source:?}: {was_covered} without the roof, {open}"
        );

        // What moved were the rings.
        plate.test.world().insert_resource(WaterAppearance {
            ripple_strength: 0.0,
            ..default()
        });
        let still = plate.moves(0.3, 0.8);
        assert!(still < 0.02 * open, "{source:?}: {still} without rings, {open}");
    }
}

#[test]
fn rings_need_deep_water_that_is_level_and_not_masked() {
    if !gpu::available() {
        return;
    }
    for source in sources() {
        let mut plate = Plate::new(source, 0.0);
        plate.rain(20.0);
        let deep = plate.moves(-0.5, 0.5);
        assert!(deep > 0.3, "{source:?}: {deep}");
        for (colour, depth_m, what) in [
            (PUDDLE, 0.0008, "thin water"),
            ([0.0, 1.0, 1.0, 0.0], 0.02, "masked by red"),
            ([1.0; 4], 0.02, "no water"),
            ([1.0, 1.0, 0.0, 0.0], 0.02, "always dry by blue"),
        ] {
            plate.paint(colour, depth_m);
            let found = plate.moves(-0.5, 0.5);
            eprintln!("{source:?}: {what} {found:.3}, deep {deep:.3}");
            // A film that has no puddle over it still grows.
            assert!(found < 0.02 * deep + 0.05, "{source:?}, {what}: {found}, deep {deep}");
        }
        // Half gathered: in between.
        plate.paint([1.0, 1.0, 1.0, 0.6], 0.02);
        let half = plate.moves(-0.5, 0.5);
        assert!(
            half > 0.05 * deep && half < 0.9 * deep,
            "{source:?}: {half}, deep {deep}"
        );

        let mut leaning = Plate::new(source, 0.61);
        leaning.rain(20.0);
        let found = leaning.moves(-0.5, 0.5);
        assert!(
            found < 0.02 * deep + 0.05,
            "{source:?}: {found} on a slope of 35°, level {deep}"
        );
    }
}

#[test]
fn the_source_of_rings_changes_at_any_time_and_passes_come_and_go() {
    if !gpu::available() {
        return;
    }
    let layers = RingSource::Layers(RingLayerSettings::default());
    let mut plate = Plate::new(RingSource::Drops, 0.0);
    let recorded = |plate: &mut Plate, frames: u32, each: Duration| {
        plate.test.reset();
        plate.test.frames(frames, each);
        plate.test.recorded(PassName::Ripples)
    };
    plate.source(layers);
    assert_eq!(recorded(&mut plate, 10, FRAME), 0, "no rain");
    plate.rain(20.0);
    assert_eq!(*plate.test.world().resource::<RainRings>().source(), layers);
    assert_eq!(recorded(&mut plate, 10, FRAME), 10, "layers under rain");
    assert_eq!(recorded(&mut plate, 10, Duration::ZERO), 0, "the clock stands");
    assert_eq!(plate.test.skipped(PassName::Ripples, SkipReason::NothingMoved), 10);
    assert!(plate.moves(-0.5, 0.5) > 0.3);

    plate.source(RingSource::Drops);
    assert_eq!(recorded(&mut plate, 10, FRAME), 10, "drops under rain");
    plate.test.frames(40, FRAME);
    let drops = plate.moves(-0.5, 0.5);
    assert!(drops > 0.3, "{drops}");

    // Other layers, with another texture.
    let fine = RingLayerSettings {
        cells: 512,
        ..default()
    };
    plate.source(RingSource::Layers(fine));
    assert_eq!(recorded(&mut plate, 10, FRAME), 10, "finer layers");
    assert!(plate.moves(-0.5, 0.5) > 0.3);

    // What does not validate changes nothing.
    let bad = RingLayerSettings {
        side_m: f64::NAN,
        ..default()
    };
    plate.source(RingSource::Layers(bad));
    assert_eq!(recorded(&mut plate, 10, FRAME), 10);
    assert_eq!(
        *plate.test.world().resource::<RainRings>().source(),
        RingSource::Layers(fine)
    );

    // Without water, and after the rain.
    let painted = plate.plate;
    plate.test.world().entity_mut(painted).remove::<PuddlePaint>();
    assert_eq!(recorded(&mut plate, 10, FRAME), 0, "no water");
    assert_eq!(plate.test.skipped(PassName::Ripples, SkipReason::NoWater), 10);
    plate.paint(PUDDLE, 0.02);
    assert_eq!(recorded(&mut plate, 10, FRAME), 10, "water again");
    let weather = plate.weather;
    plate.test.world().entity_mut(weather).insert(Weather::rain(0.0));
    let fading = recorded(&mut plate, 200, FRAME);
    assert!((20..180).contains(&fading), "{fading}");
    assert_eq!(recorded(&mut plate, 10, FRAME), 0, "after the rain");
    assert_eq!(plate.test.skipped(PassName::Ripples, SkipReason::NoRain), 10);
    assert!(plate.moves(-0.5, 0.5) < 0.01 * drops, "it lies flat");
}
