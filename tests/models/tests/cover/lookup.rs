//! The look-up at single points: exact where it can be, and at the edges of its domain.

use glam::{DVec2, DVec3};
use rain_core::cover::{ClassShare, CoverError, CoverScene, CoverSettings, OccluderId};
use rain_reference::cover as reference;

use super::{MEAN, block, random, scene, slope};
use crate::check::Worst;

/// A table roof 4 m high over x in [−3, 5], z in [−2, 6], 0.25 m thick.
fn roof() -> Vec<reference::Triangle> {
    block([-3.0, 4.0, -2.0], [5.0, 4.25, 6.0])
}

#[test]
fn away_from_edges_a_roof_stops_exactly_the_drops_that_fall_on_it() {
    for wind in [[0.0, 0.0], [3.0, -1.0], [-8.0, 4.0]] {
        let map = scene(&roof(), 0.25, wind);
        let (mut covered, mut open, mut mirrored) = (0, 0, 0);
        for i in 0..6000 {
            let [x, y, z] = random(i, 4, 4);
            let point = [16.0 * x - 8.0, 3.9 * y, 16.0 * z - 6.0];
            for speed in [2.29, 4.12, 1.0 / MEAN, 9.12] {
                // Where the drop was at the roof's height: half a metre from the rim nothing is in doubt.
                let rims = [4.0, 4.25].map(|level| {
                    let at = reference::met_level(point, level, wind, speed);
                    (at[0] + 3.0).min(5.0 - at[0]).min(at[1] + 2.0).min(6.0 - at[1])
                });
                if rims.iter().any(|rim| rim.abs() < 0.5) {
                    continue;
                }
                let exact = reference::stopped_at(&roof(), point, wind, speed).is_some();
                let found = map.covered(DVec3::from(point), 1.0 / speed).expect("inside the domain");
                assert_eq!(found, exact, "{point:?} at {speed} m/s in {wind:?}");
                covered += u32::from(exact);
                open += u32::from(!exact);
                let other = reference::stopped_at(&roof(), point, wind.map(|w| -w), speed).is_some();
                mirrored += u32::from(other != exact);
            }
        }
        assert!(covered > 1000 && open > 1000, "{covered} {open}");
        assert!(
            wind == [0.0; 2] || mirrored > 500,
            "wind from the other side is told apart: {mirrored}"
        );
    }
}

#[test]
fn what_lies_on_a_face_is_not_covered_by_it() {
    let map = scene(&roof(), 0.25, [0.0; 2]);
    let covered = |y: f64| map.covered(DVec3::new(1.1, y, 1.3), MEAN).expect("finite");
    for (y, expected) in [
        (4.25, false),
        (4.2499, true),
        (4.2501, false),
        (4.0, true),
        (-3.0, true),
        (9.0, false),
    ] {
        assert_eq!(covered(y), expected, "{y}");
        let exact = reference::stopped_at(&roof(), [1.1, y, 1.3], [0.0; 2], 1.0 / MEAN).is_some();
        assert_eq!(expected, exact, "{y}");
    }
    // Walls alone, in calm air, cover nothing.
    let wall = [[[0.0, 0.0, -9.0], [0.0, 9.0, 0.0], [0.0, 0.0, 9.0]]];
    let map = scene(&wall, 0.25, [0.0; 2]);
    assert!(map.tiles().is_empty());
    assert_eq!(map.covered(DVec3::new(0.0, 1.0, 0.0), MEAN), Ok(false));
}

#[test]
fn nothing_covers_in_an_empty_scene() {
    for wind in [[0.0; 2], [20.0, -9.0]] {
        let map = CoverScene::new(CoverSettings::default(), slope(wind)).expect("valid");
        for i in 0..200 {
            let [x, y, z] = random(i, 8, 8);
            let point = DVec3::new(1e6 * (x - 0.5), 100.0 * y, 1e6 * (z - 0.5));
            assert_eq!(map.covered(point, 0.3), Ok(false));
            assert_eq!(map.exposure(point, 0.3), Ok(1.0));
            assert_eq!(map.occluder_height(point), Ok(None));
        }
    }
}

