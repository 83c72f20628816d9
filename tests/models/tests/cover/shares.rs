//! Shares of points at which the look-up errs, against the map's resolution.

use glam::{DVec2, DVec3, Vec2};
use rain_core::cover::lookup;
use rain_core::cover::project;
use rain_core::rainfall::CLASS_SPEEDS_M_S;
use rain_reference::cover::{Triangle, stopped_at};
use rain_reference::fall_speed::fit;

use crate::check::Worst;

use super::{block, random, scene, shards};

/// Houses of 3–8 m and roofs 0.2 m thick at 2.5–8 m, and what lies inside them.
fn street(n: u32) -> Vec<[[f64; 3]; 2]> {
    (0..28)
        .map(|i| {
            let ([x, z, kind], [a, b, h]) = (random(n, i, 1), random(n, i, 2));
            let (low, high) = if kind < 0.3 {
                (0.0, 3.0 + 5.0 * h)
            } else {
                (2.5 + 5.3 * h, 2.7 + 5.3 * h)
            };
            let at = [60.0 * x - 30.0, 60.0 * z - 30.0];
            [
                [at[0], low, at[1]],
                [at[0] + 4.0 + 8.0 * a, high, at[1] + 4.0 + 8.0 * b],
            ]
        })
        .collect()
}

fn is_inside(solids: &[[[f64; 3]; 2]], p: [f64; 3]) -> bool {
    solids
        .iter()
        .any(|[low, high]| (0..3).all(|i| p[i] >= low[i] && p[i] <= high[i]))
}

/// Points in free air with the truth for each class.
type Truths = Vec<([f64; 3], [bool; 12])>;

fn truths(triangles: &[Triangle], solids: &[[[f64; 3]; 2]], wind: [f64; 2], seed: u32) -> Truths {
    (0..500)
        .map(|i| {
            let [x, y, z] = random(seed, i, 77);
            [40.0 * x - 20.0, 3.0 * y, 40.0 * z - 20.0]
        })
        .filter(|p| !is_inside(solids, *p))
        .map(|p| (p, CLASS_SPEEDS_M_S.map(|u| stopped_at(triangles, p, wind, u).is_some())))
        .collect()
}

const CELLS: [f64; 5] = [0.0625, 0.125, 0.25, 0.5, 1.0];

/// Shares of points misclassified by cell, every class alike: shipped, and two ways known to be worse: without walls,
/// and with the mean direction for every class.
fn measured(wind: [f64; 2], make: impl Fn(u32) -> (Vec<Triangle>, Vec<[[f64; 3]; 2]>)) -> [[f64; 3]; 5] {
    let mut wrong = [[0.0; 3]; 5];
    let mut asked = 0.0;
    for n in 0..4 {
        let (triangles, solids) = make(n);
        let truths = truths(&triangles, &solids, wind, n);
        asked += 12.0 * truths.len() as f64;
        for (cell, wrong) in CELLS.iter().zip(&mut wrong) {
            let map = scene(&triangles, *cell, wind);
            let reader = map.tiles().reader();
            let height = |q: Vec2| {
                let at = (q / *cell as f32).floor();
                reader.height(at.x as i64, at.y as i64)
            };
            for (p, truth) in &truths {
                let point = DVec3::from(*p);
                let (q, y) = (project(point, 0.0, map.drawn_drift()).as_vec2(), p[1] as f32);
                for (u, stopped) in CLASS_SPEEDS_M_S.iter().zip(truth) {
                    let shift = (DVec2::from(wind) / *u - map.drawn_drift()).as_vec2();
                    let shipped = map.covered(point, 1.0 / u).expect("inside the domain");
                    let starts = [y, 10.0, 0.5 * (y + 10.0)];
                    let no_walls = starts.iter().any(|s| lookup::covered_from(*s, q, y, shift, height));
                    for (wrong, answer) in wrong.iter_mut().zip([shipped, no_walls, height(q) > y]) {
                        *wrong += f64::from(u8::from(answer != *stopped));
                    }
                }
            }
        }
    }
    wrong.map(|shares| shares.map(|share| share / asked))
}

#[test]
fn misclassified_shares_stay_within_their_bound_at_every_resolution() {
    let mut all = Vec::new();
    let mut report = String::new();
    for wind in [[0.0, 0.0], [4.0, 3.0], [-8.0, 6.0], [16.0, -12.0]] {
        let houses = measured(wind, |n| {
            let solids = street(n);
            (
                solids.iter().flat_map(|[low, high]| block(*low, *high)).collect(),
                solids,
            )
        });
        let plates = measured(wind, |n| (shards(n, 60), Vec::new()));
        for (kind, shares) in [("houses", houses), ("shards", plates)] {
            for (cell, shares) in CELLS.iter().zip(shares) {
                report += &format!("{kind}, wind {wind:?} m/s, cells of {cell} m: {shares:.4?}\n");
                all.push((kind == "houses" && wind != [0.0; 2], *cell, shares));
            }
        }
    }
    for (houses_in_wind, cell, [shipped, no_walls, mean]) in all {
        assert!(
            shipped <= 0.05 + 0.05 * cell,
            "{shipped} in cells of {cell} m, of\n{report}"
        );
        if houses_in_wind && cell <= 0.25 {
            assert!(
                no_walls > shipped && mean > 2.0 * shipped,
                "{shipped} in cells of {cell} m, of\n{report}"
            );
        }
    }
}

/// Mean 1/v of each of seven equal shares of the water of `rain` mm/h between 0.2 and 6 mm, fast drops first, against
/// that of all of it, less 1.
fn sevenths(rain: f64) -> [f64; 7] {
    let steps = 100_000;
    let water = |i: u32| {
        let d = 0.2 + 5.8 * (f64::from(i) + 0.5) / f64::from(steps);
        let v = fit(d);
        ((-4.1 * rain.powf(-0.21) * d).exp() * d.powi(3) * v, v)
    };
    let all: f64 = (0..steps).map(|i| water(i).0).sum();
    let mean = (0..steps).map(|i| water(i).0 / water(i).1).sum::<f64>() / all;
    let mut means = [0.0; 7];
    let mut passed = 0.0;
    for i in (0..steps).rev() {
        let (flux, v) = water(i);
        means[((7.0 * passed / all) as usize).min(6)] += 7.0 * flux / v / all;
        passed += flux;
    }
    means.map(|share| share / mean - 1.0)
}

#[test]
fn the_shaders_shares_of_the_rain_are_its_sevenths() {
    let shader = include_str!("../../../../rain_render/shaders/lib/cover.wgsl");
    let (_, list) = shader.split_once("array<f32, 7>(").expect("the shares");
    let (list, _) = list.split_once(')').expect("their end");
    let shares: Vec<f64> = list.split(',').map(|x| x.trim().parse().expect("a number")).collect();
    let worst = |rain: f64| {
        let mut worst = Worst::default();
        for (i, (share, exact)) in shares.iter().zip(sevenths(rain)).enumerate() {
            worst.absolute(*share, exact, || format!("share {i} at {rain} mm/h"));
        }
        worst
    };
    worst(25.0).assert_below(0.04, 7);
    // Another rain is told apart.
    assert!(worst(2.0).error > 0.1 && worst(200.0).error > 0.1);
    assert!(shares.iter().sum::<f64>().abs() < 0.01, "their mean is the mean");
}
