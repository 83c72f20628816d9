//! Models that nobody here made (`RAIN_ASSETS`).

use bevy::camera::primitives::Aabb;
use bevy::math::DVec3;
use bevy::prelude::*;
use rain_plugins::scenario::file::{PathKey, ScenePart, Vehicle};
use test_support::shots::{Plan, View, mean, raining, steady};
use test_support::{assets, gpu, world};

/// Bounds of everything under `root`. Units: m.
fn bounds(world: &mut World, root: Entity) -> (DVec3, DVec3) {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let mut open = vec![root];
    while let Some(entity) = open.pop() {
        open.extend(world.get::<Children>(entity).into_iter().flat_map(|c| c.iter()));
        if let (Some(aabb), Some(place)) = (world.get::<Aabb>(entity), world.get::<GlobalTransform>(entity)) {
            for corner in 0..8_u32 {
                let sign = |bit: u32| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
                let local = aabb.center + aabb.half_extents * bevy::math::Vec3A::new(sign(0), sign(1), sign(2));
                let p = place.transform_point(local.into()).as_dvec3();
                (low, high) = (low.min(p), high.max(p));
            }
        }
    }
    (low, high)
}

#[test]
fn real_roads_get_wet_but_not_under_a_real_truck_while_it_drives() {
    let Some(folder) = assets::real_models() else { return };
    if !gpu::available() {
        return;
    }
    let (start, speed) = (90.0, 6.0);
    let place = |time_s: f64| [speed * (time_s - start), 0.9, 1.4];
    let above = |time_s: f64| {
        let [x, ..] = place(time_s);
        View::new([x + 9.0, 4.0, 9.0], [x, 0.5, 1.4]).fov(50.0)
    };
    let mut plan = Plan::new(steady(50.0, [0.0; 3]), start, &[above(start); 2]);
    plan.scenario.scene = (-3..=3)
        .map(|i| ScenePart {
            translation: [8.0 * f64::from(i), 0.0, 0.0],
            yaw_deg: 90.0,
            scale: 8.0,
            ..ScenePart::from_file("road-straight.glb")
        })
        .collect();
    plan.scenario.vehicles = vec![Vehicle {
        name: "truck".into(),
        file: "vehicle-truck-yellow.glb".into(),
        scale: 1.6,
        path: [start - 2.0, start + 2.0]
            .into_iter()
            .map(|time_s| PathKey {
                time_s,
                position: place(time_s),
            })
            .collect(),
        wheel_radius_m: 0.48,
        ..Vehicle::default()
    }];
    plan.scenario.camera.keys = vec![rain_plugins::scenario::file::CameraKey {
        time_s: 0.0,
        eye: above(start).eye.to_array(),
        target: above(start).target.to_array(),
        fov_y_deg: 50.0,
        cut: false,
    }];
    let mut session = plan.session(&folder, world::without_ground);
    for i in 0..2 {
        let shot = plan.shot(&mut session, i);
        let world = session.app().world_mut();
        let truck = world
            .query::<(Entity, &Name)>()
            .iter(world)
            .find(|(_, name)| name.as_str() == "truck")
            .map(|(entity, _)| entity)
            .expect("the truck");
        let (low, high) = bounds(world, truck);
        assert!((high - low).min_element() > 0.8, "a truck from {low} to {high}");
        // The road's surface; the kerb stands above it.
        let road = |p: DVec3| p.y < low.y + 0.05 && p.z.abs() < 2.5;
        let inset = 0.35;
        let under = shot.where_surface(|p| {
            road(p) && p.x > low.x + inset && p.x < high.x - inset && p.z > low.z + inset && p.z < high.z - inset
        });
        let beside = shot.where_surface(|p| road(p) && (p.x < low.x - 0.5 || p.x > high.x + 0.5));
        assert!(
            under.len() > 20 && beside.len() > 500,
            "{} under, {} beside",
            under.len(),
            beside.len()
        );
        assert_eq!(
            under.iter().filter(|p| p.wet > 0.0).count(),
            0,
            "capture {i}: of {} under the truck",
            under.len()
        );
        assert!(
            mean(&beside, |p| p.wet) > 0.9,
            "capture {i}: {}",
            mean(&beside, |p| p.wet)
        );
        assert!(raining(&beside) > 0, "capture {i}: no streak");
    }
}
