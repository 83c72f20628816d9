//! What is missing in a picture, by how many of the rain's drops are drawn singly.

use std::cell::RefCell;
use std::rc::Rc;

use glam::{DVec3, IVec3, Vec2};
use rain_bench::study::{Study, Variant};
use rain_core::hash::unit_f32;
use rain_core::haze::near_weight;
use rain_core::ops::ln_1p;
use rain_core::rainfall::{
    Container, Distribution, DrawRange, DropChoice, FieldMotion, RainViewVolume, ScreenStreak, SizeClass, Spectrum,
    cell_key, drop_marks, quality_for_budget,
};

use super::streaks::volume;

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    let [picture, depth] = variants();
    vec![
        Study {
            name: "drop-count",
            title: "Rain of 25 mm/h by drops drawn singly (the rest: cards, haze)",
            norm: "rms over pixels of the opacity left out to 15 m, about its mean",
            unit: UNIT,
            variants: picture,
        },
        Study {
            name: "drop-count-depth",
            title: "Optical depth by drops drawn singly (the rest: cards, haze)",
            norm: "share of the optical depth to 15 m that is left out",
            unit: UNIT,
            variants: depth,
        },
    ]
}

/// What is timed: on one thread what a software device does.
const UNIT: &str = "sixteenth of a view, chosen and composited by one thread";
/// The middle of a picture of 1280 × 720, which is drawn: this share of it each way.
const SHARE: f32 = 0.25;
/// Its size. Units: px.
const SIZE: [usize; 2] = [320, 180];
/// Units: m.
const NEAR_M: f32 = 0.1;
/// Drops that a view on a software adapter draws unless told otherwise.
const DEFAULT: f64 = 3e4;
/// Seed of the drop field.
const SEED: u64 = 7;
/// More drops than the rain has within reach.
const MOST_DROPS: u32 = 1 << 23;

/// The part of the picture that is drawn, with the focal length of the whole.
fn part() -> RainViewVolume {
    volume(SHARE)
}

/// The whole picture, which budgets are for.
fn whole() -> RainViewVolume {
    RainViewVolume {
        // 4 asin(tx ty/√((1 + tx²)(1 + ty²))), 60° high and 16:9 wide.
        solid_angle_sr: 1.473,
        ..volume(1.0)
    }
}

/// The drops of 25 mm/h in a breeze that `budget` is enough for.
fn choice(budget: f64) -> DropChoice {
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 25.0).expect("a rate");
    let mut motion = FieldMotion::default();
    motion.set_velocity(DVec3::new(2.0, 0.0, -1.0), rain_core::constants::AIR_DENSITY);
    DropChoice {
        seed: SEED,
        spectrum,
        motion: motion.after(1234.5),
        view: part(),
        kappa: quality_for_budget(&spectrum, &whole(), budget),
        most_drops: MOST_DROPS,
        uneven: None,
        region: None,
        detail: None,
    }
}

/// Opacity of the rain in every pixel, and what is kept between pictures.
struct Picture {
    opacity: Vec<f32>,
    container: Container,
    classes: Vec<SizeClass>,
}

impl Picture {
    fn new() -> Self {
        Self {
            opacity: vec![0.0; SIZE[0] * SIZE[1]],
            container: Container::default(),
            classes: SizeClass::all().into(),
        }
    }

    /// Chooses the drops and lays their streaks over each other, at a contrast of 1.
    fn draw(&mut self, choice: &DropChoice) {
        assert!(choice.fill(&mut self.container), "all drops have a place");
        self.opacity.fill(0.0);
        let range = DrawRange::of(&choice.view, choice.kappa);
        for record in &self.container.records {
            let k = (record.drop & 15) as usize;
            let placement = &self.container.classes[k];
            // Coordinates of cells have ten bits each, biased by 512.
            let unpack = |shift: u32| (record.cell >> shift & 1023) as i32 - 512;
            let cell = IVec3::new(unpack(0), unpack(10), unpack(20));
            let key = cell_key(choice.seed, k as u32, placement.eye.cell.wrapping_add(cell));
            let marks = drop_marks(key, record.drop >> 4 & 0xFFF);
            let diameter_mm = self.classes[k].diameter_mm(unit_f32(marks[1]));
            let head = record.position(choice.seed, &self.container.classes);
            let presence = (record.drop >> 16) as f32 / 65_535.0;
            let weight = near_weight(head.length().into(), range.at(diameter_mm.into())) as f32 * presence;
            let tail = head - placement.velocity_m_s * choice.view.exposure_s as f32;
            let focal_px = choice.view.focal_px as f32;
            let streak = ScreenStreak::project(head, tail, 1e-3 * diameter_mm, focal_px, NEAR_M);
            if let Some(streak) = streak.filter(|_| weight > 0.0) {
                let middle = 0.5 * (head + tail);
                // Off the axis a flat picture draws a sphere out to an ellipse.
                let secant = (middle.length() / -middle.z).clamp(1.0, 4.0);
                lay(&mut self.opacity, &streak, weight * (streak.opacity * secant).min(1.0));
            }
        }
    }

