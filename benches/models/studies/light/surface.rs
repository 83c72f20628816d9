//! Reflection, refraction, the orders of a drop, streaks.

use std::hint::black_box;

use rain_bench::study::{Study, Variant};
use rain_core::optics::{
    deviation_rad, deviation_sin_cos_f32, fresnel, fresnel_f32, fresnel_polarised, normal_reflectance, schlick,
    schlick_f32,
};
use rain_core::rainfall::{streak_opacity, streak_opacity_f32};
use rain_reference::light::{self as reference, sphere, streak};

const N: f64 = 1.333;
const COUNT: usize = 256;

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![reflection(), refraction(), orders(), opacity()]
}

/// A variant over a grid in [0, 1] with the largest error against `truth`.
fn variant(name: &str, truth: &[f64], value: impl Fn(f64) -> f64 + 'static) -> Variant {
    let grid: Vec<f64> = (0..COUNT).map(|i| i as f64 / (COUNT - 1) as f64).collect();
    let error = grid
        .iter()
        .zip(truth)
        .map(|(x, y)| (value(*x) - y).abs())
        .fold(0.0, f64::max);
    Variant::new(name, error, COUNT as u64, move || {
        grid.iter().map(|x| value(black_box(*x))).sum()
    })
}

/// The same in single precision, input included.
fn single(name: &str, truth: &[f64], value: impl Fn(f32) -> f32 + 'static) -> Variant {
    let grid: Vec<f32> = (0..COUNT).map(|i| i as f32 / (COUNT - 1) as f32).collect();
    let error = grid
        .iter()
        .zip(truth)
        .map(|(x, y)| (f64::from(value(*x)) - y).abs())
        .fold(0.0, f64::max);
    Variant::new(name, error, COUNT as u64, move || {
        f64::from(grid.iter().map(|x| value(black_box(*x))).sum::<f32>())
    })
}

fn grid_of(f: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..COUNT).map(|i| f(i as f64 / (COUNT - 1) as f64)).collect()
}

fn reflection() -> Study {
    let truth = grid_of(|c| {
        let [s, p] = reference::fresnel(c.acos(), 1.0, N);
        0.5 * (s + p)
    });
    let f0 = normal_reflectance(N) as f32;
    Study {
        name: "fresnel",
        title: "Reflectance of water",
        norm: "max |F - F_ref| over all angles",
        unit: "angle",
        variants: vec![
            single("exact, f32", &truth, |c| fresnel_f32(c, N as f32)).default(),
            variant("exact", &truth, |c| fresnel(c, N)),
            single("Schlick, f32", &truth, move |c| schlick_f32(c, f0)),
            variant("Schlick", &truth, |c| schlick(c, N)),
            variant("Snell and Fresnel by angles", &truth, |c| {
                let [s, p] = reference::fresnel(c.acos(), 1.0, N);
                0.5 * (s + p)
            }),
        ],
    }
}

fn refraction() -> Study {
    let truth = grid_of(|s| 2.0 * (s.asin() - (s / N).asin()));
    // The arc is taken for the error only: users want the sine and the cosine.
    let arc = single("", &truth, |s| {
        let [sin, cos] = deviation_sin_cos_f32(s, N as f32);
        sin.atan2(cos)
    });
    let cheap = Variant {
        error: arc.error,
        ..single("sine and cosine, no arcs, f32", &truth, |s| {
            let [sin, cos] = deviation_sin_cos_f32(s, N as f32);
            sin + cos
        })
    };
    Study {
        name: "drop-refraction",
        title: "Deviation of light in a drop",
        norm: "max |δ - δ_ref|, rad, over the disc",
        unit: "ray",
        variants: vec![
            cheap.default(),
            variant("half-sine", &truth, |s| deviation_rad(s, N)),
            variant("two arcs", &truth, |s| 2.0 * (s.asin() - (s / N).asin())),
            single("two arcs, f32", &truth, |s| 2.0 * (s.asin() - (s / N as f32).asin())),
            variant("vectors traced", &truth[..COUNT - 1], |s| {
                sphere::deviation(s.min(0.999_999), N)
            }),
        ],
    }
}

