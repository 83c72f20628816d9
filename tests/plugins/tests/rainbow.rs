//! Rainbows in a Bevy app: where they stand, what colours they have, and when there is none.

use bevy::math::DVec2;
use bevy::prelude::*;
use image::RgbImage;
use rain_core::rainfall::areas::{AreaRain, AreaSettings, AreaShape};
use rain_plugins::prelude::*;
use test_support::app::{FRAME, TestApp};
use test_support::gpu;

const SIZE: [u32; 2] = [640, 360];
/// Height of the eye.
const EYE_M: f32 = 2.0;

/// A wide shower two kilometres ahead before a dark sky, the sun behind the eye at this height.
fn shower(sun_deg: f32, lux: f32) -> TestApp {
    let mut test = TestApp::new(SIZE, true);
    test.app.insert_resource(GlobalAmbientLight {
        brightness: 20.0,
        ..default()
    });
    test.app.insert_resource(ClearColor(Color::BLACK));
    let camera = test.camera;
    let settings = HazeSettings {
        cloud_base_m: 3000.0,
        ..default()
    };
    test.world().entity_mut(camera).insert((
        settings,
        Projection::Perspective(PerspectiveProjection {
            fov: 70_f32.to_radians(),
            ..default()
        }),
    ));
    let world = test.world();
    let mut suns = world.query::<(&mut DirectionalLight, &mut Transform)>();
    for (mut light, mut place) in suns.iter_mut(world) {
        light.illuminance = lux;
        let height = sun_deg.to_radians();
        *place = Transform::default().looking_to(Vec3::new(0.0, -height.sin(), -height.cos()), Vec3::Y);
    }
    world.spawn(Weather::rain(0.0));
    world.spawn(RainArea(AreaSettings {
        centre_m: DVec2::new(0.0, -5000.0),
        shape: AreaShape::Ellipse {
            radii_m: DVec2::new(9000.0, 2500.0),
            heading_rad: 0.0,
        },
        rain: AreaRain::Rate(20.0),
        transition_m: 300.0,
        ..default()
    }));
    // Above the horizon, where the top of a bow of a low sun stands.
    test.look(Vec3::new(0.0, EYE_M, 0.0), Vec3::new(0.0, EYE_M + 0.5, -1.0));
    test
}

fn with_bow(mut test: TestApp, strength: f32) -> TestApp {
    let camera = test.camera;
    test.world()
        .entity_mut(camera)
        .insert(Rainbow { strength, ..default() });
    test
}

fn picture(test: &mut TestApp) -> RgbImage {
    test.frames(6, FRAME);
    test.picture()
}

/// Angle of a row of the picture's middle column over the horizon. Units: degrees.
fn height_deg(row: f32) -> f32 {
    let ndc = 1.0 - 2.0 * (row + 0.5) / SIZE[1] as f32;
    (0.5_f32.atan() + (ndc * 35_f32.to_radians().tan()).atan()).to_degrees()
}

/// Red, green and blue of a row about the middle column, in shares of their sum, and that sum.
fn row(picture: &RgbImage, y: u32) -> [f32; 4] {
    let mut sum = [0.0; 3];
    for x in SIZE[0] / 2 - 8..SIZE[0] / 2 + 8 {
        for (sum, value) in sum.iter_mut().zip(picture.get_pixel(x, y).0) {
            *sum += f32::from(value);
        }
    }
    // Where nothing is drawn: grey.
    let all = sum.iter().sum::<f32>() + 3.0;
    let sum = sum.map(|v| v + 1.0);
    [sum[0] / all, sum[1] / all, sum[2] / all, all]
}

/// The height (degrees) between two at which `of` a row is greatest.
fn peak(picture: &RgbImage, from: f32, to: f32, of: impl Fn([f32; 4]) -> f32) -> f32 {
    (0..SIZE[1])
        .filter(|y| (from..to).contains(&height_deg(*y as f32)))
        .max_by(|a, b| of(row(picture, *a)).total_cmp(&of(row(picture, *b))))
        .map_or(f32::NAN, |y| height_deg(y as f32))
}

