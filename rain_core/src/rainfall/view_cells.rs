//! Which cells of the drop field's lattices may hold drops of a view: for each class the smallest block about those within
//! reach and inside the view's side planes.

use glam::{DVec3, IVec3, UVec3, Vec3, Vec4};

use super::classes::{CLASS_COUNT, SizeClass};
use super::container::{CELL_BIAS, ClassPlacement, FADE_END, RainViewVolume, TURN_CAP_RAD};
use super::field::{FieldMotion, LatticeEye};
use super::lead::lead_of;
use super::spectrum::Spectrum;
use crate::error::clamped;

/// Cells of one class's lattice that may hold drops of a view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClassCells {
    /// Where the lattice stands.
    pub placement: ClassPlacement,
    /// The lowest of them, from the eye's cell.
    pub low: IVec3,
    /// How many along each axis: none of a class that has no drops.
    pub side: UVec3,
    /// The largest drop of the class is drawn so far from the lead, fade included. Units: m.
    pub reach_m: f32,
    /// Every drop of the class is drawn so far; a little less, for rounding. Units: m.
    pub least_reach_m: f32,
    /// The view's side planes, each moved out by as much as streaks reach in over it: whose drop lies outside of one does
    /// not show.
    pub sides: [Vec4; 4],
}

/// Streaks are wider than the segment that a point draws, and rounding moves them. Units: m.
const SLACK_M: f32 = 0.01;

/// The side planes of a view, moved out for streaks whose drops lie beyond them.
///
/// `streak_m`: from where a drop was when the shutter opened to where it is, relative to the eye. A streak shows through a
/// plane n·x + w ≥ 0 if one of its ends is inside: n·p or, as the view has turned by less than τ since, n·(p − s) + τ |p − s|.
fn moved_out(view: &RainViewVolume, streak_m: Vec3, furthest_m: f32) -> [Vec4; 4] {
    let turn = clamped(view.turn_rad, 0.0, TURN_CAP_RAD) as f32;
    view.side_planes.map(|plane| {
        let before = turn * (furthest_m + streak_m.length()) - plane.truncate().dot(streak_m);
        plane + Vec4::W * (before.max(0.0) + SLACK_M)
    })
}

/// Which cells of all classes may hold drops of a view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewCells {
    /// By class.
    pub classes: [ClassCells; CLASS_COUNT],
    /// Distances count from the segment between the eye and this, ahead of a fast one, or across a view without perspective. Units: m.
    pub lead_m: Vec3,
}

impl ViewCells {
    /// The cells at quality `kappa` (none) under `spectrum`, or wherever it may rain: `anywhere`. Clamps as
    /// [`Container::fill`](super::Container::fill).
    ///
    /// Error: none is missing; the blocks hold others as well, which are not within reach or outside two planes together.
    #[must_use]
    pub fn new(spectrum: &Spectrum, motion: &FieldMotion, view: &RainViewVolume, kappa: f64, anywhere: bool) -> Self {
        let eye_velocity = if view.eye_velocity_m_s.is_finite() {
            view.eye_velocity_m_s
        } else {
            DVec3::ZERO
        };
        let lead_m = lead_of(view).as_vec3();
        let raining = (spectrum.n0_per_m3_mm > 0.0 || anywhere) && kappa > 0.0;
        let sees = !view.side_planes.iter().any(|plane| plane.is_nan()) && !view.exposure_s.is_nan();
        let classes = core::array::from_fn(|k| {
            let class = SizeClass::new(k);
            let placement = ClassPlacement {
                eye: LatticeEye::new(view.eye_m, motion.offset_m[k], class.cell_m),
                velocity_m_s: motion.velocity_m_s[k].as_vec3(),
            };
            let relative = placement.velocity_m_s - eye_velocity.as_vec3();
            let cell_m = class.cell_m as f32;
            let reach_m = (FADE_END * view.drawn_m(kappa, class.max_mm)) as f32;
            let streak_m = relative * view.exposure_s as f32;
            let sides = moved_out(view, streak_m, reach_m + lead_m.length());
            // A little more, for rounding.
            let around = sides.map(|plane| plane + Vec4::W * SLACK_M);
            let extent = |axis: Vec3| extent_m(&around, reach_m, lead_m, axis);
            let low = -Vec3::from_array(Vec3::AXES.map(|axis| extent(-axis)));
            let high = Vec3::from_array(Vec3::AXES.map(extent));
            let bound = IVec3::splat(CELL_BIAS);
            let low = (low / cell_m + placement.eye.fraction).floor().as_ivec3().max(-bound);
            let high = (high / cell_m + placement.eye.fraction)
                .floor()
                .as_ivec3()
                .min(bound - 1);
            let side = (high - low + 1).max(IVec3::ZERO).as_uvec3();
            ClassCells {
                placement,
                low,
                side: if raining && sees && reach_m > 0.0 {
                    side
                } else {
                    UVec3::ZERO
                },
                reach_m,
                least_reach_m: (FADE_END * (1.0 - 1e-5) * view.drawn_m(kappa, class.min_mm)) as f32,
                sides,
            }
        });
        Self { classes, lead_m }
    }

