//! Masks worked out from geometry: against their formulas, on a terrain whose hollows are known.

use glam::DVec3;
use rain_core::surface::ground::{Ground, GroundScene, GroundSettings, PoolRoom};
use rain_core::surface::{PaintPlace, normalised_painted_depth, painted_channels, painted_depth};
use rain_core::weather::SurfaceClass;

use super::ANY;
use crate::check::Worst;

const ROOM: PoolRoom = PoolRoom {
    bottom_m: -0.06,
    spill_m: 0.02,
};

fn place(height_m: f64, up: f64, open: f64) -> PaintPlace {
    PaintPlace {
        height_m,
        up,
        open,
        pool: Some(ROOM),
    }
}

#[test]
fn channels_are_their_formulas() {
    let (mut depth, mut worst) = (Worst::default(), Worst::default());
    for i in 0..=40 {
        let share = f64::from(i) / 40.0;
        let height = ROOM.bottom_m + share * 0.08;
        depth.absolute(painted_depth(height, &ROOM), share, || format!("{height}"));
        let [r, g, b, a] = painted_channels(&place(height, 1.0, 0.7), 0.4);
        for (found, exact) in [
            (r, 0.7),
            (g, share),
            (b, 0.7),
            (a, 1.0 - ((1.0 - share) / 0.4).min(1.0)),
        ] {
            worst.absolute(found, exact, || format!("{height}"));
        }
    }
    depth.assert_below(4e-16, 40);
    worst.assert_below(5e-16, 160);
    // In the open beside hollows: white. Under cover: neither ripples nor wetting, but what is flooded stays.
    let open = PaintPlace {
        pool: None,
        ..place(0.0, 1.0, 1.0)
    };
    assert_eq!(painted_channels(&open, 0.4), [1.0; 4]);
    assert_eq!(painted_channels(&place(-0.06, 1.0, 0.0), 0.4), [0.0, 0.0, 0.0, 0.0]);
    // What is upright does not ring and holds no water, but slanted rain wets it.
    assert_eq!(painted_channels(&place(-0.06, 0.0, 1.0), 0.4), [0.0, 1.0, 1.0, 1.0]);
    let kerb = painted_channels(&place(-0.06, 0.9, 1.0), 0.4);
    assert!(
        kerb[0] > 0.4 && kerb[0] < 0.6 && (kerb[1] - 0.5).abs() < 0.1,
        "{kerb:?}"
    );
}

#[test]
fn every_puddle_floods_first_at_its_lowest() {
    // Painted down to 0.2 and 0.6: both come at once.
    for lowest in [0.0, 0.2, 0.6, 0.99] {
        assert_eq!(normalised_painted_depth(lowest, lowest), 0.0);
        assert_eq!(normalised_painted_depth(1.0, lowest), 1.0);
        let middle = normalised_painted_depth(0.5 * (1.0 + lowest), lowest);
        assert!((middle - 0.5).abs() < 1e-13, "{lowest}: {middle}");
    }
    assert_eq!(normalised_painted_depth(1.0, 1.0), 1.0, "no puddle at all");
    for bad in ANY {
        for other in ANY {
            let depth = normalised_painted_depth(bad, other);
            assert!((0.0..=1.0).contains(&depth), "{bad} {other}: {depth}");
        }
        let room = PoolRoom {
            bottom_m: bad,
            spill_m: 1.0,
        };
        assert!((0.0..=1.0).contains(&painted_depth(0.5, &room)), "{bad}");
        assert!((0.0..=1.0).contains(&painted_depth(bad, &ROOM)), "{bad}");
        let found = painted_channels(&place(bad, bad, bad), bad);
        assert!(found.iter().all(|c| (0.0..=1.0).contains(c)), "{bad}: {found:?}");
    }
    let flat = PoolRoom {
        bottom_m: 0.0,
        spill_m: 0.0,
    };
    assert_eq!(painted_depth(0.0, &flat), 1.0, "a hollow without depth is none");
}

/// Height of a plane that falls by 1 % along x with bowls of 5 and 15 cm at x = 4 and x = 12, z = 4.
fn height(x: f64, z: f64) -> f64 {
    let bowl = |at: f64, deep: f64| {
        let r2 = ((x - at) * (x - at) + (z - 4.0) * (z - 4.0)) / 4.0;
        deep * (1.0 - r2).max(0.0)
    };
    0.01 * (16.0 - x) - bowl(4.0, 0.05) - bowl(12.0, 0.15)
}

#[test]
fn a_shallow_and_a_deep_bowl_have_the_same_lowest_value_and_slopes_have_none() {
    let mut triangles = Vec::new();
    for i in 0..64 {
        for j in 0..32 {
            let p = |i: i32, j: i32| {
                let (x, z) = (f64::from(i) * 0.25, f64::from(j) * 0.25);
                DVec3::new(x, height(x, z), z)
            };
            let [a, b, c, d] = [p(i, j), p(i + 1, j), p(i + 1, j + 1), p(i, j + 1)];
            triangles.extend([[a, d, c], [a, c, b]]);
        }
    }
    let mut scene = GroundScene::default();
    scene.set(1, &triangles, SurfaceClass::Asphalt, true);
    let ground = Ground::build(&scene, &GroundSettings::default()).expect("a ground");
    let green = |x: f64, z: f64| {
        let place = DVec3::new(x, height(x, z), z);
        painted_channels(
            &PaintPlace {
                height_m: place.y,
                up: 1.0,
                open: 1.0,
                pool: ground.pool_room_at(place),
            },
            0.4,
        )[1]
    };
    let (shallow, deep) = (green(4.05, 4.05), green(12.05, 4.05));
    assert!(shallow < 0.05 && deep < 0.05, "{shallow} {deep}");
    // From the middle outwards no step down, and dry from the rim on.
    for at in [4.0, 12.0] {
        let way: Vec<f64> = (0..30).map(|i| green(at, 4.0 + f64::from(i) * 0.1)).collect();
        assert!(way.windows(2).all(|w| w[1] >= w[0] - 1e-12), "{way:?}");
        assert_eq!(way[25], 1.0);
    }
    assert_eq!((green(8.0, 4.0), green(1.0, 1.0), green(-5.0, 0.0)), (1.0, 1.0, 1.0));
    let above = DVec3::new(12.0, 2.0, 4.0);
    assert_eq!(
        ground.pool_room_at(above),
        None,
        "a table over the bowl is in no hollow"
    );
    for bad in [DVec3::NAN, DVec3::INFINITY] {
        assert_eq!(ground.pool_room_at(bad), None);
    }
}
