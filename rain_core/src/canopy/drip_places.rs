//! Where under a crown it drips: shares by distance from the trunk, and places drawn from them.

use crate::error::clamped;
use crate::hash;
use crate::ops;

/// Canopy thicknesses of the measured rows. Units: m.
pub const RADIAL_THICKNESSES_M: [f64; 4] = [4.8, 5.8, 6.8, 7.8];

/// Distances from the trunk of the measured columns, under a crown of 2 m radius. Units: m.
pub const RADIAL_DISTANCES_M: [f64; 4] = [0.4, 1.0, 1.5, 2.0];

/// Share of the drip at each distance, one row per thickness. Each row sums to 1.
///
/// Source: Nanko et al. 2011, in Weber et al. 2016, table 2: transplanted trees under an indoor rain simulator, no
/// wind.
pub const RADIAL_SHARES: [[f64; 4]; 4] = [
    [0.24, 0.22, 0.28, 0.26],
    [0.21, 0.19, 0.30, 0.30],
    [0.24, 0.20, 0.25, 0.31],
    [0.26, 0.18, 0.22, 0.34],
];

/// Radius of the measured crown. Units: m.
const MEASURED_RADIUS_M: f64 = 2.0;

/// Outer edges of the classes about the measured distances, midway between them, as shares of the crown's radius.
const CLASS_ENDS: [f64; 4] = [0.35, 0.625, 0.875, 1.0];

/// Drips that reach the ground let go in this lowest part of the canopy: leaves above drip on those below. A choice.
const LOW_SHARE: f64 = 0.2;

/// Share of the drip in the four radial classes of a crown `thickness_m` thick.
///
/// Linear between the rows, so the sum stays 1; `thickness_m` held in [4.8, 7.8] m, what is not a number counts as 4.8.
/// Units: none. Source: [`RADIAL_SHARES`].
///
/// Error: 1e-15; trees differ, and wind undoes the pattern.
#[must_use]
pub fn radial_shares(thickness_m: f64) -> [f64; 4] {
    let x = clamped(thickness_m, RADIAL_THICKNESSES_M[0], RADIAL_THICKNESSES_M[3]) - RADIAL_THICKNESSES_M[0];
    let row = (x as usize).min(2);
    let t = (x - row as f64).clamp(0.0, 1.0);
    core::array::from_fn(|class| (1.0 - t) * RADIAL_SHARES[row][class] + t * RADIAL_SHARES[row + 1][class])
}

/// The radial class, 0 to 3, of a place `radius_m` from the trunk of a crown of `crown_radius_m`: that of the nearest
/// measured distance, scaled with the crown.
///
/// Places outside the crown belong to the last class; so do all without a crown (a radius that is not above 0). A
/// `radius_m` that is not a number counts as 0.
///
/// Error: exact, save within 1e-12 of the middle between two distances, where rounding decides; trees differ.
#[must_use]
pub fn radial_class(radius_m: f64, crown_radius_m: f64) -> usize {
    if radius_m.is_nan() || radius_m <= 0.0 {
        return 0;
    }
    // Without a crown every place is outside.
    let share = if crown_radius_m > 0.0 {
        radius_m / crown_radius_m
    } else {
        1.0
    };
    CLASS_ENDS[..3].iter().position(|&end| share < end).unwrap_or(3)
}

/// A place under a crown, from the trunk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrownPlace {
    /// Along x. Units: m.
    pub x_m: f64,
    /// Along z. Units: m.
    pub z_m: f64,
    /// Above the lowest branch: where the drop lets go. Units: m.
    pub above_branch_m: f64,
    /// Radial class, 0 to 3.
    pub class: usize,
}

/// Place `index` of a crown, drawn so that it drips by [`radial_shares`] and evenly within each class, from the lowest
/// fifth of the canopy.
///
/// `crown_radius_m` in m, held in [0, 1000], what is not a number counts as 0. The same integers give the same place.
/// Classes are taken in turn by an additive recurrence, so that even a few places follow the shares.
/// Source: choice; rings midway between the measured distances.
///
/// Error: shares of n places at most 3/n off; over 40 000 places the evenness of each ring in area, angle and height
/// (χ² over 64 bins) within five standard deviations.
#[must_use]
pub fn crown_place(seed: u32, index: u32, crown_radius_m: f64, thickness_m: f64) -> CrownPlace {
    let radius = clamped(crown_radius_m, 0.0, 1000.0);
    let [a, b, c] = hash::pcg3d([index, 0x6472_6970, seed]);
    let shares = radial_shares(thickness_m);
    // Additive recurrence by the golden section from a hashed start: evener than independent draws.
    let start = hash::pcg(seed);
    let mut u = f64::from(index.wrapping_mul(2_654_435_769).wrapping_add(start)) * (1.0 / 4_294_967_296.0);
    let mut class = 0;
    while class < 3 && u >= shares[class] {
        u -= shares[class];
        class += 1;
    }
    let from = if class == 0 { 0.0 } else { CLASS_ENDS[class - 1] };
    let to = CLASS_ENDS[class];
    let along = f64::from(hash::unit_f32(a));
    let distance = radius * ops::sqrt(from * from + along * (to * to - from * from)).clamp(from, to);
    let angle = core::f64::consts::TAU * f64::from(hash::unit_f32(b));
    CrownPlace {
        x_m: distance * ops::cos(angle),
        z_m: distance * ops::sin(angle),
        above_branch_m: LOW_SHARE * clamped(thickness_m, 0.0, 1000.0) * f64::from(hash::unit_f32(c)),
        class,
    }
}

/// The class ends are those midway between the measured distances.
const _: () = {
    let mut class = 0;
    while class < 3 {
        let middle = 0.5 * (RADIAL_DISTANCES_M[class] + RADIAL_DISTANCES_M[class + 1]) / MEASURED_RADIUS_M;
        assert!(middle - CLASS_ENDS[class] < 1e-12 && CLASS_ENDS[class] - middle < 1e-12);
        class += 1;
    }
};