    /// Where the lattices stand.
    #[must_use]
    pub fn placements(&self) -> [ClassPlacement; CLASS_COUNT] {
        self.classes.map(|class| class.placement)
    }
}

/// How far places within `reach` of the lead and inside the planes extend along an axis (unit), at most. Units: m.
///
/// Any λ ≥ 0 bounds it: a·x ≤ (a + Σ λ n)·x + Σ λ w there. The best of each pair of planes is taken.
fn extent_m(planes: &[Vec4; 4], reach: f32, lead: Vec3, axis: Vec3) -> f32 {
    let bound = |left: Vec3, slack: f32| left.length() * reach + left.dot(lead).max(0.0) + slack;
    let mut least = bound(axis, 0.0);
    let mut take = |terms: [(f32, Vec4); 2]| {
        if terms.iter().all(|(share, _)| share.is_finite() && *share >= 0.0) {
            let left = terms
                .iter()
                .fold(axis, |left, (share, plane)| left + *share * plane.truncate());
            let slack: f32 = terms.iter().map(|(share, plane)| share * plane.w.max(0.0)).sum();
            let found = bound(left, slack);
            if found < least {
                least = found;
            }
        }
    };
    for (i, first) in planes.iter().enumerate() {
        let (n, along) = (first.truncate(), axis.dot(first.truncate()));
        take([(-along / n.length_squared(), *first), (0.0, *first)]);
        for second in &planes[i + 1..] {
            let m = second.truncate();
            let (nn, nm, mm) = (n.length_squared(), n.dot(m), m.length_squared());
            let determinant = nn * mm - nm * nm;
            let beside = axis.dot(m);
            take([
                ((beside * nm - along * mm) / determinant, *first),
                ((along * nm - beside * nn) / determinant, *second),
            ]);
        }
    }
    // What is left of a sum that cancels is rounding.
    least + 1e-5 * (reach + lead.length())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Quat;

    /// 60° vertical, 16:9, looking along −Z.
    fn planes() -> [Vec4; 4] {
        let ty = 30.0_f32.to_radians().tan();
        let tx = ty * 16.0 / 9.0;
        [
            Vec3::new(1.0, 0.0, -tx),
            Vec3::new(-1.0, 0.0, -tx),
            Vec3::new(0.0, 1.0, -ty),
            Vec3::new(0.0, -1.0, -ty),
        ]
        .map(|n| n.normalize().extend(0.0))
    }

    /// Numbers in [−1, 1), always the same of a seed.
    fn signed(seed: u32) -> impl FnMut() -> f32 {
        let mut word = seed;
        move || {
            word = crate::hash::pcg(word);
            2.0 * crate::hash::unit_f32(word) - 1.0
        }
    }

    #[test]
    fn a_view_reaches_to_its_corners_and_hardly_behind_itself() {
        let extent = |axis| extent_m(&planes(), 10.0, Vec3::ZERO, axis);
        // The sphere at the middle of a side: sin of half the angle.
        let half = (30.0_f32.to_radians().tan() * 16.0 / 9.0).atan();
        for (axis, expected) in [
            (Vec3::X, 10.0 * half.sin()),
            (Vec3::NEG_Y, 5.0),
            (Vec3::NEG_Z, 10.0),
            (Vec3::Z, 0.0),
        ] {
            assert!((extent(axis) - expected).abs() < 1e-3, "{axis}: {}", extent(axis));
        }
        // Planes that are 0.1 m further out let in what is 0.1 m/sin behind the corner.
        let wider = planes().map(|plane| plane + 0.1 * Vec4::W);
        let behind = extent_m(&wider, 10.0, Vec3::ZERO, Vec3::Z);
        assert!(behind > 0.1 && behind < 0.21, "{behind}");
        // Ahead of a fast eye.
        let ahead = extent_m(&planes(), 10.0, Vec3::NEG_Z * 4.0, Vec3::NEG_Z);
        assert!((ahead - 14.0).abs() < 1e-3, "{ahead}");
    }

    #[test]
    fn a_streak_with_an_end_in_the_picture_is_kept_and_few_others() {
        let mut random = signed(7);
        let inside = |planes: &[Vec4; 4], p: Vec3| planes.iter().all(|plane| plane.truncate().dot(p) + plane.w >= 0.0);
        let furthest = 5.0;
        let (mut shown, mut kept, mut by_length) = ([0; 2], [0; 2], [0; 2]);
        for round in 0..40 {
            let turn = if round % 2 == 0 { 0.0 } else { 0.05 + 0.05 * random() };
            let axis = Vec3::new(random(), random(), random()).normalize_or(Vec3::Y);
            let back = Quat::from_axis_angle(axis, -turn);
            let before = planes().map(|plane| (back * plane.truncate()).extend(plane.w));
            let view = RainViewVolume {
                eye_m: DVec3::ZERO,
                eye_velocity_m_s: DVec3::ZERO,
                side_planes: planes(),
                focal_px: 600.0,
                solid_angle_sr: 1.0,
                exposure_s: 0.02,
                turn_rad: f64::from(turn),
                parallel: None,
            };
            let streak = Vec3::new(0.05 * random(), -0.15 + 0.05 * random(), 0.05 * random());
            let sides = moved_out(&view, streak, furthest);
            let around = planes().map(|plane| plane + Vec4::W * (streak.length() + SLACK_M));
            for _ in 0..4000 {
                let p = Vec3::new(random(), random(), random()) * furthest;
                if p.length() > furthest {
                    continue;
                }
                let of = usize::from(turn > 0.0);
                let seen = inside(&planes(), p) || inside(&before, p - streak);
                assert!(!seen || inside(&sides, p), "{p}, {streak}, turned by {turn}");
                shown[of] += u32::from(seen);
                kept[of] += u32::from(inside(&sides, p));
                by_length[of] += u32::from(inside(&around, p));
            }
        }
        // Rain beside the picture falls past it.
        assert!(shown[0] > 2000 && shown[1] > 2000, "{shown:?}");
        assert!(
            kept[0] - shown[0] < (by_length[0] - shown[0]) / 2,
            "{shown:?} {kept:?} {by_length:?}"
        );
        assert!(f64::from(kept[1]) < 1.25 * f64::from(shown[1]), "{shown:?} {kept:?}");
    }

    #[test]
    fn no_place_inside_is_left_out_whatever_the_planes() {
        let mut random = signed(1);
        let mut inside = 0;
        for round in 0..60 {
            let mut planes = planes();
            if round % 2 == 1 {
                planes = core::array::from_fn(|_| {
                    Vec3::new(random(), random(), random())
                        .normalize_or(Vec3::X)
                        .extend(0.1 * random())
                });
            }
            let lead = Vec3::new(random(), random(), random()) * f32::from(u8::from(round % 3 == 0)) * 5.0;
            let reach = 3.0 + random();
            let planes = planes.map(|plane| plane + 0.1 * Vec4::W);
            let extents = Vec3::AXES.map(|axis| [axis, -axis].map(|axis| extent_m(&planes, reach, lead, axis)));
            for _ in 0..2000 {
                let p = Vec3::new(random(), random(), random()) * reach;
                if p.length() > reach {
                    continue;
                }
                let p = p + lead * (0.5 + 0.5 * random());
                if planes.iter().all(|plane| plane.truncate().dot(p) + plane.w >= 0.0) {
                    inside += 1;
                    for (v, [high, low]) in p.to_array().into_iter().zip(extents) {
                        assert!(v <= high && -v <= low, "{p} {extents:?}");
                    }
                }
            }
        }
        assert!(inside > 5000, "{inside}");
    }
}
