//! Work against precision: the wet ground of a street by cell size and interval, its build, questions to it.

use std::hint::black_box;
use std::sync::Arc;

use glam::DVec3;
use rain_bench::study::{Study, Variant};
use rain_core::hash::{pcg3d, unit_f32};
use rain_core::surface::Grate;
use rain_core::surface::basins::{Drain, Inlet};
use rain_core::surface::ground::{Ground, GroundDomain, GroundScene, GroundSettings};
use rain_core::weather::{ColumnForcing, SurfaceClass};
use rayon::prelude::*;
use street::ground::{pavement_height, road_height};
use street::layout::{
    DRAINS, FACADE_X, GUTTER_X, HOLLOWS, Hollow, KERB_WIDTH, ROAD_HALF_WIDTH, SHELTER_X, SHELTER_Y, SHELTER_Z,
};

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    let patch = Arc::new(Patch::new());
    let finest = patch.seen(FINEST_M);
    let errors: Vec<Errors> = CELLS_M
        .into_par_iter()
        .map(|cell_m| patch.seen(cell_m).against(&finest))
        .collect();
    let study = |name, title, norm, error: fn(&Errors) -> f64| Study {
        name,
        title,
        norm,
        unit: "tick of 20 m of street",
        variants: by_cell(&errors, error, |cell_m| patch.ticks(cell_m, 32, 8)),
    };
    let mut all = vec![
        study(
            "ground-puddle-level",
            "Levels of a street's puddles, by cell",
            "rms error of the level, mm",
            |e| e.level_mm,
        ),
        study(
            "ground-puddle-volume",
            "Water in a street's puddles, by cell",
            "rms error over the mean volume",
            |e| e.volume,
        ),
        study(
            "ground-depth",
            "Film and puddles of a street, by cell",
            "mean error of the depth at a place, mm",
            |e| e.depth_mm,
        ),
        study(
            "ground-pores",
            "Pores after half a minute of rain, by cell",
            "mean error of the saturation at a place",
            |e| e.saturation,
        ),
    ];
    all.push(Study {
        name: "ground-build",
        title: "Building the ground of 20 m of street (33 000 triangles)",
        norm: "rms error of puddles over the mean volume",
        unit: "build",
        variants: by_cell(
            &errors,
            |e| e.volume,
            |cell_m| {
                let patch = patch.clone();
                (
                    1,
                    Box::new(move || {
                        let ground = patch.ground(black_box(cell_m), 32, 8);
                        ground.area_m2() + f64::from(ground.ground_heights()[0])
                    }),
                )
            },
        ),
    });
    all.push(Study {
        name: "ground-queries",
        title: "10 000 questions for the water at places in a street",
        norm: "mean error of the depth at a place, mm",
        unit: "10 000 questions",
        variants: by_cell(&errors, |e| e.depth_mm, |cell_m| patch.questions(cell_m)),
    });
    all.push(intervals(&patch));
    all
}

/// Cells that are compared, and those of the reference. Units: m.
const CELLS_M: [f64; 5] = [1.0, 0.5, 0.25, 0.125, 0.0625];
const FINEST_M: f64 = 1.0 / 64.0;
/// Units: s.
const TICK_S: f64 = 1.0 / 32.0;
/// Ticks of a timed run: two of the longest intervals.
const RUN_TICKS: u32 = 256;
/// The part of the street: from façade to façade, x and z. Units: m.
const LOW_M: [f64; 2] = [-FACADE_X as f64, -12.0];
const HIGH_M: [f64; 2] = [FACADE_X as f64, 8.0];
/// Side of the squares that the ground is cut into before it is drawn, and of those that puddles are summed over.
/// Units: m.
const LATTICE_M: f64 = 0.125;
const SAMPLE_M: f64 = 1.0 / 32.0;

/// What a variant runs, and how many evaluations that makes.
type Run = (u64, Box<dyn FnMut() -> f64>);

/// A variant for each cell size.
fn by_cell(errors: &[Errors], error: fn(&Errors) -> f64, run: impl Fn(f64) -> Run) -> Vec<Variant> {
    CELLS_M
        .iter()
        .zip(errors)
        .map(|(&cell_m, errors)| {
            let (evaluations, run) = run(cell_m);
            let variant = Variant::new(format!("{cell_m} m"), error(errors), evaluations, run);
            if cell_m == GroundSettings::default().cell_m {
                variant.default()
            } else {
                variant
            }
        })
        .collect()
}

