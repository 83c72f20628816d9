//! Masks that the painter works out by itself, and feet in the puddles that it stands by.

use bevy::ecs::message::Messages;
use bevy::mesh::VertexAttributeValues;
use bevy::prelude::*;
use rain_plugins::prelude::*;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

use crate::puddles::hollow;

/// The ground with its hollow, half of it under a roof 3 m above x > 3, and a box below.
struct Yard {
    test: TestApp,
    weather: Entity,
    ground: Entity,
    roof: Entity,
    table: Entity,
}

impl Yard {
    fn new() -> Self {
        let (mut test, weather) = hollow();
        let ground = {
            let world = test.world();
            let mut meshes = world.query_filtered::<Entity, With<Mesh3d>>();
            meshes.single(world).expect("the ground alone")
        };
        let mut block = |name: &str, low: [f32; 3], high: [f32; 3]| {
            world::block(test.world(), name, Vec3::from(low), Vec3::from(high), world::STONE)
        };
        let roof = block("roof", [3.0, 3.0, -6.0], [6.0, 3.1, 6.0]);
        let table = block("table", [4.2, 0.1, 1.0], [4.8, 0.9, 1.6]);
        test.world().entity_mut(weather).insert(WeatherMode::Artist);
        for painted in [ground, table] {
            test.world().entity_mut(painted).insert((
                AutoPaint {
                    wind_m_s: 1.0,
                    ..default()
                },
                PuddlePaint {
                    height_map: false,
                    ..default()
                },
            ));
        }
        test.frames(3, FRAME);
        test.leap(2);
        test.frames(3, FRAME);
        Self {
            test,
            weather,
            ground,
            roof,
            table,
        }
    }

    fn done(&mut self) -> Vec<AutoPaintDone> {
        let mut done = self.test.world().resource_mut::<Messages<AutoPaintDone>>();
        done.drain().collect()
    }

    /// Places and colours of a mesh's vertices, in its own coordinates.
    fn vertices(&mut self, entity: Entity) -> Vec<([f32; 3], [f32; 4])> {
        let world = self.test.world();
        let handle = world.get::<Mesh3d>(entity).expect("a mesh").0.clone();
        let mesh = world.resource::<Assets<Mesh>>().get(&handle).expect("its data");
        let (Some(VertexAttributeValues::Float32x3(p)), Some(VertexAttributeValues::Float32x4(c))) = (
            mesh.attribute(Mesh::ATTRIBUTE_POSITION),
            mesh.attribute(Mesh::ATTRIBUTE_COLOR),
        ) else {
            panic!("places and colours");
        };
        p.iter().copied().zip(c.iter().copied()).collect()
    }

    /// The ground's colour nearest to (x, z).
    fn colour(&mut self, x: f32, z: f32) -> [f32; 4] {
        let near = |p: &[f32; 3]| (p[0] - x).hypot(p[2] - z);
        let vertices = self.vertices(self.ground);
        let nearest = vertices.iter().min_by(|a, b| near(&a.0).total_cmp(&near(&b.0)));
        nearest.expect("vertices").1
    }

    /// The pixel in the middle of the picture when looking down at (x, z) from below the roof.
    fn seen(&mut self, x: f32, z: f32) -> [u8; 3] {
        self.test.look(Vec3::new(0.0, 2.5, 0.01), Vec3::new(x, 0.0, z));
        self.test.frames(3, FRAME);
        self.test.picture().get_pixel(80, 45).0
    }

    fn show(&mut self, show: ShowPaint) {
        let ground = self.ground;
        self.test.world().entity_mut(ground).insert(PuddlePaint {
            show,
            height_map: false,
            ..default()
        });
        self.test.frames(4, FRAME);
    }
}

