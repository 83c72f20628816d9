//! Mist of splashes in an app: a fringe over what rain hits and none under roofs, spray in strong wind, nothing when off.

use bevy::prelude::*;
use rain_core::rainfall::{Distribution, Spectrum};
use rain_core::splash::{MistGround, MistLayers};
use rain_plugins::prelude::*;
use rain_plugins::surface::SurfaceState;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

use crate::haze::{SIZE, hazy, read, with_mask};

/// Half the angle of the narrow view upwards, by its tangent.
const HALF: f64 = 0.1;
/// The top of the box, and the eye over it. Units: m.
const TOP: f32 = 1.2;
const EYE: f32 = 1.25;

/// Rain of a rate (mm/h) and wind (m/s) on level ground, seen through a narrow view from `EYE` over the origin along −Z.
fn scene(rate: f64, wind: f32) -> (TestApp, Handle<Image>) {
    let mut test = hazy();
    world::ground(test.world());
    test.world().spawn(Weather {
        intensity_mm_h: rate,
        wind_m_s: Vec3::new(wind, 0.0, 0.0),
        ..default()
    });
    let mask = with_mask(&mut test);
    test.look(Vec3::new(0.0, EYE, 0.0), Vec3::new(0.0, EYE, -10.0));
    let camera = test.camera;
    test.world()
        .entity_mut(camera)
        .insert(Projection::Perspective(PerspectiveProjection {
            fov: 2.0 * HALF.atan() as f32,
            ..default()
        }));
    // All of the rain is haze, whatever the drops' quality has come to.
    test.world().get_mut::<RainView>(camera).expect("a view").streak_budget = Some(0);
    (test, mask)
}

/// A wall 25 m away: the sky's haze leaves nothing to compare.
fn with_wall(test: &mut TestApp) {
    world::block(
        test.world(),
        "wall",
        Vec3::new(-30.0, 0.0, -30.0),
        Vec3::new(30.0, 6.0, -25.0),
        [0.1; 3],
    );
}

/// A box to see over, 5 to 7 m before the eye.
fn with_box(test: &mut TestApp) {
    with_wall(test);
    world::block(
        test.world(),
        "box",
        Vec3::new(-2.0, 0.0, -7.0),
        Vec3::new(2.0, TOP, -5.0),
        world::STONE,
    );
}

/// Optical depth of the haze in each row of the middle column, with the mist and without.
fn depths(test: &mut TestApp, mask: &Handle<Image>, mist: Option<SplashMist>) -> Vec<f64> {
    let camera = test.camera;
    test.world()
        .get_mut::<HazeSettings>(camera)
        .expect("settings")
        .splash_mist = mist;
    test.frames(4, FRAME);
    let obscured = read(test, mask);
    (0..SIZE[1])
        .map(|y| -(1.0 - obscured[(y * SIZE[0] + SIZE[0] / 2) as usize]).ln())
        .collect()
}

/// What the mist adds in each row.
fn added(test: &mut TestApp, mask: &Handle<Image>) -> Vec<f64> {
    test.frames(20, FRAME);
    let with = depths(test, mask, Some(SplashMist::default()));
    let without = depths(test, mask, None);
    with.iter().zip(&without).map(|(a, b)| a - b).collect()
}

/// The layers by the model.
fn layers(test: &mut TestApp, rate: f64, wind_m_s: f64) -> MistLayers {
    let film_mm = f64::from(test.world().resource::<SurfaceState>().state.y);
    let ground = MistGround {
        film_mm,
        wind_m_s,
        ..default()
    };
    let rain = Spectrum::new(Distribution::MarshallPalmer, rate).expect("a rate");
    MistLayers::new(&rain, &ground, 2.0).expect("sound")
}

/// Slope of the line of sight through a row.
fn slope(row: usize) -> f64 {
    HALF * (1.0 - (2.0 * row as f64 + 1.0) / f64::from(SIZE[1]))
}

#[test]
fn heavy_rain_puts_a_halo_on_a_boxs_edge_and_none_in_the_dry_or_under_a_roof() {
    if !gpu::available() {
        return;
    }
    let (mut test, mask) = scene(50.0, 0.0);
    with_box(&mut test);
    let found = added(&mut test, &mask);
    let layer = layers(&mut test, 50.0, 0.0).thrown;
    let edge = slope_row((TOP - EYE) as f64 / 5.0);
    // Beside the edge's own pixel, up to where less than a thousandth is left.
    for (row, found) in found.iter().enumerate().take(edge - 1).skip(edge - 16) {
        let over = |z: f64| f64::from(EYE - TOP) + slope(row) * z;
        let expected = layer.depth(over(5.0), over(7.0), 2.0);
        // Texels of the map (59 mm) at both ends of the box, and the least sum that is looked for.
        let allowed = 0.08 * expected + 2e-3;
        assert!((found - expected).abs() < allowed, "{row}: {found} {expected}");
    }
    let brightest = found[edge - 2];
    assert!(brightest > 0.1, "{brightest}");
    assert!(found[2] < 1e-3, "high over it: {}", found[2]);
    // A light rain has next to none.
    let (mut light, mask) = scene(1.0, 0.0);
    with_box(&mut light);
    assert!(added(&mut light, &mask)[edge - 2] < 3e-3);
    // None under a roof.
    let (mut under, mask) = scene(50.0, 0.0);
    with_box(&mut under);
    world::block(
        under.world(),
        "roof",
        Vec3::new(-6.0, 3.0, -14.0),
        Vec3::new(6.0, 3.1, -1.0),
        world::STONE,
    );
    let covered = added(&mut under, &mask);
    assert!(covered.iter().all(|depth| *depth < 2e-3), "{covered:?}");
    // Nor in the dry: there is no haze at all.
    let (mut dry, mask) = scene(0.0, 0.0);
    with_box(&mut dry);
    dry.frames(4, FRAME);
    dry.reset();
    assert!(
        depths(&mut dry, &mask, Some(SplashMist::default()))
            .iter()
            .all(|d| *d < 1e-6)
    );
    assert_eq!(dry.recorded(PassName::Haze), 0);
}

