//! The rain container: the part of the drop field that one view draws singly.
//!
//! It follows the eye, reaches further ahead when the eye moves fast, and is culled to the frustum twice: its lattice
//! cells first, then each drop. How far a drop of diameter D is drawn is z_s(D) = min(κ z₁(D), cap): the level set of
//! equal contrast, so every budget κ draws the drops that matter most.

use glam::swizzles::Vec3Swizzles;
use glam::{DVec3, IVec3, Vec3, Vec4};

use super::classes::{SizeClass, visible_range_m};
use super::detail::DetailLaw;
use super::field::{FieldMotion, LatticeEye, Threshold, cell_key, drop_marks, drop_place, for_each_mark};
use super::follow::{Follow, FollowSettings};
use super::lead::LeadVolume;
use super::local::{CellRain, LocalRain};
use super::spectrum::Spectrum;
use super::view_cells::{ClassCells, ViewCells};
use crate::error::clamped;
use crate::hash::unit_f32;

/// Nothing is drawn singly beyond this range. Units: m.
pub const RANGE_CAP_M: f64 = 15.0;

/// Drops fade out between 0.8 and this multiple of their range. Units: none.
pub const FADE_END: f64 = 1.2;

/// How far ahead the container reaches per m/s of the eye's speed. Units: s. Chosen by eye.
pub const LEAD_TIME_S: f64 = 0.15;

/// The container never reaches further ahead than this. Units: m.
pub const LEAD_CAP_M: f64 = 8.0;

/// A view that turns further than this in one exposure lacks some of the streaks that leave it. Units: rad.
pub const TURN_CAP_RAD: f64 = 0.1;

/// Lattice coordinates relative to the eye's cell lie in [−512, 511].
pub(super) const CELL_BIAS: i32 = 512;

/// A view as the container needs it. World metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RainViewVolume {
    /// The eye.
    pub eye_m: DVec3,
    /// The eye's velocity. Units: m/s.
    pub eye_velocity_m_s: DVec3,
    /// Four side planes through the eye (inward unit normals, relative to the eye: n·x ≥ −w). `w` in metres.
    pub side_planes: [Vec4; 4],
    /// Focal length in pixels: half the height over tan of half the vertical field of view.
    pub focal_px: f64,
    /// Solid angle of the view. Units: sr.
    pub solid_angle_sr: f64,
    /// Shutter time. Units: s.
    pub exposure_s: f64,
    /// How far the view turns in it. Units: rad, held in [0, [`TURN_CAP_RAD`]].
    pub turn_rad: f64,
    /// A view without perspective. The eye then stands at one side of the picture, amid the rain that is drawn, and `focal_px` is
    /// what a picture has for which a metre at [`RANGE_CAP_M`] is as large.
    pub parallel: Option<ParallelView>,
}

/// A view whose rays are parallel. World metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParallelView {
    /// From the eye to the other side of the picture, square to its rays. Units: m.
    pub across_m: DVec3,
    /// Height of the picture. Units: m.
    pub height_m: f64,
    /// Along the rays, away from the viewer, unit.
    pub ahead: DVec3,
}

impl RainViewVolume {
    /// How far from the eye (or its lead) a diameter is drawn at a quality κ: [`DrawRange::at`]. Without perspective all drops of a
    /// diameter are as plain: those are drawn to [`RANGE_CAP_M`] that a view with perspective would draw so far, and no others.
    /// `kappa`: none; `diameter_mm` in mm. Units: m, in [0, 15].
    ///
    /// Error: as [`DrawRange::at`]; without perspective ten times that.
    #[must_use]
    pub fn drawn_m(&self, kappa: f64, diameter_mm: f64) -> f64 {
        let range = DrawRange::of(self, kappa).at(diameter_mm);
        if self.parallel.is_some() {
            RANGE_CAP_M * clamped(10.0 * range / RANGE_CAP_M - 9.0, 0.0, 1.0)
        } else {
            range
        }
    }

    /// How much more a view holds within `reach_m` (m) because it moves: volume within reach of its lead, over that within
    /// reach of the eye. Units: none. 1 in a view that stands still; planes that are none count as no view, and give 1.
    ///
    /// Error: `6e-2` against the volume while the lead is no longer than six times the reach, a factor of three beyond.
    #[must_use]
    pub fn lead_growth(&self, reach_m: f64) -> f64 {
        LeadVolume::of(self).map_or(1.0, |lead| lead.growth(reach_m))
    }
}

