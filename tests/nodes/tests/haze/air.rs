//! What else is in the air: rainbows, mist, an artist's fog over a share of it, and all of that in a mirror.

use glam::{Quat, Vec3};
use rain_core::haze::{drop_phase_per_sr, extinction_per_m};
use rain_core::optics::RainbowTables;
use rain_render::haze::{HazeBow, HazeFog};

use super::{HALF_STEP, Shot, spectrum};
use crate::device::device;

#[test]
fn the_bow_in_the_haze_is_its_light_over_the_rain_in_sight() {
    let Some(gpu) = device() else { return };
    let tables = RainbowTables::new();
    let bow = tables.of_rain(&spectrum(25.0));
    let sun = [Vec3::new(0.1, 0.3, 1.0).normalize(), Vec3::new(40.0, 30.0, 20.0)];
    let geometric = extinction_per_m(&spectrum(25.0), 1.0);
    let mut greatest = [0.0_f64; 2];
    for (pitch, strength, wall) in [
        (0.3, 1.0, Some(3000.0)),
        (0.3, 2.5, Some(500.0)),
        (-0.2, 1.0, None),
        (0.3, 0.0, None),
    ] {
        let shot = Shot {
            rotation: Quat::from_rotation_x(pitch),
            wall_m: wall,
            background: [0.0; 3],
            sun,
            bow: Some(HazeBow { phase: &bow, strength }),
            ..Shot::default()
        };
        shot.each(&gpu, |towards, rgb| {
            let depth = geometric * shot.way(towards);
            let angle = towards.angle_between(-sun[0].as_dvec3());
            let turned = drop_phase_per_sr(std::f64::consts::PI - angle) / 2.0 * -(-2.0 * depth).exp_m1();
            let share = -0.5 * f64::from(strength) * (-2.0 * depth).exp_m1();
            let light = bow.per_sr(angle);
            for (c, found) in rgb.into_iter().enumerate() {
                let expected = f64::from(sun[1][c]) * (turned + share * light[c]);
                // Half floats, and an angle to 1e-6 on slopes of 0.1 in 0.1 degrees.
                let allowed = 2.0 * HALF_STEP * expected + 2e-4 * f64::from(sun[1][c]);
                assert!((found - expected).abs() < allowed, "{towards}: {found} {expected}");
                greatest[usize::from(strength > 0.0)] = greatest[usize::from(strength > 0.0)].max(found);
            }
        });
    }
    assert!(greatest[1] > 2.0 * greatest[0] && greatest[0] > 0.0, "{greatest:?}");
}

#[test]
fn a_mirrored_view_has_the_haze_beyond_its_mirror_however_the_near_plane_lies() {
    let Some(gpu) = device() else { return };
    let extinction = extinction_per_m(&spectrum(25.0), 2.0);
    // What is drawn at eight tenths of the depth of the mirror itself, and the sky.
    for wall in [Some(0.125), None] {
        let shot = Shot {
            rotation: Quat::from_rotation_y(0.4) * Quat::from_rotation_x(0.3),
            mirror_m: Some(20.0),
            wall_m: wall,
            ..Shot::default()
        };
        let mut seen = 0;
        shot.each(&gpu, |towards, rgb| {
            // The mirror itself, and what lies beneath it, is not drawn.
            let to_mirror = 20.0 / towards.y;
            let way = shot.mirrored_way(towards);
            if towards.y < 0.01 || to_mirror > way {
                return;
            }
            let expected = (-extinction * (way - to_mirror)).exp();
            assert!(
                (rgb[0] - expected).abs() < 2.0 * HALF_STEP,
                "{towards}: {} {expected}",
                rgb[0]
            );
            seen += 1;
        });
        assert!(seen > 2000, "{seen}");
    }
}

#[test]
fn mist_is_everywhere_under_the_cloud_and_adds_to_the_rain() {
    let Some(gpu) = device() else { return };
    for rate in [0.0, 25.0] {
        let shot = Shot {
            rate,
            mist_per_m: 0.003,
            wall_m: Some(300.0),
            ..Shot::default()
        };
        let extinction = 0.003
            + if rate > 0.0 {
                extinction_per_m(&spectrum(rate), 2.0)
            } else {
                0.0
            };
        shot.each(&gpu, |towards, rgb| {
            let expected = (-extinction * shot.way(towards)).exp();
            assert!(
                (rgb[0] - expected).abs() < 2.0 * HALF_STEP,
                "{rate}: {} {expected}",
                rgb[0]
            );
        });
    }
}

#[test]
fn half_of_the_artists_fog_is_half_of_the_rains_haze() {
    let Some(gpu) = device() else { return };
    for share in [0.0_f32, 0.5, 1.0] {
        let shot = Shot {
            background: [1.0; 3],
            fog: Some(HazeFog {
                density_per_m: 0.02,
                colour: Vec3::ZERO,
                coloured: 1.0,
                desaturation: 0.0,
                share,
            }),
            ..Shot::default()
        };
        let rain = extinction_per_m(&spectrum(25.0), 2.0);
        shot.each(&gpu, |towards, rgb| {
            let [rain, fog] = [rain, 0.02].map(|extinction| (-extinction * shot.way(towards)).exp());
            let expected = rain + (fog - rain) * f64::from(share);
            assert!(
                (rgb[0] - expected).abs() < 2.0 * HALF_STEP,
                "{share}: {} {expected}",
                rgb[0]
            );
        });
    }
}
