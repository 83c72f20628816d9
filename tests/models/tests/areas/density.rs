//! Painted densities: the rate is the painted share's, bounds hold it, both precisions agree, bad paintings are refused.

use glam::DVec2;
use rain_core::rainfall::areas::{AreaField, AreaFieldF32, AreaRain, AreaSettings, AreaShape, DensityMap};

use super::places;

/// 24 × 17 cells over 300 × 200 m: a ramp with bright and dark spots.
fn painting() -> DensityMap {
    let values = (0..24 * 17).map(|i: u32| ((i * 97 + i * i * 31) % 256) as u8);
    DensityMap::new(DVec2::new(300.0, 200.0), [24, 17], values.collect()).expect("a painting")
}

fn painted(shape: AreaShape, rain: AreaRain, transition_m: f64) -> AreaSettings {
    AreaSettings {
        centre_m: DVec2::new(12.0, -7.0),
        shape,
        rain,
        transition_m,
        density: Some(painting()),
        ..AreaSettings::default()
    }
}

fn field(areas: &[AreaSettings], outside: f64) -> AreaField {
    let mut field = AreaField::new(outside);
    for area in areas {
        area.check().expect("valid");
        field.push(area, DVec2::ZERO, 0.0);
    }
    field
}

/// The painted share by the formula: weights of all cells whose middles are within one cell.
fn slow(map: &DensityMap, local: DVec2) -> f64 {
    let [nx, nz] = map.cells();
    let cell = map.size_m() / DVec2::new(nx as f64, nz as f64);
    let middle = |i: usize, k: usize| (DVec2::new(i as f64, k as f64) + 0.5) * cell - 0.5 * map.size_m();
    let held = local.clamp(middle(0, 0), middle(nx - 1, nz - 1));
    let mut sum = 0.0;
    for k in 0..nz {
        for i in 0..nx {
            let off = ((held - middle(i, k)) / cell).abs();
            let weight = (1.0 - off.x).max(0.0) * (1.0 - off.y).max(0.0);
            sum += weight * f64::from(map.values()[k * nx + i]) / 255.0;
        }
    }
    sum
}

#[test]
fn a_painted_density_multiplies_the_rain_of_its_area_in_both_precisions() {
    let map = painting();
    let shapes = [
        AreaShape::Unbounded,
        AreaShape::Circle { radius_m: 120.0 },
        super::ellipse(150.0, 60.0, 0.5),
        super::star(140.0),
    ];
    let mut wet = 0;
    for shape in shapes {
        for (rain, weather) in [
            (AreaRain::Rate(40.0), 0.0),
            (AreaRain::OfWeather(2.0), 15.0),
            (AreaRain::Scale(0.2), 30.0),
        ] {
            let area = painted(shape.clone(), rain, 30.0);
            let even = AreaSettings {
                density: None,
                ..area.clone()
            };
            let outside = if matches!(rain, AreaRain::Scale(_)) { 1.0 } else { 0.0 };
            let (with, without) = (field(&[area], outside), field(&[even], outside));
            let mut packed = AreaFieldF32::default();
            assert!(with.pack(DVec2::new(5.0, 5.0), 1e4, &mut packed));
            for p in places(800) {
                let share = slow(&map, p - DVec2::new(12.0, -7.0));
                assert!((map.at(p - DVec2::new(12.0, -7.0)) - share).abs() < 1e-13);
                let plain = without.rate_at(p, weather);
                let expected = if let AreaRain::Scale(_) = rain {
                    weather - (weather - plain) * share
                } else {
                    plain * share
                };
                let found = with.rate_at(p, weather);
                assert!((found - expected).abs() < 1e-10, "{rain:?} {p}: {found} {expected}");
                let single = packed.rate_at([p.x as f32 - 5.0, p.y as f32 - 5.0], weather as f32);
                assert!(
                    (f64::from(single) - found).abs() < 2e-2,
                    "{rain:?} {p}: {single} {found}"
                );
                wet += usize::from(found > 1.0);
                for radius in [0.0, 3.0, 40.0, 400.0, f64::INFINITY] {
                    let [least, most] = with.rates_within(p, radius, weather);
                    for q in places(40) {
                        let near = p + if radius.is_finite() { q / 290.0 * radius } else { q };
                        let own = with.rate_at(near, weather);
                        assert!(
                            own >= least - 1e-9 && own <= most + 1e-9,
                            "{radius}: {own} not in {least}..{most}"
                        );
                    }
                }
                let step = 1e-4;
                let slope = DVec2::new(
                    with.rate_at(p + DVec2::X * step, weather) - with.rate_at(p - DVec2::X * step, weather),
                    with.rate_at(p + DVec2::Y * step, weather) - with.rate_at(p - DVec2::Y * step, weather),
                ) / (2.0 * step);
                // Where two cells meet both sides are right.
                let near_edge = {
                    let at = ((p - DVec2::new(12.0, -7.0)) / map.size_m() + 0.5) * DVec2::new(24.0, 17.0) - 0.5;
                    (at - at.round()).abs().min_element() < 1e-3
                };
                if !near_edge {
                    let own = with.gradient_at(p, weather);
                    assert!(own.distance(slope) < 1e-4 * (1.0 + own.length()), "{p}: {own} {slope}");
                }
            }
        }
    }
    assert!(wet > 1000, "{wet}");
}

