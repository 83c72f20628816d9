//! Where each mechanism throws water, how fast and in which drops.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::tyre::Tyre;
use crate::constants::WATER_DENSITY;
use crate::error::{clamped, clamped_or_f32};
use crate::hash;
use crate::ops;

/// How a wheel moves water.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SprayMechanism {
    /// Capillary adhesion: the film that clings to the rubber, thrown off the rear of the wheel as fine spray.
    Adhesion,
    /// Tread pickup: what the grooves carry, thrown straight behind the contact.
    Tread,
    /// Bow wave: ahead of the contact, outwards.
    Bow,
    /// Side waves: to both sides.
    Side,
}

impl SprayMechanism {
    /// All four, in the order in which water is given to them.
    pub const ALL: [Self; 4] = [Self::Adhesion, Self::Tread, Self::Bow, Self::Side];

    /// Smallest and largest drops. Units: mm. Splash is above 1 mm, spray below 0.5 (Weir et al. 1978); a choice.
    ///
    /// Error: exact; a choice.
    #[must_use]
    pub fn diameters_mm(self) -> (f64, f64) {
        match self {
            Self::Adhesion => (0.1, 0.5),
            Self::Tread => (0.5, 3.0),
            Self::Bow | Self::Side => (1.0, 5.0),
        }
    }

    /// Speeds at which water begins to fly and at which all of it does. Units: m/s.
    ///
    /// Spray 48 to 64 km/h, the least speeds at which it was measured (Pilkington 1990); splash 10 to 30 km/h, a
    /// choice.
    ///
    /// Error: exact; a choice.
    #[must_use]
    pub fn onset_m_s(self) -> (f64, f64) {
        match self {
            Self::Adhesion | Self::Tread => (48.0 / 3.6, 64.0 / 3.6),
            Self::Bow | Self::Side => (10.0 / 3.6, 30.0 / 3.6),
        }
    }

    /// Share of the mechanism's water that flies at `speed_m_s`: smooth between both speeds of [`Self::onset_m_s`].
    ///
    /// Either way; what is not a number counts as 0. Units: none, [0, 1].
    ///
    /// Error: 1e-15; a choice.
    #[must_use]
    pub fn airborne_share(self, speed_m_s: f64) -> f64 {
        let (from, to) = self.onset_m_s();
        let t = clamped((speed_m_s.abs() - from) / (to - from), 0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    }
}

/// Drops that one kilogram of a mechanism's water makes, its volume spread evenly over ln D. Units: 1/kg.
///
/// Error: 1e-13 relative against the sum over diameters; real spray is no power law.
#[must_use]
pub fn drops_per_kg(mechanism: SprayMechanism) -> f64 {
    let (from, to) = mechanism.diameters_mm();
    let (a, b) = (from * 1e-3, to * 1e-3);
    // ∫ 6/(π ρ D³) dD/D over ln(b/a).
    let spread = (1.0 / (a * a * a) - 1.0 / (b * b * b)) / (3.0 * ops::ln(b / a));
    6.0 * spread / (core::f64::consts::PI * WATER_DENSITY)
}

/// A drop of spray as it leaves the wheel, in the wheel's frame on the ground: x to the side, y up, z the way that the
/// vehicle faces; the origin is the middle of the contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SprayDroplet {
    /// Diameter. Units: mm.
    pub diameter_mm: f32,
    /// Where it leaves. Units: m.
    pub place_m: Vec3,
    /// Its velocity over the ground. Units: m/s.
    pub velocity_m_s: Vec3,
}

/// Drop number `index` of a mechanism: the same integers give the same drop.
///
/// Adhesion leaves the rear arc, 20° to 100° behind the contact, tread 5° to 30°, both along the tangent at the speed
/// of the rim, so that over the ground they have v (1 − cos θ) forwards and v sin θ upwards; 5° of scatter sideways.
/// Bow and side leave the contact's edges at 0.5 to 1 v, 10° to 35° up, the bow 20° to 40° and the side 40° to 60° from
/// straight ahead. Diameters are drawn by volume, evenly in ln D. Backwards everything is mirrored along z.
/// `speed_m_s` held in [−200, 200], what is not a number counts as 0. Source: choice within Weir et al. 1978's picture.
/// Error: places 3e-7 of width + radius, velocities 3e-7 of the speed, diameters 1e-7 relative against the same words
/// in double precision. Measured spray scatters by more than these ranges.
#[must_use]
pub fn spray_droplet(tyre: &Tyre, mechanism: SprayMechanism, speed_m_s: f32, seed: u32, index: u32) -> SprayDroplet {
    let speed = clamped_or_f32(speed_m_s, -200.0, 200.0, 0.0);
    let [a, b, c] = hash::pcg3d([index, seed, mechanism as u32 ^ 0x7370_7279]);
    let [d, e, _] = hash::pcg3d([a ^ 0x9e37_79b9, b, c]);
    let between = |(from, to): (f32, f32), bits: u32| from + (to - from) * hash::unit_f32(bits);
    let degrees = |range: (f32, f32), bits: u32| f64::from(between(range, bits).to_radians());
    let (least, most) = mechanism.diameters_mm();
    let diameter = least * ops::exp(ops::ln(most / least) * f64::from(hash::unit_f32(a)));
    let across = between((-0.5, 0.5), b) * tyre.width_m as f32;
    let (place_m, velocity_m_s) = match mechanism {
        SprayMechanism::Adhesion | SprayMechanism::Tread => {
            let arc = if mechanism == SprayMechanism::Tread {
                (5.0, 30.0)
            } else {
                (20.0, 100.0)
            };
            let angle = degrees(arc, c);
            let (sin, cos) = (ops::sin(angle) as f32, ops::cos(angle) as f32);
            let radius = tyre.radius_m as f32;
            let aside = ops::sin(degrees((-5.0, 5.0), d)) as f32;
            (
                Vec3::new(across, radius * (1.0 - cos), -radius * sin),
                Vec3::new(aside, sin, 1.0 - cos) * speed.abs(),
            )
        }
        SprayMechanism::Bow | SprayMechanism::Side => {
            let turn = if mechanism == SprayMechanism::Bow {
                (20.0, 40.0)
            } else {
                (40.0, 60.0)
            };
            let (turn, rise) = (degrees(turn, c), degrees((10.0, 35.0), d));
            let (run, up) = (ops::cos(rise) as f32, ops::sin(rise) as f32);
            let side = if across < 0.0 { -1.0 } else { 1.0 };
            let edge = Vec3::new(0.5 * side * tyre.width_m as f32, 0.0, 0.0);
            let direction = Vec3::new(side * run * ops::sin(turn) as f32, up, run * ops::cos(turn) as f32);
            (edge, direction * between((0.5, 1.0), e) * speed.abs())
        }
    };
    let way = Vec3::new(1.0, 1.0, if speed < 0.0 { -1.0 } else { 1.0 });
    SprayDroplet {
        diameter_mm: diameter as f32,
        place_m: place_m * way,
        velocity_m_s: velocity_m_s * way,
    }
}
