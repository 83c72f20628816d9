//! An area seen from outside: where its container stands and how large it is (Puig-Centelles, Ripolles & Chover 2009, far
//! rain).

use core::f64::consts::{FRAC_PI_2, PI};

use glam::DVec2;

use super::ellipse::{ellipse_distance, ellipse_nearest, ellipse_ray, ellipse_tangents};
use crate::error::{clamped, clamped_or};
use crate::ops;

/// A view as far rain needs it: on the ground plane (x, z).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FarView {
    /// Units: m.
    pub eye_m: DVec2,
    /// Where it looks; its length does not count.
    pub ahead: DVec2,
    /// Half the horizontal field of view. Units: rad. Held in (0, π/2).
    pub half_view_rad: f64,
}

/// How much of an area a view has in sight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Seen {
    /// From side to side.
    Whole,
    /// Cut by at least one side of the picture.
    Part,
}

/// The container of far rain: a box on the ground that holds all of an elliptical area that a view has in sight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FarFit {
    /// The point of the perimeter nearest to the eye: the container stands there, its flat side to the eye. Units: m.
    pub anchor_m: DVec2,
    /// Unit direction from the eye to it.
    pub towards: DVec2,
    /// How far away it is. Units: m.
    pub distance_m: f64,
    /// Bearings of the sight's two sides relative to where the view looks, towards −Z × X first. Units: rad.
    pub bearings_rad: [f64; 2],
    /// Extent across, to the left and right of the anchor as seen from the eye (the first is at most 0). Units: m.
    pub across_m: [f64; 2],
    /// Extent before the anchor, towards the eye: of a soft edge and of outlines that are not convex. Units: m. At least 0.
    pub front_m: f64,
    /// Depth from the anchor to the furthest point in sight, along `towards`. Units: m.
    pub depth_m: f64,
    /// How much is in sight.
    pub seen: Seen,
}

/// `angle` in (−π, π].
fn wrapped(angle: f64) -> f64 {
    let turn = 2.0 * PI;
    let a = angle - turn * (angle / turn).round();
    if a <= -PI { a + turn } else { a }
}

fn bearing(direction: DVec2, ahead: DVec2) -> f64 {
    ops::atan2(ahead.perp_dot(direction), ahead.dot(direction))
}

/// Fits the far container to an ellipse (centre m, radii m, first axis turned by `heading_rad` from +X to +Z) for a view
/// outside it. None where the eye is inside or on the perimeter, or nothing of the area is between the picture's sides.
///
/// The lateral lines of the view are cut with the ellipse; the sight is the overlap of the view with the interval between
/// the two tangents. Unlike a test of the nearest point alone this misses no area that is in view.
///
/// Error: 1e-7 of the radii and the distance: no point of the area in sight is outside the container, and each side of
/// the container touches one.
#[must_use]
pub fn far_fit(view: &FarView, centre_m: DVec2, radii_m: DVec2, heading_rad: f64) -> Option<FarFit> {
    let axis = DVec2::new(ops::cos(heading_rad), ops::sin(heading_rad));
    let to_local = |v: DVec2| DVec2::new(axis.dot(v), axis.perp_dot(v));
    let eye = to_local(view.eye_m - centre_m);
    let ahead = to_local(view.ahead).try_normalize()?;
    let half = clamped(view.half_view_rad, 1e-6, FRAC_PI_2 - 1e-6);
    let tangents = ellipse_tangents(eye, radii_m)?;
    let nearest = ellipse_nearest(eye, radii_m);
    let distance = eye.distance(nearest);
    let towards = (nearest - eye).try_normalize()?;
    // The sight about the direction to the anchor, which lies between the tangents.
    let middle = bearing(towards, ahead);
    let mut sides = tangents.map(|t| wrapped(bearing(t - eye, ahead) - middle));
    sides.sort_by(f64::total_cmp);
    let [low, high] = sides.map(|side| middle + side);
    // The view's interval is about 0; the ellipse's may lie a turn away from it.
    let shift = [0.0, 2.0 * PI, -2.0 * PI]
        .into_iter()
        .find(|turn| low + turn <= half && high + turn >= -half)?;
    let (low, high) = (low + shift, high + shift);
    let bearings = [low.max(-half), high.min(half)];
    if bearings[0] >= bearings[1] {
        return None;
    }
    let seen = if bearings == [low, high] {
        Seen::Whole
    } else {
        Seen::Part
    };
    // Points that may be the furthest to a side or in depth: where the sides meet the ellipse, and its extremes between.
    let right = towards.perp();
    let (mut least, mut most, mut depth) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
    let mut visit = |p: DVec2| {
        let from = p - nearest;
        least = least.min(right.dot(from));
        most = most.max(right.dot(from));
        depth = depth.max(towards.dot(from));
    };
    let between = |p: DVec2| {
        let b = bearing(p - eye, ahead);
        b >= bearings[0] && b <= bearings[1]
    };
    for (side, tangent) in bearings.into_iter().zip([low, high]) {
        let turn = DVec2::new(ops::cos(side), ops::sin(side));
        let direction = ahead.rotate(turn);
        match ellipse_ray(eye, direction, radii_m) {
            Some(hits) if side != tangent => hits.iter().for_each(|t| visit(eye + direction * *t)),
            _ => {
                // The side touches the ellipse: the tangent point itself.
                let touch = |t: &DVec2| direction.perp_dot(*t - eye).abs();
                let [a, b] = tangents;
                visit(if touch(&a) < touch(&b) { a } else { b });
            }
        }
    }
    for direction in [right, -right, towards] {
        let extreme = radii_m * radii_m * direction / (radii_m * direction).length();
        if between(extreme) {
            visit(extreme);
        }
    }
    if between(nearest) {
        visit(nearest);
    }
    let from_local = |v: DVec2| axis.rotate(v);
    Some(FarFit {
        anchor_m: centre_m + from_local(nearest),
        towards: from_local(towards),
        distance_m: distance,
        bearings_rad: bearings,
        across_m: [least.min(0.0), most.max(0.0)],
        front_m: 0.0,
        depth_m: depth,
        seen,
    })
}

impl FarFit {
    /// Height of the container over the eye's level so that its drops come out of the cloud, or out of the top of the
    /// picture where that is lower. `cloud_m`: height of the cloud's base over the eye (m, from 0 on); `top_rad`: elevation
    /// of the picture's top (held below π/2). Units: m.
    ///
    /// Error: one rounding.
    #[must_use]
    pub fn height_m(&self, cloud_m: f64, top_rad: f64) -> f64 {
        let top = clamped_or(top_rad, -FRAC_PI_2, FRAC_PI_2 - 1e-6, 0.0);
        // The furthest rain needs the most height.
        let in_picture = (self.distance_m + self.depth_m) * ops::tan(top).max(0.0);
        clamped(cloud_m, 0.0, f64::MAX).min(in_picture)
    }

    /// Width of the container. Units: m.
    #[must_use]
    pub fn width_m(&self) -> f64 {
        self.across_m[1] - self.across_m[0]
    }
}

/// How much of a view's rain is drawn near, by its signed distance from an ellipse about the origin (m, negative inside): 1
/// inside, 0 outside, smooth over `transition_m` about the perimeter. Near and far rain together are always one.
/// Units: none.
///
/// Error: 1e-12 of the larger radius over the transition.
#[must_use]
pub fn near_share(p: DVec2, radii_m: DVec2, transition_m: f64) -> f64 {
    super::field::border_weight(ellipse_distance(p, radii_m), transition_m)
}