    /// Mean of what the rain takes out of straight light, as an optical depth.
    fn mean_depth(&self) -> f64 {
        let sum: f64 = self.opacity.iter().map(|&opacity| -ln_1p(-f64::from(opacity))).sum();
        sum / self.opacity.len() as f64
    }
}

/// Where a + k x lies within ±h: first and last x.
fn within(a: f32, k: f32, h: f32) -> [f32; 2] {
    if k.abs() > 1e-6 {
        let ends = [(-h - a) / k, (h - a) / k];
        [ends[0].min(ends[1]), ends[0].max(ends[1])]
    } else if a.abs() < h {
        [f32::NEG_INFINITY, f32::INFINITY]
    } else {
        [f32::INFINITY, f32::NEG_INFINITY]
    }
}

/// Lays a streak of this opacity over a picture, its rim softened by the pixel's own footprint, as the renderer does.
fn lay(opacity: &mut [f32], streak: &ScreenStreak, alpha: f32) {
    let [width, height] = SIZE;
    let to_picture = |p: Vec2| Vec2::new(p.x + 0.5 * width as f32, 0.5 * height as f32 - p.y);
    let (head, tail) = (to_picture(streak.head_px), to_picture(streak.tail_px));
    let along = (tail - head).try_normalize().unwrap_or(Vec2::Y);
    let across = along.perp();
    let middle = 0.5 * (head + tail);
    let half = 0.5 * Vec2::new(streak.width_px, streak.length_px) + 0.5;
    let reach = half.x * across.abs() + half.y * along.abs();
    // Casts hold what is beside the picture at its rim.
    let rows = (middle.y - reach.y).floor() as usize..height.min((middle.y + reach.y).ceil().max(0.0) as usize);
    for (y, row) in rows.clone().zip(opacity.chunks_exact_mut(width).skip(rows.start)) {
        let from_middle = y as f32 + 0.5 - middle.y;
        let start = 0.5 - middle.x;
        let (across_0, along_0) = (
            across.x * start + across.y * from_middle,
            along.x * start + along.y * from_middle,
        );
        let [a, b] = within(across_0, across.x, half.x);
        let [c, d] = within(along_0, along.x, half.y);
        let columns = a.max(c).ceil().max(0.0) as usize..width.min((b.min(d) + 1.0).floor().max(0.0) as usize);
        if columns.is_empty() {
            continue;
        }
        let first = columns.start;
        for (x, pixel) in (first..).zip(&mut row[columns]) {
            let x = x as f32;
            let inside = |at: f32, half: f32| (half - at.abs()).clamp(0.0, 1.0);
            let covered = inside(across_0 + across.x * x, half.x) * inside(along_0 + along.x * x, half.y);
            *pixel += (1.0 - *pixel) * alpha * covered;
        }
    }
}

/// Every budget with its errors in a picture and in the depth.
fn variants() -> [Vec<Variant>; 2] {
    let shared = Rc::new(RefCell::new(Picture::new()));
    let (truth, depth) = {
        let mut picture = shared.borrow_mut();
        picture.draw(&choice(f64::INFINITY));
        (picture.opacity.clone(), picture.mean_depth())
    };
    let budgets = [
        ("1 000", 1e3),
        ("3 000", 3e3),
        ("10 000", 1e4),
        ("30 000, of software adapters", DEFAULT),
        ("100 000, of GPUs", 1e5),
        ("300 000", 3e5),
        ("1 000 000", 1e6),
        ("all, 3 600 000", f64::INFINITY),
    ];
    let mut variants = [Vec::new(), Vec::new()];
    for (name, budget) in budgets {
        let choice = choice(budget);
        let errors = {
            let mut picture = shared.borrow_mut();
            picture.draw(&choice);
            // Haze adds the mean again, but no streak.
            [spread(&picture.opacity, &truth), 1.0 - picture.mean_depth() / depth]
        };
        for (variants, error) in variants.iter_mut().zip(errors) {
            let (shared, mut choice) = (shared.clone(), choice.clone());
            let variant = Variant::new(name, error, 1, move || {
                choice.motion.advance(0.01);
                let mut picture = shared.borrow_mut();
                picture.draw(&choice);
                picture.opacity.iter().step_by(997).copied().map(f64::from).sum()
            });
            variants.push(if budget == DEFAULT { variant.default() } else { variant });
        }
    }
    variants
}

/// Standard deviation over pixels of what one picture has more than another.
fn spread(picture: &[f32], other: &[f32]) -> f64 {
    let more = || picture.iter().zip(other).map(|(a, b)| f64::from(a - b));
    let count = picture.len() as f64;
    let mean = more().sum::<f64>() / count;
    (more().map(|x| (x - mean).powi(2)).sum::<f64>() / count).sqrt()
}
