//! The frozen drop field: a unit-rate Poisson process per class and lattice cell, advected by the class's velocity.
//!
//! Nothing is stored per drop. In the class's moving frame drop *i* of a cell is a pure function of
//! (seed, class, cell, i); whether it exists is decided by its own rank against the local spectrum, so the sets of
//! drops at two rain rates are nested and exactly Poisson.
//!
//! # Accuracy
//! Inside a class all drops share one speed: 4–5 % rms from the speed of their own diameter (at most 11 %).

use glam::{DVec3, IVec3, Vec3};
use serde::{Deserialize, Serialize};

use super::classes::{CLASS_COUNT, REFERENCE_N0_PER_M3_MM, REFERENCE_SLOPE_PER_MM, SizeClass};
use super::spectrum::Spectrum;
use crate::error::clamped_f32;
use crate::hash::{open_unit_f32, pcg3d, unit_f32};

/// Half-width of the soft threshold at which drops appear and vanish, as a share of their rank. Units: none.
pub const SOFT_EDGE: f32 = 0.05;

/// Largest rank that is looked for: no rain fills a cell with a tenth as many drops. Units: none.
const MAX_RANK: f32 = 65_536.0;

/// Largest diameter that a threshold is asked for. Units: mm.
const LARGEST_MM: f32 = 10.0;

/// One drop in its class frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drop {
    /// Position inside the cell, in cells. Domain: [0, 1)³.
    pub position: Vec3,
    /// Units: mm.
    pub diameter_mm: f32,
    /// Rank λ in the cell's unit-rate process. Units: none.
    pub rank: f32,
}

/// The key of a cell: all randomness of its drops comes from here.
///
/// `cell`: lattice coordinates (low 32 bits count); `class` in 0..12. Any integers give a key.
///
/// Error: exact, the same integers as the published hash in 128-bit arithmetic.
#[must_use]
pub fn cell_key(seed: u64, class: u32, cell: IVec3) -> [u32; 3] {
    let stream = pcg3d([seed as u32, (seed >> 32) as u32, class]);
    pcg3d([
        stream[0] ^ cell.x as u32,
        stream[1] ^ cell.y as u32,
        stream[2] ^ cell.z as u32,
    ])
}

/// Hash of drop `index`: [rank increment, diameter, order in which laws of detail leave drops out].
///
/// Error: exact, the same integers as the published hash in 128-bit arithmetic.
#[must_use]
pub fn drop_marks(key: [u32; 3], index: u32) -> [u32; 3] {
    pcg3d([
        key[0] ^ index.wrapping_mul(0x9E37_79B9),
        key[1].wrapping_add(index),
        key[2],
    ])
}

/// Hash of drop `index`: [x, y, z] inside the cell.
///
/// Error: exact, the same integers as the published hash in 128-bit arithmetic.
#[must_use]
pub fn drop_place(key: [u32; 3], index: u32) -> [u32; 3] {
    pcg3d([
        key[1] ^ index.wrapping_mul(0x85EB_CA6B),
        key[2].wrapping_add(index),
        key[0],
    ])
}

/// Visits the drops of one cell in order of rank, up to `max_rank`.
///
/// `max_rank`: none, held in [0, 65 536], what is not a number counts as 0. Allocates nothing.
///
/// Error: places exact, ranks and diameters 1e-6 relative against the same words in double precision. Over 200 000
/// cells the chance of each count is Poisson's within five standard deviations, places and diameters are as even as
/// theirs (χ² over 256 bins) within as many.
pub fn for_each_drop(class: &SizeClass, key: [u32; 3], max_rank: f32, mut visit: impl FnMut(u32, Drop)) {
    for_each_mark(key, max_rank, |index, mark| {
        visit(index, mark.drop(class, mark.position(key, index)));
    });
}

/// What a drop is known by before anything else is worked out.
#[derive(Debug, Clone, Copy)]
pub(super) struct DropMark {
    /// As [`Drop::rank`].
    pub rank: f32,
    size: u32,
}