/// The row that a slope is seen in.
fn slope_row(slope: f64) -> usize {
    (0.5 * f64::from(SIZE[1]) * (1.0 - slope / HALF)) as usize
}

#[test]
fn mist_stands_on_the_ground_and_strong_wind_carries_it_to_the_eye() {
    if !gpu::available() {
        return;
    }
    let at = |wind: f32| {
        let (mut test, mask) = scene(50.0, wind);
        with_wall(&mut test);
        let found = added(&mut test, &mask);
        (found, layers(&mut test, 50.0, wind.into()))
    };
    let mut before = 0.0;
    for wind in [0.0, 8.0, 15.0, 20.0] {
        let (found, mist) = at(wind);
        // At the height of the eye, level: what the wind has carried up.
        let level = slope_row(0.0);
        let expected = mist.carried.depth(EYE.into(), EYE.into(), 25.0);
        assert!(
            (found[level] - expected).abs() < 0.05 * expected + 2e-3,
            "{wind}: {} {expected}",
            found[level]
        );
        assert!(found[level] >= before - 2e-3, "{wind}");
        before = found[level];
        // On the ground before the wall: both. The wind blows along the wall, so its foot is open.
        let row = slope_row(-0.07);
        let way = f64::from(EYE) / -slope(row);
        let thrown = mist.thrown.depth(EYE.into(), 0.0, way);
        let both = thrown + mist.carried.depth(EYE.into(), 0.0, way);
        assert!(
            (found[row] - both).abs() < 0.06 * both + 2e-3,
            "{wind}: {} {both}",
            found[row]
        );
        assert!(thrown > 0.05, "{thrown}");
    }
    assert!(before > 0.1, "{before}");
}

#[test]
fn mist_that_is_off_or_refused_changes_nothing() {
    if !gpu::available() {
        return;
    }
    let (mut test, mask) = scene(50.0, 0.0);
    with_box(&mut test);
    let camera = test.camera;
    test.world().get_mut::<RainView>(camera).expect("a view").streak_budget = Some(1);
    test.frames(10, FRAME);
    let passes = |test: &mut TestApp, mist: Option<SplashMist>| {
        let seen = depths(test, &mask, mist);
        test.reset();
        test.frames(3, FRAME);
        (seen, test.recorded(PassName::Haze), test.recorded(PassName::Splash))
    };
    let (off, haze, splashes) = passes(&mut test, None);
    let (none, ..) = passes(&mut test, Some(SplashMist { gain: 0.0, ..default() }));
    // Two readings differ by the film that has gathered between them.
    assert!(off.iter().zip(&none).all(|(a, b)| (a - b).abs() < 1e-3));
    let (on, with_haze, with_splashes) = passes(&mut test, Some(SplashMist::default()));
    assert!(on.iter().zip(&off).any(|(a, b)| a - b > 0.05));
    assert_eq!((haze, splashes), (3, 3));
    assert_eq!((with_haze, with_splashes), (3, 3), "no pass of its own");
    // A bad value is named, and the last good ones stay.
    for bad in [
        SplashMist {
            gain: f32::NAN,
            ..default()
        },
        SplashMist {
            gain: -1.0,
            ..default()
        },
        SplashMist {
            roughness_m: 0.0,
            ..default()
        },
        SplashMist {
            fetch_m: f32::INFINITY,
            ..default()
        },
    ] {
        let settings = HazeSettings {
            splash_mist: Some(bad),
            ..default()
        };
        assert!(settings.validated().is_err(), "{bad:?}");
        let (kept, ..) = passes(&mut test, Some(bad));
        assert!(kept.iter().zip(&on).all(|(a, b)| (a - b).abs() < 0.02), "{bad:?}");
    }
    // Without a map what rain hits is not known.
    let (mut unknown, mask) = scene(50.0, 0.0);
    unknown.world().resource_mut::<CoverSettings>().enabled = false;
    with_box(&mut unknown);
    let found = added(&mut unknown, &mask);
    assert!(found.iter().all(|depth| depth.abs() < 2e-3), "{found:?}");
}
