//! Containers that follow a view: the semi-cylinder and the block, fitted by speed and field of view.
//!
//! A container says in which part of the air drops are drawn. Drops stand still in it: they are those of the frozen field,
//! so several views, each with its own container, see the same drops. It follows the eye with slack in place and heading,
//! continuously: the parts that it leaves and gains are at its rim, where drops fade out.
//!
//! Sources: Puig-Centelles, Ripolles & Chover 2009 (semi-cylinder with an elliptical base); the block of a driving
//! simulation, 40 × 15 × 80 m.

use core::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec2, DVec3};

use super::areas::{border_weight, ellipse_distance};
use super::container::{LEAD_CAP_M, LEAD_TIME_S};
use crate::error::{ConfigError, clamped, clamped_or, in_range};
use crate::ops;

/// A region of air about a view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FollowShape {
    /// Half a cylinder whose base is an ellipse; its flat face is behind the eye.
    SemiCylinder {
        /// Half its width. Units: m. Domain: [0.1, 1000].
        across_m: f64,
        /// From the middle to the rim ahead. Units: m. Domain: [0.1, 1000].
        ahead_m: f64,
        /// Units: m. Domain: [0.1, 1000].
        height_m: f64,
    },
    /// A block that begins behind the eye.
    Block {
        /// Units: m. Domain: [0.1, 1000].
        width_m: f64,
        /// Units: m. Domain: [0.1, 1000].
        height_m: f64,
        /// Along the view. Units: m. Domain: [0.1, 1000].
        depth_m: f64,
    },
}

impl FollowShape {
    /// The block of 40 × 15 × 80 m.
    pub const REFERENCE_BLOCK: Self = Self::Block {
        width_m: 40.0,
        height_m: 15.0,
        depth_m: 80.0,
    };
}

/// A container and how it follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FollowSettings {
    /// Its region.
    pub shape: FollowShape,
    /// The eye may be so far from its middle before it moves. Units: m. Domain: [0, 100].
    pub slack_m: f64,
    /// Drops fade out over this much inside its rim. Units: m. Domain: [0, 100].
    pub rim_m: f64,
}

/// Where a container stands.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Follow {
    /// World. Units: m.
    pub centre_m: DVec3,
    /// Direction from −Z towards +X that it faces. Units: rad.
    pub heading_rad: f64,
}

/// Margin within which a view may turn and still see nothing but the container: 90° less half the horizontal field of
/// view (held in [0, π/2]). Units: rad.
///
/// With a margin of 90° itself, half of the picture would be empty.
///
/// Error: one rounding.
#[must_use]
pub fn heading_margin_rad(half_view_rad: f64) -> f64 {
    FRAC_PI_2 - clamped_or(half_view_rad, 0.0, FRAC_PI_2, FRAC_PI_2)
}

/// `angle` in [−π, π].
fn wrapped(angle: f64) -> f64 {
    angle - 2.0 * PI * (angle / (2.0 * PI)).round()
}

