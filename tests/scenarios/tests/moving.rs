//! What moves shelters where it is now.

use std::path::Path;

use bevy::prelude::*;
use rain_plugins::scenario::file::CameraKey;
use test_support::shots::{Plan, View, mean, raining, steady};
use test_support::{gpu, world};

/// A slab that drives along x. Units: m/s.
const SPEED: f64 = 6.0;
/// Half its side. Units: m.
const HALF: f64 = 2.5;
/// When it passes x = 0. Units: s.
const PASSES_S: f64 = 120.0;

#[derive(Component)]
struct Slab;

fn drive(time: Res<Time>, mut slabs: Query<&mut Transform, With<Slab>>) {
    for mut slab in &mut slabs {
        slab.translation.x = slab_x(time.elapsed_secs_f64()) as f32;
    }
}

fn slab_x(time_s: f64) -> f64 {
    SPEED * (time_s - PASSES_S)
}

#[test]
fn a_moving_slab_keeps_rain_and_wet_off_exactly_where_it_is_in_every_capture() {
    if !gpu::available() {
        return;
    }
    // The camera rides under the slab.
    let riding = |time_s: f64| {
        let x = slab_x(time_s);
        View::new([x, 1.2, 2.0], [x, 0.0, -3.0])
    };
    let mut plan = Plan::new(steady(50.0, [0.0; 3]), PASSES_S, &[riding(PASSES_S); 3]);
    plan.scenario.camera.keys = [PASSES_S - 2.0, PASSES_S + 2.0]
        .into_iter()
        .map(|time_s| CameraKey {
            time_s,
            eye: riding(time_s).eye.to_array(),
            target: riding(time_s).target.to_array(),
            fov_y_deg: 60.0,
            cut: false,
        })
        .collect();
    let mut session = plan.session(Path::new("."), |world| {
        world::without_ground(world);
        world::ground(world);
        let low = Vec3::new(-HALF as f32, 2.2, -HALF as f32);
        let high = Vec3::new(HALF as f32, 2.3, HALF as f32);
        let slab = world::block(world, "slab", low, high, world::STONE);
        world.entity_mut(slab).insert(Slab);
    });
    session.app().add_systems(Update, drive);
    for i in 0..3 {
        let mut shot = plan.shot(&mut session, i);
        shot.view = riding(plan.time_s(i));
        let x = slab_x(plan.time_s(i));
        let from_slab = |p: bevy::math::DVec3| (p.x - x).abs().max(p.z.abs());
        let under = shot.where_surface(|p| p.y < 0.02 && from_slab(p) < HALF - 0.2);
        let beside = shot.where_surface(|p| p.y < 0.02 && from_slab(p) > HALF + 0.3);
        assert!(
            under.len() > 2000 && beside.len() > 1000,
            "{} under, {} beside",
            under.len(),
            beside.len()
        );
        assert_eq!(raining(&under), 0, "capture {i}: streaks under the slab");
        assert_eq!(
            under.iter().filter(|p| p.wet > 0.0).count(),
            0,
            "capture {i}: wet under the slab"
        );
        assert!(
            raining(&beside) * 5 > beside.len(),
            "capture {i}: {} of {}",
            raining(&beside),
            beside.len()
        );
        assert!(mean(&beside, |p| p.wet) > 0.95, "capture {i}");
    }
}
