//! What a falling drop shows.

use std::hint::black_box;
use std::rc::Rc;

use glam::Vec3;
use rain_bench::study::{Study, Variant};
use rain_core::optics::{
    CHEAP_REFLECTED, CHEAP_REFRACTED, DropBody, DropRay, deviation_sin_cos_f32, drop_rays_f32, normal_reflectance,
    schlick_f32,
};
use rain_core::rainfall::{DropOutline, Spheroid};
use rain_reference::light::drop::{Shape, cap_mean, lamp, overcast, picture, see};

const N: f32 = 1.333;
const VIEW: Vec3 = Vec3::NEG_Z;
const LAMP: Vec3 = Vec3::new(0.2843, 0.2369, -0.9290);
/// Lines of sight across.
const SIDE: u32 = 24;

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![radiance()]
}

/// An overcast sky over dark ground, and a lamp in the dusk.
fn environment(d: Vec3) -> [f32; 2] {
    let sky = if d.y > 0.0 { (1.0 + 2.0 * d.y) / 3.0 } else { 0.05 };
    [sky, 0.02 + 20.0 * ((d.dot(LAMP) - 1.0) * 89.05).exp()]
}

/// One drop: where lines of sight pass it, in radii of its widest circle from that circle's middle; the same as a part
/// of the half height and width from the middle of its picture; normals of the true outline there.
struct Drop {
    body: DropBody,
    spheroid: DropBody,
    cheap: [f32; 2],
    lines: Vec<[Vec3; 3]>,
    truth: Vec<[f64; 2]>,
    /// The same without what comes after more than three inner reflections.
    three: Vec<[f64; 2]>,
}

impl Drop {
    fn new(mm: f64) -> Self {
        let shape = Shape::falling(mm);
        let ends = shape.ends();
        let (body, [radius, level]) = DropBody::of_outline(&DropOutline::new(mm));
        let middle = Vec3::Y * (0.5 * (ends[0] + ends[1])) as f32;
        let half = Vec3::new(radius, (0.5 * (ends[1] - ends[0])) as f32, 1.0);
        let Spheroid {
            horizontal_mm,
            vertical_mm,
        } = Spheroid::of_drop(mm);
        let ratio = (vertical_mm / horizontal_mm) as f32;
        let wide = |v: Vec3| v.to_array().map(f64::from);
        let truly = |d: [f64; 3]| [overcast(d, 0.05), 0.02 + 20.0 * lamp(d, wide(LAMP.normalize()), 0.15)];
        let cheap = [0, 1].map(|which| {
            let of = |angle: f64| cap_mean(|d| truly(d)[which], wide(VIEW), angle) as f32;
            CHEAP_REFRACTED * of(40.0_f64.to_radians()) + CHEAP_REFLECTED * of(core::f64::consts::PI)
        });
        let (lines, (truth, three)) = picture(&shape, wide(VIEW), f64::from(N), 8, SIDE)
            .into_iter()
            .map(|(through, seen)| {
                let narrow = |v: [f64; 3]| Vec3::from_array(v.map(|c| c as f32));
                let at = narrow(through);
                let normal = narrow(seen.normal).normalize();
                let line = [(at - Vec3::Y * level) / radius, (at - middle) / half, normal];
                let early = |inner: Option<usize>| inner.is_none_or(|inner| inner <= 3);
                let three = [0, 1].map(|which| {
                    let paths = seen.paths.iter().filter(|path| early(path.inner));
                    paths.map(|path| path.weight * truly(path.direction)[which]).sum()
                });
                (line, ([0, 1].map(|which| seen.radiance(|d| truly(d)[which])), three))
            })
            .unzip();
        Self {
            body,
            spheroid: DropBody::new(ratio, ratio),
            cheap,
            lines,
            truth,
            three,
        }
    }
}

fn sum(rays: &[DropRay]) -> [f32; 2] {
    rays.iter().fold([0.0; 2], |sum, ray| {
        let light = environment(ray.direction);
        [0, 1].map(|i| sum[i] + ray.weight * light[i])
    })
}

/// The light of `N` rays through a body; what lies behind it where the line of sight misses.
fn through<const N: usize>(body: DropBody, at: Vec3) -> [f32; 2] {
    body.enter(at, VIEW)
        .and_then(|normal| body.rays::<N>(VIEW, normal, self::N))
        .map_or_else(|| environment(VIEW), |rays| sum(&rays))
}

