//! The field of splashes: single impacts on a grid fixed to the world and in time slots, from integers alone.
//!
//! Nothing is stored for a splash. What hits a cell in a slot is a pure function of (seed, cell, slot) and of the rates of
//! the rain: the same in every view, at every frame rate, after a rewind and a seek.

use glam::{DVec3, IVec2, Vec2};

use super::artist::splash_image_life_s;
use super::budget::SplashShares;
use crate::error::clamped;
use crate::hash::{pcg3d, unit_f32};
use crate::ops;
use crate::rainfall::{CLASS_COUNT, LatticeEye, SizeClass, Spectrum, drop_marks, drop_place, terminal_velocity};

/// Edge of the cells. Units: m.
pub const SPLASH_CELL_M: f64 = 0.25;
/// Length of a time slot. Units: s.
pub const SPLASH_SLOT_S: f64 = 0.1;
/// Slots that may hold living splashes: the present one and those before it. Units: none.
pub const SPLASH_SLOTS: u32 = 4;
/// Entries of the table of counts: more impacts in a cell and slot do not occur. Units: none.
pub const SPLASH_COUNTS: usize = 128;

/// Largest mean count of a cell and slot: from there on shares are made smaller. Units: none.
pub(super) const LARGEST_MEAN: f64 = 64.0;
/// Smallest bend of the density inside a class that is told from even. Units: none.
const LEAST_BEND: f64 = 1e-3;
/// Tells the stream of splashes from all others of a seed.
const STREAM: u32 = 0x7370_6c73;

/// One impact of the field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SplashMark {
    /// Place in the cell. Units: none, [0, 1) along x and z.
    pub place: [f32; 2],
    /// Moment in the slot. Units: none, [0, 1).
    pub moment: f32,
    /// Size class of the drop, in 0..12.
    pub class: u32,
    /// Units: mm.
    pub diameter_mm: f32,
    /// How long what it throws is shown: 0.1 to 0.3 s. Units: s.
    pub life_s: f32,
    /// How many impacts of its class it stands for, at least 1. Units: none.
    pub weight: f32,
    /// For its secondary drops.
    pub key: [u32; 3],
}

/// What falls on a cell in a slot: tables of a fixed size, made when the rain changes.
///
/// Error: impacts per area and class within 1e-6 of ∫N v dD (times the share that is kept), water of the diameters
/// within 1 % of a class's; over 200 000 cells counts, places, moments and diameters within five standard deviations.
#[derive(Debug, Clone, PartialEq)]
pub struct SplashField {
    /// Random stream.
    pub stream: [u32; 3],
    /// The count is the number of entries that do not exceed the hash.
    pub count_limits: [u32; SPLASH_COUNTS],
    /// The class is the number of entries that do not exceed the hash.
    pub class_limits: [u32; CLASS_COUNT],
    /// Inverse of the density of impacts inside a class: D = x − ln(1 − u y)/z. x, z in mm, 1/mm.
    pub diameters: [[f32; 3]; CLASS_COUNT],
    /// Impacts that a shown one of the class stands for. Units: none.
    pub weights: [f32; CLASS_COUNT],
    /// Mean count of a cell and slot. Units: none.
    pub mean: f64,
}

impl SplashField {
    /// The field of a spectrum, of which `shares` are shown.
    ///
    /// Flux on level ground in still air, by size class from 0.5 to 6 mm. Source: Poisson process with marks.
    #[must_use]
    pub fn new(seed: u64, spectrum: &Spectrum, shares: &SplashShares) -> Self {
        let cell_slot = SPLASH_CELL_M * SPLASH_CELL_M * SPLASH_SLOT_S;
        let means: [f64; CLASS_COUNT] = core::array::from_fn(|k| shares.flux(k) * shares.share(k) * cell_slot);
        let mean: f64 = means.iter().sum::<f64>().min(LARGEST_MEAN);
        let total = means.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        let mut below = 0.0;
        let class_limits = means.map(|of_class| {
            below += of_class;
            limit(below / total)
        });
        Self {
            stream: pcg3d([seed as u32, (seed >> 32) as u32, STREAM]),
            count_limits: poisson_limits(mean),
            class_limits,
            diameters: SizeClass::all().map(|class| inverse(&class, spectrum)),
            weights: core::array::from_fn(|k| {
                if shares.share(k) > 0.0 {
                    (1.0 / shares.share(k)) as f32
                } else {
                    0.0
                }
            }),
            mean,
        }
    }