impl DropMark {
    /// As [`Drop::position`].
    pub fn position(self, key: [u32; 3], index: u32) -> Vec3 {
        let place = drop_place(key, index);
        Vec3::new(unit_f32(place[0]), unit_f32(place[1]), unit_f32(place[2]))
    }

    /// All of the drop at a position.
    pub fn drop(self, class: &SizeClass, position: Vec3) -> Drop {
        Drop {
            position,
            diameter_mm: class.diameter_mm(unit_f32(self.size)),
            rank: self.rank,
        }
    }
}

/// [`for_each_drop`] for those who need little of most drops.
pub(super) fn for_each_mark(key: [u32; 3], max_rank: f32, mut visit: impl FnMut(u32, DropMark)) {
    let max_rank = clamped_f32(max_rank, 0.0, MAX_RANK);
    let mut rank = 0.0;
    let mut index = 0;
    loop {
        let marks = drop_marks(key, index);
        rank -= crate::ops::lnf(open_unit_f32(marks[0]));
        if rank >= max_rank {
            return;
        }
        visit(index, DropMark { rank, size: marks[1] });
        index += 1;
    }
}

/// Which drops of a class exist at one rain state: rank below m_k N(D)/n_ref(D).
///
/// Error: the threshold 6e-6 relative against m_k N(D)/n_ref(D), the presence 6e-5, its mean over ranks 6e-6 of the
/// threshold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Threshold {
    /// m_k N₀/N_ref. Units: none.
    scale: f32,
    /// 2 − Λ: slope of ln(N/n_ref). Units: mm⁻¹.
    slope: f32,
    /// Smallest and largest threshold in the class. Units: none.
    min: f32,
    max: f32,
}

impl Threshold {
    /// The threshold of `class` for a spectrum.
    #[must_use]
    pub fn new(class: &SizeClass, spectrum: &Spectrum) -> Self {
        let scale = (class.reference_count * spectrum.n0_per_m3_mm / REFERENCE_N0_PER_M3_MM) as f32;
        let slope = (REFERENCE_SLOPE_PER_MM - spectrum.slope_per_mm) as f32;
        let at = |d: f64| scale * crate::ops::expf(slope * d as f32);
        Self {
            scale,
            slope,
            min: at(class.min_mm).min(at(class.max_mm)),
            max: at(class.min_mm).max(at(class.max_mm)),
        }
    }

    /// ln of the threshold at a diameter of 0, and its slope (mm⁻¹).
    pub(super) fn ln_line(&self) -> [f32; 2] {
        [crate::ops::lnf(self.scale), self.slope]
    }

    /// The threshold of `class` with this line.
    pub(super) fn of_ln_line(class: &SizeClass, [ln_scale, slope]: [f32; 2]) -> Self {
        let at = |d: f64| crate::ops::expf(ln_scale + slope * d as f32);
        Self {
            scale: crate::ops::expf(ln_scale),
            slope,
            min: at(class.min_mm).min(at(class.max_mm)),
            max: at(class.min_mm).max(at(class.max_mm)),
        }
    }

    /// The rank at which a drop of this diameter is half there. Units: none.
    ///
    /// `diameter_mm` in mm, held in [0, 10]; what is not a number counts as 0.
    #[must_use]
    pub fn at(&self, diameter_mm: f32) -> f32 {
        self.scale * crate::ops::expf(self.slope * clamped_f32(diameter_mm, 0.0, LARGEST_MM))
    }

    /// Rank beyond which no drop of the class exists, soft edge included.
    #[must_use]
    pub fn scan_limit(&self) -> f32 {
        self.max * (1.0 + SOFT_EDGE)
    }

    /// Threshold at a diameter of 0, and the slope of its ln. Units: none, mm⁻¹.
    #[must_use]
    pub fn terms(&self) -> [f32; 2] {
        [self.scale, self.slope]
    }

    /// Up to this rank every drop of the class is there wholly, whatever its diameter; a little lower, for rounding.
    #[must_use]
    pub fn whole_limit(&self) -> f32 {
        self.min * (1.0 - 1.002 * SOFT_EDGE)
    }

