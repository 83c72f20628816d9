//! What is transparent before a view: what lies behind it is drawn before it, all else after.

use glam::{Mat3, Vec3};

use crate::gpu_types::GlassPane;

/// Panes that a view tells apart; more are left out. Units: none.
pub const MAX_PANES: usize = 8;

/// Nothing is thinner: a plane has no thickness. Units: m.
const LEAST_HALF_M: f32 = 1e-3;

/// A box that is seen through, relative to an eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pane {
    /// World to the box's own frame, where it reaches from −1 to 1. Units: 1/m.
    own_from_world: Mat3,
    /// The eye there. Units: none.
    eye: Vec3,
}

impl Pane {
    /// A box around `centre_m` (relative to the eye, m) with these half axes (m); an axis shorter than a millimetre counts as
    /// one millimetre long. `None` when something is not finite or all axes lie in a line.
    #[must_use]
    pub fn new(centre_m: Vec3, half_axes_m: [Vec3; 3]) -> Option<Self> {
        let [a, b, c] = half_axes_m;
        let thick = |own: Vec3, one: Vec3, other: Vec3| {
            if own.length() >= LEAST_HALF_M {
                own
            } else {
                LEAST_HALF_M * one.cross(other).normalize_or(own.normalize_or_zero())
            }
        };
        let axes = Mat3::from_cols(thick(a, b, c), thick(b, c, a), thick(c, a, b));
        let own_from_world = axes.inverse();
        let eye = own_from_world * -centre_m;
        let volume = axes.determinant();
        (volume != 0.0 && own_from_world.is_finite() && eye.is_finite()).then_some(Self { own_from_world, eye })
    }

    /// Whether the line of sight to a point has passed through the box before it gets there: of a point within the box it
    /// has not. Error: exact but for rounding.
    #[must_use]
    pub fn hides(&self, point_m: Vec3) -> bool {
        let way = self.own_from_world * point_m;
        let inverse = Vec3::select(way.abs().cmplt(Vec3::splat(1e-12)), Vec3::splat(1e-12), way).recip();
        let (one, other) = ((-1.0 - self.eye) * inverse, (1.0 - self.eye) * inverse);
        let leave = one.max(other).min_element();
        one.min(other).max_element() <= leave && leave > 0.0 && leave < 1.0
    }
}

impl From<&Pane> for GlassPane {
    fn from(pane: &Pane) -> Self {
        let row = |i: usize| pane.own_from_world.row(i).extend(pane.eye[i]).to_array();
        Self {
            along: row(0),
            up: row(1),
            across: row(2),
        }
    }
}

/// The first [`MAX_PANES`] of a list, and how many they are.
pub(crate) fn slots(panes: &[Pane]) -> ([GlassPane; MAX_PANES], u32) {
    let mut slots = [bytemuck::Zeroable::zeroed(); MAX_PANES];
    for (slot, pane) in slots.iter_mut().zip(panes) {
        *slot = GlassPane::from(pane);
    }
    (slots, panes.len().min(MAX_PANES) as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two metres wide and one high, upright, three metres ahead.
    fn window() -> Pane {
        Pane::new(Vec3::NEG_Z * 3.0, [Vec3::X, 0.5 * Vec3::Y, Vec3::ZERO]).expect("a pane")
    }

    #[test]
    fn a_pane_hides_what_is_seen_through_it_alone() {
        let pane = window();
        let at = |x: f32, y: f32, z: f32| pane.hides(Vec3::new(x, y, z));
        assert!(at(0.0, 0.0, -4.0) && at(0.0, 0.0, -3.1) && at(1.9, 0.9, -6.0) && at(-1.9, -0.9, -6.0));
        assert!(
            !at(0.0, 0.0, -2.9) && !at(0.0, 0.0, 4.0),
            "before it and behind the eye"
        );
        assert!(!at(2.1, 0.0, -6.0) && !at(0.0, 1.1, -6.0), "beside it");
        // From beside, a pane seen edge on.
        let thin = Pane::new(Vec3::new(1.0, 0.0, -3.0), [Vec3::Z, Vec3::Y, Vec3::ZERO]).expect("a pane");
        assert!(thin.hides(Vec3::new(2.0, 0.0, -6.0)) && !thin.hides(Vec3::new(0.5, 0.0, -6.0)));
    }

    #[test]
    fn a_sheet_of_water_hides_what_lies_under_it() {
        let lake = Pane::new(Vec3::new(0.0, -1.7, 0.0), [40.0 * Vec3::X, Vec3::ZERO, 40.0 * Vec3::Z]).expect("a pane");
        assert!(lake.hides(Vec3::new(3.0, -2.0, -5.0)) && !lake.hides(Vec3::new(3.0, -1.5, -5.0)));
        // From within a box its outside is behind it.
        let cabin = Pane::new(Vec3::ZERO, [Vec3::X, Vec3::Y, Vec3::Z]).expect("a pane");
        assert!(cabin.hides(Vec3::new(0.0, 0.0, -1.1)) && !cabin.hides(Vec3::new(0.0, 0.0, -0.9)));
    }

    #[test]
    fn what_is_no_box_is_no_pane() {
        assert!(Pane::new(Vec3::NAN, [Vec3::X, Vec3::Y, Vec3::Z]).is_none());
        assert!(Pane::new(Vec3::X, [Vec3::X, Vec3::INFINITY, Vec3::Z]).is_none());
        assert!(Pane::new(Vec3::X, [Vec3::X, Vec3::X, Vec3::X]).is_none());
        assert!(Pane::new(Vec3::X, [Vec3::ZERO; 3]).is_none());
        assert!(window().hides(Vec3::NEG_Z * 10.0) && !window().hides(Vec3::ZERO));
    }
}
