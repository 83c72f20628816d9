//! The outline of an area about its centre.

use core::f64::consts::PI;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::ellipse::{ellipse_distance, ellipse_nearest};
use super::polygon::{crossing, double_area, nearest};
use super::settings::AreaError;
use crate::error::in_range;
use crate::ops;

/// Smallest radius. Units: m.
pub const MIN_RADIUS_M: f64 = 0.1;
/// Largest radius and largest distance of a corner from the centre along each axis. Units: m.
pub const MAX_EXTENT_M: f64 = 1e6;
/// Most corners of a polygon.
pub const MAX_CORNERS: usize = 64;

/// The outline of an area, about its centre. Ground coordinates are (x, z).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum AreaShape {
    /// The whole plane.
    #[default]
    Unbounded,
    /// A disc.
    Circle {
        /// Units: m. Domain: [0.1, 1e6].
        radius_m: f64,
    },
    /// An ellipse.
    Ellipse {
        /// Half its axes, in either order. Units: m. Domain: each [0.1, 1e6].
        radii_m: DVec2,
        /// Turn of the first axis from +X towards +Z. Units: rad. Domain: [−100, 100].
        #[serde(default)]
        heading_rad: f64,
    },
    /// A polygon that does not cross itself, in either sense.
    Polygon {
        /// Corners relative to the centre: 3 to 64. Units: m. Domain: each within ±1e6.
        corners_m: Vec<DVec2>,
    },
}

impl AreaShape {
    /// # Errors
    /// Names what is outside its domain, has no area or crosses itself.
    pub fn check(&self) -> Result<(), AreaError> {
        const RADIUS: &str = "0.1 to 1e6 m";
        match self {
            Self::Unbounded => {}
            Self::Circle { radius_m } => {
                in_range("radius_m", *radius_m, MIN_RADIUS_M, MAX_EXTENT_M, RADIUS)?;
            }
            Self::Ellipse { radii_m, heading_rad } => {
                for radius in radii_m.to_array() {
                    in_range("radii_m", radius, MIN_RADIUS_M, MAX_EXTENT_M, RADIUS)?;
                }
                in_range("heading_rad", *heading_rad, -100.0, 100.0, "-100 to 100 rad")?;
            }
            Self::Polygon { corners_m } => {
                let count = corners_m.len();
                if !(3..=MAX_CORNERS).contains(&count) {
                    return Err(AreaError::Corners { count });
                }
                for corner in corners_m.iter().flat_map(DVec2::to_array) {
                    in_range("corners_m", corner, -MAX_EXTENT_M, MAX_EXTENT_M, "-1e6 to 1e6 m")?;
                }
                if let Some(edges) = crossing(corners_m) {
                    return Err(AreaError::Crossing { edges });
                }
                if 0.5 * double_area(corners_m).abs() < MIN_RADIUS_M * MIN_RADIUS_M {
                    return Err(AreaError::NoArea);
                }
            }
        }
        Ok(())
    }

    /// Area of the outline. Units: m². Infinite where it is unbounded.
    ///
    /// Error: 1e-13 relative.
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        match self {
            Self::Unbounded => f64::INFINITY,
            Self::Circle { radius_m } => PI * radius_m * radius_m,
            Self::Ellipse { radii_m, .. } => PI * radii_m.x * radii_m.y,
            Self::Polygon { corners_m } => 0.5 * double_area(corners_m).abs(),
        }
    }

    /// Half the size of a rectangle about the centre that holds it. Units: m. Infinite where it is unbounded.
    #[must_use]
    pub fn reach_m(&self) -> DVec2 {
        match self {
            Self::Unbounded => DVec2::INFINITY,
            Self::Circle { radius_m } => DVec2::splat(*radius_m),
            Self::Ellipse { radii_m, heading_rad } => {
                let (c, s) = (ops::cos(*heading_rad), ops::sin(*heading_rad));
                DVec2::new(
                    (DVec2::new(c, s) * *radii_m).length(),
                    (DVec2::new(s, c) * *radii_m).length(),
                )
            }
            Self::Polygon { corners_m } => corners_m.iter().fold(DVec2::ZERO, |most, c| most.max(c.abs())),
        }
    }
}

/// A shape made ready: what does not change from point to point.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Outline {
    Unbounded,
    Circle(f64),
    /// Radii, and cosine and sine of the first axis.
    Ellipse(DVec2, DVec2),
    Polygon(Vec<DVec2>),
}

impl Outline {
    pub(super) fn of(shape: &AreaShape) -> Self {
        match shape {
            AreaShape::Unbounded => Self::Unbounded,
            AreaShape::Circle { radius_m } => Self::Circle(*radius_m),
            AreaShape::Ellipse { radii_m, heading_rad } => {
                Self::Ellipse(*radii_m, DVec2::new(ops::cos(*heading_rad), ops::sin(*heading_rad)))
            }
            AreaShape::Polygon { corners_m } => Self::Polygon(corners_m.clone()),
        }
    }

    /// Signed distance of a point relative to the centre: negative inside. Beyond `enough` on either side the distance
    /// may be a lower bound of its size that is itself beyond. Units: m.
    pub(super) fn distance(&self, p: DVec2, enough: f64) -> f64 {
        match self {
            Self::Unbounded => f64::NEG_INFINITY,
            Self::Circle(radius) => p.length() - radius,
            Self::Ellipse(radii, axis) => {
                let local = DVec2::new(axis.dot(p), axis.perp_dot(p));
                // √f has a slope of at most 1/b: |σ| ≥ b |√f − 1|.
                let bound = radii.min_element() * ((local / *radii).length() - 1.0);
                if bound.abs() > enough {
                    bound
                } else {
                    ellipse_distance(local, *radii)
                }
            }
            Self::Polygon(corners) => {
                let (q, inside) = nearest(corners, p);
                let distance = p.distance(q);
                if inside { -distance } else { distance }
            }
        }
    }

    /// The nearest point of the border, relative to the centre.
    pub(super) fn nearest(&self, p: DVec2) -> DVec2 {
        match self {
            Self::Unbounded => p,
            Self::Circle(radius) => p.try_normalize().unwrap_or(DVec2::X) * *radius,
            Self::Ellipse(radii, axis) => {
                axis.rotate(ellipse_nearest(DVec2::new(axis.dot(p), axis.perp_dot(p)), *radii))
            }
            Self::Polygon(corners) => nearest(corners, p).0,
        }
    }
}
