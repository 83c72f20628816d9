//! Work against precision: the cover map by cell and by way of looking up, against exact casts of each drop's own way.

use std::hint::black_box;
use std::sync::Arc;

use glam::{DVec2, DVec3, Vec2};
use rain_bench::study::{Study, Variant};
use rain_core::cover::lookup::{covered, covered_from};
use rain_core::cover::{ClassShare, CoverScene, CoverSettings, FallSlope, OccluderId, project};
use rain_core::hash::{pcg3d, unit_f32};
use rain_core::rainfall::{CLASS_COUNT, CLASS_SPEEDS_M_S, ClassWeights, Distribution, Spectrum};
use rain_reference::cover::{Triangle, block, stopped_at};
use rayon::prelude::*;

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    let streets: Arc<Vec<Street>> = Arc::new((0..STREETS).map(Street::new).collect());
    vec![look_up(&streets), build(&streets), exposure(&streets)]
}

/// Streets, points in the air and on the ground of each, cells. Units of the cells: m.
const STREETS: u32 = 6;
const POINTS: u32 = 400;
const CELLS_M: [f64; 6] = [2.0, 1.0, 0.5, 0.25, 0.125, 0.0625];
/// No occluder is higher. Units: m.
const HIGHEST_M: f32 = 8.0;
/// Units: m/s.
const WIND_M_S: f64 = 10.0;

/// 60 m of street: roofs 0.2 m thick at 2.5 to 8 m, buildings of 3 to 8 m; rain of 25 mm/h in a wind of 10 m/s.
struct Street {
    /// Of all its solids, for casts and for maps.
    cast: Vec<Triangle>,
    triangles: Vec<[DVec3; 3]>,
    slope: FallSlope,
    /// In free air up to 3 m.
    in_air: Vec<DVec3>,
    on_ground: Vec<DVec3>,
    /// Whether drops of each class are stopped before the points in the air.
    stopped: Vec<[bool; CLASS_COUNT]>,
}

/// Share of each size class in the rain.
fn shares() -> [ClassShare; CLASS_COUNT] {
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 25.0).expect("valid");
    let rates = ClassWeights::new(&spectrum).rain_rate_mm_h;
    core::array::from_fn(|class| ClassShare {
        inverse_speed_s_per_m: 1.0 / CLASS_SPEEDS_M_S[class],
        share: rates[class],
    })
}

/// Neighbouring classes together, `groups` in all.
fn grouped(groups: usize) -> Vec<ClassShare> {
    let group = |classes: &[ClassShare]| {
        let share: f64 = classes.iter().map(|class| class.share).sum();
        let inverse: f64 = classes.iter().map(|c| c.share * c.inverse_speed_s_per_m).sum();
        ClassShare {
            inverse_speed_s_per_m: inverse / share,
            share,
        }
    };
    shares().chunks(CLASS_COUNT / groups).map(group).collect()
}

impl Street {
    fn new(number: u32) -> Self {
        let random = |i: u32, k: u32| pcg3d([number, i, k]).map(|h| f64::from(unit_f32(h)));
        let solids: Vec<[DVec3; 2]> = (0..28)
            .map(|i| {
                let ([x, z, kind], [a, b, h]) = (random(i, 1), random(i, 2));
                let (low, high) = if kind < 0.3 {
                    (0.0, 3.0 + 5.0 * h)
                } else {
                    (2.5 + 5.3 * h, 2.7 + 5.3 * h)
                };
                let at = DVec3::new(60.0 * x - 30.0, low, 60.0 * z - 30.0);
                [at, at + DVec3::new(4.0 + 8.0 * a, high - low, 4.0 + 8.0 * b)]
            })
            .collect();
        let free = |p: &DVec3| {
            !solids
                .iter()
                .any(|[low, high]| p.cmpge(*low).all() && p.cmple(*high).all())
        };
        let points = |kind: u32, height: f64| -> Vec<DVec3> {
            (0..POINTS)
                .map(|i| {
                    let [x, y, z] = random(i, kind);
                    DVec3::new(50.0 * x - 20.0, height * y, 50.0 * z - 20.0)
                })
                .filter(free)
                .collect()
        };
        let angle = 0.7 * f64::from(number);
        let wind = WIND_M_S * DVec2::new(angle.cos(), angle.sin());
        let [speeds, flux] = [
            CLASS_SPEEDS_M_S.to_vec(),
            shares().iter().map(|class| class.share).collect(),
        ];
        let cast: Vec<Triangle> = solids
            .iter()
            .flat_map(|[low, high]| block(low.to_array(), high.to_array()))
            .collect();
        let mut street = Self {
            triangles: cast.iter().map(|t| t.map(DVec3::from)).collect(),
            cast,
            slope: FallSlope::from_classes(wind, &speeds, &flux).expect("valid"),
            in_air: points(99, 3.0),
            on_ground: points(98, 0.0),
            stopped: Vec::new(),
        };
        let stopped = |place: &DVec3| shares().map(|class| street.is_hit(*place, class.inverse_speed_s_per_m));
        street.stopped = street.in_air.iter().map(stopped).collect();
        street
    }

