//! What a view that moves holds more: it reaches along the way ahead.

use glam::{DVec3, Vec4};

use super::container::{LEAD_CAP_M, LEAD_TIME_S, RainViewVolume};

/// Directions to each side of the picture.
const SIDE: usize = 6;

/// Directions spread over a view, by how they lie to the lead.
#[derive(Debug, Clone)]
pub(super) struct LeadVolume {
    /// Units: m.
    lead_m: f64,
    /// Cosine and sine of the angle to the lead, and the direction's share of the solid angle.
    rays: [[f64; 3]; SIDE * SIDE],
}

impl LeadVolume {
    /// That of a view; none where it does not move, or sees nothing.
    pub(super) fn of(view: &RainViewVolume) -> Option<Self> {
        let lead = lead_m(view.eye_velocity_m_s);
        let lead_m = lead.length();
        if lead_m < 1e-3 || view.parallel.is_some() {
            return None;
        }
        let corners = corners(&view.side_planes)?;
        let mut rays = [[0.0; 3]; SIDE * SIDE];
        for (i, ray) in rays.iter_mut().enumerate() {
            let at = |i: usize| (i as f64 + 0.5) / SIDE as f64;
            let (x, y) = (at(i % SIDE), at(i / SIDE));
            let below = corners[0].lerp(corners[1], x);
            let above = corners[2].lerp(corners[3], x);
            let place = below.lerp(above, y);
            let length = place.length();
            let cos = (place.dot(lead) / (length * lead_m)).clamp(-1.0, 1.0);
            // Of equal parts of a plane, the solid angle.
            *ray = [cos, (1.0 - cos * cos).sqrt(), 1.0 / (length * length * length)];
        }
        let sum: f64 = rays.iter().map(|ray| ray[2]).sum();
        if !(sum.is_finite() && sum > 0.0) {
            return None;
        }
        rays.iter_mut().for_each(|ray| ray[2] /= sum);
        Some(Self { lead_m, rays })
    }

    /// Volume within `reach_m` of the lead, over that within `reach_m` of the eye, both in the view. Units: none, at least 1 but
    /// for the error; 1 where nothing is reached.
    pub(super) fn growth(&self, reach_m: f64) -> f64 {
        if reach_m.is_nan() || reach_m < 1e-6 {
            return 1.0;
        }
        let lead = self.lead_m / reach_m;
        let cubes = self.rays.iter().map(|[cos, sin, share]| {
            let far = if *cos <= 0.0 {
                1.0
            } else if *cos <= lead * sin {
                1.0 / sin
            } else {
                lead * cos + (1.0 - lead * lead * sin * sin).max(0.0).sqrt()
            };
            share * far * far * far
        });
        cubes.sum()
    }
}

/// The segment from the eye that a view's drops are counted from: across it where it has no perspective, else ahead of a fast
/// eye. Units: m.
pub(super) fn lead_of(view: &RainViewVolume) -> DVec3 {
    match view.parallel {
        Some(parallel) if parallel.across_m.is_finite() => parallel.across_m,
        Some(_) => DVec3::ZERO,
        None => lead_m(view.eye_velocity_m_s),
    }
}

/// How far ahead a view reaches that moves. Units: m.
fn lead_m(eye_velocity_m_s: DVec3) -> DVec3 {
    if eye_velocity_m_s.is_finite() {
        (eye_velocity_m_s * LEAD_TIME_S).clamp_length_max(LEAD_CAP_M)
    } else {
        DVec3::ZERO
    }
}

/// The view's corners, of unit length: two of one side, then two of the other. None where its planes are none.
fn corners(planes: &[Vec4; 4]) -> Option<[DVec3; 4]> {
    let normals = planes.map(|plane| plane.truncate().as_dvec3());
    let corner = |a: usize, b: usize| {
        let along = normals[a].cross(normals[b]).try_normalize()?;
        // The one of two that is in front of the other planes.
        Some(if along.dot(normals[a ^ 1]) < 0.0 { -along } else { along })
    };
    Some([corner(0, 2)?, corner(1, 2)?, corner(0, 3)?, corner(1, 3)?])
}