impl FollowSettings {
    /// These settings, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        let size = |field, value| in_range(field, value, 0.1, 1000.0, "0.1 to 1000 m");
        match self.shape {
            FollowShape::SemiCylinder {
                across_m,
                ahead_m,
                height_m,
            } => {
                size("across_m", across_m)?;
                size("ahead_m", ahead_m)?;
                size("height_m", height_m)?;
            }
            FollowShape::Block {
                width_m,
                height_m,
                depth_m,
            } => {
                size("width_m", width_m)?;
                size("height_m", height_m)?;
                size("depth_m", depth_m)?;
            }
        }
        in_range("slack_m", self.slack_m, 0.0, 100.0, "0 to 100 m")?;
        in_range("rim_m", self.rim_m, 0.0, 100.0, "0 to 100 m")?;
        Ok(self)
    }

    /// Fitted to a view: at least `reach_m` ahead (units: m; held in [1, 500]) and further by the eye's speed (m/s), as the
    /// default container does; as wide as the view is there, over the slack. What is not a number counts as 0.
    ///
    /// Error: 1e-15 relative.
    #[must_use]
    pub fn fitted(self, reach_m: f64, speed_m_s: f64, half_view_rad: f64, half_height_rad: f64) -> Self {
        let lead = clamped(speed_m_s * LEAD_TIME_S, 0.0, LEAD_CAP_M);
        let ahead = clamped(reach_m, 1.0, 500.0) + lead + self.slack_m + self.rim_m;
        let half = |angle: f64| ahead * ops::tan(clamped(angle, 0.0, 1.5)) + self.slack_m + self.rim_m;
        let (across, high) = (half(half_view_rad).min(1000.0), half(half_height_rad).min(500.0));
        let shape = match self.shape {
            FollowShape::SemiCylinder { .. } => FollowShape::SemiCylinder {
                across_m: across.min(ahead),
                ahead_m: ahead,
                height_m: 2.0 * high,
            },
            FollowShape::Block { .. } => FollowShape::Block {
                width_m: 2.0 * across,
                height_m: 2.0 * high,
                depth_m: ahead + self.slack_m,
            },
        };
        Self { shape, ..self }
    }
}

impl Follow {
    /// Starts at the eye.
    #[must_use]
    pub fn new(eye_m: DVec3, heading_rad: f64) -> Self {
        Self {
            centre_m: eye_m,
            heading_rad,
        }
    }

    /// Follows an eye (world, m) that looks to `heading_rad`: nothing happens within the slack and the heading's margin
    /// ([`heading_margin_rad`]), past them it is drawn along. What is not finite changes nothing.
    ///
    /// Error: 1e-12 m and 1e-15 rad outside slack and margin.
    pub fn follow(&mut self, settings: &FollowSettings, eye_m: DVec3, heading_rad: f64, half_view_rad: f64) {
        if eye_m.is_finite() {
            self.centre_m = eye_m + (self.centre_m - eye_m).clamp_length_max(settings.slack_m);
        }
        if heading_rad.is_finite() {
            let margin = heading_margin_rad(half_view_rad);
            let off = wrapped(self.heading_rad - heading_rad);
            if off.abs() > margin {
                self.heading_rad = wrapped(heading_rad + off.clamp(-margin, margin));
            }
        }
    }

    /// Place relative to the container: across to the right, up, ahead. Units: m.
    #[must_use]
    pub fn local_m(&self, place_m: DVec3) -> DVec3 {
        let p = place_m - self.centre_m;
        let (s, c) = (ops::sin(self.heading_rad), ops::cos(self.heading_rad));
        DVec3::new(c * p.x + s * p.z, p.y, s * p.x - c * p.z)
    }

    /// How much of a drop at a place (world, m) is drawn: 1 inside, 0 outside, fading over the rim. Units: none.
    ///
    /// Error: 1e-12 of the size over the rim.
    #[must_use]
    pub fn weight(&self, settings: &FollowSettings, place_m: DVec3) -> f64 {
        let p = self.local_m(place_m);
        let rim = settings.rim_m;
        // A signed distance of at most 0 inside; the ramp lies inside the face.
        let inside = |distance: f64| border_weight(distance + 0.5 * rim, rim);
        let back = -p.z - settings.slack_m;
        match settings.shape {
            FollowShape::SemiCylinder {
                across_m,
                ahead_m,
                height_m,
            } => {
                let base = DVec2::new(p.x, p.z.max(0.0));
                let round = ellipse_distance(base, DVec2::new(across_m, ahead_m));
                // Behind the middle its sides run straight back.
                inside(round) * inside(p.y.abs() - 0.5 * height_m) * f64::from(u8::from(back <= 0.0))
            }
            FollowShape::Block {
                width_m,
                height_m,
                depth_m,
            } => {
                inside(p.x.abs() - 0.5 * width_m)
                    * inside(p.y.abs() - 0.5 * height_m)
                    * inside(p.z + settings.slack_m - depth_m)
                    * f64::from(u8::from(back <= 0.0))
            }
        }
    }
}