    /// Whether a drop of a class arrives at a place, by its own ray.
    fn is_hit(&self, place: DVec3, inverse_speed: f64) -> bool {
        let wind = self.slope.wind_m_s().to_array();
        stopped_at(&self.cast, place.to_array(), wind, 1.0 / inverse_speed).is_some()
    }

    fn map(&self, cell_m: f64) -> CoverScene {
        let settings = CoverSettings {
            cell_m,
            ..CoverSettings::default()
        };
        let mut scene = CoverScene::new(settings, self.slope).expect("valid");
        scene.add(OccluderId(1), &self.triangles).expect("small");
        scene.update();
        scene
    }
}

/// How a look-up is made.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    ThreeStarts,
    /// Three starts with one bound for the whole map, as in a shader.
    OneBound,
    /// The point's own height alone.
    OneStart,
    /// As if all drops fell like the mean.
    MeanDirection,
}

fn answer(map: &CoverScene, way: Way, place: DVec3, inverse_speed: f64) -> bool {
    if way == Way::ThreeStarts {
        return map.covered(place, inverse_speed).expect("in its domain");
    }
    let cell_m = map.settings().cell_m as f32;
    let (q, y) = (project(place, 0.0, map.drawn_drift()).as_vec2(), place.y as f32);
    let reader = map.tiles().reader();
    let height = |q: Vec2| {
        let cell = (q / cell_m).floor();
        reader.height(cell.x as i64, cell.y as i64)
    };
    let shift = (map.slope().wind_m_s() * inverse_speed - map.drawn_drift()).as_vec2();
    match way {
        Way::OneBound => covered(q, y, shift, HIGHEST_M, height),
        Way::OneStart => covered_from(y, q, y, shift, height),
        _ => height(q) > y,
    }
}

/// Share of drops, weighted by what they bring, that are misjudged at points in the air. Units: %.
fn misjudged(streets: &[Street], judge: impl Fn(usize, DVec3, f64) -> bool + Sync) -> f64 {
    let of = |(number, street): (usize, &Street)| {
        let mut sums = [0.0; 2];
        for (&place, stopped) in street.in_air.iter().zip(&street.stopped) {
            for (class, stopped) in shares().iter().zip(stopped) {
                let wrong = judge(number, place, class.inverse_speed_s_per_m) != *stopped;
                sums[0] += class.share * f64::from(u8::from(wrong));
                sums[1] += class.share;
            }
        }
        sums
    };
    let sums: Vec<[f64; 2]> = streets.par_iter().enumerate().map(of).collect();
    let total = |i: usize| sums.iter().map(|s| s[i]).sum::<f64>();
    100.0 * total(0) / total(1)
}

/// A variant that judges every point in the air of every street, classes in turn.
fn judging(
    name: String,
    streets: &Arc<Vec<Street>>,
    judge: impl Fn(usize, DVec3, f64) -> bool + Sync + 'static,
) -> Variant {
    let error = misjudged(streets, &judge);
    let shares = shares();
    let drops: Vec<(usize, DVec3, f64)> = streets
        .iter()
        .enumerate()
        .flat_map(|(number, street)| street.in_air.iter().map(move |place| (number, *place)))
        .zip((0..CLASS_COUNT).cycle())
        .map(|((number, place), class)| (number, place, shares[class].inverse_speed_s_per_m))
        .collect();
    Variant::new(name, error, drops.len() as u64, move || {
        let stopped =
            |&(number, place, inverse): &(usize, DVec3, f64)| f64::from(u8::from(judge(number, place, inverse)));
        black_box(&drops).iter().map(stopped).sum()
    })
}

fn maps(streets: &[Street], cell_m: f64) -> Vec<CoverScene> {
    streets.par_iter().map(|street| street.map(cell_m)).collect()
}

fn look_up(streets: &Arc<Vec<Street>>) -> Study {
    let default_m = CoverSettings::default().cell_m;
    let mut variants = Vec::new();
    let ways = [
        ("three starts", Way::ThreeStarts, &CELLS_M[..]),
        ("three starts, one bound", Way::OneBound, &[0.25, 0.0625]),
        ("one start", Way::OneStart, &[0.25]),
        ("mean direction", Way::MeanDirection, &[0.25, 0.0625]),
    ];
    for (name, way, cells) in ways {
        for &cell_m in cells {
            let maps = maps(streets, cell_m);
            let judge = move |number: usize, place, inverse| answer(&maps[number], way, place, inverse);
            let variant = judging(format!("{cell_m} m, {name}"), streets, judge);
            let default = way == Way::ThreeStarts && cell_m == default_m;
            variants.push(if default { variant.default() } else { variant });
        }
    }
    let own = streets.clone();
    let cast = move |number: usize, place, inverse| own[number].is_hit(place, inverse);
    variants.push(judging("ray cast at 336 triangles".to_owned(), streets, cast));
    Study {
        name: "cover-look-up",
        title: "Does a drop arrive? Points in the air, wind 10 m/s",
        norm: "misjudged share of the drops, %",
        unit: "look-up",
        variants,
    }
}