fn rain(rain_mm_h: f64) -> ColumnForcing {
    ColumnForcing {
        rain_mm_h,
        evaporation_mm_h: 0.1,
    }
}

/// 20 m of street as triangles: crowned road with ruts and hollows, gutters with two grates, kerbs, pavements, the roof
/// of a bus shelter.
struct Patch {
    scene: GroundScene,
    /// Anywhere on the ground.
    places: Vec<DVec3>,
    /// Where each hollow's puddle may stand.
    hollows: Vec<Vec<DVec3>>,
}

/// What is seen of a street's water.
struct Seen {
    levels_m: Vec<f64>,
    volumes_m3: Vec<f64>,
    depths_mm: Vec<f64>,
    saturations: Vec<f64>,
}

/// How far that is from another street's.
struct Errors {
    level_mm: f64,
    volume: f64,
    depth_mm: f64,
    saturation: f64,
}

impl Seen {
    fn against(&self, truth: &Self) -> Errors {
        let rms = |a: &[f64], b: &[f64]| {
            let sum: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
            (sum / b.len() as f64).sqrt()
        };
        let off = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f64>() / b.len() as f64;
        let mean_volume = truth.volumes_m3.iter().sum::<f64>() / truth.volumes_m3.len() as f64;
        Errors {
            level_mm: 1e3 * rms(&self.levels_m, &truth.levels_m),
            volume: rms(&self.volumes_m3, &truth.volumes_m3) / mean_volume,
            depth_mm: off(&self.depths_mm, &truth.depths_mm),
            saturation: off(&self.saturations, &truth.saturations),
        }
    }
}

/// Numbers from `low` to `high` in equal steps of at most `step`.
fn steps(low: f64, high: f64, step: f64) -> Vec<f64> {
    let n = ((high - low) / step - 1e-9).ceil().max(1.0) as u32;
    (0..=n)
        .map(|k| low + (high - low) * f64::from(k) / f64::from(n))
        .collect()
}

fn height(x: f64, z: f64) -> f64 {
    let on_road = x.abs() <= f64::from(ROAD_HALF_WIDTH);
    let height = if on_road { road_height } else { pavement_height };
    f64::from(height(x as f32, z as f32))
}

impl Patch {
    fn new() -> Self {
        let mut scene = GroundScene::default();
        let [road, gutter, wall] = [ROAD_HALF_WIDTH, GUTTER_X, FACADE_X].map(f64::from);
        let kerb = road + f64::from(KERB_WIDTH);
        // From, to; kerbs and pavements end upright at the road.
        let strips = [
            (-wall, -kerb, SurfaceClass::Concrete, true),
            (-kerb, -road, SurfaceClass::Stone, true),
            (-road, -gutter, SurfaceClass::Stone, false),
            (-gutter, gutter, SurfaceClass::Asphalt, false),
            (gutter, road, SurfaceClass::Stone, false),
            (road, kerb, SurfaceClass::Stone, true),
            (kerb, wall, SurfaceClass::Concrete, true),
        ];
        for (owner, (from, to, class, raised)) in (0..).zip(strips) {
            let surface = if raised { pavement_height } else { road_height };
            let corner = |x: f64, z: f64| DVec3::new(x, f64::from(surface(x as f32, z as f32)), z);
            let (xs, zs) = (steps(from, to, LATTICE_M), steps(LOW_M[1], HIGH_M[1], LATTICE_M));
            let mut triangles = Vec::new();
            for x in xs.windows(2) {
                for z in zs.windows(2) {
                    let [a, b] = [corner(x[0], z[0]), corner(x[1], z[0])];
                    let [c, d] = [corner(x[1], z[1]), corner(x[0], z[1])];
                    triangles.extend([[a, d, c], [a, c, b]]);
                }
            }
            scene.set(owner, &triangles, class, true);
        }
        let roof = |i: usize, j: usize| {
            let [x, z] = [SHELTER_X[i], SHELTER_Z[j]].map(f64::from);
            DVec3::new(x, f64::from(SHELTER_Y), z)
        };
        let [a, b, c, d] = [roof(0, 0), roof(1, 0), roof(1, 1), roof(0, 1)];
        scene.set(7, &[[a, d, c], [a, c, b]], SurfaceClass::Roof, true);
        let place = |x: f64, z: f64| DVec3::new(x, height(x, z), z);
        let inside = |x: f64, z: f64| x > LOW_M[0] && x < HIGH_M[0] && z > LOW_M[1] && z < HIGH_M[1];
        let places = (0..10_000)
            .map(|i| {
                let [u, v, _] = pcg3d([i, 3, 5]).map(|h| f64::from(unit_f32(h)));
                place(
                    LOW_M[0] + u * (HIGH_M[0] - LOW_M[0]),
                    LOW_M[1] + v * (HIGH_M[1] - LOW_M[1]),
                )
            })
            .collect();
        let disc = |hollow: &Hollow| {
            let [x0, z0, radius] = [hollow.centre[0], hollow.centre[1], hollow.radius].map(f64::from);
            let n = (radius / SAMPLE_M) as i32;
            (-n..n)
                .flat_map(|i| (-n..n).map(move |j| [i, j].map(|k| (f64::from(k) + 0.5) * SAMPLE_M)))
                .filter(|[dx, dz]| dx.hypot(*dz) < radius)
                .map(|[dx, dz]| place(x0 + dx, z0 + dz))
                .collect()
        };
        let whole = |hollow: &&Hollow| {
            let [x, z, radius] = [hollow.centre[0], hollow.centre[1], hollow.radius].map(f64::from);
            inside(x - radius, z - radius) && inside(x + radius, z + radius)
        };
        Self {
            scene,
            places,
            hollows: HOLLOWS.iter().filter(whole).map(disc).collect(),
        }
    }