    /// Presence of a drop, 0…1: 1 inside, a soft ramp at its own threshold, so that nothing pops when rain changes.
    /// The mean over ranks is exactly the threshold. A rank that is not a number is not there.
    #[must_use]
    pub fn presence(&self, drop: &Drop) -> f32 {
        let limit = self.at(drop.diameter_mm);
        if limit <= 0.0 || drop.rank.is_nan() {
            return 0.0;
        }
        (0.5 + (1.0 - drop.rank / limit) / (2.0 * SOFT_EDGE)).clamp(0.0, 1.0)
    }
}

/// Where each class's frame stands: the integral of its velocity.
///
/// Error: 1e-4 m after a day at 60 steps a second (a day's way is 200 to 800 km), 1e-15 of the way for one step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FieldMotion {
    /// ∫ u_k dt per class. Units: m.
    pub offset_m: [DVec3; CLASS_COUNT],
    /// u_k: wind plus fall. Units: m/s.
    pub velocity_m_s: [DVec3; CLASS_COUNT],
}

impl Default for FieldMotion {
    fn default() -> Self {
        let mut motion = Self {
            offset_m: [DVec3::ZERO; CLASS_COUNT],
            velocity_m_s: [DVec3::ZERO; CLASS_COUNT],
        };
        motion.set_velocity(DVec3::ZERO, crate::constants::AIR_DENSITY);
        motion
    }
}

impl FieldMotion {
    /// Sets every class's velocity from the wind (m/s, where the air goes) and the air's density (kg/m³).
    ///
    /// A wind that is not finite counts as calm; the density as in [`SizeClass::speed_in`].
    pub fn set_velocity(&mut self, wind_m_s: DVec3, air_density: f64) {
        let wind_m_s = if wind_m_s.is_finite() { wind_m_s } else { DVec3::ZERO };
        for (velocity, class) in self.velocity_m_s.iter_mut().zip(SizeClass::all()) {
            *velocity = wind_m_s - DVec3::Y * class.speed_in(air_density);
        }
    }

    /// Moves the field by `dt_s` (s, either sign; nothing happens where it is not finite) at the current velocity.
    pub fn advance(&mut self, dt_s: f64) {
        if !dt_s.is_finite() {
            return;
        }
        for (offset, velocity) in self.offset_m.iter_mut().zip(&self.velocity_m_s) {
            *offset += *velocity * dt_s;
        }
    }

    /// The same field `dt_s` later, state untouched.
    #[must_use]
    pub fn after(&self, dt_s: f64) -> Self {
        let mut later = *self;
        later.advance(dt_s);
        later
    }
}

/// The eye in a class's lattice: integer cell and fraction, so that single precision suffices at any distance.
///
/// Error: cell exact, fraction 6e-8 of a cell against (eye − offset)/edge in double precision: 1e-6 m at 100 km after a
/// day.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LatticeEye {
    /// Cell that holds the eye (low 32 bits).
    pub cell: IVec3,
    /// Position inside it, in cells. Domain: [0, 1).
    pub fraction: Vec3,
}

