//! Mist of splashes over level ground, and under what covers.

use glam::{Quat, Vec3};
use rain_core::haze::drop_phase_per_sr;
use rain_core::rainfall::Lamp;
use rain_core::splash::{MistLayer, MistLayers};

use super::{HALF_STEP, Shot};
use crate::device::device;

/// Looking down at ground that a wall across the view stands for; its haze alone, without rain.
fn depth_of(
    gpu: &crate::device::Device,
    mist: MistLayers,
    pitch: f32,
    far_m: f32,
    roof: Option<f32>,
) -> Vec<(f64, f64)> {
    let shot = Shot {
        rotation: Quat::from_rotation_x(pitch),
        rate: 0.0,
        wall_m: Some(far_m),
        background: [0.5; 3],
        splash: Some((mist, -far_m, roof)),
        ambient: Vec3::ZERO,
        ..Shot::default()
    };
    let mut found = Vec::new();
    shot.each(gpu, |towards, rgb| found.push((towards.y, -(rgb[1] / 0.5).ln())));
    found
}

#[test]
fn mist_on_level_ground_has_the_depth_of_its_layer_and_none_is_under_a_roof() {
    let Some(gpu) = device() else { return };
    let down = -core::f32::consts::FRAC_PI_2;
    let thrown = MistLayer {
        extinction_per_m: 3.0,
        height_m: 0.06,
    };
    let carried = MistLayer {
        extinction_per_m: 0.2,
        height_m: 1.5,
    };
    let none = MistLayer::default();
    let eye_m = 2.0;
    for layers in [[thrown, none], [none, carried], [thrown, carried]] {
        let mist = MistLayers {
            thrown: layers[0],
            carried: layers[1],
        };
        for (rise, found) in depth_of(&gpu, mist, down, eye_m, None) {
            let way = f64::from(eye_m) / -rise;
            let expected: f64 = layers.iter().map(|layer| layer.depth(eye_m.into(), 0.0, way)).sum();
            // Half floats of the light; the nodes of the thrown layer leave out its last 2e-3.
            let allowed = 2.0 * HALF_STEP + 4e-3 * expected;
            assert!((found - expected).abs() < allowed, "{rise}: {found}, not {expected}");
        }
    }
    // The map's surface is a roof over eye and ground: no mist is thrown under it.
    let mist = MistLayers { thrown, carried: none };
    for (_, found) in depth_of(&gpu, mist, down, eye_m, Some(1.0)) {
        assert!(found < 2.0 * HALF_STEP, "{found}");
    }
    // Bad inputs of a host make none.
    let flat = MistLayers {
        thrown: MistLayer {
            extinction_per_m: 0.0,
            height_m: 0.0,
        },
        carried: none,
    };
    for (_, found) in depth_of(&gpu, flat, down, eye_m, None) {
        assert!(found.abs() < 2.0 * HALF_STEP, "{found}");
    }
}

#[test]
fn mist_thickens_where_the_ground_is_seen_at_a_flatter_angle() {
    let Some(gpu) = device() else { return };
    let mist = MistLayers {
        thrown: MistLayer {
            extinction_per_m: 0.5,
            height_m: 0.06,
        },
        carried: MistLayer::default(),
    };
    // Through the same ground seen straight down: longer ways towards the corners.
    let found = depth_of(&gpu, mist, -core::f32::consts::FRAC_PI_2, 3.0, None);
    let steep = found.iter().filter(|(rise, _)| *rise < -0.995).map(|(_, depth)| *depth);
    let flat = found.iter().filter(|(rise, _)| *rise > -0.85).map(|(_, depth)| *depth);
    let mean = |values: Vec<f64>| values.iter().sum::<f64>() / values.len() as f64;
    let (steep, flat) = (mean(steep.collect()), mean(flat.collect()));
    assert!(flat > 1.15 * steep && steep > 0.02, "{flat} {steep}");
}

#[test]
fn lamps_light_the_mist_where_it_stands() {
    let Some(gpu) = device() else { return };
    let thrown = MistLayer {
        extinction_per_m: 2.0,
        height_m: 0.06,
    };
    let lamp = Lamp::point(Vec3::new(0.2, -1.2, 0.3), Vec3::new(300.0, 200.0, 100.0), 0.05);
    let shot = Shot {
        rotation: Quat::from_rotation_x(-core::f32::consts::FRAC_PI_2),
        rate: 0.0,
        wall_m: Some(2.0),
        background: [0.0; 3],
        splash: Some((
            MistLayers {
                thrown,
                carried: MistLayer::default(),
            },
            -2.0,
            None,
        )),
        lamps: &[lamp],
        ..Shot::default()
    };
    let mut brightest = 0.0_f64;
    shot.each(&gpu, |towards, rgb| {
        let way = 2.0 / -towards.y;
        let at = towards * way - lamp.position_m.as_dvec3();
        let lost = -(-thrown.depth(2.0, 0.0, way)).exp_m1();
        let phase = drop_phase_per_sr(at.angle_between(-towards));
        for (found, intensity) in rgb.into_iter().zip(lamp.intensity.as_dvec3().to_array()) {
            let expected = intensity * phase / at.length_squared() * lost / 2.0;
            // Half floats, and the nodes of the layer.
            assert!(
                (found - expected).abs() < 6e-3 * expected + 1e-5,
                "{towards}: {found}, not {expected}"
            );
            brightest = brightest.max(found);
        }
    });
    assert!(brightest > 0.1, "{brightest}");
}