    /// Calls `visit` with each impact in `cell` during time slot `slot`. Allocates nothing.
    pub fn for_each(&self, cell: IVec2, slot: u32, mut visit: impl FnMut(SplashMark)) {
        let [a, b, c] = self.stream;
        let key = pcg3d([a ^ cell.x as u32, b ^ cell.y as u32, c ^ slot]);
        let count = self.count_limits.iter().take_while(|limit| **limit <= key[0]).count() as u32;
        for index in 0..count {
            let place = drop_place(key, index);
            let marks = drop_marks(key, index);
            let class = self.class_limits[..CLASS_COUNT - 1]
                .iter()
                .filter(|limit| **limit <= marks[0])
                .count();
            let [start, span, bend] = self.diameters[class];
            visit(SplashMark {
                place: [unit_f32(place[0]), unit_f32(place[2])],
                moment: unit_f32(place[1]),
                class: class as u32,
                diameter_mm: start - ops::lnf(1.0 - unit_f32(marks[1]) * span) / bend,
                life_s: splash_image_life_s(f64::from(unit_f32(marks[2]))) as f32,
                weight: self.weights[class],
                key: pcg3d(marks),
            });
        }
    }
}

/// A chance in [0, 1] as the hash below which it happens.
fn limit(chance: f64) -> u32 {
    (chance * 4_294_967_296.0).min(4_294_967_295.0) as u32
}

/// Entry c: the hash from which on there are more than c impacts.
fn poisson_limits(mean: f64) -> [u32; SPLASH_COUNTS] {
    let mut chance = ops::exp(-mean);
    let mut below = 0.0;
    core::array::from_fn(|count| {
        if count > 0 {
            chance *= mean / count as f64;
        }
        below += chance;
        limit(below)
    })
}

/// Start, span and bend of the inverse of ∫N v dD inside a class, taken as exponential between its edges.
fn inverse(class: &SizeClass, spectrum: &Spectrum) -> [f32; 3] {
    let width = class.max_mm - class.min_mm;
    let bend =
        spectrum.slope_per_mm * width - ops::ln(terminal_velocity(class.max_mm) / terminal_velocity(class.min_mm));
    let bend = if bend.abs() < LEAST_BEND || !bend.is_finite() {
        LEAST_BEND
    } else {
        bend
    };
    [class.min_mm as f32, -ops::exp_m1(-bend) as f32, (bend / width) as f32]
}

/// A view's eye and moment on the grid: integers and what is left, so that single precision suffices anywhere, at any
/// time.
///
/// Error: 1e-6 m at 100 km, 4e-9 s after a week.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SplashAnchor {
    /// Cell under the eye (x, z; low 32 bits).
    pub cell: IVec2,
    /// Place of the eye in it, in cells. Domain: [0, 1).
    pub fraction: Vec2,
    /// The present slot (low 32 bits).
    pub slot: u32,
    /// Time since it began. Units: s. Domain: [0, 0.1].
    pub since_s: f32,
}

impl SplashAnchor {
    /// The eye (world metres) at `now_s` (s, held in [0, 1e12]). What is not finite counts as the origin or as 0.
    #[must_use]
    pub fn new(eye_m: DVec3, now_s: f64) -> Self {
        let eye = LatticeEye::new(eye_m, DVec3::ZERO, SPLASH_CELL_M);
        let now = clamped(now_s, 0.0, 1e12);
        let slot = (now / SPLASH_SLOT_S).floor();
        Self {
            cell: IVec2::new(eye.cell.x, eye.cell.z),
            fraction: Vec2::new(eye.fraction.x, eye.fraction.z),
            slot: slot as u64 as u32,
            since_s: (now - slot * SPLASH_SLOT_S).clamp(0.0, SPLASH_SLOT_S) as f32,
        }
    }

    /// How old a splash of `moment` in the slot `back` slots ago is; below 0 it has not fallen yet. Units: s.
    #[must_use]
    pub fn age_s(&self, back: u32, moment: f32) -> f32 {
        self.since_s + (back as f32 - moment) * SPLASH_SLOT_S as f32
    }
}