/// One drop to draw: 8 bytes. The GPU makes the rest again from the same hashes.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct DropRecord {
    /// Cell relative to the eye's cell, 10 bits each for x, y, z, biased by 512.
    pub cell: u32,
    /// Class (4 bits), index in the cell (12 bits), presence (16 bits, unorm).
    pub drop: u32,
}

/// How far each diameter is drawn: κ and the view's constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawRange {
    /// Quality κ: multiple of the one-step contrast range. Units: none.
    pub kappa: f64,
    /// Units: px.
    pub focal_px: f64,
    /// Units: s.
    pub exposure_s: f64,
}

impl DrawRange {
    /// That of a view at a quality.
    #[must_use]
    pub fn of(view: &RainViewVolume, kappa: f64) -> Self {
        Self {
            kappa,
            focal_px: view.focal_px,
            exposure_s: view.exposure_s,
        }
    }

    /// z_s(D). `diameter_mm` in mm. Units: m, in [0, 15].
    ///
    /// A quality that is not above 0 draws nothing; the rest as [`visible_range_m`].
    ///
    /// Error: 1e-13 relative above 0.1 mm.
    #[must_use]
    pub fn at(&self, diameter_mm: f64) -> f64 {
        let range = self.kappa * visible_range_m(diameter_mm, self.focal_px, self.exposure_s);
        if range > 0.0 { range.min(RANGE_CAP_M) } else { 0.0 }
    }
}

impl ParallelView {
    /// Volume in the picture within `reach_m` (m) of the line across it. Units: m³.
    fn volume_m3(&self, reach_m: f64) -> f64 {
        let half = clamped(0.5 * self.height_m, 0.0, reach_m);
        let chord = (reach_m * reach_m - half * half).max(0.0).sqrt();
        let section = 2.0 * (half * chord + reach_m * reach_m * libm::asin(half / reach_m.max(1e-9)));
        let across = self.across_m.length();
        if across.is_finite() { across * section } else { 0.0 }
    }
}

/// Expected number of drops drawn at quality `kappa` (fade range included): Ω/3 ∫ N (1.2 z_s)³ g dD over the classes, where
/// g is what a view that moves holds more ([`RainViewVolume::lead_growth`]).
///
/// `kappa`: none; `view` gives Ω (sr, held in [0, 4π]), focal length, exposure, velocity and planes. What is not a number counts as 0.
/// Two panels a class, each with the range of its middle. Units: none.
///
/// Error: 1.6 % against the integral over diameters; drops beside the view whose streaks reach in come on top, up to 10 % in a
/// view of 60° that stands still, up to 30 % at 36 m/s; without perspective 25 % in all.
#[must_use]
pub fn expected_drops(spectrum: &Spectrum, view: &RainViewVolume, kappa: f64) -> f64 {
    expected_in(spectrum, view, LeadVolume::of(view).as_ref(), kappa)
}

fn expected_in(spectrum: &Spectrum, view: &RainViewVolume, lead: Option<&LeadVolume>, kappa: f64) -> f64 {
    let solid_angle = clamped(view.solid_angle_sr, 0.0, 4.0 * core::f64::consts::PI);
    let mut sum = 0.0;
    for class in SizeClass::all() {
        // Two panels a class: the range changes by a third inside one.
        for half in 0..2 {
            let middle = 0.5 * (class.min_mm + class.max_mm);
            let (a, b) = if half == 0 {
                (class.min_mm, middle)
            } else {
                (middle, class.max_mm)
            };
            let reach = FADE_END * view.drawn_m(kappa, 0.5 * (a + b));
            let number = spectrum.moment(0, a, b);
            sum += match &view.parallel {
                Some(parallel) => number * parallel.volume_m3(reach),
                None => {
                    number * solid_angle / 3.0 * reach * reach * reach * lead.map_or(1.0, |lead| lead.growth(reach))
                }
            };
        }
    }
    sum
}

