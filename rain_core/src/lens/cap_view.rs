//! What a drop on glass shows of the scene behind it.

use super::sessile::CONTACT_ANGLE_RAD;
use crate::constants::WATER_IOR;
use crate::error::clamped;
use crate::ops;
use crate::optics::fresnel_from_inside;

/// A sight line through a drop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CapView {
    /// How far it turns towards the drop's axis. Units: rad.
    pub deviation_rad: f64,
    /// Share of the light that comes through. Units: none.
    pub transmission: f64,
}

/// What is seen at `share` of the footprint's radius (held in [0, 1], NaN counts as 0), looking along the drop's axis.
///
/// The cap of a sphere leans by sin α = share · sin θ there, θ = 45°; the line leaves the water at sin β = n sin α and turns
/// by β − α towards the axis: the image stands upside down and small. What Fresnel's reflection takes darkens the rim.
///
/// Error: 1e-14 against Snell's and Fresnel's laws by angles; eyes beside the axis see the same to first order.
#[must_use]
pub fn cap_view(share: f64) -> CapView {
    let lean = clamped(share, 0.0, 1.0) * ops::sin(CONTACT_ANGLE_RAD);
    let out = (WATER_IOR * lean).min(1.0);
    CapView {
        deviation_rad: ops::asin(out) - ops::asin(lean),
        transmission: 1.0 - fresnel_from_inside(ops::sqrt(1.0 - lean * lean), WATER_IOR),
    }
}
