//! The masks of the ground: what it remembers of the rain, and where water stands on it.

use std::path::Path;

use bevy::math::{DVec2, Vec3};
use bevy::mesh::VertexAttributeValues;
use bevy::prelude::*;
use rain_plugins::prelude::*;
use rain_plugins::scenario::file::ScenePart;
use rain_plugins::surface::GroundMap;
use test_support::shots::{Plan, View, mean, raining, steady};
use test_support::{assets, gpu, world};

#[test]
fn the_wet_mask_keeps_what_the_ground_took_under_a_roof_that_has_just_come() {
    if !gpu::available() {
        return;
    }
    let shown = |memory: bool| {
        let views = [View::new([0.0, 1.7, 4.0], [0.0, 0.0, -1.0]); 2];
        let plan = Plan::new(steady(50.0, [0.0; 3]), 120.0, &views);
        let mut session = plan.session(Path::new("."), |world| {
            if !memory {
                world::without_ground(world);
            }
            world::ground(world);
        });
        // The ground is handed over at the end of a step and built by the ticks after it.
        session.advance(1.0).expect("the renderer goes on");
        let under = |p: bevy::math::DVec3| p.y.abs() < 0.02 && p.x.abs().max(p.z.abs()) < 4.5;
        let before = plan.shot(&mut session, 0).where_surface(under);
        world::roof(session.app().world_mut());
        let after = plan.shot(&mut session, 1).where_surface(under);
        assert!(
            before.len() > 3000 && after.len() > 3000,
            "{} and {}",
            before.len(),
            after.len()
        );
        assert!(
            raining(&before) > 0 && raining(&after) == 0,
            "the roof keeps the rain off"
        );
        [&before, &after].map(|pixels| mean(pixels, |p| p.wet))
    };
    let [before, after] = shown(true);
    assert!(
        before > 0.99 && after > 0.99,
        "{before}, then {after} under the new roof"
    );
    let [before, after] = shown(false);
    assert!(
        before > 0.99 && after == 0.0,
        "{before}, then {after} without the ground"
    );
}

#[test]
fn the_wet_mask_shows_the_dry_patch_that_a_truck_leaves_as_the_water_map_knows_it() {
    if !gpu::available() {
        return;
    }
    // Under the truck and beside it, from straight above.
    let shown = |map: bool| {
        let view = View::new([0.0, 10.0, 0.0], [0.0, 0.0, 0.0]);
        let plan = Plan::new(steady(60.0, [0.0; 3]), 31.3, &[view]);
        let mut truck = None;
        let mut session = plan.session(Path::new("."), |world| {
            world::ground(world);
            if !map {
                world.remove_resource::<GroundMap>();
            }
            let (low, high) = (Vec3::new(-1.5, 0.6, -1.5), Vec3::new(1.5, 2.6, 1.5));
            let block = world::block(world, "truck", low, high, world::STONE);
            // The simulation's ground does not know it.
            world.entity_mut(block).insert(MovesInRain);
            truck = Some(block);
        });
        session.play(30.0, 2.0).expect("the renderer goes on");
        session.app().world_mut().despawn(truck.expect("a truck"));
        session.play(31.0, 2.0).expect("the renderer goes on");
        let shot = plan.shot(&mut session, 0);
        let near = |p: bevy::math::DVec3, x: f64| p.y.abs() < 0.02 && (p.x - x).abs() < 0.8 && p.z.abs() < 0.8;
        [0.0, 4.0].map(|x| {
            let pixels = shot.where_surface(|p| near(p, x));
            assert!(pixels.len() > 60, "{} pixels", pixels.len());
            mean(&pixels, |p| p.wet)
        })
    };
    let [under, beside] = shown(true);
    assert!(under < 0.15 && beside > 0.8, "{under} under it, {beside} beside it");
    let [under, beside] = shown(false);
    assert!(under > 0.8 && beside > 0.8, "without the map {under} and {beside}");
}

/// Gives a mesh of its own to an entity whose vertices all have this colour.
fn colour(world: &mut World, entity: Entity, colour: [f32; 4]) {
    let handle = world.get::<Mesh3d>(entity).expect("a mesh").0.clone();
    let mut meshes = world.resource_mut::<Assets<Mesh>>();
    let mut mesh = meshes.get(&handle).expect("its data").clone();
    let count = mesh.count_vertices();
    mesh.insert_attribute(
        Mesh::ATTRIBUTE_COLOR,
        VertexAttributeValues::Float32x4(vec![colour; count]),
    );
    let own = meshes.add(mesh);
    world.entity_mut(entity).insert(Mesh3d(own));
}