/// The quality κ at which a view draws `budget` drops, in [0, 64]; 64 when the budget is never reached.
///
/// Bisection on the class table; units: none. A budget that is not above 0, or not a number, gives 0.
///
/// Error: 1e-13 against the root of [`expected_drops`], which gives the budget back to 1e-8 relative from a millionth
/// of a drop on; the rest is that of [`expected_drops`].
#[must_use]
pub fn quality_for_budget(spectrum: &Spectrum, view: &RainViewVolume, budget: f64) -> f64 {
    const MAX: f64 = 64.0;
    let lead = LeadVolume::of(view);
    let expected_drops = |kappa| expected_in(spectrum, view, lead.as_ref(), kappa);
    if expected_drops(MAX) <= budget {
        return MAX;
    }
    let (mut low, mut high) = (0.0, MAX);
    for _ in 0..50 {
        let mid = 0.5 * (low + high);
        if expected_drops(mid) < budget {
            low = mid;
        } else {
            high = mid;
        }
    }
    low
}

/// Where each class's lattice stands for a view: what the GPU needs beside the records.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClassPlacement {
    /// The eye in the class's lattice.
    pub eye: LatticeEye,
    /// The class's velocity. Units: m/s.
    pub velocity_m_s: Vec3,
}

/// What leaves drops out of a container, beside range and view.
#[derive(Debug, Clone, Copy, Default)]
pub struct Thinning<'a> {
    /// The rain from place to place: a drop is there if it says so at the drop's own place. `None`: everywhere the rain of
    /// the spectrum.
    pub local: Option<&'a LocalRain<'a>>,
    /// A container that follows the view: a drop is there as far as it is inside. `None`: there is none.
    pub region: Option<(&'a Follow, &'a FollowSettings)>,
    /// The law by which fewer, larger drops stand for the field, by distance over [`RANGE_CAP_M`]; whoever draws them
    /// scales them ([`DetailLaw::size`]). `None`: every drop, of its own size.
    pub detail: Option<DetailLaw>,
}

/// Share over which a drop fades that a law is about to leave out, of the law's number.
const FADE: f32 = 0.1;