#[test]
fn places_far_away_are_answered_and_those_beyond_refused() {
    let wind = [5.0, 2.0];
    for far in [0.0, 1e5, 9.99e6, -9.99e6] {
        let moved: Vec<_> = roof()
            .iter()
            .map(|t| t.map(|[x, y, z]| [x + far, y, z - far]))
            .collect();
        let map = scene(&moved, 0.25, wind);
        for (x, expected) in [(1.0, true), (5.0, true), (-7.0, false), (12.0, false)] {
            let point = DVec3::new(x + far, 1.0, 2.0 - far);
            let found = map.covered(point, 1.0 / 4.12).expect("inside the domain");
            let exact = reference::stopped_at(&moved, point.to_array(), wind, 4.12).is_some();
            assert_eq!((found, exact), (expected, expected), "{point}");
        }
    }
    let map = scene(&roof(), 0.25, wind);
    for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1.1e7, -1e300] {
        for point in [
            DVec3::new(bad, 0.0, 0.0),
            DVec3::new(0.0, bad, 0.0),
            DVec3::new(0.0, 0.0, bad),
        ] {
            assert!(matches!(map.covered(point, 0.2), Err(CoverError::Config(_))), "{point}");
            assert!(
                map.exposure(point, 0.2).is_err() && map.occluder_height(point).is_err(),
                "{point}"
            );
        }
        assert!(map.covered(DVec3::ZERO, bad).is_err());
        let mut broken = CoverScene::new(CoverSettings::default(), slope(wind)).expect("valid");
        let triangle = [DVec3::ZERO, DVec3::X, DVec3::new(0.0, bad, 1.0)];
        match broken.add(OccluderId(1), &[triangle]) {
            Ok(()) => assert_eq!(broken.skipped().non_finite, 1, "{bad}"),
            Err(error) => assert!(bad.is_finite(), "{bad}: {error}"),
        }
    }
}

#[test]
fn exposure_is_the_share_of_ways_that_are_open() {
    // Over four cells, the mean of the drops that arrive, by casts; classes by their share.
    let (mut one, mut all, mut worst_case) = (0.0, 0.0, Worst::default());
    let classes = [(0.3, 1.0), (0.2, 2.0), (0.13, 5.0)];
    let mut asked = 0.0;
    for wind in [[0.0, 0.0], [4.0, 1.0], [-9.0, 6.0]] {
        let map = scene(&roof(), 0.25, wind);
        for i in 0..1500 {
            let [x, _, z] = random(i, 6, 6);
            let point = [20.0 * x - 10.0, 0.5, 20.0 * z - 8.0];
            let cast = |inverse: f64| {
                // The cells' ways are a cell apart, 1.6 cells above the surface.
                let drift = map.drawn_drift();
                let shift = DVec2::from(wind) * inverse - drift;
                let q = DVec2::new(point[0], point[2]) + point[1] * drift - 0.4 * shift;
                let level = point[1] + 0.4;
                let base = (q / 0.25 - 0.5).floor();
                let mut open = 0.0;
                for corner in [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE] {
                    let weight = 1.0 - (q / 0.25 - 0.5 - base - corner).abs();
                    let at = (base + corner + 0.5) * 0.25 - level * drift;
                    let free = reference::stopped_at(&roof(), [at.x, level, at.y], wind, 1.0 / inverse).is_none();
                    open += weight.x * weight.y * f64::from(u8::from(free));
                }
                open
            };
            let at = DVec3::from(point);
            let mut whole = 0.0;
            for (inverse, share) in classes {
                let found = f64::from(map.exposure(at, inverse).expect("finite"));
                let exact = cast(inverse);
                whole += share / 8.0 * exact;
                one += (found - exact).abs();
                worst_case.absolute(found, exact, || format!("{at} {inverse}"));
            }
            let shares = classes.map(|(inverse_speed_s_per_m, share)| ClassShare {
                inverse_speed_s_per_m,
                share,
            });
            let found = f64::from(map.flux_exposure(at, &shares).expect("finite"));
            all += (found - whole).abs();
            asked += 1.0;
        }
    }
    // Wrong only along the rims.
    assert!(one / (3.0 * asked) < 0.01, "{}", one / (3.0 * asked));
    assert!(all / asked < 0.01, "{}", all / asked);
    assert!(worst_case.error <= 1.0 && worst_case.count == 13_500);
}
