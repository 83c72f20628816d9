//! The container of an area of any outline, soft edge included: by its hull in the view's wedge.

use core::f64::consts::{FRAC_PI_2, PI};

use glam::DVec2;

use super::far::{FarFit, FarView, Seen};
use super::field::{AreaField, PlacedArea, border_weight};
use super::settings::AreaRain;
use super::shape::Outline;
use crate::error::clamped;
use crate::ops;

/// Sides of a hull: it is 0.12 % wider than a disc.
const SIDES: usize = 64;

/// Least width over which far rain gives way to near rain at a perimeter. Chosen: what one walks in half a minute; a sharp
/// edge would change the picture at once. Units: m.
const LEAST_PASSAGE_M: f64 = 40.0;

impl PlacedArea {
    /// Corners of a convex polygon about the area and its soft edge (world x, z); none where it is unbounded. Units: m.
    fn hull(&self) -> Vec<DVec2> {
        let support = |normal: DVec2| match &self.outline {
            Outline::Unbounded => None,
            Outline::Circle(radius) => Some(*radius),
            Outline::Ellipse(radii, axis) => {
                Some((*radii * DVec2::new(axis.dot(normal), axis.perp_dot(normal))).length())
            }
            Outline::Polygon(corners) => Some(corners.iter().fold(f64::NEG_INFINITY, |m, c| m.max(c.dot(normal)))),
        };
        let turn = 2.0 * PI / SIDES as f64;
        let normal = |i: usize| DVec2::new(ops::cos(turn * i as f64), ops::sin(turn * i as f64));
        let edge = |i: usize| support(normal(i)).map(|height| height + 0.5 * self.transition_m);
        (0..SIDES)
            .filter_map(|i| {
                // Where two neighbouring lines of support meet.
                let (a, b) = (edge(i)?, edge((i + 1) % SIDES)?);
                let across = (b - a * ops::cos(turn)) / ops::sin(turn);
                Some(self.centre_m + normal(i) * a + normal(i).perp() * across)
            })
            .collect()
    }

    /// Fits a container to all of the area that a view has in sight, its soft edge included, whatever its outline. It stands
    /// at the point of the outline nearest to the eye, its flat side to the eye; where the eye is inside, at the eye, facing
    /// where it looks. None where the area is unbounded or nothing of it is between the picture's sides.
    ///
    /// Error: 1e-6 m: no rain of the area in sight is further outside the container; its sides may be 0.2 % of the area's size
    /// further out than a convex outline with its soft edge.
    #[must_use]
    pub fn far_container(&self, view: &FarView) -> Option<FarFit> {
        let ahead = view.ahead.try_normalize()?;
        let half = clamped(view.half_view_rad, 1e-6, FRAC_PI_2 - 1e-6);
        let (cosine, sine) = (ops::cos(half), ops::sin(half));
        let hull = self.hull();
        // Inward normals of the picture's sides.
        let right = ahead.perp();
        let mut seen = hull.clone();
        for normal in [ahead * sine + right * cosine, ahead * sine - right * cosine] {
            seen = clipped(&seen, |p| normal.dot(p - view.eye_m));
        }
        if seen.len() < 3 {
            return None;
        }
        let local = view.eye_m - self.centre_m;
        let outside = self.outline.distance(local, f64::INFINITY) > 0.0;
        let anchor = if outside {
            self.centre_m + self.outline.nearest(local)
        } else {
            view.eye_m
        };
        let towards = (anchor - view.eye_m).try_normalize().unwrap_or(ahead);
        let mut fit = FarFit {
            anchor_m: anchor,
            towards,
            distance_m: anchor.distance(view.eye_m),
            bearings_rad: [half, -half],
            across_m: [0.0; 2],
            front_m: 0.0,
            depth_m: 0.0,
            seen: if seen == hull { Seen::Whole } else { Seen::Part },
        };
        for p in seen {
            let from = p - anchor;
            let across = towards.perp().dot(from);
            fit.across_m = [fit.across_m[0].min(across), fit.across_m[1].max(across)];
            fit.front_m = fit.front_m.max(-towards.dot(from));
            fit.depth_m = fit.depth_m.max(towards.dot(from));
            let sight = p - view.eye_m;
            let bearing = clamped(ops::atan2(ahead.perp_dot(sight), ahead.dot(sight)), -half, half);
            fit.bearings_rad = [fit.bearings_rad[0].min(bearing), fit.bearings_rad[1].max(bearing)];
        }
        Some(fit)
    }
}

/// The part of a convex polygon where a linear function is not negative.
fn clipped(corners: &[DVec2], side: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    let Some(mut before) = corners.last().copied() else {
        return kept;
    };
    for &corner in corners {
        let (a, b) = (side(before), side(corner));
        if (a < 0.0) != (b < 0.0) {
            kept.push(before + (corner - before) * (a / (a - b)));
        }
        if b >= 0.0 {
            kept.push(corner);
        }
        before = corner;
    }
    kept
}

impl FarFit {
    /// Whether a place is in the container or within `margin_m` of its sides. Units: m.
    #[must_use]
    pub fn holds(&self, place_m: DVec2, margin_m: f64) -> bool {
        let from = place_m - self.anchor_m;
        let (across, depth) = (self.towards.perp().dot(from), self.towards.dot(from));
        across >= self.across_m[0] - margin_m
            && across <= self.across_m[1] + margin_m
            && depth >= -self.front_m - margin_m
            && depth <= self.depth_m + margin_m
    }
}

impl AreaField {
    /// How much of a view's rain is near rain: 1 well inside a shower, 0 well outside all, half on an outline, over the width
    /// of the soft edge and no less than 40 m; what is left is far rain. An unbounded shower has everybody inside. Units: none.
    ///
    /// Error: 1e-12, that of the distance over the width.
    #[must_use]
    pub fn near_share_at(&self, place_m: DVec2) -> f64 {
        self.areas()
            .iter()
            .filter(|area| !matches!(area.rain, AreaRain::Scale(scale) if scale <= 1.0))
            .map(|area| {
                let width = area.transition_m.max(LEAST_PASSAGE_M);
                let painted = area.density.as_ref().map_or(1.0, |map| map.at(place_m - area.centre_m));
                area.strength * border_weight(area.distance_m(place_m), width) * painted
            })
            .fold(0.0, f64::max)
    }
}