#[test]
fn bows_stand_at_42_and_51_degrees_red_outside_and_red_inside() {
    if !gpu::available() {
        return;
    }
    for sun in [10.0, 20.0] {
        let mut test = with_bow(shower(sun, 8_000.0), 1.0);
        let picture = picture(&mut test);
        test.reset();
        test.frames(3, FRAME);
        assert_eq!(test.recorded(PassName::Rainbow), 3);
        assert_eq!(test.recorded(PassName::Haze), 3, "no pass of its own");
        // The top of each bow: its angle less the sun's height.
        let red = peak(&picture, 36.0 - sun, 46.0 - sun, |c| c[0]) + sun;
        let blue = peak(&picture, 36.0 - sun, 43.0 - sun, |c| c[2]) + sun;
        let bright = peak(&picture, 36.0 - sun, 46.0 - sun, |c| c[3]) + sun;
        assert!(
            (red - 42.0).abs() < 0.6 && (blue - 40.5).abs() < 0.8,
            "{sun}: {red} {blue}"
        );
        // The brightest row may be that of the blue: rows are half a degree high.
        assert!(
            blue <= bright && bright < red + 0.1 && blue < red,
            "{blue} {bright} {red}"
        );
        let second_red = peak(&picture, 48.0 - sun, 56.0 - sun, |c| c[0]) + sun;
        let second_blue = peak(&picture, 51.0 - sun, 57.0 - sun, |c| c[2]) + sun;
        assert!((second_red - 50.5).abs() < 0.7, "{sun}: {second_red}");
        assert!(second_blue > second_red + 1.5, "{sun}: {second_red} {second_blue}");
        // Dark between them, brighter within.
        let at = |degrees: f32| {
            let near = |y: &u32| (height_deg(*y as f32) + sun - degrees).abs();
            let y = (0..SIZE[1]).min_by(|a, b| near(a).total_cmp(&near(b))).expect("a row");
            row(&picture, y)[3]
        };
        let (band, first, second, inside) = (at(46.5), at(bright), at(52.0), at(37.0));
        assert!(
            band < inside && inside < first && band < second && second < first,
            "{band} {first} {second} {inside}"
        );
    }
}

#[test]
fn without_the_component_a_sun_or_rain_there_is_no_bow_and_no_work() {
    if !gpu::available() {
        return;
    }
    let mut plain = shower(15.0, 8_000.0);
    let without = picture(&mut plain);
    assert_eq!(plain.recorded(PassName::Rainbow), 0);
    assert!(plain.skipped(PassName::Rainbow, SkipReason::Disabled) >= 6);
    let mut off = with_bow(shower(15.0, 8_000.0), 0.0);
    assert_eq!(picture(&mut off), without, "off");
    assert!(off.skipped(PassName::Rainbow, SkipReason::Disabled) >= 6);
    let mut night = with_bow(shower(15.0, 0.0), 1.0);
    // The first frame has no haze yet.
    night.frames(6, FRAME);
    assert!(night.skipped(PassName::Rainbow, SkipReason::NoSun) >= 4);
    assert_eq!(night.recorded(PassName::Rainbow), 0);
    let mut clear = with_bow(shower(15.0, 8_000.0), 1.0);
    let camera = clear.camera;
    clear.world().get_mut::<HazeSettings>(camera).expect("settings").enabled = false;
    clear.frames(4, FRAME);
    assert!(clear.skipped(PassName::Rainbow, SkipReason::NoHaze) >= 4);
    // A bad value leaves the last good ones in force.
    let mut bad = with_bow(shower(15.0, 8_000.0), 1.0);
    bad.frames(2, FRAME);
    let camera = bad.camera;
    bad.world().get_mut::<Rainbow>(camera).expect("a bow").strength = f32::NAN;
    bad.reset();
    bad.frames(4, FRAME);
    assert_eq!(bad.recorded(PassName::Rainbow), 4);
}

#[test]
fn a_sun_above_42_degrees_leaves_the_sky_without_a_first_bow() {
    if !gpu::available() {
        return;
    }
    let colours = |picture: &RgbImage| {
        let mut most: f32 = 0.0;
        for y in (0..SIZE[1]).filter(|y| height_deg(*y as f32) > 1.0 && height_deg(*y as f32) < 30.0) {
            let [r, g, b, _] = row(picture, y);
            most = most.max((r - 1.0 / 3.0).abs() + (g - 1.0 / 3.0).abs() + (b - 1.0 / 3.0).abs());
        }
        most
    };
    let low = colours(&picture(&mut with_bow(shower(20.0, 8_000.0), 1.0)));
    // The second one sets at 51°, its violet edge at 57°.
    let high = colours(&picture(&mut with_bow(shower(62.0, 8_000.0), 1.0)));
    assert!(low > 0.1 && high < 0.03, "{low} {high}");
}

#[test]
fn fog_has_a_wide_white_bow() {
    if !gpu::available() {
        return;
    }
    let mut test = with_bow(shower(10.0, 8_000.0), 1.0);
    let camera = test.camera;
    test.world().get_mut::<Rainbow>(camera).expect("a bow").drop_radius_m = Some(1e-5);
    let fog = picture(&mut test);
    let rain = picture(&mut with_bow(shower(10.0, 8_000.0), 1.0));
    let spread = |picture: &RgbImage| {
        let rows = (0..SIZE[1]).filter(|y| (20.0..36.0).contains(&height_deg(*y as f32)));
        rows.map(|y| row(picture, y))
            .map(|c| (c[0] - c[2]).abs())
            .fold(0.0, f32::max)
    };
    assert!(spread(&fog) < 0.6 * spread(&rain), "{} {}", spread(&fog), spread(&rain));
    let top = peak(&fog, 20.0, 38.0, |c| c[3]) + 10.0;
    assert!(top > 35.0 && top < 41.0, "{top}");
}