/// Outward normal of the unit sphere at a point of its picture.
fn ball(disc: Vec3) -> Vec3 {
    let disc = disc.with_z(0.0).clamp_length_max(0.999_999);
    disc.with_z((1.0 - disc.length_squared()).sqrt()).normalize()
}

fn two(normal: Vec3) -> [f32; 2] {
    drop_rays_f32(VIEW, normal, N).map_or([0.0; 2], |rays| {
        let (refracted, reflected) = (environment(rays.refracted), environment(rays.reflected));
        [0, 1].map(|i| rays.refracted_weight * refracted[i] + rays.reflected_weight * reflected[i])
    })
}

fn schlick(normal: Vec3, f0: f32) -> [f32; 2] {
    let f = schlick_f32(normal.z, f0);
    let across = normal.with_z(0.0);
    let [sin, cos] = deviation_sin_cos_f32(across.length(), N);
    let refracted = environment(VIEW * cos - across.normalize_or_zero() * sin);
    let reflected = environment(VIEW + 2.0 * normal.z * normal);
    [0, 1].map(|i| (1.0 - f) * (1.0 - f) * refracted[i] + f * reflected[i])
}

fn radiance() -> Study {
    let drops: Rc<Vec<Drop>> = Rc::new([1.0, 2.0, 4.0].map(Drop::new).into());
    let error_of = |shown: &dyn Fn(&Drop, usize) -> [f64; 2]| {
        let mut errors = Vec::new();
        for drop in drops.iter() {
            for which in 0..2 {
                let (mut off, mut all) = (0.0, 0.0);
                for (line, truth) in drop.truth.iter().enumerate() {
                    off += (shown(drop, line)[which] - truth[which]).abs();
                    all += truth[which];
                }
                errors.push(off / all);
            }
        }
        errors.iter().sum::<f64>() / errors.len() as f64
    };
    let model = |name: &str, shown: fn(&Drop, [Vec3; 3]) -> [f32; 2]| {
        let error = error_of(&|drop, line| shown(drop, drop.lines[line]).map(f64::from));
        let count = drops.iter().map(|drop| drop.lines.len()).sum::<usize>() as u64;
        let drops = Rc::clone(&drops);
        Variant::new(name, error, count, move || {
            let mut sum = [0.0; 2];
            for drop in drops.iter() {
                for line in &drop.lines {
                    let light = shown(drop, black_box(*line));
                    sum = [sum[0] + light[0], sum[1] + light[1]];
                }
            }
            f64::from(sum[0] + sum[1])
        })
    };
    let traced = Variant::new("traced, 3 inner", error_of(&|drop, line| drop.three[line]), 8, || {
        let shape = Shape::falling(2.0);
        (0..8)
            .filter_map(|i| {
                see(
                    &shape,
                    black_box([0.1 * f64::from(i), 0.3, 0.0]),
                    [0.0, 0.0, -1.0],
                    f64::from(N),
                    3,
                )
            })
            .map(|seen| seen.radiance(|d| overcast(d, 0.05)))
            .sum()
    });
    Study {
        name: "drop-radiance",
        title: "What a falling drop shows",
        norm: "relative L1 over the disc, mean of 1, 2, 4 mm under an overcast sky and at a lamp",
        unit: "pixel",
        variants: vec![
            model("two blurred look-ups", |drop, _| drop.cheap),
            model("sphere, 2 rays, Schlick", |_, [_, disc, _]| {
                schlick(ball(disc), normal_reflectance(f64::from(N)) as f32)
            }),
            model("sphere, 2 rays", |_, [_, disc, _]| two(ball(disc))),
            model("sphere under the outline's normals, 2 rays", |_, [_, _, normal]| {
                two(normal)
            }),
            model("spheroid, 2 rays", |drop, [at, ..]| through::<2>(drop.spheroid, at)),
            model("halves, 2 rays", |drop, [at, ..]| through::<2>(drop.body, at)).default(),
            model("halves, 1 inner", |drop, [at, ..]| through::<3>(drop.body, at)),
            model("halves, 2 inner", |drop, [at, ..]| through::<4>(drop.body, at)),
            model("halves, 3 inner", |drop, [at, ..]| through::<5>(drop.body, at)),
            traced,
        ],
    }
}