/// Light that a model of a drop leaves out, over the disc.
fn orders() -> Study {
    // Rings of equal area; weights of the light at each.
    let rings: Vec<f64> = (0..COUNT)
        .map(|i| (1.0 - (i as f64 + 0.5) / COUNT as f64).sqrt())
        .collect();
    let model = |name: &str, weight: fn(f64) -> f64| {
        let sum: f64 = rings.iter().map(|c| weight(*c)).sum::<f64>() / COUNT as f64;
        let rings = rings.clone();
        Variant::new(name, (1.0 - sum).abs(), COUNT as u64, move || {
            rings.iter().map(|c| weight(black_box(*c))).sum()
        })
    };
    fn polarised(c: f64, orders: i32) -> f64 {
        let f = fresnel_polarised(c, N);
        [f.s, f.p]
            .iter()
            .map(|f| 0.5 * (f + (1.0 - f) * (1.0 - f) * (0..orders).map(|k| f.powi(k)).sum::<f64>()))
            .sum()
    }
    Study {
        name: "drop-orders",
        title: "Light of a drop that is accounted for",
        norm: "share of the light left out",
        unit: "ray",
        variants: vec![
            model("constant 0.884 + 0.066", |_| 0.884 + 0.066),
            model("F + (1 - F)², unpolarised", |c| {
                let f = fresnel(c, N);
                f + (1.0 - f) * (1.0 - f)
            })
            .default(),
            model("reflected, through, polarised", |c| polarised(c, 1)),
            model("1 inner reflection", |c| polarised(c, 2)),
            model("2 inner reflections", |c| polarised(c, 3)),
            model("3 inner reflections", |c| polarised(c, 4)),
        ],
    }
}

/// Picture of a streak 3 px wide and 24 px long.
fn opacity() -> Study {
    const WIDTH: f64 = 3.0;
    const PATH: f64 = 21.0;
    let points: Vec<[f64; 2]> = (0..8)
        .flat_map(|i| (0..28).map(move |j| [f64::from(i) * 0.49 - 1.7, f64::from(j) - 3.3]))
        .collect();
    let truth: Vec<f64> = points
        .iter()
        .map(|[x, y]| streak::covered_share(*x, *y, WIDTH, PATH, 20_000))
        .collect();
    let total: f64 = truth.iter().sum();
    let model = |name: String, alpha: Box<dyn Fn([f64; 2]) -> f64>| {
        let off: f64 = points.iter().zip(&truth).map(|(p, a)| (alpha(*p) - a).abs()).sum();
        let points = points.clone();
        Variant::new(name, off / total, points.len() as u64, move || {
            points.iter().map(|p| alpha(black_box(*p))).sum()
        })
    };
    let mut variants = vec![
        model(
            "closed form, f32".into(),
            Box::new(|[x, y]| f64::from(streak_opacity_f32(x as f32, y as f32, WIDTH as f32, PATH as f32))),
        )
        .default(),
        model(
            "closed form".into(),
            Box::new(|[x, y]| streak_opacity(x, y, WIDTH, PATH)),
        ),
        model(
            "mid-streak profile, no taper".into(),
            Box::new(|[x, y]| {
                if (0.0..=PATH).contains(&y) {
                    (WIDTH * WIDTH - 4.0 * x * x).max(0.0).sqrt() / PATH
                } else {
                    0.0
                }
            }),
        ),
    ];
    variants.extend([1, 4, 16, 64, 512].iter().map(|&samples| {
        model(
            format!("{samples} samples"),
            Box::new(move |[x, y]| streak::covered_share(x, y, WIDTH, PATH, samples)),
        )
    }));
    Study {
        name: "streak-opacity",
        title: "Opacity of a streak",
        norm: "relative L1 of the picture",
        unit: "pixel",
        variants,
    }
}
