//! Where rain comes to in the street, by casts against all its triangles, and what the cover map says.

use glam::{DVec2, DVec3};
use rain_core::cover::{CoverScene, CoverSettings, FallSlope, OccluderId};
use rain_core::hash::{pcg3d, unit_f32};
use rain_core::rainfall::CLASS_SPEEDS_M_S;
use rain_reference::cover::{Triangle, stopped_at};
use street::layout::{ARCADE_COLUMN, FACADE_X};

use crate::scene::street_scene;

/// Flux mean of 1/u at 40 mm/h. Units: s/m.
const MEAN: f64 = 0.1602;

/// The breeze in the storm's scenario while the camera stands in the arcade. Units: m/s, x and z.
const BREEZE: [f64; 2] = [0.8, 1.6];

pub fn triangles() -> Vec<Triangle> {
    let corners = |t: &crate::scene::Triangle| t.corners.map(|c| c.as_dvec3().to_array());
    street_scene().triangles.iter().map(corners).collect()
}

/// Of `triangles` those that the ways of all drops through `p` can meet: all of them run in one upright plane.
pub fn in_the_winds_plane(triangles: &[Triangle], p: [f64; 3], wind: [f64; 2]) -> Vec<Triangle> {
    let across = DVec2::from(wind).normalize().perp();
    let aside = |c: [f64; 3]| across.dot(DVec2::new(c[0] - p[0], c[2] - p[2]));
    triangles
        .iter()
        .filter(|t| t.iter().any(|c| aside(*c) >= -1e-6) && t.iter().any(|c| aside(*c) <= 1e-6))
        .copied()
        .collect()
}

pub fn map(triangles: &[Triangle], cell_m: f64, wind: [f64; 2]) -> CoverScene {
    let slope = FallSlope::new(DVec2::from(wind), MEAN).expect("inside the domain");
    let settings = CoverSettings {
        cell_m,
        ..Default::default()
    };
    let mut scene = CoverScene::new(settings, slope).expect("valid");
    let triangles: Vec<_> = triangles.iter().map(|t| t.map(DVec3::from)).collect();
    scene.add(OccluderId(1), &triangles).expect("a street");
    scene.update();
    scene
}

/// Even points of a block.
pub fn points(low: [f64; 3], high: [f64; 3], count: u32) -> impl Iterator<Item = [f64; 3]> {
    (0..count).map(move |i| {
        let share = pcg3d([i, 40, 2]).map(|h| f64::from(unit_f32(h)));
        [0, 1, 2].map(|k| low[k] + share[k] * (high[k] - low[k]))
    })
}

#[test]
fn wind_blows_no_drop_above_a_millimetre_past_the_arcades_pillar_and_the_map_lets_none_in() {
    // Behind the second pillar of the arcade, z 1.2 to 1.8 m, from its plinth to its capital.
    let inside = f64::from(FACADE_X + ARCADE_COLUMN);
    let all = triangles();
    let map = map(&all, 0.0625, BREEZE);
    let classes = CLASS_SPEEDS_M_S.len();
    let (mut open, mut let_in) = (vec![0; classes], vec![0; classes]);
    for p in points([inside, 0.5, 1.2], [inside + 0.3, 2.3, 1.8], 300) {
        let near = in_the_winds_plane(&all, p, BREEZE);
        for (k, u) in CLASS_SPEEDS_M_S.iter().enumerate() {
            open[k] += u32::from(stopped_at(&near, p, BREEZE, *u).is_none());
            let_in[k] += u32::from(!map.covered(DVec3::from(p), 1.0 / u).expect("finite"));
        }
    }
    let report = format!("open {open:?}, let in {let_in:?}");
    // What falls slower than 3.5 m/s (0.93 mm) is blown in here and there; nothing else is.
    assert!(
        open[0] > 15 && open[0] > open[1] && open[3..].iter().all(|n| *n == 0),
        "{report}"
    );
    assert!(let_in[3..].iter().all(|n| *n == 0), "{report}");
    assert!(let_in[2] <= 30, "{report}");
}

#[test]
fn shares_misclassified_in_the_street_stay_within_their_bound() {
    let all = triangles();
    let mut report = String::new();
    let mut shares = Vec::new();
    for (place, low, high) in [
        ("arcade", [6.6, 0.2, -1.5], [9.5, 3.2, 11.5]),
        ("street", [-6.4, 0.2, -22.0], [6.4, 3.0, 25.0]),
    ] {
        for cell_m in [0.0625, 0.25] {
            let (mut wrong, mut bent, mut asked) = (0, 0, 0);
            let map = map(&all, cell_m, BREEZE);
            for p in points(low, high, 300) {
                let near = in_the_winds_plane(&all, p, BREEZE);
                let at = DVec3::from(p);
                let mean = map
                    .occluder_height(at)
                    .expect("finite")
                    .is_some_and(|height| height > p[1]);
                for u in CLASS_SPEEDS_M_S {
                    let stopped = stopped_at(&near, p, BREEZE, u).is_some();
                    wrong += u32::from(map.covered(at, 1.0 / u).expect("finite") != stopped);
                    bent += u32::from(mean != stopped);
                    asked += 1;
                }
            }
            let [wrong, bent] = [wrong, bent].map(|n| f64::from(n) / f64::from(asked));
            report += &format!("{place}, cells of {cell_m} m: {wrong:.4}, mean direction only {bent:.4}\n");
            shares.push((wrong, bent));
        }
    }
    for (wrong, bent) in shares {
        assert!(wrong < 0.05 && bent > wrong, "{report}");
    }
}
