//! Haze through rain areas: the integral along a line of sight, what is drawn of it as far rain, and the cloud's base.

use glam::{DVec2, DVec3, Quat, Vec3};
use rain_core::haze::{RateExtinction, extinction_per_m};
use rain_core::rainfall::areas::{AreaField, AreaFieldF32, AreaRain, AreaSettings, AreaShape};
use rain_core::rainfall::{Distribution, FarAccount, FarEye};
use rain_render::haze::{HazeAreas, HazeFar};

use super::{HALF_STEP, LIMIT_M, Shot, spectrum};
use crate::device::device;
use crate::rain_areas::painting;

/// Three areas: a soft far shower, a small sharp polygon in it, a factor nearer by.
fn field() -> AreaField {
    let mut field = AreaField::new(0.2);
    for (centre, shape, rain, transition_m) in [
        (
            DVec2::new(300.0, -2500.0),
            AreaShape::Ellipse {
                radii_m: DVec2::new(900.0, 500.0),
                heading_rad: 0.4,
            },
            AreaRain::Rate(60.0),
            250.0,
        ),
        (
            DVec2::new(-100.0, -700.0),
            AreaShape::Polygon {
                corners_m: vec![
                    DVec2::new(-150.0, -80.0),
                    DVec2::new(150.0, -60.0),
                    DVec2::new(120.0, 90.0),
                    DVec2::new(-140.0, 60.0),
                ],
            },
            AreaRain::OfWeather(6.0),
            30.0,
        ),
        (
            DVec2::new(40.0, -30.0),
            AreaShape::Circle { radius_m: 60.0 },
            AreaRain::Scale(0.1),
            10.0,
        ),
    ] {
        let settings = AreaSettings {
            centre_m: centre,
            shape,
            rain,
            transition_m,
            // The polygon is painted.
            density: (transition_m == 30.0).then(|| painting(DVec2::new(330.0, 190.0))),
            ..AreaSettings::default()
        };
        settings.check().expect("an area");
        field.push(&settings, DVec2::ZERO, 0.0);
    }
    field
}

#[test]
fn haze_through_areas_is_the_integral_along_the_line_of_sight() {
    let Some(gpu) = device() else { return };
    let field = field();
    let weather = 5.0;
    let mut packed = AreaFieldF32::default();
    assert!(field.pack(DVec2::ZERO, LIMIT_M.into(), &mut packed));
    let most = extinction_per_m(&spectrum(60.0), 2.0);
    let mut seen = [0, 0];
    for (wall, turn) in [
        (None, 0.0),
        (Some(3500.0), 0.1),
        (Some(900.0), -0.2),
        (Some(40.0), 0.4),
        (None, 2.0),
    ] {
        let shot = Shot {
            rotation: Quat::from_rotation_y(turn) * Quat::from_rotation_x(0.25),
            rate: field.rate_at(DVec2::ZERO, weather),
            wall_m: wall,
            areas: Some(HazeAreas {
                packed: &packed,
                weather_mm_h: weather as f32,
            }),
            ..Shot::default()
        };
        let (mut sums, mut pixels) = ([0.0; 2], 0.0);
        let mut number = 0;
        shot.each(&gpu, |towards, rgb| {
            // Exact spectra along a line take their time: pixels here and there.
            number += 1;
            if number % 7 != 0 {
                return;
            }
            let way = shot.way(towards);
            let expected = field.along(DVec3::ZERO, towards * way, weather, |rate| {
                extinction_per_m(&spectrum(rate), 2.0)
            });
            if expected > 2.0 {
                return;
            }
            let found = -rgb[0].ln();
            sums[0] += found;
            sums[1] += expected;
            pixels += 1.0;
            // An interval of the grid is 6.9 % of its distance and 4 m long. The end of the way lies anywhere in one, and a
            // straight line over a bend misses a quarter of it at most; the middle of a piece of an edge misses half of
            // a 16th at each of two edges; two azimuths are a 500th apart. In all 2.7 % of 4 m and the distance to
            // the last rain, 3.3 km.
            let reach = (way * towards.length()).min(3300.0) + 4.0;
            let allowed = 0.027 * most * reach + 0.002 * expected + HALF_STEP / rgb[0];
            assert!(
                (found - expected).abs() < allowed,
                "{towards} {way}: {found} {expected}"
            );
            seen[usize::from(expected > 0.3)] += 1;
        });
        let allowed = 0.01 * sums[1] + HALF_STEP * pixels;
        assert!((sums[0] - sums[1]).abs() < allowed, "{wall:?}: {sums:?}");
    }
    assert!(seen.iter().all(|n| *n > 100), "{seen:?}");
}