#[test]
fn masks_show_what_artists_placed_and_how_meshes_take_water() {
    if !gpu::available() {
        return;
    }
    let view = View::new([0.0, 10.0, 0.0], [0.0, 0.0, 0.0]);
    let plan = Plan::new(steady(50.0, [0.0; 3]), 120.0, &[view]);
    let noise = NoisePuddles {
        seed: 3,
        size_m: 0.7,
        level: Some(0.8),
        height_map: false,
        ..default()
    };
    let mut session = plan.session(Path::new("."), |world| {
        world::without_ground(world);
        world::ground(world);
        let [painted, unpainted, noisy, proof] = [-6.0, -2.0, 2.0, 6.0].map(|x| {
            let (low, high) = (Vec3::new(x - 1.0, 0.0, -1.0), Vec3::new(x + 1.0, 0.1, 1.0));
            world::block(world, "plate", low, high, world::STONE)
        });
        // A full puddle where the paint counts; vertex colours alone are none.
        for plate in [painted, unpainted] {
            colour(world, plate, [1.0, 1.0, 1.0, 0.0]);
        }
        world.entity_mut(painted).insert(PuddlePaint {
            fixed: true,
            height_map: false,
            depth_m: 0.02,
            ..default()
        });
        world.entity_mut(noisy).insert(noise);
        world.entity_mut(proof).insert(SurfaceWetting {
            strength: 0.0,
            ..default()
        });
        // Masks see through what is transparent.
        let glass = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial {
            base_color: Color::srgba(1.0, 0.2, 0.2, 0.5),
            alpha_mode: AlphaMode::Blend,
            ..default()
        });
        let (low, high) = (Vec3::new(-7.0, 1.0, 0.0), Vec3::new(-5.0, 1.05, 1.0));
        world::block_of(world, "pane", low, high, glass);
    });
    let shot = plan.shot(&mut session, 0);
    let at = |x: f64, y: f64| {
        let pixels = shot.where_surface(|p| (p.y - y).abs() < 0.02 && (p.x - x).abs() < 0.8 && p.z.abs() < 0.8);
        assert!(pixels.len() > 60, "{} pixels at {x}", pixels.len());
        pixels
    };
    let painted = at(-6.0, 0.1);
    assert!(
        painted.iter().all(|p| (p.water - 0.02).abs() < 2e-5 && p.wet > 0.999),
        "{:?}",
        painted[0]
    );
    for (x, y) in [(-2.0, 0.1), (4.0, 0.0)] {
        let without = at(x, y);
        assert!(
            without.iter().all(|p| p.water == 0.0 && p.wet > 0.99),
            "nobody placed water at {x}: {:?}",
            without[0]
        );
    }
    let noisy = at(2.0, 0.1);
    let depth = |p: &test_support::shots::Pixel| {
        let place = p.surface.expect("on the plate");
        noise.depth_m(DVec2::new(place.x, place.z), 0.0, 0.0)
    };
    for p in &noisy {
        assert!((p.water - depth(p)).abs() < 2e-4, "{p:?}, not {} m", depth(p));
    }
    let (least, most) = noisy
        .iter()
        .map(|p| p.water)
        .fold((1.0_f64, 0.0_f64), |(l, h), w| (l.min(w), h.max(w)));
    assert!(least == 0.0 && most > 0.004, "from {least} to {most} m");
    let proof = at(6.0, 0.1);
    assert!(
        proof.iter().all(|p| p.water == 0.0 && p.wet == 0.0),
        "it takes no water: {:?}",
        proof[0]
    );
}

#[test]
fn the_water_mask_shows_a_level_pool_in_the_hollow_and_nothing_on_the_crown() {
    if !gpu::available() {
        return;
    }
    let (files, layout) = assets::street_folder();
    // From above, between a hollow and the crown of the road.
    let view = View::new([1.3, 4.2, -4.0], [1.3, 0.0, -4.0]);
    let mut plan = Plan::new(steady(50.0, [0.0; 3]), 1200.0, &[view]);
    plan.scenario.scene = vec![ScenePart::from_file(street::STREET_FILE)];
    let mut session = plan.session(files, |_| {});
    let shot = plan.shot(&mut session, 0);
    let from = |p: bevy::math::DVec3, h: &street::layout::Hollow| {
        DVec2::new(p.x, p.z).distance(DVec2::new(h.centre[0].into(), h.centre[1].into()))
    };
    let hollow = layout
        .hollows
        .iter()
        .find(|h| h.centre == [2.3, -4.0])
        .expect("the hollow before the camera");
    let pool = shot.where_surface(|p| from(p, hollow) < 0.4);
    assert!(pool.len() > 120, "{} pixels in the hollow", pool.len());
    let depths = pool.iter().map(|p| p.water);
    let (shallow, deep) = depths.fold((f64::MAX, 0.0_f64), |(l, h), d| (l.min(d), h.max(d)));
    assert!(shallow > 0.005 && deep < 0.06, "{shallow} to {deep} m in the hollow");
    // The bottom is bowl-shaped, the surface level; distances are rounded to a millimetre.
    let surface = pool.iter().filter_map(|p| Some(p.surface?.y + p.water));
    let (low, high) = surface.fold((f64::MAX, f64::MIN), |(l, h), y| (l.min(y), h.max(y)));
    assert!(high - low < 0.003, "its surface lies between {low} and {high} m");
    // Soaked under water.
    assert!(pool.iter().all(|p| p.wet > 0.999));
    let crown = shot.where_surface(|p| {
        let road = (p.y - f64::from(layout.ground_height(p.x as f32, p.z as f32))).abs() < 0.02;
        road && p.x.abs() < 0.5 && layout.hollows.iter().all(|h| from(p, h) > f64::from(h.radius))
    });
    assert!(crown.len() > 200, "{} pixels of the crown", crown.len());
    assert_eq!(crown.iter().filter(|p| p.water > 0.0).count(), 0, "water on the crown");
}