/// Presence of a drop with a mark in [0, 1] where a share of the drops is kept.
///
/// Error: its mean over marks is the share, up to 1/(1 + FADE/2); 0.0125 less at a share of 1.
fn thinned(share: f32, mark: f32) -> f32 {
    if share > 0.0 {
        ((share * (1.0 + 0.5 * FADE) - mark) / (share * FADE)).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// The drops of one view and what is needed to place them. Kept between frames so that nothing is allocated.
#[derive(Debug, Default, Clone)]
pub struct Container {
    /// Drops to draw, in class order.
    pub records: Vec<DropRecord>,
    /// One entry a class.
    pub classes: Vec<ClassPlacement>,
    /// Lattice cells visited and kept by the last [`Container::fill`].
    pub cells_visited: usize,
    /// Cells that reached into the view.
    pub cells_kept: usize,
}

impl Container {
    /// Fills the container for one view. At most `max_drops` records are written; a cut is reported by `false`.
    ///
    /// Error: the drops are those of [`for_each_drop`](super::for_each_drop) within reach and view, save within 1e-4 m of their borders;
    /// positions 1e-5 m, presence 1e-4.
    ///
    /// An eye that is not finite stands at the origin of every class, one whose velocity is not finite stands still; a
    /// side or an exposure that is not a number sees nothing.
    ///
    /// Allocates only where it holds more drops than ever before.
    #[must_use = "false says that drops were left out"]
    pub fn fill(
        &mut self,
        seed: u64,
        spectrum: &Spectrum,
        motion: &FieldMotion,
        view: &RainViewVolume,
        kappa: f64,
        max_drops: usize,
    ) -> bool {
        self.fill_local(seed, spectrum, motion, view, kappa, max_drops, &Thinning::default())
    }

    /// [`Container::fill`] with fewer drops: see [`Thinning`]. With its default bit for bit as [`Container::fill`].
    ///
    /// Error: as [`Container::fill`]; presence 1e-2 on a drop's own soft edge.
    #[must_use = "false says that drops were left out"]
    pub fn fill_local(
        &mut self,
        seed: u64,
        spectrum: &Spectrum,
        motion: &FieldMotion,
        view: &RainViewVolume,
        kappa: f64,
        max_drops: usize,
        thinning: &Thinning,
    ) -> bool {
        self.records.clear();
        self.classes.clear();
        (self.cells_visited, self.cells_kept) = (0, 0);
        let cells = ViewCells::new(spectrum, motion, view, kappa, thinning.local.is_some());
        let mut complete = true;
        for (k, (class, cells_of)) in SizeClass::all().iter().zip(&cells.classes).enumerate() {
            self.classes.push(cells_of.placement);
            complete &= self.fill_class(
                seed, k, class, spectrum, view, &cells, cells_of, kappa, max_drops, thinning,
            );
        }
        complete
    }

    fn fill_class(
        &mut self,
        seed: u64,
        k: usize,
        class: &SizeClass,
        spectrum: &Spectrum,
        view: &RainViewVolume,
        cells: &ViewCells,
        of: &ClassCells,
        kappa: f64,
        max_drops: usize,
        thinning: &Thinning,
    ) -> bool {
        let Thinning { local, region, detail } = *thinning;
        let (lead, placement, reach) = (cells.lead_m, &of.placement, of.reach_m);
        let everywhere = CellRain::Even(Threshold::new(class, spectrum));
        let eye = if view.eye_m.is_finite() {
            view.eye_m
        } else {
            DVec3::ZERO
        };
        let world = |place: Vec3| eye.xz() + place.xz().as_dvec2();
        let cell_m = class.cell_m as f32;
        let bound = IVec3::splat(CELL_BIAS);
        let half = 0.5 * cell_m;
        let cell_radius = half * 3.0_f32.sqrt();
        let high = of.low + of.side.as_ivec3();
        for z in of.low.z..high.z {
            for y in of.low.y..high.y {
                for x in of.low.x..high.x {
                    self.cells_visited += 1;
                    let cell = IVec3::new(x, y, z);
                    let centre = (cell.as_vec3() - placement.eye.fraction) * cell_m + half;
                    if !touches(&of.sides, centre, half) {
                        continue;
                    }
                    let nearest = if lead == Vec3::ZERO {
                        centre.clamp(Vec3::splat(-half), Vec3::splat(half)).distance(centre)
                    } else {
                        to_segment(centre, lead) - cell_radius
                    };
                    if nearest > reach {
                        continue;
                    }
                    let rain = local.map_or(everywhere, |local| {
                        local.within(k, world(centre), f64::from(half) * core::f64::consts::SQRT_2)
                    });
                    let scan_limit = match rain {
                        CellRain::Dry => continue,
                        CellRain::Even(threshold) => threshold.scan_limit(),
                        CellRain::Uneven(limit) => limit,
                    };
                    self.cells_kept += 1;
                    let key = cell_key(seed, k as u32, placement.eye.cell.wrapping_add(cell));
                    let corner = centre - half;
                    let all_seen = inside(&of.sides, centre, -cell_radius);
                    let whole = match rain {
                        CellRain::Even(threshold) => threshold.whole_limit(),
                        _ => -1.0,
                    };
                    let mut full = false;
                    for_each_mark(key, scan_limit, |index, mark| {
                        // What tells most drops comes first, and what takes long only for drops that it has to tell.
                        let place = mark.position(key, index);
                        let position = corner + place * cell_m;
                        let distance = to_segment(position, lead);
                        if distance > reach || !(all_seen || inside(&of.sides, position, 0.0)) {
                            return;
                        }
                        let mut presence = 1.0;
                        if distance > of.least_reach_m || mark.rank > whole {
                            let drop = mark.drop(class, place);
                            if distance > (FADE_END * view.drawn_m(kappa, f64::from(drop.diameter_mm))) as f32 {
                                return;
                            }
                            presence = match (rain, local) {
                                (CellRain::Even(threshold), _) => threshold.presence(&drop),
                                (CellRain::Uneven(_), Some(local)) => local.presence(k, world(position), &drop),
                                _ => 0.0,
                            };
                            if presence <= 0.0 {
                                return;
                            }
                        }
                        let presence = match region {
                            Some((follow, settings)) => {
                                presence * follow.weight(settings, eye + position.as_dvec3()) as f32
                            }
                            None => presence,
                        };
                        let presence = match detail {
                            Some(law) => {
                                let d = f64::from(position.length()) / RANGE_CAP_M;
                                presence * thinned(law.number(d) as f32, unit_f32(drop_marks(key, index)[2]))
                            }
                            None => presence,
                        };
                        if presence <= 0.0 {
                            return;
                        }
                        if self.records.len() >= max_drops || index > 0xFFF {
                            full = true;
                            return;
                        }
                        let biased = cell + bound;
                        self.records.push(DropRecord {
                            cell: biased.x as u32 | (biased.y as u32) << 10 | (biased.z as u32) << 20,
                            drop: k as u32 | index << 4 | ((presence * 65_535.0 + 0.5) as u32) << 16,
                        });
                    });
                    if full {
                        return false;
                    }
                }
            }
        }
        true
    }
}

impl DropRecord {
    /// Position relative to the eye, metres: what the GPU computes from the record.
    ///
    /// Error: 1e-5 m.
    #[must_use]
    pub fn position(&self, seed: u64, placement: &[ClassPlacement]) -> Vec3 {
        let k = (self.drop & 15) as usize;
        let class = &placement[k];
        let cell = IVec3::new(
            (self.cell & 1023) as i32,
            (self.cell >> 10 & 1023) as i32,
            (self.cell >> 20 & 1023) as i32,
        ) - IVec3::splat(CELL_BIAS);
        let key = cell_key(seed, k as u32, class.eye.cell.wrapping_add(cell));
        let place = drop_place(key, self.drop >> 4 & 0xFFF);
        let inside = Vec3::new(unit_f32(place[0]), unit_f32(place[1]), unit_f32(place[2]));
        (cell.as_vec3() - class.eye.fraction + inside) * super::classes::CLASS_CELL_M[k] as f32
    }
}

/// Distance from `p` to the segment from the eye (origin) to `lead`.
fn to_segment(p: Vec3, lead: Vec3) -> f32 {
    let square = lead.length_squared();
    let t = if square > 0.0 {
        (p.dot(lead) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (p - lead * t).length()
}

/// Whether anything of a cube lies inside.
fn touches(planes: &[Vec4; 4], centre: Vec3, half: f32) -> bool {
    planes.iter().all(|plane| {
        let n = plane.truncate();
        n.dot(centre) + plane.w >= -half * n.abs().element_sum()
    })
}

fn inside(planes: &[Vec4; 4], p: Vec3, margin: f32) -> bool {
    planes.iter().all(|plane| plane.truncate().dot(p) + plane.w >= -margin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rainfall::Distribution;

    /// 60° vertical, 16:9, looking along −Z.
    fn view() -> RainViewVolume {
        let (ty, aspect) = (30.0_f32.to_radians().tan(), 16.0 / 9.0);
        let tx = ty * aspect;
        let plane = |n: Vec3| n.normalize().extend(0.0);
        let ratio = f64::from(tx * ty) / (f64::from(1.0 + tx * tx) * f64::from(1.0 + ty * ty)).sqrt();
        RainViewVolume {
            eye_m: DVec3::new(12.3, 1.7, -4.5),
            eye_velocity_m_s: DVec3::ZERO,
            side_planes: [
                plane(Vec3::new(1.0, 0.0, -tx)),
                plane(Vec3::new(-1.0, 0.0, -tx)),
                plane(Vec3::new(0.0, 1.0, -ty)),
                plane(Vec3::new(0.0, -1.0, -ty)),
            ],
            focal_px: 623.5,
            solid_angle_sr: 4.0 * ratio.asin(),
            exposure_s: 1.0 / 60.0,
            turn_rad: 0.0,
            parallel: None,
        }
    }

    fn spectrum(r: f64) -> Spectrum {
        Spectrum::new(Distribution::MarshallPalmer, r).unwrap()
    }

    #[test]
    fn quality_matches_the_published_table() {
        for (r, kappa) in [(5.0, 2.0), (25.0, 1.10), (100.0, 0.62)] {
            let ours = quality_for_budget(&spectrum(r), &view(), 31_000.0);
            assert!((ours / kappa - 1.0).abs() < 0.06, "R {r}: {ours}");
        }
    }

    #[test]
    fn the_container_holds_about_its_budget() {
        let mut container = Container::default();
        for r in [1.0, 5.0, 25.0, 100.0] {
            let s = spectrum(r);
            let kappa = quality_for_budget(&s, &view(), 30_000.0);
            assert!(container.fill(1, &s, &FieldMotion::default(), &view(), kappa, 1 << 20));
            let drawn = container.records.len() as f64;
            let expected = expected_drops(&s, &view(), kappa);
            // Those whose streaks reach in from beside the view add some.
            assert!(
                drawn > 0.9 * expected && drawn < 1.1 * expected,
                "R {r}: {drawn} of {expected}"
            );
        }
    }

    #[test]
    fn a_view_that_moves_holds_about_its_budget_too() {
        let mut container = Container::default();
        let (s, mut view) = (spectrum(35.0), view());
        for velocity in [
            DVec3::new(0.0, 0.0, -5.0),
            DVec3::new(0.0, 0.0, -36.0),
            DVec3::new(14.0, 0.0, 0.0),
            DVec3::new(0.0, 0.0, 36.0),
            DVec3::new(-20.0, 2.0, -25.0),
        ] {
            view.eye_velocity_m_s = velocity;
            let kappa = quality_for_budget(&s, &view, 30_000.0);
            assert!(container.fill(1, &s, &FieldMotion::default(), &view, kappa, 1 << 20));
            let drawn = container.records.len() as f64 / 30_000.0;
            // Streaks are as long as the way of the eye, and more of them reach in from beside the view.
            assert!((0.95..1.45).contains(&drawn), "{velocity}: {drawn} of the budget");
        }
    }

    #[test]
    fn records_place_drops_inside_the_view_volume() {
        let mut container = Container::default();
        assert!(container.fill(5, &spectrum(25.0), &FieldMotion::default(), &view(), 1.1, 1 << 20));
        assert!(container.records.len() > 10_000);
        for record in &container.records {
            let p = record.position(5, &container.classes);
            assert!(p.length() < (FADE_END * RANGE_CAP_M) as f32 + 0.01);
            assert!(inside(&view().side_planes, p, 0.3), "{p}");
        }
    }

    #[test]
    fn two_views_see_the_same_drops() {
        let mut a = Container::default();
        let mut b = Container::default();
        let mut other = view();
        other.eye_m += DVec3::new(0.4, 0.1, -0.3);
        let motion = FieldMotion::default().after(1234.5);
        assert!(a.fill(5, &spectrum(25.0), &motion, &view(), 1.1, 1 << 20));
        assert!(b.fill(5, &spectrum(25.0), &motion, &other, 1.1, 1 << 20));
        let world = |c: &Container, eye: DVec3| -> std::collections::BTreeSet<[i64; 3]> {
            c.records
                .iter()
                .map(|r| {
                    let p = r.position(5, &c.classes).as_dvec3() + eye;
                    [p.x, p.y, p.z].map(|v| (v * 2000.0).round() as i64)
                })
                .collect()
        };
        let (wa, wb) = (world(&a, view().eye_m), world(&b, other.eye_m));
        let near = |set: &std::collections::BTreeSet<[i64; 3]>, p: &[i64; 3]| {
            (-1..=1).any(|x| (-1..=1).any(|y| (-1..=1).any(|z| set.contains(&[p[0] + x, p[1] + y, p[2] + z]))))
        };
        let shared = wa.iter().filter(|p| near(&wb, p)).count();
        // The volumes overlap but for a rim of 0.5 m.
        assert!(shared * 10 > wa.len() * 7, "{shared} of {}", wa.len());
    }

    #[test]
    fn a_fast_eye_sees_further_ahead_and_loses_nothing() {
        let mut still = Container::default();
        let mut fast = Container::default();
        let mut moving = view();
        moving.eye_velocity_m_s = DVec3::new(0.0, 0.0, -36.0);
        assert!(still.fill(5, &spectrum(25.0), &FieldMotion::default(), &view(), 0.6, 1 << 20));
        assert!(fast.fill(5, &spectrum(25.0), &FieldMotion::default(), &moving, 0.6, 1 << 20));
        let furthest = |c: &Container| {
            c.records
                .iter()
                .map(|r| -r.position(5, &c.classes).z)
                .fold(0.0, f32::max)
        };
        assert!(furthest(&fast) > furthest(&still) + 3.0);
        let all: std::collections::BTreeSet<(u32, u32)> = fast.records.iter().map(|r| (r.cell, r.drop)).collect();
        assert!(still.records.iter().all(|r| all.contains(&(r.cell, r.drop))));
    }

    #[test]
    fn a_cut_is_reported() {
        let mut container = Container::default();
        assert!(!container.fill(5, &spectrum(100.0), &FieldMotion::default(), &view(), 1.0, 1000));
        assert_eq!(container.records.len(), 1000);
    }

    #[test]
    fn dry_fills_nothing() {
        let mut container = Container::default();
        assert!(container.fill(5, &spectrum(0.0), &FieldMotion::default(), &view(), 1.0, 1000));
        assert!(container.records.is_empty());
    }
}