    fn ground(&self, cell_m: f64, interval_steps: u32, basin_steps: u32) -> Ground {
        let drains = DRAINS.iter().map(|place| place.map(f64::from));
        let grate = Grate {
            perimeter_m: 1.6,
            area_m2: 0.06,
        };
        let settings = GroundSettings {
            domain: Some(GroundDomain {
                low_m: LOW_M,
                high_m: HIGH_M,
            }),
            cell_m,
            max_cells: 1 << 24,
            interval_steps,
            basin_steps,
            drains: drains
                .filter(|[_, z]| *z > LOW_M[1] && *z < HIGH_M[1])
                .map(|[x_m, z_m]| Drain {
                    x_m,
                    z_m,
                    inlet: Inlet::Grate(grate),
                })
                .collect(),
            ..GroundSettings::default()
        };
        Ground::build(&self.scene, &settings).expect("a street")
    }

    /// Film and puddle at each of the first `count` places. Units: mm.
    fn depths_mm(&self, ground: &Ground, count: usize) -> Vec<f64> {
        let depth = |place: &DVec3| {
            let water = ground.water_at(*place);
            water.film_mm + 1e3 * water.puddle_m
        };
        self.places[..count].iter().map(depth).collect()
    }

    /// Half a minute of 20 mm/h, ten of 30 mm/h, five of rest; every cell in every step.
    fn seen(&self, cell_m: f64) -> Seen {
        let mut ground = self.ground(cell_m, 1, 1);
        let run = |ground: &mut Ground, rain_mm_h: f64, steps: u32| {
            for _ in 0..steps {
                ground.advance(&rain(rain_mm_h), 10.0, 1).expect("valid");
            }
        };
        run(&mut ground, 20.0, 3);
        let saturation = |place: &DVec3| ground.water_at(*place).saturation;
        let saturations = self.places.iter().map(saturation).collect();
        run(&mut ground, 30.0, 60);
        run(&mut ground, 0.0, 30);
        let (mut levels_m, mut volumes_m3) = (Vec::new(), Vec::new());
        for samples in &self.hollows {
            // Without a puddle the level is that of the dry bottom.
            let bottom = samples.iter().fold(f64::INFINITY, |low, place| low.min(place.y));
            let (mut level, mut deepest, mut volume) = (bottom, 0.0, 0.0);
            for place in samples {
                let depth = ground.water_at(*place).puddle_m;
                volume += depth * SAMPLE_M * SAMPLE_M;
                if depth > deepest
                    && let Some(cell) = ground.cell_at(place.x, place.z)
                {
                    deepest = depth;
                    level = depth + f64::from(ground.ground_heights()[cell]) + ground.base_height_m();
                }
            }
            levels_m.push(level);
            volumes_m3.push(volume);
        }
        Seen {
            levels_m,
            volumes_m3,
            depths_mm: self.depths_mm(&ground, self.places.len()),
            saturations,
        }
    }