fn build(streets: &Arc<Vec<Street>>) -> Study {
    let variants = CELLS_M.iter().map(|&cell_m| {
        let built = maps(streets, cell_m);
        let error = misjudged(streets, |number, place, inverse| {
            answer(&built[number], Way::ThreeStarts, place, inverse)
        });
        let streets = streets.clone();
        let variant = Variant::new(format!("{cell_m} m"), error, u64::from(STREETS), move || {
            let highest = |street: &Street| f64::from(street.map(black_box(cell_m)).tiles().highest());
            streets.iter().map(highest).sum()
        });
        if cell_m == CoverSettings::default().cell_m {
            variant.default()
        } else {
            variant
        }
    });
    Study {
        name: "cover-build",
        title: "The cover map of 60 m of street, 336 triangles",
        norm: "misjudged share of the drops, %",
        unit: "map",
        variants: variants.collect(),
    }
}

/// Over how many metres the exposure goes from 0.1 to 0.9 at the straight edge of a roof in calm air, at worst.
fn edge_m(cell_m: f64) -> f64 {
    let slope = FallSlope::new(DVec2::ZERO, 0.169).expect("valid");
    let settings = CoverSettings {
        cell_m,
        ..CoverSettings::default()
    };
    let offsets = (0..8).map(|i| f64::from(i) / 8.0 * cell_m);
    let width = |offset: f64| {
        let mut scene = CoverScene::new(settings, slope).expect("valid");
        let roof = block([offset, 4.0, -20.0], [offset + 20.0, 4.2, 20.0]);
        let roof: Vec<_> = roof.iter().map(|t| t.map(DVec3::from)).collect();
        scene.add(OccluderId(1), &roof).expect("small");
        scene.update();
        let step = cell_m / 64.0;
        let soft = (-192..192).filter(|i| {
            let place = DVec3::new(offset + f64::from(*i) * step, 0.0, 0.3);
            let exposure = scene.exposure(place, 0.169).expect("in its domain");
            (0.1..0.9).contains(&exposure)
        });
        soft.count() as f64 * step
    };
    offsets.map(width).fold(0.0, f64::max)
}

fn exposure(streets: &Arc<Vec<Street>>) -> Study {
    let exact: Vec<f64> = streets
        .par_iter()
        .flat_map_iter(|street| {
            let open = |place: &DVec3| {
                let (mut sum, mut open) = (0.0, 0.0);
                for class in shares() {
                    sum += class.share;
                    open += class.share * f64::from(u8::from(!street.is_hit(*place, class.inverse_speed_s_per_m)));
                }
                open / sum
            };
            street.on_ground.iter().map(open).collect::<Vec<_>>()
        })
        .collect();
    let places: Vec<(usize, DVec3)> = streets
        .iter()
        .enumerate()
        .flat_map(|(number, street)| street.on_ground.iter().map(move |place| (number, *place)))
        .collect();
    let mut variants = Vec::new();
    let mut add = |name: String, default: bool, judge: Box<dyn Fn(usize, DVec3) -> f64>| {
        let off = places
            .iter()
            .zip(&exact)
            .map(|((number, place), exact)| (judge(*number, *place) - exact).abs());
        let error = 100.0 * off.sum::<f64>() / exact.len() as f64;
        let places = places.clone();
        let variant = Variant::new(name, error, places.len() as u64, move || {
            black_box(&places)
                .iter()
                .map(|(number, place)| judge(*number, *place))
                .sum()
        });
        variants.push(if default { variant.default() } else { variant });
    };
    let soft = |cell_m: f64, groups: usize| -> Box<dyn Fn(usize, DVec3) -> f64> {
        let (maps, classes) = (maps(streets, cell_m), grouped(groups));
        Box::new(move |number, place| f64::from(maps[number].flux_exposure(place, &classes).expect("in its domain")))
    };
    let default_m = CoverSettings::default().cell_m;
    for cell_m in CELLS_M {
        let name = format!("{cell_m} m, 3 groups: edge {:.2} m wide", edge_m(cell_m));
        add(name, cell_m == default_m, soft(cell_m, 3));
    }
    for groups in [1, 2, 6, 12] {
        let plural = if groups == 1 { "" } else { "s" };
        let name = format!("{default_m} m, {groups} group{plural}");
        add(name, false, soft(default_m, groups));
    }
    for groups in [3, 6, 12] {
        let (hard, classes) = (maps(streets, default_m), grouped(groups));
        let judge = move |number: usize, place: DVec3| {
            let (mut sum, mut open) = (0.0, 0.0);
            for class in &classes {
                sum += class.share;
                let stopped = answer(&hard[number], Way::ThreeStarts, place, class.inverse_speed_s_per_m);
                open += class.share * f64::from(u8::from(!stopped));
            }
            open / sum
        };
        let name = format!("{default_m} m, {groups} groups, hard edge");
        add(name, false, Box::new(judge));
    }
    Study {
        name: "cover-exposure",
        title: "Exposure of points on the ground, wind 10 m/s",
        norm: "mean error of the exposure, %",
        unit: "place",
        variants,
    }
}