#[test]
fn masks_follow_cover_slope_and_hollows_and_are_shown() {
    if !gpu::available() {
        return;
    }
    let mut yard = Yard::new();
    let painted = yard.vertices(yard.ground);
    assert_eq!(painted.len(), 49 * 49);
    // Under the roof neither ripples nor wetting; in the open both; near the edge between.
    let (under, open, edge) = (yard.colour(4.5, 0.0), yard.colour(-3.0, 0.0), yard.colour(3.25, 0.0));
    assert!(under[0] == 0.0 && under[2] == 0.0, "{under:?}");
    assert!(open[0] > 0.99 && open[2] > 0.99, "{open:?}");
    assert!(edge[2] > 0.05 && edge[2] < 0.8, "{edge:?}");
    // The hollow floods first in its middle, the slope never.
    let (middle, rim) = (yard.colour(0.0, 0.0), yard.colour(-1.25, 0.0));
    assert!(
        middle[1] < 0.05 && rim[1] > middle[1] + 0.2 && rim[1] < 1.0,
        "{middle:?} {rim:?}"
    );
    assert_eq!((open[1], open[3]), (1.0, 1.0));
    assert_eq!(middle[3], 0.0, "there is a puddle if it is always there");
    // What lies under something is masked as a whole.
    let table = yard.table;
    assert!(yard.vertices(table).iter().all(|(_, c)| c[0] == 0.0 && c[2] == 0.0));

    // The masks themselves.
    yard.show(ShowPaint::Ripples);
    assert_eq!(yard.seen(4.5, 0.0), [0; 3]);
    let white = yard.seen(-3.0, 0.0);
    assert!(white.iter().all(|c| *c > 250), "{white:?}");
    yard.show(ShowPaint::Channels);
    let [red, green, blue] = yard.seen(0.0, 0.0);
    assert!(red > 250 && green < 90 && blue > 250, "{:?}", [red, green, blue]);

    // They hold the water that the weather gathers: none on the slope, none where the roof is.
    let weather = yard.weather;
    yard.test.world().entity_mut(weather).insert(Weather::rain(20.0));
    yard.test.leap(30);
    yard.show(ShowPaint::Water);
    assert!(yard.seen(0.0, 0.0)[0] > 250);
    assert_eq!((yard.seen(-4.0, 0.0), yard.seen(4.5, 0.0)), ([0; 3], [0; 3]));

    // Without the roof, asked again: white. Not asked: as it was.
    let (roof, ground) = (yard.roof, yard.ground);
    yard.test.world().entity_mut(roof).despawn();
    yard.test.leap(1);
    assert_eq!(yard.colour(4.5, 0.0)[2], 0.0);
    yard.done();
    yard.test
        .world()
        .get_mut::<AutoPaint>(ground)
        .expect("the painter")
        .ask_again();
    yard.test.frames(2, FRAME);
    let after = yard.colour(4.5, 0.0);
    assert!(after[0] > 0.99 && after[2] > 0.99, "{after:?}");
    let done = yard.done();
    assert_eq!(done.len(), 1, "{done:?}");
    let mesh = done[0].result.clone().expect("painted");
    assert_eq!((done[0].entity, mesh.vertices), (ground, 49 * 49));
    assert!(mesh.in_hollows > 20 && mesh.sheltered < 40, "{mesh:?}");
}

#[test]
fn bad_meshes_are_named_and_stay_as_they_are() {
    if !gpu::available() {
        return;
    }
    let mut yard = Yard::new();
    yard.done();
    let roof = yard.roof;
    let bare = {
        let world = yard.test.world();
        let handle = world.get::<Mesh3d>(roof).expect("a mesh").0.clone();
        let mut meshes = world.resource_mut::<Assets<Mesh>>();
        let mut mesh = meshes.get(&handle).expect("its data").clone();
        mesh.remove_attribute(Mesh::ATTRIBUTE_NORMAL);
        mesh.remove_attribute(Mesh::ATTRIBUTE_UV_0);
        meshes.add(mesh)
    };
    let table = yard.table;
    let world = yard.test.world();
    let bare_entity = world.spawn((Mesh3d(bare.clone()), AutoPaint::default())).id();
    let mut painter = world.get_mut::<AutoPaint>(table).expect("the painter");
    painter.wind_m_s = f32::NAN;
    yard.test.frames(2, FRAME);
    let mut done = yard.done();
    done.sort_by_key(|d| d.entity != bare_entity);
    assert_eq!(done.len(), 2, "{done:?}");
    assert_eq!(done[0].result, Err(AutoPaintError::NoNormals));
    let message = done[1].result.clone().expect_err("no wind").to_string();
    assert!(message.contains("wind_m_s"), "{message}");
    assert_eq!(
        yard.test.world().get::<Mesh3d>(bare_entity).map(|m| m.0.id()),
        Some(bare.id())
    );
    // Once for each request, not in every frame.
    yard.test.frames(3, FRAME);
    assert!(yard.done().is_empty());
}

#[test]
fn a_step_in_a_puddle_splashes_and_makes_waves_and_one_beside_it_does_not() {
    if !gpu::available() {
        return;
    }
    let (mut test, weather) = hollow();
    test.frames(3, FRAME);
    test.leap(2);
    test.world().entity_mut(weather).insert(Weather::rain(60.0));
    test.leap(1200);
    test.world().entity_mut(weather).insert(Weather::rain(0.0));
    test.frames(4, FRAME);
    let mut step = |x: f32, y: f32| {
        test.reset();
        test.world().write_message(FootStep::at(Vec3::new(x, y, 0.0)));
        test.frames(2, FRAME);
        let splashes = test.world().resource::<Messages<FootSplash>>().len();
        (splashes, test.recorded(PassName::Waves) > 0)
    };
    assert_eq!(step(-5.0, -0.05), (0, false));
    assert_eq!(step(0.1, -0.06), (1, true));
}