impl LatticeEye {
    /// The eye (world metres) seen from a class frame that has moved by `offset_m`.
    ///
    /// `cell_m`: edge of a cell, m > 0. What is not finite counts as the frame's origin.
    #[must_use]
    pub fn new(eye_m: DVec3, offset_m: DVec3, cell_m: f64) -> Self {
        let p = (eye_m - offset_m) / cell_m;
        let p = if p.is_finite() { p } else { DVec3::ZERO };
        let floor = p.floor();
        let wrap = |v: f64| (v as i64) as i32;
        Self {
            cell: IVec3::new(wrap(floor.x), wrap(floor.y), wrap(floor.z)),
            // x − floor(x) may round up to 1 for tiny negative x.
            fraction: (p - floor).as_vec3().min(Vec3::splat(1.0 - f32::EPSILON / 2.0)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rainfall::Distribution;

    fn spectrum(r: f64) -> Spectrum {
        Spectrum::new(Distribution::MarshallPalmer, r).unwrap()
    }

    /// Sum of presence × f(D) over a block of cells, per m³.
    fn density(class_index: usize, r: f64, f: impl Fn(f64) -> f64) -> f64 {
        let class = SizeClass::new(class_index);
        let threshold = Threshold::new(&class, &spectrum(r));
        let n = 40;
        let mut sum = 0.0;
        for x in 0..n {
            for y in 0..n {
                for z in 0..n {
                    let key = cell_key(7, class_index as u32, IVec3::new(x - 20, y, z));
                    for_each_drop(&class, key, threshold.scan_limit(), |_, drop| {
                        sum += f64::from(threshold.presence(&drop)) * f(f64::from(drop.diameter_mm));
                    });
                }
            }
        }
        sum / (f64::from(n * n * n) * class.cell_m.powi(3))
    }

    #[test]
    fn number_and_area_follow_the_spectrum_at_every_rate() {
        for r in [1.0, 5.0, 25.0, 100.0] {
            let s = spectrum(r);
            for k in [0, 3, 6, 8] {
                let class = SizeClass::new(k);
                let number = s.moment(0, class.min_mm, class.max_mm);
                let expected_drops = number * 64_000.0 * class.cell_m.powi(3);
                // Four standard deviations of a Poisson count.
                let bound = 4.0 / expected_drops.sqrt();
                let n = density(k, r, |_| 1.0);
                assert!((n / number - 1.0).abs() < bound, "R {r} class {k}: {n} {number}");
                let area = s.moment(2, class.min_mm, class.max_mm);
                let a = density(k, r, |d| d * d);
                assert!((a / area - 1.0).abs() < 1.2 * bound, "R {r} class {k}: {a} {area}");
            }
        }
    }

    #[test]
    fn counts_are_poisson() {
        let class = SizeClass::new(4);
        let threshold = Threshold::new(&class, &spectrum(25.0));
        let (mut sum, mut square, mut cells) = (0.0, 0.0, 0.0);
        for i in 0..200_000 {
            let key = cell_key(3, 4, IVec3::new(i % 64, (i / 64) % 64, i / 4096));
            let mut count = 0.0;
            for_each_drop(&class, key, threshold.scan_limit(), |_, drop| {
                if drop.rank < threshold.at(drop.diameter_mm) {
                    count += 1.0;
                }
            });
            sum += count;
            square += count * count;
            cells += 1.0;
        }
        let mean: f64 = sum / cells;
        let variance = square / cells - mean * mean;
        assert!((variance / mean - 1.0).abs() < 0.01, "{}", variance / mean);
    }

    #[test]
    fn heavier_rain_keeps_every_drop() {
        let (light, heavy) = (spectrum(2.0), spectrum(40.0));
        for k in 0..CLASS_COUNT {
            let class = SizeClass::new(k);
            let (a, b) = (Threshold::new(&class, &light), Threshold::new(&class, &heavy));
            for i in 0..200 {
                let key = cell_key(11, k as u32, IVec3::new(i, -i, 3 * i));
                for_each_drop(&class, key, b.scan_limit(), |_, drop| {
                    assert!(b.presence(&drop) >= a.presence(&drop));
                });
            }
        }
    }

    #[test]
    fn eye_is_exact_far_from_the_origin_and_after_days() {
        let class = SizeClass::new(5);
        let mut motion = FieldMotion::default();
        motion.advance(86_400.0);
        let eye = DVec3::new(100_000.123, 1.7, -100_000.456);
        let lattice = LatticeEye::new(eye, motion.offset_m[5], class.cell_m);
        let back = (lattice.cell.as_dvec3() + lattice.fraction.as_dvec3()) * class.cell_m + motion.offset_m[5];
        assert!((back - eye).length() < 1e-6, "{back}");
        let tiny = LatticeEye::new(DVec3::splat(-1e-30), DVec3::ZERO, 1.0);
        assert!(tiny.fraction.max_element() < 1.0);
    }

    #[test]
    fn dry_has_no_drop() {
        let class = SizeClass::new(0);
        let threshold = Threshold::new(&class, &spectrum(0.0));
        let mut any = false;
        for i in 0..1000 {
            for_each_drop(
                &class,
                cell_key(1, 0, IVec3::splat(i)),
                threshold.scan_limit(),
                |_, _| any = true,
            );
        }
        assert!(!any);
    }
}