#[test]
fn a_painting_of_ones_changes_nothing_and_goes_along_with_its_area() {
    let whole = DensityMap::new(DVec2::splat(50.0), [2, 2], vec![255; 4]).expect("a painting");
    assert_eq!(whole.extremes(), [1.0; 2]);
    let area = AreaSettings {
        shape: AreaShape::Circle { radius_m: 90.0 },
        rain: AreaRain::Rate(30.0),
        ..AreaSettings::default()
    };
    let same = AreaSettings {
        density: Some(whole),
        ..area.clone()
    };
    assert_eq!(area.effective_area_m2(), field_area(&area));
    let (a, b) = (field(&[area], 0.0), field(&[same], 0.0));
    for p in places(500) {
        assert_eq!(a.rate_at(p, 0.0), b.rate_at(p, 0.0));
    }
    let map = painting();
    let moved = AreaSettings {
        centre_m: DVec2::new(500.0, 0.0),
        ..painted(AreaShape::Unbounded, AreaRain::Rate(20.0), 0.0)
    };
    let moved = field(&[moved], 0.0);
    for p in places(200) {
        let expected = 20.0 * map.at(p);
        assert!((moved.rate_at(p + DVec2::new(500.0, 0.0), 0.0) - expected).abs() < 1e-9);
    }
}

fn field_area(area: &AreaSettings) -> f64 {
    let r = 90.0_f64;
    core::f64::consts::PI * (r * r + area.transition_m * area.transition_m / 20.0)
}

#[test]
fn paintings_are_written_read_and_refused_by_name() {
    let map = painting();
    let text = ron::to_string(&map).expect("written");
    assert_eq!(ron::from_str::<DensityMap>(&text).expect("read"), map);
    assert_ne!(
        format!("{map:?}"),
        format!(
            "{:?}",
            DensityMap::new(map.size_m(), [24, 17], vec![7; 408]).expect("one")
        )
    );
    let refused = |size: DVec2, cells: [usize; 2], count: usize| {
        DensityMap::new(size, cells, vec![0; count]).map_err(|error| error.to_string())
    };
    let good = DVec2::splat(10.0);
    for (result, name) in [
        (refused(DVec2::new(10.0, f64::NAN), [4, 4], 16), "size_m of a density"),
        (refused(DVec2::new(0.0, 10.0), [4, 4], 16), "size_m of a density"),
        (refused(good, [1, 4], 4), "cells of a density"),
        (refused(good, [4, 129], 516), "cells of a density"),
        (refused(good, [4, 4], 15), "values of a density"),
    ] {
        let error = result.expect_err("refused");
        assert!(error.contains(name), "{error}");
    }
    assert!(ron::from_str::<DensityMap>("(size_m:(1.0,1.0),cells:(2,2),values:[1,2,3])").is_err());
    // Places that are no numbers have an answer.
    assert!((0.0..=1.0).contains(&map.at(DVec2::NAN)));
}
