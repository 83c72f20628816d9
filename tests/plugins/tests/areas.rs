//! Rain areas in the picture: wet ground and drops where it rains, no pass where none is near.

use std::time::Duration;

use bevy::math::DVec2;
use bevy::prelude::*;
use image::RgbImage;
use rain_plugins::prelude::*;
use rain_plugins::rainfall::{FollowSettings, FollowShape, RainViewFrame};
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

/// Side of the picture, and its pixels per metre of ground. Units: px, px/m.
const SIZE: u32 = 128;
const PX_PER_M: f32 = 9.66;

fn disc(x: f64, z: f64, radius_m: f64, rain: AreaRain) -> RainArea {
    RainArea(AreaSettings {
        centre_m: DVec2::new(x, z),
        shape: AreaShape::Circle { radius_m },
        rain,
        transition_m: 0.5,
        ..AreaSettings::default()
    })
}

/// Level ground under a dry sky, built.
fn plain(streaks: u32) -> TestApp {
    let mut test = TestApp::new([SIZE, SIZE], true);
    world::ground(test.world());
    test.world().spawn(Weather {
        relative_humidity: 1.0,
        net_radiation_w_m2: 0.0,
        ..Weather::rain(0.0)
    });
    let camera = test.camera;
    test.world().entity_mut(camera).insert(RainView {
        streak_budget: Some(streaks),
        ..default()
    });
    test
}

fn settle(test: &mut TestApp) {
    test.frames(3, FRAME);
    test.leap(2);
    test.frames(3, FRAME);
    assert!(
        test.world().resource::<SurfaceGround>().ground().is_some(),
        "the ground is built"
    );
}

/// Mean brightness of the picture around the ground at (x, z), 0…255.
fn brightness(picture: &RgbImage, x: f32, z: f32) -> f64 {
    let [x, y] = [x, z].map(|at| (0.5 * SIZE as f32 + PX_PER_M * at) as u32);
    let pixels = (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| (x, y)));
    pixels
        .map(|(x, y)| picture.get_pixel(x, y).0.iter().map(|c| f64::from(*c)).sum::<f64>() / 3.0)
        .sum::<f64>()
        / 9.0
}

#[test]
fn the_ground_is_dark_where_it_has_rained_and_stays_so_when_the_shower_is_gone() {
    if !gpu::available() {
        return;
    }
    for map in [true, false] {
        let mut test = plain(0);
        test.world().resource_mut::<GroundMapSettings>().enabled = map;
        test.look(Vec3::new(0.0, 16.0, 0.0), Vec3::ZERO);
        settle(&mut test);
        let places = [(2.5, 0.5), (-3.5, 0.5), (2.5, 4.5)];
        let seen = |test: &mut TestApp| {
            let picture = test.picture();
            places.map(|(x, z)| brightness(&picture, x, z))
        };
        let dry = seen(&mut test);
        let shower = test.world().spawn(disc(2.5, 0.5, 2.5, AreaRain::Rate(60.0))).id();
        test.frames(12, Duration::from_secs(5));
        test.frames(2, FRAME);
        let wet = seen(&mut test);
        let darker = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| a[i] - b[i]);
        let [inside, beside, below] = darker(dry, wet);
        assert!(
            inside > 8.0 && beside.abs() < 2.0 && below.abs() < 2.0,
            "map {map}: {inside} {beside} {below}"
        );
        test.world().despawn(shower);
        test.frames(2, Duration::from_secs(5));
        test.frames(2, FRAME);
        let [inside, beside, _] = darker(dry, seen(&mut test));
        assert!(
            inside > 8.0 && beside.abs() < 2.0,
            "after it, map {map}: {inside} {beside}"
        );
    }
}

#[test]
fn drops_are_in_the_area_alone_and_no_pass_is_recorded_when_none_is_near() {
    if !gpu::available() {
        return;
    }
    let mut test = plain(20_000);
    settle(&mut test);
    // Far away: the world rains, the view does not.
    let area = test.world().spawn(disc(0.0, -400.0, 50.0, AreaRain::Rate(80.0))).id();
    test.frames(4, FRAME);
    test.reset();
    test.frames(4, FRAME);
    assert_eq!(test.recorded(PassName::Rainfall), 0);
    assert_eq!(test.skipped(PassName::Rainfall, SkipReason::NoRain), 4);
    // Over half of the view.
    test.world()
        .entity_mut(area)
        .insert(disc(60.0, 8.0, 60.0, AreaRain::Rate(80.0)));
    test.frames(4, FRAME);
    test.reset();
    test.frames(4, FRAME);
    assert_eq!(test.recorded(PassName::Rainfall), 4);
    let camera = test.camera;
    let places = |test: &mut TestApp| -> Vec<Vec3> {
        let eye = test.world().get::<Transform>(camera).expect("a camera").translation;
        let frame = test.world().get::<RainViewFrame>(camera).expect("a rain view");
        let seed = frame.choice.as_ref().expect("rain").seed;
        let drops = frame.drops();
        drops
            .records
            .iter()
            .map(|r| eye + r.position(seed, &drops.classes))
            .collect()
    };
    let drops = places(&mut test);
    assert!(
        drops.len() > 2000 && drops.iter().all(|p| p.x > -0.3),
        "{}",
        drops.len()
    );
    // In a container that follows the view: fewer, and none outside it.
    let container = FollowSettings {
        shape: FollowShape::SemiCylinder {
            across_m: 3.0,
            ahead_m: 4.0,
            height_m: 4.0,
        },
        slack_m: 0.5,
        rim_m: 0.5,
    };
    test.world().get_mut::<RainView>(camera).expect("a rain view").container = Some(container);
    test.frames(4, FRAME);
    let part = places(&mut test);
    assert!(
        part.len() > 100 && part.len() < drops.len() / 2,
        "{} of {}",
        part.len(),
        drops.len()
    );
    assert!(
        part.iter().all(|p| p.z > 8.0 - 4.6 && p.x < 3.6),
        "a drop outside the container"
    );
}