#[test]
fn haze_leaves_out_what_is_drawn_as_far_rain() {
    let Some(gpu) = device() else { return };
    let field = field();
    let weather = 5.0;
    let mut packed = AreaFieldF32::default();
    assert!(field.pack(DVec2::ZERO, LIMIT_M.into(), &mut packed));
    let rates = RateExtinction::new(Distribution::MarshallPalmer, 2.0);
    let eye = FarEye {
        eye_m: DVec3::ZERO,
        areas: &field,
        weather_mm_h: weather,
        rates: &rates,
    };
    let mut account = FarAccount::default();
    let mut seen = 0;
    for (wall, turn) in [(None, 0.0), (Some(3500.0), 0.1), (Some(900.0), -0.2), (Some(40.0), 0.4)] {
        let rotation = Quat::from_rotation_y(turn) * Quat::from_rotation_x(0.25);
        let ahead = (rotation * Vec3::NEG_Z).as_dvec3();
        account.look(&eye, DVec2::new(ahead.x, ahead.z), 0.8, 257, LIMIT_M.into());
        let far = HazeFar {
            share: 0.6,
            outside_per_m: account.outside_per_m() as f32,
        };
        let shot = |far: Option<HazeFar>| Shot {
            rotation,
            rate: field.rate_at(DVec2::ZERO, weather),
            wall_m: wall,
            areas: Some(HazeAreas {
                packed: &packed,
                weather_mm_h: weather as f32,
            }),
            far,
            thin_m: 400.0,
            ..Shot::default()
        };
        let mut whole = Vec::new();
        shot(None).each(&gpu, |_, rgb| whole.push(rgb[0]));
        let (mut sums, mut number) = ([0.0; 2], 0);
        let left = shot(Some(far));
        left.each(&gpu, |towards, rgb| {
            let before = whole[number];
            number += 1;
            if number % 5 != 0 || before < 0.05 {
                return;
            }
            let found = (rgb[0] / before).ln();
            let expected = 0.6
                * account.far_depth(
                    &eye,
                    towards,
                    left.way(towards),
                    left.cloud_m.into(),
                    left.thin_m.into(),
                );
            assert!(found > -2.0 * HALF_STEP / before, "haze only ever loses: {found}");
            sums[0] += found;
            sums[1] += expected;
            seen += usize::from(expected > 0.05);
        });
        // Both are grids along azimuths, of different knots.
        let allowed = 0.03 * sums[1] + 4.0 * HALF_STEP * (number / 5) as f64;
        assert!((sums[0] - sums[1]).abs() < allowed, "{wall:?}: {sums:?}");
        assert_eq!(
            wall == Some(40.0),
            sums[1] < 1.0,
            "nothing is far rain near the eye: {sums:?}"
        );
    }
    assert!(seen > 300, "{seen}");
}

#[test]
fn rain_thins_out_below_its_cloud() {
    let Some(gpu) = device() else { return };
    let field = field();
    let mut packed = AreaFieldF32::default();
    assert!(field.pack(DVec2::ZERO, LIMIT_M.into(), &mut packed));
    let areas = HazeAreas {
        packed: &packed,
        weather_mm_h: 5.0,
    };
    let even = extinction_per_m(&spectrum(2.0), 2.0);
    for uneven in [false, true] {
        let shot = Shot {
            rotation: Quat::from_rotation_x(0.3),
            rate: if uneven { field.rate_at(DVec2::ZERO, 5.0) } else { 2.0 },
            wall_m: None,
            cloud_m: 700.0,
            thin_m: 300.0,
            areas: uneven.then_some(areas),
            ..Shot::default()
        };
        let (mut sums, mut number, mut thinned) = ([0.0; 2], 0, 0);
        shot.each(&gpu, |towards, rgb| {
            number += 1;
            let way = shot.way(towards);
            if number % 11 != 0 || towards.y < 0.01 {
                return;
            }
            const PIECES: u32 = 40;
            let step = way / f64::from(PIECES);
            let expected: f64 = (0..PIECES)
                .map(|i| {
                    let (low, high) = (step * f64::from(i), step * f64::from(i + 1));
                    let share = rain_core::rainfall::cloud_share(towards.y * 0.5 * (low + high), 700.0, 300.0);
                    let depth = if uneven {
                        field.along(towards * low, towards * high, 5.0, |rate| {
                            extinction_per_m(&spectrum(rate), 2.0)
                        })
                    } else {
                        even * step
                    };
                    depth * share
                })
                .sum();
            if expected < 2.0 {
                let found = -rgb[0].ln();
                sums[0] += found;
                sums[1] += expected;
                thinned += usize::from(way < f64::from(LIMIT_M));
                if !uneven {
                    assert!(
                        (found - expected).abs() < 0.002 * expected + HALF_STEP / rgb[0],
                        "{found} {expected}"
                    );
                }
            }
        });
        let allowed = 0.01 * sums[1] + HALF_STEP * f64::from(number / 11);
        assert!(
            thinned > 100 && (sums[0] - sums[1]).abs() < allowed,
            "{uneven}: {sums:?} {thinned}"
        );
    }
}