    /// A wet street.
    fn wet(&self, cell_m: f64, interval_steps: u32, basin_steps: u32) -> Ground {
        let mut ground = self.ground(cell_m, interval_steps, basin_steps);
        for _ in 0..120 {
            ground.advance(&rain(30.0), 5.0, interval_steps).expect("valid");
        }
        ground
    }

    /// Ticks of rain that changes from one to the next, on wet ground.
    fn ticks(&self, cell_m: f64, interval_steps: u32, basin_steps: u32) -> Run {
        let mut ground = self.wet(cell_m, interval_steps, basin_steps);
        let run = move || {
            for tick in 0..RUN_TICKS {
                let forcing = rain(25.0 + f64::from(tick % 7));
                ground.advance(black_box(&forcing), TICK_S, 1).expect("valid");
            }
            f64::from(ground.base_height_m() as f32) + ground.film_version() as f64
        };
        (u64::from(RUN_TICKS), Box::new(run))
    }

    fn questions(&self, cell_m: f64) -> Run {
        let ground = self.wet(cell_m, 32, 8);
        let places = self.places.clone();
        let run = move || {
            let depth = |place: &DVec3| {
                let water = ground.water_at(*place);
                water.puddle_m + 1e-3 * water.film_mm
            };
            black_box(&places).iter().map(depth).sum()
        };
        (1, Box::new(run))
    }
}

/// Seconds of a shower that rises to 60 mm/h and falls again, and of the rest after it.
const SHOWER_S: u32 = 120;
const SHOWN_S: u32 = 180;

/// Depths at 1000 places in every second of the shower, every tick simulated.
fn shower(patch: &Patch, interval_steps: u32, basin_steps: u32) -> Vec<f64> {
    let mut ground = patch.ground(GroundSettings::default().cell_m, interval_steps, basin_steps);
    let mut depths = Vec::new();
    for second in 0..SHOWN_S {
        for tick in 0..32 {
            let time_s = f64::from(second) + f64::from(tick) * TICK_S;
            let half = 0.5 * f64::from(SHOWER_S);
            let forcing = rain(60.0 * (1.0 - (time_s - half).abs() / half).max(0.0));
            ground.advance(&forcing, TICK_S, 1).expect("valid");
        }
        depths.extend(patch.depths_mm(&ground, 1000));
    }
    depths
}

/// Steps of an interval, and how often basins are advanced in it.
const INTERVALS: [(u32, u32); 11] = [
    (1, 1),
    (2, 2),
    (4, 4),
    (8, 8),
    (16, 8),
    (32, 8),
    (64, 8),
    (128, 8),
    (32, 1),
    (32, 2),
    (32, 32),
];

fn intervals(patch: &Patch) -> Study {
    let seen: Vec<Vec<f64>> = INTERVALS
        .into_par_iter()
        .map(|(interval, basins)| shower(patch, interval, basins))
        .collect();
    let default = GroundSettings::default();
    let variants = INTERVALS
        .into_iter()
        .zip(&seen)
        .map(|((interval, basins), depths)| {
            let off = depths.iter().zip(&seen[0]).map(|(a, b)| (a - b).abs());
            let error = off.sum::<f64>() / depths.len() as f64;
            let (evaluations, run) = patch.ticks(default.cell_m, interval, basins);
            let name = format!("interval {interval}, basin steps {basins}");
            let variant = Variant::new(name, error, evaluations, run);
            if (interval, basins) == (default.interval_steps, default.basin_steps) {
                variant.default()
            } else {
                variant
            }
        })
        .collect();
    Study {
        name: "ground-interval",
        title: "Cells and basins in turns: ticks of an interval, in a shower",
        norm: "mean error of the depth at a place and time, mm",
        unit: "tick of 20 m of street",
        variants,
    }
}
